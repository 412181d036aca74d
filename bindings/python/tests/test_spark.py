"""On Spark: a batch, a stream and the command give the same, and a stream that is killed goes on as if it had not been."""

import csv
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import cylwatch as cw
import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from conftest import ROOT, VESSEL, log_of

pyspark = pytest.importorskip("pyspark", reason="PySpark is not installed: pip install './bindings/python[spark]'")
if not (shutil.which("java") or os.environ.get("JAVA_HOME")):
    pytest.skip("there is no Java: install a JRE 17", allow_module_level=True)

from cylwatch import spark as cws  # noqa: E402
from pyspark.sql import SparkSession  # noqa: E402
from pyspark.sql import functions as F  # noqa: E402

FILL = {"fill_pressure_bar": 200, "fill_temperature_degc": 15}
LATENESS_S = 600
SLICES = 16
KILLS = 10
CONF = {
    "spark.master": "local[2]",
    "spark.sql.shuffle.partitions": "2",
    "spark.sql.session.timeZone": "Europe/Berlin",
    "spark.ui.enabled": "false",
    "spark.ui.showConsoleProgress": "false",
    "spark.driver.host": "127.0.0.1",
    "spark.driver.bindAddress": "127.0.0.1",
    "spark.driver.extraJavaOptions": "-XX:TieredStopAtLevel=1",
    cws.PROVIDER: cws.ROCKSDB,
}
os.environ["PYSPARK_PYTHON"] = sys.executable


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    builder = SparkSession.builder.config("spark.sql.warehouse.dir", str(tmp_path_factory.mktemp("warehouse")))
    for name, value in CONF.items():
        builder = builder.config(name, value)
    session = builder.getOrCreate()
    session.sparkContext.setLogLevel("ERROR")
    yield session
    session.stop()


@pytest.fixture(scope="module")
def logs() -> dict[str, pd.DataFrame]:
    """Logs by cylinder: leaking and tight, every 10 s, 60 s and irregularly; one that cannot be read, one without a vessel."""
    leak, tunnel, cold = log_of("leak-after-tunnel"), log_of("tunnel-winter", 2), log_of("shock-cold", 3)
    thinned = leak.iloc[np.sort(np.random.default_rng(4).choice(len(leak), 500, replace=False))]
    return {
        "leak": leak,
        "tight/1": tunnel,
        "cold": cold,
        "irregular": thinned.reset_index(drop=True),
        "late": leak.iloc[::6].reset_index(drop=True),
        "bad": tunnel.assign(pressure_bar=0.0),
        "nameless": cold.iloc[:5],
    }


@pytest.fixture(scope="module")
def vessels(logs) -> pd.DataFrame:
    table = pd.DataFrame({"cylinder": [name for name in logs if name != "nameless"], "vessel": VESSEL})
    for name, value in FILL.items():
        table[name] = [None if cylinder == "bad" else value for cylinder in table["cylinder"]]
    return table.assign(lateness_s=[LATENESS_S if name == "late" else None for name in table["cylinder"]])


@pytest.fixture(scope="module")
def fleet(logs, vessels, tmp_path_factory):
    """What `cylwatch fleet` says: events by cylinder, bytes of states, cylinders with errors."""
    from conftest import program

    folder = tmp_path_factory.mktemp("fleet")
    for name, log in logs.items():
        path = folder / "logs" / f"cylinder={name.replace('/', '%2F')}"
        path.mkdir(parents=True)
        log.to_csv(path / "log.csv", index=False)
    vessels.to_csv(folder / "fleet.csv", index=False)
    words = ["fleet", "logs", "--vessels", "fleet.csv", "-o", "out", "--format", "csv"]
    subprocess.run([program(), *words], cwd=folder, capture_output=True, check=False)
    tables = {}
    for table in ("events", "errors"):
        text = (folder / "out" / f"{table}.csv").read_text().splitlines(keepends=True)
        tables[table] = list(csv.DictReader(line for line in text if not line.startswith("#")))
    states = {path.stem.replace("%2F", "/"): path.read_bytes() for path in (folder / "out" / "states").iterdir()}
    return tables["events"], {row["cylinder"] for row in tables["errors"]}, states


