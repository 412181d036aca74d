//! No moving horizon without the feature `design`: an engine that cannot be made.
use std::convert::Infallible;
use std::marker::PhantomData;

use crate::filter::ud::UdFactors;

#[derive(Clone, Debug)]
pub(super) struct Windowed<P> {
    never: Infallible,
    plant: PhantomData<P>,
    pub fallbacks: u64,
}

impl<P> Windowed<P> {
    pub fn begin(&mut self, _dt_s: f64) {
        match self.never {}
    }

    pub fn take(&mut self, _output: usize, _reading: f64) {
        match self.never {}
    }

    pub fn clear(&mut self) {
        match self.never {}
    }

    pub fn relax(&mut self, _state: usize, _factor: f64, _rest: f64) {
        match self.never {}
    }

    pub fn inflate(&mut self, _state: usize, _variance: f64) {
        match self.never {}
    }

    pub fn refine(&mut self, _x: &mut [f64], _p: &mut UdFactors) {
        match self.never {}
    }
}
