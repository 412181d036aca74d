//! Which rows were taken lately, and where there were none: a replay is no news, whatever its stamps say about the clock.
//!
//! Rows are remembered by two Bloom filters that take turns: of the last 2000 to 4000 rows none is forgotten, and one in 45 others is
//! taken for one of them at most: `(1 - e^(-k n/m))^k` with `k = 4`, `n = 2000`, `m = 16384`.
//!
//! Source: B. H. Bloom, Commun. ACM 13 (1970) 422.
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::clock::Stray;
use super::exact;

/// Bits of a filter, `64 * WORDS`, and rows that it takes.
const WORDS: usize = 256;
const ROWS: u32 = 2000;
/// Bits of a row.
const BITS_OF_ROW: usize = 4;
/// Times without rows that are remembered.
const GAPS: usize = 16;
/// Constants of the FNV-1a hash of 64 bits.
const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0000_0100_0000_01b3;

/// Rows that were taken, and times without any.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Memory {
    young: Vec<u64>,
    old: Vec<u64>,
    rows: u32,
    gaps: VecDeque<Gap>,
}

/// A time without rows on the internal axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Gap {
    #[serde(with = "exact::number")]
    from_s: f64,
    #[serde(with = "exact::number")]
    to_s: f64,
}

impl Memory {
    /// Remember a row.
    pub fn keep(&mut self, hash: u64) {
        if self.young.is_empty() || self.rows == ROWS {
            self.old = std::mem::replace(&mut self.young, vec![0; WORDS]);
            self.rows = 0;
        }
        self.rows += 1;
        for (word, bit) in places(hash) {
            self.young[word] |= bit;
        }
    }

    /// Whether a row is one of those.
    pub fn knows(&self, hash: u64) -> bool {
        let holds =
            |filter: &[u64]| !filter.is_empty() && places(hash).all(|(word, bit)| filter[word] & bit != 0);
        holds(&self.young) || holds(&self.old)
    }

    /// Remember a time without rows, s.
    pub fn keep_gap(&mut self, from_s: f64, to_s: f64) {
        if self.gaps.len() == GAPS {
            self.gaps.pop_front();
        }
        self.gaps.push_back(Gap { from_s, to_s });
    }

    /// Whether a time, s, lies within one of those: a row of that time comes from a store.
    pub fn is_in_gap(&self, time_s: f64) -> bool {
        self.gaps.iter().any(|gap| time_s > gap.from_s && time_s < gap.to_s)
    }
}

/// Words and bits of a hash.
fn places(hash: u64) -> impl Iterator<Item = (usize, u64)> {
    (0..BITS_OF_ROW).map(move |k| {
        let place = (hash >> (16 * k)) as usize % (64 * WORDS);
        (place / 64, 1 << (place % 64))
    })
}

/// FNV-1a over the bytes of stamp and readings, mixed once more; one NaN is as good as another.
pub(super) fn hash(row: &Stray) -> u64 {
    let hash = std::iter::once(&row.stamp_s)
        .chain(&row.readings)
        .map(|value| if value.is_nan() { f64::NAN } else { *value })
        .flat_map(|value| value.to_bits().to_le_bytes())
        .fold(OFFSET_BASIS, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME));
    (hash ^ (hash >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) ^ (hash >> 17)
}
