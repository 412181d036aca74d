//! A monitor's state as bytes: what continues after a restart, and what is refused.
//!
//! ```text
//! magic 8 | version u32 | fingerprint 16 | length u64 | payload | check sum of all before 16        little endian
//! ```
//!
//! Check sum and fingerprint are SipHash-1-3 with 128 bits: they find accidents, not forgery. The fingerprint is that of vessel, sensors and what the settings say of the rows: a state goes on only with the same. The payload is
//! the state in postcard's format, which keeps every bit of every number. What is kept rounded is rounded when it is kept, not when it is saved.
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use siphasher::sip128::SipHasher13;

const MAGIC: &[u8; 8] = b"cylwatch";
/// Version of the payload: one more with every change of what it holds.
pub const VERSION: u32 = 25;
const HEAD: usize = 8 + 4 + SUM + 8;
const SUM: usize = 16;

/// Why a state cannot be continued from. A cold start can always be declared instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
pub enum StateError {
    /// It is something else.
    #[error("this is no state of a monitor")]
    NoState,
    /// Written by another version.
    #[error("the state has version {found}, this program reads version {expected}")]
    Version {
        /// As found.
        found: u32,
        /// As needed.
        expected: u32,
    },
    /// Of another vessel, other sensors or other settings.
    #[error("the state is that of another vessel, other sensors or other settings")]
    Foreign,
    /// It ends too early.
    #[error("the state is cut short: {found} bytes of {expected}")]
    Cut {
        /// Bytes as found.
        found: usize,
        /// Bytes as stated in it.
        expected: usize,
    },
    /// Its check sum is wrong.
    #[error("the state is corrupted: its check sum is wrong")]
    Corrupted,
    /// It cannot be saved with this engine.
    #[error("only the state of a monitor with the extended Kalman filter can be saved")]
    Engine,
}

/// Hash of all that a state belongs to.
pub type Fingerprint = [u8; SUM];

/// Fingerprint of things by how they print.
pub fn fingerprint(of: &dyn std::fmt::Debug) -> Fingerprint {
    sum(format!("{of:?}").as_bytes())
}

fn sum(bytes: &[u8]) -> [u8; SUM] {
    SipHasher13::new().hash(bytes).as_bytes()
}

/// The bytes of a state.
///
/// # Errors
/// [`StateError::Engine`].
pub fn encode<T: Serialize>(state: &T, fingerprint: &Fingerprint) -> Result<Vec<u8>, StateError> {
    let payload = postcard::to_stdvec(state).map_err(|_| StateError::Engine)?;
    let mut bytes = Vec::with_capacity(HEAD + payload.len() + SUM);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(fingerprint);
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&payload);
    let check = sum(&bytes);
    bytes.extend_from_slice(&check);
    Ok(bytes)
}

/// A state from its bytes.
///
/// # Errors
/// As [`StateError`] says.
pub fn decode<T: DeserializeOwned>(bytes: &[u8], fingerprint: &Fingerprint) -> Result<T, StateError> {
    let part = |from: usize, length: usize| bytes.get(from..from + length);
    if part(0, MAGIC.len().min(bytes.len())) != MAGIC.get(..MAGIC.len().min(bytes.len())) || bytes.is_empty()
    {
        return Err(StateError::NoState);
    }
    let cut = |expected| StateError::Cut { found: bytes.len(), expected };
    let version = part(8, 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let version = version.ok_or(cut(HEAD + SUM))?;
    if version != VERSION {
        return Err(StateError::Version { found: version, expected: VERSION });
    }
    let length = part(HEAD - 8, 8).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes);
    let length = usize::try_from(length.ok_or(cut(HEAD + SUM))?).map_err(|_| StateError::Corrupted)?;
    let expected = length.checked_add(HEAD + SUM).ok_or(StateError::Corrupted)?;
    if bytes.len() < expected {
        return Err(cut(expected));
    }
    let (body, check) = bytes.split_at(HEAD + length);
    if check != sum(body) {
        return Err(StateError::Corrupted);
    }
    if part(12, SUM) != Some(fingerprint.as_slice()) {
        return Err(StateError::Foreign);
    }
    postcard::from_bytes(&body[HEAD..]).map_err(|_| StateError::Corrupted)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes() -> Vec<u8> {
        encode(&vec![f64::NAN, f64::INFINITY, -0.0, 1e-300], &fingerprint(&"vessel")).unwrap()
    }

    fn read(bytes: &[u8]) -> Result<Vec<f64>, StateError> {
        decode(bytes, &fingerprint(&"vessel"))
    }

    #[test]
    fn every_bit_comes_back() {
        let numbers = read(&bytes()).unwrap();
        let bits: Vec<u64> = numbers.iter().map(|number| number.to_bits()).collect();
        assert_eq!(bits, [f64::NAN, f64::INFINITY, -0.0, 1e-300].map(f64::to_bits));
    }

    #[test]
    fn whatever_is_cut_or_changed_is_refused() {
        let whole = bytes();
        for length in 0..whole.len() {
            let refused = read(&whole[..length]).unwrap_err();
            let told =
                matches!(refused, StateError::Cut { .. }) || (length == 0 && refused == StateError::NoState);
            assert!(told, "{length} bytes: {refused}");
        }
        for at in 0..whole.len() {
            let mut changed = whole.clone();
            changed[at] ^= 0x40;
            assert!(read(&changed).is_err(), "byte {at}");
        }
        assert_eq!(read(b"time_s,pressure_bar\n"), Err(StateError::NoState));
        let other: Result<Vec<f64>, _> = decode(&whole, &fingerprint(&"another"));
        assert_eq!(other, Err(StateError::Foreign));
    }
}
