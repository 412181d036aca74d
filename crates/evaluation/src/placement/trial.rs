//! A trial of the Monte Carlo study: the observers of all layouts read one truth.
use super::tally::Tally;
use super::{Achieved, Claim, Confirmation, Confirmed, InnovationSink, Run, RunId};
use crate::EvaluationError;
use crate::estimator::observer::{Commissioning, Observer, ObserverSettings};
use crate::estimator::placement::Objective;
use crate::estimator::placement::cylinder::{InstrumentedCylinder, Quantity};
use crate::estimator::sensor::Sensor;

/// The truth at a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrueState {
    pub gas_k: f64,
    pub mass_kg: f64,
    pub leak_kg_s: f64,
}

/// Errors of one run: gas temperature, mass, leak rate.
type Tallies = [Tally; 3];

/// The observer of one layout with its errors so far.
struct LayoutRun<'a, L> {
    layout: &'a [usize],
    observer: Observer,
    readings: Vec<f64>,
    tallies: Tallies,
    run: Run<L>,
}

/// The observers of all layouts, which read the same truth.
pub(super) struct Trial<'a, L> {
    runs: Vec<LayoutRun<'a, L>>,
}

/// Start of a trial.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrialStart {
    pub seed: u64,
    /// Whether the cylinder has settled, which the observers know.
    pub settled: bool,
}

/// Errors and run of one seed, layout by layout.
pub(super) type TrialResult<L> = Vec<(Tallies, Run<L>)>;

impl<'a, L: InnovationSink> Trial<'a, L> {
    /// Observers that have read nothing yet, of candidates with priors as given.
    pub(super) fn new(
        claim: &Claim<'a>,
        candidates: &[Sensor],
        settings: &ObserverSettings,
        TrialStart { seed, settled }: TrialStart,
        sink: &impl Fn(RunId) -> L,
    ) -> Result<Self, EvaluationError> {
        let (pressure_pa, temperature_k) = claim.conditions.filling;
        let commissioning = Commissioning { settled, ..Commissioning::filled(pressure_pa, temperature_k) };
        let layout_run = |(index, layout): (usize, &'a Vec<usize>)| {
            let sensors: Vec<Sensor> =
                layout.iter().map(|candidate| candidates[*candidate].clone()).collect();
            let id = RunId { seed, layout: index };
            Ok(LayoutRun {
                layout,
                observer: Observer::new(claim.vessel, &sensors, &commissioning, settings)?,
                readings: vec![f64::NAN; layout.len()],
                tallies: Tallies::default(),
                run: Run { id, sink: sink(id) },
            })
        };
        Ok(Self {
            runs: claim.layouts.iter().enumerate().map(layout_run).collect::<Result<_, EvaluationError>>()?,
        })
    }

    /// A row of readings of all candidates.
    pub(super) fn step(
        &mut self,
        time_s: f64,
        readings: &[f64],
        truth: &TrueState,
        is_judged: bool,
    ) -> Result<(), EvaluationError> {
        for LayoutRun { layout, observer, readings: own, tallies, run } in &mut self.runs {
            own.iter_mut().zip(*layout).for_each(|(own, candidate)| *own = readings[*candidate]);
            let estimate = observer.step(time_s, own)?;
            run.sink.record(time_s, observer.innovations());
            if is_judged {
                let [gas, mass, leak] = tallies;
                gas.add(estimate.gas_mean_k - truth.gas_k, estimate.gas_mean_sd_k);
                mass.add(estimate.mass_kg - truth.mass_kg, estimate.mass_sd_kg);
                leak.add(estimate.leak_kg_s - truth.leak_kg_s, estimate.leak_sd_kg_s);
            }
        }
        Ok(())
    }

    pub(super) fn finish(self) -> TrialResult<L> {
        self.runs.into_iter().map(|layout_run| (layout_run.tallies, layout_run.run)).collect()
    }
}

/// Results of all seeds beside what was predicted.
pub(super) fn confirmation<L>(
    claim: &Claim<'_>,
    cylinder: &InstrumentedCylinder,
    trials: Vec<TrialResult<L>>,
    partial: bool,
) -> Confirmation<L> {
    let quantities = [Quantity::GasTemperature, Quantity::Mass, Quantity::LeakRate];
    let problems = quantities.map(|quantity| cylinder.problem(quantity).ok());
    let confirmed = |(index, layout): (usize, &Vec<usize>)| {
        let achieved = |position: usize| -> Option<Achieved> {
            let runs: Vec<Tally> = trials.iter().map(|trial| trial[index].0[position]).collect();
            let variance = problems[position].as_ref().map(|problem| problem.value(layout));
            let predicted = variance.filter(|variance| variance.is_finite()).map(f64::sqrt);
            Tally::achieved(&runs, predicted)
        };
        Some(Confirmed {
            layout: layout.clone(),
            seeds: trials.len() as u64,
            gas_k: achieved(0)?,
            mass_kg: achieved(1)?,
            leak_kg_s: achieved(2),
        })
    };
    Confirmation {
        layouts: claim.layouts.iter().enumerate().filter_map(confirmed).collect(),
        runs: trials.into_iter().flatten().map(|(_, run)| run).collect(),
        partial,
    }
}
