"""Scenes: compiled source, with values of params."""

from __future__ import annotations

import errno
import json
import numbers
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from ctypes import byref, c_void_p, string_at
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._native import Handle, lib
from .errors import ArgumentError, CompileError, Diagnostic, diagnostics
from .results import (
    Contour,
    Measurements,
    Mesh,
    PathLike,
    Picture,
    Shader,
    measurements,
)

Value = Union[float, bool, str]
"""The value of a param: a number (angles in radians), a truth value, or a string that is written as
in a scene: ``"90deg"``, ``"#d94f30"``, the name of a choice."""

Files = Union[Mapping[str, Union[str, bytes]], Callable[[str], Union[str, bytes]]]
"""The files that a scene may import: by their paths, or a function that reads a path and raises
``KeyError`` or ``OSError`` if there is no such file."""

Progress = Callable[[int, int], object]
"""A function that receives the number of finished units and the number of known units of the
current step. It runs in another thread if the call comes from the main thread. If it raises an
exception, the work stops."""

# Points that one thread evaluates at once. Fewer points take less time than starting a thread.
_CHUNK = 1 << 15

# The largest file that is read, in bytes, and the greatest group and binding of a shader: the
# limits of the command line.
_MAX_BYTES = 64 << 20
_MAX_BINDING = 65_535


@dataclass(frozen=True)
class Param:
    """A param of a scene."""

    name: str
    """Its name in the scene."""
    type: str
    """``number``, ``int``, ``angle``, ``bool``, ``color`` or ``choice``."""
    value: Any
    """Its value: a float (angles in radians), an int, a bool, a tuple of linear red, green, blue
    and alpha, or the name of a choice."""
    default: Any
    """Its default."""
    min: float | None
    """The lowest value; None without a range."""
    max: float | None
    """The highest value; None without a range."""
    choices: tuple[str, ...]
    """The names of the choices."""
    fixed: bool
    """True if the param decides what the scene consists of: only :func:`compile` sets it."""
    summary: str
    """The first line of its documentation."""


def _param(row: dict[str, Any]) -> Param:
    def value(lanes: list[float]) -> Any:
        kinds: dict[str, Callable[[], Any]] = {
            "int": lambda: int(lanes[0]),
            "bool": lambda: lanes[0] != 0,
            "color": lambda: tuple(lanes),
            "choice": lambda: row["choices"][int(lanes[0])],
        }
        return kinds.get(row["type"], lambda: lanes[0])()

    names = Param.__dataclass_fields__
    stated = {name: row[name] for name in names}
    both = {"value": value(row["value"]), "default": value(row["default"])}
    return Param(**{**stated, **both, "choices": tuple(row["choices"])})


def _read(files: Files | None, raised: list[BaseException]) -> Any:
    """Returns the callback that reads the files of a scene."""
    if files is None:
        return _native.READ(0)
    get: Callable[[str], str | bytes] = files if callable(files) else files.__getitem__

    def read(_context: object, path: bytes, file: int) -> int:
        try:
            content = get(path.decode())
            content = content.encode() if isinstance(content, str) else bytes(content)
        except (KeyError, OSError):
            return 1
        except BaseException as exception:
            raised.append(exception)
            return 1
        return int(lib.sdfc_file_give(file, content, len(content)))

    return _native.READ(read)


def compile(
    source: str,
    *,
    name: str = "scene.sdf",
    files: Files | None = None,
    values: Mapping[str, Value] | None = None,
) -> Scene:
    """Compiles the source of a scene.

    ``name`` is the file name in messages. ``files`` has the files that the scene may import; by
    default imports are errors. ``values`` sets params, also those that decide what the scene
    consists of, such as a number of copies; an angle is a string such as ``"90deg"`` here.

    Raises :class:`CompileError` if the source has errors, and :class:`ArgumentError` if a param
    does not take its value.
    """
    raised: list[BaseException] = []
    read = _read(files, raised)
    stated = json.dumps({key: _text(value) for key, value in (values or {}).items()}).encode()
    code = source.encode("utf-8", "surrogatepass")
    found = c_void_p()
    address = lib.sdfc_compile_with_values(
        _native.text(name), code, len(code), stated, read, None, byref(found)
    )
    failure = None if address else _native.error()
    rows = diagnostics(_native.take_json(found.value)) if found.value else ()
    if address:
        scene = Scene(Handle(address, lib.sdfc_scene_free), rows)
    if raised:
        raise raised[0]
    if failure is None:
        return scene
    raise CompileError(str(failure), rows) if rows else failure


