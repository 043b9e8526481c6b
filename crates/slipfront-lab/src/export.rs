//! Export of the laboratory without a server: its page and the session as WebAssembly, as a folder for any
//! web server or as one file.

use std::collections::BTreeMap;
use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use serde::Serialize;
use sha2::{Digest, Sha256};
use slipfront_base::disk::{folder_of, make_folders, write_atomic, write_with_folders};
use slipfront_base::text::display_path;
use slipfront_base::unfinished::{UnfinishedFolder, is_unfinished};
use slipfront_session::{Document, Presets};

use crate::start::Start;
use crate::{assets, presets};

/// File name of the session as WebAssembly, next to the program and in an exported folder.
pub const MODULE: &str = "slipfront.wasm";

/// File name of the second module, in the same folder, which runs the jobs outside a session.
const WORK: &str = "slipfront-work.wasm";

/// Both modules.
const MODULES: [&str; 2] = [MODULE, WORK];

/// The file with the presets and the case with which the session begins.
const BEGINNING: &str = "start.json";

/// The file with the licences of everything in an exported page.
const NOTICES: &str = "THIRD-PARTY-NOTICES.txt";

/// Content security policy of the page of an exported folder: it may load files from its own folder and
/// compile the module.
const POLICY_OF_FOLDER: &str = include_str!("../export/folder.policy");

/// Content security policy of a page in one file: it may run its loader, apply its styles, and use what the
/// loader makes from its files.
const POLICY_OF_SINGLE: &str = include_str!("../export/single.policy");

/// Element that marks an exported page as one without a server.
const BEGINNING_OF_PAGE: &str = "<html data-channel=\"worker\">";

/// Number of bytes searched for that element.
const BYTES_OF_BEGINNING: u64 = 256;

/// Scripts that start the page.
const SCRIPTS: [&str; 2] = ["module.js", "main.js"];

/// Styles of the page.
const STYLES: [&str; 2] = ["vendor/uPlot.min.css", "style.css"];

/// The manifest that lets a browser offer to install the page as a program.
const MANIFEST: &str = r##"{
  "name": "slipfront laboratory",
  "short_name": "slipfront",
  "start_url": "./",
  "scope": "./",
  "display": "standalone",
  "background_color": "#ffffff",
  "theme_color": "#2a6f97"
}
"##;

/// Reasons why the laboratory cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The module was not built.
    #[error(
        "the simulation as WebAssembly, {MODULE}, is not in {}: build it by crates/slipfront-wasm/build.sh of the sources, and export again",
        places(.0)
    )]
    NoModule(Vec<PathBuf>),
    /// The file of the module is not WebAssembly.
    #[error("{} is no module of WebAssembly: build it anew by crates/slipfront-wasm/build.sh of the sources", display_path(.0))]
    NotModule(PathBuf),
    /// A folder of a run needs a server to read it.
    #[error("a folder of a run cannot be exported: name the case.toml in it")]
    Folder,
    /// The case with which the page opens is invalid.
    #[error("{0}")]
    Case(String),
    /// The folder is not empty, and is no exported laboratory.
    #[error("{} holds other things than an exported laboratory: name another folder", display_path(.0))]
    OtherThings(PathBuf),
    /// The file exists, and is no exported laboratory.
    #[error("{} exists, and is no exported laboratory: choose another name", display_path(.0))]
    OtherFile(PathBuf),
    /// The system refuses to read the module.
    #[error("{} cannot be read: {source}", display_path(path))]
    Read {
        /// The file of the module.
        path: PathBuf,
        /// Why the system refuses to read it.
        source: std::io::Error,
    },
    /// The system refuses to write a file or folder.
    #[error("{} cannot be written: {source}", display_path(path))]
    Write {
        /// The file or folder that cannot be written.
        path: PathBuf,
        /// Why the system refuses to write it.
        source: std::io::Error,
    },
}

/// The folders that were searched, for an error message.
fn places(folders: &[PathBuf]) -> String {
    let folders: Vec<String> = folders.iter().map(|folder| display_path(folder)).collect();
    folders.join(" or in ")
}

