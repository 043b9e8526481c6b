//! The command `slipfront export`: contents that a Process Run Crate must have, and effects on the folder.
//! `tests/ro_crate` validates crates.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use crate::support::process::{output, stderr, stdout};
use crate::support::workspace::Workspace;
use crate::verify::verified;

pub(crate) const DESCRIPTION: &str = "ro-crate-metadata.json";

/// The entities of a crate.
pub(crate) struct Crate(Vec<Value>);

impl Crate {
    fn read(workspace: &Workspace, folder: &str) -> Self {
        let file: Value =
            serde_json::from_slice(&workspace.read(&format!("{folder}/{DESCRIPTION}"))).unwrap();
        assert_eq!(file["@context"], "https://w3id.org/ro/crate/1.1/context");
        Self(file["@graph"].as_array().unwrap().clone())
    }

    pub(crate) fn entity(&self, id: &str) -> &Value {
        let found: Vec<&Value> = self.0.iter().filter(|entity| entity["@id"] == id).collect();
        assert_eq!(found.len(), 1, "{id}");
        found[0]
    }

    pub(crate) fn of_type(&self, kind: &str) -> Vec<&Value> {
        self.0.iter().filter(|entity| entity["@type"] == kind).collect()
    }
}

/// Identifiers in a property that links to one or several entities.
pub(crate) fn links(property: &Value) -> BTreeSet<String> {
    let linked = property
        .as_array()
        .cloned()
        .unwrap_or_else(|| vec![property.clone()]);
    linked
        .iter()
        .map(|link| link["@id"].as_str().unwrap().to_owned())
        .collect()
}

/// Checks every property that the profile and RO-Crate 1.1 require, every link, and every file with its
/// length.
pub(crate) fn expect_complete(workspace: &Workspace, folder: &str) -> Crate {
    let described = Crate::read(workspace, folder);
    let descriptor = described.entity(DESCRIPTION);
    assert_eq!(descriptor["@type"], "CreativeWork");
    assert_eq!(descriptor["about"]["@id"], "./");
    assert_eq!(descriptor["conformsTo"]["@id"], "https://w3id.org/ro/crate/1.1");
    let root = described.entity("./");
    assert_eq!(root["@type"], "Dataset");
    for required in ["name", "description", "datePublished", "license"] {
        assert!(!root[required].is_null(), "{required}");
    }
    let profile = root["conformsTo"]["@id"].as_str().unwrap();
    assert_eq!(profile, "https://w3id.org/ro/wfrun/process/0.5");
    assert_eq!(described.entity(profile)["@type"], "CreativeWork");
    let actions = described.of_type("CreateAction");
    let mentioned = links(&root["mentions"]);
    assert_eq!(mentioned.len(), actions.len());
    for action in actions {
        assert!(mentioned.contains(action["@id"].as_str().unwrap()));
        for instrument in links(&action["instrument"]) {
            let program = described.entity(&instrument);
            assert_eq!(program["@type"], "SoftwareApplication");
            assert_eq!(program["softwareVersion"], env!("CARGO_PKG_VERSION"));
        }
        // Times are recorded only for single runs.
        let has_manifest = links(&action["result"])
            .iter()
            .any(|id| id.ends_with("manifest.json"));
        for time in ["startTime", "endTime"] {
            let time = action[time].as_str().unwrap_or_default();
            assert_eq!(
                has_manifest,
                time.len() == 29 && time.ends_with("+00:00"),
                "{action}"
            );
        }
        for id in links(&action["object"])
            .into_iter()
            .chain(links(&action["result"]))
        {
            described.entity(&id);
        }
    }
    // Parts of the root, or of a folder that is part of it.
    let mut parts = links(&root["hasPart"]);
    for dataset in described.of_type("Dataset") {
        parts.extend(links(&dataset["hasPart"]));
    }
    for file in described.of_type("File") {
        let id = file["@id"].as_str().unwrap();
        assert!(parts.contains(id), "{id}");
        let bytes = workspace.read(&format!("{folder}/{}", id.replace("%20", " ")));
        assert_eq!(file["contentSize"], bytes.len().to_string(), "{id}");
        assert_ne!(file["description"], "A file of the results", "{id}");
    }
    described
}

