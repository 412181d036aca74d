//! From the monitor's words to plain structs.
use crate::code::Text;
use crate::event::*;
use crate::output::*;
use core::ffi::c_char;
use core::fmt;
use cylwatch_detector::estimator::observer::Quality;
use cylwatch_detector::monitor::alarm::{AlarmEvent, AlarmName, Change, LimitState};
use cylwatch_detector::monitor::{
    Event, EventKind, Health, Interval, LeakFinding, Outcome, Outlook, Output, Reason, Verdict,
};
use cylwatch_detector::prognosis::{Passage, Quantiles, Reaction};

const UNKNOWN: cw_interval = cw_interval { value: f64::NAN, low: f64::NAN, high: f64::NAN };
const NO_TIME: cw_time_left =
    cw_time_left { p5_s: f64::NAN, p50_s: f64::NAN, p95_s: f64::NAN, horizon_s: f64::NAN };
const NO_SENSOR: cw_health = cw_health { state: cw_health_state::NoSensor, off_k_or_pa: f64::NAN };

impl From<&Output> for cw_output {
    fn from(output: &Output) -> Self {
        let Output { stamp_s, estimate, decision, leak, leak_rate_kg_s, cold_pressure_pa, .. } = output;
        let (verdict, reason) = verdict(decision.verdict);
        let found = |of: fn(&LeakFinding) -> Interval| leak.as_ref().map_or(UNKNOWN, |leak| of(leak).into());
        let left = |of: fn(&Outlook) -> Quantiles| {
            output.outlook.as_ref().map_or(NO_TIME, |outlook| of(outlook).into())
        };
        let advice = output.outlook.map(|outlook| outlook.advice);
        let mut health = [NO_SENSOR; CW_MOST_SENSORS];
        for (place, one) in health.iter_mut().zip(&output.health) {
            *place = (*one).into();
        }
        Self {
            stamp_s: *stamp_s,
            time_s: estimate.time_s,
            verdict,
            reason,
            outcome: decision.outcome.into(),
            reaction: reaction(decision.reaction),
            quality: estimate.quality.into(),
            sensor_count: output.health.len() as u32,
            event_count: output.events.len() as u32,
            alarm_count: output.alarms.len() as u32,
            leak_probability: decision.leak_probability.unwrap_or(f64::NAN),
            gas_mean_k: estimate.gas_mean_k,
            gas_mean_sd_k: estimate.gas_mean_sd_k,
            mass_kg: estimate.mass_kg,
            mass_sd_kg: estimate.mass_sd_kg,
            estimated_leak_kg_s: estimate.leak_kg_s,
            estimated_leak_sd_kg_s: estimate.leak_sd_kg_s,
            pressure_pa: estimate.pressure_pa,
            pressure_expected_pa: estimate.pressure_expected_pa,
            pressure_at_15_degc_pa: estimate.p15_pa,
            cold_pressure_pa: *cold_pressure_pa,
            leak_rate_kg_s: (*leak_rate_kg_s).into(),
            leak_found: leak.is_some(),
            leak_rate_pa_s: found(|leak| leak.rate_pa_s),
            leak_onset_s: found(|leak| leak.onset_s),
            lost_kg: found(|leak| leak.lost_kg),
            outlook_known: output.outlook.is_some(),
            outlook_of_leak: output.outlook.is_some_and(|outlook| outlook.known),
            operational_limit: left(|outlook| outlook.operational),
            cold_limit: left(|outlook| outlook.cold),
            maintenance_limit: left(|outlook| outlook.maintenance),
            advice: reaction(advice.map(|advice| advice.reaction)),
            before_safe_state_probability: advice.map_or(f64::NAN, |advice| advice.before_safe_state),
            before_next_service_probability: advice.map_or(f64::NAN, |advice| advice.before_next_service),
            before_following_service_probability: advice
                .map_or(f64::NAN, |advice| advice.before_following_service),
            health,
        }
    }
}

