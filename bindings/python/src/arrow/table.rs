//! Tables of Arrow without Python: what a stream holds becomes a log, and rows become a batch.
use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::{FFI_ArrowArrayStream, RecordBatchStreamReader};
use arrow_array::types::*;
use arrow_array::{
    Array, ArrayRef, ArrowPrimitiveType, Float64Array, RecordBatch, RecordBatchReader, StringArray,
    TimestampNanosecondArray,
};
use arrow_schema::{ArrowError, DataType, Field, Schema, TimeUnit};
use cylwatch::report::{Table, Values};
use cylwatch::run::Cells;
use std::sync::Arc;

/// A stream as columns of a log: its numbers are copied once.
pub(crate) fn read(stream: FFI_ArrowArrayStream) -> Result<Vec<(String, Cells)>, ArrowError> {
    let reader = RecordBatchStreamReader::try_new(stream)?;
    let schema = reader.schema();
    let mut columns: Vec<(String, Cells)> =
        schema.fields().iter().map(|field| (field.name().clone(), empty(field.data_type()))).collect();
    for batch in reader {
        for (array, (_, cells)) in batch?.columns().iter().zip(&mut columns) {
            append(array, cells)?;
        }
    }
    Ok(columns)
}

/// A column of a type, without cells.
fn empty(of: &DataType) -> Cells {
    match of {
        DataType::Timestamp(_, zone) => {
            let zone = zone.as_deref().map(str::parse);
            match zone.transpose() {
                Ok(zone) => Cells::Instants { nanoseconds: Vec::new(), zone },
                Err(_) => Cells::Other(of.to_string()),
            }
        }
        DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View => Cells::Texts(Vec::new()),
        DataType::Null => Cells::Numbers(Vec::new()),
        number if number.is_integer() || number.is_floating() => Cells::Numbers(Vec::new()),
        other => Cells::Other(other.to_string()),
    }
}

fn append(array: &ArrayRef, cells: &mut Cells) -> Result<(), ArrowError> {
    match cells {
        Cells::Numbers(out) => numbers(array, out),
        Cells::Texts(out) => {
            let owned = |text: Option<&str>| text.map(str::to_owned);
            match array.data_type() {
                DataType::Utf8 => out.extend(array.as_string::<i32>().iter().map(owned)),
                DataType::LargeUtf8 => out.extend(array.as_string::<i64>().iter().map(owned)),
                _ => out.extend(array.as_string_view().iter().map(owned)),
            }
        }
        Cells::Instants { nanoseconds, .. } => instants(array, nanoseconds)?,
        Cells::Other(_) => {}
    }
    Ok(())
}

fn numbers(array: &ArrayRef, out: &mut Vec<f64>) {
    match array.data_type() {
        DataType::Float64 if array.null_count() == 0 => {
            out.extend_from_slice(array.as_primitive::<Float64Type>().values());
        }
        DataType::Float64 => spread::<Float64Type>(array, out, |value| value),
        DataType::Float32 => spread::<Float32Type>(array, out, f64::from),
        DataType::Float16 => spread::<Float16Type>(array, out, f64::from),
        DataType::Int8 => spread::<Int8Type>(array, out, f64::from),
        DataType::Int16 => spread::<Int16Type>(array, out, f64::from),
        DataType::Int32 => spread::<Int32Type>(array, out, f64::from),
        DataType::Int64 => spread::<Int64Type>(array, out, |value| value as f64),
        DataType::UInt8 => spread::<UInt8Type>(array, out, f64::from),
        DataType::UInt16 => spread::<UInt16Type>(array, out, f64::from),
        DataType::UInt32 => spread::<UInt32Type>(array, out, f64::from),
        DataType::UInt64 => spread::<UInt64Type>(array, out, |value| value as f64),
        _ => out.resize(out.len() + array.len(), f64::NAN),
    }
}

/// Appends numbers; a null is NaN.
fn spread<T: ArrowPrimitiveType>(array: &ArrayRef, out: &mut Vec<f64>, convert: fn(T::Native) -> f64) {
    out.extend(array.as_primitive::<T>().iter().map(|value| value.map_or(f64::NAN, convert)));
}

fn instants(array: &ArrayRef, out: &mut Vec<Option<i64>>) -> Result<(), ArrowError> {
    let mut extend = |ticks: Vec<Option<i64>>, nanoseconds: i64| {
        for tick in ticks {
            let tick = tick.map(|tick| {
                let whole = tick.checked_mul(nanoseconds);
                whole.ok_or_else(|| {
                    ArrowError::ComputeError("a date lies beyond the years 1678 to 2262".to_owned())
                })
            });
            out.push(tick.transpose()?);
        }
        Ok(())
    };
    match array.data_type() {
        DataType::Timestamp(TimeUnit::Second, _) => {
            extend(array.as_primitive::<TimestampSecondType>().iter().collect(), 1_000_000_000)
        }
        DataType::Timestamp(TimeUnit::Millisecond, _) => {
            extend(array.as_primitive::<TimestampMillisecondType>().iter().collect(), 1_000_000)
        }
        DataType::Timestamp(TimeUnit::Microsecond, _) => {
            extend(array.as_primitive::<TimestampMicrosecondType>().iter().collect(), 1_000)
        }
        _ => extend(array.as_primitive::<TimestampNanosecondType>().iter().collect(), 1),
    }
}

/// A table as a batch: missing numbers and texts are nulls, the column `time` is of timestamps in the zone.
pub(crate) fn batch(table: &Table, zone: Option<&str>) -> Result<RecordBatch, ArrowError> {
    let mut fields = Vec::new();
    let mut arrays: Vec<ArrayRef> = Vec::new();
    for column in &table.columns {
        let array: ArrayRef = match &column.values {
            Values::Numbers(_, cells) => Arc::new(
                cells.iter().map(|cell| Some(*cell).filter(|cell| !cell.is_nan())).collect::<Float64Array>(),
            ),
            Values::Integers(cells) => Arc::new(cells.iter().copied().collect::<arrow_array::Int64Array>()),
            Values::Booleans(cells) => Arc::new(cells.iter().copied().collect::<arrow_array::BooleanArray>()),
            Values::Texts(cells) if column.name == "time" => {
                let ticks: TimestampNanosecondArray = cells.iter().map(|cell| nanosecond(cell)).collect();
                Arc::new(ticks.with_timezone(zone.unwrap_or("UTC")))
            }
            Values::Texts(cells) => Arc::new(
                cells.iter().map(|cell| Some(cell).filter(|cell| !cell.is_empty())).collect::<StringArray>(),
            ),
        };
        fields.push(Field::new(&column.name, array.data_type().clone(), true));
        arrays.push(array);
    }
    RecordBatch::try_new(Arc::new(Schema::new(fields)), arrays)
}

/// Time since 1970 of a date in RFC 3339, ns; `None`: it is none, or beyond what nanoseconds can count.
fn nanosecond(date: &str) -> Option<i64> {
    let instant = date.parse::<jiff::Timestamp>().ok()?;
    i64::try_from(instant.as_nanosecond()).ok()
}
