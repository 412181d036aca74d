//! Rows that happen to the cylinder: each case has its own truth, drawn from its seed.
use cylwatch_estimator::observer::Commissioning;
use cylwatch_estimator::thermal::vessel::presets;
use cylwatch_evaluation::fault::{Case, CaseLeak, EPOCH_S, Missed, Subject, TableRow};
use cylwatch_evaluation::truth::disturbance::{Disturbance, Surrounding};
use cylwatch_evaluation::truth::{Course, Happenings, Process, Truth, draw_cylinder, simulate_through};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::Failure;
use crate::base::{BAR_PA, Campaign, DAY_S, HOUR_S, Histories, LEAKS_BAR_H, SAMPLE_S, leak, record};

const LEARNING_D: f64 = 6.0;
/// End of the record, d.
const END_D: [f64; 4] = [13.0, 14.5, 10.0, 8.5];
/// Where the pressure of a full bottle is left after a full discharge, Pa.
const EMPTY_PA: f64 = 20.0 * BAR_PA;

/// Loss from which a leak has begun, kg.
const BEGUN_KG: f64 = 0.005;
/// Time before and after a discharge between which gas has gone, s.
const WITHIN_S: f64 = 600.0;

/// What is drawn for one case. Times in s from the beginning.
#[derive(Default)]
struct Drawn {
    happenings: Happenings,
    exchanges: Vec<(f64, bool)>,
    /// The leak that must be found, where the row has its own.
    leak: Option<CaseLeak>,
    /// Seed of another bottle that takes the place, and when.
    exchanged: Option<(u64, f64)>,
    what: String,
}

