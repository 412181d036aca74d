//! Observed order of accuracy of wall conduction against closed forms: slab and cylindrical shell, step and periodic boundary.
//!
//! Inner face insulated, outer face at a given temperature, diffusivity 1. The mesh's own shape factors
//! make the matrices; time is treated exactly (eigenvalues, complex solve), so that only the mesh errs.
use cylwatch_thermal::wall::geometry::{Geometry, Layer};
use cylwatch_thermal::wall::mesh::Mesh;
use nalgebra::{Complex, DMatrix, DVector, SymmetricEigen};

use crate::support::{closed_bottle, solid};

type C = Complex<f64>;

/// One column of `cells` radial cells: node positions (depth from the inner face), volumes, stiffness matrix,
/// conductance of the outermost half cell. Density, capacity and conductivity are 1.
struct Wall {
    position_m: Vec<f64>,
    volume_m3: DVector<f64>,
    stiffness: DMatrix<f64>,
    outer: f64,
}

/// The middle of a flat end is a slab of constant area; a column of the cylinder is a shell.
fn wall(cells: usize, radius_m: f64, thickness_m: f64, slab: bool) -> Wall {
    let base = closed_bottle().geometry;
    let layer = Layer { material: solid(1.0, 1.0, 1.0), thickness_m, cells };
    let mut bottom = base.bottom;
    bottom.cells = 2;
    bottom.thickness_m = thickness_m;
    let mesh = Mesh::new(&Geometry {
        inner_diameter_m: 2.0 * radius_m,
        bottom,
        layers: vec![layer],
        lumped: false,
        ..base
    });
    let column = if slab { 0 } else { 2 };
    let first = mesh.cell(column, 0);
    let mut stiffness = DMatrix::zeros(cells, cells);
    for link in mesh.links.iter().filter(|l| l.a >= first && l.b < first + cells) {
        let g = 1.0 / (1.0 / link.shape_a_m + 1.0 / link.shape_b_m);
        let (a, b) = (link.a - first, link.b - first);
        stiffness[(a, a)] += g;
        stiffness[(b, b)] += g;
        stiffness[(a, b)] -= g;
        stiffness[(b, a)] -= g;
    }
    let outer = mesh.columns[column].outer_shape_m;
    stiffness[(cells - 1, cells - 1)] += outer;
    Wall {
        position_m: (0..cells).map(|k| (k as f64 + 0.5) / cells as f64 * thickness_m).collect(),
        volume_m3: DVector::from_fn(cells, |k, _| mesh.volume_m3[first + k]),
        stiffness,
        outer,
    }
}

impl Wall {
    /// Nodes at time `t` after the outer face has jumped from 1 to 0.
    fn after_step(&self, t: f64) -> DVector<f64> {
        let root = self.volume_m3.map(f64::sqrt);
        let scaled =
            DMatrix::from_fn(root.len(), root.len(), |i, j| self.stiffness[(i, j)] / (root[i] * root[j]));
        let eigen = SymmetricEigen::new(scaled);
        let start = eigen.eigenvectors.transpose() * &root;
        let decayed = start.zip_map(&eigen.eigenvalues, |s, l| s * (-l * t).exp());
        (eigen.eigenvectors * decayed).component_div(&root)
    }

    /// Complex amplitude of the nodes under an outer face temperature `exp(i w t)`.
    fn periodic(&self, w: f64) -> DVector<C> {
        let n = self.volume_m3.len();
        let matrix = DMatrix::from_fn(n, n, |i, j| {
            C::new(self.stiffness[(i, j)], if i == j { w * self.volume_m3[i] } else { 0.0 })
        });
        let mut rhs = DVector::from_element(n, C::new(0.0, 0.0));
        rhs[n - 1] = C::new(self.outer, 0.0);
        matrix.lu().solve(&rhs).unwrap()
    }
}

