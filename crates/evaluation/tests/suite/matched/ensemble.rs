//! Many runs of a filter in worlds of its own, judged together.
use cylwatch_estimator::bound::{Efficiency, Expectation, Moments, PosteriorBound, path_bound};
use cylwatch_estimator::consistency::{EnsembleNees, NisAccumulator, Significance};
use cylwatch_estimator::filter::{ExtendedKalman, Linearisation, StateSpace, UdFactors};
use cylwatch_estimator::observer::ObserverSettings;
use nalgebra::DMatrix;
use rand::SeedableRng;
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;

use cylwatch_evaluation::matched::{Draws, OwnWorld};
use cylwatch_evaluation::world::chamber::Chamber;

/// Fixed times at which errors are judged.
const TIMES: usize = 10;
/// Paths that the expectations of the bound run over.
const BOUND_PATHS: u64 = 30;

/// An ensemble to be drawn.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub chamber: Chamber,
    /// Of the truth, and of the filter.
    pub truth: ObserverSettings,
    pub filter: ObserverSettings,
    /// Part of the cold spreads that the prior has.
    pub spread: f64,
    pub seeds: u64,
}

/// What a run leaves behind.
struct Run {
    nis: NisAccumulator,
    /// Error and covariance at each of the fixed times.
    at: Vec<(Vec<f64>, DMatrix<f64>)>,
    /// Squared errors of gas temperature and mass, summed over the samples.
    squares: [f64; 2],
    bound: Option<Bound>,
}

/// The bound's part of a run.
struct Bound {
    moments: Vec<Moments>,
    along: UdFactors,
    /// Variances of gas temperature and mass by the bound of this path, summed over the samples.
    variances: [f64; 2],
}

/// Efficiency of gas temperature and mass over the whole run.
#[derive(Debug)]
pub(crate) struct Efficiencies {
    /// By the bound of each true path, and by the bound as published.
    pub along_paths: [Efficiency; 2],
    pub published: [Efficiency; 2],
}

pub(crate) struct Ensemble {
    plan: Plan,
    runs: Vec<Run>,
    times_s: Vec<f64>,
    samples: usize,
    /// Indices of gas temperature and mass.
    functionals: [usize; 2],
    /// States that are not known exactly.
    pub uncertain: Vec<usize>,
}

/// Samples of the fixed times: evenly over the run, the last one included.
fn fixed(samples: usize) -> Vec<usize> {
    (1..=TIMES).map(|i| i * (samples - 1) / TIMES).collect()
}

fn run(plan: &Plan, samples: usize, functionals: [usize; 2], seed: u64) -> Run {
    let mut world = OwnWorld::new(plan.chamber, &plan.truth, plan.spread).unwrap();
    let model = OwnWorld::new(plan.chamber, &plan.filter, plan.spread).unwrap();
    let (mean, p) = (model.prior().0, UdFactors::from_covariance(&model.prior_covariance()).unwrap());
    let mut run = Run {
        nis: NisAccumulator::default(),
        at: Vec::new(),
        squares: [0.0; 2],
        bound: (seed < BOUND_PATHS).then(|| Bound {
            moments: Vec::new(),
            along: UdFactors::from_covariance(&world.prior_covariance()).unwrap(),
            variances: [0.0; 2],
        }),
    };
    let mut draws = Draws(ChaCha12Rng::seed_from_u64(seed));
    let mut x = draws.state(&world);
    let mut filter = ExtendedKalman::try_new(model, &mean, p).unwrap();
    let (fixed, sample_s) = (fixed(samples), world.sample_s);
    for k in 0..samples {
        let (dt_s, before) = (if k > 0 { sample_s } else { 0.0 }, x.clone());
        world.time_s = k.saturating_sub(1) as f64 * sample_s;
        filter.model_mut().time_s = world.time_s;
        if k > 0 {
            draws.advance(&mut world, &mut x, sample_s).unwrap();
        }
        let z = draws.readings(&mut world, &x).unwrap();
        run.nis.add_innovations(filter.step(dt_s, &z).unwrap());
        let error: Vec<f64> = filter.state().iter().zip(&x).map(|(estimate, x)| estimate - x).collect();
        for (sum, state) in run.squares.iter_mut().zip(functionals) {
            *sum += error[state].powi(2);
        }
        if fixed.contains(&k) {
            run.at.push((error, filter.factors().covariance()));
        }
        if let Some(bound) = &mut run.bound {
            bound.add(&mut world, (&before, dt_s, &x), functionals);
        }
    }
    run
}