/// Presets, and the case with which the page opens.
#[derive(Serialize)]
struct Beginning<'a> {
    presets: &'a Presets,
    opening: &'a Document,
}

/// Everything that makes up a page without a server: files and modules of WebAssembly, by name.
struct Parts(BTreeMap<String, Vec<u8>>);

/// Finds the module of the session in the first folder that has it. The module of the jobs is in the same
/// folder.
///
/// # Errors
/// When none of the folders has the module.
pub fn find_module(folders: &[PathBuf]) -> Result<PathBuf, ExportError> {
    let paths = folders.iter().map(|folder| folder.join(MODULE));
    let found = paths.into_iter().find(|path| path.is_file());
    found.ok_or_else(|| ExportError::NoModule(folders.to_vec()))
}

/// Reads a module of WebAssembly.
///
/// # Errors
/// When the file cannot be read, or is not WebAssembly.
fn read_module(path: PathBuf) -> Result<Vec<u8>, ExportError> {
    let contents = fs::read(&path);
    match contents {
        Ok(contents) if contents.starts_with(b"\0asm") => Ok(contents),
        Ok(_) => Err(ExportError::NotModule(path)),
        Err(source) => Err(ExportError::Read { path, source }),
    }
}

impl Parts {
    fn new(start: &Start, module: &Path, notices: &str) -> Result<Self, ExportError> {
        let presets = presets::all();
        let opening = match start {
            Start::Preset => presets::opening(&presets).map_err(ExportError::Case)?,
            Start::Case(document) => Document::clone(document),
            Start::Folder(_) => return Err(ExportError::Folder),
        };
        let mut files: BTreeMap<String, Vec<u8>> = assets::all()
            .map(|(name, contents)| (name, contents.to_vec()))
            .collect();
        files.insert(MODULE.to_owned(), read_module(module.to_owned())?);
        files.insert(WORK.to_owned(), read_module(module.with_file_name(WORK))?);
        let beginning = Beginning {
            presets: &presets,
            opening: &opening,
        };
        let beginning =
            serde_json::to_vec(&beginning).map_err(|error| ExportError::Case(error.to_string()))?;
        files.insert(BEGINNING.to_owned(), beginning);
        files.insert(NOTICES.to_owned(), notices.as_bytes().to_vec());
        Ok(Self(files))
    }

    /// A file of the page as text.
    fn text(&self, name: &str) -> String {
        let contents = self.0.get(name).map(Vec::as_slice).unwrap_or_default();
        String::from_utf8_lossy(contents).into_owned()
    }

    /// The page, marked as one without a server, with a policy and further elements in its head.
    fn page(&self, policy: &str, more: &str) -> String {
        let policy = policy.trim_end();
        let head = format!(
            "<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"{policy}\">\n{more}"
        );
        self.text("index.html")
            .replacen("<html>", BEGINNING_OF_PAGE, 1)
            .replacen("<meta charset=\"utf-8\">\n", &head, 1)
    }
}

/// Writes the laboratory as a folder for any web server: a page that opens with a case of the start, and
/// loads nothing from outside the folder. It contains the licence notices of its parts.
///
/// # Errors
/// When the module is not WebAssembly, the folder holds other things, or the system refuses to read or write.
pub fn export_folder(start: &Start, module: &Path, notices: &str, out: &Path) -> Result<(), ExportError> {
    let failed = |source| ExportError::Write {
        path: out.to_owned(),
        source,
    };
    // A killed export may have left its hidden folder.
    let is_left = |entry: std::io::Result<fs::DirEntry>| {
        entry.is_ok_and(|entry| is_unfinished(&entry.file_name().to_string_lossy()))
    };
    let is_free = || fs::read_dir(out).is_ok_and(|mut entries| entries.all(is_left));
    if out.exists() && !out.join(MODULE).is_file() && !is_free() {
        return Err(ExportError::OtherThings(out.to_owned()));
    }
    let parts = Parts::new(start, module, notices)?;
    let page = parts.page(
        POLICY_OF_FOLDER,
        "<link rel=\"manifest\" href=\"manifest.webmanifest\">\n",
    );
    let Parts(mut files) = parts;
    files.insert("index.html".to_owned(), page.into_bytes());
    files.insert("manifest.webmanifest".to_owned(), MANIFEST.into());
    files.insert(
        "service_worker.js".to_owned(),
        service_worker(&files).into_bytes(),
    );
    place(&files, out).map_err(failed)
}

