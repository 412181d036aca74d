//! TLS of both protocols, and why it fails, with the remedy.
use crate::cli::serve::config::Broker;
use rumqttc::{TlsConfiguration, TlsError, Transport, v5};
use std::error::Error;
use std::io;
use tokio_rustls::rustls::{self, AlertDescription, CertificateError};

const OTHER_PORT: &str = "give the port where it speaks TLS, usually 8883, or leave out tls = true";

/// How the broker is called.
pub(super) fn transport(broker: &Broker) -> Transport {
    match &broker.tls {
        Some(tls) => Transport::tls_with_config(TlsConfiguration::Rustls(tls.configuration.clone())),
        None => Transport::Tcp,
    }
}

/// Why a connection has ended or did not come about.
pub(super) fn reason(error: &(dyn Error + 'static), broker: &Broker) -> String {
    let words = match of_tls(error) {
        Some(error) => words(error, broker),
        // A broker that takes the first bytes for nonsense ends the connection.
        None => error.source().filter(|error| error.is::<TlsError>()).map(|error| {
            let Broker { host, port, .. } = broker;
            format!("{host}:{port}: it ends the connection instead of speaking TLS ({error}): {OTHER_PORT}")
        }),
    };
    words.unwrap_or_else(|| error.to_string())
}

/// The error of TLS in an error.
fn of_tls<'a>(error: &'a (dyn Error + 'static)) -> Option<&'a rustls::Error> {
    let mut next = Some(error);
    while let Some(error) = next {
        // What an `io::Error` wraps is not its source.
        let wrapped = error.downcast_ref::<io::Error>().and_then(io::Error::get_ref);
        let wrapped = wrapped.and_then(|error| error.downcast_ref());
        if let Some(of_tls) = error.downcast_ref().or(wrapped) {
            return Some(of_tls);
        }
        next = match error.downcast_ref() {
            // It does not name its source.
            Some(v5::StateError::Deserialization(error)) => Some(error),
            _ => error.source(),
        };
    }
    None
}

/// Who, why and remedy.
fn words(error: &rustls::Error, broker: &Broker) -> Option<String> {
    let Broker { host, port, .. } = broker;
    let has_own_authority = broker.tls.as_ref().is_some_and(|tls| tls.has_own_authority);
    let (why, remedy) = match error {
        rustls::Error::InvalidCertificate(wrong) => of_certificate(wrong, host, has_own_authority),
        rustls::Error::AlertReceived(alert) => of_alert(*alert)?,
        rustls::Error::InvalidMessage(_) => ("it does not speak TLS there".to_owned(), OTHER_PORT.to_owned()),
        _ => return None,
    };
    Some(format!("{host}:{port}: {why} ({error}): {remedy}"))
}

/// What is wrong with the broker's certificate.
fn of_certificate(wrong: &CertificateError, host: &str, has_own_authority: bool) -> (String, String) {
    use CertificateError as E;
    let known_to = if has_own_authority { "ca_file" } else { "this system" };
    let (why, remedy) = match wrong {
        E::UnknownIssuer | E::BadSignature => (
            format!("its certificate is from an authority that {known_to} does not have"),
            "name the certificate of that authority in ca_file".to_owned(),
        ),
        E::NotValidForName | E::NotValidForNameContext { .. } => (
            format!("its certificate is not for the name {host}"),
            "give in host a name that the certificate has, or have one made for this name".to_owned(),
        ),
        E::Expired | E::ExpiredContext { .. } => (
            "its certificate has expired".to_owned(),
            "renew it at the broker, and see that the clock of this machine is right".to_owned(),
        ),
        E::NotValidYet | E::NotValidYetContext { .. } => (
            "its certificate is not valid yet".to_owned(),
            "see that the clocks of this machine and of the authority are right".to_owned(),
        ),
        _ => (
            "its certificate cannot be used".to_owned(),
            "have one made for a server, for the name in host, and no authority itself".to_owned(),
        ),
    };
    (why, remedy)
}

/// Why the broker refuses; `None`: for no reason that a certificate could have.
fn of_alert(alert: AlertDescription) -> Option<(String, String)> {
    use AlertDescription as A;
    let (why, remedy) = match alert {
        A::CertificateRequired => {
            ("it demands a certificate of the gateway", "give client_certificate_file and client_key_file")
        }
        A::BadCertificate
        | A::UnsupportedCertificate
        | A::CertificateRevoked
        | A::CertificateExpired
        | A::CertificateUnknown
        | A::UnknownCA
        | A::AccessDenied
        | A::HandshakeFailure => (
            "it refuses the certificate of the gateway, or that there is none",
            "give in client_certificate_file one that is valid and from an authority that the broker has",
        ),
        _ => return None,
    };
    Some((why.to_owned(), remedy.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::serve::document::Protocol;
    use std::time::Duration;

    fn broker() -> Broker {
        Broker {
            message_bytes: 65_536,
            host: "depot".to_owned(),
            port: 8883,
            tls: None,
            protocol: Protocol::V5,
            client_id: String::new(),
            login: None,
            keep_alive: Duration::ZERO,
            session_expiry: Duration::ZERO,
        }
    }

    #[test]
    fn an_error_of_tls_is_found_in_those_of_both_protocols_and_told_with_its_remedy() {
        let wrapped = |of_tls| io::Error::new(io::ErrorKind::InvalidData, of_tls);
        for (certificate, words) in [
            (CertificateError::UnknownIssuer, "name the certificate of that authority"),
            (CertificateError::NotValidForName, "not for the name depot"),
            (CertificateError::Expired, "renew it at the broker"),
            (CertificateError::NotValidYet, "clocks"),
        ] {
            let of_tls = rustls::Error::InvalidCertificate(certificate);
            let v4 = rumqttc::ConnectionError::Tls(wrapped(of_tls.clone()).into());
            let v5 = rumqttc::v5::ConnectionError::Io(wrapped(of_tls));
            for told in [reason(&v4, &broker()), reason(&v5, &broker())] {
                assert!(told.starts_with("depot:8883: ") && told.contains(words), "{told}");
            }
        }
        let refused = || wrapped(rustls::Error::AlertReceived(AlertDescription::CertificateRequired));
        let v4 = rumqttc::StateError::Deserialization(rumqttc::mqttbytes::Error::Io(refused()));
        let v5 = v5::StateError::Deserialization(v5::mqttbytes::Error::Io(refused()));
        let (v4, v5) = (rumqttc::ConnectionError::MqttState(v4), v5::ConnectionError::MqttState(v5));
        for told in [reason(&v4, &broker()), reason(&v5, &broker())] {
            assert!(told.contains("give client_certificate_file"), "{told}");
        }
        let eof = || TlsError::Io(io::ErrorKind::UnexpectedEof.into());
        let (v4, v5) = (rumqttc::ConnectionError::Tls(eof()), v5::ConnectionError::Tls(eof()));
        for told in [reason(&v4, &broker()), reason(&v5, &broker())] {
            assert!(told.contains("leave out tls = true"), "{told}");
        }
        let other = rumqttc::ConnectionError::Io(io::Error::other("a cable"));
        assert_eq!(reason(&other, &broker()), "I/O: a cable");
    }
}
