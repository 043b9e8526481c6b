//! The texture of a case as a drawing.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use slipfront_case::texture_file::{self, Options};

use crate::document::Document;
use crate::protocol::{DrawingFormat, DrawingReply};
use crate::sentence::sentence;

/// Draws the outlines of the texture to scale.
///
/// # Errors
/// A sentence, if the case has no texture, or it cannot be drawn.
pub(super) fn draw(
    document: &Document,
    format: DrawingFormat,
    stop: &AtomicBool,
) -> Result<DrawingReply, String> {
    if !document.has_texture() {
        return Err("the case has no texture to be drawn: paint one, or choose a case with one".to_owned());
    }
    let case = document.case_unless(stop)?;
    let name = match format {
        DrawingFormat::Dxf => "texture.dxf",
        DrawingFormat::Svg => "texture.svg",
    };
    let drawn = texture_file::contents(&case, Path::new(name), Options::default());
    let (bytes, notes) = drawn.map_err(sentence)?;
    Ok(DrawingReply {
        format,
        text: String::from_utf8_lossy(&bytes).into_owned(),
        notes,
    })
}
