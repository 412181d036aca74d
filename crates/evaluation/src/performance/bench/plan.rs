//! What a bench simulates.
use crate::estimator::identify::published::Filling;
use crate::thermal::vessel::presets;
use crate::truth::TruthSettings;
use cylwatch_thermal::units::YEAR_S;
use cylwatch_thermal::units::{DAY_S, HOUR_S};
use serde::{Deserialize, Serialize};

use crate::{EvaluationError, error::positive};

/// Cylinders, leaks and seeds of a bench.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Built-in vessel that cylinders are drawn around.
    pub vessel: String,
    /// Leak rates as loss of the pressure at 15 °C, Pa/s.
    pub rates_pa_s: Vec<f64>,
    /// Number of training seeds, with one tight cylinder each.
    pub training: u64,
    /// Number of test seeds, with one tight cylinder and one for each leak rate each.
    pub tests: u64,
    /// First training seed; the first test seed follows far behind.
    pub seed: u64,
    /// Operation from which detectors learn before anything counts, s.
    pub learning_s: f64,
    /// How long a cylinder is watched after that, s; leaks begin in the first day of it.
    pub watched_s: f64,
    /// Interval of the rows, s.
    pub interval_s: f64,
    /// Wished mean time between false alarms, s.
    pub between_alarms_s: f64,
    /// Whether the truth is the fast one: well-mixed gas, coarse wall and tolerance, instead of a stratified one.
    pub fast: bool,
}

impl Default for Plan {
    /// 11 rates from 0.001 to 10 bar/h, 24 seeds for training and 24 for tests, 10 d of learning and 8 d after it, a row every 2 min, ten
    /// years between false alarms, the fast truth.
    fn default() -> Self {
        let bar_h = [0.001, 0.003, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 3.0, 10.0];
        Self {
            vessel: "nitrogen-20l".into(),
            rates_pa_s: bar_h.map(|rate| rate * 1e5 / HOUR_S).to_vec(),
            training: 24,
            tests: 24,
            seed: 1,
            learning_s: 10.0 * DAY_S,
            watched_s: 8.0 * DAY_S,
            interval_s: 120.0,
            between_alarms_s: 10.0 * YEAR_S,
            fast: true,
        }
    }
}

impl Plan {
    /// Filling of every cylinder.
    pub const FILLING: Filling = Filling { pressure_pa: 200e5, temperature_k: 288.15 };

    /// Check the plan.
    ///
    /// # Errors
    /// A time or rate is not positive, or there are too few seeds.
    pub fn validate(&self) -> Result<(), EvaluationError> {
        positive("learning_s", self.learning_s)?;
        positive("watched_s - 1 d", self.watched_s - DAY_S)?;
        positive("interval_s", self.interval_s)?;
        positive("between_alarms_s", self.between_alarms_s)?;
        self.rates_pa_s.iter().try_for_each(|rate| positive("rates_pa_s", *rate).map(drop))?;
        positive("training - 4", self.training as f64 - 4.0)?;
        positive("tests", self.tests as f64)?;
        presets::load(&self.vessel).map(drop)?;
        Ok(())
    }

    /// The truth's settings.
    pub(super) fn truth(&self) -> TruthSettings {
        let settings = if self.fast { TruthSettings::fast() } else { TruthSettings::default() };
        TruthSettings { vessel: self.vessel.clone(), ..settings }
    }

    /// Number of cylinders that are simulated.
    pub fn cylinders(&self) -> u64 {
        self.training + self.tests * (1 + self.rates_pa_s.len() as u64)
    }

    /// Mass, kg, that makes a pascal of the pressure at 15 °C in the vessel as filled.
    ///
    /// # Errors
    /// The vessel is not known, or the filling no state of its gas.
    pub(super) fn mass_kg_pa(&self) -> Result<f64, EvaluationError> {
        let vessel = presets::load(&self.vessel)?;
        let Filling { pressure_pa, temperature_k } = Self::FILLING;
        let mass_kg = |pressure_pa: f64| -> Result<f64, EvaluationError> {
            let density = vessel.fluid.density_from_pressure_temperature(pressure_pa, temperature_k)?;
            Ok(density * vessel.volume.volume_m3(temperature_k, pressure_pa))
        };
        let step_pa = 1e4;
        Ok((mass_kg(pressure_pa + step_pa)? - mass_kg(pressure_pa - step_pa)?) / (2.0 * step_pa))
    }
}
