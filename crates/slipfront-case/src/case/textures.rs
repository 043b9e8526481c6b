//! Textures of a case file as shapes in blocks, laid over the lattice.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

use slipfront::surface::Tile;
use slipfront::{Lattice, Scales, surface};

use super::inputs::Inputs;
use super::model::TextureReport;
use super::slider::outline;
use super::topography::Ground;
use crate::arrays::{self, Slab};
use crate::case_file::{
    Arrangement, Blocks, CaseError, CaseFile, Count, FileUse, MAX_COUNT, Mask, Pattern, Pitch, Shape,
    ShapeSource, Texture,
};
use crate::quantity::Length;

/// The textured blocks of the rows of this rank, with the textures; masks and height maps are read.
/// `n_blocks` blocks exist.
pub(super) fn mesh(
    inputs: &mut Inputs,
    n_blocks: usize,
) -> Result<(surface::Meshed, TextureReport), CaseError> {
    let (textures, report) = shapes_in_blocks(inputs, n_blocks)?;
    let watch = &mut *inputs.watch;
    let mut watch = |share| watch(share).then_some(()).ok_or(CaseError::Stopped);
    let (lattice, rows) = (inputs.lattice, &inputs.slab.rows);
    let meshed = surface::mesh_watched(lattice, rows, &textures, &mut watch)?;
    Ok((meshed, report))
}

/// The textures in blocks, in the order of the file, and what their report says before they are meshed.
pub(super) fn shapes_in_blocks(
    inputs: &mut Inputs,
    n_blocks: usize,
) -> Result<(Vec<surface::Texture>, TextureReport), CaseError> {
    let (file, scales, lattice) = (inputs.file, inputs.scales, inputs.lattice);
    let mut textures = Vec::new();
    let mut report = TextureReport {
        asked_percent: Some(0.0),
        ..TextureReport::default()
    };
    let mut masks = Masks::default();
    let (mut steps, most_steps) = (0.0, STEPS + STEPS_PER_BLOCK * (lattice.nx * lattice.ny) as f64);
    // A height map covers all rows, so a rank must know which blocks exist in all of them.
    let exists = match count_height_maps(file) {
        0 => None,
        _ => outline(inputs, &Slab::whole(lattice.nx, lattice.ny))?,
    };
    for (index, texture) in file.texture.iter().enumerate() {
        let key = format!("texture.{index}");
        let refuse = |sentence: String| file.source.error(&key, sentence);
        let arrays = arrays(&texture.pattern, scales, lattice)
            .map_err(|(name, sentence)| file.source.error(&format!("{key}.{name}"), sentence))?;
        let blocks = Blocks {
            scales,
            lattice,
            n_blocks,
            arrays: &arrays,
        };
        let (shape, percent) = match texture.shape.source() {
            ShapeSource::Outline(outline) => outline.in_blocks(&blocks),
            ShapeSource::Mask(mask) => {
                let size = cell(&arrays, lattice).map_err(refuse)?;
                let tile = masks.read(inputs, index, mask, size)?;
                (surface::Shape::Tile(tile), None)
            }
            ShapeSource::HeightMap(map) => {
                let size = cell(&arrays, lattice).map_err(refuse)?;
                let ground = Ground {
                    blocks: &blocks,
                    exists: exists.as_deref(),
                    size,
                };
                let (tile, topography, percent) = ground.read(inputs, index, map)?;
                report.topographies.push(topography);
                (surface::Shape::Tile(tile), percent)
            }
            ShapeSource::Drawing(drawing) => {
                let key = format!("{key}.file");
                let block = scales.block_size * 1e3;
                let read = inputs.read(&key, &drawing.file, FileUse::Drawing, |path, source| {
                    arrays::drawing(path, source, block)
                })?;
                let notes = read.notes.iter();
                report
                    .notes
                    .extend(notes.map(|note| format!("{}: {note}", drawing.file)));
                (surface::Shape::Drawing(read.parts.into()), None)
            }
        };
        within_reach(&shape, &arrays, lattice).map_err(refuse)?;
        steps += meshing_steps(&shape, &arrays);
        if steps > most_steps {
            return Err(refuse(format!(
                "with this texture, outlines cross rows of blocks and masks cover blocks {steps:.1e} times, more than \
                 {most_steps:.1e}: reduce the number of copies, their size or their corners"
            )));
        }
        let inverted = texture.pattern.invert;
        textures.push(surface::Texture {
            shape,
            arrays,
            inverted,
        });
        let covered = |percent: f64| {
            if inverted {
                (100.0 - percent).max(0.0)
            } else {
                percent
            }
        };
        let asked = report.asked_percent.zip(percent);
        report.asked_percent = asked.map(|(sum, percent)| sum + covered(percent));
    }
    Ok((textures, report))
}

