//! Constraints: the constrained optimum against dense computation and closed forms, and what it is good for.
use cylwatch_estimator::filter::horizon::{
    Constraint, HorizonEstimate, HorizonSettings, HorizonStatus, MovingHorizon,
};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::problems::{Linear, covariance, leaking_mass, normal};
use super::reference::{Condensed, Kalman};

/// Rows of three constraints in the order of the reference: for each, its places from the window's start.
struct Rows {
    rows: Vec<DVector<f64>>,
    gaps: Vec<f64>,
    /// Constraint and age of each row, as an estimate reports them.
    names: Vec<(usize, usize)>,
}

/// Bound on state 0, a step row on state 1, and a bound on the constant state 2.
fn rows(condensed: &Condensed, bounds: [f64; 3]) -> Rows {
    let last = condensed.maps.len() - 1;
    let mut found = Rows { rows: Vec::new(), gaps: Vec::new(), names: Vec::new() };
    let mut push = |row: DVector<f64>, gap: f64, name| {
        found.rows.push(row);
        found.gaps.push(gap);
        found.names.push(name);
    };
    let at = |i: usize, k: usize| (condensed.maps[i].row(k).transpose(), condensed.offsets[i][k]);
    for i in 0..=last {
        let (row, offset) = at(i, 0);
        push(row, bounds[0] - offset, (0, last - i));
    }
    for i in 1..=last {
        let ((after, b), (before, a)) = (at(i, 1), at(i - 1, 1));
        push(after - before, bounds[1] - (b - a), (1, last - i));
    }
    let (row, offset) = at(0, 2);
    push(-row, -(bounds[2] - offset), (2, 0));
    found
}

#[test]
fn the_constrained_optimum_is_that_of_a_dense_search_over_active_sets() {
    let (mut most, mut total) = (0, 0);
    for seed in 0..40 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let problem = Linear::random(&mut rng, 3, 2, 2, 2);
        let (mean, prior) = (normal(&mut rng, 3), covariance(&mut rng, 3, 3));
        let root = prior.clone().cholesky().expect("full rank").unpack();
        let mut truth = mean.clone();
        let samples: Vec<_> = (0..4)
            .map(|_| {
                let dt_s = rng.random_range(0.2..1.0);
                (dt_s, problem.sample(&mut rng, &mut truth, dt_s, 0.2))
            })
            .collect();
        let condensed = Condensed::new(&problem, &mean, &root, &samples);
        // Bounds about where the unconstrained optimum lies, so that each is active about half of the time.
        let free = condensed.constrained(&DMatrix::zeros(0, condensed.rows.ncols()), &DVector::zeros(0), 0);
        let (x, before) = (condensed.state(3, &free.y), condensed.state(2, &free.y));
        let bounds = [x[0], x[1] - before[1], x[2]].map(|b| b + rng.random_range(-0.3..0.3));
        let expected = rows(&condensed, bounds);
        let c = DMatrix::from_columns(&expected.rows).transpose();
        let optimum = condensed.constrained(&c, &DVector::from_column_slice(&expected.gaps), 8);

        let constraints = vec![
            Constraint::at_most(0, bounds[0]),
            Constraint::step(&[(1, 1.0)], bounds[1]),
            Constraint::at_least(2, bounds[2]),
        ];
        let mut horizon =
            MovingHorizon::try_new(problem.clone(), &mean, &prior, constraints, HorizonSettings::default())
                .expect("sound problem");
        let estimates: Vec<_> =
            samples.iter().map(|(dt_s, z)| horizon.step(*dt_s, z.as_slice()).expect("no edge")).collect();
        let estimate = estimates.last().expect("four samples");
        for (i, x) in horizon.trajectory().iter().enumerate() {
            assert!((x - condensed.state(i, &optimum.y)).amax() < 1e-8, "seed {seed}, state {i}");
        }
        agrees_on_the_active_set(estimate, &expected, &optimum);
        let active = c.select_rows(&optimum.active);
        if !optimum.active.is_empty() {
            let projected = estimate.projected.as_ref().expect("rows are active");
            let error = (projected - condensed.newest_covariance(&active)).amax();
            assert!(error < 1e-9 * estimate.covariance.amax(), "seed {seed}: {error}");
        }
        most = most.max(optimum.active.len());
        total += optimum.active.len();
    }
    assert!(most >= 3 && total >= 40, "the cases exercise the constraints: at most {most}, {total} in all");
}

