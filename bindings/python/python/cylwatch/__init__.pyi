"""Types of cylwatch. Columns and options carry their units in their names; pressures are absolute unless ``_barg``."""

from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from os import PathLike
from pathlib import Path
from typing import Any, Protocol, TypedDict

import numpy as np
import numpy.typing as npt

__version__: str

class ArrowTable(Protocol):
    """A table of pandas (2.2 or later), Polars, pyarrow or any other library with Arrow's PyCapsule interface."""

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

Log = ArrowTable | Mapping[str, npt.ArrayLike] | str | PathLike[str]
"""A log: a table, a dict of columns (arrays of numpy of shape (rows,), or lists of numbers, texts or datetimes), or the path of a
CSV or Parquet file."""

Document = str | PathLike[str] | Mapping[str, Any]
"""Name of a built-in vessel or scenario, path of a TOML file, TOML as text, or the content of such a file as a dict."""

Option = bool | int | float | str | datetime | PathLike[str] | Sequence[Any] | Mapping[str, Any] | None
"""Value of an option: ``limit_bar=150`` is ``--limit-bar 150``, ``settled=True`` is ``--settled``, a list is the option several times, and
``{"wall-capacity": (1, 0.05)}`` is ``wall-capacity=1,0.05``."""

class CylwatchError(ValueError):
    """What the program refuses, in its words."""

    file: str | None
    """File that is wrong; ``<frame>`` is a table, ``<vessel>`` a text or dict."""
    line: int | None
    """Line of the file, or row of the table, from 1."""
    remedy: str | None
    """What to do."""

class Rows:
    """Rows of a result: shape (rows, columns), all digits, missing values null (NaN in numpy).

    ``pandas.DataFrame.from_arrow(rows)``, ``polars.DataFrame(rows)`` and ``pyarrow.table(rows)`` take it as it is. The column
    ``time`` (logs with dates) has timestamps in the zone of the log, in whole seconds; ``time_s`` counts from the first row.
    """

    @property
    def columns(self) -> list[str]:
        """Names of the columns, which end in their units."""

    def __len__(self) -> int: ...
    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        """A column, shape (rows,): float64, int64 for counts, datetime64[ns] in UTC for ``time``, or objects for texts."""

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...
    def __arrow_c_schema__(self) -> object: ...

class Result:
    """Result of a call. A notebook shows its report with the figure, ``print`` its summary."""

    @property
    def rows(self) -> Rows:
        """Rows in the columns of the command's data."""

    @property
    def events(self) -> list[dict[str, Any]]:
        """Events and alarms as of ``monitor --events``, in the order in which they happened."""

    @property
    def summary(self) -> dict[str, Any]:
        """The summary of the command's JSON."""

    @property
    def verdict(self) -> str | None:
        """Verdict at the end: tight, leak, discharge, refill, sensor fault or unknown; None where none is given."""

    @property
    def exit_code(self) -> int:
        """Exit code of the command: 0 done and no loss, 1 gas was lost, 3 inconclusive, or a search that was ended early."""

    @property
    def vessel(self) -> str | None:
        """Of ``calibrate``: the calibrated vessel as TOML, for ``vessel=`` of any call; else None."""

    @property
    def sensors(self) -> str | None:
        """Of ``calibrate``: the fitted sensors as TOML, for ``sensors=`` of ``monitor`` and ``estimate`` on other rows; else None."""

    @property
    def cautions(self) -> list[str]:
        """Cautions, which the command writes to stderr."""

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        """A column of the rows, shape (rows,)."""

    def __len__(self) -> int: ...
    def to_csv(self) -> str:
        """The rows as the command writes them, with its digits."""

    def to_html(self) -> str:
        """The report as one page that refers to nothing outside."""

    def _repr_html_(self) -> str: ...

def monitor(vessel: Document, log: Log, **options: Option) -> Result:
    """Decides for every row of a log whether gas is being lost: ``cylwatch monitor``.

    log: shape (rows, columns) with ``time_s`` (or another unit) or ``time`` (datetimes), and readings such as ``shoulder_degc``,
    ``valve_degc``, ``pressure_bar``; NaN, null and NaT are missing. A path is a CSV or Parquet file.

    Options, as of the command: ``limit_bar=160``, ``coldest_degc=-25``, ``next_service_d=30``, ``lateness_s=0``, ``step_min=1``,
    ``false_alarm_years=10``, ``fill_pressure_bar``, ``fill_temperature_degc``, ``fill_mass_kg``, ``settled=False``,
    ``map={"shoulder_degc": "T1"}``, ``zone="Europe/Berlin"``, ``announced=[(from, until)]``; ``sensors``, ``commissioned``,
    ``learned_in`` as path, text or dict.
    """

