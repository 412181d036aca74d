//! How to reach the broker; passwords come from a file or the environment alone.
use super::{Checked, Tls};
use crate::cli::serve::document::{BrokerTable, Protocol};
use anyhow::bail;
use std::net::IpAddr;
use std::time::Duration;

/// How to reach the broker.
#[derive(Clone, PartialEq)]
pub(in crate::cli::serve) struct Broker {
    pub host: String,
    pub port: u16,
    /// `None`: in the clear.
    pub tls: Option<Tls>,
    pub protocol: Protocol,
    pub client_id: String,
    /// User and password.
    pub login: Option<(String, String)>,
    pub keep_alive: Duration,
    pub session_expiry: Duration,
    /// Largest payload that is taken.
    pub message_bytes: usize,
}

impl Broker {
    /// What to say of a password that others on the network could read.
    pub(in crate::cli::serve) fn caution(&self) -> Option<String> {
        let has_password = self.login.as_ref().is_some_and(|(_, password)| !password.is_empty());
        (has_password && self.tls.is_none() && !is_loopback(&self.host)).then(|| {
            format!(
                "the password goes to the broker at {} in the clear: write tls = true in [broker], and ca_file if its authority is \
                 your own",
                self.host
            )
        })
    }
}

/// Whether a host is this machine, by the way it is written.
fn is_loopback(host: &str) -> bool {
    let address = host.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
    address.map_or_else(|_| host.eq_ignore_ascii_case("localhost"), |address| address.is_loopback())
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
        let tls = self.broker_tls(&table)?;
        let (file, variable) = (table.password_file.as_deref(), table.password_env.as_deref());
        let password = self.secret("broker.password", file, variable)?;
        let login = match (table.user, password) {
            (None, Some(_)) => bail!("{}: a password needs a user: add user", self.at("broker")),
            (user, password) => user.map(|user| (user, password.unwrap_or_default())),
        };
        Ok(Broker {
            host: table.host,
            port: table.port.unwrap_or(if tls.is_some() { 8883 } else { 1883 }),
            tls,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_machine_is_known_by_name_and_address() {
        for host in ["localhost", "LocalHost", "127.0.0.1", "127.8.0.1", "[::1]", "::1"] {
            assert!(is_loopback(host), "{host}");
        }
        for host in ["broker", "localhost.example", "127.0.0.1.example", "10.0.0.1", "[fe80::1]", "0.0.0.0"] {
            assert!(!is_loopback(host), "{host}");
        }
    }
}
