//! A TrueType font of the few letters of one picture, as a PDF embeds it, with only the tables that a PDF
//! requires. The outlines are those of `font.rs`, rounded to whole units of the font.

use tiny_skia::{PathSegment, Point};

use crate::font::{UNITS_PER_EM, advance, outline};

/// Lines above and below the baseline within which the letters of the font lie, in units of the font.
pub(crate) const ASCENT: i16 = 1901;
pub(crate) const DESCENT: i16 = -483;

/// A glyph as encoded in the font.
struct EncodedGlyph {
    data: Vec<u8>,
    width: u16,
    /// Lowest x, lowest y, highest x and highest y.
    bounds: [i16; 4],
    points: u16,
    contours: u16,
}

/// A point of a contour, and whether it is on the curve.
type OutlinePoint = ([i16; 2], bool);

/// A font with the glyphs of `letters`; glyph 0 represents letters that the font lacks.
pub(crate) fn font_of(letters: &[char]) -> Vec<u8> {
    let missing = std::iter::once('\u{0}');
    let glyphs: Vec<EncodedGlyph> = missing.chain(letters.iter().copied()).map(encoded).collect();
    let (mut glyf, mut loca, mut hmtx) = (Vec::new(), vec![0; 4], Vec::new());
    for glyph in &glyphs {
        glyf.extend(&glyph.data);
        loca.extend((glyf.len() as u32).to_be_bytes());
        put(&mut hmtx, &[glyph.width as i16, glyph.bounds[0]]);
    }
    let lowest = |side: usize| glyphs.iter().map(|glyph| glyph.bounds[side]).min().unwrap_or(0);
    let highest = |side: usize| glyphs.iter().map(|glyph| glyph.bounds[side]).max().unwrap_or(0);
    let bounds = [lowest(0), lowest(1), highest(2), highest(3)];
    let widest = glyphs.iter().map(|glyph| glyph.width).max().unwrap_or(0);
    let count = glyphs.len() as i16;

    // Version 1 of table and font, no checksum of the whole, the magic number; then baseline and left side
    // bearings at zero, the units, and no dates.
    let mut head = vec![0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0x5f, 0x0f, 0x3c, 0xf5, 0, 3];
    put(&mut head, &[UNITS_PER_EM as i16]);
    head.extend([0; 16]);
    put(&mut head, &bounds);
    // No style, legible from 8 pixels on, from left to right, long offsets in `loca`.
    put(&mut head, &[0, 8, 2, 1, 0]);
    let mut hhea = vec![0, 1, 0, 0];
    put(
        &mut hhea,
        &[ASCENT, DESCENT, 0, widest as i16, bounds[0], 0, bounds[2], 1],
    );
    hhea.extend([0; 14]);
    put(&mut hhea, &[count]);
    let most = |of: fn(&EncodedGlyph) -> u16| glyphs.iter().map(of).max().unwrap_or(0) as i16;
    let mut maxp = vec![0, 1, 0, 0];
    put(
        &mut maxp,
        &[count, most(|glyph| glyph.points), most(|glyph| glyph.contours)],
    );
    // No composite glyphs, no instructions, and one zone.
    put(&mut maxp, &[0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0]);
    file(&[
        (b"glyf", glyf),
        (b"head", head),
        (b"hhea", hhea),
        (b"hmtx", hmtx),
        (b"loca", loca),
        (b"maxp", maxp),
    ])
}

/// Width of a letter in units of the font.
pub(crate) fn units(letter: char) -> f64 {
    advance(letter) * f64::from(UNITS_PER_EM)
}

fn put(bytes: &mut Vec<u8>, numbers: &[i16]) {
    bytes.extend(numbers.iter().flat_map(|number| number.to_be_bytes()));
}

/// The contours of a letter.
fn contours(letter: char) -> Vec<Vec<OutlinePoint>> {
    let whole = |point: Point| [point.x, point.y].map(|units| units.round() as i16);
    let mut contours: Vec<Vec<OutlinePoint>> = Vec::new();
    for part in outline(letter) {
        if let PathSegment::MoveTo(_) = part {
            contours.push(Vec::new());
        }
        let Some(contour) = contours.last_mut() else {
            continue;
        };
        match part {
            PathSegment::MoveTo(point) | PathSegment::LineTo(point) => contour.push((whole(point), true)),
            PathSegment::QuadTo(control, end) => {
                contour.extend([(whole(control), false), (whole(end), true)]);
            }
            // TrueType closes contours implicitly, and has no cubic curves.
            PathSegment::Close | PathSegment::CubicTo(..) => {
                if contour.len() > 1 && contour.first() == contour.last() {
                    contour.pop();
                }
            }
        }
    }
    contours
}

