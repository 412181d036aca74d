//! The built-in documents are what they say they are.
use std::f64::consts::PI;

use approx::assert_relative_eq;
use cylwatch_thermal::scenario::OutsideFilm;
use cylwatch_thermal::vessel::Fill;
use cylwatch_thermal::wall::geometry::{EndShape, Geometry};
use cylwatch_thermal::wall::mesh::Mesh;
use cylwatch_thermal::{flow::FlowKind, scenario, vessel};

#[allow(dead_code)]
#[path = "../../examples/railway_week.rs"]
mod railway_week;

fn depth_m(shape: EndShape) -> f64 {
    match shape {
        EndShape::Flat => 0.0,
        EndShape::Dome { depth_m } => depth_m,
    }
}

/// Volume of the wall between two half spheroids, two cylinders and of the neck's tube, m³.
fn wall_volume_m3(geometry: &Geometry) -> f64 {
    let (r, t) = (0.5 * geometry.inner_diameter_m, geometry.thickness_m());
    let shell = |d: f64, t: f64| 2.0 / 3.0 * PI * ((r + t).powi(2) * (d + t) - r * r * d);
    let mut volume = PI * ((r + t).powi(2) - r * r) * geometry.cylinder_length_m;
    for end in [geometry.bottom, geometry.shoulder] {
        volume += shell(depth_m(end.shape), end.thickness_m);
    }
    let Some(neck) = geometry.neck else { return volume };
    let bore = 0.5 * neck.inner_diameter_m;
    let tube = PI * ((bore + neck.thickness_m).powi(2) - bore * bore) * neck.length_m;
    volume + tube - PI * bore * bore * geometry.shoulder.thickness_m
}

