//! The metadata of a Process Run Crate 0.5 (<https://w3id.org/ro/wfrun/process/0.5>), a profile of RO-Crate
//! 1.1.
//!
//! A run is a `CreateAction`: slipfront is its instrument; the case, the files that the case reads and the
//! keys of the case are its objects; every other file of the run is a result.

use std::path::Path;

use jiff::Timestamp;
use serde_json::{Map, Value, json};
use slipfront_base::disk::json as json_bytes;
use slipfront_base::number_format::count;
use slipfront_base::text::shell_path;

use super::attribution::Attribution;
use super::citation::{ARTICLE_TITLE, ARTICLE_URL, ARTICLE_YEAR, DEVELOPERS, MODEL};
use super::parameters::{Parameter, parameters};
use super::whole_run::WholeRun;
use crate::manifest::ManifestFile;
use crate::names::{CASE, FIELDS, KYMOGRAPH, MANIFEST, MOVIE, RO_CRATE, RunPicture, SERIES, SUMMARY};
use crate::observers::tables;

const CONTEXT: &str = "https://w3id.org/ro/crate/1.1/context";
const SPECIFICATION: &str = "https://w3id.org/ro/crate/1.1";
const PROFILE: &str = "https://w3id.org/ro/wfrun/process/0.5";

/// The file `ro-crate-metadata.json` of runs, each with the path of its folder in the crate: empty, or ending
/// with a slash.
pub(super) fn metadata(runs: &[(&WholeRun, String)], by: &Attribution, published: Timestamp) -> Vec<u8> {
    let mut graph = Graph::default();
    let names: Vec<&str> = runs.iter().map(|(run, _)| run.name.as_str()).collect();
    let licence = by.licence.as_ref().map_or_else(
        || json!("Not told: ask the authors before using the results."),
        |licence| link(&licence.url),
    );
    let mut root = json!({
        "name": format!("Friction computed with slipfront: {}", names.join(", ")),
        "description": format!("Results of slipfront, {MODEL}: of every run its case, curves, fields, pictures and provenance."),
        "conformsTo": link(PROFILE),
        "datePublished": published.strftime("%Y-%m-%d").to_string(),
        "license": licence,
        "hasPart": one_or_all(runs.iter().flat_map(|(run, at)| parts(run, at)).collect()),
        "mentions": one_or_all(runs.iter().map(|(run, _)| link(&action_id(run))).collect()),
    });
    let author = by.author.as_ref().map(|author| {
        let id = author.orcid.as_deref().unwrap_or("#author");
        (id, json!({"name": author.name}))
    });
    if let Some((id, _)) = &author {
        root["author"] = link(id);
    }
    graph.add(
        RO_CRATE,
        "CreativeWork",
        json!({"conformsTo": link(SPECIFICATION), "about": link("./")}),
    );
    graph.add("./", "Dataset", root);
    graph.add(
        PROFILE,
        "CreativeWork",
        json!({"name": "Process Run Crate", "version": "0.5"}),
    );
    for (run, at) in runs {
        let agent = author.as_ref().map(|(id, _)| link(id));
        add_run(&mut graph, run, at, agent);
    }
    if let Some((id, person)) = author {
        graph.add(id, "Person", person);
    }
    if let Some(licence) = &by.licence {
        let properties = json!({"name": licence.name, "description": "Licence of the results"});
        graph.add(&licence.url, "CreativeWork", properties);
    }
    graph.add("#developers", "Organization", json!({"name": DEVELOPERS}));
    let article = json!({"name": ARTICLE_TITLE, "datePublished": ARTICLE_YEAR.to_string()});
    graph.add(ARTICLE_URL, "ScholarlyArticle", article);
    json_bytes(&json!({"@context": CONTEXT, "@graph": graph.entities}))
}

/// The entities of a crate.
#[derive(Default)]
struct Graph {
    entities: Vec<Value>,
}

impl Graph {
    /// Adds an entity, unless there is one with this identifier.
    fn add(&mut self, id: &str, kind: &str, properties: Value) {
        if self.entities.iter().any(|entity| entity["@id"] == id) {
            return;
        }
        let mut entity = Map::from_iter([("@id".to_owned(), json!(id)), ("@type".to_owned(), json!(kind))]);
        if let Value::Object(properties) = properties {
            entity.extend(properties);
        }
        self.entities.push(Value::Object(entity));
    }
}

fn link(id: &str) -> Value {
    json!({"@id": id})
}

/// Links as RO-Crate has them: one of them stands alone.
fn one_or_all(mut links: Vec<Value>) -> Value {
    if links.len() == 1 {
        links.remove(0)
    } else {
        Value::Array(links)
    }
}

/// A path as part of an address: every byte but letters, digits, `-._~` and the slashes between folders as
/// `%` and its two digits.
fn encoded(path: &str) -> String {
    let byte = |byte: u8| match byte {
        b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
            char::from(byte).to_string()
        }
        _ => format!("%{byte:02X}"),
    };
    path.bytes().map(byte).collect()
}

