//! What `[[sensor]]` tables become, and which cells stand for their places.
use approx::assert_relative_eq;
use cylwatch_thermal::sensor::{
    GasPlace, Law, MountedSensor, Parameter, ParameterKind, PressureReference, SensorKind, SurfacePlace,
};
use cylwatch_thermal::vessel::{self, GasResolution, Stratification};
use cylwatch_thermal::wall::geometry::Orientation;
use cylwatch_thermal::wall::mesh::{Mesh, Section};

use super::scenario_with;

fn sensor(lines: &str) -> MountedSensor {
    let scenario = scenario_with("film_w_m2_k = 8", &format!("[[sensor]]\n{lines}")).unwrap();
    scenario.sensors.into_iter().next().unwrap()
}

fn parameter(sensor: &MountedSensor, kind: ParameterKind) -> Parameter {
    *sensor.parameter(kind).unwrap()
}

#[test]
fn names_say_kind_and_place() {
    let surface = |place| SensorKind::Surface { place };
    let cases = [
        ("shoulder", surface(SurfacePlace::Shoulder)),
        ("valve", surface(SurfacePlace::Valve)),
        ("wall_middle", surface(SurfacePlace::Middle)),
        ("gas_3", SensorKind::Gas { place: GasPlace::Cell { number: 3 } }),
        ("ambient", SensorKind::Ambient),
        ("pressure", SensorKind::Pressure { reference: PressureReference::Absolute, full_scale_pa: None }),
    ];
    for (name, kind) in cases {
        assert_eq!(sensor(&format!("name = \"{name}\"")).kind, kind, "{name}");
    }
    let named = sensor("name = \"outside\"\nkind = \"ambient\"");
    assert_eq!(named.kind, SensorKind::Ambient);
    let high = sensor("name = \"a\"\nheight_mm = 450");
    assert_eq!(high.kind, surface(SurfacePlace::Height { height_m: 0.45 }));
}

#[test]
fn a_sensor_of_which_nothing_is_said_is_ideal() {
    let (plain, transmitter) = (sensor("name = \"shoulder\""), sensor("name = \"pressure\""));
    let numbers = plain.parameters.iter().chain(&transmitter.parameters);
    assert!(numbers.clone().all(|of| (of.mean, of.sd, of.walk_per_sqrt_s) == (0.0, 0.0, 0.0)));
    assert_eq!(numbers.count(), 5);
    let sizes = [plain.lag_s, plain.noise, plain.resolution, plain.drift_per_s];
    assert_eq!((sizes, plain.dropout, plain.correlated), ([0.0; 4], 0.0, None));
}

#[test]
fn numbers_of_a_pressure_transmitter_arrive_in_si() {
    let transmitter = sensor(
        "name = \"pressure\"\noffset_mbar = -120\noffset_tolerance_bar = 0.625\nspan_percent = 0.2\n\
         span_sd_percent = 0.05\ntemperature_coefficient_mbar_k = 12\ntemperature_coefficient_sd_bar_k = 0.025\n\
         noise_mbar = 10\nresolution_mbar = 5\ndrift_mbar_d = 0.864\nwalk_sd_bar = 0.1\nwalk_time_h = 1\n\
         correlated_noise_mbar = 3\ncorrelation_time_min = 2\nlag_s = 0.5\nfull_scale_bar = 250\n\
         gauge = true\ndropout = 0.01",
    );
    use ParameterKind::{Offset, Span, TemperatureCoefficient};
    let [offset, coefficient, span] =
        [Offset, TemperatureCoefficient, Span].map(|kind| parameter(&transmitter, kind));
    assert_relative_eq!(offset.mean, -12_000.0, max_relative = 1e-14);
    assert_relative_eq!(offset.sd, 62_500.0 / 3.0_f64.sqrt(), max_relative = 1e-14);
    assert_eq!(offset.law, Law::Uniform);
    assert_relative_eq!(span.mean, 2e-3, max_relative = 1e-14);
    assert_relative_eq!(span.sd, 5e-4, max_relative = 1e-14);
    assert_relative_eq!(coefficient.mean, 1_200.0, max_relative = 1e-14);
    assert_relative_eq!(coefficient.sd, 2_500.0, max_relative = 1e-14);
    assert_relative_eq!(transmitter.noise, 1_000.0, max_relative = 1e-14);
    assert_relative_eq!(transmitter.resolution, 500.0, max_relative = 1e-14);
    assert_relative_eq!(transmitter.drift_per_s, 1e-3, max_relative = 1e-14);
    assert_relative_eq!(offset.walk_per_sqrt_s, 1e4 / 60.0, max_relative = 1e-14);
    let correlated = transmitter.correlated.unwrap();
    assert_relative_eq!(correlated.sd, 300.0, max_relative = 1e-14);
    assert_eq!((correlated.time_s, transmitter.lag_s, transmitter.dropout), (120.0, 0.5, 0.01));
    let SensorKind::Pressure { reference: PressureReference::Gauge { atmosphere_pa }, full_scale_pa } =
        transmitter.kind
    else {
        panic!("{:?}", transmitter.kind)
    };
    assert_eq!((atmosphere_pa, full_scale_pa), (101_325.0, Some(250e5)));
}

