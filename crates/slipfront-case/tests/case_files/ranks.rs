//! A case made by several ranks equals the case made by one process.

use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

use slipfront::communicator::Communicator;
use slipfront::testing::Threads;
use slipfront_case::arrays::png_of_mask;
use slipfront_case::case::{Case, Files, FilesInMemory, Ranks};
use slipfront_case::case_file::{CaseError, CaseFile};
use test_case::{test_case, test_matrix};

const NX: usize = 11;
const NY: usize = 9;

/// Writes arrays of `NX` x `NY` blocks.
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
    std::fs::write(folder.join("mask.png"), png_of_mask(NX, NY, &textured).unwrap()).unwrap();
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
    Case::to_run(file, "case", folder, watch, ranks)
}

/// Results of `size` ranks that make a case.
fn make_on_ranks(size: usize, text: &str, folder: &Path) -> Vec<Result<Case, CaseError>> {
    Threads::run(size, |communicator| {
        let ranks = Ranks {
            communicator,
            on_node: size,
        };
        make(text, folder, ranks, &mut |_| true)
    })
}

#[test_case("friction = { seed = 7, sigma_static_star = 0.9, sigma_kinetic_star = 0.2 }"; "drawn")]
#[test_case("friction = { seed = 7, sigma_static_star = 0.9, correlation_length = '3 um' }"; "correlated")]
#[test_case(
    "slider.edges = 'periodic'\nfriction = { correlation_length = '4 um', mu_kinetic_field = 'mu.csv' }"
    ; "correlated and periodic"
)]
#[test_case("slider.edges = 'periodic'\ntexture = [{ shape = 'cavity', coverage = 20, s = 3, w = 0.2, array = [2, 2], rotate = 20 }, \
     { shape = 'groove', coverage = 10, orientation = 'along' }, { shape = 'cavity', lambda = '0.1 um' }]"; "shapes")]
#[test_case("texture = [{ shape = 'polygon', points = [['0 um', '0 um'], ['9 um', '3 um'], ['3 um', '8 um']] }]"; "polygon")]
#[test_case("texture = [{ shape = 'mask', file = 'mask.png' }, { shape = 'mask', file = 'mask.npy' }, { shape = 'mask', \
     file = 'mask.png', threshold = 0.2 }]"; "masks")]
#[test_case("friction = { mu_static_field = 'c.npy', mu_kinetic_field = 'mu.csv' }"; "arrays")]
#[test_case(
    "friction = { mu_static_field = 'fortran.npy' }\nload.redistribute = false\ntexture = [{ shape = 'mask', file = 'mask.png' }]"
    ; "columns"
)]
#[test_case(
    "load = { shear_star = 0.95, shear_field = 'fortran.npy' }\ninitial = { displacement_x = 'c.npy', velocity_y = 'mu.csv' }"
    ; "load and start"
)]
fn ranks_make_the_case_that_one_process_makes(text: &str) {
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
        let loads = |case: &Case| {
            let field = case.model.dead_load().field.as_ref();
            field.map_or(Vec::new(), |field| bits(&field.relative))
        };
        assert_eq!(parts.iter().flat_map(loads).collect::<Vec<_>>(), loads(&alone));
        let begins = |case: &Case| {
            let state = case.initial.as_ref();
            state.map_or(Vec::new(), |state| {
                [&state.displacement.x, &state.velocity.y]
                    .map(|values| bits(values))
                    .concat()
            })
        };
        let n_begins = parts.iter().map(|part| begins(part).len()).sum::<usize>();
        assert_eq!(n_begins, begins(&alone).len());
        for (rank, part) in parts.iter().enumerate() {
            assert_eq!(part.model.rows, NY * rank / size..NY * (rank + 1) / size);
            assert_eq!(part.texture, alone.texture);
            assert_eq!(part.inputs, alone.inputs);
            assert_eq!(part.file, alone.file);
            assert_eq!(part.warnings(), alone.warnings());
            assert_eq!(part.expected, alone.expected);
            assert_eq!(part.budget.disk(), alone.budget.disk());
        }
    }
}

/// Results of `size` ranks that make a case from the files of a folder, each with a copy of them in memory.
fn make_in_memory(size: usize, text: &str, folder: &Path) -> Vec<Result<Case, CaseError>> {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    let contents = |entry: std::fs::DirEntry| {
        let contents = std::fs::read(entry.path()).unwrap();
        (entry.file_name().into_string().unwrap(), contents.into())
    };
    let in_memory: FilesInMemory = entries.map(contents).collect();
    Threads::run(size, |communicator| {
        let ranks = Ranks {
            communicator,
            on_node: size,
        };
        let files = Files {
            folder: Path::new("nowhere"),
            in_memory: Some(&in_memory),
        };
        let text = format!("slider.blocks = [{NX}, {NY}]\n{text}");
        let file = CaseFile::parse(&text, "case.toml", &[])?;
        Case::to_run(file, "case", files, &mut |_| true, ranks)
    })
}

