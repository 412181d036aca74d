//! Curves against time in bounded memory.
//!
//! Time is cut into equal buckets, and of every curve a bucket keeps its lowest and highest point. When there are too
//! many buckets, neighbours are joined and the buckets become twice as wide. Up to the limit every row is a bucket of
//! its own, and nothing is lost.

use crate::report::figure::Item;
use crate::report::figure::style::Stroke;

/// Most buckets: more than a figure has columns of pixels.
const MAX_BUCKETS: usize = 4096;

/// Several curves against one time.
#[derive(Clone, Debug)]
pub(crate) struct DecimatedCurves {
    curves: usize,
    /// Width of a bucket, s; 0: a bucket per row.
    width_s: f64,
    start_s: f64,
    /// First and last time of each bucket, s.
    spans: Vec<(f64, f64)>,
    /// Extremes: curve after curve, bucket after bucket.
    extremes: Vec<Extremes>,
}

/// Lowest and highest value of a bucket with their times; NaN where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extremes {
    low: (f64, f64),
    high: (f64, f64),
}

impl Extremes {
    fn of(time_s: f64, value: f64) -> Self {
        Self { low: (time_s, value), high: (time_s, value) }
    }

    fn join(&mut self, other: &Self) {
        if self.low.1.is_nan() || other.low.1 < self.low.1 {
            self.low = other.low;
        }
        if self.high.1.is_nan() || other.high.1 > self.high.1 {
            self.high = other.high;
        }
    }
}

impl DecimatedCurves {
    /// So many curves without points.
    pub(crate) fn new(curves: usize) -> Self {
        Self { curves, width_s: 0.0, start_s: 0.0, spans: Vec::new(), extremes: Vec::new() }
    }

    /// Adds a point to every curve, at a time not before the last one; NaN is a missing value.
    pub(crate) fn push(&mut self, time_s: f64, values: impl IntoIterator<Item = f64>) {
        if self.spans.is_empty() {
            self.start_s = time_s;
        }
        let values = values.into_iter().chain(std::iter::repeat(f64::NAN)).take(self.curves);
        match self.spans.last_mut() {
            Some(span)
                if self.width_s > 0.0
                    && bucket(self.start_s, self.width_s, span.0)
                        == bucket(self.start_s, self.width_s, time_s) =>
            {
                span.1 = time_s;
                let from = self.extremes.len() - self.curves;
                for (extremes, value) in self.extremes[from..].iter_mut().zip(values) {
                    extremes.join(&Extremes::of(time_s, value));
                }
            }
            _ => {
                self.spans.push((time_s, time_s));
                self.extremes.extend(values.map(|value| Extremes::of(time_s, value)));
            }
        }
        if self.spans.len() > MAX_BUCKETS {
            self.widen(time_s);
        }
    }

    /// Makes the buckets so wide that half of the most suffice.
    fn widen(&mut self, end_s: f64) {
        let duration_s = end_s - self.start_s;
        self.width_s = (2.0 * self.width_s).max(duration_s / (MAX_BUCKETS / 2) as f64);
        let mut kept = 0;
        for index in 1..self.spans.len() {
            let number = |span: (f64, f64)| bucket(self.start_s, self.width_s, span.0);
            let (from, to) = (index * self.curves, kept * self.curves);
            if number(self.spans[index]) == number(self.spans[kept]) {
                self.spans[kept].1 = self.spans[index].1;
                for curve in 0..self.curves {
                    let other = self.extremes[from + curve];
                    self.extremes[to + curve].join(&other);
                }
            } else {
                kept += 1;
                self.spans[kept] = self.spans[index];
                self.extremes.copy_within(from..from + self.curves, kept * self.curves);
            }
        }
        self.spans.truncate(kept + 1);
        self.extremes.truncate((kept + 1) * self.curves);
    }

    /// First and last time, s; `None` without points.
    pub(crate) fn span_s(&self) -> Option<(f64, f64)> {
        Some((self.spans.first()?.0, self.spans.last()?.1))
    }

    /// Shift of the time axis of a figure, s: a log whose clock began long ago is drawn from its first row.
    pub(crate) fn origin_s(&self) -> f64 {
        match self.span_s() {
            Some((from_s, to_s)) if from_s < 0.0 || from_s > to_s - from_s => from_s,
            _ => 0.0,
        }
    }

    /// A curve of a figure; `None` without points.
    pub(crate) fn item(&self, name: &str, curve: usize, stroke: Stroke) -> Option<Item> {
        let (mut x, y) = self.line(curve);
        x.iter_mut().for_each(|time_s| *time_s -= self.origin_s());
        self.has(curve).then(|| Item::Line { name: name.to_owned(), x, y, stroke })
    }

    /// A band of a figure about a curve and a truth: `[curve, lower, upper, truth]`. Where it is wide it does not set the scale.
    pub(crate) fn band_item(&self, name: &str, [curve, lower, upper, truth]: [usize; 4]) -> Option<Item> {
        let (mut x, low, high) = self.band_clipped(lower, upper, &[curve, truth])?;
        x.iter_mut().for_each(|time_s| *time_s -= self.origin_s());
        Some(Item::Band { name: name.to_owned(), x, low, high })
    }

    /// Whether a curve has any point.
    pub(crate) fn has(&self, curve: usize) -> bool {
        self.column(curve).any(|extremes| !extremes.low.1.is_nan())
    }

