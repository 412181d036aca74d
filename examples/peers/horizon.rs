//! Moving horizon on the observer's linearisation with a leak that is not negative, to compare with do-mpc.
//!
//! States are in units of their prior standard deviations, so that the solver that does not scale has a fair start, and the
//! mass has no noise of its own, whose weight (1e14) would be none to invert. Windows stand for themselves: each has its
//! own prior and samples, so that both sides minimise the same function.
use super::filter::readings;
use super::linear::{self, Process, matrix, rows};
use super::stopwatch::{Stopwatch, Timing};
use anyhow::Context;
use cylwatch::estimator::filter::StateSpace;
use cylwatch::estimator::filter::horizon::{Constraint, HorizonSettings, MovingHorizon};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Samples in a window.
const SAMPLES: usize = 20;
const WINDOWS: u64 = 20;

/// The linear problem and its windows.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Inputs {
    linear: linear::Inputs,
    /// Samples in a window.
    samples: usize,
    /// State that is not negative.
    bounded: usize,
    /// Readings of each window: (windows, samples, outputs).
    windows: Vec<Vec<Vec<f64>>>,
}

/// Scaled matrices and readings.
pub(crate) fn inputs(of: &linear::Inputs) -> anyhow::Result<Inputs> {
    let bounded = of.names.iter().position(|name| name.starts_with("leak")).context("no leak rate")?;
    let mass = of.names.iter().position(|name| name == "mass_kg").context("no mass")?;
    let prior = matrix(&of.prior);
    let scale: Vec<f64> = prior.diagonal().iter().map(|variance| variance.sqrt()).collect();
    let n = scale.len();
    let by = |m: &[Vec<f64>], row: &dyn Fn(usize) -> f64, column: &dyn Fn(usize) -> f64| {
        let m = matrix(m);
        rows(&DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)] * row(i) * column(j)))
    };
    let noise: Vec<f64> = of.q.iter().map(|q| q.sqrt()).collect();
    let error: Vec<f64> = of.r.iter().map(|r| r.sqrt()).collect();
    let mut linear = linear::Inputs {
        phi: by(&of.phi, &|i| 1.0 / scale[i], &|j| scale[j]),
        g: by(&of.g, &|i| 1.0 / scale[i], &|j| noise[j]),
        q: vec![1.0; noise.len()],
        h: by(&of.h, &|i| 1.0 / error[i], &|j| scale[j]),
        r: vec![1.0; error.len()],
        prior: rows(&DMatrix::from_fn(n, n, |i, j| prior[(i, j)] / (scale[i] * scale[j]))),
        readings: Vec::new(),
        ..of.clone()
    };
    linear.g[mass].fill(0.0);
    let spread = matrix(&linear.prior);
    let windows = (1..=WINDOWS).map(|seed| readings(&linear, &spread, SAMPLES, seed));
    let windows = windows.collect::<Result<_, _>>()?;
    linear.readings = readings(&linear, &spread, 20 * SAMPLES, WINDOWS + 1)?;
    Ok(Inputs { linear, samples: SAMPLES, bounded, windows })
}

/// Newest state of each window, and the time of a sample once the window is full.
#[derive(Debug, Serialize)]
pub(crate) struct Results {
    newest: Vec<Vec<f64>>,
    /// Windows in which the bound pushes.
    active: usize,
    cost: Vec<f64>,
    time: Timing,
    /// Time of the windows one by one, each from its prior, with an estimate at every sample.
    whole_window_time: Timing,
}

fn estimator(inputs: &Inputs) -> anyhow::Result<MovingHorizon<Process>> {
    let process = Process::new(&inputs.linear);
    let start = DVector::zeros(process.states());
    let settings = HorizonSettings { samples: inputs.samples, ..HorizonSettings::default() };
    let constraints = vec![Constraint::at_least(inputs.bounded, 0.0)];
    Ok(MovingHorizon::try_new(process, &start, &matrix(&inputs.linear.prior), constraints, settings)?)
}

/// Solves the windows, then times a long record.
pub(crate) fn run(inputs: &Inputs, stopwatch: &Stopwatch) -> anyhow::Result<Results> {
    let fresh = estimator(inputs)?;
    let dt_s = inputs.linear.interval_s;
    let solve = |window: &Vec<Vec<f64>>| {
        let mut horizon = fresh.clone();
        let steps = window.iter().map(|z| horizon.step(dt_s, z));
        let last = steps.collect::<Result<Vec<_>, _>>()?.pop();
        last.context("a window without samples")
    };
    let ends = inputs.windows.iter().map(solve).collect::<anyhow::Result<Vec<_>>>()?;
    let mut horizon = fresh.clone();
    for z in &inputs.linear.readings[..inputs.samples] {
        horizon.step(dt_s, z)?;
    }
    let rest = &inputs.linear.readings[inputs.samples..];
    let over =
        |mut horizon: MovingHorizon<Process>| rest.iter().try_for_each(|z| horizon.step(dt_s, z).map(drop));
    Ok(Results {
        active: ends.iter().filter(|end| !end.active.is_empty()).count(),
        cost: ends.iter().map(|end| end.cost).collect(),
        newest: ends.iter().map(|end| end.x.iter().copied().collect()).collect(),
        time: stopwatch.time(rest.len(), || over(horizon.clone())),
        whole_window_time: stopwatch
            .time(inputs.windows.len(), || inputs.windows.iter().map(solve).filter(Result::is_ok).count()),
    })
}
