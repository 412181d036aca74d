//! Temperature of a surface between a wall node and its film.
//!
//! The surface stores no heat, so the flow through the half cell equals the flow into the film:
//! `G (T_node - T_s) = Q(T_s)`. `Q` increases with `T_s` for every film here, so the root is unique and
//! Newton's method from the node's side converges; the half cell dominates in metal, the film in plastic liners. A film costs a density and two
//! transport properties or their interpolation, so each evaluation gives as many derivatives as it has: [`FilmSeries`].

/// Iterations after which the surface temperature counts as found; metal takes two, plastic five.
const MAX_ITERATIONS: usize = 40;
/// A step below which the film is taken as linear, K: its curvature then changes the heat by less than 1e-10.
pub(crate) const LAST_STEP_K: f64 = 1e-6;
/// Steps by the series alone, with one slope: each leaves a five hundredth of the error behind plastic and less behind metal.
#[cfg(feature = "simulate")]
const CHORDS: usize = 3;

/// A surface in balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurfaceBalance {
    /// Surface temperature, K.
    pub surface_k: f64,
    /// Heat flow from the node through the surface, W.
    pub heat_w: f64,
    /// Derivative of the heat flow with the node's temperature, W/K.
    pub heat_per_node_k: f64,
    /// Factor `G / (G + dQ/dT_s)` by which a partial derivative of the film's heat flow at fixed surface
    /// temperature becomes one at fixed node temperature.
    pub film_factor: f64,
}

/// A half cell between a wall node and its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HalfCell {
    /// Temperature of the node, K.
    pub node_k: f64,
    /// Conductance at that temperature, W/K.
    pub conductance_w_k: f64,
    /// Change of the conductance with the node's temperature, W/K².
    pub conductance_slope_w_k2: f64,
}

/// Heat flow of a film as a Taylor series in the surface temperature.
#[cfg(feature = "simulate")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FilmSeries {
    /// Heat flow from the surface, W, and its first four derivatives with the surface temperature.
    pub heat_w: [f64; 5],
    /// Within so many kelvins it gives the heat flow as well as the film itself does.
    pub holds_k: f64,
}

#[cfg(feature = "simulate")]
impl FilmSeries {
    /// A film that is linear.
    pub(crate) fn linear(heat_w: f64, slope_w_k: f64) -> Self {
        Self { heat_w: [heat_w, slope_w_k, 0.0, 0.0, 0.0], holds_k: f64::INFINITY }
    }

    /// A film of which no more than its slope is known.
    pub(crate) fn first_order(heat_w: f64, slope_w_k: f64) -> Self {
        Self { heat_w: [heat_w, slope_w_k, 0.0, 0.0, 0.0], holds_k: LAST_STEP_K }
    }

    /// Adds another film, so many times.
    pub(crate) fn add(&mut self, times: f64, other: &Self) {
        for (sum, value) in self.heat_w.iter_mut().zip(other.heat_w) {
            *sum += times * value;
        }
        self.holds_k = self.holds_k.min(other.holds_k);
    }

    fn is_linear(&self) -> bool {
        self.heat_w[2..] == [0.0; 3]
    }

    /// Heat flow and slope at a distance, K.
    fn at(&self, x: f64) -> (f64, f64) {
        let [heat, first, second, third, fourth] = self.heat_w;
        let (second, third, fourth) = (second / 2.0, third / 6.0, fourth / 24.0);
        (
            heat + x * (first + x * (second + x * (third + x * fourth))),
            first + x * (2.0 * second + x * (3.0 * third + x * 4.0 * fourth)),
        )
    }
}

