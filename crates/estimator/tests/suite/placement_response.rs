//! What disturbances leave in innovations and estimates, against sample-by-sample recursions and against other ways to the same number.
use approx::assert_relative_eq;
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::filter::steady_state;
use cylwatch_estimator::placement::{
    Candidates, DetectionSettings, Disturbance, Quantity, Response, SteadyAnalysis, SteadySettings,
};
use cylwatch_estimator::thermal::vessel::presets;
use nalgebra::{DMatrix, DVector};

fn analysis() -> (Candidates, SteadyAnalysis) {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let candidates = Candidates::of_vessel(&vessel).unwrap();
    let analysis = SteadyAnalysis::new(&vessel, &candidates.sensors(), &SteadySettings::default()).unwrap();
    (candidates, analysis)
}

fn layout(candidates: &Candidates, names: &[&str]) -> Vec<usize> {
    let mut layout: Vec<usize> = names.iter().map(|name| candidates.index(name).unwrap()).collect();
    layout.sort_unstable();
    layout
}

/// Means of the innovations and the error after the last update, sample by sample, of a reading that is off by one.
fn one_by_one(
    analysis: &SteadyAnalysis,
    layout: &[usize],
    candidate: usize,
    samples: usize,
) -> (f64, DVector<f64>) {
    let problem = analysis.problem(Quantity::LeakRate).of_layout(layout);
    let (n, m) = (problem.transition().nrows(), layout.len());
    let h = DMatrix::from_fn(m, n, |i, j| problem.outputs()[i].gradient[j]);
    let r = DVector::from_fn(m, |i, _| problem.outputs()[i].variance);
    let steady = steady_state(problem.transition(), &h, problem.process_noise(), &r).unwrap();
    let place = layout.iter().position(|of| *of == candidate).unwrap();
    let (mut error, mut after, mut information) = (DVector::zeros(n), DVector::zeros(n), 0.0);
    for sample in 0..=samples {
        let mut innovation = &h * &error;
        innovation[place] += 1.0;
        if sample < samples {
            information += innovation.dot(&steady.innovation.clone().cholesky().unwrap().solve(&innovation));
        }
        after = &error - &steady.gain * innovation;
        error = problem.transition() * &after;
    }
    (information, after)
}

#[test]
fn sums_by_doubling_are_those_of_the_samples() {
    let (candidates, analysis) = analysis();
    let layout = layout(&candidates, &["shoulder", "valve", "pressure"]);
    let shoulder = candidates.index("shoulder").unwrap();
    let response = analysis.response(&layout, &[Disturbance::Reading { candidate: shoulder }]).unwrap();
    let functional = analysis.problem(Quantity::GasTemperature).of_layout(&layout).functional().clone();
    for samples in [1, 2, 37, 600] {
        let (information, after) = one_by_one(&analysis, &layout, shoulder, samples);
        assert_relative_eq!(response.information(samples as u64)[(0, 0)], information, max_relative = 1e-8);
        let bias_k = response.bias(Quantity::GasTemperature, samples as u64)[0];
        assert_relative_eq!(bias_k, -functional.dot(&after), max_relative = 1e-6, epsilon = 1e-9);
    }
}

/// A leak on top of none is told by what a member that supposes one with a wide prior would know of it: with no other walk of the rate its variance
/// after the samples is the inverse of prior and information.
#[test]
fn the_information_of_a_leak_is_what_a_filter_with_a_state_for_it_learns() {
    let (candidates, analysis) = analysis();
    let layout = layout(&candidates, &["middle", "pressure"]);
    let problem = analysis.problem(Quantity::LeakRate).of_layout(&layout);
    let leak = analysis.slow().names().iter().position(|name| name.starts_with("leak")).unwrap();
    let states = analysis.problem(Quantity::LeakRate).states_of(&layout);
    let leak = states.iter().position(|state| *state == leak).unwrap();
    // A second rate beside the one that walks: constant, of unknown size, in the units of its scale.
    let n = states.len();
    let mut f = problem.transition().clone().resize(n + 1, n + 1, 0.0);
    let mut column = f.column(leak).rows(0, n).into_owned();
    column[leak] = 0.0;
    f.view_mut((0, n), (n, 1)).copy_from(&column);
    f[(n, n)] = 1.0;
    let q = problem.process_noise().clone().resize(n + 1, n + 1, 0.0);
    let h = DMatrix::from_fn(
        layout.len(),
        n + 1,
        |i, j| {
            if j < n { problem.outputs()[i].gradient[j] } else { 0.0 }
        },
    );
    let r = DVector::from_fn(layout.len(), |i, _| problem.outputs()[i].variance);
    let h_n = h.columns(0, n).into_owned();
    let steady = steady_state(problem.transition(), &h_n, problem.process_noise(), &r).unwrap();
    let prior = 1e4;
    let mut p = steady.predicted.clone().resize(n + 1, n + 1, 0.0);
    p[(n, n)] = prior;
    let samples = 300;
    for _ in 0..samples {
        let s = &h * &p * h.transpose() + DMatrix::from_diagonal(&r);
        let k = &p * h.transpose() * s.try_inverse().unwrap();
        let left = DMatrix::identity(n + 1, n + 1) - &k * &h;
        p = &left * &p * left.transpose() + &k * DMatrix::from_diagonal(&r) * k.transpose();
        p = &f * p * f.transpose() + &q;
    }
    let scale = analysis.slow().scales()
        [analysis.slow().names().iter().position(|of| of.starts_with("leak")).unwrap()];
    let information = analysis.response(&layout, &[Disturbance::Leak]).unwrap().information(samples)[(0, 0)];
    assert_relative_eq!(1.0 / p[(n, n)] - 1.0 / prior, information * scale * scale, max_relative = 1e-4);
}