@pytest.fixture(scope="module")
def files(logs, tmp_path_factory):
    """The logs as files of slices of time. A cylinder's rows are spread over two files, so that they come from two partitions; those of `late` come
    up to the lateness late, one in five twice."""
    folder = tmp_path_factory.mktemp("files")
    random_ = np.random.default_rng(5)
    parts = []
    for name, log in logs.items():
        arrives_s = log["time_s"].to_numpy(copy=True)
        if name == "late":
            arrives_s[1:] += random_.uniform(0, 0.9 * LATENESS_S, len(log) - 1)
            twice = random_.random(len(log)) < 0.2
            again_s = log["time_s"][twice] + random_.uniform(0, 0.9 * LATENESS_S, twice.sum())
            log, arrives_s = pd.concat([log, log[twice]]), np.concatenate([arrives_s, again_s])
        slices = np.minimum(SLICES * (arrives_s - arrives_s[0]) / (log["time_s"].max() - arrives_s[0]), SLICES - 1)
        parts.append(log.assign(cylinder=name, slice=slices.astype(int), half=random_.integers(0, 2, len(log))))
    parts.append(pd.DataFrame({"time_s": [0.0], "shoulder_degc": [15.0], "pressure_bar": [200.0], "cylinder": [None], "slice": [3], "half": [0]}))
    rows = pd.concat(parts).sample(frac=1, random_state=6)
    for (slice_, half), part in rows.groupby(["slice", "half"]):
        path = folder / f"{slice_:02}-{half}.parquet"
        pq.write_table(pa.Table.from_pandas(part.drop(columns=["slice", "half"]), preserve_index=False), path)
        # The source takes files by their age.
        os.utime(path, (1.7e9 + slice_, 1.7e9 + slice_))
    return folder


@pytest.fixture(scope="module")
def batch(session, files, vessels):
    told = cws.monitor(session.read.parquet(str(files)), vessels, rows=True)
    return {row.cylinder: row for row in told.collect()}


def streamed(session, files, vessels, folder, **options):
    """Runs a stream to its end; rows of its sink and states of its checkpoint."""
    schema = session.read.parquet(str(files)).schema
    source = session.readStream.schema(schema).option("maxFilesPerTrigger", 2).parquet(str(files))
    writer = cws.monitor(source, vessels, **options).writeStream.format("parquet")
    query = writer.option("checkpointLocation", f"{folder}/checkpoint").trigger(availableNow=True).start(f"{folder}/told")
    query.awaitTermination()
    return sink(session, folder)


def sink(session, folder):
    told = session.read.parquet(f"{folder}/told").collect()
    return told, {row.cylinder: bytes(row.state) for row in cws.states(session, f"{folder}/checkpoint").collect()}


def events(rows, cylinder):
    """Events of a cylinder as a fleet writes them; micro-batches have no order in a sink."""
    found = [event.asDict() for row in rows if row.cylinder == cylinder for event in row.events]
    return sorted(found, key=lambda event: (event["time_s"], event["line"]))


def bits(rows):
    """Rows with all bits of their numbers, by time."""
    return [[np.float64(cell).tobytes() if isinstance(cell, float) else cell for cell in row] for row in sorted(rows, key=lambda row: row.time_s)]


def state_file(vessels, cylinder, state):
    """The bytes of the command's state file from those of a stepping monitor."""
    row = vessels.set_index("cylinder").loc[cylinder].dropna().to_dict()
    monitor = cw.Monitor(row.pop("vessel"), **row)
    monitor.restore(state)
    return monitor.state_file()


def test_a_batch_is_the_fleet_event_for_event_and_byte_for_byte(batch, fleet, vessels, logs):
    told, errors, states = fleet
    assert errors | {None} == {"bad", "nameless", None} == {name for name, row in batch.items() if row.error}
    assert batch["bad"].error.line == 1 and "reads nothing" in batch["bad"].error.reason and batch["bad"].error.remedy
    assert "not in the table of vessels" in batch["nameless"].error.reason and "name no cylinder" in batch[None].error.reason
    assert batch["bad"].verdict is None and batch["bad"].state is None and not batch["bad"].events
    for name in set(logs) - errors:
        expected = [{key: row[key] for key in ("time_s", "time", "event", "id", "words", "line")} for row in told if row["cylinder"] == name]
        expected = [row | {"time_s": float(row["time_s"]), "time": row["time"] or None} for row in expected]
        assert sorted(expected, key=lambda event: (event["time_s"], event["line"])) == events(batch.values(), name), name
        # The command unites doubled rows as it reads; here the monitor does and counts them.
        if name != "late":
            assert state_file(vessels, name, bytes(batch[name].state)) == states[name], name
    assert batch["leak"].verdict == "leak" and any(events(batch.values(), "leak"))


