//! Units that durations and pressures are written in.
pub(crate) const MINUTE_S: f64 = 60.0;
pub(crate) const HOUR_S: f64 = 60.0 * MINUTE_S;
pub(crate) const DAY_S: f64 = 24.0 * HOUR_S;
pub(crate) const BAR_PA: f64 = 1e5;
