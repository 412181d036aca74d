//! The tables and the page of a fleet that is done.
use super::arguments::TableFormat;
use super::folder::Folder;
use super::record::{self, Record};
use crate::cli::output::write_file;
use crate::report::fleet::{self, Cylinder, EventRow, Fault};
use crate::report::{Provenance, Table};
use std::path::Path;

/// What a run comes to.
pub(super) struct Results<'a> {
    /// Cylinders, the most urgent first.
    pub cylinders: &'a [Cylinder],
    /// What could not be read, sorted.
    pub faults: &'a [Fault],
    /// Where it comes from.
    pub provenance: &'a Provenance,
}

impl Results<'_> {
    /// Writes tables and page; what another format has left goes.
    pub(super) fn write(&self, folder: &Folder, format: TableFormat) -> anyhow::Result<()> {
        for (name, table) in self.tables(folder) {
            let path = |ending: &str| folder.file(&format!("{name}.{ending}"));
            write_file(&path(format.ending()), &bytes(&table, self.provenance, format)?)?;
            for other in ["csv", "parquet"].into_iter().filter(|other| *other != format.ending()) {
                remove_quietly(&path(other));
            }
        }
        write_file(
            &folder.file("page.html"),
            fleet::page(self.cylinders, self.faults, self.provenance).as_bytes(),
        )
    }

    /// The tables with their names.
    pub(super) fn tables(&self, folder: &Folder) -> [(&'static str, Table); 3] {
        [
            ("summary", fleet::summary(self.cylinders)),
            ("events", self.events(folder)),
            ("errors", fleet::errors(self.faults)),
        ]
    }

    /// All events, by cylinder and in their order; from the records, so that a run holds none of them.
    fn events(&self, folder: &Folder) -> Table {
        let with_events = self.cylinders.iter().filter(|one| one.events > 0);
        let mut names: Vec<&str> = with_events.map(|one| one.name.as_str()).collect();
        names.sort_unstable();
        let mut rows = Vec::new();
        for name in names {
            let told = record::read::<Record>(&folder.files(name).record);
            let told = told.map(|record| record.told).unwrap_or_default();
            rows.extend(told.into_iter().map(|told| EventRow {
                cylinder: name.to_owned(),
                time_s: told.time_s,
                time: told.time,
                event: told.event,
                id: told.id,
                words: told.words,
                line: told.line,
            }));
        }
        fleet::events(rows)
    }
}

fn bytes(table: &Table, provenance: &Provenance, format: TableFormat) -> anyhow::Result<Vec<u8>> {
    Ok(match format {
        TableFormat::Csv => table.to_csv(provenance, &[]).into_bytes(),
        #[cfg(feature = "parquet")]
        TableFormat::Parquet => table.to_parquet(provenance, &[])?,
    })
}

fn remove_quietly(path: &Path) {
    // It is not there as a rule.
    _ = std::fs::remove_file(path);
}
