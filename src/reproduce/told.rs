//! The reproduction as a story: what the report and the terminal show.
use super::beside::{LeakScore, ScenarioScore, Spread};
use super::identification::Identification;
use super::passage::{LEAK_G_H, ONSET_S};
use super::scheme::Scheme;
use super::table_1::TABLE_1;
use super::watch::WHO;
use super::{Reproduction, answers, figures, rows};
use crate::estimator::identify::{Identified, published};
use crate::report::figure::{Part, Picture, Sheet};
use crate::report::{Story, number, simulation};
use crate::thermal::units::PASCAL_PER_BAR;

/// What one of those who watch figure 8's cylinder says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Said {
    /// Who.
    pub who: &'static str,
    /// Its threshold, bar; `None`: one of its own kind.
    pub threshold_bar: Option<f64>,
    /// From the onset to the alarm, min.
    pub delay_min: Option<f64>,
    /// Loss at the end, bar/h.
    pub rate_bar_h: Option<f64>,
    /// Time to the limit from the end on, h.
    pub left_h: Option<f64>,
}

impl Reproduction {
    /// What those who watch say about the simulated cylinder of figure 8. The first two alarm at a tenth more than what lasted in the same passage of
    /// a tight cylinder.
    pub fn figure_8_said(&self) -> [Said; 3] {
        let [tight, leaking] = [&self.leak[0].watched, &self.leak[1].watched];
        let hours = 3600.0;
        [0, 1, 2].map(|who| {
            let threshold_bar = (who < 2).then(|| 1.1 * tight.largest_lasting_bar(who));
            let alarm_s = threshold_bar
                .map_or(leaking.found_s, |threshold_bar| leaking.alarm_s(who, threshold_bar, ONSET_S));
            let loss = leaking.losses.get(who).copied().flatten();
            let found = leaking.finding.map(|finding| finding.rate_pa_s.value);
            let rate_bar_h = if who < 2 { loss.map(|loss| loss.rate_pa_s) } else { found }
                .map(|rate| rate * hours / PASCAL_PER_BAR);
            let above_bar =
                leaking.pressure_bar.last().map(|bar| bar - super::watch::LIMIT_PA / PASCAL_PER_BAR);
            let left_h =
                above_bar.zip(rate_bar_h).filter(|(_, rate)| *rate > 0.0).map(|(bar, rate)| bar / rate);
            Said {
                who: WHO[who],
                threshold_bar,
                delay_min: alarm_s.map(|alarm_s| (alarm_s - ONSET_S) / 60.0),
                rate_bar_h,
                left_h,
            }
        })
    }

    /// Alarms on the simulated cylinder of figure 8, s.
    fn figure_8_alarms_s(&self) -> [Option<f64>; 3] {
        self.figure_8_said().map(|said| said.delay_min.map(|delay_min| ONSET_S + 60.0 * delay_min))
    }

    /// The schemes of figures 4, 5 and 7, as they run.
    fn schemes(&self) -> Picture {
        let schemes = [Scheme::figure_4(), Scheme::figure_5(), Scheme::figure_7(self.seed)];
        let parts = schemes.into_iter().flatten().map(|scheme| Part::Diagram(scheme.diagram())).collect();
        Picture::Sheet(Sheet { title: "Figures 4, 5 and 7: the data's way".into(), parts })
    }

    /// All pictures with the names of their files.
    pub(super) fn pictures(&self) -> Vec<(String, Picture)> {
        let mut all: Vec<(String, Picture)> = self
            .scenarios
            .iter()
            .chain([&self.closed])
            .map(|of| (of.name.to_owned(), Picture::Figure(simulation::figure(&of.run, &of.readings))))
            .collect();
        let mut add = |name: &str, picture| all.push((name.to_owned(), picture));
        add("figure-2", Picture::Figure(figures::figure_2(&self.identification)));
        add("figure-3", Picture::Figure(figures::figure_3(&self.identification)));
        add("tight-cylinder", Picture::Figure(figures::tight(&self.tight)));
        add("figure-4-5-7", self.schemes());
        add("figure-6", Picture::Figure(figures::figure_6(&self.scheme, &self.tunnel)));
        let alarms_s = self.figure_8_alarms_s();
        add("figure-8", Picture::Figure(figures::figure_8(&self.scheme, &self.leak[1], alarms_s)));
        for (k, score) in self.beside.iter().enumerate() {
            add(&format!("observer-scenario-{}", k + 1), Picture::Figure(figures::beside(score)));
        }
        add("blowdown-i1", Picture::Figure(figures::blowdown(&self.blowdown)));
        all
    }

