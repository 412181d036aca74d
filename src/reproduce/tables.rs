//! The tables of the report: numbers of the paper beside those from here.
use super::Reproduction;
use super::drawn_cylinders::{LeakScore, ScenarioScore, Spread};
use super::methods::METHODS;
use super::paragraphs::{DRAWN, DRAWN_LEAKS, FIGURE_3, FIGURE_8, SECTION_2, TABLE};
use super::passage::{LEAK_G_H, ONSET_S};
use super::table_1::TABLE_1;
use crate::estimator::identify::{Identified, published};
use crate::report::{Report, number};

impl Reproduction {
    pub(super) fn gas(&self, report: Report) -> Report {
        let s = &self.section_2;
        let t = &self.tight;
        let row = |what: &str, paper: String, here: String| vec![what.to_owned(), paper, here];
        let rows = vec![
            row("gas mass", format!("{:.1} kg", s.paper_kg), format!("{:.3} kg", s.real_kg)),
            row("heat capacity of the steel", format!("{:.1} kJ/K", s.steel_j_k / 1e3), "the same".into()),
            row(
                "heat capacity of the gas",
                format!("{:.1} kJ/K", s.paper_j_k / 1e3),
                format!("{:.2} kJ/K", s.real_j_k / 1e3),
            ),
            row(
                "steel to gas",
                format!("{:.1}, \u{201c}about 2\u{201d}", s.paper_ratio()),
                format!("{:.1}", s.real_ratio()),
            ),
            row(
                "slope of the pressure at the fill",
                "0.8457 bar/°C".into(),
                format!("{:.3} bar/K", t.slope_bar_k),
            ),
            row("the same, ideal gas", String::new(), format!("{:.3} bar/K", t.slope_ideal_bar_k)),
            row(
                "fill with the paper\u{2019}s slope",
                String::new(),
                format!("{:.1} bar at 15 °C", t.fill_of_paper_bar),
            ),
            row(
                "tight at \u{2212}25 °C",
                "alarm below 160 bar".into(),
                format!("{:.1} bar", t.pressure_cold_bar),
            ),
        ];
        report.heading("Section 2: how much gas, how much heat").text(SECTION_2).rows(
            "",
            &["", "paper", "real gas"],
            rows,
        )
    }

    pub(super) fn table_1(&self, report: Report) -> Report {
        let study = &self.identification;
        let mut rows = Vec::new();
        for (paper, found) in TABLE_1.iter().zip(&study.rows) {
            let place = format!("{:?}", paper.place).to_lowercase();
            let is_shoulder = rows.is_empty();
            let published = |value: String| if is_shoulder { value } else { String::new() };
            rows.push(vec![
                place.clone(),
                "published".into(),
                published(format!("{}", -published::POLE_PER_S)),
                published(number(published::model().gain(), 5)),
                format!("{:.2}", paper.fit_percent),
                number(paper.fpe_k2, 4),
                number(paper.mse_k2, 4),
            ]);
            rows.push(identified(&place, "here", found));
        }
        rows.push(identified("shoulder", "refitted, gain 1", &study.refitted));
        let header = ["from", "", "pole in 1/s", "gain", "fit in %", "FPE in K²", "MSE in K²"];
        report.heading("Table 1 and figure 2: identification").text(TABLE).rows(
            "Table 1: scenarios 1 and 2, thermometer to mean gas temperature",
            &header,
            rows,
        )
    }

    pub(super) fn figure_3(&self, report: Report) -> Report {
        let study = &self.identification;
        let mut rows = Vec::new();
        for validation in &study.validations {
            for (name, rms) in
                [("published", validation.published_rms_k), ("identified here", validation.identified_rms_k)]
            {
                let mut cells = vec![format!("scenario {}", validation.scenario), name.to_owned()];
                cells.extend(rms.map(|rms| format!("{rms:.2}")));
                rows.push(cells);
            }
        }
        let header = ["", "model", "start fitted", "start at the gas", "start at zero"];
        report.heading("Figure 3: validation").text(FIGURE_3).rows(
            "Root mean square errors in K",
            &header,
            rows,
        )
    }

    pub(super) fn figure_8(&self, report: Report) -> Report {
        let or_never =
            |value: Option<f64>, digits: usize| value.map_or("never".into(), |value| number(value, digits));
        let mut rows = vec![vec![
            "published, its own scheme".to_owned(),
            number(super::scheme::THRESHOLD_BAR, 2),
            or_never(self.scheme.alarm_s.map(|alarm_s| (alarm_s - ONSET_S) / 60.0), 3),
            number(self.scheme.rate_bar_h, 3),
            number(self.scheme.left_h, 3),
        ]];
        rows.extend(self.figure_8_statements().iter().map(|said| {
            vec![
                format!("{}, cylinder", said.method),
                said.threshold_bar.map_or_else(|| "its own".into(), |bar| number(bar, 2)),
                or_never(said.delay_min, 3),
                or_never(said.rate_bar_h, 3),
                or_never(said.left_h, 3),
            ]
        }));
        let header = ["who", "threshold in bar", "delay in min", "loss in bar/h", "to 160 bar in h"];
        report
            .heading("Figure 8: a leak after the tunnel")
            .text(format!(
                "{FIGURE_8} The cylinder loses {LEAK_G_H} g/h, {:.2} bar/h at 15 °C.",
                self.leaks.first().map_or(f64::NAN, |leak| leak.leak_bar_h)
            ))
            .rows("Figure 8: what is said of the leak", &header, rows)
    }

