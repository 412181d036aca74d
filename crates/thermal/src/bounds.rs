//! Bounds of values, reported with the path of the value: those of specifications, and of what has been made of them.
use crate::error::{ThermalError, shown};
use crate::problem::{Problem, with_table, without_indices};
use alloc::borrow::ToOwned;
use alloc::boxed::Box;
use alloc::string::{String, ToString};

/// Temperatures a specification may state, K: what the fluids cover, and narrow enough to notice that °C were
/// written as K.
const TEMPERATURE_RANGE_K: (f64, f64) = (60.0, 1_500.0);

/// Pressures a specification may state, Pa.
pub(crate) const PRESSURE_RANGE_PA: (f64, f64) = (1.0, 2e8);

/// Most cells one count of a mesh may ask for.
const CELLS_MAX: usize = 200;

pub(crate) fn key_of(path: &str) -> String {
    let last = path.rsplit('.').next().unwrap_or(path);
    with_table(path, &without_indices(last))
}

pub(crate) fn at(path: &str, problem: Problem) -> ThermalError {
    ThermalError::Specification { path: path.to_owned(), problem: Box::new(problem) }
}

/// The error of a value at `path` that breaks `bound`.
// Readers of documents hand it on.
#[cfg_attr(not(feature = "files"), expect(unreachable_pub))]
pub fn broken(path: &str, value: impl ToString, bound: &str, remedy: &str) -> ThermalError {
    let (bound, remedy) = (bound.to_owned(), remedy.to_owned());
    at(path, Problem::Value { key: key_of(path), text: value.to_string(), bound, remedy })
}

/// A finite value above 0.
///
/// # Errors
/// Any other value.
pub(crate) fn positive(path: &str, value: f64, remedy: &str) -> Result<f64, ThermalError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(broken(path, shown(value), "positive", remedy))
    }
}

/// A finite value of at least 0.
///
/// # Errors
/// Any other value.
pub(crate) fn not_negative(path: &str, value: f64, remedy: &str) -> Result<f64, ThermalError> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(broken(path, shown(value), "at least 0", remedy))
    }
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
    if (range.0..=range.1).contains(&value) {
        Ok(value)
    } else {
        Err(broken(path, shown(value), bound, remedy))
    }
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
