//! A row of a log, as a source gives it and as a reader does.
use super::columns::{Columns, TruthQuantity};
use crate::thermal::units::Unit;

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Time, s; increasing, unless the log is read in any order.
    pub time_s: f64,
    /// Readings in the order of [`super::LogReader::channels`], SI; NaN is a missing value.
    pub readings: Vec<f64>,
    /// What is true, where the log knows it.
    pub truth: Truth,
    /// Line of a text log, or number of the row.
    pub number: u64,
}

/// True values of a row; NaN where the log does not know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Mean gas temperature, K.
    pub gas_mean_k: f64,
    /// Gas mass, kg.
    pub mass_kg: f64,
    /// Mass flow out of the cylinder, kg/s.
    pub outflow_kg_s: f64,
}

impl Truth {
    /// Nothing is known.
    pub(crate) const UNKNOWN: Self = Self { gas_mean_k: f64::NAN, mass_kg: f64::NAN, outflow_kg_s: f64::NAN };
}

/// What becomes of the cells of a row that comes without a log: units and ranges of the channels.
#[derive(Clone, Debug)]
pub(crate) struct RowScreen(pub(super) Vec<(usize, &'static Unit, (f64, f64))>);

impl RowScreen {
    /// Readings in the order of the channels, SI, from the cells by the positions of their columns; NaN for one that is missing or
    /// that no sensor can read.
    pub(crate) fn readings(&self, cell: impl Fn(usize) -> f64) -> Vec<f64> {
        let reading = |&(column, unit, (low, high)): &(usize, &'static Unit, (f64, f64))| {
            let value = unit.to_si(cell(column));
            if (low..=high).contains(&value) { value } else { f64::NAN }
        };
        self.0.iter().map(reading).collect()
    }
}

/// A row as a source gives it: readings, then truth, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct RawRow {
    pub time_s: f64,
    pub number: u64,
    pub values: Vec<f64>,
}

/// Makes a row of what a source gave.
pub(super) fn tell(raw: &RawRow, columns: &Columns, row: &mut Row) {
    (row.time_s, row.number, row.truth) = (raw.time_s, raw.number, Truth::UNKNOWN);
    let (readings, truth) = raw.values.split_at(columns.readings.len());
    row.readings.copy_from_slice(readings);
    for (column, &value) in columns.truth.iter().zip(truth) {
        match column.meaning {
            TruthQuantity::GasMean => row.truth.gas_mean_k = value,
            TruthQuantity::Mass => row.truth.mass_kg = value,
            TruthQuantity::Outflow => row.truth.outflow_kg_s = value,
        }
    }
}
