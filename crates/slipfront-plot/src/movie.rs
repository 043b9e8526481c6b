//! A movie of a run: maps of a field one after the other, beside the friction curve with a mark at the instant that is shown.
//!
//! Pictures of a movie have 800 x 400 pixels of 256 colours at the most. They are drawn twice as large, and every pixel is the mean of
//! four, so that letters are as large as in the other pictures beside their lines.

use crate::axis::DrawnAxis;
use crate::canvas::Canvas;
use crate::cell_means::CellMeans;
use crate::frame::{BAR_WIDTH, bar_room, colour_bar, left_room, left_side, lower_side};
use crate::friction_curve::{FrictionAxes, FrictionCurve};
use crate::geometry::{Align, Area, CanvasPoint};
use crate::label_placement::{Placer, around};
use crate::lattice_map::{Cells, MARK, MIN_RATIO, block_count, check_length, draw_titles};
use crate::movie_colours::Colours;
use crate::picture::{PictureError, check_columns};
use crate::raster::Pixels;
use crate::series::segments;
use crate::style::{
    BLACK, CURVES, GREY, MARGIN, RADIUS_MARKER, SIZE_LABEL, SIZE_TICK, WIDTH_CURVE, WIDTH_LEADER, WIDTH_MARK,
};
use crate::text::{Text, number};
use crate::ticks::{Direction, MAX_STEPS};

/// Pixels of a picture along x and along y.
pub const MOVIE_PIXELS: [usize; 2] = [800, 400];
/// Factor by which a picture is drawn larger.
const DRAWN: usize = 2;
const DRAWN_PIXELS: [usize; 2] = [DRAWN * MOVIE_PIXELS[0], DRAWN * MOVIE_PIXELS[1]];
/// Bytes while a picture is drawn: four for each pixel that is drawn, and one for each that is kept.
pub const MOVIE_PICTURE_BYTES: usize =
    4 * DRAWN_PIXELS[0] * DRAWN_PIXELS[1] + MOVIE_PIXELS[0] * MOVIE_PIXELS[1];
/// Bytes of a picture in its file (measured: 25 kB where all of a map changes).
pub const MOVIE_FILE_BYTES: usize = 25_000;
/// The largest map, as drawn.
const MAP_SIDE: f64 = 600.0;
/// Left end of the map.
const MAP_LEFT: f64 = 2.0 * MARGIN;
/// Upper end of map and curve, below two lines of text.
const TOP: f64 = 110.0;
/// Left end of the curve's part.
const CURVE_LEFT: f64 = 790.0;
/// Lower end of the curve, above its numbers and title.
const CURVE_BOTTOM: f64 = 690.0;

/// A movie of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Movie {
    /// Blocks along x.
    pub nx: usize,
    /// Blocks along y.
    pub ny: usize,
    /// True for every [cell](CellMeans) of which most is textured, row by row from y = 0.
    pub textured: Vec<bool>,
    /// Quantity of the field, over the colour bar; the character after an underscore is a subscript.
    pub title: String,
    /// Values at the ends of the colour bar; values beyond are drawn as the ends.
    pub range: [f64; 2],
    /// The curve against t*.
    pub curve: FrictionCurve,
    /// Titles of the curve's axes.
    pub axes: FrictionAxes,
    /// Pictures in the order of time.
    pub frames: Vec<MovieFrame>,
}

/// A picture of a movie.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MovieFrame {
    /// Letters of the instants A-F that the picture shows, such as "A, B"; may be empty.
    pub label: String,
    /// Time t*.
    pub time_star: f64,
    /// Friction coefficient mu*.
    pub mu_star: f64,
    /// The mean of every [cell](CellMeans), row by row from y = 0; NaN is left blank.
    pub values: Vec<f32>,
}

/// A movie that can be drawn: its layout and its colours.
pub struct MoviePictures<'a> {
    movie: &'a Movie,
    cells: Cells,
    colours: Colours,
    /// Part that is the same in all pictures.
    ground: Pixels,
    map: Area,
    bar: Area,
    x: DrawnAxis,
    mu: DrawnAxis,
}

