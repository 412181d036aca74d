//! Units of a co-simulation.
#![allow(clippy::unwrap_used)]
use cylwatch_cosimulation::description::{About, Version, describe};
use cylwatch_cosimulation::variable::Causality;
use cylwatch_cosimulation::{Access, CompiledPlant, CosimulationError, FilmInputs, Instance, Resource};
use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::monitor::MonitorSettings;
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::sensor::Sensor;
use cylwatch_thermal::vessel::{Fill, presets};

const FILL: Fill = Fill::Settled { pressure_pa: 200e5, temperature_k: 288.15 };

fn sensors() -> Vec<Sensor> {
    let mut sensors = ["shoulder", "pressure"].map(|name| Sensor::typical(name).unwrap());
    sensors[0].lag_s = 90.0;
    sensors.to_vec()
}

fn plant_of(fill: Fill, film: FilmInputs) -> Resource {
    let vessel = presets::load("nitrogen-20l").unwrap();
    Resource::Plant(Box::new(CompiledPlant { vessel, sensors: sensors(), fill, film }))
}

fn plant() -> Resource {
    plant_of(FILL, FilmInputs::Wind)
}

fn monitor() -> Resource {
    let cylinder = CompiledCylinder {
        vessel: presets::load("nitrogen-20l").unwrap(),
        sensors: sensors(),
        commissioning: Commissioning::filled(200e5, 288.15),
        settings: MonitorSettings::default(),
        learned: None,
    };
    Resource::Monitor(Box::new(cylinder))
}

fn unit(resource: &Resource) -> Instance {
    Instance::new(&resource.to_bytes().unwrap()).unwrap()
}

fn begun(resource: &Resource) -> Instance {
    let mut unit = unit(resource);
    unit.enter_initialization().unwrap();
    unit.exit_initialization().unwrap();
    unit
}

fn place(unit: &Instance, name: &str) -> u32 {
    u32::try_from(unit.variables().iter().position(|of| of.name == name).unwrap()).unwrap()
}

fn set(unit: &mut Instance, name: &str, value: f64) -> Result<(), CosimulationError> {
    unit.set(place(unit, name), Access::Real, value)
}

fn get(unit: &mut Instance, name: &str) -> f64 {
    unit.get(place(unit, name), Access::Real).unwrap()
}

/// Bits of all outputs.
fn said(unit: &mut Instance) -> Vec<u64> {
    let outputs: Vec<u32> = (0..unit.variables().len())
        .filter(|&place| unit.variables()[place].causality == Causality::Output)
        .map(|place| u32::try_from(place).unwrap())
        .collect();
    let mut value = |place| {
        let any = [Access::Real, Access::IntegerOrEnumeration];
        any.into_iter().find_map(|access| unit.get(place, access).ok()).unwrap().to_bits()
    };
    outputs.into_iter().map(&mut value).collect()
}

fn advance(unit: &mut Instance, step: usize) -> Vec<u64> {
    let phase = step as f64;
    let inputs = if unit.variables().iter().any(|of| of.name == "air_k") {
        [("air_k", 280.0 + phase.sin()), ("leak_kg_s", 1e-5)]
    } else {
        [("shoulder_k", 288.15 + 0.1 * phase.sin()), ("pressure_pa", 200e5 - 1e3 * phase)]
    };
    inputs.iter().for_each(|&(name, value)| set(unit, name, value).unwrap());
    unit.step(60.0 * phase, 60.0).unwrap();
    said(unit)
}

#[test]
fn a_state_goes_on_with_the_same_bits_in_any_instance_of_the_unit() {
    for resource in [plant(), monitor()] {
        let mut one = begun(&resource);
        (0..4).for_each(|step| drop(advance(&mut one, step)));
        let state = one.save().unwrap();
        let first: Vec<_> = (4..9).map(|step| advance(&mut one, step)).collect();
        assert_ne!(first[0], first[4]);
        one.restore(&state).unwrap();
        let again: Vec<_> = (4..9).map(|step| advance(&mut one, step)).collect();
        assert_eq!(first, again);
        // One that has not even begun.
        let mut other = unit(&resource);
        other.restore(&state).unwrap();
        assert_eq!(other.save().unwrap(), state);
        let there: Vec<_> = (4..9).map(|step| advance(&mut other, step)).collect();
        assert_eq!(first, there);
    }
}

