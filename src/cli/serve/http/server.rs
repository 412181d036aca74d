//! Connections: each is one request, in a task of its own.
use super::Site;
use super::connections::{Connections, Place, Room};
use super::limits::{ANSWER_TIME, FIELDS, HEAD_BYTES, Limit, REQUEST_TIME, STALL_TIME};
use super::patient::Patient;
use super::routes::answer;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{sleep, timeout};
use tokio_rustls::TlsAcceptor;

/// After a connection that could not be taken, as without file descriptors.
const PAUSE: Duration = Duration::from_millis(100);
/// What a connection is told that there is no room for.
const FULL: &[u8] =
    b"HTTP/1.1 503 Service Unavailable\r\nretry-after: 5\r\nconnection: close\r\ncontent-length: 0\r\n\r\n";

/// Takes connections for ever.
pub(super) async fn accept(listener: std::net::TcpListener, site: Arc<Site>) {
    let Ok(listener) = TcpListener::from_std(listener) else { return };
    let connections = Arc::new(Connections::default());
    loop {
        match listener.accept().await {
            Ok((stream, _)) => admit(stream, &site, &connections),
            Err(_) => sleep(PAUSE).await,
        }
    }
}

fn admit(stream: TcpStream, site: &Arc<Site>, connections: &Arc<Connections>) {
    match connections.room() {
        Room::Free => {}
        Room::Made => site.counts.refuse(Limit::Connections),
        Room::Full => {
            site.counts.refuse(Limit::Connections);
            if site.page.tls.is_none() {
                // A client that does not take it has gone or is slow.
                _ = stream.try_write(FULL);
            }
            return;
        }
    }
    connections.take(|number, place| {
        let (site, taken) = (Arc::clone(site), Taken(Arc::clone(connections), number));
        let task = tokio::spawn(async move {
            let _taken = taken;
            connected(stream, &site, &place).await;
        });
        task.abort_handle()
    });
}

/// A place that is given back whatever becomes of the task.
struct Taken(Arc<Connections>, u64);

impl Drop for Taken {
    fn drop(&mut self) {
        self.0.free(self.1);
    }
}

async fn connected(stream: TcpStream, site: &Arc<Site>, place: &Arc<Place>) {
    // A slower connection is a connection.
    _ = stream.set_nodelay(true);
    let stream = Patient::new(stream, Arc::clone(place), STALL_TIME, ANSWER_TIME);
    let Some(tls) = &site.page.tls else { return asked(stream, site, place).await };
    match timeout(REQUEST_TIME, TlsAcceptor::from(Arc::clone(tls)).accept(stream)).await {
        Ok(Ok(stream)) => asked(stream, site, place).await,
        Ok(Err(_)) => site.counts.refuse(Limit::Tls),
        Err(_) => site.counts.refuse(Limit::RequestTime),
    }
}

async fn asked<S: AsyncRead + AsyncWrite + Unpin>(stream: S, site: &Arc<Site>, place: &Arc<Place>) {
    let service = service_fn(|request| async move {
        place.asked();
        Ok::<_, Infallible>(answer(&request, site, place).await)
    });
    let mut builder = http1::Builder::new();
    builder.keep_alive(false).max_buf_size(HEAD_BYTES).max_headers(FIELDS);
    builder.timer(TokioTimer::new()).header_read_timeout(REQUEST_TIME);
    if let Err(error) = builder.serve_connection(TokioIo::new(stream), service).await {
        site.counts.broken(&error);
    }
}
