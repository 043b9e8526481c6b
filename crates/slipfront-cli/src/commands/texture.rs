//! `slipfront texture`: the texture of a case as outlines, a picture, a height field or a solid.

use std::path::PathBuf;

use clap::Args;
use slipfront_base::disk::is_same;
use slipfront_case::quantity::Length;
use slipfront_case::texture_file::{self, Options};

use crate::case_args::CaseArgs;
use crate::failure::Failure;
use crate::print::print_message;
use crate::ranks::CommandRanks;
use crate::report::physics;
use crate::signals::Signals;
use crate::threads::set_threads;

/// Write the texture of a case to a drawing
///
/// Formats are outlines to scale (SVG, DXF), a picture with one pixel per block (PNG, textured blocks black),
/// a height field (GSF), or a solid with a face of blocks (STL, in millimetres)
#[derive(Args)]
#[command(after_help = "Examples:
  slipfront texture cases/circle.toml -o mask.png            a mask that a case can read
  slipfront texture cases/circle.toml -o large.png --scale 16      a picture to look at
  slipfront texture cases/hexagonal_dimples.toml -o dimples.dxf    for a laser, in millimetres
  slipfront texture cases/circle.toml --depth \"2 um\" -o face.stl         for other programs")]
pub(crate) struct TextureCommand {
    #[command(flatten)]
    case: CaseArgs,
    /// Output file: .svg, .dxf, .png, .gsf (Gwyddion simple field), or .stl
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Pixels per block side, for a picture [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    scale: Option<u16>,
    /// Depth of the texture, for a .stl, such as "20 um"
    #[arg(long, value_name = "LENGTH", value_parser = depth)]
    depth: Option<f64>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

impl TextureCommand {
    pub(crate) fn execute(self) -> Result<(), Failure> {
        set_threads(None)?;
        let signals = Signals::catch().map_err(Failure::running)?;
        let case = self.case.load(&CommandRanks::alone(), &signals, false)?;
        let input = case
            .inputs
            .iter()
            .find(|input| is_same(&input.original, &self.out));
        if let Some(input) = input {
            return Err(Failure::input(format!(
                "the texture would replace {}, an input of the case: choose another name",
                input.original.display()
            )));
        }
        // A broken link also counts as an existing file, although `exists` does not see it.
        if self.out.symlink_metadata().is_ok() && !self.force {
            return Err(Failure::input(format!(
                "{} exists: choose another name, or replace it with --force",
                self.out.display()
            )));
        }
        let smallest = texture_file::smallest(&case).map_err(Failure::input)?;
        let options = Options {
            scale: self.scale.map(usize::from),
            depth: self.depth,
        };
        let said =
            texture_file::write(&case, &self.out, options).map_err(|error| match error.is_input() {
                true => Failure::input(error),
                false => Failure::running(error),
            })?;
        let covered = if case.file.texture.is_empty() {
            "the case has no texture: every block is in contact".to_owned()
        } else {
            physics::texture(&case)
        };
        let covered = covered + &physics::smallest(&case, smallest, &said);
        print_message(&format!("{covered}\n{}\n", self.out.display()));
        Ok(())
    }
}

/// A depth in m: more than 0, and no more than a metre, so that a solid has numbers that STL can hold.
fn depth(text: &str) -> Result<f64, String> {
    let depth = text.parse::<Length>().map_err(|error| error.to_string())?.si();
    if (1e-12..=1.0).contains(&depth) {
        return Ok(depth);
    }
    Err(format!("a depth is 1 pm to 1 m, and not \"{text}\""))
}
