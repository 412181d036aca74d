//! Calm windows, of which there are hundreds, in whole numbers: when each began, ms, and sums over its rows in units of half a millikelvin.
//!
//! Thermometers read in hundredths, thousandths or sixteenths of a kelvin: the difference of two of them is exact so. What the pressure stands for is rounded.
use alloc::collections::VecDeque;
use alloc::vec::Vec;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::sealed::List;

/// The unit, K.
const UNIT_K: f64 = 5e-4;
/// Length of a window, ms.
const WINDOW_MS: i64 = (1e3 * super::WINDOW_S) as i64;
/// Where there is no pressure.
const NONE: i32 = i32::MIN;

/// Means of a calm window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Calm {
    begun_ms: i64,
    rows: u32,
    /// Sum of the first less the second thermometer, units.
    apart: i32,
    /// Mean of the first less the temperature that the pressure stands for, units.
    above: i32,
}

impl Calm {
    /// A window that began then, s, of so many rows, with the sums of two thermometers and the temperature that the pressure stands for, K, NaN without a
    /// pressure.
    pub(super) fn new(begun_s: f64, rows: u32, sums_k: [f64; 2], gas_k: f64) -> Self {
        let units = |of_k: f64| libm::round(of_k / UNIT_K) as i32;
        let above = if gas_k.is_nan() { NONE } else { units(sums_k[0] / f64::from(rows) - gas_k) };
        Self { begun_ms: libm::round(1e3 * begun_s) as i64, rows, apart: units(sums_k[0] - sums_k[1]), above }
    }

    /// When it began, s.
    pub(super) fn begun_s(&self) -> f64 {
        self.begun_ms as f64 / 1e3
    }

    /// First less second thermometer, K.
    pub(super) fn apart_k(&self) -> f64 {
        UNIT_K * f64::from(self.apart) / f64::from(self.rows)
    }

    /// Each less the temperature that the pressure stands for, K; NaN without a pressure.
    pub(super) fn above_k(&self) -> [f64; 2] {
        let first_k = if self.above == NONE { f64::NAN } else { UNIT_K * f64::from(self.above) };
        [first_k, first_k - self.apart_k()]
    }
}

/// Write windows in whole numbers: twice the time since the end of the one before, ms, and one more if it has another number of rows, which then follows; the
/// difference; the rise.
pub(super) fn serialize<S: Serializer>(windows: &VecDeque<Calm>, serializer: S) -> Result<S::Ok, S::Error> {
    let (mut end_ms, mut usual_rows) = (0_i64, 0);
    let whole = windows.iter().flat_map(move |calm| {
        let since_ms = calm.begun_ms.wrapping_sub(end_ms);
        let rows = (calm.rows != usual_rows).then_some(calm.rows);
        (end_ms, usual_rows) = (calm.begun_ms.wrapping_add(WINDOW_MS), calm.rows);
        let head = since_ms.wrapping_mul(2) | i64::from(rows.is_some());
        [Some(head), rows.map(i64::from), Some(calm.apart.into()), Some(calm.above.into())]
            .into_iter()
            .flatten()
    });
    List(whole).serialize(serializer)
}

/// Read windows.
pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<VecDeque<Calm>, D::Error> {
    let mut whole = Vec::<i64>::deserialize(deserializer)?.into_iter();
    let (mut end_ms, mut rows) = (0_i64, 0);
    let mut windows = VecDeque::new();
    while let Some(head) = whole.next() {
        let mut next = || whole.next().ok_or_else(|| D::Error::custom("a window ends early"));
        if head & 1 == 1 {
            rows = u32::try_from(next()?).map_err(D::Error::custom)?;
        }
        let [apart, above] = [next()?, next()?].map(i32::try_from);
        let begun_ms = end_ms.wrapping_add(head >> 1);
        end_ms = begun_ms.wrapping_add(WINDOW_MS);
        let (apart, above) = (apart.map_err(D::Error::custom)?, above.map_err(D::Error::custom)?);
        windows.push_back(Calm { begun_ms, rows, apart, above });
    }
    Ok(windows)
}

#[cfg(test)]
mod tests {
    use serde::Serialize;

    use super::*;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Saved(#[serde(with = "super")] VecDeque<Calm>);

    #[test]
    fn windows_come_back_in_eight_bytes_each() {
        let window = |n: u32| {
            let gas_k = if n.is_multiple_of(7) { f64::NAN } else { 279.0 };
            let rows = 5 + n / 100;
            Calm::new(1.7e9 + 600.1 * f64::from(n), rows, [1400.0 + 0.01 * f64::from(n), 1400.3], gas_k)
        };
        let saved = Saved((0..400).map(window).collect());
        let bytes = postcard::to_allocvec(&saved).unwrap();
        assert!(bytes.len() < 3200, "{} bytes", bytes.len());
        assert_eq!(postcard::from_bytes::<Saved>(&bytes).unwrap(), saved);
        let cut = postcard::to_allocvec(&vec![3_i64, 5, 0]).unwrap();
        assert!(postcard::from_bytes::<Saved>(&cut).is_err(), "a window without a rise");
    }

    #[test]
    fn a_difference_of_readings_in_hundredths_or_sixteenths_is_that_of_their_means() {
        for step_k in [0.01, 0.0625] {
            let sums_k = [23.0, 31.0].map(|steps| 3.0 * 280.0 + steps * step_k);
            let calm = Calm::new(0.0, 3, sums_k, 280.1);
            assert!((calm.apart_k() + 8.0 * step_k / 3.0).abs() < 1e-12);
            let [first_k, second_k] = calm.above_k();
            assert!((first_k - (23.0 * step_k / 3.0 - 0.1)).abs() <= 0.5 * UNIT_K);
            assert!((first_k - second_k - calm.apart_k()).abs() < 1e-12);
        }
        assert!(Calm::new(0.0, 3, [840.0; 2], f64::NAN).above_k().iter().all(|of_k| of_k.is_nan()));
    }
}
