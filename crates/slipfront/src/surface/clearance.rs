//! The smallest textured feature and the smallest gap between two features: lengths that a tool must make,
//! and that blocks must resolve.

use std::collections::HashMap;

use super::contour::{Ellipse, rectangle};
use super::outline::Curve;
use super::outline_distance::{Closest, Effort, Form, TooMuch, between_boxes, widths};
use super::pattern::{Array, grids};
use super::texture::{Cavity, Shape, Texture, Tile};
use crate::lattice::{Edges, Lattice};

/// Smallest lengths of textures, in blocks; none where there is no feature or no gap.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clearance {
    /// Smallest width of a textured part.
    pub feature: Option<f64>,
    /// Smallest width of a part in contact between textured parts.
    pub gap: Option<f64>,
}

/// Number of corners of polygons for cavities other than ellipses: the error of the radius is at most five
/// millionths.
const CORNERS: usize = 1024;
/// Largest number of copies that are all compared with each other. If there are more, only neighbours in
/// every pattern, and copies at its ends, are compared.
const MANY: usize = 4096;
/// Largest number of points, edges and boxes that are examined, which takes some tenths of a second; textures
/// that need more have no result.
const EFFORT: usize = 50_000_000;

/// The smallest width of any shape and the smallest distance between two copies, before edges cut them.
/// Shapes that overlap count as one, and those that lie off the slider do not count. The width of a cavity is
/// that of the largest circle in it; for a mask, widths and distances are its shortest runs of blocks along x
/// and y. There is no result for drawings, or
/// if examining all shapes would take more than some tenths of a second.
///
/// ```
/// # use slipfront::Lattice;
/// # use slipfront::surface::{Array, Cavity, Shape, Texture, clearance};
/// let lattice = Lattice::free(40, 20);
/// let circle = Cavity { center: [20.0, 10.0], lambda: 4.0, s: 1, w: 0.0, across: false, rotate: 0.0 };
/// let arrays = vec![Array::spread(&lattice, [4, 2])];
/// let found = clearance(&lattice, &[Texture { arrays, ..Shape::Cavity(circle).into() }]);
/// assert_eq!((found.feature, found.gap), (Some(8.0), Some(2.0)));
/// ```
pub fn clearance(lattice: &Lattice, textures: &[Texture]) -> Clearance {
    measure(lattice, textures, &mut Effort(EFFORT)).unwrap_or_default()
}

fn measure(lattice: &Lattice, textures: &[Texture], effort: &mut Effort) -> Result<Clearance, TooMuch> {
    let copies = textures
        .iter()
        .map(|texture| texture.shape.n_copies(&texture.arrays));
    let all = copies.sum::<usize>() <= MANY;
    let mut found = Clearance::default();
    let mut shapes = Vec::new();
    for texture in textures {
        let drawn = match &texture.shape {
            Shape::Tile(tile) => Some((runs(tile), None)),
            Shape::Drawing(_) => return Ok(Clearance::default()),
            _ => {
                PlacedShape::new(lattice, texture, all, effort)?.map(|(widths, drawn)| (widths, Some(drawn)))
            }
        };
        let Some(([mut inside, mut outside], drawn)) = drawn else {
            continue;
        };
        if texture.inverted {
            [inside, outside] = [outside, inside];
        }
        least(&mut found.feature, inside);
        least(&mut found.gap, outside);
        shapes.extend(drawn);
    }
    let (pillars, dimples): (Vec<PlacedShape>, Vec<PlacedShape>) =
        shapes.into_iter().partition(|shape| shape.inverted);
    let dimples = Copies::new(lattice, &dimples, effort)?;
    let groups = pillars.chunks(1).map(|one| Copies::new(lattice, one, effort));
    let pillars = groups.collect::<Result<Vec<_>, _>>()?;
    // The textured area between pillars separates them.
    for pillars in &pillars {
        let is_textured = |at, effort: &mut Effort| Ok(!pillars.cover(at, effort)?);
        least(&mut found.feature, pillars.least_distance(effort, is_textured)?);
    }
    let touches = |at, effort: &mut Effort| {
        for pillars in &pillars {
            if !pillars.cover(at, effort)? {
                return Ok(false);
            }
        }
        Ok(!dimples.cover(at, effort)?)
    };
    least(&mut found.gap, dimples.least_distance(effort, touches)?);
    Ok(found)
}

