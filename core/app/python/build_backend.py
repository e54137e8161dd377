"""Builds the wheel (PEP 517) with CMake alone: `pip install --no-build-isolation .` downloads nothing.

The wheel holds the package with the command, the libraries and the plugins in it: drape/_core…so, drape/bin,
drape/lib. It is of this machine: -march=native, unless CMAKE_ARGS has -DDRAPE_NATIVE=OFF.
"""

import base64
import hashlib
import os
import pathlib
import re
import shlex
import subprocess
import sys
import sysconfig
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[3]
BUILD = SOURCE / "build-wheel"


def _version() -> str:
    return re.search(r"project\(drape VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)


def _tag() -> str:
    interpreter = "cp%d%d" % sys.version_info[:2]
    return f"{interpreter}-{interpreter}-" + re.sub("[^A-Za-z0-9]", "_", sysconfig.get_platform())


def _metadata() -> str:
    return (f"Metadata-Version: 2.1\nName: drape\nVersion: {_version()}\n"
            "Summary: Progressive cloth quasistatics\nLicense: GPL-3.0-or-later\nRequires-Python: >=3.9\n"
            "Requires-Dist: numpy\nRequires-Dist: scipy\n"
            "Provides-Extra: plots\nRequires-Dist: matplotlib; extra == 'plots'\n"
            "Provides-Extra: tables\nRequires-Dist: pandas; extra == 'tables'\n")


def _install(package: pathlib.Path) -> None:
    """Configures, builds and installs into `package`, which becomes the Python package."""
    subprocess.run(
        ["cmake", "--preset", "release", "-B", BUILD, "-DDRAPE_PYTHON=ON", "-DDRAPE_PYTHON_DIR=.", "-DDRAPE_TESTS=OFF",
         "-DDRAPE_BENCHMARKS=OFF", f"-DPython_EXECUTABLE={sys.executable}",
         *shlex.split(os.environ.get("CMAKE_ARGS", ""))], cwd=SOURCE, check=True)
    subprocess.run(["cmake", "--build", BUILD], check=True)
    subprocess.run(["cmake", "-E", "rm", "-rf", package], check=True)
    subprocess.run(["cmake", "--install", BUILD, "--prefix", package], check=True)


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = BUILD / "wheel" / "drape"
    _install(package)
    name = f"drape-{_version()}-{_tag()}.whl"
    info = f"drape-{_version()}.dist-info"
    files = {f"drape/{file.relative_to(package).as_posix()}": (file.read_bytes(), file.stat().st_mode)
             for file in sorted(package.rglob("*")) if file.is_file()}
    wheel = f"Wheel-Version: 1.0\nGenerator: drape\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
    files[f"{info}/METADATA"] = (_metadata().encode(), 0o100644)
    files[f"{info}/WHEEL"] = (wheel.encode(), 0o100644)
    record = ""
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, (content, mode) in files.items():
            entry = zipfile.ZipInfo(path)
            entry.external_attr = mode << 16  # the command stays executable
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            record += f"{path},sha256={digest},{len(content)}\n"
        archive.writestr(f"{info}/RECORD", record + f"{info}/RECORD,,\n")
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise RuntimeError("drape is built from its git repository; there is no source distribution")
