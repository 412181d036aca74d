//! Units that durations and pressures are written in.
pub(crate) use crate::estimator::thermal::units::{
    ATMOSPHERE_PA, BAR_PA, DAY_S, HOUR_S, MINUTE_S, QUOTED_K, YEAR_S,
};
