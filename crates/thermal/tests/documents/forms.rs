//! The forms in which a file can say the same thing, and what holds where it says nothing.
use approx::assert_relative_eq;
use cylwatch_thermal::flow::{FlowKind, Opening, Source, SourceProcess};
use cylwatch_thermal::scenario::OutsideFilm;
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::vessel::Fill;
use cylwatch_thermal::vessel::{
    GasResolution, InsideFilm, Vessel, VesselSpec, presets, read_specification, read_vessel,
    spec::GeometrySpec,
};
use cylwatch_thermal::wall::geometry::EndShape;

use super::{CALIBRATION, scenario_with};

const LEAST: &str = "name = 'x'\nfluid = 'nitrogen'\n[geometry]\ninner_diameter_cm = 20\ncylinder_length_m = 0.5\n\
                     [[layer]]\nmaterial = 'aluminium-6061'\nthickness_mm = 8\n";

#[test]
fn the_least_vessel_gets_the_documented_defaults() {
    let vessel = read_vessel(LEAST, "x.toml").unwrap();
    let geometry = &vessel.geometry;
    assert_eq!((geometry.bottom.cells, geometry.cylinder_cells, geometry.shoulder.cells), (2, 6, 3));
    assert_eq!(geometry.shoulder.shape, EndShape::Dome { depth_m: 0.05 });
    assert_relative_eq!(geometry.bottom.thickness_m, 0.008);
    assert_relative_eq!(vessel.volume.volume_m3, 0.017_802_358_370_342_16, max_relative = 1e-12);
    assert!(vessel.valve.is_none() && geometry.neck.is_none());
    assert_eq!(vessel.gas, GasResolution::WellMixed);
    let InsideFilm::Rayleigh { factor, multiplier, .. } = vessel.inside_film else { panic!("a power law") };
    assert_eq!((factor, multiplier), (0.13, 1.0));
}

#[test]
fn any_unit_of_the_dimension_gives_the_same_vessel() {
    let metres = LEAST.replace("inner_diameter_cm = 20", "inner_diameter_mm = 200.0");
    let one = read_vessel(LEAST, "x.toml").unwrap();
    let other = read_vessel(&metres, "x.toml").unwrap();
    assert_relative_eq!(one.geometry.inner_diameter_m, other.geometry.inner_diameter_m, max_relative = 1e-15);
}

#[test]
fn a_specification_written_and_read_again_is_the_same() {
    for name in presets::FILES.names() {
        let (specification, vessel) = read_specification(presets::FILES.text(name).unwrap(), name).unwrap();
        let text = specification.to_toml().unwrap();
        let (again, same) = read_specification(&text, name).unwrap();
        assert_eq!(again, specification, "{text}");
        assert_eq!((same.geometry, same.volume), (vessel.geometry, vessel.volume));
    }
}

#[test]
fn factors_of_a_calibration_scale_what_they_are_named_after() {
    let plain = presets::FILES.text("nitrogen-20l").unwrap();
    let text = plain
        .replace("thickness_mm = 5.8", "thickness_mm = 5.8\nheat_capacity_factor = 1.2")
        .replace("mass_kg = 1.2", "mass_kg = 1.2\nheat_capacity_factor = 0.8")
        .replace("emissivity = 0.9", "emissivity = 0.9\nfilm_factor = 1.3");
    let [before, after] = [plain, &text].map(|text| read_vessel(text, "x.toml").unwrap());
    let wall = |vessel: &Vessel| vessel.geometry.layers[0].material.heat_capacity_j_kg_k;
    assert_relative_eq!(wall(&after), 1.2 * wall(&before), max_relative = 1e-15);
    let valve = |vessel: &Vessel| vessel.valve.as_ref().unwrap().capacity_j_k();
    assert_relative_eq!(valve(&after), 0.8 * valve(&before), max_relative = 1e-15);
    assert_eq!((before.surface.film_factor, after.surface.film_factor), (1.0, 1.3));
}

#[test]
fn the_record_of_a_calibration_is_read_and_written_and_changes_nothing() {
    let plain = presets::FILES.text("nitrogen-20l").unwrap();
    let (mut specification, vessel) = read_specification(plain, "x.toml").unwrap();
    let (again, same) = read_specification(&format!("{plain}{CALIBRATION}"), "x.toml").unwrap();
    let record = again.calibration.clone().unwrap();
    assert_eq!((record.log.len(), record.fitted.len()), (1, 2));
    assert_eq!(record.fitted[1].of_log.as_deref(), Some("run.csv"));
    specification.calibration = Some(record);
    assert_eq!(again, specification);
    assert_eq!((same.geometry, same.volume), (vessel.geometry, vessel.volume));
    let written = again.to_toml().unwrap();
    assert_eq!(read_specification(&written, "x.toml").unwrap().0, again, "{written}");
}

