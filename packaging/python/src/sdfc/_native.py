"""The C interface of sdfc: the functions of ``sdfc.h``, and its errors as exceptions.

``ctypes`` releases the global interpreter lock while a function of the library runs.
"""

from __future__ import annotations

import ctypes
import json
import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor, wait
from ctypes import (
    CFUNCTYPE,
    POINTER,
    byref,
    c_char_p,
    c_double,
    c_int,
    c_size_t,
    c_uint32,
    c_uint64,
    c_void_p,
    string_at,
)
from pathlib import Path
from typing import Any, Callable

import numpy as np

from .errors import ArgumentError, Error, MachineError

READ = CFUNCTYPE(c_int, c_void_p, c_char_p, c_void_p)
PROGRESS = CFUNCTYPE(c_int, c_void_p, c_uint64, c_uint64)

OK, NULL, NOT_UTF8, ARGUMENT, SCENE, INTERNAL, MACHINE, STOPPED = range(8)

_COUNT = POINTER(c_size_t)
_LONG_CALL = [c_void_p, c_char_p, PROGRESS, c_void_p]

# The result and the arguments of each function, as in sdfc.h. A string that the caller frees is a
# c_void_p, because ctypes copies a c_char_p and forgets its address.
_FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "sdfc_version": (c_char_p, []),
    "sdfc_error": (c_char_p, []),
    "sdfc_error_status": (c_int, []),
    "sdfc_string_free": (None, [c_void_p]),
    "sdfc_bytes_data": (c_void_p, [c_void_p, _COUNT]),
    "sdfc_bytes_free": (None, [c_void_p]),
    "sdfc_file_give": (c_int, [c_void_p, c_char_p, c_size_t]),
    "sdfc_compile_with_values": (
        c_void_p,
        [c_char_p, c_char_p, c_size_t, c_char_p, READ, c_void_p, POINTER(c_void_p)],
    ),
    "sdfc_scene_copy": (c_void_p, [c_void_p]),
    "sdfc_scene_describe": (c_void_p, [c_void_p]),
    "sdfc_scene_free": (None, [c_void_p]),
    "sdfc_set": (c_int, [c_void_p, c_char_p, c_char_p]),
    "sdfc_set_number": (c_int, [c_void_p, c_char_p, c_double]),
    "sdfc_set_time": (c_int, [c_void_p, c_double, c_double]),
    "sdfc_distance": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p]),
    "sdfc_gradient": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p]),
    "sdfc_bounds": (c_int, [c_void_p, c_void_p, c_void_p]),
    "sdfc_shader_write": (c_void_p, [c_void_p, c_char_p, c_char_p, c_char_p, c_uint32, c_uint32]),
    "sdfc_shader_code": (c_void_p, [c_void_p, _COUNT]),
    "sdfc_shader_reflection": (c_char_p, [c_void_p]),
    "sdfc_shader_uniform": (c_int, [c_void_p, c_void_p, c_void_p, c_size_t, _COUNT]),
    "sdfc_shader_free": (None, [c_void_p]),
    "sdfc_mesh_make": (c_void_p, _LONG_CALL),
    "sdfc_mesh_vertices": (c_void_p, [c_void_p, _COUNT]),
    "sdfc_mesh_normals": (c_void_p, [c_void_p, _COUNT]),
    "sdfc_mesh_colors": (c_void_p, [c_void_p, _COUNT]),
    "sdfc_mesh_triangles": (c_void_p, [c_void_p, _COUNT]),
    "sdfc_mesh_describe": (c_char_p, [c_void_p]),
    "sdfc_mesh_write": (c_void_p, [c_void_p, c_char_p]),
    "sdfc_mesh_free": (None, [c_void_p]),
    "sdfc_measure": (c_void_p, _LONG_CALL),
    "sdfc_contour_make": (c_void_p, _LONG_CALL),
    "sdfc_contour_describe": (c_char_p, [c_void_p]),
    "sdfc_contour_write": (c_void_p, [c_void_p, c_char_p]),
    "sdfc_contour_free": (None, [c_void_p]),
    "sdfc_render": (c_void_p, _LONG_CALL),
    "sdfc_picture_size": (c_int, [c_void_p, POINTER(c_uint32), POINTER(c_uint32)]),
    "sdfc_picture_rgba": (c_void_p, [c_void_p]),
    "sdfc_picture_depths": (c_void_p, [c_void_p]),
    "sdfc_picture_describe": (c_char_p, [c_void_p]),
    "sdfc_picture_png": (c_void_p, [c_void_p]),
    "sdfc_picture_free": (None, [c_void_p]),
}


