//! Roots of monotone functions of one variable.

const MAX_ITERATIONS: usize = 200;
/// Relative length of the last Newton step of all roots; the error after it is about its square.
const TOLERANCE: f64 = 1e-9;

/// Newton in a bracket for an increasing function given with its slope; `None` if it does not converge.
pub(super) fn bracketed_newton(
    mut low: f64,
    mut high: f64,
    start: f64,
    mut f: impl FnMut(f64) -> (f64, f64),
) -> Option<f64> {
    let mut x = start.clamp(low, high);
    for _ in 0..MAX_ITERATIONS {
        let (value, slope) = f(x);
        if !value.is_finite() {
            return None;
        }
        if value > 0.0 {
            high = x
        } else {
            low = x
        }
        let newton = x - value / slope;
        if slope > 0.0 && (newton - x).abs() <= TOLERANCE * x.abs() {
            return Some(newton);
        }
        let inside = slope > 0.0 && newton > low && newton < high;
        x = if inside { newton } else { 0.5 * (low + high) };
    }
    (high - low <= 1e-9 * high.abs()).then_some(x)
}
