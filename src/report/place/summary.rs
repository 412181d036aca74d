//! A study as a report: the answer and what was asked, then one table after the other.
use super::faults::unseen;
use super::{BAR, DIGITS, GRAM, GRAM_PER_HOUR, HOUR, KELVIN, PlacementReport};
use crate::estimator::placement::study::{BestLayouts, Failure};
use crate::report::{Report, number};
use crate::thermal::units::DAY_S;
use crate::thermal::units::ZERO_CELSIUS_K;

impl PlacementReport<'_> {
    /// Answer, question, tables.
    pub(crate) fn summary(&self) -> Report {
        self.answer().then(self.tables())
    }

    /// The best layouts with what they are worth, and what was asked.
    pub(crate) fn answer(&self) -> Report {
        let mut report = Report::new(format!("Where sensors should sit: {}", self.study.vessel));
        if self.is_partial() {
            report = report.text("PARTIAL: the search was ended early, what is here is not all");
        }
        if self.study.numbers.is_empty() {
            report = report.text("No layout was looked at before the end.");
        }
        let best = self.study.numbers.iter().filter_map(|number| self.worth(number));
        let lost = self.study.failures.iter().map(|failure| self.lost(failure));
        let lost =
            lost.enumerate().map(|(k, words)| (if k == 0 { "one lost" } else { "" }.to_owned(), words));
        let asked = self.asked().into_iter().map(|(name, value)| (name.to_owned(), value));
        report.facts(best.chain(lost).chain(asked))
    }

    /// One table after the other.
    pub(crate) fn tables(&self) -> Report {
        let parts = [
            self.best_layouts(),
            self.refused(),
            self.judged_layouts(),
            self.differences(),
            self.along_scenarios(),
            self.fronts(),
            self.losses(),
            self.faults(),
            self.biases(),
            self.positions(),
            self.by_paper(),
            self.achieved(),
        ];
        parts.into_iter().fold(Report::default(), Report::then)
    }

    /// Tables for people, at most 110 characters wide.
    pub(crate) fn text(&self) -> String {
        self.summary().to_text()
    }

    /// The best layout of a number of sensors, and what it is worth.
    fn worth(&self, of: &BestLayouts) -> Option<(String, String)> {
        let best = of.layouts.first()?;
        let judged = self.study.judged.iter().find(|judged| judged.sensors == best.sensors)?;
        let better = of.marginal.filter(|by| *by < 0.0);
        let better = better.map_or(String::new(), |by| {
            format!(", {} % better than {}", number(-100.0 * by, 2), of.sensors - 1)
        });
        let words = format!(
            "{}: sd of gas {}, of mass {}; finds {} in {}{better}",
            self.names(&best.sensors),
            KELVIN.with_symbol(judged.steady.gas_sd_k),
            GRAM.with_symbol(judged.steady.mass_sd_kg),
            GRAM_PER_HOUR.with_symbol(judged.steady.smallest_leak_kg_s),
            self.within(),
        );
        let sensors = if of.sensors == 1 { "sensor" } else { "sensors" };
        Some((format!("best {} {sensors}", of.sensors), words))
    }

    /// What the best layout of most sensors is worth without one of them.
    fn lost(&self, failure: &Failure) -> String {
        let name = self.name(failure.sensor);
        match &failure.without {
            Some(left) => format!(
                "without {name}: sd of gas {}; finds {}",
                KELVIN.with_symbol(left.gas_sd_k),
                GRAM_PER_HOUR.with_symbol(left.smallest_leak_kg_s)
            ),
            None => format!("without {name}: {}", unseen(failure)),
        }
    }

    /// Time in which a leak is to be found.
    fn within(&self) -> String {
        let within_s = self.study.settings.steady.detection.within_s;
        if within_s < DAY_S {
            return HOUR.with_symbol(within_s);
        }
        format!("{} d", number(within_s / DAY_S, DIGITS))
    }

    /// Question and conditions of the study.
    fn asked(&self) -> Vec<(&'static str, String)> {
        let study = self.study;
        let settings = &study.settings;
        let (conditions, detection) = (&settings.steady.conditions, &settings.steady.detection);
        let degc = |kelvin: f64| format!("{} °C", number(kelvin - ZERO_CELSIUS_K, DIGITS));
        let budget = if settings.budget.is_finite() {
            format!(", at a cost of at most {}", number(settings.budget, 4))
        } else {
            String::new()
        };
        let required = self.required().map_or(String::new(), |names| format!(", {names} in every layout"));
        let (pressure_pa, filled_k) = conditions.filling;
        let air = if conditions.air_k == conditions.body_k {
            String::new()
        } else {
            format!(" in air of {}", degc(conditions.air_k))
        };
        let along = match &*study.scenarios {
            [] => "none, at rest only".into(),
            names => names.join("; "),
        };
        let per = conditions.interval_s;
        let interval =
            if per < 60.0 { format!("{per} s") } else { format!("{} min", number(per / 60.0, DIGITS)) };
        vec![
            (
                "candidates",
                format!("{}, up to {} sensors{required}", study.candidates.len(), settings.sensors),
            ),
            ("best by", format!("{}{budget}", settings.criterion.description())),
            (
                "at rest",
                format!(
                    "at {}{air}, filled to {} at {}, read every {interval}",
                    degc(conditions.body_k),
                    BAR.with_symbol(pressure_pa),
                    degc(filled_k)
                ),
            ),
            ("scenarios", along),
            (
                "found",
                format!(
                    "with 95 % within {}, at a threshold of {} sd",
                    self.within(),
                    number(detection.threshold_sd, DIGITS)
                ),
            ),
            ("delay", format!("of a leak of {}", GRAM_PER_HOUR.with_symbol(settings.leak_kg_s))),
        ]
    }
}
