//! Files of textures for other programs: their outlines must fill the textured blocks of the case.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use slipfront_case::case::Case;
use slipfront_case::texture_file::{Options, smallest, textured_blocks, write};
use test_case::test_case;

/// A part of a closed line, in blocks.
#[derive(Clone, Copy, Debug)]
enum Part {
    Line([[f64; 2]; 2]),
    /// Centre, semi-axes, direction of the first axis, and parameters of the ends.
    Arc([f64; 2], [f64; 2], f64, [f64; 2]),
}

/// Parts that are filled together, by the even-odd rule.
type Element = Vec<Part>;

fn on_arc(center: [f64; 2], [a, b]: [f64; 2], angle: f64, t: f64) -> [f64; 2] {
    let (along, aside) = (a * t.cos(), b * t.sin());
    [
        center[0] + along * angle.cos() - aside * angle.sin(),
        center[1] + along * angle.sin() + aside * angle.cos(),
    ]
}

impl Part {
    fn ends(&self) -> [[f64; 2]; 2] {
        match *self {
            Part::Line(ends) => ends,
            Part::Arc(center, axes, angle, ends) => ends.map(|t| on_arc(center, axes, angle, t)),
        }
    }

    /// Number of intersections of the part with a ray from a point to the right.
    fn crossings(&self, [x, y]: [f64; 2]) -> usize {
        let meets = |from: [f64; 2], to: [f64; 2]| (from[1] <= y) != (to[1] <= y);
        match *self {
            Part::Line([p, q]) => {
                usize::from(meets(p, q) && p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]) > x)
            }
            Part::Arc(center, [a, b], angle, [from, to]) => {
                // y = center + reach cos(t - middle), which is monotonic between multiples of pi.
                let (cosine, sine) = (a * angle.sin(), b * angle.cos());
                let (reach, middle) = (cosine.hypot(sine), sine.atan2(cosine));
                let mut ends = vec![from, to];
                ends.extend(
                    (-8..9)
                        .map(|k| middle + f64::from(k) * PI)
                        .filter(|t| (from..to).contains(t)),
                );
                ends.sort_by(f64::total_cmp);
                let half = ((y - center[1]) / reach).clamp(-1.0, 1.0).acos();
                let parts = ends.windows(2).filter(|pair| {
                    let at = |t| on_arc(center, [a, b], angle, t);
                    if !meets(at(pair[0]), at(pair[1])) {
                        return false;
                    }
                    // Of the two solutions, in any turn, the one that is nearest to the part.
                    let mid = 0.5 * (pair[0] + pair[1]);
                    let near = [middle - half, middle + half].map(|t| t + ((mid - t) / TAU).round() * TAU);
                    let t = if (near[0] - mid).abs() < (near[1] - mid).abs() {
                        near[0]
                    } else {
                        near[1]
                    };
                    at(t)[0] > x
                });
                parts.count()
            }
        }
    }

    /// Distance of a point from the part; for an arc, an upper bound of the distance from its ellipse.
    fn distance(&self, [x, y]: [f64; 2]) -> f64 {
        match *self {
            Part::Line([p, q]) => {
                let along = [q[0] - p[0], q[1] - p[1]];
                let square = along[0] * along[0] + along[1] * along[1];
                let share = (((x - p[0]) * along[0] + (y - p[1]) * along[1]) / square).clamp(0.0, 1.0);
                (p[0] + share * along[0] - x).hypot(p[1] + share * along[1] - y)
            }
            Part::Arc(center, [a, b], angle, _) => {
                let (dx, dy) = (x - center[0], y - center[1]);
                let along = (dx * angle.cos() + dy * angle.sin()) / a;
                let aside = (dy * angle.cos() - dx * angle.sin()) / b;
                (along.hypot(aside) - 1.0).abs() * a.max(b)
            }
        }
    }
}

fn number_of(line: &str, name: &str) -> Option<f64> {
    let (_, rest) = line.split_once(&format!(" {name}=\""))?;
    rest.split_once('"')?.0.trim_end_matches("mm").parse().ok()
}

