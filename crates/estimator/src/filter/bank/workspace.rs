//! Memory of a step.
use super::pack::PackMemory;
use crate::filter::plant::Plant;
use crate::filter::state_space::Linearisation;
use crate::filter::unscented::SigmaPoints;
use alloc::boxed::Box;
use alloc::vec::Vec;

/// Memory that all members share. Nothing in it outlives a step.
#[derive(Debug)]
pub struct Workspace {
    pub(super) h: Vec<f64>,
    pub(super) gain: Vec<f64>,
    /// Of members that move one by one, from the first step of one.
    pub(super) single: Option<Box<SingleMemory>>,
    pub(super) pack: PackMemory,
}

/// Memory of members that move one by one.
#[derive(Debug)]
pub(super) struct SingleMemory {
    pub(super) linear: Linearisation,
    pub(super) points: SigmaPoints,
}

impl SingleMemory {
    pub(super) fn new<P: Plant>(plant: &P) -> Self {
        Self {
            linear: Linearisation::zeros(plant.states(), plant.leading(), plant.noises()),
            points: SigmaPoints::new(plant),
        }
    }
}

impl Workspace {
    /// Memory for banks of this plant.
    pub fn new<P: Plant>(plant: &P) -> Self {
        let n = plant.states();
        Self { h: vec![0.0; n], gain: vec![0.0; n], single: None, pack: PackMemory::new(plant) }
    }
}
