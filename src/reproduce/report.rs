//! The report of the reproduction, and what a terminal shows of it.
use super::methods::METHODS;
use super::paragraphs::{FIGURE_1, FIGURE_4, FIGURE_6, LEAD, LIMITS, MEASURED};
use super::passage::ONSET_S;
use super::scheme::Scheme;
use super::{Reproduction, checks, comparison, figures};
use crate::report::figure::{Part, Picture};
use crate::report::{Report, simulation};
use crate::thermal::units::BAR_PA;
use Section::{Figure, Heading, Results, Text};

/// What a method states about the cylinder of figure 8.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LeakStatement {
    /// Who.
    pub method: &'static str,
    /// Its threshold, bar; `None`: one of its own kind.
    pub threshold_bar: Option<f64>,
    /// From the onset to the alarm, min.
    pub delay_min: Option<f64>,
    /// Loss at the end, bar/h.
    pub rate_bar_h: Option<f64>,
    /// Time to the limit from the end on, h.
    pub left_h: Option<f64>,
}

/// A part of the report.
enum Section {
    /// A paragraph.
    Text(&'static str),
    /// A heading with its paragraph.
    Heading(&'static str, &'static str),
    /// Tables, with what explains them.
    Results(fn(&Reproduction, Report) -> Report),
    /// A picture by the name of its file, with its caption.
    Figure(&'static str, &'static str),
}

const DRAWN_CAPTION: &str = "One of the drawn cylinders. The band is what the observer states of itself.";

/// The report, in the order of the paper.
const SECTIONS: &[Section] = &[
    Text(LEAD),
    Results(Reproduction::gas),
    Figure(
        "tight-cylinder",
        "Pressure of a tight, rigid cylinder filled to 200 bar at 15 °C. The published slope belongs to a fill of 175 bar.",
    ),
    Heading("Figure 1: scenario 2, a tunnel in winter", FIGURE_1),
    Figure(
        "tunnel-winter",
        "The quantities of the paper\u{2019}s figure 1, computed: ambient, shoulder, valve, wall, gas, pressure. Broken lines are what sensors read that feel 15 % of the air.",
    ),
    Results(Reproduction::table_1),
    Figure(
        "figure-2",
        "From a start at 0 °C the published function needs half an hour; afterwards its gain leaves an error of its own.",
    ),
    Results(Reproduction::figure_3),
    Figure("figure-3", "Errors beyond 4 K, of the start at zero, are left out."),
    Heading("Figures 4, 5 and 7: data flow", FIGURE_4),
    Figure(
        "figure-4-5-7",
        "Each box is a stage of the program, and what is drawn is what computed figures 6 and 8.",
    ),
    Heading("Figure 6: into the tunnel", FIGURE_6),
    Figure(
        "figure-6",
        "Above the paper\u{2019}s scheme, below a simulated cylinder that is unknown to all methods. Both are tight.",
    ),
    Results(Reproduction::figure_8),
    Figure(
        "figure-8",
        "Rings are alarms. Refitted and observer are zeroed on the ten minutes before the tunnel, the published one is not.",
    ),
    Results(Reproduction::drawn),
    Figure("observer-scenario-1", DRAWN_CAPTION),
    Figure("observer-scenario-2", DRAWN_CAPTION),
    Figure("observer-scenario-3", DRAWN_CAPTION),
    Figure("observer-scenario-4", DRAWN_CAPTION),
    Results(Reproduction::drawn_leaks),
    Heading("The model against measurement and other programs", MEASURED),
    Figure(
        "blowdown-i1",
        "The only measurement here: nitrogen from 150 bar through an orifice. The 20 L cylinder\u{2019}s chamber curves are not published as data.",
    ),
    Results(Reproduction::checks),
    Results(Reproduction::balances),
    Figure("shock-cold", ""),
    Figure("ramp-warm", ""),
    Figure("cool-down", ""),
    Figure("bottle-step", ""),
    Heading("Paper, here, and why they differ", ""),
    Results(Reproduction::comparisons),
    Text(LIMITS),
];

impl Reproduction {
    /// Statements of the methods about the simulated cylinder of figure 8. The first two alarm at 1.1 times the error that lasted in the same passage of
    /// a tight cylinder.
    pub(crate) fn figure_8_statements(&self) -> [LeakStatement; 3] {
        let [tight, leaking] = [&self.leak[0].method_run, &self.leak[1].method_run];
        let hours = 3600.0;
        [0, 1, 2].map(|method| {
            let threshold_bar = (method < 2).then(|| 1.1 * tight.largest_lasting_bar(method));
            let alarm_s = threshold_bar
                .map_or(leaking.found_s, |threshold_bar| leaking.alarm_s(method, threshold_bar, ONSET_S));
            let loss = leaking.losses.get(method).copied().flatten();
            let found = leaking.finding.map(|finding| finding.rate_pa_s.value);
            let rate_bar_h = if method < 2 { loss.map(|loss| loss.rate_pa_s) } else { found }
                .map(|rate| rate * hours / BAR_PA);
            let above_bar = leaking.pressure_bar.last().map(|bar| bar - super::methods::LIMIT_PA / BAR_PA);
            let left_h =
                above_bar.zip(rate_bar_h).filter(|(_, rate)| *rate > 0.0).map(|(bar, rate)| bar / rate);
            LeakStatement {
                method: METHODS[method],
                threshold_bar,
                delay_min: alarm_s.map(|alarm_s| (alarm_s - ONSET_S) / 60.0),
                rate_bar_h,
                left_h,
            }
        })
    }

