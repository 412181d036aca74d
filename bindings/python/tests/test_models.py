"""identify, calibrate and place are the commands, and what they find goes on."""

import json
import tomllib

import cylwatch as cw
import numpy as np
import pandas as pd
import polars as pl
import pytest
from conftest import ROOT, VESSEL, body, readings

DATE = "2026-03-01T12:00:00Z"


@pytest.fixture(scope="module")
def true_vessel():
    """The 20 L cylinder with a stronger film outside and a weaker one inside than its file says."""
    vessel = tomllib.loads((ROOT / "vessels" / f"{VESSEL}.toml").read_text())
    vessel["surface"]["film_factor"] = 1.3
    vessel["inside_film"]["multiplier"] = 0.77
    return vessel


@pytest.fixture(scope="module")
def courses(true_vessel):
    """A log of the true vessel with its air, a second one, and all columns of the first."""

    def log(scenario, seed):
        rows = pd.DataFrame.from_arrow(cw.simulate(true_vessel, scenario, seed=seed).rows)
        return readings(rows).assign(ambient_degc=rows["ambient_degc"]), rows

    (first, rows), (second, _) = log("tunnel-winter", 0), log("ramp-warm", 1)
    return first, second, rows


def summary_of(path):
    document = json.loads(path.read_text())
    return without_call(document)


def without_call(document):
    """A document without what names the run."""
    return {name: value for name, value in document.items() if name != "provenance"}


def cautions_of(said):
    return [line.removeprefix("caution: ") for line in said.splitlines() if line.startswith("caution: ")]


@pytest.mark.parametrize(
    "options, words",
    [
        ({}, []),
        ({"order": 2, "gain": 1, "validate": 0.3}, ["--order", "2", "--gain", "1", "--validate", "0.3"]),
        ({"method": "compensated-instruments", "input_sd_k": 0.05}, ["--method", "compensated-instruments", "--input-sd-k", "0.05"]),
    ],
)
def test_identify_is_the_command(options, words, courses, tmp_path, command, monkeypatch):
    monkeypatch.chdir(tmp_path)
    courses[2].to_csv("run.csv", index=False)
    asked = ["identify", "run.csv", "--input", "shoulder", "--output", "gas_mean", *words]
    code, said = command(*asked, "-o", "rows.csv")
    assert code == 0, said
    command(*asked, "-o", "model.json")
    result = cw.identify("run.csv", input="shoulder", output="gas_mean", **options)
    assert body(result.to_csv()) == body((tmp_path / "rows.csv").read_text())
    assert without_call(result.summary) == summary_of(tmp_path / "model.json")
    assert result.cautions == cautions_of(said)
    assert (result.exit_code, result.verdict, result.vessel) == (0, None, None)


def test_coefficients_of_identify_have_units_and_intervals(courses):
    result = cw.identify(courses[2], "shoulder_degc", "gas_mean_degc", gain=1)
    found = {one["name"]: one for one in result.summary["coefficients"]}
    lag = found["time constant"]
    assert lag["unit"] == "s" and lag["low"] < lag["value"] < lag["high"] and 250 < lag["value"] < 400
    assert found["denominator a0"]["value"] == pytest.approx(1 / lag["value"])
    # What was held is no estimate.
    assert (found["steady-state gain"]["value"], found["steady-state gain"]["sd"]) == (pytest.approx(1), None)
    assert np.nanmax(abs(result["gas_mean_degc"] - result["model_degc"] - result["error_k"])) < 1e-9
    assert "<svg" in result.to_html() and result._repr_html_().startswith("<iframe") and "time constant" in repr(result)


def test_identify_on_frames_and_a_frame_that_is_held_out_are_those_of_files(courses, tmp_path):
    first, second, _ = courses
    first.to_csv(tmp_path / "first.csv", index=False)
    second.to_csv(tmp_path / "second.csv", index=False)
    of_files = cw.identify(tmp_path / "first.csv", "shoulder", "valve", order=2, validate=tmp_path / "second.csv")
    assert of_files["held_out"].max() == 1
    for convert in (lambda frame: frame, pl.from_pandas, lambda frame: frame.to_dict("series")):
        of_frames = cw.identify(convert(first), "shoulder", "valve", order=2, validate=convert(second))
        for name in of_files.rows.columns:
            assert of_frames[name].tobytes() == of_files[name].tobytes(), name
        assert of_frames.summary["coefficients"] == of_files.summary["coefficients"]
        assert of_frames.summary["held_out"]["name"] == "<validate>"