/// Assert order 2 over four meshes for the largest node error.
fn assert_second_order(what: &str, error: impl Fn(usize) -> f64) {
    let errors: Vec<f64> = [6, 12, 24, 48].into_iter().map(error).collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() <= 0.2, "{what}: order {order:.3}, errors {errors:?}");
    }
    println!("{what}: errors {errors:?}");
}

/// `sum (2n+1)^-1 4/pi (-1)^n exp(-(2n+1)² pi² t / 4 L²) cos((2n+1) pi x / 2 L)`, Carslaw and Jaeger section 3.3.
#[test]
fn slab_step_converges_with_second_order() {
    let (l, t) = (0.05, 0.05 * 0.05 * 0.2);
    let exact = |x: f64| -> f64 {
        (0..60)
            .map(|n| {
                let m = 2.0 * f64::from(n) + 1.0;
                let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
                let k = m * std::f64::consts::FRAC_PI_2 / l;
                4.0 / (std::f64::consts::PI * m) * sign * (-k * k * t).exp() * (k * x).cos()
            })
            .sum()
    };
    assert_second_order("slab, step", |cells| {
        let wall = wall(cells, 0.1, l, true);
        let nodes = wall.after_step(t);
        nodes.iter().zip(&wall.position_m).map(|(n, &x)| (n - exact(x)).abs()).fold(0.0, f64::max)
    });
}

/// `cosh(q x) / cosh(q L)`, `q = sqrt(i w)`.
#[test]
fn slab_periodic_converges_with_second_order() {
    let (l, w) = (0.05, 4.0 / (0.05 * 0.05));
    let q = C::new(0.0, w).sqrt();
    assert_second_order("slab, periodic", |cells| {
        let wall = wall(cells, 0.1, l, true);
        let nodes = wall.periodic(w);
        nodes
            .iter()
            .zip(&wall.position_m)
            .map(|(n, &x)| (n - (q * x).cosh() / (q * l).cosh()).norm())
            .fold(0.0, f64::max)
    });
}

/// Ascending series of the modified Bessel functions I0, I1, K0, K1 (Abramowitz and Stegun 9.6.12, 9.6.13, 9.6.11).
fn bessel(z: C) -> (C, C, C, C) {
    const GAMMA: f64 = 0.577_215_664_901_532_9;
    let quarter = z * z * 0.25;
    let log = (z * 0.5).ln();
    let (mut i0, mut i1, mut k0, mut k1) =
        (C::new(0.0, 0.0), C::new(0.0, 0.0), C::new(0.0, 0.0), C::new(0.0, 0.0));
    let (mut term, mut harmonic) = (C::new(1.0, 0.0), 0.0);
    for k in 0..80 {
        let kf = f64::from(k);
        i0 += term;
        k0 += term * harmonic;
        let term1 = term / (kf + 1.0);
        i1 += term1;
        // psi(k+1) + psi(k+2)
        k1 += term1 * (2.0 * (harmonic - GAMMA) + 1.0 / (kf + 1.0));
        harmonic += 1.0 / (kf + 1.0);
        term = term * quarter / ((kf + 1.0) * (kf + 1.0));
    }
    let i1 = i1 * z * 0.5;
    (i0, i1, -(log + GAMMA) * i0 + k0, z.inv() + log * i1 - z * 0.25 * k1)
}

/// `[I0(q r) K1(q a) + K0(q r) I1(q a)] / [.. at b]`.
#[test]
fn shell_periodic_converges_with_second_order() {
    let (a, l) = (0.05, 0.05);
    let w = 4.0 / (l * l);
    let q = C::new(0.0, w).sqrt();
    let (_, i1a, _, k1a) = bessel(q * a);
    let shape = |r: f64| {
        let (i0, _, k0, _) = bessel(q * r);
        i0 * k1a + k0 * i1a
    };
    assert_second_order("shell, periodic", |cells| {
        let wall = wall(cells, a, l, false);
        let nodes = wall.periodic(w);
        nodes
            .iter()
            .zip(&wall.position_m)
            .map(|(n, &x)| (n - shape(a + x) / shape(a + l)).norm())
            .fold(0.0, f64::max)
    });
}