/// Elements of an SVG, in blocks, with y upwards.
fn svg(text: &str, [nx, ny]: [usize; 2]) -> Vec<Element> {
    let head = text.lines().next().unwrap();
    let block = number_of(head, "width").unwrap() / nx as f64;
    assert!((number_of(head, "height").unwrap() / block - ny as f64).abs() < 1e-9);
    let point = |x: f64, y: f64| [x / block, ny as f64 - y / block];
    let mut elements = Vec::new();
    // All elements but the edge of the slider.
    let (textures, _) = text.split_once("<g id=\"SLIDER\"").unwrap();
    for line in textures.lines() {
        let number = |name: &str| number_of(line, name);
        if line.starts_with("<circle") {
            let r = number("r").unwrap() / block;
            let center = point(number("cx").unwrap(), number("cy").unwrap());
            elements.push(vec![Part::Arc(center, [r, r], 0.0, [0.0, TAU])]);
        } else if line.starts_with("<ellipse") {
            let axes = [number("rx").unwrap() / block, number("ry").unwrap() / block];
            let center = point(number("cx").unwrap(), number("cy").unwrap());
            let degrees = line
                .split_once("rotate(")
                .map_or(0.0, |(_, rest)| rest.split(' ').next().unwrap().parse().unwrap());
            elements.push(vec![Part::Arc(
                center,
                axes,
                -f64::to_radians(degrees),
                [0.0, TAU],
            )]);
        } else if let Some(path) = line.strip_prefix("<path d=\"") {
            elements.push(svg_path(path.trim_end_matches("\"/>"), &point, block));
        }
    }
    elements
}

fn svg_path(path: &str, point: &dyn Fn(f64, f64) -> [f64; 2], block: f64) -> Element {
    let mut parts = Vec::new();
    let (mut start, mut here) = ([0.0; 2], [0.0; 2]);
    let mut rest = path.trim();
    while let Some(letter) = rest.chars().next() {
        // The `e` of an exponent is not a command.
        let end = rest[1..]
            .find(|c: char| "MLAZ".contains(c))
            .map_or(rest.len(), |at| at + 1);
        let numbers: Vec<f64> = rest[1..end]
            .split_whitespace()
            .map(|n| n.parse().unwrap())
            .collect();
        rest = &rest[end..];
        match (letter, &numbers[..]) {
            ('M', &[x, y]) => (start, here) = (point(x, y), point(x, y)),
            ('L', &[x, y]) => {
                parts.push(Part::Line([here, point(x, y)]));
                here = point(x, y);
            }
            ('A', &[a, b, degrees, large, sweep, x, y]) => {
                assert_eq!(large, 0.0);
                let to = point(x, y);
                let [from, end] = if sweep == 0.0 { [here, to] } else { [to, here] };
                parts.push(arc(from, end, [a / block, b / block], -degrees.to_radians()));
                here = to;
            }
            ('Z', []) => {
                parts.push(Part::Line([here, start]));
                here = start;
            }
            _ => panic!("{letter} {numbers:?}"),
        }
    }
    parts
}

/// The counterclockwise arc of less than half a turn, computed in coordinates in which the ellipse is the
/// unit circle.
fn arc(from: [f64; 2], to: [f64; 2], [a, b]: [f64; 2], angle: f64) -> Part {
    let (s, c) = angle.sin_cos();
    let turned = |p: [f64; 2]| [(p[0] * c + p[1] * s) / a, (p[1] * c - p[0] * s) / b];
    let (p, q) = (turned(from), turned(to));
    let (middle, half) = (
        [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])],
        [0.5 * (q[0] - p[0]), 0.5 * (q[1] - p[1])],
    );
    let square = half[0] * half[0] + half[1] * half[1];
    let height = (1.0 - square).max(0.0).sqrt() / square.sqrt();
    let unit = [middle[0] - height * half[1], middle[1] + height * half[0]];
    let parameter = |r: [f64; 2]| (r[1] - unit[1]).atan2(r[0] - unit[0]);
    let (t, mut u) = (parameter(p), parameter(q));
    if u < t {
        u += TAU;
    }
    let center = [
        unit[0] * a * c - unit[1] * b * s,
        unit[0] * a * s + unit[1] * b * c,
    ];
    Part::Arc(center, [a, b], angle, [t, u])
}

/// Entities of a layer of a DXF: the kind of each, and its codes with their values.
fn entities(text: &str, has_layer: impl Fn(&str) -> bool) -> Vec<(&str, Vec<(u16, &str)>)> {
    let (_, text) = text.split_once("\nENTITIES\n").unwrap();
    let (text, _) = text.split_once("0\nENDSEC\n").unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let mut entities: Vec<(&str, Vec<(u16, &str)>)> = Vec::new();
    for pair in lines.chunks(2) {
        match (pair[0].parse().unwrap(), pair[1]) {
            (0, kind) => entities.push((kind, Vec::new())),
            other => entities.last_mut().unwrap().1.push(other),
        }
    }
    entities.retain(|(_, pairs)| pairs.iter().any(|(code, layer)| *code == 8 && has_layer(layer)));
    entities
}

