//! Pictures of every kind and of unusual shapes: no two texts overlap, none leaves the page, and in a picture
//! of a single run, no curve crosses a text.
//!
//! The pictures are written to the folder in `SLIPFRONT_GALLERY`, if it is set.

// Clippy does not treat helpers of tests as tests.
#![allow(clippy::unwrap_used)]

mod bytes;
mod page;
mod runs;

use std::path::Path;

use slipfront_plot::{
    Bar, BarChart, BarGroup, Distribution, Estimate, FieldMap, FieldMaps, FrictionAxes, FrictionCurve,
    HeatAxis, HeatMap, KineticLine, Picture, PictureError, PictureFormat, PictureSize, Polar, Response,
    Responses, Shape, Sketch, Stroke, StrokeStyle, bars, distributions, field_maps, friction, front,
    heat_map, kymograph, polar, response, shapes, sketch, stress,
};

use page::Page;
use runs::*;

const UM: f64 = 1e-6;
const INSTANTS: [&str; 6] = ["A", "B", "C", "D", "E", "F"];

/// Width and letters of a figure in a journal's column.
const COLUMN: PictureSize = PictureSize {
    width_mm: Some(89.0),
    height_mm: None,
    font_pt: Some(8.0),
};

/// Checks a picture in its usual size and in a column, if that has room for it, and writes it if a folder is
/// set; returns the page of the usual size.
fn check(name: &str, draw: impl Fn(PictureSize) -> Result<Picture, PictureError>) -> Page {
    match draw(COLUMN) {
        Ok(picture) => {
            let page = check_one(&format!("{name}-column"), &picture);
            let width = page.width * 8.0 / 7.92 / 300.0 * 25.4;
            assert!((width - 89.0).abs() < 1e-3, "{name} is {width} mm wide");
        }
        Err(PictureError::TooSmall { .. }) => {}
        Err(error) => panic!("{name} in a column: {error}"),
    }
    check_one(
        name,
        &draw(PictureSize::default()).unwrap_or_else(|error| panic!("{name}: {error}")),
    )
}

/// Checks a picture, and writes it if a folder is set.
fn check_one(name: &str, picture: &Picture) -> Page {
    if let Some(folder) = std::env::var_os("SLIPFRONT_GALLERY") {
        std::fs::create_dir_all(&folder).unwrap();
        for format in PictureFormat::ALL {
            let path = Path::new(&folder).join(format!("{name}.{}", format.ending()));
            std::fs::write(path, picture.file(format)).unwrap();
        }
    }
    let page = Page::parse(&picture.svg);
    assert!(!page.texts.is_empty(), "{name} has no text");
    let faults = page.faults();
    assert!(faults.is_empty(), "{name}:\n{}", faults.join("\n"));
    page
}

fn star(curves: &[FrictionCurve]) -> impl Fn(PictureSize) -> Result<Picture, PictureError> {
    |size| friction(curves, &FrictionAxes::default(), size)
}

#[test]
fn a_run() {
    let with_uncertainty = |mut curve: FrictionCurve| {
        curve.kinetic = curve.kinetic.map(|window| KineticLine {
            uncertainty: Some(0.0042),
            ..window
        });
        curve
    };
    let early = {
        // Everything at once: the first instants coincide, and the window begins at the start.
        let mut curve = baseline();
        curve.first_slip = Some(0.5);
        for (instant, x) in curve.instants.iter_mut().zip([0.0, 0.5, 79.0, 79.2, 0.2, 130.0]) {
            (instant.x, instant.friction) = (x, if x > 70.0 { 0.876 } else { 0.0 });
        }
        curve.kinetic = curve.kinetic.map(|window| KineticLine { from: 2.0, ..window });
        curve
    };
    let late = {
        let mut curve = with_uncertainty(baseline());
        curve.first_slip = Some(255.0);
        curve.kinetic = curve.kinetic.map(|window| KineticLine {
            from: 250.0,
            ..window
        });
        curve
    };
    for (name, curve) in [
        ("run", baseline()),
        ("run-uncertain", with_uncertainty(baseline())),
        ("run-single-block", single_block(94.1)),
        ("run-single-block-many", single_block(20.0)),
        ("run-fast", fast()),
        ("run-early", early),
        ("run-late", late),
    ] {
        let page = check(name, star(&[curve]));
        let crossed = page.crossed();
        assert!(crossed.is_empty(), "{name}: {crossed:?}");
    }
    let newtons = FrictionAxes {
        x: "drive displacement (pm)".to_owned(),
        friction: "friction force (\u{b5}N)".to_owned(),
        peak: "F_s".to_owned(),
        kinetic: "F_k".to_owned(),
        unit: " \u{b5}N".to_owned(),
    };
    let fast = [with_uncertainty(fast())];
    check("run-newtons", |size| friction(&fast, &newtons, size));
}

