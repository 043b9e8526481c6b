//! Lines with ends, joined where these meet.

use std::collections::HashMap;

use super::pen::{CLOSE, Point, difference, length};

/// A line that does not end where it begins.
pub(super) struct OpenLine {
    pub(super) points: Vec<Point>,
    /// Line of the file, for errors.
    pub(super) number: usize,
}

/// Closed polylines made of lines that meet, two at every end.
pub(super) fn closed(mut lines: Vec<OpenLine>) -> Result<Vec<Vec<Point>>, String> {
    let is_long = |line: &OpenLine| {
        let from = line.points[0];
        line.points
            .iter()
            .any(|to| length(difference(*to, from)) >= CLOSE)
    };
    lines.retain(is_long);
    // End 2 k is the beginning of line k, and end 2 k + 1 its other end.
    let end = |at: usize| match (&lines[at / 2].points[..], at % 2) {
        ([first, ..], 0) => *first,
        (points, _) => points[points.len() - 1],
    };
    let cell = |point: Point| point.map(|length| (length / CLOSE).floor() as i64);
    let mut cells: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for at in 0..2 * lines.len() {
        cells.entry(cell(end(at))).or_default().push(at);
    }
    let partner = |at: usize| {
        let [x, y] = cell(end(at));
        let near = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x.saturating_add(i), y.saturating_add(j)]));
        let others = near.filter_map(|cell| cells.get(&cell)).flatten();
        let meets = |other: &&usize| **other != at && length(difference(end(**other), end(at))) < CLOSE;
        // A third one would make it unclear which belong together.
        let found: Vec<usize> = others.filter(meets).take(2).copied().collect();
        let number = lines[at / 2].number;
        match found[..] {
            [one] => Ok(one),
            [] => Err(format!(
                "has a line that is not closed (line {number} of the file): join its ends, which must meet within a hundredth \
                 of a block, or move it to a layer that is not shown"
            )),
            _ => Err(format!(
                "has more than two lines that end at one point (line {number} of the file): delete doubled lines, or draw \
                 outlines that touch on different layers"
            )),
        }
    };
    let partners = (0..2 * lines.len()).map(partner).collect::<Result<Vec<_>, _>>()?;
    let mut rings = Vec::new();
    let mut is_used = vec![false; lines.len()];
    for first in 0..lines.len() {
        let (mut ring, mut at) = (Vec::new(), 2 * first);
        while !is_used[at / 2] {
            is_used[at / 2] = true;
            let points = &lines[at / 2].points;
            // The last point is the first of the next line.
            if at % 2 == 0 {
                ring.extend(&points[..points.len() - 1]);
            } else {
                ring.extend(points[1..].iter().rev());
            }
            at = partners[at ^ 1];
        }
        if !ring.is_empty() {
            rings.push(ring);
        }
    }
    Ok(rings)
}
