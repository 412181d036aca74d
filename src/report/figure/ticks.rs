//! Round tick values and their labels.

/// Ticks of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Values, increasing.
    pub values: Vec<f64>,
    /// What stands at each of them.
    pub labels: Vec<String>,
    /// Values between them that get a small tick without a label.
    pub small: Vec<f64>,
}

/// Multiples of a round step inside `[low, high]`, about `wanted` of them. `steps` are the round numbers of the axis;
/// far from all of them, 1, 2 and 5 times a power of ten serve.
pub(super) fn ticks(low: f64, high: f64, wanted: usize, steps: &[f64]) -> Ticks {
    let span = high - low;
    let step = round_step(span / wanted as f64, steps);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    let values: Vec<f64> = (first..=last).map(|k| k as f64 * step).collect();
    Ticks { labels: values.iter().map(|value| label(*value, step)).collect(), values, small: Vec::new() }
}

/// Powers of ten inside `[low, high]`, both positive; 2 and 5 times them, too, where there are fewer than three. The other
/// multiples are small ticks.
pub(super) fn logarithmic_ticks(low: f64, high: f64) -> Ticks {
    let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let inside = |value: &f64| (low * (1.0 - 1e-9)..=high * (1.0 + 1e-9)).contains(value);
    let multiples = |factors: &[f64]| -> Vec<f64> {
        let all = decades.clone().flat_map(|decade| factors.iter().map(move |factor| (decade, *factor)));
        all.map(|(decade, factor)| factor * 10f64.powi(decade)).filter(inside).collect()
    };
    let powers = multiples(&[1.0]);
    let (values, between) = match powers.len() {
        0..3 => (multiples(&[1.0, 2.0, 5.0]), [3.0, 4.0, 6.0, 7.0, 8.0, 9.0].as_slice()),
        _ => (powers, [2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0].as_slice()),
    };
    let labels = values.iter().map(|value| label(*value, 10f64.powf(value.log10().floor()))).collect();
    Ticks { labels, small: multiples(between), values }
}

fn round_step(ideal: f64, steps: &[f64]) -> f64 {
    let decade = 10f64.powf(ideal.log10().floor());
    let decimal = [1.0, 2.0, 5.0, 10.0].map(|round| round * decade);
    let covered = steps.first().is_some_and(|first| *first <= 1.5 * ideal)
        && steps.last().is_some_and(|last| *last >= ideal / 1.5);
    let candidates = if covered { steps } else { &decimal };
    let distance = |step: &f64| (step / ideal).ln().abs();
    candidates.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(ideal)
}

/// A number with as many decimals as the step of its axis needs, with a real minus sign.
fn label(value: f64, step: f64) -> String {
    let decimals = (-(step * (1.0 + 1e-9)).log10().floor()).clamp(0.0, 9.0) as usize;
    // A step of 2.5 has one decimal more than its magnitude says.
    let decimals =
        if (step * 10f64.powi(decimals as i32)).fract().abs() > 1e-6 { decimals + 1 } else { decimals };
    let value = if value.abs() < step * 1e-6 { 0.0 } else { value };
    format!("{value:.decimals$}").replace('-', "\u{2212}")
}

/// Unit of a time axis that keeps its numbers short.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TimeUnit {
    /// Symbol.
    pub symbol: &'static str,
    /// Seconds in it.
    pub seconds: f64,
    /// Round steps.
    pub steps: &'static [f64],
}

/// Seconds up to three minutes, minutes up to three hours, hours up to three days, then days.
pub(super) fn time_unit(duration_s: f64) -> TimeUnit {
    const SECONDS: &[f64] = &[1.0, 2.0, 5.0, 10.0, 20.0, 30.0];
    const MINUTES: &[f64] = &[1.0, 2.0, 5.0, 10.0, 15.0, 30.0];
    const HOURS: &[f64] = &[0.5, 1.0, 2.0, 3.0, 6.0, 12.0, 24.0];
    const DAYS: &[f64] = &[0.5, 1.0, 2.0, 5.0, 7.0, 14.0, 28.0];
    match duration_s {
        d if d <= 180.0 => TimeUnit { symbol: "s", seconds: 1.0, steps: SECONDS },
        d if d <= 3.0 * 3600.0 => TimeUnit { symbol: "min", seconds: 60.0, steps: MINUTES },
        d if d <= 3.0 * 86400.0 => TimeUnit { symbol: "h", seconds: 3600.0, steps: HOURS },
        _ => TimeUnit { symbol: "d", seconds: 86400.0, steps: DAYS },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DECIMAL: &[f64] = &[];

    #[test]
    fn ticks_are_round_and_inside_the_range() {
        assert_eq!(ticks(-27.0, 23.0, 6, DECIMAL).values, vec![-20.0, -10.0, 0.0, 10.0, 20.0]);
        assert_eq!(ticks(0.0, 0.5, 5, DECIMAL).values.len(), 6);
        let first = |ticks: Ticks| ticks.values[1];
        assert_eq!(first(ticks(0.0, 5.0, 8, time_unit(18000.0).steps)), 0.5);
        assert_eq!(first(ticks(0.0, 100.0, 8, time_unit(100.0).steps)), 10.0);
        assert_eq!(first(ticks(0.0, 1.0e7, 5, DECIMAL)), 2.0e6);
        assert_eq!(first(ticks(0.0, 0.01, 5, time_unit(0.01).steps)), 0.002);
    }

    #[test]
    fn logarithmic_axes_show_powers_of_ten_and_more_where_they_are_few() {
        let wide = logarithmic_ticks(0.0008, 20.0);
        assert_eq!(wide.labels, ["0.001", "0.01", "0.1", "1", "10"]);
        assert!(wide.small.contains(&20.0) && wide.small.iter().any(|small| (small - 0.03).abs() < 1e-12));
        let narrow = logarithmic_ticks(0.3, 6.0);
        assert_eq!(narrow.labels, ["0.5", "1", "2", "5"]);
        assert!(narrow.small.iter().all(|small| narrow.values.iter().all(|value| value != small)));
    }

    #[test]
    fn labels_show_the_decimals_that_their_step_has() {
        assert_eq!(label(-10.0, 5.0), "\u{2212}10");
        assert_eq!(label(0.1 + 0.2, 0.1), "0.3");
        assert_eq!(label(-1e-17, 0.5), "0.0");
        assert_eq!(label(2.5, 2.5), "2.5");
    }

    #[test]
    fn time_axes_use_the_unit_that_people_would_say() {
        assert_eq!(time_unit(100.0).symbol, "s");
        assert_eq!(time_unit(7200.0).symbol, "min");
        assert_eq!(time_unit(14.0 * 3600.0).symbol, "h");
        assert_eq!(time_unit(30.0 * 86400.0).symbol, "d");
    }
}
