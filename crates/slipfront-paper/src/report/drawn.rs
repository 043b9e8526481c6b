//! The pictures of a figure, drawn.

use rayon::prelude::*;

use crate::error::PaperError;
use crate::figure_data::FigureData;
use slipfront_plot::Picture;

/// A drawn picture with its name and caption.
pub(super) struct Drawn {
    pub(super) name: String,
    pub(super) caption: String,
    pub(super) picture: Picture,
}

/// Draws the pictures of a figure.
pub(super) fn draw(data: &FigureData) -> Result<Vec<Drawn>, PaperError> {
    let panels = data.panels.par_iter().map(|panel| {
        let picture = panel.drawing.draw().map_err(|source| PaperError::Picture {
            name: panel.name.clone(),
            source,
        })?;
        Ok(Drawn {
            name: panel.name.clone(),
            caption: panel.caption.clone(),
            picture,
        })
    });
    panels.collect()
}
