//! Options on the look of pictures: their size, their file formats, and the choice of pictures.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use slipfront_case::nearest::nearest;
use slipfront_plot::{PictureFormat, PictureLook, PictureSize};

use crate::bounds::within;
use crate::failure::Failure;

/// The look of pictures.
#[derive(Args)]
pub(super) struct LookArgs {
    /// Width of the pictures in mm [default: 85 for curves, maps over two axes and bars, at most 175 for maps
    /// of the slider]
    #[arg(long, value_name = "MM", value_parser = millimetres)]
    width: Option<f64>,
    /// Height of the pictures in mm; for maps of the slider it follows from the width
    #[arg(long, value_name = "MM", value_parser = millimetres)]
    height: Option<f64>,
    /// Font size of titles, numbers and legends in pt [default: 7.92]. Subscripts have 0.72 of this size;
    /// titles and numbers that are too long for their axis or cell have seven eighths. Lines and marks scale
    /// with the font
    #[arg(long, value_name = "PT", value_parser = points)]
    font_size: Option<f64>,
    /// File formats, such as pdf or svg,png. PDF files contain their font. For EPS, convert the PDF: pdftops
    /// -eps -r 1200 NAME.pdf
    #[arg(
        long = "format",
        value_name = "FORMAT",
        value_delimiter = ',',
        default_value = "svg,png",
        value_parser = PossibleValuesParser::new(PictureFormat::ALL.map(PictureFormat::ending)).try_map(format_named)
    )]
    formats: Vec<PictureFormat>,
    /// Draw only this picture, given by its file name without extension
    #[arg(long, value_name = "NAME", conflicts_with = "field")]
    picture: Option<String>,
}

/// The format of files with this ending.
fn format_named(ending: String) -> Result<PictureFormat, String> {
    let mut all = PictureFormat::ALL.into_iter();
    all.find(|format| format.ending() == ending).ok_or(ending)
}

/// Parses the side of a picture in mm.
fn millimetres(text: &str) -> Result<f64, String> {
    within(text, 20.0, PictureSize::MAX_MM, "mm")
}

/// Parses a font size in pt.
fn points(text: &str) -> Result<f64, String> {
    within(text, 3.0, 40.0, "pt")
}

impl LookArgs {
    pub(super) fn size(&self) -> PictureSize {
        PictureSize {
            width_mm: self.width,
            height_mm: self.height,
            font_pt: self.font_size,
        }
    }

    pub(super) fn look(&self) -> PictureLook {
        PictureLook {
            size: self.size(),
            formats: self.formats.clone(),
            only: self.picture.clone(),
        }
    }

    /// Name of the only picture to draw, if one was requested.
    pub(super) fn picture(&self) -> Option<&str> {
        self.picture.as_deref()
    }

    /// Refuses a requested picture that is not among these.
    pub(super) fn expect_one_of(&self, names: &[&str]) -> Result<(), Failure> {
        let Some(asked) = self.picture().filter(|asked| !names.contains(asked)) else {
            return Ok(());
        };
        let near = match nearest(asked, names) {
            Some(near) => format!(": did you mean {near}? The name"),
            None => ": the name".to_owned(),
        };
        let shown = names.iter().take(MOST_NAMES).copied();
        let more =
            (names.len() > MOST_NAMES).then(|| format!("or one of {} others", names.len() - MOST_NAMES));
        let list: Vec<String> = shown.map(str::to_owned).chain(more).collect();
        Err(Failure::input(format!(
            "there is no picture {asked}{near} can be {}",
            list.join(", ")
        )))
    }
}

/// Largest number of names of pictures that a message lists.
const MOST_NAMES: usize = 20;
