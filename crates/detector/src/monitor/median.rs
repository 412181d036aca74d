//! What is unmoved by a few outliers.

/// Median, of an even number the upper one of the two in the middle; 0 of none.
pub(super) fn median(values: impl Iterator<Item = f64> + Clone) -> f64 {
    quantile(0.5, values)
}

/// The value that a part of all are below; 0 of none. It is found bit by bit, without memory for them.
pub(super) fn quantile(part: f64, values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count();
    let place = (part * count as f64) as usize;
    if count == 0 {
        return 0.0;
    }
    // The largest key that no more than `place` values are below.
    let mut found = 0_u64;
    for bit in (0..u64::BITS).rev() {
        let tried = found | 1 << bit;
        if values.clone().filter(|value| key(*value) < tried).count() <= place {
            found = tried;
        }
    }
    value(found)
}

/// A number in the order of `f64::total_cmp`.
fn key(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

fn value(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 1 { key & !(1 << 63) } else { !key })
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
        assert_eq!(median([f64::NAN, -0.0, f64::INFINITY].into_iter()), f64::INFINITY);
        assert_eq!(median([-3.0, -1e-300, -7.0].into_iter()), -3.0);
    }
}