    /// A curve as times, s, and values: the extremes of its buckets in the order of time; NaN where it has a gap.
    pub(crate) fn line(&self, curve: usize) -> (Vec<f64>, Vec<f64>) {
        let mut points = Vec::with_capacity(2 * self.spans.len());
        for extremes in self.column(curve) {
            let (mut first, mut second) = (extremes.low, extremes.high);
            if second.0 < first.0 {
                (first, second) = (second, first);
            }
            points.push(first);
            if second.0 > first.0 {
                points.push(second);
            }
        }
        points.into_iter().unzip()
    }

    /// Times, s, and edges of the band that contains two curves: the lower one's lowest, the upper one's highest value of
    /// every bucket. Buckets without both are left out.
    pub(crate) fn band(&self, lower: usize, upper: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
        let (mut time_s, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
        for ((span, lower), upper) in self.spans.iter().zip(self.column(lower)).zip(self.column(upper)) {
            let (bottom, top) = (lower.low.1, upper.high.1);
            if bottom.is_nan() || top.is_nan() {
                continue;
            }
            for at in [Some(span.0), (span.1 > span.0).then_some(span.1)].into_iter().flatten() {
                time_s.push(at);
                low.push(bottom);
                high.push(top);
            }
        }
        (time_s, low, high)
    }

    /// The band, cut off three usual half widths beside curves, so that where it is wide it does not set the scale.
    fn band_clipped(
        &self,
        lower: usize,
        upper: usize,
        curves: &[usize],
    ) -> Option<(Vec<f64>, Vec<f64>, Vec<f64>)> {
        let (time_s, mut low, mut high) = self.band(lower, upper);
        let mut halves: Vec<f64> = low.iter().zip(&high).map(|(low, high)| 0.5 * (high - low)).collect();
        halves.sort_by(f64::total_cmp);
        let room = 3.0 * halves.get(halves.len() / 2)?;
        let drawn: Vec<f64> = curves.iter().flat_map(|&curve| self.line(curve).1).collect();
        let known = || drawn.iter().copied().filter(|value| value.is_finite());
        let (bottom, top) =
            (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
        for edge in low.iter_mut().chain(&mut high) {
            *edge = edge.max(bottom - room).min(top + room);
        }
        Some((time_s, low, high))
    }

    fn column(&self, curve: usize) -> impl Iterator<Item = &Extremes> {
        self.extremes.iter().skip(curve).step_by(self.curves.max(1))
    }
}

/// Number of the bucket that a time lies in.
fn bucket(start_s: f64, width_s: f64, time_s: f64) -> u64 {
    if width_s > 0.0 { ((time_s - start_s) / width_s) as u64 } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_to_the_limit_every_point_is_there() {
        let mut curves = DecimatedCurves::new(2);
        for k in 0..MAX_BUCKETS {
            curves.push(k as f64, [(k % 3) as f64, f64::NAN]);
        }
        let (time_s, values) = curves.line(0);
        assert_eq!((time_s.len(), time_s[100], values[100]), (MAX_BUCKETS, 100.0, 1.0));
        assert!(curves.has(0) && !curves.has(1));
    }

    #[test]
    fn a_year_keeps_its_extremes_in_bounded_memory() {
        let mut curves = DecimatedCurves::new(1);
        for k in 0..3_000_000_u32 {
            let spike = if k == 1_234_567 { 99.0 } else { 0.0 };
            curves.push(1e9 + 10.0 * f64::from(k), [spike + f64::from(k % 2)]);
        }
        assert!(curves.spans.len() <= MAX_BUCKETS && curves.extremes.len() <= MAX_BUCKETS);
        let (time_s, values) = curves.line(0);
        assert!(time_s.windows(2).all(|pair| pair[0] < pair[1]));
        let spike = values.iter().position(|&value| value == 100.0).unwrap();
        assert_eq!(time_s[spike], 1e9 + 12_345_670.0);
        assert_eq!(curves.span_s(), Some((1e9, 1e9 + 29_999_990.0)));
        // Memory is used: not fewer buckets than a figure has columns.
        assert!(curves.spans.len() > MAX_BUCKETS / 4);
    }

    #[test]
    fn a_band_contains_every_point_of_its_curves() {
        let mut curves = DecimatedCurves::new(2);
        let wave = |k: u32| (f64::from(k) * 1e-3).sin();
        for k in 0..50_000 {
            curves.push(f64::from(k), [wave(k) - 1.0, wave(k) + 1.0]);
        }
        let (time_s, low, high) = curves.band(0, 1);
        for k in (0..50_000).step_by(101) {
            let after = time_s.partition_point(|&time| time < f64::from(k)).min(time_s.len() - 1);
            let (bottom, top) = (
                low[after].min(low[after.saturating_sub(1)]),
                high[after].max(high[after.saturating_sub(1)]),
            );
            assert!(bottom <= wave(k) - 1.0 && wave(k) + 1.0 <= top, "{k}");
        }
    }

    #[test]
    fn a_gap_in_one_curve_is_a_gap_of_that_curve_alone() {
        let mut curves = DecimatedCurves::new(2);
        for k in 0..10 {
            curves.push(f64::from(k), [1.0, if k == 5 { f64::NAN } else { 2.0 }]);
        }
        assert!(curves.line(0).1.iter().all(|value| value.is_finite()));
        assert_eq!(curves.line(1).1.iter().filter(|value| value.is_nan()).count(), 1);
        assert_eq!(curves.band(0, 1).0.len(), 9);
    }
}