/// Writes files to a hidden folder, which gets its name when it is whole. In a folder that is there already,
/// they get their names one by one, which needs no space on the disk.
fn place(files: &BTreeMap<String, Vec<u8>>, out: &Path) -> std::io::Result<()> {
    let is_new = !out.exists();
    make_folders(folder_of(out))?;
    let beside = if is_new { out.to_owned() } else { out.join(MODULE) };
    let hidden = UnfinishedFolder::beside(&beside)?;
    for (name, contents) in files {
        write_with_folders(&hidden.path().join(name), contents)?;
    }
    if is_new {
        return hidden.persist(out);
    }
    // The module comes first: it tells that the folder may be written to again.
    let mut names: Vec<&String> = files.keys().collect();
    names.sort_by_key(|name| *name != MODULE);
    for name in names {
        let path = out.join(name);
        make_folders(folder_of(&path))?;
        fs::rename(hidden.path().join(name), path)?;
    }
    Ok(())
}

/// The script that caches these files in the browser, under a name derived from their contents.
fn service_worker(files: &BTreeMap<String, Vec<u8>>) -> String {
    let mut hasher = Sha256::new();
    for (name, contents) in files {
        hasher.update(name.as_bytes());
        hasher.update((contents.len() as u64).to_le_bytes());
        hasher.update(contents);
    }
    let hash = hasher.finalize();
    let digits: String = hash.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    // The address of the folder is the address of the page.
    let names = ["./"].into_iter().chain(files.keys().map(String::as_str));
    let names: Vec<String> = names.map(|name| format!("'{name}'")).collect();
    include_str!("../export/service_worker.js")
        .replacen("'FILES'", &names.join(", "), 1)
        .replacen("'CACHE'", &format!("'slipfront-{digits}'"), 1)
}

/// Writes the laboratory as one file that opens from the disk: a page that opens with a case of the start,
/// and loads nothing else. It contains the licence notices of its parts.
///
/// # Errors
/// When the module is not WebAssembly, another file has this name, or the system refuses to read or write.
pub fn export_single(start: &Start, module: &Path, notices: &str, out: &Path) -> Result<(), ExportError> {
    if out.is_file() && !is_exported(out) {
        return Err(ExportError::OtherFile(out.to_owned()));
    }
    let parts = Parts::new(start, module, notices)?;
    let styles = STYLES.map(|name| parts.text(name));
    let loader = include_str!("../export/single.js");
    let hash = |text: &str| format!("'sha256-{}'", BASE64_STANDARD.encode(Sha256::digest(text)));
    let policy = POLICY_OF_SINGLE.replacen("LOADER", &hash(loader), 1).replacen(
        "STYLES",
        &styles.each_ref().map(|style| hash(style)).join(" "),
        1,
    );
    let mut page = parts.page(&policy, "");
    for (name, style) in STYLES.iter().zip(&styles) {
        let link = format!("<link rel=\"stylesheet\" href=\"{name}\">");
        page = page.replacen(&link, &format!("<style>{style}</style>"), 1);
    }
    let script = format!(
        "<script type=\"application/json\" id=\"files\">{}</script>\n",
        files_within(&parts)
    );
    for name in SCRIPTS {
        page = page.replacen(
            &format!("<script type=\"module\" src=\"{name}\"></script>\n"),
            "",
            1,
        );
    }
    // The script comes after all elements: it is not a module, and would run before they exist.
    page = page.replacen(
        "</body>",
        &format!("{script}<script>{loader}</script>\n</body>"),
        1,
    );
    write_atomic(out, page.as_bytes()).map_err(|source| ExportError::Write {
        path: out.to_owned(),
        source,
    })
}

/// Whether a file is an exported page.
fn is_exported(path: &Path) -> bool {
    let mut beginning = Vec::new();
    let read =
        fs::File::open(path).and_then(|file| file.take(BYTES_OF_BEGINNING).read_to_end(&mut beginning));
    read.is_ok() && String::from_utf8_lossy(&beginning).contains(BEGINNING_OF_PAGE)
}

