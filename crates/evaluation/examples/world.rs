//! Writes one world: its log with what really happened beside it, its vessel's file and its sensors' file.
//!
//! `cargo run --release -p cylwatch-evaluation --example world -- FAMILY SEED HOURS FOLDER [OVERLAY]`, e.g.
//!
//! ```text
//! ... --example world -- nitrogen-20l/switching/mixed/class-b/120s 1 168 /tmp/w
//! ... --example world -- argon-50l/railway/mixed/class-b/60s 1 120 /tmp/w '{"overlay": "leak", "part_per_h": 1e-4, "onset_s": 86400}'
//! cylwatch monitor /tmp/w/vessel.toml /tmp/w/log.csv --sensors /tmp/w/sensors.toml --fill-pressure-bar ... --fill-temperature-degc 15
//! ```
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use cylwatch_evaluation::thermal::vessel::Fill;
use cylwatch_evaluation::world::{Family, Overlay, Request, World, generate};

const USAGE: &str = "FAMILY SEED HOURS FOLDER [OVERLAY as JSON]";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (family, seed, hours, folder, overlay) = match &arguments[..] {
        [family, seed, hours, folder] => (family, seed, hours, folder, None),
        [family, seed, hours, folder, overlay] => (family, seed, hours, folder, Some(overlay)),
        _ => return Err(USAGE.into()),
    };
    let family: Family = family.parse()?;
    let overlay: Overlay = overlay.map(|text| serde_json::from_str(text)).transpose()?.unwrap_or_default();
    let request = Request::tight(family, seed.parse()?, 3600.0 * hours.parse::<f64>()?).with(overlay);
    let begun = Instant::now();
    let world = generate(&request)?;
    let took_s = begun.elapsed().as_secs_f64();
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join("log.csv"), log(&world)?)?;
    std::fs::write(folder.join("vessel.toml"), world.request.family.vessel.text())?;
    std::fs::write(folder.join("sensors.toml"), world.operator_data.sensors_spec.to_toml()?)?;
    say(&world, took_s);
    Ok(())
}

/// The log as a user has it, then what really happened.
fn log(world: &World) -> Result<String, std::fmt::Error> {
    let degc = |kelvin: f64| kelvin - 273.15;
    let mut text = format!("# {}, seed {}\n", world.request.family, world.request.seed);
    text += "time_s,shoulder_degc,valve_degc,pressure_bar,\
             true_time_s,true_gas_k,true_mass_kg,true_pressure_pa,true_settled_pa,true_outflow_kg_s,true_air_k,true_regime\n";
    let truth = &world.truth;
    for (row, (stamp_s, readings)) in world.log.rows().enumerate() {
        write!(text, "{stamp_s:.3}")?;
        for (reading, channel) in readings.iter().zip(&world.log.channels) {
            match channel.name.as_str() {
                _ if reading.is_nan() => write!(text, ",")?,
                "pressure" => write!(text, ",{:.5}", reading / 1e5)?,
                _ => write!(text, ",{:.3}", degc(*reading))?,
            }
        }
        writeln!(
            text,
            ",{:.3},{:.4},{:.7},{:.1},{:.1},{:.4e},{:.4},{:?}",
            truth.time_s[row],
            truth.gas_mean_k[row],
            truth.mass_kg[row],
            truth.pressure_pa[row],
            truth.settled_pa[row],
            truth.outflow_kg_s[row],
            truth.air_k[row],
            truth.regime[row],
        )?;
    }
    Ok(text)
}

/// What is not in the files, on standard error.
#[allow(clippy::print_stderr, reason = "an example that is run by hand")]
fn say(world: &World, took_s: f64) {
    let Fill::Settled { pressure_pa, temperature_k } = world.operator_data.commissioning.fill else { return };
    eprintln!("{} rows in {took_s:.2} s", world.log.time_s.len());
    eprintln!(
        "--fill-pressure-bar {:.3} --fill-temperature-degc {}",
        pressure_pa / 1e5,
        temperature_k - 273.15
    );
    eprintln!("settled at the start: {}", world.operator_data.commissioning.settled);
    for event in &world.events {
        eprintln!("{event:?}");
    }
    eprintln!("{:#?}", world.drawn);
}
