//! A dict of columns as a log: arrays of numpy, and lists of numbers, texts or datetimes.
use crate::error::refused;
use crate::time;
use cylwatch::run::{Cells, MemoryLog};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDateTime, PyDict, PyString};

/// A dict as a log of this name.
pub(crate) fn log(dict: &Bound<'_, PyDict>, name: &str) -> PyResult<MemoryLog> {
    let column = |(key, values): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let Ok(column) = key.extract::<String>() else {
            return Err(refused(
                dict.py(),
                &format!("{name}: a column is called {key}: give its name as a text"),
            ));
        };
        let of_column = |words: &str| refused(dict.py(), &format!("{name}: column {column} {words}"));
        let cells = cells(&values, &of_column)?;
        Ok((column, cells))
    };
    Ok(MemoryLog { name: name.to_owned(), columns: dict.iter().map(column).collect::<PyResult<_>>()? })
}

/// Makes an error of what is wrong with a column.
type Refuse<'a> = &'a dyn Fn(&str) -> PyErr;

fn cells(values: &Bound<'_, PyAny>, refuse: Refuse<'_>) -> PyResult<Cells> {
    if let Some(doubles) = PyBuffer::<f64>::get(values).ok().filter(is_native) {
        return numbers(values.py(), &doubles, refuse);
    }
    if values.hasattr("dtype")?
        && let Some(cells) = of_array(values, refuse)?
    {
        return Ok(cells);
    }
    of_list(values, refuse)
}

/// Whether bytes have the order of this machine: the binding takes either for it.
fn is_native(doubles: &PyBuffer<f64>) -> bool {
    let foreign: &[u8] = if cfg!(target_endian = "little") { b">!" } else { b"<" };
    !doubles.format().to_bytes().first().is_some_and(|order| foreign.contains(order))
}

fn numbers(py: Python<'_>, doubles: &PyBuffer<f64>, refuse: Refuse<'_>) -> PyResult<Cells> {
    match doubles.dimensions() {
        1 => Ok(Cells::Numbers(doubles.to_vec(py)?)),
        dimensions => Err(refuse(&format!("has {dimensions} dimensions: give an array of one"))),
    }
}

/// An array of numpy, or what becomes one; `None`: its elements are objects.
fn of_array(values: &Bound<'_, PyAny>, refuse: Refuse<'_>) -> PyResult<Option<Cells>> {
    let py = values.py();
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (values,))?;
    let kind = array.getattr("dtype")?.getattr("kind")?.extract::<String>()?;
    let as_buffer = |kind: &str| array.call_method1("astype", (kind,));
    Ok(match kind.as_str() {
        "f" | "i" | "u" => Some(numbers(py, &PyBuffer::get(&as_buffer("float64")?)?, refuse)?),
        "M" => {
            let ticks = PyBuffer::<i64>::get(&as_buffer("int64")?)?.to_vec(py)?;
            let unit = numpy.call_method1("datetime_data", (array.getattr("dtype")?,))?;
            let nanoseconds = nanoseconds(unit.extract()?, refuse)?;
            // The smallest number is what numpy calls "not a time".
            let tick = |tick: i64| match (tick, tick.checked_mul(nanoseconds)) {
                (i64::MIN, _) => Ok(None),
                (_, Some(tick)) => Ok(Some(tick)),
                (_, None) => Err(refuse("has a date beyond the years 1678 to 2262: correct it")),
            };
            let nanoseconds = ticks.into_iter().map(tick).collect::<PyResult<_>>()?;
            Some(Cells::Instants { nanoseconds, zone: None })
        }
        "O" | "U" | "T" => None,
        _ => Some(Cells::Other(array.getattr("dtype")?.str()?.to_cow()?.into_owned())),
    })
}

/// Nanoseconds of a tick of numpy's dates.
fn nanoseconds((unit, count): (String, i64), refuse: Refuse<'_>) -> PyResult<i64> {
    let one = match unit.as_str() {
        "ns" => 1,
        "us" => 1_000,
        "ms" => 1_000_000,
        "s" => 1_000_000_000,
        "m" => 60_000_000_000,
        "h" => 3_600_000_000_000,
        "D" => 86_400_000_000_000,
        _ => return Err(refuse(&format!("counts time in {unit}: convert it to datetime64[ns]"))),
    };
    Ok(one * count)
}

/// An element of a list.
enum Item {
    Missing,
    Number(f64),
    Text(String),
    /// Time since 1970, ns, and its zone.
    Instant(i64, Option<String>),
}

fn of_list(values: &Bound<'_, PyAny>, refuse: Refuse<'_>) -> PyResult<Cells> {
    let wrong = || refuse("is no array: give an array of numpy or a list, a value a row");
    if values.is_instance_of::<PyString>() || values.is_instance_of::<PyDict>() {
        return Err(wrong());
    }
    let items = values.try_iter().map_err(|_| wrong())?;
    let items: Vec<Item> = items.map(|value| item(&value?, refuse)).collect::<PyResult<_>>()?;
    let mixed = || {
        refuse("has values of several kinds: give numbers, texts, or datetimes that all have a zone or none")
    };
    match items.iter().find(|item| !matches!(item, Item::Missing)) {
        Some(Item::Text(_)) => {
            let text = |item| match item {
                Item::Missing => Ok(None),
                Item::Text(text) => Ok(Some(text)),
                _ => Err(mixed()),
            };
            Ok(Cells::Texts(items.into_iter().map(text).collect::<PyResult<_>>()?))
        }
        Some(Item::Instant(_, zone)) => {
            let zone = zone.clone();
            let instant = |item: &Item| match item {
                Item::Missing => Ok(None),
                Item::Instant(tick, other) if other.is_some() == zone.is_some() => Ok(Some(*tick)),
                _ => Err(mixed()),
            };
            let nanoseconds = items.iter().map(instant).collect::<PyResult<_>>()?;
            let zone = zone.map(|name| {
                name.parse()
                    .map_err(|_| refuse(&format!("has the zone {name}: give one of the time zone database")))
            });
            Ok(Cells::Instants { nanoseconds, zone: zone.transpose()? })
        }
        _ => {
            let number = |item| match item {
                Item::Missing => Ok(f64::NAN),
                Item::Number(number) => Ok(number),
                _ => Err(mixed()),
            };
            Ok(Cells::Numbers(items.into_iter().map(number).collect::<PyResult<_>>()?))
        }
    }
}

fn item(value: &Bound<'_, PyAny>, refuse: Refuse<'_>) -> PyResult<Item> {
    // What has no value differs from itself (NaN, NaT), or does not know (NA).
    if value.is_none() || !value.eq(value).unwrap_or(false) {
        return Ok(Item::Missing);
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(Item::Text(text.to_cow()?.into_owned()));
    }
    if let Ok(date) = value.cast::<PyDateTime>() {
        let (tick, zone) = time::instant(date)?;
        return Ok(Item::Instant(tick, zone));
    }
    match value.extract::<f64>() {
        Ok(number) if !value.is_instance_of::<PyBool>() => Ok(Item::Number(number)),
        _ => {
            let kind = value.get_type().name()?;
            Err(refuse(&format!("has a value of type {kind}: give numbers, texts or datetimes")))
        }
    }
}
