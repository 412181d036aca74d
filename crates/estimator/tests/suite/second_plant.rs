//! The filters on a plant that is no cylinder, as the example of that name has it.
use cylwatch_estimator::consistency::Significance;
use cylwatch_estimator::filter::horizon::{Constraint, HorizonSettings};
use cylwatch_estimator::filter::{BankEngine, Workspace};

#[allow(dead_code)]
#[path = "../../examples/second_plant.rs"]
mod example;

use example::{SAMPLE_S, Tank, bank, ensembles, truth, watch};

const SEEDS: u64 = 200;

#[test]
fn errors_of_filter_and_smoother_on_another_plant_lie_in_the_band_of_chi_square() {
    let mut nees = ensembles();
    let (mut refused, mut certain) = (0, 0);
    for seed in 0..SEEDS {
        let (more, excluded) = watch(seed, 1.0, &mut nees).unwrap();
        (refused, certain) = (refused + more, certain + u32::from(excluded));
    }
    for nees in &nees {
        let judgement = nees.judge(Significance::FIVE_PERCENT);
        assert!(judgement.finding.is_consistent(), "{judgement:?}");
        assert!(judgement.times.iter().all(|at| at.runs == SEEDS));
    }
    // One reading of the gauge in twenty is spoilt.
    assert!((4600..5000).contains(&refused), "{refused}");
    assert!(certain > 60, "{certain}");
}

#[test]
fn the_tight_member_of_a_tight_tank_is_never_excluded() {
    for seed in 1000..1050 {
        assert!(!watch(seed, 0.0, &mut ensembles()).unwrap().1, "seed {seed}");
    }
}

#[test]
fn every_engine_finds_the_hidden_water_and_the_leak() {
    let horizon = BankEngine::MovingHorizon(
        HorizonSettings { samples: 10, ..HorizonSettings::default() },
        vec![Constraint::at_least(3, 0.0)],
    );
    for engine in [BankEngine::Extended, BankEngine::Unscented, BankEngine::Stationary, horizon] {
        let mut tank = Tank::default();
        let (mut bank, mut work) = (bank(&mut tank, &engine), Workspace::new(&tank));
        let truth = truth(7, 1.0);
        for (_, z) in &truth {
            let Ok(()) = bank.predict(&mut tank, &mut work, SAMPLE_S);
            let Ok(()) = bank.update(&mut tank, &mut work, z);
        }
        let end = truth.last().unwrap().0;
        for (state, true_value) in end.into_iter().enumerate() {
            let (mean, variance) = bank.moments(1, state);
            assert!((mean - true_value).abs() < 3.0 * variance.sqrt(), "{engine:?}: state {state}");
        }
        assert_eq!(bank.fallbacks(), 0, "{engine:?}");
    }
}
