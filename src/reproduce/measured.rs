//! The measured blowdown I1, embedded (see `data/haque_i1/README.md` for its source).

/// A measured curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Times, s, increasing.
    pub time_s: Vec<f64>,
    /// Values, in the unit of its place.
    pub value: Vec<f64>,
}

/// The measured curves of run I1.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Pressure, bar.
    pub pressure_bar: Curve,
    /// Warmest gas thermocouple, K.
    pub(crate) gas_high_k: Curve,
    /// Coldest gas thermocouple, K.
    pub(crate) gas_low_k: Curve,
    /// Upper edge of the inner-wall temperatures, K.
    pub wall_high_k: Curve,
    /// Lower edge of the inner-wall temperatures, K.
    pub(crate) wall_low_k: Curve,
}

/// The embedded files with their names, for the record of what was read.
pub(crate) const FILES: [(&str, &str); 5] = [
    ("data/haque_i1/pressure.csv", include_str!("../../data/haque_i1/pressure.csv")),
    ("data/haque_i1/gas_high.csv", include_str!("../../data/haque_i1/gas_high.csv")),
    ("data/haque_i1/gas_low.csv", include_str!("../../data/haque_i1/gas_low.csv")),
    ("data/haque_i1/wall_high.csv", include_str!("../../data/haque_i1/wall_high.csv")),
    ("data/haque_i1/wall_low.csv", include_str!("../../data/haque_i1/wall_low.csv")),
];

impl Measured {
    /// The curves as they were digitised.
    pub fn embedded() -> Self {
        let [pressure_bar, gas_high_k, gas_low_k, wall_high_k, wall_low_k] =
            FILES.map(|(_, text)| Curve::of(text));
        Self { pressure_bar, gas_high_k, gas_low_k, wall_high_k, wall_low_k }
    }

    /// Middle of the gas band: the paired points of its edges, which are at most 0.4 s apart.
    pub fn gas_middle_k(&self) -> Curve {
        let mean = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect();
        Curve {
            time_s: mean(&self.gas_high_k.time_s, &self.gas_low_k.time_s),
            value: mean(&self.gas_high_k.value, &self.gas_low_k.value),
        }
    }
}

impl Curve {
    fn of(text: &str) -> Self {
        let numbers = |line: &str| -> Option<(f64, f64)> {
            let (time, value) = line.split_once(',')?;
            Some((time.trim().parse().ok()?, value.trim().parse().ok()?))
        };
        let (time_s, value) = text.lines().filter_map(numbers).unzip();
        Self { time_s, value }
    }

    /// Value at a time, linear between points and constant beyond them.
    pub(crate) fn at(&self, time_s: f64) -> f64 {
        interpolated(&self.time_s, &self.value, time_s)
    }
}

/// Value at `t` of a curve through points, linear between them and constant beyond.
pub(crate) fn interpolated(times: &[f64], values: &[f64], t: f64) -> f64 {
    let next = times.partition_point(|&time| time <= t);
    match next {
        0 => values.first().copied().unwrap_or(f64::NAN),
        n if n == times.len() => values[n - 1],
        n => {
            let weight = (t - times[n - 1]) / (times[n] - times[n - 1]);
            values[n - 1] + weight * (values[n] - values[n - 1])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_embedded_curve_has_its_21_points_in_order() {
        let all = Measured::embedded();
        for curve in [&all.pressure_bar, &all.gas_high_k, &all.gas_low_k, &all.wall_high_k, &all.wall_low_k] {
            assert_eq!((curve.time_s.len(), curve.value.len()), (21, 21));
            assert!(curve.time_s.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }

    #[test]
    fn the_curves_start_as_published_and_the_high_ones_lie_above_the_low_ones() {
        let all = Measured::embedded();
        assert!((all.pressure_bar.at(0.0) - 150.0).abs() < 0.1);
        // Within the first points' spacing the digitised edges touch.
        for second in 6..100 {
            let t = f64::from(second);
            assert!(
                all.gas_high_k.at(t) > all.gas_low_k.at(t) && all.wall_high_k.at(t) > all.wall_low_k.at(t)
            );
        }
    }
}
