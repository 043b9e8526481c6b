//! `slipfront plot`: pictures again, from the files of runs.

use std::path::{Path, PathBuf};

use clap::Args;
use slipfront_case::disk::{is_same, write_atomic};
use slipfront_plot::Picture;
use slipfront_run::names::MANIFEST;
use slipfront_run::pictures;
use slipfront_run::verify::{expect_as_written, inspect, is_study};

use crate::failure::Failure;
use crate::print::print;

/// Draw the pictures of a run again, or the friction curves of several runs over each other
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront plot results/baseline
  slipfront plot results/circle results/groove_across -o results/overlay")]
pub(crate) struct Plot {
    /// Run folders
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
    /// Folder for the pictures [default: the run's own; results/overlay for several]
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace pictures that stand there
    #[arg(long)]
    force: bool,
}

impl Plot {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        for folder in &self.folders {
            expect_results(folder)?;
            inspect(folder)
                .and_then(|run| expect_as_written(&run, |name| pictures::DRAWN_FROM.contains(&name)))
                .map_err(Failure::input)?;
        }
        let (out, drawn) = match self.folders.as_slice() {
            [folder] => (folder.clone(), pictures::draw(folder).map_err(Failure::input)?),
            folders => {
                let friction = pictures::draw_friction(folders).map_err(Failure::input)?;
                (PathBuf::from("results/overlay"), vec![("friction", friction)])
            }
        };
        let out = self.out.unwrap_or(out);
        let failed = |error: std::io::Error| {
            Failure::running(anyhow::anyhow!(
                "cannot write pictures to {}: {error}",
                out.display()
            ))
        };
        let files: Vec<(PathBuf, &[u8])> = drawn
            .iter()
            .flat_map(|(name, Picture { svg, png })| {
                [("svg", svg.as_bytes()), ("png", png)]
                    .map(|(ending, bytes)| (out.join(format!("{name}.{ending}")), bytes))
            })
            .collect();
        let own = matches!(self.folders.as_slice(), [folder] if is_same(folder, &out));
        if !own {
            refuse_to_replace(&out, files.iter().map(|(path, _)| path), self.force)?;
        }
        std::fs::create_dir_all(&out).map_err(failed)?;
        let mut written = String::new();
        for (path, bytes) in files {
            write_atomic(&path, bytes).map_err(failed)?;
            written += &format!("{}\n", path.display());
        }
        print(&written)
    }
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

/// Refuses the folder of a run that these are not the pictures of, and pictures that are there already.
fn refuse_to_replace<'p>(
    out: &Path,
    mut files: impl Iterator<Item = &'p PathBuf>,
    force: bool,
) -> Result<(), Failure> {
    let manifest = out.join(MANIFEST);
    let holds_a_run = manifest
        .try_exists()
        .map_err(|error| Failure::input(anyhow::anyhow!("cannot read {}: {error}", manifest.display())))?;
    let sentence = if holds_a_run {
        format!(
            "{} holds a run, and these are not its pictures: choose another folder with --out",
            out.display()
        )
    } else if let Some(path) = files.find(|path| !force && path.symlink_metadata().is_ok()) {
        format!(
            "{} exists: choose another folder with --out, or replace it with --force",
            path.display()
        )
    } else {
        return Ok(());
    };
    Err(Failure::input(anyhow::anyhow!(sentence)))
}
