//! How high the evidence rises without a leak, and the thresholds that follow for a vessel.
//!
//! The monitor runs over leak-free worlds ([`Campaign`], [`monitor_all`]). The largest values of its statistics ([`Record`]) give their tails (`fit`), and
//! these the thresholds of a mean time between false alarms. [`commission`] finds both for a vessel, and the rate of false alarms that such
//! thresholds have in cylinders that they were not fitted to (`cross_validation`).
mod campaign;
mod commissioned;
mod cross_validation;
mod fit;
mod monitored;
mod record;

pub use campaign::{Campaign, monitor_all};
pub use commissioned::{Commissioned, CommissionedScale, FitSettings, commission};
pub use monitored::{MonitoredCylinder, monitor};
pub use record::Record;
