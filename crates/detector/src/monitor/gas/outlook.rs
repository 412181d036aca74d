//! When the time that is left is computed, and from what.
use crate::DetectorError;
use crate::estimator::observer::Leak;
use crate::monitor::settings::MonitorSettings;
use crate::monitor::{LeakFinding, Outlook};
use crate::prognosis::{Contents, MassAndLeak, Prognosis, QUOTED_K};

/// Interval at which the time left is computed anew while gas is being lost, and while none is, s.
const LEAKING_S: f64 = 3600.0;
const TIGHT_S: f64 = 86_400.0;
/// How far ahead, s: ten years.
const HORIZON_S: f64 = 10.0 * crate::monitor::settings::YEAR_S;
/// Standard deviations between the ends of a 95 % interval.
const WIDTH_SD: f64 = 3.92;

/// Masses at which limits are reached, kg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::monitor) struct LimitMasses {
    operational_kg: f64,
    cold_kg: f64,
    maintenance_kg: f64,
}

impl LimitMasses {
    /// Of a vessel with a filling, kg.
    pub fn new(contents: &Contents, settings: &MonitorSettings, full_kg: f64) -> Result<Self, DetectorError> {
        let limits = &settings.limits;
        Ok(Self {
            operational_kg: contents.mass_kg(limits.operational_pa, QUOTED_K)?,
            cold_kg: contents.mass_kg(limits.operational_pa, limits.coldest_k)?,
            maintenance_kg: contents.limit_after_loss_kg(full_kg, limits.maintenance_loss)?,
        })
    }

    /// What is left for the mass and the leak, that found or, without one, that of a slow member of the bank. In a leak the mass is
    /// that of the freest member, as in [`crate::monitor::Output`].
    pub fn outlook(
        &self,
        settings: &MonitorSettings,
        free: &Leak,
        finding: Option<&LeakFinding>,
        slow: &Leak,
        leak_probability: f64,
    ) -> Result<Outlook, DetectorError> {
        let state = match finding {
            None => MassAndLeak::of_leak(slow)?,
            Some(leak) => {
                let rate = leak.rate_kg_s;
                let sd_kg_s = (rate.high - rate.low) / WIDTH_SD;
                // Rate and mass come from the same masses, but from their slope and their level: as good as independent.
                let covariance = [[free.mass_sd_kg.powi(2), 0.0], [0.0, sd_kg_s * sd_kg_s]];
                MassAndLeak::try_new(free.mass_kg, rate.value, covariance)?
            }
        };
        let until = |limit_kg| {
            Prognosis::try_new(state, limit_kg, settings.loss)?.with_leak_probability(leak_probability)
        };
        let (operational, cold) = (until(self.operational_kg)?, until(self.cold_kg)?);
        let maintenance = until(self.maintenance_kg)?;
        let (at_15_degc, in_the_cold) = (operational.quantiles(HORIZON_S), cold.quantiles(HORIZON_S));
        let limits = [operational, cold];
        let counting = if settings.limits.cold_is_operational { &limits[..] } else { &limits[..1] };
        Ok(Outlook {
            operational: at_15_degc,
            cold: in_the_cold,
            maintenance: maintenance.quantiles(HORIZON_S),
            advice: settings.reaction.decide(counting, &maintenance)?,
        })
    }
}

/// Interval until the next one, s.
pub(in crate::monitor) fn interval_s(leaking: bool) -> f64 {
    if leaking { LEAKING_S } else { TIGHT_S }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::thermal::vessel::presets;
    use crate::monitor::Interval;
    use crate::prognosis::Passage;

    const HOUR_S: f64 = 3600.0;

    #[test]
    fn in_a_leak_the_time_left_counts_from_the_mass_of_the_freest_member() {
        let contents = Contents::of(&presets::load("nitrogen-20l").unwrap());
        let settings = MonitorSettings::default();
        let masses = LimitMasses::new(&contents, &settings, 4.46).unwrap();
        let exact = |value: f64| Interval { value, low: value, high: value };
        let rate_kg_s = 6e-3 / HOUR_S;
        let finding = LeakFinding {
            rate_kg_s: exact(rate_kg_s),
            rate_pa_s: exact(1.0),
            onset_s: exact(0.0),
            lost_kg: exact(0.1),
        };
        let member = |mass_kg: f64| Leak {
            rate_kg_s,
            sd_kg_s: 1e-9,
            mass_kg,
            mass_sd_kg: 1e-6,
            covariance_kg2_s: 0.0,
            begun_anew: false,
        };
        // The slow member still has the 100 g that are lost.
        let outlook = masses.outlook(&settings, &member(4.3), Some(&finding), &member(4.4), 1.0).unwrap();
        let expected_s = settings.loss.time_s(4.3, rate_kg_s, masses.operational_kg);
        let Passage::In(found_s) = outlook.operational.p50 else { panic!("{:?}", outlook.operational) };
        assert!((found_s / expected_s - 1.0).abs() < 1e-3, "{found_s} s, {expected_s} s");
    }
}
