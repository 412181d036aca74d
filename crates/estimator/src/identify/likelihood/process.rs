//! Model and input as one process for the Kalman filter.
use nalgebra::{DMatrix, DVector};

use super::Likelihood;
use crate::EstimatorError;
use crate::filter::{Dimensions, Linearisation, StateSpace};
use crate::identify::compensation::Variances;
use crate::identify::parametrisation::Coefficients;
use crate::identify::propagator::{Propagator, Propagators};
use crate::identify::response::companion;
use crate::identify::schedule::Piece;
use crate::identify::{Hold, InputModel};

/// The process of `[w, u now, u next, (slope)]` over the present piece.
pub(super) struct Process<const N: usize> {
    k: Coefficients,
    hold: Hold,
    input_model: InputModel,
    variances: Variances,
    intensity: f64,
    input_time: Vec<f64>,
    chain: Propagators<N>,
    /// The present piece.
    pub piece: Piece,
    /// Transition of the last piece: regular records have the same one over and over.
    last: Option<(Kind, Linearisation)>,
}

/// What the transition over a piece depends on.
#[derive(Clone, Copy, Debug)]
struct Kind {
    duration: f64,
    from: f64,
    to: f64,
    fresh: Option<(usize, f64)>,
}

impl Kind {
    /// Equal but for the rounding of the times.
    fn is(&self, other: &Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs();
        let fresh = match (self.fresh, other.fresh) {
            (Some((place, a)), Some((other, b))) => place == other && near(a, b),
            (None, None) => true,
            _ => false,
        };
        fresh && near(self.duration, other.duration) && near(self.from, other.from) && near(self.to, other.to)
    }
}

impl<const N: usize> Process<N> {
    pub(super) fn new(k: &Coefficients, likelihood: &Likelihood<'_>, intensity: f64) -> Self {
        let (f, g) = companion::<N>(k);
        let piece = Piece { duration: 0.0, left: 0, from: 0.0, to: 0.0, fresh: false, output: None };
        Self {
            k: *k,
            hold: likelihood.search.problem.hold,
            input_model: likelihood.input_model,
            variances: likelihood.variances,
            intensity,
            input_time: likelihood.search.problem.input_time.clone(),
            chain: Propagators::new(f, g),
            piece,
            last: None,
        }
    }

    /// The state that takes a fresh input sample, and the interval that it has wandered over.
    fn fresh(&self) -> Option<(usize, f64)> {
        let t = &self.input_time;
        match (self.piece.fresh, self.hold, self.piece.left) {
            (true, Hold::First, left) => Some((N + 1, t[left + 1] - t[left])),
            (true, Hold::Zero, left) if left > 0 => Some((N, t[left] - t[left - 1])),
            _ => None,
        }
    }

    /// Transition of the input states where a sample acts, and the noise that enters there.
    fn load(&self) -> (DMatrix<f64>, DMatrix<f64>, DVector<f64>) {
        let (states, noises) = (self.states(), self.noises());
        let (mut phi, mut g) = (DMatrix::identity(states, states), DMatrix::zeros(states, noises));
        let mut q = DVector::zeros(noises);
        if let Some((place, wandered)) = self.fresh() {
            phi[(place, place)] = 0.0;
            phi[(place, N)] = 1.0;
            g[(place, 0)] = 1.0;
            q[0] = self.intensity * wandered;
            if self.input_model == InputModel::IntegratedRandomWalk {
                // The slope's step moves the input by half an interval; the rest is independent of it.
                phi[(place, N + 2)] = wandered;
                g[(place, 1)] = 0.5 * wandered;
                g[(N + 2, 1)] = 1.0;
                q[0] = self.intensity * wandered.powi(3) / 12.0;
                q[1] = self.intensity * wandered;
            }
        }
        (phi, g, q)
    }

    /// Transition over the piece.
    fn run(&mut self) -> DMatrix<f64> {
        let states = self.states();
        let Piece { duration, from, to, .. } = self.piece;
        let p: &Propagator<N> = self.chain.over(duration);
        let share = if from < 1.0 { (to - from) / (1.0 - from) } else { 0.0 };
        let mut phi = DMatrix::identity(states, states);
        for i in 0..N {
            for j in 0..N {
                phi[(i, j)] = p.phi[(i, j)];
            }
            phi[(i, N)] = p.constant[i] - share * p.rise[i];
            phi[(i, N + 1)] = share * p.rise[i];
        }
        phi[(N, N)] = 1.0 - share;
        phi[(N, N + 1)] = share;
        phi
    }
}

impl<const N: usize> StateSpace for Process<N> {
    type Error = EstimatorError;

    fn dimensions(&self) -> Dimensions {
        let noises = 1 + usize::from(self.input_model == InputModel::IntegratedRandomWalk);
        let states = N + 1 + noises;
        Dimensions { states, leading: states, noises, outputs: 2 }
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        _dt: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), EstimatorError> {
        let Piece { duration, from, to, .. } = self.piece;
        let kind = Kind { duration, from, to, fresh: self.fresh() };
        if self.last.as_ref().is_none_or(|(last, _)| !last.is(&kind)) {
            let (load, g, q) = self.load();
            let run = self.run();
            self.last = Some((kind, Linearisation { phi: &run * load, g: run * g, q }));
        }
        if let Some((_, last)) = &self.last {
            let moved = &last.phi * DVector::from_column_slice(x);
            x.copy_from_slice(moved.as_slice());
            if let Some(linear) = linear {
                linear.phi.copy_from(&last.phi);
                linear.g.copy_from(&last.g);
                linear.q.copy_from(&last.q);
            }
        }
        Ok(())
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, EstimatorError> {
        // The newest input state is read, whichever it is; at the very start both are the same.
        let read = if self.hold == Hold::First { N + 1 } else { N };
        let value = match j {
            0 => x[read],
            _ => (0..N).map(|i| self.k.b[i] * x[i]).sum(),
        };
        if let Some(h) = h {
            h.fill(0.0);
            match j {
                0 => h[read] = 1.0,
                _ => h[..N].copy_from_slice(&self.k.b[..N]),
            }
        }
        Ok(value)
    }

    fn noise_variance(&self, j: usize, _x: &[f64]) -> f64 {
        if j == 0 { self.variances.input } else { self.variances.output }
    }
}
