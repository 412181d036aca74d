//! What an inspection can say: pressure adjusted for temperature, loss against the fill, and the probability that the loss is above a limit.
//!
//! ```text
//! L = 1 - p(m) / p(m_0)        p(m): pressure of a mass at the reference temperature
//! s_L = (1 - L) sqrt((s_p / p)² + (s_p0 / p_0)²)
//! P(L > L_max) = Phi((L - L_max) / s_L)
//! ```
//!
//! The mass with its uncertainty comes from an observer that does not know the fill: from a log, or from one reading of a cylinder that has rested
//! ([`SingleReading`]). What was filled has an uncertainty of its own, taken as independent; one gauge that read both makes the
//! interval too wide, never too narrow. Nothing is supposed of the loss beforehand.
//!
//! # Source
//! ISO 14520-1 as [`ISO_14520_LOSS`] quotes it: a loss of pressure, adjusted for temperature, of more than 5 %. It is a criterion
//! here, and the outcome no certificate.
use cylwatch_estimator::observer::{Commissioning, Estimate, Observer, ObserverSettings};
use cylwatch_estimator::sensor::{Sensor, Site};
use cylwatch_estimator::thermal::vessel::{Fill, Vessel};

use crate::DetectorError;
use crate::monitor::Interval;
use crate::prognosis::{Contents, ISO_14520_LOSS, normal_probability};
use crate::units::QUOTED_K;

/// Standard deviations from the middle to the bounds of a 95 % interval.
pub const BOUND_SD: f64 = 1.959_963_984_540_054;
/// Interval at which an observer looks at a cylinder that rests, s.
const LOOK_S: f64 = 600.0;
/// Standard deviation of the mass before the pressure has been read, a part of it: nothing is known of it.
const UNKNOWN_MASS_SD: f64 = 0.2;

/// A mass of gas and its standard deviation, kg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UncertainMass {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Standard deviation, kg.
    pub sd_kg: f64,
}

impl From<&Estimate> for UncertainMass {
    fn from(estimate: &Estimate) -> Self {
        Self { mass_kg: estimate.mass_kg, sd_kg: estimate.mass_sd_kg }
    }
}

/// When a loss is too large, and how sure that has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// Largest loss of pressure adjusted for temperature, a part of that of the fill.
    pub loss_limit: f64,
    /// Probability from which on a cylinder passes or is to be refilled, 0.5 to 1.
    pub certainty: f64,
    /// Temperature that pressures are adjusted to, K.
    pub reference_k: f64,
}

impl Default for Criterion {
    /// 5 %, with 95 % certainty, at 15 °C.
    fn default() -> Self {
        Self { loss_limit: ISO_14520_LOSS, certainty: 0.95, reference_k: QUOTED_K }
    }
}

/// What becomes of a cylinder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// The loss is below the limit.
    Pass,
    /// It is above.
    Refill,
    /// Neither is certain enough.
    CannotBeTold,
}

/// The outcome of an inspection; intervals are of 95 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inspection {
    /// Pressure at the reference temperature, Pa.
    pub adjusted_pa: Interval,
    /// The same of the fill, Pa.
    pub filled_pa: Interval,
    /// Loss, a part of the fill's pressure.
    pub loss: Interval,
    /// Probability that the loss is above the limit.
    pub refill_probability: f64,
    /// What follows.
    pub judgement: Judgement,
}

impl Criterion {
    /// Judge a cylinder by what it holds and what it was filled with.
    ///
    /// # Errors
    /// A setting is out of its bounds; a mass is not positive or no state of the gas.
    pub fn judge(
        &self,
        contents: &Contents,
        filled: UncertainMass,
        now: UncertainMass,
    ) -> Result<Inspection, DetectorError> {
        let require = |setting, value: f64, (low, high): (f64, f64), bound| match value {
            value if value > low && value < high => Ok(()),
            _ => Err(DetectorError::Setting { setting, value, bound }),
        };
        require("loss_limit", self.loss_limit, (0.0, 1.0), "between 0 and 1")?;
        require("certainty", self.certainty, (0.5, 1.0), "between 0.5 and 1")?;
        let pressure = |mass: UncertainMass| self.pressure_pa(contents, mass);
        let ((now_pa, now_sd_pa), (filled_pa, filled_sd_pa)) = (pressure(now)?, pressure(filled)?);
        let loss = 1.0 - now_pa / filled_pa;
        let loss_sd = (1.0 - loss) * libm::hypot(now_sd_pa / now_pa, filled_sd_pa / filled_pa);
        let refill_probability = match loss_sd > 0.0 {
            true => normal_probability((loss - self.loss_limit) / loss_sd),
            false => f64::from(u8::from(loss > self.loss_limit)),
        };
        let judgement = match refill_probability {
            probability if probability <= 1.0 - self.certainty => Judgement::Pass,
            probability if probability >= self.certainty => Judgement::Refill,
            _ => Judgement::CannotBeTold,
        };
        Ok(Inspection {
            adjusted_pa: interval(now_pa, now_sd_pa),
            filled_pa: interval(filled_pa, filled_sd_pa),
            loss: interval(loss, loss_sd),
            refill_probability,
            judgement,
        })
    }