#[test]
fn the_delay_is_when_the_information_suffices() {
    let (candidates, analysis) = analysis();
    let layout = layout(&candidates, &["shoulder", "valve", "pressure"]);
    let smallest = analysis.smallest_leak_kg_s(&layout).unwrap();
    let within_s = analysis.settings().detection.within_s;
    // The smallest leak of a day is found after a day, a larger one sooner, a smaller one later.
    assert_relative_eq!(analysis.delay_s(&layout, smallest).unwrap().unwrap(), within_s, max_relative = 1e-3);
    let delays: Vec<f64> =
        [4.0, 2.0, 1.0, 0.95].map(|by| analysis.delay_s(&layout, by * smallest).unwrap().unwrap()).to_vec();
    assert!(delays.is_sorted() && delays[0] > 0.0, "{delays:?}");
    let response: Response = analysis.response(&layout, &[Disturbance::Leak]).unwrap();
    let needed = (DetectionSettings::default().needed_sd() / (3.0 * smallest)).powi(2);
    let samples = response.samples_to(0, needed).unwrap();
    let information = |samples| response.information(samples)[(0, 0)];
    assert!(information(samples) >= needed && information(samples - 1) < needed);
    // The member follows a leak that lasts, so that in the end innovations tell no more of a tiny one.
    assert_eq!(analysis.delay_s(&layout, 1e-6 * smallest).unwrap(), None);
}

/// In a trial a middle thermometer found leaks some 30 % smaller than one on the shoulder; with the film at the difference that noise makes it
/// is 20 %.
#[test]
fn the_middle_finds_smaller_leaks_than_the_shoulder() {
    let (candidates, analysis) = analysis();
    let smallest = |names: &[&str]| analysis.smallest_leak_kg_s(&layout(&candidates, names)).unwrap();
    let (middle, shoulder) =
        (smallest(&["middle", "valve", "pressure"]), smallest(&["shoulder", "valve", "pressure"]));
    println!("smallest leak in a day: middle {} g/h, shoulder {} g/h", 3.6e6 * middle, 3.6e6 * shoulder);
    assert!(middle < 0.85 * shoulder);
}

/// How fine the wall is divided decides how finely heights are told apart, not what a place is worth.
#[test]
fn a_finer_wall_says_the_same_of_a_place() {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let candidates = Candidates::of_vessel(&vessel).unwrap();
    let gas_sd_k = |wall_nodes| {
        let mut settings = SteadySettings::default();
        settings.observer.wall_nodes = wall_nodes;
        let analysis = SteadyAnalysis::new(&vessel, &candidates.sensors(), &settings).unwrap();
        ["bottom", "middle", "shoulder", "valve"]
            .map(|name| analysis.accuracy(&layout(&candidates, &[name, "pressure"])).unwrap().gas_sd_k)
    };
    let (vehicle, usual, fine) = (gas_sd_k(2), gas_sd_k(6), gas_sd_k(12));
    println!("{vehicle:?} {usual:?} {fine:?}");
    for place in 0..4 {
        assert_relative_eq!(usual[place], fine[place], max_relative = 0.03);
        assert_relative_eq!(vehicle[place], fine[place], max_relative = 0.08);
    }
}

#[test]
fn what_is_not_seen_is_named() {
    let (candidates, analysis) = analysis();
    let error = analysis.accuracy(&layout(&candidates, &["shoulder", "valve"])).unwrap_err();
    assert!(matches!(&error, EstimatorError::Unseen { state } if state == "mass_kg"), "{error}");
}
