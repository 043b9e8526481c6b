//! A movie of a run: maps of a field one after the other, next to the friction curve with a mark at the
//! instant that is shown.
//!
//! Pictures of a movie usually have 800 x 400 pixels and at most 256 colours. They are drawn twice as large,
//! and every pixel is the mean of four, so that letters and lines have the same proportions as in other
//! pictures. A long slider has its map above the curve.

use crate::axis::DrawnAxis;
use crate::canvas::Canvas;
use crate::cell_means::CellMeans;
use crate::frame::{BAR_WIDTH, bar_room, colour_bar, left_room, left_side, lower_side};
use crate::friction_curve::{FrictionAxes, FrictionCurve};
use crate::geometry::{Align, Area, CanvasPoint};
use crate::label_placement::{Placer, around};
use crate::lattice_map::{Cells, MARK, MIN_RATIO, SnapshotMap, SnapshotMaps, draw_titles};
use crate::movie_colours::Colours;
use crate::picture_error::{PictureError, check_columns};
use crate::raster::Pixels;
use crate::series::segments;
use crate::style::{
    BLACK, CURVES, GREY, MARGIN, RADIUS_MARKER, SIZE_TEXT, WIDTH_CURVE, WIDTH_LEADER, WIDTH_MARK,
};
use crate::text::Text;
use crate::ticks::{Direction, MAX_STEPS};

/// Size of the pictures of a movie, which are twice as wide as high.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MovieSize {
    /// 400 x 200 pixels.
    Small,
    /// 800 x 400 pixels.
    #[default]
    Usual,
    /// 1600 x 800 pixels.
    Large,
}

impl MovieSize {
    /// Pixels of a picture along x and along y.
    pub const fn pixels(self) -> [usize; 2] {
        [DRAWN_PIXELS[0] / self.drawn(), DRAWN_PIXELS[1] / self.drawn()]
    }

    /// Factor by which a picture is drawn larger.
    const fn drawn(self) -> usize {
        match self {
            Self::Small => 4,
            Self::Usual => 2,
            Self::Large => 1,
        }
    }
}

const DRAWN_PIXELS: [usize; 2] = [1600, 800];
/// Largest side of the map, in drawn pixels.
const MAP_SIDE: f64 = 600.0;
/// Left end of the map.
const MAP_LEFT: f64 = 2.0 * MARGIN;
/// Upper end of map and curve, below two lines of text.
const TOP: f64 = 110.0;
/// Left end of the curve's part.
const CURVE_LEFT: f64 = 790.0;
/// Lower end of the curve, above its numbers and title.
const CURVE_BOTTOM: f64 = 690.0;
/// Ratio of length to height above which a slider has its map above the curve.
const LONG: f64 = 3.0;
/// Width of a map above the curve, and its least height over its width.
const LONG_SIDE: f64 = 1400.0;
const MIN_RATIO_ABOVE: f64 = 1.0 / 12.0;
/// Distance of the curve from a map above it.
const BELOW: f64 = 60.0;

/// A movie of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Movie {
    /// A map for each picture; the title of their values is over the colour bar.
    pub snapshots: SnapshotMaps,
    /// The curve against t*.
    pub curve: FrictionCurve,
    /// Titles of the curve's axes.
    pub axes: FrictionAxes,
}

/// A movie that can be drawn: its layout and its colours.
pub struct MoviePictures<'a> {
    movie: &'a Movie,
    size: MovieSize,
    cells: Cells,
    colours: Colours,
    /// Part that is the same in all pictures.
    ground: Pixels,
    layout: MovieLayout,
    x: DrawnAxis,
    mu: DrawnAxis,
}

/// Positions of the parts of a picture, in drawn pixels.
struct MovieLayout {
    map: Area,
    /// Area available to the map; its titles are centred above this area.
    room: Area,
    bar: Area,
    /// Left end of the curve's part.
    curve_left: f64,
    /// Upper end of the curve.
    curve_top: f64,
}