    /// Everything in the order of the paper.
    pub fn story(&self) -> Story {
        let pictures = self.pictures();
        let show = |story: Story, name: &str, caption: &str| match pictures
            .iter()
            .find(|(found, _)| found == name)
        {
            Some((_, picture)) => story.picture(picture.clone(), caption),
            None => story,
        };
        let mut story = Story::new("The paper rebuilt, and what an observer adds").text(LEAD);
        story = self.gas(story);
        story = show(
            story,
            "tight-cylinder",
            "Pressure of a tight, rigid cylinder filled to 200 bar at 15 °C. The published slope belongs to a fill of 175 bar.",
        );
        story = story.heading("Figure 1: scenario 2, a tunnel in winter").text(FIGURE_1);
        story = show(
            story,
            "tunnel-winter",
            "The quantities of the paper\u{2019}s figure 1, computed: ambient, shoulder, valve, wall, gas, pressure. Broken lines are what sensors read that feel 15 % of the air.",
        );
        story = self.table_1(story);
        story = show(
            story,
            "figure-2",
            "From a start at 0 °C the published function needs half an hour; afterwards its gain leaves an error of its own.",
        );
        story = self.figure_3(story);
        story = show(story, "figure-3", "Errors beyond 4 K, of the start at zero, are left out.");
        story = story.heading("Figures 4, 5 and 7: the way of the data").text(FIGURE_4);
        story = show(
            story,
            "figure-4-5-7",
            "Each box is a stage of the program, and what is drawn is what computed figures 6 and 8.",
        );
        story = story.heading("Figure 6: into the tunnel").text(FIGURE_6);
        story = show(
            story,
            "figure-6",
            "Above the paper\u{2019}s scheme, below a simulated cylinder that nobody who watches it knows. Nothing is missing in either.",
        );
        story = self.figure_8(story);
        story = show(
            story,
            "figure-8",
            "Rings are alarms. Refitted and observer are zeroed on the ten minutes before the tunnel, the published one is not.",
        );
        story = self.drawn(story);
        for k in 1..=self.beside.len() {
            story = show(
                story,
                &format!("observer-scenario-{k}"),
                "One of the drawn cylinders. The band is what the observer states of itself.",
            );
        }
        story = self.drawn_leaks(story);
        story = story.heading("The model against measurement and other programs").text(MEASURED);
        story = show(
            story,
            "blowdown-i1",
            "The only measurement here: nitrogen from 150 bar through an orifice. The 20 L cylinder\u{2019}s chamber curves are not published as data.",
        );
        let table = rows::rows(self);
        story = story.rows(
            "Numbers beside their references",
            &rows::HEADER,
            table.iter().map(rows::Row::cells).collect(),
        );
        let (header, lines) = rows::scenarios(self);
        story = story.rows("Scenarios: ends, solver, balances", &header, lines);
        for name in ["shock-cold", "ramp-warm", "cool-down", "bottle-step"] {
            story = show(story, name, "");
        }
        story
            .heading("Paper, here, and why they differ")
            .rows("", &answers::HEADER, answers::answers(self).iter().map(answers::Answer::cells).collect())
            .text(LIMITS)
    }

    /// What a terminal shows: the numbers that compare.
    pub fn text(&self) -> String {
        let mut story = Story::new("");
        story = self.table_1(story);
        story = self.figure_8(story);
        story = self.drawn(story);
        story = self.drawn_leaks(story);
        let table = rows::rows(self);
        story = story.rows(
            "Numbers beside their references",
            &rows::HEADER,
            table.iter().map(rows::Row::cells).collect(),
        );
        let answers = answers::answers(self)
            .into_iter()
            .map(|answer| vec![answer.what.to_owned(), answer.paper, answer.here]);
        story = story.rows(
            "Paper and here; why they differ stands in the report",
            &["what", "paper", "here"],
            answers.collect(),
        );
        story.blocks.retain(|block| !matches!(block, crate::report::Block::Text(_)));
        story.to_text()
    }

