//! What goes wrong is said: infeasible constraints are an outcome, unusable input is an error, neither does harm.
use std::cell::Cell;
use std::rc::Rc;

use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::filter::horizon::{
    Constraint, FallbackReason, HorizonError, HorizonSettings, HorizonStatus, Loss, MovingHorizon,
};
use cylwatch_estimator::filter::{Dimensions, Linearisation, StateSpace};
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::problems::{Linear, covariance, leaking_mass, normal};
use super::reference::Kalman;

#[test]
fn constraints_that_contradict_each_other_leave_the_filters_estimate_and_say_so() {
    let mut rng = ChaCha8Rng::seed_from_u64(14);
    let problem = Linear::random(&mut rng, 4, 3, 2, 2);
    let (mean, prior) = (normal(&mut rng, 4), covariance(&mut rng, 4, 4));
    let contradiction = vec![Constraint::at_least(0, 1.0), Constraint::at_most(0, -1.0)];
    let settings = HorizonSettings { samples: 5, ..HorizonSettings::default() };
    let mut horizon = MovingHorizon::try_new(problem.clone(), &mean, &prior, contradiction, settings)
        .expect("each row is sound");
    let mut filter = Kalman { x: mean.clone(), p: prior };
    let mut truth = mean;
    for _ in 0..20 {
        let z = problem.sample(&mut rng, &mut truth, 0.5, 0.2);
        filter.step(&problem, 0.5, &z);
        let estimate = horizon.step(0.5, z.as_slice()).expect("an outcome, not an error");
        assert_eq!(estimate.status, HorizonStatus::Fallback(FallbackReason::Infeasible));
        assert!((&estimate.x - &filter.x).amax() < 1e-9);
        assert!(estimate.active.is_empty() && estimate.projected.is_none());
    }
}

#[test]
fn infeasible_constraints_leave_the_robust_estimate_where_the_loss_is_robust() {
    let estimate = |constraints| {
        let loss = Loss::Huber { delta: 1.5 };
        let settings = HorizonSettings { samples: 8, loss, ..HorizonSettings::default() };
        let prior = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 0.01]));
        let mut horizon = MovingHorizon::try_new(
            leaking_mass(0.01, 1e-6, 1.0),
            &DVector::zeros(2),
            &prior,
            constraints,
            settings,
        )
        .expect("sound problem");
        let readings = [0.1, -0.5, 30.0, 0.4, 0.0, -25.0, 0.3];
        let estimates = readings.map(|z| horizon.step(1.0, &[z]).expect("no edge"));
        estimates.into_iter().last().expect("seven samples")
    };
    let free = estimate(Vec::new());
    let denied = estimate(vec![Constraint::at_least(1, 1.0), Constraint::at_most(1, -1.0)]);
    assert_eq!(denied.status, HorizonStatus::Fallback(FallbackReason::Infeasible));
    assert_eq!(free.outliers.len(), 2);
    assert!((denied.x - free.x).amax() < 1e-9 && (denied.covariance - free.covariance).amax() < 1e-9);
}

#[test]
fn a_state_known_for_certain_outside_a_bound_is_infeasible_until_the_bound_holds() {
    // The mass is known and leaks at a known rate: nothing can move it.
    let problem = leaking_mass(0.0, 0.0, 1.0);
    let start = DVector::from_vec(vec![10.0, 1.0]);
    let settings = HorizonSettings { samples: 2, ..HorizonSettings::default() };
    let mut horizon = MovingHorizon::try_new(
        problem,
        &start,
        &DMatrix::zeros(2, 2),
        vec![Constraint::at_most(0, 8.5)],
        settings,
    )
    .expect("sound problem");
    let statuses: Vec<_> = (0..6)
        .map(|i| {
            let estimate = horizon.step(1.0, &[0.0]).expect("no edge");
            assert!((estimate.x[0] - (9.0 - f64::from(i))).abs() < 1e-12, "the certain state stays");
            estimate.status
        })
        .collect();
    let infeasible = HorizonStatus::Fallback(FallbackReason::Infeasible);
    // At the fourth sample the window holds masses 8, 7 and 6.
    assert_eq!(statuses[..3], [infeasible; 3]);
    assert_eq!(statuses[3..], [HorizonStatus::Unconstrained; 3]);
}

fn sound() -> MovingHorizon<Linear> {
    let prior = DMatrix::identity(2, 2);
    MovingHorizon::try_new(
        leaking_mass(1.0, 1.0, 1.0),
        &DVector::zeros(2),
        &prior,
        Vec::new(),
        <_>::default(),
    )
    .expect("sound problem")
}

#[test]
fn samples_that_are_none_are_refused_and_leave_the_window_as_it_was() {
    let mut horizon = sound();
    let mut untouched = sound();
    for h in [&mut horizon, &mut untouched] {
        h.step(1.0, &[0.3]).expect("sound sample");
    }
    for dt_s in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(horizon.step(dt_s, &[0.0]), Err(HorizonError::Interval { .. })));
    }
    assert_eq!(horizon.step(1.0, &[0.0, 1.0]), Err(HorizonError::Readings { given: 2, outputs: 1 }));
    let infinite = horizon.step(1.0, &[f64::INFINITY]).expect_err("infinite");
    assert_eq!(infinite.to_string(), "reading inf of output 0 must be finite, or NaN where there is none");
    assert_eq!(horizon.step(1.0, &[0.7]), untouched.step(1.0, &[0.7]));
}

