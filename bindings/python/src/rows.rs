//! Rows of a result: columns for frames by Arrow, for numpy, and as Python values.
use crate::{arrow, error};
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type, TimestampNanosecondType};
use arrow_array::{Array, RecordBatch};
use arrow_schema::DataType;
use cylwatch::report::{Table, Values};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule, PyDict, PyList};

/// Rows of a result. `pandas.DataFrame.from_arrow`, `polars.DataFrame`, `pyarrow.table` and others take it as it is; `rows["mass_kg"]` is an array of
/// numpy. Columns and units are those of the command's data, with all digits; a missing value is null, and NaN in numpy.
#[pyclass(frozen, module = "cylwatch")]
pub(crate) struct Rows(RecordBatch);

impl Rows {
    pub(crate) fn new(py: Python<'_>, table: &Table, zone: Option<&str>) -> PyResult<Self> {
        arrow::batch(table, zone).map(Self).map_err(|error| error::refused(py, &error.to_string()))
    }

    pub(crate) fn count(&self) -> usize {
        self.0.num_rows()
    }
}

#[pymethods]
impl Rows {
    /// Names of the columns, which end in their units.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.0.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    fn __len__(&self) -> usize {
        self.count()
    }

    fn __repr__(&self) -> String {
        format!("<cylwatch.Rows: {} rows of {}>", self.count(), self.columns().join(", "))
    }

    /// A column as an array of numpy: numbers as float64, counts as int64, dates as datetime64[ns] in UTC, texts as objects.
    pub(crate) fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(array) = self.0.column_by_name(name) else {
            let columns = self.columns().join(", ");
            return Err(pyo3::exceptions::PyKeyError::new_err(format!("{name}: the columns are {columns}")));
        };
        let numpy = py.import("numpy")?;
        let of_bytes = |bytes: Vec<u8>, kind: &str| {
            numpy.call_method1("frombuffer", (PyBytes::new(py, &bytes), kind))?.call_method0("copy")
        };
        match array.data_type() {
            DataType::Float64 => {
                let cells = array.as_primitive::<Float64Type>().iter();
                of_bytes(cells.flat_map(|cell| cell.unwrap_or(f64::NAN).to_le_bytes()).collect(), "<f8")
            }
            DataType::Timestamp(..) => {
                // The smallest number is what numpy calls "not a time".
                let ticks = array.as_primitive::<TimestampNanosecondType>().iter();
                of_bytes(ticks.flat_map(|tick| tick.unwrap_or(i64::MIN).to_le_bytes()).collect(), "<M8[ns]")
            }
            // What is missing is None, among objects.
            kind => {
                let (list, kind) = match kind {
                    DataType::Int64 => (PyList::new(py, array.as_primitive::<Int64Type>())?, "int64"),
                    DataType::Boolean => (PyList::new(py, array.as_boolean())?, "bool"),
                    _ => (PyList::new(py, array.as_string::<i32>().iter().collect::<Vec<_>>())?, "object"),
                };
                let kind = if array.null_count() == 0 { kind } else { "object" };
                numpy.call_method1("array", (list, kind))
            }
        }
    }

    /// The rows as a stream of Arrow.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // By the interface a producer may hand out its own schema.
        let _ = requested_schema;
        arrow::stream(py, &self.0)
    }

    /// The schema of Arrow.
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        arrow::schema(py, &self.0)
    }
}

/// A cell as a Python value; None is a missing one.
pub(crate) fn cell<'py>(py: Python<'py>, values: &Values, row: usize) -> PyResult<Bound<'py, PyAny>> {
    let object = match values {
        Values::Numbers(_, cells) => cells.get(row).filter(|cell| !cell.is_nan()).into_pyobject(py)?,
        Values::Integers(cells) => cells.get(row).copied().flatten().into_pyobject(py)?,
        Values::Booleans(cells) => cells.get(row).copied().flatten().into_pyobject(py)?,
        Values::Texts(cells) => cells.get(row).filter(|cell| !cell.is_empty()).into_pyobject(py)?,
    };
    Ok(object)
}

/// The rows of a table as dicts.
pub(crate) fn dicts<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyList>> {
    let count = table.columns.first().map_or(0, |column| match &column.values {
        Values::Numbers(_, cells) => cells.len(),
        Values::Integers(cells) => cells.len(),
        Values::Booleans(cells) => cells.len(),
        Values::Texts(cells) => cells.len(),
    });
    let list = PyList::empty(py);
    for row in 0..count {
        let dict = PyDict::new(py);
        for column in &table.columns {
            dict.set_item(&column.name, cell(py, &column.values, row)?)?;
        }
        list.append(dict)?;
    }
    Ok(list)
}
