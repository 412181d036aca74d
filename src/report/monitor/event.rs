//! Events: in words for people, and as lines of JSON for programs.
use super::short;
use crate::detector::monitor::{Event, EventKind, Health, Interval, LeakFinding, Verdict};
use crate::estimator::log::Quantity;
use crate::report::Clock;
use crate::report::estimate::duration;
use crate::report::{BAR_PER_HOUR, GRAM, GRAM_PER_HOUR};
use crate::thermal::units::BAR_PA;
use serde_json::{Value, json};

/// What events call times and sensors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Naming {
    /// Times.
    pub clock: Clock,
    /// Names and quantities of the sensors, in the order of the readings.
    pub sensors: Vec<(String, Quantity)>,
}

impl Naming {
    fn sensor(&self, index: usize) -> &str {
        self.sensors.get(index).map_or("sensor", |(name, _)| name.as_str())
    }

    fn quantity(&self, index: usize) -> Quantity {
        self.sensors.get(index).map_or(Quantity::Temperature, |&(_, quantity)| quantity)
    }
}

/// An event in words.
pub(crate) fn event_text(event: &Event, naming: &Naming) -> String {
    format!("{}: {}", naming.clock.text(event.time_s), event_kind_text(event, naming))
}

fn event_kind_text(event: &Event, naming: &Naming) -> String {
    let since = || naming.clock.text(event.onset_s);
    match &event.kind {
        EventKind::Verdict { from, to } => format!("verdict {to}, before {from}"),
        EventKind::LeakFound(leak) => format!(
            "leak found: {} g/h, since {}",
            range(leak.rate_kg_s.scaled(GRAM_PER_HOUR)),
            naming.clock.text(leak.onset_s.value)
        ),
        EventKind::LeakEnded => "the leak has ended, or there was none".to_owned(),
        EventKind::Discharge(mass_kg) => format!("discharge of {} g at {}", short(mass_kg * GRAM), since()),
        EventKind::Refill(mass_kg) => format!("refill of {} g at {}", short(mass_kg * GRAM), since()),
        EventKind::Sensor { sensor, health } => {
            format!("{} {}", naming.sensor(*sensor), health_text(*health, naming.quantity(*sensor)))
        }
        EventKind::ColdNight(pressure_pa) => format!(
            "the coldest night will bring the pressure to {:.1} bar without any leak: refill before it",
            pressure_pa / BAR_PA
        ),
        EventKind::FillingDoubted { mass_kg, filled_kg } => format!(
            "the readings correspond to {} of gas, the stated filling to {}: check the units of the log and the filling",
            mass_text(*mass_kg),
            mass_text(*filled_kg)
        ),
        EventKind::Swapped([first, second]) => format!(
            "{} and {} are swapped; corrected from now on: learning again",
            naming.sensor(*first),
            naming.sensor(*second)
        ),
        EventKind::Late { sensor, by_s } => format!(
            "{} is late by {:.0} s; corrected from now on: learning again",
            naming.sensor(*sensor),
            by_s
        ),
        EventKind::Disturbed { sensors: [first, second], off_k } => format!(
            "{} less {} is off its usual difference by {:+.1} K: one end is warmed or cooled locally, or one of them has shifted; \
             small leaks are not detected meanwhile",
            naming.sensor(*first),
            naming.sensor(*second),
            off_k
        ),
        EventKind::ClockJump(jump_s) => {
            let way = if *jump_s < 0.0 { "back" } else { "forward" };
            format!("the clock jumped {way} by {}", duration(jump_s.abs()))
        }
        EventKind::Gap(gap_s) => format!("no rows for {}", duration(*gap_s)),
        EventKind::TooLate => format!("a row of {} came too late and was left out", since()),
        EventKind::Restarted => "the estimate restarted from its prior".to_owned(),
    }
}

/// A mass in kilograms or, a small one, in grams.
fn mass_text(mass_kg: f64) -> String {
    if mass_kg < 1.0 { format!("{} g", short(mass_kg * GRAM)) } else { format!("{} kg", short(mass_kg)) }
}

