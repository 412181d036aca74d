//! A connection that ends when its client takes nothing for too long.
use super::connections::Place;
use std::future::Future;
use std::io::{Error, ErrorKind, Result};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::{Instant, Sleep, sleep_until};

/// A connection with the patience for its client.
pub(super) struct Patient {
    stream: TcpStream,
    place: Arc<Place>,
    /// When patience ends while nothing can be sent.
    stall: Pin<Box<Sleep>>,
    is_stalled: bool,
    stall_time: Duration,
    end: Instant,
}

impl Patient {
    /// A client that must take something in one time, and all in another unless it listens to events.
    pub(super) fn new(stream: TcpStream, place: Arc<Place>, stall_time: Duration, time: Duration) -> Self {
        let end = Instant::now() + time;
        Self { stream, place, stall: Box::pin(sleep_until(end)), is_stalled: false, stall_time, end }
    }

    fn patience<T>(&mut self, context: &mut Context<'_>, sent: Poll<Result<T>>) -> Poll<Result<T>> {
        if sent.is_ready() {
            self.is_stalled = false;
            return sent;
        }
        if !std::mem::replace(&mut self.is_stalled, true) {
            let stalled = Instant::now() + self.stall_time;
            self.stall.as_mut().reset(if self.place.is_stream() { stalled } else { stalled.min(self.end) });
        }
        match self.stall.as_mut().poll(context) {
            Poll::Ready(()) => Poll::Ready(Err(Error::from(ErrorKind::TimedOut))),
            Poll::Pending => Poll::Pending,
        }
    }
}

impl AsyncRead for Patient {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, buffer)
    }
}

impl AsyncWrite for Patient {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<Result<usize>> {
        let sent = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.patience(context, sent)
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Result<()>> {
        let sent = Pin::new(&mut self.stream).poll_flush(context);
        self.patience(context, sent)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tokio::io::{AsyncReadExt, AsyncWriteExt};
    use tokio::net::TcpListener;

    /// Whether a client that takes a piece from time to time, all in all little, is given up.
    async fn is_given_up(pieces: usize, is_stream: bool) -> bool {
        let ms = Duration::from_millis;
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let mut client = TcpStream::connect(listener.local_addr().unwrap()).await.unwrap();
        let place = Arc::new(Place::default());
        if is_stream {
            place.streams();
        }
        let mut patient = Patient::new(listener.accept().await.unwrap().0, place, ms(400), ms(800));
        tokio::spawn(async move {
            let mut piece = vec![0; 4 << 20];
            for _ in 0..pieces {
                tokio::time::sleep(ms(100)).await;
                _ = client.read_exact(&mut piece).await;
            }
            tokio::time::sleep(ms(2000)).await;
        });
        let written = tokio::time::timeout(ms(1500), patient.write_all(&vec![0; 1 << 28])).await;
        written.is_ok_and(|written| written.is_err_and(|error| error.kind() == ErrorKind::TimedOut))
    }

    #[test]
    fn a_client_that_takes_nothing_or_takes_too_long_is_given_up_and_a_slow_stream_is_not() {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        assert!(runtime.block_on(is_given_up(0, false)));
        assert!(runtime.block_on(is_given_up(0, true)));
        assert!(runtime.block_on(is_given_up(20, false)));
        assert!(!runtime.block_on(is_given_up(20, true)));
    }
}