impl From<&Event> for cw_event {
    fn from(event: &Event) -> Self {
        let nothing = Self {
            kind: cw_event_kind::Verdict,
            sensor: -1,
            other_sensor: -1,
            verdict_from: cw_verdict::Unknown,
            reason_from: cw_reason::None,
            verdict_to: cw_verdict::Unknown,
            reason_to: cw_reason::None,
            health: NO_SENSOR,
            time_s: event.time_s,
            onset_s: event.onset_s,
            leak_rate_kg_s: UNKNOWN,
            mass_kg: f64::NAN,
            filled_kg: f64::NAN,
            pressure_pa: f64::NAN,
            duration_s: f64::NAN,
            difference_k: f64::NAN,
            id: id(event.id()),
        };
        use cw_event_kind as Kind;
        match event.kind {
            EventKind::Verdict { from, to } => {
                let ((verdict_from, reason_from), (verdict_to, reason_to)) = (verdict(from), verdict(to));
                Self { verdict_from, reason_from, verdict_to, reason_to, ..nothing }
            }
            EventKind::LeakFound(leak) => {
                Self { kind: Kind::LeakFound, leak_rate_kg_s: leak.rate_kg_s.into(), ..nothing }
            }
            EventKind::LeakEnded => Self { kind: Kind::LeakEnded, ..nothing },
            EventKind::Discharge(mass_kg) => Self { kind: Kind::Discharge, mass_kg, ..nothing },
            EventKind::Refill(mass_kg) => Self { kind: Kind::Refill, mass_kg, ..nothing },
            EventKind::Sensor { sensor, health } => {
                Self { kind: Kind::Sensor, sensor: sensor as i32, health: health.into(), ..nothing }
            }
            EventKind::ColdNight(pressure_pa) => Self { kind: Kind::ColdNight, pressure_pa, ..nothing },
            EventKind::FillingDoubted { mass_kg, filled_kg } => {
                Self { kind: Kind::FillingDoubted, mass_kg, filled_kg, ..nothing }
            }
            EventKind::Swapped([one, other]) => {
                Self { kind: Kind::Swapped, sensor: one as i32, other_sensor: other as i32, ..nothing }
            }
            EventKind::Late { sensor, by_s } => {
                Self { kind: Kind::Late, sensor: sensor as i32, duration_s: by_s, ..nothing }
            }
            EventKind::Disturbed { sensors: [one, other], off_k } => Self {
                kind: Kind::Disturbed,
                sensor: one as i32,
                other_sensor: other as i32,
                difference_k: off_k,
                ..nothing
            },
            EventKind::ClockJump(duration_s) => Self { kind: Kind::ClockJump, duration_s, ..nothing },
            EventKind::Gap(duration_s) => Self { kind: Kind::Gap, duration_s, ..nothing },
            EventKind::TooLate => Self { kind: Kind::TooLate, ..nothing },
            EventKind::Restarted => Self { kind: Kind::Restarted, ..nothing },
        }
    }
}

impl From<&AlarmEvent> for cw_alarm {
    fn from(event: &AlarmEvent) -> Self {
        let condition = &event.transition.condition;
        Self {
            name: match event.alarm {
                AlarmName::Leak => cw_alarm_name::Leak,
                AlarmName::OperationalLimit => cw_alarm_name::OperationalLimit,
                AlarmName::MaintenanceLimit => cw_alarm_name::MaintenanceLimit,
                AlarmName::SensorFault => cw_alarm_name::SensorFault,
                AlarmName::Unknown => cw_alarm_name::Unknown,
                AlarmName::ColdNight => cw_alarm_name::ColdNight,
            },
            change: match event.transition.change {
                Change::Active => cw_alarm_change::Active,
                Change::LimitChanged => cw_alarm_change::LimitChanged,
                Change::ReAlarm => cw_alarm_change::ReAlarm,
                Change::Inactive => cw_alarm_change::Inactive,
                Change::Acknowledged => cw_alarm_change::Acknowledged,
                Change::Confirmed => cw_alarm_change::Confirmed,
                Change::Reset => cw_alarm_change::Reset,
                Change::Enabled => cw_alarm_change::Enabled,
                Change::Disabled => cw_alarm_change::Disabled,
            },
            limit: match condition.limit {
                None => cw_alarm_limit::None,
                Some(LimitState::Low) => cw_alarm_limit::Low,
                Some(LimitState::LowLow) => cw_alarm_limit::LowLow,
            },
            severity: u32::from(condition.severity),
            re_alarm_repeat_count: i32::from(condition.re_alarm_repeat_count),
            active: condition.active,
            acked: condition.acked,
            confirmed: condition.confirmed,
            latched: condition.latched,
            time_s: event.transition.time_s,
            active_since_s: condition.active_since_s.unwrap_or(f64::NAN),
            id: id(event.id()),
        }
    }
}

