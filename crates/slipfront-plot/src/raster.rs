//! A canvas as pixels, drawn by `tiny-skia`. The features `simd` and `std` of `tiny-skia` are off, so that
//! every machine computes the same bits.

use tiny_skia::{
    Color, ColorU8, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PremultipliedColorU8,
    Rect, Stroke, StrokeDash, Transform,
};

use crate::canvas::{Canvas, Element, Letters, Primitive};
use crate::color_image::{Image, palette};
use crate::font;
use crate::geometry::{Area, CanvasPoint};
use crate::style::Rgb;

/// Red, green and blue of every pixel, row by row; none if there are too many for the memory.
pub(crate) fn rgb(canvas: &Canvas) -> Option<Vec<u8>> {
    let [width, height] = canvas.pixels();
    let mut ground = Pixels::blank(width, height)?;
    ground.draw(canvas);
    // Drops the opacity in place: every pixel is opaque, because the page is white.
    let mut bytes = ground.0.take();
    let pixels = bytes.len() / 4;
    for pixel in 0..pixels {
        bytes.copy_within(4 * pixel..4 * pixel + 3, 3 * pixel);
    }
    bytes.truncate(3 * pixels);
    Some(bytes)
}

/// Pixels on which canvases are drawn, one over the other.
#[derive(Clone)]
pub(crate) struct Pixels(Pixmap);

impl Pixels {
    /// White pixels; none if there are too many for the memory.
    pub(crate) fn blank(width: u32, height: u32) -> Option<Self> {
        let mut pixmap = Pixmap::new(width, height)?;
        pixmap.fill(Color::WHITE);
        Some(Self(pixmap))
    }

    /// Draws a canvas over the pixels.
    pub(crate) fn draw(&mut self, canvas: &Canvas) {
        for image in &canvas.images {
            draw_image(&mut self.0, image, canvas.scale);
        }
        for element in &canvas.elements {
            draw(&mut self.0, element, canvas.scale);
        }
    }

    /// The colour of a pixel, counted row by row.
    pub(crate) fn colour(&self, pixel: usize) -> Rgb {
        let pixel = self.0.pixels()[pixel];
        [pixel.red(), pixel.green(), pixel.blue()]
    }
}

/// Draws an element, scaled by a factor; an element without extent draws nothing.
fn draw(pixmap: &mut Pixmap, element: &Element, scale: f64) {
    let [red, green, blue] = element.colour;
    let mut paint = Paint::default();
    paint.set_color_rgba8(red, green, blue, (element.opacity * 255.0).round() as u8);
    let path = match &element.primitive {
        Primitive::Line(line) => path(&line.points, line.closed),
        Primitive::Polygon(points) => path(points, true),
        Primitive::Rectangle(area) => {
            let [x, y, width, height] = area.sides().map(|length| length as f32);
            Rect::from_xywh(x, y, width, height).map(PathBuilder::from_rect)
        }
        Primitive::Disc { centre, radius } => {
            PathBuilder::from_circle(centre.0 as f32, centre.1 as f32, *radius as f32)
        }
        Primitive::Letters(letters) => outlines(letters),
    };
    let Some(path) = path else { return };
    let larger = Transform::from_scale(scale as f32, scale as f32);
    if let Primitive::Line(line) = &element.primitive {
        let stroke = Stroke {
            width: line.width as f32,
            line_cap: LineCap::Butt,
            line_join: LineJoin::Round,
            dash: StrokeDash::new(line.dashes.iter().map(|&length| length as f32).collect(), 0.0),
            ..Stroke::default()
        };
        pixmap.stroke_path(&path, &paint, &stroke, larger, None);
    } else {
        pixmap.fill_path(&path, &paint, FillRule::Winding, larger, None);
    }
}

/// A path through points; none for fewer than two points, or if a coordinate is not a number.
fn path(points: &[CanvasPoint], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for &(x, y) in points {
        if path.is_empty() {
            path.move_to(x as f32, y as f32);
        } else {
            path.line_to(x as f32, y as f32);
        }
    }
    if closed {
        path.close();
    }
    path.finish()
}

/// The outlines of letters on a baseline.
fn outlines(letters: &Letters) -> Option<Path> {
    let mut path = PathBuilder::new();
    let scale = letters.size as f32;
    let [along, above] = letters.directions();
    let mut pen = 0.0;
    for character in letters.text.chars() {
        let origin = [
            letters.at.0 + pen * f64::from(along[0]),
            letters.at.1 + pen * f64::from(along[1]),
        ];
        font::draw(character, &mut path, |right, up| {
            let place = |axis: usize| origin[axis] as f32 + scale * (right * along[axis] + up * above[axis]);
            (place(0), place(1))
        });
        pen += font::advance(character) * f64::from(letters.size);
    }
    path.finish()
}

