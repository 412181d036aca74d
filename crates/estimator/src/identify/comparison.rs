//! A given model beside data: what its simulation misses.
use serde::Serialize;

use super::model::Model;
use super::problem::Problem;
use super::report::simulated_residuals;
use super::response::respond;
use super::schedule::Schedule;
use super::start::with_initial_response;
use super::statistics::{Residuals, Statistics};
use super::{Data, IdentifyError, InitialState};

/// How a model that was not identified from these data does on them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Free response and its derivatives at the start, as estimated for these data or as given.
    pub initial: Vec<f64>,
    /// Figures of merit; only the initial states, if they were estimated, count as parameters.
    pub statistics: Statistics,
    /// Errors of the simulation.
    pub residuals: Residuals,
}

impl Model {
    /// Simulate the data's input from an initial state, which is fitted to the data if it is
    /// [`InitialState::Estimated`], and compare with the output; correlations up to `lags`.
    ///
    /// # Errors
    /// The model is no stable one of order 1 to 3, or the data hold nothing to compare with.
    pub fn compare_from(
        &self,
        data: &Data,
        initial: &InitialState,
        lags: usize,
    ) -> Result<Comparison, IdentifyError> {
        let mut problem = Problem::new(data, None, Some(f64::INFINITY), self.order())?;
        problem.rescale(1.0 / problem.units.time_s);
        let (parametrisation, theta) = self.parameters(initial.clone(), &problem.units)?;
        let theta = with_initial_response(&problem, &parametrisation, &theta)
            .ok_or(IdentifyError::TooFewSamples { samples: problem.samples(), parameters: self.order() })?;
        let k = parametrisation.expand(&theta);
        let y = respond(&problem, &Schedule::new(&problem, k.dead_time), &problem.u, &k).y;
        let errors: Vec<f64> = problem.y.iter().zip(&y).map(|(y, model)| y - model).collect();
        let residuals = simulated_residuals(&problem, &errors, lags);
        let estimated = if *initial == InitialState::Estimated { self.order() } else { 0 };
        let output: Vec<f64> = problem.y.iter().map(|y| y * problem.units.output).collect();
        Ok(Comparison {
            initial: super::report::initial(&problem, &parametrisation, &theta),
            statistics: Statistics::new(&output, &residuals.values, estimated),
            residuals,
        })
    }

    /// Fit to data, %, with an initial state estimated for them (MATLAB's `compare`).
    ///
    /// # Errors
    /// As of [`Model::compare_from`].
    pub fn compare(&self, data: &Data) -> Result<f64, IdentifyError> {
        Ok(self.compare_from(data, &InitialState::Estimated, 1)?.statistics.fit_percent)
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::identify::{Hold, published};

    /// The published model's answer to a step of 46 K from 21 °C, exact, with the readings of one minute missing.
    fn step() -> Data {
        let time_s: Vec<f64> = (0..120).map(|k| 500.0 + 60.0 * f64::from(k)).collect();
        let (pole, gain) = (published::POLE_PER_S, published::NUMERATOR_PER_S / published::POLE_PER_S);
        let settled = gain * -25.0;
        let mut input = vec![-25.0; 120];
        input[119] = -25.5;
        let mut output: Vec<f64> =
            time_s.iter().map(|t| settled + (21.0 - settled) * (-pole * (t - 500.0)).exp()).collect();
        output.truncate(119);
        output.push(f64::NAN);
        output[40] = f64::NAN;
        Data::try_new(time_s, input, output, Hold::Zero).unwrap()
    }

    #[test]
    fn the_right_state_at_the_start_leaves_nothing_and_is_found_if_it_is_not_given() {
        let given = published::model().compare_from(&step(), &InitialState::Given(vec![21.0]), 25).unwrap();
        assert_eq!(given.statistics.samples, 118);
        assert_eq!((given.statistics.parameters, given.residuals.time_s[40]), (0, 500.0 + 60.0 * 41.0));
        assert!(given.statistics.mse < 1e-20, "{}", given.statistics.mse);
        let found = published::model().compare_from(&step(), &InitialState::Estimated, 25).unwrap();
        assert_relative_eq!(found.initial[0], 21.0, max_relative = 1e-9);
        assert_eq!(found.statistics.parameters, 1);
        assert_relative_eq!(published::model().compare(&step()).unwrap(), 100.0, max_relative = 1e-9);
    }

    #[test]
    fn a_zero_state_leaves_its_decay_in_the_errors() {
        let zero = published::model().compare_from(&step(), &InitialState::Zero, 25).unwrap();
        for (time_s, error) in zero.residuals.time_s.iter().zip(&zero.residuals.values) {
            let decay = 21.0 * (-published::POLE_PER_S * (time_s - 500.0)).exp();
            assert_relative_eq!(*error, decay, epsilon = 1e-9);
        }
    }
}