fn agrees_on_the_active_set(estimate: &HorizonEstimate, rows: &Rows, optimum: &super::reference::Optimum) {
    assert_eq!(estimate.active.len(), optimum.active.len());
    for (row, multiplier) in optimum.active.iter().zip(&optimum.multipliers) {
        let name = rows.names[*row];
        let found = estimate.active.iter().find(|a| (a.row, a.age) == name).expect("the same rows push");
        let scale = multiplier.abs().max(1.0);
        assert!((found.multiplier - multiplier).abs() < 1e-7 * scale, "{} {multiplier}", found.multiplier);
    }
}

/// Pool adjacent violators: the decreasing sequence nearest to `z` (Barlow et al. 1972).
fn decreasing_regression(z: &[f64]) -> Vec<f64> {
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for &z in z {
        pools.push((z, 1));
        while pools.len() > 1 && pools[pools.len() - 2].0 < pools[pools.len() - 1].0 {
            let (b, m) = pools.pop().expect("two pools");
            let (a, n) = pools.pop().expect("two pools");
            pools.push(((a * n as f64 + b * m as f64) / (n + m) as f64, n + m));
        }
    }
    pools.iter().flat_map(|&(value, count)| std::iter::repeat_n(value, count)).collect()
}

#[test]
fn a_free_mass_that_may_not_rise_is_the_isotonic_regression_of_its_readings() {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    // Next to no prior and next to no dynamics: the cost is that of the readings alone, to 1e-8.
    let problem = leaking_mass(1e8, 0.0, 1.0);
    let prior = DMatrix::from_diagonal(&DVector::from_vec(vec![1e8, 0.0]));
    let never_rising = vec![Constraint::step(&[(0, 1.0)], 0.0)];
    let mut horizon =
        MovingHorizon::try_new(problem, &DVector::zeros(2), &prior, never_rising, HorizonSettings::default())
            .expect("sound problem");
    let readings: Vec<f64> = (0..20).map(|i| 5.0 - 0.1 * f64::from(i) + normal(&mut rng, 1)[0]).collect();
    for z in &readings {
        horizon.step(1.0, &[*z]).expect("no edge");
    }
    let expected = decreasing_regression(&readings);
    assert!(expected.windows(2).filter(|pair| pair[0] == pair[1]).count() > 8, "many rows are active");
    for (x, expected) in horizon.trajectory()[1..].iter().zip(&expected) {
        assert!((x[0] - expected).abs() < 1e-6, "{} {expected}", x[0]);
    }
}

/// Run a random problem of seven states inside four constraints; how many estimates had active rows.
fn run_inside(known_input: f64, seed: u64) -> usize {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut problem = Linear::random(&mut rng, 7, 5, 4, 3);
    problem.u *= known_input;
    let (mean, prior) = (DVector::zeros(7), covariance(&mut rng, 7, 7));
    let constraints = vec![
        Constraint::at_least(0, -0.1),
        Constraint::at_most(6, 0.25),
        Constraint::row(&[(1, 1.0), (2, -2.0), (5, 0.5)], 0.7),
        Constraint::step(&[(3, 1.0), (4, 1.0)], 1.0),
    ];
    let settings = HorizonSettings { samples: 8, ..HorizonSettings::default() };
    let mut horizon = MovingHorizon::try_new(problem.clone(), &mean, &prior, constraints.clone(), settings)
        .expect("sound problem");
    let mut truth = mean;
    let mut active = 0;
    for step in 0..200 {
        let dt_s = rng.random_range(0.05..1.0);
        let z = problem.sample(&mut rng, &mut truth, dt_s, 0.2);
        let estimate = horizon.step(dt_s, z.as_slice()).expect("no edge");
        assert_eq!(
            estimate.status == HorizonStatus::Unconstrained,
            estimate.active.is_empty(),
            "step {step}: {:?}",
            estimate.status
        );
        active += usize::from(!estimate.active.is_empty());
        assert!(estimate.x[0] >= -0.1 && estimate.x[6] <= 0.25, "simple bounds hold to the last digit");
        for states in horizon.trajectory().windows(2) {
            let scale = states[1].amax().max(1.0);
            for (row, constraint) in constraints.iter().enumerate() {
                let excess = constraint.excess(states[0].as_slice(), states[1].as_slice());
                assert!(excess < 1e-9 * scale, "step {step}, row {row}: {excess}");
            }
        }
    }
    active
}

