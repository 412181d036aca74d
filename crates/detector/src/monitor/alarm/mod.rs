//! Alarms in the words of OPC UA Part 9: what an operator sees, and what stays until somebody has seen it.
//!
//! A verdict is what the monitor thinks now; an alarm is what must be dealt with. [`Alarm`] holds the rules of one alarm, [`Condition`]
//! its state, and every change goes through a pure function: state, time and signal in, state and [`Transition`]s out.
//!
//! * **ActiveState**: the signal has been there for the OnDelay; it ends when it has been away for the OffDelay. An
//!   [`ExclusiveLimit`] has the sub-states Low and LowLow, each with a limit and a deadband: left only above limit and deadband.
//! * **AckedState, ConfirmedState**: false from an activation (a re-alarm, a worse limit) until [`Condition::acknowledge`], and from there
//!   until [`Condition::confirm`].
//! * **LatchedState**: stays after the return to normal until [`Condition::reset`], which needs it acknowledged and confirmed.
//! * **Retain**: worth showing: active, or something is left to be done. **EnabledState**: a disabled one is neither.
//! * **ReAlarmTime**: an alarm that is still active then is raised again, unacknowledged; ReAlarmRepeatCount counts.
//!
//! Assumptions that the standard leaves open: an interval between samples counts for a delay with at most
//! [`Timing::longest_step_s`], so that a gap without samples serves no delay and sparse samples serve it in the end.
//! A signal that is unknown leaves the state as it is: it holds an on-delay and begins an off-delay anew, so that
//! not to know never helps to clear an alarm. A clock that is set back adds nothing.
//!
//! [`AlarmPanel`] holds the six alarms of a cylinder.
//!
//! Source: OPC 10000-9 (1.05), 4.8, 5.7, 5.8.2 (names), 5.8.5 (reset), 5.8.19 (exclusive limits), B.1 (examples).
mod condition;
mod delay;
mod operator;
mod panel;
mod rules;
mod settings;
#[cfg(test)]
mod tests;

pub use condition::{Change, Condition, LimitState, Transition};
pub use delay::Delayed;
pub use panel::{AlarmEvent, AlarmInputs, AlarmName, AlarmPanel};
pub use rules::{Alarm, ExclusiveLimit, Limit, OffNormal, Timing, Trigger};
pub use settings::AlarmSettings;
