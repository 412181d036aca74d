//! Options that say how a log is to be read.
use clap::Args;
use cylwatch::log::{LogOptions, Mapping, Zone};

/// Foreign names and zone.
#[derive(Clone, Debug, Default, Args)]
pub struct LogArguments {
    /// Column of the log with a foreign name, as shoulder_degc=T1, or time=Datum+Zeit; may be given again.
    #[arg(long = "map", value_name = "OURS=THEIRS")]
    pub mappings: Vec<Mapping>,
    /// Offset from UTC of dates that do not say theirs, as +01:00 [default: UTC, with a caution].
    #[arg(long, value_name = "OFFSET", allow_hyphen_values = true)]
    pub zone: Option<Zone>,
}

impl LogArguments {
    /// As options of a reader that knows these sensors, too.
    pub fn options(&self, sensors: Vec<String>) -> LogOptions {
        LogOptions { mappings: self.mappings.clone(), zone: self.zone, sensors, ..LogOptions::default() }
    }
}
