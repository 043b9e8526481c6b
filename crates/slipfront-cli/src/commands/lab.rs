//! `slipfront lab`: the laboratory in the browser.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use slipfront_base::text::display_path;
use slipfront_lab::{
    ExportError, Laboratory, Patience, ServerOptions, Start, export_folder, export_single, find_module,
};

use super::licences::NOTICES;
use crate::browser;
use crate::failure::Failure;
use crate::print::print_message;
use crate::print_stderr::{print_notes, print_stderr};
use crate::signals::Signals;
use crate::threads::{count_from_one, set_worker_threads};

/// Open the interactive laboratory in a browser
///
/// The surface slides while you watch it, paint on it and change it
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront lab                                          a circular cavity, sliding
  slipfront lab cases/groove_across.toml                 your own case
  slipfront lab results/circle                           a repeated run, compared with its recorded results
  slipfront lab mine/a.toml --allow-files shared         a case with files in another folder
  slipfront lab --single slipfront.html                  a single file that opens without this program and without a network
  slipfront lab 'http://127.0.0.1:4000/#case=q1Yqyc_NUbJSSinKLEvVK4svLkksUrBVMNAzjMlT0lFKy8xJLVayqq6tBQA'
                                                         the case in a copied link

The page is available on this machine only, and needs no network. Ctrl-C ends it.")]
pub(crate) struct LabCommand {
    /// Case file, run folder, or link copied from the page
    #[arg(value_name = "CASE")]
    case: Option<String>,
    /// Folder of results: runs are saved there, and runs in it can be replayed
    #[arg(short, long, value_name = "DIR", default_value = "results")]
    results: PathBuf,
    /// Another folder with files that a case may read and that may be embedded in links and exports [default:
    /// only the folder of the case]; repeatable
    #[arg(long, value_name = "DIR")]
    allow_files: Vec<PathBuf>,
    /// Port of the server [default: a free port]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Print the address, but do not start the browser
    #[arg(long)]
    no_open: bool,
    /// Maximum number of threads of a run [default: one less than the number of cores, for the browser]
    #[arg(long, value_name = "N", value_parser = count_from_one)]
    threads: Option<u16>,
    /// Write the laboratory as a folder for any web server, and open nothing
    #[arg(long, value_name = "DIR", conflicts_with_all = ["single", "port", "no_open", "threads", "results"])]
    export: Option<PathBuf>,
    /// Write the laboratory as a single file that opens in a browser from disk, and open nothing
    #[arg(long, value_name = "FILE.html", conflicts_with_all = ["port", "no_open", "threads", "results"])]
    single: Option<PathBuf>,
}

/// Marks the part of a link that contains the case.
const LINK: &str = "#case=";

impl LabCommand {
    pub(crate) fn execute(self, module_folder: Option<&Path>) -> Result<(), Failure> {
        // This comes first, because a large case is made on these threads.
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = set_worker_threads(Some(self.threads.unwrap_or((cores as u16 - 1).max(1))), 1)?;
        let parts = self.case.as_deref().and_then(|case| case.split_once(LINK));
        let link = parts.map(|(_, link)| link);
        let start = match &self.case {
            Some(case) if link.is_none() => {
                Start::read(Path::new(case), &self.allow_files).map_err(Failure::input)?
            }
            _ => Start::default(),
        };
        if self.export.is_some() || self.single.is_some() {
            return self.export(&start, module_folder);
        }
        let signals = Signals::catch().map_err(Failure::running)?;
        let laboratory = Laboratory::bind(ServerOptions {
            start,
            results: self.results,
            allow_files: self.allow_files,
            print: print_stderr,
            port: self.port,
            threads,
            patience: Patience::default(),
        });
        let laboratory = laboratory.map_err(|error| {
            Failure::input(format!(
                "cannot listen on port {} of 127.0.0.1 ({error}): choose another one with --port",
                self.port
            ))
        })?;
        // Anyone with the address can use the laboratory. The file is removed when this value is dropped,
        // after the server has ended.
        let file = others_read_output().then(|| laboratory.address_file(link));
        let file = file.transpose().map_err(|error| {
            Failure::running(format!(
                "other users can read standard output, and the address cannot be written to a private file ({error}): free some \
                 space in {}, or use `chmod 600` on the output",
                std::env::temp_dir().display()
            ))
        })?;
        let (address, which) = match &file {
            Some(file) => (file.path().display().to_string(), "the address in that file"),
            None => (laboratory.address(link), "this address"),
        };
        print_message(&format!("The laboratory is open until Ctrl-C: {address}\n"));
        let readable = "other users can read this output, so the address is in a file that only you can read";
        print_notes(file.is_some().then(|| readable.to_owned()));
        if !self.no_open
            && let Err(reason) = start_browser(&laboratory, link)
        {
            let note = format!("no browser was started, because {reason}: open {which} in a browser");
            print_notes([note]);
        }
        laboratory.serve(stopped(&signals)).map_err(Failure::running)
    }
}

impl LabCommand {
    /// Writes the laboratory as a folder or as one file.
    fn export(&self, start: &Start, module_folder: Option<&Path>) -> Result<(), Failure> {
        let folders = module_folder.map_or_else(places_of_module, |folder| vec![folder.to_owned()]);
        let module = find_module(&folders).map_err(Failure::input)?;
        let failed = |error| match error {
            ExportError::Write { .. } => Failure::running(error),
            error => Failure::input(error),
        };
        if let Some(out) = &self.export {
            export_folder(start, &module, NOTICES, out).map_err(failed)?;
            print_message(&format!(
                "The laboratory is written to {}: serve the folder with a web server, such as `python3 -m http.server`.\n",
                display_path(out)
            ));
        }
        if let Some(out) = &self.single {
            export_single(start, &module, NOTICES, out).map_err(failed)?;
            print_message(&format!(
                "The laboratory is written to {}: open it in a browser.\n",
                display_path(out)
            ));
        }
        Ok(())
    }
}

/// Folders that may contain the session as WebAssembly: the folder of this program, and the one above it
/// (`target/` in a checkout).
fn places_of_module() -> Vec<PathBuf> {
    let program = std::env::current_exe().and_then(|program| program.canonicalize());
    let program = program.unwrap_or_default();
    program.ancestors().skip(1).take(2).map(Path::to_owned).collect()
}

/// Opens a page in the browser that leads to the address. The address itself is not in the arguments, because
/// every user of the machine can read the arguments of a program.
fn start_browser(laboratory: &Laboratory, link: Option<&str>) -> Result<(), String> {
    if let Some(reason) = browser::hindrance() {
        return Err(reason);
    }
    let page = laboratory.start_page(link);
    let page = page.map_err(|error| format!("a page for it cannot be written ({error})"))?;
    open::that_detached(page).map_err(|_| "none could be found".to_owned())
}

/// Whether standard output is a file that other users can read.
fn others_read_output() -> bool {
    #[cfg(unix)]
    {
        use std::os::fd::AsFd;
        use std::os::unix::fs::MetadataExt;
        let output = std::io::stdout()
            .as_fd()
            .try_clone_to_owned()
            .map(std::fs::File::from);
        let output = output.and_then(|file| file.metadata());
        output.is_ok_and(|output| output.is_file() && output.mode() & 0o044 != 0)
    }
    #[cfg(not(unix))]
    false
}

/// Waits for the signal that ends the command.
async fn stopped(signals: &Signals) {
    /// Time between two checks; short enough for a waiting user.
    const LOOK: Duration = Duration::from_millis(50);
    while signals.stopped().is_none() {
        tokio::time::sleep(LOOK).await;
    }
}
