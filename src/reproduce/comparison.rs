//! Paper, here, and why they differ: the table that closes the report.
use super::Reproduction;
use super::cylinder::SLOPE_OF_PAPER_BAR_K;
use super::table_1::TABLE_1;
use crate::estimator::identify::published;
use crate::report::number;
use crate::thermal::units::BAR_PA;
use serde_json::{Value, json};

/// One question.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Comparison {
    /// Of what.
    pub what: &'static str,
    /// What the paper says.
    pub paper: String,
    /// What comes out here.
    pub here: String,
    /// Why they differ, or that they do not.
    pub why: String,
}

impl Comparison {
    /// As JSON.
    pub(crate) fn to_json(&self) -> Value {
        json!({ "what": self.what, "paper": self.paper, "here": self.here, "why": self.why })
    }

    /// As a row of a table.
    pub(crate) fn cells(&self) -> Vec<String> {
        vec![self.what.to_owned(), self.paper.clone(), self.here.clone(), self.why.clone()]
    }
}

/// Names of the columns.
pub(crate) const HEADER: [&str; 4] = ["what", "paper", "here", "why they differ"];

fn n(value: f64, digits: usize) -> String {
    number(value, digits)
}

/// All answers, in the order of the paper.
pub(crate) fn comparisons(results: &Reproduction) -> Vec<Comparison> {
    let mut all = of_the_gas(results);
    all.extend(of_the_model(results));
    all.extend(of_the_monitor(results));
    all
}

fn of_the_gas(results: &Reproduction) -> Vec<Comparison> {
    let (section, tight) = (&results.section_2, &results.tight);
    vec![
        Comparison {
            what: "gas mass",
            paper: format!("{} kg", n(section.paper_kg, 3)),
            here: format!("{} kg", n(section.real_kg, 4)),
            why: format!(
                "ideal gas at 20 °C there; here Z = {} at 200 bar and 15 °C",
                n(section.compressibility, 5)
            ),
        },
        Comparison {
            what: "heat capacity, steel to gas",
            paper: "about 2 to 1".into(),
            here: format!("{} to 1", n(section.real_ratio(), 3)),
            why: format!(
                "the gas is held at constant volume: c_v = {} J/(kg K), not 1000",
                n(section.real_cv_j_kg_k, 3)
            ),
        },
        Comparison {
            what: "slope of the pressure",
            paper: format!("{SLOPE_OF_PAPER_BAR_K} bar/°C"),
            here: format!("{} bar/K", n(tight.slope_bar_k, 3)),
            why: format!(
                "a real gas at 200 bar and 15 °C; the ideal gas has {}. The paper's slope is that of a cylinder filled to {} bar: so was \
                 its test vessel, probably",
                n(tight.slope_ideal_bar_k, 3),
                n(tight.fill_of_paper_bar, 4)
            ),
        },
        Comparison {
            what: "tight, full, at \u{2212}25 °C",
            paper: "alarm below 160 bar".into(),
            here: format!("reads {} bar", n(tight.pressure_cold_bar, 5)),
            why: "the pressure switch calls cold a failure: the reason for all of this".into(),
        },
    ]
}