def load(path: PathLike, *, values: Mapping[str, Value] | None = None) -> Scene:
    """Reads a file and compiles it, with the files below its folder that it imports.

    Files that are not there are looked for in the folders of the environment variable
    ``SDFC_PATH``. ``values`` and exceptions are those of :func:`compile`. Raises ``OSError`` if the
    file cannot be read or is larger than 64 MiB. Imports cannot follow links out of the folder.
    """
    path = Path(path)
    modules = [part for part in os.environ.get("SDFC_PATH", "").split(os.pathsep) if part]
    folders = [path.parent, *map(Path, modules)]

    def read(below: str) -> bytes:
        found = (folder for folder in folders if (folder / below).exists())
        folder = next(found, path.parent).resolve()
        file = (folder / below).resolve()
        if folder not in file.parents:
            raise PermissionError(f"{below} is outside the folder of the scene")
        return _content(file)

    # A byte that is not UTF-8 becomes a surrogate, which `compile` refuses.
    source = _content(path).decode("utf-8", "surrogateescape")
    name = str(path).encode("utf-8", "replace").decode()
    return compile(source, name=name, files=read, values=values)


def _content(path: Path) -> bytes:
    """Reads a file that is at most as large as those that the command line reads."""
    with path.open("rb") as file:
        content = file.read(_MAX_BYTES + 1)
    if len(content) > _MAX_BYTES:
        raise OSError(errno.EFBIG, f"it is larger than {_MAX_BYTES >> 20} MiB", str(path))
    return content


