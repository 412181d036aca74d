//! A certificate that the gateway shows, to who looks at the page or to the broker. It is read again when its files have changed, as certificates are
//! renewed more often than gateways are started.
use super::Checked;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime};
use tokio_rustls::rustls::SignatureScheme;
use tokio_rustls::rustls::client::ResolvesClientCert;
use tokio_rustls::rustls::crypto::ring;
use tokio_rustls::rustls::pki_types::pem::PemObject;
use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer};
use tokio_rustls::rustls::server::{ClientHello, ResolvesServerCert};
use tokio_rustls::rustls::sign::CertifiedKey;

/// Between two looks at the files.
const LOOK: Duration = Duration::from_secs(60);

/// Files of a chain and its key, in PEM.
#[derive(Clone, Debug)]
struct Files {
    certificate: PathBuf,
    key: PathBuf,
}

impl Files {
    /// What they have.
    ///
    /// # Errors
    /// Names the file that cannot be used.
    fn read(&self) -> Result<CertifiedKey, (PathBuf, anyhow::Error)> {
        let of = |file: &PathBuf| {
            let file = file.clone();
            move |error: anyhow::Error| (file, error)
        };
        let chain = CertificateDer::pem_file_iter(&self.certificate)
            .and_then(Iterator::collect::<Result<Vec<_>, _>>)
            .map_err(|error| of(&self.certificate)(error.into()))?;
        let key = PrivateKeyDer::from_pem_file(&self.key).map_err(|error| of(&self.key)(error.into()))?;
        let certified = CertifiedKey::from_der(chain, key, &ring::default_provider());
        certified.map_err(|error| of(&self.certificate)(error.into()))
    }

    fn changed(&self) -> [Option<SystemTime>; 2] {
        [&self.certificate, &self.key].map(|file| file.metadata().and_then(|file| file.modified()).ok())
    }
}

#[derive(Debug)]
struct Known {
    certified: Arc<CertifiedKey>,
    changed: [Option<SystemTime>; 2],
    looked: Instant,
}

/// The certificate as it is now.
#[derive(Debug)]
pub(super) struct Certificate {
    files: Files,
    known: Mutex<Known>,
}

impl Certificate {
    /// # Errors
    /// Names the file that cannot be used.
    fn of(files: Files) -> Result<Self, (PathBuf, anyhow::Error)> {
        let changed = files.changed();
        let known = Known { certified: Arc::new(files.read()?), changed, looked: Instant::now() };
        Ok(Self { files, known: Mutex::new(known) })
    }

    /// What the files have; what they had as long as they cannot be used.
    fn now(&self, look: Duration) -> Arc<CertifiedKey> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if known.looked.elapsed() >= look {
            known.looked = Instant::now();
            let changed = self.files.changed();
            if changed != known.changed
                && let Ok(certified) = self.files.read()
            {
                (known.certified, known.changed) = (Arc::new(certified), changed);
            }
        }
        Arc::clone(&known.certified)
    }
}

impl ResolvesServerCert for Certificate {
    fn resolve(&self, _: ClientHello<'_>) -> Option<Arc<CertifiedKey>> {
        Some(self.now(LOOK))
    }
}

impl ResolvesClientCert for Certificate {
    fn resolve(&self, _: &[&[u8]], _: &[SignatureScheme]) -> Option<Arc<CertifiedKey>> {
        Some(self.now(LOOK))
    }

    fn has_certs(&self) -> bool {
        true
    }
}

impl Checked<'_> {
    /// The certificate at paths such as `page.tls_certificate_file` and `page.tls_key_file`.
    pub(super) fn certificate(
        &self,
        paths: &str,
        certificate: &str,
        key: &str,
    ) -> anyhow::Result<Certificate> {
        let [certificate, key] = [certificate, key].map(|file| self.folder.join(file));
        Certificate::of(Files { certificate: certificate.clone(), key }).map_err(|(file, error)| {
            let path =
                format!("{paths}{}", if file == certificate { "certificate_file" } else { "key_file" });
            error.context(format!("{}: {} is not usable", self.at(&path), file.display()))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PEM: &str = include_str!("../../../../tests/suite/serve/http/certificate.pem");
    const KEY: &str = include_str!("../../../../tests/suite/serve/http/key.pem");

    #[test]
    fn a_renewed_certificate_is_taken_and_one_that_cannot_be_used_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let [certificate, key] = ["c.pem", "k.pem"].map(|name| folder.path().join(name));
        let write = |text: &str, second: u64| {
            std::fs::write(&certificate, text).unwrap();
            let file = std::fs::File::options().append(true).open(&certificate).unwrap();
            file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(second)).unwrap();
        };
        let files = Files { certificate: certificate.clone(), key: key.clone() };
        write(PEM, 1);
        assert_eq!(Certificate::of(files.clone()).unwrap_err().0, key);
        std::fs::write(&key, KEY).unwrap();
        let of_page = Certificate::of(files).unwrap();
        let length = |look| of_page.now(look).cert.len();
        write(&PEM.repeat(2), 2);
        assert_eq!([length(LOOK), length(Duration::ZERO)], [1, 2]);
        write("nothing", 3);
        assert_eq!(length(Duration::ZERO), 2);
        write(PEM, 4);
        assert_eq!(length(Duration::ZERO), 1);
    }
}