/// A module for a page in one file: compressed with gzip, in Base64.
fn compressed(module: &[u8]) -> String {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    // Writing to memory cannot fail.
    let compressed = encoder.write_all(module).and_then(|()| encoder.finish());
    BASE64_STANDARD.encode(compressed.unwrap_or_default())
}

/// The files that a page in one file loads, as JSON inside a script: texts and compressed modules.
fn files_within(parts: &Parts) -> String {
    let is_asked_for =
        |name: &str| name != "index.html" && !name.ends_with(".css") && !name.ends_with(".LICENSE");
    let contents = |name: &str, contents: &[u8]| match MODULES.contains(&name) {
        true => compressed(contents),
        false => String::from_utf8_lossy(contents).into_owned(),
    };
    let files = parts.0.iter().filter(|(name, _)| is_asked_for(name));
    let files: BTreeMap<&str, String> = files
        .map(|(name, bytes)| (name.as_str(), contents(name, bytes)))
        .collect();
    // Texts: serialisation cannot fail. Sequences that would end the script are escaped.
    serde_json::to_string(&files)
        .unwrap_or_default()
        .replace("</", "<\\/")
        .replace("<!--", "<\\u0021--")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use tempfile::TempDir;

    use super::*;

    /// A folder with files that begin like modules.
    fn with_modules() -> (TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        for name in [MODULE, WORK] {
            fs::write(folder.path().join(name), b"\0asm\x01\0\0\0").unwrap();
        }
        let module = folder.path().join(MODULE);
        (folder, module)
    }

    #[test]
    fn a_folder_has_all_files_of_the_page_and_asks_for_no_other() {
        let (folder, module) = with_modules();
        let out = folder.path().join("lab");
        export_folder(&Start::default(), &module, "notices", &out).unwrap();
        let page = fs::read_to_string(out.join("index.html")).unwrap();
        assert!(
            page.contains("<html data-channel=\"worker\">") && page.contains(POLICY_OF_FOLDER.trim_end())
        );
        assert!(!page.contains("http:") && !page.contains("https:"), "{page}");
        let kept = fs::read_to_string(out.join("service_worker.js")).unwrap();
        for (name, contents) in assets::all() {
            let written = fs::read(out.join(&name)).unwrap();
            assert!(name == "index.html" || written == contents, "{name}");
            assert!(kept.contains(&format!("'{name}'")), "{name}");
        }
        let beginning: serde_json::Value =
            serde_json::from_slice(&fs::read(out.join(BEGINNING)).unwrap()).unwrap();
        assert_eq!(beginning["opening"]["name"], "circle");
        assert!(beginning["presets"].as_array().unwrap().len() > 30);
        assert_eq!(fs::read_to_string(out.join(NOTICES)).unwrap(), "notices");
        for name in [MODULE, WORK] {
            assert!(
                out.join(name).is_file() && kept.contains(&format!("'{name}'")),
                "{name}"
            );
        }
        // The same files give the same bytes and the same cache name in the browser; other files give another
        // name.
        let again = folder.path().join("again");
        export_folder(&Start::default(), &module, "notices", &again).unwrap();
        assert_eq!(kept, fs::read_to_string(again.join("service_worker.js")).unwrap());
        fs::write(&module, b"\0asm\x01\0\0\0\0").unwrap();
        export_folder(&Start::default(), &module, "notices", &again).unwrap();
        assert_ne!(kept, fs::read_to_string(again.join("service_worker.js")).unwrap());
    }

    /// An export that the system stops in between leaves nothing that is in the way of the next.
    #[test]
    fn a_folder_is_whole_or_not_there() {
        let (folder, module) = with_modules();
        let out = folder.path().join("lab");
        // No file has a name of so many letters, as none finds room on a full disk.
        let name = "n".repeat(300);
        let mut files = BTreeMap::from([(MODULE.to_owned(), vec![1]), (name.clone(), vec![2])]);
        for is_there in [false, true] {
            if is_there {
                fs::create_dir(&out).unwrap();
            }
            place(&files, &out).unwrap_err();
            assert_eq!(out.exists(), is_there);
            assert_eq!(
                fs::read_dir(folder.path()).unwrap().count(),
                2 + usize::from(is_there)
            );
        }
        assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
        files.remove(&name);
        place(&files, &out).unwrap();
        fs::create_dir(out.join(".slipfront-0123456789abcdef-AbCdEf")).unwrap();
        export_folder(&Start::default(), &module, "notices", &out).unwrap();
        fs::write(out.join("mine"), "mine").unwrap();
        fs::remove_file(out.join(MODULE)).unwrap();
        let said = export_folder(&Start::default(), &module, "notices", &out).unwrap_err();
        assert!(matches!(said, ExportError::OtherThings(_)), "{said}");
    }

    #[test]
    fn one_file_holds_the_files_that_its_page_asks_for() {
        let (folder, module) = with_modules();
        let out = folder.path().join("lab.html");
        export_single(&Start::default(), &module, "notices", &out).unwrap();
        let page = fs::read_to_string(&out).unwrap();
        assert!(!page.contains("<link rel=\"stylesheet\"") && !page.contains("src=\"m"));
        let (_, within) = page.split_once("id=\"files\">").unwrap();
        let (within, loader) = within.split_once("</script>").unwrap();
        let files: BTreeMap<String, String> = serde_json::from_str(within).unwrap();
        for name in [MODULE, WORK] {
            let packed = BASE64_STANDARD.decode(&files[name]).unwrap();
            let mut module = Vec::new();
            flate2::read::GzDecoder::new(&*packed)
                .read_to_end(&mut module)
                .unwrap();
            assert_eq!(module, b"\0asm\x01\0\0\0", "{name}");
        }
        assert_eq!(files[NOTICES], "notices");
        let asked: BTreeSet<&str> = files.keys().map(String::as_str).collect();
        for name in [
            "main.js",
            "lab_worker.js",
            "en.json",
            "vendor/uPlot.esm.js",
            BEGINNING,
        ] {
            assert!(asked.contains(name), "{name}");
        }
        // The policy allows the script that runs.
        let loader = loader
            .split_once("<script>")
            .unwrap()
            .1
            .split_once("</script>")
            .unwrap()
            .0;
        let hash = BASE64_STANDARD.encode(Sha256::digest(loader));
        assert!(page.contains(&format!("'sha256-{hash}'")));
    }

    #[test]
    fn what_cannot_be_exported_is_refused_with_the_remedy() {
        let (folder, module) = with_modules();
        let said = |result: Result<(), ExportError>| result.unwrap_err().to_string();
        let start = Start::default();
        let other = folder.path().join("other");
        fs::create_dir(&other).unwrap();
        fs::write(other.join("mine"), "mine").unwrap();
        assert!(said(export_folder(&start, &module, "notices", &other)).contains("holds other things"));
        assert_eq!(fs::read_dir(&other).unwrap().count(), 1);
        assert!(
            said(export_single(
                &start,
                &other.join("mine"),
                "notices",
                &other.join("x")
            ))
            .contains("is no module")
        );
        assert!(
            said(export_single(&start, &module, "notices", &other.join("mine")))
                .contains("is no exported laboratory")
        );
        assert_eq!(fs::read_to_string(other.join("mine")).unwrap(), "mine");
        // An exported page is replaced.
        let page = folder.path().join("page.html");
        export_single(&start, &module, "notices", &page).unwrap();
        export_single(&start, &module, "notices", &page).unwrap();
        assert!(said(export_single(&start, &other, "notices", &page)).contains("cannot be read"));
        let missing = find_module(&[other.clone(), folder.path().join("none")]).unwrap_err();
        assert!(
            missing
                .to_string()
                .contains("build it by crates/slipfront-wasm/build.sh"),
            "{missing}"
        );
        assert_eq!(find_module(&[other, folder.path().to_owned()]).unwrap(), module);
        // Both modules are needed.
        fs::remove_file(folder.path().join(WORK)).unwrap();
        let missing = said(export_single(&start, &module, "notices", &page));
        assert!(
            missing.contains("slipfront-work.wasm cannot be read"),
            "{missing}"
        );
    }
}
