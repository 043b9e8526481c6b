//! Outlines of a DXF: its closed lines, and lines that are closed together, layer by layer.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::f64::consts::TAU;

use slipfront::surface::{FillRule, Part};
use slipfront_base::number_format::count;
use slipfront_base::text::single_line;

use super::chains::{OpenLine, closed};
use super::outlines::{Drawing, MAX_DEPTH, SLIDER_LAYER};
use super::pen::{Budget, CLOSE, Map, Pen, Point, direction};
use super::splines;

/// Lengths of the units that `$INSUNITS` numbers, mm; 0 is none.
const UNITS_MM: [f64; 15] = [
    0.0,
    25.4,
    304.8,
    1_609_344.0,
    1.0,
    10.0,
    1e3,
    1e6,
    25.4e-6,
    25.4e-3,
    914.4,
    1e-7,
    1e-6,
    1e-3,
    100.0,
];

/// A record: its kind, and the values of its codes.
struct Record<'t> {
    kind: &'t str,
    /// Line of the file in which it begins.
    line: usize,
    pairs: Vec<(i32, &'t str)>,
}

impl<'t> Record<'t> {
    fn text(&self, code: i32) -> Option<&'t str> {
        self.pairs.iter().find(|pair| pair.0 == code).map(|pair| pair.1)
    }

    fn parsed(&self, value: &str) -> Result<f64, String> {
        let parsed = value.parse().ok().filter(|number: &f64| number.is_finite());
        parsed.ok_or_else(|| {
            self.about(&format!(
                "with \"{}\" for a number: correct it",
                single_line(value)
            ))
        })
    }

    fn number_or(&self, code: i32, default: f64) -> Result<f64, String> {
        self.text(code).map_or(Ok(default), |value| self.parsed(value))
    }

    fn flags(&self, code: i32) -> Result<u32, String> {
        Ok(self.number_or(code, 0.0)? as u32)
    }

    fn point(&self, code: i32) -> Result<Point, String> {
        Ok([self.number_or(code, 0.0)?, self.number_or(code + 10, 0.0)?])
    }

    /// All values of a code.
    fn numbers(&self, code: i32) -> Result<Vec<f64>, String> {
        let values = self.pairs.iter().filter(|pair| pair.0 == code);
        values.map(|pair| self.parsed(pair.1)).collect()
    }

    /// All points that begin with a code.
    fn points(&self, code: i32) -> Result<Vec<Point>, String> {
        let (x, y) = (self.numbers(code)?, self.numbers(code + 10)?);
        if x.len() != y.len() {
            return Err(self.about(&format!(
                "with {} x and {} y: write the file again",
                x.len(),
                y.len()
            )));
        }
        Ok(x.into_iter().zip(y).map(|(x, y)| [x, y]).collect())
    }

    /// An error about the record; `problem` follows its name.
    fn about(&self, problem: &str) -> String {
        format!("has a {} in line {} {problem}", single_line(self.kind), self.line)
    }
}

pub(super) fn read(bytes: &[u8], block: f64) -> Result<Drawing, String> {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err("is a binary DXF: save it as ASCII DXF".to_owned());
    }
    // Names of layers may be in any encoding, as in files of older programs.
    let text = String::from_utf8_lossy(bytes);
    let mut reader = Reader::default();
    let records = records(&text)?;
    let unit = reader.sort(&records)?;
    let entities = std::mem::take(&mut reader.entities);
    let mut drawn = Drawn {
        file: &reader,
        budget: Budget::new(),
        layers: BTreeMap::new(),
        hidden: Vec::new(),
    };
    let scale = Map::scale([unit / block; 2]);
    drawn.entities(&entities, scale, "0", 0)?;
    let mut notes = Vec::new();
    if let Some(first) = drawn.hidden.first() {
        notes.push(format!(
            "not shown, and so no texture: {}, the first in line {first}",
            count(drawn.hidden.len(), "object")
        ));
    }
    let mut parts = Vec::new();
    for (name, layer) in drawn.layers {
        let rings = layer.rings(&name)?;
        if !rings.is_empty() {
            let rule = FillRule::EvenOdd;
            parts.push(Part { rings, rule });
        }
    }
    Ok(Drawing { parts, notes })
}