/// Closed line of an entity of a DXF, in blocks.
fn closed_line(kind: &str, pairs: &[(u16, &str)], block: f64) -> Element {
    let value = |code: u16| pairs.iter().find(|pair| pair.0 == code).unwrap().1.parse::<f64>();
    let number = |code: u16| value(code).unwrap();
    let length = |code: u16| number(code) / block;
    match kind {
        "LWPOLYLINE" => {
            let mut corners: Vec<([f64; 2], f64)> = Vec::new();
            for (code, value) in pairs {
                match (code, value.parse::<f64>()) {
                    (10, Ok(x)) => corners.push(([x / block, 0.0], 0.0)),
                    (20, Ok(y)) => corners.last_mut().unwrap().0[1] = y / block,
                    (42, Ok(bulge)) => corners.last_mut().unwrap().1 = bulge,
                    _ => (),
                }
            }
            assert_eq!((number(90) as usize, number(70)), (corners.len(), 1.0));
            let edges = corners.iter().zip(corners.iter().cycle().skip(1));
            edges.map(|(&(p, bulge), &(q, _))| bulged(p, q, bulge)).collect()
        }
        "CIRCLE" => vec![Part::Arc(
            [length(10), length(20)],
            [length(40); 2],
            0.0,
            [0.0, TAU],
        )],
        "ELLIPSE" => {
            let major = [length(11), length(21)];
            let a = major[0].hypot(major[1]);
            assert!(number(40) <= 1.0);
            assert_eq!([number(41), number(42)], [0.0, TAU]);
            let angle = major[1].atan2(major[0]);
            vec![Part::Arc(
                [length(10), length(20)],
                [a, a * number(40)],
                angle,
                [0.0, TAU],
            )]
        }
        other => panic!("{other}"),
    }
}

/// The line from one corner to the next, or the circular arc with the angle `4 atan(bulge)`.
fn bulged(p: [f64; 2], q: [f64; 2], bulge: f64) -> Part {
    let radius = (q[0] - p[0]).hypot(q[1] - p[1]) * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
    if bulge == 0.0 {
        Part::Line([p, q])
    } else if bulge > 0.0 {
        arc(p, q, [radius; 2], 0.0)
    } else {
        arc(q, p, [radius; 2], 0.0)
    }
}

/// Elements of a DXF, in blocks: all lines of each layer.
fn dxf(text: &str, block: f64) -> Vec<Element> {
    let mut layers: BTreeMap<&str, Element> = BTreeMap::new();
    for (kind, pairs) in entities(text, |layer| layer != "SLIDER") {
        let layer = pairs.iter().find(|pair| pair.0 == 8).unwrap().1;
        layers
            .entry(layer)
            .or_default()
            .extend(closed_line(kind, &pairs, block));
    }
    layers.into_values().collect()
}

/// Every block is textured according to the elements, except for centres within 1e-9 block of an outline,
/// and again when the drawing is read, except for centres within two ten-thousandths: chords differ from
/// curves by one, and the elements from these by rounding.
fn expect_filled(elements: &[Element], [textured, again]: [&[bool]; 2], nx: usize, what: &str) {
    for (b, (textured, again)) in textured.iter().zip(again).enumerate() {
        let center = [(b % nx) as f64 + 0.5, (b / nx) as f64 + 0.5];
        // Not exactly at the height of the ends of arcs, which are rounded.
        let ray = [center[0], center[1] + 1e-10];
        let odd = |element: &Element| element.iter().map(|part| part.crossings(ray)).sum::<usize>() % 2 == 1;
        let is_filled = elements.iter().any(odd);
        if is_filled != *textured || is_filled != *again {
            let nearest = elements
                .iter()
                .flatten()
                .map(|part| part.distance(center))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < if is_filled != *textured { 1e-9 } else { 2e-4 },
                "{what}: block ({}, {}), {nearest} from an outline",
                b % nx,
                b / nx
            );
        }
    }
}

const SHAPES: &[&str] = &[
    "[[texture]]\nshape = 'cavity'\ncoverage = 10",
    // Across two free edges, and across the corner.
    "[[texture]]\nshape = 'cavity'\nlambda = '9 um'\ncenter = ['3 um', '4.2 um']",
    "[[texture]]\nshape = 'cavity'\nlambda = '9 um'\nw = 0.4\nrotate = 30\ncenter = ['36 um', '15 um']",
    "[[texture]]\nshape = 'cavity'\nlambda = '12 um'\nw = -0.5\nacross = true\nrotate = -20",
    "[[texture]]\nshape = 'cavity'\nlambda = '3 um'\ns = 2\nw = 0.4\npitch = '8 um'\nlattice = 'hexagonal'",
    "[[texture]]\nshape = 'cavity'\nlambda = '3 um'\nw = 0.3\nrotate = 75\narray = [4, 3]\nlattice = 'staggered'\ninvert = true",
    "[[texture]]\nshape = 'cavity'\nlambda = '4.5 um'\narray = [4, 4]\ninvert = true",
    "[[texture]]\nshape = 'groove'\nwidth = '2.3 um'\narray = [4, 1]",
    "[[texture]]\nshape = 'groove'\norientation = 'along'\nwidth = '3 um'\noffset = '14 um'\n[[texture]]\nshape = 'cavity'\nlambda = '4 um'\narray = [2, 2]",
    "[[texture]]\nshape = 'polygon'\npoints = [['10 um', '-3 um'], ['30 um', '4.1 um'], ['12 um', '9 um'], ['25 um', '-2 um']]\narray = [1, 3]\npitch = '11 um'",
    "[[texture]]\nshape = 'mask'\nfile = 'mask.png'",
    "[[texture]]\nshape = 'mask'\nfile = 'mask.png'\narray = [3, 2]\nlattice = 'staggered'\ninvert = true",
];

