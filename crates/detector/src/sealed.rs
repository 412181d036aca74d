//! Bytes that are kept or sent: a monitor's state, a cylinder for a controller. Whatever is damaged or foreign is refused.
//!
//! ```text
//! magic 8 | version u32 | fingerprint 16 | length u64 | payload | check sum of all before 16        little endian
//! ```
//!
//! Check sum and fingerprint are SipHash-1-3 with 128 bits: they find accidents, not forgery. The fingerprint is that of what the bytes
//! belong to; of a state it is vessel, sensors and what the settings say of the rows: it goes on only with the same. The payload is in
//! postcard's format, which keeps every bit of every number. What is kept rounded is rounded when it is kept, not when it is saved.
use alloc::vec::Vec;
use core::hash::Hasher;
use postcard::ser_flavors::Flavor;
use serde::de::DeserializeOwned;
use serde::ser::SerializeSeq;
use serde::{Serialize, Serializer};
use siphasher::sip128::{Hasher128, SipHasher13};

const HEAD: usize = 8 + 4 + SUM + 8;
const SUM: usize = 16;

/// What bytes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// State of a monitor.
    State,
    /// A cylinder that has been compiled for a controller.
    Cylinder,
    /// A cylinder that has been compiled to be simulated.
    Plant,
    /// State of an instance of a co-simulation.
    Instance,
}

impl Kind {
    /// Version of the payload: one more with every change of what it holds.
    pub const fn version(self) -> u32 {
        match self {
            Self::State => 27,
            Self::Cylinder | Self::Plant | Self::Instance => 1,
        }
    }

    const fn magic(self) -> &'static [u8; 8] {
        match self {
            Self::State => b"cylwatch",
            Self::Cylinder => b"cylinder",
            Self::Plant => b"cylplant",
            Self::Instance => b"cyl-inst",
        }
    }
}

impl core::fmt::Display for Kind {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::State => "state of a monitor",
            Self::Cylinder => "compiled cylinder",
            Self::Plant => "compiled plant",
            Self::Instance => "state of an instance",
        })
    }
}

/// Why bytes cannot be used. In place of a state a cold start can always be declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SealError {
    /// It is something else.
    #[error("this is no {0}")]
    Other(Kind),
    /// Written by another version.
    #[error("the {kind} has version {found}, this program reads version {}", kind.version())]
    Version {
        /// What it is.
        kind: Kind,
        /// Version as found.
        found: u32,
    },
    /// Of another vessel, other sensors or other settings.
    #[error("the {0} is that of another vessel, other sensors or other settings")]
    Foreign(Kind),
    /// It ends too early.
    #[error("the {kind} is cut short: {found} bytes of {expected}")]
    Cut {
        /// What it is.
        kind: Kind,
        /// Bytes as found.
        found: usize,
        /// Bytes as stated in it.
        expected: usize,
    },
    /// Its check sum is wrong.
    #[error("the {0} is corrupted: its check sum is wrong")]
    Corrupted(Kind),
    /// It cannot be saved with this engine.
    #[error("only the state of a monitor with the extended Kalman filter can be saved")]
    Engine,
}

/// Hash of all that bytes belong to.
pub type Fingerprint = [u8; SUM];

/// Fingerprint of things by their bytes.
pub fn fingerprint(of: &impl Serialize) -> Fingerprint {
    // Nothing that has one fails to be put into bytes; if it did, it would fit nothing but itself.
    postcard::serialize_with_flavor(of, Hashed(SipHasher13::new())).unwrap_or([0; SUM])
}

fn sum(bytes: &[u8]) -> [u8; SUM] {
    SipHasher13::new().hash(bytes).as_bytes()
}

/// Elements as those of a list that need not be made: they are counted first.
pub(crate) struct List<I>(pub I);

impl<I: Iterator<Item: Serialize> + Clone> Serialize for List<I> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut to = serializer.serialize_seq(Some(self.0.clone().count()))?;
        self.0.clone().try_for_each(|element| to.serialize_element(&element))?;
        to.end()
    }
}