def test_calibrate_is_the_command(courses, tmp_path, command, monkeypatch):
    monkeypatch.chdir(tmp_path)
    courses[0].to_csv("log.csv", index=False)
    courses[1].to_csv("other.csv", index=False)
    asked = ["calibrate", VESSEL, "log.csv", "--film-w-m2-k", "20", "--fit", "outside-film,wall-capacity", "--prior", "wall-capacity=1,0.05"]
    asked += ["--validate", "other.csv", "--date", DATE]
    code, said = command(*asked, "-o", "new.toml", "--sensors-out", "sensors.toml")
    assert code == 0, said
    told = {kind: command.output(*asked, "--format", kind) for kind in ("csv", "json")}
    result = cw.calibrate(
        VESSEL,
        "log.csv",
        film_w_m2_k=20,
        fit=["outside-film", "wall-capacity"],
        prior={"wall-capacity": (1, 0.05)},
        validate="other.csv",
        date=DATE,
    )
    assert body(result.to_csv()) == body(told["csv"])
    document = json.loads(told["json"])
    assert without_call(result.summary) == without_call(document)
    assert body(result.vessel) == body((tmp_path / "new.toml").read_text())
    assert body(result.sensors) == body((tmp_path / "sensors.toml").read_text())
    assert result.cautions == cautions_of(said)
    # The rows are the parameters of the JSON, to the last bit.
    for name in ("value", "sd", "low", "high", "start"):
        assert result[name].tolist() == [one[name] for one in document["parameters"]], name
    assert result["parameter"].tolist() == [one["parameter"] for one in document["parameters"]]
    assert "<svg" in result.to_html() and "wall-capacity" in repr(result) and result.exit_code == 0


def test_a_calibrated_vessel_goes_on_to_the_monitor(true_vessel, courses):
    found = cw.calibrate(VESSEL, courses[0], scenario="tunnel-winter")
    film = list(found["parameter"]).index("outside-film")
    assert found["low"][film] < 1.3 < found["high"][film] and found["unit"][film] == "1"
    assert tomllib.loads(found.vessel)["surface"]["film_factor"] == pytest.approx(1.3, abs=0.01)
    # Another log of the same cylinder, with the air shut out: nothing leaks, and what was found predicts it better.
    other = readings(pd.DataFrame.from_arrow(cw.simulate(true_vessel, "shock-cold", seed=3).rows))
    before, after = (cw.monitor(vessel, other) for vessel in (VESSEL, found.vessel))
    assert after.verdict != "leak" and len(after) == len(before) and after.to_csv() != before.to_csv()
    with_sensors = cw.monitor(found.vessel, other, sensors=found.sensors)
    assert with_sensors.verdict != "leak" and with_sensors.to_csv() != after.to_csv()


def test_logs_of_calibrate_have_scenarios_vessels_and_held_out_frames_of_their_own(true_vessel, courses, tmp_path):
    first, second, _ = courses
    first.to_csv(tmp_path / "first.csv", index=False)
    second.to_csv(tmp_path / "second.csv", index=False)
    cold = readings(pd.DataFrame.from_arrow(cw.simulate(true_vessel, "shock-cold", seed=3).rows))
    options = {"fit": "outside-film", "relative_tolerance": 1e-8, "date": DATE}
    scenarios = ["tunnel-winter", None, "shock-cold"]
    vessel = tomllib.loads((ROOT / "vessels" / f"{VESSEL}.toml").read_text())
    results = [
        cw.calibrate(VESSEL, logs, scenario=scenarios, vessel_of=[None, vessel], validate=cold, **options)
        for logs in ([first, second], [tmp_path / "first.csv", tmp_path / "second.csv"], [pl.from_pandas(first), tmp_path / "second.csv"])
    ]
    for result in results:
        assert result["value"].tobytes() == results[0]["value"].tobytes()
    assert results[0].summary["logs"] == ["<frame 1>", "<frame 2>"]
    assert results[2].summary["logs"] == ["<frame 1>", str(tmp_path / "second.csv")]
    said = results[0].summary["circumstances"]
    assert "`Tunnel" in said[0] or "scenario" in said[0], said
    assert "air from the column ambient" in said[1] and said[2].startswith("<validate>: scenario"), said
    assert results[0].summary["held_out"]["what"] == "<validate>"
    with pytest.raises(cw.CylwatchError, match="4 entries, and there are 3 logs"):
        cw.calibrate(VESSEL, [first, second], scenario=["none"] * 4, validate=cold, **options)


