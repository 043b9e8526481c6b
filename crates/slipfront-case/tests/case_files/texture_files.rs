//! Files of textures for other programs: their outlines fill the textured blocks of the case.

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use slipfront_case::case::Case;
use slipfront_case::texture_file::{smallest, textured_blocks, write};
use test_case::test_case;

/// A piece of a closed line, in blocks.
#[derive(Clone, Copy, Debug)]
enum Part {
    Line([[f64; 2]; 2]),
    /// Centre, semi-axes, direction of the first, and parameters.
    Arc([f64; 2], [f64; 2], f64, [f64; 2]),
}

/// Parts that are filled together by the even-odd rule.
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

    /// Number of times that a ray from a point to the right meets the part.
    fn crossings(&self, [x, y]: [f64; 2]) -> usize {
        let meets = |from: [f64; 2], to: [f64; 2]| (from[1] <= y) != (to[1] <= y);
        match *self {
            Part::Line([p, q]) => {
                usize::from(meets(p, q) && p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]) > x)
            }
            Part::Arc(center, [a, b], angle, [from, to]) => {
                // y = center + reach cos(t - middle), which rises or falls between multiples of pi.
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
                    // The one of the two solutions, in any turn, that is nearest to the part.
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

    /// Largest distance of a point from the part.
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

/// The elements of an SVG, in blocks with y upwards.
fn svg(text: &str, [nx, ny]: [usize; 2]) -> Vec<Element> {
    let head = text.lines().next().unwrap();
    let block = number_of(head, "width").unwrap() / nx as f64;
    assert!((number_of(head, "height").unwrap() / block - ny as f64).abs() < 1e-9);
    let point = |x: f64, y: f64| [x / block, ny as f64 - y / block];
    let mut elements = Vec::new();
    for line in text.lines() {
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
        // An exponent is no command.
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
                assert_eq!((large, sweep), (0.0, 0.0));
                let to = point(x, y);
                parts.push(arc(here, to, [a / block, b / block], -degrees.to_radians()));
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

/// The arc of less than half a turn, counterclockwise, found in coordinates in which the ellipse is the unit
/// circle.
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

/// Parameters of an arc such that its end comes after its start.
fn counterclockwise([from, to]: [f64; 2]) -> [f64; 2] {
    [from, if to > from { to } else { to + TAU }]
}

/// The elements of a DXF, in blocks: each closed line, or all of a layer that is filled by the even-odd rule.
fn dxf(text: &str, block: f64) -> Vec<Element> {
    let lines: Vec<&str> = text.lines().collect();
    let pairs: Vec<(u16, &str)> = lines
        .chunks(2)
        .map(|pair| (pair[0].trim().parse().unwrap(), pair[1]))
        .collect();
    let begin = pairs.iter().position(|pair| *pair == (2, "ENTITIES")).unwrap();
    let pairs = &pairs[begin + 1..];
    let end = pairs.iter().position(|pair| *pair == (0, "ENDSEC")).unwrap();
    let starts = (0..=end).filter(|&at| pairs[at].0 == 0).collect::<Vec<_>>();
    let mut elements: Vec<Element> = Vec::new();
    let mut even_odd: Vec<(String, usize)> = Vec::new();
    let mut open: Element = Vec::new();
    for span in starts.windows(2) {
        let entity = &pairs[span[0]..span[1]];
        let text = |code: u16| entity.iter().find(|pair| pair.0 == code).unwrap().1;
        let number = |code: u16| text(code).parse::<f64>().unwrap();
        let length = |code: u16| number(code) / block;
        let layer = text(8);
        if layer == "SLIDER" {
            continue;
        }
        match entity[0].1 {
            "LWPOLYLINE" => {
                let all = |code: u16| {
                    entity
                        .iter()
                        .filter(move |pair| pair.0 == code)
                        .map(|pair| pair.1.parse::<f64>().unwrap() / block)
                };
                let corners: Vec<[f64; 2]> = all(10).zip(all(20)).map(|(x, y)| [x, y]).collect();
                assert_eq!(number(90) as usize, corners.len());
                let next = corners.iter().cycle().skip(1);
                open.extend(corners.iter().zip(next).map(|(p, q)| Part::Line([*p, *q])));
            }
            "LINE" => open.push(Part::Line([[length(10), length(20)], [length(11), length(21)]])),
            "CIRCLE" => open.push(Part::Arc(
                [length(10), length(20)],
                [length(40); 2],
                0.0,
                [0.0, TAU],
            )),
            "ARC" => {
                let ends = counterclockwise([50, 51].map(|code| number(code).to_radians()));
                open.push(Part::Arc([length(10), length(20)], [length(40); 2], 0.0, ends));
            }
            "ELLIPSE" => {
                let major = [length(11), length(21)];
                let a = major[0].hypot(major[1]);
                assert!(number(40) <= 1.0);
                let ends = counterclockwise([number(41), number(42)]);
                open.push(Part::Arc(
                    [length(10), length(20)],
                    [a, a * number(40)],
                    major[1].atan2(major[0]),
                    ends,
                ));
            }
            other => panic!("{other}"),
        }
        let (first, last) = (open[0].ends()[0], open[open.len() - 1].ends()[1]);
        if (first[0] - last[0]).hypot(first[1] - last[1]) > 1e-6 {
            continue;
        }
        let element = std::mem::take(&mut open);
        match even_odd.iter().find(|(name, _)| name == layer) {
            Some((_, at)) => elements[*at].extend(element),
            None => {
                if layer.ends_with("EVEN_ODD") {
                    even_odd.push((layer.to_owned(), elements.len()));
                }
                elements.push(element);
            }
        }
    }
    assert!(open.is_empty(), "an outline is open");
    elements
}

/// Every block is textured as the elements say, but for centres within 1e-9 block of an outline.
fn expect_filled(elements: &[Element], textured: &[bool], nx: usize, what: &str) {
    for (b, textured) in textured.iter().enumerate() {
        let center = [(b % nx) as f64 + 0.5, (b / nx) as f64 + 0.5];
        let odd =
            |element: &Element| element.iter().map(|part| part.crossings(center)).sum::<usize>() % 2 == 1;
        if elements.iter().any(odd) != *textured {
            let nearest = elements
                .iter()
                .flatten()
                .map(|part| part.distance(center))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 1e-9,
                "{what}: block ({}, {}), {nearest} from an outline",
                b % nx,
                b / nx
            );
        }
    }
}

const SHAPES: &[&str] = &[
    "[[texture]]\nshape = 'cavity'\ncoverage = 10",
    // Over two free edges, and over the corner.
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

#[test_case("", &[""])]
#[test_case("[slider]\nblocks = [40, 30]\n", SHAPES)]
#[test_case("[slider]\nblocks = [40, 30]\nedges = 'periodic'\n", SHAPES)]
#[test_case(
    "[slider]\nblocks = [40, 30]\nblock_size = '1.7 nm'\n",
    &["[[texture]]\nshape = 'cavity'\ncoverage = 10\nw = 0.3"]
)]
#[test_case("[slider]\nblocks = [31, 31]\noutline = 'disc'\n", &SHAPES[..2])]
fn outlines_fill_the_blocks_of_the_mask(slider: &str, shapes: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let mask: Vec<bool> = (0..30).map(|b| b % 7 < 2 || b == 12).collect();
    std::fs::write(
        folder.path().join("mask.png"),
        slipfront_case::arrays::png_of_mask(6, 5, &mask).unwrap(),
    )
    .unwrap();
    for shape in shapes {
        let text = format!("{slider}{shape}");
        let case = Case::parse(&text, "case", folder.path(), &[]).unwrap();
        let (nx, ny) = (case.model.lattice.nx, case.model.lattice.ny);
        let textured = textured_blocks(&case);
        assert_eq!(textured.contains(&true), !text.is_empty());
        let written = |name: &str| {
            write(&case, &folder.path().join(name), None).unwrap();
            fs::read_to_string(folder.path().join(name)).unwrap()
        };
        expect_filled(
            &svg(&written("a.svg"), [nx, ny]),
            &textured,
            nx,
            &format!("SVG of {text}"),
        );
        let block = 1e3 * case.scales.block_size;
        expect_filled(
            &dxf(&written("a.dxf"), block),
            &textured,
            nx,
            &format!("DXF of {text}"),
        );
    }
}

#[test]
fn circles_and_ellipses_are_written_as_such_and_cavities_as_4096_corners() {
    let folder = tempfile::tempdir().unwrap();
    let written = |shape: &str, name: &str| {
        let text = format!("slider.blocks = [40, 30]\n[[texture]]\nshape = 'cavity'\n{shape}");
        let case = Case::parse(&text, "case", "", &[]).unwrap();
        write(&case, &folder.path().join(name), None).unwrap();
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
    // The edge of the slider, for registration, in both.
    assert!(
        svg.contains("<rect id=\"SLIDER\" width=\"0.04\" height=\"0.03\" fill=\"none\" stroke=\"black\" "),
        "{svg:.300}"
    );
    assert_eq!(
        count(&written(square, "a.dxf"), "\nSLIDER\n"),
        count(&written(ellipse, "b.dxf"), "\nSLIDER\n")
    );
    assert!(written(square, "a.dxf").contains("\n90\n4096\n70\n1\n"));
    // In true size: 40 blocks of 1 um.
    assert!(written(square, "a.svg").contains("width=\"0.04mm\" height=\"0.03mm\""));
}

#[test]
fn pictures_and_fields_read_back_as_the_same_texture() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let text = "slider.blocks = [37, 22]\n[[texture]]\nshape = 'cavity'\ncoverage = 20\nw = 0.3\nrotate = 20\ncenter = ['12 um', '7 um']";
    let case = Case::parse(text, "case", "", &[]).unwrap();
    let textured = textured_blocks(&case);
    for (scale, size) in [(None, [37, 22]), (Some(3), [111, 66])] {
        write(&case, &path("mask.png"), scale).unwrap();
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
    write(&case, &path("mask.gsf"), None).unwrap();
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
    for (name, scale, part) in [
        ("a.jpg", None, ".gsf for a height field"),
        ("a.svg", Some(2), "--scale"),
        ("a.png", Some(40_000), "lower `--scale`"),
    ] {
        let said = write(&case, &path(name), scale).unwrap_err().to_string();
        assert!(said.contains(part), "{said}");
        assert!(!Path::new(&path(name)).exists());
    }
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
        // Rounding of places up to 40, a hundred times over.
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
