//! A connection that ends when its client takes nothing for too long.
use super::connections::Place;
use super::limits::{ANSWER_TIME, STALL_TIME};
use std::future::Future;
use std::io::{Error, ErrorKind, Result};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
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
    end: Instant,
}

impl Patient {
    pub(super) fn new(stream: TcpStream, place: Arc<Place>) -> Self {
        let end = Instant::now() + ANSWER_TIME;
        Self { stream, place, stall: Box::pin(sleep_until(end)), is_stalled: false, end }
    }

    fn patience<T>(&mut self, context: &mut Context<'_>, sent: Poll<Result<T>>) -> Poll<Result<T>> {
        if sent.is_ready() {
            self.is_stalled = false;
            return sent;
        }
        if !std::mem::replace(&mut self.is_stalled, true) {
            let stalled = Instant::now() + STALL_TIME;
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