#[test]
fn what_is_damaged_or_of_another_unit_is_refused_and_changes_nothing() {
    let (mut plant, mut monitor) = (begun(&plant()), begun(&monitor()));
    advance(&mut plant, 0);
    advance(&mut monitor, 0);
    let (of_plant, of_monitor) = (plant.save().unwrap(), monitor.save().unwrap());
    assert!(plant.restore(&of_monitor).is_err() && monitor.restore(&of_plant).is_err());
    let another =
        begun(&plant_of(Fill::Settled { pressure_pa: 150e5, temperature_k: 288.15 }, FilmInputs::Wind));
    assert!(plant.restore(&another.save().unwrap()).is_err());
    for at in (0..of_plant.len()).step_by(7) {
        let mut changed = of_plant.clone();
        changed[at] ^= 0x10;
        assert!(plant.check(&changed).is_err() && plant.restore(&changed).is_err(), "byte {at}");
        assert!(plant.restore(&of_plant[..at]).is_err(), "{at} bytes");
    }
    assert_eq!((plant.save().unwrap(), monitor.save().unwrap()), (of_plant, of_monitor));
    for resource in [self::plant(), self::monitor()] {
        let whole = resource.to_bytes().unwrap();
        for at in (0..whole.len()).step_by(11) {
            let mut changed = whole.clone();
            changed[at] ^= 0x10;
            assert!(Instance::new(&changed).is_err(), "byte {at}");
        }
    }
}

#[test]
fn each_fill_and_film_has_its_variables_and_a_fill_of_its_mass_is_the_same_fill() {
    let names = |resource: &Resource| {
        let unit = unit(resource);
        let settable = |of: &&cylwatch_cosimulation::variable::Variable| of.start.is_some();
        unit.variables().iter().filter(settable).map(|of| of.name.clone()).collect::<Vec<_>>().join(" ")
    };
    let flows = "irradiance_w_m2 leak_kg_s leak_bore_m refill_kg_s refill_source_k refill_source_pa";
    let settled = "fill_pressure_pa fill_temperature_k start_temperature_k relative_tolerance air_k";
    assert_eq!(names(&plant()), format!("{settled} wind_m_s radiation_difference_k {flows}"));
    let coefficient = plant_of(FILL, FilmInputs::Coefficient);
    assert_eq!(names(&coefficient), format!("{settled} film_w_m2_k {flows}"));
    assert_eq!(names(&monitor()), "shoulder_k pressure_pa");
    let mut by_pressure = begun(&plant());
    let mass_kg = get(&mut by_pressure, "mass_kg");
    let mut by_mass = begun(&plant_of(Fill::Mass { mass_kg }, FilmInputs::Wind));
    assert_eq!(said(&mut by_pressure), said(&mut by_mass));
    let pressure_pa = get(&mut by_mass, "pressure_pa");
    let mut by_start = begun(&plant_of(Fill::Pressure { pressure_pa }, FilmInputs::Wind));
    assert!((get(&mut by_start, "mass_kg") / mass_kg - 1.0).abs() < 1e-9);
}

#[test]
fn a_refill_warms_the_gas_and_brings_its_mass() {
    let mut plant =
        begun(&plant_of(Fill::Settled { pressure_pa: 50e5, temperature_k: 288.15 }, FilmInputs::Wind));
    let (before_kg, before_k) = (get(&mut plant, "mass_kg"), get(&mut plant, "gas_mean_k"));
    set(&mut plant, "refill_kg_s", 5e-3).unwrap();
    plant.step(0.0, 200.0).unwrap();
    assert!((get(&mut plant, "mass_kg") - before_kg - 1.0).abs() < 1e-6);
    assert!(get(&mut plant, "gas_mean_k") > before_k + 5.0);
    assert!((get(&mut plant, "outflow_kg_s") + 5e-3).abs() < 1e-12);
}

