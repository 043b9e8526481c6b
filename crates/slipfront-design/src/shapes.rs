//! Shapes of the base case with unknown numbers: the keys, their values and the resulting textures.

use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseError, CaseFile, Override, Texture};
use slipfront_case::texture_file::{smallest, textured_blocks};
use slipfront_study::Unknown;
use toml::Value;

use crate::limits::Limits;
use crate::slider_blocks::SliderBlocks;
use crate::subject::Subject;

/// Keys of a texture with whole-number values.
const WHOLE: [&str; 2] = ["s", "array"];

/// Resolution of numbers, as a share of their range: values are rounded to the power of ten below it, so a
/// file has `"7.93 um"` and not sixteen digits.
const RESOLVED: f64 = 1e-3;

/// The textures of a base case with unknown numbers.
#[derive(Debug)]
pub(crate) struct Shapes {
    pub(crate) unknowns: Vec<Unknown>,
    /// The base case with every default filled in.
    base: String,
    /// The base case; shapes are meshed on its blocks.
    subject: Subject,
    grid: SliderBlocks,
    limits: Limits,
}

impl Shapes {
    /// The shapes of a base case with these unknowns, within limits.
    ///
    /// # Errors
    /// When the base is not valid with one of the unknowns at an end of its range and the others in the
    /// middle of theirs.
    pub(crate) fn new(
        unknowns: Vec<Unknown>,
        base: &Case,
        subject: Subject,
        grid: SliderBlocks,
        limits: Limits,
    ) -> Result<Self, CaseError> {
        let shapes = Self {
            base: base.file.to_toml()?,
            unknowns,
            subject,
            grid,
            limits,
        };
        for unknown in 0..shapes.unknowns.len() {
            for end in [0.0, 1.0] {
                let mut shares = shapes.middle();
                shares[unknown] = end;
                shapes.subject.with_textures(&shapes.textures(&shares)?)?;
            }
        }
        Ok(shapes)
    }

    /// The middle of all ranges, as shares.
    pub(crate) fn middle(&self) -> Vec<f64> {
        vec![0.5; self.unknowns.len()]
    }

    /// Settings of the unknown keys at these shares of their ranges.
    pub(crate) fn set_to(&self, shares: &[f64]) -> Vec<Override> {
        let values = self.unknowns.iter().zip(shares);
        values
            .map(|(unknown, &share)| Override::new(unknown.key(), &value(unknown, share)))
            .collect()
    }

    /// The textures at these shares of the ranges.
    ///
    /// # Errors
    /// When the case refuses them.
    pub(crate) fn textures(&self, shares: &[f64]) -> Result<Vec<Texture>, CaseError> {
        let set: Vec<String> = self.set_to(shares).iter().map(Override::to_string).collect();
        Ok(CaseFile::parse(&self.base, "base", &set)?.texture)
    }

    /// The textured blocks at these shares of the ranges.
    ///
    /// # Errors
    /// A sentence with a limit that they break, or with the reason why a case refuses them.
    pub(crate) fn texture(&self, shares: &[f64]) -> Result<Vec<bool>, String> {
        let drawn = || {
            let case = self.subject.with_textures(&self.textures(shares)?)?;
            Ok((textured_blocks(&case), smallest(&case)?.feature))
        };
        let (blocks, feature) = drawn().map_err(|error: CaseError| error.without_place())?;
        if !blocks.contains(&true) {
            return Err("the texture covers no block".to_owned());
        }
        let checked = self.limits.check(&self.grid, &blocks, feature);
        checked.map_err(|illegal| illegal.to_string())?;
        Ok(blocks)
    }
}

/// The number of an unknown at a share of its range, rounded.
pub(crate) fn number(unknown: &Unknown, share: f64) -> f64 {
    let exact = unknown.at(share);
    if is_whole(unknown.key()) {
        return exact.round();
    }
    let beside = if share + RESOLVED > 1.0 {
        share - RESOLVED
    } else {
        share + RESOLVED
    };
    let step = (unknown.at(beside) - exact).abs();
    let digits = -libm::floor(libm::log10(step)) as i32;
    let rounded = if digits > 0 {
        // Formatting rounds the number, and parsing returns the nearest one.
        format!("{exact:.0$}", digits as usize).parse().unwrap_or(exact)
    } else {
        let tens = libm::pow(10.0, f64::from(-digits));
        (exact / tens).round() * tens
    };
    rounded.clamp(unknown.at(0.0), unknown.at(1.0))
}

/// The value of an unknown at a share of its range, as written in a file. If an array is unknown as a whole,
/// its numbers of columns and rows are equal.
pub(crate) fn value(unknown: &Unknown, share: f64) -> Value {
    let number = number(unknown, share);
    if !is_whole(unknown.key()) {
        return unknown.with_unit(number);
    }
    let whole = Value::from(number as i64);
    if unknown.key().ends_with("array") {
        Value::from(vec![whole.clone(), whole])
    } else {
        whole
    }
}

/// Whether the value of a key of a texture is a whole number.
fn is_whole(key: &str) -> bool {
    let is_index = |part: &&str| part.bytes().all(|byte| byte.is_ascii_digit());
    let name = key.rsplit('.').find(|part| !is_index(part));
    name.is_some_and(|name| WHOLE.contains(&name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipfront_case::case_file::{KeyKind, SECTIONS};

    #[test]
    fn values_are_rounded_to_what_a_range_resolves() {
        let of = |key: &str, from: f64, to: f64, unit: &str, share: f64| {
            let unknown = Unknown::new(key, from, to, false).unwrap();
            let unknown = if unit.is_empty() {
                unknown
            } else {
                unknown.in_unit(unit)
            };
            value(&unknown, share).to_string()
        };
        // A thousandth of 80 is 0.08, above 0.01.
        assert_eq!(
            of("texture.0.lambda", 40.0, 120.0, "um", 0.123_456),
            "\"49.88 um\""
        );
        assert_eq!(of("texture.0.lambda", 1e4, 9e6, "nm", 0.5), "\"4505000 nm\"");
        assert_eq!(of("texture.0.rotate", 0.0, 45.0, "", 1.0), "45.0");
        assert_eq!(of("texture.0.array", 2.0, 8.0, "", 0.3), "[4, 4]");
        assert_eq!(of("texture.0.array.1", 2.0, 8.0, "", 0.3), "4");
        assert_eq!(of("texture.0.repeat.array", 1.0, 3.0, "", 1.0), "[3, 3]");
        assert_eq!(of("texture.0.s", 1.0, 3.0, "", 0.0), "1");
        // Rounding must not leave the range if an end is not a round number.
        assert_eq!(of("texture.0.w", 0.0, 1.0 / 3.0, "", 1.0), "0.3333");
        assert!(of("texture.0.w", 1.0 / 3.0, 1.0, "", 0.0).starts_with("0.33333"));
    }

    /// A whole-number key that is missing in the list here would be set to a fraction.
    #[test]
    fn all_whole_numbers_of_shapes_are_known() {
        let shapes = SECTIONS.iter().filter(|section| section.is_shape);
        for key in shapes.flat_map(|section| section.keys) {
            if matches!(key.kind, KeyKind::Whole { .. }) {
                assert!(WHOLE.contains(&key.name), "{}", key.name);
            }
        }
    }
}