impl MovieLayout {
    fn new(nx: usize, ny: usize, size: MovieSize) -> Self {
        let cells = CellMeans::cells(nx, ny);
        let ratio = ny as f64 / nx as f64;
        if ratio * LONG >= 1.0 {
            let room = Area::new(MAP_LEFT, TOP, MAP_SIDE, MAP_SIDE);
            let ratio = ratio.clamp(MIN_RATIO, 1.0 / MIN_RATIO);
            let sides = [MAP_SIDE.min(MAP_SIDE / ratio), MAP_SIDE.min(MAP_SIDE * ratio)];
            return Self {
                map: map_area(room, sides, cells, size),
                room,
                bar: Area::new(room.right() + 2.0 * MARGIN, TOP, BAR_WIDTH, CURVE_BOTTOM - TOP),
                curve_left: CURVE_LEFT,
                curve_top: TOP,
            };
        }
        let sides = [LONG_SIDE, LONG_SIDE * ratio.max(MIN_RATIO_ABOVE)];
        let room = Area::new(MAP_LEFT, TOP, sides[0], sides[1]);
        let map = map_area(room, sides, cells, size);
        Self {
            bar: Area::new(map.right() + 2.0 * MARGIN, TOP, BAR_WIDTH, map.height),
            curve_left: 0.0,
            curve_top: map.bottom() + BELOW,
            map,
            room,
        }
    }
}

impl<'a> MoviePictures<'a> {
    /// Lays a movie out in pictures of this size.
    ///
    /// # Errors
    /// A lattice without blocks, an array of the wrong length, no picture, or no memory for one.
    pub fn new(movie: &'a Movie, size: MovieSize) -> Result<Self, PictureError> {
        let SnapshotMaps { lattice, maps, .. } = &movie.snapshots;
        movie.snapshots.check()?;
        let curve = &movie.curve;
        check_columns(
            &curve.label,
            ("times", curve.x.len()),
            &[("friction", curve.friction.len())],
        )?;
        let layout = MovieLayout::new(lattice.nx, lattice.ny, size);
        let times = maps.iter().map(|map| map.time_star);
        let times: Vec<f64> = curve.x.iter().copied().chain(times).collect();
        let frictions: Vec<f64> = curve.friction.iter().copied().chain([0.0]).collect();
        let mu = DrawnAxis::around(&frictions, false, 0.06).placed(CURVE_BOTTOM, layout.curve_top);
        let right = DRAWN_PIXELS[0] as f64 - 3.0 * MARGIN;
        let left = layout.curve_left + left_room(&mu.ticks(Direction::Y, MAX_STEPS));
        let [width, height] = DRAWN_PIXELS.map(|pixels| pixels as u32);
        let mut pictures = Self {
            movie,
            size,
            cells: lattice.cells(),
            colours: Colours::default(),
            ground: Pixels::blank(width, height).ok_or_else(no_memory)?,
            layout,
            x: DrawnAxis::around(&times, false, 0.0).placed(left, right),
            mu,
        };
        let mut canvas = blank();
        pictures.draw_bar(&mut canvas);
        pictures.draw_curve(&mut canvas);
        pictures.ground.draw(&canvas);
        Ok(pictures)
    }

    /// Size of the pictures.
    pub fn size(&self) -> MovieSize {
        self.size
    }

    /// The colours of the pixels: red, green and blue of each.
    pub fn palette(&self) -> &[[u8; 3]] {
        self.colours.palette()
    }

    /// A picture: the colour of every pixel, row by row from the top.
    pub fn draw(&self, index: usize) -> Vec<u8> {
        let mut canvas = blank();
        let map = &self.movie.snapshots.maps[index];
        self.draw_map(&mut canvas, map);
        self.draw_mark(&mut canvas, map);
        let mut drawn = self.ground.clone();
        drawn.draw(&canvas);
        let [nx, ny] = self.size.pixels();
        let larger = self.size.drawn();
        let pixel = |at: usize| {
            let first = larger * (at / nx) * DRAWN_PIXELS[0] + larger * (at % nx);
            let mut sum = [0_u32; 3];
            for k in 0..larger * larger {
                let colour = drawn.colour(first + k / larger * DRAWN_PIXELS[0] + k % larger);
                for (sum, channel) in sum.iter_mut().zip(colour) {
                    *sum += u32::from(channel);
                }
            }
            let count = (larger * larger) as u32;
            self.colours
                .nearest(sum.map(|sum| ((sum + count / 2) / count) as u8))
        };
        (0..nx * ny).map(pixel).collect()
    }

