"""A fleet on Spark: a DataFrame of readings in, a DataFrame of verdicts, events, errors and states out.

``monitor`` groups a batch by its column ``cylinder`` (``applyInArrow``); of a stream it keeps the monitor's bytes as keyed state
(``transformWithStateInPandas``). Both feed each cylinder's rows to one ``cylwatch.Monitor`` and so give the events, rows and states of
``cylwatch fleet``. Which rows are late, doubled or contradictory is decided by the monitor; watermarks of Spark are not used.

>>> from cylwatch import spark as cylwatch_spark                                                        # doctest: +SKIP
>>> told = cylwatch_spark.monitor(session.read.parquet("logs"), "nitrogen-20l", fill_mass_kg=4.4)       # doctest: +SKIP
>>> told.select("cylinder", "verdict", "row.leak_g_h").show()                                           # doctest: +SKIP
"""

import os
from collections.abc import Iterable, Iterator
from typing import Any

import pyarrow as pa
from pyspark.sql import DataFrame, SparkSession
from pyspark.sql import functions as F
from pyspark.sql.pandas.types import from_arrow_schema
from pyspark.sql.streaming import StatefulProcessor
from pyspark.sql.types import NumericType, TimestampType

from .vessels import assigned, refused
from .watch import CYLINDER, STATE, TIME, Watch, columns

__all__ = ["PROVIDER", "ROCKSDB", "monitor", "states"]

PROVIDER = "spark.sql.streaming.stateStore.providerClass"
"""The option of a session that says where keyed state is kept."""
ROCKSDB = "org.apache.spark.sql.execution.streaming.state.RocksDBStateStoreProvider"
"""Its value for a stream that is monitored."""


def monitor(
    df: DataFrame,
    vessels: Any,
    *,
    order_by: str | None = None,
    rows: bool = False,
    states: DataFrame | None = None,
    **options: Any,
) -> DataFrame:
    """Monitors the cylinders of a DataFrame, a batch or a stream, as ``cylwatch fleet`` does.

    df: columns ``cylinder``; ``time`` (timestamp), or ``time_s`` or another unit; readings in numbers with their units, as
    ``shoulder_degc``.
    vessels: one vessel for all (name, path, TOML or dict), or a table with the columns of the file of vessels of ``cylwatch fleet``: a
    frame of Spark, pandas, Polars or pyarrow. Files that it names are read here, not by the workers.
    order_by: column of numbers that puts a cylinder's rows in order, as the offset of Kafka; by default it is their time.
    rows: hand out an array ``rows`` of all rows that have become final, not the last one as ``row``.
    states: columns ``cylinder`` and ``state`` to go on from, of an earlier batch or of a checkpoint; a stream uses them in its first run.
    options: as of ``cylwatch.monitor``, for cylinders whose row of ``vessels`` does not say otherwise.

    A row for each cylinder, of a stream for each cylinder in each micro-batch in which it has rows:

    ``cylinder``, ``verdict``; ``row``, its last row so far in the columns of the command, or ``rows``; ``events``, an array of time_s,
    time, event, id, words and line, as the events of a fleet; ``error`` (line, reason, remedy), if rows could not be used; of a batch
    ``state``, for ``states`` or ``Monitor.restore``. A cylinder that fails keeps the state it had, and the others go on.
    """
    df, time = _readings(df, order_by)
    zone = df.sparkSession.conf.get("spark.sql.session.timeZone").removeprefix("Etc/")
    documents, by_cylinder, example = assigned(df.sparkSession, vessels, options)
    watch = Watch(documents, by_cylinder, time, order_by, zone, rows, columns(example, time, zone))
    told = _streamed(df, watch, states) if df.isStreaming else _batched(df, watch, states)
    if time != TIME:
        return told
    # Timestamps pass the workers as microseconds, which no zone of a session changes.
    if rows:
        return told.withColumn("rows", F.transform("rows", _dated))
    return told.withColumn("row", _dated(F.col("row")))


def states(session: SparkSession, checkpoint: str | os.PathLike[str]) -> DataFrame:
    """The states in the checkpoint of a stream: columns ``cylinder`` and ``state``."""
    store = session.read.format("statestore").option("stateVarName", STATE).load(os.fspath(checkpoint))
    return store.select(f"key.{CYLINDER}", f"value.{STATE}")


