//! The bound by a window of samples: a second-order cone program.
//!
//! Let the state before the first of `m` samples be known as well as all candidates together would let it be known in the steady state,
//! `P_0`. No layout begins better, so what it makes of the functional after `m` samples is a lower bound of its steady state, which it reaches for
//! `m` to infinity. The best linear estimate with multipliers `lambda_jt` on the readings has the variance
//!
//! `mu_1^T P_0 mu_1 + sum_(t>1) mu_t^T Q mu_t + sum_j sigma_j^2 |lambda_j|^2 / z_j`,
//!
//! `mu_t = F^T mu_(t+1) - sum_j h_j lambda_jt`, `F^T mu_(m+1)` replaced by the functional,
//!
//! the error's coefficients `mu_t` of the initial state and of the process noise that enters before sample `t`. It is least over `lambda` and `z` together: `|lambda_j|^2 <= s_j z_j`
//! are second-order cones (Sagnol 2011), the rest is quadratic.
use super::super::constraints::Constraints;
use super::super::problem::LinearProblem;
use super::cuts::Cuts;
use super::program::{ConeProgram, Row};
use crate::EstimatorError;

/// The least variance of any weights that meet the constraints, after so many samples of the window.
///
/// # Errors
/// The constraints contradict each other, not even all candidates see what they should, or the solver does not come to an end.
pub fn window_bound(
    problem: &LinearProblem,
    constraints: &Constraints,
    samples: usize,
) -> Result<f64, EstimatorError> {
    let candidates = problem.outputs().len();
    constraints.validate(candidates)?;
    let (n, m) = (problem.functional().len(), samples.max(1));
    let first = problem.least_prediction()?;
    // All in units of the functional's standard deviation before the window.
    let scale = (problem.functional().transpose() * &first * problem.functional())[(0, 0)];
    if scale <= 0.0 {
        return Ok(0.0);
    }
    // z | s | lambda_jt | mu_t
    let lambda = |j: usize, t: usize| 2 * candidates + j * m + t;
    let mu = |t: usize, state: usize| 2 * candidates + candidates * m + t * n + state;
    let mut program = ConeProgram::new(mu(m, 0));
    Cuts::new(constraints, candidates).constrain(&mut program);
    let transition = problem.transition();
    for t in 0..m {
        let covariance = if t == 0 { &first } else { problem.process_noise() };
        for column in 0..n {
            for row in 0..=column {
                let value = covariance[(row, column)] + covariance[(column, row)];
                if value != 0.0 {
                    program.quadratic.push((mu(t, row), mu(t, column), value / scale));
                }
            }
        }
        for state in 0..n {
            let mut factors = vec![(mu(t, state), 1.0)];
            let mut bound = 0.0;
            if t + 1 == m {
                bound = problem.functional()[state];
            } else {
                let next = (0..n).filter(|row| transition[(*row, state)] != 0.0);
                factors.extend(next.map(|row| (mu(t + 1, row), -transition[(row, state)])));
            }
            let outputs = problem.outputs().iter().enumerate();
            let read = outputs.filter(|(_, output)| output.gradient[state] != 0.0);
            // Multipliers are in units of the functional over the sensor's noise.
            factors.extend(read.map(|(j, output)| {
                (lambda(j, t), output.gradient[state] * (scale / output.variance).sqrt())
            }));
            program.equal.push(Row::new(factors, bound));
        }
    }
    for j in 0..candidates {
        let (z, s) = (j, candidates + j);
        program.linear[s] = 1.0;
        let mut cone =
            vec![Row::new(vec![(s, 1.0), (z, 1.0)], 0.0), Row::new(vec![(s, 1.0), (z, -1.0)], 0.0)];
        cone.extend((0..m).map(|t| Row::new(vec![(lambda(j, t), 2.0)], 0.0)));
        program.cones.push(cone);
    }
    Ok(scale * program.solve()?.dual)
}
