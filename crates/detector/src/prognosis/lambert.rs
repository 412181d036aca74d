//! Lambert's function: when an exponential loss has come to a limit.
//!
//! Source: R. M. Corless et al., Adv. Comput. Math. 5 (1996) 329.

/// `w >= 0` with `w exp(w) = x`, for `x >= 0`; NaN for a negative `x`.
pub fn lambert_w(x: f64) -> f64 {
    if x.is_nan() || x < 0.0 {
        return f64::NAN;
    }
    if x == 0.0 || x == f64::INFINITY {
        return x;
    }
    // Halley's steps on w - x exp(-w), where nothing overflows, from a start that is right to the second order at 0.
    let mut w = libm::log1p(x);
    w *= 1.0 - libm::log1p(w) / (2.0 + w);
    for _ in 0..20 {
        let excess = w - x * libm::exp(-w);
        let step = excess / (1.0 + w - 0.5 * (w + 2.0) * excess / (1.0 + w));
        w -= step;
        if step.abs() <= 1e-15 * w.abs() {
            break;
        }
    }
    w
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn known_values_and_the_inverse() {
        assert_relative_eq!(lambert_w(1.0), 0.567_143_290_409_783_8, max_relative = 1e-15);
        assert_relative_eq!(lambert_w(std::f64::consts::E), 1.0, max_relative = 1e-15);
        for w in [1e-300, 1e-12, 0.01, 0.2, 0.9, 3.0, 20.0, 300.0, 690.0] {
            assert_relative_eq!(lambert_w(w * f64::exp(w)), w, max_relative = 1e-14);
        }
        assert_eq!(lambert_w(0.0), 0.0);
        assert!(lambert_w(-0.1).is_nan() && lambert_w(f64::NAN).is_nan());
    }
}
