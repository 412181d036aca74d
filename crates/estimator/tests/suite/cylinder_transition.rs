//! The observer's state space against the definitions: steps split in two, matrix exponentials, differences.
use cylwatch_estimator::filter::{Linearisation, StateSpace};
use cylwatch_estimator::observer::ObserverSettings;
use cylwatch_estimator::observer::cylinder::Cylinder;
use cylwatch_estimator::observer::states::StateKind;
use cylwatch_estimator::sensor::{ParameterKind, Sensor, read_sensors};
use cylwatch_estimator::thermal::reduced::{ReducedModel, Unknowns};
use cylwatch_estimator::thermal::sensor::{PressureReference, SensorKind};
use cylwatch_estimator::thermal::vessel::presets;
use nalgebra::{DMatrix, DVector};

use crate::linear_model::discretise;

/// One sensor of each kind; the pressure with an uncertain span, counted from the atmosphere.
fn sensors(lag_s: f64) -> Vec<Sensor> {
    let mut sensors: Vec<Sensor> = ["shoulder", "valve", "wall_middle", "gas_1", "ambient", "pressure"]
        .iter()
        .map(|name| Sensor::typical(name).unwrap())
        .collect();
    sensors[0].lag_s = lag_s;
    sensors[5].lag_s = 0.5 * lag_s;
    sensors[5].parameter_mut(ParameterKind::Span).unwrap().sd = 2e-3;
    let SensorKind::Pressure { full_scale_pa, .. } = sensors[5].kind else { panic!("a transmitter") };
    let reference = PressureReference::Gauge { atmosphere_pa: 95_000.0 };
    sensors[5].kind = SensorKind::Pressure { reference, full_scale_pa };
    let (_, suite) =
        read_sensors("[[sensor]]\nname = \"tip\"\nkind = \"immersion\"\ncell = 1", "tip.toml").unwrap();
    sensors.extend_from_slice(suite.sensors());
    sensors[6].lag_s = 2.0 * lag_s;
    sensors
}

fn cylinder(longest_step_s: f64, lag_s: f64) -> Cylinder {
    let settings = ObserverSettings { longest_step_s, wall_nodes: 3, ..ObserverSettings::default() };
    Cylinder::new(&presets::load("nitrogen-20l").unwrap(), &sensors(lag_s), &settings).unwrap()
}

/// A state, and how much each entry may typically differ. `hot`: the chamber has just become 46 K colder, the sun shines and gas
/// leaks; otherwise everything is at rest at the temperature that air and sun return to.
fn state(cylinder: &Cylinder, hot: bool) -> (Vec<f64>, Vec<f64>) {
    let rest_k = cylinder.settings().air_rest_k;
    let at = |hot_value: f64, rest: f64| if hot { hot_value } else { rest };
    let pressure_pa = 1.9e7;
    let of = |kind: &StateKind| match *kind {
        StateKind::Wall(node) => (at(285.0 + 1.5 * node as f64, rest_k), 1.0),
        StateKind::Valve => (at(279.0, rest_k), 1.0),
        StateKind::Gas => (at(291.0, rest_k), 1.0),
        StateKind::Mass => (4.46, 0.05),
        StateKind::Leak => (at(1e-5, 0.0), 1e-6),
        StateKind::Air => (at(248.0, rest_k), 1.0),
        StateKind::OutsideFilm => (at(0.2, 0.0), 0.2),
        StateKind::Sun => (at(3.0, 0.0), 2.0),
        StateKind::InsideFilm => (at(0.1, 0.0), 0.2),
        StateKind::Capacity => (at(0.05, 0.0), 0.1),
        StateKind::FilmSlope => (at(0.1, 0.0), 0.2),
        StateKind::ValveSun => (at(0.05, 0.0), 0.1),
        StateKind::Lag { sensor: 0 | 6 } => (at(284.0, rest_k), 1.0),
        StateKind::Lag { .. } => (pressure_pa, 1e5),
        StateKind::Parameter { sensor, parameter } => {
            match cylinder.sensors()[sensor].parameters()[parameter].kind {
                ParameterKind::Offset if sensor == 5 => (at(2e4, 0.0), 3e4),
                ParameterKind::Offset => (at(0.1, 0.0), 0.2),
                ParameterKind::Coupling => (0.1, 0.04),
                ParameterKind::TemperatureCoefficient => (at(1500.0, 0.0), 2500.0),
                ParameterKind::Span => (at(1e-3, 0.0), 2e-3),
            }
        }
    };
    cylinder.state_map().kinds.iter().map(of).unzip()
}

fn linearisation(cylinder: &Cylinder) -> Linearisation {
    Linearisation::zeros(cylinder.states(), cylinder.leading(), cylinder.noises())
}