fn least(found: &mut Option<f64>, value: Option<f64>) {
    if let Some(value) = value {
        *found = Some(found.map_or(value, |found| found.min(value)));
    }
}

/// The shortest runs of blocks along x and y that are inside a mask, and the shortest runs outside that lie
/// between two of these.
fn runs(tile: &Tile) -> [Option<f64>; 2] {
    let [nx, ny] = tile.size;
    let mut found = [None, None];
    let mut add = |line: Vec<bool>| {
        let runs: Vec<&[bool]> = line.chunk_by(|one, other| one == other).collect();
        for (at, run) in runs.iter().enumerate() {
            if run[0] || at > 0 && at + 1 < runs.len() {
                least(&mut found[usize::from(!run[0])], Some(run.len() as f64));
            }
        }
    };
    tile.blocks.chunks(nx).for_each(|row| add(row.to_vec()));
    (0..nx).for_each(|column| add((0..ny).map(|row| tile.blocks[row * nx + column]).collect()));
    found
}

/// The widths of a shape inside and outside, and the shape.
type Measured = ([Option<f64>; 2], PlacedShape);

/// A shape of a texture, and its positions on the slider.
struct PlacedShape {
    form: Form,
    places: Vec<[f64; 2]>,
    inverted: bool,
}

impl PlacedShape {
    /// A shape other than a mask, with its widths inside and outside; none if no copy lies on the slider.
    fn new(
        lattice: &Lattice,
        texture: &Texture,
        all: bool,
        effort: &mut Effort,
    ) -> Result<Option<Measured>, TooMuch> {
        if let Shape::Cavity(Cavity { s: 2.., .. }) = texture.shape {
            // The cost of its corners, in time and memory.
            effort.take(16 * CORNERS)?;
        }
        let Some((form, mut places)) = form(lattice, texture, all) else {
            return Ok(None);
        };
        let size = [lattice.nx as f64, lattice.ny as f64];
        for axis in 0..2 {
            let [low, high] = form.bounds(axis);
            match lattice.edges[axis] {
                Edges::Free if all => {
                    places.retain(|at| high + at[axis] > 0.0 && low + at[axis] < size[axis]);
                }
                Edges::Free => {}
                Edges::Periodic => {
                    for at in &mut places {
                        let turns = ((0.5 * (low + high) + at[axis]) / size[axis]).floor();
                        at[axis] -= turns * size[axis];
                    }
                }
            }
        }
        if places.is_empty() {
            return Ok(None);
        }
        let widths = match (&texture.shape, &form) {
            // A rectangle that ends where the slider does, so that its length is not a width.
            (Shape::Groove(groove), _) => [Some(groove.width), None],
            (Shape::Cavity(Cavity { lambda, w, .. }), _) => [Some(2.0 * lambda * (1.0 - w.abs())), None],
            (_, Form::Polygon(corners)) => widths(corners, effort)?,
            _ => [None, None],
        };
        let inverted = texture.inverted;
        Ok(Some((
            widths,
            Self {
                form,
                places,
                inverted,
            },
        )))
    }
}

/// The form of a texture, and the shifts of its copies: all, or some of many. None for a mask.
fn form(lattice: &Lattice, texture: &Texture, all: bool) -> Option<(Form, Vec<[f64; 2]>)> {
    let form = match &texture.shape {
        Shape::Cavity(cavity) => match cavity.curve() {
            Curve::Ellipse { semi_axes, axis } => Form::Ellipse(Ellipse {
                center: cavity.center,
                semi_axes,
                axis,
            }),
            Curve::Polygon(rings) => {
                let vertices = || rings.iter().flat_map(|ring| &ring.vertices);
                let step = vertices().count().div_ceil(CORNERS);
                let some = vertices().step_by(step);
                Form::Polygon(some.map(|vertex| vertex.around(cavity.center)).collect())
            }
        },
        Shape::Polygon(points) => Form::Polygon(points.clone()),
        Shape::Groove(groove) => {
            let [low, high] = groove.rectangle(lattice, 0.0);
            let across = |shift| {
                let mut place = [0.0; 2];
                place[groove.axis()] = shift;
                place
            };
            let shifts = groove.shifts(&grids(&texture.arrays)).into_iter();
            let corners = rectangle(low, high);
            return Some((Form::Polygon(corners), shifts.map(across).collect()));
        }
        Shape::Tile(_) | Shape::Drawing(_) => return None,
    };
    Some((form, places(&texture.arrays, all)))
}

