//! Profile likelihood of one parameter: the least sum of squares over all others, as a function of this one.
//!
//! The interval is where it has risen by `q^2 f`, with the normal quantile `q` of the confidence and the factor `f` that the
//! sandwich puts on this parameter's variance. Unlike the covariance it follows a curved or one-sided likelihood.
//!
//! Source: Raue et al. 2009.
use super::solve::search;
use super::uncertainty::{of_free, prior_information};
use super::{CalibrateError, Calibrated};
use crate::least_squares::invert;

/// Trials on each side.
const TRIALS: usize = 12;

/// Share of the rise at which the end of the interval is found.
const RISE_TOLERANCE: f64 = 0.02;

/// A profile, in the parameter's unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Place of the parameter in the list.
    pub parameter: usize,
    /// Values that were tried, increasing, with the rise of the sum of squares over its least one, divided by `f`.
    pub points: Vec<(f64, f64)>,
    /// Interval of the settings' confidence; an end at a bound is open.
    pub interval: (f64, f64),
    /// Whether the lower and the upper end are where the sum has risen, not a bound.
    pub closed: (bool, bool),
}

impl Calibrated {
    /// Profile of a parameter by its place in the list; each point is a calibration of all others.
    ///
    /// # Errors
    /// [`CalibrateError::ParameterUnknown`], that of a search, or [`CalibrateError::Stopped`].
    pub fn profile(&self, parameter: usize) -> Result<Profile, CalibrateError> {
        let parameters = self.fit.specs.len();
        if parameter >= parameters || self.solution.held[parameter] {
            return Err(CalibrateError::ParameterUnknown { index: parameter, parameters });
        }
        let mut points = vec![(self.solution.z[parameter], 0.0)];
        let (low, low_closed) = self.profile_end(parameter, -1.0, &mut points)?;
        let (high, high_closed) = self.profile_end(parameter, 1.0, &mut points)?;
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let spec = &self.fit.specs[parameter];
        Ok(Profile {
            parameter,
            points: points.into_iter().map(|(z, rise)| (spec.value(z), rise)).collect(),
            interval: (spec.value(low), spec.value(high)),
            closed: (low_closed, high_closed),
        })
    }

    /// Where the sum has risen enough on one side, by secants of its root, which is nearly linear.
    fn profile_end(
        &self,
        parameter: usize,
        side: f64,
        points: &mut Vec<(f64, f64)>,
    ) -> Result<(f64, bool), CalibrateError> {
        let quantile = self.fit.settings.quantile();
        let (sd, factor) = self.coordinate_sd(parameter);
        let (low, high) = self.fit.specs[parameter].bounds_coordinate();
        let middle = self.solution.z[parameter];
        let bound = if side < 0.0 { low } else { high };
        // Distances from the estimate: the largest that is inside, the smallest that is outside.
        let (mut inside, mut outside) = ((0.0, 0.0), None::<(f64, f64)>);
        let mut distance = quantile * sd;
        for _ in 0..TRIALS {
            distance = distance.min((bound - middle).abs());
            let z = middle + side * distance;
            let rise = self.rise_at(parameter, z)? / factor;
            points.push((z, rise));
            let root = rise.max(0.0).sqrt();
            if (root / quantile - 1.0).abs() < 0.5 * RISE_TOLERANCE {
                return Ok((z, true));
            }
            if root < quantile {
                if z == bound {
                    return Ok((bound, false));
                }
                inside = (distance, root);
            } else {
                outside = Some((distance, root));
            }
            distance = match outside {
                Some((far, high)) => {
                    let share = (quantile - inside.1) / (high - inside.1);
                    inside.0 + (far - inside.0) * share.clamp(0.1, 0.9)
                }
                None => distance * (quantile / root.max(0.3 * quantile)).max(1.1),
            };
        }
        Ok((middle + side * distance, outside.is_some()))
    }

    /// Least sum of squares with the parameter fixed, less the least of all.
    fn rise_at(&self, parameter: usize, z: f64) -> Result<f64, CalibrateError> {
        let mut held = self.solution.held.clone();
        held[parameter] = true;
        let mut start = self.conditional_start(parameter, z);
        start[parameter] = z;
        Ok(self.fit.unless_stopped(search(&self.fit, start, &held))?.cost - self.solution.cost)
    }

    /// The others moved along with the parameter as their covariance says.
    fn conditional_start(&self, parameter: usize, z: f64) -> Vec<f64> {
        let covariance = &self.covariance;
        let slope =
            |i: usize| if self.fit.specs[i].kind.is_positive() { self.estimates[i].value } else { 1.0 };
        let variance = covariance[(parameter, parameter)] / slope(parameter).powi(2);
        let moved = |(i, (at, spec)): (usize, (&f64, &super::ParameterSpec))| {
            let along = covariance[(i, parameter)] / (slope(i) * slope(parameter));
            let (low, high) = spec.bounds_coordinate();
            (at + along / variance * (z - self.solution.z[parameter])).clamp(low, high)
        };
        self.solution.z.iter().zip(&self.fit.specs).enumerate().map(moved).collect()
    }

    /// Standard deviation in the search's coordinate, and the sandwich's factor on the variance.
    fn coordinate_sd(&self, parameter: usize) -> (f64, f64) {
        let estimate = &self.estimates[parameter];
        let positive = self.fit.specs[parameter].kind.is_positive();
        let sd = if positive { estimate.sd / estimate.value } else { estimate.sd };
        let free: Vec<usize> = (0..self.fit.specs.len()).filter(|&i| !self.solution.held[i]).collect();
        let information =
            self.solution.jacobian.tr_mul(&self.solution.jacobian) + prior_information(&self.fit);
        let plain = invert(&of_free(&information, &free));
        let place = free.iter().position(|&i| i == parameter);
        let variance = plain.zip(place).map_or(sd * sd, |(plain, place)| plain[(place, place)]);
        (sd, sd * sd / variance)
    }
}
