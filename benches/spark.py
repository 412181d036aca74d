#!/usr/bin/env python3
"""Measure `cylwatch.spark` on two cores against `cylwatch fleet --threads 2`, both from Parquet into Parquet, and a stream.

Run it with the Python of an environment that has the package, PySpark and pyarrow, as `bindings/python/test` leaves one behind where there
is Java 17, after `cargo build --release --features parquet`. Seconds of processors are those of the workers and of the JVM.
Spark's own words go to stderr. Needs Linux.
"""

import argparse
import glob
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cylwatch as cw
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from cylwatch import spark as cws

os.environ["PYSPARK_PYTHON"] = sys.executable
from pyspark.sql import SparkSession  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
VESSEL = "nitrogen-20l"
FILL = {"fill_pressure_bar": 200, "fill_temperature_degc": 15}
CONF = {
    "spark.sql.shuffle.partitions": "4",
    "spark.ui.enabled": "false",
    "spark.ui.showConsoleProgress": "false",
    "spark.driver.bindAddress": "127.0.0.1",
    "spark.driver.host": "127.0.0.1",
    "spark.driver.memory": "4g",
    cws.PROVIDER: cws.ROCKSDB,
}


def write_logs(folder: Path, cylinders: int) -> int:
    """Copies of four logs of a week at 60 s, a Parquet file each; the number of rows."""
    folder.mkdir()
    logs = []
    for seed in range(4):
        table = pa.table(cw.simulate(VESSEL, "railway-week", seed=seed).rows)
        names = {name: name.removeprefix("measured_") for name in table.column_names if name.startswith("measured_")}
        logs.append(table.select(["time_s", *names]).rename_columns(["time_s", *names.values()]))
    for k in range(cylinders):
        log = logs[k % 4]
        column = pa.array([f"C{k:03}"] * log.num_rows)
        pq.write_table(log.append_column("cylinder", column), folder / f"C{k:03}.parquet", compression="snappy")
    return sum(logs[k % 4].num_rows for k in range(cylinders))


def write_batches(folder: Path, cylinders: int, rows: int, batches: int) -> None:
    """Micro-batches of a stream: so many rows of each cylinder, 10 s apart, a file each."""
    folder.mkdir()
    for batch in range(batches):
        time_s = 10.0 * (rows * batch + np.arange(rows))
        phases = np.arange(cylinders)[:, None]
        table = pa.table({
            "cylinder": np.repeat([f"C{k:05}" for k in range(cylinders)], rows),
            "time_s": np.tile(time_s, cylinders),
            "shoulder_degc": (15 + 0.02 * np.sin(7.3 * time_s + phases)).ravel(),
            "pressure_bar": (200 + 0.02 * np.sin(3.1 * time_s + phases)).ravel(),
        })
        pq.write_table(table, folder / f"{batch}.parquet")
        os.utime(folder / f"{batch}.parquet", (1.7e9 + batch, 1.7e9 + batch))


def processors_s() -> tuple[float, float]:
    """Seconds of the processors of this session's processes so far: all, and the JVM."""
    tick, session = os.sysconf("SC_CLK_TCK"), os.getsid(0)
    all_s = java_s = 0.0
    for path in glob.glob("/proc/[0-9]*/stat"):
        try:
            head, _, rest = Path(path).read_text().rpartition(")")
        except OSError:
            continue
        fields = rest.split()
        if int(fields[3]) == session:
            spent_s = sum(map(int, fields[11:15])) / tick
            all_s += spent_s
            java_s += spent_s * ("java" in head)
    return all_s, java_s


def measured(what: str, rows: int, work) -> None:
    begun, before = time.monotonic(), processors_s()
    work()
    wall_s = time.monotonic() - begun
    all_s, java_s = (after - was for after, was in zip(processors_s(), before))
    print(f"{what}: {wall_s:.1f} s, {rows / wall_s:.0f} rows/s; processors {all_s:.1f} s, of it JVM {java_s:.1f} s", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cylinders", type=int, default=80, help="of the batch")
    parser.add_argument("--streamed", type=int, default=1000, help="cylinders of the stream")
    parser.add_argument("--program", type=Path, default=ROOT / "target" / "release" / "cylwatch")
    given = parser.parse_args()
    # A session of its own, so that its processes can be told from others.
    if os.getsid(0) != os.getpid():
        os.setsid() if os.getpgrp() != os.getpid() else os.execvp("setsid", ["setsid", "--wait", sys.executable, *sys.argv])
    with tempfile.TemporaryDirectory(prefix="cylwatch-spark-") as name:
        folder = Path(name)
        rows = write_logs(folder / "logs", given.cylinders)
        print(f"{given.cylinders} cylinders, {rows} rows", flush=True)
        options = [f"--{key.replace('_', '-')}={value}" for key, value in FILL.items()]
        command = [given.program.resolve(), "fleet", "logs", "--vessel", VESSEL, *options, "--threads", "2", "-q"]
        for k in range(2):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            begun = time.monotonic()
            code = subprocess.run([*command, "-o", f"fleet{k}"], cwd=folder, stdout=subprocess.DEVNULL).returncode
            if code not in (0, 1, 3):
                sys.exit(f"the command ended with {code}")
            wall_s, after = time.monotonic() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
            spent_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            print(f"fleet: {wall_s:.1f} s, {rows / wall_s:.0f} rows/s; processors {spent_s:.1f} s", flush=True)

        builder = SparkSession.builder.master("local[2]")
        for key, value in CONF.items():
            builder = builder.config(key, value)
        session = builder.config("spark.sql.warehouse.dir", str(folder / "warehouse")).getOrCreate()
        session.sparkContext.setLogLevel("ERROR")
        logs = session.read.parquet(str(folder / "logs"))
        for k in range(3):
            told = cws.monitor(logs, VESSEL, **FILL)
            measured("batch", rows, lambda: told.write.parquet(str(folder / f"told{k}")))
        first = logs.groupBy("cylinder").applyInArrow(lambda key, table: table.slice(0, 1), logs.schema)
        measured("shuffle and Arrow alone", rows, first.collect)

        for of_each in (6, 60) if given.streamed else ():
            source, sink = folder / f"stream{of_each}", folder / f"sink{of_each}"
            write_batches(source, given.streamed, of_each, 5)
            reader = session.readStream.schema(session.read.parquet(str(source)).schema).option("maxFilesPerTrigger", 1)
            told = cws.monitor(reader.parquet(str(source)), VESSEL, **FILL)
            writer = told.writeStream.format("parquet").option("checkpointLocation", str(sink / "checkpoint"))

            def run() -> None:
                writer.trigger(availableNow=True).start(str(sink / "told")).awaitTermination()

            measured(f"five micro-batches, {of_each} rows of each of {given.streamed} cylinders", 5 * of_each * given.streamed, run)
        session.stop()


main()
