//! Bytes changed at random: accidents, and forgeries with the check sum that belongs to them. The C interface's tests use it too.
use siphasher::sip128::SipHasher13;

/// Bytes before the payload and after it.
const HEAD: usize = 36;
const SUM: usize = 16;

/// Numbers that a formula trips over.
const EXTREMES: [f64; 10] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0, 1e300, -1e300, 1e-300, 5e-324, 1e9];

/// xorshift64*.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    pub(crate) fn below(&mut self, bound: usize) -> usize {
        (self.next() >> 11) as usize % bound.max(1)
    }
}

/// Bits, bytes, cuts, insertions, moves within, words of all ones, parts of other bytes.
pub(crate) fn damaged(bytes: &[u8], foreign: &[u8], random: &mut Random) -> Vec<u8> {
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
pub(crate) fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
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

/// The number of cases: a variable of the environment, or as usual.
pub(crate) fn count(name: &str, usual: usize) -> usize {
    std::env::var(name).map_or(usual, |count| count.parse().unwrap())
}

/// Sealed bytes whose payload is damaged, or holds other numbers: most changes keep its structure, so that it is read.
pub(crate) fn forged(bytes: &[u8], foreign: &[u8], random: &mut Random) -> Vec<u8> {
    if random.below(4) == 0 {
        return sealed(damaged(bytes, foreign, random));
    }
    let mut bytes = bytes.to_vec();
    let payload = HEAD..bytes.len() - SUM;
    for _ in 0..=random.below(2) {
        let at = payload.start + random.below(payload.len());
        match random.below(4) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.next() as u8,
            _ => {
                let is_number = |at: &usize| {
                    let word = bytes[*at..*at + 8].try_into().unwrap();
                    let value = f64::from_le_bytes(word).abs();
                    value == 0.0 || (1e-12..1e12).contains(&value)
                };
                let Some(at) = (at..payload.end - 8).find(is_number) else { continue };
                let value = EXTREMES[random.below(EXTREMES.len())];
                bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
            }
        }
    }
    sealed(bytes)
}
