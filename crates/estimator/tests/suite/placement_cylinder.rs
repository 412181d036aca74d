//! Sensor placement on the cylinder: the criterion is the observer's own accuracy, and the searches work on it.
use approx::assert_relative_eq;
use cylwatch_estimator::EstimatorError;
use cylwatch_estimator::filter::{Linearisation, Plant, StateSpace, UdFactors};
use cylwatch_estimator::observer::cylinder::Cylinder;
use cylwatch_estimator::observer::{LeakHypothesis, ObserverSettings};
use cylwatch_estimator::placement::certificate::{CertificateSettings, certify};
use cylwatch_estimator::placement::search::{Method, SearchControl, SearchResult, search};
use cylwatch_estimator::placement::{
    Conditions, Constraints, GroupedProblem, InstrumentedCylinder, Objective, Quantity,
};
use cylwatch_estimator::sensor::Sensor;
use cylwatch_estimator::thermal::vessel::{Vessel, presets};
use nalgebra::DMatrix;

/// Wall nodes of these tests, fine enough to tell heights apart.
const NODES: usize = 6;
const NAMES: [&str; 6] = ["shoulder", "valve", "middle", "bottom", "ambient", "pressure"];

fn vessel() -> Vessel {
    presets::load("nitrogen-20l").unwrap()
}

fn settings() -> ObserverSettings {
    ObserverSettings { wall_nodes: NODES, ..ObserverSettings::default() }
}

fn candidates(names: &[&str]) -> Vec<Sensor> {
    names.iter().map(|name| Sensor::typical(name).unwrap()).collect()
}

fn instrumented(sensors: &[Sensor], member: &LeakHypothesis) -> InstrumentedCylinder {
    InstrumentedCylinder::new(&vessel(), sensors, &settings(), member, &Conditions::default()).unwrap()
}

fn member() -> LeakHypothesis {
    settings().bank[0]
}

fn index(name: &str) -> usize {
    NAMES.iter().position(|known| *known == name).unwrap()
}

fn layout(names: &[&str]) -> Vec<usize> {
    let mut layout: Vec<usize> = names.iter().map(|name| index(name)).collect();
    layout.sort_unstable();
    layout
}

#[test]
fn a_layout_is_worth_what_the_cylinder_with_its_sensors_alone_is_worth() {
    let all = instrumented(&candidates(&NAMES), &member());
    for names in [&["shoulder", "valve", "pressure"][..], &["pressure"], &["bottom", "ambient", "pressure"]] {
        let layout = layout(names);
        let own: Vec<&str> = layout.iter().map(|&candidate| NAMES[candidate]).collect();
        let alone = instrumented(&candidates(&own), &member());
        let everybody: Vec<usize> = (0..own.len()).collect();
        for quantity in [Quantity::GasTemperature, Quantity::Mass] {
            let problem = all.problem(quantity).unwrap();
            let value = problem.value(&layout);
            assert_relative_eq!(
                value,
                alone.problem(quantity).unwrap().value(&everybody),
                max_relative = 1e-9
            );
            // With the states of those that nobody reads.
            assert_relative_eq!(value, problem.whole().value(&layout), max_relative = 1e-6);
        }
    }
}

