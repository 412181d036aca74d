//! When the time that is left is computed, and from what.
use crate::DetectorError;
use crate::monitor::settings::MonitorSettings;
use crate::monitor::{LeakFinding, Outlook};
use crate::prognosis::{Contents, MassAndLeak, Passage, Prognosis, Quantiles};
use crate::units::{DAY_S, HOUR_S, QUOTED_K, YEAR_S};

/// Interval at which the time left is computed anew while gas is being lost, and while none is, s.
const LEAKING_S: f64 = HOUR_S;
const TIGHT_S: f64 = DAY_S;
/// How far ahead, s: ten years.
const HORIZON_S: f64 = 10.0 * YEAR_S;
/// Standard deviations between the ends of a 95 % interval, and between zero and its upper end.
const WIDTH_SD: f64 = 3.92;
const HALF_WIDTH_SD: f64 = 1.96;

/// Masses at which limits are reached, kg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::monitor) struct LimitMasses {
    operational_kg: f64,
    cold_kg: f64,
    maintenance_kg: f64,
}

/// What the time left is computed from.
#[derive(Clone, Copy, Debug)]
pub(in crate::monitor) struct Basis<'a> {
    /// Mass and its standard deviation, kg; in a leak those of the freest member.
    pub mass_kg: (f64, f64),
    /// The leak that is found.
    pub finding: Option<&'a LeakFinding>,
    /// What the rate of a leak is below with 97.5 %, kg/s.
    pub largest_kg_s: f64,
    /// Probability of a leak; `None`: nothing is known of one, and the time left is not known unless a limit is reached.
    pub leak_probability: Option<f64>,
}

impl LimitMasses {
    /// Of a vessel with a filling, kg.
    pub(crate) fn new(
        contents: &Contents,
        settings: &MonitorSettings,
        full_kg: f64,
    ) -> Result<Self, DetectorError> {
        let limits = &settings.limits;
        Ok(Self {
            operational_kg: contents.mass_kg(limits.operational_pa, QUOTED_K)?,
            cold_kg: contents.mass_kg(limits.operational_pa, limits.coldest_k)?,
            maintenance_kg: contents.limit_after_loss_kg(full_kg, limits.maintenance_loss)?,
        })
    }

    /// What is left for the mass and the leak.
    pub(crate) fn outlook(
        &self,
        settings: &MonitorSettings,
        basis: &Basis<'_>,
    ) -> Result<Outlook, DetectorError> {
        let (mass_kg, mass_sd_kg) = basis.mass_kg;
        let (rate_kg_s, rate_sd_kg_s) = match basis.finding {
            None => (0.0, basis.largest_kg_s / HALF_WIDTH_SD),
            Some(leak) => (leak.rate_kg_s.value, (leak.rate_kg_s.high - leak.rate_kg_s.low) / WIDTH_SD),
        };
        // Rate and mass come from the same masses, but from their slope and their level: as good as independent.
        let covariance = [[mass_sd_kg * mass_sd_kg, 0.0], [0.0, rate_sd_kg_s * rate_sd_kg_s]];
        let state = MassAndLeak::try_new(mass_kg, rate_kg_s, covariance)?;
        let probability = basis.leak_probability.unwrap_or(0.0);
        let until =
            |limit_kg| Prognosis::try_new(state, limit_kg, settings.loss)?.with_leak_probability(probability);
        let (operational, cold) = (until(self.operational_kg)?, until(self.cold_kg)?);
        let maintenance = until(self.maintenance_kg)?;
        let limits = [operational, cold];
        let counting = if settings.limits.cold_is_operational { &limits[..] } else { &limits[..1] };
        let known = basis.leak_probability.is_some();
        let left = |prognosis: &Prognosis| said(prognosis.quantiles(HORIZON_S), known);
        Ok(Outlook {
            operational: left(&operational),
            cold: left(&cold),
            maintenance: left(&maintenance),
            advice: settings.reaction.decide(counting, &maintenance)?,
            known,
        })
    }
}

/// The time left where nothing may be known of a leak: a limit that is reached, and no more.
fn said(quantiles: Quantiles, known: bool) -> Quantiles {
    let passage = |passage| if known || passage == Passage::Reached { passage } else { Passage::Unknown };
    let Quantiles { p5, p50, p95, horizon_s } = quantiles;
    Quantiles { p5: passage(p5), p50: passage(p50), p95: passage(p95), horizon_s }
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
    use crate::units::HOUR_S;

    #[test]
    fn in_a_leak_the_time_left_counts_from_the_mass_that_is_there() {
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
        let basis = Basis {
            mass_kg: (4.3, 1e-6),
            finding: Some(&finding),
            largest_kg_s: rate_kg_s,
            leak_probability: Some(1.0),
        };
        let outlook = masses.outlook(&settings, &basis).unwrap();
        let expected_s = settings.loss.time_s(4.3, rate_kg_s, masses.operational_kg);
        let Passage::In(found_s) = outlook.operational.p50 else { panic!("{:?}", outlook.operational) };
        assert!((found_s / expected_s - 1.0).abs() < 1e-3, "{found_s} s, {expected_s} s");
    }

    #[test]
    fn without_evidence_about_a_leak_only_a_limit_that_is_reached_is_said() {
        let contents = Contents::of(&presets::load("nitrogen-20l").unwrap());
        let settings = MonitorSettings::default();
        let masses = LimitMasses::new(&contents, &settings, 4.46).unwrap();
        let left = |mass_kg: f64, leak_probability| {
            let basis =
                Basis { mass_kg: (mass_kg, 1e-3), finding: None, largest_kg_s: 1e-9, leak_probability };
            masses.outlook(&settings, &basis).unwrap().operational.p50
        };
        assert_eq!(left(4.4, None), Passage::Unknown);
        assert_eq!(left(3.0, None), Passage::Reached);
        assert_eq!(left(4.4, Some(0.01)), Passage::BeyondHorizon);
    }
}
