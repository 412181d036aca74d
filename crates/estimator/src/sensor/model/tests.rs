//! Readings by hand, derivatives by differences.
use approx::assert_relative_eq;
use cylwatch_thermal::sensor::SensorSpec;
use cylwatch_thermal::units::ATMOSPHERE_PA;
use proptest::prelude::*;

use super::*;

fn sensor(change: impl FnOnce(&mut SensorSpec)) -> Sensor {
    let mut spec = SensorSpec { name: "shoulder".into(), ..SensorSpec::default() };
    change(&mut spec);
    Sensor::try_from(&spec).unwrap()
}

fn pressure(change: impl FnOnce(&mut SensorSpec)) -> Sensor {
    sensor(|spec| {
        spec.name = "pressure".into();
        change(spec);
    })
}

/// One of every kind, a gauge transmitter among them.
fn every_kind() -> [Sensor; 7] {
    let named = |name: &str| sensor(|spec| spec.name = name.into());
    let gauge = pressure(|spec| {
        spec.gauge = Some(true);
        spec.altitude_m = Some(1500.0);
    });
    let immersion = sensor(|spec| {
        spec.kind = Some(crate::sensor::KindChoice::Immersion);
        spec.cell = Some(1);
    });
    [named("shoulder"), named("valve"), named("gas_2"), named("ambient"), named("pressure"), gauge, immersion]
}

#[test]
fn a_surface_sensor_reads_between_surface_and_air() {
    let exposure = Exposure { body_k: 250.0, air_k: 290.0, ..Exposure::default() };
    // A tenth of the 40 K to the air, and 0.2 K too much.
    let found = sensor(|_| ()).predict(&exposure, &[0.2, 0.1]);
    assert_relative_eq!(found.value, 254.2, max_relative = 1e-14);
}

#[test]
fn gas_and_air_sensors_read_what_they_are_in() {
    let exposure = Exposure { body_k: 250.0, air_k: 290.0, ..Exposure::default() };
    let [_, _, gas, ambient, ..] = every_kind();
    assert_eq!(gas.predict(&exposure, &[-0.5]).value, 249.5);
    assert_eq!(ambient.predict(&exposure, &[0.25]).value, 290.25);
}

#[test]
fn an_immersion_sensor_reads_between_gas_and_valve() {
    let exposure = Exposure { body_k: 290.0, electronics_k: 250.0, air_k: 200.0, ..Exposure::default() };
    // A tenth of the 40 K to the valve, and 0.2 K too much.
    let [.., immersion] = every_kind();
    assert_relative_eq!(immersion.predict(&exposure, &[0.2, 0.1]).value, 286.2, max_relative = 1e-14);
}

#[test]
fn a_transmitter_adds_offset_span_and_temperature_error() {
    let exposure = Exposure { pressure_pa: 180e5, electronics_k: 313.15, ..Exposure::default() };
    // 180 bar, 0.1 % more, 0.2 bar more, and 0.02 bar/K at 40 degC, 25 K above 15 degC: 180.88 bar.
    let found = pressure(|_| ()).predict(&exposure, &[0.2e5, 0.02e5, 1e-3]);
    assert_relative_eq!(found.value, 180.88e5, max_relative = 1e-14);
}

#[test]
fn a_gauge_at_the_sea_records_the_absolute_pressure_and_in_the_mountains_too_much() {
    let at = |altitude_m| {
        pressure(|spec| {
            spec.gauge = Some(true);
            spec.altitude_m = altitude_m;
        })
    };
    let exposure = Exposure { pressure_pa: 150e5, electronics_k: 288.15, ..Exposure::default() };
    let read = |sensor: Sensor| sensor.predict(&exposure, &[0.0; 3]).value;
    assert_relative_eq!(read(at(None)), 150e5, max_relative = 1e-14);
    // The standard atmosphere has 795.0 hPa at 2000 m, 218.3 hPa less than at the sea (ISO 2533).
    assert_relative_eq!(read(at(Some(2000.0))) - 150e5, 21_829.8, epsilon = 0.1);
}

#[test]
fn the_noise_of_a_reading_is_white_and_correlated_noise_and_a_twelfth_of_the_squared_step() {
    let coarse = sensor(|spec| spec.resolution_k = Some(0.6));
    assert_relative_eq!(coarse.noise_variance(), 0.03, max_relative = 1e-14);
    let all = sensor(|spec| {
        spec.resolution_k = Some(0.6);
        spec.noise_k = Some(0.3);
        (spec.correlated_noise_k, spec.correlation_time_s) = (Some(0.4), Some(60.0));
    });
    assert_relative_eq!(all.noise_variance(), 0.28, max_relative = 1e-14);
}

#[test]
fn a_transmitter_cannot_read_beyond_the_current_of_its_loop() {
    // 3.8 and 20.5 mA of a loop of 4 to 20 mA for 0 to 250 bar.
    let full_scale = |gauge| pressure(|spec| (spec.full_scale_pa, spec.gauge) = (Some(250e5), Some(gauge)));
    let (low, high) = full_scale(false).plausible();
    assert_relative_eq!(low, -3.125e5, max_relative = 1e-14);
    assert_relative_eq!(high, 257.8125e5, max_relative = 1e-14);
    let (low, high) = full_scale(true).plausible();
    assert_relative_eq!(low, -3.125e5 + 101_325.0, max_relative = 1e-14);
    assert_relative_eq!(high, 257.8125e5 + 101_325.0, max_relative = 1e-14);
}

