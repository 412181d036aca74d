"""A fleet is the command's, and what it writes is read by others."""

import os

import cylwatch as cw
import duckdb
import polars as pl
import pyarrow as pa
import pytest
from conftest import VESSEL, interrupted, turns_during

FILL = {"fill_pressure_bar": 200, "fill_temperature_degc": 15}


@pytest.fixture
def logs(leak, dated, tmp_path, monkeypatch):
    """Four cylinders in a folder beside their file of vessels: a log in CSV, one in Parquet, two in one log; a fifth has none."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "logs").mkdir()
    leak.to_csv("logs/A.csv", index=False)
    pl.from_pandas(dated).write_parquet("logs/B.parquet", compression="snappy")
    both = [leak.head(100 + 50 * k).assign(cylinder=name) for k, name in enumerate("CD")]
    pl.concat(map(pl.from_pandas, both)).write_csv("logs/site.csv")
    rows = "".join(f"{name},{VESSEL},200,15\n" for name in "ABCDE")
    (tmp_path / "fleet.csv").write_text("cylinder,vessel,fill_pressure_bar,fill_temperature_degc\n" + rows)
    return tmp_path


def content(folder):
    """Everything in a folder that is not hidden."""
    files = (path for path in folder.rglob("*") if path.is_file() and "/." not in str(path))
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def test_the_folder_is_the_command_s_to_the_last_byte(logs, command):
    (logs / "logs/B.parquet").unlink()
    result = cw.fleet("logs", "out", vessels="fleet.csv", format="csv", rows=True, threads=1)
    ours = content(logs / "out")
    assert "states/C.state" in ours and "rows/A.csv" in ours and "page.html" in ours
    for path in sorted((logs / "out").rglob("*"), reverse=True):
        path.unlink() if path.is_file() else path.rmdir()
    code, said = command("fleet", "logs", "--output=out", "--vessels=fleet.csv", "--format=csv", "--rows")
    assert (code, result.exit_code) == (1, 1), said
    theirs = content(logs / "out")
    assert ours.keys() == theirs.keys()
    assert [name for name in ours if ours[name] != theirs[name]] == []
    assert len(result) == 5 and result.page.samefile(logs / "out" / "page.html")


def test_duckdb_and_polars_read_what_the_tables_say(logs):
    result = cw.fleet("logs", "out", vessels="fleet.csv")
    assert result.summary["cylinder"][0] in "AB" and set(result.summary["cylinder"]) == set("ABCDE")
    assert pl.DataFrame(result.errors)["cylinder"].to_list() == ["E"]
    assert pl.DataFrame(result.events).height > 2
    for name in ("summary", "events", "errors"):
        ours = pa.table(getattr(result, name))
        if name == "events":
            ours = ours.drop_columns(["time"])
        path = f"out/{name}.parquet"
        columns = ", ".join(ours.column_names)
        read = duckdb.sql(f"select {columns} from '{path}'").fetchall()
        assert read == pl.read_parquet(path).select(ours.column_names).rows(), name
        assert read == list(zip(*(column.to_pylist() for column in ours.columns))), name
    query = "select cylinder, count(*) from 'out/events.parquet' group by all order by all"
    counts = dict(zip(result.summary["cylinder"], result.summary["events"]))
    assert duckdb.sql(query).fetchall() == sorted((k, n) for k, n in counts.items() if n)


def test_a_log_in_parquet_is_the_log_in_csv(leak, dated, tmp_path):
    for log in (leak, dated):
        pl.from_pandas(log).write_parquet(tmp_path / "log.parquet", compression="snappy")
        read = cw.monitor(VESSEL, tmp_path / "log.parquet", **FILL)
        assert pa.table(read.rows).equals(pa.table(cw.monitor(VESSEL, pl.from_pandas(log), **FILL).rows).cast(pa.table(read.rows).schema))


def test_a_second_night_goes_on(logs, leak):
    (logs / "logs/A.csv").write_text(leak.head(200).to_csv(index=False))
    first = cw.fleet("logs", "out", vessels="fleet.csv")
    leak.to_csv("logs/A.csv", index=False)
    second = cw.fleet("logs", "out", vessels="fleet.csv")
    whole = cw.fleet("logs", "whole", vessels="fleet.csv")
    assert pl.DataFrame(second.summary).equals(pl.DataFrame(whole.summary))
    assert pl.DataFrame(second.events).equals(pl.DataFrame(whole.events))
    assert not pl.DataFrame(first.summary).equals(pl.DataFrame(whole.summary))


def long_logs(leak, cylinders=40):
    rows = pl.from_pandas(leak)
    last = rows["time_s"].max() + 60
    long = pl.concat([rows.with_columns(pl.col("time_s") + k * last) for k in range(40)])
    os.remove("logs/B.parquet"), os.remove("logs/site.csv"), os.remove("logs/A.csv")
    for k in range(cylinders):
        long.write_csv(f"logs/L{k}.csv")


def test_ctrl_c_ends_a_run_and_the_same_call_does_the_rest(logs, leak):
    long_logs(leak)
    assert interrupted(lambda: cw.fleet("logs", "out", vessel=VESSEL), after_s=0.5) < 5
    assert not (logs / "out/summary.parquet").exists()
    # A signal ends one run, not those after it.
    assert len(cw.fleet("logs", "out", vessel=VESSEL)) == 40


def test_progress_counts_the_cylinders_and_is_shown(logs, capfd):
    seen = []
    cw.fleet("logs", "out", vessels="fleet.csv", progress=lambda *so_far: seen.append(so_far))
    done, cylinders, rows_per_s, left_s = seen[-1]
    assert (done, cylinders, left_s) == (4, 4, 0.0) and rows_per_s > 0
    assert [so_far[0] for so_far in seen] == sorted({so_far[0] for so_far in seen})
    assert capfd.readouterr().err == ""
    cw.fleet("logs", "again", vessels="fleet.csv", progress=True)
    assert "\r4 of 4 cylinders, " in capfd.readouterr().err
    with pytest.raises(ZeroDivisionError):
        cw.fleet("logs", "third", vessels="fleet.csv", progress=lambda *so_far: 1 / 0)
    with pytest.raises(cw.CylwatchError, match="give True or a callable"):
        cw.fleet("logs", "fourth", vessels="fleet.csv", progress=3)


def test_other_threads_run_meanwhile(logs, leak):
    long_logs(leak, cylinders=8)
    assert turns_during(lambda: cw.fleet("logs", "out", vessel=VESSEL, threads=1)) > 20


def test_what_is_wrong_is_refused_with_file_line_and_remedy(logs):
    (logs / "fleet.csv").write_text("cylinder,vessel\nA,nitrogen-20\n")
    with pytest.raises(cw.CylwatchError, match="nearest is nitrogen-20l") as refused:
        cw.fleet("logs", "out", vessels=logs / "fleet.csv")
    assert (refused.value.file, refused.value.line) == (str(logs / "fleet.csv"), 2) and refused.value.remedy
    for call, words in [
        (lambda: cw.fleet("logs", "out"), "--vessels"),
        (lambda: cw.fleet("nowhere", "out", vessel=VESSEL), "cannot be read"),
        (lambda: cw.fleet("logs", "fleet.csv", vessel=VESSEL), "is a file"),
        (lambda: cw.fleet("logs", "out", vessel=VESSEL, sensors={"sensor": []}), "give its path"),
        (lambda: cw.fleet("logs", "out", vessel=VESSEL, quiet=True), "command line"),
        (lambda: cw.fleet("logs", "out", vessel=VESSEL, threads=0), "at least 1"),
    ]:
        with pytest.raises(cw.CylwatchError, match=words):
            call()