def test_a_batch_has_the_rows_of_a_monitor_on_the_same_log(batch, logs):
    for name in ("leak", "tight/1", "irregular"):
        expected = pa.table(cw.Monitor(VESSEL, **FILL).steps(logs[name])["rows"])
        assert len(batch[name].rows) == expected.num_rows > 100
        for column in expected.column_names:
            ours = [row[column] for row in batch[name].rows]
            theirs = expected[column].to_pylist()
            assert [np.float64(x).tobytes() if isinstance(x, float) else x for x in ours] == [
                np.float64(x).tobytes() if isinstance(x, float) else x for x in theirs
            ], column


def test_a_stream_is_the_batch_event_for_event_and_byte_for_byte(session, files, vessels, batch, tmp_path):
    told, states = streamed(session, files, vessels, tmp_path, rows=True)
    assert len({row.cylinder for row in told}) == len(batch)
    for name, whole in batch.items():
        mine = [row for row in told if row.cylinder == name]
        if whole.error:
            assert all(row.error for row in mine) and name not in states
            continue
        assert len(mine) > SLICES // 2 and not any(row.error for row in mine)
        assert events(mine, name) == events([whole], name)
        # Of the rows that came late and twice, too.
        assert bits(row for one in mine for row in one.rows) == bits(whole.rows), name
        if name != "late":
            assert states[name] == bytes(whole.state), name


def test_a_batch_goes_on_as_a_batch_and_as_a_stream_with_other_partitions(session, files, vessels, batch, tmp_path):
    later = tmp_path / "later"
    later.mkdir()
    first = [str(path) for path in sorted(files.iterdir()) if path.name < "08"]
    for path in files.iterdir():
        if path.name >= "08":
            shutil.copy2(path, later)
    session.conf.set("spark.sql.shuffle.partitions", 3)
    begun = cws.monitor(session.read.parquet(*first), vessels).select("cylinder", "state", "events").persist()
    assert begun.count() == len(batch)
    session.conf.set("spark.sql.shuffle.partitions", 2)
    known = begun.where("state is not null").drop("events")
    went_on = {row.cylinder: row for row in cws.monitor(session.read.parquet(str(later)), vessels, states=known).collect()}
    _, states = streamed(session, later, vessels, tmp_path, states=known)
    for name, whole in batch.items():
        if not whole.error and name != "late":
            assert bytes(went_on[name].state) == states[name] == bytes(whole.state), name
            assert events([*begun.collect(), went_on[name]], name) == events([whole], name)


def test_dates_are_those_of_the_command_in_the_zone_of_the_session(session, logs, tmp_path):
    start = pd.Timestamp("2026-10-25T00:30:00", tz="Europe/Berlin")
    log = logs["leak"].drop(columns="time_s").assign(time=start + pd.to_timedelta(logs["leak"]["time_s"], unit="s"))
    expected = cw.monitor(VESSEL, log, **FILL)
    monitor = cw.Monitor(VESSEL, **FILL)
    monitor.steps(log)
    pq.write_table(pa.Table.from_pandas(log.assign(cylinder="A").sample(frac=1, random_state=1), preserve_index=False), tmp_path / "log.parquet")
    (told,) = cws.monitor(session.read.parquet(str(tmp_path / "log.parquet")), VESSEL, rows=True, **FILL).collect()
    assert bytes(told.state) == monitor.save()
    assert [event.line for event in told.events] and {event.time for event in told.events} <= {event["time"] for event in expected.events}
    # Through the hour that comes twice.
    assert [row.time.timestamp() for row in told.rows] == [t.timestamp() for t in pa.table(monitor_rows(log))["time"].to_pylist()]


def monitor_rows(log):
    return cw.Monitor(VESSEL, **FILL).steps(log)["rows"]


