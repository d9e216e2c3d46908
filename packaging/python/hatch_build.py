"""Puts the library into the wheel, and names the platform that it runs on."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = {"win32": "sdfc_capi.dll", "darwin": "libsdfc_capi.dylib"}.get(
    sys.platform, "libsdfc_capi.so"
)


def library() -> Path:
    """Returns the library that SDFC_LIBRARY names, or builds it."""
    if "SDFC_LIBRARY" in os.environ:
        return Path(os.environ["SDFC_LIBRARY"])
    build = ["cargo", "build", "--release", "--locked", "-p", "sdfc-capi"]
    subprocess.run(build, cwd=ROOT, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", "target"))
    return ROOT / target / "release" / LIBRARY


def stripped(binary: Path, folder: str) -> Path:
    """Returns a copy of the library without symbols, which take a fifth of it; on other systems
    than Linux, the library itself."""
    if not sys.platform.startswith("linux") or shutil.which("strip") is None:
        return binary
    small = Path(folder) / binary.name
    subprocess.run(["strip", "--strip-all", "-o", small, binary], check=True)
    return small


def platform(binary: Path) -> str:
    """Returns the platform tag of a wheel with this library.

    On Linux it names the oldest glibc that has all symbols of the library (PEP 600). On macOS it
    names the one architecture of the library, while Python itself may have two.
    """
    if sys.platform == "darwin":
        return f"macosx_11_0_{os.uname().machine}"
    tag = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    versions = re.findall(rb"GLIBC_2\.(\d+)", binary.read_bytes())
    if not sys.platform.startswith("linux") or not versions:
        return tag
    return tag.replace("linux", f"manylinux_2_{max(map(int, versions))}", 1)


class Hook(BuildHookInterface):
    """Builds one wheel per platform, for all versions of Python 3."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        self.folder = tempfile.TemporaryDirectory()
        binary = stripped(library(), self.folder.name)
        build_data["tag"] = f"py3-none-{platform(binary)}"
        build_data["pure_python"] = False
        build_data["force_include"][str(binary)] = f"sdfc/{LIBRARY}"
        for name in ("LICENSE-MIT", "LICENSE-APACHE"):
            build_data["force_include"][str(ROOT / name)] = f"sdfc/{name}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        self.folder.cleanup()
