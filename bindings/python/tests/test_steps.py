"""Monitor and observer row by row, saved and restored anywhere."""

import random

import cylwatch as cw
import numpy as np
import pandas as pd
import pytest
from conftest import VESSEL

KINDS = [(cw.Monitor, cw.monitor), (cw.Observer, cw.estimate)]


def rows_of(log):
    time = "time" if "time" in log else "time_s"
    for row in log.to_dict("records"):
        yield row.pop(time), row


def stepped(steps, rows):
    out = []
    for time, readings in rows:
        out += steps.step(time, readings)["rows"]
    if isinstance(steps, cw.Monitor):
        out += steps.finish()["rows"]
    return out


def same(rows, result):
    frame = pd.DataFrame.from_arrow(result.rows)
    assert len(rows) == len(frame)
    for name in frame:
        if frame[name].dtype == np.float64:
            ours = np.array([np.nan if row[name] is None else row[name] for row in rows])
            assert ours.tobytes() == frame[name].to_numpy().tobytes(), name


@pytest.mark.parametrize("which", ["leak", "dated"])
@pytest.mark.parametrize("kind, whole", KINDS)
def test_steps_are_the_whole_log_to_the_last_bit(kind, whole, which, request):
    log = request.getfixturevalue(which)
    same(stepped(kind(VESSEL), rows_of(log)), whole(VESSEL, log))


@pytest.mark.parametrize("kind, whole", KINDS)
def test_a_stop_at_any_row_changes_no_bit(kind, whole, leak):
    log = leak.iloc[:400].copy()
    # The fill waits for the first pressure: a stop before it, too.
    log.loc[:3, "pressure_bar"] = np.nan
    rows = list(rows_of(log))
    expected = whole(VESSEL, log)
    stops = {0, 1, 2, 4, 5, *random.Random(1).sample(range(6, 400), 12)}
    steps, out = kind(VESSEL), []
    for index, (time, readings) in enumerate(rows):
        if index in stops:
            state = steps.save()
            steps = kind(VESSEL)
            steps.restore(state)
            assert steps.save() == state
        out += steps.step(time, readings)["rows"]
    if kind is cw.Monitor:
        out += steps.finish()["rows"]
    same(out, expected)


def test_events_of_steps_are_those_of_the_whole_log(leak):
    monitor = cw.Monitor(VESSEL)
    events = [event for time, readings in rows_of(leak) for event in monitor.step(time, readings)["events"]]
    events += monitor.finish()["events"]
    assert events == cw.monitor(VESSEL, leak).events and monitor.verdict == "leak"


@pytest.mark.parametrize("kind", [cw.Monitor, cw.Observer])
def test_foreign_and_damaged_states_are_refused_and_change_nothing(kind, leak):
    rows = list(rows_of(leak.iloc[:80]))
    steps = kind(VESSEL)
    for time, readings in rows[:40]:
        steps.step(time, readings)
    state = steps.save()
    other = kind(VESSEL, fill_mass_kg=4.3)
    for bad in (b"", b"no state", state[:-1], state[:200] + bytes([state[200] ^ 1]) + state[201:]):
        with pytest.raises(cw.CylwatchError):
            steps.restore(bad)
    with pytest.raises(cw.CylwatchError):
        other.restore(state)
    assert steps.save() == state


def test_names_and_times_of_steps_are_checked(leak):
    monitor = cw.Monitor(VESSEL)
    monitor.step(0, {"shoulder_degc": 15.0, "pressure_bar": 200.0})
    monitor.step(60, {"pressure_bar": 200.0})
    with pytest.raises(cw.CylwatchError, match="first step"):
        monitor.step(120, {"valve_degc": 15.0})
    with pytest.raises(cw.CylwatchError, match="seconds or dates"):
        monitor.step(pd.Timestamp("2026-01-01", tz="UTC"), {"pressure_bar": 200.0})
    with pytest.raises(cw.CylwatchError, match="no zone"):
        cw.Monitor(VESSEL).step(pd.Timestamp("2026-01-01"), {"pressure_bar": 200.0})
