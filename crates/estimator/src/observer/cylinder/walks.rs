//! How states walk, and how far they may.
use super::super::settings::Walk;
use super::super::states::StateKind;
use super::Cylinder;
use super::transition::Walking;
use crate::filter::SlowProcess;
use crate::sensor::ParameterKind;

/// Least film outside, by radiation alone, and the largest, in a gale, W/(m² K).
const LEAST_FILM_W_M2_K: f64 = 4.0;
const LARGEST_FILM_W_M2_K: f64 = 80.0;
/// Bound on the logarithm of the inside film's multiplier.
const LN_INSIDE_BOUND: f64 = 1.5;
/// Bounds on constants of the model and of sensors about the means of their priors, in standard deviations of the prior:
/// coloured model error would carry a combination that the data do not tell apart further and further. What walks away from
/// its prior by itself, such as a transmitter that drifts, has none, and an offset that may have changed as much more. One sensor of 16 000 is beyond four of them; beyond three it was one of 370, and a
/// cylinder whose transmitter was one leaked for ever.
const BOUND_SD: f64 = 4.0;

/// How a constant moves.
pub(super) fn slow_process(cylinder: &Cylinder, state: usize) -> SlowProcess {
    let Cylinder { settings, sensors, states, .. } = cylinder;
    let of = |walk: &Walk, rest| SlowProcess {
        intensity: walk.per_sqrt_s * walk.per_sqrt_s,
        decay_per_s: walk.decay_per_s(),
        rest,
    };
    match &states.kinds[state] {
        StateKind::InsideFilm => of(&settings.ln_inside_film, 0.0),
        StateKind::Capacity => of(&settings.ln_capacity, 0.0),
        StateKind::FilmSlope => of(&settings.film_slope, 0.0),
        StateKind::ValveSun => of(&settings.valve_sun, 0.0),
        StateKind::Parameter { sensor, parameter } => {
            let parameter = &sensors[*sensor].parameters()[*parameter];
            let walk = settings.walk_of(parameter, sensors[*sensor].quantity());
            of(&walk, parameter.mean)
        }
        _ => SlowProcess::default(),
    }
}

impl Cylinder {
    pub(super) fn set_bounds(&mut self) {
        let mut bounds = core::mem::take(&mut self.bounds);
        bounds.clear();
        let of = |state| self.bounds_of(state).map(|(low, high)| (state, low, high));
        bounds.extend((0..self.states.count()).filter_map(of));
        self.bounds = bounds;
    }

    /// What each sensor's offset may have changed by since it was new, standard deviation: it is held within as much more.
    pub(crate) fn set_loosened(&mut self, loosened: &[f64]) {
        if self.loosened != loosened {
            self.loosened.copy_from_slice(loosened);
            self.set_bounds();
        }
    }

    fn bounds_of(&self, state: usize) -> Option<(f64, f64)> {
        let film_w_m2_k = self.settings.film_w_m2_k;
        match &self.states.kinds[state] {
            StateKind::OutsideFilm => Some((
                libm::log(LEAST_FILM_W_M2_K / film_w_m2_k),
                libm::log(LARGEST_FILM_W_M2_K / film_w_m2_k),
            )),
            StateKind::InsideFilm => Some((-LN_INSIDE_BOUND, LN_INSIDE_BOUND)),
            StateKind::Capacity => within_prior(&self.settings.ln_capacity),
            StateKind::FilmSlope => within_prior(&self.settings.film_slope),
            StateKind::ValveSun => within_prior(&self.settings.valve_sun),
            StateKind::Parameter { sensor, parameter } => {
                let parameter = &self.sensors[*sensor].parameters()[*parameter];
                let (low, high) = parameter.domain();
                let changed =
                    if parameter.kind == ParameterKind::Offset { self.loosened[*sensor] } else { 0.0 };
                let (least, most) = match parameter.walk_per_sqrt_s {
                    0.0 => within(parameter.mean, BOUND_SD * libm::hypot(parameter.sd, changed)),
                    _ => (f64::NEG_INFINITY, f64::INFINITY),
                };
                Some((low.max(least), high.min(most)))
            }
            _ => None,
        }
    }

    pub(super) fn set_walks(&mut self) {
        let s = &self.settings;
        self.walking[self.states.air].rest = s.air_rest_k;
        for (i, kind) in self.states.kinds[..self.states.leading].iter().enumerate() {
            let (walk, decay_per_s) = match kind {
                StateKind::Wall(_) | StateKind::Valve => (s.temperature_walk_k_per_sqrt_s, 0.0),
                StateKind::Gas => (s.gas_walk_k_per_sqrt_s, 0.0),
                StateKind::Air => (s.air.per_sqrt_s, s.air.decay_per_s()),
                StateKind::OutsideFilm => (s.ln_outside_film.per_sqrt_s, s.ln_outside_film.decay_per_s()),
                StateKind::Sun => (s.sun.per_sqrt_s, s.sun.decay_per_s()),
                _ => continue,
            };
            self.walking[i] = Walking { intensity: walk * walk, decay_per_s, ..self.walking[i] };
        }
    }
}

/// Bounds of a constant of the model whose prior has the mean 0, unless its walk leads away from the prior.
fn within_prior(walk: &Walk) -> Option<(f64, f64)> {
    walk.stays_within_prior().then(|| within(0.0, BOUND_SD * walk.prior_sd))
}

fn within(mean: f64, by: f64) -> (f64, f64) {
    (mean - by, mean + by)
}

#[cfg(test)]
mod tests;
