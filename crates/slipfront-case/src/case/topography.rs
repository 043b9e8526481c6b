//! Measured topography: which blocks of a height map touch.

use std::sync::Arc;

use slipfront::surface::Tile;

use super::inputs::{Inputs, Watch};
use crate::arrays::{self, ArrayError, Roughness, Slab, Units};
use crate::case_file::{Bearing, CaseError, CaseFile, HeightMap, Pitch};
use crate::quantity::Length;

/// A height map as it was read and laid over blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Topography {
    /// Position of its texture in the case file, from 0.
    pub texture: usize,
    /// The file, as the case file names it.
    pub file: String,
    /// Points of the file along x and along y.
    pub points: [usize; 2],
    /// Its true size along x and along y, m.
    pub size: [f64; 2],
    /// Blocks that it is laid over, along x and along y.
    pub blocks: [usize; 2],
    /// Roughness of all points.
    pub roughness: Roughness,
    /// The least height of a block that touches, m.
    pub contact_height: f64,
}

/// Reads the height map of a texture for `blocks` along x and y: which of them do not touch.
pub(super) fn read(
    file: &CaseFile,
    index: usize,
    map: &HeightMap,
    blocks: [usize; 2],
    inputs: &Inputs,
    watch: &mut Watch,
) -> Result<(Tile, Topography), CaseError> {
    let units = Units {
        height: map.height_unit.as_ref().map(Length::si),
        pixel: map.pixel_size.as_ref().map(|size| match size {
            Pitch::Equal(size) => [size.si(); 2],
            Pitch::Each(sizes) => [sizes[0].si(), sizes[1].si()],
        }),
    };
    let key = format!("texture.{index}.file");
    let read = inputs.read_height_map(file, &key, &map.file, |path, source| {
        arrays::height_map(path, source, &units, blocks, &mut |share| {
            watch(share).then_some(()).ok_or(ArrayError::Stopped)
        })
    })?;
    let contact_height = contact_height(&read.blocks, map);
    // Of a map that covers the slider, a rank needs its own rows.
    let slab = match blocks == [inputs.slab.nx, inputs.slab.ny] {
        true => inputs.slab.clone(),
        false => Slab::whole(blocks[0], blocks[1]),
    };
    let kept = &read.blocks[slab.rows.start * slab.nx..slab.rows.end * slab.nx];
    let textured: Vec<bool> = kept.iter().map(|height| *height < contact_height).collect();
    let tile = Tile {
        size: blocks,
        rows: slab.rows,
        blocks: Arc::new(textured),
    };
    let topography = Topography {
        texture: index,
        file: map.file.clone(),
        points: read.points,
        size: read.size,
        blocks,
        roughness: read.roughness,
        contact_height,
    };
    Ok((tile, topography))
}

/// The least height that touches, m. Of a share it is the height of a block, so that blocks of equal height all touch or none does.
fn contact_height(heights: &[f64], map: &HeightMap) -> f64 {
    match &map.bearing {
        Bearing::Percent(percent) => {
            let touching = (heights.len() as f64 * percent / 100.0).round() as usize;
            let mut heights = heights.to_vec();
            match touching.checked_sub(1) {
                Some(last) => *heights.select_nth_unstable_by(last, |a, b| b.total_cmp(a)).1,
                None => f64::INFINITY,
            }
        }
        Bearing::Depth(depth) => {
            let highest = || heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            map.reference.as_ref().map_or_else(highest, Length::si) - depth.si()
        }
    }
}
