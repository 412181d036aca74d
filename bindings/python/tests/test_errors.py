"""What is refused, and how."""

import random
import string

import cylwatch as cw
import numpy as np
import pandas as pd
import pytest
from conftest import VESSEL, interrupted, turns_during


def test_an_error_has_file_line_and_remedy(leak, tmp_path, command):
    path = tmp_path / "log.csv"
    log = leak.copy()
    log.loc[10, "time_s"] = -1e6
    log.to_csv(path, index=False)
    with pytest.raises(cw.CylwatchError) as refused:
        cw.estimate(VESSEL, path)
    error = refused.value
    assert isinstance(error, ValueError)
    assert (error.file, error.line) == (str(path), 12) and error.remedy.startswith("sort the rows")
    _, said = command("estimate", VESSEL, path)
    assert said.strip().removeprefix("error: ") == str(error)
    with pytest.raises(cw.CylwatchError, match="<frame> row 11") as refused:
        cw.estimate(VESSEL, log)
    assert (refused.value.file, refused.value.line) == ("<frame>", 11)


def test_wrong_vessels_options_and_logs_are_refused_with_a_remedy(leak):
    for call, words in [
        (lambda: cw.monitor("nitrogen-20", leak), "nearest is nitrogen-20l"),
        (lambda: cw.monitor(VESSEL, leak, limit_bra=5), "limit-bra"),
        (lambda: cw.monitor(VESSEL, leak, limit_bar=-5), "must be above 0"),
        (lambda: cw.monitor(VESSEL, leak, output="x.csv"), "in memory"),
        (lambda: cw.monitor(VESSEL, leak, state="x"), "in memory"),
        (lambda: cw.monitor("-", leak), "standard input"),
        (lambda: cw.monitor(VESSEL, 5), "Arrow"),
        (lambda: cw.monitor(5, leak), "vessel is of type int"),
        (lambda: cw.monitor(VESSEL, leak, map=3), "no dict"),
        (lambda: cw.monitor(VESSEL, "nowhere.csv"), "cannot be read"),
        (lambda: cw.monitor(VESSEL, leak.rename(columns={"pressure_bar": "pressure"})), "unit"),
        (lambda: cw.monitor(VESSEL, leak.drop(columns="time_s")), "no column of time"),
        (lambda: cw.monitor(VESSEL, leak.assign(pressure_bar=pd.Timestamp("2026-01-01"))), "must have numbers"),
        (lambda: cw.monitor(VESSEL, leak.iloc[:0]), "no row"),
        (lambda: cw.monitor({"name": None}, leak), "vessel"),
        (lambda: cw.simulate(VESSEL, "nothing"), "no such file"),
        (lambda: cw.properties("nitrogen", temperature_degc=15), "two of temperature"),
        (lambda: cw.Observer(VESSEL, smooth=True), "later rows"),
    ]:
        with pytest.raises(cw.CylwatchError, match=words) as refused:
            call()
        assert hasattr(refused.value, "remedy")


def garbage(random_, leak):
    """Something that is no log, or hardly one."""
    columns = ["time_s", "time", "shoulder_degc", "pressure_bar", "pressure_psi", "valve_k", "x", "", "gas_mean_degc", "wall_"]
    values = [
        lambda n: np.array([random_.uniform(-1e3, 1e3) for _ in range(n)]),
        lambda n: np.array([random_.choice([np.nan, np.inf, -np.inf, 0.0, 1e308, -1e-308, 200.0]) for _ in range(n)]),
        lambda n: np.arange(n) * random_.choice([-1, 0, 1, 60, 2**40]),
        lambda n: ["".join(random_.choices(string.printable, k=5)) for _ in range(n)],
        lambda n: pd.Series([random_.choice([None, True, 3, "a"]) for _ in range(n)]).astype(str),
        lambda n: pd.to_datetime(np.array([random_.randrange(-(2**63) + 1, 2**63) for _ in range(n)])),
        lambda n: [None] * n,
        lambda n: np.full(n, random_.random() < 0.5),
        lambda n: 200 + np.arange(n) % 3 * 0.1,
    ]
    n = random_.choice([0, 1, 2, 30, 200])
    chosen = random_.sample(columns, random_.randrange(0, len(columns)))
    return pd.DataFrame({name: random_.choice(values)(n) for name in chosen})


def test_no_input_makes_a_panic(leak):
    random_ = random.Random(23)
    refused = 0
    for _ in range(400):
        call = random_.choice([cw.monitor, cw.estimate])
        options = {random_.choice(["limit_bar", "fill_mass_kg", "step_s", "zone", "x", "map"]): random_.choice([0, -1, 1e300, "é", True, [], {}, None, 5])}
        try:
            call(random_.choice([VESSEL, "argon-5l", "[", "name = 1", {}]), garbage(random_, leak), **options)
        except cw.CylwatchError as error:
            refused += 1
            assert "internal error" not in str(error), error
    assert refused > 200


def test_steps_with_wild_numbers_make_no_panic():
    random_ = random.Random(5)
    wild = [np.nan, np.inf, -np.inf, 1e308, -1e308, 0, 200.0, 15.0, None]
    for kind in (cw.Monitor, cw.Observer):
        steps = kind(VESSEL)
        steps.step(0, {"shoulder_degc": 15.0, "pressure_bar": 200.0})
        for _ in range(300):
            try:
                row = {"shoulder_degc": random_.choice(wild), "pressure_bar": random_.choice(wild)}
                steps.step(random_.choice([*wild[:-1], 60, 120, 1e5]), row)
            except cw.CylwatchError as error:
                assert "internal error" not in str(error), error


def long_log(rows: int) -> pd.DataFrame:
    time_s = 10.0 * np.arange(rows)
    warm = 4 * np.sin(time_s / 13000)
    return pd.DataFrame({"time_s": time_s, "shoulder_degc": 15 + warm, "pressure_bar": 200 + 0.7 * warm})


def test_ctrl_c_ends_a_run():
    log = long_log(3_000_000)
    assert interrupted(lambda: cw.estimate(VESSEL, log), after_s=0.3) < 5


def test_other_threads_run_meanwhile():
    assert turns_during(lambda: cw.estimate(VESSEL, long_log(100_000))) > 20
