//! Python values as what a command line says: vessels and other documents, options.
use crate::error::refused;
use crate::table::table;
use cylwatch::run::MemoryLog;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDateTime, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

/// What messages call the log of the option `validate`.
const VALIDATE: &str = "<validate>";

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
    /// Logs that options name.
    pub logs: Vec<MemoryLog>,
}

impl Options {
    /// Adds a document for an option: the name that stands for it. `place` is the name of a text.
    fn document(&mut self, value: &Bound<'_, PyAny>, what: &str, place: String) -> PyResult<String> {
        Ok(match document(value, what)? {
            Document::Place(path) => path.to_string_lossy().into_owned(),
            Document::Text(text) => {
                self.documents.push((place.clone(), text));
                place
            }
        })
    }

    /// Adds an option that names a document: one, or a list of them, each for one of the `logs`.
    pub(crate) fn documents_of_logs(
        &mut self,
        key: &str,
        value: &Bound<'_, PyAny>,
        logs: &[String],
    ) -> PyResult<()> {
        let name = key.replace('_', "-");
        let Some(list) = list(value) else {
            let place = self.document(value, key, format!("<{key}>"))?;
            self.options.push((name, Some(place)));
            return Ok(());
        };
        if list.len() > logs.len() {
            let message = format!(
                "{key} has {} entries, and there are {} logs: give one for each log, the log of validate last, or None",
                list.len(),
                logs.len()
            );
            return Err(refused(value.py(), &message));
        }
        for (k, (value, log)) in list.iter().zip(logs).enumerate().filter(|(_, (value, _))| !value.is_none())
        {
            let place = self.document(value, key, format!("<{key} {}>", k + 1))?;
            self.options.push((name.clone(), Some(format!("{log}={place}"))));
        }
        Ok(())
    }
}

/// The elements of a list or tuple.
pub(crate) fn list<'py>(value: &Bound<'py, PyAny>) -> Option<Vec<Bound<'py, PyAny>>> {
    let is_list = value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>();
    is_list.then(|| value.try_iter().ok()?.collect::<PyResult<_>>().ok()).flatten()
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
            "sensors" | "candidates" | "commissioned" | "learned_in" => {
                file(&key, name, &value, &mut options)?;
            }
            "scenario" => scenarios(&value, &mut options)?,
            "validate" => validate(&value, &mut options)?,
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
    if let Some(list) = list(value) {
        return list.iter().try_for_each(|value| option(key, name.clone(), value, options));
    }
    if let Ok(dict) = value.cast::<PyDict>() {
        for (of, value) in dict {
            options.options.push((name.clone(), Some(format!("{of}={}", assigned(key, &value)?))));
        }
        return Ok(());
    }
    options.options.push((name, Some(text(key, value)?)));
    Ok(())
}

/// What is assigned to a name: a value, or several.
fn assigned(key: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    let values = list(value).unwrap_or_else(|| vec![value.clone()]);
    Ok(values.iter().map(|value| text(key, value)).collect::<PyResult<Vec<_>>>()?.join(","))
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
    option("map", "map".to_owned(), dict, options)
}

/// Scenarios of a command that takes several.
fn scenarios(value: &Bound<'_, PyAny>, options: &mut Options) -> PyResult<()> {
    for (k, value) in list(value).unwrap_or_else(|| vec![value.clone()]).iter().enumerate() {
        let place = options.document(value, "scenario", format!("<scenario {}>", k + 1))?;
        options.options.push(("scenario".to_owned(), Some(place)));
    }
    Ok(())
}

/// What is held out: a part of the log, or another log.
fn validate(value: &Bound<'_, PyAny>, options: &mut Options) -> PyResult<()> {
    let is_log = value.is_instance_of::<PyDict>() || value.hasattr("__arrow_c_stream__")?;
    if !is_log {
        return option("validate", "validate".to_owned(), value, options);
    }
    let log = table(value, VALIDATE)?;
    options.options.push(("validate".to_owned(), Some(log.name.clone())));
    options.logs.push(log);
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

/// A file that an option names: sensors and candidates in TOML, the others in JSON.
fn file(key: &str, name: String, value: &Bound<'_, PyAny>, options: &mut Options) -> PyResult<()> {
    // A number of sensors is no file of them.
    if value.is_none() || value.is_instance_of::<PyInt>() {
        return option(key, name, value, options);
    }
    let place = format!("<{key}>");
    let place = match value.cast::<PyDict>() {
        Ok(dict) if !matches!(key, "sensors" | "candidates") => {
            options.documents.push((place.clone(), json(dict.as_any(), key)?));
            place
        }
        _ => options.document(value, key, place)?,
    };
    options.options.push((name, Some(place)));
    Ok(())
}
