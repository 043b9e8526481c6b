//! A texture while it is painted: a layer of its own beside the shapes, which stay what they are.

use slipfront::surface::mesh;
use slipfront_case::case::Case;

use super::brush::stroke;
use crate::document::Document;

/// The painted layer of a case, block by block, before it is made part of the case.
pub(super) struct Painting {
    /// The gesture by which the page paints.
    pub(super) gesture: u64,
    /// The place of the layer among the textures; none if it is to be a new one behind them.
    index: Option<usize>,
    /// Blocks that are painted.
    layer: Vec<bool>,
    /// Blocks that other textures cover; none once all textures have become the layer.
    others: Option<Vec<bool>>,
}

impl Painting {
    /// The layer of a document, of which `case` is made; a new layer if the document has none.
    ///
    /// # Errors
    /// A sentence, if a file of a texture cannot be read any more.
    pub(super) fn begin(document: &Document, case: &Case, gesture: u64) -> Result<Self, String> {
        let model = &case.model;
        let index = document.painted_layer();
        let (layer, others) = match index {
            None => (
                vec![false; model.lattice.n_blocks()],
                model.surface.textured.clone(),
            ),
            Some(index) => {
                let mut textures = case.textures_in_blocks().map_err(|error| error.to_string())?;
                let layer = textures.remove(index);
                let blocks_of = |textures: &[_]| mesh(&model.lattice, textures).textured;
                (blocks_of(&[layer]), blocks_of(&textures))
            }
        };
        Ok(Self {
            gesture,
            index,
            layer,
            others: Some(others),
        })
    }

    /// Paints the blocks within `radius` of the line through `points`, or brings them into contact. Where
    /// these lie in a shape, all textures become the layer, since no texture takes another one away. Lengths
    /// are in blocks.
    ///
    /// # Errors
    /// A sentence, if there is no such stroke.
    pub(super) fn stroke(
        &mut self,
        case: &Case,
        points: &[[f64; 2]],
        radius: f64,
        textured: bool,
    ) -> Result<(), String> {
        let mut stroked = vec![false; self.layer.len()];
        stroke(&mut stroked, &case.model.lattice, points, radius, true)?;
        let takes_away = |others: &&mut Vec<bool>| {
            !textured
                && stroked
                    .iter()
                    .zip(&***others)
                    .any(|(stroked, other)| *stroked && *other)
        };
        if let Some(others) = self.others.as_mut().filter(takes_away) {
            for (painted, other) in self.layer.iter_mut().zip(&*others) {
                *painted |= other;
            }
            self.others = None;
        }
        let painted = self
            .layer
            .iter_mut()
            .zip(&stroked)
            .filter(|(_, stroked)| **stroked);
        painted.for_each(|(painted, _)| *painted = textured);
        Ok(())
    }

    /// The document with the layer as it is painted now, which has so many columns.
    ///
    /// # Errors
    /// A sentence, if the image of the layer cannot be written.
    pub(super) fn document(&self, document: &Document, columns: usize) -> Result<Document, String> {
        let made = if self.others.is_none() {
            document.with_mask(&self.layer, columns)
        } else {
            document.with_layer(self.index, &self.layer, columns)
        };
        made.map_err(|error| error.to_string())
    }
}
