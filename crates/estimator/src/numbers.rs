//! Numbers as they are saved: each in as few bytes as hold all of its bits.
//!
//! A run of up to 64 numbers of one width has a byte for width and length before it. Zero takes no byte, a number of single precision four, one of which
//! single precision has nothing but zeros in its last 16 bits ([`coarse`]) two, any other eight: little endian.
use alloc::vec::Vec;
use core::iter::Peekable;
use serde::de::Error;
use serde::ser::SerializeSeq;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

const LONGEST_RUN: usize = 64;

/// Bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Width {
    None,
    Coarse,
    Single,
    Double,
}

impl Width {
    const ALL: [Self; 4] = [Self::None, Self::Coarse, Self::Single, Self::Double];

    fn of(value: f64) -> Self {
        let single = value as f32;
        match () {
            () if value.to_bits() == 0 => Self::None,
            // How a NaN is converted is not certain.
            () if value.is_nan() || f64::from(single).to_bits() != value.to_bits() => Self::Double,
            () if single.to_bits().trailing_zeros() < 16 => Self::Single,
            () => Self::Coarse,
        }
    }

    fn bytes(self) -> usize {
        [0, 2, 4, 8][self as usize]
    }

    /// The bytes of a number are the first ones.
    fn write(self, value: f64) -> [u8; 8] {
        if self == Self::Double {
            return value.to_le_bytes();
        }
        let mut bytes = [0; 8];
        let single = (value as f32).to_le_bytes();
        bytes[..self.bytes()].copy_from_slice(&single[4 - self.bytes()..]);
        bytes
    }

    fn read(self, bytes: &[u8]) -> f64 {
        let mut whole = [0; 8];
        if self == Self::Double {
            whole.copy_from_slice(bytes);
            return f64::from_le_bytes(whole);
        }
        let mut single = [0; 4];
        single[4 - bytes.len()..].copy_from_slice(bytes);
        f32::from_le_bytes(single).into()
    }
}

/// The nearest number with 8 significant bits, itself where there is none: for what need not be known better than to 0.2 %.
pub(crate) fn coarse(value: f64) -> f64 {
    let bits = (value as f32).to_bits();
    let rounded = f32::from_bits(bits.saturating_add(0x7fff + (bits >> 16 & 1)) & 0xffff_0000);
    if rounded.is_normal() { rounded.into() } else { value }
}

/// The nearest number of single precision, itself where there is none.
pub(crate) fn single(value: f64) -> f64 {
    let rounded = value as f32;
    if rounded.is_normal() { rounded.into() } else { value }
}

/// Write numbers.
pub(crate) fn serialize<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    All(values.iter().copied()).serialize(serializer)
}

/// The same of numbers wherever they are.
pub(crate) struct All<I>(pub I);

impl<I: Iterator<Item = f64> + Clone> Serialize for All<I> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let runs = || Runs(self.0.clone().peekable());
        let bytes = runs().map(|run| 1 + run.length * run.width.bytes()).sum();
        let mut to = serializer.serialize_seq(Some(bytes))?;
        for Run { width, length, values } in runs() {
            to.serialize_element(&((width as u8) << 6 | (length - 1) as u8))?;
            for value in &values[..length] {
                let bytes = width.write(*value).into_iter().take(width.bytes());
                bytes.into_iter().try_for_each(|byte| to.serialize_element(&byte))?;
            }
        }
        to.end()
    }
}

/// Up to 64 numbers of one width.
struct Run {
    width: Width,
    length: usize,
    values: [f64; LONGEST_RUN],
}

struct Runs<I: Iterator<Item = f64>>(Peekable<I>);

impl<I: Iterator<Item = f64>> Iterator for Runs<I> {
    type Item = Run;

    fn next(&mut self) -> Option<Run> {
        let width = Width::of(*self.0.peek()?);
        let mut run = Run { width, length: 0, values: [0.0; LONGEST_RUN] };
        for to in &mut run.values {
            let Some(value) = self.0.next_if(|value| Width::of(*value) == width) else { break };
            *to = value;
            run.length += 1;
        }
        Some(run)
    }
}

/// Read numbers.
pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let bytes = Vec::<u8>::deserialize(deserializer)?;
    let (mut values, mut left) = (Vec::new(), bytes.as_slice());
    while let Some((&head, after)) = left.split_first() {
        let (width, length) = (Width::ALL[usize::from(head >> 6)], usize::from(head & 0x3f) + 1);
        let run = after.split_at_checked(length * width.bytes());
        let (run, after) = run.ok_or_else(|| D::Error::custom("a run of numbers ends early"))?;
        values.extend((0..length).map(|n| width.read(&run[n * width.bytes()..][..width.bytes()])));
        left = after;
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Serialize, Deserialize)]
    struct Saved(#[serde(with = "super")] Vec<f64>);

    fn bytes(values: &[f64]) -> Vec<u8> {
        postcard::to_allocvec(&Saved(values.to_vec())).unwrap()
    }

    #[test]
    fn every_bit_comes_back() {
        let odd = [
            0.0,
            -0.0,
            1.0,
            -1.5,
            f64::NAN,
            -f64::NAN,
            f64::INFINITY,
            0.1,
            f64::from(0.1_f32),
            1e-300,
            1e300,
        ];
        let odd =
            odd.into_iter().chain([f64::from_bits(0x7ff0_0000_0000_0001), f64::MIN_POSITIVE, 1e-45, 5e-324]);
        let many: Vec<f64> = odd.cycle().take(1000).chain((0..1000).map(f64::from)).collect();
        let Saved(back) = postcard::from_bytes(&bytes(&many)).unwrap();
        let bits = |of: &[f64]| of.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&back), bits(&many));
    }

    #[test]
    fn a_number_takes_no_more_bytes_than_it_needs() {
        // And three: the length of all, twice that of a run.
        let each = |value: f64| bytes(&[value; 100]).len();
        assert_eq!([0.0, 1.0, f64::from(0.1_f32), 0.1].map(each), [3, 204, 404, 804]);
        assert_eq!([coarse(0.1), single(0.1)].map(each), [204, 404]);
    }

    #[test]
    fn a_rounded_number_is_the_nearest() {
        for value in [0.1, -3.7e-20, 1.0 + 1.0 / 256.0 + 1e-9, 12345.678] {
            assert!((coarse(value) / value - 1.0).abs() <= 1.0 / 256.0);
            assert!((single(value) / value - 1.0).abs() <= f64::from(f32::EPSILON) / 2.0);
        }
        let none = [0.0, f64::INFINITY, f64::NEG_INFINITY, 1e-300, 1e300];
        assert_eq!((none.map(coarse), none.map(single)), (none, none));
        assert!(coarse(f64::NAN).is_nan() && single(f64::NAN).is_nan());
    }

    #[test]
    fn a_run_that_ends_early_is_refused() {
        let whole = bytes(&[0.1; 3]);
        for length in 2..whole.len() {
            let mut cut = whole[..length].to_vec();
            cut[0] = length as u8 - 1;
            assert!(postcard::from_bytes::<Saved>(&cut).is_err(), "{length} bytes");
        }
    }
}