#[test]
fn a_material_of_the_file_hides_the_library() {
    let own = "[[material]]\nname = 'aluminium-6061'\ndensity_kg_m3 = 2600\nheat_capacity_j_kg_k = 900\n\
               conductivity_w_m_k = 150\n";
    let vessel = read_vessel(&format!("{LEAST}{own}"), "x.toml").unwrap();
    assert_eq!(vessel.geometry.layers[0].material.density_kg_m3, 2600.0);
}

#[test]
fn a_specification_without_a_file_names_the_path() {
    let geometry = GeometrySpec {
        inner_diameter_m: -0.2,
        cylinder_length_m: 0.5,
        cylinder_cells: None,
        lumped: false,
        bottom: Default::default(),
        shoulder: Default::default(),
        neck: None,
    };
    let layer = vec![cylwatch_thermal::vessel::spec::LayerSpec {
        material: "brass".into(),
        thickness_m: 0.01,
        cells: None,
        heat_capacity_factor: None,
    }];
    let specification = VesselSpec {
        name: "x".into(),
        fluid: "nitrogen".into(),
        equation: Default::default(),
        orientation: Default::default(),
        geometry,
        layer,
        material: Vec::new(),
        volume: Default::default(),
        valve: None,
        surface: Default::default(),
        inside_film: Default::default(),
        gas: Default::default(),
        calibration: None,
    };
    let message = specification.build().unwrap_err().to_string();
    assert_eq!(message, "geometry inner_diameter_m = -0.2 must be positive: check the unit, _mm or _m");
}

#[test]
fn changes_table_and_column_give_the_same_air() {
    let film = "\nfilm_w_m2_k = 8";
    let forms = [
        "air_degc = 10\n[[ambient.air_change]]\nat_s = 0\nover_h = 1\nto_degc = 20\n[ambient.film_table]\ntime_s = [0]\nfilm_w_m2_k = [8]",
        "air_table = { time_min = [0, 60], air_degc = [10, 20] }",
        "air_table = { time_h = [0, 1], air_k = [283.15, 293.15] }",
        "air_csv = { file = 't.csv', column = 'air_degc' }",
    ];
    for form in forms {
        let text = if form.contains("film") { form.to_owned() } else { format!("{form}{film}") };
        let scenario = scenario_with("air_degc = 21\nfilm_w_m2_k = 8", &text).unwrap();
        let air = &scenario.surroundings.air_k;
        for (t_s, degc) in [(0.0, 10.0), (1_800.0, 15.0), (3_600.0, 20.0), (9_000.0, 20.0)] {
            assert_relative_eq!(air.at(t_s), 273.15 + degc, max_relative = 1e-12);
        }
        assert_relative_eq!(scenario.initial.gas_temperature_k, 283.15, max_relative = 1e-12);
    }
}

#[test]
fn steps_after_ramps_and_on_their_end_are_exact_jumps() {
    let changes = "air_degc = 0\nfilm_w_m2_k = 8\n[[ambient.air_change]]\nat_h = 0.5\nover_h = 0.5\nto_degc = 10\n\
                   [[ambient.air_change]]\nat_h = 1\nto_degc = 30\n[[ambient.air_change]]\nat_h = 1.5\nover_min = 10\nto_degc = 0";
    let scenario = scenario_with("air_degc = 21\nfilm_w_m2_k = 8", changes).unwrap();
    let air = &scenario.surroundings.air_k;
    let expected = [(0.0, 0.0), (0.5, 0.0), (0.75, 5.0), (1.0, 30.0), (1.5, 30.0), (1.75, 0.0)];
    for (t_h, degc) in expected {
        assert_relative_eq!(air.at(t_h * 3_600.0), 273.15 + degc, max_relative = 1e-12);
    }
    assert_relative_eq!(air.segment(1_800.0, 3_600.0).at(3_600.0), 283.15, max_relative = 1e-12);
}

#[test]
fn a_computed_film_brings_radiation_to_the_air_and_a_coefficient_none() {
    let coefficient = scenario_with("film_w_m2_k = 8", "film_w_m2_k = 9").unwrap();
    assert!(coefficient.surroundings.radiation_k.is_none());
    let still = scenario_with("film_w_m2_k = 8", "").unwrap();
    let OutsideFilm::Convection { wind_m_s, multiplier } = &still.surroundings.film else {
        panic!("convection")
    };
    assert_eq!((wind_m_s.at(0.0), *multiplier), (0.0, 1.0));
    assert_eq!(still.surroundings.radiation_k, Some(still.surroundings.air_k.clone()));
    let shaded = scenario_with("film_w_m2_k = 8", "wind_km_h = 36\nradiation_degc = 5").unwrap();
    assert_relative_eq!(shaded.surroundings.radiation_k.unwrap().at(0.0), 278.15);
}

#[test]
fn fills_and_pressures_are_read_in_all_their_ways() {
    let fill = |text: &str| scenario_with("pressure_bar = 100", text).unwrap().initial.fill;
    assert_eq!(fill("mass_g = 4500"), Fill::Mass { mass_kg: 4.5 });
    let settled = fill("fill_pressure_barg = 199");
    assert_eq!(settled, Fill::Settled { pressure_pa: 1.99e7 + 101_325.0, temperature_k: 288.15 });
    assert_eq!(fill("pressure_mpa = 10"), Fill::Pressure { pressure_pa: 1e7 });
}

