//! A case that several ranks make is the one that a process makes alone.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

use std::path::Path;

use rstest::rstest;
use slipfront::communicator::{Communicator, Threads};
use slipfront_case::arrays::write_mask_png;
use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::{CaseError, CaseFile};

const NX: usize = 11;
const NY: usize = 9;

/// Arrays of `NX` x `NY` blocks.
fn write_inputs(folder: &Path) {
    let blocks = || (0..NY).flat_map(|j| (0..NX).map(move |i| (i, j)));
    let mu = |(i, j): (usize, usize)| 0.8 + 0.01 * i as f64 + 0.003 * j as f64;
    let npy = |descr: &str, order: &str, data: Vec<u8>| {
        let mut text = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': ({NY}, {NX}), }}");
        text += &" ".repeat(118 - 1 - text.len());
        let bytes = [&b"\x93NUMPY\x01\x00\x76\x00"[..], text.as_bytes(), b"\n", &data];
        bytes.concat()
    };
    let write = |name: &str, bytes: Vec<u8>| std::fs::write(folder.join(name), bytes).unwrap();
    write(
        "c.npy",
        npy(
            "<f8",
            "False",
            blocks().flat_map(|b| mu(b).to_le_bytes()).collect(),
        ),
    );
    let columns = (0..NX).flat_map(|i| (0..NY).map(move |j| (i, j)));
    write(
        "fortran.npy",
        npy("<f8", "True", columns.flat_map(|b| mu(b).to_le_bytes()).collect()),
    );
    let lines = (0..NY).map(|j| (0..NX).map(|i| format!("{:?} ", mu((i, j)))).collect::<String>() + "\n");
    let lines: Vec<String> = lines.collect();
    write("mu.csv", format!("# mu\n{}", lines.concat()).into_bytes());
    let wrong = lines
        .concat()
        .replacen(&lines[6], &lines[6].replacen("0.8", "-0.8", 1), 1);
    write("negative.csv", wrong.into_bytes());
    write("short.csv", lines[..7].concat().into_bytes());
    let textured: Vec<bool> = blocks().map(|(i, j)| i * j % 5 == 2).collect();
    write(
        "mask.npy",
        npy("|b1", "False", textured.iter().map(|t| u8::from(*t)).collect()),
    );
    write_mask_png(&folder.join("mask.png"), NX, NY, &textured).unwrap();
    write(
        "cut.png",
        std::fs::read(folder.join("mask.png")).unwrap()[..60].to_vec(),
    );
}

fn make(
    text: &str,
    folder: &Path,
    ranks: Ranks,
    watch: &mut dyn FnMut(f64) -> bool,
) -> Result<Case, CaseError> {
    let text = format!("slider.blocks = [{NX}, {NY}]\n{text}");
    let file = CaseFile::parse(&text, "case.toml", &[])?;
    Case::to_run_on_ranks(file, "case", folder, watch, ranks)
}

/// What so many ranks make.
fn make_on_ranks(size: usize, text: &str, folder: &Path) -> Vec<Result<Case, CaseError>> {
    Threads::run(size, |communicator| {
        let ranks = Ranks {
            communicator,
            on_node: size,
        };
        make(text, folder, ranks, &mut |_| true)
    })
}

