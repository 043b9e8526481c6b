//! Textures of a case file as shapes in blocks.

use std::path::Path;

use slipfront::{Lattice, Scales, surface};

use super::inputs::{Input, Inputs};
use crate::arrays::ArrayError;
use crate::case_file::{CaseError, CaseFile};
use crate::quantity::Length;
use crate::{arrays, case_file};

/// The shapes of all textures of a case file, and their area as asked for, % (see
/// [`TextureReport`](super::runnable::TextureReport)); masks are read.
pub(super) fn textures(
    file: &mut CaseFile,
    scales: &Scales,
    lattice: &Lattice,
    inputs: &mut Inputs,
) -> Result<(Vec<surface::Texture>, Option<f64>), CaseError> {
    let mut shapes = Vec::new();
    let mut asked = Some(0.0);
    for index in 0..file.texture.len() {
        let (shape, percent) = match &file.texture[index] {
            case_file::Texture::Cavity(cavity) => cavity_in_blocks(cavity, scales, lattice),
            case_file::Texture::Groove(groove) => groove_in_blocks(groove, scales, lattice),
            case_file::Texture::Polygon(polygon) => {
                let points = polygon.points.iter().map(|point| in_blocks(scales, point));
                (surface::Texture::Polygon(points.collect()), None)
            }
            case_file::Texture::Mask(mask) => {
                let key = format!("texture.{index}.file");
                let parse = |given: &_| mask_of(given, mask.threshold, lattice);
                let (given, shape) = inputs.read(file, &key, &mask.file, lattice, parse)?;
                let pixels = match &shape {
                    surface::Texture::Image(image) => image.dark.len(),
                    _ => lattice.n_blocks(),
                };
                inputs.budget.masks += pixels as f64;
                let copy = inputs.keep(file, given)?;
                if let case_file::Texture::Mask(mask) = &mut file.texture[index] {
                    mask.file = copy;
                }
                (shape, None)
            }
        };
        within_reach(&shape, lattice)
            .map_err(|sentence| file.source.error(&format!("texture.{index}"), sentence))?;
        shapes.push(shape);
        asked = asked.zip(percent).map(|(sum, percent)| sum + percent);
    }
    Ok((shapes, asked))
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
        surface::Texture::Image(_) | surface::Texture::Blocks(_) => 0.0,
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
) -> (surface::Texture, Option<f64>) {
    let n_blocks = lattice.n_blocks();
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
) -> (surface::Texture, Option<f64>) {
    let breadth = match groove.orientation {
        surface::Orientation::Across => lattice.nx as f64,
        surface::Orientation::Along => lattice.ny as f64,
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

fn mask_of(given: &Input, threshold: f64, lattice: &Lattice) -> Result<surface::Texture, ArrayError> {
    let (path, bytes) = (&given.original, &given.bytes);
    Ok(if is_array(path) {
        surface::Texture::Blocks(arrays::mask_npy(path, bytes, lattice.nx, lattice.ny)?)
    } else {
        surface::Texture::Image(arrays::mask_png(path, bytes, threshold)?)
    })
}

/// Whether the file of a mask is an array, and not an image.
pub(super) fn is_array(path: &Path) -> bool {
    arrays::extension(path) == "npy"
}
