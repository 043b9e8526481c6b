//! Fig. 13: the outlines of Eq. 17, and the size that Eq. 18 gives them (D5).

use std::f64::consts::TAU;

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::runner::FigureRunner;
use crate::statistics::largest;
use slipfront_case::case_file;
use slipfront_case::case_file::CavitySize;
use slipfront_plot::Shape;

/// Corners of a drawn outline.
const CORNERS: usize = 360;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.plan("fig13")?;
    let mut shapes = Vec::new();
    let (mut misses, mut printed, mut vertices) = (Vec::new(), Vec::new(), Vec::new());
    for (k, label) in sweep.names(0).into_iter().enumerate() {
        let case = sweep.case(&[k], 0)?;
        let Some(case_file::Texture::Cavity(cavity)) = case.file.texture.first() else {
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
            // Eq. 18 as printed has N^2 where the area is N l^2.
            let n = case.model.lattice.n_blocks() as f64;
            let lambda_square =
                n * n * percent / (100.0 * 0.5 * TAU * (1.0 - f64::from(cavity.s) * cavity.w.powi(2)));
            let area = 0.5 * TAU * lambda_square * (1.0 - f64::from(cavity.s) * cavity.w.powi(2));
            printed.push(100.0 * (area / n) / (asked / 100.0));
        }
    }
    data.panel(
        "fig13",
        "The outlines of Eq. 17 at equal area: ellipses (s = 1), semi-triangles (s = 2), -squares (s = 3) and -pentagons \
         (s = 4), round (w = 1/(5 s)) and sharp (w = 1/s).",
        Drawing::Shapes(shapes),
    );
    data.value("worst_coverage_miss_percent", largest(misses));
    data.value("area_as_printed_percent", largest(printed));
    data.value("vertices_missed", largest(vertices));
    Ok(())
}

/// Eq. 17 at the area of a circle of radius 1.
fn outline(s: u32, w: f64) -> Vec<[f64; 2]> {
    let s = f64::from(s);
    let lambda = 1.0 / (1.0 - s * w * w).sqrt();
    let point = |k: usize| {
        let phi = TAU * k as f64 / CORNERS as f64;
        [
            lambda * (libm::cos(phi) + w * libm::cos(s * phi)),
            lambda * (libm::sin(phi) - w * libm::sin(s * phi)),
        ]
    };
    (0..CORNERS).map(point).collect()
}

/// How many places of an outline lie farther out than those before and after: its vertices.
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
            // A polygon of 360 corners in a unit circle lacks 5e-5 of its area.
            assert!((0.5 * twice / (0.5 * TAU) - 1.0).abs() < 2e-4, "{s} {w}: {twice}");
        }
        assert_eq!(farthest(&outline(3, 1.0 / 3.0)), 4);
    }
}
