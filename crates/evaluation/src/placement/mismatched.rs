//! Worlds that the observer's model does not know: drawn cylinders in railway weather, read by drawn specimens of the candidates.
use cylwatch_thermal::units::{HOUR_S, QUOTED_K};
use std::sync::atomic::Ordering;

use rayon::prelude::*;

use super::trial::{Trial, TrialResult, TrialStart, TrueState, confirmation};
use super::{Claim, ConfirmSettings, Confirmation, InnovationSink, Rows, RunId};
use crate::EvaluationError;
use crate::estimator::observer::Commissioning;
use crate::estimator::observer::cylinder::Cylinder;
use crate::estimator::placement::cylinder::InstrumentedCylinder;
use crate::estimator::placement::search::SearchControl;
use crate::estimator::sensor::{SensorSuite, sample_at};
use crate::world::{Family, NominalVessel, Overlay, Request, RowPattern, Run};

/// Errors in worlds that differ from the observer's model: cylinders with well-mixed gas, drawn around the claim's vessel with the claim's
/// filling, under a rail vehicle in winter, for as long as a run is. The observer has the claim's settings and its whole bank. Masses are
/// in the stated volume and otherwise compared as they are: a transmitter's constant offset is part of the error, but not of the prediction.
///
/// # Errors
/// A setting is out of its bounds, a layout names no candidate, a candidate has no place on the vessel, or a simulation fails.
pub fn mismatched<L: InnovationSink>(
    claim: &Claim<'_>,
    settings: &ConfirmSettings,
    control: &SearchControl,
    sink: &(impl Fn(RunId) -> L + Sync),
) -> Result<Confirmation<L>, EvaluationError> {
    let rows = Rows::new(claim, settings)?;
    let Claim { vessel, candidates, conditions, .. } = *claim;
    let cylinder = InstrumentedCylinder::new(vessel, candidates, claim.settings, claim.member, conditions)?;
    let suite = SensorSuite::try_new(candidates.to_vec())?;
    let (pressure_pa, temperature_k) = conditions.filling;
    let mass_kg = Commissioning::filled(pressure_pa, temperature_k).mass_kg(vessel, temperature_k)?;
    let mut model = Cylinder::new(vessel, candidates, claim.settings)?;
    let fill_pa = model.model().settled_pressure_pa(mass_kg, QUOTED_K)?;
    let nominal =
        NominalVessel { fill_pa: (fill_pa, fill_pa), ..NominalVessel::own(vessel.clone(), fill_pa) };
    let overlay = settings.leak.map_or(Overlay::Nothing, |leak| Overlay::Leak {
        part_per_h: leak.rate_kg_s * HOUR_S / mass_kg,
        onset_s: leak.onset_s,
    });
    let pattern = if rows.interval_s < 60.0 { RowPattern::TenSeconds } else { RowPattern::Minute };
    let family = Family { rows: pattern, ..Family::usual() };
    let of_seed = |seed: u64| -> Result<Option<TrialResult<L>>, EvaluationError> {
        if control.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let request = Request::tight(family, seed, settings.duration_s).with(overlay);
        request.validate()?;
        // The leak is simulated however slow it is: candidates read surfaces that it cools.
        let Run { drawn, trajectory, .. } = Run::around(&nominal, &request, &overlay)?;
        let times_s: Vec<f64> =
            (0..rows.count).map(|row| drawn.fill.lead_s + row as f64 * rows.interval_s).collect();
        let log = sample_at(&trajectory, &suite.draw(seed), &times_s, seed)?;
        let at = |values: &[f64], t_s: f64| {
            let known_s = &trajectory.time_s;
            let next = known_s.partition_point(|&known| known <= t_s).clamp(1, known_s.len() - 1);
            let weight = (t_s - known_s[next - 1]) / (known_s[next] - known_s[next - 1]);
            values[next - 1] + weight * (values[next] - values[next - 1])
        };
        let start = TrialStart { seed, settled: drawn.fill.lead_s == 0.0 };
        let mut trial = Trial::new(claim, candidates, claim.settings, start, sink)?;
        for (row, (time_s, readings)) in log.rows().enumerate() {
            let log_s = row as f64 * rows.interval_s;
            let leak = settings.leak.filter(|leak| log_s >= leak.onset_s);
            let true_state = TrueState {
                gas_k: at(&trajectory.gas_mean_k, time_s),
                mass_kg: at(&trajectory.mass_kg, time_s) / drawn.vessel.volume,
                leak_kg_s: leak.map_or(0.0, |leak| leak.rate_kg_s),
            };
            trial.step(log_s, readings, &true_state, rows.is_judged(row))?;
        }
        Ok(Some(trial.finish()))
    };
    let seeds = settings.first_seed..settings.first_seed + settings.seeds;
    let trials: Vec<Option<TrialResult<L>>> = seeds.into_par_iter().map(of_seed).collect::<Result<_, _>>()?;
    let partial = trials.iter().any(Option::is_none);
    Ok(confirmation(claim, &cylinder, trials.into_iter().flatten().collect(), partial))
}
