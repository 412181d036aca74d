//! Whole truths: what the simulation makes of a course.
use cylwatch_thermal::units::ZERO_CELSIUS_K;
use cylwatch_thermal::vessel::presets;

use super::super::{Course, Truth, TruthLeak, TruthSettings, generate, generate_with, simulate_truth};
use super::mean;

/// Coarse in space: what is claimed here does not depend on the mesh.
fn coarse() -> TruthSettings {
    TruthSettings { cylinder_cells: 3, gas_cells: 4, relative_tolerance: 1e-5, ..TruthSettings::default() }
}

fn bodies(truth: &Truth) -> [&Vec<f64>; 6] {
    [
        &truth.gas_mean_k,
        &truth.wall_mean_k,
        &truth.shoulder_k,
        &truth.valve_k,
        &truth.middle_k,
        &truth.bottom_k,
    ]
}

#[test]
fn a_seed_gives_one_truth_and_another_seed_another() {
    let of = |seed| generate_with(&Course::Scenario1, seed, 60.0, &coarse()).unwrap();
    let (first, again, other) = (of(1), of(1), of(2));
    assert_eq!(first.log.values, again.log.values);
    assert_eq!(bodies(&first), bodies(&again));
    let differ = first.log.values.iter().zip(&other.log.values).filter(|(a, b)| a != b).count();
    assert_eq!(differ, first.log.values.len(), "every reading differs");
}

#[test]
fn chamber_courses_start_settled_and_reach_their_temperatures() {
    // Start and end in °C, and how far the bodies may still lag at the end, K: nothing but turbulence after steps of nine
    // and more time constants; 20 min behind ramps of 10 and -2.3 K/h.
    let courses = [
        (Course::Scenario1, 21.0, -25.0, (-0.2, 2.0)),
        (Course::Scenario2, -25.0, 40.0, (-2.0, 0.2)),
        (Course::Scenario3, 10.0, 60.0, (-10.0, -2.0)),
        (Course::Scenario4, 60.0, 28.0, (0.3, 2.0)),
        (Course::Tunnel, -10.0, 35.0, (-2.0, 0.2)),
    ];
    for (course, start, end, (least, most)) in courses {
        let truth = generate_with(&course, 8, 120.0, &coarse()).unwrap();
        let change = truth.time_s.iter().position(|&t_s| t_s >= course.change_s()).unwrap();
        for body in bodies(&truth) {
            // An outer surface differs from its wall by the film of the turbulent air alone.
            assert!(
                (body[0] - start - ZERO_CELSIUS_K).abs() < 2e-3,
                "{}: {} K at first",
                course.name(),
                body[0]
            );
            // An hour of turbulence of 0.4 K and 2 min hardly moves a body of half an hour.
            let rest = body[..change].iter().map(|k| (k - start - ZERO_CELSIUS_K).abs()).fold(0.0, f64::max);
            assert!(rest < 0.6, "{}: {rest} K before the change", course.name());
            let lag = body[body.len() - 1] - end - ZERO_CELSIUS_K;
            assert!(lag > least - 0.5 && lag < most + 0.5, "{}: {lag} K from the end", course.name());
        }
        assert_eq!(*truth.time_s.last().unwrap(), course.duration_s());
    }
}

#[test]
fn a_full_cylinder_has_the_mass_of_its_fill_and_the_pressure_of_its_temperature() {
    let truth = generate_with(&Course::Scenario1, 8, 600.0, &coarse()).unwrap();
    let nominal = presets::load("nitrogen-20l").unwrap();
    // Filled to 200 bar and settled at 15 °C, in the volume that this cylinder then has.
    let rho = nominal.fluid.density_from_pressure_temperature(200e5, 288.15).unwrap();
    let drawn = truth.parameters.apply(&nominal);
    let mass_kg = rho * drawn.volume.volume_m3(288.15, 200e5);
    approx::assert_relative_eq!(truth.mass_kg[0], mass_kg, max_relative = 1e-9);
    // Settled at 21 °C, six kelvin warmer: 6 K of 0.99 bar/K.
    let rise_bar = truth.pressure_pa[0] / 1e5 - 200.0;
    assert!((5.5..6.2).contains(&rise_bar), "{rise_bar} bar above the fill");
}