/// The textures with known outlines, in blocks: all but masks and height maps.
pub(super) fn outlines_in_blocks(
    file: &CaseFile,
    scales: &Scales,
    lattice: &Lattice,
    n_blocks: usize,
) -> Vec<surface::Texture> {
    let outline = |texture: &Texture| {
        let arrays = arrays(&texture.pattern, scales, lattice).ok()?;
        let (shape, _) = texture.shape.outline()?.in_blocks(&Blocks {
            scales,
            lattice,
            n_blocks,
            arrays: &arrays,
        });
        let inverted = texture.pattern.invert;
        Some(surface::Texture {
            shape,
            arrays,
            inverted,
        })
    };
    file.texture.iter().filter_map(outline).collect()
}

/// Pitch in blocks of the innermost array of a texture, and whether it is the only array and fills the
/// slider.
pub(super) fn pitch(texture: &Texture, scales: &Scales, lattice: &Lattice) -> Option<(f64, bool)> {
    let arrays = arrays(&texture.pattern, scales, lattice).ok()?;
    let array = arrays.last()?;
    // Copies of a groove are repeated along one axis only.
    let is_groove = matches!(texture.shape, Shape::Groove(_));
    let repeated = (0..2).filter(|&axis| array.count[axis] > 1);
    let pitch = repeated
        .clone()
        .map(|axis| array.spacing[axis])
        .reduce(f64::max)?;
    let sizes = [lattice.nx, lattice.ny];
    let is_filled = |axis: usize| array.spacing[axis] * (array.count[axis] + 1) as f64 > sizes[axis] as f64;
    let is_regular =
        arrays.len() == 1 && (0..2).all(|axis| is_filled(axis) && (array.count[axis] > 1 || is_groove));
    Some((pitch, is_regular))
}

/// Pitch in blocks of a texture that is a single array and fills the slider; none for other textures.
pub(super) fn regular_pitch(textures: &[Texture], scales: &Scales, lattice: &Lattice) -> Option<f64> {
    let [texture] = textures else { return None };
    let (pitch, is_regular) = pitch(texture, scales, lattice)?;
    is_regular.then_some(pitch)
}

/// The arrays of a pattern in blocks, the outermost first. The outermost covers the slider, and the next one
/// a place of it. An error consists of the key, within the texture, and the sentence.
pub(super) fn arrays(
    pattern: &Pattern,
    scales: &Scales,
    lattice: &Lattice,
) -> Result<Vec<surface::Array>, (String, String)> {
    let mut room = [lattice.nx as f64, lattice.ny as f64];
    let mut arrays: Vec<surface::Array> = Vec::new();
    for (before, array) in pattern.arrays().filter(|(_, array)| array.is_array()) {
        // Ratio of the row spacing of a hexagonal lattice to its pitch.
        let height = match array.lattice {
            Arrangement::Hexagonal => 0.75_f64.sqrt(),
            Arrangement::Square | Arrangement::Staggered => 1.0,
        };
        let spread = |count: [u32; 2]| {
            let [x, y] = [0, 1].map(|axis| room[axis] / f64::from(count[axis]));
            match array.lattice {
                Arrangement::Hexagonal => [x.min(y / height), (x * height).min(y)],
                Arrangement::Square | Arrangement::Staggered => [x, y],
            }
        };
        let spacing = match (&array.pitch, array.array) {
            (Some(Pitch::Equal(pitch)), _) => {
                let pitch = scales.in_blocks(pitch.si());
                [pitch, pitch * height]
            }
            (Some(Pitch::Each(pitch)), _) => in_blocks(scales, pitch),
            (None, Count::Of(count)) => spread(count),
            (None, Count::Auto) => room,
        };
        let count = match array.array {
            Count::Of(count) => count.map(|count| count as usize),
            // The margin prevents that rounding of a decimal number loses a copy.
            Count::Auto => [0, 1].map(|axis| ((room[axis] / spacing[axis] * (1.0 + 1e-9)) as usize).max(1)),
        };
        let before_it = |axis: usize| arrays.iter().map(|array| array.count[axis]).product::<usize>();
        for (axis, lines) in [(0, "columns"), (1, "rows")] {
            let total = before_it(axis).saturating_mul(count[axis]);
            if total as u64 > MAX_COUNT {
                let key = if array.array == Count::Auto {
                    "pitch"
                } else {
                    "array"
                };
                let sentence = format!(
                    "the pattern has {total} {lines}; at most {MAX_COUNT} are possible: increase the pitch, or reduce the \
                     number of copies"
                );
                return Err((format!("{before}{key}"), sentence));
            }
        }
        arrays.push(surface::Array {
            count,
            spacing,
            staggered: array.lattice != Arrangement::Square,
        });
        room = spacing;
    }
    Ok(arrays)
}

