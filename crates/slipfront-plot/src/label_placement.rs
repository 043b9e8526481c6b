//! Places labels near the points that they name, clear of each other and, where there is room, of the curve.

use crate::geometry::{Area, CanvasPoint};

/// Least distance between labels.
const CLEARANCE: f64 = 5.0;

/// Area for labels, and the things already there.
#[derive(Default)]
pub(crate) struct Placer {
    bounds: Area,
    taken: Vec<Area>,
    lines: Vec<[CanvasPoint; 2]>,
}

/// A possible place for a label, with its penalty as a distance in pixels from the best place.
pub(crate) struct Candidate {
    pub(crate) area: Area,
    pub(crate) penalty: f64,
    /// The line that would join label and point.
    pub(crate) leader: Option<[CanvasPoint; 2]>,
}

impl Placer {
    pub(crate) fn new(bounds: Area) -> Self {
        Self {
            bounds,
            ..Self::default()
        }
    }

    /// Keeps labels out of an area.
    pub(crate) fn take(&mut self, area: Area) {
        self.taken.push(area);
    }

    /// Makes labels avoid the line through these points, if there is room.
    pub(crate) fn avoid(&mut self, points: &[CanvasPoint]) {
        let segments = points.windows(2).map(|pair| [pair[0], pair[1]]);
        self.lines.extend(segments);
    }

    /// Takes the best candidate and returns it; none if there are no candidates.
    pub(crate) fn place(&mut self, candidates: Vec<Candidate>) -> Option<Candidate> {
        let mut best: Option<(f64, Candidate)> = None;
        for candidate in candidates {
            let bound = best.as_ref().map_or(f64::INFINITY, |(cost, _)| *cost);
            let cost = self.cost(&candidate, bound);
            if cost < bound {
                best = Some((cost, candidate));
            }
        }
        let (_, candidate) = best?;
        self.taken.push(candidate.area);
        self.lines.extend(candidate.leader);
        Some(candidate)
    }

    /// Cost of the candidate, or any number above `bound` if it costs more than that.
    fn cost(&self, candidate: &Candidate, bound: f64) -> f64 {
        let area = grown(candidate.area, CLEARANCE);
        let mut cost = candidate.penalty;
        if area.x < self.bounds.x
            || area.y < self.bounds.y
            || area.right() > self.bounds.right()
            || area.bottom() > self.bounds.bottom()
        {
            cost += 1e6;
        }
        for taken in &self.taken {
            if overlap(&area, taken) {
                cost += 1e4;
            }
            if candidate.leader.is_some_and(|leader| crosses(leader, taken)) {
                cost += 100.0;
            }
        }
        for &line in &self.lines {
            if cost > bound {
                break;
            }
            if crosses(line, &area) {
                cost += 60.0;
            }
        }
        cost
    }
}

/// Places around `point` for a label of this size, near ones first. Far places get a leader, and so do places
/// that are as near to another of the `dots`, because the label would seem to belong to that dot.
pub(crate) fn around(
    point: CanvasPoint,
    (width, height): (f64, f64),
    dots: &[CanvasPoint],
) -> Vec<Candidate> {
    let mut candidates = Vec::new();
    for gap in [14.0, 22.0, 34.0, 50.0, 70.0, 95.0, 130.0, 180.0] {
        for step in 0..24 {
            // From the upper right, where a reader expects it, to both sides in turn.
            let turn = f64::from((step + 1) / 2) * if step % 2 == 0 { 1.0 } else { -1.0 };
            let (sin, cos) = libm::sincos((-0.25 + turn / 12.0) * std::f64::consts::PI);
            // The label's edge, not its centre, stays `gap` away from the point.
            let x = point.0 + cos * (gap + 0.5 * width) - 0.5 * width;
            let y = point.1 + sin * (gap + 0.5 * height) - 0.5 * height;
            let area = Area::new(x, y, width, height);
            let (right, bottom) = (area.right() + 3.0, area.bottom() + 3.0);
            let to_label = |dot: CanvasPoint| {
                let nearest = (dot.0.clamp(x - 3.0, right), dot.1.clamp(y - 3.0, bottom));
                (nearest.0 - dot.0, nearest.1 - dot.1)
            };
            let (dx, dy) = to_label(point);
            let distance = libm::hypot(dx, dy);
            let is_near = |&dot: &CanvasPoint| {
                let (dx, dy) = to_label(dot);
                dot != point && libm::hypot(dx, dy) < 1.5 * distance
            };
            let strays = dots.iter().any(is_near);
            // The leader starts outside its dot, so that it never counts as crossing the dot.
            let start = (point.0 + dx / distance * 12.0, point.1 + dy / distance * 12.0);
            let end = (point.0 + dx, point.1 + dy);
            let leader = (distance > if strays { 20.0 } else { 30.0 }).then_some([start, end]);
            let unclear = if strays && leader.is_none() { 30.0 } else { 0.0 };
            candidates.push(Candidate {
                area,
                penalty: gap + 2.0 * turn.abs() + unclear,
                leader,
            });
        }
    }
    candidates
}

