"""Waiting for events, on a machine that may be slow or busy."""

import time

DEADLINE = 600  # [s], many times what any takes


class InVain(Exception):
    pass


def wait_until(what, holds):
    """What `holds` returns at last; raises InVain after the deadline."""
    end = time.monotonic() + DEADLINE
    while not (value := holds()):
        if time.monotonic() > end:
            raise InVain(f"in vain for {DEADLINE} s: {what}")
        time.sleep(0.05)
    return value
