//! A table as a Parquet file: an optional column of its type for each column, where it comes from as metadata.
use super::{Cell, Column, Table, Values};
use crate::report::{Provenance, ReportError};
use ::parquet::basic::{Compression, LogicalType, Repetition, Type as PhysicalType};
use ::parquet::data_type::{BoolType, ByteArrayType, DataType, DoubleType, Int64Type};
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use ::parquet::schema::types::Type;
use std::ops::Range;
use std::sync::Arc;

/// Rows of a row group.
const GROUP: usize = 100_000;

impl Table {
    /// As a Parquet file. The metadata `provenance` is the object of a JSON file, `remarks` are lines.
    ///
    /// # Errors
    /// The library fails.
    pub(crate) fn to_parquet(
        &self,
        provenance: &Provenance,
        remarks: &[String],
    ) -> Result<Vec<u8>, ReportError> {
        self.parquet(provenance, remarks).map_err(|error| ReportError::Parquet { reason: error.to_string() })
    }

    fn parquet(&self, provenance: &Provenance, remarks: &[String]) -> Result<Vec<u8>, ParquetError> {
        let fields = self.columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
        let schema = Type::group_type_builder("cylwatch").with_fields(fields).build()?;
        let metadata = [("provenance", provenance.to_json().to_string()), ("remarks", remarks.join("\n"))];
        let metadata = metadata.map(|(key, value)| KeyValue::new(key.to_owned(), value)).to_vec();
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_key_value_metadata(Some(metadata))
            .build();
        let mut bytes = Vec::new();
        let mut writer = SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties))?;
        for from in (0..self.rows()).step_by(GROUP) {
            let rows = from..self.rows().min(from + GROUP);
            let mut group = writer.next_row_group()?;
            for column in &self.columns {
                if let Some(mut out) = group.next_column()? {
                    write(column, rows.clone(), &mut out)?;
                    out.close()?;
                }
            }
            group.close()?;
        }
        writer.close()?;
        Ok(bytes)
    }
}

fn field(column: &Column) -> Result<Arc<Type>, ParquetError> {
    let (physical, logical) = match column.values {
        Values::Numbers(..) => (PhysicalType::DOUBLE, None),
        Values::Integers(_) => (PhysicalType::INT64, None),
        Values::Booleans(_) => (PhysicalType::BOOLEAN, None),
        Values::Texts(_) => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let field = Type::primitive_type_builder(&column.name, physical).with_logical_type(logical);
    field.with_repetition(Repetition::OPTIONAL).build().map(Arc::new)
}

/// Writes some rows of a column; numbers are rounded as in CSV and JSON.
fn write(
    column: &Column,
    rows: Range<usize>,
    out: &mut SerializedColumnWriter<'_>,
) -> Result<(), ParquetError> {
    let cells = rows.map(|row| column.values.cell(row));
    match column.values {
        Values::Numbers(..) => batch::<DoubleType>(out, cells, |cell| match cell {
            Cell::Number(value, digits) => Some(digits.rounded(value)),
            _ => None,
        }),
        Values::Integers(_) => batch::<Int64Type>(out, cells, |cell| match cell {
            Cell::Integer(value) => Some(value),
            _ => None,
        }),
        Values::Booleans(_) => batch::<BoolType>(out, cells, |cell| match cell {
            Cell::Boolean(value) => Some(value),
            _ => None,
        }),
        Values::Texts(_) => batch::<ByteArrayType>(out, cells, |cell| match cell {
            Cell::Text(text) => Some(text.into()),
            _ => None,
        }),
    }
}

fn batch<'a, T: DataType>(
    out: &mut SerializedColumnWriter<'_>,
    cells: impl Iterator<Item = Cell<'a>>,
    value: impl Fn(Cell<'a>) -> Option<T::T>,
) -> Result<(), ParquetError> {
    let values: Vec<Option<T::T>> = cells.map(value).collect();
    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    let known: Vec<T::T> = values.into_iter().flatten().collect();
    out.typed::<T>().write_batch(&known, Some(&levels), None).map(|_| ())
}