/// Some of them, for sliders of other outlines.
const SOME_SHAPES: &[&str] = &[SHAPES[2], SHAPES[4], SHAPES[8], SHAPES[11]];

#[test_case("", &[""])]
#[test_case("[slider]\nblocks = [40, 30]\n", SHAPES)]
#[test_case("[slider]\nblocks = [40, 30]\nedges = 'periodic'\n", SHAPES)]
#[test_case(
    "[slider]\nblocks = [40, 30]\nblock_size = '1.7 nm'\n",
    &["[[texture]]\nshape = 'cavity'\ncoverage = 10\nw = 0.3"]
)]
#[test_case("[slider]\nblocks = [34, 34]\noutline = 'disc'\n", SOME_SHAPES)]
#[test_case(
    "[slider]\nblocks = [40, 30]\noutline = 'mask'\noutline_file = 'holes.png'\n",
    SOME_SHAPES
)]
fn outlines_fill_the_blocks_of_the_mask(slider: &str, shapes: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let mask: Vec<bool> = (0..30).map(|b| b % 7 < 2 || b == 12).collect();
    std::fs::write(
        folder.path().join("mask.png"),
        slipfront_case::arrays::png_of_mask(6, 5, &mask).unwrap(),
    )
    .unwrap();
    // Corners that touch, narrow teeth, holes, and islands within them.
    let holes = |b: usize| (b % 40 / 7 + b / 40 / 5) % 4 != 1 || b % 5 == 2;
    let exists: Vec<bool> = (0..1200).map(holes).collect();
    fs::write(
        folder.path().join("holes.png"),
        slipfront_case::arrays::png_of_mask(40, 30, &exists).unwrap(),
    )
    .unwrap();
    for shape in shapes {
        let text = format!("{slider}{shape}");
        let case = Case::parse(&text, "case", folder.path(), &[]).unwrap();
        let (nx, ny) = (case.model.lattice.nx, case.model.lattice.ny);
        let textured = textured_blocks(&case);
        assert_eq!(textured.contains(&true), !text.is_empty());
        let written = |name: &str| {
            write(&case, &folder.path().join(name), Options::default()).unwrap();
            fs::read_to_string(folder.path().join(name)).unwrap()
        };
        let block = 1e3 * case.scales.block_size;
        let drawn = [svg(&written("a.svg"), [nx, ny]), dxf(&written("a.dxf"), block)];
        for (elements, name) in drawn.iter().zip(["a.svg", "a.dxf"]) {
            let again = format!("{slider}[[texture]]\nshape = 'drawing'\nfile = '{name}'");
            let again = match Case::parse(&again, "case", folder.path(), &[]) {
                Ok(case) => textured_blocks(&case),
                Err(error) => {
                    assert!(
                        elements.is_empty() && error.to_string().contains("no outline"),
                        "{error}"
                    );
                    textured.clone()
                }
            };
            expect_filled(elements, [&textured, &again], nx, &format!("{name} of {text}"));
        }
    }
}

