//! Cylinders and their sensors against the laws that the study states for them.
use cylwatch_thermal::vessel::{GasResolution, InnerVolume, InsideFilm, Vessel, presets};

use super::super::{Cylinder, TruthLeak, TruthSettings, draw_cylinder};
use super::{assert_uniform, covariance, sd};
use crate::EvaluationError;

const DRAWS: u64 = 500;

fn nominal() -> Vessel {
    presets::load("nitrogen-20l").unwrap()
}

fn drawn() -> Vec<Cylinder> {
    let (nominal, settings) = (nominal(), TruthSettings::default());
    (0..DRAWS).map(|seed| draw_cylinder(&nominal, &settings, seed).unwrap()).collect()
}

type Quantity = (&'static str, fn(&Cylinder) -> f64, (f64, f64));

/// What is drawn, by the statement of the study: outside and inside film 0.75-1.3, wall capacity 0.8-1.25, valve capacity
/// 0.75-1.3, its conductance 0.7-1.3, emissivity 0.6-0.95, expansion ± 10 %, axial film slope ± 30 %, offsets ± 0.3 K,
/// couplings 5-15 %; plume constants around those of the stratified model.
const LAWS: [Quantity; 19] = [
    ("outside film", |c| c.parameters.outside_film, (0.75, 1.3)),
    ("inside film", |c| c.parameters.inside_film, (0.75, 1.3)),
    ("wall capacity", |c| c.parameters.wall_capacity, (0.8, 1.25)),
    ("valve capacity", |c| c.parameters.valve_capacity, (0.75, 1.3)),
    ("valve contact", |c| c.parameters.valve_contact, (0.7, 1.3)),
    ("emissivity", |c| c.parameters.emissivity, (0.6, 0.95)),
    ("thermal expansion", |c| c.parameters.thermal_expansion, (0.9, 1.1)),
    ("pressure expansion", |c| c.parameters.pressure_expansion, (0.9, 1.1)),
    ("film slope", |c| c.parameters.film_slope, (-0.3, 0.3)),
    ("exchange length", |c| c.parameters.exchange_length_diameters, (0.7, 1.4)),
    ("core mixing", |c| c.parameters.core_mixing, (0.02, 0.1)),
    ("shoulder offset", |c| c.sensors.shoulder.offset_k, (-0.3, 0.3)),
    ("valve offset", |c| c.sensors.valve.offset_k, (-0.3, 0.3)),
    ("middle offset", |c| c.sensors.middle.offset_k, (-0.3, 0.3)),
    ("bottom offset", |c| c.sensors.bottom.offset_k, (-0.3, 0.3)),
    ("shoulder coupling", |c| c.sensors.shoulder.air_coupling, (0.05, 0.15)),
    ("valve coupling", |c| c.sensors.valve.air_coupling, (0.05, 0.15)),
    ("middle coupling", |c| c.sensors.middle.air_coupling, (0.05, 0.15)),
    ("bottom coupling", |c| c.sensors.bottom.air_coupling, (0.05, 0.15)),
];

#[test]
fn every_drawn_quantity_fills_its_stated_range_evenly() {
    let drawn = drawn();
    for (what, value, bounds) in &LAWS {
        let values: Vec<f64> = drawn.iter().map(value).collect();
        assert_uniform(what, &values, *bounds);
    }
}

#[test]
fn transmitters_are_off_by_a_tenth_to_a_quarter_of_a_percent_with_either_sign() {
    let drawn = drawn();
    // Of 250 bar full scale; the coefficient per 10 K is 0.05 to 0.15 % of it.
    let full_scale_pa = 250e5;
    let offset: Vec<f64> = drawn.iter().map(|c| c.sensors.pressure.offset_pa / full_scale_pa).collect();
    let coefficient: Vec<f64> =
        drawn.iter().map(|c| c.sensors.pressure.coefficient_pa_k * 10.0 / full_scale_pa).collect();
    for (values, bounds) in [(&offset, (0.001, 0.0025)), (&coefficient, (0.0005, 0.0015))] {
        let magnitudes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
        assert_uniform("magnitude", &magnitudes, bounds);
        let positive = values.iter().filter(|&&value| value > 0.0).count() as f64;
        assert!((positive - 250.0).abs() < 4.0 * 125_f64.sqrt(), "{positive} of 500 positive");
    }
}

#[test]
fn drawn_quantities_do_not_depend_on_each_other() {
    let drawn = drawn();
    let columns: Vec<Vec<f64>> = LAWS.iter().map(|(_, value, _)| drawn.iter().map(value).collect()).collect();
    for (i, a) in columns.iter().enumerate() {
        for (j, b) in columns.iter().enumerate().take(i) {
            let correlation = covariance(a, b) / (sd(a) * sd(b));
            // 171 pairs: a larger correlation than 4.3 standard deviations has one set in 340 by chance.
            let bound = 4.3 / (DRAWS as f64).sqrt();
            assert!(correlation.abs() < bound, "{} and {}: {correlation:.3}", LAWS[i].0, LAWS[j].0);
        }
    }
}

#[test]
fn a_seed_draws_one_cylinder_and_a_mesh_changes_nothing_of_it() {
    let draw = |settings: &TruthSettings, seed| draw_cylinder(&nominal(), settings, seed).unwrap();
    let coarse = TruthSettings { cylinder_cells: 2, gas_cells: 1, ..TruthSettings::default() };
    let (first, again, other) =
        (draw(&TruthSettings::default(), 11), draw(&coarse, 11), draw(&TruthSettings::default(), 12));
    assert_eq!((first.parameters, first.sensors), (again.parameters, again.sensors));
    assert!(again.vessel.gas == GasResolution::WellMixed && again.vessel.geometry.cylinder_cells == 2);
    assert!(first.parameters != other.parameters && first.sensors != other.sensors);
}

#[test]
fn what_was_drawn_is_what_the_vessel_has() {
    let (nominal, cylinder) = (nominal(), draw_cylinder(&nominal(), &TruthSettings::default(), 5).unwrap());
    let (vessel, drawn) = (&cylinder.vessel, &cylinder.parameters);
    let ratio = |after: f64, before: f64, factor: f64| {
        approx::assert_relative_eq!(after / before, factor, max_relative = 1e-12)
    };
    for (after, before) in vessel.geometry.layers.iter().zip(&nominal.geometry.layers) {
        ratio(after.material.heat_capacity_j_kg_k, before.material.heat_capacity_j_kg_k, drawn.wall_capacity);
        assert_eq!(after.material.conductivity_w_m_k, before.material.conductivity_w_m_k);
    }
    let (after, before) = (vessel.valve.as_ref().unwrap(), nominal.valve.as_ref().unwrap());
    ratio(after.capacity_j_k(), before.capacity_j_k(), drawn.valve_capacity);
    ratio(after.contact_w_k, before.contact_w_k, drawn.valve_contact);
    let multiplier = |vessel: &Vessel| match vessel.inside_film {
        InsideFilm::Rayleigh { multiplier, .. } => multiplier,
        InsideFilm::Coefficient { film_w_m2_k } => film_w_m2_k,
    };
    ratio(multiplier(vessel), multiplier(&nominal), drawn.inside_film);
    // 100 K and 100 bar away from the reference the volume has grown by what the expansions say.
    let (v, n) = (&vessel.volume, &nominal.volume);
    let growth = |wall_k: f64, pressure_pa: f64| {
        let grown = |volume: &InnerVolume| {
            volume.volume_m3(
                volume.reference_temperature_k + wall_k,
                volume.reference_pressure_pa + pressure_pa,
            ) / volume.volume_m3
                - 1.0
        };
        grown(v) / grown(n)
    };
    approx::assert_relative_eq!(growth(100.0, 0.0), drawn.thermal_expansion, max_relative = 1e-9);
    approx::assert_relative_eq!(growth(0.0, 1e7), drawn.pressure_expansion, max_relative = 1e-9);
    assert_eq!(vessel.surface.emissivity, drawn.emissivity);
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    let refused = |change: fn(&mut TruthSettings), name: &str| {
        let mut settings = TruthSettings::default();
        change(&mut settings);
        let error = draw_cylinder(&nominal(), &settings, 1).unwrap_err();
        assert!(matches!(error, EvaluationError::TruthSetting { setting, .. } if setting == name), "{error}");
    };
    refused(|s| s.cylinder_cells = 0, "cylinder_cells");
    refused(|s| s.radial_cells = 0, "radial_cells");
    refused(|s| s.gas_cells = 0, "gas_cells");
    refused(|s| s.relative_tolerance = 0.1, "relative_tolerance");
    refused(|s| s.relative_tolerance = f64::NAN, "relative_tolerance");
    refused(|s| s.leak = Some(TruthLeak { rate_kg_s: -1e-6, start_s: 0.0 }), "leak.rate_kg_s");
    refused(|s| s.leak = Some(TruthLeak { rate_kg_s: 1e-6, start_s: f64::NAN }), "leak.start_s");
}
