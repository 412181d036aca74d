//! How to reach the broker; passwords come from a file or the environment alone.
use super::Checked;
use crate::cli::serve::document::{BrokerTable, Protocol};
use anyhow::bail;
use std::time::Duration;

/// How to reach the broker.
#[derive(Clone, PartialEq)]
pub(in crate::cli::serve) struct Broker {
    pub host: String,
    pub port: u16,
    pub protocol: Protocol,
    pub client_id: String,
    /// User and password.
    pub login: Option<(String, String)>,
    pub keep_alive: Duration,
    pub session_expiry: Duration,
    /// Largest payload that is taken.
    pub message_bytes: usize,
}

impl Checked<'_> {
    pub(super) fn broker(&self, table: BrokerTable, message_bytes: usize) -> anyhow::Result<Broker> {
        if table.password.is_some() {
            bail!(
                "{}: broker password stands in the configuration: write it to a file that others cannot read and name \
                 that in password_file, or name a variable in password_env",
                self.at("broker.password")
            );
        }
        if table.client_id.is_empty() {
            self.refuse(
                "broker.client_id",
                "\"\"",
                "a name",
                "the broker keeps messages for it while the gateway is away",
            )?;
        }
        let (file, variable) = (table.password_file.as_deref(), table.password_env.as_deref());
        let password = self.secret("broker.password", file, variable)?;
        let login = match (table.user, password) {
            (None, Some(_)) => bail!("{}: a password needs a user: add user", self.at("broker")),
            (user, password) => user.map(|user| (user, password.unwrap_or_default())),
        };
        Ok(Broker {
            host: table.host,
            port: table.port.unwrap_or(1883),
            protocol: table.protocol.unwrap_or_default(),
            client_id: table.client_id,
            login,
            message_bytes,
            keep_alive: self.seconds("broker.keep_alive_s", table.keep_alive_s, 30.0, (5.0, 3_600.0))?,
            session_expiry: self.seconds(
                "broker.session_expiry_s",
                table.session_expiry_s,
                7.0 * 86_400.0,
                (60.0, f64::from(u32::MAX)),
            )?,
        })
    }
}
