//! The brush: strokes over the blocks.

use slipfront::Lattice;

/// Largest number of points of a stroke in one message.
const MAX_POINTS: usize = 4096;

/// Turns the blocks with centres within `radius` of the line through `points` into texture, or into contact.
/// Lengths are in blocks.
///
/// # Errors
/// A sentence, if there are no points or too many of them, or they or the radius are out of bounds.
pub(super) fn stroke(
    mask: &mut [bool],
    lattice: &Lattice,
    points: &[[f64; 2]],
    radius: f64,
    textured: bool,
) -> Result<(), String> {
    if points.is_empty() || points.len() > MAX_POINTS || !points.iter().flatten().all(|x| x.abs() < 1e6) {
        return Err(format!("a stroke has 1 to {MAX_POINTS} points near the slider"));
    }
    if !(0.1..=1000.0).contains(&radius) {
        return Err(format!(
            "the radius of the brush is {radius} blocks, where it may be from 0.1 to 1000"
        ));
    }
    // The last point is repeated, for a stroke with a single point.
    let ends = points.iter().skip(1).chain(points.last());
    for (from, to) in points.iter().zip(ends) {
        let within = |axis: usize, count: usize| {
            let low = from[axis].min(to[axis]) - radius;
            let high = from[axis].max(to[axis]) + radius;
            (low.floor().max(0.0) as usize).min(count)..(high.ceil().max(0.0) as usize).min(count)
        };
        for j in within(1, lattice.ny) {
            for i in within(0, lattice.nx) {
                let middle = [i as f64 + 0.5, j as f64 + 0.5];
                if distance(middle, *from, *to) <= radius {
                    mask[lattice.block(i, j)] = textured;
                }
            }
        }
    }
    Ok(())
}

/// Distance of a point from a line between two others.
fn distance([x, y]: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let square = dx * dx + dy * dy;
    let along = if square > 0.0 {
        (((x - from[0]) * dx + (y - from[1]) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    libm::hypot(x - from[0] - along * dx, y - from[1] - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_covers_the_middles_within_its_radius() {
        let lattice = Lattice::free(6, 3);
        let mut mask = [false; 18];
        // Centres of the lowest row are 0.5 away from y = 0; those of i = 1, 2, 3 are within 1 of the ends in
        // x.
        stroke(&mut mask, &lattice, &[[1.5, 0.0], [3.5, 0.0]], 1.0, true).unwrap();
        let row = |mask: &[bool], j: usize| {
            mask[6 * j..][..6]
                .iter()
                .map(|m| u8::from(*m))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            (row(&mask, 0), row(&mask, 1)),
            (vec![0, 1, 1, 1, 0, 0], vec![0; 6])
        );
        stroke(&mut mask, &lattice, &[[2.5, 0.5]], 0.1, false).unwrap();
        assert_eq!(row(&mask, 0), [0, 1, 0, 1, 0, 0]);
        // There is nothing to paint beyond the slider.
        stroke(&mut mask, &lattice, &[[-50.0, -50.0], [60.0, 80.0]], 0.1, true).unwrap();
        assert!(stroke(&mut mask, &lattice, &[[f64::NAN, 0.0]], 1.0, true).is_err());
    }
}
