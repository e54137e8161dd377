"""Packs what CMake builds: `make wheel`, or `pip install --no-build-isolation .`, which downloads nothing.

The package has the command, the libraries, the plugins and the libraries of the system that they need in it: drape/_core…so,
drape/bin, drape/lib; pip puts a script before the command on the PATH. DRAPE_BUILD names a folder that is built already; else the preset `package` is built.
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import numpy
import setuptools
import setuptools.command.build_py

SOURCE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(os.environ.get("DRAPE_BUILD", SOURCE / "build-package")).resolve()
# Every Python of this system has these, and a second copy of them would be another library.
SYSTEM = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|z|ssl|crypto|gcc_s|stdc\+\+))\.so")


def bundle(package):
    """Copies the libraries of the system that the package's own need."""
    for library in [*(package / "lib").rglob("*.so"), package / "bin/drape"]:
        listed = subprocess.run(["ldd", library], check=True, capture_output=True, text=True).stdout
        for name, path in re.findall(r"^\s*(\S+) => (/\S+)", listed, re.M):
            if not SYSTEM.match(name) and not (package / "lib" / name).exists():
                shutil.copy(path, package / "lib" / name)


class Build(setuptools.command.build_py.build_py):
    def run(self):
        package = pathlib.Path(self.build_lib).resolve() / "drape"
        build = [] if "DRAPE_BUILD" in os.environ else [
            ["cmake", "--preset", "package", "-B", BUILD, f"-DPython_EXECUTABLE={sys.executable}",
             *shlex.split(os.environ.get("CMAKE_ARGS", ""))],
            ["cmake", "--build", BUILD]]
        for command in [*build, ["cmake", "-E", "rm", "-rf", package], ["cmake", "--install", BUILD, "--prefix", package]]:
            subprocess.run(command, cwd=SOURCE, check=True)
        for file in (package / "lib/python3/dist-packages/drape").iterdir():
            file.rename(package / file.name)
        bundle(package)


class Compiled(setuptools.Distribution):
    def has_ext_modules(self):
        return True


BUILD.mkdir(exist_ok=True)
setuptools.setup(
    version=re.search(r"project\(drape VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1),
    # A pybind11 from before 2.12, as Debian 12's, reads the arrays of numpy 1 alone; the numpy of this Python is one that it reads.
    install_requires=["numpy<2" if numpy.__version__.startswith("1.") else "numpy", "scipy", "pandas"],
    packages=["drape"], package_dir={"drape": "core/app/python/drape"}, scripts=["core/app/python/bin/drape"],
    distclass=Compiled, cmdclass={"build_py": Build},
    options={"build": {"build_base": str(BUILD / "wheel")}, "egg_info": {"egg_base": str(BUILD)}})
