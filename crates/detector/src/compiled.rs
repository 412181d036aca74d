//! A cylinder as bytes for a controller: vessel, sensors, fill, settings and what was learnt, all valid, so that the controller reads
//! no files.
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

use crate::DetectorError;
use crate::estimator::observer::{Commissioning, Learned};
use crate::estimator::sensor::Sensor;
use crate::estimator::thermal::vessel::Vessel;
use crate::monitor::{Monitor, MonitorSettings};
use crate::sealed::{self, Kind};

/// Bytes of one kind belong to nothing but their version.
const OF_ITSELF: sealed::Fingerprint = [0; 16];

/// All that a monitor begins with.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CompiledCylinder {
    /// The vessel.
    pub vessel: Vessel,
    /// Its sensors, in the order of the readings.
    pub sensors: Vec<Sensor>,
    /// What is known of it at the first row.
    pub commissioning: Commissioning,
    /// Settings of the monitor.
    pub settings: MonitorSettings,
    /// What an observer of it has learnt.
    pub learned: Option<Learned>,
}

impl CompiledCylinder {
    /// As bytes. Every bit of every number is kept, and the same cylinder has the same bytes on every machine.
    ///
    /// # Errors
    /// [`DetectorError::Sealed`]: never of a cylinder that has a monitor.
    pub fn to_bytes(&self) -> Result<Vec<u8>, DetectorError> {
        Ok(sealed::encode(Kind::Cylinder, self, &OF_ITSELF)?)
    }

    /// From its bytes.
    ///
    /// # Errors
    /// [`DetectorError::Sealed`]: they are damaged, of another version, or something else.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, DetectorError> {
        Ok(sealed::decode(Kind::Cylinder, bytes, &OF_ITSELF)?)
    }

    /// A monitor that begins with the first row.
    ///
    /// # Errors
    /// As [`Monitor::new`].
    pub fn monitor(&self) -> Result<Monitor, DetectorError> {
        let Self { vessel, sensors, commissioning, settings, learned } = self;
        let monitor = Monitor::new(vessel, sensors, commissioning, settings)?;
        Ok(match learned {
            Some(learned) => monitor.with_learned(learned.clone()),
            None => monitor,
        })
    }

    /// A monitor that goes on from a saved state.
    ///
    /// # Errors
    /// As [`Monitor::restore`].
    pub fn restored(&self, state: &[u8]) -> Result<Monitor, DetectorError> {
        Monitor::restore(&self.vessel, &self.sensors, &self.settings, state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sealed::SealError;
    use cylwatch_estimator::thermal::vessel::presets;

    fn compiled(vessel: &str) -> CompiledCylinder {
        let sensors = ["shoulder", "pressure"].map(|name| Sensor::typical(name).unwrap());
        CompiledCylinder {
            vessel: presets::load(vessel).unwrap(),
            sensors: sensors.to_vec(),
            commissioning: Commissioning::filled(150e5, 288.15),
            settings: MonitorSettings::default(),
            learned: None,
        }
    }

    #[test]
    fn every_built_in_vessel_comes_back_as_it_was() {
        for (name, _) in presets::FILES.files {
            let one = compiled(name);
            let again = CompiledCylinder::from_bytes(&one.to_bytes().unwrap()).unwrap();
            assert_eq!(format!("{again:?}"), format!("{one:?}"), "{name}");
        }
    }

    #[test]
    fn what_is_damaged_cut_or_something_else_is_refused() {
        let whole = compiled("nitrogen-20l").to_bytes().unwrap();
        for at in 0..whole.len() {
            for bit in 0..8 {
                let mut changed = whole.clone();
                changed[at] ^= 1 << bit;
                assert!(CompiledCylinder::from_bytes(&changed).is_err(), "bit {bit} of byte {at}");
            }
            assert!(CompiledCylinder::from_bytes(&whole[..at]).is_err(), "{at} bytes");
        }
        let state = compiled("nitrogen-20l").monitor().unwrap().save().unwrap();
        let refused = CompiledCylinder::from_bytes(&state).unwrap_err();
        assert!(matches!(refused, DetectorError::Sealed(SealError::Other(Kind::Cylinder))), "{refused}");
        let refused = compiled("nitrogen-20l").restored(&whole).unwrap_err();
        assert!(matches!(refused, DetectorError::Sealed(SealError::Other(Kind::State))), "{refused}");
    }
}
