//! A sorted set of fingerprints, saved in Rice's code: of each gap between two of them the quotient by 128 as so many ones and a zero, and seven bits of the rest.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

/// Bits of the rest: 600 fingerprints of 16 bits are 109 apart.
const REST_BITS: u32 = 7;

/// Fingerprints, sorted, each once.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(into = "(u16, Vec<u8>)", try_from = "(u16, Vec<u8>)")]
pub(super) struct Generation(Vec<u16>);

impl Generation {
    /// None, with memory for as many as one has.
    pub(super) fn with_room() -> Self {
        Self(Vec::with_capacity(super::ROWS as usize))
    }

    pub(super) fn insert(&mut self, fingerprint: u16) {
        if let Err(at) = self.0.binary_search(&fingerprint) {
            self.0.insert(at, fingerprint);
        }
    }

    /// Nothing any more; the memory stays.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    pub(super) fn contains(&self, fingerprint: u16) -> bool {
        self.0.binary_search(&fingerprint).is_ok()
    }
}

impl From<Generation> for (u16, Vec<u8>) {
    fn from(Generation(sorted): Generation) -> Self {
        let (mut bits, mut next) = (Vec::new(), 0);
        for fingerprint in &sorted {
            let gap = u32::from(*fingerprint) - next;
            next = u32::from(*fingerprint) + 1;
            bits.extend((0..gap >> REST_BITS).map(|_| true).chain([false]));
            bits.extend((0..REST_BITS).map(|bit| gap >> bit & 1 == 1));
        }
        let byte = |bits: &[bool]| bits.iter().rev().fold(0, |byte, bit| byte << 1 | u8::from(*bit));
        (sorted.len() as u16, bits.chunks(8).map(byte).collect())
    }
}

impl TryFrom<(u16, Vec<u8>)> for Generation {
    type Error = &'static str;

    fn try_from((length, bytes): (u16, Vec<u8>)) -> Result<Self, Self::Error> {
        const BAD: &str = "the code of a generation is none";
        let mut bits = bytes.iter().flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1 == 1));
        let mut next = 0_u32;
        let Self(mut sorted) = Self::with_room();
        for _ in 0..length {
            while bits.next().ok_or(BAD)? {
                next += 1 << REST_BITS;
            }
            for bit in 0..REST_BITS {
                next += u32::from(bits.next().ok_or(BAD)?) << bit;
            }
            sorted.push(u16::try_from(next).map_err(|_| BAD)?);
            next += 1;
        }
        Ok(Self(sorted))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// So many fingerprints, spread evenly but for a little.
    fn generation(length: u32) -> Generation {
        let mut generation = Generation::default();
        (0..length).for_each(|n| generation.insert((n.wrapping_mul(2_654_435_769) >> 16) as u16));
        generation
    }

    #[test]
    fn any_set_comes_back() {
        for length in [0, 1, 2, 37, 600] {
            let coded = <(u16, Vec<u8>)>::from(generation(length));
            assert_eq!(Generation::try_from(coded), Ok(generation(length)));
        }
        let extremes = Generation(vec![0, 1, 2, u16::MAX - 1, u16::MAX]);
        assert_eq!(Generation::try_from(<(u16, Vec<u8>)>::from(extremes.clone())), Ok(extremes));
    }

    #[test]
    fn a_full_one_takes_nine_bits_of_a_fingerprint_at_most() {
        let (_, bytes) = generation(600).into();
        assert!(8 * bytes.len() < 9 * 600, "{} bytes", bytes.len());
    }

    #[test]
    fn a_code_that_ends_early_or_goes_too_far_is_refused() {
        let (length, bytes) = generation(600).into();
        assert!(Generation::try_from((length, bytes[..bytes.len() - 1].to_vec())).is_err());
        assert!(Generation::try_from((length + 1, bytes)).is_err());
        assert!(Generation::try_from((1, vec![u8::MAX; 1000])).is_err());
    }
}