def test_what_cannot_be_calibrated_comes_with_a_remedy(courses, command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    still = courses[0].assign(**{name: 20.0 + 0.01 * (np.arange(len(courses[0])) % 2) for name in ("shoulder_degc", "valve_degc", "ambient_degc")})
    still = still.assign(pressure_bar=200.0 + 0.001 * (np.arange(len(still)) % 3))
    with pytest.raises(cw.CylwatchError, match="no channel moves") as refused:
        cw.calibrate(VESSEL, still)
    assert refused.value.remedy.startswith("record a change of the ambient")
    still.to_csv("still.csv", index=False)
    _, said = command("calibrate", VESSEL, "still.csv")
    with pytest.raises(cw.CylwatchError) as of_file:
        cw.calibrate(VESSEL, "still.csv")
    assert f"error: {of_file.value}" in said
    with pytest.raises(cw.CylwatchError, match="<frame>: nothing says what the air does") as refused:
        cw.calibrate(VESSEL, courses[0].drop(columns="ambient_degc"))
    assert "--scenario" in refused.value.remedy or "give --map" in str(refused.value)


def test_a_leak_is_asked_about(courses):
    first = courses[0]
    falling = first.assign(pressure_bar=first["pressure_bar"] - 0.02 * np.arange(len(first)))
    found = cw.calibrate(VESSEL, falling, scenario="tunnel-winter", fit="outside-film")
    assert any("looks like a leak of about" in words and "does it leak?" in words for words in found.cautions), found.cautions
    assert found.summary["apparent_leaks"][0]["rate_kg_s"] > 0
    # With the inside film free nothing fits any more.
    with pytest.raises(cw.CylwatchError, match="look like a leak of about") as refused:
        cw.calibrate(VESSEL, falling, scenario="tunnel-winter")
    assert refused.value.remedy == "does it leak?"


SMALL = {"wall_nodes": 2, "scenario": "none", "sensors": 2}
SMALL_WORDS = ["--wall-nodes", "2", "--scenario", "none", "--sensors", "2"]


def test_place_is_the_command(tmp_path, command):
    code, said = command("place", VESSEL, *SMALL_WORDS, "-o", "rows.csv")
    assert code == 0, said
    command("place", VESSEL, *SMALL_WORDS, "-o", "study.json")
    result = cw.place(VESSEL, **SMALL)
    assert body(result.to_csv()) == body((tmp_path / "rows.csv").read_text())
    assert without_call(result.summary) == summary_of(tmp_path / "study.json")
    assert "pressure" in result["layout"][0] and result["sensors"][0] == 2 and (result["gas_sd_k"] > 0).all()
    assert result.summary["best"][0]["names"] == result["layout"][0].split(" + ")
    assert "<svg" in result.to_html() and "Where sensors should sit" in repr(result) and result.exit_code == 0


def test_candidates_and_scenarios_of_place_are_documents(tmp_path):
    text = '[[rule]]\nsensor = "valve"\nstatus = "forbidden"\n'
    (tmp_path / "places.toml").write_text(text)
    ways = (text, tmp_path / "places.toml", {"rule": [{"sensor": "valve", "status": "forbidden"}]})
    results = [cw.place(VESSEL, candidates=candidates, **SMALL) for candidates in ways]
    assert len({body(result.to_csv()) for result in results}) == 1
    assert not any("valve" in layout for layout in results[0]["layout"])
    few = SMALL | {"candidates": {"sensor": [{"name": "shoulder"}, {"name": "pressure"}]}}
    shock = tomllib.loads((ROOT / "scenarios" / "shock-cold.toml").read_text())
    along = [cw.place(VESSEL, **few | {"scenario": scenario}) for scenario in (shock, ["shock-cold", "tunnel-winter"])]
    assert along[0]["course_mean_k_1"].tobytes() == along[1]["course_mean_k_1"].tobytes()
    assert "course_mean_k_2" in along[1].rows.columns and "course_mean_k_2" not in along[0].rows.columns


def test_a_search_that_the_time_ends_has_what_was_found(tmp_path, command):
    result = cw.place(VESSEL, **SMALL, time_limit_s=1e-6)
    code, said = command("place", VESSEL, *SMALL_WORDS, "--time-limit-s", "1e-6", "-o", "rows.csv")
    assert (result.exit_code, code) == (3, 3) and result.summary["partial"] is True
    assert result.cautions == cautions_of(said) == ["the search was ended early: the results are partial"]


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda log: cw.identify(log, "shoulder", "shoulder"), "same column"),
        (lambda log: cw.identify(log, "shoulder", "nowhere"), "no column nowhere"),
        (lambda log: cw.identify(log, "shoulder", "valve", out="x.csv"), "in memory"),
        (lambda log: cw.identify(log, "shoulder", "valve", validate=2.5), "between 0 and 1"),
        (lambda log: cw.identify(5, "shoulder", "valve"), "log is of type int"),
        (lambda log: cw.calibrate(VESSEL, []), "required"),
        (lambda log: cw.calibrate(VESSEL, [log, 5]), "log is of type int"),
        (lambda log: cw.calibrate(VESSEL, log, fit="outside-fil"), "outside-film"),
        (lambda log: cw.calibrate(VESSEL, log, output="new.toml"), "in memory"),
        (lambda log: cw.calibrate(VESSEL, log, sensors_out="new.toml"), "in memory"),
        (lambda log: cw.calibrate(VESSEL, log, prior={"outside-film": {}}), "give a number or a text"),
        (lambda log: cw.place(VESSEL, matrices="m.json"), "in memory"),
        (lambda log: cw.place(VESSEL, criterion="best"), "leak-rate"),
        (lambda log: cw.place(VESSEL, sensors=0), "sensors"),
        (lambda log: cw.place("nitrogen-20"), "nearest is nitrogen-20l"),
    ],
)
def test_wrong_calls_are_refused(call, words, courses):
    with pytest.raises(cw.CylwatchError, match=words) as refused:
        call(courses[0])
    assert hasattr(refused.value, "remedy") and "internal error" not in str(refused.value)
