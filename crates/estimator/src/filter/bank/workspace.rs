//! Memory of a step.
use super::pack::PackMemory;
use crate::filter::plant::Plant;
use crate::filter::state_space::Linearisation;
use crate::filter::unscented::SigmaPoints;
use alloc::vec::Vec;

/// Memory that all members share. Nothing in it outlives a step.
#[derive(Debug)]
pub struct Workspace {
    pub(super) linear: Linearisation,
    pub(super) h: Vec<f64>,
    pub(super) gain: Vec<f64>,
    pub(super) points: SigmaPoints,
    pub(super) pack: PackMemory,
}

impl Workspace {
    /// Memory for banks of this plant.
    pub fn new<P: Plant>(plant: &P) -> Self {
        let n = plant.states();
        Self {
            linear: Linearisation::zeros(n, plant.leading(), plant.noises()),
            h: vec![0.0; n],
            gain: vec![0.0; n],
            points: SigmaPoints::new(plant),
            pack: PackMemory::new(plant),
        }
    }
}
