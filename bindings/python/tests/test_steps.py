"""Monitor and observer row by row, saved and restored anywhere."""

import json
import random

import cylwatch as cw
import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
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


@pytest.mark.parametrize("which", ["leak", "dated"])
def test_steps_by_tables_are_steps_by_rows(which, request):
    log = request.getfixturevalue(which)
    single, tables = cw.Monitor(VESSEL, limit_bar=150), cw.Monitor(VESSEL, limit_bar=150)
    events, lines, frames = [], [], []
    for part in (log[:1], pl.from_pandas(log[1:300]), pa.Table.from_pandas(log[300:], preserve_index=False)):
        told = tables.steps(part)
        lines += [event["line"] for event in told["told"]]
        frames.append(pd.DataFrame.from_arrow(told["rows"]))
        assert list(told["told"][0]) == ["time_s", "time", "event", "id", "words", "line"] if told["told"] else True
    rows = stepped_with(single, rows_of(log), events)
    assert [json.loads(line) for line in lines] == events and len(events) > 2
    assert tables.save() == single.save() and tables.state_file() == single.state_file() is not None
    frame = pd.concat(frames)
    for name in frame:
        if frame[name].dtype == np.float64:
            ours = np.array([np.nan if row[name] is None else row[name] for row in rows])
            assert ours.tobytes() == frame[name].to_numpy().tobytes(), name
    last = cw.Monitor(VESSEL, limit_bar=150).steps(log, rows=False)
    assert len(last["rows"]) == 1 and last["rows"]["mass_kg"][0] == rows[-1]["mass_kg"]
    assert [event["line"] for event in last["told"]] == lines


def stepped_with(monitor, rows, events):
    out = []
    for time, readings in rows:
        told = monitor.step(time, readings)
        out += told["rows"]
        events += told["events"]
    return out


def test_a_table_that_steps_cannot_take_is_refused(leak):
    for table, words in [
        (leak.drop(columns="time_s"), "no column of time"),
        (leak.assign(site="x"), "site has texts"),
        (leak.assign(time_s=np.nan), "row 1: there is no time"),
        (leak.assign(time=pd.Timestamp("2026-01-01")), "no zone"),
    ]:
        with pytest.raises(cw.CylwatchError, match=words) as refused:
            cw.Monitor(VESSEL).steps(table)
        assert refused.value.remedy
