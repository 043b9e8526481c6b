//! `slipfront plot`: pictures again, from the files of runs.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use slipfront_case::case::PROGRAM;
use slipfront_case::disk::{is_same, read_limited, write_atomic};
use slipfront_case::machine::available_of;
use slipfront_case::number_format::byte_size;
use slipfront_plot::Picture;
use slipfront_run::friction_picture::{self, Against, Overlay, Units};
use slipfront_run::names::MANIFEST;
use slipfront_run::pictures;
use slipfront_run::run_folder::inspection::Inspection;
use slipfront_run::verify::{expect_as_written, inspect, is_study};

use crate::failure::Failure;
use crate::print::print_message;
use crate::threads::set_threads;

/// Draw the pictures of a run again, or the friction curves of one or several runs over each other, on axes of your choice
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront plot results/baseline
  slipfront plot results/circle results/groove_across -o results/overlay
  slipfront plot results/circle --units si --against displacement -o results/newtons")]
pub(crate) struct Plot {
    /// Run folders
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// Draw friction alone, in these units
    #[arg(long)]
    units: Option<UnitsName>,
    /// Draw friction alone, against this [default: time, or where runs of different materials can be compared]
    #[arg(long)]
    against: Option<AgainstName>,
    /// Folder for the pictures [default: the run's own; results/overlay for several and for friction alone]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace pictures that stand there
    #[arg(long)]
    force: bool,
}

/// Units of the axes.
#[derive(Clone, Copy, ValueEnum)]
enum UnitsName {
    /// Dimensionless
    Star,
    /// Newtons, and seconds or metres
    Si,
}

/// The horizontal axis.
#[derive(Clone, Copy, ValueEnum)]
enum AgainstName {
    /// Time
    Time,
    /// Path of the drive
    Displacement,
}

impl Plot {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        let mut runs = Vec::new();
        for folder in &self.folders {
            expect_results(folder)?;
            let run = inspect(folder).map_err(Failure::input)?;
            expect_as_written(&run, |name| pictures::DRAWN_FROM.contains(&name)).map_err(Failure::input)?;
            runs.push(run);
        }
        expect_memory(&self.folders)?;
        let (out, drawn) = match self.folders.as_slice() {
            [folder] if self.units.is_none() && self.against.is_none() => {
                (folder.clone(), pictures::draw(folder).map_err(Failure::input)?)
            }
            folders => {
                let units = match self.units {
                    None | Some(UnitsName::Star) => Units::Star,
                    Some(UnitsName::Si) => Units::Si,
                };
                let against = self.against.map(|name| match name {
                    AgainstName::Time => Against::Time,
                    AgainstName::Displacement => Against::Displacement,
                });
                let overlay = friction_picture::overlay(folders, units, against);
                let Overlay { picture, note } = overlay.map_err(Failure::input)?;
                if let Some(note) = note {
                    print_message(&format!("note: {note}\n"));
                }
                (PathBuf::from("results/overlay"), vec![("friction", picture)])
            }
        };
        let out = self.out.unwrap_or(out);
        let failed = |error: std::io::Error| {
            Failure::running(anyhow::anyhow!(
                "cannot write pictures to {}: {error}",
                out.display()
            ))
        };
        let files: Vec<(String, &[u8])> = drawn
            .iter()
            .flat_map(|(name, Picture { svg, png })| {
                [("svg", svg.as_bytes()), ("png", png)]
                    .map(|(ending, bytes)| (format!("{name}.{ending}"), bytes))
            })
            .collect();
        let own = match runs.as_slice() {
            [run] if is_same(&run.path, &out) => Some(run),
            _ => None,
        };
        if own.is_none() {
            refuse_other_run(&out)?;
        }
        if !self.force {
            refuse_to_replace(&out, &files, own)?;
        }
        std::fs::create_dir_all(&out).map_err(failed)?;
        let mut written = String::new();
        for (name, bytes) in files {
            let path = out.join(name);
            write_atomic(&path, bytes).map_err(failed)?;
            written += &format!("{}\n", path.display());
        }
        print_message(&written);
        Ok(())
    }
}

/// Refuses pictures for which there is no memory.
fn expect_memory(folders: &[PathBuf]) -> Result<(), Failure> {
    let needed = PROGRAM + pictures::memory(folders).map_err(Failure::input)?;
    let available = available_of(needed);
    if needed <= available {
        return Ok(());
    }
    Err(Failure::input(anyhow::anyhow!(
        "these pictures take about {} of memory where {} are available to this process: give it more, in a queue for \
         example with `--mem`",
        byte_size(needed),
        byte_size(available)
    )))
}

fn expect_results(folder: &Path) -> Result<(), Failure> {
    if folder.is_file() {
        return Err(Failure::input(anyhow::anyhow!(
            "{} is a file: plot takes folders of finished runs, whose series.csv it draws, and no other curves",
            folder.display()
        )));
    }
    let path = folder.join("summary.json");
    let sentence = match path.try_exists() {
        Ok(true) => return Ok(()),
        Ok(false) if is_study(folder) => format!(
            "{} is the folder of a study, which holds its pictures: plot takes folders of runs",
            folder.display()
        ),
        Ok(false) => format!(
            "{} holds no summary.json: name the folder of a run that is finished",
            folder.display()
        ),
        Err(error) => format!("cannot read {}: {error}", path.display()),
    };
    Err(Failure::input(anyhow::anyhow!(sentence)))
}

/// Refuses the folder of a run that these are not the pictures of.
fn refuse_other_run(out: &Path) -> Result<(), Failure> {
    let manifest = out.join(MANIFEST);
    let sentence = match manifest.try_exists() {
        Ok(false) => return Ok(()),
        Ok(true) => format!(
            "{} holds a run, and these are not its pictures: choose another folder with --out",
            out.display()
        ),
        Err(error) => format!("cannot read {}: {error}", manifest.display()),
    };
    Err(Failure::input(anyhow::anyhow!(sentence)))
}

/// Refuses to replace what stands where the pictures go, unless it is the same, or a picture that the run in the folder, if
/// they are `own` ones of it, has drawn there.
fn refuse_to_replace(out: &Path, files: &[(String, &[u8])], own: Option<&Inspection>) -> Result<(), Failure> {
    for (name, bytes) in files {
        let path = out.join(name);
        let is_same = || read_limited(&path, bytes.len() as u64).is_ok_and(|found| found == *bytes);
        if path.symlink_metadata().is_err() || is_same() {
            continue;
        }
        let what = match own
            .map(|run| run.has_written(name))
            .transpose()
            .map_err(Failure::input)?
        {
            Some(true) => continue,
            Some(false) => "is not as the run has drawn it",
            None => "exists",
        };
        let sentence = format!(
            "{} {what}: choose another folder with --out, or replace it with --force",
            path.display()
        );
        return Err(Failure::input(anyhow::anyhow!(sentence)));
    }
    Ok(())
}
