//! The best layouts for each number of sensors, and the same and others by every number.
use super::{DIGITS, GRAM, GRAM_PER_HOUR, HOUR, KELVIN, PlacementReport, Unit};
use crate::estimator::placement::ScenarioMeasure;
use crate::estimator::placement::search::Method;
use crate::estimator::placement::study::{BestLayouts, EvaluatedLayout, Infeasible, Proof};
use crate::report::{Report, number};

/// Layouts near the best that are named.
const LISTED_LAYOUTS: usize = 3;
/// What a ranking may differ by and still be one, relative.
const TIE_TOLERANCE: f64 = 1e-3;

/// A number that layouts are judged by: its column, and its SI value.
type Measure = (&'static str, Unit, fn(&EvaluatedLayout) -> Option<f64>);

/// What the filter states of itself at rest.
const COVARIANCE_MEASURES: [Measure; 3] = [
    ("gas K", KELVIN, |of| Some(of.steady.gas_sd_k)),
    ("mass g", GRAM, |of| Some(of.steady.mass_sd_kg)),
    ("leak g/h", GRAM_PER_HOUR, |of| Some(of.steady.leak_sd_kg_s)),
];
/// What a leak is found by.
const LEAK_MEASURE: Measure = ("finds g/h", GRAM_PER_HOUR, |of| Some(of.steady.smallest_leak_kg_s));
const DELAY: Measure = ("delay h", HOUR, |of| of.delay_s);
/// With model error, along the first scenario.
const ROBUST: [Measure; 2] = [
    ("robust K", KELVIN, |of| Some(ScenarioMeasure::Schmidt.of(of.scenarios.first()?))),
    ("worst K", KELVIN, |of| Some(ScenarioMeasure::WorstCase.of(of.scenarios.first()?))),
];

impl PlacementReport<'_> {
    /// For each number of sensors the best by the criterion, and what it cannot fall below.
    pub(super) fn best_layouts(&self) -> Report {
        let criterion = self.study.settings.criterion;
        let unit = Unit::of(criterion);
        let value = format!("value / {}", unit.symbol);
        let percent = number(100.0 * self.study.settings.within, DIGITS);
        let near = format!("within {percent} %");
        let header = ["sensors", "best layout", &value, "bound", "gap", "relaxed", "change", &near, "search"];
        let row = |number: &BestLayouts| {
            let best = number.layouts.first();
            vec![
                number.sensors.to_string(),
                best.map_or(String::new(), |best| self.chosen(&best.sensors)),
                best.map_or(String::new(), |best| unit.number(best.value)),
                if number.proof == Proof::None { "none".into() } else { unit.number(number.bound) },
                if number.proof == Proof::None { String::new() } else { share(number.gap()) },
                share(number.relaxation_gap()),
                number.marginal.map_or(String::new(), |by| format!("{:+.1} %", 100.0 * by)),
                number.layouts.len().to_string(),
                searched(number),
            ]
        };
        let rows: Vec<Vec<String>> = self.study.numbers.iter().map(row).collect();
        let title = format!("Best layouts by the {}", criterion.description());
        let explained = "gap: of the best to what the search or the relaxation proves; relaxed: to the convex relaxation \
                         alone; change: against one sensor less";
        Report::default().explained_rows(title, &header, rows, explained).remark(self.near_best())
    }

    /// The first few that are as good as the best.
    fn near_best(&self) -> String {
        let unit = Unit::of(self.study.settings.criterion);
        let line = |number: &BestLayouts| {
            let others = number.layouts.iter().skip(1).take(LISTED_LAYOUTS);
            let named: Vec<String> = others
                .map(|layout| format!("{} ({})", self.chosen(&layout.sensors), unit.number(layout.value)))
                .collect();
            let more = number.layouts.len().saturating_sub(1 + LISTED_LAYOUTS);
            let more = if more > 0 { format!("; {more} more") } else { String::new() };
            (!named.is_empty()).then(|| format!("  {}: {}{more}\n", number.sensors, named.join("; ")))
        };
        let lines: String = self.study.numbers.iter().filter_map(line).collect();
        if lines.is_empty() { lines } else { format!("nearly as good:\n{lines}") }
    }

    /// Numbers of sensors without a layout.
    pub(super) fn refused(&self) -> Report {
        let line = |of: &Infeasible| format!("no layout of {}: {}\n", of.sensors, of.reason);
        Report::default().text(self.study.refused.iter().map(line).collect::<String>())
    }

    /// Layouts by every number, the best of each number of sensors marked.
    pub(super) fn judged_layouts(&self) -> Report {
        let study = self.study;
        let mut measures: Vec<Measure> = COVARIANCE_MEASURES.to_vec();
        measures.extend([LEAK_MEASURE, DELAY]);
        if !study.scenarios.is_empty() {
            measures.extend(ROBUST);
        }
        let mut header = vec!["n", "layout"];
        header.extend(measures.iter().map(|(name, ..)| *name));
        header.push("cost");
        let row = |judged: &EvaluatedLayout| {
            let mut cells = vec![judged.sensors.len().to_string(), self.chosen(&judged.sensors)];
            for (_, unit, of) in &measures {
                let best = self.best_of(judged.sensors.len(), *of).and_then(of);
                let value = of(judged);
                let mark = if value.is_some() && value == best { "*" } else { " " };
                cells.push(value.map_or("never ".into(), |value| format!("{}{mark}", unit.number(value))));
            }
            cells.push(number(judged.cost, 4));
            cells
        };
        let rows: Vec<Vec<String>> = study.judged.iter().map(row).collect();
        let robust = match study.scenarios.first() {
            Some(name) => format!(
                "; robust, worst: of the gas temperature with model error in \"{name}\": mean, and largest in the worst variant"
            ),
            None => String::new(),
        };
        let explained = format!(
            "* best of so many sensors; sd of gas temperature, mass and leak rate at rest; finds: smallest leak found in time{robust}"
        );
        Report::default().explained_rows("Layouts by every number", &header, rows, explained)
    }

    /// Best of so many sensors by a number.
    fn best_of(&self, sensors: usize, of: fn(&EvaluatedLayout) -> Option<f64>) -> Option<&EvaluatedLayout> {
        let same = self.study.judged.iter().filter(|judged| judged.sensors.len() == sensors);
        let with = same.filter_map(|judged| Some((of(judged)?, judged)));
        with.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, judged)| judged)
    }

    /// Where certainty and the smallest leak ask for different layouts: a small covariance alone finds no leak.
    pub(super) fn differences(&self) -> Report {
        let line = |number: &BestLayouts| {
            let (_, unit, smallest) = LEAK_MEASURE;
            let finds = self.best_of(number.sensors, smallest)?;
            let least = smallest(finds)?;
            let mut parts = Vec::new();
            for (name, _, stated) in COVARIANCE_MEASURES {
                let knows = self.best_of(number.sensors, stated)?;
                let found = smallest(knows)?;
                if found > least * (1.0 + TIE_TOLERANCE) {
                    let what = name.split(' ').next().unwrap_or(name);
                    let more = 100.0 * (found / least - 1.0);
                    parts.push(format!(
                        "least sd of {what}: {}, +{} %",
                        self.chosen(&knows.sensors),
                        crate::report::number(more, 2)
                    ));
                }
            }
            let finds = format!("{} finds {}", self.chosen(&finds.sensors), unit.with_symbol(least));
            Some(match &*parts {
                [] => format!("  {}: the same, {finds}\n", number.sensors),
                parts => format!("  {}: they DIFFER, {finds}; {}\n", number.sensors, parts.join("; ")),
            })
        };
        let lines: Vec<String> = self.study.numbers.iter().filter_map(line).collect();
        if lines.is_empty() {
            return Report::default();
        }
        let title = "Posterior covariance against the smallest leak, by number of sensors";
        Report::default().text(format!("{title}\n{}", lines.concat()))
    }

    /// The best layouts along every scenario, with what they suffer from most.
    pub(super) fn along_scenarios(&self) -> Report {
        let header =
            ["scenario", "n", "sd mean", "sd worst", "robust mean", "worst case", "largest error by", "K"];
        let bests = self.study.numbers.iter().filter_map(|number| {
            let best = number.layouts.first()?;
            self.study.judged.iter().find(|judged| judged.sensors == best.sensors)
        });
        let bests: Vec<&EvaluatedLayout> = bests.collect();
        let mut rows = Vec::new();
        for (scenario, name) in self.study.scenarios.iter().enumerate() {
            for (judged, accuracy) in
                bests.iter().filter_map(|judged| Some((judged, judged.scenarios.get(scenario)?)))
            {
                let errors = accuracy.variants.iter();
                let largest = errors.max_by(|a, b| a.gas_k.worst.total_cmp(&b.gas_k.worst));
                rows.push(vec![
                    name.clone(),
                    judged.sensors.len().to_string(),
                    KELVIN.number(accuracy.gas_sd_k.mean),
                    KELVIN.number(accuracy.gas_sd_k.worst),
                    KELVIN.number(accuracy.gas_schmidt_k.mean),
                    KELVIN.number(accuracy.gas_worst_case_k.worst),
                    largest.map_or(String::new(), |of| of.variant.description()),
                    largest.map_or(String::new(), |of| KELVIN.number(of.gas_k.worst)),
                ]);
            }
        }
        Report::default().rows("The best layouts along scenarios: gas temperature, K", &header, rows)
    }
}

/// A share of one in percent.
fn share(of: Option<f64>) -> String {
    of.map_or(
        String::new(),
        |of| if of < 5e-5 { "0 %".into() } else { format!("{} %", number(100.0 * of, 2)) },
    )
}

/// How it was searched, and how much of it.
fn searched(number: &BestLayouts) -> String {
    let method = match number.method {
        Method::Exhaustive => "all",
        Method::BranchAndBound => "branch and bound",
        Method::Greedy => "greedy",
    };
    let partial = if number.partial { ", ended early" } else { "" };
    format!("{method}, {}{partial}", number.evaluated)
}
