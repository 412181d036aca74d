"""Logs for the tests, and the command that results are compared with."""

import json
import os
import signal
import subprocess
import threading
import time
from pathlib import Path

import cylwatch as cw
import pandas as pd
import pytest

# A shell that starts the tests in the background lets them ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(__file__).parents[3]
VESSEL = "nitrogen-20l"


def program() -> Path:
    """The command: $CYLWATCH, or what cargo built."""
    named = os.environ.get("CYLWATCH")
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    places = [Path(named)] if named else [target / kind / "cylwatch" for kind in ("release", "debug")]
    for place in places:
        if place.exists():
            return place
    pytest.skip("the command is not built: cargo build --release")


@pytest.fixture
def command(tmp_path):
    """Runs the command in a folder of its own; hands out exit code and stderr."""

    def done(*arguments):
        return subprocess.run([program(), *map(str, arguments)], cwd=tmp_path, capture_output=True, text=True)

    def run(*arguments):
        ended = done(*arguments)
        return ended.returncode, ended.stderr

    run.output = lambda *arguments: done(*arguments).stdout
    return run


def log_of(scenario: str, seed: int = 7) -> pd.DataFrame:
    """What the sensors of a simulated cylinder read."""
    return readings(pd.DataFrame.from_arrow(cw.simulate(VESSEL, scenario, seed=seed).rows))


def readings(rows: pd.DataFrame) -> pd.DataFrame:
    """A log of what the sensors of a simulation read."""
    names = {name: name.removeprefix("measured_") for name in rows if name.startswith("measured_")}
    return rows[["time_s", *names]].rename(columns=names)


@pytest.fixture(scope="session")
def leak() -> pd.DataFrame:
    """A leak of 60 g/h that opens in a tunnel."""
    return log_of("leak-after-tunnel")


@pytest.fixture(scope="session")
def dated(leak) -> pd.DataFrame:
    """The same with dates of a zone."""
    start = pd.Timestamp("2026-11-25T00:30:00", tz="Europe/Berlin")
    time = start + pd.to_timedelta(leak["time_s"], unit="s")
    return leak.drop(columns="time_s").assign(time=time)


def interrupted(call, after_s):
    """Seconds that a call takes which Ctrl-C ends so long after its beginning."""
    threading.Timer(after_s, os.kill, (os.getpid(), signal.SIGINT)).start()
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        call()
    return time.monotonic() - began


def turns_during(call) -> int:
    """How often this thread has its turn while another one is in a call, which comes to its end."""
    done = threading.Event()

    def run():
        call()
        done.set()

    thread = threading.Thread(target=run)
    thread.start()
    turns = 0
    while thread.is_alive():
        turns += 1
        time.sleep(0.001)
    assert done.is_set()
    return turns


def body(csv: str) -> str:
    """CSV without its comment lines, which name the run."""
    return "".join(line for line in csv.splitlines(keepends=True) if not line.startswith("#"))


def lines(path: Path) -> list:
    """Objects of a file of JSON lines."""
    return [json.loads(line) for line in path.read_text().splitlines()]
