//! When rows are measured and how they are stamped.
//!
//! A row is due every interval and measured up to 2 % of it, at most 1 s, early or late. Up to 1 % of the rows are lost, each by
//! itself; gaps of 2 min to 6 h (evenly by the logarithm, at least two rows) begin once in ten days on average. Between day 20 and day 60 the
//! clock is set once: forward by 1 s to 1 h, or back by up to half an interval. Stamps are those of the clock.
use super::RowPattern;
use crate::random::{Purpose, Random};

const JITTER: f64 = 0.02;
const JITTER_MOST_S: f64 = 1.0;
const LOST_MOST: f64 = 0.01;
const GAP_EVERY_S: f64 = 10.0 * 86_400.0;
const GAP_S: (f64, f64) = (120.0, 6.0 * 3600.0);
const CLOCK_SET_S: (f64, f64) = (20.0 * 86_400.0, 60.0 * 86_400.0);
const CLOCK_FORWARD_S: (f64, f64) = (1.0, 3600.0);

/// Times of the rows of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Rows {
    /// When each was measured, s from the start of the log.
    pub time_s: Vec<f64>,
    /// How each is stamped, s.
    pub stamp_s: Vec<f64>,
    /// Stretches without rows: true begin and end, s.
    pub gaps_s: Vec<(f64, f64)>,
    /// When the clock is set, and by how much, s; `None`: not within the log.
    pub clock: Option<(f64, f64)>,
}

impl Rows {
    /// The rows of a log. `is_good_clock`: the clock is never set and there are no gaps, because a fault is judged by itself.
    pub(super) fn draw(pattern: RowPattern, length_s: f64, seed: u64, is_good_clock: bool) -> Self {
        let interval_s = pattern.interval_s();
        let random = &mut Random::new(seed, Purpose::WorldRows);
        let lost = random.uniform((0.0, LOST_MOST));
        let (set_at_s, by_s) = clock(interval_s, random);
        let gaps_s = if is_good_clock { Vec::new() } else { gaps(interval_s, length_s, seed) };
        let clock = (!is_good_clock && set_at_s < length_s).then_some((set_at_s, by_s));
        let jitter_s = (JITTER * interval_s).min(JITTER_MOST_S);
        let mut rows = Self { gaps_s, clock, ..Self::default() };
        let mut gap = 0;
        for row in 0..=(length_s / interval_s).floor() as usize {
            let due_s = row as f64 * interval_s;
            let (early_s, is_lost) = (random.uniform((-jitter_s, jitter_s)), random.happens(lost));
            let time_s = (due_s + early_s).clamp(0.0, length_s);
            while rows.gaps_s.get(gap).is_some_and(|(_, end_s)| *end_s <= time_s) {
                gap += 1;
            }
            let is_in_gap = rows.gaps_s.get(gap).is_some_and(|(begin_s, _)| *begin_s <= time_s);
            if (is_lost && row > 0) || is_in_gap {
                continue;
            }
            rows.time_s.push(time_s);
            rows.stamp_s.push(rows.stamp(time_s));
        }
        rows
    }

    /// A row exactly every interval, stamped with its time.
    pub(super) fn even(pattern: RowPattern, length_s: f64) -> Self {
        let interval_s = pattern.interval_s();
        let count = (length_s / interval_s).floor() as usize;
        let time_s: Vec<f64> = (0..=count).map(|row| row as f64 * interval_s).collect();
        Self { stamp_s: time_s.clone(), time_s, ..Self::default() }
    }

    /// Take away the rows of a stretch, s.
    pub(super) fn remove(&mut self, (from_s, until_s): (f64, f64)) {
        let kept = |time_s: f64| !(from_s..until_s).contains(&time_s);
        let mut of_stamp = self.time_s.iter().copied();
        self.stamp_s.retain(|_| of_stamp.next().is_some_and(kept));
        self.time_s.retain(|&time_s| kept(time_s));
        self.gaps_s.push((from_s, until_s));
    }

    /// Stamp of a true time, s.
    pub(super) fn stamp(&self, time_s: f64) -> f64 {
        match self.clock {
            Some((at_s, by_s)) if time_s >= at_s => time_s + by_s,
            _ => time_s,
        }
    }
}

fn clock(interval_s: f64, random: &mut Random) -> (f64, f64) {
    let at_s = random.uniform(CLOCK_SET_S);
    let forward_s = random.by_logarithm(CLOCK_FORWARD_S);
    let back_s = random.uniform((0.1, 0.5)) * interval_s;
    (at_s, if random.happens(0.5) { forward_s } else { -back_s })
}

fn gaps(interval_s: f64, length_s: f64, seed: u64) -> Vec<(f64, f64)> {
    let random = &mut Random::new(seed, Purpose::WorldGaps);
    let mut gaps = Vec::new();
    let mut t = 0.0;
    loop {
        t -= GAP_EVERY_S * (1.0 - random.uniform((0.0, 1.0))).ln();
        if t >= length_s {
            return gaps;
        }
        let lasting_s = random.by_logarithm(GAP_S).max(2.0 * interval_s);
        gaps.push((t, t + lasting_s));
        t += lasting_s;
    }
}
