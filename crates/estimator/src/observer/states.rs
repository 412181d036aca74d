//! The observer's state vector: what each entry is.
//!
//! `x = [T_w,1 .. T_w,N | T_valve | T_gas | m | r | T_air | o | sun | sensor lags || i | c | s | b_v | sensor parameters]`
//!
//! with the leak rate `r` and the logarithms `o, i, c` of the multipliers on outside film, inside film and capacity,
//! the change `s` of the outside film along the axis, and the departure `b_v` of the valve's part of the sun.
//! What stands behind the double bar is constant but for slow walks ([`crate::filter::StateSpace::leading`]). A
//! quantity that the settings declare known has no state.
use alloc::string::String;
use alloc::vec::Vec;
use core::ops::Range;

use crate::sensor::{ParameterKind, Sensor};
use crate::thermal::reduced::ReducedModel;

use super::settings::{ObserverSettings, Walk};

/// What a state is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StateKind {
    /// Temperature of a wall node, counted from the bottom, K.
    Wall(usize),
    /// Valve temperature, K.
    Valve,
    /// Mean gas temperature, K.
    Gas,
    /// Gas mass, kg.
    Mass,
    /// Leak rate, kg/s.
    Leak,
    /// Temperature of the surroundings, K.
    Air,
    /// Logarithm of the outside film's multiplier.
    OutsideFilm,
    /// Sun on the upper quarter of the wall, W.
    Sun,
    /// Reading behind the lag of a sensor, K or Pa.
    Lag {
        /// Index of the sensor.
        sensor: usize,
    },
    /// Logarithm of the inside film's multiplier.
    InsideFilm,
    /// Logarithm of the multiplier on the heat capacity of wall and valve.
    Capacity,
    /// Change of the outside film from bottom to top, relative.
    FilmSlope,
    /// Departure of the valve's part of the sun from the usual one.
    ValveSun,
    /// A parameter of a sensor, in the unit of its kind.
    Parameter {
        /// Index of the sensor.
        sensor: usize,
        /// Index among the sensor's parameters.
        parameter: usize,
    },
}

/// Indices of the states.
#[derive(Clone, Debug, PartialEq)]
pub struct States {
    /// What each state is.
    pub kinds: Vec<StateKind>,
    /// Name of each state, stable between runs: `gas_k`, `shoulder.offset_k`, ...
    pub names: Vec<String>,
    /// Number of leading states.
    pub leading: usize,
    /// Wall nodes.
    pub wall: usize,
    /// Valve temperature.
    pub valve: Option<usize>,
    /// Gas temperature.
    pub gas: usize,
    /// Gas mass.
    pub mass: usize,
    /// Leak rate.
    pub leak: usize,
    /// Temperature of the surroundings.
    pub air: usize,
    /// Outside film.
    pub outside: Option<usize>,
    /// Sun.
    pub sun: Option<usize>,
    /// Inside film.
    pub inside: Option<usize>,
    /// Heat capacity.
    pub capacity: Option<usize>,
    /// Change of the outside film along the axis.
    pub slope: Option<usize>,
    /// Part of the sun on the valve.
    pub valve_sun: Option<usize>,
    /// Lag state of each sensor.
    pub lag: Vec<Option<usize>>,
    /// State of each parameter of each sensor.
    pub parameters: Vec<Vec<Option<usize>>>,
}

impl States {
    /// The state of a sensor's offset, if it has one.
    pub(crate) fn offset_of(&self, sensor: usize, sensors: &[Sensor]) -> Option<usize> {
        let parameters = sensors.get(sensor)?.parameters();
        let offset = parameters.iter().position(|parameter| parameter.kind == ParameterKind::Offset)?;
        self.parameters[sensor][offset]
    }