/// Transition `F` over all states and noise covariance of the moving ones.
fn dense(linear: &Linearisation) -> (DMatrix<f64>, DMatrix<f64>) {
    let (m, n) = linear.phi.shape();
    let mut f = DMatrix::identity(n, n);
    f.rows_mut(0, m).copy_from(&linear.phi);
    let mut q = DMatrix::zeros(n, n);
    let noise = &linear.g * DMatrix::from_diagonal(&linear.q) * linear.g.transpose();
    q.view_mut((0, 0), (m, m)).copy_from(&noise);
    (f, q)
}

/// State, transition and noise after some steps.
fn steps(cylinder: &mut Cylinder, x: &[f64], intervals_s: &[f64]) -> (Vec<f64>, DMatrix<f64>, DMatrix<f64>) {
    let (n, mut linear) = (x.len(), linearisation(cylinder));
    let (mut x, mut f, mut q) = (x.to_vec(), DMatrix::identity(n, n), DMatrix::zeros(n, n));
    for &dt_s in intervals_s {
        cylinder.propagate(&mut x, dt_s, Some(&mut linear)).unwrap();
        let (step, noise) = dense(&linear);
        q = &step * q * step.transpose() + noise;
        f = step * f;
    }
    (x, f, q)
}

/// Largest difference of transitions, each element by what the column's typical difference does to the row's.
fn transition_difference(a: &DMatrix<f64>, b: &DMatrix<f64>, typical: &[f64]) -> f64 {
    (a - b).map_with_location(|i, j, d| (d * typical[j] / typical[i]).abs()).max()
}

/// Largest difference of noise covariances, each element by the two standard deviations.
fn noise_difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    let sd = b.diagonal().map(f64::sqrt);
    let of = |i: usize, j: usize, d: f64| if d == 0.0 { 0.0 } else { (d / (sd[i] * sd[j])).abs() };
    (a - b).map_with_location(of).max()
}

fn largest(a: &[f64], b: &[f64], typical: &[f64]) -> f64 {
    a.iter().zip(b).zip(typical).map(|((a, b), typical)| ((a - b) / typical).abs()).fold(0.0, f64::max)
}

#[test]
fn a_long_interval_is_its_parts_one_after_the_other() {
    // Two cylinders: the surface solver starts from its last solution.
    let (mut whole, mut parts) = (cylinder(20.0, 12.0), cylinder(20.0, 12.0));
    let (x, typical) = state(&whole, true);
    let (x_whole, f_whole, q_whole) = steps(&mut whole, &x, &[60.0]);
    let (x_parts, f_parts, q_parts) = steps(&mut parts, &x, &[20.0, 20.0, 20.0]);
    assert!(largest(&x_whole, &x_parts, &typical) < 1e-12);
    assert!(transition_difference(&f_whole, &f_parts, &typical) < 1e-12);
    assert!(noise_difference(&q_whole, &q_parts) < 1e-10);
}

/// Whether errors at halved steps fall by `2^order`, within a quarter of a power; for steps short enough that the next power of the
/// step no longer matters.
fn fall_with(errors: &[f64], order: f64) -> bool {
    errors.windows(2).all(|pair| ((pair[0] / pair[1]).log2() - order).abs() < 0.25)
}

#[test]
fn a_step_at_rest_is_two_half_steps() {
    // At rest the point of linearisation stays where it is: the transition is exact, the noise up to Simpson's rule.
    let (mut whole, mut halves) = (cylinder(1e3, 0.0), cylinder(1e3, 0.0));
    let (x, typical) = state(&whole, false);
    let noise = [20.0, 10.0, 5.0, 2.5].map(|h| {
        let (x_whole, f_whole, q_whole) = steps(&mut whole, &x, &[h]);
        let (x_halves, f_halves, q_halves) = steps(&mut halves, &x, &[0.5 * h, 0.5 * h]);
        assert_eq!((&x_whole, &x_halves), (&x, &x));
        assert!(transition_difference(&f_whole, &f_halves, &typical) < 1e-13);
        noise_difference(&q_whole, &q_halves)
    });
    println!("noise of 20, 10, 5, 2.5 s split in two: {noise:?}");
    assert!(noise[0] < 1e-5 && fall_with(&noise[1..], 4.0), "{noise:?}");
}

