"""A check-up: which parts of the installation are in order, and the exact remedy for each that is not."""

import ctypes
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib import metadata

from frontend.registration import RegistrationError, load_open3d

# open3d links against these; every desktop has them, a bare server does not.
SYSTEM_LIBRARIES = {"libGL.so.1": "libgl1", "libEGL.so.1": "libegl1", "libX11.so.6": "libx11-6"}
DISTRIBUTIONS = ("gtsam", "numpy", "scipy", "shapely", "filterpy", "numba", "matplotlib", "typer", "rich")
REGISTRATION_DISTRIBUTIONS = ("open3d-cpu", "open3d")


@dataclass(frozen=True)
class Finding:
    """One thing looked at. needed: without it nothing works; otherwise only what `says` names is missing."""

    subject: str
    in_order: bool
    needed: bool
    says: str


def examine() -> list[Finding]:
    """Every finding, the needed ones first."""
    return [_python(), *map(_distribution, DISTRIBUTIONS), _registration(), _system_libraries()]


def missing_system_libraries() -> list[str]:
    """Names of the Debian packages whose libraries cannot be loaded here; empty where open3d brings its own."""
    if not sys.platform.startswith("linux"):
        return []
    return [package for library, package in SYSTEM_LIBRARIES.items() if not _loads(library)]


def install_system_libraries(run: Callable[[list[str]], int]) -> bool:
    """Fetch what is missing by apt if this user may; says whether apt was run. `run`: command to exit code."""
    packages = missing_system_libraries()
    if not packages or os.geteuid() != 0 or shutil.which("apt-get") is None:
        return False
    install = ["apt-get", "install", "--yes", "--quiet", "--no-install-recommends", *packages]
    # A fresh image has no package lists; one that has them is spared the wait.
    if run(install) != 0:
        run(["apt-get", "update", "--quiet"])
        run(install)
    return True


def run_quietly(command: list[str]) -> int:
    """The exit code of a command whose output nobody needs: what is still missing afterwards is said by `examine`."""
    environment = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
    return subprocess.run(command, env=environment, capture_output=True, check=False).returncode


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _python() -> Finding:
    version = ".".join(map(str, sys.version_info[:3]))
    fits = (3, 11) <= sys.version_info[:2] < (3, 15)
    return Finding("Python", fits, True, version if fits else f"{version}, but 3.11 to 3.14 is needed")


def _distribution(name: str) -> Finding:
    try:
        return Finding(name, True, True, metadata.version(name))
    except metadata.PackageNotFoundError:
        return Finding(name, False, True, "not installed: run `make map`, which sets everything up")


def _registration() -> Finding:
    installed = [d for d in metadata.distributions() if d.metadata["Name"] in REGISTRATION_DISTRIBUTIONS]
    if not installed:
        return Finding("open3d", False, False, "not installed: registration will not work, the rest will")
    try:
        load_open3d()
    except RegistrationError as reason:
        return Finding("open3d", False, False, str(reason))
    return Finding("open3d", True, False, installed[0].version)


def _system_libraries() -> Finding:
    packages = missing_system_libraries()
    remedy = f"registration needs them: run `apt-get install {' '.join(packages)}` as root; the rest works without"
    return Finding("libraries of open3d", not packages, False, remedy if packages else "all load")