#[test]
fn a_reading_at_the_full_scale_says_only_that_the_pressure_is_as_high() {
    let usable = |gauge| {
        let of = pressure(|spec| (spec.full_scale_pa, spec.gauge) = (Some(250e5), Some(gauge)));
        move |reading_pa: f64| {
            let (low, high) = of.usable_range();
            (low..=high).contains(&reading_pa)
        }
    };
    let (absolute, gauge) = (usable(false), usable(true));
    assert!(absolute(249.9e5) && !absolute(250e5) && !absolute(257e5));
    assert!(gauge(250.9e5) && !gauge(250e5 + ATMOSPHERE_PA));
}

#[test]
fn quantities_and_parameters_are_those_of_the_kind() {
    use ParameterKind::{Coupling, Offset, Span, TemperatureCoefficient};
    let kinds = |sensor: &Sensor| sensor.parameters().iter().map(|p| p.kind).collect::<Vec<_>>();
    let [shoulder, valve, gas, ambient, absolute, gauge, immersion] = every_kind();
    for coupled in [shoulder, valve, immersion] {
        assert_eq!((coupled.quantity(), kinds(&coupled)), (Quantity::Temperature, vec![Offset, Coupling]));
    }
    for single in [gas, ambient] {
        assert_eq!((single.quantity(), kinds(&single)), (Quantity::Temperature, vec![Offset]));
    }
    for transmitter in [absolute, gauge] {
        let expected = vec![Offset, TemperatureCoefficient, Span];
        assert_eq!((transmitter.quantity(), kinds(&transmitter)), (Quantity::Pressure, expected));
    }
}

#[test]
fn a_tolerance_of_a_class_is_a_uniform_prior() {
    let class_b = sensor(|spec| spec.class = Some(crate::sensor::Pt100Class::B));
    // 0.3 + 0.005 x 20 = 0.4 K; a uniform distribution has its limits at sqrt(3) standard deviations.
    assert_relative_eq!(class_b.parameters()[0].sd, 0.4 / 1.732_050_807_568_877, max_relative = 1e-14);
    assert_eq!(class_b.parameters()[0].law, crate::sensor::Law::Uniform);
}

#[test]
fn a_walk_over_a_time_is_a_walk_per_root_second() {
    let walking = sensor(|spec| (spec.walk_sd_k, spec.walk_time_s) = (Some(0.05), Some(10_000.0)));
    assert_relative_eq!(walking.parameters()[0].walk_per_sqrt_s, 5e-4, max_relative = 1e-14);
    assert_eq!(walking.parameters()[1].walk_per_sqrt_s, 0.0);
}

/// Central difference of the reading by one of its arguments. Readings are linear in each argument, so a wide step
/// costs nothing and keeps rounding small.
fn difference(read: impl Fn(f64) -> f64, at: f64, step: f64) -> f64 {
    (read(at + step) - read(at - step)) / (2.0 * step)
}

proptest! {
    #[test]
    fn derivatives_are_central_differences(
        body_k in 200.0..350.0_f64,
        air_k in 200.0..350.0_f64,
        pressure_pa in 1e5..3e7_f64,
        electronics_k in 200.0..350.0_f64,
        unit in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        for sensor in every_kind() {
            let exposure = Exposure { body_k, air_k, pressure_pa, electronics_k };
            let is_pressure = sensor.quantity() == Quantity::Pressure;
            let scale = if is_pressure { [1e5, 5e3, 1e-2] } else { [1.0, 0.5, 0.0] };
            let parameters = [0, 1, 2].map(|j| scale[j] * unit[j]);
            let found = sensor.predict(&exposure, &parameters);
            let read = |exposure: Exposure| sensor.predict(&exposure, &parameters).value;
            let close = |derivative: f64, difference: f64| {
                (derivative - difference).abs() <= 1e-7 * (1.0 + derivative.abs())
            };
            let d = difference(|x| read(Exposure { body_k: x, ..exposure }), body_k, 10.0);
            prop_assert!(close(found.per_body, d), "{} body: {} {d}", sensor.name, found.per_body);
            let d = difference(|x| read(Exposure { air_k: x, ..exposure }), air_k, 10.0);
            prop_assert!(close(found.per_air, d), "{} air: {} {d}", sensor.name, found.per_air);
            let d = difference(|x| read(Exposure { pressure_pa: x, ..exposure }), pressure_pa, 1e5);
            prop_assert!(close(found.per_pressure, d), "{} pressure: {} {d}", sensor.name, found.per_pressure);
            let d = difference(|x| read(Exposure { electronics_k: x, ..exposure }), electronics_k, 10.0);
            prop_assert!(close(found.per_electronics, d), "{} el.: {} {d}", sensor.name, found.per_electronics);
            for j in 0..sensor.parameters().len() {
                let with = |x: f64| {
                    let mut changed = parameters;
                    changed[j] = x;
                    sensor.predict(&exposure, &changed).value
                };
                let d = difference(with, parameters[j], 0.1);
                prop_assert!(close(found.per_parameter[j], d), "{} {j}: {d}", sensor.name);
            }
            let beyond = &found.per_parameter[sensor.parameters().len()..];
            prop_assert!(beyond.iter().all(|&derivative| derivative == 0.0));
        }
    }
}
