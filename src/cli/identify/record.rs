//! Columns of a log in memory, in the units that models are written in.
use crate::cli::input::LogInput;
use crate::estimator::log::Quantity;
use crate::log::columns::TruthQuantity;
use crate::log::{LogReader, Row};
use crate::report::identify::Signal;
use crate::thermal::units::{BAR_PA, Dimension, ZERO_CELSIUS_K, units_of};
use anyhow::{Context, bail};

/// What is true and may be identified from.
const GAS_MEAN: &str = "gas_mean";

/// Columns of a log, at the same times.
pub(super) struct Record {
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Columns in the order in which they were asked for.
    pub columns: Vec<NamedColumn>,
}

/// A column with its values, °C or bar; NaN is a missing value.
pub(super) struct NamedColumn {
    /// What it is.
    pub signal: Signal,
    /// Its values.
    pub values: Vec<f64>,
}

/// Where a column's values come from.
#[derive(Clone, Copy)]
enum Source {
    Channel(usize, Quantity),
    GasMean,
}

/// Name of a column as it was asked for, without its unit and in small letters.
pub(super) fn base_name(asked: &str) -> String {
    let name = asked.to_ascii_lowercase();
    let name = name.strip_prefix("measured_").unwrap_or(&name);
    let units = units_of(Dimension::Temperature).chain(units_of(Dimension::Pressure));
    let bases = units.filter_map(|unit| name.strip_suffix(unit.suffix)?.strip_suffix('_'));
    bases.min_by_key(|base| base.len()).unwrap_or(name).to_owned()
}

impl Source {
    /// Finds a column by its name without unit.
    fn find(reader: &LogReader, name: &str) -> anyhow::Result<Self> {
        let channels = reader.channels();
        if let Some(at) = channels.iter().position(|channel| channel.name.eq_ignore_ascii_case(name)) {
            return Ok(Self::Channel(at, channels[at].quantity));
        }
        let truth = &reader.columns().truth;
        let knows_gas = truth.iter().any(|column| column.meaning == TruthQuantity::GasMean);
        if knows_gas && name == GAS_MEAN {
            return Ok(Self::GasMean);
        }
        let mut known: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
        known.extend(knows_gas.then_some(GAS_MEAN));
        bail!("the log has no column {name}; it has {}: choose one of them, or give --map", known.join(", "))
    }

    fn signal(self, reader: &LogReader) -> Signal {
        match self {
            Self::Channel(at, Quantity::Temperature) => Signal::temperature(&reader.channels()[at].name),
            Self::Channel(at, Quantity::Pressure) => Signal::pressure(&reader.channels()[at].name),
            Self::GasMean => Signal::temperature(GAS_MEAN),
        }
    }

    fn value(self, row: &Row) -> f64 {
        match self {
            Self::Channel(at, Quantity::Temperature) => row.readings[at] - ZERO_CELSIUS_K,
            Self::Channel(at, Quantity::Pressure) => row.readings[at] / BAR_PA,
            Self::GasMean => row.truth.gas_mean_k - ZERO_CELSIUS_K,
        }
    }
}

impl Record {
    /// Reads the named columns; `progress` is told the share that has been read.
    pub(super) fn read(log: &mut LogInput, names: &[String], progress: impl Fn(f64)) -> anyhow::Result<Self> {
        let sources = names.iter().map(|name| Source::find(&log.reader, name));
        let sources = sources.collect::<anyhow::Result<Vec<_>>>()?;
        let column = |source: &Source| NamedColumn { signal: source.signal(&log.reader), values: Vec::new() };
        let mut record = Self { columns: sources.iter().map(column).collect(), time_s: Vec::new() };
        while let Some(row) = log.reader.next_row()? {
            record.time_s.push(row.time_s);
            for (column, source) in record.columns.iter_mut().zip(&sources) {
                column.values.push(source.value(row));
            }
            if record.time_s.len().is_multiple_of(1024) {
                progress(log.fraction());
            }
        }
        Ok(record)
    }

    /// The record before and in its last part, a fraction of its length in time.
    pub(super) fn split(self, fraction: f64) -> anyhow::Result<(Self, Self)> {
        let ends = self.time_s.first().zip(self.time_s.last()).context("the log has no rows")?;
        let at_s = ends.1 - fraction * (ends.1 - ends.0);
        let at = self.time_s.partition_point(|&time_s| time_s < at_s);
        let part = |range: std::ops::Range<usize>| Self {
            time_s: self.time_s[range.clone()].to_vec(),
            columns: self.columns.iter().map(|column| column.part(range.clone())).collect(),
        };
        Ok((part(0..at), part(at..self.time_s.len())))
    }
}

impl NamedColumn {
    fn part(&self, range: std::ops::Range<usize>) -> Self {
        Self { signal: self.signal.clone(), values: self.values[range].to_vec() }
    }
}
