//! The engines of a bank against the textbook filter, on linear processes.
use cylwatch_estimator::filter::horizon::HorizonSettings;
use cylwatch_estimator::filter::{Bank, BankEngine, Workspace};

use crate::linear_model::{Case, DenseFilter, covariance_difference, rng, state_difference};

#[test]
fn every_engine_that_estimates_all_states_is_the_textbook_filter() {
    let horizon =
        BankEngine::MovingHorizon(HorizonSettings { samples: 5, ..HorizonSettings::default() }, Vec::new());
    for (engine, tolerance) in
        [(BankEngine::Extended, 1e-10), (BankEngine::Unscented, 1e-10), (horizon, 1e-8)]
    {
        let mut rng = rng(61);
        for sizes in [(1, 1, 1), (4, 4, 2), (8, 5, 3), (12, 12, 4)] {
            let Case { mut model, x0, p0, dt_s, z } = Case::random(&mut rng, sizes, 25);
            let mut work = Workspace::new(&model);
            // Five members: more than one pack.
            let members = vec![((), p0.clone()); 5];
            let mut bank = Bank::new(&mut model, &engine, x0.as_slice(), &members).unwrap();
            let mut textbook = DenseFilter::new(x0, p0);
            for (dt_s, z) in dt_s.iter().zip(&z) {
                bank.predict(&mut model, &mut work, *dt_s).unwrap();
                bank.update(&mut model, &mut work, z).unwrap();
                textbook.step(&model, *dt_s, z);
                for index in 0..5 {
                    let mean = bank.mean(index);
                    let state = state_difference(mean.as_slice(), &textbook.x, &textbook.p);
                    let covariance = covariance_difference(&bank.covariance(index), &textbook.p);
                    assert!(
                        state < tolerance && covariance < tolerance,
                        "{engine:?} {sizes:?}: {state:e} {covariance:e}"
                    );
                }
            }
            assert_eq!(bank.fallbacks(), 0);
        }
    }
}
