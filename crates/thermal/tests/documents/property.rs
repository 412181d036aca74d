//! No text makes the readers panic, and what they accept is physical.
use cylwatch_thermal::flow::{FlowKind, Opening};
use cylwatch_thermal::scenario::{self, OutsideFilm, Scenario};
use cylwatch_thermal::vessel::Fill;
use cylwatch_thermal::vessel::{self, InsideFilm, Vessel};
use cylwatch_thermal::wall::geometry::EndShape;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Pieces that stress a reader: numbers at and beyond bounds, keys, brackets, characters of several bytes.
const PIECES: [&str; 34] = [
    "0",
    "-1",
    "1e-300",
    "1e300",
    "1e999",
    "nan",
    "-inf",
    "0x7fffffffffffffff",
    "99999999999999999999",
    "1.5",
    "\"\"",
    "true",
    "[",
    "]",
    "{",
    "}",
    "=",
    "\n",
    "\n[gas]\n",
    "\n[[layer]]\n",
    "\n[ambient]\n",
    "# ",
    "\"",
    "'''",
    "_bar",
    "_k",
    "_mm",
    "air_degc = 3\n",
    "cells = 3\n",
    "[1, 2]",
    "1979-05-27",
    "\u{fc}\u{20ac}",
    "\u{0}",
    "time_s = [0, 1]",
];

/// Replaces some stretches of a text by pieces.
fn mutated(text: &str, edits: &[(Index, usize, &'static str)]) -> String {
    let mut characters: Vec<char> = text.chars().collect();
    for (at, length, piece) in edits {
        let start = at.index(characters.len() + 1);
        let end = (start + length).min(characters.len());
        characters.splice(start..end, piece.chars());
    }
    characters.into_iter().collect()
}

/// Replaces the value of a line by a piece.
fn with_value(text: &str, at: Index, piece: &str) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let assignments: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].contains(" = ")).collect();
    let line = &mut lines[assignments[at.index(assignments.len())]];
    let key = line.split(" = ").next().unwrap_or_default().to_owned();
    *line = format!("{key} = {piece}");
    lines.join("\n")
}

fn edits() -> impl Strategy<Value = Vec<(Index, usize, &'static str)>> {
    prop::collection::vec((any::<Index>(), 0..12_usize, select(PIECES.to_vec())), 1..4)
}

fn texts(presets: Vec<&'static str>) -> impl Strategy<Value = String> {
    let preset = select(presets);
    prop_oneof![
        (preset.clone(), edits()).prop_map(|(text, edits)| mutated(text, &edits)),
        (preset.clone(), any::<Index>(), select(PIECES.to_vec()))
            .prop_map(|(t, at, piece)| with_value(t, at, piece)),
        (preset, any::<Index>(), any::<f64>()).prop_map(|(t, at, number)| with_value(
            t,
            at,
            &number.to_string()
        )),
        prop::collection::vec(any::<u8>(), 0..200)
            .prop_map(|bytes| String::from_utf8_lossy(&bytes).into_owned()),
    ]
}

fn vessels() -> Vec<&'static str> {
    vessel::presets::FILES.names().filter_map(|name| vessel::presets::FILES.text(name).ok()).collect()
}

fn scenarios() -> Vec<&'static str> {
    scenario::presets::FILES.names().filter_map(|name| scenario::presets::FILES.text(name).ok()).collect()
}

fn positive(values: impl IntoIterator<Item = f64>) -> bool {
    values.into_iter().all(|value| value.is_finite() && value > 0.0)
}

fn vessel_is_physical(vessel: &Vessel) -> bool {
    let geometry = &vessel.geometry;
    let ends = [geometry.bottom, geometry.shoulder];
    let depths = ends.iter().map(|end| match end.shape {
        EndShape::Flat => 1.0,
        EndShape::Dome { depth_m } => depth_m,
    });
    let layers = geometry.layers.iter().flat_map(|layer| {
        let material = &layer.material;
        [
            layer.thickness_m,
            material.density_kg_m3,
            material.heat_capacity_j_kg_k,
            material.conductivity_w_m_k,
        ]
    });
    let film = match vessel.inside_film {
        InsideFilm::Rayleigh { factor, exponent, multiplier } => [factor, exponent, multiplier],
        InsideFilm::Coefficient { film_w_m2_k: 0.0 } => [1.0; 3],
        InsideFilm::Coefficient { film_w_m2_k } => [film_w_m2_k, 1.0, 1.0],
    };
    let valve = vessel
        .valve
        .iter()
        .flat_map(|valve| [valve.mass_kg, valve.contact_w_k, valve.area_m2, valve.diameter_m]);
    positive([geometry.inner_diameter_m, geometry.cylinder_length_m, vessel.volume.volume_m3])
        && positive(ends.map(|end| end.thickness_m))
        && positive(depths)
        && positive(layers)
        && positive(film)
        && positive(valve)
        && !geometry.layers.is_empty()
        && geometry.layers.iter().all(|layer| layer.cells > 0)
}

