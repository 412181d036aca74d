//! What acts on the cylinder at one instant, and its linear pieces between two edges of the scenario.
use crate::flow::Flow;
use crate::scenario::series::LinearPiece;
use crate::scenario::{OutsideFilm, Scenario, Series};

/// Relative difference above which a signal jumps at an edge: far above rounding, far below any effect.
const JUMP_TOLERANCE: f64 = 1e-9;

/// Outside film at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilmInput {
    /// Coefficient, W/(m² K).
    Coefficient(f64),
    /// Wind across the axis, m/s, and the multiplier on the film.
    Convection {
        /// Wind, m/s.
        wind_m_s: f64,
        /// Multiplier on the film.
        multiplier: f64,
    },
}

/// An instant between two edges of the scenario: it says which side of a jump a table of a flow is taken from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moment {
    /// Time, s.
    pub time_s: f64,
    /// The edges before and after it, s.
    pub between_s: (f64, f64),
}

impl Moment {
    /// Value of a series.
    pub(crate) fn value(&self, series: &Series) -> f64 {
        series.segment(self.between_s.0, self.between_s.1).at(self.time_s)
    }
}

/// Surroundings at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    /// When: flows may change with time.
    pub moment: Moment,
    /// Air temperature, K.
    pub air_k: f64,
    /// Outside film.
    pub film: FilmInput,
    /// Temperature that the surface radiates to, K.
    pub radiation_k: Option<f64>,
    /// Solar irradiance, W/m².
    pub irradiance_w_m2: f64,
    /// Air temperature at the top minus that at the bottom, K.
    pub air_difference_k: f64,
}

impl Inputs {
    /// Whether any signal, tables of flows included, differs by more than the rounding of a linear piece.
    pub(crate) fn jumped_from(&self, before: &Self, flows: &[Flow]) -> bool {
        let signals = |inputs: &Self| {
            let (film, multiplier) = match inputs.film {
                FilmInput::Coefficient(film) => (film, 1.0),
                FilmInput::Convection { wind_m_s, multiplier } => (wind_m_s, multiplier),
            };
            let radiation_k = inputs.radiation_k.unwrap_or(0.0);
            [inputs.air_k, film, multiplier, radiation_k, inputs.irradiance_w_m2, inputs.air_difference_k]
        };
        let differ = |a: f64, b: f64, scale: f64| (a - b).abs() > JUMP_TOLERANCE * (scale + a.abs());
        // Mass flows are small numbers: 1e-6 kg/s is a leak.
        let of_flows = || flows.iter().flat_map(|flow| flow.kind.series());
        signals(self).iter().zip(signals(before)).any(|(a, b)| differ(*a, b, 1.0))
            || of_flows().any(|series| differ(self.moment.value(series), before.moment.value(series), 1e-6))
    }
}

/// The surroundings between two edges, every signal linear in time.
#[derive(Clone, Copy, Debug)]
pub struct InputPieces {
    between_s: (f64, f64),
    air: LinearPiece,
    film: LinearPiece,
    multiplier: Option<f64>,
    radiation: Option<LinearPiece>,
    irradiance: Option<LinearPiece>,
    air_difference: Option<LinearPiece>,
}

impl InputPieces {
    /// The pieces on an interval without an edge in its inside.
    pub fn new(scenario: &Scenario, from_s: f64, to_s: f64) -> Self {
        let surroundings = &scenario.surroundings;
        let multiplier = match surroundings.film {
            OutsideFilm::Coefficient { .. } => None,
            OutsideFilm::Convection { multiplier, .. } => Some(multiplier),
        };
        Self {
            between_s: (from_s, to_s),
            air: surroundings.air_k.segment(from_s, to_s),
            film: surroundings.film.signal().segment(from_s, to_s),
            multiplier,
            radiation: surroundings.radiation_k.as_ref().map(|s| s.segment(from_s, to_s)),
            irradiance: surroundings.sun.as_ref().map(|sun| sun.irradiance_w_m2.segment(from_s, to_s)),
            air_difference: surroundings.axial.air_difference_k.as_ref().map(|s| s.segment(from_s, to_s)),
        }
    }

    /// Surroundings at a time in the interval, s.
    pub fn at(&self, t_s: f64) -> Inputs {
        let film = self.film.at(t_s);
        Inputs {
            moment: Moment { time_s: t_s, between_s: self.between_s },
            air_k: self.air.at(t_s),
            film: match self.multiplier {
                None => FilmInput::Coefficient(film),
                Some(multiplier) => FilmInput::Convection { wind_m_s: film, multiplier },
            },
            radiation_k: self.radiation.map(|piece| piece.at(t_s)),
            irradiance_w_m2: self.irradiance.map_or(0.0, |piece| piece.at(t_s)),
            air_difference_k: self.air_difference.map_or(0.0, |piece| piece.at(t_s)),
        }
    }
}

/// Times at which an input jumps or bends, or a flow may start or stop, s: increasing, inside `(0, duration)`,
/// with the duration as the last.
pub(crate) fn edges_s(scenario: &Scenario) -> Vec<f64> {
    let surroundings = &scenario.surroundings;
    let mut edges: Vec<f64> =
        surroundings.air_k.edges_s().chain(surroundings.film.signal().edges_s()).collect();
    edges.extend(surroundings.radiation_k.iter().flat_map(|s| s.edges_s()));
    edges.extend(surroundings.sun.iter().flat_map(|sun| sun.irradiance_w_m2.edges_s()));
    edges.extend(surroundings.axial.air_difference_k.iter().flat_map(|s| s.edges_s()));
    edges.extend(scenario.flows.iter().flat_map(|flow| [flow.start_s, flow.stop_s]));
    let of_flows = scenario.flows.iter().flat_map(|flow| flow.kind.series());
    edges.extend(of_flows.flat_map(|s| s.edges_s()));
    edges.retain(|&t| t > 0.0 && t < scenario.duration_s);
    edges.push(scenario.duration_s);
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}
