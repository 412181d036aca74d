"""Vessels and options of a fleet, as workers can use them, which have none of the files here."""

import json
import os
import pickle
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa
from pyspark import Broadcast
from pyspark.sql import DataFrame, SparkSession

from cylwatch import CylwatchError, Monitor

CYLINDER = "cylinder"
VESSEL = "vessel"
FILES = {"sensors": str, "commissioned": json.loads, "learned_in": json.loads}
"""Options whose value may be a file, and how its text is handed on."""

Assigned = tuple[int, bytes]
"""Place of a vessel in the list of documents, and options, pickled."""


class Named:
    """What is assigned to each cylinder: a broadcast, of which a worker holds one copy. It is looked up when it is used and not before, since
    Spark unpickles the function of a stream on its driver, too, where there are no broadcasts."""

    def __init__(self, find: Callable[..., Broadcast], *arguments: Any) -> None:
        self.find, self.arguments = find, arguments

    def __reduce__(self) -> tuple[Any, ...]:
        find, arguments = self.find(*self.arguments).__reduce__()
        return Named, (find, *arguments)

    def of(self, cylinder: str) -> Assigned | None:
        return self.find(*self.arguments).value.get(cylinder)


def assigned(session: SparkSession, vessels: Any, options: Mapping[str, Any]) -> tuple[list[bytes], Named | Assigned, Monitor]:
    """Documents of the vessels; what is assigned to each cylinder, or to all; and a monitor of one of them.

    A vessel or an option that is unknown is refused here; of many cylinders, a wrong value only where its rows are."""
    documents: dict[bytes, int] = {}
    common = {name: _handed(name, value) for name, value in options.items()}

    def assign(vessel: Any, own: Mapping[str, Any]) -> Assigned:
        document = pickle.dumps(_document(vessel))
        return documents.setdefault(document, len(documents)), pickle.dumps(common | own)

    if isinstance(vessels, str | os.PathLike | Mapping):
        alike = assign(vessels, {})
        return list(documents), alike, _checked(list(documents), alike)
    named: dict[str, Assigned] = {}
    checked, example = set(), None
    for row in _rows(vessels):
        name, vessel = row.pop(CYLINDER, None), row.pop(VESSEL, None)
        if name is None or vessel is None:
            raise refused(f"a row of the vessels has cylinder {name} and vessel {vessel}: fill in both")
        if str(name) in named:
            raise refused(f"cylinder {name} stands twice in the table of vessels: keep one of the rows")
        one = named[str(name)] = assign(vessel, row)
        kind = one[0], tuple(row)
        if kind not in checked:
            checked.add(kind)
            example = _checked(list(documents), one, f"cylinder {name}: ")
    if example is None:
        raise refused("the table of vessels has no row: add one for each cylinder")
    broadcast = session.sparkContext.broadcast(named)
    return list(documents), Named(lambda: broadcast), example


def refused(message: str) -> CylwatchError:
    """An error of the package; the remedy stands behind the last colon."""
    error = CylwatchError(message)
    error.file = error.line = None
    error.remedy = message.rpartition(": ")[2]
    return error


def _checked(documents: list[bytes], one: Assigned, place: str = "") -> Monitor:
    at, options = one
    try:
        return Monitor(pickle.loads(documents[at]), **pickle.loads(options))
    except CylwatchError as error:
        raise refused(f"{place}{error}") from error


def _rows(vessels: Any) -> Iterator[dict[str, Any]]:
    """Rows of a table of vessels without their empty cells."""
    if isinstance(vessels, DataFrame):
        vessels = vessels.toArrow()
    if not hasattr(vessels, "__arrow_c_stream__"):
        kind = type(vessels).__name__
        raise refused(f"vessels is of type {kind}: give a name, a path, TOML or a dict, or a frame with the column cylinder")
    for row in pa.table(vessels).to_pylist():
        # pandas hands out an index without a name, too.
        row = {name.lower(): value for name, value in row.items() if not name.startswith("__index_level_")}
        cells = {name: value for name, value in row.items() if value is not None and value == value and value != ""}
        yield {name: _handed(name, value) for name, value in cells.items()}


def _handed(name: str, value: Any) -> Any:
    if name == "settled" and isinstance(value, str):
        return value.lower() in ("yes", "true", "1")
    if name == "announced" and isinstance(value, str):
        return [tuple(value.split("..", 1))]
    if name in FILES and _is_file(value):
        return FILES[name](Path(value).read_text(encoding="utf-8"))
    return value


def _document(vessel: Any) -> Any:
    """A built-in name, TOML or a dict."""
    return Path(vessel).read_text(encoding="utf-8") if _is_file(vessel) else vessel


def _is_file(value: Any) -> bool:
    return isinstance(value, str | os.PathLike) and "\n" not in os.fspath(value) and Path(value).is_file()
