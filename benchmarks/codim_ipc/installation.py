#!/usr/bin/python3
"""The Codim-IPC that its user has built, in the folder that the environment's CODIM_IPC names. Run, it says what is missing."""

import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ASK = ("set CODIM_IPC to the folder of Codim-IPC (https://github.com/ipc-sim/Codim-IPC), built by its own instructions, which leave "
       "build/JGSL*.so and have Python/Drivers")


class Missing(Exception):
    pass


def python_path():
    """The folders of the module JGSL and of the package Drivers, for PYTHONPATH; raises Missing. They may be one folder."""
    if not os.environ.get("CODIM_IPC"):
        raise Missing(ASK)
    root = pathlib.Path(os.environ["CODIM_IPC"]).resolve()
    folders = []
    for subfolder, pattern in (("build", "JGSL*.so"), ("Python", "Drivers/__init__.py")):
        found = [folder for folder in (root / subfolder, root) if list(folder.glob(pattern))]
        if not found:
            raise Missing(f"{root} has no {subfolder}/{pattern}; {ASK}")
        folders.append(str(found[0]))
    return ":".join(folders)


def check():
    """Raises Missing where a scene cannot be simulated; returns the path."""
    path = python_path()
    tried = subprocess.run([HERE / "simulate", "--check"], env={**os.environ, "PYTHONPATH": path}, stdin=subprocess.DEVNULL,
                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if tried.returncode:
        raise Missing(f"{os.environ['CODIM_IPC']}: {(tried.stderr.strip() or 'its module ended Python').splitlines()[-1]}")
    return path


if __name__ == "__main__":
    try:
        check()
    except Missing as fault:
        sys.exit(str(fault))