#[rstest]
#[case::drawn("friction = { seed = 7, sigma_static_star = 0.9, sigma_kinetic_star = 0.2 }")]
#[case::shapes(
    "slider.edges = 'periodic'\ntexture = [{ shape = 'cavity', coverage = 20, s = 3, w = 0.2, array = [2, 2], rotate = 20 }, \
     { shape = 'groove', coverage = 10, orientation = 'along' }, { shape = 'cavity', lambda = '0.1 um' }]"
)]
#[case::polygon(
    "texture = [{ shape = 'polygon', points = [['0 um', '0 um'], ['9 um', '3 um'], ['3 um', '8 um']] }]"
)]
#[case::masks(
    "texture = [{ shape = 'mask', file = 'mask.png' }, { shape = 'mask', file = 'mask.npy' }, { shape = 'mask', \
     file = 'mask.png', threshold = 0.2 }]"
)]
#[case::arrays("friction = { mu_static_field = 'c.npy', mu_kinetic_field = 'mu.csv' }")]
#[case::columns(
    "friction = { mu_static_field = 'fortran.npy' }\nload.redistribute = false\ntexture = [{ shape = 'mask', file = 'mask.png' }]"
)]
fn ranks_make_the_case_that_one_process_makes(#[case] text: &str) {
    let folder = tempfile::tempdir().unwrap();
    write_inputs(folder.path());
    let alone = make(text, folder.path(), Ranks::ALONE, &mut |_| true).unwrap();
    let whole = &alone.model.surface;
    for size in [1, 2, 3, 4, 7, NY] {
        let parts: Vec<Case> = make_on_ranks(size, text, folder.path())
            .into_iter()
            .map(Result::unwrap)
            .collect();
        let surfaces = || parts.iter().map(|part| &part.model.surface);
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        let joined: Vec<u64> = surfaces().flat_map(|surface| bits(&surface.mu_static)).collect();
        assert_eq!(joined, bits(&whole.mu_static), "{size} ranks");
        let joined: Vec<u64> = surfaces().flat_map(|surface| bits(&surface.mu_kinetic)).collect();
        assert_eq!(joined, bits(&whole.mu_kinetic), "{size} ranks");
        let joined: Vec<bool> = surfaces().flat_map(|surface| surface.textured.clone()).collect();
        assert_eq!(joined, whole.textured, "{size} ranks");
        for (rank, part) in parts.iter().enumerate() {
            assert_eq!(part.model.rows, NY * rank / size..NY * (rank + 1) / size);
            assert_eq!(part.texture, alone.texture);
            assert_eq!(part.inputs, alone.inputs);
            assert_eq!(part.file, alone.file);
            assert_eq!(part.warnings(), alone.warnings());
            assert_eq!(part.expected, alone.expected);
            assert_eq!(part.budget.disk(), alone.budget.disk());
            assert_eq!(
                part.budget.disk_of_checkpoints(),
                alone.budget.disk_of_checkpoints()
            );
        }
    }
}

/// Whichever rank finds what is wrong, all say what a process alone says.
#[rstest]
#[case::value("friction.mu_static_field = 'negative.csv'", "has -0.8")]
#[case::lines("friction.mu_static_field = 'short.csv'", "has 7 lines of numbers")]
#[case::missing("friction.mu_static_field = 'missing.npy'", "cannot read")]
#[case::image(
    "texture = [{ shape = 'mask', file = 'cut.png' }]",
    "ends before the last pixel"
)]
#[case::mask(
    "texture = [{ shape = 'mask', file = 'c.npy' }]",
    "where 0 or 1, 1 as of a dark pixel, is wanted"
)]
#[case::no_contact(
    "texture = [{ shape = 'groove', width = '100 um' }]",
    "nothing is left in contact"
)]
#[case::far("texture = [{ shape = 'groove', width = '1 m', offset = '1 km' }]", "reaches")]
fn all_ranks_tell_the_error_of_one(#[case] text: &str, #[case] wanted: &str) {
    let folder = tempfile::tempdir().unwrap();
    write_inputs(folder.path());
    let alone = make(text, folder.path(), Ranks::ALONE, &mut |_| true)
        .unwrap_err()
        .to_string();
    assert!(alone.contains(wanted), "{alone}");
    for size in [2, 3, 4, 7] {
        for part in make_on_ranks(size, text, folder.path()) {
            assert_eq!(part.unwrap_err().to_string(), alone, "{size} ranks");
        }
    }
}

#[test]
fn a_rank_that_is_stopped_stops_all() {
    let text = "texture = [{ shape = 'cavity', coverage = 20 }]";
    let stopped = Threads::run(3, |communicator| {
        let ranks = Ranks {
            communicator,
            on_node: 3,
        };
        make(text, Path::new(""), ranks, &mut |_| communicator.rank() != 1)
    });
    assert!(stopped.iter().all(|made| matches!(made, Err(CaseError::Stopped))));
}

#[test]
fn more_ranks_than_rows_are_refused() {
    for made in make_on_ranks(NY + 1, "", Path::new("")) {
        let said = made.unwrap_err().to_string();
        assert!(said.contains("more ranks (10) than rows of blocks (9)"), "{said}");
    }
}

/// Case files are read by every rank.
#[test]
fn a_case_file_is_loaded_by_all_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    let load = || {
        Threads::run(3, |communicator| {
            let ranks = Ranks {
                communicator,
                on_node: 1,
            };
            let loaded = Case::load_on_ranks(&path, &["friction.seed=3".to_owned()], &mut |_| true, ranks);
            loaded
                .map(|case| (case.name.clone(), case.model.rows.clone()))
                .map_err(|error| error.to_string())
        })
    };
    std::fs::write(&path, format!("slider.blocks = [{NX}, {NY}]")).unwrap();
    let named = |rows| Ok(("case".to_owned(), rows));
    assert_eq!(load(), [named(0..3), named(3..6), named(6..9)]);
    std::fs::write(&path, "slider.blocks = 3").unwrap();
    let said = load();
    assert!(
        said[0].is_err() && said.iter().all(|one| *one == said[0]),
        "{said:?}"
    );
}
