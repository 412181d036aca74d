//! A table as a Parquet file: a column of optional doubles for each of its columns, where it comes from as metadata.
use super::{Provenance, ReportError, Table, rounded};
use ::parquet::basic::{Compression, Repetition, Type as PhysicalType};
use ::parquet::data_type::DoubleType;
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::types::Type;
use std::sync::Arc;

/// Rows of a row group.
const GROUP: usize = 100_000;

impl Table {
    /// As a Parquet file. The metadata `provenance` is the object of a JSON file, `remarks` are lines.
    ///
    /// # Errors
    /// The library fails.
    pub fn to_parquet(&self, provenance: &Provenance, remarks: &[String]) -> Result<Vec<u8>, ReportError> {
        self.parquet(provenance, remarks).map_err(|error| ReportError::Parquet { reason: error.to_string() })
    }

    fn parquet(&self, provenance: &Provenance, remarks: &[String]) -> Result<Vec<u8>, ParquetError> {
        let field = |name: &str| {
            let field = Type::primitive_type_builder(name, PhysicalType::DOUBLE);
            field.with_repetition(Repetition::OPTIONAL).build().map(Arc::new)
        };
        let fields = self.columns.iter().map(|column| field(&column.name)).collect::<Result<Vec<_>, _>>()?;
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
            let to = self.rows().min(from + GROUP);
            let mut group = writer.next_row_group()?;
            for column in &self.columns {
                // As in CSV and JSON: rounded, and nothing where there is no finite value.
                let cells =
                    (from..to).map(|row| column.values.get(row).copied().filter(|value| value.is_finite()));
                let cells: Vec<Option<f64>> =
                    cells.map(|cell| cell.map(|value| rounded(value, self.digits))).collect();
                let levels: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
                let values: Vec<f64> = cells.into_iter().flatten().collect();
                if let Some(mut out) = group.next_column()? {
                    out.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
                    out.close()?;
                }
            }
            group.close()?;
        }
        writer.close()?;
        Ok(bytes)
    }
}
