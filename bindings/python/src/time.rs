//! Times that come from Python.
use crate::error::refused;
use cylwatch::run::StepTime;
use pyo3::prelude::*;
use pyo3::types::{PyDateTime, PyDelta, PyDeltaAccess, PyDict};

/// When a row was read: seconds, or a datetime with its zone.
pub(crate) fn time(value: &Bound<'_, PyAny>) -> PyResult<StepTime> {
    let py = value.py();
    let Ok(date) = value.cast::<PyDateTime>() else {
        let second = value.extract::<f64>();
        return second.map(StepTime::Second).map_err(|_| {
            refused(py, &format!("time = {value} is no time: give seconds, or a datetime with tzinfo"))
        });
    };
    match instant(date)? {
        (tick, Some(zone)) => Ok(StepTime::Instant(tick, zone)),
        (_, None) => Err(refused(py, &format!("time = {value} has no zone: give tzinfo"))),
    }
}

/// Time since 1970 of a datetime, ns, and the name of its zone; without one it is told as if it were of UTC.
pub(crate) fn instant(value: &Bound<'_, PyDateTime>) -> PyResult<(i64, Option<String>)> {
    let py = value.py();
    let zone = value.getattr("tzinfo")?;
    let utc = py.import("datetime")?.getattr("timezone")?.getattr("utc")?;
    let date = if zone.is_none() {
        let keywords = PyDict::new(py);
        keywords.set_item("tzinfo", &utc)?;
        value.call_method("replace", (), Some(&keywords))?
    } else {
        value.call_method1("astimezone", (&utc,))?
    };
    let epoch = PyDateTime::new(py, 1970, 1, 1, 0, 0, 0, 0, Some(utc.cast()?))?;
    let since = date.call_method1("__sub__", (epoch,))?;
    let since = since.cast::<PyDelta>()?;
    let seconds = i64::from(since.get_days()) * 86_400 + i64::from(since.get_seconds());
    // A stamp of pandas is a datetime with more digits.
    let below = date.getattr("nanosecond").and_then(|below| below.extract::<i64>()).unwrap_or(0);
    let nanosecond = i64::from(since.get_microseconds()) * 1000 + below;
    let whole = seconds.checked_mul(1_000_000_000).and_then(|whole| whole.checked_add(nanosecond));
    let whole = whole
        .ok_or_else(|| refused(py, &format!("time = {value} must lie between the years 1678 and 2262")))?;
    let zone = if zone.is_none() { None } else { Some(zone_name(&zone, value)?) };
    Ok((whole, zone))
}

/// Name of a zone: of the database, else the distance from UTC at that time.
fn zone_name(zone: &Bound<'_, PyAny>, date: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(key) = zone.getattr("key").and_then(|key| key.extract::<String>()) {
        return Ok(key);
    }
    let offset = date.call_method0("utcoffset")?;
    let minutes = (offset.call_method0("total_seconds")?.extract::<f64>()? / 60.0).round() as i64;
    let (sign, minutes) = (if minutes < 0 { '-' } else { '+' }, minutes.abs());
    Ok(if minutes == 0 { "UTC".to_owned() } else { format!("{sign}{:02}:{:02}", minutes / 60, minutes % 60) })
}