/// Programs for lasers sort by colour, and fill between nested outlines of one layer.
#[test]
fn every_texture_and_the_slider_have_a_layer_and_a_colour() {
    let folder = tempfile::tempdir().unwrap();
    let groove = "[[texture]]\nshape = 'groove'\nwidth = '3 um'\n";
    let case = Case::parse(&groove.repeat(9), "case", "", &[]).unwrap();
    let written = |name: &str| {
        let notes = write(&case, &folder.path().join(name), Options::default()).unwrap();
        assert!(notes[0].contains("repeat after 7 textures"), "{notes:?}");
        fs::read_to_string(folder.path().join(name)).unwrap()
    };
    let svg = written("a.svg");
    let colors: Vec<&str> = svg.split(" stroke=\"").skip(1).map(|rest| &rest[..7]).collect();
    let different: std::collections::BTreeSet<&str> = colors[..7].iter().copied().collect();
    assert_eq!((different.len(), colors[7], colors[9]), (7, colors[0], "#000000"));
    assert!(!different.contains("#000000"));
    assert!(svg.contains(
        "<g id=\"TEXTURE_2\" inkscape:groupmode=\"layer\" inkscape:label=\"TEXTURE_2\" fill=\"#0000ff\""
    ));
    let dxf = written("a.dxf");
    for (layer, color) in [
        ("SLIDER", 7),
        ("TEXTURE_1", 1),
        ("TEXTURE_2", 5),
        ("TEXTURE_8", 1),
    ] {
        assert!(
            dxf.contains(&format!("\n2\n{layer}\n70\n0\n62\n{color}\n")),
            "{layer}"
        );
        assert!(dxf.contains(&format!("\n8\n{layer}\n")), "{layer}");
    }
}

/// Outlines of a drawing remain outlines, and those of parts that overlap become edges of blocks.
#[test_case("M0.1 0.1L1.2 0.1 0.7 0.9zM2 1h1v.3h-1z", 7, false; "beside each other")]
#[test_case("M0 0.1h2v2h-2z M0.3 0.4v1h1v-1z", 8, false; "within each other")]
#[test_case("M0.1 0.1L1.2 0.1 0.7 0.9z", 3, true; "one")]
#[test_case("M0.1 0.1h2v2h-2zM1 1h2v2h-2z", 8, false; "over each other")]
fn outlines_of_drawings_remain(path: &str, corners: usize, has_feature: bool) {
    let folder = tempfile::tempdir().unwrap();
    let page = "<svg width='4mm' height='3mm' viewBox='0 0 4 3'>";
    fs::write(
        folder.path().join("a.svg"),
        format!("{page}<path d='{path}'/></svg>"),
    )
    .unwrap();
    let text = "slider = { blocks = [40, 30], block_size = '100 um' }\n[[texture]]\nshape = 'drawing'\nfile = 'a.svg'";
    let case = Case::parse(text, "case", folder.path(), &[]).unwrap();
    let notes = write(&case, &folder.path().join("a.dxf"), Options::default()).unwrap();
    let dxf = fs::read_to_string(folder.path().join("a.dxf")).unwrap();
    let found = entities(&dxf, |layer| layer != "SLIDER").into_iter();
    let count = found
        .map(|(kind, pairs)| closed_line(kind, &pairs, 0.1).len())
        .sum::<usize>();
    assert_eq!(
        (count, notes.len()),
        (corners, usize::from(path.ends_with("h2v2h-2z")))
    );
    assert_eq!(smallest(&case).unwrap().feature.is_some(), has_feature);
}

#[test]
fn circles_and_ellipses_are_written_as_such_and_cavities_as_4096_corners() {
    let folder = tempfile::tempdir().unwrap();
    let written = |shape: &str, name: &str| {
        let text = format!("slider.blocks = [40, 30]\n[[texture]]\nshape = 'cavity'\n{shape}");
        let case = Case::parse(&text, "case", "", &[]).unwrap();
        write(&case, &folder.path().join(name), Options::default()).unwrap();
        fs::read_to_string(folder.path().join(name)).unwrap()
    };
    let count = |text: &str, part: &str| text.matches(part).count();
    let circles = "lambda = '2 um'\narray = [3, 2]";
    assert_eq!(count(&written(circles, "a.svg"), "<circle "), 6);
    assert_eq!(count(&written(circles, "a.dxf"), "\nCIRCLE\n"), 6);
    let ellipse = "lambda = '2 um'\nw = 0.3\nrotate = 40";
    assert_eq!(count(&written(ellipse, "a.svg"), "<ellipse "), 1);
    assert_eq!(count(&written(ellipse, "a.dxf"), "\nELLIPSE\n"), 1);
    let square = "lambda = '5 um'\ns = 3\nw = 0.2";
    let svg = written(square, "a.svg");
    let path = svg.lines().find(|line| line.starts_with("<path")).unwrap();
    assert_eq!(count(path, "L"), 4095);
    // The edge of the slider, for alignment.
    let edge = "fill=\"none\" fill-rule=\"evenodd\" stroke=\"#000000\" stroke-width=\"0.00005\">\n\
                <path d=\"M0 0.03L0.04 0.03L0.04 0L0 0Z\"/>\n</g>\n</svg>\n";
    assert!(svg.ends_with(edge), "{svg}");
    assert!(written(square, "a.dxf").contains("\n90\n4096\n70\n1\n"));
    // True size: 40 blocks of 1 um.
    assert!(written(square, "a.svg").contains("width=\"0.04mm\" height=\"0.03mm\""));
}

