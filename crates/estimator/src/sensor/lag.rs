//! First-order lag of a sensor: `tau dy_l/dt = y - y_l`, solved exactly while `y` is linear in time.
//!
//! From `y_0` to `y_1` within `dt`, with `x = dt / tau` and `phi = (1 - exp(-x)) / x`:
//!
//! ```text
//! y_l(dt) = exp(-x) y_l(0) + (phi - exp(-x)) y_0 + (1 - phi) y_1
//! ```
//!
//! The three weights add to 1. They are the derivatives that a filter with a state for `y_l` needs.

/// A first-order lag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstOrderLag {
    /// Time constant, s; 0: the output is the input.
    pub tau_s: f64,
}

/// Weights of the lagged reading after an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LagWeights {
    /// Of the lagged reading before.
    pub before: f64,
    /// Of the static reading at the start.
    pub start: f64,
    /// Of the static reading at the end.
    pub end: f64,
}

impl FirstOrderLag {
    /// Weights for an interval of `dt_s >= 0`.
    pub(crate) fn weights(&self, dt_s: f64) -> LagWeights {
        if self.tau_s <= 0.0 {
            return LagWeights { before: 0.0, start: 0.0, end: 1.0 };
        }
        if dt_s <= 0.0 {
            return LagWeights { before: 1.0, start: 0.0, end: 0.0 };
        }
        let x = dt_s / self.tau_s;
        let before = (-x).exp();
        let phi = -(-x).exp_m1() / x;
        LagWeights { before, start: phi - before, end: 1.0 - phi }
    }

    /// Lagged reading after `dt_s` in which the static one went linearly from `start` to `end`.
    pub fn advance(&self, lagged: f64, start: f64, end: f64, dt_s: f64) -> f64 {
        let LagWeights { before, start: w0, end: w1 } = self.weights(dt_s);
        before * lagged + w0 * start + w1 * end
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    const LAG: FirstOrderLag = FirstOrderLag { tau_s: 20.0 };

    #[test]
    fn after_a_step_it_has_gone_632_thousandths_in_one_time_constant_and_95_percent_in_three() {
        // 1 - 1/e and 1 - 1/e^3, as tables print them.
        assert_relative_eq!(LAG.advance(0.0, 1.0, 1.0, 20.0), 0.632_120_558_828_557_7, max_relative = 1e-14);
        assert_relative_eq!(LAG.advance(0.0, 1.0, 1.0, 60.0), 0.950_212_931_632_136, max_relative = 1e-14);
    }

    #[test]
    fn in_a_ramp_it_follows_one_time_constant_behind() {
        // Long after the start of y = 0.01 t the lagged reading is 0.01 (t - tau).
        let t_s = 2_000.0;
        assert_relative_eq!(
            LAG.advance(0.0, 0.0, 0.01 * t_s, t_s),
            0.01 * (t_s - 20.0),
            max_relative = 1e-14
        );
    }

    #[test]
    fn irregular_pieces_of_a_ramp_give_the_closed_form_of_the_whole() {
        // From rest, y = r t gives r (t - tau (1 - exp(-t/tau))).
        let (rate, mut t, mut lagged) = (0.03, 0.0, 0.0);
        for dt in [0.1, 7.0, 0.013, 31.0, 2.5, 60.0, 1e-6] {
            lagged = LAG.advance(lagged, rate * t, rate * (t + dt), dt);
            t += dt;
        }
        assert_relative_eq!(lagged, rate * (t - 20.0 * (1.0 - (-t / 20.0_f64).exp())), max_relative = 1e-12);
    }

    /// Dense reference: Runge-Kutta of fourth order in 20 000 steps.
    #[test]
    fn one_long_interval_agrees_with_a_dense_integration() {
        let (tau, start, end, dt) = (13.0, 4.0, -2.0, 50.0);
        let (steps, mut y) = (20_000, 9.0);
        let h = dt / f64::from(steps);
        let rate = |t: f64, y: f64| (start + (end - start) * t / dt - y) / tau;
        for k in 0..steps {
            let t = h * f64::from(k);
            let k1 = rate(t, y);
            let k2 = rate(t + 0.5 * h, y + 0.5 * h * k1);
            let k3 = rate(t + 0.5 * h, y + 0.5 * h * k2);
            let k4 = rate(t + h, y + h * k3);
            y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
        let exact = FirstOrderLag { tau_s: tau }.advance(9.0, start, end, dt);
        assert_relative_eq!(exact, y, max_relative = 1e-12);
    }

    #[test]
    fn without_lag_the_reading_is_the_static_one() {
        assert_eq!(FirstOrderLag { tau_s: 0.0 }.advance(3.0, 1.0, 2.0, 5.0), 2.0);
        assert_eq!(LAG.advance(3.0, 1.0, 2.0, 0.0), 3.0);
    }

    proptest! {
        #[test]
        fn weights_add_to_one_and_none_is_negative(tau_s in 1e-3..1e5_f64, dt_s in 0.0..1e6_f64) {
            let w = FirstOrderLag { tau_s }.weights(dt_s);
            prop_assert!((w.before + w.start + w.end - 1.0).abs() < 1e-14);
            prop_assert!(w.before >= 0.0 && w.start >= -1e-15 && w.end >= -1e-15);
        }
    }
}