class Fleet:
    """What a run over a fleet comes to. The tables are those of its folder: shape (rows, columns), missing values null."""

    @property
    def summary(self) -> Rows:
        """A row for each cylinder, the most urgent first: ``cylinder``, ``light``, ``verdict``, ``p15_bar``, ``lost_g`` and more."""

    @property
    def events(self) -> Rows:
        """A row for each event and change of an alarm, by cylinder; ``time`` in UTC, ``line`` the JSON of ``monitor --events``."""

    @property
    def errors(self) -> Rows:
        """A row for everything that could not be read: ``cylinder``, ``file``, ``line``, ``reason``, ``remedy``."""

    @property
    def exit_code(self) -> int:
        """Exit code of the command: 0 no cylinder lost gas, 1 one did, 3 of one it cannot be told."""

    @property
    def page(self) -> Path:
        """The page that was written."""

    def __len__(self) -> int: ...

def fleet(
    logs: str | PathLike[str],
    output: str | PathLike[str],
    *,
    progress: bool | Callable[[int, int, float, float | None], object] | None = None,
    **options: Option,
) -> Fleet:
    """Monitors many cylinders on all cores: ``cylwatch fleet``.

    logs: a folder of CSV or Parquet files, one for each cylinder, folders ``cylinder=NAME``, or files with a column ``cylinder``.
    output: the folder of the command, to the last byte. The same call resumes a run that was stopped or killed, and goes on from it
    when the logs have grown. Ctrl-C ends it within a thousand rows of a cylinder.
    progress: True writes how far it is to stderr; a callable gets cylinders that are done, all cylinders, rows a second, seconds left
    (None while no log is done), when cylinders have been done, at most every 50 ms. An exception of it ends the run.

    Options: ``vessels="fleet.csv"`` (a row for each cylinder) or ``vessel="nitrogen-20l"``, ``format="parquet"`` or ``"csv"``,
    ``rows=False``, ``threads``, ``go_on=False``, and those of ``monitor``; ``sensors``, ``commissioned``, ``learned_in`` as paths.
    """

def estimate(vessel: Document, log: Log, **options: Option) -> Result:
    """Estimates gas temperature, mass and leak rate with standard deviations: ``cylwatch estimate``.

    log as of ``monitor``. Options: those of the fill and the log, ``filter="ekf"``, ``smooth=False``, ``sensors``, ``learned_in``.
    """

def simulate(vessel: Document, scenario: Document, seed: int = 0, **options: Option) -> Result:
    """Simulates a vessel in a scenario: ``cylwatch simulate``.

    The rows have temperatures in degC, pressure in bar, mass in kg, and the readings of the scenario's sensors with the errors that
    ``seed`` draws (``measured_<sensor>_<unit>``); they are a log for ``monitor`` and ``estimate``. Option: ``relative_tolerance=1e-6``.
    """

def identify(log: Log, input: str, output: str, **options: Option) -> Result:
    """Identifies a transfer function from one column of a log to another: ``cylwatch identify``.

    input, output: names of columns, with or without units; temperatures are in degC, pressures in bar, time in s. The rows, shape
    (rows, 6 or 7), are time, input, output, model, error, from temperature to temperature the published model, and whether the row was
    held out. ``summary["coefficients"]`` has poles, time constants, gain and coefficients, each with ``name``, ``value``, ``unit``,
    ``sd`` and its 95 % interval ``low``, ``high``; ``summary["identified"]`` the model and its figures of merit.

    Options: ``order=1``, ``zeros``, ``gain="free"``, ``validate=0.3`` or another log, ``method="output-error"``, ``offset=False``,
    ``initial="estimated"``, ``dead_time_s``, ``input_sd_k``, ``output_sd_k``, ``second``, and those of the log.
    """

def calibrate(vessel: Document, logs: Log | Sequence[Log], **options: Option) -> Result:
    """Fits physical parameters of a vessel to its logs: ``cylwatch calibrate``.

    logs: a log, or a list of them, of the same vessel, with ``ambient_degc`` (the air) and the readings of the sensors. The rows, a
    parameter each, have value, sd, the 95 % interval ``low``, ``high``, prior and start in the SI unit of the column ``unit``; "1" is a
    factor on what the vessel said. ``vessel`` of the result is the calibrated vessel, ``sensors`` its sensors; ``summary`` has
    covariance and residuals.

    ``scenario`` says what the surroundings did instead of ``ambient_degc``: one for all logs, or a list with one for each, the log of
    ``validate`` last; None is the log's own air. ``vessel_of`` is such a list of the vessels of logs that are not of the main one.
    Other options: ``fit=["outside-film", "inside-film"]``, ``hold``, ``prior={"wall-capacity": (1, 0.05)}``, ``bounds``, ``start``,
    ``profile``, ``validate=0.3`` or another log, ``film_w_m2_k``, ``wind_m_s``, ``sensors``, ``date``, and those of the fill and the log.
    """

