//! Study files; the cases that they name are those of the repository.

use slipfront_case::case_file::ParsedCase;
use slipfront_study::{StudyFile, StudyFolder};

use crate::checks::readable;
use crate::long::{many, nested};
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// The text of a study, its copy in the results folder, and the cases of some of its points.
pub(crate) const STUDY_FILE: Target = Target {
    name: "study_file",
    check: study_file,
    generated: Vec::new,
    files: &["cases/studies/*.toml"],
    dictionary: Some("study.dict"),
    max_bytes: 4096,
    // An axis has at most 100 000 levels, and the number of points is checked with every axis.
    memory: Memory {
        bytes: 512 << 20,
        per_byte: 1024,
    },
    time: Time::READING,
    mutations: 100,
    repetitions: 20,
    long,
};

/// Texts with many of each thing that a study may have, and with long and deep ones.
fn long() -> Vec<Vec<u8>> {
    let axis = "base = '../circle.toml'\n[[axes]]\n";
    let of_axis = |begin: &str, piece: &str, end: &str| many(&format!("{axis}{begin}"), piece, end);
    vec![
        of_axis("key = 'friction.seed'\nlist = [", "#, ", "]"),
        of_axis("key = 'friction.seed'\nlist = [", "'#', ", "]"),
        of_axis("zip = { ", "'friction.a#' = [1], ", "b = [1] }"),
        of_axis(
            "name = 'a'\nvariants = { b = { friction = { ",
            "a# = 1, ",
            "b = 1 } } }",
        ),
        of_axis("key = 'slider.blocks'\nlist = [", "[#, 9], ", "]"),
        of_axis("key = '", "a.", "a'\nlist = [1]"),
        of_axis(
            "name = 'a'\n[axes.variants]\n",
            "v# = { friction.seed = # }\n",
            "",
        ),
        many(
            "base = '../circle.toml'\n",
            "[[axes]]\nkey = 'friction.seed'\nlist = [1]\n",
            "",
        ),
        many(
            "base = '../circle.toml'\n",
            "[[axes]]\nkey = 'friction.a#'\nlist = [1]\n",
            "",
        ),
        many("", "[[base.texture]]\nshape = 'cavity'\n", "[[axes]]\n"),
        many("[base.friction]\n", "mu_statik# = 1\n", ""),
        many("base = '../circle.toml'\n[study]\n", "replicats# = 1\n", ""),
        many(
            "base = '../circle.toml'\n[study]\nreference = { ",
            "a# = 1, ",
            "b = 1 }",
        ),
        many("base = '", "../", "circle.toml'"),
        many("", "axes.", "a = 1"),
        nested("base = ", "{ base = ", "1", " }", ""),
        nested("axes = ", "[", "", "]", ""),
    ]
}

/// Most levels of the longest axis whose cases are parsed.
const MAX_LEVELS: usize = 3;

fn study_file(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else {
        return;
    };
    let folder = scratch::repository("cases/studies");
    let study = match StudyFile::parse(text, "study.toml", "study", &folder) {
        Ok(study) => study,
        Err(error) => return readable(&error),
    };
    let axis = study.axes.iter().max_by_key(|axis| axis.levels.len());
    for level in axis
        .into_iter()
        .flat_map(|axis| axis.levels.iter().take(MAX_LEVELS))
    {
        let base = ParsedCase::parse(&study.base.text, &study.base.name);
        if let Err(error) = base.and_then(|base| base.with(&level.overrides.iter().collect::<Vec<_>>())) {
            readable(&error);
        }
    }
    // Counting never overflows.
    assert!(study.count_points().unwrap() as u64 <= study.count_runs().unwrap());

    let out = scratch::folder("study");
    match StudyFolder::open(&out, &study, None, false) {
        Err(error) => readable(&error),
        Ok(opened) => {
            drop(opened);
            let again = StudyFile::load(&out.join("study.toml")).unwrap();
            assert_eq!(format!("{:?}", again.settings), format!("{:?}", study.settings));
            if !names_files(text) {
                assert_eq!(format!("{:?}", again.axes), format!("{:?}", study.axes));
            }
            // A study read from its results folder is not changed by opening the folder again.
            assert!(!StudyFolder::open(&out, &again, None, false).unwrap().changed);
        }
    }
}

/// Whether the study may name files, whose names differ in the copy.
fn names_files(text: &str) -> bool {
    text.contains("file") || text.contains("field") || text.contains('\\')
}
