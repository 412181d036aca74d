//! Cylinders and states that have been damaged at random: each is refused, whatever the damage.
use crate::support::{Handle, Memory, blob, cylinder, rows};
use cylwatch_c::code::cw_code;
use cylwatch_c::{cw_handle, cw_init, cw_restore};
use siphasher::sip128::SipHasher13;
use std::collections::BTreeMap;
use std::ptr::null_mut;

/// xorshift64*.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.next() >> 11) as usize % bound.max(1)
    }
}

/// Bits, bytes, cuts, insertions, moves within, words of all ones, parts of other bytes.
fn damaged(bytes: &[u8], foreign: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(8) {
            0 | 1 => bytes[at] ^= 1 << random.below(8),
            2 => bytes[at] = random.next() as u8,
            3 => bytes.truncate(at + 1),
            4 => bytes.insert(at, random.next() as u8),
            5 => {
                let from = random.below(bytes.len());
                let length = random.below((bytes.len() - at.max(from)).min(64));
                bytes.copy_within(from..from + length, at);
            }
            6 => {
                let end = (at + 8).min(bytes.len());
                bytes[at..end].fill(0xff);
            }
            _ => {
                let length = random.below((bytes.len() - at).min(foreign.len()).min(64));
                let from = random.below(foreign.len() - length);
                bytes[at..at + length].copy_from_slice(&foreign[from..from + length]);
            }
        }
    }
    bytes
}

/// The bytes with the length and the check sum that belong to them: what a mistake, not an accident, would write.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    const HEAD: usize = 36;
    const SUM: usize = 16;
    if bytes.len() < HEAD + SUM {
        return bytes;
    }
    let payload = bytes.len() - HEAD - SUM;
    bytes[HEAD - 8..HEAD].copy_from_slice(&(payload as u64).to_le_bytes());
    let body = HEAD + payload;
    let sum = SipHasher13::new().hash(&bytes[..body]).as_bytes();
    bytes[body..].copy_from_slice(&sum);
    bytes
}

fn count(name: &str, usual: usize) -> usize {
    std::env::var(name).map_or(usual, |count| count.parse().unwrap())
}

/// A cylinder, and its state after two hours.
fn originals() -> (Vec<u8>, Vec<u8>) {
    let handle = Handle::begun();
    for (time_s, readings) in rows(720) {
        handle.all(handle.step(time_s, &readings));
    }
    (blob(), handle.save())
}

fn begin(arena: &Memory, blob: &[u8], state: Option<&[u8]>) -> (cw_code, *mut cw_handle) {
    let mut handle = null_mut();
    let (start, size) = (arena.start(), arena.size());
    let code = unsafe {
        match state {
            None => cw_init(start, size, blob.as_ptr(), blob.len(), &raw mut handle),
            Some(state) => cw_restore(
                start,
                size,
                blob.as_ptr(),
                blob.len(),
                state.as_ptr(),
                state.len(),
                &raw mut handle,
            ),
        }
    };
    (code, handle)
}

/// `MUTATIONS=1000000 cargo test -p cylwatch-c mutations -- --nocapture` is the long run.
#[test]
fn every_mutation_is_refused() {
    let (blob, state) = originals();
    let foreign = cylinder(&["shoulder", "pressure"]).to_bytes().unwrap();
    let arena = Memory::skipping(1, 4 << 20);
    let mut random = Random(0x5eed_0001);
    let mut codes = BTreeMap::new();
    for round in 0..count("MUTATIONS", 20_000) {
        let (original, other) = if round % 2 == 0 { (&blob, &foreign) } else { (&state, &blob) };
        let bytes = damaged(original, other, &mut random);
        if bytes == *original {
            continue;
        }
        let (code, handle) =
            if round % 2 == 0 { begin(&arena, &bytes, None) } else { begin(&arena, &blob, Some(&bytes)) };
        assert!(!matches!(code, cw_code::CW_OK | cw_code::CW_PANICKED), "round {round}: {code:?}");
        assert!(!handle.is_null());
        *codes.entry(format!("{code:?}")).or_insert(0_usize) += 1;
    }
    println!("{codes:?}");
}

/// The check sum finds accidents, not intent: with the right one anything may be in the bytes. They may then be refused or taken, but
/// nothing crashes where a monitor begins. `FORGERIES=100000` is longer.
#[test]
fn no_mutation_with_a_right_check_sum_crashes() {
    let (blob, state) = originals();
    let foreign = cylinder(&["shoulder", "pressure"]).to_bytes().unwrap();
    let arena = Memory::of(4 << 20);
    let mut random = Random(0x5eed_0002);
    let mut codes = BTreeMap::new();
    for round in 0..count("FORGERIES", 300) {
        let (original, other) = if round % 2 == 0 { (&blob, &foreign) } else { (&state, &blob) };
        let bytes = sealed(damaged(original, other, &mut random));
        let (code, _) =
            if round % 2 == 0 { begin(&arena, &bytes, None) } else { begin(&arena, &blob, Some(&bytes)) };
        *codes.entry(format!("{code:?}")).or_insert(0_usize) += 1;
    }
    println!("{codes:?}");
}