def _load() -> Any:
    """Loads the library beside this file, or the one that ``SDFC_LIBRARY`` names."""
    names = {"win32": "sdfc_capi.dll", "darwin": "libsdfc_capi.dylib"}
    beside = Path(__file__).with_name(names.get(sys.platform, "libsdfc_capi.so"))
    library = ctypes.CDLL(os.environ.get("SDFC_LIBRARY") or str(beside))
    for name, (result, arguments) in _FUNCTIONS.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


lib = _load()


def text(value: str) -> bytes:
    """Converts a string to a C string, which cannot hold null characters."""
    if "\0" in value:
        raise ArgumentError(f"{value!r} has a null character")
    return value.encode("utf-8", "surrogatepass")


def options(**values: object) -> bytes:
    """Converts options to JSON, without those that are None."""
    stated = {name: value for name, value in values.items() if value is not None}
    try:
        return json.dumps(stated, allow_nan=False, default=_plain).encode()
    except ValueError:
        raise ArgumentError(f"the options have a number that is not finite: {stated}") from None


def _plain(value: Any) -> object:
    """Converts arrays and scalars of NumPy to lists and numbers."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"an option cannot be a {type(value).__name__}: {value!r}")


def error() -> Error:
    """Returns the error of this thread's last call as an exception."""
    message = lib.sdfc_error().decode()
    kinds = {ARGUMENT: ArgumentError, NOT_UTF8: ArgumentError, MACHINE: MachineError}
    return kinds.get(lib.sdfc_error_status(), Error)(message)


def check(status: int) -> None:
    """Raises the error of a call that returned a status."""
    if status != OK:
        raise error()


def take_json(address: int | None) -> Any:
    """Parses a JSON string that the caller frees, and frees it."""
    if address is None:
        raise error()
    try:
        return json.loads(string_at(address))
    finally:
        lib.sdfc_string_free(address)


def take_bytes(address: int | None) -> bytes:
    """Copies a file that the caller frees, and frees it."""
    if address is None:
        raise error()
    try:
        length = c_size_t()
        data = lib.sdfc_bytes_data(address, byref(length))
        return string_at(data, length.value)
    finally:
        lib.sdfc_bytes_free(address)


class Handle:
    """An object of the library, which is freed together with this one."""

    __slots__ = ("_free", "address")

    def __init__(self, address: int | None, free: Callable[[int], None]) -> None:
        self.address = address or 0
        if address is None:
            raise error()
        self._free = free

    def __del__(self) -> None:
        if self.address:
            self._free(self.address)


class _Memory:
    """Memory of an object of the library, which lives as long as an array shows it."""

    def __init__(self, owner: Handle, address: int, shape: tuple[int, ...], dtype: str) -> None:
        self.owner = owner
        self.__array_interface__ = {
            "data": (address, True),
            "shape": shape,
            "typestr": np.dtype(dtype).str,
            "version": 3,
        }


def view(owner: Handle, address: int, shape: tuple[int, ...], dtype: str) -> np.ndarray[Any, Any]:
    """Returns a read-only array that shows memory of the library, without a copy."""
    if 0 in shape:
        empty: np.ndarray[Any, Any] = np.empty(shape, dtype)
        empty.setflags(write=False)
        return empty
    return np.asarray(_Memory(owner, address, shape, dtype))


def run(
    call: Callable[..., int | None],
    free: Callable[[int], None],
    scene: Handle,
    stated: bytes,
    progress: Callable[[int, int], object] | None,
) -> Handle:
    """Runs a long call. Ctrl-C, or an exception of ``progress``, stops it."""
    raised: list[BaseException] = []
    is_stopped = threading.Event()

    def report(_context: object, done: int, total: int) -> int:
        if is_stopped.is_set():
            return 1
        try:
            if progress is not None:
                progress(done, total)
        except BaseException as exception:
            raised.append(exception)
            return 1
        return 0

    def work() -> Handle:
        address = call(scene.address, stated, PROGRESS(report), None)
        made = Handle(address, free) if address or not raised else None
        if raised or made is None:
            raise raised[0]
        return made

    if threading.current_thread() is not threading.main_thread():
        return work()
    # Python tells the main thread of signals, and an exception that one raises in a callback of C
    # would be lost. So the main thread only waits.
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(work)
        try:
            # Windows would not tell a thread that waits without a limit of Ctrl-C.
            while not wait([future], timeout=0.1).done:
                pass
            return future.result()
        finally:
            is_stopped.set()
