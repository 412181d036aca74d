//! Bounds of specification values, reported with the path of the value.
use super::{Problem, suggestion, with_table};
use crate::ThermalError;

/// Temperatures a specification may state, K: what the fluids cover, and narrow enough to notice that °C were
/// written as K.
pub(crate) const TEMPERATURE_RANGE_K: (f64, f64) = (60.0, 1_500.0);

/// Pressures a specification may state, Pa.
pub(crate) const PRESSURE_RANGE_PA: (f64, f64) = (1.0, 2e8);

/// Most cells one count of a mesh may ask for.
pub(crate) const CELLS_MAX: usize = 200;

fn key_of(path: &str) -> String {
    let last = path.rsplit('.').next().unwrap_or(path);
    with_table(path, &super::without_indices(last))
}

fn at(path: &str, problem: Problem) -> ThermalError {
    ThermalError::Specification { path: path.to_owned(), problem: Box::new(problem) }
}

/// The error of a value at `path` that breaks `bound`.
pub fn broken(path: &str, value: impl ToString, bound: &str, remedy: &str) -> ThermalError {
    let (bound, remedy) = (bound.to_owned(), remedy.to_owned());
    at(path, Problem::Value { key: key_of(path), text: value.to_string(), bound, remedy })
}

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

/// A finite value above 0.
///
/// # Errors
/// Any other value.
pub(crate) fn positive(path: &str, value: f64, remedy: &str) -> Result<f64, ThermalError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(broken(path, value, "positive", remedy)) }
}

/// A finite value of at least 0.
///
/// # Errors
/// Any other value.
pub(crate) fn not_negative(path: &str, value: f64, remedy: &str) -> Result<f64, ThermalError> {
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err(broken(path, value, "at least 0", remedy)) }
}

/// A finite value between bounds, both included; `bound` says them in words.
///
/// # Errors
/// Any other value.
pub(crate) fn within(
    path: &str,
    value: f64,
    range: (f64, f64),
    bound: &str,
    remedy: &str,
) -> Result<f64, ThermalError> {
    if (range.0..=range.1).contains(&value) { Ok(value) } else { Err(broken(path, value, bound, remedy)) }
}

/// A fraction, 0 to 1.
///
/// # Errors
/// Any other value.
pub(crate) fn fraction(path: &str, value: f64, remedy: &str) -> Result<f64, ThermalError> {
    within(path, value, (0.0, 1.0), "between 0 and 1", remedy)
}

/// A temperature in `TEMPERATURE_RANGE_K`.
///
/// # Errors
/// Any other value.
pub(crate) fn temperature_k(path: &str, value: f64) -> Result<f64, ThermalError> {
    let bound = "between 60 K and 1500 K (-213 degC and 1227 degC)";
    within(path, value, TEMPERATURE_RANGE_K, bound, "check the unit, _degc or _k")
}

/// An absolute pressure in `PRESSURE_RANGE_PA`.
///
/// # Errors
/// Any other value.
pub(crate) fn pressure_pa(path: &str, value: f64) -> Result<f64, ThermalError> {
    let bound = "between 1 Pa and 2000 bar absolute";
    within(
        path,
        value,
        PRESSURE_RANGE_PA,
        bound,
        "check the unit, _bar is absolute and _barg above the atmosphere",
    )
}

/// A count of cells, `least` to `CELLS_MAX`.
///
/// # Errors
/// Any other value.
pub(crate) fn cells(path: &str, value: usize, least: usize) -> Result<usize, ThermalError> {
    if (least..=CELLS_MAX).contains(&value) {
        return Ok(value);
    }
    Err(broken(path, value, &format!("between {least} and {CELLS_MAX}"), "3 to 10 cells are usual"))
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
