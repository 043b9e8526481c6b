//! A picture of every kind has the same bytes on every machine.
//!
//! The digests change with the look of the pictures, and with the version of the crates that compress PNG and
//! PDF.

use slipfront_plot::{
    Bar, BarChart, BarGroup, DrawnLattice, Estimate, FieldMap, FieldMaps, FrictionAxes, FrictionCurve,
    HeatAxis, HeatMap, Instant, KineticLine, Picture, PictureFormat, PictureSize, Polar, Response, Responses,
    Shape, SnapshotMap, SnapshotMaps, bars, field_maps, friction, heat_map, polar, response, shapes, stress,
};

/// The first digits of the hashes of all files.
fn digests(picture: &Picture) -> [String; 3] {
    PictureFormat::ALL.map(|format| blake3::hash(&picture.file(format)).to_hex()[..16].to_string())
}

/// Numbers that look random and are made from whole numbers alone.
fn numbers(count: usize) -> Vec<f64> {
    (0..count)
        .map(|index| (index * index * 7919 % 1009) as f64 / 1009.0)
        .collect()
}

fn curve() -> FrictionCurve {
    let x: Vec<f64> = (0..1000).map(|step| 0.25 * f64::from(step)).collect();
    FrictionCurve {
        label: "one curve".to_string(),
        friction: x
            .iter()
            .map(|t| (t / 80.0).min(0.9) + 0.1 * (t % 3.0) / 3.0)
            .collect(),
        sliding_percent: numbers(1000).iter().map(|number| 100.0 * number).collect(),
        x,
        first_slip: Some(60.0),
        peak: Some((80.0, 0.95)),
        kinetic: Some(KineticLine {
            from: 150.0,
            to: 249.0,
            mean: 0.92,
            uncertainty: Some(0.02),
        }),
        instants: vec![Instant {
            letter: 'A',
            x: 20.0,
            friction: 0.25,
        }],
        ..FrictionCurve::default()
    }
}

fn stress_maps() -> SnapshotMaps {
    let map = |label: &str| SnapshotMap {
        label: label.to_string(),
        time_star: 12.5,
        mu_star: 0.5,
        values: numbers(30 * 20).iter().map(|&number| number as f32).collect(),
    };
    SnapshotMaps {
        lattice: DrawnLattice {
            nx: 30,
            ny: 20,
            block_size: 1e-6,
            textured: (0..30 * 20).map(|block| block % 30 < 10 && block > 200).collect(),
        },
        maps: vec![map("A"), map("B")],
        value_title: "contact stress \u{3c4}_c*".to_string(),
        range: [0.0, 1.0],
    }
}

fn maps() -> FieldMaps {
    FieldMaps {
        value_title: "mu_s".to_string(),
        range: [0.0, 1.0],
        columns: 1,
        maps: vec![FieldMap {
            label: "a map".to_string(),
            note: "and a note".to_string(),
            nx: 25,
            ny: 25,
            values: numbers(625).iter().map(|&number| number as f32).collect(),
            textured: (0..625).map(|block| block % 25 == 12).collect(),
            marks: vec![[3, 4]],
        }],
    }
}

fn responses() -> Responses {
    let response = |label: &str, factor: f64| Response {
        label: label.to_string(),
        points: [(0.01, 1.0), (0.02, 2.0), (0.05, 4.0), (0.1, 3.0)]
            .map(|(x, mean)| (x, [mean - 0.5, mean, mean + 0.5].map(|end| factor * end)))
            .map(|(x, [low, mean, high])| (x, Estimate::between(low, mean, high)))
            .to_vec(),
        line: false,
    };
    Responses {
        x_title: "V*".to_string(),
        log_x: true,
        y_title: "\u{3bc}*".to_string(),
        legend_title: "size".to_string(),
        curves: vec![response("5 x 5", 1.0), response("25 x 25", 1.2)],
        ..Responses::default()
    }
}

fn chart() -> BarChart {
    let bar = |label: &str, mean: f64| Bar {
        label: label.to_string(),
        value: Estimate::between(mean - 1.0, mean, mean + 1.0),
    };
    let group = |label: &str| BarGroup {
        label: label.to_string(),
        bars: vec![bar("slow", 3.0), bar("fast", 4.0)],
    };
    BarChart {
        y_title: "reduction (%)".to_string(),
        x_title: "shape".to_string(),
        legend_title: "drive".to_string(),
        groups: vec![group("circle"), group("groove across")],
        ..BarChart::default()
    }
}

fn heat() -> HeatMap {
    let axis = |title: &str, values: &[f64]| HeatAxis {
        title: title.to_string(),
        values: values.to_vec(),
        log: true,
    };
    HeatMap {
        x: axis("V*", &[0.01, 0.03, 0.1]),
        y: axis("A* (%)", &[5.0, 10.0, 20.0]),
        value_title: "\u{3bc}*".to_string(),
        values: numbers(9).into_iter().map(Estimate::exact).collect(),
        note: String::new(),
    }
}

fn around() -> Polar {
    Polar {
        value_title: "\u{3bc}*".to_string(),
        note: "95 % interval of the mean, n = 5".to_string(),
        curves: vec![Response {
            points: [0.0, 90.0, 180.0, 270.0]
                .into_iter()
                .zip(&responses().curves[0].points)
                .map(|(degrees, (_, value))| (degrees, *value))
                .collect(),
            ..Response::default()
        }],
        ..Polar::default()
    }
}

fn outlines() -> [Shape; 1] {
    [Shape {
        label: "triangle".to_string(),
        points: vec![[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]],
    }]
}

#[test]
fn every_kind_of_picture_has_its_bytes() {
    let usual = PictureSize::default();
    let found = [
        ("friction", friction(&[curve()], &FrictionAxes::default(), usual)),
        (
            "frictions",
            friction(&[curve(), curve()], &FrictionAxes::default(), usual),
        ),
        ("stress", stress(&stress_maps(), false, usual)),
        ("fields", field_maps(&maps(), usual)),
        ("response", response(&responses(), usual)),
        ("bars", bars(&chart(), usual)),
        ("heat map", heat_map(&heat(), usual)),
        ("shapes", shapes(&outlines())),
        ("polar", polar(&around(), usual)),
    ]
    .map(|(name, picture)| {
        let digests = digests(&picture.unwrap());
        format!("{name}: {}", digests.join(" "))
    });
    assert_eq!(found.join("\n"), EXPECTED.trim());
}

const EXPECTED: &str = "
friction: 61dde05f8ddeb593 97e9cbcc14675bcf 464ecb59304ef20b
frictions: e0998bb174c82c0b 92705be814979c6a a2ea6b02dd212f34
stress: 33379bb9212d2609 a159bf1d283af5e0 c5074221ac21d6ee
fields: d25152f096b25773 f5e58bc886dfb1d1 ea87eda60829c128
response: 1b573b472bfe0dfc 84d077c6d265d28f 4d12e80c1db9e19b
bars: 82087f4aa4ed0db9 dc7fa4afcb1428f1 0546b010b23b54b0
heat map: b2e573807d214cf7 376253a239b62456 34bcd6aee09a2f23
shapes: b6b81f6588f9a32e c5c68e6afd4ad939 a9e9f8ccf05c4053
polar: 3a8196aba6026a31 d137745d0935360e b90bc3990e5f1dbe
";
