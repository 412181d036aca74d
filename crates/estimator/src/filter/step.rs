//! Steps in time: into what an interval is divided, and the transition of one.
//!
//! A transition is that of equations linearised at its beginning. It is exact but for the change of their coefficients, so an interval
//! is divided into parts. A plant that no reading disturbs comes to rest, and in a long interval the coefficients change less and less:
//! steps become longer, by doubling the transition `x' = x + Phi (x - x_0)`, which is exact for coefficients that stay:
//!
//! `N(2h) = N(h) + Phi(h) N(h) Phi(h)^T`, `Phi(2h) = Phi(h) Phi(h)`.
//!
//! A gap of `k` parts then takes `2 log2 k` steps.
//!
//! Source: doubling, Anderson and Moore, Optimal Filtering (1979), section 6.7.
use alloc::vec::Vec;
use nalgebra::DMatrix;

use super::dense::{add_product, add_product_transposed};
use super::kernel::axpy;
use super::state_space::Linearisation;

/// Number and length, s, of the equal parts that an interval is divided into.
#[cfg(feature = "design")]
pub(crate) fn parts(dt_s: f64, longest_part_s: f64) -> (usize, f64) {
    let parts = libm::ceil(dt_s / longest_part_s).max(1.0);
    (parts as usize, dt_s / parts)
}

/// Steps that an interval is divided into, each as often as its length is that of a part doubled: four parts, and then no step is longer than
/// half of what has passed before it.
#[derive(Clone, Debug)]
pub(crate) struct Steps {
    /// Length of a part, s.
    pub part_s: f64,
    passed: u64,
    parts: u64,
}

impl Steps {
    /// Over an interval in parts no longer than this, s: as many as end with a step.
    pub(crate) fn of(dt_s: f64, longest_part_s: f64) -> Self {
        let fewest = libm::ceil(dt_s / longest_part_s).max(1.0);
        let mut steps = Self { part_s: 0.0, passed: 0, parts: u64::MAX };
        while (steps.passed as f64) < fewest && steps.next().is_some() {}
        Self { part_s: dt_s / steps.passed as f64, passed: 0, parts: steps.passed }
    }

    /// Whether it is one part.
    pub(crate) fn is_one(&self) -> bool {
        self.parts == 1
    }
}

impl Iterator for Steps {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        let doublings = (self.passed / 2).max(1).ilog2();
        let passed = self.passed.checked_add(1 << doublings).filter(|passed| *passed <= self.parts)?;
        self.passed = passed;
        Some(doublings)
    }
}

/// Transition of a step, with the noise that it adds in parts: members of a bank differ in the intensity of some sources.
#[derive(Clone, Debug)]
pub struct StepTransition {
    /// Leading rows of the transition: (leading, n).
    pub phi: DMatrix<f64>,
    /// Noise covariance that all members share: (leading, leading), upper triangle.
    pub noise: DMatrix<f64>,
    /// Noise covariance by each source of [`Plant::intensities`](super::Plant::intensities), per unit of its intensity.
    pub(crate) by_source: Vec<DMatrix<f64>>,
    pub(super) linear: Linearisation,
}

/// Memory to double a transition.
#[derive(Clone, Debug)]
pub(crate) struct DoublingMemory {
    phi: DMatrix<f64>,
    carried: DMatrix<f64>,
    moved: Vec<f64>,
}

impl DoublingMemory {
    /// For transitions of `n` states, of which `leading` move.
    pub(crate) fn new(n: usize, leading: usize) -> Self {
        Self {
            phi: DMatrix::zeros(leading, n),
            carried: DMatrix::zeros(leading, leading),
            moved: vec![0.0; leading],
        }
    }
}

impl StepTransition {
    /// Of `n` states, of which `leading` move, so many noises and so many sources whose intensity is a member's own.
    pub(crate) fn zeros(n: usize, leading: usize, noises: usize, sources: usize) -> Self {
        let square = DMatrix::zeros(leading, leading);
        Self {
            phi: DMatrix::zeros(leading, n),
            by_source: vec![square.clone(); sources],
            noise: square,
            linear: Linearisation::zeros(n, leading, noises),
        }
    }

    /// Twice as long a step with the same coefficients; it has moved a state to `x` from `before`.
    pub(crate) fn double(&mut self, before: &[f64], x: &mut [f64], memory: &mut DoublingMemory) {
        let DoublingMemory { phi: doubled, carried, moved } = memory;
        let (m, phi) = (self.phi.nrows(), self.phi.as_slice());
        let (moving, constant) = phi.split_at(m * m);
        moved.iter_mut().zip(&*x).zip(before).for_each(|((to, x), before)| *to = x - before);
        for (column, by) in moving.chunks_exact(m.max(1)).zip(moved) {
            axpy(*by, column, &mut x[..m]);
        }
        for noise in core::iter::once(&mut self.noise).chain(&mut self.by_source) {
            noise.fill_lower_triangle_with_upper_triangle();
            carried.fill(0.0);
            add_product(carried.as_mut_slice(), 1.0, moving, noise.as_slice(), m);
            add_product_transposed(noise.as_mut_slice(), carried.as_slice(), |_| 1.0, moving, m, m);
        }
        let (moving_twice, constant_twice) = doubled.as_mut_slice().split_at_mut(m * m);
        moving_twice.fill(0.0);
        constant_twice.copy_from_slice(constant);
        add_product(doubled.as_mut_slice(), 1.0, moving, phi, m);
        core::mem::swap(&mut self.phi, doubled);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_become_longer_and_fill_the_interval() {
        let of = |dt_s| Steps::of(dt_s, 60.0);
        assert_eq!(of(1e-3).collect::<Vec<_>>(), [0]);
        assert_eq!(of(180.0).collect::<Vec<_>>(), [0, 0, 0]);
        assert_eq!(of(601.0).collect::<Vec<_>>(), [0, 0, 0, 0, 1, 1, 2]);
        for dt_s in [1.0, 60.0, 61.0, 300.0, 3600.0, 86_400.0, 3.1e7, 1e12, 1e300] {
            let mut passed_s: f64 = 0.0;
            let part_s = of(dt_s).part_s;
            let steps: Vec<f64> = of(dt_s).map(|doublings| part_s * 2.0_f64.powi(doublings as i32)).collect();
            for step_s in &steps {
                assert!(*step_s <= (0.5 * passed_s).max(part_s));
                passed_s += step_s;
            }
            assert!((passed_s / dt_s - 1.0).abs() < 1e-14);
            assert!(part_s <= 60.0 || dt_s > 1e20, "parts of {part_s} s");
            assert!(
                (steps.len() as f64) <= 6.0 + 2.0 * (dt_s / 60.0).log2().max(0.0),
                "{} steps",
                steps.len()
            );
        }
    }
}