impl<'a> MoviePictures<'a> {
    /// Lays a movie out.
    ///
    /// # Errors
    /// A lattice without blocks, an array of the wrong length, no picture, or no memory for one.
    pub fn of(movie: &'a Movie) -> Result<Self, PictureError> {
        block_count(movie.nx, movie.ny)?;
        let [columns, rows] = CellMeans::cells(movie.nx, movie.ny);
        if movie.frames.is_empty() {
            return Err(PictureError::Nothing("snapshot"));
        }
        check_length("the texture", movie.textured.len(), columns * rows)?;
        for frame in &movie.frames {
            let what = format!("the map at t* = {}", frame.time_star);
            check_length(&what, frame.values.len(), columns * rows)?;
        }
        let curve = &movie.curve;
        check_columns(
            &curve.label,
            ("times", curve.x.len()),
            &[("friction", curve.friction.len())],
        )?;
        let map = map_area(movie.nx, movie.ny, [columns, rows]);
        let bar_left = MAP_LEFT + MAP_SIDE + 2.0 * MARGIN;
        let bar = Area::new(bar_left, TOP, BAR_WIDTH, CURVE_BOTTOM - TOP);
        let times = movie.frames.iter().map(|frame| frame.time_star);
        let times: Vec<f64> = curve.x.iter().copied().chain(times).collect();
        let frictions: Vec<f64> = curve.friction.iter().copied().chain([0.0]).collect();
        let mu = DrawnAxis::around(&frictions, false, 0.06).placed(CURVE_BOTTOM, TOP);
        let right = DRAWN_PIXELS[0] as f64 - 3.0 * MARGIN;
        let left = CURVE_LEFT + left_room(&mu.ticks(Direction::Y, MAX_STEPS));
        let [width, height] = DRAWN_PIXELS.map(|pixels| pixels as u32);
        let mut pictures = Self {
            movie,
            cells: Cells::of(movie.nx, movie.ny, &movie.textured),
            colours: Colours::default(),
            ground: Pixels::blank(width, height).ok_or_else(no_memory)?,
            map,
            bar,
            x: DrawnAxis::around(&times, false, 0.0).placed(left, right),
            mu,
        };
        let mut canvas = blank();
        pictures.draw_bar(&mut canvas);
        pictures.draw_curve(&mut canvas);
        pictures.ground.draw(&canvas);
        Ok(pictures)
    }

    /// The colours of the pixels: red, green and blue of each.
    pub fn palette(&self) -> &[[u8; 3]] {
        self.colours.palette()
    }

    /// A picture: the colour of every pixel, row by row from the top.
    pub fn draw(&self, index: usize) -> Vec<u8> {
        let mut canvas = blank();
        let frame = &self.movie.frames[index];
        self.draw_map(&mut canvas, frame);
        self.draw_mark(&mut canvas, frame);
        let mut drawn = self.ground.clone();
        drawn.draw(&canvas);
        let [nx, ny] = MOVIE_PIXELS;
        let pixel = |at: usize| {
            let first = DRAWN * (at / nx) * DRAWN_PIXELS[0] + DRAWN * (at % nx);
            let mut sum = [0_u32; 3];
            for k in 0..DRAWN * DRAWN {
                let colour = drawn.colour(first + k / DRAWN * DRAWN_PIXELS[0] + k % DRAWN);
                for (sum, channel) in sum.iter_mut().zip(colour) {
                    *sum += u32::from(channel);
                }
            }
            let count = (DRAWN * DRAWN) as u32;
            self.colours
                .nearest(sum.map(|sum| ((sum + count / 2) / count) as u8))
        };
        (0..nx * ny).map(pixel).collect()
    }

    fn draw_map(&self, canvas: &mut Canvas, frame: &MovieFrame) {
        let movie = self.movie;
        self.cells.draw(canvas, self.map, &frame.values, movie.range);
        canvas.frame(self.map);
        let time = format!("t* = {}", number(frame.time_star, 1));
        let label = match frame.label.as_str() {
            "" => time,
            letters => format!("{letters}: {time}"),
        };
        let friction = if frame.mu_star.is_finite() {
            Text::plain(&format!("\u{3bc}* = {}", number(frame.mu_star, 3)), SIZE_TICK)
        } else {
            Text::default()
        };
        let room = Area::new(MAP_LEFT, TOP, MAP_SIDE, MAP_SIDE);
        draw_titles(canvas, room, &Text::plain(&label, SIZE_LABEL), &friction);
    }