/// Run a row; `None` where it has its own leak and this one is not it, or nothing happens.
pub fn run(
    campaign: &Campaign,
    row: TableRow,
    seed: u64,
    leak_index: usize,
    what: &mut String,
) -> Result<Option<Vec<Missed>>, Failure> {
    let own = matches!(row, TableRow::G4 | TableRow::G5);
    if own && leak_index > 0 {
        return Ok(None);
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(100 + row as u64);
    let at_s = (LEARNING_D + 0.25 + 0.75 * random.random::<f64>()) * DAY_S;
    let mut drawn = draw(campaign, row, at_s, seed, leak_index, &mut random)?;
    drawn.what.clone_into(what);
    let rate_pa_s = LEAKS_BAR_H[leak_index] * BAR_PA / HOUR_S;
    if rate_pa_s > 0.0 {
        // After an exchange of gas, whose episode is new; else beside what happens.
        let after_s = if drawn.exchanges.is_empty() { 0.0 } else { 4.0 * HOUR_S };
        let onset_s = at_s + after_s + 0.25 * DAY_S * random.random::<f64>();
        drawn.leak = Some(CaseLeak { rate_pa_s, onset_s });
        drawn.happenings.processes.extend(leak(drawn.leak));
    }
    let days = if own { END_D[0] } else { END_D[leak_index] };
    let truth = truth(campaign, row, seed, leak_index, days, &drawn)?;
    if row == TableRow::G5 {
        // Where it never becomes warmer nothing is let out: no case.
        let Some(onset_s) = begun_s(&truth) else { return Ok(None) };
        drawn.leak = drawn.leak.map(|leak| CaseLeak { onset_s, ..leak });
    }
    if row == TableRow::G2 && !loses(&truth, at_s) {
        // So cold that its pressure was below the end of the discharge: no case.
        return Ok(None);
    }
    let case = Case {
        row,
        fault: None,
        onset_s: EPOCH_S + at_s,
        leak: drawn.leak.map(|leak| CaseLeak { onset_s: leak.onset_s + EPOCH_S, ..leak }),
        exchanges: drawn.exchanges.iter().map(|(at_s, out)| (EPOCH_S + at_s, *out)).collect(),
        from_s: EPOCH_S + LEARNING_D * DAY_S,
        until_s: EPOCH_S + days * DAY_S,
    };
    let fill_pa = drawn.happenings.fill_pa.unwrap_or(200.0 * BAR_PA);
    let commissioning = Commissioning { settled: false, ..Commissioning::filled(fill_pa, 288.15) };
    let subject = Subject { commissioning, ..campaign.subject.clone() };
    let history = subject.run(None, &record(&truth)?.without("ambient"))?;
    Ok(Some(crate::missed(&case, &Histories { history, unbroken: None })))
}

/// Whether gas is lost about a time, s.
fn loses(truth: &Truth, at_s: f64) -> bool {
    let mass_kg = |time_s: f64| {
        truth.mass_kg[truth.time_s.partition_point(|at_s| *at_s < time_s).min(truth.mass_kg.len() - 1)]
    };
    mass_kg(at_s - WITHIN_S) - mass_kg(at_s + WITHIN_S) > BEGUN_KG
}

/// When gas began to be lost, s.
fn begun_s(truth: &Truth) -> Option<f64> {
    let first_kg = *truth.mass_kg.first()?;
    let begun = truth.mass_kg.iter().position(|mass_kg| first_kg - mass_kg > BEGUN_KG)?;
    Some(truth.time_s[begun])
}

fn truth(
    campaign: &Campaign,
    row: TableRow,
    seed: u64,
    leak_index: usize,
    days: f64,
    drawn: &Drawn,
) -> Result<Truth, Failure> {
    let name = format!("{}-{leak_index}", row.name());
    let Some((other, at_s)) = drawn.exchanged else {
        return campaign.truth(&name, days, seed, &drawn.happenings);
    };
    // The new bottle is another one, full, in the weather that it comes into only by its own seed: it has been standing outside.
    let before = Happenings { processes: Vec::new(), ..drawn.happenings.clone() };
    let after = Happenings { fill_pa: None, ..drawn.happenings.clone() };
    let old = campaign.truth(&format!("{name}-old"), days, seed, &before)?;
    let new = campaign.truth(&format!("{name}-new"), days, other, &after)?;
    Ok(old.exchanged(&new, at_s, 1800.0))
}

fn draw(
    campaign: &Campaign,
    row: TableRow,
    at_s: f64,
    seed: u64,
    leak_index: usize,
    random: &mut ChaCha8Rng,
) -> Result<Drawn, Failure> {
    Ok(match row {
        TableRow::G1 => refill(at_s, seed, random),
        TableRow::G2 => discharge(at_s, leak_index, random),
        TableRow::G3 => puffs(at_s, random),
        TableRow::G4 => own_leak(at_s, random),
        TableRow::G5 => masked(campaign, at_s, seed)?,
        _ => surroundings(row, at_s, random),
    })
}

fn refill(at_s: f64, seed: u64, random: &mut ChaCha8Rng) -> Drawn {
    let low_pa = 160.0 * BAR_PA;
    let lasting_s = match random.random_range(0..3) {
        0 => 120.0 + 180.0 * random.random::<f64>(),
        1 => 1800.0 + 3600.0 * random.random::<f64>(),
        _ => {
            return Drawn {
                happenings: Happenings { fill_pa: Some(low_pa), ..Happenings::default() },
                exchanges: vec![(at_s + 1800.0, false)],
                exchanged: Some((seed + 100_000, at_s)),
                what: "another bottle".into(),
                ..Drawn::default()
            };
        }
    };
    let refill = Process::Refill { start_s: at_s, lasting_s, rise_pa: 40.0 * BAR_PA, source_k: 288.15 };
    Drawn {
        happenings: Happenings { fill_pa: Some(low_pa), processes: vec![refill], ..Happenings::default() },
        exchanges: vec![(at_s, false)],
        what: format!("refill in {lasting_s:.0} s"),
        ..Drawn::default()
    }
}

fn discharge(at_s: f64, leak_index: usize, random: &mut ChaCha8Rng) -> Drawn {
    // A bottle that is empty leaks no more.
    let full = leak_index == 0 && random.random();
    let until_pa = if full { EMPTY_PA } else { (150.0 + 35.0 * random.random::<f64>()) * BAR_PA };
    let diameter_m = if full { 0.006 } else { 0.0025 };
    let discharge = Process::Discharge { start_s: at_s, lasting_s: 60.0, diameter_m, until_pa };
    Drawn {
        happenings: Happenings { processes: vec![discharge], ..Happenings::default() },
        exchanges: vec![(at_s, true)],
        what: format!("discharge to {:.0} bar", until_pa / BAR_PA),
        ..Drawn::default()
    }
}

fn puffs(at_s: f64, random: &mut ChaCha8Rng) -> Drawn {
    let drop_pa = (0.5 + 1.5 * random.random::<f64>()) * BAR_PA;
    let every_s = 8.0 * HOUR_S;
    let puffs = Process::Puffs { start_s: at_s, every_s, count: 3, drop_pa };
    Drawn {
        happenings: Happenings { processes: vec![puffs], ..Happenings::default() },
        exchanges: (0..3).map(|k| (at_s + f64::from(k) * every_s, true)).collect(),
        what: format!("puffs of {:.2} bar", drop_pa / BAR_PA),
        ..Drawn::default()
    }
}

/// Leaks that change; the rate of the case is the one from which the delay counts.
fn own_leak(at_s: f64, random: &mut ChaCha8Rng) -> Drawn {
    let rate = |bar_h: f64| bar_h * BAR_PA / HOUR_S;
    let (process, leak, what) = match random.random_range(0..3) {
        0 => {
            // From 0.01 bar/h it is at 0.08 bar/h after three days.
            let process = Process::GrowingLeak {
                start_s: at_s,
                stop_s: 1e9_f64.min(END_D[0] * DAY_S),
                rate_pa_s: rate(0.01),
                doubling_s: DAY_S,
                largest_pa_s: rate(1.0),
            };
            (process, CaseLeak { rate_pa_s: rate(0.01), onset_s: at_s }, "growing")
        }
        1 => {
            let process = Process::ColdLeak {
                start_s: at_s,
                stop_s: END_D[0] * DAY_S,
                rate_pa_s: rate(0.2),
                below_k: 273.15 + 3.0,
            };
            // Open between a quarter of the time and always.
            (process, CaseLeak { rate_pa_s: rate(0.02), onset_s: at_s }, "only while cold")
        }
        _ => {
            let stop_s = at_s + DAY_S;
            let process = Process::Leak { start_s: at_s, stop_s, rate_pa_s: rate(0.2) };
            (process, CaseLeak { rate_pa_s: rate(0.2), onset_s: at_s }, "stopping after a day")
        }
    };
    Drawn {
        happenings: Happenings { processes: vec![process], ..Happenings::default() },
        leak: Some(leak),
        what: what.into(),
        ..Drawn::default()
    }
}

/// Warming by 20 K within ten hours, and the leak that hides it.
fn masked(campaign: &Campaign, at_s: f64, seed: u64) -> Result<Drawn, Failure> {
    let warming = Disturbance {
        start_s: at_s,
        lasting_s: 30.0 * HOUR_S,
        kind: Surrounding::Air { by_k: 20.0, within_s: 10.0 * HOUR_S },
    };
    let mut happenings = Happenings { disturbances: vec![warming], ..Happenings::default() };
    let course = Course::RailwayWeeks { days: (at_s / DAY_S + 1.0).ceil() };
    let vessel = draw_cylinder(&presets::load(&campaign.truth.vessel)?, &campaign.truth, seed)?.vessel;
    for _ in 0..2 {
        let (_, warm) = simulate_through(&course, seed, SAMPLE_S, &campaign.truth, &happenings)?;
        let leak = Process::masked(&vessel, &warm, (at_s + HOUR_S, at_s + 10.0 * HOUR_S), 600.0)?;
        happenings.processes = vec![leak];
    }
    // Some 20 bar in 9 h, most of it in the warmest of them; as soon as it must be found with 1 bar/h.
    let leak = CaseLeak { rate_pa_s: BAR_PA / HOUR_S, onset_s: at_s + HOUR_S };
    Ok(Drawn { happenings, leak: Some(leak), what: "masked by warming".into(), ..Drawn::default() })
}

fn surroundings(row: TableRow, at_s: f64, random: &mut ChaCha8Rng) -> Drawn {
    let mut of = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let (lasting_s, kind) = match row {
        TableRow::E1 => {
            let air_k = 273.15 + of(32.0, 42.0);
            (12.0 * HOUR_S, Surrounding::Tunnels { air_k, stay_s: of(1200.0, 2100.0), every_s: HOUR_S })
        }
        TableRow::E2 => (18.0 * HOUR_S, Surrounding::Air { by_k: -20.0, within_s: 8.0 * HOUR_S }),
        // More than the sun gives to a clean bottle: it makes the shoulder some 15 K warmer.
        TableRow::E3 => (2.0 * HOUR_S, Surrounding::Sun { irradiance_w_m2: 2500.0, film_w_m2_k: 5.0 }),
        TableRow::E4 => (of(2.0, 5.0) * HOUR_S, Surrounding::Wet { by_k: -10.0, melting_s: HOUR_S }),
        TableRow::E5 => match of(0.0, 3.0) as usize {
            0 => (of(6.0, 24.0) * HOUR_S, Surrounding::Heater { difference_k: of(-20.0, 20.0) }),
            1 => (of(6.0, 24.0) * HOUR_S, Surrounding::Hall { air_k: 293.15 }),
            _ => (of(6.0, 24.0) * HOUR_S, Surrounding::Cycling { by_k: 5.0, period_s: 900.0 }),
        },
        _ => {
            let period_s = of(1.0, 3.0) * HOUR_S;
            let kind = Surrounding::Speed { standing_w_m2_k: 5.0, fast_w_m2_k: 50.0, period_s };
            (24.0 * HOUR_S, kind)
        }
    };
    let disturbance = Disturbance { start_s: at_s, lasting_s, kind };
    Drawn {
        what: format!("{kind:?} for {:.1} h", lasting_s / HOUR_S),
        happenings: Happenings { disturbances: vec![disturbance], ..Happenings::default() },
        ..Drawn::default()
    }
}