/// Number of points along each side of a pixel over which the colour of an image is averaged.
const SAMPLES: usize = 4;

/// Draws an image onto whole pixels. Where cells meet within a pixel, their colours are mixed.
fn draw_image(pixmap: &mut Pixmap, image: &Image, scale: f64) {
    let [x, y, width, height] = image.area.sides().map(|side| scale * side);
    let area = Area::new(x, y, width, height);
    let [left, top] = [area.x, area.y].map(|side| side.round() as usize);
    let pitch = pixmap.width() as usize;
    let width = pitch.min(area.right().round() as usize) - left;
    let height = (pixmap.height() as usize).min(area.bottom().round() as usize) - top;
    let colours = palette();
    let columns = cells(image.columns, width);
    let rows = cells(image.rows(), height);
    let mut above = None;
    for (y, rows) in rows.chunks_exact(SAMPLES).enumerate() {
        let start = (top + y) * pitch + left;
        let pixels = pixmap.pixels_mut();
        // Most rows of pixels lie in the same cells as the one above.
        if above.replace(rows) == Some(rows) {
            pixels.copy_within(start - pitch..start - pitch + width, start);
            continue;
        }
        let columns = columns.chunks_exact(SAMPLES);
        for (pixel, columns) in pixels[start..start + width].iter_mut().zip(columns) {
            *pixel = mean_colour(image, rows, columns, &colours);
        }
    }
}

/// The mean of the colours of the samples of a pixel, which lie in these rows and columns of an image.
fn mean_colour(image: &Image, rows: &[usize], columns: &[usize], colours: &[Rgb]) -> PremultipliedColorU8 {
    let mut sums = [0_u16; 3];
    for &row in rows {
        let levels = &image.levels[row * image.columns..];
        for &column in columns {
            let colour = colours[usize::from(levels[column])];
            for (sum, channel) in sums.iter_mut().zip(colour) {
                *sum += u16::from(channel);
            }
        }
    }
    let count = (SAMPLES * SAMPLES) as u16;
    let [red, green, blue] = sums.map(|sum| ((sum + count / 2) / count) as u8);
    ColorU8::from_rgba(red, green, blue, 255).premultiply()
}

