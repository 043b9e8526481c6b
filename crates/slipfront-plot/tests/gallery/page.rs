//! Positions of texts and curves on the page of a picture, found from its SVG.

use std::collections::HashMap;

/// The widths of letters, of a font 2048 units high.
const OUTLINES: &str = include_str!("../../src/font/outlines.txt");
/// Height of letters above the line, and depth of some of them below it, over the font size.
const ABOVE: f64 = 0.73;
const BELOW: f64 = 0.24;
const DESCENDING: [char; 9] = ['g', 'j', 'p', 'q', 'y', '\u{3bc}', '(', ')', ','];
/// Tolerance in pixels: coordinates of an SVG are rounded to hundredths of a pixel, and letters of a word
/// touch.
const ROUNDING: f64 = 0.1;

/// A rectangle: from x and y, to x and y.
pub(crate) type Sides = [f64; 4];

/// A text and the rectangle that it fills.
#[derive(Clone, Debug)]
pub(crate) struct TypesetLine {
    pub(crate) text: String,
    pub(crate) sides: Sides,
}

/// A page with its texts and curves.
pub(crate) struct Page {
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) texts: Vec<TypesetLine>,
    /// The corners of the lines that are as thick as curves.
    pub(crate) curves: Vec<Vec<[f64; 2]>>,
}

impl Page {
    pub(crate) fn parse(svg: &str) -> Self {
        let widths: HashMap<&str, f64> = OUTLINES.lines().filter_map(width).collect();
        let advance = |letter: char| {
            let code = format!("{:x}", u32::from(letter));
            // A letter that the font lacks is taken to be as wide as the font is high.
            widths.get(code.as_str()).map_or(1.0, |units| units / 2048.0)
        };
        let view: Vec<f64> = numbers(attribute(svg, "viewBox").unwrap());
        let texts = svg.lines().filter(|line| line.starts_with("<text "));
        let curves = svg
            .lines()
            .filter(|line| line.contains("fill=\"none\"") && line.contains("stroke-width=\"3.75\""));
        Self {
            width: view[2],
            height: view[3],
            texts: texts.map(|line| written(line, &advance)).collect(),
            curves: curves.map(corners).collect(),
        }
    }

    /// Faults of the texts: one that leaves the page, two that overlap.
    pub(crate) fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (index, written) in self.texts.iter().enumerate() {
            let TypesetLine { text, sides } = written;
            let [from, top, to, bottom] = *sides;
            if from < 0.0 || top < 0.0 || to > self.width || bottom > self.height {
                faults.push(format!("`{text}` leaves the page: {sides:.0?}"));
            }
            let others = self.texts[..index].iter();
            let over = others.filter(|other| overlap(&other.sides, sides));
            faults.extend(over.map(|other| format!("`{text}` lies over `{}`", other.text)));
        }
        faults
    }

    /// The texts that a curve runs through.
    pub(crate) fn crossed(&self) -> Vec<&str> {
        let is_crossed = |written: &&TypesetLine| {
            let segments = self.curves.iter().flat_map(|points| points.windows(2));
            segments
                .into_iter()
                .any(|segment| crosses(segment, &written.sides))
        };
        let crossed = self.texts.iter().filter(is_crossed);
        crossed.map(|written| written.text.as_str()).collect()
    }
}

/// The code of a glyph and its width.
fn width(line: &str) -> Option<(&str, f64)> {
    let mut parts = line.split(' ');
    Some((parts.next()?, parts.next()?.parse().ok()?))
}

/// The value of an attribute of a tag.
fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = tag.split_once(&format!(" {name}=\""))?;
    rest.split_once('"').map(|(value, _)| value)
}

fn numbers(text: &str) -> Vec<f64> {
    let words = text.split(|c: char| c == 'M' || c == 'Z' || c.is_whitespace());
    let words = words.filter(|word| !word.is_empty());
    words.map(|word| word.parse().unwrap()).collect()
}

fn corners(line: &str) -> Vec<[f64; 2]> {
    let numbers = numbers(attribute(line, "d").unwrap());
    numbers
        .chunks_exact(2)
        .map(|point| [point[0], point[1]])
        .collect()
}

fn written(line: &str, advance: &impl Fn(char) -> f64) -> TypesetLine {
    let number = |name: &str| -> f64 { attribute(line, name).unwrap().parse().unwrap() };
    let (_, rest) = line.split_once('>').unwrap();
    let text = rest.strip_suffix("</text>").unwrap();
    let text = text
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&");
    let (x, y, size) = (number("x"), number("y"), number("font-size"));
    let length = size * text.chars().map(advance).sum::<f64>();
    let below = if text.contains(DESCENDING) {
        BELOW * size
    } else {
        0.0
    };
    let sides = match attribute(line, "transform") {
        None => [x, y - ABOVE * size, x + length, y + below],
        Some(_) => [x - ABOVE * size, y - length, x + below, y],
    };
    TypesetLine { text, sides }
}

fn overlap(a: &Sides, b: &Sides) -> bool {
    a[0] + ROUNDING < b[2] && b[0] + ROUNDING < a[2] && a[1] + ROUNDING < b[3] && b[1] + ROUNDING < a[3]
}

/// Whether a segment has a point within a rectangle, tried at every half pixel.
fn crosses(segment: &[[f64; 2]], [from, top, to, bottom]: &Sides) -> bool {
    let [start, end] = [segment[0], segment[1]];
    let length = (end[0] - start[0]).hypot(end[1] - start[1]);
    let steps = (2.0 * length).ceil().max(1.0) as usize;
    (0..=steps).any(|step| {
        let share = step as f64 / steps as f64;
        let [x, y] = [0, 1].map(|axis| start[axis] + share * (end[axis] - start[axis]));
        (*from..=*to).contains(&x) && (*top..=*bottom).contains(&y)
    })
}

#[test]
fn faults_are_found() {
    let svg = |texts: &str| format!("<svg viewBox=\"0 0 100 50\">\n{texts}");
    let text = |x: f64, y: f64, letters: &str| {
        format!("<text x=\"{x}\" y=\"{y}\" font-size=\"20\" fill=\"#1a1a1a\">{letters}</text>\n")
    };
    let faults = |texts: &str| Page::parse(&svg(texts)).faults();
    assert!(faults(&(text(5.0, 20.0, "ab") + &text(35.0, 20.0, "ab"))).is_empty());
    assert_eq!(
        faults(&(text(5.0, 20.0, "a") + &text(15.0, 30.0, "b"))),
        ["`b` lies over `a`"]
    );
    assert!(faults(&text(90.0, 20.0, "ab"))[0].contains("leaves the page"));
    assert!(faults(&text(5.0, 10.0, "a"))[0].contains("leaves the page"));
    let curve = "<path d=\"M0 0 50 40\" fill=\"none\" stroke=\"#000000\" stroke-width=\"3.75\"/>\n";
    let page = Page::parse(&svg(&(text(20.0, 30.0, "ab") + &text(60.0, 30.0, "c") + curve)));
    assert_eq!(page.crossed(), ["ab"]);
}
