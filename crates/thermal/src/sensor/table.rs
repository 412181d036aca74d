//! What a sensor's kind is read from.
use super::spec::SensorSpec;

/// A table with its path.
pub(super) struct Table<'a> {
    pub(super) spec: &'a SensorSpec,
    pub(super) path: &'a str,
    pub(super) is_pressure: bool,
}

impl Table<'_> {
    pub(super) fn at(&self, field: &str) -> String {
        format!("{}.{field}", self.path)
    }
}
