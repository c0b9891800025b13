"""A check-up: which parts of the installation are in order, and the exact remedy for each that is not."""

import ctypes
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module, metadata
from pathlib import Path

from frontend.registration import RegistrationError, load_open3d

# open3d links against these; every desktop has them, a bare server does not.
SYSTEM_LIBRARIES = {"libGL.so.1": "libgl1", "libEGL.so.1": "libegl1", "libX11.so.6": "libx11-6"}
DISTRIBUTIONS = (
    "gtsam", "numpy", "scipy", "shapely", "filterpy", "numba", "matplotlib", "typer", "rich", "trimesh",
    "starlette", "uvicorn", "websockets", "python-multipart",
)  # fmt: skip
REGISTRATION_DISTRIBUTIONS = ("open3d-cpu", "open3d")
DATA = "ROOMSKETCH_DATA"
DATASETS = Path(__file__).parents[1] / "datasets"


@dataclass(frozen=True)
class Finding:
    """One thing looked at. needed: without it nothing works; otherwise only what `says` names is missing."""

    subject: str
    in_order: bool
    needed: bool
    says: str


@dataclass(frozen=True)
class Extra:
    """What `pip install 'roomsketch[name]'` adds. modules: by the distribution that brings each."""

    name: str
    modules: dict[str, str]
    serves: str


EXTRAS = (
    Extra("ros", {"rosbags": "rosbags.highlevel"}, "ROS bags and MCAP files"),
    Extra("cad", {"ezdxf": "ezdxf"}, "drawings for CAD programs, .dxf"),
    Extra("gis", {"pyogrio": "pyogrio"}, "GeoPackages, .gpkg"),
    Extra("data", {"rtb-data": "rtbdata"}, "a long lidar drive to try, killian.g2o.zip"),
    Extra("docs", {"mkdocs-material": "material", "mkdocstrings": "mkdocstrings"}, "building the documentation"),
)


def examine() -> list[Finding]:
    """Every finding, the needed ones first."""
    needed = [_python(), *map(_distribution, DISTRIBUTIONS)]
    return [*needed, _registration(), _system_libraries(), *map(_extra, EXTRAS), _data_folder(), _own_datasets()]


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


def _extra(extra: Extra) -> Finding:
    """Imported, not only looked up: what is installed may be broken, and its reason is worth more than its version."""
    subject, versions = f"extra [{extra.name}]", []
    for distribution, module in extra.modules.items():
        try:
            versions.append(f"{distribution} {metadata.version(distribution)}")
            import_module(module)
        except metadata.PackageNotFoundError:
            remedy = f"pip install 'roomsketch[{extra.name}]'"
            return Finding(subject, False, False, f"{distribution} is not installed; for {extra.serves}: {remedy}")
        except (ImportError, OSError) as reason:
            broken = f"{distribution} cannot be imported ({reason})"
            remedy = f"pip install --force-reinstall 'roomsketch[{extra.name}]'"
            return Finding(subject, False, False, f"{broken}: {remedy}")
    return Finding(subject, True, False, f"{', '.join(versions)}: {extra.serves}")


def _data_folder() -> Finding:
    """The folder of recordings from elsewhere: tests and benchmarks read it where it is named."""
    named = os.environ.get(DATA)
    if named is None:
        lacks = "not set, so tests and benchmarks on recordings from elsewhere are left out"
        return Finding(DATA, False, False, f"{lacks}; export {DATA}=FOLDER to have them run")
    return _folder_of_recordings(DATA, Path(named), f"export {DATA}=FOLDER with the folder that holds them")


def _own_datasets() -> Finding:
    remedy = "take them from the project's repository, or make them by `roomsketch simulate`"
    return _folder_of_recordings("datasets", DATASETS, remedy)


def _folder_of_recordings(subject: str, folder: Path, remedy: str) -> Finding:
    if not folder.is_dir():
        return Finding(subject, False, False, f"{folder} is no folder: {remedy}")
    held = sorted(path.name for path in folder.iterdir() if path.is_dir())
    if not held:
        return Finding(subject, False, False, f"{folder} holds no folder of recordings: {remedy}")
    return Finding(subject, True, False, f"{folder}: {', '.join(held)}")
