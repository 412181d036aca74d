//! What the readings say of their sensors: whether they can be used, have an offset that changed, are late or in another one's place.
pub mod health;
pub(super) mod lateness;
pub(super) mod parity;
pub mod thermometers;
pub(super) mod wiring;

/// What a difference of the first thermometer less the second is of one of them.
fn of_its_own(which: usize, difference: f64) -> f64 {
    if which == 0 { difference } else { -difference }
}
