//! What is unmoved by a few outliers.
use alloc::vec::Vec;

/// Median, of an even number the upper one of the two in the middle; 0 of none.
pub(super) fn median(values: impl Iterator<Item = f64>) -> f64 {
    quantile(0.5, values)
}

/// The value that a part of all are below; 0 of none.
pub(super) fn quantile(part: f64, values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let place = (part * values.len() as f64) as usize;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(place, f64::total_cmp).1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_five_of_four_and_of_none() {
        assert_eq!(median([5.0, 1.0, 50.0, 2.0, -3.0].into_iter()), 2.0);
        assert_eq!(median([5.0, 1.0, 50.0, 2.0].into_iter()), 5.0);
        assert_eq!(median(std::iter::empty()), 0.0);
        assert_eq!(quantile(0.9, (0..20).map(f64::from)), 18.0);
    }
}
