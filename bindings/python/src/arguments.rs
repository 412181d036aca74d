//! Python values as what a command line says: vessels and other documents, options, times.
use crate::error::refused;
use cylwatch::run::StepTime;
use pyo3::prelude::*;
use pyo3::types::{
    PyBool, PyDateTime, PyDelta, PyDeltaAccess, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple,
};

/// A document: the text itself, or where it is.
pub(crate) enum Document {
    /// Name of a built-in one, or path.
    Place(std::path::PathBuf),
    /// Text.
    Text(String),
}

/// A vessel or scenario: name, path, TOML, or a dict of what the file would have.
pub(crate) fn document(value: &Bound<'_, PyAny>, what: &str) -> PyResult<Document> {
    if let Ok(text) = value.cast::<PyString>() {
        let text = text.to_cow()?;
        // No name of a file or a built-in one has an assignment or a second line.
        let is_text = text.contains('\n') || text.contains('=');
        return Ok(if is_text {
            Document::Text(text.into_owned())
        } else {
            Document::Place(text.as_ref().into())
        });
    }
    if let Ok(dict) = value.cast::<PyDict>() {
        return Ok(Document::Text(toml(dict, what)?));
    }
    if let Ok(path) = value.extract::<std::path::PathBuf>() {
        return Ok(Document::Place(path));
    }
    let message =
        format!("{what} is of type {}: give a name, a path, TOML or a dict", value.get_type().name()?);
    Err(refused(value.py(), &message))
}

fn json(value: &Bound<'_, PyAny>, what: &str) -> PyResult<String> {
    let dumps = value.py().import("json")?.getattr("dumps")?;
    let text = dumps.call1((value,)).and_then(|text| text.extract::<String>());
    text.map_err(|error| {
        refused(value.py(), &format!("{what}: {error}: use numbers, texts, lists and dicts"))
    })
}

fn toml(dict: &Bound<'_, PyDict>, what: &str) -> PyResult<String> {
    let text = json(dict.as_any(), what)?;
    let table = serde_json::from_str::<toml::Table>(&text).map_err(|error| error.to_string());
    let text = table.and_then(|table| toml::to_string(&table).map_err(|error| error.to_string()));
    text.map_err(|error| refused(dict.py(), &format!("{what}: {error}: leave out keys without a value")))
}

/// Options of a call, and the documents that they name.
#[derive(Default)]
pub(crate) struct Options {
    /// Names without dashes, and values; none is a switch.
    pub options: Vec<(String, Option<String>)>,
    /// Names and texts.
    pub documents: Vec<(String, String)>,
}

/// Keywords as options: `limit_bar=150` is `--limit-bar 150`, `True` a switch, a list the option again and again.
pub(crate) fn options(given: Option<&Bound<'_, PyDict>>) -> PyResult<Options> {
    let mut options = Options::default();
    for (key, value) in given.into_iter().flatten() {
        let key = key.extract::<String>()?;
        let name = key.replace('_', "-");
        match key.as_str() {
            "map" => map(&value, &mut options)?,
            "announced" => announced(&value, &mut options)?,
            "sensors" | "commissioned" | "learned_in" => file(&key, name, &value, &mut options)?,
            _ => option(&key, name, &value, &mut options)?,
        }
    }
    Ok(options)
}

fn option(key: &str, name: String, value: &Bound<'_, PyAny>, options: &mut Options) -> PyResult<()> {
    if value.is_none() {
        return Ok(());
    }
    if let Ok(switch) = value.cast::<PyBool>() {
        if switch.is_true() {
            options.options.push((name, None));
        }
        return Ok(());
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        return value.try_iter()?.try_for_each(|value| option(key, name.clone(), &value?, options));
    }
    options.options.push((name, Some(text(key, value)?)));
    Ok(())
}

/// A value as a command line has it.
fn text(key: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(text.to_cow()?.into_owned());
    }
    if value.is_instance_of::<PyFloat>() || value.is_instance_of::<PyInt>() {
        return Ok(value.str()?.to_cow()?.into_owned());
    }
    if value.is_instance_of::<PyDateTime>() {
        if value.getattr("tzinfo")?.is_none() {
            return Err(refused(value.py(), &format!("{key} = {value} has no zone: give tzinfo")));
        }
        return value.call_method0("isoformat")?.extract();
    }
    if let Ok(path) = value.extract::<std::path::PathBuf>() {
        return Ok(path.to_string_lossy().into_owned());
    }
    // Numbers of other libraries.
    if let Ok(number) = value.extract::<f64>() {
        return Ok(number.to_string());
    }
    let message = format!("{key} is of type {}: give a number or a text", value.get_type().name()?);
    Err(refused(value.py(), &message))
}

fn map(value: &Bound<'_, PyAny>, options: &mut Options) -> PyResult<()> {
    let Ok(dict) = value.cast::<PyDict>() else {
        return Err(refused(value.py(), "map is no dict: write {'shoulder_degc': 'T1'}, our name first"));
    };
    for (ours, theirs) in dict {
        options.options.push(("map".to_owned(), Some(format!("{ours}={theirs}"))));
    }
    Ok(())
}

fn announced(value: &Bound<'_, PyAny>, options: &mut Options) -> PyResult<()> {
    for span in value.try_iter()? {
        let (from, until) = span?.extract::<(Bound<'_, PyAny>, Bound<'_, PyAny>)>()?;
        let span = format!("{}..{}", text("announced", &from)?, text("announced", &until)?);
        options.options.push(("announced".to_owned(), Some(span)));
    }
    Ok(())
}

/// A file that an option names: sensors in TOML, the others in JSON.
fn file(key: &str, name: String, value: &Bound<'_, PyAny>, options: &mut Options) -> PyResult<()> {
    if value.is_none() {
        return Ok(());
    }
    let document = match value.cast::<PyDict>() {
        Ok(dict) if key != "sensors" => Document::Text(json(dict.as_any(), key)?),
        _ => document(value, key)?,
    };
    let place = match document {
        Document::Place(path) => path.to_string_lossy().into_owned(),
        Document::Text(text) => {
            let place = format!("<{key}>");
            options.documents.push((place.clone(), text));
            place
        }
    };
    options.options.push((name, Some(place)));
    Ok(())
}

/// When a row was read: seconds, or a datetime with its zone.
pub(crate) fn time(value: &Bound<'_, PyAny>) -> PyResult<StepTime> {
    let py = value.py();
    let Ok(date) = value.cast::<PyDateTime>() else {
        let second = value.extract::<f64>();
        return second.map(StepTime::Second).map_err(|_| {
            refused(py, &format!("time = {value} is no time: give seconds, or a datetime with tzinfo"))
        });
    };
    let zone = value.getattr("tzinfo")?;
    if zone.is_none() {
        return Err(refused(py, &format!("time = {value} has no zone: give tzinfo")));
    }
    let utc = py.import("datetime")?.getattr("timezone")?.getattr("utc")?;
    let date = date.call_method1("astimezone", (&utc,))?;
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
    Ok(StepTime::Instant(whole, zone_name(&zone, value)?))
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