/// How a sensor is doing, in words.
pub(crate) fn health_text(health: Health, quantity: Quantity) -> String {
    match health {
        Health::Good => "good".to_owned(),
        Health::Missing => "gives no readings".to_owned(),
        Health::Implausible => "gives readings outside its range: check its wire".to_owned(),
        Health::Stuck => "stands still".to_owned(),
        Health::Spikes => "has single readings far off".to_owned(),
        Health::Shifted(by) => {
            let (by, unit) = match quantity {
                Quantity::Temperature => (by, "K"),
                Quantity::Pressure => (by / BAR_PA, "bar"),
            };
            format!("is shifted by {} {unit}; corrected", short(by))
        }
        Health::Deviates(by) => {
            format!(
                "is off by {} K, according to the other thermometer and the pressure: warmed locally or shifted",
                short(by)
            )
        }
        Health::Detached => "follows the air: it is off its surface".to_owned(),
    }
}

/// A value with its interval.
pub(super) fn range(interval: Interval) -> String {
    format!("{} ({} to {})", short(interval.value), short(interval.low), short(interval.high))
}

/// An event as one line of JSON, without its end.
pub(crate) fn event_line(event: &Event, naming: &Naming) -> String {
    let mut line = json!({
        "id": event.id().to_string(),
        "event": event.kind.name(),
        "time_s": naming.clock.of_log_s(event.time_s),
        "time": naming.clock.date(event.time_s),
        "onset_s": naming.clock.of_log_s(event.onset_s),
        "onset": naming.clock.date(event.onset_s),
    });
    if let (Value::Object(line), Value::Object(details)) = (&mut line, details(&event.kind, naming)) {
        line.extend(details);
    }
    line.to_string()
}

fn details(kind: &EventKind, naming: &Naming) -> Value {
    match kind {
        EventKind::Verdict { from, to } => json!({ "from": verdict(*from), "to": verdict(*to) }),
        EventKind::LeakFound(leak) => finding(leak, &naming.clock),
        EventKind::Discharge(mass_kg) | EventKind::Refill(mass_kg) => json!({ "mass_g": mass_kg * GRAM }),
        EventKind::Sensor { sensor, health } => json!({
            "sensor": naming.sensor(*sensor),
            "health": health_word(*health),
            "shift": shift(*health, naming.quantity(*sensor)),
        }),
        EventKind::ColdNight(pressure_pa) => json!({ "pressure_bar": pressure_pa / BAR_PA }),
        EventKind::FillingDoubted { mass_kg, filled_kg } => {
            json!({ "mass_kg": mass_kg, "filled_kg": filled_kg })
        }
        EventKind::Swapped(sensors) => json!({ "sensors": sensors.map(|sensor| naming.sensor(sensor)) }),
        EventKind::Late { sensor, by_s } => json!({ "sensor": naming.sensor(*sensor), "by_s": by_s }),
        EventKind::Disturbed { sensors, off_k } => {
            json!({ "sensors": sensors.map(|sensor| naming.sensor(sensor)), "off_k": off_k })
        }
        EventKind::ClockJump(jump_s) => json!({ "jump_s": jump_s }),
        EventKind::Gap(gap_s) => json!({ "gap_s": gap_s }),
        EventKind::LeakEnded | EventKind::TooLate | EventKind::Restarted => json!({}),
    }
}

/// A verdict as an object.
pub(super) fn verdict(verdict: Verdict) -> Value {
    json!({ "verdict": verdict.as_str(), "reason": verdict.reason().map(|reason| reason.as_str()) })
}

/// A finding with its intervals, in the units of the files.
pub(super) fn finding(leak: &LeakFinding, clock: &Clock) -> Value {
    let of = |interval: Interval| json!([interval.value, interval.low, interval.high]);
    let began = leak.onset_s;
    let began_s = [began.value, began.low, began.high].map(|time_s| clock.of_log_s(time_s));
    json!({
        "rate_g_h": of(leak.rate_kg_s.scaled(GRAM_PER_HOUR)),
        "rate_bar_h": of(leak.rate_pa_s.scaled(BAR_PER_HOUR)),
        "began_s": began_s,
        "lost_g": of(leak.lost_kg.scaled(GRAM)),
    })
}

/// A health as one word.
pub(crate) fn health_word(health: Health) -> &'static str {
    match health {
        Health::Good => "good",
        Health::Missing => "missing",
        Health::Implausible => "implausible",
        Health::Stuck => "stuck",
        Health::Spikes => "spikes",
        Health::Shifted(_) => "shifted",
        Health::Deviates(_) => "deviates",
        Health::Detached => "detached",
    }
}