#[test]
fn every_built_in_document_loads() {
    for name in vessel::presets::FILES.names() {
        vessel::presets::load(name).unwrap_or_else(|error| panic!("{error}"));
    }
    for name in scenario::presets::FILES.names() {
        scenario::presets::load(name).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn an_unknown_name_gets_a_suggestion() {
    let message = vessel::presets::load("nitrogen20l").unwrap_err().to_string();
    assert!(message.starts_with("no built-in vessel nitrogen20l, did you mean nitrogen-20l?;"), "{message}");
    let message = scenario::presets::load("shok-cold").unwrap_err().to_string();
    assert!(message.starts_with("no built-in scenario shok-cold, did you mean shock-cold?;"), "{message}");
}

#[test]
fn the_20_litre_cylinder_has_its_volume_mass_and_cells() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let geometry = &vessel.geometry;
    let section_m2 = PI * (0.5 * geometry.inner_diameter_m).powi(2);
    let domes_m = 2.0 / 3.0 * (depth_m(geometry.bottom.shape) + depth_m(geometry.shoulder.shape));
    assert_relative_eq!(section_m2 * (geometry.cylinder_length_m + domes_m), 0.020, max_relative = 0.01);
    assert_relative_eq!(vessel.volume.volume_m3, 0.020);
    let density = geometry.layers[0].material.density_kg_m3;
    assert_relative_eq!(density * wall_volume_m3(geometry), 22.4, max_relative = 0.01);
    assert_relative_eq!(Mesh::new(geometry).mass_kg(), 22.4, max_relative = 0.01);
    let neck = geometry.neck.unwrap();
    let columns = geometry.bottom.cells + geometry.cylinder_cells + geometry.shoulder.cells + neck.cells;
    assert_eq!(columns * geometry.layers[0].cells, 36);
    assert_eq!(Mesh::new(geometry).cells(), 36);
}

#[test]
fn the_vessel_of_the_paper_is_the_20_litre_cylinder_made_rigid() {
    let vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let mut paper = vessel::presets::load("nitrogen-20l-paper").unwrap();
    assert_eq!((paper.volume.volume_m3, paper.volume.pressure_expansion_per_pa), (0.020, 0.0));
    assert_eq!(paper.geometry.layers[0].material.heat_capacity_j_kg_k, 460.0);
    paper.geometry.layers = vessel.geometry.layers.clone();
    assert_eq!((paper.geometry, paper.valve, paper.surface), (vessel.geometry, vessel.valve, vessel.surface));
}

#[test]
fn published_vessels_have_their_volumes() {
    let haque = vessel::presets::load("haque-i1").unwrap();
    assert_relative_eq!(haque.volume.volume_m3, 0.0892, max_relative = 1e-3);
    let bottle = vessel::presets::load("closed-bottle").unwrap();
    assert_relative_eq!(bottle.volume.volume_m3, 0.020, max_relative = 1e-3);
    assert!(bottle.geometry.lumped && bottle.valve.is_none());
    assert_eq!(bottle.volume.thermal_expansion_per_k, 0.0);
}

#[test]
fn scenarios_are_what_their_names_say() {
    let cold = scenario::presets::load("shock-cold").unwrap();
    let full = Fill::Settled { pressure_pa: 2e7, temperature_k: 288.15 };
    assert_eq!(cold.initial.fill, full);
    assert_relative_eq!(cold.initial.wall_temperature_k, 294.15);
    assert_relative_eq!(cold.surroundings.air_k.at(0.0), 248.15);
    assert_eq!(cold.pressure_limits_pa, [1.6e7]);
    assert_eq!((cold.duration_s, cold.sample_time_s), (10_800.0, 60.0));
    assert!(matches!(cold.surroundings.film, OutsideFilm::Coefficient { .. }));
    assert!(cold.surroundings.radiation_k.is_none());
    let ramp = scenario::presets::load("ramp-warm").unwrap();
    assert_relative_eq!(ramp.surroundings.air_k.at(9_000.0), 308.15, max_relative = 1e-12);
    let step = scenario::presets::load("tunnel-step").unwrap();
    assert_relative_eq!(step.surroundings.air_k.at(599.0), 263.15);
    assert_relative_eq!(step.surroundings.air_k.at(600.0), 308.15);
    let leak = scenario::presets::load("leak-after-tunnel").unwrap();
    assert_eq!((leak.flows.len(), leak.flows[0].start_s, leak.flows[0].stop_s), (1, 3_600.0, f64::INFINITY));
    let haque = scenario::presets::load("haque-i1").unwrap();
    let FlowKind::Orifice { diameter_m, back_pressure_pa, .. } = haque.flows[0].kind else {
        panic!("an orifice")
    };
    assert_relative_eq!(diameter_m, 0.00635);
    assert_relative_eq!(back_pressure_pa, 101_300.0);
}

#[test]
fn the_railway_week_comes_from_its_generator() {
    let stored = scenario::presets::table("railway-week.csv").unwrap();
    assert_eq!(stored, railway_week::table(), "run the example railway_week and store its output");
    assert!(scenario::presets::table("other.csv").is_err());
}

#[test]
fn the_railway_week_has_tunnels_wind_and_sun() {
    let week = scenario::presets::load("railway-week").unwrap();
    let air = &week.surroundings.air_k;
    let minutes = |day: i64| (day * 1440..(day + 1) * 1440).map(|minute| minute as f64 * 60.0);
    for day in 0..7 {
        let warm: Vec<bool> = minutes(day).map(|t| air.at(t) > 273.15 + 25.0).collect();
        let entries = warm.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        assert!((3..=6).contains(&entries), "{entries} tunnels on day {day}");
    }
    let outside: Vec<f64> =
        (0..7).flat_map(minutes).map(|t| air.at(t) - 273.15).filter(|&t| t < 25.0).collect();
    let mean = outside.iter().sum::<f64>() / outside.len() as f64;
    assert!(mean.abs() < 2.0, "{mean}");
    let OutsideFilm::Convection { wind_m_s, .. } = &week.surroundings.film else { panic!("wind") };
    assert!(wind_m_s.range().0 == 0.0 && (20.0..=30.0).contains(&wind_m_s.range().1));
    assert!(week.surroundings.radiation_k.is_some());
    assert!(week.surroundings.sun.unwrap().irradiance_w_m2.range().1 > 200.0);
}
