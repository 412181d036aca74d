//! Sensors that are lost or wrong, and unknown errors.
use super::{GRAM, GRAM_PER_HOUR, KELVIN, PlacementReport, Unit, WATT};
use crate::estimator::placement::study::{Bias, BiasSource, Failure};
use crate::report::Report;

impl PlacementReport<'_> {
    /// The layout that failures are of.
    fn of_layout(&self) -> String {
        let layout: Vec<usize> = self.study.failures.iter().map(|failure| failure.sensor).collect();
        self.names(&layout)
    }

    /// What is left without each sensor.
    pub(super) fn losses(&self) -> Report {
        let header = ["lost", "gas sd / K", "mass / g", "leak / g/h", "smallest leak / g/h"];
        let rows: Vec<Vec<String>> = self.study.failures.iter().map(|failure| self.loss(failure)).collect();
        Report::default().rows(format!("A sensor lost, of {}", self.of_layout()), &header, rows)
    }

    fn loss(&self, failure: &Failure) -> Vec<String> {
        let mut cells = vec![self.name(failure.sensor).to_owned()];
        match &failure.without {
            Some(left) => cells.extend([
                KELVIN.number(left.gas_sd_k),
                GRAM.number(left.mass_sd_kg),
                GRAM_PER_HOUR.number(left.leak_sd_kg_s),
                GRAM_PER_HOUR.number(left.smallest_leak_kg_s),
            ]),
            None => cells.push(unseen(failure)),
        }
        cells
    }

    /// A constant error of each sensor.
    pub(super) fn faults(&self) -> Report {
        let header = [
            "at fault",
            "found from",
            "told apart from",
            "else taken for",
            "1 K or 1 bar",
            "gas / K",
            "mass / g",
        ];
        let row = |failure: &Failure| {
            let unit = self.unit_of(failure.sensor);
            let other = failure.confused_with.map_or("a leak", |sensor| self.name(sensor));
            let isolated = if failure.isolated.is_finite() {
                unit.with_symbol(failure.isolated)
            } else {
                "never".into()
            };
            vec![
                self.name(failure.sensor).to_owned(),
                unit.with_symbol(failure.found),
                isolated,
                other.to_owned(),
                if failure.is_isolable { "told apart" } else { "NOT told apart" }.into(),
                KELVIN.number(failure.gas_k),
                GRAM.number(failure.mass_kg),
            ]
        };
        let rows: Vec<Vec<String>> = self.study.failures.iter().map(row).collect();
        let explained = "smallest constant error that is found in time, and that is also told from a leak and from every other sensor's; \
                         gas, mass: error that 1 K or 1 bar makes in a day";
        Report::default().explained_rows(
            format!("A sensor at fault, of {}", self.of_layout()),
            &header,
            rows,
            explained,
        )
    }

    /// What a standard deviation of something unknown does in an hour, a day and a week.
    pub(super) fn biases(&self) -> Report {
        let header =
            ["unknown", "one sd", "K: 1 h", "1 d", "7 d", "g: 1 h", "1 d", "7 d", "g/h: 1 h", "1 d", "7 d"];
        let rows: Vec<Vec<String>> = self.study.biases.iter().map(|bias| self.bias(bias)).collect();
        let explained = "error of the estimates after so long, from an unknown error of one sd that sets in; coupling: with 10 K between \
                         air and wall";
        Report::default().explained_rows(
            "Unknown errors in the estimates: gas temperature in K, mass in g, leak rate in g/h",
            &header,
            rows,
            explained,
        )
    }

    fn bias(&self, bias: &Bias) -> Vec<String> {
        let (what, unit): (String, Unit) = match bias.source {
            BiasSource::Offset(sensor) => (format!("offset {}", self.name(sensor)), self.unit_of(sensor)),
            BiasSource::Coupling(sensor) => (format!("coupling {}", self.name(sensor)), KELVIN),
            BiasSource::Sun => ("sun on the upper quarter".into(), WATT),
        };
        let mut cells = vec![what, unit.with_symbol(bias.size)];
        for (unit, values) in [(KELVIN, bias.gas_k), (GRAM, bias.mass_kg), (GRAM_PER_HOUR, bias.leak_kg_s)] {
            cells.extend(values.map(|value| short(unit, value)));
        }
        cells
    }
}

/// Why nothing can be said without a sensor.
pub(super) fn unseen(failure: &Failure) -> String {
    match &failure.unseen {
        Some(state) => format!("the others do not see {state}"),
        None => "the others have no steady state".into(),
    }
}

/// Two digits, and nothing beyond three decimals.
fn short(unit: Unit, si: f64) -> String {
    crate::report::number((1e3 * unit.per_si * si).round() / 1e3, 2)
}
