//! Where the rows of a log come from.
use super::LogError;
use super::caution::Cautions;
use super::csv::CsvSource;
use super::inspect::Tap;
use super::memory::MemorySource;
use super::row::RawRow;
use super::time::TimeReader;

/// Where rows come from.
pub(super) enum Source {
    Csv(Box<CsvSource>),
    Memory(Box<MemorySource>),
    #[cfg(feature = "parquet")]
    Parquet(Box<super::parquet::ParquetSource>),
}

impl Source {
    /// Reads the next row that has a time; `false` at the end.
    pub(super) fn next(&mut self, row: &mut RawRow, cautions: &mut Cautions) -> Result<bool, LogError> {
        match self {
            Self::Csv(source) => source.next(row, cautions),
            Self::Memory(source) => source.next(row, cautions),
            #[cfg(feature = "parquet")]
            Self::Parquet(source) => source.next(row, cautions),
        }
    }

    /// Why a row is wrong: because the packed stream is damaged, if it is; else as it was said.
    pub(super) fn explained(&mut self, error: LogError) -> LogError {
        match self {
            Self::Csv(source) => source.damage().unwrap_or(error),
            Self::Memory(_) => error,
            #[cfg(feature = "parquet")]
            Self::Parquet(_) => error,
        }
    }

    /// Whether what comes next has not been taken from the input yet.
    pub(super) fn is_drained(&self) -> bool {
        match self {
            Self::Csv(source) => source.is_drained(),
            Self::Memory(_) => false,
            #[cfg(feature = "parquet")]
            Self::Parquet(_) => false,
        }
    }

    /// Place of a row for a message.
    pub(super) fn place(&self, number: u64) -> String {
        match self {
            Self::Csv(source) => source.place(number),
            Self::Memory(source) => source.place(number),
            #[cfg(feature = "parquet")]
            Self::Parquet(source) => source.place(number),
        }
    }

    /// What reads the times.
    pub(super) fn time_reader(&self) -> &TimeReader {
        match self {
            Self::Csv(source) => source.time_reader(),
            Self::Memory(source) => source.time_reader(),
            #[cfg(feature = "parquet")]
            Self::Parquet(source) => source.time_reader(),
        }
    }

    /// What counted the cells of a log that is inspected.
    pub(super) fn tap(&self) -> Option<&Tap> {
        match self {
            Self::Csv(source) => source.tap(),
            Self::Memory(_) => None,
            #[cfg(feature = "parquet")]
            Self::Parquet(_) => None,
        }
    }

    /// Share of the log that has been read, where the source says how long it is.
    pub(super) fn fraction(&self) -> Option<f64> {
        match self {
            Self::Csv(_) => None,
            Self::Memory(source) => Some(source.fraction()),
            #[cfg(feature = "parquet")]
            Self::Parquet(source) => Some(source.fraction()),
        }
    }
}