/// Links to the folder of a run in the crate, or to its files where it has none of its own.
fn parts(run: &WholeRun, at: &str) -> Vec<Value> {
    if at.is_empty() {
        run.files().map(|file| link(&file_id(at, file))).collect()
    } else {
        vec![link(&encoded(at))]
    }
}

fn file_id(at: &str, file: &ManifestFile) -> String {
    encoded(&format!("{at}{}", file.name))
}

fn action_id(run: &WholeRun) -> String {
    format!("#run-{}", &run.manifest.checksum)
}

/// Adds a run: its folder, its files, its parameters, the program and the action.
fn add_run(graph: &mut Graph, run: &WholeRun, at: &str, agent: Option<Value>) {
    let manifest = &run.manifest;
    if !at.is_empty() {
        let files: Vec<Value> = run.files().map(|file| link(&file_id(at, file))).collect();
        let properties =
            json!({"name": run.name, "description": "Folder of a run", "hasPart": one_or_all(files)});
        graph.add(&encoded(at), "Dataset", properties);
    }
    let (mut objects, mut results) = (Vec::new(), Vec::new());
    for file in run.files() {
        let id = file_id(at, file);
        let is_input = file.name == CASE || file.name.starts_with("inputs/");
        if is_input { &mut objects } else { &mut results }.push(link(&id));
        graph.add(&id, "File", file_properties(file));
    }
    for Parameter { key, value, unit } in parameters(&run.case) {
        let id = format!("{}/{}", action_id(run), encoded(&key));
        let mut properties = json!({"name": key, "value": value});
        if let Some((name, code)) = unit {
            properties["unitText"] = json!(name);
            if let Some(code) = code {
                properties["unitCode"] = json!(code);
            }
        }
        graph.add(&id, "PropertyValue", properties);
        objects.push(link(&id));
    }
    let program = format!(
        "#{}",
        encoded(&format!("{}/{}", manifest.program(), manifest.build))
    );
    let mut action = json!({
        "name": format!("Run of the case {}", run.name),
        "description": format!(
            "`slipfront run {}` repeats it with the same bytes; on {}, {}, {}; {CASE} has the BLAKE3 hash {}",
            shell_path(Path::new(&format!("{at}{CASE}"))),
            manifest.host,
            manifest.platform,
            count(manifest.threads, "thread"),
            manifest.case_blake3
        ),
        "identifier": run.identifier(),
        "instrument": link(&program),
        "object": one_or_all(objects),
        "result": one_or_all(results),
    });
    for (key, time) in [("startTime", &manifest.started), ("endTime", &manifest.finished)] {
        if let Ok(time) = time.parse::<Timestamp>() {
            action[key] = json!(time.strftime("%Y-%m-%dT%H:%M:%S%.3f+00:00").to_string());
        }
    }
    if let Some(agent) = agent {
        action["agent"] = agent;
    }
    graph.add(&action_id(run), "CreateAction", action);
    let mut software = json!({
        "name": "slipfront",
        "description": MODEL,
        "softwareVersion": manifest.version,
        "identifier": manifest.build,
        "author": link("#developers"),
        "citation": link(ARTICLE_URL),
    });
    if let Some(revision) = &manifest.revision {
        software["description"] = json!(format!("{MODEL}; built from the git commit {revision}"));
    }
    graph.add(&program, "SoftwareApplication", software);
}

fn file_properties(file: &ManifestFile) -> Value {
    let ending = file.name.rsplit('.').next().unwrap_or_default();
    let mut properties = json!({
        "name": file.name,
        "description": description(&file.name),
        "contentSize": file.bytes.to_string(),
    });
    if let Some((_, format)) = FORMATS.iter().find(|(known, _)| *known == ending) {
        properties["encodingFormat"] = json!(format);
    }
    properties
}

/// Media types of the files of a run by their endings.
const FORMATS: [(&str, &str); 10] = [
    ("csv", "text/csv"),
    ("gif", "image/gif"),
    ("json", "application/json"),
    ("nc", "application/x-netcdf"),
    ("npy", "application/x-npy"),
    ("png", "image/png"),
    ("svg", "image/svg+xml"),
    ("tif", "image/tiff"),
    ("tiff", "image/tiff"),
    ("toml", "application/toml"),
];

fn description(name: &str) -> String {
    let known = [
        (CASE, "The case with every default filled in"),
        (SUMMARY, "The numbers of the run"),
        (SERIES, "The curves over time"),
        (
            KYMOGRAPH,
            "Share of sliding blocks over place along the drive and time",
        ),
        (
            FIELDS,
            "Displacement, velocity, stress and sliding of every block at some instants",
        ),
        (MOVIE, "The snapshots one after the other"),
        (
            MANIFEST,
            "Provenance of the run; length and BLAKE3 checksum of every other file",
        ),
    ];
    let tables = tables().map(|table| (table.file, table.description));
    if let Some((_, meaning)) = known.into_iter().chain(tables).find(|(known, _)| *known == name) {
        return meaning.to_owned();
    }
    let is_shown = |picture: &RunPicture| picture.files().iter().any(|file| file == name);
    match RunPicture::ALL.into_iter().find(is_shown) {
        Some(picture) => format!("Picture: {}", picture.shows()),
        None => "A file that the case reads".to_owned(),
    }
}
