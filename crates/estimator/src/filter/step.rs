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
    /// Of a plant that moves by its linearisation.
    pub(super) linear: Option<Linearisation>,
}

/// Memory to put transitions one after the other.
#[derive(Clone, Debug)]
pub(crate) struct StepMemory {
    phi: DMatrix<f64>,
    carried: DMatrix<f64>,
    moved: Vec<f64>,
}

impl StepMemory {
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
    /// Of `n` states, of which `leading` move, and so many sources whose intensity is a member's own.
    pub(crate) fn zeros(n: usize, leading: usize, sources: usize) -> Self {
        let square = DMatrix::zeros(leading, leading);
        Self {
            phi: DMatrix::zeros(leading, n),
            by_source: vec![square.clone(); sources],
            noise: square,
            linear: None,
        }
    }

    /// No step, of a plant whose members share all noise.
    pub(crate) fn clear(&mut self) {
        self.phi.fill_with_identity();
        self.noise.fill(0.0);
    }

    /// Another step after this one, of a plant whose members share all noise.
    pub(crate) fn append(&mut self, next: &Self, memory: &mut StepMemory) {
        carry(&next.phi, &mut self.noise, &mut memory.carried);
        self.noise.copy_from(&next.noise);
        add_carried(&mut self.noise, &memory.carried, &next.phi);
        compose(&next.phi, &self.phi, &mut memory.phi);
        core::mem::swap(&mut self.phi, &mut memory.phi);
    }

    /// Twice as long a step with the same coefficients; it has moved a state to `x` from `before`.
    pub(crate) fn double(&mut self, before: &[f64], x: &mut [f64], memory: &mut StepMemory) {
        let StepMemory { phi: doubled, carried, moved } = memory;
        let m = self.phi.nrows();
        moved.iter_mut().zip(&*x).zip(before).for_each(|((to, x), before)| *to = x - before);
        for (column, by) in self.phi.as_slice().chunks_exact(m.max(1)).zip(moved) {
            axpy(*by, column, &mut x[..m]);
        }
        for noise in core::iter::once(&mut self.noise).chain(&mut self.by_source) {
            carry(&self.phi, noise, carried);
            add_carried(noise, carried, &self.phi);
        }
        compose(&self.phi, &self.phi, doubled);
        core::mem::swap(&mut self.phi, doubled);
    }
}

/// Leading rows of the transition `next` after `phi`, in `product`: (leading, n) each. Constants stay.
pub(super) fn compose(next: &DMatrix<f64>, phi: &DMatrix<f64>, product: &mut DMatrix<f64>) {
    let m = next.nrows();
    let (moving, constant) = next.as_slice().split_at(m * m);
    let product = product.as_mut_slice();
    product[..m * m].fill(0.0);
    product[m * m..].copy_from_slice(constant);
    add_product(product, 1.0, moving, phi.as_slice(), m);
}

/// `Phi N` of a covariance by its upper triangle.
fn carry(phi: &DMatrix<f64>, noise: &mut DMatrix<f64>, carried: &mut DMatrix<f64>) {
    let m = phi.nrows();
    noise.fill_lower_triangle_with_upper_triangle();
    carried.fill(0.0);
    add_product(carried.as_mut_slice(), 1.0, &phi.as_slice()[..m * m], noise.as_slice(), m);
}

/// `N <- N + (Phi N') Phi^T`.
fn add_carried(noise: &mut DMatrix<f64>, carried: &DMatrix<f64>, phi: &DMatrix<f64>) {
    let m = phi.nrows();
    let moving = &phi.as_slice()[..m * m];
    add_product_transposed(noise.as_mut_slice(), carried.as_slice(), |_| 1.0, moving, m, m);
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

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

    #[test]
    fn parts_of_an_interval_follow_each_other() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let (n, m) = (7, 4);
        let (mut parts, mut part) = (StepTransition::zeros(n, m, 0), StepTransition::zeros(n, m, 0));
        let mut memory = StepMemory::new(n, m);
        parts.clear();
        let (mut f, mut q) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
        for _ in 0..3 {
            let phi = DMatrix::from_fn(m, n, |_, _| rng.random_range(-1.0..1.0));
            let noise = DMatrix::from_diagonal(&DVector::from_fn(m, |_, _| rng.random_range(0.1..1.0)));
            part.phi.copy_from(&phi);
            part.noise.copy_from(&noise);
            parts.append(&part, &mut memory);
            let (mut step, mut added) = (DMatrix::identity(n, n), DMatrix::zeros(n, n));
            step.rows_mut(0, m).copy_from(&phi);
            added.view_mut((0, 0), (m, m)).copy_from(&noise);
            q = &step * q * step.transpose() + added;
            f = step * f;
        }
        assert!((&parts.phi - f.rows(0, m)).abs().max() < 1e-12);
        let moving = q.view((0, 0), (m, m)).into_owned();
        assert!((parts.noise.upper_triangle() - moving.upper_triangle()).abs().max() < 1e-12);
    }

    #[test]
    fn a_doubled_step_is_one_after_itself_and_goes_on_as_it_has_moved() {
        let (n, m) = (5, 3);
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let mut step = StepTransition::zeros(n, m, 1);
        step.phi = DMatrix::from_fn(m, n, |_, _| rng.random_range(-1.0..1.0));
        step.noise = DMatrix::from_diagonal_element(m, m, 0.3);
        step.by_source[0] = DMatrix::from_diagonal_element(m, m, 0.7);
        let (mut twice, mut memory) = (step.clone(), StepMemory::new(n, m));
        twice.append(&step, &mut memory);
        // `x' = Phi x + c` twice, with constants that stay.
        let (start, c) = (DVector::from_fn(n, |i, _| 1.0 + i as f64), DVector::from_element(m, 0.2));
        let moved = |x: &DVector<f64>| {
            let mut after = x.clone();
            after.rows_mut(0, m).copy_from(&(&step.phi * x + &c));
            after
        };
        let once = moved(&start);
        let (expected, mut x) = (moved(&once), once.as_slice().to_vec());
        step.clone().double(start.as_slice(), &mut x, &mut memory);
        assert!((DVector::from_vec(x) - expected).amax() < 1e-12);
        let mut doubled = step.clone();
        doubled.double(start.as_slice(), &mut once.as_slice().to_vec(), &mut memory);
        assert_eq!(doubled.phi, twice.phi);
        assert_eq!(doubled.noise.upper_triangle(), twice.noise.upper_triangle());
        let ratio = doubled.by_source[0].component_div(&doubled.noise);
        assert!(ratio.iter().all(|ratio| (ratio / (0.7 / 0.3) - 1.0).abs() < 1e-9), "{ratio}");
    }
}
