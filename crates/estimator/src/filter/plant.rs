//! What a bank of filters asks of a process beyond its [`StateSpace`].
use core::fmt::Debug;

use super::dense::add_product_transposed;
use super::gate::Gate;
use super::state_space::{Linearisation, StateSpace};
use super::step::StepTransition;
use super::ud_bank::Pattern;

/// Slow motion of a constant: `d(x - rest) = -decay (x - rest) dt + w`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlowProcess {
    /// Variance gained in a second.
    pub intensity: f64,
    /// Inverse memory, 1/s; 0: a random walk.
    pub decay_per_s: f64,
    /// Value that it returns to.
    pub rest: f64,
}

impl SlowProcess {
    /// Factor on the departure from rest, and variance gained, over an interval, s.
    pub fn over(&self, dt_s: f64) -> (f64, f64) {
        let decay = self.decay_per_s * dt_s;
        let span_s = if decay > 0.0 { -libm::expm1(-2.0 * decay) / (2.0 * self.decay_per_s) } else { dt_s };
        (libm::exp(-decay), self.intensity * span_s)
    }
}

/// A process as a [bank](super::Bank) of filters sees it: each member supposes something else of it.
///
/// One method is required. The others say what a plant has beyond a state space: bounds, constants that walk slowly, readings that
/// free states when they are re-acquired. The last group lets members whose states are close share one linearisation.
pub trait Plant: StateSpace + Clone + Debug {
    /// What a member of a bank supposes, such as how fast the plant leaks.
    type Hypothesis: Clone + Debug + PartialEq;

    /// Numbers of states and of leading states for which the loops over covariances are unrolled.
    const USUAL_SIZES: (usize, usize) = (0, 0);

    /// Number of noise sources whose intensity is a member's own.
    const SOURCES: usize = 0;

    /// From now on process and outputs are as a hypothesis has them.
    fn suppose(&mut self, hypothesis: &Self::Hypothesis);

    /// Gate of an output for a member with this hypothesis.
    fn gate(&self, _hypothesis: &Self::Hypothesis, _output: usize) -> Gate {
        Gate::default()
    }

    /// Whether the equations hold at a state.
    fn is_possible(&self, x: &[f64]) -> bool {
        x.iter().all(|x| x.is_finite())
    }

    /// Noise variance of output `j` for a member with this hypothesis.
    fn noise_variance_supposing(&self, _hypothesis: &Self::Hypothesis, j: usize, x: &[f64]) -> f64 {
        self.noise_variance(j, x)
    }

    /// Noise variance of output `j` where it is read every `interval_s`, s.
    fn noise_variance_at_interval(&mut self, j: usize, x: &[f64], _interval_s: f64) -> f64 {
        self.noise_variance(j, x)
    }

    /// Longest part of an interval over which the coefficients stay, s; at rest they stay longer.
    fn longest_step_s(&self) -> f64 {
        f64::INFINITY
    }

    /// Bounded states, each with its lowest and highest value.
    fn bounds(&self) -> &[(usize, f64, f64)] {
        &[]
    }

    /// How a constant moves.
    fn slow_process(&self, _state: usize) -> SlowProcess {
        SlowProcess::default()
    }

    /// States that a re-acquired reading of an output frees of everything known about them, with their variances. Where there
    /// are none, the reading's noise grows until the state follows it half of the way at most.
    fn freed_by(&self, _output: usize) -> &[(usize, f64)] {
        &[]
    }

    /// States that some members consider but do not estimate, unless a reading says much of them.
    fn considered(&self) -> &[usize] {
        &[]
    }

    /// Whether a member with this hypothesis is one of those.
    fn considers(&self, _hypothesis: &Self::Hypothesis) -> bool {
        false
    }

    /// The plant as a moving horizon passes it, again at each iteration: it may take longer steps.
    fn for_window(&self) -> Self {
        self.clone()
    }

    /// Move `x` by one undivided step of `dt_s`, s, as supposed last, and write the transition.
    ///
    /// # Errors
    /// As [`StateSpace::propagate`].
    fn transition(&mut self, x: &mut [f64], dt_s: f64, step: &mut StepTransition) -> Result<(), Self::Error> {
        let StepTransition { phi, noise, linear, .. } = step;
        let zeros = || Linearisation::zeros(self.states(), self.leading(), self.noises());
        let linear = linear.get_or_insert_with(zeros);
        self.propagate(x, dt_s, Some(linear))?;
        phi.copy_from(&linear.phi);
        noise.fill(0.0);
        let (m, g) = (noise.nrows(), linear.g.as_slice());
        add_product_transposed(noise.as_mut_slice(), g, |source| linear.q[source], g, m, m);
        Ok(())
    }

    /// Where the leading rows of a transition may differ from zero.
    fn pattern(&self) -> Pattern {
        Pattern::new(&vec![(0..self.states()).collect(); self.leading()])
    }

    /// Intensity of each source of `StepTransition::by_source` for a member with this hypothesis: ([`SOURCES`](Self::SOURCES)).
    fn intensities(&self, _hypothesis: &Self::Hypothesis, _intensities: &mut [f64]) {}

    /// Whether a member with this hypothesis is linearised before others.
    fn is_reference(&self, _hypothesis: &Self::Hypothesis) -> bool {
        true
    }

    /// Distance of two states under their hypotheses, in parts of what one linearisation bears; up to 1 they share it.
    fn distance(&self, _reference: (&Self::Hypothesis, &[f64]), _other: (&Self::Hypothesis, &[f64])) -> f64 {
        f64::INFINITY
    }

    /// Add to the leading states `by` what the curvature of the equations does to a state `x` in a step of `dt_s`, s, that was
    /// linearised at `reference`.
    ///
    /// # Errors
    /// The equations do not hold at `x`.
    fn add_curvature(
        &mut self,
        _reference: &[f64],
        _x: &[f64],
        _dt_s: f64,
        _step: &StepTransition,
        _by: &mut [f64],
    ) -> Result<(), Self::Error> {
        Ok(())
    }
}
