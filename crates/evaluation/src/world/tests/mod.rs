//! Tests of worlds: laws of what is drawn, simulations, readings, overlays.
mod chamber;
mod disturbances;
mod laws;
mod overlays;
mod processes;
mod readings;
mod rows;
mod worlds;

use super::{Family, Request};
use cylwatch_thermal::units::DAY_S;

fn family(key: &str) -> Family {
    key.parse().unwrap()
}

/// A tight world of a family.
fn request(key: &str, seed: u64, days: f64) -> Request {
    Request::tight(family(key), seed, days * DAY_S)
}