    /// Alarms on the simulated cylinder of figure 8, s.
    fn figure_8_alarms_s(&self) -> [Option<f64>; 3] {
        self.figure_8_statements().map(|said| said.delay_min.map(|delay_min| ONSET_S + 60.0 * delay_min))
    }

    /// The schemes of figures 4, 5 and 7, as they run.
    fn schemes(&self) -> Picture {
        let schemes = [Scheme::figure_4(), Scheme::figure_5(), Scheme::figure_7(self.seed)];
        let parts = schemes.iter().map(|scheme| Part::Diagram(scheme.diagram())).collect();
        Picture { title: "Figures 4, 5 and 7: the data's way".into(), parts }
    }

    /// All pictures with the names of their files.
    pub(super) fn pictures(&self) -> Vec<(String, Picture)> {
        let mut all: Vec<(String, Picture)> = self
            .scenarios
            .iter()
            .chain([&self.closed])
            .map(|of| (of.name.to_owned(), simulation::figure(&of.run, &of.readings).into()))
            .collect();
        let mut add = |name: &str, picture| all.push((name.to_owned(), picture));
        add("figure-2", figures::figure_2(&self.identification).into());
        add("figure-3", figures::figure_3(&self.identification));
        add("tight-cylinder", figures::tight(&self.tight).into());
        add("figure-4-5-7", self.schemes());
        add("figure-6", figures::figure_6(&self.scheme, &self.tunnel));
        let alarms_s = self.figure_8_alarms_s();
        add("figure-8", figures::figure_8(&self.scheme, &self.leak[1], alarms_s));
        for (k, score) in self.drawn_cylinders.iter().enumerate() {
            add(&format!("observer-scenario-{}", k + 1), figures::drawn_cylinder(score).into());
        }
        add("blowdown-i1", figures::blowdown(&self.blowdown).into());
        all
    }

    /// Everything in the order of the paper.
    pub(crate) fn report(&self) -> Report {
        self.report_with(&self.pictures())
    }

    /// The report with pictures that are made.
    pub(super) fn report_with(&self, pictures: &[(String, Picture)]) -> Report {
        let title = Report::new("The paper rebuilt, and what an observer adds");
        SECTIONS.iter().fold(title, |report, section| match *section {
            Text(paragraph) => report.text(paragraph),
            Heading(words, paragraph) => report.heading(words).text(paragraph),
            Results(results) => results(self, report),
            Figure(name, caption) => match pictures.iter().find(|(known, _)| known == name) {
                Some((_, picture)) => report.picture(picture.clone(), caption),
                None => report,
            },
        })
    }

    fn checks(&self, report: Report) -> Report {
        let rows = checks::checks(self).iter().map(checks::Check::cells).collect();
        report.rows("Numbers beside their references", &checks::HEADER, rows)
    }

    fn balances(&self, report: Report) -> Report {
        let (header, rows) = checks::scenarios(self);
        report.rows("Scenarios: ends, solver, balances", &header, rows)
    }

    fn comparisons(&self, report: Report) -> Report {
        let rows = comparison::comparisons(self).iter().map(comparison::Comparison::cells).collect();
        report.rows("", &comparison::HEADER, rows)
    }

    /// What a terminal shows: the numbers that compare.
    pub(crate) fn text(&self) -> String {
        let results =
            [Self::table_1, Self::figure_8, Self::drawn, Self::drawn_leaks, Self::checks, Self::answers];
        let mut report = results.into_iter().fold(Report::new(""), |report, results| results(self, report));
        report.blocks.retain(|block| !matches!(block, crate::report::Block::Text(_)));
        report.to_text()
    }

    /// The comparison without its reasons.
    fn answers(&self, report: Report) -> Report {
        let rows = comparison::comparisons(self)
            .into_iter()
            .map(|answer| vec![answer.what.to_owned(), answer.paper, answer.here]);
        report.rows(
            "Paper and here; why they differ stands in the report",
            &["what", "paper", "here"],
            rows.collect(),
        )
    }
}