    pub(super) fn drawn(&self, report: Report) -> Report {
        let spread = |spread: &Spread, digits: usize| {
            format!(
                "{} ({} to {})",
                number(spread.value, digits),
                number(spread.low, digits),
                number(spread.high, digits)
            )
        };
        let row = |score: &ScenarioScore, values: &[Spread; 3], bound: f64| {
            let mut cells = vec![score.title.clone()];
            cells.extend(values.iter().map(|value| spread(value, 2)));
            cells.push(number(bound, 2));
            cells
        };
        let gas = self.drawn_cylinders.iter().map(|score| row(score, &score.gas_k, score.bound_k)).collect();
        let missing = self
            .drawn_cylinders
            .iter()
            .map(|score| row(score, &score.missing_bar, score.bound_bar))
            .collect();
        let mut header = vec![""];
        header.extend(METHODS);
        header.push("bound");
        let covered = self.drawn_cylinders.iter().map(|score| 100.0 * score.covered).sum::<f64>()
            / self.drawn_cylinders.len().max(1) as f64;
        report
            .heading("The same scenarios on cylinders unknown to the observer")
            .text(format!("{DRAWN} {} cylinders for each. {covered:.0} % of the true temperatures lie within two of the observer\u{2019}s standard deviations.", self.cylinders))
            .rows("Error of the mean gas temperature in K, root mean square (least to largest of a cylinder)", &header, gas)
            .rows("Pressure that seems to be missing in bar, root mean square (least to largest of a cylinder)", &header, missing)
    }

    pub(super) fn drawn_leaks(&self, report: Report) -> Report {
        let mut rows = Vec::new();
        for leak in &self.leaks {
            for method in 0..3 {
                rows.push(leak_row(leak, method));
            }
            let bound = leak.bound_min.map_or("never".into(), |minutes| number(minutes, 2));
            let rate = format!("sd {}", number(leak.bound_bar_h, 2));
            let empty = String::new;
            rows.push(vec![empty(), "bound".into(), empty(), empty(), empty(), bound, rate]);
        }
        let header =
            ["leak", "who", "threshold in bar", "before it", "found", "median delay in min", "loss in bar/h"];
        let caption =
            "Leaks 50 min after the tunnel\u{2019}s mouth, watched for 2 h 10 min (losses: least to largest)";
        report
            .heading("Leaks after the tunnel on cylinders unknown to the observer")
            .text(DRAWN_LEAKS)
            .rows(caption, &header, rows)
    }
}

fn identified(place: &str, name: &str, found: &Identified) -> Vec<String> {
    let s = &found.statistics;
    vec![
        place.to_owned(),
        name.to_owned(),
        number(-found.model.den[1], 4),
        number(found.model.gain(), 4),
        format!("{:.2}", s.fit_percent),
        number(s.fpe, 3),
        number(s.mse, 3),
    ]
}

fn leak_row(leak: &LeakScore, method: usize) -> Vec<String> {
    let name = if method == 0 {
        format!("{} g/h, {:.2} bar/h", leak.leak_g_h, leak.leak_bar_h)
    } else {
        String::new()
    };
    let threshold = leak.threshold_bar.get(method).map_or_else(|| "its own".into(), |bar| number(*bar, 2));
    let of_all = |count: usize| format!("{count} of {}", leak.cylinders);
    let (early, found) = (of_all(leak.false_alarms[method]), of_all(leak.delay_min[method].len()));
    let mut delays = leak.delay_min[method].clone();
    delays.sort_by(f64::total_cmp);
    let delay = median(&delays).map_or("never".into(), |median| format!("{median:.0}"));
    let mut rates = leak.rate_bar_h[method].clone();
    rates.sort_by(f64::total_cmp);
    let rate = match (rates.first(), median(&rates), rates.last()) {
        (Some(low), Some(middle), Some(high)) => format!("{middle:.2} ({low:.2} to {high:.2})"),
        _ => "none said".into(),
    };
    vec![name, METHODS[method].into(), threshold, early, found, delay, rate]
}

/// Middle of sorted values.
fn median(sorted: &[f64]) -> Option<f64> {
    let n = sorted.len();
    (n > 0).then(|| 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]))
}