#[test]
fn parameters_count_until_the_first_step_and_inputs_at_once() {
    let mut plant = unit(&plant());
    set(&mut plant, "fill_pressure_pa", 100e5).unwrap();
    let mass_kg = get(&mut plant, "mass_kg");
    plant.enter_initialization().unwrap();
    set(&mut plant, "fill_pressure_pa", 150e5).unwrap();
    assert!(get(&mut plant, "mass_kg") > 1.3 * mass_kg);
    plant.exit_initialization().unwrap();
    let refused = set(&mut plant, "fill_pressure_pa", 100e5).unwrap_err();
    assert!(refused.to_string().contains("before the first step"), "{refused}");
    // A surface feels the air at once, a reading behind its lag later.
    let before_k = ["shoulder_k", "measured_shoulder_k"].map(|name| get(&mut plant, name));
    set(&mut plant, "air_k", 320.0).unwrap();
    assert!(get(&mut plant, "shoulder_k") > before_k[0] + 1e-3);
    assert_eq!(get(&mut plant, "measured_shoulder_k"), before_k[1]);
    plant.step(0.0, 60.0).unwrap();
    assert!(get(&mut plant, "measured_shoulder_k") > before_k[1] + 0.1);
}

#[test]
fn calls_out_of_order_and_values_out_of_bounds_are_refused_with_their_reason() {
    let mut plant = unit(&plant());
    let mut refused = |words: &str, done: &dyn Fn(&mut Instance) -> Result<(), CosimulationError>| {
        let error = done(&mut plant).unwrap_err().to_string();
        assert!(error.contains(words), "`{words}` is missing in: {error}");
    };
    refused("a step does not belong before the initialization", &|unit| unit.step(0.0, 1.0));
    refused("end", &|unit| unit.terminate());
    refused("air_k = 20 must lie between 60 and 1500", &|unit| set(unit, "air_k", 20.0));
    refused("leak_kg_s = -1", &|unit| set(unit, "leak_kg_s", -1.0));
    refused("it is an output", &|unit| set(unit, "mass_kg", 1.0));
    refused("follows from the steps", &|unit| set(unit, "time", 1.0));
    refused("no variable 1000 of type real", &|unit| unit.set(1000, Access::Real, 1.0));
    refused("no variable 1 of type integer", &|unit| unit.set(1, Access::Integer, 1.0));
    refused("", &|unit| unit.start_at(f64::NAN));
    plant.enter_initialization().unwrap();
    plant.exit_initialization().unwrap();
    for (from_s, step_s) in [(0.0, 0.0), (0.0, -1.0), (0.0, f64::NAN), (0.0, f64::INFINITY), (60.0, 60.0)] {
        assert!(plant.step(from_s, step_s).is_err(), "{from_s} {step_s}");
    }
    plant.step(0.0, 60.0).unwrap();
    plant.terminate().unwrap();
    assert!(plant.step(60.0, 60.0).is_err() && set(&mut plant, "air_k", 280.0).is_err());
    plant.reset().unwrap();
    assert_eq!(plant.save().unwrap(), unit(&self::plant()).save().unwrap());
    // Gas that a cold fluid does not have: what was, stays.
    let mut cold = begun(&self::plant());
    set(&mut cold, "air_k", 60.0).unwrap();
    set(&mut cold, "wind_m_s", 200.0).unwrap();
    let before = cold.save().unwrap();
    let error = cold.step(0.0, 1e6).unwrap_err().to_string();
    assert!(error.contains("step from 0 s"), "{error}");
    assert_eq!(cold.save().unwrap(), before);
}

#[test]
fn a_description_names_every_variable_once_and_escapes_what_a_person_wrote() {
    let about = About { name: "20 l <\"&'> \u{e4}", description: "test", step_s: 60.0 };
    for resource in [plant(), monitor()] {
        let unit = unit(&resource);
        for (version, skipped) in [(Version::Two, 1), (Version::Three, 0)] {
            let text = describe(&unit, &about, version).unwrap();
            assert!(text.contains("20 l &lt;&quot;&amp;") && text.contains('\u{e4}'), "{text}");
            for (place, of) in unit.variables().iter().enumerate() {
                let named = format!("name=\"{}\" valueReference=\"{place}\"", of.name);
                assert_eq!(text.matches(&named).count(), usize::from(place >= skipped), "{named}");
            }
            assert!(text.contains(&unit.token()) && text.contains("0.1.0"));
        }
    }
}
