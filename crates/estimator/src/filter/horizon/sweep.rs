//! The linearised window without constraints, solved and factorised by one sweep from its end to its start.
//!
//! The cost to go from state `i` is kept as `|U_i delta_i - y_i|^2` with a triangle `U_i`. One step back stacks it with
//! the readings at state `i + 1`, puts the transition in place of `delta_{i+1}` and triangularises
//! `[I 0 0; B G, B F, y - B c]` over the columns `[omega_i, delta_i, rhs]`: the first rows give the best noise
//! `omega_i = kappa - K delta_i`, the rows below `U_i, y_i`. At the start, `delta_0 = e + S xi` likewise.
//!
//! What remains is a process that runs forward, driven by independent `eta` of unit variance:
//! `delta_{i+1} = A_i delta_i + b_i + D_i eta_i`, `A = F - G K`, `b = c + G kappa`, `D = G R^{-1}`. With `eta = 0` it
//! runs through the optimum; its covariance is the posterior of the window. So the posterior is `delta = optimum +
//! T eta`, and neither a covariance nor a noise variance is ever inverted: all may be singular. Nothing is squared.
//!
//! It is the square-root information form of the dual (regulator) recursion; Bierman 1977, chapters VI and X, and
//! Rao, Rawlings and Lee 2001 for the problem.
use nalgebra::{DMatrix, DVector};

use super::constraint::{Constraint, Span, StageRow};
use super::interval::Interval;
use super::program::Basis;
use super::triangular::{divide_right, triangularise};
use super::window::WindowTrajectory;
use crate::filter::kernel::{axpy, dot};

/// Posterior of a window as a process driven by independent noises `eta` of unit variance.
///
/// `eta` is one vector: (n) for the initial state, then (k) for each interval.
#[derive(Clone, Debug)]
pub(super) struct Sweep {
    states: usize,
    leading: usize,
    noises: usize,
    stages: Vec<Stage>,
    start: Start,
    work: Work,
}

/// The posterior process over one interval.
#[derive(Clone, Debug)]
struct Stage {
    /// `K`: (k, n).
    feedback: DMatrix<f64>,
    /// `kappa`: (k).
    feedforward: DVector<f64>,
    /// `R^{-1}`, the noises' posterior root: (k, k).
    noise_root: DMatrix<f64>,
    /// `A`: (leading, n).
    closed_loop: DMatrix<f64>,
    /// `b`: (leading).
    drift: DVector<f64>,
    /// `D`: (leading, k).
    input: DMatrix<f64>,
}

/// The posterior of the initial state.
#[derive(Clone, Debug)]
struct Start {
    /// Optimal `xi`: (n).
    xi: DVector<f64>,
    /// Root of its posterior covariance: (n, n).
    xi_root: DMatrix<f64>,
    /// Optimal `delta_0`: (n).
    delta: DVector<f64>,
    /// Root of its posterior covariance: (n, n).
    delta_root: DMatrix<f64>,
}

/// Memory of the sweep.
#[derive(Clone, Debug)]
struct Work {
    /// `[U y]` and the readings below: (n + outputs, n + 1), of which `rows` count.
    block: DMatrix<f64>,
    rows: usize,
    /// `[omega, delta, rhs]`: (k + n + outputs, k + n + 1).
    stacked: DMatrix<f64>,
    /// `[xi, rhs]`: (2 n, n + 1).
    initial: DMatrix<f64>,
}

impl Sweep {
    /// Room for windows of a problem of these sizes.
    pub(super) fn new(states: usize, leading: usize, noises: usize, outputs: usize) -> Self {
        let (n, k) = (states, noises);
        let start = Start {
            xi: DVector::zeros(n),
            xi_root: DMatrix::zeros(n, n),
            delta: DVector::zeros(n),
            delta_root: DMatrix::zeros(n, n),
        };
        let work = Work {
            block: DMatrix::zeros(n + outputs, n + 1),
            rows: 0,
            stacked: DMatrix::zeros(k + n + outputs, k + n + 1),
            initial: DMatrix::zeros(2 * n, n + 1),
        };
        Self { states, leading, noises, stages: Vec::new(), start, work }
    }