#[test]
fn a_step_with_lagging_sensors_is_two_half_steps() {
    // The time constant is about the step: the lags are the fastest of all. They have to be at rest with what they read.
    let (mut whole, mut halves) = (cylinder(1e3, 12.0), cylinder(1e3, 12.0));
    let (mut x, typical) = state(&whole, false);
    for lagged in 0..x.len() {
        if let StateKind::Lag { sensor } = whole.state_map().kinds[lagged] {
            x[lagged] = reading_at_rest(sensor, &x);
        }
    }
    for h in [40.0, 20.0, 5.0] {
        let (_, f_whole, q_whole) = steps(&mut whole, &x, &[h]);
        let (_, f_halves, q_halves) = steps(&mut halves, &x, &[0.5 * h, 0.5 * h]);
        let (f, q) =
            (transition_difference(&f_whole, &f_halves, &typical), noise_difference(&q_whole, &q_halves));
        println!("{h} s with lags split in two: transition {f:e}, noise {q:e}");
        assert!(f < 1e-12, "{h} s: {f:e}");
    }
}

/// Reading without lag of a sensor.
fn reading_at_rest(sensor: usize, x: &[f64]) -> f64 {
    // The same states without those of the lags.
    let mut prompt = cylinder(1e3, 0.0);
    let lagging = cylinder(1e3, 12.0);
    let kinds = &lagging.state_map().kinds;
    let without: Vec<f64> = x
        .iter()
        .zip(kinds)
        .filter(|(_, kind)| !matches!(kind, StateKind::Lag { .. }))
        .map(|(x, _)| *x)
        .collect();
    prompt.output(sensor, &without, None).unwrap()
}

/// `A` and `dx/dt` of a cylinder without lags, from the thermal model's own Jacobian.
fn continuous(cylinder: &mut Cylinder, x: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    let (map, n) = (cylinder.state_map().clone(), x.len());
    let settings = cylinder.settings().clone();
    let physical = map.mass + 1;
    let columns = [
        Some(map.air),
        map.outside,
        map.inside,
        map.capacity,
        map.sun,
        map.valve_sun,
        map.slope,
        Some(map.leak),
    ];
    let value = |state: Option<usize>| x[state.unwrap()];
    let unknowns = Unknowns {
        air_k: x[map.air],
        ln_outside_film: value(map.outside),
        ln_inside_film: value(map.inside),
        ln_capacity: value(map.capacity),
        sun_w: value(map.sun),
        valve_sun: ReducedModel::VALVE_SUN + value(map.valve_sun),
        film_slope: value(map.slope),
        outflow_kg_s: x[map.leak],
    };
    let mut rate = vec![0.0; physical];
    let mut jacobian = DMatrix::zeros(physical, physical + Unknowns::COUNT);
    cylinder.model().rates(&x[..physical], &unknowns, &mut rate, Some(&mut jacobian)).unwrap();
    let (mut a, mut f) = (DMatrix::zeros(n, n), DVector::zeros(n));
    a.view_mut((0, 0), (physical, physical)).copy_from(&jacobian.columns(0, physical));
    for (unknown, column) in columns.iter().enumerate() {
        a.view_mut((0, column.unwrap()), (physical, 1)).copy_from(&jacobian.column(physical + unknown));
    }
    f.rows_mut(0, physical).copy_from_slice(&rate);
    for (state, walk) in [(map.outside.unwrap(), settings.ln_outside_film), (map.sun.unwrap(), settings.sun)]
    {
        let decay = walk.memory_s.unwrap().recip();
        a[(state, state)] = -decay;
        f[state] = -decay * x[state];
    }
    (a, f)
}

/// Intensities of the noise, per s.
fn intensities(cylinder: &Cylinder, n: usize) -> DMatrix<f64> {
    let (map, s) = (cylinder.state_map(), cylinder.settings());
    let mut sd = DVector::zeros(n);
    sd.rows_mut(0, map.gas).fill(s.temperature_walk_k_per_sqrt_s);
    sd[map.gas] = s.gas_walk_k_per_sqrt_s;
    sd[map.mass] = s.bank[0].mass_walk_kg_per_sqrt_s;
    sd[map.leak] = s.bank[0].rate.per_sqrt_s;
    sd[map.air] = s.air.per_sqrt_s;
    sd[map.outside.unwrap()] = s.ln_outside_film.per_sqrt_s;
    sd[map.sun.unwrap()] = s.sun.per_sqrt_s;
    DMatrix::from_diagonal(&sd.map(|sd| sd * sd))
}

