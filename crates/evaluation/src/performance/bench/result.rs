//! From simulated cylinders to thresholds and measures.
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicU64, Ordering};

use super::case::{SETTLED_S, Watched};
use super::{AlarmLevel, Candidate, Plan, alarm_level};
use crate::EvaluationError;
use crate::noise::Noise;
use crate::performance::{AlarmRate, Performance, Run};

/// How far a bench has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Cylinders simulated.
    pub done: u64,
    /// Cylinders in all.
    pub all: u64,
}

/// All candidates on the same cylinders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// What was simulated.
    pub plan: Plan,
    /// Candidates in their order.
    pub judged: Vec<Judged>,
    /// Error of the settled pressure without a leak, Pa, of the candidate where it is smallest; behind the shortest possible delay.
    pub noise: Option<Noise>,
}

/// One candidate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// Unit of its threshold.
    pub unit: String,
    /// Its threshold.
    pub level: AlarmLevel,
    /// Its measures.
    pub performance: Performance,
    /// Its test runs.
    pub runs: Vec<Run>,
}

/// Simulate the plan on all cores and judge the candidates; `progress` is called from any of the threads.
///
/// # Errors
/// The plan is not valid, a simulation fails, a candidate cannot go on, or its statistic says nothing on tight cylinders.
pub fn bench(
    plan: &Plan,
    candidates: &[Candidate],
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Outcome, EvaluationError> {
    plan.validate()?;
    let (cases, done) = (plan.cases(), AtomicU64::new(0));
    let watched: Vec<Watched> = cases
        .par_iter()
        .map(|case| {
            let watched = plan.watch(*case, candidates)?;
            let done = 1 + done.fetch_add(1, Ordering::Relaxed);
            progress(Progress { done, all: cases.len() as u64 });
            Ok(watched)
        })
        .collect::<Result<_, EvaluationError>>()?;
    let noise = smallest_noise(&watched, candidates.len());
    let bound_s = |rate_pa_s: f64| {
        noise.map(|noise| noise.shortest_delay_s(rate_pa_s, SETTLED_S, plan.between_alarms_s))
    };
    let judge = |(index, candidate): (usize, &Candidate)| {
        let level = trained(plan, &watched, index).map_err(|error| match error {
            EvaluationError::TooFewRuns { found, needed } => {
                EvaluationError::Silent { detector: candidate.name.clone(), found, needed }
            }
            error => error,
        })?;
        let runs = tested(&watched, index, level.threshold);
        let mut performance = Performance::of(&candidate.name, &runs, bound_s);
        // Before its leak a leaking cylinder is the tight one of its seed: it would count again for each rate.
        let tight: Vec<Run> = runs.iter().filter(|run| run.leak.is_none()).copied().collect();
        performance.reliability = AlarmRate::of(&tight);
        Ok(Judged { unit: candidate.unit.to_owned(), level, performance, runs })
    };
    let judged = candidates.iter().enumerate().map(judge).collect::<Result<_, EvaluationError>>()?;
    Ok(Outcome { plan: plan.clone(), judged, noise })
}

/// The threshold of a candidate from the training cylinders.
fn trained(plan: &Plan, watched: &[Watched], index: usize) -> Result<AlarmLevel, EvaluationError> {
    let training = watched.iter().filter(|watched| watched.case.training);
    let largest: Vec<f64> = training.map(|watched| watched.traces[index].most()).collect();
    alarm_level(&largest, plan.watched_s * largest.len() as f64, plan.between_alarms_s)
}

/// The test runs of a candidate at its threshold.
fn tested(watched: &[Watched], index: usize, threshold: f64) -> Vec<Run> {
    let run = |watched: &Watched| {
        let alarm = watched.traces[index].alarm(threshold);
        Run {
            seed: watched.case.seed,
            leak: watched.leak,
            from_s: watched.from_s,
            until_s: watched.until_s,
            alarm_s: alarm.map(|alarm| alarm.time_s),
            found: alarm.and_then(|alarm| alarm.found),
        }
    };
    watched.iter().filter(|watched| !watched.case.training).map(run).collect()
}

/// The noise of the settled pressure on tight cylinders, root mean square and median time over the cylinders, of the
/// candidate with the smallest.
fn smallest_noise(watched: &[Watched], candidates: usize) -> Option<Noise> {
    let mut best: Option<Noise> = None;
    for index in 0..candidates {
        let fits: Vec<Noise> =
            watched.iter().filter_map(|watched| Noise::fit(&watched.settled_pa[index])).collect();
        if fits.is_empty() {
            continue;
        }
        let variance = fits.iter().map(|fit| fit.sd.powi(2)).sum::<f64>() / fits.len() as f64;
        let mut times: Vec<f64> = fits.iter().map(|fit| fit.correlation_time_s).collect();
        times.sort_by(f64::total_cmp);
        let noise = Noise { sd: variance.sqrt(), correlation_time_s: times[times.len() / 2] };
        if best.is_none_or(|best| noise.sd < best.sd) {
            best = Some(noise);
        }
    }
    best
}
