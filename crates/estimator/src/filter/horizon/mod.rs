//! Moving-horizon estimation: the best trajectory through the last `N` samples, inside linear constraints.
//!
//! `min |x_0 - xbar|^2_{Pbar^-1} + sum |w_i|^2_{q^-1} + 2 sum rho((z_j - h_j(x_i)) / sqrt(R_j))` subject to
//! `x_{i+1} = f(x_i) + G w_i` and to inequalities on states and on their changes ([`Constraint`]). Half of it is
//! minimised by Gauss-Newton steps; each linearises the window along its trajectory, solves the problem without
//! constraints by one factorisation, and where that leaves the constraints or meets outliers, moves to the constrained
//! optimum by a quadratic program in the few directions concerned. Without constraints and outliers a linear problem
//! gives the Kalman filter's estimate and covariance, whatever the window's length.
//!
//! * `settings`, `constraint`, `outcome`: what goes in and out;
//! * `window`, `interval`: trajectory and samples, linearised; `arrival`: what the samples before the window say;
//! * `sweep`: the unconstrained optimum and posterior; `problem`, `resolve`, `active_set`: from there to the constrained optimum, with
//!   `program`, `interior_point` and `polish` for the quadratic program;
//! * `gauss_newton`: the iteration, `merit`: whether a step helps; `estimator`: one sample after the other.
//!
//! Assumptions: the noises are white and Gaussian but for outliers; constraints are linear; noise variances that
//! depend on the state are taken at the trajectory of linearisation; the process gives the same answer whenever it is
//! asked, since every interval in the window is passed again at each sample.
//!
//! Source: Rao, Rawlings and Lee 2001; Rao, Rawlings and Mayne 2003; Huber 1964.
mod active_set;
mod arrival;
mod constraint;
mod estimator;
mod gauss_newton;
mod interior_point;
mod interval;
mod merit;
mod outcome;
mod polish;
mod problem;
mod program;
mod resolve;
mod settings;
mod sweep;
mod triangular;
mod window;

pub use constraint::Constraint;
pub use estimator::MovingHorizon;
pub use outcome::{ActiveConstraint, FallbackReason, HorizonError, HorizonEstimate, HorizonStatus, Outlier};
pub use settings::{HorizonSettings, Loss};