/// J0, J1, Y0, Y1 from the modified functions on the imaginary axis: `J0(x) = I0(ix)`, `Y0(x) = i I0(ix) - (2/pi) K0(ix)` ...
fn bessel_real(x: f64) -> (f64, f64, f64, f64) {
    let i = C::new(0.0, 1.0);
    let (i0, i1, k0, k1) = bessel(i * x);
    let two_over_pi = std::f64::consts::FRAC_2_PI;
    // A&S 9.6.3 to 9.6.5 with z = i x: I_n(i x) = i^n J_n(x); K_0(i x) = -(pi/2)(Y0 + i J0), K_1(i x) = -(pi/2)(J1 - i Y1).
    (i0.re, (i1 / i).re, (-k0 * two_over_pi).re, (k1 * two_over_pi).im)
}

/// Eigenfunction series of the shell, Carslaw and Jaeger section 7.10.
#[test]
fn shell_step_converges_with_second_order() {
    let (a, l) = (0.05_f64, 0.05_f64);
    let (b, t) = (a + l, l * l * 0.1);
    let function = |lambda: f64, r: f64| {
        let (_, j1a, _, y1a) = bessel_real(lambda * a);
        let (j0, _, y0, _) = bessel_real(lambda * r);
        j0 * y1a - y0 * j1a
    };
    let derivative = |lambda: f64, r: f64| {
        let (_, j1a, _, y1a) = bessel_real(lambda * a);
        let (_, j1, _, y1) = bessel_real(lambda * r);
        -lambda * (j1 * y1a - y1 * j1a)
    };
    // Roots of R(b) = 0 by scanning and bisection; the sixth decays as exp(-30).
    let mut roots = Vec::new();
    let step = 0.2 / l;
    let mut low = 0.2 * step;
    while roots.len() < 6 {
        let high = low + step;
        if function(low, b) * function(high, b) < 0.0 {
            let (mut x0, mut x1) = (low, high);
            for _ in 0..60 {
                let m = 0.5 * (x0 + x1);
                if function(x0, b) * function(m, b) <= 0.0 { x1 = m } else { x0 = m }
            }
            roots.push(0.5 * (x0 + x1));
        }
        low = high;
    }
    let exact = |r: f64| -> f64 {
        roots
            .iter()
            .map(|&k| {
                let slope = derivative(k, b);
                let projection = -b * slope / (k * k);
                let norm = 0.5 * (b * b * slope * slope / (k * k) - a * a * function(k, a).powi(2));
                projection / norm * function(k, r) * (-k * k * t).exp()
            })
            .sum()
    };
    assert_second_order("shell, step", |cells| {
        let wall = wall(cells, a, l, false);
        let nodes = wall.after_step(t);
        nodes.iter().zip(&wall.position_m).map(|(n, &x)| (n - exact(a + x)).abs()).fold(0.0, f64::max)
    });
}

#[test]
fn series_give_tabulated_bessel_functions() {
    // Abramowitz and Stegun, tables 9.1 and 9.8.
    let (i0, i1, k0, k1) = bessel(C::new(2.0, 0.0));
    approx::assert_relative_eq!(i0.re, 2.279_585_302, max_relative = 1e-9);
    approx::assert_relative_eq!(i1.re, 1.590_636_855, max_relative = 1e-9);
    approx::assert_relative_eq!(k0.re, 0.113_893_873, max_relative = 1e-8);
    approx::assert_relative_eq!(k1.re, 0.139_865_882, max_relative = 1e-8);
    let (j0, j1, y0, y1) = bessel_real(5.0);
    approx::assert_relative_eq!(j0, -0.177_596_771, max_relative = 1e-8);
    approx::assert_relative_eq!(j1, -0.327_579_138, max_relative = 1e-8);
    approx::assert_relative_eq!(y0, -0.308_517_625, max_relative = 1e-8);
    approx::assert_relative_eq!(y1, 0.147_863_143, max_relative = 1e-8);
}