#[test]
fn numbers_of_a_temperature_arrive_in_si() {
    let strapped = sensor(
        "name = \"shoulder\"\nair_coupling = 0.1\nair_coupling_sd = 0.04\noffset_k = 0.2\nclass = \"B\"\n\
         noise_k = 0.05\nresolution_k = 0.0625\ndrift_k_d = 0.0864\nlowest_degc = -60\nhighest_degc = 100",
    );
    let [offset, coupling] =
        [ParameterKind::Offset, ParameterKind::Coupling].map(|kind| parameter(&strapped, kind));
    assert_eq!((coupling.mean, coupling.sd), (0.1, 0.04));
    // Class B: 0.3 K and 0.005 K for each of 20 degC.
    assert_relative_eq!(offset.sd, 0.4 / 3.0_f64.sqrt(), max_relative = 1e-14);
    assert_eq!((offset.mean, strapped.noise, strapped.resolution), (0.2, 0.05, 0.0625));
    assert_relative_eq!(strapped.drift_per_s, 1e-6, max_relative = 1e-14);
    assert_relative_eq!(strapped.plausible.0, 213.15, max_relative = 1e-14);
    assert_relative_eq!(strapped.plausible.1, 373.15, max_relative = 1e-14);
}

#[test]
fn a_height_on_the_wall_is_the_column_whose_inner_face_is_there() {
    for name in vessel::presets::FILES.names() {
        let geometry = vessel::presets::load(name).unwrap().geometry;
        let mesh = Mesh::new(&geometry);
        let column = |height_m| SurfacePlace::Height { height_m }.column(&geometry, &mesh);
        for (j, found) in mesh.columns.iter().enumerate() {
            let (low, high) = found.inner_height_m;
            if high > low {
                let middle_m = geometry.bottom.thickness_m + 0.5 * (low + high);
                assert_eq!(column(middle_m), Some(j), "{name}");
            }
        }
        assert_eq!(column(-0.001), None);
        assert_eq!(column(geometry.outer_height_m() + 0.001), None);
        let lowest = mesh.columns[column(0.0).unwrap()].section;
        let highest = mesh.columns[column(geometry.outer_height_m()).unwrap()].section;
        assert!(matches!(lowest, Section::Bottom | Section::Cylinder), "{name}");
        assert!(matches!(highest, Section::Neck | Section::Shoulder | Section::Cylinder), "{name}");
        assert_eq!(SurfacePlace::Valve.column(&geometry, &mesh), None);
        assert_eq!(SurfacePlace::Shoulder.column(&geometry, &mesh), mesh.column_of("shoulder"));
    }
}

#[test]
fn a_height_in_the_gas_is_the_slab_around_it() {
    let mut vessel = vessel::presets::load("nitrogen-20l").unwrap();
    let stratification = Stratification { cells: 5, exchange_length_diameters: 1.0, core_mixing: 0.1 };
    vessel.gas = GasResolution::Stratified(stratification);
    for orientation in [Orientation::Vertical, Orientation::Horizontal] {
        vessel.geometry.orientation = orientation;
        let mesh = Mesh::new(&vessel.geometry);
        let geometry = &vessel.geometry;
        let (below_m, inner_m) = match orientation {
            Orientation::Vertical => (geometry.bottom.thickness_m, geometry.inner_height_m()),
            Orientation::Horizontal => (geometry.thickness_m(), geometry.inner_diameter_m),
        };
        let cell = |height_m| GasPlace::Height { height_m }.cell(&vessel, &mesh);
        // Slabs of equal height: a fifth each.
        for (part, expected) in [(0.01, 0), (0.19, 0), (0.21, 1), (0.5, 2), (0.79, 3), (0.81, 4), (0.99, 4)] {
            assert_eq!(cell(below_m + part * inner_m), Some(expected), "{orientation:?} {part}");
        }
        assert_eq!((cell(0.5 * below_m), cell(below_m + 1.01 * inner_m)), (None, None));
        let numbered = |number| GasPlace::Cell { number }.cell(&vessel, &mesh);
        assert_eq!([0, 1, 5, 6].map(numbered), [None, Some(0), Some(4), None]);
    }
}

#[test]
fn an_immersion_sensor_states_its_stem_and_hangs_as_a_gas_sensor_does() {
    let stem = sensor(
        "name = \"tank\"\nkind = \"immersion\"\nheight_mm = 750\nstem_coupling = 0.1\nstem_coupling_sd = 0.05\n\
         class = \"A\"\nlag_s = 15",
    );
    let place = GasPlace::Height { height_m: 0.75 };
    assert_eq!((stem.kind, stem.lag_s), (SensorKind::Immersion { place }, 15.0));
    let coupling = parameter(&stem, ParameterKind::Coupling);
    assert_eq!((coupling.mean, coupling.sd, coupling.law), (0.1, 0.05, Law::Normal));
    let refused = |lines: &str| {
        let document = format!("[[sensor]]\nname = \"gas_1\"\n{lines}");
        scenario_with("film_w_m2_k = 8", &document).unwrap_err().to_string()
    };
    for (lines, words) in [
        (
            "stem_coupling = 0.1",
            "stem_coupling cannot stand beside kind = gas: it belongs to immersion sensors",
        ),
        (
            "kind = \"immersion\"\nair_coupling = 0.1",
            "beside kind = immersion: it belongs to surface sensors",
        ),
        ("kind = \"immersion\"\nnoise_mbar = 1", "it belongs to pressure transmitters"),
        ("kind = \"immersion\"\nstem_coupling = 1.1", "stem_coupling = 1.1 must be between 0 and 1"),
        ("kind = \"immersion\"\nstem_coupling_sd = -1", "stem_coupling_sd = -1 must be between 0 and 1"),
    ] {
        let message = refused(lines);
        assert!(message.contains(words), "{message}");
    }
}
