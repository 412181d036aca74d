//! What the best layouts achieve in Monte Carlo runs, beside what is predicted.
use super::{GRAM, GRAM_PER_HOUR, KELVIN, PlacementReport, Unit};
use crate::evaluation::placement::{Achieved, Confirmed, Detected};
use crate::report::Report;

impl PlacementReport<'_> {
    /// Errors and smallest leaks in the observer's own world, then in drawn ones.
    pub(super) fn achieved(&self) -> Report {
        let Some(closed_loop) = self.closed_loop else { return Report::default() };
        let parts = [
            self.errors("In the observer's own world, a calm one", &closed_loop.matched),
            self.leaks("Smallest leak there", &closed_loop.matched_leaks),
            self.errors("In drawn cylinders in railway weather", &closed_loop.mismatched),
            self.leaks("Smallest leak there", &closed_loop.mismatched_leaks),
        ];
        parts.into_iter().fold(Report::default(), Report::then)
    }

    fn errors(&self, title: &str, of: &[Confirmed]) -> Report {
        let Some(first) = of.first() else { return Report::default() };
        let header = [
            "layout",
            "gas K: predicted",
            "stated",
            "achieved [95 %]",
            "mass g: predicted",
            "stated",
            "achieved [95 %]",
        ];
        let row = |of: &Confirmed| {
            let mut cells = vec![self.chosen(&of.layout)];
            for (achieved, unit) in [(&of.gas_k, KELVIN), (&of.mass_kg, GRAM)] {
                cells.push(achieved.predicted.map_or(String::new(), |sd| unit.number(sd)));
                cells.push(unit.number(achieved.stated));
                cells.push(with_interval(achieved, unit));
            }
            cells
        };
        let title = format!("{title}: errors over {} runs", first.seeds);
        Report::default().rows(title, &header, of.iter().map(row).collect())
    }

    fn leaks(&self, title: &str, of: &[Detected]) -> Report {
        let Some(first) = of.first() else { return Report::default() };
        let leak = GRAM_PER_HOUR.with_symbol(first.leak_kg_s);
        let found = format!("{leak} found");
        let header = ["layout", "predicted g/h", "achieved g/h", "sd", "mean", "answer", &found, "predicted"];
        let row = |of: &Detected| {
            vec![
                self.chosen(&of.layout),
                GRAM_PER_HOUR.number(of.predicted_kg_s),
                GRAM_PER_HOUR.number(of.achieved_kg_s),
                format!("{:.2}", of.sd),
                format!("{:+.2}", of.mean),
                format!("{:.2}", of.answer),
                format!("{:.0} %", 100.0 * of.found),
                format!("{:.0} %", 100.0 * of.found_predicted),
            ]
        };
        let explained = "sd, mean: of the best statistic without a leak, predicted 1 and 0; answer: what the leak moves it by, in \
                         parts of the predicted; achieved: the smallest leak with these";
        let title = format!("{title}, over {} runs with and without", first.seeds);
        Report::default().explained_rows(title, &header, of.iter().map(row).collect(), explained)
    }
}

fn with_interval(of: &Achieved, unit: Unit) -> String {
    format!("{} [{}, {}]", unit.number(of.rms), unit.number(of.interval.low), unit.number(of.interval.high))
}
