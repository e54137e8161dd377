"""Waiting for events, with limits of the time that the test and all it started take (tests/support/limited.cpp): a busy machine
shortens none. Without drape_limited there are none."""

import os
import subprocess
import tempfile
import time
from pathlib import Path

CPU = 40 * float(os.environ.get("DRAPE_TEST_SLOWDOWN", 1))  # [s]
IDLE = 40  # [s]


class InVain(Exception):
    pass


def taken():
    """Seconds of processor time and of idle time so far."""
    file = os.environ.get("DRAPE_TEST_TIME")
    return [float(word) for word in Path(file).read_text().split()] if file else [0.0, 0.0]


def wait_until(what, holds, cpu=CPU, idle=IDLE):
    """What `holds` returns at last; raises InVain where that takes longer than the limits."""
    begun, pause = taken(), 0.01
    while not (value := holds()):
        for name, limit, then, now in zip(("processor", "idle"), (cpu, idle), begun, taken()):
            if now - then > limit:
                raise InVain(f"in vain for {limit:g} s of {name} time: {what}")
        time.sleep(pause)
        pause = min(1.5 * pause, 0.1)
    return value


def completed(words, cpu=120, idle=IDLE, **options):
    """As subprocess.run with its output captured; kills the command where it takes longer than the limits."""
    words = [str(word) for word in words]
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=out, stderr=err, **options)
        try:
            wait_until(f"the end of {' '.join(words)[:200]}", lambda: process.poll() is not None, cpu, idle)
        finally:
            process.kill()
            process.wait()
        out.seek(0), err.seek(0)
        return subprocess.CompletedProcess(words, process.returncode, out.read(), err.read())
