//! The exact Jacobian against central differences, in every regime.
use cylwatch_thermal::flow::{Flow, FlowKind, Opening, Source, SourceProcess};
use cylwatch_thermal::model::Model;
use cylwatch_thermal::model::inputs::{FilmInput, Inputs, Moment};
use cylwatch_thermal::model::layout::Layout;
use cylwatch_thermal::scenario::{Scenario, Series};
use cylwatch_thermal::vessel::{GasResolution, InnerVolume, Stratification, Surface, Valve, Vessel};
use cylwatch_thermal::wall::geometry::{End, EndShape, Geometry, Layer, Neck, Orientation};
use cylwatch_thermal::wall::material::Material;
use proptest::prelude::*;

use crate::support::{closed_bottle, solid, still};

/// Derivatives of everything that a stacked gas does, too: boundary layers, overturn, mixing, plates.
#[test]
fn jacobian_is_the_derivative_for_stacked_gas() {
    for orientation in [Orientation::Vertical, Orientation::Horizontal] {
        let mut vessel = full();
        vessel.geometry.orientation = orientation;
        vessel.gas = GasResolution::Stratified(Stratification {
            cells: 5,
            exchange_length_diameters: 1.0,
            core_mixing: 0.05,
        });
        check(&vessel, &with_flows(vec![]), &STILL, 3.0);
        check(&vessel, &with_flows(vec![FlowKind::Leak { mass_flow_kg_s: 1e-4 }]), &STILL, -3.0);
    }
}

/// Everything switched on: domes, neck, two layers, temperature-dependent steel, elastic volume, valve, radiation.
fn full() -> Vessel {
    let base = closed_bottle();
    let end = End { shape: EndShape::Dome { depth_m: 0.07 }, thickness_m: 0.008, cells: 2 };
    let steel = Material {
        heat_capacity_slope_per_k: 7e-4,
        conductivity_slope_per_k: -4e-4,
        ..solid(7850.0, 460.0, 42.0)
    };
    Vessel {
        volume: InnerVolume {
            thermal_expansion_per_k: 3.5e-5,
            pressure_expansion_per_pa: 1.5e-10,
            ..base.volume
        },
        valve: Some(Valve {
            material: solid(8400.0, 380.0, 115.0),
            mass_kg: 1.2,
            contact_w_k: 2.0,
            area_m2: 0.02,
            diameter_m: 0.06,
            film_factor: 1.25,
        }),
        surface: Surface { emissivity: 0.9, solar_absorptivity: 0.5, film_factor: 1.2 },
        geometry: Geometry {
            cylinder_cells: 3,
            bottom: end,
            shoulder: end,
            neck: Some(Neck { inner_diameter_m: 0.025, thickness_m: 0.012, length_m: 0.03, cells: 1 }),
            layers: vec![
                Layer { material: solid(950.0, 1900.0, 0.4), thickness_m: 0.003, cells: 2 },
                Layer { material: steel, thickness_m: 0.006, cells: 2 },
            ],
            lumped: false,
            ..base.geometry
        },
        ..base
    }
}

fn flow(kind: FlowKind) -> Flow {
    Flow::open("flow", kind)
}

fn with_flows(kinds: Vec<FlowKind>) -> Scenario {
    let mut scenario = still(280.0, 288.15, 10.0, 1.0);
    scenario.flows = kinds.into_iter().map(flow).collect();
    scenario
}

/// Rounding of the flow that equalises stacked cells: 1e-8 Pa over a conductance of 1e-3 kg/(s Pa), and its enthalpy.
fn equalisation(layout: &Layout, row: usize) -> f64 {
    match row {
        _ if layout.gas == 1 || row < layout.mass => 0.0,
        r if r < layout.energy => 1e-11,
        _ => 4e-6,
    }
}

fn check(vessel: &Vessel, scenario: &Scenario, inputs: &Inputs, gas_offset_k: f64) {
    let model = Model::new(vessel, scenario).unwrap();
    let mut initial = scenario.initial;
    initial.gas_temperature_k += gas_offset_k;
    let mut x = model.initial_state(vessel, &initial).unwrap();
    let layout = *model.layout();
    for (cell, value) in x[..layout.mean_wall].iter_mut().enumerate() {
        *value += 3.0 * ((cell * 7 % 11) as f64 / 11.0 - 0.4);
    }
    let open = vec![true; scenario.flows.len()];
    let n = layout.states;
    // The motion of the gas is the last state.
    let stirring = scenario.flows.iter().any(|flow| flow.kind.has_jet()).then_some(n - 1);
    if let Some(stirring) = stirring {
        x[stirring] = 2e4;
    }
    let mut jacobian = vec![vec![0.0; n]; n];
    model.jacobian(&x, inputs, &open, &mut |i, j, v| jacobian[i][j] += v).unwrap();
    let capacity = |row: usize| if row <= layout.mean_wall { 1.0 } else { 1e-3 };
    for column in 0..n {
        let step = match column {
            // Small enough for the stiff equalisation of stacked cells.
            c if (layout.mass..layout.energy).contains(&c) => 1e-6,
            c if (layout.energy..layout.heat_in).contains(&c) => 0.2,
            c if c <= layout.mean_wall => 1e-4,
            c if Some(c) == stirring => 1.0,
            // Mass drawn from a source vessel comes after the four entries of the ledger.
            c if c >= layout.heat_in + 4 => 1e-5,
            _ => 1.0,
        };
        let mut rates = [vec![0.0; n], vec![0.0; n]];
        for (side, rate) in [1.0, -1.0].into_iter().zip(&mut rates) {
            let mut moved = x.clone();
            moved[column] += side * step;
            model.rate(&moved, inputs, &open, rate).unwrap();
        }
        for row in 0..n {
            let difference = (rates[0][row] - rates[1][row]) / (2.0 * step);
            let scale =
                (rates[0][row].abs() / x[column].abs().max(1.0) + difference.abs()) * capacity(row) + 1e-7;
            // Rounding of the two rates, which the step magnifies.
            let rounding = (1e-12 * (rates[0][row].abs() + 1.0) + equalisation(&layout, row)) / step;
            let error = (jacobian[row][column] - difference).abs();
            assert!(
                error < 2e-4 * scale.max(difference.abs()) + rounding,
                "row {row} column {column}: {} against {difference}",
                jacobian[row][column]
            );
        }
    }
}