/// The legend of an overlay, name after name.
fn legend(page: &Page, count: usize) -> Vec<String> {
    let texts = page.texts.iter().map(|written| written.text.clone());
    let names: Vec<String> = texts
        .filter(|text| text.contains("run") || text.contains('\u{2026}'))
        // The common folder is above them.
        .filter(|text| !text.starts_with("results/a_rather"))
        .collect();
    assert_eq!(names.len(), count, "{names:?}");
    names
}

#[test]
fn overlays() {
    let overlay = |name: &str, labels: &[String]| {
        let speeds = labels.iter().enumerate();
        let curves: Vec<_> = speeds
            .map(|(k, label)| at_speed(label, 0.05 * k as f64))
            .collect();
        let page = check(name, star(&curves));
        let mut names = legend(&page, labels.len());
        names.sort();
        names.dedup();
        assert_eq!(names.len(), labels.len(), "{name}: {names:?}");
    };
    let numbered = |count: usize, label: &dyn Fn(usize) -> String| (1..=count).map(label).collect::<Vec<_>>();
    overlay("overlay-2", &numbered(2, &|k| format!("run {k}")));
    overlay("overlay-10", &numbered(10, &|k| format!("run {k}")));
    overlay("overlay-30", &numbered(30, &|k| format!("run {k}")));
    let measured = FrictionCurve {
        instants: Vec::new(),
        is_record: true,
        ..at_speed("force.csv", 0.1)
    };
    check("overlay-measured", star(&[baseline(), measured]));
    let long = "results/a_rather_long_name_of_a_study_of_many_materials";
    // The common folder of all names is above them, once.
    let speeds: Vec<FrictionCurve> = (1..=4)
        .map(|k| at_speed(&format!("{long}/speed_0.{k}"), 0.05 * f64::from(k)))
        .collect();
    let page = check("overlay-long", star(&speeds));
    let texts: Vec<&str> = page.texts.iter().map(|written| written.text.as_str()).collect();
    for k in 1..=4 {
        assert!(texts.contains(&format!("speed_0.{k}").as_str()), "{texts:?}");
    }
    assert_eq!(
        texts
            .iter()
            .filter(|text| text.starts_with("results/a_rather"))
            .count(),
        1
    );
    for (name, [width, height, font]) in [
        ("overlay-narrow", [60.0, 120.0, 7.0]),
        ("overlay-wide", [120.0, 70.0, 11.0]),
        ("overlay-smallest", [43.0, 48.0, 8.0]),
    ] {
        let size = PictureSize {
            width_mm: Some(width),
            height_mm: Some(height),
            font_pt: Some(font),
        };
        let drawn = friction(&speeds, &FrictionAxes::default(), size);
        check_one(name, &drawn.unwrap_or_else(|error| panic!("{name}: {error}")));
    }
    // A legend of thirty names takes the whole height.
    let low = PictureSize {
        height_mm: Some(50.0),
        ..PictureSize::default()
    };
    let many: Vec<FrictionCurve> = (0..30).map(|k| at_speed(&format!("run {k}"), 0.1)).collect();
    let said = friction(&many, &FrictionAxes::default(), low)
        .unwrap_err()
        .to_string();
    assert!(
        said.starts_with("a height of 50 mm leaves no room for curves with text of 8 pt"),
        "{said}"
    );
    overlay(
        "overlay-equal",
        &numbered(4, &|k| format!("series_{k}/{long}/{long}")),
    );
    overlay(
        "overlay-alike",
        &numbered(3, &|k| format!("{long}/{k}/{long}/run")),
    );
}

