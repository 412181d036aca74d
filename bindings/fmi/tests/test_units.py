"""Plant and monitor step by step, against the program, and their states."""

import math

import pytest
from conftest import FILL, READINGS, STEP_S, cylwatch, inputs, scenario, table

STEPS = 120
TIGHT = {"start_temperature_k": 275.0, "relative_tolerance": 1e-12}


def begun(unit, **parameters):
    return unit("plant", **parameters, **inputs(0))


def set_all(one, values):
    for name, value in values.items():
        one.set(name, value)


def same(one, other):
    """Bit by bit; NaN is NaN."""
    return one.keys() == other.keys() and all(
        a == b or (math.isnan(a) and math.isnan(b)) for a, b in zip(one.values(), other.values())
    )


def ran(plant, steps, first=0):
    """Outputs at the beginning of each step."""
    rows = []
    for step in range(first, first + steps):
        set_all(plant, inputs(step))
        rows.append(plant.all())
        plant.step(STEP_S * step)
    return rows


@pytest.fixture(scope="session")
def simulated(tmp_path_factory):
    """The same by the program."""
    folder = tmp_path_factory.mktemp("simulated")
    (folder / "scenario.toml").write_text(scenario(STEPS))
    cylwatch(folder, "simulate", "nitrogen-20l", "scenario.toml", "-o", "run.csv", "--relative-tolerance", "1e-12")
    return folder, table(folder / "run.csv")


def test_the_plant_goes_as_simulate(unit, simulated):
    _, theirs = simulated
    ours = ran(begun(unit, **TIGHT), STEPS)
    pairs = {
        "gas_mean_k": ("gas_mean_degc", 1.0, 273.15),
        "pressure_pa": ("pressure_bar", 1e5, 0.0),
        "mass_kg": ("mass_kg", 1.0, 0.0),
        "valve_k": ("valve_degc", 1.0, 273.15),
        "measured_shoulder_k": ("measured_shoulder_degc", 1.0, 273.15),
        "measured_valve_k": ("measured_valve_degc", 1.0, 273.15),
        "measured_pressure_pa": ("measured_pressure_bar", 1e5, 0.0),
    }
    worst = 0.0
    for name, (column, factor, zero) in pairs.items():
        for row, text in zip(ours, theirs[column]):
            value = float(text) * factor + zero
            worst = max(worst, abs(row[name] / value - 1.0))
    print(f"plant and simulate, relative: {worst:.1e}")
    assert worst < 1e-9


def test_wired_together_they_say_what_simulate_and_monitor_say(unit, simulated):
    folder, _ = simulated
    cylwatch(folder, "monitor", "nitrogen-20l", log(folder), *FILL, "-o", "rows.csv")
    theirs = table(folder / "rows.csv")
    plant, monitor = begun(unit, **TIGHT), unit("monitor")
    said = []
    for step in range(STEPS):
        set_all(plant, inputs(step))
        for name in READINGS:
            monitor.set(name, plant.get(f"measured_{name}"))
        plant.step(STEP_S * step)
        monitor.step(STEP_S * step)
        # Of the first row nothing is said before the second one is there.
        if monitor.get("rows") > 0:
            said.append({**monitor.all(), "word": monitor.word("verdict")})
    times = [float(time) for time in theirs["time_s"]]
    assert len(said) >= STEPS - 2
    pairs = [("mass_kg", "mass_kg", 1.0, 0.0, 1e-6), ("gas_mean_k", "gas_mean_degc", 1.0, -273.15, 1e-4)]
    pairs += [("pressure_15_degc_pa", "p15_bar", 1e-5, 0.0, 1e-5), ("mass_sd_kg", "mass_sd_g", 1e3, 0.0, 1e-4)]
    for row in said:
        at = times.index(row["row_time_s"])
        assert row["word"].replace("_", " ") == theirs["verdict"][at], at
        for name, column, factor, zero, digits in pairs:
            # Both files are rounded to their decimals, the log and what is said of it.
            assert abs(row[name] * factor + zero - float(theirs[column][at])) <= 1.01 * digits, (at, name)


def log(folder):
    """The readings of the run as a log."""
    run = table(folder / "run.csv")
    columns = ["time_s", "measured_shoulder_degc", "measured_valve_degc", "measured_pressure_bar"]
    lines = [",".join(name.removeprefix("measured_") for name in columns)]
    lines += [",".join(cells) for cells in zip(*(run[name][:STEPS] for name in columns))]
    (folder / "log.csv").write_text("\n".join(lines) + "\n")
    return "log.csv"