fn id(shown: impl fmt::Display) -> [c_char; CW_ID_SIZE] {
    let mut id = [0; CW_ID_SIZE];
    let text = Text::<{ CW_ID_SIZE - 1 }>::of(&shown);
    for (place, &byte) in id.iter_mut().zip(text.as_bytes()) {
        *place = byte as c_char;
    }
    id
}

fn verdict(verdict: Verdict) -> (cw_verdict, cw_reason) {
    let reason = verdict.reason().map_or(cw_reason::None, Into::into);
    let verdict = match verdict {
        Verdict::Tight => cw_verdict::Tight,
        Verdict::Leak => cw_verdict::Leak,
        Verdict::Discharge => cw_verdict::Discharge,
        Verdict::Refill => cw_verdict::Refill,
        Verdict::SensorFault => cw_verdict::SensorFault,
        Verdict::Unknown(_) => cw_verdict::Unknown,
    };
    (verdict, reason)
}

fn reaction(reaction: Option<Reaction>) -> cw_reaction {
    match reaction {
        None => cw_reaction::Unknown,
        Some(Reaction::None) => cw_reaction::None,
        Some(Reaction::NextInterval) => cw_reaction::NextInterval,
        Some(Reaction::AsSoonAsPossible) => cw_reaction::AsSoonAsPossible,
        Some(Reaction::Shutdown) => cw_reaction::Shutdown,
    }
}

impl From<Reason> for cw_reason {
    fn from(reason: Reason) -> Self {
        match reason {
            Reason::Learning => Self::Learning,
            Reason::Filling => Self::Filling,
            Reason::NoPressure => Self::NoPressure,
            Reason::NoTemperature => Self::NoTemperature,
            Reason::Gap => Self::Gap,
            Reason::Jump => Self::Jump,
            Reason::Settling => Self::Settling,
            Reason::Disturbed => Self::Disturbed,
            Reason::Stuck => Self::Stuck,
            Reason::Clock => Self::Clock,
            Reason::Restarted => Self::Restarted,
            Reason::Suspected => Self::Suspected,
            Reason::Empty => Self::Empty,
        }
    }
}

impl From<Outcome> for cw_outcome {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::NoLoss => Self::NoLoss,
            Outcome::Loss => Self::Loss,
            Outcome::Unknown => Self::Unknown,
        }
    }
}

impl From<Quality> for cw_quality {
    fn from(quality: Quality) -> Self {
        match quality {
            Quality::Good => Self::Good,
            Quality::Degraded => Self::Degraded,
            Quality::Predicted => Self::Predicted,
            Quality::Open => Self::Open,
            Quality::Restarted => Self::Restarted,
        }
    }
}

impl From<Health> for cw_health {
    fn from(health: Health) -> Self {
        use cw_health_state as State;
        let (state, off_k_or_pa) = match health {
            Health::Good => (State::Good, f64::NAN),
            Health::Missing => (State::Missing, f64::NAN),
            Health::Implausible => (State::Implausible, f64::NAN),
            Health::Stuck => (State::Stuck, f64::NAN),
            Health::Spikes => (State::Spikes, f64::NAN),
            Health::Shifted(by) => (State::Shifted, by),
            Health::Deviates(by) => (State::Deviates, by),
            Health::Detached => (State::Detached, f64::NAN),
        };
        Self { state, off_k_or_pa }
    }
}

impl From<Interval> for cw_interval {
    fn from(Interval { value, low, high }: Interval) -> Self {
        Self { value, low, high }
    }
}

impl From<Quantiles> for cw_time_left {
    fn from(Quantiles { p5, p50, p95, horizon_s }: Quantiles) -> Self {
        let [p5_s, p50_s, p95_s] = [p5, p50, p95].map(|passage| match passage {
            Passage::Reached => 0.0,
            Passage::In(after_s) => after_s,
            Passage::BeyondHorizon => f64::INFINITY,
            Passage::Unknown => f64::NAN,
        });
        Self { p5_s, p50_s, p95_s, horizon_s }
    }
}
