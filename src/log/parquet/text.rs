//! A Parquet file as the text of a log, for whoever looks at all of its columns: the header in line 1, row N in line N + 1.
use super::refused;
use crate::log::LogError;
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::record::Field;
use ::parquet::record::reader::RowIter;
use std::fs::File;
use std::io::Read;

/// The rows as text, made one at a time.
struct Text {
    rows: RowIter<'static>,
    line: Vec<u8>,
    at: usize,
}

/// The text of a file.
pub(in crate::log) fn text(input: File, file: &str) -> Result<impl Read + 'static, LogError> {
    let reader = SerializedFileReader::new(input).map_err(|error| refused(file, &error))?;
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let names: Vec<String> =
        schema.root_schema().get_fields().iter().map(|field| field.name().to_owned()).collect();
    let line = line(&names).map_err(|source| LogError::Io { file: file.to_owned(), source })?;
    Ok(Text { rows: RowIter::from_file_into(Box::new(reader)), line, at: 0 })
}

impl Read for Text {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        if self.at == self.line.len() {
            let Some(row) = self.rows.next() else { return Ok(0) };
            let row = row.map_err(std::io::Error::other)?;
            let cells: Vec<String> = row.get_column_iter().map(|(_, field)| cell(field)).collect();
            (self.line, self.at) = (line(&cells)?, 0);
        }
        let count = buffer.len().min(self.line.len() - self.at);
        buffer[..count].copy_from_slice(&self.line[self.at..self.at + count]);
        self.at += count;
        Ok(count)
    }
}

fn line(cells: &[String]) -> std::io::Result<Vec<u8>> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    writer.write_record(cells)?;
    writer.into_inner().map_err(|error| std::io::Error::other(error.to_string()))
}

fn cell(field: &Field) -> String {
    let date = |instant: Result<jiff::Timestamp, jiff::Error>| {
        instant.map_or_else(|_| field.to_string(), |at| at.to_string())
    };
    match field {
        Field::Null => String::new(),
        Field::Str(text) => text.clone(),
        Field::TimestampMillis(tick) => date(jiff::Timestamp::from_millisecond(*tick)),
        Field::TimestampMicros(tick) => date(jiff::Timestamp::from_microsecond(*tick)),
        Field::Double(value) => value.to_string(),
        Field::Float(value) => value.to_string(),
        other => other.to_string(),
    }
}
