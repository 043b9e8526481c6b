//! Outlines of the textures, drawn over the field.

use std::f64::consts::TAU;

use serde::Serialize;
use slipfront::surface::{Contour, Ellipse, Piece, clip, contours};
use slipfront_case::case::Case;

/// The outlines of one texture, in blocks.
#[derive(Debug, Serialize)]
pub(crate) struct ShapeOutlines {
    /// The place of the texture among all textures, from 0.
    index: usize,
    outlines: Vec<Vec<[f64; 2]>>,
}

/// Largest number of outlines of all textures; further textures are visible only in the field itself.
const MAX_OUTLINES: usize = 2000;

/// Largest number of corners of all copies of a texture, whether they lie on the slider or not.
const MAX_CORNERS: usize = 1 << 22;

/// Number of points on an ellipse.
const POINTS: usize = 72;

/// Outlines of the textures of a case that have one.
pub(crate) fn outlines(case: &Case) -> Vec<ShapeOutlines> {
    // Images alone are not read again, because this function runs at every stroke of a brush.
    if !case
        .file
        .texture
        .iter()
        .any(|texture| texture.shape.has_outline())
    {
        return Vec::new();
    }
    // A mask that cannot be read any more has no outline either.
    let textures = case.textures_in_blocks().unwrap_or_default();
    let lattice = &case.model.lattice;
    let slider = [Contour::rectangle(
        [0.0; 2],
        [lattice.nx, lattice.ny].map(|blocks| blocks as f64),
    )];
    let mut left = MAX_OUTLINES;
    let drawn = textures.iter().enumerate().filter_map(|(index, texture)| {
        let shape = &texture.shape;
        if shape.n_copies(&texture.arrays).saturating_mul(shape.n_corners()) > MAX_CORNERS {
            return None;
        }
        let shapes = contours(lattice, texture)?;
        let contours: Vec<Contour> = shapes.iter().flat_map(|shape| clip(shape, &slider)).collect();
        left = left.checked_sub(contours.len())?;
        let outlines = contours.iter().map(points).collect();
        Some(ShapeOutlines { index, outlines })
    });
    drawn.collect()
}

fn points(contour: &Contour) -> Vec<[f64; 2]> {
    match contour {
        Contour::Ellipse(ellipse) => arc(ellipse, [0.0, TAU]),
        Contour::Polygon(corners) => corners.clone(),
        Contour::Pieces(pieces) => {
            let of_piece = |piece: &Piece| match piece {
                Piece::Line([from, _]) => vec![*from],
                Piece::Arc(ellipse, ends) => arc(ellipse, *ends),
            };
            pieces.iter().flat_map(of_piece).collect()
        }
    }
}

/// Points of an ellipse between two parameters.
fn arc(ellipse: &Ellipse, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let count = (((to - from) / TAU * POINTS as f64).ceil() as usize).max(1);
    let at = |k| ellipse.at(from + (to - from) * k as f64 / count as f64);
    (0..count).map(at).collect()
}

#[cfg(test)]
mod tests {
    use crate::document::Document;

    use super::*;

    /// A shape of five corners is drawn in a thousand copies, and not in a million.
    #[test]
    fn outlines_of_many_copies_are_not_made() {
        for (rows, drawn) in [(1, 1), (1000, 0)] {
            let text = format!(
                "slider.blocks = [30, 30]\ntexture = [{{ shape = 'polygon', array = [1000, {rows}], pitch = '1 nm', \
                 points = [{}] }}]",
                "['1 um', '1 um'], ['2 um', '1 um'], ['2 um', '2 um'], ['1 um', '2 um'], ['1 um', '1.5 um']"
            );
            let document = Document::new("case", &text, |_| Err("there is none".to_owned())).unwrap();
            let case = document.case(&mut |_| true).unwrap();
            assert_eq!(outlines(&case).len(), drawn);
        }
    }
}
