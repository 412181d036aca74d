//! What the statistics say, in plain words.
use std::fmt;

use serde::Serialize;

use super::{Band, Coverage, Lilliefors, NisAccumulator, Significance};

/// What a test says of an estimator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// Nothing speaks against a correct filter.
    Consistent,
    /// Deviations are larger than stated.
    TooConfident,
    /// Deviations are smaller than stated.
    TooCautious,
    /// Innovations depend on earlier ones.
    Correlated,
    /// Innovations are not normal.
    NotNormal,
    /// There is too little to say anything.
    TooFew,
}

impl Finding {
    /// Judgement of a mean of squares by its band.
    pub(super) fn of_mean_square(mean: f64, band: Band) -> Self {
        match () {
            () if band.contains(mean) => Self::Consistent,
            () if mean < band.low => Self::TooCautious,
            () => Self::TooConfident,
        }
    }

    /// Whether nothing speaks against a correct filter.
    pub fn is_consistent(self) -> bool {
        self == Self::Consistent
    }

    /// In plain words.
    pub(crate) fn as_str(self) -> &'static str {
        match self {
            Self::Consistent => "as stated",
            Self::TooConfident => "larger than stated: the filter is too confident",
            Self::TooCautious => "smaller than stated: the filter is too cautious",
            Self::Correlated => "correlated in time: the model misses something slow",
            Self::NotNormal => "not normal",
            Self::TooFew => "too few to tell",
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Normalised innovations squared of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NisReport {
    /// Mean of `nu^2/S` before the gate, 1 for a correct filter; NaN without readings.
    pub mean: f64,
    /// The same of the accepted readings.
    pub mean_accepted: f64,
    /// Degrees of freedom: number of readings.
    pub readings: u64,
    /// Readings that the gate did not pass.
    pub refused: u64,
    /// Band of the mean; `None` without readings.
    pub band: Option<Band>,
    /// What it says.
    pub finding: Finding,
}

impl NisReport {
    pub(super) fn of(nis: &NisAccumulator, significance: Significance) -> Self {
        Self {
            mean: nis.mean(),
            mean_accepted: nis.mean_accepted(),
            readings: nis.dof(),
            refused: nis.refused(),
            band: nis.band(significance),
            finding: nis.finding(significance),
        }
    }
}

/// One output of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputReport {
    /// Name of the output.
    pub name: String,
    /// Its normalised innovations squared.
    pub nis: NisReport,
    /// Lag, in samples, of the largest autocorrelation by size, and that autocorrelation.
    pub largest_autocorrelation: Option<(usize, f64)>,
    /// Bound on the largest one.
    pub autocorrelation_bound: Option<f64>,
    /// What all lags together say.
    pub whiteness: Finding,
}

/// Statistics of a run and what they say.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConsistencyReport {
    /// Probability with which each test calls a correct filter wrong.
    pub significance: Significance,
    /// All outputs together.
    pub nis: NisReport,
    /// Each output.
    pub outputs: Vec<OutputReport>,
    /// Normality of the innovations of all outputs; `None`: too few.
    pub lilliefors: Option<Lilliefors>,
    /// What it says.
    pub normality: Finding,
    /// Share of samples whose 95 % band holds the truth, by the quantity's name; empty where the truth is not known.
    pub coverage: Vec<(String, Coverage)>,
}

impl fmt::Display for ConsistencyReport {
    /// One line for each statement, without a line break at the end.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "innovations: {}", size(&self.nis))?;
        for output in &self.outputs {
            write!(f, "\n  {}: {}", output.name, size(&output.nis))?;
            match (output.largest_autocorrelation, output.autocorrelation_bound) {
                (Some((lag, rho)), Some(bound)) => write!(
                    f,
                    "; autocorrelation at most {rho:.3} at lag {lag} (bound {bound:.3}), {}",
                    white(output.whiteness)
                )?,
                _ => write!(f, "; autocorrelation: {}", Finding::TooFew)?,
            }
        }
        match &self.lilliefors {
            Some(test) => write!(
                f,
                "\ndistribution: Lilliefors distance {:.4} of {} values, {}",
                test.distance,
                test.values,
                if self.normality.is_consistent() { "normal as far as they tell" } else { "not normal" }
            )?,
            None => write!(f, "\ndistribution: {}", Finding::TooFew)?,
        }
        for (name, coverage) in &self.coverage {
            write!(
                f,
                "\n{name}: the 95 % band holds the truth in {:.1} % of the samples",
                100.0 * coverage.share()
            )?;
        }
        Ok(())
    }
}

fn white(finding: Finding) -> &'static str {
    if finding == Finding::Consistent { "independent as far as they tell" } else { finding.as_str() }
}

fn size(nis: &NisReport) -> String {
    let Some(band) = nis.band else { return Finding::TooFew.to_string() };
    let refused = match nis.refused {
        0 => String::new(),
        refused => format!(" ({refused} refused by the gate; {:.3} without them)", nis.mean_accepted),
    };
    format!(
        "mean of nu^2/S {:.3}, band {:.3} to {:.3}, {} readings{refused}: {}",
        nis.mean, band.low, band.high, nis.readings, nis.finding
    )
}
