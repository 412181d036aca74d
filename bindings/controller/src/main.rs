//! `replay`: reads `cylinder.bin` and `log.csv`, writes `out.bin`, all in the folder where it runs; on the host and, through
//! semihosting, in an emulated microcontroller.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod counted;
#[cfg(target_os = "none")]
mod target;

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    match host::run() {
        Ok(rows) => {
            println!("rows {rows}");
            std::process::ExitCode::SUCCESS
        }
        Err(words) => {
            eprintln!("{words}");
            std::process::ExitCode::from(2)
        }
    }
}

#[cfg(not(target_os = "none"))]
mod host {
    use crate::counted::{Arena, Counted};
    use cylwatch_controller::{LARGEST_STATE, Observed, replay};
    use std::alloc::System;
    use std::fs::File;
    use std::io::{BufWriter, Write};

    #[global_allocator]
    static ALLOCATOR: Counted<System> = Counted(System);

    struct Told {
        out: BufWriter<File>,
        arena: Arena,
        failed: Option<std::io::Error>,
    }

    impl Observed for Told {
        fn write(&mut self, bytes: &[u8]) {
            self.failed = self.failed.take().or(self.out.write_all(bytes).err());
        }

        fn begun(&mut self) {
            self.arena.begun();
        }

        fn saving(&mut self) {
            self.arena.saving();
        }

        fn saved(&mut self) {
            self.arena.saved();
        }

        fn restored(&mut self) {
            self.arena.restored();
        }

        fn work(&mut self) {
            self.arena.work();
        }

        fn rest(&mut self) {
            self.arena.rest();
        }
    }

    pub fn run() -> Result<usize, String> {
        let read = |name: &str| std::fs::read(name).map_err(|error| format!("{name}: {error}"));
        let log = String::from_utf8(read("log.csv")?).map_err(|error| format!("log.csv: {error}"))?;
        let cylinder = read("cylinder.bin")?;
        let failed = |error| format!("out.bin: {error}");
        let out = BufWriter::new(File::create("out.bin").map_err(failed)?);
        let mut told = Told { out, arena: Arena::empty(), failed: None };
        let mut room = [0; LARGEST_STATE];
        let rows = replay(&cylinder, &log, &mut room, &mut told).map_err(|error| error.to_string())?;
        let measured = told.arena.measured();
        told.failed.map_or(told.out.flush(), Err).map_err(failed)?;
        measured.iter().for_each(|(name, value)| println!("{name} {value}"));
        Ok(rows)
    }
}