/// The cell at every sample along a side.
fn cells(count: usize, pixels: usize) -> Vec<usize> {
    let samples = pixels * SAMPLES;
    let cell = |sample| (2 * sample + 1) * count / (2 * samples);
    (0..samples).map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Align, Area};
    use crate::style::{BLACK, CURVES, WHITE};
    use crate::text::Text;

    /// The colours at some points of a small picture.
    fn pixels<const COUNT: usize>(draw: impl Fn(&mut Canvas), at: [(usize, usize); COUNT]) -> [Rgb; COUNT] {
        let mut canvas = Canvas::new(40.0, 30.0);
        draw(&mut canvas);
        let rgb = rgb(&canvas).unwrap();
        at.map(|(x, y)| {
            let start = (y * 40 + x) * 3;
            [rgb[start], rgb[start + 1], rgb[start + 2]]
        })
    }

    const AREA: Area = Area {
        x: 10.0,
        y: 10.0,
        width: 8.0,
        height: 6.0,
    };

    #[test]
    fn a_line_is_as_wide_as_asked_and_ends_where_it_ends() {
        let line = |canvas: &mut Canvas| canvas.line((10.0, 10.0), (20.0, 10.0), 2.0, BLACK);
        let found = pixels(line, [(10, 9), (19, 10), (9, 9), (20, 10), (15, 8), (15, 11)]);
        assert_eq!(found, [BLACK, BLACK, WHITE, WHITE, WHITE, WHITE]);
        // Half a pixel is half as dark.
        let fine = |canvas: &mut Canvas| canvas.line((10.0, 10.0), (20.0, 10.0), 1.0, [0, 0, 0]);
        let [[red, ..]] = pixels(fine, [(15, 10)]);
        assert!((126..=129).contains(&red), "{red}");
    }

    #[test]
    fn a_frame_has_whole_corners() {
        let found = pixels(
            |canvas| canvas.frame(AREA),
            [(10, 10), (17, 15), (14, 13), (9, 13), (18, 13)],
        );
        assert_eq!(found, [BLACK, BLACK, WHITE, BLACK, BLACK]);
    }

    #[test]
    fn areas_are_filled_to_their_edges() {
        let at = [(10, 10), (17, 15), (18, 15), (9, 10)];
        let fill = |canvas: &mut Canvas| canvas.fill(AREA, CURVES[0], 1.0);
        assert_eq!(pixels(fill, at), [CURVES[0], CURVES[0], WHITE, WHITE]);
        let faint = |canvas: &mut Canvas| canvas.fill(AREA, [0, 0, 0], 0.2);
        assert_eq!(pixels(faint, at)[0], [204, 204, 204]);
        let corners = vec![(10.0, 10.0), (18.0, 10.0), (18.0, 16.0), (10.0, 16.0)];
        let polygon = |canvas: &mut Canvas| canvas.polygon(corners.clone(), CURVES[0], 1.0);
        assert_eq!(pixels(polygon, at), [CURVES[0], CURVES[0], WHITE, WHITE]);
    }

    #[test]
    fn a_dot_has_a_rim() {
        let dot = |canvas: &mut Canvas| {
            let ground = Area { width: 30.0, ..AREA };
            canvas.fill(ground, BLACK, 1.0);
            canvas.dot((20.0, 13.0), 3.8, CURVES[1]);
        };
        assert_eq!(
            pixels(dot, [(20, 13), (24, 13), (11, 13)]),
            [CURVES[1], WHITE, BLACK]
        );
    }

    #[test]
    fn letters_stand_on_their_baseline_and_may_read_upwards() {
        // A minus sign is a bar: from 217 to 1499 of 2048 along, from 557 to 727 above the baseline.
        let minus = Text::plain("\u{2212}", 24);
        let text = |canvas: &mut Canvas| canvas.text(&minus, (10.0, 20.0), Align::Start, BLACK);
        assert_eq!(
            pixels(text, [(13, 12), (26, 12), (20, 10), (20, 15), (11, 12), (30, 12)]),
            [BLACK, BLACK, WHITE, WHITE, WHITE, WHITE]
        );
        let upwards = |canvas: &mut Canvas| canvas.text_upwards(&minus, (20.0, 28.0), Align::Start, BLACK);
        assert_eq!(
            pixels(
                upwards,
                [(12, 24), (12, 11), (10, 18), (15, 18), (12, 27), (12, 8)]
            ),
            [BLACK, BLACK, WHITE, WHITE, WHITE, WHITE]
        );
    }

    #[test]
    fn cells_that_meet_within_a_pixel_are_mixed() {
        let image = |canvas: &mut Canvas| {
            canvas.images.push(Image {
                area: Area { width: 3.0, ..AREA },
                columns: 2,
                levels: vec![0, 254],
            });
        };
        let [dark, mixed, bright] = pixels(image, [(10, 12), (11, 12), (12, 12)]);
        assert_eq!((dark, bright), ([0x44, 0x01, 0x54], [0xfd, 0xe7, 0x25]));
        assert_eq!(mixed, [161, 116, 61]);
    }

    /// Every pixel of an image is the mean of its samples, with more and fewer cells than pixels, and rows of
    /// pixels that lie in one or in several rows of cells.
    #[test]
    fn every_pixel_of_an_image_is_the_mean_of_its_samples() {
        for [columns, rows, width, height] in [[3, 4, 11, 18], [7, 20, 11, 18], [1, 1, 8, 6], [5, 6, 5, 6]] {
            let levels: Vec<u8> = (0..columns * rows).map(|cell| (cell * 97 % 256) as u8).collect();
            let mean_at = |x: usize, y: usize| {
                let cell = |pixel: usize, sample: usize, cells: usize, pixels: usize| {
                    (2 * (SAMPLES * pixel + sample) + 1) * cells / (2 * SAMPLES * pixels)
                };
                let samples = (0..SAMPLES * SAMPLES).map(|k| {
                    let row = cell(y, k / SAMPLES, rows, height);
                    palette()[usize::from(levels[row * columns + cell(x, k % SAMPLES, columns, width)])]
                });
                let samples: Vec<Rgb> = samples.collect();
                [0, 1, 2].map(|channel| {
                    let sum: usize = samples.iter().map(|colour| usize::from(colour[channel])).sum();
                    (sum as f64 / samples.len() as f64).round() as u8
                })
            };
            let mut canvas = Canvas::new(20.0, 25.0);
            canvas.images.push(Image {
                area: Area::new(4.0, 3.0, width as f64, height as f64),
                columns,
                levels: levels.clone(),
            });
            let found = rgb(&canvas).unwrap();
            for (index, found) in found.chunks_exact(3).enumerate() {
                let (x, y) = (index % 20, index / 20);
                let inside = (4..4 + width).contains(&x) && (3..3 + height).contains(&y);
                let expected = if inside { mean_at(x - 4, y - 3) } else { WHITE };
                assert_eq!(found, expected, "{columns} x {rows}: ({x}, {y})");
            }
        }
    }
}