#[test]
fn settings_constraints_and_priors_out_of_range_are_refused() {
    let attempt = |mean: usize, prior: DMatrix<f64>, constraint: Constraint, settings| {
        let problem = leaking_mass(1.0, 1.0, 1.0);
        MovingHorizon::try_new(problem, &DVector::zeros(mean), &prior, vec![constraint], settings)
            .map(|_| ())
            .expect_err("refused")
            .to_string()
    };
    let (good, bound, default) =
        (DMatrix::identity(2, 2), Constraint::at_least(1, 0.0), HorizonSettings::default());
    let with = |change: fn(&mut HorizonSettings)| {
        let mut settings = default.clone();
        change(&mut settings);
        attempt(2, good.clone(), bound.clone(), settings)
    };
    assert_eq!(with(|s| s.samples = 0), "moving-horizon setting samples = 0 must be at least 1");
    assert_eq!(
        with(|s| s.iterations_max = 0),
        "moving-horizon setting iterations_max = 0 must be at least 1"
    );
    assert!(with(|s| s.tolerance = f64::NAN).contains("tolerance = NaN must be above 0 and below 1"));
    assert!(with(|s| s.loss = Loss::Huber { delta: 0.0 }).contains("loss.delta = 0 must be above 0"));
    let row = |constraint| attempt(2, good.clone(), constraint, default.clone());
    assert_eq!(
        row(Constraint::at_most(2, 0.0)),
        "constraint 0 names state 2, but states run from 0 to 1 only"
    );
    assert!(row(Constraint::at_most(0, f64::INFINITY)).contains("must be finite"));
    assert!(row(Constraint::row(&[(0, 0.0)], 1.0)).contains("must differ from zero"));
    assert!(
        attempt(3, good.clone(), bound.clone(), default.clone()).contains("prior mean of as many, not 3")
    );
    assert!(attempt(2, DMatrix::identity(3, 3), bound.clone(), default.clone()).contains("not 3 x 3"));
    assert!(attempt(2, -&good, bound.clone(), default.clone()).contains("positive semi-definite"));
}

#[test]
fn rows_on_the_steps_of_constants_are_refused() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let problem = Linear::random(&mut rng, 3, 2, 1, 1);
    let constraint = vec![Constraint::step(&[(2, 1.0)], 0.0)];
    let refused = MovingHorizon::try_new(
        problem,
        &DVector::zeros(3),
        &DMatrix::identity(3, 3),
        constraint,
        <_>::default(),
    )
    .map(|_| ());
    assert!(matches!(refused, Err(EstimatorError::ConstraintRow { row: 0, .. })));
}

/// A walk whose evaluation fails, or whose noise vanishes, on demand.
#[derive(Clone)]
struct Moody {
    mood: Rc<Cell<Mood>>,
}

#[derive(Clone, Copy, PartialEq)]
enum Mood {
    Good,
    NoTransition,
    NoTransitionDerivative,
    NotANumber,
    NoNoise,
}

impl StateSpace for Moody {
    type Error = std::fmt::Error;

    fn dimensions(&self) -> Dimensions {
        Dimensions { states: 1, leading: 1, noises: 1, outputs: 1 }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        _dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Self::Error> {
        let mood = self.mood.get();
        if mood == Mood::NoTransition || (mood == Mood::NoTransitionDerivative && linear.is_some()) {
            return Err(std::fmt::Error);
        }
        if mood == Mood::NotANumber {
            x[0] = f64::NAN;
        }
        if let Some(linear) = linear {
            linear.phi[(0, 0)] = 1.0;
            linear.g[(0, 0)] = 1.0;
            linear.q[0] = 1.0;
        }
        Ok(())
    }

    fn output(&mut self, _j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Self::Error> {
        if let Some(h) = h {
            h[0] = 1.0;
        }
        Ok(x[0])
    }

    fn noise_variance(&self, _j: usize, _x: &[f64]) -> f64 {
        if self.mood.get() == Mood::NoNoise { 0.0 } else { 1.0 }
    }
}

#[test]
fn a_process_that_cannot_be_evaluated_costs_the_sample_and_no_more() {
    let bad = [Mood::NoTransition, Mood::NoTransitionDerivative, Mood::NotANumber, Mood::NoNoise];
    for (mood, samples_before) in bad.into_iter().flat_map(|mood| [(mood, 0), (mood, 2), (mood, 3)]) {
        let state = Rc::new(Cell::new(Mood::Good));
        let settings = HorizonSettings { samples: 3, ..HorizonSettings::default() };
        let new = || {
            let model = Moody { mood: state.clone() };
            let (mean, prior) = (DVector::zeros(1), DMatrix::identity(1, 1));
            MovingHorizon::try_new(model, &mean, &prior, Vec::new(), settings.clone()).expect("sound")
        };
        let (mut horizon, mut untouched) = (new(), new());
        for i in 0..samples_before {
            let z = [f64::from(i)];
            assert_eq!(horizon.step(1.0, &z), untouched.step(1.0, &z));
        }
        state.set(mood);
        let error = horizon.step(1.0, &[5.0]).expect_err("cannot be evaluated");
        match mood {
            Mood::NoNoise => assert!(matches!(error, HorizonError::NoiseVariance { output: 0, .. })),
            Mood::NotANumber => assert_eq!(error, HorizonError::NotFinite),
            _ => assert_eq!(error, HorizonError::Model(std::fmt::Error)),
        }
        state.set(Mood::Good);
        let (a, b) = (horizon.step(1.0, &[1.0]), untouched.step(1.0, &[1.0]));
        assert_eq!(a.expect("good again"), b.expect("always good"));
    }
}