const STILL: Inputs = Inputs {
    moment: Moment { time_s: 0.0, between_s: (0.0, 3_600.0) },
    air_k: 275.0,
    film: FilmInput::Coefficient(12.0),
    radiation_k: None,
    irradiance_w_m2: 0.0,
    air_difference_k: 0.0,
};

#[test]
fn jacobian_is_the_derivative_in_a_closed_cylinder() {
    check(&full(), &with_flows(vec![]), &STILL, 1.0);
}

#[test]
fn jacobian_is_the_derivative_in_wind_and_radiation() {
    let inputs = Inputs {
        film: FilmInput::Convection { wind_m_s: 7.0, multiplier: 1.1 },
        radiation_k: Some(270.0),
        irradiance_w_m2: 500.0,
        ..STILL
    };
    check(&full(), &with_flows(vec![]), &inputs, -2.0);
    let calm = Inputs { film: FilmInput::Convection { wind_m_s: 0.0, multiplier: 1.0 }, ..inputs };
    check(&full(), &with_flows(vec![]), &calm, 3.0);
}

#[test]
fn jacobian_is_the_derivative_where_film_and_air_change_along_the_axis() {
    let mut scenario = with_flows(vec![]);
    scenario.surroundings.axial.film_slope = 0.8;
    check(&full(), &scenario, &Inputs { air_difference_k: 15.0, ..STILL }, 1.0);
    let wind = FilmInput::Convection { wind_m_s: 3.0, multiplier: 1.0 };
    check(&full(), &scenario, &Inputs { air_difference_k: 15.0, film: wind, ..STILL }, 1.0);
}

#[test]
fn jacobian_is_the_derivative_in_a_blowdown_and_a_refill() {
    let orifice = |back_pressure_pa| FlowKind::Orifice {
        diameter_m: 0.003,
        discharge_coefficient: 0.8,
        back_pressure_pa,
    };
    check(&full(), &with_flows(vec![orifice(1e5)]), &STILL, -8.0);
    check(&full(), &with_flows(vec![orifice(150e5)]), &STILL, -8.0);
    check(
        &full(),
        &with_flows(vec![
            FlowKind::Leak { mass_flow_kg_s: 1e-5 },
            FlowKind::Refill {
                mass_flow_kg_s: 5e-3,
                source_temperature_k: 300.0,
                source_pressure_pa: 250e5,
                inlet_diameter_m: Some(0.004),
            },
        ]),
        &STILL,
        6.0,
    );
}

/// Refills through openings, choked and not, from sources that do and do not run down, with their jets.
#[test]
fn jacobian_is_the_derivative_of_a_refill_through_an_opening() {
    let hole = Opening::Orifice { diameter_m: 0.003, discharge_coefficient: 0.8 };
    let valve = Opening::Valve { kv_m3_h: 0.3, x_t: 0.7 };
    let vessel =
        |pressure_pa, process| Source::Vessel { volume_m3: 0.05, temperature_k: 290.0, pressure_pa, process };
    let constant =
        Source::Supply { temperature_k: Series::constant(290.0), pressure_pa: Series::constant(300e5) };
    let supply = |opening, source, inlet_diameter_m| FlowKind::Supply { opening, source, inlet_diameter_m };
    let stacked = GasResolution::Stratified(Stratification {
        cells: 4,
        exchange_length_diameters: 1.0,
        core_mixing: 0.05,
    });
    for gas in [GasResolution::WellMixed, stacked] {
        let vessel_of = Vessel { gas, ..full() };
        for opening in [hole, valve] {
            let flows = vec![
                supply(opening, constant.clone(), Some(0.004)),
                supply(opening, vessel(700e5, SourceProcess::Adiabatic), Some(0.006)),
                supply(opening, vessel(260e5, SourceProcess::Isothermal), None),
                FlowKind::Release { opening, back_pressure_pa: 150e5 },
            ];
            check(&vessel_of, &with_flows(flows), &STILL, 4.0);
        }
    }
}

/// Where the pressures are equal or the wrong way round nothing flows, and the derivative says so.
#[test]
fn jacobian_is_the_derivative_where_the_source_is_no_longer_above() {
    let supply = FlowKind::Supply {
        opening: Opening::Orifice { diameter_m: 0.003, discharge_coefficient: 0.8 },
        source: Source::Vessel {
            volume_m3: 0.05,
            temperature_k: 290.0,
            pressure_pa: 100e5,
            process: SourceProcess::Adiabatic,
        },
        inlet_diameter_m: Some(0.004),
    };
    check(&full(), &with_flows(vec![supply]), &STILL, 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]
    #[test]
    fn jacobian_is_the_derivative_everywhere(air in 230.0..330.0f64, film in 1.0..80.0f64, offset in -15.0..15.0f64) {
        let inputs = Inputs { air_k: air, film: FilmInput::Coefficient(film), ..STILL };
        check(&full(), &with_flows(vec![FlowKind::Leak { mass_flow_kg_s: 1e-5 }]), &inputs, offset);
    }
}
