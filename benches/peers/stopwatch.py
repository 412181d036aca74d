"""CPU time of a call: repetitions of batches after a warm-up.

Load of the machine lengthens it less than wall time.
"""

import json
import sys
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

BATCH_S = 5e-4
BUDGET_S = 0.4
REPETITIONS = 5

Timing = dict[str, float]
Results = dict[str, Any]


def measure(run: Callable[[], object], parts: int = 1, repetitions: int = REPETITIONS) -> Timing:
    """Times of one of the `parts` equal parts that a call of `run` consists of, s."""

    def timed(calls: int) -> float:
        start = time.process_time()
        for _ in range(calls):
            run()
        return time.process_time() - start

    calls = 1
    while timed(calls) < BATCH_S:
        calls *= 2
    begin = time.perf_counter()
    batches: list[float] = []
    while len(batches) < repetitions or time.perf_counter() - begin < BUDGET_S:
        batches.append(timed(calls) / (calls * parts))
    return quartiles(batches)


def quartiles(batches: list[float]) -> Timing:
    """Smallest, quartiles and number of times."""
    ordered = sorted(batches)

    def quantile(q: float) -> float:
        return ordered[round(q * (len(ordered) - 1))]

    return {
        "minimum_s": quantile(0.0),
        "lower_s": quantile(0.25),
        "median_s": quantile(0.5),
        "upper_s": quantile(0.75),
        "repetitions": len(ordered),
    }


def main(case: Callable[[Any, bool], Results], packages: list[str]) -> None:
    """Run a case on the file of inputs and print its results; the word `first` asks for more than times."""
    inputs = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    results = case(inputs, "first" in sys.argv[2:])
    results["versions"] = {name: metadata.version(name) for name in packages}
    print(json.dumps(results))
