"""What a worker does: a cylinder's rows, in any order, and its state become what is told of them, and the state after them."""

import functools
import pickle
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from cylwatch import CylwatchError, Monitor

from .vessels import CYLINDER, Named, refused

TIME = "time"
STATE = "state"
EVENTS = pa.list_(pa.struct([("time_s", pa.float64()), *((name, pa.string()) for name in ("time", "event", "id", "words", "line"))]))
ERROR = pa.struct([("line", pa.int64()), ("reason", pa.string()), ("remedy", pa.string())])


@dataclass
class Watch:
    """What workers know."""

    documents: list[bytes]
    """Vessels, each once, pickled."""
    assigned: Named | tuple[int, bytes]
    """Place of the vessel there, and options, pickled: by cylinder, or of all."""
    time: str
    order_by: str | None
    zone: str
    every_row: bool
    row: pa.DataType

    def told(self, cylinder: str | None, table: pa.Table, state: bytes | None) -> tuple[dict[str, Any], bytes | None]:
        """Steps through the rows; what is told, and the state after them. After an error it is the one before."""
        told: dict[str, Any] = {CYLINDER: cylinder, "rows": pa.array([], self.row), "events": []}
        try:
            stepped = self.monitor(cylinder, state)
            dated = table.filter(pc.is_finite(table[self.time]))
            out = stepped.steps(self.ordered(dated), rows=self.every_row)
            told |= {"events": out["told"], "verdict": stepped.verdict, "rows": self.structs(out["rows"])}
            state = stepped.save()
            if missing := table.num_rows - dated.num_rows:
                raise refused(f"rows without a time were left out, {missing} of {table.num_rows}: give each row its time")
        except CylwatchError as error:
            told["error"] = {"line": error.line, "reason": str(error), "remedy": error.remedy}
        return told, state

    def monitor(self, cylinder: str | None, state: bytes | None) -> Monitor:
        """The monitor of a cylinder."""
        if cylinder is None:
            raise refused("rows name no cylinder and were left out: complete the column cylinder")
        assigned = self.assigned.of(cylinder) if isinstance(self.assigned, Named) else self.assigned
        if assigned is None:
            raise refused(f"cylinder {cylinder} is not in the table of vessels: add a row with its vessel")
        at, options = assigned
        monitor, fresh = _made(self.documents[at], options)
        monitor.restore(fresh if state is None else state)
        return monitor

    def ordered(self, table: pa.Table) -> pa.Table:
        """The rows in their order, whatever Spark made of it. Readings decide between rows that tie, so that a replay gives the same bytes."""
        first = self.order_by or self.time
        at = table[first]
        if not pc.all(pc.greater(at[1:], at[:-1])).as_py():
            others = [name for name in table.column_names if name not in (first, CYLINDER)]
            table = table.take(pc.sort_indices(table, [(name, "ascending") for name in (first, *others)]))
        if self.time == TIME:
            instants = table[TIME].cast(pa.timestamp("us", self.zone))
            table = table.set_column(table.column_names.index(TIME), TIME, instants)
        return table.drop_columns([name for name in {CYLINDER, self.order_by} - {self.time} if name in table.column_names])

    def table(self, frames: Iterable[Any]) -> pa.Table:
        """Frames of pandas as one table; where a time is missing pandas has made numbers with a fraction of all."""

        def array(name: str, cells: Any) -> pa.Array:
            if name == TIME:
                return pa.array(cells.to_numpy(), pa.int64(), from_pandas=True)
            return pa.array(cells.to_numpy(), from_pandas=False)

        of = [{name: array(name, cells) for name, cells in frame.items() if name != CYLINDER} for frame in frames]
        return pa.concat_tables(map(pa.table, of))

    def structs(self, rows: Any) -> pa.Array:
        """Rows as structs, times in microseconds."""
        table = pa.table(rows)
        arrays = []
        for field in self.row:
            array = table[field.name].combine_chunks()
            arrays.append(array.cast(pa.timestamp("us", "UTC"), safe=False).cast(pa.int64()) if field.name == TIME else array)
        return pa.StructArray.from_arrays(arrays, fields=list(self.row))

    def schema(self, with_state: bool) -> pa.Schema:
        """What is told, in Arrow."""
        rows = ("rows", pa.list_(self.row)) if self.every_row else ("row", self.row)
        fields = [(CYLINDER, pa.string()), ("verdict", pa.string()), rows, ("events", EVENTS), ("error", ERROR)]
        return pa.schema(fields + ([(STATE, pa.binary())] if with_state else []))

    def record(self, told: Mapping[str, Any], *state: bytes | None) -> pa.Table:
        """What is told of a cylinder as a table of one row, with its state or without."""
        schema, rows = self.schema(bool(state)), told["rows"]
        known = told | {STATE: state[0]} if state else told
        arrays = []
        for field in schema:
            if field.name == "row":
                arrays.append(rows[-1:] if len(rows) else pa.nulls(1, field.type))
            elif field.name == "rows":
                arrays.append(pa.ListArray.from_arrays([0, len(rows)], rows, type=field.type))
            else:
                arrays.append(pa.array([known.get(field.name)], field.type))
        return pa.Table.from_arrays(arrays, schema=schema)


@functools.lru_cache(maxsize=256)
def _made(document: bytes, options: bytes) -> tuple[Monitor, bytes]:
    """A monitor to restore states into, and the state in which nothing has come. A worker keeps them from one micro-batch to the next."""
    monitor = Monitor(pickle.loads(document), **pickle.loads(options))
    return monitor, monitor.save()


def columns(example: Monitor, time: str, zone: str) -> pa.DataType:
    """The columns of the command's rows as a struct, times in microseconds."""
    nothing = pa.table({time: pa.array([], pa.timestamp("us", zone) if time == TIME else pa.float64())})
    fields = pa.table(example.steps(nothing)["rows"]).schema
    return pa.struct([(field.name, pa.int64() if field.name == TIME else field.type) for field in fields])
