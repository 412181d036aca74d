//! Memory of a step.
use super::pack::PackMemory;
use crate::filter::plant::Plant;
#[cfg(feature = "design")]
use crate::filter::{state_space::Linearisation, unscented::SigmaPoints};
#[cfg(feature = "design")]
use alloc::boxed::Box;
use alloc::vec::Vec;

/// Memory that all members share. Nothing in it outlives a step.
#[derive(Debug)]
pub struct Workspace {
    pub(super) h: Vec<f64>,
    pub(super) gain: Vec<f64>,
    /// Of members that move one by one, from the first step of one.
    #[cfg(feature = "design")]
    pub(super) single: Option<Box<SingleMemory>>,
    pub(super) pack: PackMemory,
}

impl Workspace {
    /// Memory for banks of this plant.
    pub fn new<P: Plant>(plant: &P) -> Self {
        let n = plant.states();
        Self {
            h: vec![0.0; n],
            gain: vec![0.0; n],
            #[cfg(feature = "design")]
            single: None,
            pack: PackMemory::new(plant),
        }
    }
}

/// Memory of members that move one by one.
#[cfg(feature = "design")]
#[derive(Debug)]
pub(super) struct SingleMemory {
    pub(super) linear: Linearisation,
    pub(super) points: SigmaPoints,
}

#[cfg(feature = "design")]
impl SingleMemory {
    pub(super) fn new<P: Plant>(plant: &P) -> Self {
        Self {
            linear: Linearisation::zeros(plant.states(), plant.leading(), plant.noises()),
            points: SigmaPoints::new(plant),
        }
    }
}
