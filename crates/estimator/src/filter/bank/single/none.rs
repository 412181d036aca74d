//! No engine but the extended filter without the feature `design`: members that cannot be made.
use core::convert::Infallible;
use core::marker::PhantomData;

use nalgebra::DMatrix;

use super::engine::BankEngine;
use super::member::Member;
use super::workspace::Workspace;
use crate::EstimatorError;
use crate::filter::plant::Plant;
use crate::filter::ud::UdFactors;

#[derive(Clone, Debug)]
pub(super) struct Single<P> {
    never: Infallible,
    plant: PhantomData<P>,
}

impl<P: Plant> Single<P> {
    pub(super) fn new(_engine: &BankEngine, _plant: &P, _p: UdFactors) -> Result<Self, EstimatorError> {
        Err(EstimatorError::EngineMissing)
    }

    pub(super) fn copy_from(&mut self, _other: &Self) {
        match self.never {}
    }

    pub(super) fn predict(
        &mut self,
        _plant: &mut P,
        _work: &mut Workspace,
        _member: &mut Member<P::Hypothesis>,
        _dt_s: f64,
    ) -> Result<(), P::Error> {
        match self.never {}
    }

    pub(super) fn update(
        &mut self,
        _plant: &mut P,
        _work: &mut Workspace,
        _member: &mut Member<P::Hypothesis>,
        _reading: (usize, f64),
    ) -> Result<(), P::Error> {
        match self.never {}
    }

    pub(super) fn interrupt(&mut self) {
        match self.never {}
    }

    pub(super) fn finish(&mut self, _plant: &mut P, _member: &mut Member<P::Hypothesis>) {
        match self.never {}
    }

    pub(super) fn relax(&mut self, _state: usize, _factor: f64, _rest: f64) {
        match self.never {}
    }

    pub(super) fn inflate(&mut self, _state: usize, _variance: f64) {
        match self.never {}
    }

    pub(super) fn decorrelate_and_set(&mut self, _state: usize, _variance: f64) {
        match self.never {}
    }

    pub(super) fn is_finite(&self) -> bool {
        match self.never {}
    }

    pub(super) fn variance(&self, _state: usize) -> f64 {
        match self.never {}
    }

    pub(super) fn write_column(&self, _state: usize, _column: &mut [f64]) {
        match self.never {}
    }

    pub(super) fn covariance(&self) -> DMatrix<f64> {
        match self.never {}
    }

    pub(super) fn fallbacks(&self) -> u64 {
        match self.never {}
    }
}