#[test]
fn a_tight_cylinder_keeps_its_mass_and_a_leaking_one_loses_rate_times_time() {
    let leak = TruthLeak { rate_kg_s: 50e-3 / 3600.0, start_s: 4321.0 };
    let of = |leak| {
        let settings = TruthSettings { leak, relative_tolerance: 1e-8, ..coarse() };
        generate_with(&Course::Scenario1, 4, 60.0, &settings).unwrap()
    };
    let (tight, leaking) = (of(None), of(Some(leak)));
    assert!(tight.mass_kg.iter().all(|&mass| (mass / tight.mass_kg[0] - 1.0).abs() < 1e-12));
    for (&t_s, &mass_kg) in leaking.time_s.iter().zip(&leaking.mass_kg) {
        let lost = leak.rate_kg_s * (t_s - leak.start_s).max(0.0);
        assert!((tight.mass_kg[0] - mass_kg - lost).abs() < 1e-9, "{mass_kg} kg at {t_s} s");
    }
    // Both cylinders are the same until then; afterwards the gas expands and cools.
    let after = |truth: &Truth| mean(&truth.gas_mean_k[truth.gas_mean_k.len() / 2..]);
    let before = leaking.time_s.iter().position(|&t_s| t_s > leak.start_s).unwrap();
    for k in 0..before {
        assert!((tight.gas_mean_k[k] - leaking.gas_mean_k[k]).abs() < 1e-5);
    }
    assert!(after(&leaking) < after(&tight) && leaking.pressure_pa.last() < tight.pressure_pa.last());
}

#[test]
fn the_stratified_truth_is_warmer_above_and_its_mean_is_weighted_by_mass() {
    let (_, run) = simulate_truth(&Course::Scenario1, 8, 600.0, &TruthSettings::default()).unwrap();
    assert!(run.gas_cells_k.iter().all(|cells| cells.len() == 10));
    // While the wall cools the gas, cold gas sinks along it.
    let change = run.time_s.iter().position(|&t_s| t_s > Course::Scenario1.change_s() + 600.0).unwrap();
    let cells = &run.gas_cells_k[change];
    assert!(cells.windows(2).all(|pair| pair[1] > pair[0]), "{cells:?}");
    let (bottom, top) = (cells[0], cells[cells.len() - 1]);
    assert!((bottom..top).contains(&run.gas_mean_k[change]));
    // One pressure everywhere: the colder half is the denser one, so the mean by mass is below that by volume.
    assert!(run.gas_mean_k[change] < mean(cells));
}

#[test]
fn a_learning_observer_gets_a_sample_a_minute_and_the_course_after_it_all() {
    let course = Course::Learnt { days: 0.25, then: Box::new(Course::Tunnel) };
    let truth = generate_with(&course, 2, 20.0, &coarse()).unwrap();
    let opening = truth.time_s.iter().position(|&t_s| t_s >= course.opening_s()).unwrap();
    assert_eq!(course.opening_s(), 0.25 * 86_400.0 + 5.0 * 3600.0);
    assert!(truth.time_s[..opening].windows(2).all(|pair| pair[1] - pair[0] == 60.0));
    assert!(truth.time_s[opening..].windows(2).all(|pair| (pair[1] - pair[0] - 20.0).abs() < 1e-9));
    // Four hours of rest after the railway: settled at the tunnel's start.
    let from_start = truth.gas_mean_k[opening] - 263.15;
    assert!(from_start.abs() < 0.6, "{from_start} K from -10 °C");
}

#[test]
fn default_settings_are_those_of_the_plain_generator() {
    let course = Course::Tunnel;
    let plain = generate(&course, 5, 1200.0).unwrap();
    let with = generate_with(&course, 5, 1200.0, &TruthSettings::default()).unwrap();
    assert_eq!(plain.log.values, with.log.values);
    assert_eq!(plain.log.channels.len(), 5);
}
