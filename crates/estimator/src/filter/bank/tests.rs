use std::convert::Infallible;

use super::windowed::Windowed;
use super::*;
use crate::filter::horizon::HorizonSettings;
use crate::filter::{Dimensions, Gate, Linearisation, Outcome, StateSpace};

/// A level that walks and is read with an offset; a member supposes how fast it walks, variance per second.
#[derive(Clone, Debug)]
struct Level {
    intensity: f64,
}

impl StateSpace for Level {
    type Error = Infallible;

    fn dimensions(&self) -> Dimensions {
        Dimensions { states: 2, leading: 1, noises: 1, outputs: 1 }
    }

    fn propagate(
        &mut self,
        _x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), Infallible> {
        if let Some(linear) = linear {
            linear.phi.copy_from_slice(&[1.0, 0.0]);
            linear.g[(0, 0)] = 1.0;
            linear.q[0] = self.intensity * dt_s;
        }
        Ok(())
    }

    fn output(&mut self, _j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, Infallible> {
        if let Some(h) = h {
            h.fill(1.0);
        }
        Ok(x[0] + x[1])
    }

    fn noise_variance(&self, _j: usize, _x: &[f64]) -> f64 {
        0.01
    }
}

impl Plant for Level {
    type Hypothesis = f64;

    fn suppose(&mut self, intensity: &f64) {
        self.intensity = *intensity;
    }

    fn gate(&self, _: &f64, _: usize) -> Gate {
        Gate { limit: 16.0, rejections_in_a_row: 3 }
    }
}

fn bank(engine: &BankEngine) -> (Level, Workspace, Bank<Level>) {
    let mut level = Level { intensity: 0.0 };
    let prior = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 0.04]));
    let members = [0.0, 0.1, 1.0].map(|intensity| (intensity, prior.clone()));
    let bank = Bank::new(&mut level, engine, &[0.0, 0.0], &members).unwrap();
    (level.clone(), Workspace::new(&level), bank)
}

#[test]
fn each_member_gates_reads_and_reacquires_by_its_own_hypothesis() {
    let window = BankEngine::MovingHorizon(HorizonSettings::default(), Vec::new());
    for engine in [BankEngine::Extended, BankEngine::Unscented, window] {
        let (mut level, mut work, mut bank) = bank(&engine);
        let mut outcomes = Vec::new();
        for k in 0..8 {
            bank.predict(&mut level, &mut work, 1.0).unwrap();
            // From the fourth sample on it stands elsewhere.
            bank.update(&mut level, &mut work, &[if k < 3 { 0.1 } else { 3.0 }]).unwrap();
            outcomes.push([0, 1, 2].map(|index| bank.innovations(index)[0].outcome));
        }
        // Of the level at rest the fourth refusal is one too many; one that walks has followed at once.
        assert_eq!(outcomes[3], [Outcome::Rejected, Outcome::Rejected, Outcome::Accepted], "{engine:?}");
        assert_eq!(outcomes[6][0], Outcome::Reacquired, "{engine:?}");
        bank.replace(0, 2);
        assert_eq!((bank.mean(0), bank.covariance(0)), (bank.mean(2), bank.covariance(2)), "{engine:?}");
    }
}

#[test]
fn an_opened_estimate_begins_a_new_window() {
    let level = Level { intensity: 0.1 };
    let mut windowed = Windowed::new(&level, &HorizonSettings::default(), &[]);
    let mut x = vec![0.0; 2];
    let mut p = UdFactors::from_covariance(&DMatrix::identity(2, 2)).unwrap();
    let mut lengths = Vec::new();
    for k in 0..3 {
        if k == 2 {
            windowed.clear();
        }
        windowed.begin(10.0);
        windowed.refine(&mut x, &mut p);
        lengths.push(windowed.samples());
    }
    assert_eq!(lengths, [0, 1, 0]);
}