/// The records of a file: those of the header and the tables, too.
fn records(text: &str) -> Result<Vec<Record<'_>>, String> {
    let mut records: Vec<Record> = Vec::new();
    let mut lines = text.lines().map(str::trim).zip(1..);
    while let Some((code, line)) = lines.next() {
        let Ok(code) = code.parse() else {
            return Err(format!(
                "is no DXF: line {line} is \"{}\" instead of a group code; save it as ASCII DXF",
                single_line(&code.chars().take(40).collect::<String>())
            ));
        };
        let Some((value, _)) = lines.next() else {
            return Err(format!(
                "ends in line {line} in the middle of a pair: write the file again"
            ));
        };
        match (code, records.last_mut()) {
            (0, _) => records.push(Record {
                kind: value,
                line,
                pairs: Vec::new(),
            }),
            // Comments.
            (999, _) => (),
            (_, Some(record)) => record.pairs.push((code, value)),
            (_, None) => {
                return Err(format!(
                    "is no DXF: it begins with the group code {code}; save it as ASCII DXF"
                ));
            }
        }
    }
    match records.last() {
        Some(Record { kind: "EOF", .. }) => Ok(records),
        _ => Err("is cut off: it has no EOF; write the file again".to_owned()),
    }
}

/// A block: where its origin is, and what is in it.
type Block<'r> = (Point, Vec<&'r Record<'r>>);

/// A file, sorted.
#[derive(Default)]
struct Reader<'r> {
    hidden_layers: HashSet<String>,
    blocks: HashMap<String, Block<'r>>,
    entities: Vec<&'r Record<'r>>,
}

impl<'r> Reader<'r> {
    /// Sorts the records; returns the unit of length, mm.
    fn sort(&mut self, records: &'r [Record<'r>]) -> Result<f64, String> {
        let (mut section, mut block, mut unit) = ("", None, None);
        for record in records {
            match (record.kind, section) {
                ("SECTION", _) => {
                    section = record.text(2).unwrap_or_default();
                    if section == "HEADER" {
                        let name = record.pairs.iter().position(|pair| *pair == (9, "$INSUNITS"));
                        unit = name.and_then(|at| record.pairs.get(at + 1)).map(|pair| pair.1);
                    }
                }
                // Frozen, or off.
                ("LAYER", "TABLES") if record.flags(70)? & 1 == 1 || record.number_or(62, 7.0)? < 0.0 => {
                    let name = record.text(2).unwrap_or_default();
                    self.hidden_layers.insert(name.to_uppercase());
                }
                ("BLOCK", "BLOCKS") => {
                    let name = record.text(2).unwrap_or_default().to_uppercase();
                    self.blocks.insert(name.clone(), (record.point(10)?, Vec::new()));
                    block = Some(name);
                }
                ("ENDBLK", "BLOCKS") => block = None,
                (_, "BLOCKS") => {
                    let known = block.as_ref().and_then(|name| self.blocks.get_mut(name));
                    known.into_iter().for_each(|(_, entities)| entities.push(record));
                }
                ("ENDSEC", _) => section = "",
                (_, "ENTITIES") => self.entities.push(record),
                _ => (),
            }
        }
        let number = unit.and_then(|unit| unit.parse::<usize>().ok()).unwrap_or(0);
        UNITS_MM.get(number).copied().filter(|unit| *unit > 0.0).ok_or_else(|| {
            format!(
                "states no unit of length: its $INSUNITS is {}; set the unit of the drawing to millimetres (AutoCAD: UNITS, LibreCAD: \
                 Current Drawing Preferences) and save it again",
                unit.map_or("missing".to_owned(), |unit| format!("\"{}\"", single_line(unit)))
            )
        })
    }
}

/// The lines of a layer.
#[derive(Default)]
struct Layer {
    /// Closed lines, with their lines of the file.
    closed: Vec<(Vec<Point>, usize)>,
    open: Vec<OpenLine>,
}

impl Layer {
    /// All outlines; two equal ones would cancel each other.
    fn rings(self, name: &str) -> Result<Vec<Vec<Point>>, String> {
        let mut known = HashSet::new();
        for (ring, line) in &self.closed {
            let mut corners: Vec<[i64; 2]> = ring
                .iter()
                .map(|point| point.map(|length| (length / CLOSE).round() as i64))
                .collect();
            corners.sort_unstable();
            if !known.insert(corners) {
                return Err(format!(
                    "has the same outline twice on layer {} (line {line} of the file): delete one",
                    single_line(name)
                ));
            }
        }
        let joined =
            closed(self.open).map_err(|problem| format!("{problem}; layer {}", single_line(name)))?;
        let rings = self.closed.into_iter().map(|(ring, _)| ring).chain(joined);
        Ok(rings.filter(|ring| ring.len() > 2).collect())
    }
}

/// Lines drawn from the entities of a file, layer by layer.
struct Drawn<'r> {
    file: &'r Reader<'r>,
    budget: Budget,
    layers: BTreeMap<String, Layer>,
    /// Lines of entities that are not shown.
    hidden: Vec<usize>,
}