@pytest.mark.parametrize("kind", ["plant", "monitor"])
def test_from_a_state_on_the_same_bits_come(unit, kind):
    def advance(one, step):
        if kind == "plant":
            set_all(one, inputs(step))
        else:
            readings = (281.0 + math.sin(step / 9.0), 281.5 + math.sin(step / 8.0), 195e5 - 1e3 * step)
            set_all(one, dict(zip(READINGS, readings)))
        one.step(STEP_S * step)
        return one.all()

    one = unit(kind)
    for step in range(5):
        advance(one, step)
    state = one.unit.getFMUState()
    bytes_ = bytes(one.unit.serializeFMUState(state))
    first = [advance(one, step) for step in range(5, 12)]
    # Back in the same instance.
    one.unit.setFMUState(state)
    again = [advance(one, step) for step in range(5, 12)]
    assert all(map(same, first, again))
    # And in another one, by bytes.
    other = unit(kind)
    copy = other.unit.deserializeFMUState(bytes_)
    other.unit.setFMUState(copy)
    assert all(map(same, first, (advance(other, step) for step in range(5, 12))))
    assert bytes(other.unit.serializeFMUState(copy)) == bytes_
    # A damaged or foreign one is refused, and said.
    for changed in (bytes_[:-1], bytes_[:50] + b"x" + bytes_[51:], b""):
        with pytest.raises(Exception):
            other.unit.deserializeFMUState(changed)
    assert other.said
    with pytest.raises(Exception):
        unit("monitor" if kind == "plant" else "plant").unit.deserializeFMUState(bytes_)
    one.unit.freeFMUState(state)
    other.unit.freeFMUState(copy)


def test_steps_may_have_any_length(unit):
    small, large = begun(unit, relative_tolerance=1e-9), begun(unit, relative_tolerance=1e-9)
    now_s = 0.0
    for step_s in (0.5, 7.25, 52.25, 240.0, 3300.0):
        small.step(now_s, step_s)
        now_s += step_s
    large.step(0.0, 3600.0)
    assert abs(small.get("gas_mean_k") - large.get("gas_mean_k")) < 1e-5
    small.step(3600.0)


def test_a_run_may_begin_at_any_time(unit):
    plant = unit("plant", start_s=1e6)
    refuses(plant, ["at 1000000 s"], lambda: plant.step(0.0))
    plant.step(1e6)
    plant.step(1e6 + STEP_S)
    if not plant.is_2:
        assert plant.get("time") == 1e6 + 2 * STEP_S


def test_a_leak_by_its_bore_loses_mass_and_none_keeps_it(unit):
    plant = unit("plant")
    filled = plant.get("mass_kg")
    plant.step(0.0)
    assert plant.get("mass_kg") == pytest.approx(filled, rel=1e-12)
    plant.set("leak_bore_m", 0.2e-3)
    outflow = plant.get("outflow_kg_s")
    plant.step(STEP_S)
    # Choked nitrogen at 200 bar through 0.2 mm: about 1.2 g/s per 1e5 Pa and cm2.
    assert 0.5e-3 < outflow < 2e-3
    assert plant.get("mass_kg") == pytest.approx(filled - outflow * STEP_S, rel=1e-2)


def refuses(one, words, work):
    one.said.clear()
    with pytest.raises(Exception):
        work()
    assert one.said and all(word in one.said[-1] for word in words), one.said


def test_what_is_not_possible_is_refused_with_its_reason(unit):
    plant, monitor = unit("plant"), unit("monitor")
    refuses(plant, ["air_k = -5", "60", "1500"], lambda: plant.set("air_k", -5.0))
    refuses(plant, ["air_k = NaN"], lambda: plant.set("air_k", math.nan))
    refuses(plant, ["mass_kg cannot be set", "output"], lambda: plant.set("mass_kg", 1.0))
    refuses(plant, ["before the first step"], lambda: plant.set("fill_pressure_pa", 1e7))
    refuses(plant, ["step of 60 s from 30 s", "at 0 s"], lambda: plant.step(30.0))
    refuses(plant, ["positive"], lambda: plant.step(0.0, 0.0))
    refuses(plant, ["positive"], lambda: plant.step(0.0, math.nan))
    get = plant.unit.getReal if plant.is_2 else plant.unit.getFloat64
    refuses(plant, ["no variable 9999"], lambda: get([9999]))
    verdict = monitor.variables["verdict"].valueReference
    get = monitor.unit.getReal if monitor.is_2 else monitor.unit.getFloat64
    refuses(monitor, [f"no variable {verdict} of type real"], lambda: get([verdict]))
    # Nothing of it has changed anything.
    plant.step(0.0)


def test_a_null_pointer_and_something_else_are_no_instances(unit):
    from ctypes import c_double, c_uint32, create_string_buffer, byref

    one = unit("plant")
    library = one.unit.dll
    name = "fmi2GetReal" if one.is_2 else "fmi3GetFloat64"
    get = getattr(library, name)
    reference, value = c_uint32(1), c_double()
    more = () if one.is_2 else (1,)
    for wrong in (None, create_string_buffer(64)):
        assert get(wrong, byref(reference), 1, byref(value), *more) == 3
    assert get(one.unit.component if one.is_2 else one.unit.component, None, 1, byref(value), *more) == 3
    assert get(one.unit.component, byref(reference), 1, None, *more) == 3


def test_readings_that_never_come_are_missing_and_the_end_says_what_was_held_back(unit):
    monitor = unit("monitor")
    for step in range(5):
        monitor.step(STEP_S * step)
    rows = monitor.get("rows")
    assert monitor.word("verdict") == "unknown"
    monitor.unit.terminate()
    assert monitor.get("rows") == 5 >= rows


def test_a_reset_begins_again(unit):
    plant = begun(unit)
    before = plant.all()
    plant.step(0.0)
    plant.unit.reset()
    if plant.is_2:
        plant.unit.setupExperiment(startTime=0.0)
        plant.unit.enterInitializationMode()
    else:
        plant.unit.enterInitializationMode(startTime=0.0)
    set_all(plant, inputs(0))
    plant.unit.exitInitializationMode()
    assert same(plant.all(), before)
