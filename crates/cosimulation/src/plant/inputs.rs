//! What a master sets of a plant, and the scenario of a step that it makes.
use cylwatch_thermal::flow::{Flow, FlowKind, Source};
use cylwatch_thermal::scenario::{AxialVariation, Initial, OutsideFilm, Scenario, Series, Sun, Surroundings};
use cylwatch_thermal::simulate::SimulationSettings;
use cylwatch_thermal::units::{ATMOSPHERE_PA, QUOTED_K};
use cylwatch_thermal::vessel::{Fill, GasResolution};

use super::{CompiledPlant, FilmInputs};
use crate::variable::{Causality, Unit, Variable};

/// Discharge coefficient of a leak's bore, that of a scenario's orifice that states none.
const DISCHARGE_COEFFICIENT: f64 = 0.8;
/// Temperatures that a scenario may have, K.
const TEMPERATURES_K: (f64, f64) = (60.0, 1500.0);
/// Differences of them, K.
const DIFFERENCES_K: (f64, f64) = (-300.0, 300.0);
/// Pressures that a scenario may have, Pa.
const PRESSURES_PA: (f64, f64) = (1.0, 2e8);
/// Mass flows that a scenario may have, kg/s.
const FLOWS_KG_S: (f64, f64) = (0.0, 100.0);

/// Parameters and inputs of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InputOf {
    FillPressure,
    FillTemperature,
    FillMass,
    StartPressure,
    StartTemperature,
    RelativeTolerance,
    Air,
    Wind,
    RadiationDifference,
    Film,
    Irradiance,
    Leak,
    LeakBore,
    Refill,
    RefillTemperature,
    RefillPressure,
}

/// Those that a plant has.
pub(super) fn inputs(plant: &CompiledPlant) -> Vec<InputOf> {
    use InputOf::*;
    let mut inputs = match plant.fill {
        Fill::Settled { .. } => vec![FillPressure, FillTemperature],
        Fill::Mass { .. } => vec![FillMass],
        Fill::Pressure { .. } => vec![StartPressure],
    };
    inputs.extend([StartTemperature, RelativeTolerance, Air]);
    match plant.film {
        FilmInputs::Wind => inputs.extend([Wind, RadiationDifference]),
        FilmInputs::Coefficient => inputs.push(Film),
    }
    inputs.extend([Irradiance, Leak, LeakBore]);
    // No model of gas in layers holds while it is filled.
    if !matches!(plant.vessel.gas, GasResolution::Stratified(gas) if gas.cells > 1) {
        inputs.extend([Refill, RefillTemperature, RefillPressure]);
    }
    inputs
}

impl InputOf {
    /// Its variable.
    pub(super) fn variable(self, plant: &CompiledPlant) -> Variable {
        let (pressure_pa, temperature_k, mass_kg) = match plant.fill {
            Fill::Settled { pressure_pa, temperature_k } => (pressure_pa, temperature_k, 0.0),
            Fill::Pressure { pressure_pa } => (pressure_pa, QUOTED_K, 0.0),
            Fill::Mass { mass_kg } => (ATMOSPHERE_PA, QUOTED_K, mass_kg),
        };
        let parameter =
            |words, unit, start, range| Variable::settable(Causality::Parameter, words, unit, start, range);
        let input =
            |words, unit, start, range| Variable::settable(Causality::Input, words, unit, start, range);
        match self {
            Self::FillPressure => {
                let words =
                    ("fill_pressure_pa", "Absolute pressure of the fill, settled at fill_temperature_k");
                parameter(words, Unit::Pascal, pressure_pa, PRESSURES_PA)
            }
            Self::FillTemperature => {
                let words =
                    ("fill_temperature_k", "Temperature of gas and wall to which fill_pressure_pa belongs");
                parameter(words, Unit::Kelvin, temperature_k, TEMPERATURES_K)
            }
            Self::FillMass => parameter(("fill_mass_kg", "Gas mass"), Unit::Kilogram, mass_kg, (1e-9, 1e5)),
            Self::StartPressure => {
                let words = ("start_pressure_pa", "Absolute pressure at the start, at start_temperature_k");
                parameter(words, Unit::Pascal, pressure_pa, PRESSURES_PA)
            }
            Self::StartTemperature => {
                let words = ("start_temperature_k", "Temperature of gas, wall and valve at the start");
                parameter(words, Unit::Kelvin, QUOTED_K, TEMPERATURES_K)
            }
            Self::RelativeTolerance => {
                let start = SimulationSettings::default().relative_tolerance;
                let words = ("relative_tolerance", "Relative tolerance of the solver");
                parameter(words, Unit::One, start, (1e-13, 1e-2))
            }
            Self::Air => input(("air_k", "Air temperature"), Unit::Kelvin, QUOTED_K, TEMPERATURES_K),
            Self::Wind => {
                input(("wind_m_s", "Wind across the axis"), Unit::MetrePerSecond, 0.0, (0.0, 200.0))
            }
            Self::RadiationDifference => {
                let words = (
                    "radiation_difference_k",
                    "Temperature that the surface radiates to, minus that of the air",
                );
                input(words, Unit::KelvinDifference, 0.0, DIFFERENCES_K)
            }
            Self::Film => {
                let words = ("film_w_m2_k", "Film coefficient outside, radiation included");
                input(words, Unit::WattPerSquareMetreKelvin, 10.0, (0.0, 1e4))
            }
            Self::Irradiance => {
                let words = ("irradiance_w_m2", "Irradiance of the sun, normal to its rays");
                input(words, Unit::WattPerSquareMetre, 0.0, (0.0, 2000.0))
            }
            Self::Leak => input(("leak_kg_s", "Mass flow out"), Unit::KilogramPerSecond, 0.0, FLOWS_KG_S),
            Self::LeakBore => {
                let words =
                    ("leak_bore_m", "Bore of a hole to the atmosphere, discharge coefficient 0.8; 0: none");
                input(words, Unit::Metre, 0.0, (0.0, 0.1))
            }
            Self::Refill => input(("refill_kg_s", "Mass flow in"), Unit::KilogramPerSecond, 0.0, FLOWS_KG_S),
            Self::RefillTemperature => {
                let words = ("refill_source_k", "Temperature of the source of the mass flow in");
                input(words, Unit::Kelvin, QUOTED_K, TEMPERATURES_K)
            }
            Self::RefillPressure => {
                let words = ("refill_source_pa", "Absolute pressure of the source of the mass flow in");
                input(words, Unit::Pascal, 200e5, PRESSURES_PA)
            }
        }
    }

