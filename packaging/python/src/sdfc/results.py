"""Meshes, contours, measurements, pictures and shaders of scenes."""

from __future__ import annotations

import json
import math
import os
from ctypes import byref, c_size_t, c_uint32, create_string_buffer, string_at
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._native import Handle, lib
from .errors import ArgumentError

PathLike = Union[str, "os.PathLike[str]"]

_MESHES = (".stl", ".obj", ".ply", ".glb", ".3mf")
_CONTOURS = (".svg", ".dxf")


def _format(path: PathLike, what: str, known: tuple[str, ...]) -> bytes:
    """Returns the format of a file, by the extension of its name."""
    extension = Path(path).suffix.lower()
    if extension in known:
        return extension[1:].encode()
    *most, last = known
    names = f"{', '.join(most)} or {last}" if most else last
    raise ArgumentError(f"{path}: {what} are written as {names}")


def _corners(bounds: Any) -> NDArray[np.float64] | None:
    return None if bounds is None else np.array(bounds)


class Mesh:
    """A closed mesh of triangles, and what is proven about it. Made by :meth:`Scene.mesh`.

    Arrays are read-only, and show the memory of the library without a copy.
    """

    vertices: NDArray[np.float64]
    """Positions in scene units, of shape (n, 3)."""
    normals: NDArray[np.float64]
    """Unit normals at the vertices, of shape (n, 3); on a sharp edge that of one side."""
    colors: NDArray[np.float32] | None
    """Linear red, green and blue at the vertices, of shape (n, 3); None without materials."""
    triangles: NDArray[np.uint32]
    """Indices of vertices, of shape (m, 3), counter-clockwise as seen from outside."""
    volume: float
    """The volume that the mesh encloses, in cubic scene units."""
    area: float
    """The area of all triangles, in square scene units."""
    bounds: NDArray[np.float64] | None
    """The lowest and the highest corner, of shape (2, 3); None without vertices."""
    shells: list[dict[str, Any]]
    """The connected parts and cavities: ``volume``, ``holes``, ``is_cavity``, ``bounds`` and more,
    as ``sdfc mesh --json`` writes them."""
    certificate: dict[str, Any]
    """The proven properties: ``error``, ``is_proven``, ``is_topology_proven``, ``undecided`` and
    more, as ``sdfc mesh --json`` writes them."""
    left_out: list[str]
    """The solids without a limit, such as a floor, that the mesh leaves out."""

    def __init__(self, handle: Handle) -> None:
        self._handle = handle

        def rows(get: Any, dtype: str) -> NDArray[Any]:
            count = c_size_t()
            first = get(handle.address, byref(count))
            return _native.view(handle, first, (count.value, 3), dtype)

        self.vertices = rows(lib.sdfc_mesh_vertices, "f8")
        self.normals = rows(lib.sdfc_mesh_normals, "f8")
        colors = rows(lib.sdfc_mesh_colors, "f4")
        self.colors = colors if len(colors) else None
        self.triangles = rows(lib.sdfc_mesh_triangles, "u4")
        described = json.loads(lib.sdfc_mesh_describe(handle.address))
        self.volume, self.area = described["volume"], described["area"]
        self.bounds = _corners(described["bounds"])
        self.shells = described["shells"]
        self.certificate = described["certificate"]
        self.left_out = described["left_out"]

    def save(self, path: PathLike) -> None:
        """Writes a file: .stl, .obj, .ply, .glb or .3mf, by the extension of its name.

        Raises :class:`ArgumentError` for another extension, or if the format cannot hold the mesh.
        """
        address = lib.sdfc_mesh_write(self._handle.address, _format(path, "meshes", _MESHES))
        Path(path).write_bytes(_native.take_bytes(address))

    def __repr__(self) -> str:
        proof = "proven" if self.certificate["is_proven"] else "not proven everywhere"
        return (
            f"<sdfc.Mesh: {len(self.vertices)} vertices, {len(self.triangles)} triangles, "
            f"error {self.certificate['error']:g} {proof}>"
        )


