//! The observer's way through the log: row by row, or smoothed, which hands rows out later.
use crate::estimator::observer::{Estimate, Innovation, Observer, Smoother};
use crate::log::{Row, Truth};
use anyhow::Context;
use std::collections::VecDeque;

/// A pass of an observer.
pub(super) enum Pass {
    /// Every row at once.
    Forward(Box<Observer>),
    /// A smoother, and what goes with the rows that it holds back.
    Smoothed(Box<Smoother>, VecDeque<(Truth, Vec<Innovation>)>),
}

impl Pass {
    /// A pass of an observer that has not begun.
    pub(super) fn new(observer: Observer, smooth: bool) -> anyhow::Result<Self> {
        Ok(if smooth {
            Self::Smoothed(Box::new(Smoother::new(observer)?), VecDeque::new())
        } else {
            Self::Forward(Box::new(observer))
        })
    }

    /// Takes in a row and hands out the estimates that are final, in the order of their rows, each with the truth and
    /// the innovations of its row.
    pub(super) fn push(
        &mut self,
        row: &Row,
        readings: &[f64],
        mut take: impl FnMut(Estimate, &Truth, &[Innovation]) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        match self {
            Self::Forward(observer) => {
                let estimate = observer.step(row.time_s, readings)?;
                take(estimate, &row.truth, observer.innovations())
            }
            Self::Smoothed(smoother, waiting) => {
                let ready = smoother.push(row.time_s, readings)?;
                waiting.push_back((row.truth, smoother.observer().innovations().to_vec()));
                hand_out(ready, waiting, take)
            }
        }
    }

    /// Hands out what is left, and the observer as it is after the last row.
    pub(super) fn finish(
        self,
        take: impl FnMut(Estimate, &Truth, &[Innovation]) -> anyhow::Result<()>,
    ) -> anyhow::Result<Observer> {
        match self {
            Self::Forward(observer) => Ok(*observer),
            Self::Smoothed(smoother, mut waiting) => {
                let (observer, rest) = smoother.into_parts();
                hand_out(rest, &mut waiting, take)?;
                Ok(observer)
            }
        }
    }
}

fn hand_out(
    ready: Vec<Estimate>,
    waiting: &mut VecDeque<(Truth, Vec<Innovation>)>,
    mut take: impl FnMut(Estimate, &Truth, &[Innovation]) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    for estimate in ready {
        let (truth, innovations) = waiting.pop_front().context("a smoother hands out every row once")?;
        take(estimate, &truth, &innovations)?;
    }
    Ok(())
}