#[test]
fn estimates_stay_inside_the_constraints() {
    let active: Vec<usize> = (0..4).map(|seed| run_inside(0.0, seed)).collect();
    assert!(active.iter().all(|a| (50..=200).contains(a)), "constraints bind at times: {active:?}");
}

#[test]
fn estimates_stay_inside_constraints_that_the_data_contradict_by_thousands_of_standard_deviations() {
    let active = run_inside(1.0, 33);
    assert!(active > 190, "the process drifts out, so that some row is nearly always active: {active}");
}

#[test]
fn constraints_that_never_bind_change_nothing() {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let problem = Linear::random(&mut rng, 4, 3, 2, 2);
    let (mean, prior) = (DVector::zeros(4), covariance(&mut rng, 4, 4));
    let constraints = vec![Constraint::at_least(0, -1e6), Constraint::row(&[(1, 1.0), (3, 1.0)], 1e6)];
    let settings = HorizonSettings { samples: 5, ..HorizonSettings::default() };
    let mut horizon =
        MovingHorizon::try_new(problem.clone(), &mean, &prior, constraints, settings).expect("sound problem");
    let mut filter = Kalman { x: mean.clone(), p: prior };
    let mut truth = mean;
    for _ in 0..40 {
        let z = problem.sample(&mut rng, &mut truth, 0.5, 0.2);
        filter.step(&problem, 0.5, &z);
        let estimate = horizon.step(0.5, z.as_slice()).expect("no edge");
        assert_eq!((estimate.qp_solves, estimate.projected), (0, None));
        assert!((estimate.x - &filter.x).amax() < 1e-10);
    }
}

/// Root mean square errors of a small constant leak, with the bound at zero and without, over an ensemble.
fn leak_errors(samples: usize) -> (f64, f64) {
    let leak = 0.01;
    let (mut with, mut without) = (0.0, 0.0);
    for seed in 0..60 {
        let mut rng = ChaCha8Rng::seed_from_u64(1000 + seed);
        let prior = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 0.01]));
        let settings = HorizonSettings { samples, ..HorizonSettings::default() };
        let start = DVector::from_vec(vec![100.0, 0.0]);
        let horizon = |bounds| {
            let problem = leaking_mass(0.0, 1e-5, 1.0);
            MovingHorizon::try_new(problem, &start, &prior, bounds, settings.clone()).expect("sound problem")
        };
        let (mut bounded, mut free) = (horizon(vec![Constraint::at_least(1, 0.0)]), horizon(Vec::new()));
        let mut mass = 100.0;
        for step in 0..60 {
            mass -= leak;
            let z = [mass + normal(&mut rng, 1)[0]];
            let (a, b) = (bounded.step(1.0, &z).expect("no edge"), free.step(1.0, &z).expect("no edge"));
            assert!(a.x[1] >= 0.0);
            if step >= 20 {
                with += (a.x[1] - leak).powi(2) / (60.0 * 40.0);
                without += (b.x[1] - leak).powi(2) / (60.0 * 40.0);
            }
        }
    }
    (with.sqrt(), without.sqrt())
}

#[test]
fn a_leak_that_cannot_be_negative_is_estimated_better_for_it() {
    for samples in [1, 15] {
        let (with, without) = leak_errors(samples);
        assert!(with < 0.9 * without, "{samples} samples: {with} against {without}");
    }
}
