//! The measures of runs that the judge shares with the bench.
pub use crate::performance::bench::{AlarmLevel, Trace, alarm_level};
pub use crate::performance::{
    Class, Delay, Detection, Estimated, Horizon, Proportion, Reached, Run, SmallestLeak, TrueLeak, by_rate,
};