    fn draw_bar(&self, canvas: &mut Canvas) {
        let movie = self.movie;
        colour_bar(canvas, self.bar, movie.range);
        let title = Text::math(&movie.title, SIZE_LABEL);
        let room = bar_room(movie.range, self.bar.height);
        let start = (self.bar.x + room - title.width()).min(self.bar.x);
        canvas.text(&title, (start, self.bar.y - 22.0), Align::Start, BLACK);
    }

    fn curve_area(&self) -> Area {
        Area::between(self.x.start, self.x.end, self.mu.start, self.mu.end)
    }

    fn draw_curve(&self, canvas: &mut Canvas) {
        let (movie, curve) = (self.movie, &self.movie.curve);
        let area = self.curve_area();
        let title = Text::math(&movie.axes.friction, SIZE_LABEL);
        left_side(
            canvas,
            area,
            CURVE_LEFT,
            &self.mu.ticks(Direction::Y, MAX_STEPS),
            &title,
        );
        let title = Text::math(&movie.axes.x, SIZE_LABEL);
        lower_side(canvas, area, &self.x.ticks(Direction::X, MAX_STEPS), &title);
        let mut placer = Placer::new(area);
        for segment in segments(&curve.x, &curve.friction, &self.x, &self.mu) {
            placer.avoid(&segment);
            canvas.polyline(segment, WIDTH_CURVE, CURVES[0]);
        }
        let dots: Vec<CanvasPoint> = curve
            .instants
            .iter()
            .map(|instant| (self.x.at(instant.x), self.mu.clamped(instant.friction)))
            .collect();
        for (instant, &dot) in curve.instants.iter().zip(&dots) {
            canvas.dot(dot, RADIUS_MARKER, GREY);
            let letter = Text::plain(&instant.letter.to_string(), SIZE_TICK);
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
    fn draw_mark(&self, canvas: &mut Canvas, frame: &MovieFrame) {
        let area = self.curve_area();
        let now = self.x.clamped(frame.time_star);
        canvas.line((now, area.y), (now, area.bottom()), WIDTH_MARK, MARK);
        if frame.mu_star.is_finite() {
            canvas.dot((now, self.mu.clamped(frame.mu_star)), RADIUS_MARKER, MARK);
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

/// Area of the map, in the middle of its room: every cell has an equal, whole number of pixels.
fn map_area(nx: usize, ny: usize, cells: [usize; 2]) -> Area {
    let ratio = (ny as f64 / nx as f64).clamp(MIN_RATIO, 1.0 / MIN_RATIO);
    let sides = [MAP_SIDE.min(MAP_SIDE / ratio), MAP_SIDE.min(MAP_SIDE * ratio)];
    let whole = |axis: usize| {
        let cell = (DRAWN * cells[axis]) as f64;
        (sides[axis] / cell).floor().max(1.0) * cell
    };
    let drawn = DRAWN as f64;
    let indent = (0.5 * (MAP_SIDE - whole(0)) / drawn).floor() * drawn;
    Area::new(MAP_LEFT + indent, TOP, whole(0), whole(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn movie(nx: usize, ny: usize) -> Movie {
        let [columns, rows] = CellMeans::cells(nx, ny);
        let frame = |k: usize| MovieFrame {
            label: if k == 1 { "A, B".to_owned() } else { String::new() },
            time_star: 10.0 * k as f64,
            mu_star: 0.1 * k as f64,
            values: (0..columns * rows).map(|cell| (cell % 7) as f32 / 7.0).collect(),
        };
        Movie {
            nx,
            ny,
            textured: (0..columns * rows).map(|cell| cell % 5 == 0).collect(),
            title: "\u{3c4}_c*".to_owned(),
            range: [0.0, 1.0],
            curve: FrictionCurve {
                x: (0..100).map(|k| 0.3 * f64::from(k)).collect(),
                friction: (0..100).map(|k| 0.003 * f64::from(k)).collect(),
                ..FrictionCurve::default()
            },
            axes: FrictionAxes::default(),
            frames: (0..3).map(frame).collect(),
        }
    }

    /// Positions of map and curve, in pixels of the picture.
    fn halves(area: Area) -> [usize; 4] {
        area.sides().map(|side| side as usize / DRAWN)
    }

    /// Every block of the map has its own colour in whole pixels, with no others between.
    #[test]
    fn blocks_have_whole_pixels_of_their_colour() {
        let mut movie = movie(100, 100);
        movie.textured.fill(false);
        let pictures = MoviePictures::of(&movie).unwrap();
        let pixels = pictures.draw(2);
        assert_eq!(pixels.len(), MOVIE_PIXELS[0] * MOVIE_PIXELS[1]);
        let [left, top, width, height] = halves(pictures.map);
        assert_eq!([width, height], [300, 300]);
        // The edge of the map is drawn over the outermost pixels.
        for row in 1..99 {
            for column in 1..99 {
                // Row 0 of the blocks is the lowest.
                let share = f64::from(((99 - row) * 100 + column) % 7) / 7.0;
                let wanted = crate::style::ramp(share);
                for k in 0..9 {
                    let (x, y) = (left + 3 * column as usize + k % 3, top + 3 * row as usize + k / 3);
                    let found = pictures.palette()[usize::from(pixels[y * MOVIE_PIXELS[0] + x])];
                    let far = wanted
                        .iter()
                        .zip(found)
                        .map(|(one, other)| one.abs_diff(other))
                        .max();
                    // Of 255 levels to 192 colours, steps of at most 3, looked up without three bits, up to 7.
                    assert!(far <= Some(9), "({column}, {row}): {wanted:?} {found:?}");
                }
            }
        }
    }

    /// The mark moves along the curve, and nothing else of the curve's part changes.
    #[test]
    fn the_mark_stands_at_the_instant() {
        let movie = movie(20, 10);
        let pictures = MoviePictures::of(&movie).unwrap();
        let [first, last] = [0, 2].map(|index| pictures.draw(index));
        let mark = |pixels: &[u8], time_star: f64| {
            let x = pictures.x.at(time_star) as usize / DRAWN;
            let y = pictures.mu.end as usize / DRAWN + 30;
            let colour = pictures.palette()[usize::from(pixels[y * MOVIE_PIXELS[0] + x])];
            colour[0] > 150 && colour[1] < 140
        };
        assert!(mark(&last, 20.0) && !mark(&first, 20.0));
        let changed = (0..first.len()).filter(|&at| first[at] != last[at]);
        let in_curve = changed.filter(|at| at % MOVIE_PIXELS[0] > CURVE_LEFT as usize / DRAWN);
        // Two lines of two pixels, with their smoothed edges, and two dots.
        assert!(in_curve.count() < 2 * 4 * 290 + 500);
    }

    #[test]
    fn every_shape_is_drawn() {
        for (nx, ny) in [(1, 1), (300, 1), (1, 300), (1000, 4), (257, 256)] {
            let movie = movie(nx, ny);
            let pictures = MoviePictures::of(&movie).unwrap();
            let map = pictures.map;
            assert!(map.x >= 0.0 && map.right() <= MAP_LEFT + MAP_SIDE, "{nx} x {ny}");
            assert!(map.bottom() <= TOP + MAP_SIDE && map.height >= 40.0 && map.width >= 40.0);
            pictures.draw(1);
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let said = |change: &dyn Fn(&mut Movie)| {
            let mut movie = movie(2, 3);
            change(&mut movie);
            MoviePictures::of(&movie).err().unwrap().to_string()
        };
        assert_eq!(said(&|m| m.frames.clear()), "there is no snapshot to draw");
        assert_eq!(said(&|m| m.nx = 0), "a lattice of 0 x 3 blocks cannot be drawn");
        assert_eq!(
            said(&|m| m.frames[1].values.push(0.0)),
            "the map at t* = 10 has 7 values where 6 are wanted"
        );
    }
}