def test_what_is_wrong_with_a_whole_table_is_refused_at_once(session, vessels):
    good = session.createDataFrame([("A", 0.0, 15.0, 200.0)], "cylinder string, time_s double, shoulder_degc double, pressure_bar double")
    for frame, of, options, words in [
        (good.drop("cylinder"), VESSEL, {}, "no column cylinder"),
        (good.drop("time_s"), VESSEL, {}, "0 columns of time"),
        (good.withColumn("time_h", F.lit(1.0)), VESSEL, {}, "2 columns of time"),
        (good.withColumn("site", F.lit("x")), VESSEL, {}, "site is of type string"),
        (good.withColumnRenamed("time_s", "time"), VESSEL, {}, "time is of type double"),
        (good, "nitrogen-20", {}, "nearest is nitrogen-20l"),
        (good, VESSEL, {"limit_bra": 5}, "limit-bra"),
        (good, vessels.assign(limit_bra=5), {}, "limit-bra"),
        (good, pd.concat([vessels, vessels]), {}, "stands twice"),
        (good, vessels.iloc[:0], {}, "has no row"),
        (good, vessels.drop(columns="vessel"), {}, "fill in both"),
        (good, 5, {}, "type int"),
        (good, VESSEL, {"order_by": "offset"}, "no column offset"),
    ]:
        with pytest.raises(cw.CylwatchError, match=words) as refused:
            cws.monitor(frame, of, **options)
        assert refused.value.remedy
    session.conf.unset(cws.PROVIDER)
    try:
        with pytest.raises(cw.CylwatchError, match="RocksDB"):
            cws.monitor(session.readStream.format("rate").load().selectExpr("'A' cylinder", "double(value) time_s", "15D shoulder_degc"), VESSEL)
    finally:
        session.conf.set(cws.PROVIDER, cws.ROCKSDB)


def test_rows_without_a_time_are_told_and_the_others_are_used(session):
    rows = [("A", 0.0, 15.0, 200.0), ("A", None, 15.0, 200.0), ("A", 60.0, 15.0, 200.0)]
    frame = session.createDataFrame(rows, "cylinder string, time_s double, shoulder_degc double, pressure_bar double")
    (told,) = cws.monitor(frame, VESSEL, step_s=0).collect()
    assert "1 of 3" in told.error.reason and told.error.remedy == "give each row its time" and told.row.time_s == 60.0


def test_the_blocks_of_the_chapter_run(session, tmp_path, capsys):
    from test_book import blocks

    found, names = blocks("book/src/spark.md"), {}
    assert len(found) == 2
    for block in found:
        # A relative path counts from where the JVM was started.
        block = block.replace('"logs"', f'"{tmp_path}/logs"').replace('"fleet/', f'"{tmp_path}/fleet/')
        exec(compile(block, "spark.md", "exec"), names)
        assert "leak_found" in capsys.readouterr().out.replace("-", "_")


def example(files, vessels, folder) -> subprocess.Popen:
    """The example job in a session of its own."""
    submit = " ".join(f"--conf '{name}={value}'" for name, value in CONF.items())
    words = [ROOT / "bindings/python/examples/spark_files.py", files, vessels, folder, "--files", "2"]
    environment = os.environ | {"PYSPARK_SUBMIT_ARGS": f"{submit} pyspark-shell"}
    log = open(folder / "log.txt", "a")  # noqa: SIM115
    return subprocess.Popen([sys.executable, *words], env=environment, stdout=log, stderr=log, start_new_session=True)


def kill(job: subprocess.Popen) -> None:
    """Kills all processes of a session: Python, the JVM, and the workers, which have a group of their own."""
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
            if int(fields[3]) == job.pid:
                os.kill(int(stat.parent.name), signal.SIGKILL)
        except (FileNotFoundError, ProcessLookupError):
            pass
    job.wait()


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes of a session are found by /proc")
def test_a_stream_that_is_killed_ten_times_tells_everything_once(session, files, vessels, batch, tmp_path):
    vessels.to_csv(tmp_path / "fleet.csv", index=False)
    begun = tmp_path / "checkpoint" / "offsets"
    random_ = random.Random(8)

    def batches():
        return len([path for path in begun.glob("[0-9]*")]) if begun.exists() else 0

    for number in range(KILLS):
        before, job = batches(), example(files, tmp_path / "fleet.csv", tmp_path)
        # One in five is killed while it starts, the others in or after a micro-batch that they begin.
        if number % 5 == 2:
            time.sleep(random_.uniform(0.5, 6))
        else:
            while batches() == before and job.poll() is None:
                time.sleep(0.02)
            time.sleep(random_.uniform(0, 1.5))
        assert job.poll() is None, (tmp_path / "log.txt").read_text()[-2000:]
        kill(job)
    assert 0 < batches() < SLICES
    job = example(files, tmp_path / "fleet.csv", tmp_path)
    assert job.wait() == 0, (tmp_path / "log.txt").read_text()[-2000:]
    told, states = sink(session, tmp_path)
    for name, whole in batch.items():
        mine = [row for row in told if row.cylinder == name]
        assert len(mine) <= batches() <= SLICES and bool(whole.error) == any(row.error for row in mine)
        assert events(mine, name) == events([whole], name), name
        if not whole.error and name != "late":
            assert states[name] == bytes(whole.state), name
            assert max(row.row.time_s for row in mine) == whole.rows[-1].time_s
