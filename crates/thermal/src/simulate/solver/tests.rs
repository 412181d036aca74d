//! Dense output of the last step.
use super::*;
use crate::scenario::presets as scenarios;
use crate::vessel::presets as vessels;

/// Steps up to a time after which one more is made; with an edge at a part of that step beyond its end, s and states within that step.
fn within_last_step(edge: Option<f64>) -> (f64, Vec<Vec<f64>>) {
    let (vessel, scenario) = (vessels::load("nitrogen-20l").unwrap(), scenarios::load("ramp-warm").unwrap());
    let model = Model::new(&vessel, &scenario).unwrap();
    let x0 = model.initial_state(&vessel, &scenario.initial).unwrap();
    let drive = Drive {
        pieces: Cell::new(InputPieces::new(&scenario, 0.0, 18_000.0)),
        open: RefCell::new(Vec::new()),
        failure: RefCell::new(None),
    };
    let (states, settings) = (x0.len(), SimulationSettings::default());
    with_stepper(&model, &drive, x0, vec![1e-4; states], &settings, |stepper| {
        stepper.set_stop(18_000.0).unwrap();
        while stepper.time_s() < 3000.0 {
            assert_eq!(stepper.step().unwrap(), Step::Internal);
        }
        let begin_s = stepper.time_s();
        if let Some(edge_s) = edge {
            stepper.set_stop(edge_s).unwrap();
        }
        assert_eq!(stepper.step().unwrap(), Step::Internal, "the edge lies beyond the step");
        let length_s = stepper.time_s() - begin_s;
        let within = [0.1, 0.3, 0.5, 0.7, 0.9].map(|part| {
            let mut x = vec![0.0; states];
            stepper.interpolate(begin_s + part * length_s, &mut x).unwrap();
            x
        });
        Ok((stepper.time_s(), within.to_vec()))
    })
    .unwrap()
}

/// What is left before an edge rescales the history only when samples of the step before it have been taken.
#[test]
fn a_step_that_ends_right_before_an_edge_is_interpolated_like_one_that_does_not() {
    let (end_s, free) = within_last_step(None);
    for beyond in [1e-1, 1e-3, 1e-5, 1e-7] {
        let (same_s, edged) = within_last_step(Some(end_s + beyond));
        assert_eq!(same_s, end_s);
        for (state, (free, edged)) in free.iter().zip(&edged).flat_map(|(a, b)| a.iter().zip(b)).enumerate() {
            let off = (free - edged).abs() / free.abs().max(1.0);
            assert!(off < 1e-5, "{beyond} s before an edge, entry {state}: {free} {edged}");
        }
    }
}
