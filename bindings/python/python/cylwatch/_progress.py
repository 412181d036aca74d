"""How far a fleet is, on stderr: ``cw.fleet(..., progress=True)``."""

import sys


def show(done: int, cylinders: int, rows_per_s: float, left_s: float | None) -> None:
    """Writes a line in place of the last one."""
    left = "" if left_s is None else f", {left_s / 60:.0f} min left" if left_s >= 90 else f", {left_s:.0f} s left"
    end = "\n" if done == cylinders else ""
    print(f"\r{done} of {cylinders} cylinders, {rows_per_s:.0f} rows/s{left}\033[K", end=end, file=sys.stderr, flush=True)