impl Drawn<'_> {
    /// Draws entities; those on layer 0 belong to the layer `outer`.
    fn entities(&mut self, entities: &[&Record], map: Map, outer: &str, depth: usize) -> Result<(), String> {
        let mut rest = entities;
        while let [entity, after @ ..] = rest {
            // The vertices of a polyline and the attributes of a block follow it.
            let count = after
                .iter()
                .take_while(|part| ["VERTEX", "ATTRIB", "SEQEND"].contains(&part.kind))
                .count();
            let (parts, next) = after.split_at(count);
            // Records are searched from their beginning, once for each copy of a block.
            let length = |record: &&Record| 1 + record.pairs.len() / 16;
            let lengths = length(entity) + parts.iter().map(length).sum::<usize>();
            self.budget.take(lengths as f64)?;
            rest = next;
            let layer = match entity.text(8).unwrap_or("0") {
                "0" => outer,
                own => own,
            };
            let is_hidden = self.file.hidden_layers.contains(&layer.to_uppercase()) || entity.flags(60)? == 1;
            // What is on paper, such as frames and views, is not in the model.
            if entity.flags(67)? == 1 || layer == SLIDER_LAYER {
                continue;
            }
            if is_hidden {
                self.hidden.push(entity.line);
                continue;
            }
            match (entity.kind, entity.number_or(230, 1.0)?) {
                _ if entity.number_or(210, 0.0)?.abs() + entity.number_or(220, 0.0)?.abs() > 1e-9 => {
                    return Err(
                        entity.about("that does not lie in the plane of the drawing: draw it in plan")
                    );
                }
                ("INSERT", z) => self.insert(entity, map.after(mirror(z)), layer, depth)?,
                (_, z) => self.line(entity, parts, (map, z), layer)?,
            }
        }
        Ok(())
    }

    /// Draws the copies of a block.
    fn insert(&mut self, entity: &Record, map: Map, layer: &str, depth: usize) -> Result<(), String> {
        let name = entity.text(2).unwrap_or_default();
        let Some((base, entities)) = self.file.blocks.get(&name.to_uppercase()) else {
            let problem = format!(
                "of the block \"{}\", which is not in the file: explode it",
                single_line(name)
            );
            return Err(entity.about(&problem));
        };
        if depth >= MAX_DEPTH {
            return Err(entity.about(&format!("within {MAX_DEPTH} other blocks: explode it")));
        }
        let scale = Map::scale([entity.number_or(41, 1.0)?, entity.number_or(42, 1.0)?]);
        let to = map
            .after(Map::shift(entity.point(10)?))
            .after(Map::rotation(entity.number_or(50, 0.0)?));
        let count = [
            entity.number_or(70, 1.0)?.max(1.0),
            entity.number_or(71, 1.0)?.max(1.0),
        ];
        let spacing = [entity.number_or(44, 0.0)?, entity.number_or(45, 0.0)?];
        let [columns, rows] = [self.budget.take(count[0])?, self.budget.take(count[1])?];
        for row in 0..rows {
            for column in 0..columns {
                self.budget.take(1.0)?;
                let shift = Map::shift([column as f64 * spacing[0], row as f64 * spacing[1]]);
                let copy = to
                    .after(shift)
                    .after(scale)
                    .after(Map::shift(base.map(|length| -length)));
                self.entities(entities, copy, layer, depth + 1)?;
            }
        }
        Ok(())
    }

    /// Draws one line; the second part of `map` is the side from which it is seen.
    fn line(
        &mut self,
        entity: &Record,
        parts: &[&Record],
        map: (Map, f64),
        layer: &str,
    ) -> Result<(), String> {
        let (map, z) = map;
        // Centres and corners of these kinds, but not of the others, are those seen from that side.
        let is_seen = ["LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE"].contains(&entity.kind);
        let map = if is_seen { map.after(mirror(z)) } else { map };
        let mut pen = Pen::new(map, &mut self.budget);
        let flags = entity.flags(70)?;
        let mut is_closed = false;
        match entity.kind {
            "LWPOLYLINE" => {
                is_closed = flags & 1 == 1;
                let mut corners: Vec<(Point, f64)> = Vec::new();
                for (code, value) in &entity.pairs {
                    match (code, corners.last_mut()) {
                        (10, _) => corners.push(([entity.parsed(value)?, 0.0], 0.0)),
                        (20, Some((point, _))) => point[1] = entity.parsed(value)?,
                        (42, Some((_, bulge))) => *bulge = entity.parsed(value)?,
                        _ => (),
                    }
                }
                polyline(&mut pen, &corners, is_closed)?;
            }
            // Flags of lines in space, and of meshes.
            "POLYLINE" if flags & (8 | 16 | 64) == 0 => {
                is_closed = flags & 1 == 1;
                let corner = |vertex: &&Record| Ok((vertex.point(10)?, vertex.number_or(42, 0.0)?));
                let mut vertices = Vec::new();
                for vertex in parts.iter().filter(|part| part.kind == "VERTEX") {
                    // The frame of a curve is not the curve.
                    if vertex.flags(70)? & 16 == 0 {
                        vertices.push(vertex);
                    }
                }
                let corners: Result<Vec<_>, String> = vertices.into_iter().map(corner).collect();
                polyline(&mut pen, &corners?, is_closed)?;
            }
            "LINE" => {
                pen.to(entity.point(10)?)?;
                pen.to(entity.point(11)?)?;
            }
            "CIRCLE" | "ARC" => {
                let (center, r) = (entity.point(10)?, entity.number_or(40, 0.0)?);
                let axes = [[r, 0.0], [0.0, r]];
                is_closed = entity.kind == "CIRCLE";
                if is_closed {
                    pen.ellipse(center, axes)?;
                } else {
                    let [from, to] =
                        [entity.number_or(50, 0.0)?, entity.number_or(51, 360.0)?].map(f64::to_radians);
                    part_of_ellipse(&mut pen, center, axes, [from, to])?;
                }
            }
            "ELLIPSE" => {
                let (center, [x, y]) = (entity.point(10)?, entity.point(11)?);
                let ratio = entity.number_or(40, 1.0)? * z.signum();
                let axes = [[x, y], [-ratio * y, ratio * x]];
                let [from, to] = [entity.number_or(41, 0.0)?, entity.number_or(42, TAU)?];
                is_closed = (to - from).abs() > TAU - 1e-6;
                if is_closed {
                    pen.ellipse(center, axes)?;
                } else {
                    part_of_ellipse(&mut pen, center, axes, [from, to])?;
                }
            }
            "SPLINE" => {
                if entity.numbers(41)?.windows(2).any(|pair| pair[0] != pair[1]) {
                    return Err(entity.about("with weights: convert it to a polyline"));
                }
                let degree = entity.flags(71)? as usize;
                splines::draw(&mut pen, degree, &entity.numbers(40)?, &entity.points(10)?)
                    .map_err(|problem| format!("{problem} (line {} of the file)", entity.line))?;
            }
            _ => {
                return Err(entity.about(
                    "which is no line in the plane: convert it to polylines, delete it, or move it to a layer that is not shown",
                ));
            }
        }
        let (points, returns) = pen.take();
        let layer = self.layers.entry(layer.to_owned()).or_default();
        if is_closed || returns {
            layer.closed.push((points, entity.line));
        } else if points.len() > 1 {
            let number = entity.line;
            layer.open.push(OpenLine { points, number });
        }
        Ok(())
    }
}

