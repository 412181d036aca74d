//! Which rows were taken lately, and where there were none: a replay is no news, whatever its stamps say about the clock.
//!
//! Of every row a fingerprint of 16 bits is kept, in four generations of 600 rows: of the last 1800 rows none is forgotten, and of the others one in 27,
//! `2400 / 2^16`, is taken for one of them at most. A generation is sorted, so that it is saved by the gaps between its fingerprints: 8.3 bits of a row.
//!
//! Source: set of fingerprints, L. Carter et al., STOC 1978, 59; code of the gaps, R. F. Rice, JPL Publication 79-22 (1979).
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::clock::Stray;
use crate::DetectorError;
use crate::monitor::restored;
use generation::Generation;

mod generation;

/// Rows of a generation, and generations.
const ROWS: u32 = 600;
const GENERATIONS: usize = 4;
/// Times without rows that are remembered.
const GAPS: usize = 16;
/// Constants of the FNV-1a hash of 64 bits.
const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0000_0100_0000_01b3;

/// Rows that were taken, and times without any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Memory {
    generations: [Generation; GENERATIONS],
    /// The one that grows, and rows in it.
    youngest: u8,
    rows: u32,
    gaps: SmallVec<[Gap; GAPS]>,
}

/// A time without rows on the internal axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Gap {
    from_s: f64,
    to_s: f64,
}

impl Default for Memory {
    fn default() -> Self {
        let generations = core::array::from_fn(|_| Generation::with_room());
        Self { generations, youngest: 0, rows: 0, gaps: SmallVec::new() }
    }
}

impl Memory {
    /// Checks one that was saved.
    pub(super) fn validate(&self) -> Result<(), DetectorError> {
        restored::at_most(ROWS as usize, "intake.memory.rows", self.rows as usize)?;
        let youngest = usize::from(self.youngest);
        restored::at_most(GENERATIONS - 1, "intake.memory.youngest", youngest)?;
        restored::at_most(GAPS, "intake.memory.gaps", self.gaps.len())?;
        let longest = self.generations.iter().map(Generation::len).max().unwrap_or(0);
        restored::at_most(ROWS as usize, "intake.memory.generations", longest)
    }

    /// Remember a row.
    pub(super) fn keep(&mut self, hash: u64) {
        if self.rows == ROWS {
            // The oldest one is forgotten.
            self.youngest = (self.youngest + 1) % GENERATIONS as u8;
            self.rows = 0;
        }
        let Some(youngest) = self.generations.get_mut(usize::from(self.youngest)) else { return };
        if self.rows == 0 {
            youngest.clear();
        }
        self.rows += 1;
        youngest.insert(fingerprint(hash));
    }

    /// Whether a row is one of those.
    pub(super) fn knows(&self, hash: u64) -> bool {
        self.generations.iter().any(|generation| generation.contains(fingerprint(hash)))
    }

    /// Remember a time without rows, s.
    pub(super) fn keep_gap(&mut self, from_s: f64, to_s: f64) {
        if self.gaps.len() == GAPS {
            self.gaps.remove(0);
        }
        self.gaps.push(Gap { from_s, to_s });
    }

    /// Whether a time, s, lies within one of those: a row of that time comes from a store.
    pub(super) fn is_in_gap(&self, time_s: f64) -> bool {
        self.gaps.iter().any(|gap| time_s > gap.from_s && time_s < gap.to_s)
    }
}

fn fingerprint(hash: u64) -> u16 {
    (hash >> 48) as u16
}

/// FNV-1a over the bytes of stamp and readings, mixed once more; one NaN is as good as another.
pub(super) fn hash(row: &Stray) -> u64 {
    let hash = core::iter::once(&row.stamp_s)
        .chain(&row.readings)
        .map(|value| if value.is_nan() { f64::NAN } else { *value })
        .flat_map(|value| value.to_bits().to_le_bytes())
        .fold(OFFSET_BASIS, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME));
    (hash ^ (hash >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) ^ (hash >> 17)
}