/// Area within a closed line, in square blocks: the polygon of its corners plus the segments between chords
/// and arcs.
fn area(line: &Element) -> f64 {
    let part = |part: &Part| {
        let [[x_0, y_0], [x, y]] = part.ends();
        let segment = match part {
            Part::Line(_) => 0.0,
            Part::Arc(_, [a, b], _, [from, to]) => a * b * (to - from - (to - from).sin()),
        };
        0.5 * (x_0 * y - x * y_0 + segment)
    };
    line.iter().map(part).sum()
}

/// The texture of a case, and its edge, as closed lines of a DXF, in blocks.
fn drawn(text: &str) -> [Vec<(String, Element)>; 2] {
    let case = Case::parse(text, "case", "", &[]).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.dxf");
    write(&case, &path, Options::default()).unwrap();
    let dxf = fs::read_to_string(path).unwrap();
    [false, true].map(|is_edge| {
        let found = entities(&dxf, |layer| (layer == "SLIDER") == is_edge).into_iter();
        let line = |pairs: &[_], kind| closed_line(kind, pairs, 1e3 * case.scales.block_size);
        found
            .map(|(kind, pairs)| (kind.to_owned(), line(&pairs, kind)))
            .collect()
    })
}

/// Area of the part of a circle around the origin to the right of `x` and above `y`, a point inside it.
fn right_of_and_above(radius: f64, x: f64, y: f64) -> f64 {
    let [beside, above] = [x, y].map(|length| (radius * radius - length * length).sqrt());
    let angle = (x / radius).acos() - (y / radius).asin();
    0.5 * (radius * radius * angle - x * (beside - y) - y * (above - x))
}

/// Common area of two circles with these radii and this distance of their centres.
fn lens(a: f64, b: f64, apart: f64) -> f64 {
    let half = |a: f64, b: f64| {
        let chord = (apart * apart + a * a - b * b) / (2.0 * apart);
        a * a * (chord / a).acos() - chord * (a * a - chord * chord).sqrt()
    };
    half(a, b) + half(b, a)
}

/// Circles with a radius of 9 blocks on a slider of 40 blocks by 30, or on a disc of 40.
#[test_case("blocks = [40, 30]", [3.0, 15.0], &[right_of_and_above(9.0, -3.0, 0.0) * 2.0]; "cut by an edge")]
#[test_case("blocks = [40, 30]", [0.0, 38.0 / 3.0], &[81.0 * PI / 2.0]; "around an edge")]
#[test_case("blocks = [40, 30]", [3.0, 4.0], &[right_of_and_above(9.0, -3.0, -4.0)]; "cut by a corner")]
#[test_case("blocks = [40, 30]", [40.0, 0.0], &[81.0 * PI / 4.0]; "around a corner")]
#[test_case("blocks = [40, 30]", [49.0, 15.0], &[]; "beside an edge")]
#[test_case("blocks = [40, 40]\noutline = 'disc'", [35.0, 20.0], &[lens(9.0, 20.0, 15.0)]; "cut by a disc")]
#[test_case("blocks = [40, 40]\noutline = 'disc'", [3.0, 3.0], &[lens(9.0, 20.0, 17.0 * 2_f64.sqrt())]; "in the corner of a disc")]
#[test_case("blocks = [40, 40]\noutline = 'disc'", [48.0, 40.0], &[]; "beside a disc")]
fn circles_are_cut_exactly(slider: &str, center: [f64; 2], areas: &[f64]) {
    let [x, y] = center;
    let texture = format!("[[texture]]\nshape = 'cavity'\nlambda = '9 um'\ncenter = ['{x} um', '{y} um']\n");
    let [shapes, edge] = drawn(&format!("[slider]\n{slider}\n{texture}"));
    assert_eq!(shapes.len(), areas.len());
    for ((kind, line), wanted) in shapes.iter().zip(areas) {
        assert_eq!(kind, "LWPOLYLINE");
        // Rounding: about twenty operations on numbers up to four times as large.
        assert!(
            (area(line) / wanted - 1.0).abs() < 1e-12,
            "{} {wanted}",
            area(line)
        );
    }
    let (kind, size) = if slider.contains("disc") {
        ("CIRCLE", 400.0 * PI)
    } else {
        ("LWPOLYLINE", 1200.0)
    };
    assert_eq!(edge[0].0, kind);
    assert!(edge.len() == 1 && (area(&edge[0].1) / size - 1.0).abs() < 1e-12);
}