/// Bytes of which the hash is wanted alone.
struct Hashed(SipHasher13);

impl Flavor for Hashed {
    type Output = [u8; SUM];

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.try_extend(&[byte])
    }

    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        self.0.write(bytes);
        Ok(())
    }

    fn finalize(self) -> postcard::Result<[u8; SUM]> {
        Ok(self.0.finish128().as_bytes())
    }
}

/// Bytes that are written as far as there is room, and counted.
struct Fitted<'a> {
    room: &'a mut [u8],
    length: usize,
}

impl Flavor for Fitted<'_> {
    type Output = usize;

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.try_extend(&[byte])
    }

    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        let end = self.length + bytes.len();
        if let Some(to) = self.room.get_mut(self.length..end) {
            to.copy_from_slice(bytes);
        }
        self.length = end;
        Ok(())
    }

    fn finalize(self) -> postcard::Result<usize> {
        Ok(self.length)
    }
}

/// The bytes of a value.
///
/// # Errors
/// [`SealError::Engine`].
pub fn encode<T: Serialize>(kind: Kind, value: &T, fingerprint: &Fingerprint) -> Result<Vec<u8>, SealError> {
    let mut bytes = postcard::to_extend(value, vec![0; HEAD]).map_err(|_| SealError::Engine)?;
    bytes.resize(bytes.len() + SUM, 0);
    seal(kind, fingerprint, &mut bytes);
    Ok(bytes)
}

/// The same into `room`, and how many they are: if more than there is room for, what is in it means nothing. Allocates nothing that the value does not.
///
/// # Errors
/// [`SealError::Engine`].
pub fn encode_into<T: Serialize>(
    kind: Kind,
    value: &T,
    fingerprint: &Fingerprint,
    room: &mut [u8],
) -> Result<usize, SealError> {
    let payload = Fitted { room: room.get_mut(HEAD..).unwrap_or_default(), length: 0 };
    let length = postcard::serialize_with_flavor(value, payload).map_err(|_| SealError::Engine)?;
    let whole = HEAD + length + SUM;
    if let Some(bytes) = room.get_mut(..whole) {
        seal(kind, fingerprint, bytes);
    }
    Ok(whole)
}

/// Write head and check sum around a payload.
fn seal(kind: Kind, fingerprint: &Fingerprint, bytes: &mut [u8]) {
    let length = bytes.len() - HEAD - SUM;
    bytes[..8].copy_from_slice(kind.magic());
    bytes[8..12].copy_from_slice(&kind.version().to_le_bytes());
    bytes[12..12 + SUM].copy_from_slice(fingerprint);
    bytes[HEAD - 8..HEAD].copy_from_slice(&(length as u64).to_le_bytes());
    let (body, check) = bytes.split_at_mut(HEAD + length);
    check.copy_from_slice(&sum(body));
}

/// A value from its bytes.
///
/// # Errors
/// As [`SealError`] says.
pub fn decode<T: DeserializeOwned>(
    kind: Kind,
    bytes: &[u8],
    fingerprint: &Fingerprint,
) -> Result<T, SealError> {
    open(kind, bytes, fingerprint)?.part()
}

/// What bytes hold, part by part in the order in which it was written.
#[derive(Debug)]
pub struct Payload<'a> {
    kind: Kind,
    left: &'a [u8],
}

impl Payload<'_> {
    /// The next part.
    ///
    /// # Errors
    /// [`SealError::Corrupted`].
    pub fn part<T: DeserializeOwned>(&mut self) -> Result<T, SealError> {
        let (part, left) =
            postcard::take_from_bytes(self.left).map_err(|_| SealError::Corrupted(self.kind))?;
        self.left = left;
        Ok(part)
    }

    /// The next part, over another one.
    ///
    /// # Errors
    /// As [`part`](Self::part).
    #[inline(never)]
    pub fn read<T: DeserializeOwned>(&mut self, to: &mut T) -> Result<(), SealError> {
        *to = self.part()?;
        Ok(())
    }
}