fn grown(area: Area, by: f64) -> Area {
    Area::new(
        area.x - by,
        area.y - by,
        area.width + 2.0 * by,
        area.height + 2.0 * by,
    )
}

/// True when two areas share more than an edge.
pub(crate) fn overlap(a: &Area, b: &Area) -> bool {
    a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom()
}

/// True when part of the segment lies in the area (Liang and Barsky's clipping).
fn crosses([from, to]: [CanvasPoint; 2], area: &Area) -> bool {
    let (mut enters, mut leaves) = (0.0f64, 1.0f64);
    for (start, step, lo, hi) in [
        (from.0, to.0 - from.0, area.x, area.right()),
        (from.1, to.1 - from.1, area.y, area.bottom()),
    ] {
        if step == 0.0 {
            if start < lo || start > hi {
                return false;
            }
        } else {
            let (a, b) = ((lo - start) / step, (hi - start) / step);
            enters = enters.max(a.min(b));
            leaves = leaves.min(a.max(b));
        }
    }
    enters <= leaves
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: Area = Area {
        x: 0.0,
        y: 0.0,
        width: 860.0,
        height: 480.0,
    };

    #[test]
    fn crowded_labels_do_not_overlap() {
        let mut placer = Placer::new(BOUNDS);
        // Ten points within 12 pixels, near a corner.
        let areas: Vec<Area> = (0..10)
            .filter_map(|index| {
                placer
                    .place(around((845.0 - 1.2 * f64::from(index), 10.0), (24.0, 24.0), &[]))
                    .map(|c| c.area)
            })
            .collect();
        assert_eq!(areas.len(), 10);
        for (index, a) in areas.iter().enumerate() {
            assert!(a.x >= 0.0 && a.y >= 0.0 && a.right() <= 860.0 && a.bottom() <= 480.0);
            assert!(areas[..index].iter().all(|b| !overlap(a, b)));
        }
    }

    #[test]
    fn a_label_leaves_the_curve_free() {
        let mut placer = Placer::new(BOUNDS);
        let curve = [(0.0, 480.0), (430.0, 100.0), (860.0, 480.0)];
        placer.avoid(&curve);
        let area = placer.place(around(curve[1], (150.0, 30.0), &[])).unwrap().area;
        assert!(!crosses([curve[0], curve[1]], &area) && !crosses([curve[1], curve[2]], &area));
    }

    /// The label of each of two dots side by side is nearer to its own dot, or joined to it by a leader.
    #[test]
    fn a_label_is_not_taken_for_that_of_another_dot() {
        let dots = [(400.0, 300.0), (425.0, 300.0)];
        let mut placer = Placer::new(BOUNDS);
        for (own, other) in [(dots[0], dots[1]), (dots[1], dots[0])] {
            let placed = placer.place(around(own, (24.0, 24.0), &dots)).unwrap();
            let distance = |dot: (f64, f64)| {
                let x = dot.0.clamp(placed.area.x, placed.area.right()) - dot.0;
                x.hypot(dot.1.clamp(placed.area.y, placed.area.bottom()) - dot.1)
            };
            assert!(placed.leader.is_some() || distance(own) < distance(other));
        }
    }

    #[test]
    fn a_segment_crosses_an_area_only_inside_it() {
        let area = Area {
            x: 10.0,
            y: 10.0,
            width: 10.0,
            height: 10.0,
        };
        assert!(crosses([(0.0, 0.0), (30.0, 30.0)], &area));
        assert!(crosses([(12.0, 0.0), (12.0, 30.0)], &area));
        assert!(!crosses([(0.0, 0.0), (9.0, 30.0)], &area));
        assert!(!crosses([(0.0, 5.0), (30.0, 5.0)], &area));
    }
}
