//! What acts on the cylinder at one instant, and its linear pieces between two edges of the scenario.
use crate::scenario::series::LinearPiece;
use crate::scenario::{OutsideFilm, Scenario};

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

/// Surroundings at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
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
    /// Whether any signal differs by more than the rounding of a linear piece.
    pub(crate) fn jumped_from(&self, before: &Self) -> bool {
        let signals = |inputs: &Self| {
            let (film, multiplier) = match inputs.film {
                FilmInput::Coefficient(film) => (film, 1.0),
                FilmInput::Convection { wind_m_s, multiplier } => (wind_m_s, multiplier),
            };
            let radiation_k = inputs.radiation_k.unwrap_or(0.0);
            [inputs.air_k, film, multiplier, radiation_k, inputs.irradiance_w_m2, inputs.air_difference_k]
        };
        signals(self)
            .iter()
            .zip(signals(before))
            .any(|(a, b)| (a - b).abs() > JUMP_TOLERANCE * (1.0 + a.abs()))
    }
}

/// The surroundings between two edges, every signal linear in time.
#[derive(Clone, Copy, Debug)]
pub struct InputPieces {
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
    edges.retain(|&t| t > 0.0 && t < scenario.duration_s);
    edges.push(scenario.duration_s);
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}
