//! Writes states on a thread of its own: rows do not wait for it.
use crate::cli::output::write_files;
use anyhow::Context;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};

/// States that are written together: each has a file open.
pub(super) const TOGETHER: usize = 64;

/// A state that is to be written.
pub(super) struct Job {
    pub name: String,
    pub file: PathBuf,
    pub bytes: Vec<u8>,
    /// A file that goes then.
    pub replaces: Option<PathBuf>,
}

/// What became of the state of a cylinder.
type Done = (String, anyhow::Result<()>);

/// The thread, and what it has not done.
pub(super) struct Saver {
    jobs: Sender<Vec<Job>>,
    done: Receiver<Done>,
    /// What was waited for.
    ready: Vec<Done>,
    pending: usize,
}

impl Saver {
    pub(super) fn new() -> Self {
        let (jobs, asked) = channel::<Vec<Job>>();
        let (told, done) = channel();
        std::thread::spawn(move || {
            for some in asked {
                // Nobody listens any more when the gateway has ended.
                some.chunks(TOGETHER).flat_map(written).for_each(|one| _ = told.send(one));
            }
        });
        Self { jobs, done, ready: Vec::new(), pending: 0 }
    }

    /// Writes some states, [`TOGETHER`] at a time.
    pub(super) fn begin(&mut self, jobs: Vec<Job>) {
        self.pending += jobs.len();
        _ = self.jobs.send(jobs);
    }

    /// A state that has been written, or has failed.
    pub(super) fn done(&mut self) -> Option<Done> {
        if let Some(done) = self.ready.pop() {
            return Some(done);
        }
        let done = self.done.try_recv().ok()?;
        self.pending -= 1;
        Some(done)
    }

    /// Waits for all.
    pub(super) fn wait(&mut self) {
        while self.pending > 0
            && let Ok(done) = self.done.recv()
        {
            self.pending -= 1;
            self.ready.push(done);
        }
    }
}

fn written(jobs: &[Job]) -> Vec<Done> {
    let files: Vec<_> = jobs.iter().map(|job| (job.file.as_path(), job.bytes.as_slice())).collect();
    let written = write_files(&files);
    jobs.iter()
        .zip(written)
        .map(|(job, written)| (job.name.clone(), written.and_then(|()| remove(job))))
        .collect()
}

fn remove(job: &Job) -> anyhow::Result<()> {
    match &job.replaces {
        Some(file) if file.is_file() => {
            std::fs::remove_file(file).with_context(|| format!("{} cannot be removed", file.display()))
        }
        _ => Ok(()),
    }
}
