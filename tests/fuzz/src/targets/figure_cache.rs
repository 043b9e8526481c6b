//! Data of figures that `slipfront paper` stores between calls, with a checksum.

use std::cell::OnceCell;

use slipfront_paper::{Drawing, FigureCache, FigureData, MeasuredNumber, Panel, StepRule, Table};
use slipfront_plot::{FieldMap, FieldMaps, FrictionCurve, Shape};

use crate::scratch;
use crate::target::{Memory, Target, Time};

/// The file as it is, then its contents with a valid checksum.
pub(crate) const FIGURE_CACHE: Target = Target {
    name: "figure_cache",
    check: figure_cache,
    generated,
    files: &[],
    dictionary: None,
    max_bytes: 4096,
    // Postcard reserves at most 1 MiB at once, however long a list claims to be.
    memory: Memory {
        bytes: 16 << 20,
        per_byte: 512,
    },
    time: Time::READING,
    mutations: 2000,
    repetitions: 15,
    long: Vec::new,
};

fn generated() -> Vec<Vec<u8>> {
    let mut data = FigureData::default();
    data.numbers
        .insert("fig99.one".to_owned(), MeasuredNumber::from_values(&[1.0, 2.0]));
    data.numbers
        .insert("fig99.two".to_owned(), MeasuredNumber::exact(f64::INFINITY));
    let small = postcard::to_stdvec(&data).unwrap();
    data.tables.push(Table {
        name: "table".to_owned(),
        caption: "a table".to_owned(),
        header: vec!["a".to_owned(), "b".to_owned()],
        rows: vec![vec!["1".to_owned(), "2".to_owned()]],
    });
    let curve = FrictionCurve {
        label: "curve".to_owned(),
        x: vec![0.0, 1.0],
        friction: vec![0.0, f64::NAN],
        sliding_percent: vec![0.0, 100.0],
        peak: Some((1.0, 0.5)),
        ..FrictionCurve::default()
    };
    let maps = FieldMaps {
        value_title: "stress".to_owned(),
        range: [0.0, 1.0],
        columns: 1,
        maps: vec![FieldMap {
            label: "map".to_owned(),
            note: String::new(),
            nx: 1,
            ny: 1,
            values: vec![0.5],
            textured: vec![false],
            marks: vec![[0, 0]],
        }],
    };
    let shape = Shape {
        label: "shape".to_owned(),
        points: vec![[0.0, 1.0]],
    };
    for drawing in [
        Drawing::Curves(vec![curve]),
        Drawing::Maps(maps),
        Drawing::Shapes(vec![shape]),
    ] {
        data.panels.push(Panel {
            name: "panel".to_owned(),
            caption: "a panel".to_owned(),
            drawing,
        });
    }
    vec![small, postcard::to_stdvec(&data).unwrap()]
}

thread_local! {
    /// Opening hashes the program.
    static OPEN: OnceCell<FigureCache> = const { OnceCell::new() };
}

fn figure_cache(input: &[u8]) {
    OPEN.with(|cache| {
        let cache = cache.get_or_init(|| FigureCache::open(&scratch::folder("paper"), true).unwrap());
        let path = cache.path("fig99", StepRule::Auto);
        let read = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            cache.load("fig99", StepRule::Auto)
        };
        assert!(read(input).is_none(), "data without a checksum");
        let Some(data) = read(&cache.with_checksum(input)) else {
            return;
        };
        let bytes = postcard::to_stdvec(&data).unwrap();
        let again = read(&cache.with_checksum(&bytes)).unwrap();
        assert_eq!(postcard::to_stdvec(&again).unwrap(), bytes);
    });
}