    fn value_of(self, inputs: &[Self], values: &[f64]) -> Option<f64> {
        let place = inputs.iter().position(|input| *input == self)?;
        values.get(place).copied()
    }

    /// Its value; 0 where a plant does not have it.
    pub(super) fn value(self, inputs: &[Self], values: &[f64]) -> f64 {
        self.value_of(inputs, values).unwrap_or(0.0)
    }
}

/// The scenario of a step of so many seconds.
pub(super) fn step(inputs: &[InputOf], values: &[f64], duration_s: f64) -> Scenario {
    let value = |input: InputOf| input.value(inputs, values);
    let held = |input: InputOf| Series::constant(value(input));
    let given = |input: InputOf| input.value_of(inputs, values);
    let fill = match (given(InputOf::FillMass), given(InputOf::StartPressure)) {
        (Some(mass_kg), _) => Fill::Mass { mass_kg },
        (_, Some(pressure_pa)) => Fill::Pressure { pressure_pa },
        _ => Fill::Settled {
            pressure_pa: value(InputOf::FillPressure),
            temperature_k: value(InputOf::FillTemperature),
        },
    };
    let start_k = value(InputOf::StartTemperature);
    let film = match given(InputOf::Film) {
        Some(film) => OutsideFilm::Coefficient { film_w_m2_k: Series::constant(film) },
        None => OutsideFilm::Convection { wind_m_s: held(InputOf::Wind), multiplier: 1.0 },
    };
    let difference_k = given(InputOf::RadiationDifference);
    Scenario {
        name: "step".to_owned(),
        initial: Initial { fill, wall_temperature_k: start_k, gas_temperature_k: start_k },
        surroundings: Surroundings {
            air_k: held(InputOf::Air),
            film,
            radiation_k: difference_k
                .map(|difference_k| Series::constant(value(InputOf::Air) + difference_k)),
            sun: Some(Sun {
                irradiance_w_m2: held(InputOf::Irradiance),
                from_fraction: 0.0,
                to_fraction: 1.0,
                valve: true,
            }),
            axial: AxialVariation::default(),
        },
        flows: flows(&value),
        pressure_limits_pa: Vec::new(),
        sensors: Vec::new(),
        duration_s,
        sample_time_s: duration_s,
    }
}

/// The flows that are not zero.
fn flows(value: &dyn Fn(InputOf) -> f64) -> Vec<Flow> {
    let held = |input| Series::constant(value(input));
    let mut flows = Vec::new();
    if value(InputOf::Leak) > 0.0 {
        flows.push(Flow::open("leak", FlowKind::LeakSeries { mass_flow_kg_s: held(InputOf::Leak) }));
    }
    if value(InputOf::LeakBore) > 0.0 {
        let kind = FlowKind::Orifice {
            diameter_m: value(InputOf::LeakBore),
            discharge_coefficient: DISCHARGE_COEFFICIENT,
            back_pressure_pa: ATMOSPHERE_PA,
        };
        flows.push(Flow::open("hole", kind));
    }
    if value(InputOf::Refill) > 0.0 {
        let source = Source::Supply {
            temperature_k: held(InputOf::RefillTemperature),
            pressure_pa: held(InputOf::RefillPressure),
        };
        let mass_flow_kg_s = held(InputOf::Refill);
        flows.push(Flow::open(
            "refill",
            FlowKind::RefillSeries { mass_flow_kg_s, source, inlet_diameter_m: None },
        ));
    }
    flows
}
