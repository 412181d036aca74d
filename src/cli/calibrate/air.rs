//! The air from readings with noise: a line with few bends, each of which costs the simulation a step.

/// Knots of a line through points, with bends where the points leave a straight line by more than a tolerance (Ramer,
/// Douglas and Peucker), and with the values at the knots that are nearest to all points by least squares, so that
/// their noise averages out.
pub fn drawn(points: &[(f64, f64)], tolerance: f64) -> Vec<(f64, f64)> {
    let places = bends(points, tolerance);
    let values = fitted(points, &places);
    places.into_iter().map(|place| points[place].0).zip(values).collect()
}

/// Places of the first point, the last one, and the bends between.
fn bends(points: &[(f64, f64)], tolerance: f64) -> Vec<usize> {
    let Some(last) = points.len().checked_sub(1) else { return Vec::new() };
    let mut places = vec![0, last];
    let mut pieces = vec![(0, last)];
    while let Some((from, to)) = pieces.pop() {
        let ((t0, y0), (t1, y1)) = (points[from], points[to]);
        let off = |k: usize| {
            let (t, y) = points[k];
            (y - y0 - (y1 - y0) * (t - t0) / (t1 - t0)).abs()
        };
        let farthest = (from + 1..to).map(|k| (k, off(k))).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = farthest.filter(|(_, off)| *off > tolerance) {
            places.push(k);
            pieces.extend([(from, k), (k, to)]);
        }
    }
    places.sort_unstable();
    places.dedup();
    places
}

/// Values at the knots by least squares: the normal equations of hat functions are tridiagonal, and since every knot is a
/// point, positive definite.
fn fitted(points: &[(f64, f64)], places: &[usize]) -> Vec<f64> {
    let count = places.len();
    let (mut diagonal, mut beside, mut rhs) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
    let mut piece = 0;
    for (k, &(t, y)) in points.iter().enumerate() {
        while piece + 2 < count && k >= places[piece + 1] {
            piece += 1;
        }
        let Some(&next) = places.get(piece + 1) else {
            diagonal[piece] += 1.0;
            rhs[piece] += y;
            continue;
        };
        let (t0, t1) = (points[places[piece]].0, points[next].0);
        let share = (t - t0) / (t1 - t0);
        diagonal[piece] += (1.0 - share) * (1.0 - share);
        diagonal[piece + 1] += share * share;
        beside[piece] += share * (1.0 - share);
        rhs[piece] += (1.0 - share) * y;
        rhs[piece + 1] += share * y;
    }
    // Elimination without pivots, which a positive definite matrix does not need.
    for k in 1..count {
        let factor = beside[k - 1] / diagonal[k - 1];
        diagonal[k] -= factor * beside[k - 1];
        rhs[k] -= factor * rhs[k - 1];
    }
    for k in (0..count).rev() {
        let known = if k + 1 < count { beside[k] * rhs[k + 1] } else { 0.0 };
        rhs[k] = (rhs[k] - known) / diagonal[k];
    }
    rhs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: &[(f64, f64)], expected: &[(f64, f64)]) -> bool {
        let close = |(a, b): (&(f64, f64), &(f64, f64))| a.0 == b.0 && (a.1 - b.1).abs() < 1e-9;
        found.len() == expected.len() && found.iter().zip(expected).all(close)
    }

    #[test]
    fn a_ramp_keeps_its_ends_and_a_step_its_two_sides() {
        let ramp: Vec<(f64, f64)> = (0..100).map(|k| (f64::from(k), 0.5 * f64::from(k))).collect();
        assert!(near(&drawn(&ramp, 0.1), &[(0.0, 0.0), (99.0, 49.5)]));
        let step: Vec<(f64, f64)> =
            (0..100).map(|k| (f64::from(k), if k < 50 { 0.0 } else { 5.0 })).collect();
        assert!(near(&drawn(&step, 0.1), &[(0.0, 0.0), (49.0, 0.0), (50.0, 5.0), (99.0, 5.0)]));
        assert!(near(&drawn(&[(3.0, 1.0)], 0.1), &[(3.0, 1.0)]));
        assert!(drawn(&[], 0.1).is_empty());
    }

    #[test]
    fn noise_within_the_tolerance_averages_out() {
        // Noise of 0.05 with the mean 0 on a constant: the line is nearer to the constant than its end points are.
        let noise = |k: u32| 0.05 * if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let points: Vec<(f64, f64)> = (0..200).map(|k| (f64::from(k), 40.0 + noise(k))).collect();
        let knots = drawn(&points, 0.11);
        assert_eq!(knots.len(), 2);
        assert!(knots.iter().all(|(_, y)| (y - 40.0).abs() < 2e-3), "{knots:?}");
    }

    #[test]
    fn a_curve_is_followed_by_few_knots() {
        let curve = |t: f64| 10.0 * (t / 40.0).sin();
        let points: Vec<(f64, f64)> = (0..500).map(|k| (f64::from(k), curve(f64::from(k)))).collect();
        let knots = drawn(&points, 0.1);
        assert!(knots.len() < 60, "{}", knots.len());
        assert!(knots.iter().all(|(t, y)| (y - curve(*t)).abs() < 0.1));
    }
}
