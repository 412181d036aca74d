//! What the service manager is told (sd_notify): that the gateway is ready, reads its configuration again, or ends, and that its loop turns.
//!
//! The socket is that of `NOTIFY_SOCKET`; without it, and on systems that have none, nothing is sent. The watchdog hears from the loop alone: one that is
//! held up is killed by the service manager, and started again.
use std::time::{Duration, Instant};

/// The service manager.
pub(super) struct Notify {
    socket: Option<socket::Socket>,
    /// How often the watchdog wants to hear from the loop.
    every: Option<Duration>,
    next: Instant,
}

impl Notify {
    /// The one of the environment.
    pub(super) fn of_environment() -> Self {
        let number = |name: &str| std::env::var(name).ok()?.parse::<u64>().ok();
        let is_ours = number("WATCHDOG_PID").is_none_or(|pid| pid == u64::from(std::process::id()));
        Self {
            socket: socket::Socket::of_environment(),
            every: number("WATCHDOG_USEC").filter(|_| is_ours).map(every),
            next: Instant::now(),
        }
    }

    /// The states are there, and the broker is called.
    pub(super) fn ready(&self) {
        self.send("READY=1");
    }

    /// The configuration is read again; [`Self::ready`] follows.
    pub(super) fn reloading(&self) {
        self.send("RELOADING=1");
    }

    /// The states are saved.
    pub(super) fn stopping(&self) {
        self.send("STOPPING=1");
    }

    /// The loop has turned.
    pub(super) fn turned(&mut self) {
        let now = Instant::now();
        if let Some(every) = self.every
            && now >= self.next
        {
            self.send("WATCHDOG=1");
            self.next = now + every;
        }
    }

    fn send(&self, words: &str) {
        // A service manager that does not listen ends the gateway by itself, if it was told to.
        self.socket.iter().for_each(|socket| socket.send(words));
    }
}

/// A third of the time after which the watchdog bites, µs.
fn every(watchdog_us: u64) -> Duration {
    Duration::from_micros(watchdog_us / 3)
}

#[cfg(target_os = "linux")]
mod socket {
    use std::os::linux::net::SocketAddrExt;
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::net::{SocketAddr, UnixDatagram};

    /// A socket of datagrams, by a path or, after `@`, by a name.
    pub(super) struct Socket(UnixDatagram, SocketAddr);

    impl Socket {
        pub(super) fn of_environment() -> Option<Self> {
            let path = std::env::var_os("NOTIFY_SOCKET")?;
            let address = match path.as_bytes().strip_prefix(b"@") {
                Some(name) => SocketAddr::from_abstract_name(name),
                None => SocketAddr::from_pathname(&path),
            };
            let socket = UnixDatagram::unbound().ok()?;
            // The loop must not wait for a reader.
            socket.set_nonblocking(true).ok()?;
            Some(Self(socket, address.ok()?))
        }

        pub(super) fn send(&self, words: &str) {
            _ = self.0.send_to_addr(words.as_bytes(), &self.1);
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod socket {
    /// None.
    pub(super) struct Socket;

    impl Socket {
        pub(super) fn of_environment() -> Option<Self> {
            None
        }

        pub(super) fn send(&self, _: &str) {}
    }
}
