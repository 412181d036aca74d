use nalgebra::{DMatrix, DVector};

use super::*;
use crate::filter::{Linearisation, SPREAD_SQUARED, SigmaPoints, StateSpace, UdFactors};
use crate::observer::ObserverSettings;
use crate::sensor::Sensor;
use crate::thermal::vessel::presets;

fn cylinder() -> Cylinder {
    let sensors = ["shoulder", "valve", "pressure"].map(|name| Sensor::typical(name).unwrap());
    Cylinder::new(&presets::load("nitrogen-20l").unwrap(), &sensors, &ObserverSettings::default()).unwrap()
}

/// A gas warmer than the wall, everything in doubt.
fn start(cylinder: &Cylinder) -> (Vec<f64>, DMatrix<f64>) {
    use crate::observer::states::StateKind;
    let n = cylinder.states();
    let (mut x, mut p) = (vec![0.0; n], DMatrix::zeros(n, n));
    for (i, kind) in cylinder.state_map().kinds.iter().enumerate() {
        let (mean, sd) = match kind {
            StateKind::Wall(node) => (280.0 + *node as f64, 1.0),
            StateKind::Valve => (279.0, 1.0),
            StateKind::Gas => (290.0, 2.0),
            StateKind::Mass => (4.5, 0.05),
            StateKind::Leak => (0.0, 0.0),
            StateKind::Air => (270.0, 5.0),
            StateKind::OutsideFilm | StateKind::InsideFilm | StateKind::Capacity => (0.1, 0.3),
            StateKind::FilmSlope => (0.05, 0.2),
            StateKind::ValveSun => (0.02, 0.1),
            StateKind::Sun | StateKind::Lag { .. } => (1.0, 2.0),
            StateKind::Parameter { sensor, parameter } => {
                let parameter = &cylinder.sensors()[*sensor].parameters()[*parameter];
                (parameter.mean, parameter.sd)
            }
        };
        x[i] = mean;
        p[(i, i)] = sd * sd;
    }
    (x, p)
}

fn observe(
    cylinder: &mut Cylinder,
    points: &mut SigmaPoints,
    (x, p): (&mut [f64], &mut UdFactors),
    readings: &[f64],
) {
    let (mut h, mut gain) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    for (sensor, reading) in readings.iter().enumerate().filter(|(_, reading)| reading.is_finite()) {
        let (value, r) = points.output(cylinder, sensor, x, p, &mut h).unwrap();
        p.update(&h, r, &mut gain);
        x.iter_mut().zip(&gain).for_each(|(x, k)| *x += k * (reading - value));
    }
}

/// The unscented filter on a dense covariance, its points drawn anew for each reading (Julier and Uhlmann 2004).
struct Dense {
    cylinder: Cylinder,
    x: DVector<f64>,
    p: DMatrix<f64>,
}

impl Dense {
    /// `x` and `x +- s sqrt(d_j) u_j`.
    fn points(&self) -> Vec<DVector<f64>> {
        let factors = UdFactors::from_covariance(&self.p).unwrap();
        let away =
            |j: usize| factors.unit_upper().column(j) * (SPREAD_SQUARED * factors.diagonal()[j]).sqrt();
        let pairs = (0..self.x.len()).flat_map(|j| [&self.x + away(j), &self.x - away(j)]);
        [self.x.clone()].into_iter().chain(pairs).collect()
    }

    /// Mean of values at the points, and their departures from it times the square root of their weights in covariances; that of the
    /// middle may be negative.
    fn moments(&self, values: &[DVector<f64>]) -> (DVector<f64>, Vec<(f64, DVector<f64>)>) {
        let n = self.x.len() as f64;
        let weight = 0.5 / SPREAD_SQUARED;
        let middle = (SPREAD_SQUARED - n) / SPREAD_SQUARED + 3.0 - SPREAD_SQUARED / n;
        let shift: DVector<f64> = values[1..].iter().map(|value| (value - &values[0]) * weight).sum();
        let mean = &values[0] + shift;
        let of = |(i, value): (usize, &DVector<f64>)| (if i == 0 { middle } else { weight }, value - &mean);
        let departures = values.iter().enumerate().map(of).collect();
        (mean, departures)
    }