    /// The states that a model, its sensors and the settings ask for.
    pub(crate) fn new(model: &ReducedModel, sensors: &[Sensor], settings: &ObserverSettings) -> Self {
        let mut kinds: Vec<StateKind> = (0..model.wall_nodes()).map(StateKind::Wall).collect();
        let push = |kinds: &mut Vec<StateKind>, kind: StateKind| {
            kinds.push(kind);
            kinds.len() - 1
        };
        let uncertain = |kinds: &mut Vec<StateKind>, walk: &Walk, kind: StateKind| {
            (!walk.is_known()).then(|| push(kinds, kind))
        };
        let valve = model.valve_index().map(|_| push(&mut kinds, StateKind::Valve));
        let gas = push(&mut kinds, StateKind::Gas);
        let mass = push(&mut kinds, StateKind::Mass);
        let leak = push(&mut kinds, StateKind::Leak);
        let air = push(&mut kinds, StateKind::Air);
        let outside = uncertain(&mut kinds, &settings.ln_outside_film, StateKind::OutsideFilm);
        let sun = uncertain(&mut kinds, &settings.sun, StateKind::Sun);
        let lag = sensors
            .iter()
            .enumerate()
            .map(|(sensor, s)| (s.lag_s() > 0.0).then(|| push(&mut kinds, StateKind::Lag { sensor })))
            .collect();
        let leading = kinds.len();
        let inside = uncertain(&mut kinds, &settings.ln_inside_film, StateKind::InsideFilm);
        let capacity = uncertain(&mut kinds, &settings.ln_capacity, StateKind::Capacity);
        let slope = uncertain(&mut kinds, &settings.film_slope, StateKind::FilmSlope);
        let valve_sun =
            valve.and(sun).and_then(|_| uncertain(&mut kinds, &settings.valve_sun, StateKind::ValveSun));
        let parameters = sensors
            .iter()
            .enumerate()
            .map(|(sensor, s)| {
                let state = |(parameter, p): (usize, &crate::sensor::Parameter)| {
                    (p.sd > 0.0 || p.walk_per_sqrt_s > 0.0)
                        .then(|| push(&mut kinds, StateKind::Parameter { sensor, parameter }))
                };
                s.parameters().iter().enumerate().map(state).collect()
            })
            .collect();
        let names = kinds.iter().map(|kind| name(kind, sensors)).collect();
        let wall = model.wall_nodes();
        Self {
            kinds,
            names,
            leading,
            wall,
            valve,
            gas,
            mass,
            leak,
            air,
            outside,
            sun,
            inside,
            capacity,
            slope,
            valve_sun,
            lag,
            parameters,
        }
    }

    /// States that belong to the cylinder and its sensors, not to the moment.
    pub(crate) fn constants(&self) -> Range<usize> {
        self.leading..self.count()
    }

    /// Number of states.
    pub(crate) fn count(&self) -> usize {
        self.kinds.len()
    }
}

fn name(kind: &StateKind, sensors: &[Sensor]) -> String {
    match kind {
        StateKind::Wall(node) => format!("wall_{}_k", node + 1),
        StateKind::Valve => "valve_k".into(),
        StateKind::Gas => "gas_k".into(),
        StateKind::Mass => "mass_kg".into(),
        StateKind::Leak => "leak_kg_s".into(),
        StateKind::Air => "air_k".into(),
        StateKind::OutsideFilm => "ln_outside_film".into(),
        StateKind::Sun => "sun_w".into(),
        StateKind::InsideFilm => "ln_inside_film".into(),
        StateKind::Capacity => "ln_capacity".into(),
        StateKind::FilmSlope => "film_slope".into(),
        StateKind::ValveSun => "valve_sun".into(),
        StateKind::Lag { sensor } => format!("{}.lagged", sensors[*sensor].name),
        StateKind::Parameter { sensor, parameter } => {
            let sensor = &sensors[*sensor];
            let kind = match sensor.parameters()[*parameter].kind {
                ParameterKind::Offset => match sensor.quantity() {
                    crate::log::Quantity::Temperature => "offset_k",
                    crate::log::Quantity::Pressure => "offset_pa",
                },
                ParameterKind::Coupling => "coupling",
                ParameterKind::TemperatureCoefficient => "temperature_coefficient_pa_k",
                ParameterKind::Span => "span",
            };
            format!("{}.{kind}", sensor.name)
        }
    }
}
