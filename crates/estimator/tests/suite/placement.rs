//! Sensor placement on random systems: searches against each other, gradients against differences, bounds against the optimum.
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::placement::certificate::{CertificateSettings, certify, window::window_bound};
use cylwatch_estimator::placement::search::{Method, SearchControl, SearchResult, search};
use cylwatch_estimator::placement::{CandidateOutput, Constraints, Group, LinearProblem, Objective};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

const SYSTEMS: u64 = 30;

/// A random system of 5 to 9 states, some of them slow, with 8 to 12 candidates of different noise.
fn system(seed: u64) -> LinearProblem {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let n = random.random_range(5..10);
    let candidates = random.random_range(8..13);
    let mut normal = || -> f64 { random.sample(StandardNormal) };
    let mut f = DMatrix::from_fn(n, n, |_, _| normal());
    let radius = f.complex_eigenvalues().iter().map(|value| value.norm()).fold(0.0, f64::max);
    f *= 0.97 / radius;
    let root = DMatrix::from_fn(n, n, |_, _| 0.3 * normal());
    let functional = DVector::from_fn(n, |_, _| normal());
    let outputs: Vec<CandidateOutput> = (0..candidates)
        .map(|_| CandidateOutput {
            gradient: DVector::from_fn(n, |_, _| normal()),
            variance: (0.5 * normal()).exp(),
        })
        .collect();
    LinearProblem::new(f, &root * root.transpose(), functional, outputs).unwrap()
}

fn find(problem: &LinearProblem, constraints: &Constraints, method: Method) -> SearchResult {
    search(problem, constraints, method, 0.02, &SearchControl::default()).unwrap()
}

#[test]
fn branch_and_bound_finds_the_layouts_that_the_exhaustive_search_finds() {
    let mut saved = 0;
    for seed in 1..=SYSTEMS {
        let problem = system(seed);
        for sensors in 1..=4 {
            let constraints = Constraints::of(sensors);
            let all = find(&problem, &constraints, Method::Exhaustive);
            let bounded = find(&problem, &constraints, Method::BranchAndBound);
            assert_eq!(all.layouts, bounded.layouts, "system {seed}, {sensors} sensors");
            assert!(!all.layouts.is_empty() && all.bound == Some(all.layouts[0].value));
            saved += u64::from(bounded.evaluated < all.evaluated);
        }
    }
    println!("branch and bound took fewer evaluations in {saved} of {} searches", 4 * SYSTEMS);
}

#[test]
fn all_searches_keep_the_constraints() {
    for seed in 1..=SYSTEMS {
        let problem = system(seed);
        let candidates = problem.candidates();
        let constraints = Constraints {
            must: vec![2],
            forbidden: vec![0],
            groups: vec![Group { members: vec![1, 3, 4], fewest: 1, most: 2 }],
            apart: vec![(3, 5), (2, 6)],
            costs: (0..candidates).map(|index| 1.0 + index as f64).collect(),
            budget: 20.0,
            ..Constraints::of(4)
        };
        let all = find(&problem, &constraints, Method::Exhaustive);
        let bounded = find(&problem, &constraints, Method::BranchAndBound);
        let greedy = find(&problem, &constraints, Method::Greedy);
        assert_eq!(all.layouts, bounded.layouts, "system {seed}");
        let best = all.best().unwrap();
        let found = greedy.best().expect("greedy finds one that is allowed");
        assert!(found.value >= best.value);
        for layout in all.layouts.iter().chain(&greedy.layouts) {
            assert!(constraints.allow(&layout.sensors), "{:?}", layout.sensors);
        }
        let certificate = certify(&problem, &constraints, &CertificateSettings::default()).unwrap();
        assert!(certificate.bound() <= best.value * (1.0 + 1e-9));
        let free = certify(&problem, &Constraints::of(4), &CertificateSettings::default()).unwrap();
        assert!(certificate.relaxed >= free.bound(), "constraints can only raise it");
    }
}

#[test]
fn the_gradient_is_that_of_the_differences() {
    for seed in 1..=SYSTEMS {
        let problem = system(seed);
        let mut random = ChaCha8Rng::seed_from_u64(1000 + seed);
        let at: Vec<f64> = (0..problem.candidates()).map(|_| 0.2 + 0.6 * random.random::<f64>()).collect();
        let here = problem.relaxed(&at).unwrap();
        let largest = here.gradient.iter().fold(0.0, |most: f64, by| most.max(by.abs()));
        for index in 0..at.len() {
            let moved = |by: f64| {
                let mut moved = at.clone();
                moved[index] += by;
                problem.relaxed(&moved).unwrap().value
            };
            // Two central differences, extrapolated.
            let central = |by: f64| (moved(by) - moved(-by)) / (2.0 * by);
            let difference = (4.0 * central(1e-3) - central(2e-3)) / 3.0;
            let error = (here.gradient[index] - difference).abs() / largest;
            assert!(error < 1e-6, "system {seed}, candidate {index}: {error:e}");
            assert!(here.gradient[index] <= 0.0, "a sensor more never harms");
        }
    }
}

