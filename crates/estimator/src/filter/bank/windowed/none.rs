//! No moving horizon without the feature `design`: an engine that cannot be made.
use core::convert::Infallible;
use core::marker::PhantomData;

use crate::filter::ud::UdFactors;

#[derive(Clone, Debug)]
pub(super) struct Windowed<P> {
    never: Infallible,
    plant: PhantomData<P>,
    pub(super) fallbacks: u64,
}

impl<P> Windowed<P> {
    pub(super) fn begin(&mut self, _dt_s: f64) {
        match self.never {}
    }

    pub(super) fn take(&mut self, _output: usize, _reading: f64) {
        match self.never {}
    }

    pub(super) fn clear(&mut self) {
        match self.never {}
    }

    pub(super) fn relax(&mut self, _state: usize, _factor: f64, _rest: f64) {
        match self.never {}
    }

    pub(super) fn inflate(&mut self, _state: usize, _variance: f64) {
        match self.never {}
    }

    pub(super) fn refine(&mut self, _x: &mut [f64], _p: &mut UdFactors) {
        match self.never {}
    }
}
