//! What a document alone can get wrong, and the bounds of its values.
use super::{Problem, suggestion};
use crate::ThermalError;
pub use crate::bounds::broken;
pub(crate) use crate::bounds::{PRESSURE_RANGE_PA, not_negative, positive, within};
use crate::bounds::{at, key_of};
#[cfg(feature = "simulate")]
pub(crate) use crate::bounds::{fraction, pressure_pa, temperature_k};

/// The error of a key that has to be there.
pub(crate) fn missing(path: &str, remedy: &str) -> ThermalError {
    let key = super::keys::example(&key_of(path));
    at(path, Problem::Missing { key, remedy: remedy.to_owned() })
}

/// The error of a key that cannot stand beside another.
pub(crate) fn conflict(path: &str, other: &str, remedy: &str) -> ThermalError {
    let (other, remedy) = (other.to_owned(), remedy.to_owned());
    at(path, Problem::Conflict { key: key_of(path), other, remedy })
}

/// The error of a word that is none of the `known`.
pub(crate) fn unknown<'a>(path: &str, word: &str, known: impl IntoIterator<Item = &'a str>) -> ThermalError {
    let known: Vec<&str> = known.into_iter().collect();
    let nearest = suggestion(word, known.iter().copied());
    let known = known.join(", ");
    at(path, Problem::UnknownChoice { key: key_of(path), text: word.to_owned(), nearest, known })
}

/// A time for bounds in messages, in the largest unit that leaves it whole: `2 h`, `90 min`, `5 s`.
#[cfg(feature = "simulate")]
pub(crate) fn time_text(time_s: f64) -> String {
    match time_s {
        t if t != 0.0 && t % 3_600.0 == 0.0 => format!("{} h", t / 3_600.0),
        t if t != 0.0 && t % 60.0 == 0.0 => format!("{} min", t / 60.0),
        t => format!("{t} s"),
    }
}