/// Solve the balance of a half cell and a film that is given about any surface temperature. Behind metal one expansion about the node is enough.
#[cfg(feature = "simulate")]
pub(crate) fn solve_surface(half: &HalfCell, film: impl Fn(f64) -> FilmSeries) -> SurfaceBalance {
    let &HalfCell { node_k, conductance_w_k, .. } = half;
    let mut surface_k = node_k;
    let (mut heat_w, mut slope) = (0.0, 0.0);
    for _ in 0..MAX_ITERATIONS {
        let series = film(surface_k);
        let driving_k = node_k - surface_k;
        [heat_w, slope, ..] = series.heat_w;
        let per_w = 1.0 / (conductance_w_k + slope);
        let mut step = (conductance_w_k * driving_k - heat_w) * per_w;
        if step.abs() <= series.holds_k {
            if !series.is_linear() {
                for _ in 0..CHORDS {
                    step += (conductance_w_k * (driving_k - step) - series.at(step).0) * per_w;
                }
            }
            (heat_w, slope) = series.at(step);
            surface_k += step;
            break;
        }
        surface_k += step;
    }
    balance(half, surface_k, heat_w, slope)
}

/// As [`solve_surface`] by Newton's method, started at a known surface temperature, K; `film` may return something beside heat flow and slope
/// (W, W/K), and what it returned last, within 1 µK of the solution, comes back.
pub(crate) fn solve_surface_from<T>(
    half: &HalfCell,
    start_k: f64,
    film: impl Fn(f64) -> (f64, f64, T),
) -> (SurfaceBalance, T) {
    let &HalfCell { node_k, conductance_w_k, .. } = half;
    let mut surface_k = start_k;
    let (mut heat_w, mut slope, mut beside) = film(surface_k);
    for _ in 0..MAX_ITERATIONS {
        let step = (conductance_w_k * (node_k - surface_k) - heat_w) / (conductance_w_k + slope);
        surface_k += step;
        if step.abs() <= LAST_STEP_K {
            heat_w += slope * step;
            break;
        }
        (heat_w, slope, beside) = film(surface_k);
    }
    (balance(half, surface_k, heat_w, slope), beside)
}

/// The balance at a surface temperature, heat flow and slope of the film there.
fn balance(half: &HalfCell, surface_k: f64, heat_w: f64, slope: f64) -> SurfaceBalance {
    let HalfCell { node_k, conductance_w_k, conductance_slope_w_k2 } = *half;
    let film_factor = conductance_w_k / (conductance_w_k + slope);
    let node_factor = conductance_w_k + conductance_slope_w_k2 * (node_k - surface_k);
    let heat_per_node_k = slope / (conductance_w_k + slope) * node_factor;
    SurfaceBalance { surface_k, heat_w, heat_per_node_k, film_factor }
}

#[cfg(all(test, feature = "simulate"))]
mod tests {
    use super::*;

    fn half(conductance_w_k: f64, node_k: f64) -> HalfCell {
        HalfCell { node_k, conductance_w_k, conductance_slope_w_k2: 0.0 }
    }

    #[test]
    fn linear_film_gives_the_series_conductance() {
        let balance = solve_surface(&half(3.0, 300.0), |t| FilmSeries::linear(2.0 * (t - 290.0), 2.0));
        approx::assert_relative_eq!(balance.heat_w, 10.0 / (1.0 / 3.0 + 1.0 / 2.0), max_relative = 1e-12);
        approx::assert_relative_eq!(balance.surface_k, 296.0, max_relative = 1e-12);
        approx::assert_relative_eq!(balance.heat_per_node_k, 1.2, max_relative = 1e-12);
    }

    #[test]
    fn stiff_natural_convection_converges_behind_a_poor_conductor() {
        let film = |t: f64| {
            let theta = t - 250.0;
            let s = (theta * theta + 1e-4).powf(1.0 / 6.0);
            let slope = 200.0 * s * (1.0 + theta * theta / (3.0 * (theta * theta + 1e-4)));
            FilmSeries::first_order(200.0 * s * theta, slope)
        };
        let balance = solve_surface(&half(0.5, 320.0), film);
        approx::assert_relative_eq!(balance.heat_w, 0.5 * (320.0 - balance.surface_k), max_relative = 1e-9);
    }
}
