//! What a unit begins with: the bytes that its archive carries.
use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::sealed::{self, Fingerprint, Kind, SealError};

use crate::CosimulationError;
use crate::plant::CompiledPlant;

/// Bytes of one kind belong to nothing but their version.
const OF_ITSELF: Fingerprint = [0; 16];

/// What a unit begins with.
#[derive(Clone, Debug)]
pub enum Resource {
    /// A cylinder to be simulated.
    Plant(Box<CompiledPlant>),
    /// A cylinder to be watched.
    Monitor(Box<CompiledCylinder>),
}

impl Resource {
    /// Name of its file in an archive.
    pub const FILE: &str = "cylinder.bin";

    /// As bytes: the same on every machine.
    ///
    /// # Errors
    /// [`CosimulationError::Sealed`]: never of one that can begin.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CosimulationError> {
        Ok(match self {
            Self::Plant(plant) => sealed::encode(Kind::Plant, plant, &OF_ITSELF)?,
            Self::Monitor(cylinder) => cylinder.to_bytes()?,
        })
    }

    /// From its bytes.
    ///
    /// # Errors
    /// [`CosimulationError::Sealed`]: they are damaged, of another version, or something else.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CosimulationError> {
        match sealed::decode(Kind::Plant, bytes, &OF_ITSELF) {
            Ok(plant) => Ok(Self::Plant(plant)),
            Err(SealError::Other(_)) => Ok(Self::Monitor(Box::new(CompiledCylinder::from_bytes(bytes)?))),
            Err(refused) => Err(refused.into()),
        }
    }

    /// What tells it from others: a description and its resource have the same.
    ///
    /// # Errors
    /// As [`Resource::to_bytes`].
    pub fn token(&self) -> Result<String, CosimulationError> {
        Ok(token(&fingerprint(&self.to_bytes()?)))
    }
}

/// Of the bytes of a resource and the version of the program.
pub(crate) fn fingerprint(bytes: &[u8]) -> Fingerprint {
    sealed::fingerprint(&(env!("CARGO_PKG_VERSION"), bytes))
}

/// A fingerprint in the form of a GUID.
pub(crate) fn token(fingerprint: &Fingerprint) -> String {
    let hex: String = fingerprint.iter().map(|byte| format!("{byte:02x}")).collect();
    let part = |from: usize, to: usize| hex.get(from..to).unwrap_or_default();
    format!("{{{}-{}-{}-{}-{}}}", part(0, 8), part(8, 12), part(12, 16), part(16, 20), part(20, 32))
}
