//! When the time that is left is computed, and from what.
use crate::DetectorError;
use crate::estimator::observer::{Estimate, Leak};
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

    /// What is left for the mass and the leak, that found or, without one, that of a slow member of the bank.
    pub fn outlook(
        &self,
        settings: &MonitorSettings,
        estimate: &Estimate,
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
                let covariance = [[estimate.mass_sd_kg.powi(2), 0.0], [0.0, sd_kg_s * sd_kg_s]];
                MassAndLeak::try_new(estimate.mass_kg, rate.value, covariance)?
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