    fn gas(&self, story: Story) -> Story {
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
        story.heading("Section 2: how much gas, how much heat").text(SECTION_2).rows(
            "",
            &["", "paper", "real gas"],
            rows,
        )
    }

    fn table_1(&self, story: Story) -> Story {
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
        story.heading("Table 1 and figure 2: identification").text(TABLE).rows(
            "Table 1: scenarios 1 and 2, thermometer to mean gas temperature",
            &header,
            rows,
        )
    }

    fn figure_3(&self, story: Story) -> Story {
        let study: &Identification = &self.identification;
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
        story.heading("Figure 3: validation").text(FIGURE_3).rows(
            "Root mean square errors in K",
            &header,
            rows,
        )
    }

    fn figure_8(&self, story: Story) -> Story {
        let or_never =
            |value: Option<f64>, digits: usize| value.map_or("never".into(), |value| number(value, digits));
        let mut rows = vec![vec![
            "published, its own scheme".to_owned(),
            number(super::scheme::THRESHOLD_BAR, 2),
            or_never(self.scheme.alarm_s.map(|alarm_s| (alarm_s - ONSET_S) / 60.0), 3),
            number(self.scheme.rate_bar_h, 3),
            number(self.scheme.left_h, 3),
        ]];
        rows.extend(self.figure_8_said().iter().map(|said| {
            vec![
                format!("{}, cylinder", said.who),
                said.threshold_bar.map_or_else(|| "its own".into(), |bar| number(bar, 2)),
                or_never(said.delay_min, 3),
                or_never(said.rate_bar_h, 3),
                or_never(said.left_h, 3),
            ]
        }));
        let header = ["who", "threshold in bar", "delay in min", "loss in bar/h", "to 160 bar in h"];
        story
            .heading("Figure 8: a leak after the tunnel")
            .text(format!(
                "{FIGURE_8} The cylinder loses {LEAK_G_H} g/h, {:.2} bar/h at 15 °C.",
                self.leaks.first().map_or(f64::NAN, |leak| leak.leak_bar_h)
            ))
            .rows("Figure 8: what is said of the leak", &header, rows)
    }

    fn drawn(&self, story: Story) -> Story {
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
        let gas = self.beside.iter().map(|score| row(score, &score.gas_k, score.bound_k)).collect();
        let missing =
            self.beside.iter().map(|score| row(score, &score.missing_bar, score.bound_bar)).collect();
        let mut header = vec![""];
        header.extend(WHO);
        header.push("bound");
        let covered = self.beside.iter().map(|score| 100.0 * score.covered).sum::<f64>()
            / self.beside.len().max(1) as f64;
        story
            .heading("The same scenarios on cylinders that nobody knows")
            .text(format!("{DRAWN} {} cylinders for each. {covered:.0} % of the true temperatures lie within two of the observer\u{2019}s standard deviations.", self.cylinders))
            .rows("Error of the mean gas temperature in K, root mean square (least to largest of a cylinder)", &header, gas)
            .rows("Pressure that seems to be missing in bar, root mean square (least to largest of a cylinder)", &header, missing)
    }