    /// Factorise the window linearised along `path`; the arrival cost is that of `x_0 = mean + root xi`.
    pub(super) fn factorise(
        &mut self,
        intervals: &[Interval],
        path: &WindowTrajectory,
        mean: &DVector<f64>,
        root: &DMatrix<f64>,
    ) {
        self.stages.resize_with(intervals.len(), || Stage::zeros(self.states, self.leading, self.noises));
        self.work.rows = 0;
        for (i, interval) in intervals.iter().enumerate().rev() {
            let defect = (&interval.advanced - &path.x[i + 1]).rows(0, self.leading).into_owned();
            self.work.stack_readings(interval);
            self.work.eliminate_noise(interval, &defect);
            self.stages[i].read(&self.work.stacked, interval, defect);
        }
        self.factorise_start(mean - &path.x[0], root);
    }

    /// `delta_0 = offset + S xi` in place of `delta_0`.
    fn factorise_start(&mut self, offset: DVector<f64>, root: &DMatrix<f64>) {
        let n = self.states;
        let Work { block, rows, initial, .. } = &mut self.work;
        initial.fill(0.0);
        initial.view_mut((0, 0), (n, n)).fill_diagonal(1.0);
        let u = block.view((0, 0), (*rows, n));
        initial.view_mut((n, 0), (*rows, n)).gemm(1.0, &u, root, 0.0);
        let mut rhs = initial.view_mut((n, n), (*rows, 1));
        rhs.copy_from(&block.view((0, n), (*rows, 1)));
        rhs.gemm(-1.0, &u, &offset, 1.0);
        triangularise(initial, n + *rows, n);
        let start = &mut self.start;
        start.xi_root.fill_with_identity();
        divide_right(&mut start.xi_root, initial);
        start.xi.gemv(1.0, &start.xi_root, &initial.view((0, n), (n, 1)).column(0), 0.0);
        start.delta_root.gemm(1.0, root, &start.xi_root, 0.0);
        start.delta.copy_from(&offset);
        start.delta.gemv(1.0, root, &start.xi, 1.0);
    }

    /// Number of states that move.
    pub(super) fn leading(&self) -> usize {
        self.leading
    }

    /// Length of `eta`.
    pub(super) fn drives(&self) -> usize {
        self.states + self.stages.len() * self.noises
    }

    /// The optimum, moved by `eta` (length [`drives`](Self::drives)) where given. States are changes.
    pub(super) fn run(&self, eta: Option<&[f64]>) -> WindowTrajectory {
        let n = self.states;
        let (mut xi, mut delta) = (self.start.xi.clone(), self.start.delta.clone());
        if let Some(eta) = eta {
            multiply_add(&self.start.xi_root, &eta[..n], xi.as_mut_slice());
            multiply_add(&self.start.delta_root, &eta[..n], delta.as_mut_slice());
        }
        let mut path = WindowTrajectory { x: vec![delta], omega: Vec::with_capacity(self.stages.len()), xi };
        for (i, stage) in self.stages.iter().enumerate() {
            let delta = path.newest();
            let mut omega = stage.feedforward.clone();
            omega.gemv(-1.0, &stage.feedback, delta, 1.0);
            let mut next = delta.clone();
            let mut moved = next.rows_mut(0, self.leading);
            moved.copy_from(&stage.drift);
            moved.gemv(1.0, &stage.closed_loop, delta, 1.0);
            if let Some(eta) = eta {
                let eta = &eta[n + i * self.noises..][..self.noises];
                multiply_add(&stage.noise_root, eta, omega.as_mut_slice());
                multiply_add(&stage.input, eta, &mut next.as_mut_slice()[..self.leading]);
            }
            path.x.push(next);
            path.omega.push(omega);
        }
        path
    }

