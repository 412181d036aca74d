//! A sorted set of fingerprints, saved in Rice's code: of each gap between two of them the quotient by 128 as so many ones and a zero, and seven bits of the rest.
use alloc::vec::Vec;
use core::iter;
use serde::{Deserialize, Serialize, Serializer};

use crate::sealed::List;

/// Bits of the rest: 600 fingerprints of 16 bits are 109 apart.
const REST_BITS: u32 = 7;

/// Fingerprints, sorted, each once.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "(u16, Vec<u8>)")]
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

impl Generation {
    fn bits(&self) -> impl Iterator<Item = bool> + Clone {
        let nexts = iter::once(0).chain(self.0.iter().map(|before| u32::from(*before) + 1));
        self.0.iter().zip(nexts).flat_map(|(fingerprint, next)| {
            let gap = u32::from(*fingerprint) - next;
            let rest = (0..REST_BITS).map(move |bit| gap >> bit & 1 == 1);
            iter::repeat_n(true, (gap >> REST_BITS) as usize).chain([false]).chain(rest)
        })
    }

    fn bytes(&self) -> impl Iterator<Item = u8> + Clone {
        let mut bits = self.bits();
        iter::from_fn(move || {
            let first = u8::from(bits.next()?);
            Some((1..8).fold(first, |byte, bit| byte | u8::from(bits.next().unwrap_or(false)) << bit))
        })
    }
}

/// As `(u16, Vec<u8>)`, without its memory.
impl Serialize for Generation {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (self.0.len() as u16, List(self.bytes())).serialize(serializer)
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

    fn coded(generation: &Generation) -> (u16, Vec<u8>) {
        postcard::from_bytes(&postcard::to_allocvec(generation).unwrap()).unwrap()
    }

    #[test]
    fn any_set_comes_back() {
        for length in [0, 1, 2, 37, 600] {
            let coded = coded(&generation(length));
            assert_eq!(Generation::try_from(coded), Ok(generation(length)));
        }
        let extremes = Generation(vec![0, 1, 2, u16::MAX - 1, u16::MAX]);
        assert_eq!(Generation::try_from(coded(&extremes)), Ok(extremes));
    }

    #[test]
    fn a_full_one_takes_nine_bits_of_a_fingerprint_at_most() {
        let (_, bytes) = coded(&generation(600));
        assert!(8 * bytes.len() < 9 * 600, "{} bytes", bytes.len());
    }

    #[test]
    fn a_code_that_ends_early_or_goes_too_far_is_refused() {
        let (length, bytes) = coded(&generation(600));
        assert!(Generation::try_from((length, bytes[..bytes.len() - 1].to_vec())).is_err());
        assert!(Generation::try_from((length + 1, bytes)).is_err());
        assert!(Generation::try_from((1, vec![u8::MAX; 1000])).is_err());
    }
}
