//! What an identification found, with everything it is compared with.
use crate::estimator::identify::{
    Comparison, Data, Identified, IdentifyError, InitialState, Model, Residuals, published,
};

/// A column that is identified from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Signal {
    /// Name, as `shoulder`.
    pub name: String,
    /// Suffix of the unit of its values, as `degc`.
    pub suffix: &'static str,
    /// Symbol of that unit.
    pub unit: &'static str,
    /// Symbol of the unit of a difference, as K.
    pub difference: &'static str,
}

impl Signal {
    /// A temperature, °C.
    pub(crate) fn temperature(name: impl Into<String>) -> Self {
        Self { name: name.into(), suffix: "degc", unit: "°C", difference: "K" }
    }

    /// A pressure, bar.
    pub(crate) fn pressure(name: impl Into<String>) -> Self {
        Self { name: name.into(), suffix: "bar", unit: "bar", difference: "bar" }
    }

    /// Whether it is a temperature.
    pub(crate) fn is_temperature(&self) -> bool {
        self.suffix == "degc"
    }
}

/// State in which a model starts on data that it was not identified from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    /// Fitted to the data.
    Fitted,
    /// At the first output, for a model of order 1.
    FirstOutput,
    /// At zero.
    Zero,
}

impl Start {
    /// Those that a model can be started at: for a higher order the output alone is no state.
    fn of(model: &Model) -> &'static [Self] {
        match model.order() {
            1 => &[Self::Fitted, Self::FirstOutput, Self::Zero],
            _ => &[Self::Fitted, Self::Zero],
        }
    }

    /// In a few words.
    pub(crate) fn text(self) -> &'static str {
        match self {
            Self::Fitted => "fitted",
            Self::FirstOutput => "first output",
            Self::Zero => "zero",
        }
    }

    fn state(self, model: &Model, data: &Data) -> InitialState {
        match self {
            Self::Fitted => InitialState::Estimated,
            Self::Zero => InitialState::Zero,
            Self::FirstOutput => {
                let from = data.input().iter().position(|value| value.is_finite()).unwrap_or(0);
                let first = data.output()[from..].iter().find(|value| value.is_finite());
                InitialState::Given(vec![first.map_or(0.0, |first| first - model.offset)])
            }
        }
    }
}

/// A given model on data from one start.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Judged {
    /// Which model.
    pub model: &'static str,
    /// Where it starts.
    pub start: Start,
    /// How it does.
    pub comparison: Comparison,
}

/// Names of the models that are judged.
const IDENTIFIED: &str = "identified";
const PUBLISHED: &str = "published";

/// Data with the models that were judged on them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Part {
    /// What the data are, as a file's name.
    pub name: String,
    /// The data.
    pub data: Data,
    /// Models that were not identified from these data.
    pub judged: Vec<Judged>,
}

/// An identification with its comparisons.
#[derive(Clone, Debug)]
pub(crate) struct Study {
    /// The input.
    pub input: Signal,
    /// The output.
    pub output: Signal,
    /// Method and structure in words.
    pub method: String,
    /// What was found.
    pub identified: Identified,
    /// The data it was identified from, with the published model on them.
    pub fitted: Part,
    /// Data that it was not identified from.
    pub held_out: Option<Part>,
}

impl Study {
    /// Compares the identified with the published model on the same data, and on others.
    ///
    /// # Errors
    /// The other data hold nothing to compare with.
    pub(crate) fn new(
        (input, output): (Signal, Signal),
        method: String,
        identified: Identified,
        fitted: (String, Data),
        held_out: Option<(String, Data)>,
        lags: usize,
    ) -> Result<Self, IdentifyError> {
        let comparable = input.is_temperature() && output.is_temperature();
        let published = comparable.then(published::model);
        let judge = |data: &Data, model: Option<&Model>, name: &'static str| {
            let one = |start: Start, model: &Model| {
                let comparison = model.compare_from(data, &start.state(model, data), lags)?;
                Ok(Judged { model: name, start, comparison })
            };
            let each = |model: &Model| Start::of(model).iter().map(|&start| one(start, model)).collect();
            model.map_or(Ok(Vec::new()), each)
        };
        let part = |(name, data): (String, Data), model: Option<&Model>| {
            let mut judged: Vec<Judged> = judge(&data, model, IDENTIFIED)?;
            judged.extend(judge(&data, published.as_ref(), PUBLISHED)?);
            Ok(Part { name, data, judged })
        };
        Ok(Self {
            fitted: part(fitted, None)?,
            held_out: held_out.map(|held_out| part(held_out, Some(&identified.model))).transpose()?,
            input,
            output,
            method,
            identified,
        })
    }

    /// Title: from which column to which.
    pub(crate) fn title(&self) -> String {
        format!("{} \u{2192} {}", self.input.name, self.output.name)
    }
}

impl Part {
    /// A model from a start.
    pub(crate) fn of(&self, model: &str, start: Start) -> Option<&Comparison> {
        let found = self.judged.iter().find(|judged| judged.model == model && judged.start == start);
        found.map(|judged| &judged.comparison)
    }

    /// The identified model with a fitted start; none on the data that it was identified from.
    pub(crate) fn identified(&self) -> Option<&Comparison> {
        self.of(IDENTIFIED, Start::Fitted)
    }

    /// The published model with a fitted start.
    pub(crate) fn published(&self) -> Option<&Comparison> {
        self.of(PUBLISHED, Start::Fitted)
    }

    /// Rows of the data that errors belong to.
    pub(crate) fn rows(&self, errors: &Residuals) -> Vec<usize> {
        let times = self.data.time_s();
        let mut row = 0;
        let row_of = |time_s: &f64| {
            // Times of errors were scaled and back: they are right to rounding.
            let near = |row: usize| {
                let next = times.get(row + 1).copied().unwrap_or(f64::INFINITY);
                (times[row] - time_s).abs() <= (next - time_s).abs()
            };
            while row + 1 < times.len() && !near(row) {
                row += 1;
            }
            row
        };
        errors.time_s.iter().map(row_of).collect()
    }

    /// What the model says at the times of its errors.
    pub(crate) fn simulated(&self, errors: &Residuals) -> Vec<f64> {
        let rows = self.rows(errors);
        rows.iter().zip(&errors.values).map(|(&row, error)| self.data.output()[row] - error).collect()
    }
}