def _dated(row: Any) -> Any:
    return row.withField(TIME, F.timestamp_micros(row[TIME]))


def _readings(df: DataFrame, order_by: str | None) -> tuple[DataFrame, str]:
    """The columns that a monitor takes, in types that no zone of a session changes, and the name of the time."""
    for needed in filter(None, (CYLINDER, order_by)):
        if needed not in df.columns:
            raise refused(f"the DataFrame has no column {needed}, it has {', '.join(df.columns)}: add it")
    times = [name for name in df.columns if name == TIME or name.startswith(f"{TIME}_")]
    if len(times) != 1:
        raise refused(f"the DataFrame has {len(times)} columns of time: keep one, time (a timestamp) or time_s")
    taken = [F.col(CYLINDER).cast("string")]
    for field in df.schema.fields:
        column, kind = F.col(f"`{field.name}`"), field.dataType
        if field.name == CYLINDER:
            continue
        if field.name == TIME and isinstance(kind, TimestampType):
            taken.append(F.unix_micros(column).alias(TIME))
        elif field.name == TIME:
            remedy = "cast it to timestamp, which reads it in spark.sql.session.timeZone"
            raise refused(f"column time is of type {kind.simpleString()}: {remedy}")
        elif isinstance(kind, NumericType):
            taken.append(column if field.name == order_by else column.cast("double").alias(field.name))
        else:
            remedy = "cast it to double, or leave it out with drop"
            raise refused(f"column {field.name} is of type {kind.simpleString()}, and readings are numbers: {remedy}")
    return df.select(*taken), times[0]


def _batched(df: DataFrame, watch: Watch, states: DataFrame | None) -> DataFrame:
    def begun(key: tuple[pa.Scalar, ...], table: pa.Table) -> pa.Table:
        return watch.record(*watch.told(key[0].as_py(), table, None))

    def continued(key: tuple[pa.Scalar, ...], table: pa.Table, before: pa.Table) -> pa.Table:
        return watch.record(*watch.told(key[0].as_py(), table, before[STATE][0].as_py() if before.num_rows else None))

    grouped, out = df.groupBy(CYLINDER), from_arrow_schema(watch.schema(with_state=True))
    if states is None:
        return grouped.applyInArrow(begun, out)
    return grouped.cogroup(states.select(CYLINDER, STATE).groupBy(CYLINDER)).applyInArrow(continued, out)


def _streamed(df: DataFrame, watch: Watch, states: DataFrame | None) -> DataFrame:
    provider = df.sparkSession.conf.get(PROVIDER, "")
    if provider != ROCKSDB:
        raise refused(f"{PROVIDER} is {provider!r}, and keyed state needs RocksDB: set it to {ROCKSDB}")
    before = None if states is None else states.select(CYLINDER, STATE).groupBy(CYLINDER)
    out = from_arrow_schema(watch.schema(with_state=False))
    return df.groupBy(CYLINDER).transformWithStateInPandas(_Cylinder(watch), out, "Append", "None", before)


class _Cylinder(StatefulProcessor):
    """A cylinder of a stream."""

    def __init__(self, watch: Watch) -> None:
        self.watch = watch

    def init(self, handle: Any) -> None:
        self.state = handle.getValueState(STATE, f"{STATE} binary")

    def handleInitialState(self, key: Any, initialState: Any, timerValues: Any) -> None:
        self.state.update((initialState[STATE].iloc[0],))

    def handleInputRows(self, key: Any, rows: Iterable[Any], timerValues: Any) -> Iterator[Any]:
        import pandas as pd

        before = bytes(self.state.get()[0]) if self.state.exists() else None
        # pandas makes NaN of a name that is missing.
        cylinder = key[0] if isinstance(key[0], str) else None
        told, state = self.watch.told(cylinder, self.watch.table(rows), before)
        if state is not None and state != before:
            self.state.update((state,))
        record = self.watch.record(told)
        # Of objects: what pandas would infer of each column costs more than the rows.
        cells = [column.to_pylist()[0] for column in record.columns]
        yield pd.DataFrame([cells], columns=record.column_names, dtype=object)

    def close(self) -> None:
        pass
