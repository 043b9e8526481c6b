//! Settings of pictures that a user can choose: their size, the formats of their files, and which of them are
//! drawn.

use crate::size::PictureSize;

/// Format of the file of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// SVG, with its font inside.
    Svg,
    /// PNG, 300 dots per inch.
    Png,
    /// PDF of one page, with its font inside; its text can be searched and selected.
    Pdf,
}

impl PictureFormat {
    /// Every format.
    pub const ALL: [Self; 3] = [Self::Svg, Self::Png, Self::Pdf];

    /// Ending of the names of files in this format, without the dot.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
        }
    }
}

/// Size of pictures, formats of their files, and the one picture of several that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureLook {
    /// Size of the pictures.
    pub size: PictureSize,
    /// Formats of the files.
    pub formats: Vec<PictureFormat>,
    /// Name of the only picture that is drawn; none for all.
    pub only: Option<String>,
}

impl Default for PictureLook {
    /// All pictures in their usual size, as SVG and PNG.
    fn default() -> Self {
        Self {
            size: PictureSize::default(),
            formats: vec![PictureFormat::Svg, PictureFormat::Png],
            only: None,
        }
    }
}

impl PictureLook {
    /// Whether the picture of this name is drawn.
    pub fn draws(&self, name: &str) -> bool {
        self.only.as_ref().is_none_or(|only| only == name)
    }
}