    /// Pressure of a mass at the reference temperature with its standard deviation, Pa.
    fn pressure_pa(&self, contents: &Contents, mass: UncertainMass) -> Result<(f64, f64), DetectorError> {
        let UncertainMass { mass_kg, sd_kg } = mass;
        let pressure_pa = contents.pressure_pa(mass_kg, self.reference_k)?;
        let slope_pa_kg = contents.slope_pa_kg(mass_kg, self.reference_k)?;
        Ok((pressure_pa, slope_pa_kg * sd_kg))
    }
}

fn interval(value: f64, sd: f64) -> Interval {
    Interval { value, low: value - BOUND_SD * sd, high: value + BOUND_SD * sd }
}

/// How far the mean gas temperature is from a thermometer on the wall and from one in the air at any time of railway winters, rms, K: the largest of seven vessels
/// in the climate `railway` of the worlds (steel cylinders have 1.5 to 1.8 K from the wall).
const FROM_WALL_K: f64 = 2.6;
const FROM_AIR_K: f64 = 9.8;

/// What an observer is told that shall find a mass which nobody states, from the first pressure, Pa, and after it: so a loss shows.
pub fn commissioning(first_pa: f64, settled: bool) -> Commissioning {
    let fill = Fill::Pressure { pressure_pa: first_pa };
    Commissioning { fill, mass_sd: UNKNOWN_MASS_SD, settled }
}

/// One look at a gauge and at a thermometer, on the cylinder or in the air about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleReading {
    /// Absolute pressure as read, Pa.
    pub pressure_pa: f64,
    /// Temperature as read, K.
    pub temperature_k: f64,
    /// How long the surroundings have been at about that temperature, s; 0: nobody knows.
    pub rested_s: f64,
}

/// What a single reading is taken with.
#[derive(Clone, Debug)]
pub struct Instruments {
    /// Thermometer, on the cylinder or in the air.
    pub thermometer: Sensor,
    /// What the temperature of the surroundings is known by: a thermometer in the air.
    pub air: Sensor,
    /// Pressure gauge.
    pub gauge: Sensor,
}

impl SingleReading {
    /// The mass that a cylinder holds by it. Without known rest the gas is as far from the thermometer as it is in railway winters. With it, an observer begins
    /// with wall and gas 10 K from the thermometer, sees the air at one temperature for the time of rest, and then the thermometer and the
    /// pressure.
    ///
    /// # Errors
    /// The reading is no state of the gas, or a sensor has no place on the vessel.
    pub fn mass(&self, vessel: &Vessel, with: &Instruments) -> Result<UncertainMass, DetectorError> {
        let Instruments { thermometer, air, gauge } = with;
        let Self { pressure_pa, temperature_k, rested_s } = *self;
        let in_air = thermometer.site() == Site::Air;
        if rested_s == 0.0 {
            return self.mass_without_rest(&Contents::of(vessel), (thermometer, in_air), gauge);
        }
        let commissioning = commissioning(pressure_pa, false);
        let mut settings = ObserverSettings::default();
        settings.air.prior_sd = Commissioning::UNSETTLED_AIR_SD_K;
        let mut sensors = vec![if in_air { thermometer.clone() } else { air.clone() }, gauge.clone()];
        sensors.extend((!in_air).then(|| thermometer.clone()));
        let mut observer = Observer::new(vessel, &sensors, &commissioning, &settings)?;
        let looks = libm::ceil(rested_s / LOOK_S);
        let at_rest = [temperature_k, f64::NAN, f64::NAN];
        for look in 0..looks as u64 {
            observer.step(LOOK_S * look as f64, &at_rest[..sensors.len()])?;
        }
        let read = [temperature_k, pressure_pa, temperature_k];
        let estimate = observer.step(LOOK_S * looks, &read[..sensors.len()])?;
        Ok((&estimate).into())
    }

