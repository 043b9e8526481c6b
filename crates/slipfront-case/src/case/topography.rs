//! Measured topography: the blocks of a height map that are in contact.

use std::sync::Arc;

use slipfront::surface::{Tile, n_copies};
use slipfront::{Edges, Lattice};

use super::inputs::Inputs;
use crate::arrays::{self, HeightMapUnits, Preparation, Room, Roughness, Slab};
use crate::case_file::{Bearing, Blocks, CaseError, FileUse, HeightMap, Level, Missing, Pitch};
use crate::quantity::Length;
use crate::table::TableOptions;

/// A height map, read and laid over blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Topography {
    /// Position of its texture in the case file, from 0.
    pub texture: usize,
    /// The file, as the case file names it.
    pub file: String,
    /// Points of the file along x and along y.
    pub points: [usize; 2],
    /// True size of the map along x and along y, m.
    pub size: [f64; 2],
    /// Blocks that the map covers, along x and along y.
    pub blocks: [usize; 2],
    /// Roughness of all points.
    pub roughness: Roughness,
    /// Smallest height of a block in contact, m.
    pub contact_height: f64,
    /// Sentences on doubtful features of the map.
    pub notes: Vec<String>,
}

/// Blocks that a height map covers.
pub(super) struct Ground<'a> {
    pub(super) blocks: &'a Blocks<'a>,
    /// Marks of the existing blocks of the whole lattice; none without an outline, because then all exist.
    pub(super) exists: Option<&'a [bool]>,
    /// Blocks of the map along x and along y.
    pub(super) size: [usize; 2],
}

impl Ground<'_> {
    /// Reads the height map of a texture: the blocks that do not touch, and their requested area, % of the
    /// area of the blocks that exist.
    pub(super) fn read(
        &self,
        inputs: &mut Inputs,
        index: usize,
        map: &HeightMap,
    ) -> Result<(Tile, Topography, Option<f64>), CaseError> {
        let units = HeightMapUnits {
            height: map.height_unit.as_ref().map(Length::si),
            pixel: map.pixel_size.as_ref().map(|size| match size {
                Pitch::Equal(size) => [size.si(); 2],
                Pitch::Each(sizes) => [sizes[0].si(), sizes[1].si()],
            }),
        };
        let room = Room {
            blocks: self.size,
            is_place: !self.blocks.arrays.is_empty(),
        };
        let preparation = Preparation {
            missing: map.missing.map(Missing::value),
            is_levelled: map.level == Some(Level::Plane),
            table: TableOptions::stated(None, map.decimal, map.separator),
        };
        let key = format!("texture.{index}.file");
        let read = inputs.read(&key, &map.file, FileUse::HeightMap, |path, source| {
            arrays::height_map(path, source, &units, &preparation, &room)
        })?;
        let mut existing = self.heights_of_existing_blocks(&read.blocks);
        let asked = match map.bearing {
            Bearing::Percent(percent) => {
                let laid = match self.exists {
                    Some(_) => existing.len(),
                    None => n_copies(self.blocks.arrays) * existing.len(),
                };
                Some((100.0 - percent) * laid as f64 / self.blocks.n_blocks as f64)
            }
            Bearing::Depth(_) => None,
        };
        let contact_height = contact_height(&mut existing, map).ok_or_else(|| {
            let sentence =
                "its pattern covers no block of the slider: change its `pitch` or `array`, or the outline";
            inputs.file.source.error(&key, sentence)
        })?;
        let touching = existing.iter().filter(|height| **height >= contact_height);
        let mut notes = read.notes;
        if touching.take(2).count() == 1 && existing.len() > 1 {
            notes.push("only its highest block is in contact and carries the whole load".to_owned());
        }
        // If a map covers the slider, a rank needs only its own rows.
        let slab = if self.size == [inputs.slab.nx, inputs.slab.ny] {
            inputs.slab.clone()
        } else {
            Slab::whole(self.size[0], self.size[1])
        };
        let kept = &read.blocks[slab.rows.start * slab.nx..slab.rows.end * slab.nx];
        let textured: Vec<bool> = kept.iter().map(|height| *height < contact_height).collect();
        let tile = Tile {
            size: self.size,
            rows: slab.rows,
            blocks: Arc::new(textured),
        };
        let topography = Topography {
            texture: index,
            file: map.file.clone(),
            points: read.points,
            size: read.size,
            blocks: self.size,
            roughness: read.roughness,
            contact_height,
            notes,
        };
        Ok((tile, topography, asked))
    }

    /// Heights of the blocks that exist; with an outline, for every copy.
    fn heights_of_existing_blocks(&self, heights: &[f64]) -> Vec<f64> {
        let Some(exists) = self.exists else {
            return heights.to_vec();
        };
        let Lattice { nx, ny, edges } = *self.blocks.lattice;
        // A lattice coordinate. On a periodic axis, coordinates continue beyond the edges.
        let within = |at: isize, axis: usize| -> Option<usize> {
            let size = [nx, ny][axis] as isize;
            match edges[axis] {
                Edges::Periodic => Some(at.rem_euclid(size) as usize),
                Edges::Free => (0..size).contains(&at).then_some(at as usize),
            }
        };
        let mut existing = Vec::new();
        for [left, bottom] in Tile::starts(self.blocks.lattice, self.size, self.blocks.arrays) {
            for (row, heights) in (bottom..).zip(heights.chunks_exact(self.size[0])) {
                let Some(row) = within(row, 1) else { continue };
                let exists = &exists[row * nx..][..nx];
                let columns = (left..).zip(heights);
                let stands = |column: isize| within(column, 0).is_some_and(|column| exists[column]);
                existing.extend(
                    columns
                        .filter(|(column, _)| stands(*column))
                        .map(|(_, height)| *height),
                );
            }
        }
        existing
    }
}

/// Smallest height, m, of the blocks in contact; none if there is no block. At least one block is in contact.
/// A share is converted to the height of a block, so that blocks of equal height all touch or all do not.
fn contact_height(heights: &mut [f64], map: &HeightMap) -> Option<f64> {
    let highest = heights.iter().copied().reduce(f64::max)?;
    Some(match &map.bearing {
        Bearing::Percent(percent) => {
            let touching = (heights.len() as f64 * percent / 100.0).round().max(1.0) as usize;
            *heights
                .select_nth_unstable_by(touching - 1, |a, b| b.total_cmp(a))
                .1
        }
        Bearing::Depth(depth) => map.reference.as_ref().map_or(highest, Length::si) - depth.si(),
    })
}
