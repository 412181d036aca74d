//! Vessels and scenarios that the tests build by hand.
use cylwatch_thermal::fluid::Fluid;
use cylwatch_thermal::scenario::{AxialVariation, Initial, OutsideFilm, Scenario, Series, Surroundings};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::vessel::Fill;
use cylwatch_thermal::vessel::{GasResolution, InnerVolume, InsideFilm, Surface, Vessel};
use cylwatch_thermal::wall::geometry::{End, EndShape, Geometry, Layer, Orientation};
use cylwatch_thermal::wall::material::Material;

pub(crate) const MCADAMS: InsideFilm =
    InsideFilm::Rayleigh { factor: 0.13, exponent: 1.0 / 3.0, multiplier: 1.0 };

pub(crate) fn solid(density: f64, heat_capacity: f64, conductivity: f64) -> Material {
    Material {
        name: "steel".into(),
        density_kg_m3: density,
        heat_capacity_j_kg_k: heat_capacity,
        heat_capacity_slope_per_k: 0.0,
        conductivity_w_m_k: conductivity,
        conductivity_slope_per_k: 0.0,
        source: "test".into(),
    }
}

/// The closed bottle of the project's reference run: flat ends, 0.70 m x 190.7 mm, wall 6.7 mm, rigid, one wall cell.
pub(crate) fn closed_bottle() -> Vessel {
    let end = End { shape: EndShape::Flat, thickness_m: 0.0067, cells: 1 };
    let geometry = Geometry {
        orientation: Orientation::Vertical,
        inner_diameter_m: 0.1907,
        cylinder_length_m: 0.70,
        cylinder_cells: 1,
        bottom: end,
        shoulder: end,
        neck: None,
        layers: vec![Layer { material: solid(7850.0, 470.0, 45.0), thickness_m: 0.0067, cells: 1 }],
        lumped: true,
    };
    Vessel {
        name: "closed bottle".into(),
        fluid: Fluid::named("nitrogen").unwrap(),
        volume: rigid(geometry.contour_volume_m3()),
        geometry,
        valve: None,
        surface: Surface { emissivity: 0.0, solar_absorptivity: 0.0, film_factor: 1.0 },
        inside_film: MCADAMS,
        jet_film_factor: 1.0,
        gas: GasResolution::WellMixed,
    }
}

pub(crate) fn rigid(volume_m3: f64) -> InnerVolume {
    InnerVolume {
        volume_m3,
        thermal_expansion_per_k: 0.0,
        pressure_expansion_per_pa: 0.0,
        reference_temperature_k: 288.15,
        reference_pressure_pa: 1e5,
    }
}

/// Constant surroundings with a film coefficient, settled fill of 200 bar at 288.15 K.
pub(crate) fn still(air_k: f64, start_k: f64, film_w_m2_k: f64, hours: f64) -> Scenario {
    Scenario {
        name: "test".into(),
        initial: Initial {
            fill: Fill::Settled { pressure_pa: 200e5, temperature_k: 288.15 },
            wall_temperature_k: start_k,
            gas_temperature_k: start_k,
        },
        surroundings: Surroundings {
            air_k: Series::constant(air_k),
            film: OutsideFilm::Coefficient { film_w_m2_k: Series::constant(film_w_m2_k) },
            radiation_k: None,
            sun: None,
            axial: AxialVariation::default(),
        },
        flows: Vec::new(),
        pressure_limits_pa: Vec::new(),
        sensors: Vec::new(),
        duration_s: hours * 3600.0,
        sample_time_s: 60.0,
    }
}

pub(crate) fn run(vessel: &Vessel, scenario: &Scenario, relative_tolerance: f64) -> Trajectory {
    let settings = SimulationSettings { relative_tolerance, ..SimulationSettings::default() };
    simulate(vessel, scenario, &settings, &mut |_| {}).unwrap()
}

/// Layers of gas may be filled: for balances, which hold whatever is mixed.
pub(crate) fn run_layers(vessel: &Vessel, scenario: &Scenario, relative_tolerance: f64) -> Trajectory {
    let settings =
        SimulationSettings { relative_tolerance, fills_layers: true, ..SimulationSettings::default() };
    simulate(vessel, scenario, &settings, &mut |_| {}).unwrap()
}

pub(crate) fn insulated(fluid: Fluid) -> Vessel {
    Vessel { fluid, inside_film: InsideFilm::Coefficient { film_w_m2_k: 1e-9 }, ..closed_bottle() }
}
