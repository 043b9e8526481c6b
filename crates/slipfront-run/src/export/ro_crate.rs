//! The metadata of a Process Run Crate 0.5 (<https://w3id.org/ro/wfrun/process/0.5>), a profile of RO-Crate
//! 1.1.
//!
//! Every action is a `CreateAction`: slipfront is its instrument, the input files and keys are its objects,
//! and the output files are its results.

use std::collections::HashSet;
use std::path::Path;

use jiff::Timestamp;
use serde_json::{Map, Value, json};
use slipfront_base::disk::json as json_bytes;
use slipfront_base::text::shell_path;

use super::attribution::Attribution;
use super::citation::{ARTICLE_TITLE, ARTICLE_URL, ARTICLE_YEAR, DEVELOPERS, MODEL};
use super::exported::{Action, Exported, ExportedFile, MadeBy};
use super::meaning::format_of;
use super::parameters::Parameter;
use crate::names::RO_CRATE;

const CONTEXT: &str = "https://w3id.org/ro/crate/1.1/context";
const SPECIFICATION: &str = "https://w3id.org/ro/crate/1.1";
const PROFILE: &str = "https://w3id.org/ro/wfrun/process/0.5";

/// The file `ro-crate-metadata.json` of results, each with the path of its folder in the crate: empty, or
/// ending with a slash.
pub(super) fn metadata(all: &[(&Exported, String)], by: &Attribution, published: Timestamp) -> Vec<u8> {
    let mut graph = Graph::default();
    let titles: Vec<String> = all.iter().map(|(results, _)| results.title()).collect();
    let actions = all.iter().flat_map(|(results, _)| &results.actions);
    let parts = all.iter().flat_map(|(results, at)| parts(results, at));
    let licence = by.licence.as_ref().map_or_else(
        || json!("No licence is given: ask the authors before using the results."),
        |licence| link(&licence.url),
    );
    let author = by.author.as_ref().map(|author| {
        let id = author.orcid.as_deref().unwrap_or("#author");
        (id, json!({"name": author.name}))
    });
    let agent = author.as_ref().map(|(id, _)| link(id));
    let root = json!({
        "name": format!("Friction computed with slipfront: {}", titles.join(", ")),
        "description": format!("Results of slipfront, {MODEL}: cases, curves, fields, tables and pictures with their provenance."),
        "conformsTo": link(PROFILE),
        "datePublished": published.strftime("%Y-%m-%d").to_string(),
        "license": licence,
        "hasPart": one_or_all(parts.collect()),
        "mentions": one_or_all(actions.map(|action| link(&action_id(action))).collect()),
        "author": agent,
    });
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
    for (results, at) in all {
        add_results(&mut graph, results, at, agent.as_ref());
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
    /// Identifiers of the entities.
    ids: HashSet<String>,
}

impl Graph {
    /// Adds an entity with those of these properties that are not null, unless there is one with this
    /// identifier.
    fn add(&mut self, id: &str, kind: &str, properties: Value) {
        if !self.ids.insert(id.to_owned()) {
            return;
        }
        let mut entity = Map::from_iter([("@id".to_owned(), json!(id)), ("@type".to_owned(), json!(kind))]);
        if let Value::Object(properties) = properties {
            entity.extend(properties.into_iter().filter(|(_, value)| !value.is_null()));
        }
        self.entities.push(Value::Object(entity));
    }
}

fn link(id: &str) -> Value {
    json!({"@id": id})
}

/// Links in the form of RO-Crate: a single link is not in an array.
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

/// Links to the folder of results in the crate, or to its files if they do not have their own folder.
fn parts(results: &Exported, at: &str) -> Vec<Value> {
    if at.is_empty() {
        files(results, at)
    } else {
        vec![link(&encoded(at))]
    }
}

/// Links to all files of results.
fn files(results: &Exported, at: &str) -> Vec<Value> {
    let names = results.files.iter().map(|of| &of.file.name);
    names.map(|name| link(&file_id(at, name))).collect()
}

fn file_id(at: &str, name: &str) -> String {
    encoded(&format!("{at}{name}"))
}

/// Names of the folders of results in a crate, from its description; none if it is no description.
pub fn folders_in(description: &[u8]) -> Option<Vec<String>> {
    let description: Value = serde_json::from_slice(description).ok()?;
    let datasets = description["@graph"].as_array()?.iter();
    let datasets = datasets.filter(|entity| entity["@type"] == "Dataset" && entity["@id"] != "./");
    datasets
        .map(|entity| entity["name"].as_str().map(str::to_owned))
        .collect()
}

fn action_id(action: &Action) -> String {
    format!("#{}", encoded(&action.id))
}

/// Adds results: their folder, their files and their actions.
fn add_results(graph: &mut Graph, results: &Exported, at: &str, agent: Option<&Value>) {
    if !at.is_empty() {
        let properties = json!({
            "name": results.name,
            "description": format!("Folder of a {}", results.kind),
            "hasPart": one_or_all(files(results, at)),
        });
        graph.add(&encoded(at), "Dataset", properties);
    }
    for ExportedFile { file, meaning } in &results.files {
        let properties = json!({
            "name": file.name,
            "description": meaning,
            "contentSize": file.bytes.to_string(),
            "encodingFormat": format_of(&file.name),
        });
        graph.add(&file_id(at, &file.name), "File", properties);
    }
    for action in &results.actions {
        add_action(graph, action, at, agent);
    }
}

/// Adds an action with its parameters and its program.
fn add_action(graph: &mut Graph, action: &Action, at: &str, agent: Option<&Value>) {
    let links = |names: &[String]| -> Vec<Value> {
        let ids = names.iter().map(|name| file_id(at, name));
        ids.map(|id| link(&id)).collect()
    };
    let mut objects = links(&action.objects);
    for parameter in &action.parameters {
        let id = format!("{}/{}", action_id(action), encoded(&parameter.key));
        objects.push(link(&id));
        graph.add(&id, "PropertyValue", value_of(parameter));
    }
    let [start, end] = action.times.each_ref().map(|time| {
        let time = time.parse::<Timestamp>().ok()?;
        Some(time.strftime("%Y-%m-%dT%H:%M:%S%.3f+00:00").to_string())
    });
    let failed = action
        .failure
        .as_ref()
        .map(|_| "http://schema.org/FailedActionStatus");
    let properties = json!({
        "name": action.name,
        "description": description(action, at),
        "instrument": link(&add_program(graph, &action.program)),
        "object": one_or_all(objects),
        "result": one_or_all(links(&action.results)),
        "startTime": start,
        "endTime": end,
        "identifier": action.seal.as_ref().map(|seal| format!("blake3:{seal}")),
        "actionStatus": failed,
        "error": action.failure,
        "agent": agent,
    });
    graph.add(&action_id(action), "CreateAction", properties);
}

/// The command that repeats an action, and its description.
fn description(action: &Action, at: &str) -> String {
    let Some((command, files)) = &action.command else {
        return action.description.clone();
    };
    let files = files.iter().map(|name| format!("{at}{name}"));
    let files: String = files
        .map(|path| format!(" {}", shell_path(Path::new(&path))))
        .collect();
    format!("`{command}{files}` repeats it; {}", action.description)
}

fn value_of(Parameter { key, value, unit }: &Parameter) -> Value {
    let (name, code) = unit.map_or((None, None), |(name, code)| (Some(name), code));
    json!({"name": key, "value": value, "unitText": name, "unitCode": code})
}

/// Adds a program, and returns its identifier.
fn add_program(graph: &mut Graph, program: &MadeBy) -> String {
    let id = format!(
        "#{}",
        encoded(&format!("{}/{}", program.in_words(), program.build))
    );
    let description = match &program.revision {
        Some(revision) => format!("{MODEL}; built from the git commit {revision}"),
        None => MODEL.to_owned(),
    };
    let software = json!({
        "name": "slipfront",
        "description": description,
        "softwareVersion": program.version,
        "identifier": program.build,
        "author": link("#developers"),
        "citation": link(ARTICLE_URL),
    });
    graph.add(&id, "SoftwareApplication", software);
    id
}
