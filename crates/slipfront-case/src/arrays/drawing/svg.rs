//! Outlines of an SVG: its filled shapes.

use roxmltree::Node;
use slipfront::surface::Part;
use slipfront_base::number_format::count;
use slipfront_base::text::single_line;
use svgtypes::{
    Length, LengthUnit, PathParser, PathSegment, TransformListParser, TransformListToken, ViewBox,
};

use super::outlines::{Drawing, MAX_DEPTH, SLIDER_LAYER};
use super::pen::{Budget, Map, Pen, Point, difference, direction, length};
use super::svg_style::{Paint, Rules, Style};
use super::tree;

/// Largest number of nodes of the file.
const NODES_MAX: u32 = 1 << 20;
/// User units of an inch.
const PIXELS_PER_INCH: f64 = 96.0;
const MM_PER_INCH: f64 = 25.4;
/// Largest relative difference of the scales along x and y: they are rounded in the file.
const SAME_SCALE: f64 = 1e-3;
/// Namespace of the names of layers.
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
/// Elements that draw nothing where they stand.
const NOT_DRAWN: [&str; 13] = [
    "defs",
    "title",
    "desc",
    "metadata",
    "style",
    "clipPath",
    "mask",
    "symbol",
    "marker",
    "linearGradient",
    "radialGradient",
    "pattern",
    "filter",
];

pub(super) fn read(bytes: &[u8], block: f64) -> Result<Drawing, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        format!(
            "is not UTF-8 text after {} bytes: save it as plain SVG",
            error.valid_up_to()
        )
    })?;
    let text = without_type(text)?;
    let remedy = |sentence: String| format!("is not a readable drawing: {sentence}; save it as plain SVG");
    let document = tree::parse("the file", &text, NODES_MAX).map_err(remedy)?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(format!(
            "begins with <{}>, not <svg>: save it as plain SVG",
            root.tag_name().name()
        ));
    }
    let mut reader = Reader {
        rules: Rules::read(&document)?,
        budget: Budget::new(),
        parts: Vec::new(),
        hidden: LeftOut::default(),
        flat: LeftOut::default(),
    };
    let page = page(root, block)?;
    reader.group(root, page.after(transform(root)?), Style::INITIAL, 0)?;
    let mut notes = Vec::new();
    for (found, what) in [(reader.hidden, "not shown"), (reader.flat, "without an area")] {
        if let Some(first) = found.first {
            notes.push(format!(
                "{what}, and so no texture: {}, the first in line {first}",
                count(found.count, "element")
            ));
        }
    }
    Ok(Drawing {
        parts: reader.parts,
        notes,
    })
}

/// The text without a document type, as older programs write: it only names the standard.
fn without_type(text: &str) -> Result<String, String> {
    let Some(from) = text.find("<!DOCTYPE") else {
        return Ok(text.to_owned());
    };
    let end = text[from..].find(['>', '[']).map(|at| from + at);
    match end.filter(|&end| text.as_bytes()[end] == b'>') {
        Some(end) => {
            // The numbers of lines remain.
            let lines = text[from..end].matches('\n').count();
            Ok(format!(
                "{}{}{}",
                &text[..from],
                "\n".repeat(lines),
                &text[end + 1..]
            ))
        }
        None => Err("declares entities in its document type: save it as plain SVG".to_owned()),
    }
}

/// The map from user units, y downwards, to blocks, y upwards.
fn page(root: Node, block: f64) -> Result<Map, String> {
    let millimetres = |name: &str| {
        let written = root.attribute(name).unwrap_or_default();
        let length = written.trim().parse::<Length>().ok();
        let unit = match length.map(|length| length.unit) {
            Some(LengthUnit::Mm) => 1.0,
            Some(LengthUnit::Cm) => 10.0,
            Some(LengthUnit::In) => MM_PER_INCH,
            Some(LengthUnit::Pt) => MM_PER_INCH / 72.0,
            Some(LengthUnit::Pc) => MM_PER_INCH / 6.0,
            _ => {
                return Err(format!(
                    "states no true size: its `{name}` is \"{}\"; give width and height of the page in mm, as in width=\"10mm\" \
                     (Inkscape: Document Properties)",
                    single_line(written)
                ));
            }
        };
        let number = length.map_or(f64::NAN, |length| length.number);
        if number * unit > 0.0 {
            return Ok(number * unit);
        }
        Err(format!(
            "has a page with the {name} \"{}\": give one above 0",
            single_line(written)
        ))
    };
    let [width, height] = [millimetres("width")?, millimetres("height")?];
    let pixel = MM_PER_INCH / PIXELS_PER_INCH;
    let [x, y, columns, rows] = match root.attribute("viewBox") {
        None => [0.0, 0.0, width / pixel, height / pixel],
        Some(text) => {
            let given = text.parse::<ViewBox>();
            let given =
                given.map_err(|error| format!("has the viewBox \"{}\": {error}", single_line(text)))?;
            [given.x, given.y, given.w, given.h]
        }
    };
    let scale = [width / columns, height / rows];
    let ratio = scale[0] / scale[1];
    if ratio.is_nan() || (ratio - 1.0).abs() > SAME_SCALE {
        return Err(format!(
            "shows {columns} x {rows} user units on {width} mm x {height} mm, which is not to scale: give width and height in the \
             ratio of the viewBox"
        ));
    }
    let upwards = Map([scale[0] / block, 0.0, 0.0, -scale[1] / block, 0.0, height / block]);
    Ok(upwards.after(Map::shift([-x, -y])))
}