#[test]
fn a_run_is_described_in_its_folder() {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml -o a");
    let before = workspace.files("a");
    let said = workspace.succeed("export a --ro-crate");
    assert!(said.starts_with("a/ro-crate-metadata.json\n"), "{said}");
    assert!(
        said.contains("has no author") && said.contains("has no licence"),
        "{said}"
    );
    let described = expect_complete(&workspace, "a");
    assert_eq!(described.of_type("File").len(), before.len());
    let action = described.of_type("CreateAction")[0];
    let objects = links(&action["object"]);
    assert!(objects.contains("case.toml") && objects.contains("inputs/spot.png"));
    let results = links(&action["result"]);
    assert!(results.contains("summary.json") && results.contains("manifest.json"));
    assert!(
        described.entity("./")["license"]
            .as_str()
            .unwrap()
            .starts_with("No licence is given")
    );
    let parameter = |key: &str| {
        let id = format!("{}/{key}", action["@id"].as_str().unwrap());
        assert!(objects.contains(&id), "{id}");
        described.entity(&id)
    };
    assert_eq!(parameter("drive.v_star")["value"], 0.1);
    let size = parameter("slider.block_size");
    assert_eq!(
        (&size["value"], &size["unitText"], &size["unitCode"]),
        (&1e-6.into(), &"m".into(), &"MTR".into())
    );

    // The results are unchanged, and can be verified as before.
    let mut after = workspace.files("a");
    assert!(after.remove(DESCRIPTION).is_some());
    assert!(after == before);
    let (status, said, errors) = verified(&workspace, "a");
    assert_eq!((status, errors.as_str()), (0, ""));
    assert!(!said.contains(DESCRIPTION), "{said}");
    assert!(workspace.succeed("run --resume a").contains("is complete"));

    // Existing descriptions are not replaced without --force.
    let refused = workspace.fail("export a --ro-crate", 2);
    assert!(refused.contains("exists: replace it with --force"), "{refused}");
    workspace.succeed("export a --ro-crate --force --licence CC-BY-4.0");
    let licence = expect_complete(&workspace, "a").entity("./")["license"].clone();
    assert_eq!(licence["@id"], "https://spdx.org/licenses/CC-BY-4.0");

    // The description does not match another run in its place.
    workspace.succeed("run masked.toml -o a --force --seed 2");
    let (status, said, _) = verified(&workspace, "a");
    assert_eq!(status, 0);
    assert!(
        said.contains("ro-crate-metadata.json does not describe the results"),
        "{said}"
    );
}

#[test]
fn several_runs_are_one_crate() {
    let workspace = Workspace::masked();
    workspace.succeed("run masked.toml --out a");
    workspace.succeed("run small.toml --out b/run");
    std::fs::rename(workspace.path("a"), workspace.path("with a blank")).unwrap();
    let export =
        |line: &str| workspace.shell(&format!("'{}' export {line}", crate::support::process::program()));
    let done = export("'with a blank' b/run --ro-crate --author 'A. Author' -o all");
    assert!(done.status.success());
    let described = expect_complete(&workspace, "all");
    assert_eq!(described.of_type("CreateAction").len(), 2);
    assert_eq!(described.of_type("SoftwareApplication").len(), 1);
    for action in described.of_type("CreateAction") {
        assert_eq!(action["agent"]["@id"], "#author");
    }
    assert_eq!(described.entity("#author")["name"], "A. Author");
    assert!(workspace.files("all/with a blank") == workspace.files("with a blank"));
    assert!(workspace.files("all/run") == workspace.files("b/run"));
    let refused = workspace.fail("export b/run --ro-crate -o all", 2);
    assert!(refused.contains("the folder all is not empty"), "{refused}");
    let refused = workspace.fail("export b/run --ro-crate -o .", 2);
    assert!(refused.contains("the command runs in the folder ."), "{refused}");
    // The crate may take the place of an empty folder.
    std::fs::create_dir(workspace.path("empty")).unwrap();
    workspace.succeed("export b/run --ro-crate -o empty");
    expect_complete(&workspace, "empty");
    let refused = workspace.fail("export b/run all/run --ro-crate -o new", 2);
    assert!(
        refused.contains("two of the folders have the same name run"),
        "{refused}"
    );
    assert!(!workspace.exists("new"));
    let refused = workspace.fail("export b/run all/run --ro-crate", 2);
    assert!(refused.contains("give its folder with --out"), "{refused}");
}

#[test]
fn only_whole_runs_are_exported() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a");
    for form in ["--ro-crate", "--bibtex", "--cff --author A", "--ro-crate -o new"] {
        let series = workspace.read("a/series.csv");
        workspace.write("a/series.csv", "changed");
        let refused = workspace.fail(&format!("export a {form}"), 1);
        assert!(refused.contains("a/series.csv differs"), "{refused}");
        workspace.write("a/series.csv", series);
        workspace.interrupt("a");
        let refused = workspace.fail(&format!("export a {form}"), 2);
        assert!(refused.contains("slipfront run --resume a"), "{refused}");
        workspace.succeed("run --resume a");
    }
    assert!(!workspace.exists("new") && !workspace.exists(&format!("a/{DESCRIPTION}")));
    let refused = workspace.fail("export a", 2);
    assert!(refused.contains("--ro-crate"), "{refused}");
    let refused = workspace.fail("export a --ro-crate --author A<me>", 2);
    assert!(refused.contains("https://orcid.org/"), "{refused}");
    let refused = workspace.fail("export a --ro-crate --licence my_own", 2);
    assert!(refused.contains("https://spdx.org/licenses"), "{refused}");
}