impl Bound {
    fn add(&mut self, world: &mut OwnWorld, step: (&[f64], f64, &[f64]), functionals: [usize; 2]) {
        let heard = vec![true; world.outputs()];
        let mut linear = Linearisation::zeros(world.states(), world.leading(), world.noises());
        let mut moments = Moments::new(world.states(), world.leading());
        moments.add_path(world, step, &heard, &mut linear).unwrap();
        self.moments.push(moments);
        path_bound(world, &mut self.along, step, &heard, &mut linear).unwrap();
        for (sum, state) in self.variances.iter_mut().zip(functionals) {
            *sum += self.along.variance(state);
        }
    }
}

impl Ensemble {
    pub(crate) fn of(plan: &Plan) -> Self {
        let world = OwnWorld::new(plan.chamber, &plan.truth, plan.spread).unwrap();
        let prior = world.prior_covariance();
        let functionals = [world.map().gas, world.map().mass];
        let samples = world.samples();
        Self {
            runs: (0..plan.seeds).into_par_iter().map(|seed| run(plan, samples, functionals, seed)).collect(),
            plan: plan.clone(),
            times_s: fixed(samples).iter().map(|k| *k as f64 * world.sample_s).collect(),
            samples,
            functionals,
            uncertain: (0..world.states()).filter(|&i| prior[(i, i)] > 0.0).collect(),
        }
    }

    /// Innovations of all runs.
    pub(crate) fn nis(&self) -> NisAccumulator {
        let mut all = NisAccumulator::default();
        self.runs.iter().for_each(|run| all.merge(&run.nis));
        all
    }

    /// Normalised errors squared of some states together, over the runs, at the fixed times.
    pub(crate) fn nees(&self, states: &[usize]) -> EnsembleNees {
        let mut nees = EnsembleNees::new(&self.times_s, states.len());
        for run in &self.runs {
            for (index, (error, p)) in run.at.iter().enumerate() {
                let error: Vec<f64> = states.iter().map(|&i| error[i]).collect();
                nees.add(index, &error, &p.select_rows(states).select_columns(states)).unwrap();
            }
        }
        nees
    }

    /// Indices of gas temperature and mass.
    pub(crate) fn functionals(&self) -> [usize; 2] {
        self.functionals
    }

    /// Variances of gas temperature and mass, summed over the samples: mean of the bounds of the paths, and the bound as
    /// published on the same paths.
    pub(crate) fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let paths: Vec<&Bound> = self.runs.iter().filter_map(|run| run.bound.as_ref()).collect();
        let along =
            [0, 1].map(|w| paths.iter().map(|path| path.variances[w]).sum::<f64>() / paths.len() as f64);
        let world = OwnWorld::new(self.plan.chamber, &self.plan.truth, self.plan.spread).unwrap();
        let mut bound =
            PosteriorBound::try_new(&world.prior_covariance(), world.leading(), Expectation::Full).unwrap();
        let mut published = [0.0; 2];
        for k in 0..self.samples {
            let mut moments = Moments::new(world.states(), world.leading());
            paths.iter().for_each(|path| moments.merge(&path.moments[k]).unwrap());
            bound.step(&moments).unwrap();
            for (sum, state) in published.iter_mut().zip(self.functionals) {
                *sum += bound.covariance()[(state, state)];
            }
        }
        (along, published)
    }

    /// Efficiency by both bounds, with intervals of 95 %.
    pub(crate) fn efficiencies(&self) -> Efficiencies {
        let (along, published) = self.bounds();
        let of = |bounds: [f64; 2]| {
            [0, 1].map(|w| {
                let squares: Vec<f64> = self.runs.iter().map(|run| run.squares[w]).collect();
                Efficiency::over_time(bounds[w], &squares, Significance::FIVE_PERCENT).unwrap()
            })
        };
        Efficiencies { along_paths: of(along), published: of(published) }
    }
}
