//! Where the page listens, and what it asks for: a token and TLS wherever it is not this machine alone.
use super::Checked;
use crate::cli::serve::document::PageTable;
use anyhow::bail;
use sha2::{Digest, Sha256};
use std::net::SocketAddr;
use std::sync::Arc;
use subtle::ConstantTimeEq;
use tokio_rustls::rustls::ServerConfig;
use tokio_rustls::rustls::crypto::ring;

/// Shortest token, characters.
const SHORTEST_TOKEN: usize = 16;

/// The page.
pub(in crate::cli::serve) struct Page {
    pub listen: SocketAddr,
    pub token: Option<Token>,
    pub tls: Option<Arc<ServerConfig>>,
    /// Names of this machine beside `localhost`, as a proxy in front of it has them.
    pub host_names: Vec<String>,
}

/// A token, by its hash.
pub(in crate::cli::serve) struct Token([u8; 32]);

impl Token {
    fn of(token: &[u8]) -> Self {
        Self(Sha256::digest(token).into())
    }

    /// Whether it is this one, in a time that does not tell how much of it is right.
    pub(in crate::cli::serve) fn is(&self, given: &[u8]) -> bool {
        self.0.ct_eq(&Self::of(given).0).into()
    }
}

impl Page {
    /// As a browser has it.
    pub(in crate::cli::serve) fn address(&self) -> String {
        format!("{}://{}/", if self.tls.is_some() { "https" } else { "http" }, self.listen)
    }
}

impl Checked<'_> {
    pub(super) fn page(&self, table: &PageTable) -> anyhow::Result<Page> {
        let Ok(listen) = table.listen.parse::<SocketAddr>() else {
            return self.refuse(
                "page.listen",
                &table.listen,
                "an address and a port, as 127.0.0.1:8742 or [::1]:8742",
                "give the address of a network card, or that of this machine alone",
            );
        };
        if table.token.is_some() {
            bail!(
                "{}: page token stands in the configuration: write it to a file that others cannot read and name that in \
                 token_file, or name a variable in token_env",
                self.at("page.token")
            );
        }
        let token = self.secret("page.token", table.token_file.as_deref(), table.token_env.as_deref())?;
        if token.as_ref().is_some_and(|token| token.chars().count() < SHORTEST_TOKEN) {
            bail!(
                "{}: the token is shorter than {SHORTEST_TOKEN} characters, which can be guessed: make one, as by `openssl rand -hex 24`",
                self.at("page")
            );
        }
        let tls = match (&table.tls_certificate_file, &table.tls_key_file) {
            (None, None) => None,
            (Some(certificate), Some(key)) => Some(self.tls(certificate, key)?),
            _ => bail!(
                "{}: TLS needs tls_certificate_file and tls_key_file: give both or none",
                self.at("page")
            ),
        };
        if !listen.ip().is_loopback() && (token.is_none() || tls.is_none()) {
            self.refuse(
                "page.listen",
                &table.listen,
                "an address of this machine alone unless there are a token and TLS",
                "give token_file or token_env, tls_certificate_file and tls_key_file, or listen at 127.0.0.1",
            )?;
        }
        let host_names = table.host_names.clone().unwrap_or_default();
        Ok(Page { listen, token: token.map(|token| Token::of(token.as_bytes())), tls, host_names })
    }

    fn tls(&self, certificate: &str, key: &str) -> anyhow::Result<Arc<ServerConfig>> {
        let certificate = self.certificate("page.tls_", certificate, key)?;
        let mut configuration = ServerConfig::builder_with_provider(Arc::new(ring::default_provider()))
            .with_safe_default_protocol_versions()?
            .with_no_client_auth()
            .with_cert_resolver(Arc::new(certificate));
        configuration.alpn_protocols = vec![b"http/1.1".to_vec()];
        Ok(Arc::new(configuration))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_itself_alone() {
        let token = Token::of(b"open sesame, please");
        assert!(token.is(b"open sesame, please"));
        for other in [&b""[..], b"open sesame, pleas", b"open sesame, please ", b"Open sesame, please"] {
            assert!(!token.is(other));
        }
    }
}