def _text(value: Value) -> str:
    """Returns a value as a scene writes it."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    return value if isinstance(value, str) else repr(float(value)).removesuffix(".0")


class Scene:
    """A compiled scene, with values of its params. Made by :func:`compile` and :func:`load`.

    A scene never changes: :meth:`at` returns another one. Its methods may run in any number of
    threads at once, and other Python threads run meanwhile.
    """

    warnings: tuple[Diagnostic, ...]
    """The warnings of the compiler."""

    def __init__(self, handle: Handle, warnings: tuple[Diagnostic, ...]) -> None:
        self._handle, self.warnings = handle, warnings

    def _described(self) -> dict[str, Any]:
        found: dict[str, Any] = _native.take_json(lib.sdfc_scene_describe(self._handle.address))
        return found

    @property
    def params(self) -> dict[str, Param]:
        """The params with their values, in order of declaration."""
        return {row["name"]: _param(row) for row in self._described()["params"]}

    @property
    def is_certified(self) -> bool:
        """True if distances never exceed the true distances."""
        return bool(self._described()["certified"])

    @property
    def is_planar(self) -> bool:
        """True if the scene draws regions (2D). Their distances depend on x and y alone."""
        return bool(self._described()["planar"])

    @property
    def bounds(self) -> NDArray[np.float64]:
        """The lowest and the highest corner of a box that contains the surface, of shape (2, 3), in
        scene units; infinite where the scene has no limit."""
        corners = np.empty((2, 3))
        low, high = corners[0].ctypes.data, corners[1].ctypes.data
        _native.check(lib.sdfc_bounds(self._handle.address, low, high))
        return corners

    def at(
        self,
        values: Mapping[str, Value] | None = None,
        *,
        time: float | None = None,
        frame: int | None = None,
        **more: Value,
    ) -> Scene:
        """Returns the scene with other values of params: ``scene.at(radius=0.5)``.

        ``time`` is in seconds, and ``frame`` is an integer; if either is given, the other one is 0
        by default. Params that are not named keep their values. Nothing is compiled.

        Raises :class:`ArgumentError` if there is no such param, if it does not take the value, or
        if it decides what the scene consists of: pass those to :func:`compile`. Also raised if
        ``time`` is not finite or ``frame`` is no integer.
        """
        address = lib.sdfc_scene_copy(self._handle.address)
        scene = Scene(Handle(address, lib.sdfc_scene_free), self.warnings)
        for name, value in {**(values or {}), **more}.items():
            param, handle = _native.text(name), scene._handle.address
            if isinstance(value, numbers.Real) and not isinstance(value, (bool, np.bool_)):
                _native.check(lib.sdfc_set_number(handle, param, float(value)))
            else:
                _native.check(lib.sdfc_set(handle, param, _native.text(_text(value))))
        if time is not None or frame is not None:
            _native.check(lib.sdfc_set_time(scene._handle.address, time or 0.0, frame or 0))
        return scene

    def distance(self, points: ArrayLike) -> NDArray[np.float64]:
        """Returns the signed distances at points, negative inside, in scene units.

        ``points`` has the shape (..., 3), and the result the shape (...): n points give an array
        of shape (n,). All cores share the work. Computed in f64.
        """
        return self._evaluate(points, 1, lib.sdfc_distance)[..., 0]

    def gradient(self, points: ArrayLike) -> NDArray[np.float64]:
        """Returns the gradients of the distance at points.

        ``points`` has the shape (..., 3), and so has the result. A gradient points away from the
        surface outside, has the length 1 if the field is the exact distance, and may have any
        length elsewhere. All cores share the work. Computed in f64.
        """
        return np.ascontiguousarray(self._evaluate(points, 4, lib.sdfc_gradient)[..., :3])

    def _evaluate(self, points: ArrayLike, width: int, call: Any) -> NDArray[np.float64]:
        array = np.ascontiguousarray(points, dtype=np.float64)
        if array.ndim == 0 or array.shape[-1] != 3:
            raise ArgumentError(f"points have the shape (..., 3), not {np.shape(points)}")
        count = array.size // 3
        found = np.empty((*array.shape[:-1], width))
        start, end = array.ctypes.data, found.ctypes.data

        def part(first: int, size: int) -> None:
            _native.check(
                call(self._handle.address, start + 24 * first, size, end + 8 * width * first)
            )

        threads = min(_cores(), -(-count // _CHUNK))
        if threads <= 1:
            part(0, count)
            return found
        # More parts than threads, so that a thread that is slower takes fewer of them.
        size = max(_CHUNK, -(-count // (8 * threads)))
        firsts = range(0, count, size)
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(lambda first: part(first, min(size, count - first)), firsts))
        return found

    def mesh(
        self,
        error: float | None = None,
        *,
        relative: float | None = None,
        max_cells: int | None = None,
        progress: Progress | None = None,
    ) -> Mesh:
        """Makes a closed mesh of the surface, on all cores.

        ``error`` is the greatest distance between mesh and surface, in scene units; ``relative`` is
        the same as a fraction of the longest side of the scene's bounds, by default 0.001.
        ``max_cells`` limits the cells that are examined, by default 50,000,000, which take some
        gigabytes of memory.

        Raises :class:`Error` if the scene has no limit or no inside, and :class:`ArgumentError` if
        the error is too small, or greater than the longest side of the scene's bounds.
        """
        stated = _native.options(error=error, error_relative=relative, max_cells=max_cells)
        call, free = lib.sdfc_mesh_make, lib.sdfc_mesh_free
        return Mesh(_native.run(call, free, self._handle, stated, progress))

    def contour(
        self,
        normal: Sequence[float] = (0.0, 0.0, 1.0),
        offset: float = 0.0,
        *,
        error: float | None = None,
        relative: float | None = None,
        max_cells: int | None = None,
        arcs: bool = False,
        progress: Progress | None = None,
    ) -> Contour:
        """Makes the closed paths around the section by a plane, on all cores.

        The plane has the ``normal``, of any length, and the coordinate ``offset`` along it, in
        scene units. ``error``, ``relative`` and ``max_cells`` are those of :meth:`mesh`.
        With ``arcs``, paths have circular arcs where these need fewer points.

        Raises :class:`ArgumentError` if the plane meets no inside of the scene.
        """
        stated = _native.options(
            normal=list(normal),
            offset=offset,
            error=error,
            error_relative=relative,
            max_cells=max_cells,
            arcs=arcs,
        )
        call, free = lib.sdfc_contour_make, lib.sdfc_contour_free
        return Contour(_native.run(call, free, self._handle, stated, progress))

    def measure(
        self,
        relative: float | None = None,
        *,
        max_cells: int | None = None,
        progress: Progress | None = None,
    ) -> Measurements:
        """Measures volume, center of mass, inertia and extent as proven intervals, on all cores.

        ``relative`` is how exact the volume is, as a fraction of itself, by default 0.001;
        ``max_cells`` limits the boxes that are examined, by default 4,000,000.

        Raises :class:`Error` if the scene has no limit.
        """
        stated = _native.options(error_relative=relative, max_cells=max_cells)
        call, free = lib.sdfc_measure, lib.sdfc_string_free
        found = _native.run(call, free, self._handle, stated, progress)
        return measurements(json.loads(string_at(found.address)))

    def render(
        self,
        size: tuple[int, int] = (640, 360),
        *,
        backend: str = "auto",
        method: str | None = None,
        samples: int | None = None,
        region: tuple[int, int, int, int] | None = None,
        isolines: float | None = None,
        camera: Mapping[str, Any] | None = None,
        progress: Progress | None = None,
    ) -> Picture:
        """Draws the scene.

        ``size`` is width and height in pixels. ``backend`` is ``gpu``, ``cpu``, or ``auto``, which
        takes the CPU if there is no GPU; :attr:`Picture.note` says so. ``method`` is a ray method,
        by default the scene's or ``auto``. ``samples`` is the number of rays per pixel. ``region``
        draws a part of the picture: left, top, width and height in pixels. ``isolines`` is their
        distance in a picture of regions. ``camera`` has the keys ``eye``, ``target`` and ``up``,
        and either ``fov`` (vertical, in radians) or ``height`` (in scene units, for parallel rays);
        by default it is the scene's camera, or one that sees the whole scene.

        Raises :class:`MachineError` if there is no GPU and ``backend`` is ``gpu``.
        """
        stated = _native.options(
            size=list(size),
            backend=backend,
            method=method,
            samples=samples,
            region=region,
            isolines=isolines,
            camera=None if camera is None else dict(camera),
        )
        call, free = lib.sdfc_render, lib.sdfc_picture_free
        return Picture(_native.run(call, free, self._handle, stated, progress))

    def _repr_png_(self) -> bytes:
        return self.render().png()

    def shader(
        self,
        target: str = "wgsl",
        part: str = "field",
        *,
        prefix: str = "sdf_",
        group: int = 0,
        binding: int = 0,
    ) -> Shader:
        """Writes the scene as a shader.

        ``target`` is ``wgsl``, ``glsl``, ``glsl-es``, ``hlsl``, ``msl``, ``spirv`` or
        ``shadertoy``; ``part`` is ``field``, ``march`` or ``render``. Names in the source begin
        with ``prefix``, and the first buffer has the index ``binding`` in ``group``.

        ``group`` and ``binding`` are at most 65535.

        Raises :class:`ArgumentError` for another target, part, group or binding.
        """
        for what, number in (("group", group), ("binding", binding)):
            # ctypes would take the lowest 32 bits.
            if not 0 <= number <= _MAX_BINDING:
                raise ArgumentError(f"`{what}` is {number}; it must be 0 to {_MAX_BINDING}")
        address = lib.sdfc_shader_write(
            self._handle.address,
            _native.text(target),
            _native.text(part),
            _native.text(prefix),
            group,
            binding,
        )
        handle = Handle(address, lib.sdfc_shader_free)
        return Shader(handle, self._handle, target != "spirv")

    def wgsl(self) -> str:
        """Returns the field as WGSL: the functions ``sdf_distance`` and ``sdf_gradient``."""
        return str(self.shader().code)

    def __repr__(self) -> str:
        params = ", ".join(f"{name}={param.value!r}" for name, param in self.params.items())
        return f"<sdfc.Scene: {params or 'no params'}>"


def _cores() -> int:
    """Returns the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
