//! Method, and what is held out, as checked options.
use super::arguments::{HoldName, IdentifyArguments, MethodName};
use super::record::base_name;
use super::{Quantities, Record};
use crate::estimator::identify::{DeadTime, Gain, Hold, InitialState, InputModel, Method, Structure};
use anyhow::{Context, bail};

/// A method that has what it needs, apart from the data.
pub(super) struct Choice {
    method: MethodName,
    input_model: InputModel,
    /// How the input runs between its samples.
    pub hold: Hold,
}

impl Choice {
    /// Checks that the options fit each other.
    pub(super) fn checked(arguments: &IdentifyArguments) -> anyhow::Result<Self> {
        let IdentifyArguments { input, output, second, method, .. } = arguments;
        let same = |a: &str, b: &str| base_name(a) == base_name(b);
        if same(input, output) {
            bail!("--input and --output name the same column {input}: choose two");
        }
        match (method, second) {
            (MethodName::SecondSensor, None) => {
                bail!("the method second-sensor needs another sensor of the input: give --second")
            }
            (MethodName::SecondSensor, Some(second)) if same(second, input) || same(second, output) => {
                bail!("--second {second} is a column of its own: name another sensor of the input")
            }
            (MethodName::SecondSensor, _) | (_, None) => {}
            (_, Some(_)) => bail!("--second is for the method second-sensor: add --method second-sensor"),
        }
        let knows_noise = matches!(
            method,
            MethodName::BiasCompensated | MethodName::CompensatedInstruments | MethodName::MaximumLikelihood
        );
        if arguments.quantities.has_noise() && !knows_noise {
            bail!(
                "--input-sd and --output-sd are for the methods bias-compensated, compensated-instruments and \
                 maximum-likelihood: choose one by --method"
            );
        }
        let hold = match arguments.hold {
            HoldName::First => Hold::First,
            HoldName::Zero => Hold::Zero,
        };
        Ok(Self { method: *method, input_model: arguments.course.into(), hold })
    }

    /// The method for a record.
    pub(super) fn method(&self, record: &Record, quantities: &Quantities) -> anyhow::Result<Method> {
        let input = || quantities.variance("input-sd", &record.columns[0].signal);
        let output = || quantities.variance("output-sd", &record.columns[1].signal);
        Ok(match self.method {
            MethodName::OutputError => Method::OutputError,
            MethodName::RefinedInstruments => Method::RefinedInstruments,
            MethodName::BiasCompensated => {
                Method::BiasCompensated { input_variance: input()?, output_variance: output()? }
            }
            MethodName::CompensatedInstruments => Method::CompensatedInstruments { input_variance: input()? },
            MethodName::SecondSensor => {
                let second = record.columns.get(2).context("the second sensor has no column")?;
                if second.signal.unit != record.columns[0].signal.unit {
                    let (second, input) = (&second.signal.name, &record.columns[0].signal.name);
                    bail!("{second} is no other sensor of {input}: their quantities differ");
                }
                Method::SecondSensor { input: second.values.clone() }
            }
            MethodName::MaximumLikelihood => Method::MaximumLikelihood {
                input_variance: input()?,
                output_variance: output()?,
                input_model: self.input_model,
            },
        })
    }

    /// Method and structure in words.
    pub(super) fn description(&self, structure: &Structure) -> String {
        let method = match self.method {
            MethodName::OutputError => "output error",
            MethodName::RefinedInstruments => "refined instrumental variables",
            MethodName::BiasCompensated => "bias-compensated least squares",
            MethodName::CompensatedInstruments => "compensated refined instruments",
            MethodName::SecondSensor => "instruments from a second sensor",
            MethodName::MaximumLikelihood => "maximum likelihood",
        };
        let hold = match self.hold {
            Hold::First => "input straight between samples",
            Hold::Zero => "input held between samples",
        };
        let mut words = format!("order {}, zeros {}; {method}; {hold}", structure.order, structure.zeros);
        words.push_str(match structure.initial {
            InitialState::Estimated => "; state at the start estimated",
            InitialState::Zero => "; zero at the start",
            InitialState::Settled => "; settled at the start",
            InitialState::Given(_) => "; state at the start given",
        });
        if let Gain::Fixed(gain) = structure.gain {
            words.push_str(&format!("; gain held at {gain}"));
        }
        if let DeadTime::Fixed(dead_time_s) = structure.dead_time {
            words.push_str(&format!("; dead time {dead_time_s} s"));
        }
        if structure.offset {
            words.push_str("; with an offset");
        }
        words
    }
}

/// Data that the model is not identified from.
pub(super) enum Validation {
    /// The last part of the log, between 0 and 1.
    Fraction(f64),
    /// Another log.
    Log(String),
}

impl Validation {
    /// A fraction where the text is a number, else a log.
    pub(super) fn checked(text: &str) -> anyhow::Result<Self> {
        match text.parse::<f64>() {
            Ok(fraction) if fraction > 0.0 && fraction < 1.0 => Ok(Self::Fraction(fraction)),
            Ok(_) => bail!("--validate {text} must lie between 0 and 1, or name a log"),
            Err(_) => Ok(Self::Log(text.to_owned())),
        }
    }
}