/// Line of the file in which an element begins.
fn line(node: Node) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

/// An error about an element; `problem` follows its name.
fn about(node: Node, problem: &str) -> String {
    let name = node.tag_name().name();
    format!("has a <{}> in line {} {problem}", single_line(name), line(node))
}

/// Refuses an element; `problem` follows its name.
fn refuse<T>(node: Node, problem: &str) -> Result<T, String> {
    Err(about(node, problem))
}

struct Reader<'x> {
    rules: Rules<'x>,
    budget: Budget,
    parts: Vec<Part>,
    /// Elements that are not shown, and those that have no area.
    hidden: LeftOut,
    flat: LeftOut,
}

/// Elements that are no texture: how many, and the line of the first, which is found by counting all lines
/// before it.
#[derive(Default)]
struct LeftOut {
    count: usize,
    first: Option<u32>,
}

impl LeftOut {
    fn add(&mut self, node: Node) {
        self.count += 1;
        self.first.get_or_insert_with(|| line(node));
    }
}

impl<'x> Reader<'x> {
    fn group(&mut self, group: Node<'x, 'x>, map: Map, style: Style, depth: usize) -> Result<(), String> {
        if depth > MAX_DEPTH {
            return refuse(
                group,
                &format!("within more than {MAX_DEPTH} groups: ungroup them"),
            );
        }
        let style = self.rules.style(group, style);
        for node in group.children().filter(Node::is_element) {
            self.budget.take(1.0)?;
            // Other programs' own notes have other namespaces.
            if node.tag_name().namespace() == group.tag_name().namespace() {
                self.element(node, map, style, depth)?;
            }
        }
        Ok(())
    }

    fn element(&mut self, node: Node<'x, 'x>, map: Map, style: Style, depth: usize) -> Result<(), String> {
        let kind = node.tag_name().name();
        let names = [node.attribute("id"), node.attribute((INKSCAPE, "label"))];
        if NOT_DRAWN.contains(&kind) || names.contains(&Some(SLIDER_LAYER)) {
            return Ok(());
        }
        if self.rules.is_hidden(node) {
            self.hidden.add(node);
            return Ok(());
        }
        for name in ["clip-path", "mask", "filter"] {
            let value = self.rules.property(node, name);
            if value.is_some_and(|value| value != "none") {
                let problem = format!("that a `{name}` changes: apply it to the path, or remove it");
                return refuse(node, &problem);
            }
        }
        let own_style = node.attribute("style").unwrap_or_default();
        if own_style.contains("transform") {
            return refuse(node, "with `transform` in its style: write it as an attribute");
        }
        let map = map.after(transform(node)?);
        match kind {
            "g" | "a" => self.group(node, map, style, depth + 1),
            "path" | "rect" | "circle" | "ellipse" | "polygon" | "polyline" | "line" => {
                self.shape(node, map, style)
            }
            _ => refuse(
                node,
                "which has no outline of its own: convert it to a path (Inkscape: Path > Object to Path), or hide it",
            ),
        }
    }

    fn shape(&mut self, node: Node<'x, 'x>, map: Map, style: Style) -> Result<(), String> {
        let style = self.rules.style(node, style);
        let fill = if node.tag_name().name() == "line" {
            Paint::Nothing
        } else {
            style.fill
        };
        match (style.is_visible, fill, style.stroke) {
            (true, Paint::Dark, _) => (),
            (false, ..) | (_, Paint::Nothing, Paint::Nothing) => {
                self.hidden.add(node);
                return Ok(());
            }
            (_, Paint::White, _) => {
                return refuse(
                    node,
                    "filled with white, which could be a hole or nothing: cut holes (Inkscape: Path > Difference), or hide it",
                );
            }
            (_, Paint::Nothing, _) => {
                let problem = "with a line and no fill, so that it has no inside: fill it, or hide it";
                return refuse(node, problem);
            }
        }
        let mut pen = Pen::new(map, &mut self.budget);
        let mut rings = Vec::new();
        for (ring, is_closed) in outlines(node, &mut pen)? {
            if !is_closed && ring.len() > 2 {
                return refuse(
                    node,
                    "with an open line: close it (Inkscape: Shift+J on its two ends)",
                );
            }
            if ring.len() > 2 {
                rings.push(ring);
            }
        }
        if rings.is_empty() {
            self.flat.add(node);
        } else {
            let rule = style.rule;
            self.parts.push(Part { rings, rule });
        }
        Ok(())
    }
}

