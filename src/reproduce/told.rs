//! The reproduction as a story: what the report and the terminal show.
use super::passage::ONSET_S;
use super::scheme::Scheme;
use super::watch::WHO;
use super::words::{FIGURE_1, FIGURE_4, FIGURE_6, LEAD, LIMITS, MEASURED};
use super::{Reproduction, answers, figures, rows};
use crate::report::figure::{Part, Picture, Sheet};
use crate::report::{Story, simulation};
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
        let parts = schemes.iter().map(|scheme| Part::Diagram(scheme.diagram())).collect();
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
        self.story_with(&self.pictures())
    }

    /// The story around pictures that are made.
    pub(super) fn story_with(&self, pictures: &[(String, Picture)]) -> Story {
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
        story = story.heading("Figures 4, 5 and 7: data flow").text(FIGURE_4);
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
}
