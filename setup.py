"""Packs what CMake builds: `make wheel`, or `pip install --no-build-isolation .`, which downloads nothing.

The package has the command, the libraries and the plugins in it: drape/_core…so, drape/bin, drape/lib. It is of this machine:
-march=native, unless CMAKE_ARGS has -DDRAPE_NATIVE=OFF.
"""

import os
import pathlib
import re
import shlex
import subprocess
import sys

import setuptools
import setuptools.command.build_py

SOURCE = pathlib.Path(__file__).resolve().parent
BUILD = SOURCE / "build-wheel"


class Build(setuptools.command.build_py.build_py):
    def run(self):
        package = pathlib.Path(self.build_lib).resolve() / "drape"
        for command in (
            ["cmake", "--preset", "release", "-B", BUILD, "-DDRAPE_PYTHON=ON", "-DDRAPE_TESTS=OFF", "-DDRAPE_BENCHMARKS=OFF",
             f"-DPython_EXECUTABLE={sys.executable}", *shlex.split(os.environ.get("CMAKE_ARGS", ""))],
            ["cmake", "--build", BUILD],
            ["cmake", "-E", "rm", "-rf", package],
            ["cmake", "--install", BUILD, "--prefix", package],
        ):
            subprocess.run(command, cwd=SOURCE, check=True)
        for file in (package / "lib/python3/dist-packages/drape").iterdir():
            file.rename(package / file.name)


class Compiled(setuptools.Distribution):
    def has_ext_modules(self):
        return True


BUILD.mkdir(exist_ok=True)
setuptools.setup(
    version=re.search(r"project\(drape VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1),
    packages=["drape"], package_dir={"drape": "core/app/python/drape"}, distclass=Compiled, cmdclass={"build_py": Build},
    options={"build": {"build_base": str(BUILD / "wheel")}, "egg_info": {"egg_base": str(BUILD)}})
