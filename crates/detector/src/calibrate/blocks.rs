//! Moving-block bootstrap: new courses of residuals, put together from stretches of recorded ones.
//!
//! Blocks of a fixed length that begin anywhere in the record follow each other; within a block the correlation is that
//! of the record. Drawn independently they jump where they meet, which a whitening statistic takes for outliers;
//! matched blocks go on, instead, behind a sample whose value is close to the last one (drawn from its nearest
//! ranks), and so keep the dependence on the sample before.
//!
//! Block length: `n^(1/3) (2 phi/(1 - phi^2))^(2/3)`, optimal for the variance of a mean of AR(1) residuals, but not below ten
//! integrated correlation times `1 + 2 sum rho_k` and at most a fifth of the record.
//!
//! Assumes stationary residuals without a change. What the record does not hold, such as rarer weather, the
//! bootstrap cannot know: mean times far beyond the length of the record are extrapolations.
//!
//! Source: H. R. Kuensch, Ann. Stat. 17 (1989) 1217; E. Carlstein, Ann. Stat. 14 (1986) 1171; matched blocks: E. Carlstein,
//! K.-A. Do, P. Hall, T. Hesterberg and H. R. Kuensch, Bernoulli 4 (1998) 305.
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::ResidualSource;
use crate::DetectorError;
use crate::statistic::Residual;

/// Fewest residuals to draw from.
pub(super) const FEWEST: usize = 50;
/// Ranks to either side of the last value that a matched block may follow, as a share of the record.
const NEAREST: f64 = 0.001;

/// Residuals drawn from recorded ones, block by block.
#[derive(Clone, Debug)]
pub struct MovingBlocks {
    /// Values and intervals since the one before.
    record: Vec<(f64, f64)>,
    /// Indices in the order of their values; empty if blocks are not matched.
    ranks: Vec<usize>,
    block: usize,
    seed: u64,
    random: ChaCha8Rng,
    position: usize,
    left: usize,
    last: Option<Residual>,
}

impl MovingBlocks {
    /// Matched blocks of so many samples.
    ///
    /// # Errors
    /// There are fewer than 50 residuals, times do not increase, values are not finite, or the block is empty or longer
    /// than the record.
    pub fn try_new(residuals: &[Residual], block: usize, seed: u64) -> Result<Self, DetectorError> {
        let blocks = Self::independent(residuals, block, seed)?;
        let mut ranks: Vec<usize> = (0..blocks.record.len() - 1).collect();
        ranks.sort_by(|a, b| blocks.record[*a].0.total_cmp(&blocks.record[*b].0));
        Ok(Self { ranks, ..blocks })
    }

    /// Blocks drawn independently of each other, as Kuensch has it: for statistics of residuals that are nearly white.
    ///
    /// # Errors
    /// As [`Self::try_new`].
    pub fn independent(residuals: &[Residual], block: usize, seed: u64) -> Result<Self, DetectorError> {
        check(residuals)?;
        if block == 0 || block > residuals.len() {
            let bound = "between 1 and the number of residuals";
            return Err(DetectorError::Setting { setting: "block", value: block as f64, bound });
        }
        let mut intervals: Vec<f64> =
            residuals.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
        let mut sorted = intervals.clone();
        sorted.sort_by(f64::total_cmp);
        // Nobody knows what came before the first residual: the usual interval.
        intervals.insert(0, sorted[sorted.len() / 2]);
        let record = residuals.iter().zip(intervals).map(|(residual, interval)| (residual.value, interval));
        let record = record.collect();
        let random = ChaCha8Rng::seed_from_u64(seed);
        Ok(Self { record, ranks: Vec::new(), block, seed, random, position: 0, left: 0, last: None })
    }

    /// Where the next block begins.
    fn next_block(&mut self) -> usize {
        let n = self.record.len();
        let Some(last) = self.last.filter(|_| !self.ranks.is_empty()) else {
            return self.random.random_range(0..=n - self.block);
        };
        let reach = (NEAREST * n as f64).ceil() as usize;
        let rank = self.ranks.partition_point(|index| self.record[*index].0 < last.value);
        let (low, high) = (rank.saturating_sub(reach), (rank + reach).min(self.ranks.len() - 1));
        self.ranks[self.random.random_range(low.min(high)..=high)] + 1
    }
}

impl ResidualSource for MovingBlocks {
    type Sample = Residual;

    fn begin(&mut self, run: u64) {
        self.random = ChaCha8Rng::seed_from_u64(self.seed);
        self.random.set_stream(run);
        self.left = 0;
        self.last = None;
    }

    fn next_residual(&mut self) -> Residual {
        // A matched block may begin so late that the record ends before the block.
        if self.left == 0 || self.position >= self.record.len() {
            self.position = self.next_block();
            self.left = self.block;
        }
        let (value, interval_s) = self.record[self.position];
        self.position += 1;
        self.left -= 1;
        let time_s = self.last.map_or(0.0, |last| last.time_s + interval_s);
        let next = Residual { time_s, value };
        self.last = Some(next);
        next
    }
}