/// The positions of arrays of arrays: all, or for each array the first three and the last line along both
/// axes, which include all distances between neighbours.
fn places(arrays: &[Array], all: bool) -> Vec<[f64; 2]> {
    let lines = |count: usize| (0..count).filter(move |&line| all || line < 3 || line + 1 == count);
    arrays.iter().fold(vec![[0.0; 2]], |outer, array| {
        let mut places = Vec::new();
        for [x, y] in outer {
            for row in lines(array.count[1]) {
                for column in lines(array.count[0]) {
                    let [dx, dy] = array.place(column, row);
                    places.push([x + dx, y + dy]);
                }
            }
        }
        places
    })
}

/// Copies of some shapes, from left to right.
struct Copies<'a> {
    forms: Vec<&'a Form>,
    copies: Vec<PlacedCopy>,
}

struct PlacedCopy {
    form: usize,
    at: [f64; 2],
    /// The smallest and the largest coordinate along each axis.
    bounds: [[f64; 2]; 2],
    /// Whether the copy is an image of a copy beyond a periodic edge.
    is_image: bool,
}

impl<'a> Copies<'a> {
    /// The copies of shapes on the slider, and those beyond its periodic edges, up to half the slider away.
    fn new(lattice: &Lattice, shapes: &'a [PlacedShape], effort: &mut Effort) -> Result<Self, TooMuch> {
        let size = [lattice.nx as f64, lattice.ny as f64];
        let mut copies = Vec::new();
        for (form, shape) in shapes.iter().enumerate() {
            let bounds = [0, 1].map(|axis| shape.form.bounds(axis));
            effort.take(shape.places.len())?;
            for &place in &shape.places {
                for turn in turns(lattice) {
                    let at = [place[0] + turn[0], place[1] + turn[1]];
                    let bounds = [0, 1].map(|axis| bounds[axis].map(|bound| bound + at[axis]));
                    let is_image = turn != [0.0; 2];
                    let is_near = |axis: usize| {
                        bounds[axis][1] > -0.5 * size[axis] && bounds[axis][0] < 1.5 * size[axis]
                    };
                    if !is_image || is_near(0) && is_near(1) {
                        copies.push(PlacedCopy {
                            form,
                            at,
                            bounds,
                            is_image,
                        });
                    }
                }
            }
        }
        copies.sort_by(|one, other| one.bounds[0][0].total_cmp(&other.bounds[0][0]));
        let forms = shapes.iter().map(|shape| &shape.form).collect();
        Ok(Self { forms, copies })
    }