/// Size in blocks of a mask or height map: one place of the pattern, or the slider.
fn cell(arrays: &[surface::Array], lattice: &Lattice) -> Result<[usize; 2], String> {
    let slider = [lattice.nx, lattice.ny];
    let Some(array) = arrays.last() else {
        return Ok(slider);
    };
    let size = array.spacing.map(|spacing| (spacing.round() as usize).max(1));
    if size[0] > slider[0] || size[1] > slider[1] {
        return Err(format!(
            "{} x {} blocks in every place of the pattern are more than the {} x {} of the slider: reduce the pitch",
            size[0], size[1], slider[0], slider[1]
        ));
    }
    Ok(size)
}

/// Number of height maps of a case. Their heights are in memory one at a time.
fn count_height_maps(file: &CaseFile) -> usize {
    let shapes = file.texture.iter().map(|texture| &texture.shape);
    shapes
        .filter(|shape| matches!(shape, Shape::HeightMap(_)))
        .count()
}

/// Identity of a mask of a case: file, bits of the threshold, and blocks. Several textures may share one
/// mask.
type MaskKey<'a> = (&'a str, u64, [usize; 2]);

/// The masks that have been read.
#[derive(Default)]
struct Masks<'a>(HashMap<MaskKey<'a>, Tile>);

impl<'a> Masks<'a> {
    /// The mask of a texture, with this size in blocks.
    fn read(
        &mut self,
        inputs: &mut Inputs,
        index: usize,
        mask: &'a Mask,
        size: [usize; 2],
    ) -> Result<Tile, CaseError> {
        let entry = match self.0.entry((&mask.file, mask.threshold.to_bits(), size)) {
            Entry::Occupied(known) => return Ok(known.get().clone()),
            Entry::Vacant(entry) => entry,
        };
        let key = format!("texture.{index}.file");
        let [nx, ny] = size;
        // If a mask covers the slider, a rank needs only its own rows.
        let slab = if (nx, ny) == (inputs.slab.nx, inputs.slab.ny) {
            inputs.slab.clone()
        } else {
            Slab::whole(nx, ny)
        };
        let blocks = inputs.read_mask(&key, &mask.file, mask.threshold, &slab)?;
        let tile = Tile {
            size,
            rows: slab.rows,
            blocks: Arc::new(blocks),
        };
        Ok(entry.insert(tile).clone())
    }
}

/// Largest extent of a texture, in slider lengths. A texture farther away is a typing error, and on a
/// periodic axis its position would be lost to rounding.
const REACH: f64 = 100.0;

fn within_reach(shape: &surface::Shape, arrays: &[surface::Array], lattice: &Lattice) -> Result<(), String> {
    let side = |array: &surface::Array, axis: usize| (array.count[axis] as f64 * array.spacing[axis]).abs();
    let sides = arrays.iter().map(|array| side(array, 0).max(side(array, 1)));
    let reach = shape.reach() + 0.5 * sides.sum::<f64>();
    let slider = lattice.nx.max(lattice.ny) as f64;
    if reach <= REACH * slider {
        return Ok(());
    }
    Err(format!(
        "the texture extends over {reach:.1e} blocks, more than {REACH} times the {slider} blocks of the slider: check its \
         units, and `slider.block_size`"
    ))
}

/// Largest number of steps in which the textures of a small slider are meshed: half a minute where outlines
/// cross each row many times, else a second.
const STEPS: f64 = 1e9;
/// Number of steps by which it grows with each block: a hundred textures may cover a large slider.
const STEPS_PER_BLOCK: f64 = 100.0;

/// Number of steps in which a texture is meshed: crossings of outlines with rows of blocks, corners for each
/// row of copies, blocks of masks.
fn meshing_steps(shape: &surface::Shape, arrays: &[surface::Array]) -> f64 {
    let of_copy = match shape {
        surface::Shape::Polygon(points) => {
            let next = points.iter().cycle().skip(1);
            points.iter().zip(next).map(|(p, q)| (q[1] - p[1]).abs()).sum()
        }
        surface::Shape::Drawing(parts) => {
            let rings = parts.iter().flat_map(|part| &part.rings);
            let sides = rings.flat_map(|ring| ring.windows(2));
            sides.map(|side| (side[1][1] - side[0][1]).abs()).sum()
        }
        surface::Shape::Tile(tile) => (tile.size[0] * tile.size[1]) as f64,
        surface::Shape::Cavity(_) | surface::Shape::Groove(_) => 4.0 * shape.reach(),
    };
    let rows: usize = arrays.iter().map(|array| array.count[1]).product();
    shape.n_copies(arrays) as f64 * of_copy + (rows * shape.n_corners()) as f64
}

fn in_blocks(scales: &Scales, [x, y]: &[Length; 2]) -> [f64; 2] {
    [scales.in_blocks(x.si()), scales.in_blocks(y.si())]
}
