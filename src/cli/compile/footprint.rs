//! What a compiled cylinder takes on a controller: bytes of code, state, stack and arena, and instructions of a row.
//!
//! Its own bytes and those of its state are exact. Its arena is counted here, on 64 bits, while two days of rows go through. What depends
//! on the target is measured by `bindings/controller/test` with the reference cylinder, and embedded as a table.
use crate::cli::format::Format;
use crate::detector::compiled::CompiledCylinder;
use crate::detector::prognosis::Contents;
use crate::estimator::log::Quantity;
use crate::report::{Column, Provenance, Report, Table, Values};
use anyhow::Context;
use peak_alloc::PeakAlloc;
use serde_json::json;
use std::f64::consts::TAU;

/// A line for each target; the first is the arena on 64 bits.
const MEASURED: &str = include_str!("../../../assets/footprint.csv");

/// Column, words and unit of each quantity, in the order in which they are shown. The first ones are this cylinder's.
const QUANTITIES: [(&str, &str, &str); 14] = [
    ("cylinder_bytes", "compiled cylinder", "bytes"),
    ("state_bytes", "saved state", "bytes"),
    ("arena_begin_bytes", "arena to begin", "bytes"),
    ("arena_row_bytes", "arena between rows", "bytes"),
    ("arena_restore_bytes", "arena to restore", "bytes"),
    ("code_bytes", "code", "bytes"),
    ("constants_bytes", "constants", "bytes"),
    ("stack_begin_bytes", "stack to begin", "bytes"),
    ("stack_row_bytes", "stack of a row", "bytes"),
    ("stack_save_bytes", "stack to save", "bytes"),
    ("stack_restore_bytes", "stack to restore", "bytes"),
    ("instructions_row", "row on average", "instructions"),
    ("instructions_longest_row", "longest row", "instructions"),
    ("instructions_row_after_gap", "row after a gap of an hour", "instructions"),
];

const REMARKS: [&str; 2] = [
    "this cylinder: its arena is what the monitor asks for on this machine of 64 bits in two days of rows a minute apart with swings of \
     the temperature. A machine of 32 bits needs as much less as its column is below that of 64 bits; an allocator needs more for its blocks.",
    "64 bits and targets: the reference cylinder, a nitrogen-20l with two thermometers and a transmitter, in a day of rows 10 s apart \
     with a tunnel, a leak, a spike, missing cells and an hour's gap. Built with the profile `controller`, in QEMU, which counts \
     instructions and no cycles. Stack is that below the caller; to begin, all of it.",
];

/// Temperature about which the readings swing, and how far, K.
const MIDDLE_K: f64 = 288.15;
const SWING_K: f64 = 15.0;
/// Time between rows, s.
const ROW_S: f64 = 60.0;
/// Bytes of a state at most.
const STATE_AT_MOST: usize = 64 << 10;
/// What a monitor remembers is full after two days.
const ROWS: usize = 2 * 1440;

/// What a cylinder takes, and what the reference cylinder takes on targets.
pub(super) struct Footprint {
    name: String,
    /// Targets with the value of each quantity, where there is one.
    lines: Vec<(String, Vec<Option<i64>>)>,
}

impl Footprint {
    /// Of a cylinder and its bytes.
    pub(super) fn of(cylinder: &CompiledCylinder, bytes: &[u8]) -> anyhow::Result<Self> {
        let (state, arena) = run_dry(cylinder, bytes)?;
        let here = [Some(bytes.len()), Some(state)].into_iter().chain(arena);
        let mut here: Vec<_> = here.map(|value| value.and_then(|value| value.try_into().ok())).collect();
        here.resize(QUANTITIES.len(), None);
        let mut lines = vec![("this cylinder".to_owned(), here)];
        lines.append(&mut measured()?);
        Ok(Self { name: cylinder.vessel.name.clone(), lines })
    }

    /// For people, or as data.
    pub(super) fn written(&self, format: Option<Format>, provenance: &Provenance) -> anyhow::Result<String> {
        Ok(match format {
            None => self.report().to_text(),
            Some(Format::Csv) => self.table().to_csv(provenance, &[]),
            Some(Format::Json) => {
                let document =
                    json!({ "provenance": provenance.to_json(), "columns": self.table().to_json() });
                serde_json::to_string_pretty(&document)? + "\n"
            }
        })
    }