/// The steady state is where the observer's filter stays: factors that begin there go through samples of the cylinder's
/// own transition and outputs.
#[test]
fn the_observers_filter_stays_in_the_steady_state() {
    let sensors = candidates(&["shoulder", "valve", "pressure"]);
    // The leak rate walks: every state of the cylinder is one of the problem.
    let member = LeakHypothesis::walking_rate(0.02);
    let instrumented = instrumented(&sensors, &member);
    let n = instrumented.names().len();
    let scales = nalgebra::DVector::from_column_slice(instrumented.scales());
    let problem = instrumented.problem(Quantity::LeakRate).unwrap();
    let mut information = DMatrix::zeros(n, n);
    for of in problem.whole().outputs() {
        information.ger(1.0 / of.variance, &of.gradient, &of.gradient, 1.0);
    }
    let before = cylwatch_estimator::filter::steady_prediction(
        instrumented.transition(),
        &information,
        instrumented.process_noise(),
    )
    .unwrap();

    let conditions = Conditions::default();
    let mut cylinder = Cylinder::new(&vessel(), &sensors, &settings()).unwrap();
    cylinder.suppose(&member);
    let (n, m) = (cylinder.states(), cylinder.leading());
    let mut linear = Linearisation::zeros(n, m, cylinder.noises());
    // All states but the transmitter's constant offset are in the problem.
    let names = &cylinder.state_map().names;
    let kept: Vec<usize> =
        instrumented.names().iter().map(|name| names.iter().position(|of| of == name).unwrap()).collect();
    assert_eq!(kept.len() + 1, n, "{names:?}");
    let mut before_all = DMatrix::zeros(n, n);
    let mut point = vec![0.0; n];
    for (i, &state) in kept.iter().enumerate() {
        point[state] = instrumented.point()[i];
        for (j, &other) in kept.iter().enumerate() {
            before_all[(state, other)] = before[(i, j)] * scales[i] * scales[j];
        }
    }
    let mut p = UdFactors::from_covariance(&before_all).unwrap();
    let (mut h, mut gain) = (vec![0.0; n], vec![0.0; n]);
    for _ in 0..50 {
        for sensor in 0..sensors.len() {
            cylinder.set_interval_s(sensor, conditions.interval_s);
            cylinder.output(sensor, &point, Some(&mut h)).unwrap();
            let r = cylinder.noise_variance(sensor, &point);
            p.update(&h, r, &mut gain);
        }
        let mut x = point.clone();
        cylinder.propagate(&mut x, conditions.interval_s, Some(&mut linear)).unwrap();
        p.predict(&linear);
        let slow: Vec<(f64, f64)> =
            (m..n).map(|state| cylinder.slow_process(state).over(conditions.interval_s)).collect();
        let mut covariance = p.covariance();
        for (i, (factor, gained)) in slow.iter().enumerate() {
            covariance.row_mut(m + i).scale_mut(*factor);
            covariance.column_mut(m + i).scale_mut(*factor);
            covariance[(m + i, m + i)] += gained;
        }
        p = UdFactors::from_covariance(&covariance).unwrap();
    }
    let after = p.covariance();
    for &state in &kept {
        assert_relative_eq!(after[(state, state)], before_all[(state, state)], max_relative = 1e-5);
    }
}

#[test]
fn without_a_pressure_the_mass_is_not_seen_and_named() {
    let all = instrumented(&candidates(&NAMES), &member());
    let blind = layout(&["shoulder", "valve", "ambient"]);
    assert_eq!(all.problem(Quantity::Mass).unwrap().value(&blind), f64::INFINITY);
    assert_eq!(all.unseen(&blind), Some("mass_kg"));
    let error = all.problem(Quantity::LeakRate).unwrap_err();
    assert!(matches!(error, EstimatorError::PlacementQuantity { quantity: Quantity::LeakRate }), "{error}");
}

#[test]
fn a_sensor_more_and_a_finer_sensor_never_know_less() {
    let mut sensors = candidates(&NAMES);
    let problem = instrumented(&sensors, &member()).problem(Quantity::GasTemperature).unwrap();
    let value = |problem: &GroupedProblem, names: &[&str]| problem.value(&layout(names)).sqrt();
    let order = ["pressure", "shoulder", "valve", "middle", "bottom", "ambient"];
    let values: Vec<f64> = (1..=order.len()).map(|count| value(&problem, &order[..count])).collect();
    assert!(values.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-9)), "{values:?}");
    assert_eq!(values[0], f64::INFINITY, "a pressure alone does not tell the mass from the temperature");
    assert!((0.2..0.7).contains(&values[1]) && values[5] < 0.6 * values[1], "{values:?}");
    let before = value(&problem, &["pressure", "shoulder"]);
    sensors[index("shoulder")].noise_sd *= 10.0;
    let coarse = instrumented(&sensors, &member()).problem(Quantity::GasTemperature).unwrap();
    assert!(value(&coarse, &["pressure", "shoulder"]) > before);
    assert_relative_eq!(value(&coarse, &["pressure", "valve"]), value(&problem, &["pressure", "valve"]));
}