    fn draw_map(&self, canvas: &mut Canvas, map: &SnapshotMap) {
        let area = self.layout.map;
        let range = self.movie.snapshots.range;
        self.cells.draw(canvas, area, &map.values, range);
        canvas.frame(area);
        let titles = [map.time_title(), map.friction_title()];
        let [time, friction] = titles.map(|title| Text::plain(&title, SIZE_TEXT));
        draw_titles(canvas, self.layout.room, &[time], &friction);
    }

    fn draw_bar(&self, canvas: &mut Canvas) {
        let (maps, bar) = (&self.movie.snapshots, self.layout.bar);
        colour_bar(canvas, bar, maps.range);
        let title = Text::math(&maps.value_title, SIZE_TEXT);
        let room = bar_room(maps.range, bar.height);
        let start = (bar.x + room - title.width()).min(bar.x);
        canvas.text(&title, (start, bar.y - 22.0), Align::Start, BLACK);
    }

    fn curve_area(&self) -> Area {
        Area::between(self.x.start, self.x.end, self.mu.start, self.mu.end)
    }

    fn draw_curve(&self, canvas: &mut Canvas) {
        let (movie, curve) = (self.movie, &self.movie.curve);
        let area = self.curve_area();
        let title = Text::math(&movie.axes.friction, SIZE_TEXT);
        left_side(
            canvas,
            area,
            self.layout.curve_left,
            &self.mu.ticks(Direction::Y, MAX_STEPS),
            &title,
        );
        let title = Text::math(&movie.axes.x, SIZE_TEXT);
        lower_side(canvas, area, &self.x.ticks(Direction::X, MAX_STEPS), &title);
        let mut placer = Placer::new(area);
        for segment in segments(curve.friction_points(), &self.x, &self.mu) {
            placer.avoid(&segment);
            canvas.polyline(segment, WIDTH_CURVE, CURVES[0]);
        }
        // Letters of instants with overlapping dots are joined.
        let mut marks: Vec<(CanvasPoint, Vec<String>)> = Vec::new();
        for instant in &curve.instants {
            let dot = (self.x.at(instant.x), self.mu.clamped(instant.friction));
            let covers = |(at, _): &&mut (CanvasPoint, Vec<String>)| {
                libm::hypot(dot.0 - at.0, dot.1 - at.1) < RADIUS_MARKER
            };
            let letter = instant.letter.to_string();
            match marks.iter_mut().find(covers) {
                Some((_, letters)) => letters.push(letter),
                None => marks.push((dot, vec![letter])),
            }
        }
        let dots: Vec<CanvasPoint> = marks.iter().map(|(dot, _)| *dot).collect();
        for (dot, letters) in marks {
            canvas.dot(dot, RADIUS_MARKER, GREY);
            let letter = Text::plain(&letters.join(", "), SIZE_TEXT);
            if let Some(place) = placer.place(around(dot, (letter.width(), letter.height()), &dots)) {
                if let Some([from, to]) = place.leader {
                    canvas.line(from, to, WIDTH_LEADER, GREY);
                }
                canvas.text(&letter, (place.area.x, place.area.bottom()), Align::Start, BLACK);
            }
        }
        canvas.frame(area);
    }

    /// Draws the mark of the curve at the instant that is shown.
    fn draw_mark(&self, canvas: &mut Canvas, map: &SnapshotMap) {
        let area = self.curve_area();
        let now = self.x.clamped(map.time_star);
        canvas.line((now, area.y), (now, area.bottom()), WIDTH_MARK, MARK);
        if map.mu_star.is_finite() {
            canvas.dot((now, self.mu.clamped(map.mu_star)), RADIUS_MARKER, MARK);
        }
    }
}

/// A canvas of the size of a picture.
fn blank() -> Canvas {
    let [width, height] = DRAWN_PIXELS.map(|pixels| pixels as f64);
    Canvas::new(width, height)
}

