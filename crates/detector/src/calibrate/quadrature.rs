//! Gauss-Legendre quadrature and the solution of a run length's integral equation with it (Nystroem's method).
//!
//! `a(s) = r(s) + p(s) a(s0) + int K(s, y) a(y) dy`: what one sample brings (`r = 1` for a run length), then on from the
//! atom `s0` (a barrier where the statistic stays with probability `p`) or from `y`. At the nodes it is a linear system; between them the
//! equation itself interpolates.
//!
//! Source: D. Brook and D. A. Evans, Biometrika 59 (1972) 539; C. W. Champ and S. E. Rigdon, Commun. Stat. Simul.
//! Comput. 20 (1991) 191; nodes: W. H. Press et al., Numerical Recipes, 2007, section 4.6.
use nalgebra::{DMatrix, DVector};

/// A node and its weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub x: f64,
    pub weight: f64,
}

/// `count` nodes between two bounds.
pub(super) fn gauss_legendre(count: usize, low: f64, high: f64) -> Vec<Node> {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    (0..count)
        .map(|i| {
            let (root, slope) = legendre_root(count, i);
            Node { x: middle - half * root, weight: 2.0 * half / ((1.0 - root * root) * slope * slope) }
        })
        .collect()
}

/// The `i`-th root of the Legendre polynomial of a degree, from above, and the derivative there.
fn legendre_root(degree: usize, i: usize) -> (f64, f64) {
    let n = degree as f64;
    let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
    let mut slope = 1.0;
    // Newton's method converges quadratically from this start; ten steps are more than enough.
    for _ in 0..10 {
        let (mut p, mut before) = (1.0, 0.0);
        for k in 0..degree {
            let k = k as f64;
            (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
        }
        slope = n * (x * p - before) / (x * x - 1.0);
        let step = p / slope;
        x -= step;
        if step.abs() < 1e-15 {
            break;
        }
    }
    (x, slope)
}

/// Number of nodes that resolve a kernel so wide on a domain so long.
pub(super) fn enough_nodes(domain: f64, kernel_width: f64) -> usize {
    (40.0 + 6.0 * domain / kernel_width).min(1200.0) as usize
}

/// What a sample brings to a run length: itself.
pub(super) fn one_sample(_: f64) -> f64 {
    1.0
}

/// A run length, or a probability of how a run ends, `a(s)`, as a function of the start.
pub(super) struct RunLength<K, P, R> {
    nodes: Vec<Node>,
    at_nodes: DVector<f64>,
    at_atom: f64,
    kernel: K,
    atom: P,
    brought: R,
}

impl<K: Fn(f64, f64) -> f64, P: Fn(f64) -> f64, R: Fn(f64) -> f64> RunLength<K, P, R> {
    /// Solve for `kernel(s, y)` on the nodes with the atom at `atom_at`, reached from `s` with probability `atom(s)`,
    /// where a sample from `s` brings `brought(s)`.
    pub fn solve(nodes: Vec<Node>, kernel: K, (atom_at, atom): (f64, P), brought: R) -> Self {
        let n = nodes.len();
        let start = |i: usize| if i < n { nodes[i].x } else { atom_at };
        let system = DMatrix::from_fn(n + 1, n + 1, |i, j| {
            let moved = if j < n { nodes[j].weight * kernel(start(i), nodes[j].x) } else { atom(start(i)) };
            f64::from(u8::from(i == j)) - moved
        });
        let right = DVector::from_fn(n + 1, |i, _| brought(start(i)));
        // Singular only if no alarm ever comes: the run is then endless.
        let solution =
            system.lu().solve(&right).unwrap_or_else(|| DVector::from_element(n + 1, f64::INFINITY));
        Self {
            at_nodes: solution.rows(0, n).into_owned(),
            at_atom: solution[n],
            nodes,
            kernel,
            atom,
            brought,
        }
    }

    /// `a(s)`.
    pub fn starting_at(&self, s: f64) -> f64 {
        let moved: f64 = self
            .nodes
            .iter()
            .zip(self.at_nodes.iter())
            .map(|(node, value)| node.weight * (self.kernel)(s, node.x) * value)
            .sum();
        (self.brought)(s) + (self.atom)(s) * self.at_atom + moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_rule_of_n_nodes_integrates_polynomials_up_to_degree_2n_minus_1_exactly() {
        for n in [1, 2, 5, 12] {
            let nodes = gauss_legendre(n, -1.0, 3.0);
            for degree in 0..2 * n as i32 {
                let sum: f64 = nodes.iter().map(|node| node.weight * node.x.powi(degree)).sum();
                let exact = (3_f64.powi(degree + 1) - (-1_f64).powi(degree + 1)) / f64::from(degree + 1);
                assert_relative_eq!(sum, exact, max_relative = 1e-11, epsilon = 1e-11);
            }
        }
    }

    #[test]
    fn a_thousand_nodes_integrate_a_bell() {
        let nodes = gauss_legendre(1000, -30.0, 30.0);
        let sum: f64 = nodes.iter().map(|node| node.weight * (-0.5 * node.x * node.x).exp()).sum();
        assert_relative_eq!(sum, std::f64::consts::TAU.sqrt(), max_relative = 1e-13);
    }
}
