//! `replay`: reads `cylinder.bin` and `log.csv`, writes `out.bin`, all in the folder where it runs; on the host and, through
//! semihosting, in an emulated microcontroller.
#![cfg_attr(target_os = "none", no_std, no_main)]

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
    use cylwatch_controller::{LARGEST_STATE, Observed, replay};

    struct Bytes(Vec<u8>);

    impl Observed for Bytes {
        fn write(&mut self, bytes: &[u8]) {
            self.0.extend_from_slice(bytes);
        }
    }

    pub fn run() -> Result<usize, String> {
        let read = |name: &str| std::fs::read(name).map_err(|error| format!("{name}: {error}"));
        let log = String::from_utf8(read("log.csv")?).map_err(|error| format!("log.csv: {error}"))?;
        let mut bytes = Bytes(Vec::new());
        let (cylinder, mut room) = (read("cylinder.bin")?, [0; LARGEST_STATE]);
        let rows = replay(&cylinder, &log, &mut room, &mut bytes).map_err(|error| error.to_string())?;
        std::fs::write("out.bin", bytes.0).map_err(|error| format!("out.bin: {error}"))?;
        Ok(rows)
    }
}