@dataclass(frozen=True)
class ContourPath:
    """A closed path of a contour."""

    points: NDArray[np.float64]
    """The corners in the coordinates of the plane, of shape (n, 2), in scene units. The last one is
    connected to the first one."""
    bulges: NDArray[np.float64]
    """The bulge of the line or arc from each corner to the next one, of shape (n,): 0 for a line,
    else the tangent of a quarter of the arc's angle, positive if it is counter-clockwise."""
    is_hole: bool
    """True if the inside of the scene is outside of the path; holes are clockwise."""
    parent: int | None
    """The index of the path directly around this one."""


class Contour:
    """The closed paths around a section of a scene. Made by :meth:`Scene.contour`."""

    paths: list[ContourPath]
    """The paths. They neither cross nor touch."""
    origin: NDArray[np.float64]
    """The position in space of the origin of the plane's coordinates, of shape (3,)."""
    axes: NDArray[np.float64]
    """The directions in space of the plane's coordinates, of shape (2, 3)."""
    area: float
    """The area of the section, in square scene units."""
    length: float
    """The length of all paths, in scene units."""
    bounds: NDArray[np.float64] | None
    """The lowest and the highest corner in the plane, of shape (2, 2); None without paths."""
    certificate: dict[str, Any]
    """The proven properties, as ``sdfc contour --json`` writes them."""
    left_out: list[str]
    """The solids or regions without a limit that the contour leaves out."""

    def __init__(self, handle: Handle) -> None:
        self._handle = handle
        described = json.loads(lib.sdfc_contour_describe(handle.address))
        self.paths = [
            ContourPath(
                np.array(path["points"]),
                np.array(path["bulges"]),
                path["is_hole"],
                path["parent"],
            )
            for path in described["paths"]
        ]
        self.origin, self.axes = np.array(described["origin"]), np.array(described["axes"])
        self.area, self.length = described["area"], described["length"]
        self.bounds = _corners(described["bounds"])
        self.certificate = described["certificate"]
        self.left_out = described["left_out"]

    def save(self, path: PathLike) -> None:
        """Writes a file: .svg or .dxf, by the extension of its name. A scene unit is a millimetre.

        Raises :class:`ArgumentError` for another extension.
        """
        address = lib.sdfc_contour_write(self._handle.address, _format(path, "contours", _CONTOURS))
        Path(path).write_bytes(_native.take_bytes(address))

    def __repr__(self) -> str:
        return f"<sdfc.Contour: {len(self.paths)} paths, area {self.area:g}>"


@dataclass(frozen=True)
class Measurements:
    """Measurements of a scene. Made by :meth:`Scene.measure`.

    An interval is an array (low, high) that is proven to hold the true value.
    """

    volume: NDArray[np.float64]
    """The volume in cubic scene units, of shape (2,)."""
    center_of_mass: NDArray[np.float64] | None
    """The center of mass for an even density, of shape (3, 2); None if no inside is proven."""
    inertia: NDArray[np.float64] | None
    """The inertia about the center of mass for a density of 1: xx, yy, zz, xy, xz, yz; of shape
    (6, 2)."""
    lowest: NDArray[np.float64] | None
    """The lowest coordinates of the inside, of shape (3, 2)."""
    highest: NDArray[np.float64] | None
    """The highest coordinates of the inside, of shape (3, 2)."""
    area_estimate: float
    """The area in square scene units: an estimate, not proven."""
    cells: int
    """The number of boxes that were examined."""
    is_limited: bool
    """True if the limit of boxes was reached: intervals are true, but wider than asked for."""


