//! `slipfront lab`: the laboratory in the browser.

use std::path::{Path, PathBuf};

use clap::Args;
use slipfront_lab::{Laboratory, Options, Start};

use crate::failure::Failure;
use crate::print::print_message;
use crate::print_stderr::print_stderr;
use crate::threads::{count_from_one, set_worker_threads};

/// Open a page in the browser on which a surface slides while you look at it, paint on it and change it
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront lab                                          a circular cavity, sliding
  slipfront lab cases/groove_across.toml                 a case of yours
  slipfront lab results/circle                           a run again, beside what it recorded
  slipfront lab mine/a.toml --allow-files shared         a case that names files in another folder
  slipfront lab 'http://127.0.0.1:4000/#case=q1Yqyc_NUbJSSinKLEvVK4svLkksUrBVMNAzjMlT0lFKy8xJLVayqq6tBQA'
                                                         the case of a link that was copied there

The page answers on this machine alone, and needs no network. Ctrl-C ends it.")]
pub(crate) struct Lab {
    /// Case file, run folder, or a link of the page
    #[arg(value_name = "CASE")]
    case: Option<String>,
    /// Folder of results: runs are saved there, and those that are there can be shown again
    #[arg(short, long, value_name = "DIR", default_value = "results")]
    results: PathBuf,
    /// Another folder of which files that a case names may be read and become part of links and exports: else those in the
    /// folder of the case alone; may be given several times
    #[arg(long, value_name = "DIR")]
    allow_files: Vec<PathBuf>,
    /// The port [default: one that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Do not start the browser: open the address that is printed
    #[arg(long)]
    no_open: bool,
    /// Most threads of a run [default: one per core but one, which the browser has]
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
}

/// What stands before the case in a link.
const LINK: &str = "#case=";

impl Lab {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        // First, since a large case is made on these threads.
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = set_worker_threads(Some(self.threads.unwrap_or((cores as u16 - 1).max(1))), 1)?;
        let link = self
            .case
            .as_deref()
            .and_then(|case| case.split_once(LINK))
            .map(|(_, link)| link);
        let start = match &self.case {
            Some(case) if link.is_none() => {
                Start::of(Path::new(case), &self.allow_files).map_err(Failure::input)?
            }
            _ => Start::default(),
        };
        let laboratory = Laboratory::bind(Options {
            start,
            results: self.results,
            allow_files: self.allow_files,
            tell: print_stderr,
            port: self.port,
            threads,
        });
        let laboratory = laboratory.map_err(|error| {
            Failure::input(anyhow::anyhow!(
                "cannot listen on port {} of 127.0.0.1 ({error}): choose another one with --port",
                self.port
            ))
        })?;
        let address = laboratory.address(link);
        print_message(&format!("The laboratory is open until Ctrl-C: {address}\n"));
        if !self.no_open && open::that_detached(&address).is_err() {
            print_stderr("note: no browser could be started: open this address in one");
        }
        laboratory.serve(stopped()).map_err(Failure::running)
    }
}

/// Waits for the signal that ends the command.
async fn stopped() {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        if let Ok(mut terminate) = signal(SignalKind::terminate()) {
            tokio::select! {
                _ = terminate.recv() => {}
                _ = tokio::signal::ctrl_c() => {}
            }
            return;
        }
    }
    let _ = tokio::signal::ctrl_c().await;
}
