//! Course of a quantity in bounded memory, for a sparkline.
use serde::{Deserialize, Serialize};

/// Most points.
pub(crate) const POINTS: usize = 48;

/// Means over stretches of time of equal length; where they would become too many, two become one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Trace {
    start_s: f64,
    width_s: f64,
    /// Sum and count of each stretch.
    stretches: Vec<(f64, u32)>,
}

impl Trace {
    /// Width of the first stretches, s.
    const FIRST_S: f64 = 60.0;

    /// Takes in a value; one that is no number, or that lies before the first, is left out.
    pub(crate) fn push(&mut self, time_s: f64, value: f64) {
        if !(value.is_finite() && time_s.is_finite()) {
            return;
        }
        if self.stretches.is_empty() {
            (self.start_s, self.width_s) = (time_s, Self::FIRST_S);
        }
        let past_s = time_s - self.start_s;
        if past_s < 0.0 {
            return;
        }
        while past_s >= POINTS as f64 * self.width_s {
            self.stretches = self
                .stretches
                .chunks(2)
                .map(|pair| pair.iter().fold((0.0, 0), |sum, part| (sum.0 + part.0, sum.1 + part.1)))
                .collect();
            self.width_s *= 2.0;
        }
        let index = (past_s / self.width_s) as usize;
        if self.stretches.len() <= index {
            self.stretches.resize(index + 1, (0.0, 0));
        }
        let stretch = &mut self.stretches[index];
        *stretch = (stretch.0 + value, stretch.1 + 1);
    }

    /// The means, NaN where nothing was seen.
    pub(crate) fn means(&self) -> Vec<f64> {
        let mean = |&(sum, count): &(f64, u32)| if count == 0 { f64::NAN } else { sum / f64::from(count) };
        self.stretches.iter().map(mean).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_year_of_a_falling_line_stays_a_falling_line_of_few_points() {
        let mut trace = Trace::default();
        for minute in 0..500_000 {
            trace.push(60.0 * f64::from(minute), 200.0 - 1e-4 * f64::from(minute));
        }
        let means = trace.means();
        assert!((POINTS / 2..=POINTS).contains(&means.len()), "{}", means.len());
        assert!(means.windows(2).all(|pair| pair[1] < pair[0]));
        assert!((means[0] - 200.0).abs() < 1.0);
    }

    #[test]
    fn a_gap_is_no_number_and_what_is_none_is_left_out() {
        let mut trace = Trace::default();
        trace.push(0.0, 1.0);
        trace.push(10.0, 3.0);
        trace.push(30.0, f64::NAN);
        trace.push(-5.0, 100.0);
        trace.push(150.0, 5.0);
        let means = trace.means();
        assert_eq!((means[0], means[1].is_nan(), means[2]), (2.0, true, 5.0));
    }
}
