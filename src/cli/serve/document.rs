//! The configuration as its file has it: tables and keys, SI values.
use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

/// The whole file.
#[derive(Deserialize, JsonSchema)]
pub(super) struct Document {
    pub broker: BrokerTable,
    pub store: StoreTable,
    #[serde(rename = "type")]
    pub types: Vec<TypeTable>,
    #[serde(default)]
    pub cylinder: Vec<CylinderTable>,
    pub pattern: Option<PatternTable>,
    pub payload: PayloadTable,
    #[serde(default)]
    pub publish: PublishTable,
    #[serde(default)]
    pub limits: LimitsTable,
    pub page: Option<PageTable>,
}

/// The broker.
#[derive(Deserialize, JsonSchema)]
pub(super) struct BrokerTable {
    pub host: String,
    /// 1883, or 8883 with TLS.
    pub port: Option<u16>,
    pub tls: Option<bool>,
    /// Certificates of authorities, PEM; those of the system if it is not given.
    pub ca_file: Option<String>,
    pub client_certificate_file: Option<String>,
    pub client_key_file: Option<String>,
    pub protocol: Option<Protocol>,
    pub client_id: String,
    pub user: Option<String>,
    /// Refused, whatever it holds.
    #[schemars(skip)]
    pub password: Option<IgnoredAny>,
    pub password_file: Option<String>,
    pub password_env: Option<String>,
    pub keep_alive_s: Option<f64>,
    pub session_expiry_s: Option<f64>,
}

/// Version of the protocol.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub(super) enum Protocol {
    #[default]
    #[serde(rename = "5")]
    V5,
    #[serde(rename = "3.1.1")]
    V311,
}

/// Where states are kept.
#[derive(Deserialize, JsonSchema)]
pub(super) struct StoreTable {
    pub folder: String,
    pub save_every_s: Option<f64>,
}

/// Cylinders that are alike.
#[derive(Deserialize, JsonSchema)]
pub(super) struct TypeTable {
    pub name: String,
    pub vessel: String,
    pub silent_after_s: Option<f64>,
    #[serde(default)]
    pub options: OptionsTable,
}

/// Options by the names that they have in `monitor`; the rest of the program checks them.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
pub(super) struct OptionsTable {
    pub fill_pressure_pa: Option<f64>,
    pub fill_temperature_k: Option<f64>,
    pub fill_mass_kg: Option<f64>,
    pub fill_sd_percent: Option<f64>,
    pub settled: Option<bool>,
    pub limit_pa: Option<f64>,
    pub coldest_k: Option<f64>,
    pub next_service_s: Option<f64>,
    pub lateness_s: Option<f64>,
    pub step_s: Option<f64>,
    pub false_alarm_years: Option<f64>,
    pub sensors: Option<String>,
    pub commissioned: Option<String>,
    pub learned_in: Option<String>,
}

/// A cylinder.
#[derive(Deserialize, JsonSchema)]
pub(super) struct CylinderTable {
    pub name: String,
    #[serde(rename = "type")]
    pub kind: String,
    pub topic: String,
    pub silent_after_s: Option<f64>,
    #[serde(default)]
    pub options: OptionsTable,
}

/// Cylinders that are not named.
#[derive(Deserialize, JsonSchema)]
pub(super) struct PatternTable {
    pub topic: String,
    #[serde(rename = "type")]
    pub kind: String,
    pub most: u32,
}

/// Where a message has its time and its readings.
#[derive(Deserialize, JsonSchema)]
pub(super) struct PayloadTable {
    pub format: Option<PayloadFormat>,
    pub time: Option<String>,
    pub clock: Option<TimeForm>,
    pub reading: Vec<ReadingTable>,
}

/// How a message is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
pub(super) enum PayloadFormat {
    #[default]
    #[serde(rename = "json")]
    Json,
    #[serde(rename = "sparkplug-b")]
    SparkplugB,
}

/// How a time is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum TimeForm {
    /// A date with a zone.
    #[default]
    Rfc3339,
    /// Seconds since 1970, UTC.
    Seconds,
    /// Milliseconds since 1970, UTC.
    Milliseconds,
    /// The time at which the message comes.
    Arrival,
}

/// A reading.
#[derive(Deserialize, JsonSchema)]
pub(super) struct ReadingTable {
    /// Name of a column of a log, with its unit.
    pub name: String,
    /// JSON pointer.
    pub at: Option<String>,
    /// Name of a metric of Sparkplug.
    pub metric: Option<String>,
}

/// Where results go.
#[derive(Default, Deserialize, JsonSchema)]
pub(super) struct PublishTable {
    pub prefix: Option<String>,
}

/// Bounds of what is taken in.
#[derive(Default, Deserialize, JsonSchema)]
pub(super) struct LimitsTable {
    pub message_bytes: Option<u32>,
    pub cylinders: Option<u32>,
    pub rows_a_minute: Option<u32>,
}

/// Where the page listens.
#[derive(Deserialize, JsonSchema)]
pub(super) struct PageTable {
    /// Address and port.
    pub listen: String,
    /// Refused, whatever it holds.
    #[schemars(skip)]
    pub token: Option<IgnoredAny>,
    pub token_file: Option<String>,
    pub token_env: Option<String>,
    pub tls_certificate_file: Option<String>,
    pub tls_key_file: Option<String>,
    pub host_names: Option<Vec<String>>,
}
