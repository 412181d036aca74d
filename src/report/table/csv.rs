//! A table as CSV, below comment lines that say where it comes from.
use super::{Cell, Table};
use crate::report::Provenance;
use csv::{ByteRecord, Terminator, Writer, WriterBuilder};
use std::cell::RefCell;
use std::io::{Result, Write};
use std::rc::Rc;

/// Bytes that a writer writes and that can be taken while it goes on: to begin a writer for every row would cost more than the row.
#[derive(Clone, Default)]
struct Sink(Rc<RefCell<Vec<u8>>>);

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Writes records of cells.
pub(super) struct Records {
    writer: Writer<Sink>,
    sink: Sink,
    record: ByteRecord,
    cell: Vec<u8>,
}

impl Records {
    pub(super) fn new() -> Self {
        let sink = Sink::default();
        let writer =
            WriterBuilder::new().terminator(Terminator::Any(b'\n')).flexible(true).from_writer(sink.clone());
        Self { writer, sink, record: ByteRecord::new(), cell: Vec::new() }
    }

    /// Writes a record. The sink is always writable, and records may have any length.
    pub(super) fn push<'a>(&mut self, cells: impl Iterator<Item = Cell<'a>>) {
        self.record.clear();
        for cell in cells {
            self.cell.clear();
            cell.write(&mut self.cell);
            self.record.push_field(&self.cell);
        }
        _ = self.writer.write_byte_record(&self.record);
    }

    /// Appends what has been written since the last time.
    pub(super) fn take(&mut self, text: &mut String) {
        _ = self.writer.flush();
        let mut bytes = self.sink.0.borrow_mut();
        text.push_str(&String::from_utf8_lossy(&bytes));
        bytes.clear();
    }
}

impl Table {
    /// As CSV; `remarks` are further comment lines, without their `#`.
    pub(crate) fn to_csv(&self, provenance: &Provenance, remarks: &[String]) -> String {
        let mut text = provenance.comment_lines();
        for remark in remarks {
            text.push_str(&format!("# {}\n", remark.replace(['\n', '\r'], " ")));
        }
        let mut records = Records::new();
        records.push(self.columns.iter().map(|column| Cell::text(&column.name)));
        for row in 0..self.rows() {
            records.push(self.columns.iter().map(|column| column.values.cell(row)));
        }
        records.take(&mut text);
        text
    }
}
