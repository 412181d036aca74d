//! Quantiles of a column in memory that does not grow.

/// Values that are kept.
const SAMPLE_SIZE: usize = 4096;

/// Every value up to 4096, then every second, fourth, eighth ... one: a systematic sample in the order of time.
#[derive(Clone, Debug)]
pub(super) struct Sketch {
    values: Vec<f64>,
    /// One value in so many is kept.
    stride: u64,
    seen: u64,
}

impl Default for Sketch {
    fn default() -> Self {
        Self { values: Vec::new(), stride: 1, seen: 0 }
    }
}

impl Sketch {
    /// Takes in a value.
    pub(super) fn push(&mut self, value: f64) {
        if self.seen.is_multiple_of(self.stride) {
            if self.values.len() == SAMPLE_SIZE {
                let mut number = 0;
                self.values.retain(|_| {
                    number += 1;
                    number % 2 == 1
                });
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.values.push(value);
            }
        }
        self.seen += 1;
    }

    /// The value below which this share lies; NaN without values.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        sorted.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_exact_while_all_is_kept_and_near_beyond() {
        let mut sketch = Sketch::default();
        assert!(sketch.quantile(0.5).is_nan());
        (0..101).for_each(|k| sketch.push(f64::from(k * 37 % 101)));
        assert_eq!((sketch.quantile(0.0), sketch.quantile(0.5), sketch.quantile(1.0)), (0.0, 50.0, 100.0));
        (0..1_000_000).for_each(|k| sketch.push(f64::from(k % 1000)));
        assert!((sketch.quantile(0.5) - 500.0).abs() < 20.0);
        assert!(sketch.values.len() <= SAMPLE_SIZE);
    }
}