    fn drawn_leaks(&self, story: Story) -> Story {
        let mut rows = Vec::new();
        for leak in &self.leaks {
            for who in 0..3 {
                rows.push(leak_row(leak, who));
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
        story
            .heading("Leaks after the tunnel on cylinders that nobody knows")
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

fn leak_row(leak: &LeakScore, who: usize) -> Vec<String> {
    let name =
        if who == 0 { format!("{} g/h, {:.2} bar/h", leak.leak_g_h, leak.leak_bar_h) } else { String::new() };
    let threshold = leak.threshold_bar.get(who).map_or_else(|| "its own".into(), |bar| number(*bar, 2));
    let of_all = |count: usize| format!("{count} of {}", leak.cylinders);
    let (early, found) = (of_all(leak.false_alarms[who]), of_all(leak.delay_min[who].len()));
    let mut delays = leak.delay_min[who].clone();
    delays.sort_by(f64::total_cmp);
    let delay = median(&delays).map_or("never".into(), |median| format!("{median:.0}"));
    let mut rates = leak.rate_bar_h[who].clone();
    rates.sort_by(f64::total_cmp);
    let rate = match (rates.first(), median(&rates), rates.last()) {
        (Some(low), Some(middle), Some(high)) => format!("{middle:.2} ({low:.2} to {high:.2})"),
        _ => "none said".into(),
    };
    vec![name, WHO[who].into(), threshold, early, found, delay, rate]
}

/// Middle of sorted values.
fn median(sorted: &[f64]) -> Option<f64> {
    let n = sorted.len();
    (n > 0).then(|| 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]))
}

const LEAD: &str = "Every figure and table of H. Bücking, R. Pfaff, R. Dirksmeier, Sensor positioning and thermal model for condition \
     monitoring of pressure gas reservoirs in vehicles, from the model instead of the measurement, beside the paper\u{2019}s own numbers; then the \
     same cases with an observer and a detector. The last table says where paper and model differ, and why.";
const SECTION_2: &str = "The paper estimates mass and heat capacities with the ideal gas. The model has the reference equation of state of \
     nitrogen (Span et al. 2000).";
const FIGURE_1: &str = "The 20 L steel cylinder in a chamber whose air jumps from \u{2212}25 to 40 °C. Film outside (20 W/m²/K) and mounting are assumed: \
     the paper does not state them.";
const TABLE: &str = "A first-order transfer function by output error with its start estimated, as MATLAB\u{2019}s tfest does, from a sample a minute. \
     Refitted is the same with the gain held at 1, the only one that physics allows; the comparisons below use it with a real gas.";
const FIGURE_3: &str =
    "The models on scenarios 3 and 4, which they were not identified from, with and without a first value.";
const FIGURE_4: &str = "The transfer function makes a gas temperature of the shoulder\u{2019}s, the slope a pressure of that; less the pressure that is read, it is \
     the error. A threshold that is exceeded for ten minutes is a leak, the slope of the error its rate.";
const FIGURE_6: &str = "The paper steps the shoulder itself from \u{2212}10 to 35 °C. On a simulated cylinder the air steps, and the published expectation is off \
     by bars where nothing is missing.";
const FIGURE_8: &str = "The paper subtracts a steady loss and noise of 10 mbar from its own expectation. On a simulated cylinder, detectors by threshold \
     get the lowest one at which they are silent in the same passage of a tight cylinder, and a tenth more; the monitor has its own, for one false alarm \
     in ten years.";
const DRAWN: &str = "Cylinders with drawn films, capacities, mounting and sensor errors, gusts, and stratified gas. The observer knows the nominal \
     cylinder, reads shoulder, valve and pressure, and is zeroed on the hour before, as the refitted scheme is; the published scheme is as published. Bound: \
     what no estimator goes below in a world that is the observer\u{2019}s own model with its uncertainty; in this world, which is another one, it is what could be hoped for. \
     Of the pressure it counts the gas temperature alone: the drawn transmitters also drift by 1 to 2.4 bar over 65 K, which no one knows at first. \
     All start cold; what ten days of learning make of the observer stands in the book\u{2019}s table of measured numbers.";
const DRAWN_LEAKS: &str = "Thresholds of the detectors without an observer: the lowest at which they are silent on as many other tight cylinders in the same \
     passage, and a tenth more: they are made for this tunnel. Before it: alarms before the leak has begun. Bound: when a filter at rest could know of it at the monitor\u{2019}s rate of false alarms, and \
     the standard deviation of its rate at the end.";
const MEASURED: &str = "Closed forms, reference values and the balances of every run are in the tests; here is what can be seen.";
const LIMITS: &str = "Only simulated: all that concerns the 20 L cylinder. Film coefficients and mounting are assumed, the paper\u{2019}s measured curves are not \
     published as data.";
