//! Textures of a case file as shapes in blocks, laid over them.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use slipfront::{Lattice, Scales, surface};

use super::inputs::Inputs;
use crate::arrays::ArrayError;
use crate::case_file::{CaseError, CaseFile, Mask};
use crate::quantity::Length;
use crate::{arrays, case_file};

/// Told the share that is done of laying the texture over the blocks; `false` ends it.
pub type Watch<'a> = dyn FnMut(f64) -> bool + 'a;

/// The textured blocks of the rows that this rank holds, and the area of all textures as asked for, % of that of the `n_blocks` that
/// exist (see [`TextureReport`](super::runnable::TextureReport)); masks are read.
pub(super) fn mesh(
    file: &CaseFile,
    scales: &Scales,
    lattice: &Lattice,
    n_blocks: usize,
    inputs: &Inputs,
    watch: &mut Watch,
) -> Result<(surface::Meshed, Option<f64>), CaseError> {
    let mut shapes = Vec::new();
    let mut asked = Some(0.0);
    let mut masks = Masks::default();
    for (index, texture) in file.texture.iter().enumerate() {
        let (shape, percent) = match texture {
            case_file::Texture::Cavity(cavity) => cavity_in_blocks(cavity, scales, lattice, n_blocks),
            case_file::Texture::Groove(groove) => groove_in_blocks(groove, scales, lattice, n_blocks),
            case_file::Texture::Polygon(polygon) => {
                let points = polygon.points.iter().map(|point| in_blocks(scales, point));
                (surface::Texture::Polygon(points.collect()), None)
            }
            case_file::Texture::Mask(mask) => {
                let blocks = masks.read(file, index, mask, inputs, watch)?;
                (surface::Texture::Blocks(blocks), None)
            }
        };
        within_reach(&shape, lattice)
            .map_err(|sentence| file.source.error(&format!("texture.{index}"), sentence))?;
        shapes.push(shape);
        asked = asked.zip(percent).map(|(sum, percent)| sum + percent);
    }
    let mut watch = |share| watch(share).then_some(()).ok_or(CaseError::Stopped);
    let meshed = surface::mesh_watched(lattice, &inputs.slab.rows, &shapes, &mut watch)?;
    Ok((meshed, asked))
}

/// What tells the masks of a case apart: file, and bits of the threshold. Several textures may have one.
type MaskKey<'a> = (&'a str, u64);

fn key_of(mask: &Mask) -> MaskKey<'_> {
    (&mask.file, mask.threshold.to_bits())
}

/// How many masks a case has in memory at once.
pub(super) fn count_masks(file: &CaseFile) -> usize {
    let masks = file.texture.iter().filter_map(|texture| match texture {
        case_file::Texture::Mask(mask) => Some(key_of(mask)),
        _ => None,
    });
    masks.collect::<HashSet<_>>().len()
}

/// The masks that have been read.
#[derive(Default)]
struct Masks<'a>(HashMap<MaskKey<'a>, Arc<Vec<bool>>>);

impl<'a> Masks<'a> {
    /// The mask of a texture.
    fn read(
        &mut self,
        file: &CaseFile,
        index: usize,
        mask: &'a Mask,
        inputs: &Inputs,
        watch: &mut Watch,
    ) -> Result<Arc<Vec<bool>>, CaseError> {
        let entry = match self.0.entry(key_of(mask)) {
            Entry::Occupied(known) => return Ok(Arc::clone(known.get())),
            Entry::Vacant(entry) => entry,
        };
        let key = format!("texture.{index}.file");
        let read = read_mask(file, &key, &mask.file, mask.threshold, inputs, watch)?;
        Ok(Arc::clone(entry.insert(Arc::new(read))))
    }
}

