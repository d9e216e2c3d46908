"""Compiles scenes of signed distance functions: distances, meshes, pictures and shaders.

>>> import sdfc
>>> scene = sdfc.compile("sphere(1) - sphere(0.5)")
>>> float(scene.distance([2, 0, 0]))
1.0
>>> mesh = scene.mesh(error=0.01)
>>> mesh.certificate["is_proven"]
True

Lengths are in scene units, angles in radians, times in seconds. y points up.
"""

from ._native import lib as _lib
from .errors import ArgumentError, CompileError, Diagnostic, Error, MachineError
from .results import Contour, ContourPath, Measurements, Mesh, Picture, Shader
from .scene import Files, Param, Progress, Scene, Value, compile, load

__version__: str = _lib.sdfc_version().decode()

__all__ = [
    "ArgumentError",
    "CompileError",
    "Contour",
    "ContourPath",
    "Diagnostic",
    "Error",
    "Files",
    "MachineError",
    "Measurements",
    "Mesh",
    "Param",
    "Picture",
    "Progress",
    "Scene",
    "Shader",
    "Value",
    "compile",
    "load",
]