#[test]
fn stress_on_every_shape() {
    let maps = |nx, ny, texture| stress_maps(nx, ny, UM, texture, &INSTANTS);
    for (name, maps) in [
        ("stress", maps(50, 50, CIRCLE)),
        (
            "stress-1x1",
            stress_maps(1, 1, UM, SMOOTH, &["A", "B, C, D", "E", "F"]),
        ),
        ("stress-1x100", maps(1, 100, SMOOTH)),
        ("stress-100x1", maps(100, 1, SMOOTH)),
        ("stress-4x400", maps(4, 400, SMOOTH)),
        ("stress-400x4", maps(400, 4, SMOOTH)),
        ("stress-1000x4", maps(1000, 4, SMOOTH)),
        ("stress-1000x4-one", stress_maps(1000, 4, UM, SMOOTH, &["A"])),
        ("stress-200x50", maps(200, 50, DIMPLES)),
        ("stress-60x100", stress_maps(60, 100, UM, DIMPLES, &INSTANTS[..5])),
        ("stress-dimples", maps(200, 200, DIMPLES)),
        ("stress-mask", maps(50, 50, HERRINGBONE)),
        (
            "stress-square-centimetre",
            stress_maps(1000, 1000, 10.0 * UM, LARGE_DIMPLES, &["C"]),
        ),
        (
            "stress-times",
            stress_maps(30, 30, UM, SMOOTH, &["t* = 0.0", "t* = 2000.5", "t* = 12345.6"]),
        ),
    ] {
        check(name, |size| stress(&maps, false, size));
    }
    let torque = slipfront_plot::SnapshotMaps {
        value_title: "velocity along x (\u{b5}m/s)".to_owned(),
        range: [-1.3e-7, 2.6e-7],
        ..maps(40, 40, SMOOTH)
    };
    check("stress-torque", |size| stress(&torque, true, size));
}

#[test]
fn fronts_on_every_shape() {
    for (name, (map, space_time)) in [
        ("front", front_of(50, 50, UM, CIRCLE, 3)),
        ("front-1x1", front_of(1, 1, UM, SMOOTH, 1)),
        ("front-1x100", front_of(1, 100, UM, SMOOTH, 6)),
        ("front-100x1", front_of(100, 1, UM, SMOOTH, 6)),
        ("front-4x400", front_of(4, 400, UM, SMOOTH, 30)),
        ("front-400x4", front_of(400, 4, UM, SMOOTH, 17)),
        ("front-1000x4", front_of(1000, 4, UM, SMOOTH, 30)),
        ("front-dimples", front_of(200, 200, UM, DIMPLES, 20)),
        ("front-mask", front_of(50, 50, UM, HERRINGBONE, 4)),
        (
            "front-square-centimetre",
            front_of(1000, 1000, 10.0 * UM, LARGE_DIMPLES, 9),
        ),
        ("front-200x50", front_of(200, 50, UM, SMOOTH, 2)),
    ] {
        check(name, |size| front(&map, &space_time, size));
        check(&name.replace("front", "kymograph"), |size| {
            kymograph(&space_time, size)
        });
    }
}

/// Note below the pictures of studies.
const NOTE: &str = "intervals: 95 % of the mean, n = 3 to 12";

fn curve(label: &str, level: f64, line: bool) -> Response {
    let point = |x: f64| {
        let mean = level - 0.1 * x.ln();
        // The second point is marked, as runs without a transition are.
        let crossed = !line && x == 0.03;
        (
            x,
            Estimate {
                crossed,
                ..Estimate::between(mean - 0.05, mean, mean + 0.05)
            },
        )
    };
    Response {
        label: label.to_owned(),
        points: [0.01, 0.03, 0.1, 0.3].map(point).to_vec(),
        line,
    }
}

#[test]
fn responses() {
    let drawn = |titles: [&str; 3], labels: &[&str], size: PictureSize| {
        let labels = labels.iter().enumerate();
        response(
            &Responses {
                x_title: titles[0].to_owned(),
                log_x: true,
                y_title: titles[1].to_owned(),
                legend_title: titles[2].to_owned(),
                note: NOTE.to_owned(),
                curves: labels
                    .map(|(k, label)| curve(label, 1.0 + 0.1 * k as f64, k == 1))
                    .collect(),
                ..Responses::default()
            },
            size,
        )
    };
    let titles = ["drive speed V*", "static friction \u{3bc}\u{209b}*", "P"];
    check("response", |size| drawn(titles, &[""], size));
    check("response-pressures", |size| {
        drawn(titles, &["50 kPa", "100 kPa", "1 MPa"], size)
    });
    let nine = ["10", "[20, 10]", "30", "40", "50", "[60, 10]", "70", "80", "90"];
    let reductions = ["V*", "reduction of \u{3bc}\u{209b}* (%)", "blocks along a side"];
    check("response-nine", |size| drawn(reductions, &nine, size));
    let precursors = [
        "tangential/normal force F\u{209c}/F\u{2099} after the event",
        "relative length L\u{209a}/L",
        "",
    ];
    check("precursors", |size| drawn(precursors, &["events", "exact"], size));
}