/// The fields of BibTeX entries as BibTeX parses them: a value ends with the brace that closes its first
/// brace, even after a backslash.
pub(crate) fn entries(bibtex: &str) -> Vec<BTreeMap<String, String>> {
    let mut found = Vec::new();
    for entry in bibtex.split_inclusive("\n}\n") {
        let (head, mut rest) = entry.split_once(",\n").unwrap();
        assert!(head.starts_with('@') && head.matches('{').count() == 1, "{head}");
        let mut fields = BTreeMap::new();
        while rest != "}\n" {
            let (name, value) = rest.split_once(" = {").unwrap_or_else(|| panic!("{entry}"));
            let mut depth = 1;
            let end = value.find(|c| {
                depth += i32::from(c == '{') - i32::from(c == '}');
                depth == 0
            });
            let (value, after) = value.split_at(end.unwrap_or_else(|| panic!("{entry}")));
            fields.insert(name.trim().to_owned(), value.to_owned());
            rest = after.strip_prefix("},\n").unwrap_or_else(|| panic!("{entry}"));
        }
        found.push(fields);
    }
    found
}

/// Folders and authors may have any name; `tests/ro_crate/citations.py` checks that other programs can read
/// the entries.
#[test]
fn any_name_can_be_cited() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml --no-pictures -o plain");
    for (name, title) in [
        ("{", "\\textbraceleft{}"),
        ("a}b", "a\\textbraceright{}b"),
        ("a\\", "a\\textbackslash{}"),
        ("\\{", "\\textbackslash{}\\textbraceleft{}"),
        (
            "100 % of #1 & $2_^~",
            "100 \\% of \\#1 \\& \\$2\\_\\textasciicircum{}\\textasciitilde{}",
        ),
        ("@misc{a, \"q\" = 'b'", "@misc\\textbraceleft{}a, \"q\" = 'b'"),
        ("\u{e4}\u{df} \u{3bc}\u{6f22}", "\u{e4}\u{df} \u{3bc}\u{6f22}"),
        ("two\nlines", "two lines"),
    ] {
        std::fs::rename(workspace.path("plain"), workspace.path(name)).unwrap();
        let mut process = workspace.process("export --bibtex --author");
        let output = output(process.args([name.replace('\n', " "), name.to_owned()]));
        let bibtex = stdout(&output);
        assert!(output.status.success(), "{name}: {}", stderr(&output));
        let entries = entries(&bibtex);
        assert_eq!(entries.len(), 3, "{bibtex}");
        assert_eq!(
            entries[0]["title"],
            format!("{{Friction computed with slipfront: {title}}}")
        );
        assert_eq!(entries[0]["author"], format!("{{{title}}}"));
        std::fs::rename(workspace.path(name), workspace.path("plain")).unwrap();
    }
}

#[test]
fn runs_are_cited() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a_b");
    let manifest: Value = serde_json::from_slice(&workspace.read("a_b/manifest.json")).unwrap();
    let seal = manifest["seal"].as_str().unwrap();
    let bibtex = workspace.succeed("export a_b --bibtex");
    assert_eq!(bibtex.matches('@').count(), 3);
    assert_eq!(bibtex.matches('{').count(), bibtex.matches('}').count());
    assert!(
        bibtex.contains("slipfront: a\\_b}") && bibtex.contains(seal),
        "{bibtex}"
    );
    assert!(
        bibtex.contains("doi = {10.1016/j.triboint.2023.108866}"),
        "{bibtex}"
    );
    assert!(
        bibtex.contains("author = {Jalali, S. K. and Pugno, N. M.}"),
        "{bibtex}"
    );
    assert!(bibtex.contains(&format!(
        "year = {{{}}}",
        &manifest["finished"].as_str().unwrap()[..4]
    )));
    assert!(
        workspace
            .succeed("export a_b --bibtex --author A")
            .contains("  author = {{A}},\n")
    );
    let refused = workspace.fail("export a_b --cff", 2);
    assert!(refused.contains("needs an author"), "{refused}");
    let cff = workspace.succeed("export a_b --cff --author A --licence CC0-1.0");
    for line in [
        "cff-version: 1.2.0",
        "type: dataset",
        "  - name: \"A\"",
        "license: \"CC0-1.0\"",
        "  - type: software",
        "      - family-names: Jalali",
    ] {
        assert!(cff.lines().any(|found| found == line), "{line}\n{cff}");
    }
    assert!(cff.contains(seal));
}