    /// `s_m² = (dm/dT s_T)² + (dm/dp s_p)²`.
    fn mass_without_rest(
        &self,
        contents: &Contents,
        (thermometer, in_air): (&Sensor, bool),
        gauge: &Sensor,
    ) -> Result<UncertainMass, DetectorError> {
        let Self { pressure_pa, temperature_k, .. } = *self;
        let away_k = if in_air { FROM_AIR_K } else { FROM_WALL_K };
        let sd_k = libm::hypot(away_k, thermometer.offset_sd());
        let mass_kg = contents.mass_kg(pressure_pa, temperature_k)?;
        let of_temperature_kg = 0.5
            * (contents.mass_kg(pressure_pa, temperature_k - sd_k)?
                - contents.mass_kg(pressure_pa, temperature_k + sd_k)?);
        let of_gauge_kg = contents.mass_kg(pressure_pa + gauge.offset_sd(), temperature_k)? - mass_kg;
        Ok(UncertainMass { mass_kg, sd_kg: libm::hypot(of_temperature_kg, of_gauge_kg) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use cylwatch_estimator::thermal::vessel::presets;

    const BAR_PA: f64 = 1e5;

    fn cylinder() -> (Vessel, Contents) {
        let vessel = presets::load("nitrogen-20l").unwrap();
        let contents = Contents::of(&vessel);
        (vessel, contents)
    }

    fn mass(contents: &Contents, bar: f64, sd_part: f64) -> UncertainMass {
        let mass_kg = contents.mass_kg(bar * BAR_PA, QUOTED_K).unwrap();
        UncertainMass { mass_kg, sd_kg: sd_part * mass_kg }
    }

    #[test]
    fn a_loss_is_that_of_the_pressure_at_the_reference_temperature() {
        let (_, contents) = cylinder();
        let (filled, now) = (mass(&contents, 200.0, 0.0), mass(&contents, 188.0, 0.0));
        let found = Criterion::default().judge(&contents, filled, now).unwrap();
        assert_relative_eq!(found.loss.value, 0.06, epsilon = 1e-9);
        assert_eq!((found.refill_probability, found.judgement), (1.0, Judgement::Refill));
        // At another temperature the share differs a little: the gas is no ideal one.
        let warm = Criterion { reference_k: 323.15, ..Criterion::default() };
        let warm = warm.judge(&contents, filled, now).unwrap();
        assert!((warm.loss.value - 0.06).abs() > 1e-4 && (warm.loss.value - 0.06).abs() < 5e-3, "{warm:?}");
    }

    #[test]
    fn what_is_uncertain_leaves_the_probability_between() {
        let (_, contents) = cylinder();
        let judged = |bar: f64, sd_part: f64| {
            let (filled, now) = (mass(&contents, 200.0, 0.0), mass(&contents, bar, sd_part));
            Criterion::default().judge(&contents, filled, now).unwrap()
        };
        let even = judged(190.0, 0.02);
        assert_relative_eq!(even.refill_probability, 0.5, epsilon = 1e-9);
        assert_eq!(even.judgement, Judgement::CannotBeTold);
        // 2.5 % of loss is left to the limit, and 1 % of the mass is 1.1 % of the pressure or so.
        assert_eq!(judged(195.0, 0.01).judgement, Judgement::Pass);
        assert_eq!(judged(195.0, 0.02).judgement, Judgement::CannotBeTold);
        assert_eq!(judged(185.0, 0.01).judgement, Judgement::Refill);
    }

    #[test]
    fn the_standard_deviation_of_the_loss_is_that_of_many_draws() {
        let (_, contents) = cylinder();
        let (filled, now) = (mass(&contents, 200.0, 0.01), mass(&contents, 186.0, 0.015));
        let criterion = Criterion::default();
        let found = criterion.judge(&contents, filled, now).unwrap();
        // Points of equal probability of both normal variables: no seed.
        let points: Vec<f64> = (0..60).map(|k| quantile((f64::from(k) + 0.5) / 60.0)).collect();
        let at = |of: UncertainMass, z: f64| {
            contents.pressure_pa(of.mass_kg + z * of.sd_kg, criterion.reference_k).unwrap()
        };
        let losses: Vec<f64> = points
            .iter()
            .flat_map(|&a| points.iter().map(move |&b| (a, b)))
            .map(|(a, b)| 1.0 - at(now, a) / at(filled, b))
            .collect();
        let count = losses.len() as f64;
        let mean = losses.iter().sum::<f64>() / count;
        let sd = (losses.iter().map(|loss| (loss - mean).powi(2)).sum::<f64>() / count).sqrt();
        let stated = (found.loss.high - found.loss.low) / (2.0 * BOUND_SD);
        assert!((sd / stated - 1.0).abs() < 0.03, "{sd} and {stated}");
        let above = losses.iter().filter(|loss| **loss > criterion.loss_limit).count() as f64 / count;
        assert!((above - found.refill_probability).abs() < 0.01, "{above} and {}", found.refill_probability);
    }

    fn quantile(probability: f64) -> f64 {
        let (mut low, mut high) = (-8.0, 8.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if normal_probability(middle) < probability { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    #[test]
    fn rest_makes_a_reading_sure_and_without_it_ten_kelvins_use_up_the_five_percent() {
        let (vessel, contents) = cylinder();
        let [wall, air, gauge] =
            ["shoulder", "ambient", "pressure"].map(|name| Sensor::typical(name).unwrap());
        let reading = |rested_h: f64| SingleReading {
            pressure_pa: 200.0 * BAR_PA,
            temperature_k: QUOTED_K,
            rested_s: 3600.0 * rested_h,
        };
        let part = |thermometer: &Sensor, rested_h: f64| {
            let with =
                Instruments { thermometer: thermometer.clone(), air: air.clone(), gauge: gauge.clone() };
            let mass = reading(rested_h).mass(&vessel, &with).unwrap();
            let truth = contents.mass_kg(200.0 * BAR_PA, QUOTED_K).unwrap();
            assert!((mass.mass_kg / truth - 1.0).abs() < 0.01, "{rested_h} h: {mass:?} for {truth}");
            mass.sd_kg / mass.mass_kg
        };
        let rests_h = [0.0, 1.0, 3.0, 6.0, 12.0];
        let [on_wall, in_air] = [&wall, &air].map(|thermometer| rests_h.map(|h| part(thermometer, h)));
        for parts in [on_wall, in_air] {
            assert!(parts.is_sorted_by(|a, b| a + 1e-4 >= *b), "{parts:?}");
        }
        // 0.99 bar/K: 2.6 and 9.8 K are 1.3 and 4.9 % of 200 bar, and 1.2 % of pressure are 1 % of mass.
        assert!((0.010..0.013).contains(&on_wall[0]) && in_air[0] > 0.04, "{on_wall:?}, {in_air:?}");
        // Still air changes 16 kJ/K through 6 W/K: after an hour a quarter of the ten kelvins is left; the wall is nearer to the gas.
        assert!(on_wall[1] < 0.01 && (0.009..0.02).contains(&in_air[1]), "{on_wall:?}, {in_air:?}");
        // What is left is the gauge, 0.25 % of 250 bar, and thermometers of which nobody knows how they are fixed.
        assert!(on_wall[4] < 0.006 && in_air[4] < 0.01, "{on_wall:?}, {in_air:?}");
    }

    #[test]
    fn settings_out_of_bounds_are_refused() {
        let (_, contents) = cylinder();
        let full = mass(&contents, 200.0, 0.01);
        for criterion in [
            Criterion { loss_limit: 1.0, ..Criterion::default() },
            Criterion { loss_limit: f64::NAN, ..Criterion::default() },
            Criterion { certainty: 0.5, ..Criterion::default() },
        ] {
            assert!(criterion.judge(&contents, full, full).is_err(), "{criterion:?}");
        }
        assert!(
            Criterion::default().judge(&contents, full, UncertainMass { mass_kg: 0.0, sd_kg: 0.1 }).is_err()
        );
    }
}