#[test]
fn a_step_is_the_exponential_of_the_linearised_equations() {
    let mut cylinder = cylinder(1e3, 0.0);
    let (x, typical) = state(&cylinder, true);
    let n = x.len();
    // The surface solver starts from its last solution: let it arrive.
    steps(&mut cylinder, &x, &[1.0]);
    let noise = [20.0, 10.0, 5.0, 2.5].map(|h| {
        let (moved, f, q) = steps(&mut cylinder, &x, &[h]);
        let (a, rate) = continuous(&mut cylinder, &x);
        // exp([A f; 0 0] h) = [Phi, h phi_1(hA) f; 0 1].
        let mut augmented = DMatrix::zeros(n + 1, n + 1);
        augmented.view_mut((0, 0), (n, n)).copy_from(&(&a * h));
        augmented.view_mut((0, n), (n, 1)).copy_from(&(rate * h));
        let exponential = augmented.exp();
        let expected: Vec<f64> = (0..n).map(|i| x[i] + exponential[(i, n)]).collect();
        let phi = exponential.view((0, 0), (n, n)).into_owned();
        let (mean, transition) =
            (largest(&moved, &expected, &typical), transition_difference(&f, &phi, &typical));
        assert!(mean < 1e-8 && transition < 1e-8, "{h} s: {mean:e} {transition:e}");
        noise_difference(&q, &discretise(&a, &intensities(&cylinder, n), h).1)
    });
    println!("noise of 20, 10, 5, 2.5 s by Simpson's rule: {noise:?}");
    assert!(noise[0] < 1e-3 && fall_with(&noise[1..], 4.0), "{noise:?}");
}

#[test]
fn two_steps_differ_from_one_by_the_cube_of_the_step() {
    let mut cylinder = cylinder(1e3, 0.0);
    let (x, typical) = state(&cylinder, true);
    let split = [20.0, 10.0, 5.0, 2.5, 1.25].map(|h| {
        let whole = steps(&mut cylinder, &x, &[h]).0;
        let halves = steps(&mut cylinder, &x, &[0.5 * h, 0.5 * h]).0;
        largest(&whole, &halves, &typical)
    });
    println!("state after 20, 10, 5, 2.5, 1.25 s split in two: {split:?}");
    // 20 s against twice 10 s, just after the air has fallen by 46 K.
    assert!(split[0] < 6e-3, "{split:?}");
    assert!(fall_with(&split[2..], 3.0), "{split:?}");
}

/// Derivatives of the state after a step, by central differences.
fn differences(cylinder: &mut Cylinder, x: &[f64], typical: &[f64], h: f64) -> DMatrix<f64> {
    let n = x.len();
    let mut f = DMatrix::zeros(n, n);
    for column in 0..n {
        let step = 0.02 * typical[column];
        let mut along = |sign: f64| {
            let mut moved = x.to_vec();
            moved[column] += sign * step;
            cylinder.propagate(&mut moved, h, None).unwrap();
            moved
        };
        let (ahead, behind) = (along(1.0), along(-1.0));
        for row in 0..n {
            f[(row, column)] = (ahead[row] - behind[row]) / (2.0 * step);
        }
    }
    f
}

#[test]
fn the_transition_is_the_derivative_of_a_step_up_to_its_square() {
    // exp(hA) leaves out how A itself changes along the step.
    for lag_s in [0.0, 12.0] {
        let mut cylinder = cylinder(1e3, lag_s);
        let (x, typical) = state(&cylinder, true);
        let errors = [20.0, 2.5, 1.25, 0.625, 0.2].map(|h| {
            let f = steps(&mut cylinder, &x, &[h]).1;
            transition_difference(&f, &differences(&mut cylinder, &x, &typical, h), &typical)
        });
        println!("transition against differences at 20, 2.5, 1.25, 0.625, 0.2 s, lag {lag_s} s: {errors:?}");
        assert!(errors[0] < 0.05 && errors[4] < 2e-5, "{errors:?}");
        assert!(fall_with(&errors[1..4], 2.0), "{errors:?}");
    }
}

#[test]
fn gradients_of_all_outputs_are_their_derivatives() {
    for (hot, lag_s) in [(true, 0.0), (false, 0.0), (true, 12.0)] {
        let mut cylinder = cylinder(20.0, lag_s);
        let (x, typical) = state(&cylinder, hot);
        let mut h = vec![0.0; x.len()];
        for output in 0..cylinder.outputs() {
            cylinder.output(output, &x, Some(&mut h)).unwrap();
            let unit = if output == 5 { 1e5 } else { 1.0 };
            for column in 0..x.len() {
                let step = 1e-2 * typical[column];
                let mut at = |sign: f64| {
                    let mut moved = x.clone();
                    moved[column] += sign * step;
                    cylinder.output(output, &moved, None).unwrap()
                };
                let expected = (at(1.0) - at(-1.0)) / (2.0 * step);
                let difference = ((h[column] - expected) * typical[column] / unit).abs();
                let name = &cylinder.state_map().names[column];
                assert!(difference < 1e-6, "output {output} by {name}: {} against {expected}", h[column]);
            }
        }
    }
}