/// No line without an inside is written: neither for a polygon without an area, nor for a groove or a copy
/// that touches the edge from outside.
#[test_case(
    "edges = 'free'",
    "shape = 'polygon'\npoints = [['1 um', '1 um'], ['9 um', '9 um'], ['5 um', '5 um']]"
)]
#[test_case("edges = 'free'", "shape = 'groove'\nwidth = '10 um'\noffset = '25 um'")]
#[test_case("edges = 'periodic'", "shape = 'groove'\nwidth = '10 um'\noffset = '15 um'")]
#[test_case(
    "edges = 'free'",
    "shape = 'cavity'\nlambda = '9 um'\ncenter = ['-9 um', '15 um']"
)]
fn nothing_empty_is_drawn(edges: &str, texture: &str) {
    let [shapes, _] = drawn(&format!(
        "[slider]\nblocks = [40, 30]\n{edges}\n[[texture]]\n{texture}\n"
    ));
    let filled = usize::from(edges.contains("periodic"));
    assert_eq!(shapes.len(), filled);
    assert!(shapes.iter().all(|(_, line)| area(line) > 1.0));
}

#[test]
fn dimples_over_periodic_edges_are_closed_lines() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let text = fs::read_to_string(folder.join("hexagonal_dimples.toml")).unwrap();
    let [shapes, _] = drawn(&text);
    let count = |kind: &str| shapes.iter().filter(|(other, _)| other == kind).count();
    // A dimple of each of the four rows is cut, and continues at the opposite edge.
    assert_eq!((shapes.len(), count("CIRCLE"), count("LWPOLYLINE")), (20, 12, 8));
    let all: f64 = shapes.iter().map(|(_, line)| area(line)).sum();
    // The total is that of sixteen dimples.
    assert!((all / (256.0 * PI) - 1.0).abs() < 1e-12, "{all}");
}

#[test]
fn pictures_and_fields_read_back_as_the_same_texture() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let text = "slider.blocks = [37, 22]\n[[texture]]\nshape = 'cavity'\ncoverage = 20\nw = 0.3\nrotate = 20\ncenter = ['12 um', '7 um']";
    let case = Case::parse(text, "case", "", &[]).unwrap();
    let textured = textured_blocks(&case);
    for (scale, size) in [(None, [37, 22]), (Some(3), [111, 66])] {
        let options = Options { scale, depth: None };
        write(&case, &path("mask.png"), options).unwrap();
        let text = "slider.blocks = [37, 22]\n[[texture]]\nshape = 'mask'\nfile = 'mask.png'";
        let read = Case::parse(text, "case", folder.path(), &[]).unwrap();
        assert_eq!(textured_blocks(&read), textured);
        let file = fs::File::open(path("mask.png")).unwrap();
        let info = png::Decoder::new(std::io::BufReader::new(file))
            .read_info()
            .unwrap()
            .info()
            .clone();
        assert_eq!([info.width, info.height], size);
    }
    write(&case, &path("mask.gsf"), Options::default()).unwrap();
    let bytes = fs::read(path("mask.gsf")).unwrap();
    let end = bytes.iter().position(|byte| *byte == 0).unwrap();
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    assert!(
        header.starts_with("Gwyddion Simple Field 1.0\nXRes = 37\nYRes = 22\n"),
        "{header}"
    );
    let length = |name: &str| -> f64 {
        let (_, rest) = header.split_once(&format!("\n{name} = ")).unwrap();
        rest.lines().next().unwrap().parse().unwrap()
    };
    assert!((length("XReal") - 37e-6).abs() < 1e-18 && (length("YReal") - 22e-6).abs() < 1e-18);
    let numbers = &bytes[end / 4 * 4 + 4..];
    let heights: Vec<f32> = numbers
        .chunks(4)
        .map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap()))
        .collect();
    assert_eq!(heights.len(), 37 * 22);
    for (b, textured) in textured.iter().enumerate() {
        assert_eq!(
            heights[(21 - b / 37) * 37 + b % 37],
            if *textured { 0.0 } else { 1.0 }
        );
    }
    for (name, scale, depth, part) in [
        ("a.jpg", None, None, ".gsf for a height field"),
        ("a.svg", Some(2), None, "--scale"),
        ("a.png", Some(40_000), None, "reduce `--scale`"),
        ("a.stl", None, None, "write `--depth"),
        ("a.png", None, Some(1e-6), "leave `--depth` out"),
    ] {
        let options = Options { scale, depth };
        let said = write(&case, &path(name), options).unwrap_err().to_string();
        assert!(said.contains(part), "{said}");
        assert!(!Path::new(&path(name)).exists());
    }
}