fn scenario_is_physical(scenario: &Scenario) -> bool {
    let fill = match scenario.initial.fill {
        Fill::Settled { pressure_pa, temperature_k } => [pressure_pa, temperature_k],
        Fill::Pressure { pressure_pa } => [pressure_pa, 1.0],
        Fill::Mass { mass_kg } => [mass_kg, 1.0],
    };
    let film = match &scenario.surroundings.film {
        OutsideFilm::Coefficient { film_w_m2_k } => {
            film_w_m2_k.range().0 >= 0.0 && film_w_m2_k.range().1.is_finite()
        }
        OutsideFilm::Convection { wind_m_s, multiplier } => {
            wind_m_s.range().0 >= 0.0 && wind_m_s.range().1.is_finite() && positive([*multiplier])
        }
    };
    let flows = scenario.flows.iter().all(|flow| {
        let size = match flow.kind {
            FlowKind::Leak { mass_flow_kg_s } | FlowKind::Refill { mass_flow_kg_s, .. } => mass_flow_kg_s,
            FlowKind::Orifice { diameter_m, .. } => diameter_m,
            FlowKind::LeakSeries { ref mass_flow_kg_s }
            | FlowKind::RefillSeries { ref mass_flow_kg_s, .. } => {
                if mass_flow_kg_s.range().0 >= 0.0 {
                    1.0
                } else {
                    -1.0
                }
            }
            FlowKind::Release { opening, .. } | FlowKind::Supply { opening, .. } => match opening {
                Opening::Orifice { diameter_m, .. } | Opening::IdealGasOrifice { diameter_m, .. } => {
                    diameter_m
                }
                Opening::Valve { kv_m3_h, .. } => kv_m3_h,
            },
        };
        positive([size]) && flow.start_s >= 0.0 && flow.stop_s > flow.start_s
    });
    let air = scenario.surroundings.air_k.range();
    positive([air.0, air.1, scenario.duration_s, scenario.sample_time_s])
        && positive([scenario.initial.wall_temperature_k, scenario.initial.gas_temperature_k])
        && positive(fill)
        && positive(scenario.pressure_limits_pa.iter().copied())
        && film
        && flows
}

proptest! {
    #![proptest_config(ProptestConfig { cases: ProptestConfig::default().cases.max(1000), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_gives_a_physical_vessel_or_a_message(text in texts(vessels())) {
        match vessel::read_vessel(&text, "x.toml") {
            Ok(vessel) => prop_assert!(vessel_is_physical(&vessel), "{text}"),
            Err(error) => {
                let message = error.to_string();
                prop_assert!(message.starts_with("x.toml:") && !message.contains('\n'), "{message}");
            }
        }
    }

    #[test]
    fn any_text_gives_a_physical_scenario_or_a_message(text in texts(scenarios())) {
        match scenario::read_scenario(&text, "x.toml", &scenario::presets::table) {
            Ok(scenario) => prop_assert!(scenario_is_physical(&scenario), "{text}"),
            Err(error) => {
                let message = error.to_string();
                let placed = message.starts_with("x.toml:") || message.starts_with("railway-week.csv:");
                prop_assert!(placed && !message.contains('\n'), "{message}");
            }
        }
    }

    #[test]
    fn any_table_gives_a_scenario_or_a_message(
        text in prop_oneof![
            (Just(super::TABLE), edits()).prop_map(|(text, edits)| mutated(text, &edits)),
            "[a-z_,0-9.\n\"#-]{0,200}",
        ]
    ) {
        let column = "air_csv = { file = 't.csv', column = 'air_degc' }";
        let document = super::SCENARIO.replace("air_degc = 21", column);
        match scenario::read_scenario(&document, "x.toml", &|_| Ok(text.clone())) {
            Ok(scenario) => prop_assert!(scenario_is_physical(&scenario), "{text}"),
            Err(error) => prop_assert!(error.to_string().contains("t.csv:") || error.to_string().contains("x.toml:")),
        }
    }
}