#[test_case(
    "texture = [{ shape = 'mask', file = 'mask.png' }, { shape = 'mask', file = 'mask.npy' }]\nload.pressure_field = 'mu.csv'"
    ; "masks"
)]
#[test_case("friction = { mu_static_field = 'fortran.npy', mu_kinetic_field = 'mu.csv' }"; "columns")]
#[test_case(
    "texture = [{ shape = 'height_map', file = 'c.npy', height_unit = '1 um', pixel_size = '1 um', bearing_percent = 50 }]"
    ; "heights"
)]
fn files_in_memory_make_the_case_of_those_on_the_disk(text: &str) {
    let folder = tempfile::tempdir().unwrap();
    write_inputs(folder.path());
    for size in [1, 3] {
        let on_disk = make_on_ranks(size, text, folder.path());
        let in_memory = make_in_memory(size, text, folder.path());
        for (on_disk, in_memory) in on_disk.into_iter().zip(in_memory) {
            let (on_disk, in_memory) = (on_disk.unwrap(), in_memory.unwrap());
            assert_eq!(in_memory.model, on_disk.model);
            assert_eq!(in_memory.file, on_disk.file);
            assert_eq!(in_memory.budget, on_disk.budget);
            let named = |case: &Case| {
                let inputs = case.inputs.iter();
                inputs
                    .map(|input| (input.name.clone(), input.length, input.hash))
                    .collect::<Vec<_>>()
            };
            assert_eq!(named(&in_memory), named(&on_disk));
            for input in &in_memory.inputs {
                let mut copy = Vec::new();
                input.open().unwrap().read_to_end(&mut copy).unwrap();
                assert_eq!(blake3::hash(&copy), input.hash);
            }
        }
    }
}

#[test_case("friction.mu_static_field = 'negative.csv'", "`negative.csv` has -0.8"; "value")]
#[test_case("texture = [{ shape = 'mask', file = 'cut.png' }]",
    "`cut.png` is not a readable .png file: it ends before"; "image")]
#[test_case("friction.mu_static_field = 'missing.npy'",
    "cannot read `nowhere/missing.npy`"; "missing")]
#[test_case("load.pressure_field = 'long.npy'",
    "`long.npy` has 20000 bytes where 9 rows of 11 numbers take"; "long")]
fn files_in_memory_are_refused_in_the_same_sentences(text: &str, wanted: &str) {
    let folder = tempfile::tempdir().unwrap();
    write_inputs(folder.path());
    std::fs::write(folder.path().join("long.npy"), [0; 20_000]).unwrap();
    for size in [1, 3] {
        for made in make_in_memory(size, text, folder.path()) {
            let said = made.unwrap_err().to_string();
            assert!(said.contains(wanted), "{said}");
        }
    }
}

/// All ranks report the same error as a single process, whichever rank finds it.
#[test_case("friction.mu_static_field = 'negative.csv'", "has -0.8"; "value")]
#[test_case("friction.mu_static_field = 'short.csv'", "has 7 lines of numbers"; "lines")]
#[test_case("friction.mu_static_field = 'missing.npy'", "cannot read"; "missing")]
#[test_case("texture = [{ shape = 'mask', file = 'cut.png' }]",
    "ends before the last pixel"; "image")]
#[test_case("texture = [{ shape = 'mask', file = 'c.npy' }]",
    "must be 0 or 1 (1 is a dark pixel)"; "mask")]
#[test_case("texture = [{ shape = 'groove', width = '100 um' }]",
    "no block is in contact"; "no contact")]
#[test_case("texture = [{ shape = 'groove', width = '1 m', offset = '1 km' }]", "extends over"; "far")]
fn all_ranks_tell_the_error_of_one(text: &str, wanted: &str) {
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

/// Every rank reads the case file.
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
            let loaded = Case::load(&path, &["friction.seed=3".to_owned()], &mut |_| true, ranks);
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

/// If the last rank has a different case, all ranks report the difference and its place.
#[test_case("friction.seed = 1",
    "friction.seed = 2",
    "`friction.seed` is 2 on rank 2 and 1 on rank 0"; "seed")]
#[test_case("", "slider.edges = 'periodic'", "`slider.edges` is"; "rows")]
#[test_case("", "texture = [{ shape = 'groove', width = '1 um' }]", "`texture.0."; "longer")]
#[test_case("texture = [{ shape = 'groove', width = '1 um' }]",
    "",
    "not given on rank 2 and"; "shorter")]
#[test_case("texture = [{ shape = 'polygon', points = [['0 um', '0 um'], ['9 um', '3 um'], ['3 um', '8 um']] }]",
    "texture = [{ shape = 'polygon', points = [['0 um', '0 um'], ['9 um', '3 um'], ['3 um', '7 um']] }]",
    "`texture.0.points.2` is"; "point")]
