//! Fig. 13: the outlines of Eq. 17, and their size by Eq. 18 (D5).

use std::f64::consts::TAU;

use crate::drawing::{Drawing, names, stroke};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::runner::FigureRunner;
use crate::statistics::largest;
use slipfront_case::case_file;
use slipfront_case::case_file::CavitySize;
use slipfront_plot::{Shape, Sketch, StrokeStyle};

/// Number of corners of a drawn outline.
const CORNERS: usize = 360;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.plan("fig13")?;
    let mut shapes = Vec::new();
    let (mut misses, mut printed, mut vertices) = (Vec::new(), Vec::new(), Vec::new());
    for (k, label) in sweep.names(0).into_iter().enumerate() {
        let case = sweep.case(&[k], 0)?;
        let Some(case_file::Shape::Cavity(cavity)) = case.file.texture.first().map(|texture| &texture.shape)
        else {
            continue;
        };
        let points = outline(cavity.s, cavity.w);
        if cavity.s > 1 {
            vertices.push((farthest(&points) as f64 - f64::from(cavity.s + 1)).abs());
        }
        shapes.push(Shape { label, points });
        let asked = case.texture.asked_percent.unwrap_or(f64::NAN);
        misses.push((case.texture.meshed_percent - asked).abs());
        if let CavitySize::Coverage(percent) = cavity.size {
            // Eq. 18 as printed has N^2 in place of N; the area of the slider is N l^2.
            let n = case.model.lattice.n_blocks() as f64;
            let lambda_square =
                n * n * percent / (100.0 * 0.5 * TAU * (1.0 - f64::from(cavity.s) * cavity.w.powi(2)));
            let area = 0.5 * TAU * lambda_square * (1.0 - f64::from(cavity.s) * cavity.w.powi(2));
            printed.push(100.0 * (area / n) / (asked / 100.0));
        }
    }
    data.panel(
        "fig13",
        "Parameters of Eq. 17. An arm \u{3bb} at the angle \u{3c6} starts at the centre (x_0, y_0), and an arm w \u{3bb} at the \
         angle -s \u{3c6} leads from its end to the outline; here s = 3, w = 0.2.",
        Drawing::Sketch(parameters()),
    );
    data.panel(
        "fig13_shapes",
        "Outlines of Eq. 17 with equal area: ellipses (s = 1), semi-triangles (s = 2), -squares (s = 3) and -pentagons \
         (s = 4), round (w = 1/(5 s)) and sharp (w = 1/s).",
        Drawing::Shapes(shapes),
    );
    data.value("worst_coverage_miss_percent", largest(misses));
    data.value("area_as_printed_percent", largest(printed));
    data.value("vertices_missed", largest(vertices));
    Ok(())
}

/// Outline of Eq. 17 with the area of a circle of radius 1.
fn outline(s: u32, w: f64) -> Vec<[f64; 2]> {
    let lambda = 1.0 / (1.0 - f64::from(s) * w * w).sqrt();
    let point = |k: usize| on_outline(s, w, TAU * k as f64 / CORNERS as f64).map(|at| lambda * at);
    (0..CORNERS).map(point).collect()
}

/// Point of Eq. 17 for lambda = 1 about the origin.
fn on_outline(s: u32, w: f64, phi: f64) -> [f64; 2] {
    let s = f64::from(s);
    [
        libm::cos(phi) + w * libm::cos(s * phi),
        libm::sin(phi) - w * libm::sin(s * phi),
    ]
}

/// A cavity, with the vectors that add up to a point of its outline.
fn parameters() -> Sketch {
    let (s, w, phi) = (3, 0.2, TAU / 10.0);
    let circle = |radius: f64, from: f64, until: f64| -> Vec<[f64; 2]> {
        let angles = (0..=CORNERS).map(|k| from + (until - from) * k as f64 / CORNERS as f64);
        angles
            .map(|angle| [radius * libm::cos(angle), radius * libm::sin(angle)])
            .collect()
    };
    let points = (0..CORNERS).map(|k| on_outline(s, w, TAU * k as f64 / CORNERS as f64));
    let middle = [0.0, 0.0];
    let arm = [libm::cos(phi), libm::sin(phi)];
    let end = on_outline(s, w, phi);
    Sketch {
        strokes: vec![
            stroke(StrokeStyle::Area, &points.collect::<Vec<_>>()),
            stroke(StrokeStyle::Thin, &circle(1.0, 0.0, TAU)),
            stroke(StrokeStyle::Thin, &circle(0.35, 0.0, phi)),
            stroke(StrokeStyle::Arrow, &[middle, [1.6, 0.0]]),
            stroke(StrokeStyle::Arrow, &[middle, [0.0, 1.35]]),
            stroke(StrokeStyle::Arrow, &[middle, arm]),
            stroke(StrokeStyle::Arrow, &[arm, end]),
        ],
        labels: names([
            ("x", [1.6, -0.1]),
            ("y", [0.12, 1.35]),
            ("(x_0, y_0)", [-0.25, -0.1]),
            ("\u{3bb}", [0.42, 0.42]),
            ("\u{3c6}", [0.45, 0.14]),
            ("w \u{3bb}", [0.94, 0.66]),
            ("(x_\u{393}, y_\u{393})", [1.18, 0.38]),
        ])
        .to_vec(),
    }
}

/// Number of vertices of an outline: points that are farther from the middle than their neighbours.
fn farthest(points: &[[f64; 2]]) -> usize {
    let radius = |k: usize| {
        let [x, y] = points[k % points.len()];
        libm::hypot(x, y)
    };
    let n = points.len();
    (0..n)
        .filter(|&k| radius(k) > radius(k + n - 1) && radius(k) >= radius(k + 1))
        .count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_keep_the_area_of_the_circle() {
        for (s, w) in [(1, 0.6), (2, 0.5), (4, 0.05)] {
            let points = outline(s, w);
            let twice: f64 = (0..points.len())
                .map(|k| {
                    let ([x, y], [next_x, next_y]) = (points[k], points[(k + 1) % points.len()]);
                    x * next_y - next_x * y
                })
                .sum();
            // The area of a polygon with 360 corners in a unit circle is too small by 5e-5.
            assert!((0.5 * twice / (0.5 * TAU) - 1.0).abs() < 2e-4, "{s} {w}: {twice}");
        }
        assert_eq!(farthest(&outline(3, 1.0 / 3.0)), 4);
    }
}
