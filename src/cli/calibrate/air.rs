//! The air from readings with noise: straight pieces, as few as the noise allows, since each costs the simulation a step.
//!
//! A piece is cut where two lines by least squares fit it better than one, by more than noise could: the sum of squares falls
//! by [`CUT`] variances of the noise. A step of the air is a cut, too, and stays as steep as it was read.

/// Fall of the sum of squares, in variances of the noise, that is no chance: two numbers and a place among a day of readings.
const SIGNIFICANT_FALL: f64 = 30.0;

/// Knots of the pieces' lines: each point belongs to one piece, whose ends are the first and the last of its points.
/// `least_sd` is the least noise, as of readings that are rounded.
pub(super) fn drawn(points: &[(f64, f64)], least_sd: f64) -> Vec<(f64, f64)> {
    let sums = Sums::new(points);
    let variance = noise(points).max(least_sd).powi(2);
    let mut knots = Vec::new();
    let mut waiting = vec![(0, points.len())];
    while let Some((from, to)) = waiting.pop() {
        match sums.cut(from, to, SIGNIFICANT_FALL * variance) {
            // The first half is next.
            Some(place) => waiting.extend([(place, to), (from, place)]),
            None => knots.extend(sums.line(points, from, to)),
        }
    }
    knots
}

/// Standard deviation of the noise by the median of the second differences, which a course with few bends leaves alone:
/// that of white noise is the 0.6745th part of their deviation, `sqrt(6)` times its own.
fn noise(points: &[(f64, f64)]) -> f64 {
    let mut differences: Vec<f64> =
        points.windows(3).map(|three| (three[0].1 - 2.0 * three[1].1 + three[2].1).abs()).collect();
    if differences.is_empty() {
        return 0.0;
    }
    let middle = differences.len() / 2;
    *differences.select_nth_unstable_by(middle, f64::total_cmp).1 / (0.6745 * 6.0_f64.sqrt())
}

/// Sums of `1, t, y, t^2, t y, y^2` over the points before each, from means so that they stay small.
struct Sums {
    before: Vec<[f64; 6]>,
    means: (f64, f64),
}

impl Sums {
    fn new(points: &[(f64, f64)]) -> Self {
        let count = points.len().max(1) as f64;
        let (t, y) = points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0, sum.1 + point.1));
        let means = (t / count, y / count);
        let mut sum = [0.0; 6];
        let mut before = vec![sum];
        for point in points {
            let (t, y) = (point.0 - means.0, point.1 - means.1);
            for (sum, term) in sum.iter_mut().zip([1.0, t, y, t * t, t * y, y * y]) {
                *sum += term;
            }
            before.push(sum);
        }
        Self { before, means }
    }

    /// Mean time, mean value, slope and sum of squares of the line through points `from..to`.
    fn fit(&self, from: usize, to: usize) -> [f64; 4] {
        let [n, t, y, tt, ty, yy] = std::array::from_fn(|k| self.before[to][k] - self.before[from][k]);
        let (spread, along) = (tt - t * t / n, ty - t * y / n);
        let slope = if to - from > 1 { along / spread } else { 0.0 };
        [t / n, y / n, slope, (yy - y * y / n - slope * along).max(0.0)]
    }

    /// The place that divides points into two with lines of their own, if that is worth it.
    fn cut(&self, from: usize, to: usize, worth: f64) -> Option<usize> {
        let of_both = |place: usize| self.fit(from, place)[3] + self.fit(place, to)[3];
        let best = (from + 1..to).map(|place| (place, of_both(place))).min_by(|a, b| a.1.total_cmp(&b.1));
        let whole = if from < to { self.fit(from, to)[3] } else { 0.0 };
        best.filter(|(_, both)| whole - both > worth).map(|(place, _)| place)
    }

    /// Ends of the line through points `from..to`.
    fn line(&self, points: &[(f64, f64)], from: usize, to: usize) -> Vec<(f64, f64)> {
        if from == to {
            return Vec::new();
        }
        let [mean_t, mean_y, slope, _] = self.fit(from, to);
        let at = |k: usize| {
            let t = points[k].0;
            (t, self.means.1 + mean_y + slope * (t - self.means.0 - mean_t))
        };
        if to - from == 1 { vec![at(from)] } else { vec![at(from), at(to - 1)] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SD: f64 = 0.05;

    /// Readings of a course each 10 s, with nearly normal noise.
    fn readings(rows: u32, course: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let mut seed = 7_u64;
        let mut uniform = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut noise = || SD * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0);
        (0..rows).map(|k| (10.0 * f64::from(k), course(10.0 * f64::from(k)) + noise())).collect()
    }

    /// Value of the knots' line.
    fn at(knots: &[(f64, f64)], t: f64) -> f64 {
        let next = knots.partition_point(|knot| knot.0 <= t).clamp(1, knots.len() - 1);
        let [(t0, y0), (t1, y1)] = [knots[next - 1], knots[next]];
        y0 + (y1 - y0) * (t - t0) / (t1 - t0)
    }

    #[test]
    fn a_ramp_is_one_piece_and_a_step_two() {
        let ramp: Vec<(f64, f64)> = (0..100).map(|k| (f64::from(k), 0.5 * f64::from(k))).collect();
        let knots = drawn(&ramp, 0.03);
        assert_eq!(knots.len(), 2);
        assert!((knots[0].1 - 0.0).abs() < 1e-9 && (knots[1].1 - 49.5).abs() < 1e-9);
        let step = readings(200, |t| if t < 1000.0 { 20.0 } else { -10.0 });
        let knots = drawn(&step, 0.03);
        let times: Vec<f64> = knots.iter().map(|knot| knot.0).collect();
        assert_eq!(times, [0.0, 990.0, 1000.0, 1990.0]);
        assert_eq!(drawn(&[(3.0, 1.0)], 0.03), [(3.0, 1.0)]);
        assert!(drawn(&[], 0.03).is_empty());
    }

    #[test]
    fn the_noise_of_readings_is_found_and_averages_out() {
        let points = readings(500, |_| 40.0);
        assert!((noise(&points) / SD - 1.0).abs() < 0.1, "{}", noise(&points));
        let knots = drawn(&points, 0.03);
        assert_eq!(knots.len(), 2);
        // A line's ends are known to two standard deviations over the root of the number.
        assert!(knots.iter().all(|(_, y)| (y - 40.0).abs() < 5.0 * SD / 500.0_f64.sqrt()), "{knots:?}");
    }

    #[test]
    fn a_day_of_noisy_waves_is_followed_nearer_than_its_readings_by_few_pieces() {
        let course = |t: f64| 10.0 + 12.0 * (t / 86_400.0 * std::f64::consts::TAU).sin();
        let knots = drawn(&readings(8640, course), 0.03);
        assert!(knots.len() < 80, "{}", knots.len());
        let errors = (0..8639).map(|k| 10.0 * f64::from(k)).map(|t| (at(&knots, t) - course(t)).powi(2));
        let rms = (errors.sum::<f64>() / 8639.0).sqrt();
        assert!(rms < 0.4 * SD, "{rms} K");
    }
}