fn encoded(letter: char) -> EncodedGlyph {
    let contours = contours(letter);
    let points: Vec<OutlinePoint> = contours.concat();
    let along = |axis: usize| points.iter().map(move |(point, _)| point[axis]);
    let lowest = |axis: usize| along(axis).min().unwrap_or(0);
    let highest = |axis: usize| along(axis).max().unwrap_or(0);
    let bounds = [lowest(0), lowest(1), highest(0), highest(1)];
    let mut data = Vec::new();
    if !points.is_empty() {
        put(&mut data, &[contours.len() as i16]);
        put(&mut data, &bounds);
        let mut end = -1;
        for contour in &contours {
            end += contour.len() as i16;
            put(&mut data, &[end]);
        }
        // No instructions; then a flag for each point, and its steps from the point before it.
        put(&mut data, &[0]);
        data.extend(points.iter().map(|(_, is_on)| u8::from(*is_on)));
        for axis in 0..2 {
            let before = std::iter::once(0).chain(along(axis));
            let steps: Vec<i16> = along(axis).zip(before).map(|(at, before)| at - before).collect();
            put(&mut data, &steps);
        }
        data.resize(data.len().next_multiple_of(4), 0);
    }
    EncodedGlyph {
        data,
        width: units(letter) as u16,
        bounds,
        points: points.len() as u16,
        contours: contours.len() as u16,
    }
}

/// A font file of these tables, which are sorted by name.
fn file(tables: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let count = tables.len() as u16;
    let power = count.ilog2();
    let range = 16 << power;
    let mut file = vec![0, 1, 0, 0];
    for number in [count, range, power as u16, 16 * count - range] {
        file.extend(number.to_be_bytes());
    }
    let mut offset = 12 + 16 * tables.len();
    for (name, table) in tables {
        file.extend(*name);
        for number in [checksum(table), offset as u32, table.len() as u32] {
            file.extend(number.to_be_bytes());
        }
        offset += table.len().next_multiple_of(4);
    }
    for (_, table) in tables {
        file.extend(table);
        file.resize(file.len().next_multiple_of(4), 0);
    }
    file
}

/// Sum of a table's words of four bytes.
fn checksum(table: &[u8]) -> u32 {
    let word = |bytes: &[u8]| {
        let mut word = [0; 4];
        word[..bytes.len()].copy_from_slice(bytes);
        u32::from_be_bytes(word)
    };
    table.chunks(4).map(word).fold(0, u32::wrapping_add)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of this name, found through the directory of the file.
    fn table<'f>(file: &'f [u8], name: &[u8; 4]) -> &'f [u8] {
        let entry = file[12..]
            .chunks(16)
            .find(|entry| entry.starts_with(name))
            .unwrap();
        let number = |at: usize| u32::from_be_bytes(entry[at..at + 4].try_into().unwrap()) as usize;
        &file[number(8)..number(8) + number(12)]
    }

    fn number(table: &[u8], at: usize) -> i16 {
        i16::from_be_bytes([table[at], table[at + 1]])
    }

    #[test]
    fn a_font_has_the_glyphs_of_its_letters_in_their_order() {
        let file = font_of(&[' ', '\u{2212}', 'g']);
        assert_eq!(number(table(&file, b"maxp"), 4), 4);
        let widths = [0, 1, 2, 3].map(|glyph| number(table(&file, b"hmtx"), 4 * glyph));
        assert_eq!(widths, [2048, 651, 1716, 1300]);
        let loca = table(&file, b"loca");
        let offset = |glyph: usize| u32::from_be_bytes(loca[4 * glyph..4 * glyph + 4].try_into().unwrap());
        // A blank has no outline.
        assert_eq!(offset(1), offset(2));
        assert_eq!(offset(4) as usize, table(&file, b"glyf").len());
        // A minus sign is one contour of four corners, from 217 to 1499 along, from 557 to 727 above.
        let minus = &table(&file, b"glyf")[offset(2) as usize..];
        assert_eq!(
            [0, 2, 4, 6, 8].map(|at| number(minus, at)),
            [1, 217, 557, 1499, 727]
        );
        assert_eq!((number(minus, 10), &minus[14..18]), (3, &[1; 4][..]));
    }

    #[test]
    fn tables_are_found_by_their_directory() {
        let file = font_of(&['a']);
        assert_eq!(file[..12], [0, 1, 0, 0, 0, 6, 0, 64, 0, 2, 0, 32]);
        let head = table(&file, b"head");
        assert_eq!((head.len(), &head[12..16]), (54, &[0x5f, 0x0f, 0x3c, 0xf5][..]));
        assert_eq!(
            (table(&file, b"hhea").len(), table(&file, b"maxp").len()),
            (36, 32)
        );
        assert_eq!(checksum(&[0, 0, 0, 1, 0xff, 0xff, 0xff, 0xff, 2]), 0x0200_0000);
    }
}