    /// Whether a point lies inside any copy.
    fn cover(&self, point: [f64; 2], effort: &mut Effort) -> Result<bool, TooMuch> {
        let end = self.copies.partition_point(|copy| copy.bounds[0][0] <= point[0]);
        effort.take(end)?;
        for copy in &self.copies[..end] {
            let is_in_box = (0..2).all(|axis| {
                let [low, high] = copy.bounds[axis];
                (low..=high).contains(&point[axis])
            });
            let from_there = [0, 1].map(|axis| point[axis] - copy.at[axis]);
            if is_in_box && self.forms[copy.form].contains(from_there, effort)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The smallest distance between two copies with all blocks between them in contact; copies that touch do
    /// not count.
    fn least_distance(
        &self,
        effort: &mut Effort,
        counts: impl Fn([f64; 2], &mut Effort) -> Result<bool, TooMuch>,
    ) -> Result<Option<f64>, TooMuch> {
        let mut found = f64::INFINITY;
        // Patterns have few different distances, which differ only by rounding from place to place.
        let mut known: HashMap<(usize, usize, [i64; 2]), Option<Closest>> = HashMap::new();
        for (k, from) in self.copies.iter().enumerate() {
            for to in &self.copies[k + 1..] {
                effort.take(1)?;
                if to.bounds[0][0] - from.bounds[0][1] >= found {
                    break;
                }
                if from.is_image && to.is_image || between_boxes(&from.bounds, &to.bounds) >= found {
                    continue;
                }
                let shift = [0, 1].map(|axis| to.at[axis] - from.at[axis]);
                let key = (
                    from.form,
                    to.form,
                    shift.map(|length| (length * 1e9).round() as i64),
                );
                let closest = match known.get(&key) {
                    Some(closest) => *closest,
                    None => {
                        let closest = self.forms[from.form].closest(self.forms[to.form], shift, effort)?;
                        known.insert(key, closest);
                        closest
                    }
                };
                let Some(closest) = closest.filter(|closest| closest.distance < found) else {
                    continue;
                };
                let mut is_free = true;
                for [x, y] in closest.between() {
                    is_free = is_free && counts([x + from.at[0], y + from.at[1]], effort)?;
                }
                if is_free {
                    found = closest.distance;
                }
            }
        }
        Ok(found.is_finite().then_some(found))
    }
}

/// Shifts to the neighbouring images beyond periodic edges, including no shift.
fn turns(lattice: &Lattice) -> impl Iterator<Item = [f64; 2]> {
    let along = |axis: usize| {
        let size = [lattice.nx, lattice.ny][axis] as f64;
        match lattice.edges[axis] {
            Edges::Free => vec![0.0],
            Edges::Periodic => vec![-size, 0.0, size],
        }
    };
    let (x, y) = (along(0), along(1));
    y.into_iter()
        .flat_map(move |y| x.clone().into_iter().map(move |x| [x, y]))
}

#[cfg(test)]
mod tests {
    use super::super::texture::{Groove, Orientation};
    use super::*;

    fn clearance_of(lattice: &Lattice, shape: Shape, arrays: Vec<Array>, inverted: bool) -> [f64; 2] {
        let texture = Texture {
            shape,
            arrays,
            inverted,
        };
        let Clearance { feature, gap } = clearance(lattice, &[texture]);
        [feature, gap].map(|length| length.unwrap_or(f64::NAN))
    }

    fn is_near(found: [f64; 2], expected: [f64; 2]) -> bool {
        // Rounding of coordinates up to 60, times a hundred.
        let near = |found: f64, expected: f64| {
            (found - expected).abs() < 1e-12 || found.is_nan() && expected.is_nan()
        };
        near(found[0], expected[0]) && near(found[1], expected[1])
    }

    #[test]
    fn widths_and_gaps_are_those_of_the_drawing() {
        let free = Lattice::free(60, 60);
        let periodic = Lattice::with_edges(60, 60, [Edges::Periodic; 2]);
        let ellipse = |w: f64| {
            Shape::Cavity(Cavity {
                center: [30.0, 30.0],
                lambda: 5.0,
                s: 1,
                w,
                across: false,
                rotate: 0.0,
            })
        };
        let array = |count, spacing, staggered| Array {
            count,
            spacing,
            staggered,
        };
        let nan = f64::NAN;
        let close = array([3, 1], [12.0, 12.0], false);
        assert!(is_near(
            clearance_of(&free, ellipse(0.2), vec![], false),
            [8.0, nan]
        ));
        // Semi-axes of 6 and 4: neighbours along x touch, and neighbours along y are 4 apart.
        assert!(is_near(
            clearance_of(
                &free,
                ellipse(0.2),
                vec![array([3, 3], [13.0, 12.0], false)],
                false
            ),
            [8.0, 1.0]
        ));
        assert!(is_near(
            clearance_of(&free, ellipse(0.0), vec![close], true),
            [2.0, 10.0]
        ));
        // Beyond the edges, from 42 to 18 + 60.
        assert!(is_near(
            clearance_of(
                &periodic,
                ellipse(0.0),
                vec![array([2, 1], [48.0, 1.0], false)],
                false
            ),
            [10.0, 2.0]
        ));
        let diagonal = array([2, 2], [20.0, 10.0], true);
        assert!(is_near(
            clearance_of(&free, ellipse(0.0), vec![diagonal], false),
            [10.0, 200.0_f64.sqrt() - 10.0]
        ));
        // Clusters of four, which are nearer to each other than their members are.
        let clusters = vec![
            array([2, 1], [21.0, 1.0], false),
            array([2, 2], [11.0, 11.0], false),
        ];
        let found = clearance_of(&free, ellipse(-0.0), clusters, false);
        assert!(is_near(found, [10.0, 1.0]), "{found:?}");
        let groove = Shape::Groove(Groove {
            orientation: Orientation::Across,
            width: 2.5,
            offset: 0.0,
        });
        assert!(is_near(
            clearance_of(&free, groove, vec![array([4, 1], [10.0, 1.0], false)], false),
            [2.5, 7.5]
        ));
        let square = Shape::Polygon(vec![[10.0, 10.0], [20.0, 10.0], [20.0, 13.0], [10.0, 13.0]]);
        assert!(is_near(clearance_of(&free, square, vec![], false), [3.0, nan]));
        // Arms have a width of 12 when vertical, at a slope of 2 to 3; the notch of a chevron between them is
        // a corner, not a gap.
        let chevron = [
            [10.0, 12.0],
            [25.0, 22.0],
            [40.0, 12.0],
            [40.0, 24.0],
            [25.0, 34.0],
            [10.0, 24.0],
        ];
        let found = clearance_of(&free, Shape::Polygon(chevron.to_vec()), vec![], false);
        assert!(
            (found[0] - 12.0 * 15.0 / 325.0_f64.sqrt()).abs() < 1e-9,
            "{found:?}"
        );
    }

    fn circle(center: [f64; 2], lambda: f64) -> Texture {
        let cavity = Cavity {
            center,
            lambda,
            s: 1,
            w: 0.0,
            across: false,
            rotate: 0.0,
        };
        Shape::Cavity(cavity).into()
    }

    fn groove(orientation: Orientation, width: f64, offset: f64) -> Texture {
        let groove = Groove {
            orientation,
            width,
            offset,
        };
        Shape::Groove(groove).into()
    }

    /// A part that a third shape covers is not a gap between two others, nor is there a gap between grooves
    /// that cross or dimples that merge.
    #[test]
    fn gaps_are_not_looked_for_below_other_shapes() {
        let free = Lattice::free(60, 60);
        let gap = |textures: &[Texture]| clearance(&free, textures).gap;
        let (across, along) = (
            groove(Orientation::Across, 2.0, 0.0),
            groove(Orientation::Along, 3.0, 5.0),
        );
        assert_eq!(gap(&[across.clone(), along.clone()]), None);
        // Two dimples on both sides of a groove are nearer to it than to each other.
        let dimples = [circle([24.0, 10.0], 4.0), circle([38.0, 10.0], 4.0)];
        assert_eq!(gap(&dimples), Some(6.0));
        assert_eq!(gap(&[dimples.to_vec(), vec![across.clone()]].concat()), Some(1.0));
        let wide = groove(Orientation::Across, 8.0, 1.0);
        assert_eq!(gap(&[dimples.to_vec(), vec![wide]].concat()), None);
        // Overlapping dimples in a row form one groove: the dimple in the middle is not a gap between its two
        // neighbours.
        let row = |pitch: f64| Texture {
            arrays: vec![Array {
                count: [6, 1],
                spacing: [pitch, 1.0],
                staggered: false,
            }],
            ..circle([30.0, 30.0], 4.0)
        };
        assert_eq!(gap(&[row(5.0)]), None);
        assert_eq!(gap(&[row(8.0)]), None);
        assert_eq!(gap(&[row(9.0)]), Some(1.0));
        // Pillars that overlap, and dimples below pillars of another texture.
        let pillars = |pitch| Texture {
            inverted: true,
            ..row(pitch)
        };
        let found = clearance(&free, &[pillars(5.0)]);
        assert_eq!((found.feature, found.gap), (None, Some(8.0)));
        let found = clearance(&free, &[pillars(9.0), across, along]);
        assert_eq!((found.feature, found.gap), (Some(1.0), Some(8.0)));
    }

    #[test]
    fn what_lies_off_the_slider_does_not_count() {
        let free = Lattice::free(60, 40);
        let found = clearance(
            &free,
            &[
                circle([30.0, 20.0], 5.0),
                circle([-3.0, 20.0], 2.0),
                circle([30.0, 44.0], 3.0),
            ],
        );
        assert_eq!((found.feature, found.gap), (Some(10.0), None));
        // A dimple that an edge cuts counts with its full size.
        let found = clearance(&free, &[circle([30.0, 20.0], 5.0), circle([30.0, 40.5], 2.0)]);
        assert_eq!((found.feature, found.gap), (Some(4.0), Some(13.5)));
        // Beyond a periodic edge it continues at the opposite edge.
        let periodic = Lattice::with_edges(60, 40, [Edges::Periodic; 2]);
        let found = clearance(
            &periodic,
            &[circle([30.0, 20.0], 5.0), circle([30.0, -153.0], 2.0)],
        );
        assert_eq!((found.feature, found.gap), (Some(4.0), Some(6.0)));
        // Of positions far apart, all but one lie off the slider.
        let wide = Array {
            count: [3, 3],
            spacing: [70.0, 50.0],
            staggered: false,
        };
        let found = clearance(
            &free,
            &[Texture {
                arrays: vec![wide],
                ..circle([30.0, 20.0], 5.0)
            }],
        );
        assert_eq!((found.feature, found.gap), (Some(10.0), None));
    }

    /// The vertices of a sharp cavity are not narrow features: they taper to zero width in blocks of any
    /// size.
    #[test]
    fn a_cavity_is_as_wide_as_the_circle_in_it() {
        for (s, w) in [(2, 0.5), (3, -1.0 / 3.0), (4, 0.05), (64, 1.0 / 64.0)] {
            let cavity = Cavity {
                center: [30.0, 30.0],
                lambda: 9.0,
                s,
                w,
                across: true,
                rotate: 20.0,
            };
            let found = clearance(&Lattice::free(60, 60), &[Shape::Cavity(cavity).into()]);
            assert_eq!(
                (found.feature, found.gap),
                (Some(18.0 * (1.0 - w.abs())), None),
                "{s}"
            );
        }
    }

    /// As many copies as are all compared with each other, more copies, and as many separate textures, with a
    /// groove across all of them: none takes too long.
    #[test]
    fn many_shapes_are_measured_in_little_time() {
        let measured = |lattice: &Lattice, textures: &[Texture]| {
            let found = measure(lattice, textures, &mut Effort(EFFORT)).unwrap();
            [found.feature.unwrap(), found.gap.unwrap()]
        };
        for edges in [Edges::Free, Edges::Periodic] {
            for count in [64, 65, 100] {
                let size = 10 * count;
                let lattice = Lattice::with_edges(size, size, [edges; 2]);
                let array = Array::spread(&lattice, [count, count]);
                for array in [array, array.staggered()] {
                    let dimples = Texture {
                        arrays: vec![array],
                        ..circle([5.0 * count as f64; 2], 3.0)
                    };
                    assert!(is_near(
                        measured(&lattice, std::slice::from_ref(&dimples)),
                        [6.0, 4.0]
                    ));
                    let with_groove = [dimples, groove(Orientation::Along, 1.0, 0.0)];
                    assert_eq!(measured(&lattice, &with_groove)[0], 1.0);
                }
            }
            let alone = |k: usize| circle([10.0 * (k % 50) as f64 + 5.0, 10.0 * (k / 50) as f64 + 5.0], 3.0);
            let textures: Vec<Texture> = (0..2500).map(alone).collect();
            let lattice = Lattice::with_edges(500, 500, [edges; 2]);
            assert_eq!(measured(&lattice, &textures), [6.0, 4.0]);
        }
    }
}