/// What bytes hold that are whole, of this kind and of what the fingerprint is of.
///
/// # Errors
/// As [`SealError`] says.
pub fn open<'a>(kind: Kind, bytes: &'a [u8], fingerprint: &Fingerprint) -> Result<Payload<'a>, SealError> {
    let part = |from: usize, length: usize| bytes.get(from..from + length);
    let known = kind.magic().len().min(bytes.len());
    if bytes.is_empty() || part(0, known) != kind.magic().get(..known) {
        return Err(SealError::Other(kind));
    }
    let cut = |expected| SealError::Cut { kind, found: bytes.len(), expected };
    let corrupted = SealError::Corrupted(kind);
    let version = part(8, 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let version = version.ok_or(cut(HEAD + SUM))?;
    if version != kind.version() {
        return Err(SealError::Version { kind, found: version });
    }
    let length = part(HEAD - 8, 8).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes);
    let length = usize::try_from(length.ok_or(cut(HEAD + SUM))?).map_err(|_| corrupted)?;
    let expected = length.checked_add(HEAD + SUM).ok_or(corrupted)?;
    if bytes.len() < expected {
        return Err(cut(expected));
    }
    let (body, check) = bytes.split_at(HEAD + length);
    if check != sum(body) {
        return Err(corrupted);
    }
    if part(12, SUM) != Some(fingerprint.as_slice()) {
        return Err(SealError::Foreign(kind));
    }
    Ok(Payload { kind, left: &body[HEAD..] })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes() -> Vec<u8> {
        encode(Kind::State, &vec![f64::NAN, f64::INFINITY, -0.0, 1e-300], &fingerprint(&"vessel")).unwrap()
    }

    fn read(bytes: &[u8]) -> Result<Vec<f64>, SealError> {
        decode(Kind::State, bytes, &fingerprint(&"vessel"))
    }

    #[test]
    fn every_bit_comes_back() {
        let numbers = read(&bytes()).unwrap();
        let bits: Vec<u64> = numbers.iter().map(|number| number.to_bits()).collect();
        assert_eq!(bits, [f64::NAN, f64::INFINITY, -0.0, 1e-300].map(f64::to_bits));
    }

    #[test]
    fn bytes_in_room_that_is_there_are_the_same_and_too_little_room_is_told() {
        let value = vec![f64::NAN, f64::INFINITY, -0.0, 1e-300];
        let whole = bytes();
        let mut room = [0xa5; 200];
        for length in [0, 1, HEAD - 1, HEAD, whole.len() - 1, whole.len(), 200] {
            let needed =
                encode_into(Kind::State, &value, &fingerprint(&"vessel"), &mut room[..length]).unwrap();
            assert_eq!(needed, whole.len());
            assert_eq!(length >= needed, room[..needed] == whole, "room for {length}");
        }
        assert_eq!(room[whole.len()..], [0xa5; 200][whole.len()..]);
    }

    #[test]
    fn a_fingerprint_is_the_hash_of_the_bytes() {
        let of = ("vessel", 1.5, vec![7_u64; 9]);
        assert_eq!(fingerprint(&of), sum(&postcard::to_allocvec(&of).unwrap()));
    }

    #[test]
    fn whatever_is_cut_or_changed_is_refused() {
        let whole = bytes();
        for length in 0..whole.len() {
            let refused = read(&whole[..length]).unwrap_err();
            let told = matches!(refused, SealError::Cut { .. })
                || (length == 0 && refused == SealError::Other(Kind::State));
            assert!(told, "{length} bytes: {refused}");
        }
        for at in 0..whole.len() {
            let mut changed = whole.clone();
            changed[at] ^= 0x40;
            assert!(read(&changed).is_err(), "byte {at}");
        }
        assert_eq!(read(b"time_s,pressure_bar\n"), Err(SealError::Other(Kind::State)));
        let other: Result<Vec<f64>, _> = decode(Kind::State, &whole, &fingerprint(&"another"));
        assert_eq!(other, Err(SealError::Foreign(Kind::State)));
    }
}