def place(vessel: Document, **options: Option) -> Result:
    """Finds where sensors should sit: ``cylwatch place``.

    The rows, a judged layout each, have the number of sensors, the layout by the names of its sensors joined with " + ", its cost, and
    the standard deviations and delays that it gives, with units. ``summary["best"]`` has the best layout of each number of sensors.

    Options: ``sensors=4``, ``criterion="leak-rate"``, ``scenario="tunnel-winter"`` (a document, a list of them, or "none"),
    ``candidates`` as path, text or dict, ``budget``, ``leak_g_h=10``, ``within_d=1``, ``sample_time_min=1``, ``fill_pressure_bar=200``,
    ``method``, ``wall_nodes``, ``confirm=0``, ``seed=1``. ``time_limit_min`` ends the search with what it has, and exit code 3.
    """

def properties(gas: str, **options: Option) -> dict[str, float | None]:
    """Properties of a gas at a state: ``cylwatch properties``; values in SI, the unit in the key.

    Two of temperature, pressure and density fix the state: ``temperature_degc=15, pressure_bar=200``. ``equation="reference"``,
    ``"ideal-gas"`` or ``"peng-robinson"``.
    """

class Step(TypedDict):
    """What has become final with a step."""

    rows: list[dict[str, Any]]
    """Rows in the columns of the command's data; None is a missing value."""

class MonitorStep(Step):
    """The same of a monitor."""

    events: list[dict[str, Any]]
    """Events and alarms of these rows."""

class Told(TypedDict):
    """An event or a change of an alarm, in the columns of the events of a fleet."""

    time_s: float
    time: str | None
    event: str
    id: str
    words: str
    line: str
    """The line of JSON that ``monitor --events`` writes."""

class MonitorSteps(TypedDict):
    """What has become final with a table."""

    rows: Rows
    """Rows in the columns of the command's data."""
    told: list[Told]
    """What happened in them."""

class Monitor:
    """A monitor that is fed row by row. Its rows are those of ``monitor`` on the same log, to the last bit."""

    def __init__(self, vessel: Document, **options: Option) -> None:
        """Options as of ``monitor``. Without a stated fill, rows wait until one has a pressure."""

    def step(self, time: float | datetime, readings: Mapping[str, float | None]) -> MonitorStep:
        """Takes in a row. time: s, or a datetime with its zone. The first step names all readings, with units."""

    def steps(self, table: ArrowTable, rows: bool = True) -> MonitorSteps:
        """Takes in the rows of a table in their order, faster than step by step, to the same bits.

        table: ``time`` with a zone, or ``time_s`` or another unit, and readings in numbers. With ``rows=False`` its rows are the last
        one so far alone. After an error the rows before the one that is refused have been taken in.
        """

    def finish(self) -> MonitorStep:
        """The rows that are held back, as at the end of a log."""

    @property
    def verdict(self) -> str:
        """Verdict of the last row that came out; unknown before."""

    def save(self) -> bytes:
        """All of it as bytes, at any row."""

    def state_file(self) -> bytes | None:
        """The bytes of the file that ``cylwatch monitor --state`` and ``fleet`` write after these rows; None before the fill is known."""

    def restore(self, state: bytes) -> None:
        """Goes on from bytes as if there had been no stop; vessel and options must be the same."""

class Observer:
    """An observer that is fed row by row. Its rows are those of ``estimate`` on the same log, to the last bit."""

    def __init__(self, vessel: Document, **options: Option) -> None:
        """Options as of ``estimate``, but for ``smooth``. Without a stated fill, rows wait until one has a pressure."""

    def step(self, time: float | datetime, readings: Mapping[str, float | None]) -> Step:
        """Takes in a row. time: s, or a datetime with its zone. The first step names all readings, with units."""

    def save(self) -> bytes:
        """All of it as bytes, at any row; filter ekf only."""

    def restore(self, state: bytes) -> None:
        """Goes on from bytes as if there had been no stop; vessel and options must be the same."""