    /// Derivative `T^T c` of a row's value with `eta`; its square is the row's posterior variance.
    pub(super) fn derivative(&self, constraint: &Constraint, spot: StageRow) -> Vec<f64> {
        let mut c = vec![0.0; self.states];
        for &(k, a) in constraint.terms() {
            c[k] += a;
        }
        let mut eta = vec![0.0; self.drives()];
        let mut y = c.clone();
        if constraint.span() == Span::State {
            self.pull_back(&mut y, spot.stage, 0, &mut eta);
        } else {
            self.pull_back(&mut y, spot.stage, spot.stage - 1, &mut eta);
            axpy(-1.0, &c, &mut y);
            self.pull_back(&mut y, spot.stage - 1, 0, &mut eta);
        }
        self.pull_start(&y, &mut eta);
        eta
    }

    /// Derivative with `eta` of `c^T delta` at a stage; `c`: (n).
    pub(super) fn derivative_at(&self, c: &[f64], stage: usize) -> Vec<f64> {
        let mut eta = vec![0.0; self.drives()];
        let mut y = c.to_vec();
        self.pull_back(&mut y, stage, 0, &mut eta);
        self.pull_start(&y, &mut eta);
        eta
    }

    /// Carry the derivative `y` with the state at `from` back to the state at `to`.
    fn pull_back(&self, y: &mut [f64], from: usize, to: usize, eta: &mut [f64]) {
        let mut before = vec![0.0; self.states];
        for i in (to..from).rev() {
            let stage = &self.stages[i];
            let moved = &y[..self.leading];
            transpose_multiply(&stage.input, moved, &mut eta[self.states + i * self.noises..]);
            transpose_multiply(&stage.closed_loop, moved, &mut before);
            axpy(1.0, &y[self.leading..], &mut before[self.leading..]);
            y.copy_from_slice(&before);
        }
    }

    fn pull_start(&self, y: &[f64], eta: &mut [f64]) {
        transpose_multiply(&self.start.delta_root, y, eta);
    }

    /// Posterior covariance of the newest state, a sum of squares: (n, n).
    pub(super) fn newest_covariance(&self) -> DMatrix<f64> {
        let (n, leading) = (self.states, self.leading);
        let mut p = &self.start.delta_root * self.start.delta_root.transpose();
        let mut moved = DMatrix::zeros(leading, n);
        for stage in &self.stages {
            moved.gemm(1.0, &stage.closed_loop, &p, 0.0);
            let mut top = p.view_mut((0, 0), (leading, leading));
            top.gemm(1.0, &moved, &stage.closed_loop.transpose(), 0.0);
            top.gemm(1.0, &stage.input, &stage.input.transpose(), 1.0);
            let cross = moved.columns(leading, n - leading);
            p.view_mut((0, leading), (leading, n - leading)).copy_from(&cross);
            p.view_mut((leading, 0), (n - leading, leading)).copy_from(&cross.transpose());
        }
        (&p + p.transpose()) * 0.5
    }

    /// Covariance of the newest state given that rows at these spots hold with equality: (n, n).
    ///
    /// With `T_N` the newest rows of `T` and `B` a basis of the rows' derivatives it is `T_N (I - B B^T) T_N^T`,
    /// formed as a Gram matrix and so positive semi-definite.
    pub(super) fn projected_covariance<'a>(
        &self,
        rows: impl Iterator<Item = (&'a Constraint, StageRow)>,
    ) -> DMatrix<f64> {
        let mut basis = Basis::default();
        for (constraint, spot) in rows {
            basis.coordinates(&self.derivative(constraint, spot));
        }
        let mut free = DMatrix::zeros(self.drives(), self.states);
        for (k, mut column) in free.column_iter_mut().enumerate() {
            let mut unit = vec![0.0; self.states];
            unit[k] = 1.0;
            let newest = self.derivative_at(&unit, self.stages.len());
            column.copy_from_slice(&basis.reject(&newest));
        }
        free.tr_mul(&free)
    }
}