/// The map of what is seen from this side of the plane.
fn mirror(z: f64) -> Map {
    Map::scale([if z < 0.0 { -1.0 } else { 1.0 }, 1.0])
}

/// Draws lines from corner to corner, and arcs: one of the angle `t` has the bulge `tan(t/4)`.
fn polyline(pen: &mut Pen, corners: &[(Point, f64)], is_closed: bool) -> Result<(), String> {
    let Some((first, _)) = corners.first() else {
        return Ok(());
    };
    pen.to(*first)?;
    let last = if is_closed {
        corners.len()
    } else {
        corners.len() - 1
    };
    let nexts = corners.iter().cycle().skip(1);
    for (&(from, bulge), &(to, _)) in corners.iter().zip(nexts).take(last) {
        if bulge == 0.0 || from == to {
            pen.to(to)?;
            continue;
        }
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let height = 0.25 * (1.0 / bulge - bulge);
        let center = [from[0] + 0.5 * dx - height * dy, from[1] + 0.5 * dy + height * dx];
        let u = [from[0] - center[0], from[1] - center[1]];
        pen.arc(center, [u, [-u[1], u[0]]], [0.0, 4.0 * libm::atan(bulge)], to)?;
    }
    Ok(())
}

/// Draws the part of an ellipse between two parameters, from the first to the second.
fn part_of_ellipse(
    pen: &mut Pen,
    center: Point,
    axes: [Point; 2],
    [from, to]: [f64; 2],
) -> Result<(), String> {
    let to = from + (to - from).rem_euclid(TAU);
    let at = |parameter: f64| {
        let [c, s] = direction(parameter);
        [0, 1].map(|axis| center[axis] + c * axes[0][axis] + s * axes[1][axis])
    };
    pen.to(at(from))?;
    pen.arc(center, axes, [from, to], at(to))
}
