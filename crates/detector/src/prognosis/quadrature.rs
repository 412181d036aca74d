//! Adaptive quadrature, for integrands that step somewhere between the bounds.
//!
//! Kronrod's 15 points with Gauss's 7 inside them; the interval is halved until both agree.
//!
//! Source: R. Piessens et al., QUADPACK, 1983 (points and weights).

/// Kronrod's points in `[0, 1]`, from outside; every second one is Gauss's.
const POINTS: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_5,
    0.0,
];
/// Kronrod's weights.
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_22,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_2,
    0.140_653_259_715_525_9,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_8,
];
/// Gauss's weights at the second, fourth, sixth and eighth point.
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_7, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];
/// Deepest halving: a jump of the integrand is found to 1e-12 of the interval.
const DEEPEST: u32 = 40;

/// `int_low^high f` to an absolute tolerance.
pub(super) fn integrate(f: &impl Fn(f64) -> f64, low: f64, high: f64, tolerance: f64) -> f64 {
    halve(f, (low, high), tolerance, DEEPEST)
}

fn halve(f: &impl Fn(f64) -> f64, (low, high): (f64, f64), tolerance: f64, deeper: u32) -> f64 {
    let (kronrod, gauss) = both(f, low, high);
    // The error of Kronrod's sum is far below the difference; a smaller tolerance in each half keeps the sum of errors.
    if deeper == 0 || (kronrod - gauss).abs() <= tolerance {
        return kronrod;
    }
    let middle = 0.5 * (low + high);
    let tolerance = libm::sqrt(0.5_f64) * tolerance;
    halve(f, (low, middle), tolerance, deeper - 1) + halve(f, (middle, high), tolerance, deeper - 1)
}

fn both(f: &impl Fn(f64) -> f64, low: f64, high: f64) -> (f64, f64) {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let (mut kronrod, mut gauss) = (0.0, 0.0);
    for (n, (point, weight)) in POINTS.iter().zip(KRONROD).enumerate() {
        let sum = if n == 7 { f(middle) } else { f(middle - half * point) + f(middle + half * point) };
        kronrod += weight * sum;
        if n % 2 == 1 {
            gauss += GAUSS[n / 2] * sum;
        }
    }
    (half * kronrod, half * gauss)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn polynomials_to_the_degree_of_each_rule_are_exact() {
        let power = |n: i32| both(&|x: f64| x.powi(n), 0.0, 1.0);
        for n in 0..=13 {
            assert_relative_eq!(power(n).1, 1.0 / f64::from(n + 1), max_relative = 1e-14);
        }
        for n in 0..=22 {
            assert_relative_eq!(power(n).0, 1.0 / f64::from(n + 1), max_relative = 1e-14);
        }
        assert!((power(14).1 - 1.0 / 15.0).abs() > 1e-10);
    }

    #[test]
    fn jumps_and_narrow_steps_are_found() {
        let jump = integrate(&|x: f64| if x > 0.123_456 { x } else { 0.0 }, -1.0, 1.0, 1e-11);
        assert_relative_eq!(jump, 0.5 * (1.0 - 0.123_456_f64.powi(2)), max_relative = 1e-9);
        let step = integrate(&|x: f64| ((x - 0.3) / 1e-5).tanh(), 0.0, 1.0, 1e-12);
        assert_relative_eq!(step, 0.4, max_relative = 1e-9);
    }
}
