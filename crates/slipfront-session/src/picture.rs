//! A field of all blocks as a picture with one byte per block.

use serde::Deserialize;
use slipfront::Snapshot;
use slipfront::observe::{Field, Kymograph};
use slipfront::{PositionBins, Scales};

/// The field of all blocks that is shown; its number stands in pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum DisplayedField {
    ContactStress,
    Traction,
    Displacement,
    Speed,
    Sliding,
    FirstSlip,
    /// First slips of the blocks that hold, and the blocks that slide.
    Front,
}

impl DisplayedField {
    /// Whether colours represent times of first slips, which some blocks may not have yet.
    fn shows_first_slips(self) -> bool {
        matches!(self, Self::FirstSlip | Self::Front)
    }
}

/// Byte of the largest value of the scale.
const MAX_BYTE: f32 = 250.0;
/// Bytes of blocks without a value.
const SLIDES: u8 = 252;
const NOT_YET: u8 = 253;
const NO_BLOCK: u8 = 254;
const TEXTURED: u8 = 255;

/// Value of a sliding block where other blocks have times.
pub(crate) const SLIDING_NOW: f32 = f32::INFINITY;

/// Kinds of binary messages.
const PICTURE: u8 = 1;
const KYMOGRAPH: u8 = 2;

/// Draws the pictures of one run, with a scale that changes rarely.
#[derive(Default)]
pub(crate) struct Painter {
    number: u32,
    values: Vec<f32>,
    other: Vec<f32>,
    times: Vec<f64>,
    /// The largest value of the scale, and the field that it belongs to.
    high: Option<(DisplayedField, f32)>,
}

/// Header of a picture: step, time, friction, percentage of sliding blocks, size and textured blocks.
pub(crate) struct PictureFrame<'a> {
    pub(crate) step: u64,
    pub(crate) time_star: f64,
    pub(crate) mu_star: f64,
    pub(crate) sliding_percent: f64,
    pub(crate) size: [usize; 2],
    pub(crate) textured: &'a [bool],
    /// Whether the picture shows a snapshot of a recorded run.
    pub(crate) recorded: bool,
}

impl Painter {
    /// Resets the scale, so that the next picture chooses its own.
    pub(crate) fn reset_scale(&mut self) {
        self.high = None;
    }

    /// The picture of a run at this instant. Displacements count from rest: `origin` is the position of the
    /// drive at the start of the leg, m.
    pub(crate) fn paint_snapshot(
        &mut self,
        now: &Snapshot,
        scales: &Scales,
        origin: Option<&[[f32; 2]]>,
        shown: DisplayedField,
    ) -> Vec<u8> {
        let lattice = &now.model.lattice;
        let surface = &now.model.surface;
        let n_blocks = surface.n_blocks();
        self.values.resize(n_blocks, 0.0);
        self.other.resize(n_blocks, 0.0);
        let (values, other) = (&mut self.values, &mut self.other);
        let stress = scales.stress() as f32;
        match shown {
            DisplayedField::ContactStress => read_scaled(now, Field::ContactStress, stress, values),
            DisplayedField::Traction => read_scaled(now, Field::Traction, stress, values),
            DisplayedField::Sliding => now.read_field(Field::Sliding, values),
            DisplayedField::FirstSlip | DisplayedField::Front => {
                self.times.resize(n_blocks, 0.0);
                now.read_first_slips(&mut self.times);
                if shown == DisplayedField::Front {
                    now.read_field(Field::Sliding, other);
                }
                for ((value, time), slides) in values.iter_mut().zip(&self.times).zip(other) {
                    let slides = shown == DisplayedField::Front && *slides > 0.0;
                    *value = if slides { SLIDING_NOW } else { *time as f32 };
                }
            }
            DisplayedField::Displacement => {
                let unit = scales.displacement() as f32;
                read_scaled(now, Field::DisplacementX, unit, values);
                read_scaled(now, Field::DisplacementY, unit, other);
                if let Some(origin) = origin {
                    for ((x, y), [from_x, from_y]) in values.iter_mut().zip(&mut *other).zip(origin) {
                        *x += from_x;
                        *y += from_y;
                    }
                }
                lengths(values, other);
            }
            DisplayedField::Speed => {
                let unit = scales.speed() as f32;
                read_scaled(now, Field::VelocityX, unit, values);
                read_scaled(now, Field::VelocityY, unit, other);
                lengths(values, other);
            }
        }
        let frame = PictureFrame {
            step: now.step,
            time_star: now.time_star,
            mu_star: now.point.mu_star,
            sliding_percent: now.point.sliding_percent,
            size: [lattice.nx, lattice.ny],
            textured: &surface.textured,
            recorded: false,
        };
        let values = std::mem::take(&mut self.values);
        let exists = now
            .model
            .slider()
            .outline
            .as_ref()
            .map(|outline| &*outline.exists);
        let picture = self.paint(&frame, shown, &values, exists);
        self.values = values;
        picture
    }

