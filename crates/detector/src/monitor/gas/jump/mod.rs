//! A pressure that jumps: gas or transmitter?
//!
//! # Noticed
//! The observer's innovation of the pressure changes slowly, because its errors do. A change from one sample to the next is a jump if
//! it is beyond
//!
//! `L = 0.12 bar + 4 c + 1.2 q + W`
//!
//! and the reading itself made most of it by its second difference: what the expectation alone did is the model's. `c` is the mean
//! size of such changes lately, as it grows with the root of the interval, `q` the step in which the transmitter reads, and `W` what the
//! surroundings may have done: 2.2 times what the observer cannot have known of the gas temperature in the row before
//! ([`Observer::fresh_doubt_pa`](crate::estimator::observer::Observer::fresh_doubt_pa)) and the same part `c` of what its expectation moved by,
//! `W = 2.2 c (dp/dT (s + (1 - exp(-dt / tau)) e) + |E|)`. In a tunnel it takes more to be a jump; gas that flows there is told by the observer's
//! flowing member.
//!
//! # Examined
//! A second observer goes on from before the jump without the pressure, and `e(t)`, what it expects less what is read, less the same
//! before the jump, shows
//!
//! * back to nothing within a few samples, or in three of the last five: spikes;
//! * growing over several samples: gas flows;
//! * a step that stays: the transmitter's offset has jumped, which no thermal process does;
//! * a step of which a part comes back within half an hour: gas was let out (or in) at once, and the rest, cooled (or warmed) on
//!   the way, comes to the temperature of the wall. At 200 bar an isentropic step of the pressure is 1.6 times the isothermal one;
//!   what is left of it at the first sample is at least the tenth part that divides the two.
//!
//! The shadow is good as long as wall and gas go on as before. When the surroundings begin to move, what has been seen until then is
//! judged, if it is six samples and tells gas from transmitter, and no gas flows but a puff; else it goes on.
//!
//! No transmitter's offset jumps by more than a tenth of the largest filling: beyond that it is gas. The part that comes back is known
//! no better than the model wanders while wall and gas move: `0.04 bar + 0.05 bar/K` of the change of the gas temperature and
//! the `W` of the jump. Where that is half of the jump, nothing has passed:
//! what has jumped and not jumped back is gas or an offset. What lies within it of the division remains unclear when gas may be gone.
//! What is left within twice the `W` of the jump may be the surroundings' doing: it counts for nothing, and gas that went shows in the masses.
//! Of a gain so small that no filling stops there the transmitter is the safe assumption: it leaves the mass as low as it was.
//!
//! All pressures are stated for a fill of 200 bar; for another one they are the same parts of it.
//!
//! Assumes that a jump of gas is over within two hours; a longer one is a flow.
mod examination;
mod notice;

pub use examination::{Cause, Examination};
pub use notice::{Innovated, JumpWatch};