fn of_the_model(results: &Reproduction) -> Vec<Comparison> {
    let study = &results.identification;
    let [shoulder, valve] = &study.rows;
    let pole = |found: &crate::estimator::identify::Identified| found.model.den[1];
    let s = &shoulder.statistics;
    let [paper_shoulder, paper_valve] = &TABLE_1;
    let offset = study.largest_gain.map_or_else(String::new, |(offset_k, gain)| {
        format!("; no constant offset makes it: {} K give the most, {}", n(offset_k, 2), n(gain, 4))
    });
    let worst = |rms: fn(&super::identification::Validation) -> [f64; 3], start: usize| {
        study.validations.iter().map(|validation| rms(validation)[start]).fold(0.0, f64::max)
    };
    vec![
        Comparison {
            what: "pole, shoulder to gas",
            paper: format!("{} 1/s ({:.0} s)", published::POLE_PER_S, 1.0 / published::POLE_PER_S),
            here: format!("{} 1/s ({:.0} s)", n(pole(shoulder), 4), 1.0 / pole(shoulder)),
            why: format!(
                "{:+.0} %: mounting and outside film are assumed (15 %, 20 W/m²/K); a thermometer that reads 10 to 20 % of the way to the \
                 air moves the pole from 0.0043 to 0.0027",
                100.0 * (pole(shoulder) / published::POLE_PER_S - 1.0)
            ),
        },
        Comparison {
            what: "steady-state gain",
            paper: n(published::model().gain(), 5),
            here: n(shoulder.model.gain(), 4),
            why: format!(
                "at rest all temperatures are equal, a gain beside 1 is no physics{offset}; a reading drawn to the room by {:.1} % of the \
                 difference would",
                100.0 * study.share_of_gain
            ),
        },
        Comparison {
            what: "table 1, shoulder: fit, MSE",
            paper: format!("{} %, {} K²", paper_shoulder.fit_percent, paper_shoulder.mse_k2),
            here: format!("{:.2} %, {} K²", s.fit_percent, n(s.mse, 3)),
            why: "the simulated chamber has no noise, and what made the gain is not in it".into(),
        },
        Comparison {
            what: "table 1, valve: fit, MSE",
            paper: format!("{} %, {} K²", paper_valve.fit_percent, paper_valve.mse_k2),
            here: format!("{:.2} %, {} K²", valve.statistics.fit_percent, n(valve.statistics.mse, 3)),
            why: "with equal mounting the shoulder is ahead here; which of the two is, mounting decides, not the place".into(),
        },
        Comparison {
            what: "samples, spread of the gas",
            paper: format!("{:.0}, {:.1} K (from FPE, MSE and fit)", paper_shoulder.samples(2.0), paper_shoulder.output_sd_k()),
            here: format!("{}, {:.1} K", s.samples, study.record.gas_sd_k()),
            why: "agree: the scenarios were a sample a minute for 6.45 h".into(),
        },
        Comparison {
            what: "figure 3, start at the gas",
            paper: "\u{201c}a good result\u{201d}, no number".into(),
            here: format!(
                "published {} K rms at worst, identified here {} K",
                n(worst(|v| v.published_rms_k, 1), 3),
                n(worst(|v| v.identified_rms_k, 1), 2)
            ),
            why: "the published gain leaves 0.8 K at \u{2212}25 °C and 1.3 K at 40 °C at rest".into(),
        },
        Comparison {
            what: "figure 3, start at zero",
            paper: "a transient".into(),
            here: format!("published {} K rms at worst", n(worst(|v| v.published_rms_k, 2), 3)),
            why: "the transient of 331 s from 0 °C; a first value removes it, as the paper says".into(),
        },
    ]
}

fn of_the_monitor(results: &Reproduction) -> Vec<Comparison> {
    let missing = &results.tunnel.method_run.missing_bar;
    let largest = |method: usize| missing[method].iter().fold(0.0, |most: f64, e| most.max(e.abs()));
    let said = results.figure_8_statements();
    let minutes = |delay: Option<f64>| delay.map_or("never".into(), |delay| format!("{delay:.0} min"));
    let rate = results.leak[1].method_run.finding.map(|finding| finding.rate_pa_s);
    let rate = rate.map_or_else(String::new, |rate| {
        let [value, low, high] = [rate.value, rate.low, rate.high].map(|pa_s| pa_s * 3600.0 / BAR_PA);
        format!("; {value:.2} bar/h ({low:.2} to {high:.2})")
    });
    vec![
        Comparison {
            what: "figure 6, tight in the tunnel",
            paper: "expected and actual pressure are one".into(),
            here: format!(
                "missing at most: published {:.1} bar, refitted {:.1}, observer {:.2}",
                largest(0),
                largest(1),
                largest(2)
            ),
            why: "there the cylinder is the model itself; here it has a wall and a real gas".into(),
        },
        Comparison {
            what: "figure 8, its own scheme",
            paper: "the error rises from t2 on".into(),
            here: format!(
                "alarm {} after t2, {} bar/h",
                minutes(results.scheme.alarm_s.map(|alarm_s| (alarm_s - super::passage::ONSET_S) / 60.0)),
                n(results.scheme.rate_bar_h, 3)
            ),
            why: "agree; threshold (0.1 bar), holding time (10 min) and loss (3 bar/h) are not stated and chosen here".into(),
        },
        Comparison {
            what: "figure 8, a cylinder losing 60 g/h",
            paper: "not shown".into(),
            here: format!(
                "alarm after {} (published, threshold {} bar), {} (refitted, {} bar), {} (monitor){rate}",
                minutes(said[0].delay_min),
                n(said[0].threshold_bar.unwrap_or(f64::NAN), 2),
                minutes(said[1].delay_min),
                n(said[1].threshold_bar.unwrap_or(f64::NAN), 2),
                minutes(said[2].delay_min)
            ),
            why: "the thermal error sets the threshold of the first two, not the noise of 10 mbar".into(),
        },
    ]
}
