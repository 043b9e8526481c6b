//! A texture while it is painted: a separate layer in addition to the shapes, which stay unchanged.

use slipfront::surface::mesh;
use slipfront_case::case::Case;

use super::brush::stroke;
use crate::document::Document;
use crate::sentence::sentence;

/// The painted layer of a case, block by block, before it becomes part of the case.
pub(super) struct Painting {
    /// The gesture with which the page paints.
    pub(super) gesture: u64,
    /// Index of the layer among the textures; none for a new layer after them.
    index: Option<usize>,
    /// The painted blocks.
    layer: Vec<bool>,
    /// Blocks that other textures cover; none once all textures were merged into the layer.
    others: Option<Vec<bool>>,
}

impl Painting {
    /// Begins with the painted layer of a document, from which `case` is made; with a new layer if the
    /// document has none.
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
                let mut textures = case.textures_in_blocks().map_err(sentence)?;
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

    /// Paints the blocks within `radius` of the line through `points`, or brings them into contact. If such a
    /// contact lies inside a shape, all textures are merged into the layer, because no texture can remove
    /// part of another one. Lengths are in blocks.
    ///
    /// # Errors
    /// A sentence, if the stroke is invalid.
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

    /// The document with the layer as painted up to now, with `columns` blocks along x.
    ///
    /// # Errors
    /// A sentence, if the image of the layer cannot be written.
    pub(super) fn document(&self, document: &Document, columns: usize) -> Result<Document, String> {
        let made = if self.others.is_none() {
            document.with_mask(&self.layer, columns)
        } else {
            document.with_layer(self.index, &self.layer, columns)
        };
        made.map_err(sentence)
    }
}
