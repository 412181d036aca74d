//! Which rows were taken last: a replay of them is no news, whatever its stamps say about the clock.
use serde::{Deserialize, Serialize};

use super::clock::Stray;

/// Rows that are remembered.
const REMEMBERED: usize = 128;
/// Constants of the FNV-1a hash of 64 bits.
const OFFSET_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const PRIME: u64 = 0x0000_0100_0000_01b3;

/// Hashes of the rows that were taken last.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Memory {
    hashes: Vec<u64>,
    next: usize,
}

impl Memory {
    /// Remember a row.
    pub fn keep(&mut self, hash: u64) {
        if self.hashes.len() < REMEMBERED {
            self.hashes.push(hash);
        } else {
            self.hashes[self.next] = hash;
        }
        self.next = (self.next + 1) % REMEMBERED;
    }

    /// Whether a row is one of those.
    pub fn knows(&self, hash: u64) -> bool {
        self.hashes.contains(&hash)
    }
}

/// FNV-1a over the bytes of stamp and readings; one NaN is as good as another.
pub(super) fn hash(row: &Stray) -> u64 {
    std::iter::once(&row.stamp_s)
        .chain(&row.readings)
        .map(|value| if value.is_nan() { f64::NAN } else { *value })
        .flat_map(|value| value.to_bits().to_le_bytes())
        .fold(OFFSET_BASIS, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME))
}