impl Stage {
    fn zeros(n: usize, leading: usize, k: usize) -> Self {
        Self {
            feedback: DMatrix::zeros(k, n),
            feedforward: DVector::zeros(k),
            noise_root: DMatrix::zeros(k, k),
            closed_loop: DMatrix::zeros(leading, n),
            drift: DVector::zeros(leading),
            input: DMatrix::zeros(leading, k),
        }
    }

    /// Take the noise's rows from the triangle.
    fn read(&mut self, stacked: &DMatrix<f64>, interval: &Interval, defect: DVector<f64>) {
        let (k, n) = self.feedback.shape();
        self.noise_root.fill_with_identity();
        divide_right(&mut self.noise_root, stacked);
        self.feedback.gemm(1.0, &self.noise_root, &stacked.view((0, k), (k, n)), 0.0);
        self.feedforward.gemv(1.0, &self.noise_root, &stacked.view((0, k + n), (k, 1)).column(0), 0.0);
        self.input.gemm(1.0, &interval.noise_input, &self.noise_root, 0.0);
        self.closed_loop.copy_from(&interval.linear.phi);
        self.closed_loop.gemm(-1.0, &interval.noise_input, &self.feedback, 1.0);
        self.drift = defect;
        self.drift.gemv(1.0, &interval.noise_input, &self.feedforward, 1.0);
    }
}

impl Work {
    /// Put the readings below `[U y]`.
    fn stack_readings(&mut self, interval: &Interval) {
        let n = self.block.ncols() - 1;
        for reading in &interval.readings {
            let root = reading.weight.sqrt();
            for (j, a) in interval.gradient.column(reading.output).iter().enumerate() {
                self.block[(self.rows, j)] = root * a;
            }
            self.block[(self.rows, n)] = root * reading.residual;
            self.rows += 1;
        }
    }

    /// Triangularise over `[omega, delta]`; the rows of `delta` become the block of the stage before.
    fn eliminate_noise(&mut self, interval: &Interval, defect: &DVector<f64>) {
        let (leading, k) = interval.noise_input.shape();
        let (n, rows) = (self.block.ncols() - 1, self.rows);
        let stacked = &mut self.stacked;
        stacked.rows_mut(0, k).fill(0.0);
        stacked.view_mut((0, 0), (k, k)).fill_diagonal(1.0);
        let moved = self.block.view((0, 0), (rows, leading));
        stacked.view_mut((k, 0), (rows, k)).gemm(1.0, &moved, &interval.noise_input, 0.0);
        // Constants keep their columns; the moving states' columns are covered by `phi`.
        stacked.view_mut((k, k), (rows, n + 1)).copy_from(&self.block.view((0, 0), (rows, n + 1)));
        stacked.view_mut((k, k), (rows, leading)).fill(0.0);
        stacked.view_mut((k, k), (rows, n)).gemm(1.0, &moved, &interval.linear.phi, 1.0);
        stacked.view_mut((k, k + n), (rows, 1)).gemm(-1.0, &moved, defect, 1.0);
        triangularise(stacked, k + rows, k + n);
        self.rows = rows.min(n);
        self.block.view_mut((0, 0), (self.rows, n + 1)).copy_from(&stacked.view((k, k), (self.rows, n + 1)));
    }
}

/// `y <- y + A x`.
fn multiply_add(a: &DMatrix<f64>, x: &[f64], y: &mut [f64]) {
    for (column, x) in a.column_iter().zip(x) {
        axpy(*x, column.as_slice(), y);
    }
}

/// `y <- A^T x` into the leading entries of `y`.
fn transpose_multiply(a: &DMatrix<f64>, x: &[f64], y: &mut [f64]) {
    for (column, y) in a.column_iter().zip(y) {
        *y = dot(column.as_slice(), x);
    }
}
