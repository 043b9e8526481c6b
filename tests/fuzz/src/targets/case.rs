//! Case files and their overrides, which stand in `# set: ` comments at the top.

use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::CaseFile;

use crate::checks::readable;
use crate::long::{many, nested};
use crate::scratch::repository;
use crate::target::{Memory, Target, Time};

const CASES: &[&str] = &[
    "cases/*.toml",
    "crates/slipfront-paper/cases/table1/*.toml",
    "crates/slipfront-case/tests/good/*.toml",
    "crates/slipfront-case/tests/bad/*.toml",
];

/// The text of a case with overrides.
pub(crate) const CASE_FILE: Target = Target {
    name: "case_file",
    check: case_file,
    generated: Vec::new,
    files: CASES,
    dictionary: Some("case.dict"),
    max_bytes: 4096,
    memory: Memory {
        bytes: 1 << 20,
        per_byte: 512,
    },
    time: Time::READING,
    mutations: 3000,
    repetitions: 30,
    long,
};

/// The case that follows from the text, with its surface, for a small lattice.
pub(crate) const CASE: Target = Target {
    name: "case",
    check: case,
    generated: Vec::new,
    files: CASES,
    dictionary: Some("case.dict"),
    max_bytes: 4096,
    // The mask of cases/mask.toml has some thousand pixels.
    memory: Memory {
        bytes: 8 << 20,
        per_byte: 512,
    },
    time: Time::READING,
    mutations: 300,
    repetitions: 30,
    long,
};

/// Texts with many of each thing that a case may have, and with long and deep ones.
fn long() -> Vec<Vec<u8>> {
    vec![
        many("", "[[texture]]\nshape = 'cavity'\ncoverage = 1\n", ""),
        many("texture = [", "{ shape = 'cavity', s = # },", "]"),
        many(
            "[[texture]]\nshape = 'polygon'\npoints = [",
            "['# um', '# um'],",
            "]",
        ),
        many("drive.program = [", "{ v_star = 0.1, until_star = # },", "]"),
        many("output.snapshots = [", "#, ", "]"),
        many("output.fields = [", "'sliding', ", "]"),
        many("[friction]\n", "mu_statik# = 1\n", ""),
        many("[friction]\n", "mu_static = #\n", ""),
        many("", "mu_static.a# = 1\n", ""),
        many("", "[friktion#]\n", ""),
        many("", "[friction.a#]\nb = 1\n", ""),
        many("", "[[friction]]\n", ""),
        many("", "# set: friction.mu_static=#\n", ""),
        many("", "# set: texture.0.a#=1\n", "[[texture]]\nshape = 'cavity'"),
        many("", "# set: texture.#.shape='cavity'\n", ""),
        many("# set: a", ".a#", "=1\n"),
        many("# set: friction.mu_static=[", "[", "\n"),
        many("", "x", " = 1"),
        many("", "a.", "a = 1"),
        many("[", "a.", "a]"),
        many("[friction]\nlaw = '", "projection#", "'"),
        many("[friction]\nlaw = \"", "\\u00e9\\n", "\""),
        many("[friction]\nlaw = '''", "'\n", "'''"),
        many("[friction]\nmu_static = 0.", "0", "1"),
        many("[friction]\nmu_static = 1", "_0", ""),
        many("slider.block_size = '1", " um", "'"),
        many("slider.block_size = '1 ", "m/", "m'"),
        many("", "# a comment = 'of [many'\n", ""),
        many("", "\n", "x"),
        many("", "\r\n", "friction = 1"),
        many("", " \t", "a"),
        many("", "\u{e9}", "a"),
        many("", "\"", ""),
        many("a = \"", "\\", ""),
        nested("a = ", "[", "", "]", ""),
        nested("a = ", "{ a = ", "1", " }", ""),
        nested("texture = ", "[", "", "]", ""),
        nested("friction = ", "{ friction = ", "1", " }", ""),
    ]
}

/// Most blocks of a lattice that is made: only the memory of the machine bounds a lattice.
const MAX_BLOCKS: u64 = 1000;

/// The case file, or nothing after checking the error.
fn parse(input: &[u8]) -> Option<CaseFile> {
    let text = std::str::from_utf8(input).ok()?;
    let comments = text.lines().take_while(|line| line.starts_with('#'));
    let overrides: Vec<String> = comments
        .filter_map(|line| line.strip_prefix("# set: "))
        .map(str::to_owned)
        .collect();
    match CaseFile::parse(text, "case.toml", &overrides) {
        Ok(case) => Some(case),
        Err(error) => {
            readable(&error);
            let message = error.to_string();
            assert!(
                message.starts_with("case.toml:") || message.starts_with("--set "),
                "no place: {message}"
            );
            None
        }
    }
}

/// A case file that is written and read again is equal.
fn case_file(input: &[u8]) {
    let Some(case) = parse(input) else { return };
    let printed = case.to_toml().unwrap();
    let again =
        CaseFile::parse(&printed, "printed", &[]).unwrap_or_else(|error| panic!("{error}\n{printed}"));
    assert_eq!(again, case);
    assert_eq!(again.to_toml().unwrap(), printed);
}

/// A valid case file gives a case whose values are within their bounds, or a readable error.
fn case(input: &[u8]) {
    let Some(mut file) = parse(input) else { return };
    // The seeds are of the paper's size.
    for blocks in &mut file.slider.blocks {
        *blocks = (*blocks).min(31);
    }
    if file.check().is_err()
        || u64::from(file.slider.blocks[0]) * u64::from(file.slider.blocks[1]) > MAX_BLOCKS
    {
        return;
    }
    match Case::new(
        file,
        "case",
        repository("cases").as_path(),
        &mut |_| true,
        Ranks::ALONE,
    ) {
        Err(error) => readable(&error),
        Ok(case) => {
            assert!(case.time_plan.last_step >= 1 && case.time_plan.dt_star > 0.0);
            assert!(case.groups.v_star.is_finite() && case.groups.omega_star.is_finite());
            assert!(case.texture.meshed_percent >= 0.0 && case.texture.meshed_percent <= 100.0);
            for warning in case.warnings() {
                readable(&warning);
            }
            let surface = &case.model.surface;
            let coefficients = surface.mu_static.iter().chain(&surface.mu_kinetic);
            assert!(coefficients.clone().all(|mu| mu.is_finite() && *mu >= 0.0));
            let printed = case.file.to_toml().unwrap();
            assert_eq!(CaseFile::parse(&printed, "printed", &[]).unwrap(), case.file);
        }
    }
}
