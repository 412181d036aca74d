//! What layouts are ranked by.
use serde::{Deserialize, Serialize};

use super::course::{AlongCourse, Course, CourseNumber};
use super::objective::{Objective, Relaxed};
use super::site::{Site, SmallestLeak};
use super::{GroupedProblem, Quantity};
use crate::EstimatorError;

/// One physical number by which layouts are ranked; the smaller, the better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Criterion {
    /// Standard deviation of the mean gas temperature at rest, K.
    GasTemperature,
    /// Of the mass, kg.
    Mass,
    /// Of the leak rate, kg/s.
    LeakRate,
    /// Smallest leak that is found in time, kg/s.
    SmallestLeak,
    /// A number of the gas temperature along the first scenario, K.
    Course(CourseNumber),
}

impl Criterion {
    /// Those of a cylinder at rest.
    pub(crate) const AT_REST: [Self; 4] =
        [Self::GasTemperature, Self::Mass, Self::LeakRate, Self::SmallestLeak];

    /// All, in the order of a list.
    pub const ALL: [Self; 8] = [
        Self::GasTemperature,
        Self::Mass,
        Self::LeakRate,
        Self::SmallestLeak,
        Self::Course(CourseNumber::Mean),
        Self::Course(CourseNumber::Worst),
        Self::Course(CourseNumber::Schmidt),
        Self::Course(CourseNumber::WorstCase),
    ];

    /// One word.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::GasTemperature => "gas-temperature",
            Self::Mass => "mass",
            Self::LeakRate => "leak-rate",
            Self::SmallestLeak => "smallest-leak",
            Self::Course(CourseNumber::Mean) => "course-mean",
            Self::Course(CourseNumber::Worst) => "course-worst",
            Self::Course(CourseNumber::Schmidt) => "robust-mean",
            Self::Course(CourseNumber::WorstCase) => "robust-worst",
        }
    }

    /// Words for people.
    pub fn words(self) -> &'static str {
        match self {
            Self::GasTemperature => "sd of the mean gas temperature",
            Self::Mass => "sd of the gas mass",
            Self::LeakRate => "sd of the leak rate",
            Self::SmallestLeak => "smallest leak found in time",
            Self::Course(CourseNumber::Mean) => "mean sd of the gas temperature along the scenario",
            Self::Course(CourseNumber::Worst) => "largest sd of the gas temperature along the scenario",
            Self::Course(CourseNumber::Schmidt) => "mean sd of the gas temperature with model error",
            Self::Course(CourseNumber::WorstCase) => {
                "largest error of the gas temperature in the worst variant"
            }
        }
    }

    /// Whether it is convex in the weights of sensors, so that a bound can be proven without looking at every layout.
    pub fn is_convex(self) -> bool {
        matches!(self, Self::GasTemperature | Self::Mass | Self::LeakRate)
    }

    /// What is searched for.
    ///
    /// # Errors
    /// [`EstimatorError::PlacementConstraints`]: a number of a course, but there is none.
    pub(super) fn worth<'a>(
        self,
        site: &'a Site,
        courses: &'a [Course],
    ) -> Result<Worth<'a>, EstimatorError> {
        let quantity = match self {
            Self::GasTemperature => Quantity::GasTemperature,
            Self::Mass => Quantity::Mass,
            Self::LeakRate => Quantity::LeakRate,
            Self::SmallestLeak => return Ok(Worth::Leak(SmallestLeak(site))),
            Self::Course(number) => {
                let what = format!("the criterion {} is that of a scenario; name one", self.as_str());
                let course = courses.first().ok_or(EstimatorError::PlacementConstraints { what })?;
                return Ok(Worth::Along(AlongCourse { course, number }, site));
            }
        };
        Ok(Worth::Steady(site.problem(quantity)))
    }
}

/// The square of a criterion as an objective.
#[derive(Clone, Copy, Debug)]
pub(super) enum Worth<'a> {
    Steady(&'a GroupedProblem),
    Leak(SmallestLeak<'a>),
    /// Of layouts that see every state at rest: a course ends before what is not seen has grown.
    Along(AlongCourse<'a>, &'a Site),
}

impl Objective for Worth<'_> {
    fn candidates(&self) -> usize {
        match self {
            Self::Steady(of) => of.candidates(),
            Self::Leak(of) => of.candidates(),
            Self::Along(of, _) => of.candidates(),
        }
    }

    fn value(&self, layout: &[usize]) -> f64 {
        match self {
            Self::Steady(of) => of.value(layout),
            Self::Leak(of) => of.value(layout),
            Self::Along(_, site) if site.certainty(layout).is_err() => f64::INFINITY,
            Self::Along(of, _) => of.value(layout),
        }
    }

    fn relaxed(&self, weights: &[f64]) -> Option<Relaxed> {
        match self {
            Self::Steady(of) => of.relaxed(weights),
            Self::Leak(of) => of.relaxed(weights),
            Self::Along(of, _) => of.relaxed(weights),
        }
    }
}