/// A solid is closed: every edge of a triangle is that of another one, the other way round.
#[test_case(""; "a dimple")]
#[test_case("outline = 'disc'"; "on a disc")]
#[test_case("outline = 'mask'\noutline_file = 'holes.png'"; "with blocks that touch at corners")]
fn a_solid_is_closed_and_has_its_volume(slider: &str) {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let exists: Vec<bool> = (0..400).map(|b| (b % 20 / 3 + b / 60) % 2 == 0).collect();
    fs::write(
        path("holes.png"),
        slipfront_case::arrays::png_of_mask(20, 20, &exists).unwrap(),
    )
    .unwrap();
    let texture =
        "[[texture]]\nshape = 'cavity'\nlambda = '5 um'\nw = 0.2\nrotate = 20\ncenter = ['9 um', '7 um']";
    let text = format!("[slider]\nblocks = [20, 20]\n{slider}\n{texture}");
    let case = Case::parse(&text, "case", folder.path(), &[]).unwrap();
    let depth = Some(2e-6);
    write(
        &case,
        &path("face.stl"),
        Options {
            depth,
            ..Options::default()
        },
    )
    .unwrap();
    let bytes = fs::read(path("face.stl")).unwrap();
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    let mut edges: BTreeMap<[[u32; 3]; 2], usize> = BTreeMap::new();
    let mut volume = 0.0;
    for triangle in bytes[84..].chunks(50) {
        let numbers = triangle[..48].as_chunks().0.iter();
        let numbers: Vec<f32> = numbers.map(|bytes| f32::from_le_bytes(*bytes)).collect();
        let [normal, a, b, c] = [0, 1, 2, 3].map(|k| [0, 1, 2].map(|axis| f64::from(numbers[3 * k + axis])));
        let across = |p: [f64; 3], q: [f64; 3]| {
            [0, 1, 2].map(|k| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3])
        };
        let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| p[k] - q[k]);
        assert!(dot(across(minus(b, a), minus(c, a)), normal) > 0.0);
        volume += dot(across(a, b), c) / 6.0;
        let bits = |point: [f64; 3]| point.map(|length| (length as f32).to_bits());
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge.map(bits)).or_default() += 1;
        }
    }
    let is_shared = |edge: &[[u32; 3]; 2]| edges[edge] == 1 && edges.get(&[edge[1], edge[0]]) == Some(&1);
    assert!(edges.keys().all(is_shared));
    let blocks = (0..400).filter(|&b| case.model.slider().exists(b)).count() as f64;
    let covered = textured_blocks(&case)
        .into_iter()
        .filter(|&textured| textured)
        .count() as f64;
    assert!(covered > 30.0);
    // Cubic millimetres. Corners that are moved take up to a 256th of a block at each.
    let wanted = (4.0 * blocks - 2.0 * covered) * 1e-9;
    let moved = if slider.contains("mask") { 1e-2 } else { 1e-4 };
    assert!((volume / wanted - 1.0).abs() < moved, "{volume} {wanted}");
}

#[test]
fn the_smallest_lengths_are_told_of_every_shape() {
    for (texture, feature, gap) in [
        (
            "shape = 'cavity'\nlambda = '2 um'\npitch = '5 um'",
            Some(4.0),
            Some(1.0),
        ),
        (
            "shape = 'cavity'\nlambda = '2 um'\npitch = '5 um'\ninvert = true",
            Some(1.0),
            Some(4.0),
        ),
        (
            "shape = 'groove'\nwidth = '0.5 um'\npitch = '5 um'",
            Some(0.5),
            Some(4.5),
        ),
        ("shape = 'cavity'\nlambda = '2 um'", Some(4.0), None),
    ] {
        let case = Case::parse(
            &format!("slider.blocks = [40, 40]\n[[texture]]\n{texture}"),
            "case",
            "",
            &[],
        )
        .unwrap();
        let found = smallest(&case).unwrap();
        // Rounding of positions up to 40, a hundred times.
        let near = |found: Option<f64>, wanted: Option<f64>| match (found, wanted) {
            (Some(found), Some(wanted)) => (found - wanted).abs() < 1e-12,
            (found, wanted) => found == wanted,
        };
        assert!(
            near(found.feature, feature) && near(found.gap, gap),
            "{texture}: {found:?}"
        );
    }
}

/// Only the lowest row of an upright sheet can be textured; the blocks above it do not count as texture.
#[test]
fn an_upright_sheet_has_its_texture_in_the_lowest_row() {
    let text = "slider.blocks = [12, 5]\nfriction.along = 'x'\n\
                texture = [{ shape = 'groove', width = '3 um', orientation = 'across' }]";
    let case = Case::parse(text, "upright", "", &[]).unwrap();
    let textured = textured_blocks(&case);
    let in_groove: Vec<usize> = (0..60).filter(|&b| textured[b]).collect();
    assert_eq!(in_groove, [4, 5, 6]);
    assert!(case.texture.meshed_percent > 0.0);
}
