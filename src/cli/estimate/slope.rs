//! Leak rates as fall of the pressure settled at 15 °C.
use crate::estimator::observer::Estimate;
use crate::estimator::observer::cylinder::Cylinder;
use crate::report::Clock;
use crate::report::estimate::EstimateRow;

/// Change of the mass, relative, after which the slope of the settled pressure is taken anew.
const SLOPE_AGES: f64 = 1e-3;
/// Step of the mass for that slope, relative.
const SLOPE_STEP: f64 = 1e-4;
/// Temperature at which pressures are compared, K: 15 °C.
const SETTLED_K: f64 = 288.15;

/// Slope of the settled pressure in the mass.
pub(super) struct Slope {
    /// Model of the gas.
    cylinder: Cylinder,
    /// Mass, kg, and slope there, Pa/kg.
    pub known: (f64, f64),
}

impl Slope {
    /// Of the gas in a cylinder.
    pub(super) fn of(cylinder: Cylinder) -> Self {
        Self { cylinder, known: (f64::NAN, f64::NAN) }
    }

    /// An estimate as a row.
    pub(super) fn row(&mut self, estimate: Estimate, clock: &Clock) -> anyhow::Result<EstimateRow> {
        let leak_pa_s = estimate.leak_kg_s * self.pa_kg(&estimate)?;
        let time = clock.date_of_log(estimate.time_s).unwrap_or_default();
        Ok(EstimateRow { time, estimate, leak_pa_s, verdict: "" })
    }

    fn pa_kg(&mut self, estimate: &Estimate) -> anyhow::Result<f64> {
        let mass_kg = estimate.mass_kg;
        let age = (mass_kg / self.known.0 - 1.0).abs();
        if age.is_nan() || age > SLOPE_AGES {
            // A model remembers where it found the last state: a fresh one gives the same bits whatever came before.
            let mut cylinder = self.cylinder.clone();
            let model = cylinder.model();
            let above = model.settled_pressure_pa(mass_kg * (1.0 + SLOPE_STEP), SETTLED_K)?;
            let below = model.settled_pressure_pa(mass_kg * (1.0 - SLOPE_STEP), SETTLED_K)?;
            self.known = (mass_kg, (above - below) / (2.0 * SLOPE_STEP * mass_kg));
        }
        Ok(self.known.1)
    }
}
