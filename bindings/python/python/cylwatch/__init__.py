"""cylwatch tells a leaking gas cylinder from a cold one.

Logs come as tables of pandas (2.2 or later), Polars or pyarrow, as dicts of arrays, or as paths; names of columns end in their units
(``time_s``, ``shoulder_degc``, ``pressure_bar``). Options are those of the command line: ``limit_bar=150`` is
``--limit-bar 150``. All numbers are those of the command.

>>> import cylwatch as cw
>>> run = cw.simulate("nitrogen-20l", "leak-after-tunnel", seed=7)
>>> cw.monitor("nitrogen-20l", run.rows).verdict
'leak'
"""

from ._cylwatch import (
    CylwatchError,
    Fleet,
    Monitor,
    Observer,
    Result,
    Rows,
    __version__,
    calibrate,
    estimate,
    fleet,
    identify,
    monitor,
    place,
    properties,
    simulate,
)

__all__ = [
    "CylwatchError",
    "Fleet",
    "Monitor",
    "Observer",
    "Result",
    "Rows",
    "__version__",
    "calibrate",
    "estimate",
    "fleet",
    "identify",
    "monitor",
    "place",
    "properties",
    "simulate",
]