    fn step(&mut self, dt_s: f64, readings: &[f64]) {
        let (n, leading) = (self.x.len(), self.cylinder.leading());
        let mut linear = Linearisation::zeros(n, leading, self.cylinder.noises());
        let mut points = self.points();
        for (i, point) in points.iter_mut().enumerate() {
            let linear = (i == 0).then_some(&mut linear);
            self.cylinder.propagate(point.as_mut_slice(), dt_s, linear).unwrap();
        }
        let (mean, departures) = self.moments(&points);
        self.x = mean;
        self.p = departures.iter().map(|(weight, d)| d * d.transpose() * *weight).sum();
        let mut moving = self.p.view_mut((0, 0), (leading, leading));
        moving += &linear.g * DMatrix::from_diagonal(&linear.q) * linear.g.transpose();
        for (j, &z) in readings.iter().enumerate().filter(|(_, z)| z.is_finite()) {
            let noise = self.cylinder.noise_variance(j, self.x.as_slice());
            let points = self.points();
            let output = |x: &DVector<f64>| {
                DVector::from_element(1, self.cylinder.output(j, x.as_slice(), None).unwrap())
            };
            let outputs: Vec<_> = points.iter().map(output).collect();
            let (mean, departures) = self.moments(&outputs);
            let s = departures.iter().map(|(weight, d)| weight * d[0] * d[0]).sum::<f64>() + noise;
            let pairs = departures.iter().zip(&points);
            let cross: DVector<f64> = pairs.map(|((weight, d), x)| (x - &self.x) * (weight * d[0])).sum();
            self.x += &cross * ((z - mean[0]) / s);
            self.p -= &cross * cross.transpose() / s;
        }
    }
}

#[test]
fn statistical_linearisation_is_the_unscented_filter_with_dense_covariance() {
    let mut cylinder = cylinder();
    let (mut x, dense) = start(&cylinder);
    let n = x.len();
    let mut reference =
        Dense { cylinder: self::cylinder(), x: DVector::from_column_slice(&x), p: dense.clone() };
    let mut p = UdFactors::from_covariance(&dense).unwrap();
    let mut points = SigmaPoints::new(&cylinder);
    for k in 0..40 {
        let (t, missing) = (f64::from(k) * 15.0, if k % 7 == 3 { f64::NAN } else { 0.0 });
        let readings = [279.0 - t * 2e-3, 278.0 - t * 3e-3 + missing, 195e5 - 300.0 * t];
        reference.step(15.0, &readings);
        points.predict(&mut cylinder, &mut x, &mut p, 15.0).unwrap();
        observe(&mut cylinder, &mut points, (&mut x, &mut p), &readings);
    }
    let (ours, theirs) = (p.covariance(), reference.p);
    for i in 0..n {
        let sd = theirs[(i, i)].sqrt();
        assert!((x[i] - reference.x[i]).abs() <= 1e-7 * sd, "state {i}");
        for j in 0..n {
            let scale = sd * theirs[(j, j)].sqrt();
            assert!((ours[(i, j)] - theirs[(i, j)]).abs() <= 1e-7 * scale, "covariance ({i}, {j})");
        }
    }
}

#[test]
fn a_point_outside_the_domain_is_replaced_by_the_tangent() {
    let mut cylinder = cylinder();
    let (mut x, mut dense) = start(&cylinder);
    let mass = cylinder.state_map().mass;
    dense[(mass, mass)] = 9.0; // three times sqrt(3) kg reaches below an empty cylinder
    let mut p = UdFactors::from_covariance(&dense).unwrap();
    let mut points = SigmaPoints::new(&cylinder);
    points.predict(&mut cylinder, &mut x, &mut p, 15.0).unwrap();
    observe(&mut cylinder, &mut points, (&mut x, &mut p), &[279.0, 278.0, 195e5]);
    assert!(x.iter().all(|x| x.is_finite()));
    // What is left is the doubt about the gas temperature and the transmitter.
    assert!(p.variance(mass).sqrt() < 0.1, "mass sd {}", p.variance(mass).sqrt());
}
