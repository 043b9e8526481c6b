//! `slipfront plot`: pictures again, from the files of runs.

use std::path::PathBuf;

use clap::Args;
use slipfront_case::folder::write_whole;
use slipfront_case::pictures::Picture;
use slipfront_case::results;
use slipfront_case::verify::expect_as_written;

use super::print;
use crate::failure::Failure;

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
}

impl Plot {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        for folder in &self.folders {
            expect_as_written(folder, &results::DRAWN_FROM).map_err(Failure::input)?;
        }
        let (out, drawn) = match self.folders.as_slice() {
            [folder] => (folder.clone(), results::draw(folder).map_err(Failure::input)?),
            folders => {
                let friction = results::draw_friction(folders).map_err(Failure::input)?;
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
        std::fs::create_dir_all(&out).map_err(failed)?;
        let mut written = String::new();
        for (name, Picture { svg, png }) in drawn {
            for (ending, bytes) in [("svg", svg.as_bytes()), ("png", &png)] {
                let path = out.join(format!("{name}.{ending}"));
                write_whole(&path, bytes).map_err(failed)?;
                written += &format!("{}\n", path.display());
            }
        }
        print(&written)
    }
}