#[test]
fn searches_on_the_cylinder_agree_and_the_bound_holds() {
    let mut sensors: Vec<Sensor> =
        [0.1, 0.25, 0.4, 0.55].iter().map(|at| Sensor::typical_at_height(*at).unwrap()).collect();
    sensors.extend(candidates(&["shoulder", "valve", "pressure"]));
    let pressure = sensors.len() - 1;
    let problem = instrumented(&sensors, &member()).problem(Quantity::GasTemperature).unwrap();
    for count in 2..=4 {
        let constraints = Constraints { must: vec![pressure], ..Constraints::of(count) };
        let find = |method| -> SearchResult {
            search(&problem, &constraints, method, 0.02, &SearchControl::default()).unwrap()
        };
        let (all, bounded) = (find(Method::Exhaustive), find(Method::BranchAndBound));
        assert_eq!(all.layouts, bounded.layouts);
        let best = all.best().unwrap();
        let proven = certify(&problem, &constraints, &CertificateSettings::default()).unwrap();
        assert!(proven.bound() <= best.value * (1.0 + 1e-9), "{} above {}", proven.bound(), best.value);
        // Without the errors of what is hardly read growing as its noise does, the bound would be 0.2 K for any number.
        assert!(proven.bound() > 0.6 * best.value, "{count} sensors: {}", proven.bound() / best.value);
        println!(
            "{count} sensors: {:?} {:.4} K, not below {:.4} K",
            best.sensors.iter().map(|&one| &*sensors[one].name).collect::<Vec<_>>(),
            best.value.sqrt(),
            proven.bound().sqrt()
        );
    }
}

#[test]
fn the_relaxed_criterion_is_convex_and_its_gradient_is_that_of_differences() {
    // One of them lags: a state of its own that the wall drives.
    let mut sensors = candidates(&["shoulder", "valve", "middle", "bottom", "pressure"]);
    sensors[2].lag_s = 40.0;
    let problem = instrumented(&sensors, &member()).problem(Quantity::GasTemperature).unwrap();
    let value = |weights: &[f64]| problem.relaxed(weights).unwrap().value;
    let at = [0.3, 0.7, 0.5, 0.2, 1.0];
    let relaxed = problem.relaxed(&at).unwrap();
    for candidate in 0..4 {
        let moved = |by: f64| {
            let mut weights = at;
            weights[candidate] += by;
            value(&weights)
        };
        let step = 1e-3;
        let difference =
            (8.0 * (moved(step) - moved(-step)) - (moved(2.0 * step) - moved(-2.0 * step))) / (12.0 * step);
        assert_relative_eq!(relaxed.gradient[candidate], difference, max_relative = 1e-6);
    }
    for (one, other) in
        [([1.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0, 1.0]), ([0.1, 0.9, 0.3, 0.0, 1.0], at)]
    {
        let middle: Vec<f64> = one.iter().zip(&other).map(|(a, b)| 0.5 * (a + b)).collect();
        assert!(value(&middle) <= 0.5 * (value(&one) + value(&other)) * (1.0 + 1e-9));
    }
    // At 0 and 1 it is the value of the layout.
    assert_relative_eq!(value(&[1.0, 0.0, 1.0, 0.0, 1.0]), problem.value(&[0, 2, 4]), max_relative = 1e-5);
}

#[test]
fn candidates_alike_share_their_weight() {
    // Three heights on one cell of the mesh, one on another.
    let mut sensors: Vec<Sensor> =
        [0.3, 0.3001, 0.3002, 0.5].iter().map(|at| Sensor::typical_at_height(*at).unwrap()).collect();
    for (number, sensor) in sensors.iter_mut().enumerate() {
        sensor.name = format!("wall_{number}");
    }
    sensors.extend(candidates(&["pressure"]));
    let problem = instrumented(&sensors, &member()).problem(Quantity::GasTemperature).unwrap();
    let at = |weights: [f64; 5]| problem.relaxed(&weights).unwrap();
    let (spread, one) = (at([0.2, 0.3, 0.1, 0.4, 1.0]), at([0.6, 0.0, 0.0, 0.4, 1.0]));
    assert_relative_eq!(spread.value, one.value, max_relative = 1e-9);
    assert!(spread.gradient[0] == spread.gradient[2] && spread.gradient[0] != spread.gradient[3]);
    assert_relative_eq!(at([1.0, 0.0, 0.0, 0.0, 1.0]).value, problem.value(&[0, 4]), max_relative = 1e-5);
}