    /// A row for each target.
    fn table(&self) -> Table {
        let mut table = Table::new();
        table.push_texts("target", self.lines.iter().map(|(target, _)| target.clone()));
        for (at, (column, ..)) in QUANTITIES.iter().enumerate() {
            let values = self.lines.iter().map(|(_, values)| values[at]).collect();
            table.columns.push(integers(column, values));
        }
        table
    }

    /// A row for each quantity.
    fn report(&self) -> Report {
        let mut table = Table::new();
        table.push_texts("", QUANTITIES.iter().map(|(_, words, _)| (*words).to_owned()));
        for (target, values) in &self.lines {
            table.columns.push(integers(target, values.clone()));
        }
        table.push_texts("unit", QUANTITIES.iter().map(|(.., unit)| (*unit).to_owned()));
        let report = Report::new(format!("Footprint on a controller: {}", self.name)).table("", table);
        REMARKS.into_iter().fold(report, Report::text)
    }
}

fn integers(name: &str, values: Vec<Option<i64>>) -> Column {
    Column { name: name.to_owned(), unit: "", values: Values::Integers(values) }
}

/// The lines of the table.
fn measured() -> anyhow::Result<Vec<(String, Vec<Option<i64>>)>> {
    let damaged = "the embedded table of footprints is damaged: install the program again";
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(MEASURED.as_bytes());
    let header = reader.headers().context(damaged)?.clone();
    let places = QUANTITIES.map(|(column, ..)| header.iter().position(|name| name == column));
    let line = |record: csv::StringRecord| {
        let value = |place: Option<usize>| record.get(place?)?.parse().ok();
        (record[0].to_owned(), places.into_iter().map(value).collect())
    };
    reader.into_records().map(|record| Ok(line(record.context(damaged)?))).collect()
}

/// Bytes of the state after two days, and of the arena: to begin, between rows, to restore.
fn run_dry(cylinder: &CompiledCylinder, bytes: &[u8]) -> anyhow::Result<(usize, [Option<usize>; 3])> {
    let (rows, mut room) = (rows(cylinder)?, vec![0; STATE_AT_MOST]);
    let before = PeakAlloc.current_usage();
    let added = |bytes: usize| (before > 0).then(|| bytes.saturating_sub(before));
    PeakAlloc.reset_peak_usage();
    // What a controller holds: the cylinder as it was read, and its monitor.
    let begun = CompiledCylinder::from_bytes(bytes)?;
    let mut monitor = begun.monitor()?;
    let begin = PeakAlloc.peak_usage();
    let mut between = PeakAlloc.current_usage();
    for (row, readings) in rows.iter().enumerate() {
        monitor.take(row as f64 * ROW_S, readings)?;
        while monitor.next_output()?.is_some() {}
        between = between.max(PeakAlloc.current_usage());
    }
    PeakAlloc.reset_peak_usage();
    let state_bytes = monitor.save_into(&mut room)?;
    let state = room.get(..state_bytes).context("the state is longer than any")?;
    // An arena need not hold two.
    drop(monitor);
    let restored = begun.restored(state)?;
    let restore = PeakAlloc.peak_usage();
    // One that was restored may hold more.
    between = between.max(PeakAlloc.current_usage());
    drop(restored);
    Ok((state_bytes, [begin, between, restore].map(added)))
}

/// Readings of a cylinder that keeps its gas, in swings of a day and, smaller, of an hour and a half.
fn rows(cylinder: &CompiledCylinder) -> anyhow::Result<Vec<Vec<f64>>> {
    let CompiledCylinder { vessel, sensors, commissioning, .. } = cylinder;
    let mass_kg = commissioning.mass_kg(vessel, MIDDLE_K)?;
    let contents = Contents::of(vessel);
    let row = |row: usize| {
        let turns = row as f64 * ROW_S / 86_400.0;
        let gas_k = MIDDLE_K + SWING_K * ((TAU * turns).sin() + 0.2 * (TAU * 16.0 * turns).sin());
        let pressure_pa = contents.pressure_pa(mass_kg, gas_k)?;
        Ok(sensors
            .iter()
            .map(|sensor| match sensor.quantity() {
                Quantity::Pressure => pressure_pa,
                Quantity::Temperature => gas_k,
            })
            .collect())
    };
    (0..ROWS).map(row).collect()
}
