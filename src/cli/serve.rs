//! `cylwatch serve`: a gateway beside an MQTT broker. Rows of many cylinders in, each to a monitor of its own; verdicts, estimates, events and
//! alarms out, those of `monitor` and `fleet`.
//!
//! | file | part |
//! |---|---|
//! | `document`, `config` | the configuration, as written and checked |
//! | `mapping` | a message becomes a row of a cylinder |
//! | `journal`, `keeper`, `saver`, `recent` | rows and states on disk; what is guaranteed stands in `keeper` |
//! | `silence`, `alarms` | cylinders that send nothing, and the gateway's own alarms |
//! | `publication`, `outbox` | what is published, and what has not arrived |
//! | `link` | the broker |
//! | `gateway` | the loop |
//! | `notify` | what the service manager hears |
//! | `replay` | recorded logs, played to the broker |
//! | `status`, `board` | what the loop tells of itself, and shows of the cylinders |
//! | `http` | the page, metrics and health checks |
mod alarms;
mod board;
mod config;
mod document;
mod file;
mod gateway;
mod http;
mod journal;
mod keeper;
mod link;
mod mapping;
mod notify;
mod outbox;
mod publication;
mod recent;
mod replay;
mod saver;
mod signals;
mod silence;
mod status;

use super::message::Messages;
use crate::report::{Input, Provenance, quoted};
use crate::thermal::document::schema;
use clap::Args;
use gateway::Gateway;
use replay::{Replay, ReplayArguments};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Arguments of `serve`.
#[derive(Debug, Args)]
#[command(after_long_help = HELP)]
pub(super) struct ServeArguments {
    /// Configuration: a TOML file.
    pub config: PathBuf,
    /// Check the configuration and end.
    #[arg(long)]
    pub check: bool,
    #[command(flatten)]
    pub replay: ReplayArguments,
}

/// Runs until a signal comes, or a replay has ended.
pub(super) fn run(arguments: ServeArguments, messages: &Messages) -> anyhow::Result<()> {
    let (mut settings, broker) = config::read(&arguments.config)?;
    broker.caution().iter().for_each(|words| messages.caution(words));
    let replay = Replay::of(&arguments.replay, (&settings, &broker), messages)?;
    if arguments.check {
        messages.say(&format!("{} can be used", arguments.config.display()));
        return Ok(());
    }
    let page = settings.page.take();
    let listener = page.as_ref().map(http::bound).transpose()?;
    let (journal, origin) = (settings.folder.join("journal"), provenance(&arguments.config)?);
    let gateway = Gateway::new(arguments.config, (settings, broker), replay, messages)?;
    if let (Some(page), Some(listener)) = (page, listener) {
        messages.say(&format!("the page is at {}", page.address()));
        http::serve(listener, http::Site::new(page, gateway.status(), journal, origin))?;
    }
    gateway.run()
}

/// JSON schema of configurations.
pub(super) fn configuration_schema() -> Value {
    schema::of::<document::Document>("configuration of cylwatch serve")
}

/// JSON schema of `verdict`, `estimate`, `alarm` or `event`.
pub(super) fn published_schema(what: &str) -> Value {
    publication::schema(what)
}

/// Where the page comes from.
fn provenance(config: &Path) -> anyhow::Result<Provenance> {
    let name = config.display().to_string();
    let inputs = vec![Input::of(name.clone(), &std::fs::read(config)?)];
    Ok(Provenance { command: format!("cylwatch serve {}", quoted(&name)), inputs, seed: None })
}

const HELP: &str = "\
The configuration names the broker, the store, cylinders and their types, and where a JSON message
has its time and its readings:
  [broker]
  host = \"localhost\"              # port = 1883, protocol = \"5\" or \"3.1.1\", user, password_file or
  client_id = \"depot-7\"           # password_env, keep_alive_s = 30, session_expiry_d = 7
                                    # tls = true (port 8883), ca_file, client_certificate_file, client_key_file
  [store]
  folder = \"/var/lib/cylwatch\"    # states and journal; save_every_min = 10
  [[type]]
  name = \"rail\"
  vessel = \"nitrogen-20l\"
  options = { fill_pressure_bar = 200, fill_temperature_degc = 15, settled = true, limit_bar = 160 }
  [[cylinder]]
  name = \"A12\"
  type = \"rail\"
  topic = \"train/7/A12\"           # silent_after_min = 60
  [payload]
  time = \"/t\"                     # clock = \"rfc3339\", \"seconds\", \"milliseconds\" or \"arrival\"
  [[payload.reading]]
  name = \"pressure_bar\"
  at = \"/p\"
  [[payload.reading]]
  name = \"shoulder_degc\"
  at = \"/temperature\"

A page of all cylinders, /metrics for Prometheus and /healthz, read-only:
  [page]
  listen = \"127.0.0.1:8742\"       # elsewhere token_file or token_env, tls_certificate_file, tls_key_file

With format = \"sparkplug-b\" in [payload] a topic is GROUP/NODE/DEVICE, and a reading has
metric = \"Gas/Pressure\" in place of at.

It publishes cylwatch/NAME/verdict, estimate and alarm/ALARM, which the broker keeps, and
cylwatch/NAME/event, at quality of service 1. A comment to cylwatch/NAME/acknowledge acknowledges
the alarms. Rows that were accepted and events survive a kill; see book/src/serve.md.

Ctrl-C and SIGTERM save all states and end with exit code 0; 2 the configuration is wrong. SIGHUP
reads the configuration again: it is taken over whole or refused whole.

Examples:
  cylwatch serve gateway.toml --check
  cylwatch serve gateway.toml
  cylwatch serve gateway.toml --replay logs --speed 1000 --stay";
