"""A dict of arrays or lists is a log, as a file or a frame of the same columns is."""

from array import array
from datetime import datetime, timedelta, timezone
from zoneinfo import ZoneInfo

import cylwatch as cw
import numpy as np
import pandas as pd
import pytest
from conftest import VESSEL, body


def bits(result):
    return [result[name].tobytes() for name in result.rows.columns if result[name].dtype == np.float64]


def columns_of(log, convert):
    return {name: convert(log[name].to_numpy()) for name in log}


@pytest.mark.parametrize("call", [cw.monitor, cw.estimate])
@pytest.mark.parametrize(
    "convert",
    [
        lambda values: values,
        lambda values: np.repeat(values, 2)[::2],
        lambda values: values.astype(">f8"),
        lambda values: values.astype(object),
        lambda values: pd.Series(values, index=range(5, 5 + len(values))),
        list,
        lambda values: values.tolist(),
        lambda values: array("d", values),
        lambda values: [str(value) for value in values],
    ],
)
def test_every_kind_of_column_is_the_file_to_the_last_bit(call, convert, leak, tmp_path):
    leak.to_csv(tmp_path / "log.csv", index=False)
    assert bits(call(VESSEL, columns_of(leak, convert))) == bits(call(VESSEL, tmp_path / "log.csv"))


def test_whole_and_single_numbers_are_numbers(leak):
    seconds = leak["time_s"].astype("int64")
    expected = cw.monitor(VESSEL, leak)
    for time in (seconds.to_numpy(), seconds.astype("uint16").to_numpy(), seconds.tolist()):
        columns = columns_of(leak, lambda values: values) | {"time_s": time}
        assert bits(cw.monitor(VESSEL, columns)) == bits(expected)
    single = leak.astype({"pressure_bar": "float32"})
    assert bits(cw.monitor(VESSEL, columns_of(single, lambda values: values))) == bits(cw.monitor(VESSEL, single))


def test_missing_values_of_lists_and_arrays_are_those_of_a_frame(leak):
    log = leak.copy()
    log.loc[5:40, "shoulder_degc"] = np.nan
    expected = bits(cw.monitor(VESSEL, log))
    columns = columns_of(log, lambda values: values)
    assert bits(cw.monitor(VESSEL, columns)) == expected
    for missing in (None, float("nan"), pd.NA):
        shoulder = [missing if np.isnan(value) else value for value in log["shoulder_degc"]]
        assert bits(cw.monitor(VESSEL, columns | {"shoulder_degc": shoulder})) == expected
    empty = columns | {"valve_degc": [None] * len(log)}
    assert bits(cw.monitor(VESSEL, empty)) == bits(cw.monitor(VESSEL, log.assign(valve_degc=np.nan)))


@pytest.mark.parametrize("zone", [ZoneInfo("Europe/Berlin"), timezone.utc, timezone(timedelta(hours=5, minutes=30))])
def test_datetimes_with_zones_are_told_in_their_zone(zone, leak):
    # Through the hour that Berlin's clock shows twice.
    start = datetime(2026, 10, 24, 22, 30, tzinfo=timezone.utc)
    dates = [(start + timedelta(seconds=second)).astimezone(zone) for second in leak["time_s"]]
    frame = leak.drop(columns="time_s").assign(time=pd.DatetimeIndex(dates))
    columns = columns_of(leak.drop(columns="time_s"), lambda values: values) | {"time": dates}
    expected = cw.monitor(VESSEL, frame)
    for time in (dates, [pd.Timestamp(date) for date in dates], np.array(dates, dtype=object), frame["time"]):
        result = cw.monitor(VESSEL, columns | {"time": time})
        assert body(result.to_csv()) == body(expected.to_csv()) and bits(result) == bits(expected)


def test_dates_of_numpy_and_datetimes_without_a_zone_are_of_the_stated_one(leak):
    naive = pd.date_range("2026-01-12", periods=len(leak), freq="min")
    plain = columns_of(leak.drop(columns="time_s"), lambda values: values)
    expected = cw.monitor(VESSEL, leak.drop(columns="time_s").assign(time=naive), zone="Europe/Berlin")
    for unit in ("ns", "us", "ms", "s", "m"):
        result = cw.monitor(VESSEL, plain | {"time": naive.to_numpy().astype(f"datetime64[{unit}]")}, zone="Europe/Berlin")
        assert body(result.to_csv()) == body(expected.to_csv()), unit
    result = cw.monitor(VESSEL, plain | {"time": naive.to_pydatetime().tolist()}, zone="Europe/Berlin")
    assert body(result.to_csv()) == body(expected.to_csv())
    assert any("no zone" in words for words in cw.monitor(VESSEL, plain | {"time": naive.to_numpy()}).cautions)
    gap = naive.to_numpy().copy()
    gap[7] = np.datetime64("NaT", "ns")
    of_frame = leak.drop(columns="time_s").assign(time=gap)
    assert len(cw.monitor(VESSEL, plain | {"time": gap}, zone="UTC")) == len(cw.monitor(VESSEL, of_frame, zone="UTC"))


def test_what_is_no_column_is_refused_with_its_name(leak):
    columns = columns_of(leak, lambda values: values)
    count = len(leak)
    aware = datetime(2026, 1, 1, tzinfo=timezone.utc)
    for change, words in [
        ({"pressure_bar": np.ones((count, 2))}, "column pressure_bar has 2 dimensions"),
        ({"pressure_bar": np.ones((count, 2), dtype=int)}, "column pressure_bar has 2 dimensions"),
        ({"pressure_bar": 200.0}, "column pressure_bar is no array"),
        ({"pressure_bar": "200"}, "column pressure_bar is no array"),
        ({"pressure_bar": [200.0, "x"] * (count // 2) + [1.0] * (count % 2)}, "several kinds"),
        ({"pressure_bar": [object()] * count}, "value of type object"),
        ({"pressure_bar": [True] * count}, "value of type bool"),
        ({"pressure_bar": np.ones(count, dtype=bool)}, "must have numbers"),
        ({"pressure_bar": np.ones(count, dtype=complex)}, "must have numbers"),
        ({"pressure_bar": columns["pressure_bar"][:-1]}, "pressure_bar"),
        ({"time": [aware, datetime(2026, 1, 2)], "time_s": []}, "a zone or none"),
        ({"time": np.array(["3000-01-01"] * count, "datetime64[D]")}, "1678 to 2262"),
        ({"time": np.array([1] * count, "datetime64[M]")}, "datetime64"),
        ({5: columns["pressure_bar"]}, "called 5"),
    ]:
        with pytest.raises(cw.CylwatchError, match=words) as refused:
            cw.monitor(VESSEL, columns | change)
        assert refused.value.remedy and "internal error" not in str(refused.value)
    with pytest.raises(cw.CylwatchError, match="<frame> row 11") as refused:
        wrong = columns["time_s"].copy()
        wrong[10] = -1e6
        cw.estimate(VESSEL, columns | {"time_s": wrong})
    assert refused.value.line == 11


def test_foreign_names_of_columns_are_mapped(leak):
    foreign = {"t_s": leak["time_s"].to_numpy(), "T1": leak["shoulder_degc"].to_numpy(), "P": leak["pressure_bar"].to_numpy()}
    mapped = cw.monitor(VESSEL, foreign, map={"time_s": "t_s", "shoulder_degc": "T1", "pressure_bar": "P"})
    assert bits(mapped) == bits(cw.monitor(VESSEL, leak[["time_s", "shoulder_degc", "pressure_bar"]]))
