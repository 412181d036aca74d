"""Every number is the command's."""

import json

import cylwatch as cw
import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest
from conftest import VESSEL, body, lines


@pytest.mark.parametrize("which", ["leak", "dated"])
def test_monitor_on_a_frame_is_the_command_on_its_csv(which, request, tmp_path, command):
    log = request.getfixturevalue(which)
    log.to_csv(tmp_path / "log.csv", index=False)
    code, _ = command("monitor", VESSEL, "log.csv", "-o", "rows.csv", "--events", "events.jsonl", "--limit-bar", 150)
    command("monitor", VESSEL, "log.csv", "-o", "rows.json", "--limit-bar", 150)
    result = cw.monitor(VESSEL, log, limit_bar=150)
    assert body(result.to_csv()) == body((tmp_path / "rows.csv").read_text())
    assert result.events == lines(tmp_path / "events.jsonl")
    assert result.summary | {"cautions": 0} == json.loads((tmp_path / "rows.json").read_text())["summary"] | {"cautions": 0}
    assert (result.exit_code, result.verdict) == (code, "leak")


@pytest.mark.parametrize("options", [{}, {"smooth": True}, {"settled": True, "fill_mass_kg": 4.48}])
def test_estimate_on_a_frame_is_the_command_on_its_csv(options, leak, tmp_path, command):
    leak.to_csv(tmp_path / "log.csv", index=False)
    words = []
    for name, value in options.items():
        words += [f"--{name.replace('_', '-')}"] + ([] if value is True else [str(value)])
    code, said = command("estimate", VESSEL, "log.csv", "-o", "est.csv", *words)
    assert code == 0, said
    result = cw.estimate(VESSEL, leak, **options)
    assert body(result.to_csv()) == body((tmp_path / "est.csv").read_text())
    assert (result.verdict, result.exit_code, result.events) == (None, 0, [])


def test_simulate_is_the_command(tmp_path, command):
    command("simulate", VESSEL, "shock-cold", "--seed", 3, "-o", "run.csv")
    assert body(cw.simulate(VESSEL, "shock-cold", seed=3).to_csv()) == body((tmp_path / "run.csv").read_text())


def test_properties_are_the_command_to_its_16_digits(tmp_path, command):
    command("properties", "nitrogen", "--temperature-degc", 15, "--pressure-bar", 200, "-o", "p.json", "--format", "json")
    columns = json.loads((tmp_path / "p.json").read_text())["columns"]
    ours = cw.properties("nitrogen", temperature_degc=15, pressure_bar=200)
    assert {name: float(f"{value:.15e}") for name, value in ours.items()} == {n: v[0] for n, v in columns.items()}


@pytest.mark.parametrize("which", ["leak", "dated"])
@pytest.mark.parametrize("call", [cw.monitor, cw.estimate])
def test_all_ways_into_memory_give_the_same_bits(call, which, request, tmp_path):
    log = request.getfixturevalue(which)
    log.to_csv(tmp_path / "log.csv", index=False)
    results = [
        call(VESSEL, log),
        call(VESSEL, pl.from_pandas(log)),
        call(VESSEL, pa.Table.from_pandas(log, preserve_index=False)),
        call(VESSEL, pa.Table.from_pandas(log, preserve_index=False).to_reader(max_chunksize=7)),
        call(VESSEL, tmp_path / "log.csv"),
        call(VESSEL, str(tmp_path / "log.csv")),
    ]
    first = pa.table(results[0].rows)
    for other in results[1:]:
        table = pa.table(other.rows)
        assert table.column_names == first.column_names
        for name in first.column_names:
            if pa.types.is_floating(first[name].type):
                bits = [t[name].combine_chunks().to_numpy(zero_copy_only=False).tobytes() for t in (first, table)]
                assert bits[0] == bits[1], name
            elif name != "time" :
                assert table[name].equals(first[name]), name
            else:
                assert table[name].cast(pa.timestamp("ns", "UTC")).equals(first[name].cast(pa.timestamp("ns", "UTC")))
    assert all(other.events[0]["id"] == results[0].events[0]["id"] for other in results if other.events)


def test_rows_go_into_every_frame_and_into_numpy(dated):
    result = cw.monitor(VESSEL, dated)
    frame = pd.DataFrame.from_arrow(result.rows)
    polars = pl.DataFrame(result.rows)
    arrow = pa.table(result.rows)
    assert list(frame) == polars.columns == arrow.column_names == result.rows.columns
    assert len(frame) == len(polars) == len(arrow) == len(result) > 100
    mass = result["mass_kg"]
    assert mass.dtype == np.float64 and mass.tobytes() == frame["mass_kg"].to_numpy().tobytes()
    assert frame["time"].dt.tz is not None and str(frame["time"].dt.tz) == "Europe/Berlin"
    assert (result["time"] == frame["time"].dt.tz_convert("UTC").dt.tz_localize(None).to_numpy()).all()
    assert result["verdict"][-1] == "leak"
    with pytest.raises(KeyError, match="mass_kg"):
        result["mass_g"]


def test_dates_are_told_in_the_zone_of_the_frame_through_the_hour_that_comes_twice(leak):
    start = pd.Timestamp("2026-10-25T00:30:00", tz="Europe/Berlin")
    log = leak.drop(columns="time_s").assign(time=start + pd.to_timedelta(leak["time_s"], unit="s"))
    result = cw.monitor(VESSEL, log)
    csv = result.to_csv()
    # The same hour of the clock, once in summer time and once in winter time.
    assert ",2026-10-25T02:30" in csv and "+02:00," in csv and "+01:00," in csv
    assert (np.diff(result["time"]) > np.timedelta64(0)).all()
    assert body(cw.monitor(VESSEL, leak).to_csv()).count("\n") == body(csv).count("\n")


def test_missing_values_and_other_types_mean_what_they_mean_in_a_file(leak, tmp_path):
    log = leak.copy()
    log.loc[5:40, "shoulder_degc"] = np.nan
    log.to_csv(tmp_path / "log.csv", index=False)
    texts = log.astype({"pressure_bar": str})
    whole = log.astype({"time_s": "int64"})
    expected = cw.monitor(VESSEL, tmp_path / "log.csv").to_csv()
    for other in (log, texts, whole, pl.from_pandas(log, nan_to_null=True)):
        assert body(cw.monitor(VESSEL, other).to_csv()) == body(expected)


def test_a_vessel_is_a_name_a_path_a_text_or_a_dict(leak, tmp_path):
    import tomllib

    from conftest import ROOT

    path = ROOT / "vessels" / f"{VESSEL}.toml"
    text = path.read_text()
    results = [cw.monitor(vessel, leak).to_csv() for vessel in (VESSEL, path, text, tomllib.loads(text))]
    assert len({body(result) for result in results}) == 1


def test_foreign_names_are_mapped(leak):
    foreign = leak.rename(columns={"shoulder_degc": "T1", "pressure_bar": "P"})
    mapped = cw.monitor(VESSEL, foreign, map={"shoulder_degc": "T1", "pressure_bar": "P"})
    assert body(mapped.to_csv()) == body(cw.monitor(VESSEL, leak).to_csv())


def test_a_notebook_shows_a_page_with_the_figure(leak):
    result = cw.monitor(VESSEL, leak)
    page = result.to_html()
    assert page.startswith("<!DOCTYPE html>") and "<svg" in page and "leak" in page
    assert result._repr_html_().startswith("<iframe srcdoc=") and "verdict" in repr(result)