fn another_case_is_refused_by_all(text: &str, other: &str, sentence: &str) {
    let made = Threads::run(4, |communicator| {
        let text = if communicator.rank() == 2 { other } else { text };
        let ranks = Ranks {
            communicator,
            on_node: 4,
        };
        make(text, Path::new(""), ranks, &mut |_| true)
            .unwrap_err()
            .to_string()
    });
    assert!(
        made[0].contains(sentence) && made[0].contains("on rank 2"),
        "{}",
        made[0]
    );
    assert!(made.iter().all(|said| *said == made[0]), "{made:?}");
}

/// Files must have the same contents on all ranks, but not the same paths.
#[test]
fn another_file_is_refused_by_all() {
    let folders = [(); 3].map(|()| tempfile::tempdir().unwrap());
    for folder in &folders {
        write_inputs(folder.path());
    }
    let text = "friction = { mu_static_field = 'c.npy', mu_kinetic_field = 'mu.csv' }";
    let made = || {
        Threads::run(3, |communicator| {
            let ranks = Ranks {
                communicator,
                on_node: 3,
            };
            let folder = folders[communicator.rank()].path();
            make(text, folder, ranks, &mut |_| true).map_err(|error| error.to_string())
        })
    };
    for case in made() {
        assert_eq!(case.unwrap().inputs.len(), 2);
    }
    let edited = folders[1].path().join("mu.csv");
    let bytes = std::fs::read_to_string(&edited).unwrap();
    std::fs::write(&edited, bytes.replacen("0.8", "0.9", 1)).unwrap();
    for case in made() {
        let said = case.unwrap_err();
        assert!(
            said.starts_with("mu.csv (`friction.mu_kinetic_field`) is a file of")
                && said.contains("on rank 1 and"),
            "{said}"
        );
    }
    std::fs::remove_file(&edited).unwrap();
    for case in made() {
        let said = case.unwrap_err();
        assert!(
            said.starts_with("rank 1: case.toml:") && said.contains("mu.csv"),
            "{said}"
        );
    }
}

/// A file that changes while the case is made is refused, whichever rank finds this: its contents may differ
/// from the hashed ones.
#[test_matrix([1, 3])]
fn a_file_that_changes_while_the_case_is_made_is_refused(size: usize) {
    let folder = tempfile::tempdir().unwrap();
    write_inputs(folder.path());
    let text = "friction.mu_static_field = 'mu.csv'\ntexture = [{ shape = 'mask', file = 'mask.png' }]";
    let made = Threads::run(size, |communicator| {
        let ranks = Ranks {
            communicator,
            on_node: size,
        };
        // The texture is laid over the blocks before the coefficients are read.
        let edit = &mut |_| {
            if communicator.rank() + 1 == size {
                let mut file = File::options().append(true).open(folder.path().join("mu.csv"));
                file.as_mut().unwrap().write_all(b"# edited\n").unwrap();
            }
            true
        };
        make(text, folder.path(), ranks, edit)
            .map(drop)
            .map_err(|error| error.to_string())
    });
    for made in made {
        let said = made.unwrap_err();
        assert!(
            said.contains("mu.csv was changed while the case was prepared"),
            "{said}"
        );
    }
}

/// Bytes that this thread has read.
#[cfg(target_os = "linux")]
fn bytes_read() -> u64 {
    let text = std::fs::read_to_string("/proc/thread-self/io").unwrap();
    let line = text.lines().find_map(|line| line.strip_prefix("rchar: "));
    line.unwrap().parse().unwrap()
}

/// The first of the ranks on a machine reads the whole file, and the others read only their own rows.
#[cfg(target_os = "linux")]
#[test]
fn one_rank_of_a_machine_hashes_a_file() {
    const SIDE: usize = 512;
    let folder = tempfile::tempdir().unwrap();
    let mut text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({SIDE}, {SIDE}), }}");
    text += &" ".repeat(118 - 1 - text.len());
    let values = vec![0.5_f64; SIDE * SIDE];
    let data = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect::<Vec<_>>();
    let bytes = [&b"\x93NUMPY\x01\x00\x76\x00"[..], text.as_bytes(), b"\n", &data].concat();
    std::fs::write(folder.path().join("mu.npy"), &bytes).unwrap();
    let read = Threads::run(4, |communicator| {
        let ranks = Ranks {
            communicator,
            on_node: 4,
        };
        let text = format!("slider.blocks = [{SIDE}, {SIDE}]\nfriction.mu_static_field = 'mu.npy'");
        let file = CaseFile::parse(&text, "case.toml", &[]).unwrap();
        let before = bytes_read();
        Case::new(file, "case", folder.path(), &mut |_| true, ranks).unwrap();
        (bytes_read() - before) as f64 / bytes.len() as f64
    });
    // A quarter of the rows, and buffers that read more than is needed.
    let rows = 0.25..0.35;
    assert!(rows.contains(&(read[0] - 1.0)), "{read:?}");
    assert!(read[1..].iter().all(|read| rows.contains(read)), "{read:?}");
}