#[test]
fn the_relaxation_is_convex_and_is_the_value_at_its_corners() {
    for seed in 1..=SYSTEMS {
        let problem = system(seed);
        let mut random = ChaCha8Rng::seed_from_u64(2000 + seed);
        let mut weights =
            || -> Vec<f64> { (0..problem.candidates()).map(|_| random.random::<f64>()).collect() };
        for _ in 0..20 {
            let (a, b) = (weights(), weights());
            let middle: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 0.5 * (a + b)).collect();
            let [a, b, middle] = [a, b, middle].map(|at| problem.relaxed(&at).unwrap().value);
            assert!(middle <= 0.5 * (a + b) * (1.0 + 1e-12), "system {seed}: {middle} above {a}, {b}");
        }
        let layout = [0, 3, 5];
        let mut corner = vec![0.0; problem.candidates()];
        layout.iter().for_each(|index| corner[*index] = 1.0);
        let (value, relaxed) = (problem.value(&layout), problem.relaxed(&corner).unwrap().value);
        assert!((value - relaxed).abs() <= 1e-12 * value);
    }
}

#[test]
fn no_bound_is_above_the_optimum_and_the_window_comes_near_the_relaxation() {
    let mut nearest = 0.0_f64;
    for seed in 1..=SYSTEMS {
        let problem = system(seed);
        for sensors in 1..=4 {
            let constraints = Constraints::of(sensors);
            let best = find(&problem, &constraints, Method::Exhaustive).layouts[0].value;
            let certificate = certify(&problem, &constraints, &CertificateSettings::default()).unwrap();
            let (bound, relaxed) = (certificate.bound(), certificate.relaxed);
            assert!(bound <= relaxed * (1.0 + 1e-9) && relaxed <= best * (1.0 + 1e-9), "system {seed}");
            assert!(relaxed - bound <= 2e-3 * relaxed, "system {seed}: {bound} below {relaxed}");
            if seed > 6 {
                continue;
            }
            let windows = [1, 4, 16].map(|samples| window_bound(&problem, &constraints, samples).unwrap());
            assert!(windows[0] <= windows[1] * (1.0 + 1e-7) && windows[1] <= windows[2] * (1.0 + 1e-7));
            assert!(windows[2] <= relaxed * (1.0 + 1e-7), "system {seed}: {windows:?} above {relaxed}");
            nearest = nearest.max(windows[2] / relaxed);
        }
    }
    assert!(nearest > 0.99, "{nearest}");
}

#[test]
fn what_cannot_be_seen_is_worth_nothing_and_contradictions_are_refused() {
    // A random walk that only the first candidate sees.
    let f = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 0.5]));
    let output = |gradient: [f64; 2]| CandidateOutput {
        gradient: DVector::from_vec(gradient.to_vec()),
        variance: 1.0,
    };
    let outputs = vec![output([1.0, 1.0]), output([0.0, 1.0]), output([0.0, 2.0])];
    let q = DMatrix::identity(2, 2);
    let problem = LinearProblem::new(f, q, DVector::from_vec(vec![1.0, 0.0]), outputs).unwrap();
    assert_eq!(problem.value(&[1, 2]), f64::INFINITY);
    assert!(problem.value(&[0]).is_finite());
    for method in [Method::Exhaustive, Method::BranchAndBound, Method::Greedy] {
        let found = find(&problem, &Constraints::of(2), method);
        assert!(found.best().unwrap().sensors.contains(&0), "{method:?}");
        let blind = Constraints { forbidden: vec![0], ..Constraints::of(2) };
        assert!(find(&problem, &blind, method).best().is_none());
        let refused = search(&problem, &Constraints::of(9), method, 0.0, &SearchControl::default());
        assert!(matches!(refused, Err(EstimatorError::PlacementConstraints { .. })));
    }
    // Each by itself is possible, all together are not.
    let groups = vec![
        Group { members: vec![0, 1], fewest: 2, most: 2 },
        Group { members: vec![2], fewest: 1, most: 1 },
    ];
    let refused =
        certify(&problem, &Constraints { groups, ..Constraints::of(2) }, &CertificateSettings::default());
    assert!(matches!(refused, Err(EstimatorError::PlacementConstraints { .. })), "{refused:?}");
}

#[test]
fn a_search_that_is_stopped_says_so() {
    let problem = system(3);
    let control = SearchControl::default();
    control.stop.store(true, std::sync::atomic::Ordering::Relaxed);
    let found = search(&problem, &Constraints::of(3), Method::Exhaustive, 0.02, &control).unwrap();
    assert!(found.partial && found.bound.is_none());
}
