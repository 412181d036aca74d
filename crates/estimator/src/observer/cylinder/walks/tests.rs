use super::*;
use crate::filter::Plant;
use crate::observer::ObserverSettings;
use crate::sensor::Sensor;
use crate::thermal::sensor::SensorSpec;
use crate::thermal::vessel::presets;
use approx::assert_relative_eq;
use cylwatch_thermal::units::DAY_S;

fn cylinder(transmitter: &SensorSpec, settings: &ObserverSettings) -> Cylinder {
    let sensors = [Sensor::typical("shoulder").unwrap(), Sensor::try_from(transmitter).unwrap()];
    Cylinder::new(&presets::load("nitrogen-20l").unwrap(), &sensors, settings).unwrap()
}

fn transmitter() -> SensorSpec {
    SensorSpec {
        name: "pressure".into(),
        noise_pa: Some(1e3),
        offset_sd_pa: Some(4e4),
        temperature_coefficient_sd_pa_k: Some(2500.0),
        full_scale_pa: Some(250e5),
        ..SensorSpec::default()
    }
}

/// Bounds of the state of a name; infinite where it has none.
fn bounds(cylinder: &Cylinder, name: &str) -> (f64, f64) {
    let state = cylinder.state_map().names.iter().position(|own| own == name).unwrap();
    let of = cylinder.bounds().iter().find(|(bounded, ..)| *bounded == state);
    of.map_or((f64::NEG_INFINITY, f64::INFINITY), |&(_, low, high)| (low, high))
}

#[test]
fn a_constant_stays_within_four_standard_deviations_of_its_prior() {
    let cylinder = cylinder(&transmitter(), &ObserverSettings::default());
    assert_eq!(bounds(&cylinder, "pressure.offset_pa"), (-1.6e5, 1.6e5));
    assert_eq!(bounds(&cylinder, "pressure.temperature_coefficient_pa_k"), (-10_000.0, 10_000.0));
    // A coupling of 0.1 +- 0.04 cannot be negative.
    let (low, high) = bounds(&cylinder, "shoulder.coupling");
    assert_eq!(low, 0.0);
    assert_relative_eq!(high, 0.26, max_relative = 1e-12);
}

#[test]
fn a_transmitter_that_drifts_by_itself_is_not_held_at_its_prior() {
    for offset_sd_pa in [4e4, 0.0] {
        let drifting = SensorSpec {
            offset_sd_pa: Some(offset_sd_pa),
            walk_sd_pa: Some(2e5),
            walk_time_s: Some(100.0 * DAY_S),
            ..transmitter()
        };
        let cylinder = cylinder(&drifting, &ObserverSettings::default());
        let unbounded = (f64::NEG_INFINITY, f64::INFINITY);
        assert_eq!(bounds(&cylinder, "pressure.offset_pa"), unbounded, "sd {offset_sd_pa} Pa");
        assert_eq!(bounds(&cylinder, "pressure.temperature_coefficient_pa_k"), (-10_000.0, 10_000.0));
    }
}

#[test]
fn a_capacity_is_held_at_its_prior_unless_its_walk_leads_away() {
    let of = |ln_capacity: Walk| {
        let settings = ObserverSettings { ln_capacity, ..ObserverSettings::default() };
        bounds(&cylinder(&transmitter(), &settings), "ln_capacity")
    };
    assert_eq!(of(Walk::constant(0.1)), (-0.4, 0.4));
    assert_eq!(of(Walk::forgetting(0.1, DAY_S)), (-0.4, 0.4));
    let unbounded = (f64::NEG_INFINITY, f64::INFINITY);
    assert_eq!(of(Walk::per_sqrt_hour(0.1, 0.01)), unbounded);
    assert_eq!(of(Walk { prior_sd: 0.05, ..Walk::forgetting(0.1, DAY_S) }), unbounded);
}

fn process(walk: &Walk) -> SlowProcess {
    SlowProcess { intensity: walk.per_sqrt_s.powi(2), decay_per_s: walk.decay_per_s(), rest: 0.0 }
}

#[test]
fn what_forgets_is_as_uncertain_after_any_time_as_its_prior() {
    let process = process(&Walk::forgetting(0.25, 120.0 * DAY_S));
    for dt_s in [1.0, 3600.0, 30.0 * DAY_S, 5000.0 * DAY_S] {
        let (factor, gained) = process.over(dt_s);
        assert_relative_eq!(factor * factor * 0.0625 + gained, 0.0625, max_relative = 1e-9);
    }
    // After one memory a 1/e of the departure is left.
    assert_relative_eq!(process.over(120.0 * DAY_S).0, 0.367_879_441, max_relative = 1e-9);
}

#[test]
fn two_intervals_of_a_slow_process_are_one_of_their_sum() {
    let memory = Walk { prior_sd: 0.1, per_sqrt_s: 2e-4, memory_s: Some(5.0 * DAY_S) };
    for walk in [memory, Walk::per_sqrt_hour(0.1, 0.02)] {
        let process = process(&walk);
        for (a_s, b_s) in [(3600.0, 3600.0), (60.0, 20.0 * DAY_S), (2.0 * DAY_S, 900.0)] {
            let ((fa, va), (fb, vb)) = (process.over(a_s), process.over(b_s));
            let (factor, gained) = process.over(a_s + b_s);
            assert_relative_eq!(factor, fa * fb, max_relative = 1e-12);
            assert_relative_eq!(gained, fb * fb * va + vb, max_relative = 1e-10);
        }
    }
}

#[test]
fn a_random_walk_gains_variance_in_proportion_to_time_and_forgets_nothing() {
    // 0.02 in the square root of an hour is 0.1 after 25 hours.
    let (factor, gained) = process(&Walk::per_sqrt_hour(0.0, 0.02)).over(25.0 * 3600.0);
    assert_eq!(factor, 1.0);
    assert_relative_eq!(gained, 0.01, max_relative = 1e-12);
}