/// That residuals are enough, finite and in order.
pub(super) fn check(residuals: &[Residual]) -> Result<(), DetectorError> {
    let finite = residuals.iter().filter(|residual| residual.value.is_finite()).count();
    if finite < FEWEST || finite < residuals.len() {
        return Err(DetectorError::TooFewResiduals { found: finite, needed: residuals.len().max(FEWEST) });
    }
    let mut last_s = f64::NEG_INFINITY;
    for (index, residual) in residuals.iter().enumerate() {
        if !(residual.time_s > last_s && residual.time_s.is_finite()) {
            return Err(DetectorError::TimeBackwards { index, time_s: residual.time_s });
        }
        last_s = residual.time_s;
    }
    if residuals.iter().all(|residual| residual.value == residuals[0].value) {
        return Err(DetectorError::ResidualsConstant);
    }
    Ok(())
}

/// Autocorrelation at a lag, the mean taken off.
fn autocorrelation(values: &[f64], lag: usize) -> f64 {
    let square: f64 = values.iter().map(|value| value * value).sum();
    values.iter().zip(&values[lag..]).map(|(a, b)| a * b).sum::<f64>() / square
}

/// Integrated correlation time `1 + 2 sum rho_k` in samples, summed as long as pairs of neighbours are positive (Geyer).
///
/// # Errors
/// There are fewer than 50 residuals, one is not finite, or they do not vary.
pub fn autocorrelation_time(residuals: &[Residual]) -> Result<f64, DetectorError> {
    check(residuals)?;
    let values = centred(residuals);
    let mut time = -1.0;
    for pair in 0..values.len() / 4 {
        let sum = autocorrelation(&values, 2 * pair) + autocorrelation(&values, 2 * pair + 1);
        if sum <= 0.0 {
            break;
        }
        time += 2.0 * sum;
    }
    Ok(time.max(1.0))
}

/// Block length for residuals, samples.
///
/// # Errors
/// As [`autocorrelation_time`].
pub fn block_length(residuals: &[Residual]) -> Result<usize, DetectorError> {
    let time = autocorrelation_time(residuals)?;
    let n = residuals.len() as f64;
    let phi = autocorrelation(&centred(residuals), 1).clamp(0.0, 0.9999);
    let optimal = n.cbrt() * (2.0 * phi / (1.0 - phi * phi)).powf(2.0 / 3.0);
    Ok(optimal.max(10.0 * time).ceil().min(n / 5.0) as usize)
}

fn centred(residuals: &[Residual]) -> Vec<f64> {
    let mean = residuals.iter().map(|residual| residual.value).sum::<f64>() / residuals.len() as f64;
    residuals.iter().map(|residual| residual.value - mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::SimulatedNoise;
    use crate::statistic::Noise;

    fn record(phi: f64, n: usize) -> Vec<Residual> {
        let mut source = SimulatedNoise::try_new(Noise::ar1(2.0, phi, 60.0), 60.0, 11).unwrap();
        (0..n).map(|_| source.next_residual()).collect()
    }

    #[test]
    fn the_correlation_time_of_ar1_residuals_is_the_closed_form() {
        for phi in [0.0, 0.5, 0.9] {
            let found = autocorrelation_time(&record(phi, 100_000)).unwrap();
            let expected = (1.0 + phi) / (1.0 - phi);
            assert!((found / expected - 1.0).abs() < 0.15, "{phi}: {found}, expected {expected}");
        }
    }

    #[test]
    fn matched_blocks_keep_variance_and_correlation_where_independent_ones_lose_it() {
        let residuals = record(0.9, 20_000);
        let correlation = |mut blocks: MovingBlocks| {
            blocks.begin(3);
            let drawn: Vec<f64> = (0..40_000).map(|_| blocks.next_residual().value).collect();
            let variance = drawn.iter().map(|value| value * value).sum::<f64>() / drawn.len() as f64;
            (autocorrelation(&drawn, 1), variance)
        };
        let (matched, variance) = correlation(MovingBlocks::try_new(&residuals, 5, 1).unwrap());
        let (independent, _) = correlation(MovingBlocks::independent(&residuals, 5, 1).unwrap());
        assert!((matched - 0.9).abs() < 0.015, "{matched}");
        assert!((3.4..4.6).contains(&variance), "{variance}");
        // Four of five neighbours are in one block.
        assert!((independent - 0.72).abs() < 0.03, "{independent}");
    }

    #[test]
    fn runs_repeat_by_number_and_differ_between_numbers() {
        let mut blocks = MovingBlocks::try_new(&record(0.5, 500), 20, 9).unwrap();
        let mut draw = |run| {
            blocks.begin(run);
            (0..50).map(|_| blocks.next_residual().value).collect::<Vec<_>>()
        };
        assert_eq!(draw(1), draw(1));
        assert_ne!(draw(1), draw(2));
    }

    #[test]
    fn records_that_are_none_are_refused() {
        let good = record(0.5, 100);
        assert!(MovingBlocks::try_new(&good[..49], 5, 1).is_err());
        assert!(MovingBlocks::try_new(&good, 0, 1).is_err());
        assert!(MovingBlocks::try_new(&good, 101, 1).is_err());
        let mut wrong = good.clone();
        wrong[7].time_s = wrong[6].time_s;
        assert!(matches!(block_length(&wrong), Err(DetectorError::TimeBackwards { index: 7, .. })));
        wrong = good.clone();
        wrong[7].value = f64::NAN;
        assert!(block_length(&wrong).is_err());
        let constant: Vec<Residual> = good.iter().map(|r| Residual { value: 1.0, ..*r }).collect();
        assert!(matches!(block_length(&constant), Err(DetectorError::ResidualsConstant)));
    }
}