fn no_memory() -> PictureError {
    PictureError::Gif("there is no memory for a picture".to_owned())
}

/// Area of a map of these sides, in the middle of its room: every cell has an equal, whole number of pixels.
fn map_area(room: Area, sides: [f64; 2], cells: [usize; 2], size: MovieSize) -> Area {
    let whole = |axis: usize| {
        let cell = (size.drawn() * cells[axis]) as f64;
        (sides[axis] / cell).floor().max(1.0) * cell
    };
    let drawn = size.drawn() as f64;
    let indent = (0.5 * (room.width - whole(0)) / drawn).floor().max(0.0) * drawn;
    Area::new(room.x + indent, room.y, whole(0), whole(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice_map::DrawnLattice;

    const PIXELS: [usize; 2] = MovieSize::Usual.pixels();

    fn movie(nx: usize, ny: usize) -> Movie {
        let [columns, rows] = CellMeans::cells(nx, ny);
        let map = |k: usize| SnapshotMap {
            label: if k == 1 { "A, B".to_owned() } else { String::new() },
            time_star: 10.0 * k as f64,
            mu_star: 0.1 * k as f64,
            values: (0..columns * rows).map(|cell| (cell % 7) as f32 / 7.0).collect(),
        };
        Movie {
            snapshots: SnapshotMaps {
                lattice: DrawnLattice {
                    nx,
                    ny,
                    block_size: 1e-6,
                    textured: (0..columns * rows).map(|cell| cell % 5 == 0).collect(),
                },
                maps: (0..3).map(map).collect(),
                value_title: "\u{3c4}_c*".to_owned(),
                range: [0.0, 1.0],
            },
            curve: FrictionCurve {
                x: (0..100).map(|k| 0.3 * f64::from(k)).collect(),
                friction: (0..100).map(|k| 0.003 * f64::from(k)).collect(),
                ..FrictionCurve::default()
            },
            axes: FrictionAxes::default(),
        }
    }

    /// Positions of map and curve, in pixels of the picture.
    fn halves(area: Area) -> [usize; 4] {
        area.sides().map(|side| side as usize / MovieSize::Usual.drawn())
    }

    /// Every block of the map fills whole pixels with its own colour, without blending.
    #[test]
    fn blocks_have_whole_pixels_of_their_colour() {
        let mut movie = movie(100, 100);
        movie.snapshots.lattice.textured.fill(false);
        let pictures = MoviePictures::new(&movie, MovieSize::Usual).unwrap();
        let pixels = pictures.draw(2);
        assert_eq!(pixels.len(), PIXELS[0] * PIXELS[1]);
        let [left, top, width, height] = halves(pictures.layout.map);
        assert_eq!([width, height], [300, 300]);
        // The edge of the map is drawn over the outermost pixels.
        for row in 1..99 {
            for column in 1..99 {
                // Row 0 of the blocks is the lowest.
                let share = f64::from(((99 - row) * 100 + column) % 7) / 7.0;
                let wanted = crate::style::ramp(share);
                for k in 0..9 {
                    let (x, y) = (left + 3 * column as usize + k % 3, top + 3 * row as usize + k / 3);
                    let found = pictures.palette()[usize::from(pixels[y * PIXELS[0] + x])];
                    let far = wanted
                        .iter()
                        .zip(found)
                        .map(|(one, other)| one.abs_diff(other))
                        .max();
                    // The ramp of 192 colours has steps of at most 3, and the lookup ignores three bits (up
                    // to 7).
                    assert!(far <= Some(9), "({column}, {row}): {wanted:?} {found:?}");
                }
            }
        }
    }

    /// The mark moves along the curve, and nothing else changes in the part of the curve.
    #[test]
    fn the_mark_stands_at_the_instant() {
        let movie = movie(20, 10);
        let pictures = MoviePictures::new(&movie, MovieSize::Usual).unwrap();
        let [first, last] = [0, 2].map(|index| pictures.draw(index));
        let mark = |pixels: &[u8], time_star: f64| {
            let x = pictures.x.at(time_star) as usize / MovieSize::Usual.drawn();
            let y = pictures.mu.end as usize / MovieSize::Usual.drawn() + 30;
            let colour = pictures.palette()[usize::from(pixels[y * PIXELS[0] + x])];
            colour[0] > 150 && colour[1] < 140
        };
        assert!(mark(&last, 20.0) && !mark(&first, 20.0));
        let changed = (0..first.len()).filter(|&at| first[at] != last[at]);
        let in_curve = changed.filter(|at| at % PIXELS[0] > CURVE_LEFT as usize / MovieSize::Usual.drawn());
        // Two lines of two pixels, with their smoothed edges, and two dots.
        assert!(in_curve.count() < 2 * 4 * 290 + 500);
    }

    #[test]
    fn every_shape_is_drawn() {
        for (nx, ny) in [(1, 1), (300, 1), (1, 300), (1000, 4), (257, 256)] {
            let movie = movie(nx, ny);
            let pictures = MoviePictures::new(&movie, MovieSize::Usual).unwrap();
            let MovieLayout { map, room, bar, .. } = pictures.layout;
            assert!(map.x >= room.x && map.right() <= room.right(), "{nx} x {ny}");
            assert!(map.bottom() <= TOP + MAP_SIDE && map.height >= 40.0 && map.width >= 40.0);
            assert!(bar.x >= map.right() && pictures.mu.end < pictures.mu.start);
            pictures.draw(1);
        }
    }

    /// A long slider fills the picture from side to side, above its curve.
    #[test]
    fn a_long_slider_fills_the_picture() {
        let movie = movie(200, 10);
        let pictures = MoviePictures::new(&movie, MovieSize::Usual).unwrap();
        let MovieLayout { map, curve_top, .. } = pictures.layout;
        // Six pixels for each of 200 blocks.
        assert_eq!(map.width, 1200.0);
        assert!(map.height >= LONG_SIDE * MIN_RATIO_ABOVE - 20.0 && curve_top > map.bottom());
        assert!(pictures.x.start < 200.0 && pictures.x.end > 1500.0);
        assert!(pictures.mu.start - pictures.mu.end > 300.0);
    }

    #[test]
    fn pictures_have_the_size_that_is_asked_for() {
        let movie = movie(20, 10);
        for (size, pixels) in [
            (MovieSize::Small, [400, 200]),
            (MovieSize::Usual, [800, 400]),
            (MovieSize::Large, [1600, 800]),
        ] {
            let pictures = MoviePictures::new(&movie, size).unwrap();
            assert_eq!(size.pixels(), pixels);
            assert_eq!(pictures.draw(0).len(), pixels[0] * pixels[1]);
        }
    }

    /// Letters of instants at one point are joined.
    #[test]
    fn letters_at_one_point_are_joined() {
        let mut movie = movie(20, 10);
        movie.curve.instants = [('A', 10.0), ('B', 10.01), ('C', 20.0)]
            .map(|(letter, x)| crate::friction_curve::Instant {
                letter,
                x,
                friction: 0.01 * x,
            })
            .to_vec();
        let pictures = MoviePictures::new(&movie, MovieSize::Usual).unwrap();
        let mut canvas = blank();
        pictures.draw_curve(&mut canvas);
        let written: Vec<&str> = canvas
            .elements
            .iter()
            .filter_map(|element| match &element.primitive {
                crate::canvas::Primitive::Letters(letters) => Some(letters.text.as_str()),
                _ => None,
            })
            .collect();
        assert!(
            written.contains(&"A, B") && written.contains(&"C") && !written.contains(&"A"),
            "{written:?}"
        );
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let said = |change: &dyn Fn(&mut Movie)| {
            let mut movie = movie(2, 3);
            change(&mut movie);
            MoviePictures::new(&movie, MovieSize::Usual)
                .err()
                .unwrap()
                .to_string()
        };
        assert_eq!(said(&|m| m.snapshots.maps.clear()), "there is no map to draw");
        assert_eq!(
            said(&|m| m.snapshots.lattice.nx = 0),
            "a lattice of 0 x 3 blocks cannot be drawn"
        );
        assert_eq!(
            said(&|m| m.snapshots.maps[1].values.push(0.0)),
            "the map at t* = 10 has 7 values instead of 6"
        );
    }
}
