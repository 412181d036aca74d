//! Posterior Cramer-Rao bound: what no estimator of a state can do better, and how near one comes to it.
//!
//! With the information `J` about the state at one sample, its transition `phi` linearised on a true path, noise `Q` of
//! the moving states and gradients `H` of the outputs,
//!
//! `J+ = D22 - D21 (J + D11)^-1 D12 + E[H^T R^-1 H]`, `D11 = E[phi^T Q^-1 phi]`, `D12 = -E[phi^T Q^-1]`, `D22 = E[Q^-1]`.
//!
//! Expectations run over true paths, which the caller draws: [`Moments`] sums over them, sample by sample, and
//! [`PosteriorBound`] moves from sample to sample. With `Q~ = D22^-1`, `phi~ = -Q~ D21` and the information
//! `V = D11 - phi~^T D22 phi~` that the spread of `phi` gives about the state before, the same reads
//! `J+ = (Q~ + phi~ (J + V)^-1 phi~^T)^-1 + E[H^T R^-1 H]`. So it is computed: it asks for no inverse of `J` or `phi`, and
//! states without noise, such as constants, are the limit of small noise.
//!
//! # Which expectation
//! * [`Expectation::Full`] is the bound as published. It asks for a regular `Q` wherever `phi` has a spread. Averaging the
//!   information over unlike paths counts as known what each path by itself leaves open, such as the mass beside an offset:
//!   with constants of some spread the bound, though right, lies far below what any estimator reaches.
//! * [`Expectation::MeanTransition`] drops the spread of `phi` from path to path: `(E[Q] + E[phi] J^-1 E[phi]^T)^-1`. `Q` may be
//!   singular. What the spread tells is missing, so that the result is never below the bound: it errs to the high
//!   side, and an efficiency by it is too good. Without spread both are equal.
//! * [`path_bound`] gives the same for one path by itself; its mean over paths, too, is never below the bound as published with
//!   the mean information (Jensen's inequality), and is what a filter with the right linearisations states.
//!
//! What a variance `R` that depends on the state tells by itself is left out everywhere, which errs to the high side too.
//!
//! Source: Tichavsky, Muravchik, Nehorai 1998 (equations 21, 33-36); constants: van Trees 1968 (section 2.4).
mod efficiency;
mod moments;
mod recursion;

pub use efficiency::Efficiency;
pub use moments::Moments;
pub use recursion::{Expectation, PosteriorBound, path_bound, posterior_bound};

#[cfg(test)]
mod tests;
