//! Logs that begin where nobody chose: at the mouth of a tunnel, with walls and gas tens of kelvins from what the thermometers read.
use cylwatch_detector::monitor::{EventKind, Monitor, MonitorSettings};
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::thermal::vessel::Fill;
use cylwatch_evaluation::world::{Request, World, generate};
use cylwatch_thermal::units::HOUR_S;

/// Rows from the mouth of a tunnel that a log begins with, and rows of it.
const LATER: usize = 7;
const ROWS: usize = 240;

/// Indices of rows at most so many after the air became 15 K warmer within three rows, five hours or more apart.
fn mouths(world: &World) -> Vec<usize> {
    let air_k = &world.truth.air_k;
    let mut found: Vec<usize> = Vec::new();
    for row in 60..air_k.len() - ROWS {
        if air_k[row] - air_k[row - 3] > 15.0 && found.last().is_none_or(|last| row > last + 300) {
            found.push(row + 2 * found.len() % LATER);
        }
    }
    found
}

/// What the monitor says of the exchange of gas in rows of a world from one on, of which only the readings are known.
fn exchanges(world: &World, from: usize) -> Vec<EventKind> {
    let readings = |row: usize| world.log.row(row);
    let first = readings(from);
    let [pressure_pa, first_k] = [first[2], 0.5 * (first[0] + first[1])];
    let filled = Commissioning {
        fill: Fill::Pressure { pressure_pa },
        mass_sd: (Commissioning::UNSETTLED_SD_K / first_k).hypot(0.01),
        settled: false,
    };
    let mut settings = MonitorSettings::default();
    settings.observer.air.prior_sd = Commissioning::UNSETTLED_AIR_SD_K;
    let known = &world.operator_data;
    let mut monitor = Monitor::new(&known.vessel, &known.sensors, &filled, &settings).unwrap();
    let rows = (from..from + ROWS).map(|row| (world.log.time_s[row], readings(row)));
    let outputs = rows.flat_map(|(time_s, row)| monitor.step(time_s, row).unwrap());
    let events = outputs.flat_map(|output| output.events.into_iter().map(|event| event.kind));
    events
        .filter(|kind| {
            matches!(kind, EventKind::Refill(_) | EventKind::Discharge(_) | EventKind::LeakFound(_))
        })
        .collect()
}

#[test]
fn a_log_that_begins_in_a_tunnel_shows_no_exchange_of_gas() {
    let mut begun = 0;
    for vessel in ["nitrogen-20l", "argon-50l", "hydrogen-50l", "air-tank-8l"] {
        for climate in ["railway", "switching"] {
            let family = format!("{vessel}/{climate}/mixed/class-b/60s").parse().unwrap();
            let world = generate(&Request::tight(family, 77, 48.0 * HOUR_S)).unwrap();
            for from in mouths(&world) {
                let said = exchanges(&world, from);
                assert!(said.is_empty(), "{vessel}, {climate}, from row {from}: {said:?}");
                begun += 1;
            }
        }
    }
    println!("{begun} logs");
    assert!(begun >= 20, "{begun}");
}
