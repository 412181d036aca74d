//! Onsets that thin out with age: every one of the newest, then one of two, of four, and so on.
//!
//! Level `j` holds `per_octave` to `per_octave + 1` hypotheses, each the survivor of `2^j` successive onsets. When a
//! level is full its two oldest hypotheses meet and the one with more evidence moves up a level. A sample causes one
//! meeting on average, at most one per level.
//!
//! What is lost: onsets of level `j` are at least `per_octave (2^j - 1)` samples old, so the grid point nearest to the
//! true onset misses it by less than the share `eps = 2^j/(per_octave (2^j - 1))` of its age, `2/per_octave` at worst
//! and about `1/per_octave` on old levels. A likelihood ratio of an onset that is wrong by the share `eps` of the age
//! keeps, in white noise, at least the share `1/(1 + eps)` of its expected value for a step and about
//! `1 - 3 eps^2/4` for a ramp. That the survivor is the one with more evidence makes the actual loss smaller.
//!
//! Source: exponential histogram, M. Datar, A. Gionis, P. Indyk and R. Motwani, SIAM J. Comput. 31 (2002) 1794.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// Something assumed to have begun at some time.
pub trait OnsetHypothesis {
    /// How well it explains the samples so far; the larger one of two survives.
    fn evidence(&self) -> f64;
}

/// Hypotheses in the order of their age, fewer the older they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OnsetGrid<H> {
    per_octave: usize,
    /// From new to old; within a level the oldest in front.
    levels: Vec<VecDeque<H>>,
}

impl<H: OnsetHypothesis> OnsetGrid<H> {
    /// Onsets up to at least `window` pushes ago, `per_octave` (at least 2) per doubling of age.
    pub fn new(window: usize, per_octave: usize) -> Self {
        let per_octave = per_octave.max(2);
        // The oldest survivor may be the newest of its 2^(levels - 1) onsets.
        let reach =
            |levels: u32| per_octave.saturating_mul((1_usize << levels) - 1) - (1_usize << (levels - 1));
        let deepest = usize::BITS - 2;
        let levels = (1..deepest).find(|levels| reach(*levels) >= window).unwrap_or(deepest);
        let level = || VecDeque::with_capacity(per_octave + 2);
        Self { per_octave, levels: (0..levels).map(|_| level()).collect() }
    }

    /// Add the newest onset; `leave` is given each hypothesis that leaves the grid.
    pub fn push(&mut self, newest: H, mut leave: impl FnMut(H)) {
        let mut moving = newest;
        for level in &mut self.levels {
            level.push_back(moving);
            if level.len() < self.per_octave + 2 {
                return;
            }
            let [Some(older), Some(newer)] = [level.pop_front(), level.pop_front()] else { return };
            let (survivor, loser) =
                if older.evidence() >= newer.evidence() { (older, newer) } else { (newer, older) };
            leave(loser);
            moving = survivor;
        }
        leave(moving);
    }

    /// All hypotheses, level by level.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &H> {
        self.levels.iter().rev().flatten()
    }

    /// All hypotheses, to be changed, level by level.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut H> {
        self.levels.iter_mut().flatten()
    }

    /// The one with the most evidence.
    pub fn best(&self) -> Option<&H> {
        self.iter().max_by(|a, b| a.evidence().total_cmp(&b.evidence()))
    }

    /// Forget all.
    pub fn clear(&mut self) {
        self.levels.iter_mut().for_each(VecDeque::clear);
    }
}
