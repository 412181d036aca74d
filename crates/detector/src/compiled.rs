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
use crate::units::QUOTED_K;

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
    /// As [`Self::validate`]: what would be refused where it is read is not written.
    pub fn to_bytes(&self) -> Result<Vec<u8>, DetectorError> {
        self.validate()?;
        Ok(sealed::encode(Kind::Cylinder, self, &OF_ITSELF)?)
    }

    /// From its bytes.
    ///
    /// # Errors
    /// [`DetectorError::Sealed`]: they are damaged, of another version, or something else; or as [`Self::validate`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, DetectorError> {
        let cylinder: Self = sealed::decode(Kind::Cylinder, bytes, &OF_ITSELF)?;
        cylinder.validate()?;
        Ok(cylinder)
    }

    /// Checks every value by the bounds that files are held to: a check sum finds accidents, and says nothing of what was sealed.
    ///
    /// # Errors
    /// Names the first value that breaks a bound, and the bound.
    pub fn validate(&self) -> Result<(), DetectorError> {
        let Self { vessel, sensors, commissioning, settings, learned } = self;
        vessel.validate()?;
        for (i, sensor) in sensors.iter().enumerate() {
            sensor.validate(&format!("sensor {}", i + 1))?;
        }
        commissioning.mass_kg(vessel, QUOTED_K)?;
        settings.validate()?;
        learned.as_ref().map_or(Ok(()), |learned| learned.validate(vessel))?;
        Ok(())
    }

    /// A monitor that begins with the first row.
    ///
    /// # Errors
    /// As [`Monitor::new`].
    pub fn monitor(&self) -> Result<Monitor, DetectorError> {
        let Self { vessel, sensors, commissioning, settings, learned } = self;
        let monitor = Monitor::new(vessel, sensors, commissioning, settings)?;
        match learned {
            Some(learned) => monitor.with_learned(learned.clone()),
            None => Ok(monitor),
        }
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
    fn a_value_out_of_its_bounds_is_refused_by_name_whatever_the_check_sum_says() {
        let mut learnt = compiled("nitrogen-20l");
        learnt.learned = learnt.monitor().unwrap().observer().learned();
        type Change = fn(&mut CompiledCylinder);
        let cases: [(Change, &str); 9] = [
            (
                |c| c.vessel.geometry.layers[0].thickness_m = f64::NAN,
                "layer thickness_m = NaN must be positive",
            ),
            (|c| c.vessel.volume.volume_m3 = 1e300, "volume volume_m3 = 1e300 must be within 30 % of"),
            (|c| c.sensors[1].noise_sd = -1.0, "sensor 2 noise_pa = -1 must be at least 0"),
            (|c| c.sensors[0].kind = c.sensors[1].kind, "sensor 1 parameters = 2 must be these: Offset"),
            (|c| c.commissioning.mass_sd = 0.0, "`commissioning.mass_sd` = 0 must be positive"),
            (
                |c| c.settings.observer.longest_step_s = 5e-324,
                "`longest_step_s` = 5e-324 must be at least 1 s",
            ),
            (|c| c.settings.limits.coldest_k = -1.0, "`limits.coldest_k` = -1 must be positive"),
            (
                |c| c.settings.alarms.leak.timing.on_delay_s = -1.0,
                "alarm `leak`: setting `on_delay_s` = -1 must be",
            ),
            (|c| c.settings.intake.step_s = f64::INFINITY, "`step_s` = inf must be finite"),
        ];
        for (change, words) in cases {
            let mut wrong = learnt.clone();
            change(&mut wrong);
            let forged = sealed::encode(Kind::Cylinder, &wrong, &OF_ITSELF).unwrap();
            for outcome in [CompiledCylinder::from_bytes(&forged).map(|_| ()), wrong.to_bytes().map(|_| ())] {
                let told = outcome.map_or_else(|refused| refused.to_string(), |()| "nothing".to_owned());
                assert!(told.contains(words), "`{words}` is not in `{told}`");
            }
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