/// Reads an image or array of this name, which `key` gives it: whether each block is dark, or 1.
pub(super) fn read_mask(
    file: &CaseFile,
    key: &str,
    name: &str,
    threshold: f64,
    inputs: &Inputs,
    watch: &mut Watch,
) -> Result<Vec<bool>, CaseError> {
    inputs.read(file, key, name, |path, source, slab| match is_array(path) {
        true => arrays::mask_npy(path, source, slab),
        false => arrays::mask_png(path, source, threshold, slab, &mut |share| {
            watch(share).then_some(()).ok_or(ArrayError::Stopped)
        }),
    })
}

/// How far a texture may reach, in slider lengths. Farther away it is a typing error, and on a periodic axis its position
/// would be lost to rounding.
const REACH: f64 = 100.0;

fn within_reach(shape: &surface::Texture, lattice: &Lattice) -> Result<(), String> {
    let farthest = |lengths: &[f64]| lengths.iter().copied().map(f64::abs).fold(0.0, f64::max);
    let reach = match shape {
        surface::Texture::Cavity(cavity) => farthest(&cavity.center) + 2.0 * cavity.lambda,
        surface::Texture::Groove(groove) => groove.offset.abs() + groove.width,
        surface::Texture::Polygon(points) => farthest(points.as_flattened()),
        surface::Texture::Blocks(_) => 0.0,
    };
    let slider = lattice.nx.max(lattice.ny) as f64;
    if reach <= REACH * slider {
        return Ok(());
    }
    Err(format!(
        "the texture reaches {reach:.1e} blocks far, more than {REACH} times the slider's {slider} blocks: look at its \
         units, and at `slider.block_size`"
    ))
}

fn in_blocks(scales: &Scales, [x, y]: &[Length; 2]) -> [f64; 2] {
    [scales.in_blocks(x.si()), scales.in_blocks(y.si())]
}

fn cavity_in_blocks(
    cavity: &case_file::Cavity,
    scales: &Scales,
    lattice: &Lattice,
    n_blocks: usize,
) -> (surface::Texture, Option<f64>) {
    let array = cavity.array.map(|count| count as usize);
    let count = array[0] * array[1];
    let (s, w) = (cavity.s, cavity.w);
    let (lambda, percent) = match &cavity.size {
        case_file::CavitySize::Coverage(percent) => {
            (surface::cavity_lambda(*percent, n_blocks, s, w, count), *percent)
        }
        case_file::CavitySize::Lambda(lambda) => {
            let lambda = scales.in_blocks(lambda.si());
            (lambda, surface::cavity_percent(lambda, n_blocks, s, w, count))
        }
    };
    let center = match &cavity.center {
        case_file::Center::Middle => [0.5 * lattice.nx as f64, 0.5 * lattice.ny as f64],
        case_file::Center::At(center) => in_blocks(scales, center),
    };
    let cavity = surface::Cavity {
        center,
        lambda,
        s,
        w,
        across: cavity.across,
        rotate: cavity.rotate,
        array,
    };
    (surface::Texture::Cavity(cavity), Some(percent))
}

fn groove_in_blocks(
    groove: &case_file::Groove,
    scales: &Scales,
    lattice: &Lattice,
    n_blocks: usize,
) -> (surface::Texture, Option<f64>) {
    // A groove is as long as the lattice: the share of it that the slider fills is that of its area.
    let share = n_blocks as f64 / lattice.n_blocks() as f64;
    let breadth = match groove.orientation {
        surface::Orientation::Across => lattice.nx as f64 * share,
        surface::Orientation::Along => lattice.ny as f64 * share,
    };
    let (width, percent) = match &groove.size {
        case_file::GrooveSize::Coverage(percent) => (breadth * percent / 100.0, *percent),
        case_file::GrooveSize::Width(width) => {
            let width = scales.in_blocks(width.si());
            (width, 100.0 * width / breadth)
        }
    };
    let groove = surface::Groove {
        orientation: groove.orientation,
        width,
        offset: scales.in_blocks(groove.offset.si()),
    };
    (surface::Texture::Groove(groove), Some(percent))
}

/// Whether the file of a mask is an array, and not an image.
pub(super) fn is_array(path: &Path) -> bool {
    arrays::extension(path) == "npy"
}