/// Catalogues of events: small ones that follow a power law plus one that is far larger; a few; equal ones;
/// and two.
#[test]
fn catalogues() {
    let moments = |count: usize| {
        (1..count)
            .map(|k| 1e3 / k as f64)
            .chain([2e4])
            .collect::<Vec<_>>()
    };
    let waits = |count: usize| {
        (1..count)
            .map(|k| -3.0 * libm::log(k as f64 / count as f64))
            .collect::<Vec<_>>()
    };
    let drawn = |moments: &[f64], waits: &[f64], note: &str, size: PictureSize| {
        let panel = |x_title: &str, y_title: &str, values: &[f64]| Distribution {
            x_title: x_title.to_owned(),
            y_title: y_title.to_owned(),
            values: values.to_vec(),
        };
        let panels = [
            panel(
                "moment M* (displacement times blocks)",
                "events of at least M*",
                moments,
            ),
            panel("waiting time t* of the drive", "waits of at least t*", waits),
        ];
        distributions(&panels, note, size)
    };
    let note = "without 3 events that slip backwards";
    check("events", |size| drawn(&moments(30_000), &waits(30_000), "", size));
    check("events-few", |size| drawn(&moments(12), &waits(12), note, size));
    check("events-equal", |size| drawn(&[2.0; 40], &[7.0; 39], "", size));
    check("events-two", |size| drawn(&[2e-7, 3e5], &[7.0], "", size));
}

/// Friction against direction: equal in all directions, larger along one axis, with wide intervals, without a
/// value in one.
#[test]
fn polars() {
    let around = |label: &str, mean: &dyn Fn(f64) -> f64, half: f64| {
        let point = |k: i32| {
            let degrees = 15.0 * f64::from(k);
            let mean = mean(degrees);
            let value = Estimate {
                crossed: degrees == 60.0,
                ..Estimate::between(mean - half, mean, mean + half)
            };
            (degrees, value)
        };
        Response {
            label: label.to_owned(),
            points: (0..24).map(point).collect(),
            line: false,
        }
    };
    let twofold = |degrees: f64| 0.65 + 0.15 * (2.0 * (degrees - 60.0).to_radians()).cos();
    let drawn = |legend_title: &str, curves: &[Response], size: PictureSize| {
        polar(
            &Polar {
                value_title: "friction \u{3bc}*".to_owned(),
                legend_title: legend_title.to_owned(),
                note: NOTE.to_owned(),
                curves: curves.to_vec(),
            },
            size,
        )
    };
    let [statics, kinetics] = ["\u{3bc}\u{209b}*", "\u{3bc}\u{2096}*"];
    let isotropic = around(statics, &|_| 0.8, 0.01);
    check("polar-isotropic", |size| {
        drawn("", std::slice::from_ref(&isotropic), size)
    });
    let pair = vec![
        around(statics, &twofold, 0.02),
        around(kinetics, &|_| 0.45, 0.005),
    ];
    check("polar-twofold", |size| drawn("", &pair, size));
    let wide = vec![around(statics, &twofold, 0.9), around(kinetics, &|_| 0.45, 0.6)];
    check("polar-wide", |size| drawn("", &wide, size));
    let mut missing = around(statics, &twofold, 0.05);
    missing.points[3].1.mean = f64::NAN;
    check("polar-missing", |size| {
        drawn("", std::slice::from_ref(&missing), size)
    });
    let names = [
        "P = 50 kPa, grooves",
        "P = 50 kPa, dimple",
        "P = 1 MPa, grooves",
        "P = 1 MPa, dimple",
    ];
    let named = names.iter().flat_map(|name| {
        [
            around(&format!("{name}, {statics}"), &twofold, 0.02),
            around(&format!("{name}, {kinetics}"), &|_| 0.45, 0.005),
        ]
    });
    let named: Vec<Response> = named.collect();
    check("polar-eight", |size| drawn("", &named, size));
}