/// A polyline, and whether it is closed.
type Outline = (Vec<Point>, bool);

fn transform(node: Node) -> Result<Map, String> {
    let mut map = Map::shift([0.0; 2]);
    for token in TransformListParser::from(node.attribute("transform").unwrap_or_default()) {
        use TransformListToken::{Matrix, Rotate, Scale, SkewX, SkewY, Translate};
        let skew = |angle: f64| libm::tan(angle.to_radians());
        let token = token.map_err(|error| about(node, &format!("with an unreadable transform: {error}")))?;
        map = map.after(match token {
            Matrix { a, b, c, d, e, f } => Map([a, b, c, d, e, f]),
            Translate { tx, ty } => Map::shift([tx, ty]),
            Scale { sx, sy } => Map::scale([sx, sy]),
            Rotate { angle } => Map::rotation(angle),
            SkewX { angle } => Map([1.0, 0.0, skew(angle), 1.0, 0.0, 0.0]),
            SkewY { angle } => Map([1.0, skew(angle), 0.0, 1.0, 0.0, 0.0]),
        });
    }
    Ok(map)
}

/// The outlines of an element.
fn outlines(node: Node, pen: &mut Pen) -> Result<Vec<Outline>, String> {
    let optional = |name: &str| {
        let Some(text) = node.attribute(name).filter(|text| *text != "auto") else {
            return Ok(None);
        };
        let unit = |unit| match unit {
            LengthUnit::None | LengthUnit::Px => Some(1.0),
            LengthUnit::In => Some(PIXELS_PER_INCH),
            LengthUnit::Cm => Some(PIXELS_PER_INCH / 2.54),
            LengthUnit::Mm => Some(PIXELS_PER_INCH / MM_PER_INCH),
            LengthUnit::Pt => Some(PIXELS_PER_INCH / 72.0),
            LengthUnit::Pc => Some(PIXELS_PER_INCH / 6.0),
            LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => None,
        };
        let read = text.trim().parse::<Length>().ok();
        let read = read.and_then(|read| Some(read.number * unit(read.unit)?));
        let is_size = !["x", "y", "cx", "cy"].contains(&name);
        let read = read.filter(|read| *read >= 0.0 || !is_size);
        read.map(Some).ok_or_else(|| {
            let text = single_line(text);
            let problem = format!("with {name}=\"{text}\", which is no length: give a number");
            about(node, &problem)
        })
    };
    let number = |name: &str| optional(name).map(|read| read.unwrap_or(0.0));
    match node.tag_name().name() {
        "path" => path(node, node.attribute("d").unwrap_or_default(), pen),
        kind @ ("polygon" | "polyline") => {
            let end = if kind == "polygon" { "z" } else { "" };
            let points = node.attribute("points").unwrap_or_default();
            path(node, &format!("M{points}{end}"), pen)
        }
        "rect" => {
            let [x, y, width, height] = [number("x")?, number("y")?, number("width")?, number("height")?];
            let [rx, ry] = [optional("rx")?, optional("ry")?];
            let [rx, ry] = [rx.or(ry), ry.or(rx)].map(|radius| radius.unwrap_or(0.0));
            let [rx, ry] = [rx.min(0.5 * width), ry.min(0.5 * height)];
            let [h, v] = [width - 2.0 * rx, height - 2.0 * ry];
            let corner = |x: f64, y: f64| format!("a{rx} {ry} 0 0 1 {x} {y}");
            let corners = [corner(rx, ry), corner(-rx, ry), corner(-rx, -ry), corner(rx, -ry)];
            let [a, b, c, d] = corners;
            path(
                node,
                &format!("M{} {y}h{h}{a}v{v}{b}h{}{c}v{}{d}z", x + rx, -h, -v),
                pen,
            )
        }
        // A circle or an ellipse: lines are never filled.
        kind => {
            let [rx, ry] = match kind {
                "circle" => [optional("r")?; 2],
                _ => [optional("rx")?, optional("ry")?],
            };
            let [rx, ry] = [rx.or(ry), ry.or(rx)].map(|radius| radius.unwrap_or(0.0));
            pen.ellipse([number("cx")?, number("cy")?], [[rx, 0.0], [0.0, ry]])?;
            Ok(vec![pen.take()])
        }
    }
}

