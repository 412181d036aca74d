//! Record of a member's last step, as a smoother and the signature of a leak need it.
use nalgebra::DMatrix;

use crate::filter::PassStep;
use crate::filter::dense::add_product;

/// The last step of a member.
#[derive(Clone, Debug)]
pub(super) struct Pass {
    pub step: PassStep,
    /// Whether mass, gas temperature and leak rate were freed before the sample's readings, and mass and gas temperature before each of them.
    pub opened: bool,
    pub opened_before: Vec<bool>,
    /// Whether the member began anew after the readings: nothing links it with what it was.
    pub begun_anew: bool,
    /// Factor by which each state came nearer to its rest before the readings: (n).
    pub relaxed: Vec<f64>,
    /// States that were held at a bound after the readings, with what each lacked over its variance; and the shares of that which all states took on: (n), one after
    /// the other.
    pub bounded: Vec<(usize, f64)>,
    pub shares: Vec<f64>,
    /// Memory of a product.
    product: DMatrix<f64>,
}

impl Pass {
    /// No step yet, of a member with `n` states, of which `leading` move, and so many sensors.
    pub fn new(n: usize, leading: usize, sensors: usize) -> Self {
        Self {
            step: PassStep::zeros(n, leading, sensors),
            opened: false,
            begun_anew: false,
            opened_before: vec![false; sensors],
            relaxed: vec![1.0; n],
            bounded: Vec::with_capacity(n),
            shares: Vec::with_capacity(n * n),
            product: DMatrix::zeros(leading, n),
        }
    }

    /// Become as that of another bank of the same observer, without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.step.copy_from(&other.step);
        self.opened = other.opened;
        self.opened_before.clone_from(&other.opened_before);
        self.begun_anew = other.begun_anew;
        self.relaxed.clone_from(&other.relaxed);
        self.bounded.clone_from(&other.bounded);
        self.shares.clone_from(&other.shares);
    }

    /// A sample comes `dt_s`, s, after the last one.
    pub fn begin(&mut self, dt_s: f64) {
        self.step.interval_s = dt_s;
        self.step.phi.fill_with_identity();
        self.step.used.fill(false);
        self.opened = false;
        self.begun_anew = false;
        self.relaxed.fill(1.0);
        self.opened_before.fill(false);
        self.bounded.clear();
        self.shares.clear();
    }

    /// Part of the interval with the transition `phi`: (leading, n).
    pub fn move_on(&mut self, phi: &DMatrix<f64>) {
        let m = phi.nrows();
        let (moving, constant) = phi.as_slice().split_at(m * m);
        let product = self.product.as_mut_slice();
        product[..m * m].fill(0.0);
        product[m * m..].copy_from_slice(constant);
        add_product(product, 1.0, moving, self.step.phi.as_slice(), m);
        std::mem::swap(&mut self.product, &mut self.step.phi);
    }

    /// A reading was used: gradient and gain (n), innovation and its variance.
    pub fn take(&mut self, sensor: usize, h: &[f64], gain: &[f64], (nu, s): (f64, f64)) {
        let step = &mut self.step;
        step.h.column_mut(sensor).as_mut_slice().copy_from_slice(h);
        step.gain.column_mut(sensor).as_mut_slice().copy_from_slice(gain);
        step.innovation[sensor] = nu;
        step.variance[sensor] = s;
        step.used[sensor] = true;
    }

    /// A constant came nearer to its rest.
    pub fn relax(&mut self, state: usize, factor: f64) {
        self.relaxed[state] *= factor;
    }

    /// A state was held at its bound, lacking so much over its variance; all took on such shares of what it lacked: (n), 1 of itself.
    pub fn bound(&mut self, state: usize, force: f64, shares: &[f64]) {
        self.bounded.push((state, force));
        self.shares.extend_from_slice(shares);
    }

    /// The member began anew.
    pub fn begin_anew(&mut self) {
        self.begun_anew = true;
    }

    /// Mass and gas temperature are freed before the readings, or before that of one sensor.
    pub fn open(&mut self, before: Option<usize>) {
        match before {
            Some(sensor) => self.opened_before[sensor] = true,
            None => self.opened = true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_is_the_step_and_not_the_one_before() {
        let mut step = Pass::new(3, 2, 2);
        step.begin(60.0);
        step.move_on(&DMatrix::from_fn(2, 3, |row, column| 0.1 + row as f64 + 0.3 * column as f64));
        step.take(1, &[1.0, 2.0, 3.0], &[0.1, 0.2, 0.3], (0.5, 2.0));
        step.relax(2, 0.5);
        step.open(None);
        step.open(Some(1));
        step.bound(1, 0.2, &[0.4, 1.0, -0.1]);
        step.begin_anew();
        let mut copy = Pass::new(3, 2, 2);
        copy.copy_from(&step);
        let marks = |of: &Pass| {
            let bounds = (of.bounded.clone(), of.shares.clone());
            (of.opened, of.opened_before.clone(), of.begun_anew, of.relaxed.clone(), bounds)
        };
        assert_eq!((&copy.step, marks(&copy)), (&step.step, marks(&step)));
        // Its own memory of a product is as good.
        for of in [&mut step, &mut copy] {
            of.move_on(&DMatrix::from_element(2, 3, 0.7));
        }
        assert_eq!(copy.step, step.step);
    }
}