    /// Draws values, which are in the unit of the field.
    pub(crate) fn paint(
        &mut self,
        frame: &PictureFrame,
        shown: DisplayedField,
        values: &[f32],
        exists: Option<&[bool]>,
    ) -> Vec<u8> {
        let [low, high] = self.scale(shown, values);
        self.number = self.number.wrapping_add(1);
        let mut bytes = Vec::with_capacity(36 + values.len());
        bytes.extend([PICTURE, shown as u8]);
        bytes.extend(u16::from(frame.recorded).to_le_bytes());
        bytes.extend(self.number.to_le_bytes());
        bytes.extend((frame.step as u32).to_le_bytes());
        for number in [frame.time_star, frame.mu_star, frame.sliding_percent] {
            bytes.extend((number as f32).to_le_bytes());
        }
        bytes.extend(low.to_le_bytes());
        bytes.extend(high.to_le_bytes());
        for count in frame.size {
            bytes.extend((count as u16).to_le_bytes());
        }
        let factor = if high > low { MAX_BYTE / (high - low) } else { 0.0 };
        let missing = if shown.shows_first_slips() {
            NOT_YET
        } else {
            NO_BLOCK
        };
        let byte = |value: &f32| {
            if value.is_nan() {
                missing
            } else if *value == SLIDING_NOW {
                SLIDES
            } else {
                ((value - low) * factor + 0.5).clamp(0.0, MAX_BYTE) as u8
            }
        };
        let first = bytes.len();
        bytes.extend(values.iter().map(byte));
        let pixels = &mut bytes[first..];
        // Blocks without contact have no contact stress, but their motion is shown like that of other blocks.
        if !matches!(shown, DisplayedField::Displacement | DisplayedField::Speed) {
            for (pixel, textured) in pixels.iter_mut().zip(frame.textured) {
                *pixel = if *textured { TEXTURED } else { *pixel };
            }
        }
        for (pixel, _) in pixels
            .iter_mut()
            .zip(exists.into_iter().flatten())
            .filter(|(_, exists)| !**exists)
        {
            *pixel = NO_BLOCK;
        }
        bytes
    }

    /// The values of the first and the last colour.
    fn scale(&mut self, shown: DisplayedField, values: &[f32]) -> [f32; 2] {
        if shown == DisplayedField::Sliding {
            return [0.0, 1.0];
        }
        let finite = || values.iter().copied().filter(|value| *value != SLIDING_NOW);
        let largest = finite().fold(0.0, f32::max);
        if shown.shows_first_slips() {
            let earliest = finite().fold(f32::INFINITY, f32::min);
            return [earliest.min(largest), largest];
        }
        // The scale shrinks only when most of it is unused, so that colours do not flicker.
        let kept = self
            .high
            .filter(|(of, high)| *of == shown && (0.3 * high..=*high).contains(&largest));
        let high = kept.map_or_else(|| round_up(1.2 * largest), |(_, high)| high);
        self.high = Some((shown, high));
        [0.0, high]
    }
}

fn read_scaled(now: &Snapshot, field: Field, unit: f32, values: &mut [f32]) {
    now.read_field(field, values);
    for value in values {
        *value *= unit;
    }
}

/// Replaces first components of vectors by the lengths of the vectors.
pub(crate) fn lengths(x: &mut [f32], y: &[f32]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x = (*x * *x + y * y).sqrt();
    }
}

/// Rounds up to 1, 1.5, 2, 3, 5, 7 or 10 times a power of ten; 1 if the value is not positive.
fn round_up(value: f32) -> f32 {
    if value <= 0.0 || !value.is_finite() {
        return 1.0;
    }
    let power = libm::powf(10.0, libm::log10f(value).floor());
    let steps = [1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0];
    let step = steps.into_iter().find(|step| step * power >= value);
    step.unwrap_or(10.0) * power
}

/// The share of sliding blocks over place and time, as a picture; `before_star` is the duration t* of the
/// previous legs.
pub(crate) fn kymograph(
    kymograph: &Kymograph,
    bins: &PositionBins,
    dt_star: f64,
    before_star: f64,
) -> Option<Vec<u8>> {
    let rows: Vec<(f64, Vec<f32>)> = kymograph.rows().collect();
    let (first, last) = (rows.first()?.0, rows.last()?.0);
    let mut bytes = vec![KYMOGRAPH, 0, 0, 0];
    bytes.extend((rows.len() as u32).to_le_bytes());
    bytes.extend((bins.count as u32).to_le_bytes());
    let times = [first, last].map(|step| before_star + step * dt_star);
    for number in [times[0], times[1], bins.start, bins.width as f64] {
        bytes.extend((number as f32).to_le_bytes());
    }
    let byte = |share: &f32| {
        if share.is_nan() {
            TEXTURED
        } else {
            (share * MAX_BYTE + 0.5) as u8
        }
    };
    bytes.extend(rows.iter().flat_map(|(_, shares)| shares).map(byte));
    Some(bytes)
}