#[test]
fn bar_charts() {
    let chart = |groups: &[&str], names: &[&str], size: PictureSize| {
        let bar = |(k, label): (usize, &&str)| Bar {
            label: (*label).to_owned(),
            value: Estimate {
                crossed: k == 1,
                ..Estimate::between(0.7, 0.8 + 0.01 * k as f64, 0.9)
            },
        };
        let group = |label: &&str| BarGroup {
            label: (*label).to_owned(),
            bars: names.iter().enumerate().map(bar).collect(),
        };
        bars(
            &BarChart {
                y_title: "static friction \u{3bc}\u{209b}*".to_owned(),
                x_title: "blocks along a side".to_owned(),
                legend_title: "load pressure P".to_owned(),
                groups: groups.iter().map(group).collect(),
                note: NOTE.to_owned(),
            },
            size,
        )
    };
    check("bars", |size| chart(&[""], &["10", "[20, 10]", "[10, 20]"], size));
    check("bars-groups", |size| {
        chart(&["10", "[20, 10]"], &["50 kPa", "100 kPa", "1 MPa"], size)
    });
    let names: Vec<String> = (0..30)
        .map(|k| format!("a surface with a long name {k}"))
        .collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    check("bars-many", |size| chart(&[""], &names, size));
    check("bars-long-legend", |size| {
        chart(&["circle", "groove"], &names[..9], size)
    });
}

#[test]
fn heat_maps() {
    let axis = |title: &str, values: Vec<f64>| HeatAxis {
        title: title.to_owned(),
        values,
        log: true,
    };
    let map = |columns: usize, rows: usize, scale: f64, half: f64, size: PictureSize| {
        let values = |count: usize| (0..count).map(|k| 0.01 * 1.5f64.powi(k as i32)).collect();
        let value = |k: usize| {
            let (mean, half) = (scale * (k % 7) as f64, half * (1 + k % 3) as f64);
            Estimate {
                crossed: k == 1,
                ..Estimate::between(mean - half, mean, mean + half)
            }
        };
        heat_map(
            &HeatMap {
                x: axis("drive speed V*", values(columns)),
                y: axis("texture coverage A* of texture 2 (%)", values(rows)),
                value_title: "static friction \u{3bc}\u{209b}*".to_owned(),
                values: (0..columns * rows).map(value).collect(),
                note: NOTE.to_owned(),
            },
            size,
        )
    };
    check("heat-map", |size| map(3, 3, 0.1, f64::NAN, size));
    check("heat-map-intervals", |size| map(3, 3, 0.1, 0.02, size));
    check("heat-map-unresolved", |size| map(3, 3, 0.01, 0.2, size));
    check("heat-map-8", |size| map(8, 8, 0.01, 0.002, size));
    check("heat-map-40", |size| map(40, 25, 1e-7, 1e-8, size));
}

#[test]
fn pictures_of_the_paper() {
    let map = |label: &str, nx: usize, ny: usize| FieldMap {
        label: label.to_owned(),
        note: "\u{3bc}* = 0.5, with a note".to_owned(),
        nx,
        ny,
        values: (0..nx * ny).map(|k| (k % 13) as f32 / 13.0).collect(),
        textured: (0..nx * ny).map(|k| CIRCLE(k % nx, k / nx)).collect(),
        marks: vec![[0, 0]],
    };
    let maps = |columns: usize, maps: &[FieldMap], size: PictureSize| {
        field_maps(
            &FieldMaps {
                value_title: "static coefficient \u{3bc}_s".to_owned(),
                range: [0.0, 1.0],
                columns,
                maps: maps.to_vec(),
            },
            size,
        )
    };
    let three = [
        map("25 x 25", 25, 25),
        map("50 x 50", 50, 50),
        map("a long name of a map", 25, 25),
    ];
    check("fields", |size| maps(3, &three, size));
    let wide = [map("400 x 4", 400, 4)];
    check("fields-wide", |size| maps(1, &wide, size));
    let tall: Vec<FieldMap> = (0..6).map(|k| map(&format!("map {k}"), 4, 400)).collect();
    check("fields-tall", |size| maps(6, &tall, size));
    let triangle = |label: &str| Shape {
        label: label.to_owned(),
        points: vec![[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]],
    };
    let four = ["s = 2, w = 0.1", "a shape with a long name", "c", "d"].map(triangle);
    check_one("shapes", &shapes(&four).unwrap());
    let line = Stroke {
        style: StrokeStyle::Arrow,
        points: vec![[0.0, 0.0], [2.0, 1.0]],
    };
    let drawn = Sketch {
        strokes: vec![line],
        labels: vec![("k_1".to_owned(), [0.5, 0.5]), ("x".to_owned(), [2.0, 0.0])],
    };
    check_one("sketch", &sketch(&drawn).unwrap());
}