/// The outlines of a path.
fn path(node: Node, commands: &str, pen: &mut Pen) -> Result<Vec<Outline>, String> {
    let mut done = Vec::new();
    let mut start = [0.0; 2];
    // Control point that a smooth curve mirrors, and whether it is that of a cubic curve.
    let mut control: Option<(Point, bool)> = None;
    // A line may follow the end of another one without a move.
    let mut is_begun = false;
    for segment in PathParser::from(commands) {
        let segment =
            segment.map_err(|error| about(node, &format!("with unreadable coordinates: {error}")))?;
        let (here, last) = (pen.here, control.take());
        let from = |abs: bool| if abs { [0.0; 2] } else { here };
        let at = |abs: bool, x: f64, y: f64| [from(abs)[0] + x, from(abs)[1] + y];
        let mirrored = |is_cubic: bool| match last {
            Some((point, of_cubic)) if of_cubic == is_cubic => {
                [0, 1].map(|axis| 2.0 * here[axis] - point[axis])
            }
            _ => here,
        };
        if let PathSegment::MoveTo { abs, x, y } = segment {
            done.push(pen.take());
            start = at(abs, x, y);
            pen.to(start)?;
            is_begun = true;
            continue;
        }
        if !is_begun {
            pen.to(start)?;
            is_begun = true;
        }
        match segment {
            PathSegment::MoveTo { .. } => (),
            PathSegment::LineTo { abs, x, y } => pen.to(at(abs, x, y))?,
            PathSegment::HorizontalLineTo { abs, x } => pen.to([from(abs)[0] + x, here[1]])?,
            PathSegment::VerticalLineTo { abs, y } => pen.to([here[0], from(abs)[1] + y])?,
            PathSegment::CurveTo {
                abs,
                x1,
                y1,
                x2,
                y2,
                x,
                y,
            } => {
                pen.bezier(&[at(abs, x1, y1), at(abs, x2, y2), at(abs, x, y)])?;
                control = Some((at(abs, x2, y2), true));
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                pen.bezier(&[mirrored(true), at(abs, x2, y2), at(abs, x, y)])?;
                control = Some((at(abs, x2, y2), true));
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                pen.bezier(&[at(abs, x1, y1), at(abs, x, y)])?;
                control = Some((at(abs, x1, y1), false));
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                let middle = mirrored(false);
                pen.bezier(&[middle, at(abs, x, y)])?;
                control = Some((middle, false));
            }
            PathSegment::EllipticalArc {
                abs,
                rx,
                ry,
                x_axis_rotation,
                large_arc,
                sweep,
                x,
                y,
            } => {
                let end = at(abs, x, y);
                arc(pen, [rx, ry], x_axis_rotation, large_arc, sweep, end)?;
            }
            PathSegment::ClosePath { .. } => {
                pen.to(start)?;
                let (ring, _) = pen.take();
                done.push((ring, true));
                is_begun = false;
            }
        }
    }
    done.push(pen.take());
    Ok(done)
}

/// Draws an arc of an ellipse given by its ends. In coordinates in which the ellipse is the unit circle, its
/// centre lies beside the middle of the chord; radii that are too short are enlarged.
fn arc(
    pen: &mut Pen,
    radii: [f64; 2],
    degrees: f64,
    is_large: bool,
    sweep: bool,
    end: Point,
) -> Result<(), String> {
    let [rx, ry] = radii.map(f64::abs);
    let here = pen.here;
    if rx == 0.0 || ry == 0.0 || here == end {
        return pen.to(end);
    }
    let [c, s] = direction(degrees.to_radians());
    let [dx, dy] = difference(end, here);
    let chord = [(dx * c + dy * s) / rx, (dy * c - dx * s) / ry];
    let half = 0.5 * length(chord);
    let enlarged = half.max(1.0);
    let height = (enlarged * enlarged - half * half).max(0.0).sqrt();
    let side = if is_large == sweep { -1.0 } else { 1.0 };
    let share = side * height / (2.0 * half);
    let [rx, ry] = [rx * enlarged, ry * enlarged];
    // From the beginning of the arc to its centre, in units of the enlarged radii.
    let [x, y] = [
        0.5 * chord[0] - share * chord[1],
        0.5 * chord[1] + share * chord[0],
    ]
    .map(|length| length / enlarged);
    let axes = [[rx * c, rx * s], [-ry * s, ry * c]];
    let center = [0, 1].map(|axis| here[axis] + x * axes[0][axis] + y * axes[1][axis]);
    let from = libm::atan2(-y, -x);
    let [end_x, end_y] = chord.map(|length| length / enlarged);
    let turn = libm::atan2(end_y - y, end_x - x) - from;
    let whole = std::f64::consts::TAU;
    let turn = if sweep {
        turn.rem_euclid(whole)
    } else {
        -(-turn).rem_euclid(whole)
    };
    pen.arc(center, axes, [from, from + turn], end)
}