fn shift(health: Health, quantity: Quantity) -> Value {
    match (health, quantity) {
        (Health::Shifted(by) | Health::Deviates(by), Quantity::Temperature) => json!({ "k": by }),
        (Health::Shifted(by), Quantity::Pressure) => json!({ "bar": by / BAR_PA }),
        _ => Value::Null,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detector::monitor::Reason;
    use crate::report::monitor::row::tests::leaking;

    fn naming() -> Naming {
        let sensors =
            vec![("shoulder".to_owned(), Quantity::Temperature), ("pressure".to_owned(), Quantity::Pressure)];
        Naming { clock: Clock::new(Some("2026-01-01T00:00:00Z".parse().unwrap()), None), sensors }
    }

    fn kinds() -> Vec<EventKind> {
        vec![
            EventKind::Verdict { from: Verdict::Unknown(Reason::Learning), to: Verdict::Tight },
            EventKind::LeakFound(leaking().leak.unwrap()),
            EventKind::LeakEnded,
            EventKind::Discharge(0.12),
            EventKind::Refill(1.5),
            EventKind::Sensor { sensor: 1, health: Health::Shifted(-0.4e5) },
            EventKind::Sensor { sensor: 0, health: Health::Deviates(1.2) },
            EventKind::ColdNight(158.2e5),
            EventKind::FillingDoubted { mass_kg: 4.1, filled_kg: 4.48 },
            EventKind::Swapped([0, 1]),
            EventKind::Late { sensor: 0, by_s: 87.3 },
            EventKind::Disturbed { sensors: [0, 1], off_k: -1.24 },
            EventKind::ClockJump(-3600.0),
            EventKind::Gap(7200.0),
            EventKind::TooLate,
            EventKind::Restarted,
        ]
    }

    #[test]
    fn words_say_when_and_what_in_units_that_people_use() {
        let said: Vec<String> = kinds()
            .into_iter()
            .map(|kind| event_text(&Event::new(7200.0, 3600.0, kind), &naming()))
            .collect();
        assert!(said.iter().all(|words| words.starts_with("2026-01-01T02:00:00Z: ")), "{said:?}");
        for (words, part) in said.iter().zip([
            "verdict tight, before unknown: still learning the sensors",
            "leak found: 3.6 (2.88 to 4.68) g/h, since 2026-01-01T01:00:00Z",
            "ended, or there was none",
            "discharge of 120 g at 2026-01-01T01:00:00Z",
            "refill of 1500 g",
            "pressure is shifted by -0.4 bar",
            "shoulder is off by 1.2 K, according to the other thermometer and the pressure",
            "158.2 bar without any leak",
            "4.1 kg of gas, the stated filling to 4.48 kg",
            "shoulder and pressure are swapped",
            "shoulder is late by 87 s",
            "off its usual difference by -1.2 K",
            "jumped back by 60 min",
            "no rows for 2 h",
            "a row of 2026-01-01T01:00:00Z came too late",
            "restarted from its prior",
        ]) {
            assert!(words.contains(part), "`{part}` is missing in {words}");
        }
    }

    #[test]
    fn a_line_is_one_json_object_with_id_time_and_what_the_words_say() {
        for kind in kinds() {
            let event = Event::new(7200.0, 3600.0, kind);
            let line = event_line(&event, &naming());
            assert!(!line.contains('\n'));
            let object: Value = serde_json::from_str(&line).unwrap();
            assert_eq!(
                (object["id"].as_str(), object["time_s"].as_f64()),
                (Some(event.id().to_string().as_str()), Some(7200.0))
            );
            assert_eq!(object["onset"], "2026-01-01T01:00:00Z");
            assert_eq!(object["event"], event.kind.name());
            match event.kind {
                EventKind::LeakFound(_) => assert_eq!(object["rate_g_h"][2].as_f64().unwrap().round(), 5.0),
                EventKind::Sensor { sensor: 0, .. } => assert_eq!(object["shift"]["k"], 1.2),
                EventKind::Sensor { .. } => assert_eq!(object["shift"]["bar"], -0.4),
                EventKind::Verdict { .. } => {
                    assert_eq!(object["from"]["reason"], "still learning the sensors")
                }
                _ => {}
            }
        }
        let without = Naming::default();
        let object: Value =
            serde_json::from_str(&event_line(&Event::new(1.0, 0.0, EventKind::TooLate), &without)).unwrap();
        assert!(object["time"].is_null());
    }
}
