//! Wall time of a call: repetitions of batches, each long enough for the clock, after a warm-up.
use serde::Serialize;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Shortest batch: thousands of times the resolution of the clock.
const BATCH: Duration = Duration::from_micros(500);
/// Repetitions at least, however long one takes.
const REPETITIONS: usize = 5;

/// How long to measure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stopwatch {
    budget: Duration,
}

/// Times of one call, s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Timing {
    /// Shortest batch: what the machine can do when nobody disturbs it.
    pub minimum_s: f64,
    /// Quartiles of the batches.
    pub lower_s: f64,
    /// Median of the batches.
    pub median_s: f64,
    /// Upper quartile of the batches.
    pub upper_s: f64,
    /// Batches.
    pub repetitions: usize,
}

impl Stopwatch {
    /// Spend about `budget` on each timing; zero runs everything once or a few times.
    pub(crate) fn new(budget: Duration) -> Self {
        Self { budget }
    }

    /// Time of one call of `run`, which stands for `parts` equal parts: the time of a part.
    pub(crate) fn time<T>(&self, parts: usize, mut run: impl FnMut() -> T) -> Timing {
        let mut timed = |calls: usize| {
            let start = Instant::now();
            (0..calls).for_each(|_| drop(black_box(run())));
            start.elapsed()
        };
        let mut calls = 1;
        while timed(calls) < BATCH.min(self.budget) {
            calls *= 2;
        }
        let begin = Instant::now();
        let mut batches = Vec::new();
        while batches.len() < REPETITIONS || begin.elapsed() < self.budget {
            batches.push(timed(calls).as_secs_f64() / (calls * parts) as f64);
            if self.budget.is_zero() {
                break;
            }
        }
        batches.sort_by(f64::total_cmp);
        let quantile = |q: f64| batches[(q * (batches.len() - 1) as f64).round() as usize];
        Timing {
            minimum_s: quantile(0.0),
            lower_s: quantile(0.25),
            median_s: quantile(0.5),
            upper_s: quantile(0.75),
            repetitions: batches.len(),
        }
    }
}
