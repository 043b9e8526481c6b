//! `slipfront texture`: the textured blocks of a case as a picture.

use std::path::PathBuf;

use clap::Args;
use slipfront_case::arrays;
use slipfront_case::arrays::ArrayError;
use slipfront_case::disk::is_same;

use crate::case_args::CaseArgs;
use crate::failure::Failure;
use crate::print::print_message;
use crate::ranks::Ranks;
use crate::report;
use crate::signals::Signals;
use crate::threads::set_threads;

/// Write the texture of a case as a mask: one pixel per block, textured ones black
#[derive(Args)]
#[command(after_help = "Example:
  slipfront texture cases/circle.toml -o mask.png")]
pub(crate) struct Texture {
    #[command(flatten)]
    case: CaseArgs,
    /// The picture to write
    #[arg(short, long, value_name = "MASK.png")]
    out: PathBuf,
    /// Replace the picture if it exists
    #[arg(long)]
    force: bool,
}

impl Texture {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        let signals = Signals::catch().map_err(Failure::running)?;
        let case = self.case.load(&Ranks::alone(), &signals, false)?;
        let input = case
            .inputs
            .iter()
            .find(|input| is_same(&input.original, &self.out));
        if let Some(input) = input {
            let sentence = format!(
                "the mask would replace {}, which the case reads: choose another name",
                input.original.display()
            );
            return Err(Failure::input(anyhow::anyhow!(sentence)));
        }
        // A broken link is a file of the user as well, and `exists` does not see it.
        if self.out.symlink_metadata().is_ok() && !self.force {
            let sentence = format!(
                "{} exists: choose another name, or replace it with --force",
                self.out.display()
            );
            return Err(Failure::input(anyhow::anyhow!(sentence)));
        }
        let lattice = &case.model.lattice;
        // What does not exist has no contact either, but is no texture.
        let (surface, slider) = (&case.model.surface, case.model.slider());
        let blocks = surface.textured.iter().enumerate();
        let textured: Vec<bool> = blocks
            .map(|(b, textured)| *textured && slider.exists(b))
            .collect();
        arrays::write_mask_png(&self.out, lattice.nx, lattice.ny, &textured).map_err(
            |error| match error {
                ArrayError::Extension { .. } => Failure::input(error),
                error => Failure::running(error),
            },
        )?;
        let covered = match case.file.texture.is_empty() {
            true => "the case has no texture: every pixel is white".to_owned(),
            false => report::texture(&case),
        };
        print_message(&format!("{covered}\n{}\n", self.out.display()));
        Ok(())
    }
}
