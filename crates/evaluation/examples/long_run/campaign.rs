//! Which cylinders are run: training, test, test with stratified gas, seasons, leaks. No seed is used twice.
use cylwatch_evaluation::truth::{Course, TruthLeak, TruthSettings};

use crate::truths::{Run, SETS};

const DAY_S: f64 = 86_400.0;
/// A third of a year.
const WINTER_D: f64 = 122.0;
/// Before a leak begins, d.
const LEARNING_D: f64 = 10.0;
/// Nitrogen in 20 L for 1 bar at 15 °C and 200 bar, kg.
const KG_PER_BAR: f64 = 0.019_18;
/// Leak rates, bar/h.
pub const RATES_BAR_H: [f64; 21] = [
    0.001, 0.0012, 0.0015, 0.002, 0.003, 0.005, 0.01, 0.012, 0.015, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5,
    1.0, 2.0, 3.0, 5.0, 10.0,
];

/// A part of the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Leak-free winters that thresholds are fitted to: half with stratified, half with well-mixed gas.
    Train,
    /// Leak-free winters with well-mixed gas.
    Test,
    /// Leak-free winters with stratified gas.
    Stratified,
    /// Leak-free years with all seasons.
    Seasons,
    /// Winters with a leak.
    Leaks,
}

impl Part {
    /// By its name on the command line.
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "train" => Self::Train,
            "test" => Self::Test,
            "stratified" => Self::Stratified,
            "seasons" => Self::Seasons,
            "leaks" => Self::Leaks,
            _ => return None,
        })
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Test => "test",
            Self::Stratified => "stratified",
            Self::Seasons => "seasons",
            Self::Leaks => "leaks",
        }
    }

    /// Simulated cylinders, each with its sets of sensors.
    pub fn groups(self) -> Vec<Vec<Run>> {
        let winter = Course::RailwayWeeks { days: WINTER_D };
        let year = Course::RailwayYear { days: 365.0 };
        let tight = |seeds: std::ops::Range<u64>, course: &Course, settings: &TruthSettings| {
            seeds.map(|seed| sets(course, seed, settings)).collect::<Vec<_>>()
        };
        let (mixed, layers) = (TruthSettings::fast(), stratified());
        match self {
            Self::Train => {
                interleaved(tight(30_001..30_025, &winter, &layers), tight(10_001..10_025, &winter, &mixed))
            }
            Self::Test => tight(20_001..20_155, &winter, &mixed),
            Self::Stratified => tight(40_001..40_013, &winter, &layers),
            Self::Seasons => tight(50_001..50_013, &year, &mixed),
            Self::Leaks => {
                (60_001..60_011).flat_map(|seed| RATES_BAR_H.map(|rate| leaking(seed, rate))).collect()
            }
        }
    }
}

/// Four layers of gas, otherwise as fast as can be.
fn stratified() -> TruthSettings {
    TruthSettings { gas_cells: 4, ..TruthSettings::fast() }
}

fn interleaved(a: Vec<Vec<Run>>, b: Vec<Vec<Run>>) -> Vec<Vec<Run>> {
    a.into_iter().zip(b).flat_map(|(a, b)| [a, b]).collect()
}

fn sets(course: &Course, seed: u64, settings: &TruthSettings) -> Vec<Run> {
    let run = |set| Run::new(course.clone(), seed, set, settings.clone());
    (0..SETS).map(run).collect()
}

/// A leak that begins on the eleventh day, at a time of day that is spread evenly over the seeds.
fn leaking(seed: u64, rate_bar_h: f64) -> Vec<Run> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let start_s = DAY_S * (LEARNING_D + (seed as f64 * GOLDEN).fract());
    let after_d = match rate_bar_h {
        rate if rate >= 0.5 => 1.5,
        rate if rate >= 0.03 => 8.0,
        _ => 30.5,
    };
    let leak = TruthLeak { rate_kg_s: rate_bar_h * KG_PER_BAR / 3600.0, start_s };
    let course = Course::RailwayWeeks { days: LEARNING_D + 1.0 + after_d };
    sets(&course, seed, &TruthSettings { leak: Some(leak), ..TruthSettings::fast() })
}

/// Rate of a run's leak, bar/h; 0 without one.
pub fn rate_bar_h(run: &Run) -> f64 {
    run.settings.leak.map_or(0.0, |leak| {
        let rate = leak.rate_kg_s * 3600.0 / KG_PER_BAR;
        RATES_BAR_H.into_iter().min_by(|a, b| (a - rate).abs().total_cmp(&(b - rate).abs())).unwrap_or(rate)
    })
}
