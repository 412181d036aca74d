//! Numbers of the command line: one parser with bounds, and one message with the option, the value, the bounds and a remedy.
use clap::builder::TypedValueParser;
use clap::error::ErrorKind;
use clap::{Arg, Command};
use std::any::TypeId;
use std::ffi::OsStr;
use std::fmt::{Display, LowerExp};
use std::ops::Bound;
use std::str::FromStr;

/// A number inside bounds; of a float at least finite.
#[derive(Clone, Debug)]
pub(super) struct Within<T> {
    low: Bound<T>,
    high: Bound<T>,
}

/// A number from one end to the other, both included.
pub(super) const fn within<T>(low: T, high: T) -> Within<T> {
    Within { low: Bound::Included(low), high: Bound::Included(high) }
}

/// A number of at least this.
pub(super) const fn at_least<T>(low: T) -> Within<T> {
    Within { low: Bound::Included(low), high: Bound::Unbounded }
}

/// A number above this.
pub(super) const fn above(low: f64) -> Within<f64> {
    Within { low: Bound::Excluded(low), high: Bound::Included(f64::MAX) }
}

/// Any finite number.
pub(super) const fn finite() -> Within<f64> {
    Within { low: Bound::Included(f64::MIN), high: Bound::Included(f64::MAX) }
}

impl<T> Within<T> {
    /// The same, at most this.
    pub(super) fn at_most(self, high: T) -> Self {
        Self { high: Bound::Included(high), ..self }
    }
}

impl<T: PartialOrd + Display> Within<T> {
    fn contains(&self, value: &T) -> bool {
        let low = match &self.low {
            Bound::Included(low) => value >= low,
            Bound::Excluded(low) => value > low,
            Bound::Unbounded => true,
        };
        let high = match &self.high {
            Bound::Included(high) => value <= high,
            Bound::Excluded(high) => value < high,
            Bound::Unbounded => true,
        };
        low && high
    }
}

impl<T: PartialOrd + Display + LowerExp + 'static> Within<T> {
    /// The bounds, without those that only exclude infinity.
    fn bounds(&self) -> String {
        let is_end = |end: &T| [f64::MIN, f64::MAX].iter().any(|limit| end.to_string() == limit.to_string());
        let low = match &self.low {
            Bound::Included(low) if !is_end(low) => format!("of at least {}", short(low)),
            Bound::Excluded(low) => format!("above {}", short(low)),
            _ => String::new(),
        };
        let high = match &self.high {
            Bound::Included(high) if !is_end(high) => format!("at most {}", short(high)),
            Bound::Excluded(high) => format!("below {}", short(high)),
            _ => String::new(),
        };
        let bounds = [low, high].into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>();
        let kind = if TypeId::of::<T>() == TypeId::of::<f64>() { "number" } else { "whole number" };
        match bounds.join(" and ") {
            none if none.is_empty() => format!("a finite {kind}"),
            bounds => format!("a {kind} {bounds}"),
        }
    }
}

/// A bound, with an exponent where it is shorter.
fn short(bound: &(impl Display + LowerExp)) -> String {
    let plain = bound.to_string();
    if plain.len() > 8 { format!("{bound:e}") } else { plain }
}

impl<T> TypedValueParser for Within<T>
where
    T: FromStr + PartialOrd + Display + LowerExp + Clone + Send + Sync + 'static,
{
    type Value = T;

    fn parse_ref(&self, _: &Command, arg: Option<&Arg>, text: &OsStr) -> Result<T, clap::Error> {
        let text = text.to_string_lossy();
        let value = text.trim().parse::<T>().ok().filter(|value| self.contains(value));
        value.ok_or_else(|| {
            let option = arg.and_then(Arg::get_long).map_or(String::new(), |name| format!("--{name} "));
            let defaults = arg.map(Arg::get_default_values).unwrap_or_default();
            let default = defaults
                .first()
                .map_or(String::new(), |default| format!("; the default is {}", default.to_string_lossy()));
            let with_point = text.trim().replace(',', ".");
            let point = match with_point.parse::<T>() {
                Ok(_) if text.contains(',') => format!(": write {with_point}, with a decimal point"),
                _ => default,
            };
            let message = format!("{option}{text}: it must be {}{point}\n", self.bounds());
            clap::Error::raw(ErrorKind::ValueValidation, message)
        })
    }
}

/// Lets every numeric option of a command and its subcommands take a negative number, so that the bounds are what refuses it.
pub(super) fn with_negative_numbers(command: Command) -> Command {
    let numeric = [TypeId::of::<f64>(), TypeId::of::<u64>(), TypeId::of::<usize>()];
    let is_numeric = move |arg: &Arg| numeric.iter().any(|of| arg.get_value_parser().type_id() == *of);
    command
        .mut_args(|arg| if is_numeric(&arg) { arg.allow_negative_numbers(true) } else { arg })
        .mut_subcommands(with_negative_numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str, parser: Within<f64>) -> Result<f64, String> {
        let arg = Arg::new("x").long("years").default_value("10");
        let value = parser.parse_ref(&Command::new("c"), Some(&arg), OsStr::new(text));
        value.map_err(|error| error.to_string())
    }

    #[test]
    fn a_number_out_of_its_bounds_is_refused_with_option_value_bounds_and_default() {
        assert_eq!(parsed("2.5", above(0.0)), Ok(2.5));
        for text in ["-3", "0", "inf", "nan", "x"] {
            let message = parsed(text, above(0.0).at_most(100.0)).unwrap_err();
            let bounds = "it must be a number above 0 and at most 100; the default is 10";
            assert_eq!(message, format!("error: --years {text}: {bounds}\n"));
        }
        assert!(parsed("inf", finite()).unwrap_err().contains("it must be a finite number"));
    }

    #[test]
    fn a_negative_number_reaches_the_parser_of_every_numeric_option() {
        let command = Command::new("c")
            .subcommand(Command::new("s").arg(Arg::new("n").long("count").value_parser(within(1_u64, 9))));
        let refused = with_negative_numbers(command).try_get_matches_from(["c", "s", "--count", "-3"]);
        let message = refused.unwrap_err().to_string();
        assert_eq!(message, "error: --count -3: it must be a whole number of at least 1 and at most 9\n");
    }
}
