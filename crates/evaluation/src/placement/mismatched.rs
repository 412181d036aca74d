//! Worlds that the observer's model does not know: drawn cylinders in railway weather, read by drawn specimens of the candidates.
use cylwatch_thermal::units::DAY_S;
use cylwatch_thermal::units::QUOTED_K;
use std::sync::atomic::Ordering;

use rayon::prelude::*;

use super::jury::{Jury, Present, Verdict, confirmation};
use super::{Claim, ConfirmSettings, Confirmation, Listener, Rows, RunId};
use crate::EvaluationError;
use crate::estimator::observer::Commissioning;
use crate::estimator::observer::cylinder::Cylinder;
use crate::estimator::placement::cylinder::SitedCylinder;
use crate::estimator::placement::search::Watch;
use crate::estimator::sensor::{SensorSuite, sample};
use crate::truth::{Course, Happenings, TruthSettings, simulate_around};

/// Errors in worlds that differ from the observer's model: railway weeks of as many days as a run has, with the truths' `settings.vessel` and
/// `settings.leak` as the claim and its confirmation have them. The observer has the claim's settings and its whole bank. Masses are compared
/// as they are: a transmitter's constant offset is part of the error, but not of the prediction.
///
/// # Errors
/// A setting is out of its bounds, a layout names no candidate, a candidate has no place on the vessel, or a simulation fails.
pub fn mismatched<L: Listener>(
    claim: &Claim<'_>,
    settings: &ConfirmSettings,
    truth: &TruthSettings,
    watch: &Watch,
    listen: &(impl Fn(RunId) -> L + Sync),
) -> Result<Confirmation<L>, EvaluationError> {
    let rows = Rows::new(claim, settings)?;
    let Claim { vessel, candidates, conditions, .. } = *claim;
    let sited = SitedCylinder::new(vessel, candidates, claim.settings, claim.member, conditions)?;
    let suite = SensorSuite::try_new(candidates.to_vec())?;
    let (pressure_pa, temperature_k) = conditions.filling;
    let mass_kg = Commissioning::filled(pressure_pa, temperature_k).mass_kg(vessel, temperature_k)?;
    let mut nominal = Cylinder::new(vessel, candidates, claim.settings)?;
    let fill_pa = nominal.model().settled_pressure_pa(mass_kg, QUOTED_K)?;
    let happenings = Happenings { fill_pa: Some(fill_pa), ..Happenings::default() };
    let course = Course::RailwayWeeks { days: settings.duration_s / DAY_S };
    let truth = TruthSettings { leak: settings.leak, ..truth.clone() };
    let of_seed = |seed: u64| -> Result<Option<Verdict<L>>, EvaluationError> {
        if watch.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let (_, trajectory) = simulate_around(vessel, &course, seed, rows.interval_s, &truth, &happenings)?;
        let log = sample(&trajectory, &suite.draw(seed), seed)?;
        let mut jury = Jury::new(claim, candidates, claim.settings, seed, listen)?;
        for (row, (time_s, readings)) in log.rows().enumerate() {
            let leak = settings.leak.filter(|leak| time_s >= leak.start_s);
            let present = Present {
                gas_k: trajectory.gas_mean_k[row],
                mass_kg: trajectory.mass_kg[row],
                leak_kg_s: leak.map_or(0.0, |leak| leak.rate_kg_s),
            };
            jury.hear(time_s, readings, &present, rows.is_judged(row))?;
        }
        Ok(Some(jury.verdict()))
    };
    let seeds = settings.first_seed..settings.first_seed + settings.seeds;
    let verdicts: Vec<Option<Verdict<L>>> = seeds.into_par_iter().map(of_seed).collect::<Result<_, _>>()?;
    let partial = verdicts.iter().any(Option::is_none);
    Ok(confirmation(claim, &sited, verdicts.into_iter().flatten().collect(), partial))
}