def measurements(found: dict[str, Any]) -> Measurements:
    """Converts what ``sdfc measure --json`` writes, where null is an infinite end."""

    def intervals(value: Any) -> NDArray[np.float64] | None:
        if value is None:
            return None
        array = np.array(value, dtype=np.float64)
        low, high = array[..., 0], array[..., 1]
        low[np.isnan(low)], high[np.isnan(high)] = -math.inf, math.inf
        return array

    names = Measurements.__dataclass_fields__
    plain = ("area_estimate", "cells", "is_limited")
    values: dict[str, Any] = {
        name: found[name] if name in plain else intervals(found[name]) for name in names
    }
    return Measurements(**values)


class Picture:
    """A picture of a scene. Made by :meth:`Scene.render`.

    A notebook shows it, and ``numpy.asarray(picture)`` is its :attr:`pixels`. Arrays are read-only,
    and show the memory of the library without a copy.
    """

    pixels: NDArray[np.uint8]
    """Red, green, blue in sRGB and an alpha of 255, of shape (height, width, 4), from the top."""
    depths: NDArray[np.float32]
    """The distance from the eye to the surface along each pixel's ray, of shape (height, width), in
    scene units; infinite where a ray hits nothing."""
    note: str | None
    """Why device or method differ from the arguments; None if they do not."""
    unproven: str | None
    """Which part of the picture is unproven, and why; None if no ray can have missed more than the
    method's tolerance."""
    stats: dict[str, Any]
    """Times, counts and the device, as ``sdfc render --stats`` writes them."""

    def __init__(self, handle: Handle) -> None:
        self._handle = handle
        width, height = c_uint32(), c_uint32()
        _native.check(lib.sdfc_picture_size(handle.address, byref(width), byref(height)))
        shape = (height.value, width.value)
        rgba = lib.sdfc_picture_rgba(handle.address)
        self.pixels = _native.view(handle, rgba, (*shape, 4), "u1")
        self.depths = _native.view(handle, lib.sdfc_picture_depths(handle.address), shape, "f4")
        described = json.loads(lib.sdfc_picture_describe(handle.address))
        self.note, self.unproven = described["note"], described["unproven"]
        self.stats = described["stats"]

    def png(self) -> bytes:
        """Returns the picture as a PNG file."""
        return _native.take_bytes(lib.sdfc_picture_png(self._handle.address))

    def save(self, path: PathLike) -> None:
        """Writes the picture as a PNG file.

        Raises :class:`ArgumentError` if the name does not end in .png.
        """
        _format(path, "pictures", (".png",))
        Path(path).write_bytes(self.png())

    def _repr_png_(self) -> bytes:
        return self.png()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy:
            return np.array(self.pixels, dtype=dtype)
        return np.asarray(self.pixels, dtype=dtype)

    def __repr__(self) -> str:
        height, width = self.depths.shape
        return f"<sdfc.Picture: {width}x{height}>"


class Shader:
    """A scene as shader source. Made by :meth:`Scene.shader`."""

    code: str | bytes
    """The source; the words of a SPIR-V module as bytes."""
    reflection: dict[str, Any]
    """Functions, params, buffers and the certificate, as ``sdfc compile --reflect`` writes them."""
    uniform: bytes
    """The content of the uniform buffer for the values of the scene; empty if there is none."""

    def __init__(self, handle: Handle, scene: Handle, is_text: bool) -> None:
        length = c_size_t()
        first = lib.sdfc_shader_code(handle.address, byref(length))
        code = string_at(first, length.value)
        self.code = code.decode() if is_text else code
        self.reflection = json.loads(lib.sdfc_shader_reflection(handle.address))

        def uniform(room: Any | None, capacity: int) -> None:
            call = lib.sdfc_shader_uniform
            _native.check(call(handle.address, scene.address, room, capacity, byref(length)))

        uniform(None, 0)
        room = create_string_buffer(length.value)
        uniform(room, length.value)
        self.uniform = room.raw

    def __repr__(self) -> str:
        unit = "characters" if isinstance(self.code, str) else "bytes"
        return f"<sdfc.Shader: {len(self.code)} {unit}>"
