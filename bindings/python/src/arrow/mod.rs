//! Tables through Arrow's C stream interface: capsules of Python around [`table`].
mod table;

pub(crate) use table::batch;

use crate::error::refused;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{RecordBatch, RecordBatchIterator};
use cylwatch::run::MemoryLog;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use std::ffi::CStr;

/// Name of the capsule, by the interface.
const STREAM: &CStr = c"arrow_array_stream";

/// A table as a log of this name: its numbers are copied once.
pub(crate) fn log(table: &Bound<'_, PyAny>, name: &str) -> PyResult<MemoryLog> {
    let capsule = table.call_method0("__arrow_c_stream__")?;
    let capsule = capsule.cast::<PyCapsule>()?;
    let pointer = capsule.pointer_checked(Some(STREAM))?.cast::<FFI_ArrowArrayStream>();
    // SAFETY: a capsule of this name holds a stream, which lives as long as the capsule. `from_raw` moves it out and leaves one that
    // is released, as the interface asks of a consumer.
    #[allow(unsafe_code)]
    let stream = unsafe { FFI_ArrowArrayStream::from_raw(pointer.as_ptr()) };
    let columns = table::read(stream)
        .map_err(|error| refused(table.py(), &format!("{name}: {error}: convert the table with pyarrow")))?;
    Ok(MemoryLog { name: name.to_owned(), columns })
}

/// A batch as the capsule that a frame takes.
pub(crate) fn stream<'py>(py: Python<'py>, batch: &RecordBatch) -> PyResult<Bound<'py, PyCapsule>> {
    let batches = RecordBatchIterator::new([Ok(batch.clone())], batch.schema());
    PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(batches)), STREAM)
}

/// The schema of a batch as a capsule.
pub(crate) fn schema<'py>(py: Python<'py>, batch: &RecordBatch) -> PyResult<Bound<'py, PyCapsule>> {
    let schema = arrow_schema::ffi::FFI_ArrowSchema::try_from(batch.schema().as_ref());
    let schema = schema.map_err(|error| refused(py, &error.to_string()))?;
    PyCapsule::new_with_value(py, schema, c"arrow_schema")
}