#[test]
fn a_refill_and_a_relief_device_are_read() {
    let flows = "film_w_m2_k = 8\n[[refill]]\nflow_g_s = 2\nsource_temperature_degc = 20\nsource_pressure_bar = 300\n\
                 inlet_diameter_mm = 4\ncloses_above_bar = 220\n[[discharge]]\ndiameter_mm = 2\nopens_above_bar = 250\n\
                 closes_below_bar = 230\n[[leak]]\nflow_g_h = 3.6\nstart_min = 1\nstop_min = 2\n[[leak]]\nflow_g_h = 1\n";
    let scenario = scenario_with("film_w_m2_k = 8", flows).unwrap();
    let names: Vec<&str> = scenario.flows.iter().map(|flow| flow.name.as_str()).collect();
    assert_eq!(names, ["leak", "leak2", "discharge", "refill"]);
    assert_relative_eq!(scenario.flows[2].opens_above_pa.unwrap(), 2.5e7);
    assert_relative_eq!(scenario.flows[3].closes_above_pa.unwrap(), 2.2e7);
    assert_eq!((scenario.flows[0].start_s, scenario.flows[0].stop_s), (60.0, 120.0));
}

#[test]
fn flows_are_read_from_tables_files_and_openings() {
    let flows = "film_w_m2_k = 0\n[[leak]]\nflow_csv = {file = \"flow.csv\", column = \"leak_g_s\"}\n\
                 [[discharge]]\nkv_m3_h = 0.4\nback_pressure_bar = 2\n\
                 [[discharge]]\ndiameter_mm = 1\ndischarge_coefficient_ideal_gas = 0.8\n\
                 [[refill]]\ndiameter_mm = 2\ndischarge_coefficient = 0.7\nsource_temperature_degc = 20\nsource_pressure_bar = 300\n\
                 [[refill]]\nkv_m3_h = 1\nx_t = 0.4\nsource_temperature_degc = 20\nsource_pressure_csv = {file = \"flow.csv\", column = \"source_barg\"}\n\
                 [[refill]]\ndiameter_mm = 3\nsource_volume_l = 50\nsource_process = \"isothermal\"\nsource_temperature_degc = 20\nsource_pressure_bar = 300\n\
                 [[refill]]\nflow_g_s = 2\nsource_pressure_bar = 10\nsource_temperature_table = {time_min = [0, 1], temperature_degc = [0, 10]}\n";
    let scenario = scenario_with("film_w_m2_k = 8", flows).unwrap();
    let kind = |k: usize| &scenario.flows[k].kind;
    let FlowKind::LeakSeries { mass_flow_kg_s } = kind(0) else { panic!("a table") };
    assert_relative_eq!(mass_flow_kg_s.at(30.0), 1.25e-3, max_relative = 1e-12);
    let valve = Opening::Valve { kv_m3_h: 0.4, x_t: 0.72 };
    assert_eq!(*kind(1), FlowKind::Release { opening: valve, back_pressure_pa: 2e5 });
    assert!(matches!(kind(2), FlowKind::Release { opening: Opening::IdealGasOrifice { .. }, .. }));
    let FlowKind::Supply { opening: Opening::Orifice { discharge_coefficient, .. }, .. } = kind(3) else {
        panic!("an orifice")
    };
    assert_eq!(*discharge_coefficient, 0.7);
    let FlowKind::Supply { source: Source::Supply { pressure_pa, .. }, .. } = kind(4) else {
        panic!("a table")
    };
    assert_relative_eq!(pressure_pa.at(30.0), 195e5 + 101_325.0, max_relative = 1e-12);
    let FlowKind::Supply { source: Source::Vessel { volume_m3, process, .. }, .. } = kind(5) else {
        panic!("a vessel")
    };
    assert_eq!((*volume_m3, *process), (0.05, SourceProcess::Isothermal));
    assert!(matches!(kind(6), FlowKind::RefillSeries { .. }));
}

#[test]
fn a_film_of_zero_is_an_insulated_wall() {
    let vessel = super::vessel_with("law = \"mcadams\"", "law = \"coefficient\"\nfilm_w_m2_k = 0");
    let vessel = read_vessel(&vessel, "x.toml").unwrap();
    let mut scenario = scenario_with("film_w_m2_k = 8", "film_w_m2_k = 0").unwrap();
    scenario.initial.gas_temperature_k = 310.0;
    scenario.initial.wall_temperature_k = 280.0;
    let run = simulate(&vessel, &scenario, &SimulationSettings::default(), &mut |_| {}).unwrap();
    assert_relative_eq!(*run.gas_mean_k.last().unwrap(), 310.0, max_relative = 1e-7);
    assert_relative_eq!(*run.wall_mean_k.last().unwrap(), 280.0, max_relative = 1e-9);
}
