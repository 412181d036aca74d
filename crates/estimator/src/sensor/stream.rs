//! Random numbers: for every seed one stream per sensor and purpose, so that nothing that is added or changed
//! shifts the numbers of anything else.
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// What random numbers are for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose {
    /// Parameters of a specimen.
    Specimen,
    /// White noise.
    White,
    /// Correlated noise.
    Correlated,
    /// Which readings get lost.
    Dropout,
    /// Random walk of a parameter, by its place in the list.
    Walk(usize),
}

/// The generator for a sensor's name and a purpose.
pub(super) fn stream(seed: u64, name: &str, purpose: Purpose) -> ChaCha8Rng {
    let number = match purpose {
        Purpose::Specimen => 0,
        Purpose::White => 1,
        Purpose::Correlated => 2,
        Purpose::Dropout => 3,
        Purpose::Walk(index) => 4 + index as u8,
    };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(fnv1a(name.bytes().chain([0, number])));
    rng
}

/// Fowler-Noll-Vo hash 1a, 64 bits: the same on every machine and in every version.
fn fnv1a(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Test vectors of the authors' reference code.
    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!(fnv1a("".bytes()), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv1a("a".bytes()), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a("foobar".bytes()), 0x8594_4171_f739_67e8);
    }
}
