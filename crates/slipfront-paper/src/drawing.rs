//! Pictures as data, which can be drawn or written as CSV.

use serde::{Deserialize, Serialize};

use crate::error::PaperError;
use crate::number::MeasuredNumber;

use slipfront_plot::{
    BarChart, Estimate, FieldMap, FieldMaps, FrictionAxes, FrictionCurve, Picture, PictureError, PictureSize,
    Response, Responses, Shape, Sketch, Stroke, StrokeStyle,
};

/// The contents of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Drawing {
    /// mu* and N* against t*.
    Curves(Vec<FrictionCurve>),
    /// Fields over the blocks.
    Maps(FieldMaps),
    /// Quantities against the varied key.
    Responses(Responses),
    /// Quantities of named variants.
    Bars(BarChart),
    /// Outlines.
    Shapes(Vec<Shape>),
    /// Lines and names.
    Sketch(Sketch),
}

impl Drawing {
    /// The picture.
    ///
    /// # Errors
    /// When there is nothing to draw.
    pub fn draw(&self) -> Result<Picture, PictureError> {
        let size = PictureSize::default();
        match self {
            Self::Curves(curves) => slipfront_plot::friction(curves, &FrictionAxes::default(), size),
            Self::Maps(maps) => slipfront_plot::field_maps(maps, size),
            Self::Responses(responses) => slipfront_plot::response(responses, size),
            Self::Bars(chart) => slipfront_plot::bars(chart, size),
            Self::Shapes(shapes) => slipfront_plot::shapes(shapes),
            Self::Sketch(sketch) => slipfront_plot::sketch(sketch),
        }
    }

    /// Numbers of the picture as CSV, with enough digits to read back the same bits.
    ///
    /// # Errors
    /// When the numbers cannot be written as CSV.
    pub fn csv(&self) -> Result<Vec<u8>, PaperError> {
        let mut table = csv::Writer::from_writer(Vec::new());
        match self {
            Self::Curves(curves) => {
                table.write_record(["curve", "time_star", "mu_star", "sliding_percent"])?;
                for curve in curves {
                    for (k, time) in curve.x.iter().enumerate() {
                        table.serialize((&curve.label, time, curve.friction[k], curve.sliding_percent[k]))?;
                    }
                }
            }
            Self::Maps(maps) => {
                table.write_record(["map", "i", "j", "value"])?;
                for map in &maps.maps {
                    for (block, value) in map.values.iter().enumerate() {
                        let value = (!value.is_nan()).then_some(value);
                        table.serialize((&map.label, block % map.nx, block / map.nx, value))?;
                    }
                }
            }
            Self::Responses(responses) => {
                table.write_record(["curve", "x", "mean", "low", "high"])?;
                for curve in &responses.curves {
                    for (x, value) in &curve.points {
                        table.serialize((&curve.label, x, cells(value)))?;
                    }
                }
            }
            Self::Bars(chart) => {
                table.write_record(["group", "bar", "mean", "low", "high"])?;
                for group in &chart.groups {
                    for bar in &group.bars {
                        table.serialize((&group.label, &bar.label, cells(&bar.value)))?;
                    }
                }
            }
            Self::Shapes(shapes) => {
                table.write_record(["outline", "x", "y"])?;
                for shape in shapes {
                    for [x, y] in &shape.points {
                        table.serialize((&shape.label, x, y))?;
                    }
                }
            }
            Self::Sketch(sketch) => {
                table.write_record(["line", "x", "y"])?;
                for (line, stroke) in sketch.strokes.iter().enumerate() {
                    for [x, y] in &stroke.points {
                        table.serialize((line, x, y))?;
                    }
                }
            }
        }
        finish(table)
    }
}

/// The bytes of a finished table.
pub(super) fn finish(table: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, PaperError> {
    let bytes = table.into_inner();
    bytes.map_err(|error| csv::Error::from(error.into_error()).into())
}

/// A value for a cell of a table; none, for an empty cell, instead of NaN.
pub(super) fn known(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

/// The mean and the ends of its interval, as cells of a table.
fn cells(value: &Estimate) -> [Option<f64>; 3] {
    [value.mean, value.low, value.high].map(known)
}

/// A number and its interval as they are drawn.
pub(super) fn estimate(number: &MeasuredNumber) -> Estimate {
    let [mean, low, high] = number.ends();
    Estimate::between(low, mean, high)
}

/// A stroke of a sketch through these points.
pub(super) fn stroke(style: StrokeStyle, points: &[[f64; 2]]) -> Stroke {
    Stroke {
        style,
        points: points.to_vec(),
    }
}

/// Names of a sketch, each at its place.
pub(super) fn names<const N: usize>(names: [(&str, [f64; 2]); N]) -> [(String, [f64; 2]); N] {
    names.map(|(name, at)| (name.to_owned(), at))
}

pub(super) fn measured(label: &str, x: &[f64], numbers: &[MeasuredNumber]) -> Response {
    Response {
        label: label.to_owned(),
        points: x.iter().copied().zip(numbers.iter().map(estimate)).collect(),
        line: false,
    }
}

/// Maps of tau_c*, from 0 to its maximum in the run.
pub(super) fn stress_maps(maps: Vec<FieldMap>, columns: usize) -> Drawing {
    Drawing::Maps(FieldMaps {
        value_title: "\u{3c4}_c*".to_owned(),
        range: [0.0, 1.0],
        columns,
        maps,
    })
}

/// Maps of local coefficients over their mean, up to three standard deviations on either side.
pub(super) fn coefficient_maps(value_title: &str, sigma: f64, maps: Vec<FieldMap>) -> Drawing {
    Drawing::Maps(FieldMaps {
        value_title: value_title.to_owned(),
        range: [1.0 - 3.0 * sigma, 1.0 + 3.0 * sigma],
        columns: maps.len(),
        maps,
    })
}
