//! Polylines on paper: gaps, thinning to what can be seen, dashes.

/// A point on paper.
pub(super) type Point = (f64, f64);

/// Splits a curve where a value is missing (NaN).
pub(super) fn unbroken(points: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    let mut pieces = vec![Vec::new()];
    for point in points {
        if point.0.is_finite() && point.1.is_finite() {
            if let Some(piece) = pieces.last_mut() {
                piece.push(point);
            }
        } else if pieces.last().is_some_and(|piece| !piece.is_empty()) {
            pieces.push(Vec::new());
        }
    }
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// Keeps of every column of width `column` the first, lowest, highest and last point: the drawn line is the same, and
/// a day at one sample a second does not become 86 400 corners.
fn thin(points: &[Point], column: f64) -> Vec<Point> {
    let mut out: Vec<Point> = Vec::new();
    let mut start = 0;
    while start < points.len() {
        let cell = (points[start].0 / column).floor();
        let count = points[start..].iter().take_while(|p| (p.0 / column).floor() == cell).count();
        let group = &points[start..start + count];
        let extreme = |better: fn(f64, f64) -> bool| {
            (0..count).fold(0, |best, k| if better(group[k].1, group[best].1) { k } else { best })
        };
        let mut keep = [0, extreme(|a, b| a < b), extreme(|a, b| a > b), count - 1];
        keep.sort_unstable();
        let mut last = usize::MAX;
        for k in keep {
            if k != last {
                out.push(group[k]);
                last = k;
            }
        }
        start += count;
    }
    out
}

/// How far a drawn curve may pass from its points, in figure units: less than a printer's dot.
const TOLERANCE: f64 = 0.04;

/// The curve with as few corners as the eye allows: many short pieces would each be rounded to pixels and wobble.
pub(super) fn simplified(points: &[Point]) -> Vec<Point> {
    let points = thin(points, 0.5);
    let mut keep = vec![false; points.len()];
    let mut stretches = vec![(0, points.len().saturating_sub(1))];
    // Douglas and Peucker (1973): keep the farthest point of a stretch while it is too far from its chord.
    while let Some((from, to)) = stretches.pop() {
        if points.is_empty() {
            break;
        }
        (keep[from], keep[to]) = (true, true);
        let farthest = (from + 1..to)
            .map(|k| (distance(points[k], points[from], points[to]), k))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|(distance, _)| *distance > TOLERANCE);
        if let Some((_, k)) = farthest {
            stretches.extend([(from, k), (k, to)]);
        }
    }
    points.into_iter().zip(keep).filter_map(|(point, keep)| keep.then_some(point)).collect()
}

/// Cuts a polyline at its sharp corners, which stay in both pieces.
pub(super) fn smooth_pieces(points: Vec<Point>) -> Vec<Vec<Point>> {
    /// Cosine of the turn above which a corner is smooth.
    const SMOOTH: f64 = 0.7;
    let mut pieces = Vec::new();
    let mut start = 0;
    for k in 1..points.len().saturating_sub(1) {
        let (a, b, c) = (points[k - 1], points[k], points[k + 1]);
        let (u, v) = ((b.0 - a.0, b.1 - a.1), (c.0 - b.0, c.1 - b.1));
        if u.0 * v.0 + u.1 * v.1 < SMOOTH * u.0.hypot(u.1) * v.0.hypot(v.1) {
            pieces.push(points[start..=k].to_vec());
            start = k;
        }
    }
    pieces.push(points[start..].to_vec());
    pieces
}

/// Distance of `p` from the line through `a` and `b`.
fn distance(p: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length = dx.hypot(dy);
    if length == 0.0 {
        return (p.0 - a.0).hypot(p.1 - a.1);
    }
    ((p.0 - a.0) * dy - (p.1 - a.1) * dx).abs() / length
}

/// Cuts a polyline into the drawn stretches of a dash pattern; an empty pattern leaves it whole.
pub(super) fn dashes(points: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    if pattern.is_empty() || points.len() < 2 {
        return vec![points.to_vec()];
    }
    let mut out = Vec::new();
    let (mut index, mut left) = (0, pattern[0]);
    let mut current = vec![points[0]];
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let length = (b.0 - a.0).hypot(b.1 - a.1);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let at = (a.0 + (b.0 - a.0) * done / length, a.1 + (b.1 - a.1) * done / length);
            if index % 2 == 0 {
                current.push(at);
                out.push(std::mem::take(&mut current));
            } else {
                current = vec![at];
            }
            index = (index + 1) % pattern.len();
            left = pattern[index];
        }
        left -= length - done;
        if index % 2 == 0 {
            current.push(b);
        }
    }
    if index % 2 == 0 && current.len() > 1 {
        out.push(current);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_keep_their_phase_around_corners() {
        let corner = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0)];
        let drawn = dashes(&corner, &[2.0, 2.0]);
        assert_eq!(drawn, vec![vec![(0.0, 0.0), (2.0, 0.0)], vec![(3.0, 1.0), (3.0, 3.0)]]);
    }

    #[test]
    fn thinning_keeps_ends_and_extremes() {
        let spike: Vec<Point> =
            (0..1000).map(|k| (f64::from(k) * 1e-3, if k == 500 { 9.0 } else { 0.0 })).collect();
        let thinned = thin(&spike, 1.0);
        assert!(thinned.len() <= 4);
        assert_eq!((thinned[0], thinned[thinned.len() - 1]), (spike[0], spike[999]));
        assert!(thinned.iter().any(|p| p.1 == 9.0));
    }

    #[test]
    fn a_straight_line_keeps_two_corners_and_a_step_keeps_four() {
        let line: Vec<Point> = (0..500).map(|k| (f64::from(k), 2.0 * f64::from(k))).collect();
        assert_eq!(simplified(&line), vec![line[0], line[499]]);
        let step: Vec<Point> = (0..500).map(|k| (f64::from(k), if k < 250 { 0.0 } else { 90.0 })).collect();
        assert_eq!(simplified(&step).len(), 4);
        assert!(simplified(&[]).is_empty());
    }

    #[test]
    fn a_polyline_is_cut_at_its_sharp_corners_only() {
        let pieces = smooth_pieces(vec![(0.0, 0.0), (1.0, 0.0), (2.0, 0.1), (2.0, 9.0)]);
        assert_eq!(pieces, vec![vec![(0.0, 0.0), (1.0, 0.0), (2.0, 0.1)], vec![(2.0, 0.1), (2.0, 9.0)]]);
    }

    #[test]
    fn missing_values_leave_a_gap() {
        let pieces = unbroken([(0.0, 1.0), (1.0, f64::NAN), (2.0, 1.0)].into_iter());
        assert_eq!(pieces, vec![vec![(0.0, 1.0)], vec![(2.0, 1.0)]]);
    }
}
