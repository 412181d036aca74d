//! TLS to the broker: the authorities that are believed, and the certificate that the gateway shows.
use super::Checked;
use crate::cli::serve::document::BrokerTable;
use crate::report::Input;
use anyhow::{Context, anyhow, bail};
use std::sync::Arc;
use tokio_rustls::rustls::crypto::ring;
use tokio_rustls::rustls::pki_types::pem::PemObject;
use tokio_rustls::rustls::pki_types::{CertificateDer, ServerName};
use tokio_rustls::rustls::{ClientConfig, RootCertStore};

/// TLS to the broker; equal where all files are.
#[derive(Clone)]
pub(in crate::cli::serve) struct Tls {
    pub configuration: Arc<ClientConfig>,
    /// Whether `ca_file` is given.
    pub has_own_authority: bool,
    /// SHA-256 of authorities, certificate and key.
    files: Vec<String>,
}

impl PartialEq for Tls {
    fn eq(&self, other: &Self) -> bool {
        self.files == other.files
    }
}

impl Checked<'_> {
    /// `None`: the broker is called in the clear.
    pub(super) fn broker_tls(&self, table: &BrokerTable) -> anyhow::Result<Option<Tls>> {
        let (certificate, key) = (&table.client_certificate_file, &table.client_key_file);
        if table.tls != Some(true) {
            let keys = ["broker.ca_file", "broker.client_certificate_file", "broker.client_key_file"];
            for (path, file) in keys.into_iter().zip([&table.ca_file, certificate, key]) {
                if let Some(file) = file {
                    self.refuse(path, file, "given with tls = true alone", "add tls = true or leave it out")?;
                }
            }
            return Ok(None);
        }
        if ServerName::try_from(table.host.as_str()).is_err() {
            let bound = "a name or an IPv4 address where tls = true";
            self.refuse("broker.host", &table.host, bound, "give a name that the broker's certificate has")?;
        }
        let (roots, authorities) = self.authorities(table.ca_file.as_deref())?;
        let builder = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()))
            .with_safe_default_protocol_versions()?
            .with_root_certificates(roots);
        let mut files = vec![authorities];
        let configuration = match (certificate, key) {
            (None, None) => builder.with_no_client_auth(),
            (Some(certificate), Some(key)) => {
                let shown = self.certificate("broker.client_", certificate, key)?;
                for file in [certificate, key] {
                    files.push(Input::of("", &std::fs::read(self.folder.join(file))?).sha256);
                }
                builder.with_client_cert_resolver(Arc::new(shown))
            }
            _ => bail!(
                "{}: a certificate of the gateway needs client_certificate_file and client_key_file: give both or none",
                self.at("broker")
            ),
        };
        let has_own_authority = table.ca_file.is_some();
        Ok(Some(Tls { configuration: Arc::new(configuration), has_own_authority, files }))
    }

    /// Authorities of a file, or of the system, and their hash.
    fn authorities(&self, file: Option<&str>) -> anyhow::Result<(RootCertStore, String)> {
        let mut roots = RootCertStore::empty();
        let Some(file) = file else {
            let certificates = rustls_native_certs::load_native_certs().certs;
            let bytes: Vec<u8> = certificates.iter().flat_map(|of| of.iter().copied()).collect();
            let hash = Input::of("", &bytes).sha256;
            roots.add_parsable_certificates(certificates);
            if roots.is_empty() {
                bail!(
                    "{}: this system has no certificates of authorities: install them (ca-certificates), or name that of the \
                     broker's authority in ca_file",
                    self.at("broker.tls")
                );
            }
            return Ok((roots, hash));
        };
        let path = self.folder.join(file);
        let unusable = || format!("{}: {} is not usable", self.at("broker.ca_file"), path.display());
        let bytes = std::fs::read(&path).with_context(unusable)?;
        for certificate in CertificateDer::pem_slice_iter(&bytes) {
            let added = certificate.map_err(anyhow::Error::from).and_then(|of| Ok(roots.add(of)?));
            added.with_context(unusable)?;
        }
        if roots.is_empty() {
            return Err(anyhow!("it has no certificate in PEM").context(unusable()));
        }
        Ok((roots, Input::of("", &bytes).sha256))
    }
}
