//! The browser of the user, according to the desktop, and whether it can show a file that only the user can
//! read.

use std::env;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Reason why the browser would not show a private temporary file, as a clause; none if no reason is known.
pub(crate) fn hindrance() -> Option<String> {
    if !cfg!(target_os = "linux") {
        return None;
    }
    let (pages, addresses) = (
        default_program("text/html"),
        default_program("x-scheme-handler/http"),
    );
    if let (Some(pages), Some(addresses)) = (&pages, &addresses)
        && pages != addresses
    {
        return Some(format!(
            "{pages} opens HTML files on this system, but the browser is {addresses}"
        ));
    }
    let named = env::var("BROWSER").unwrap_or_default();
    let entry = pages.and_then(|name| command_of(&name)).unwrap_or_default();
    let sandboxed = named.split(':').chain([&*entry]).find(|line| is_sandboxed(line));
    sandboxed.map(|line| {
        format!("the browser `{line}` is a snap or a Flatpak, which sees no temporary files but its own")
    })
}

/// Name of the desktop entry of the default program for a MIME type.
fn default_program(kind: &str) -> Option<String> {
    let mut query = Command::new("xdg-mime");
    query.args(["query", "default", kind]);
    let output = query.stdin(Stdio::null()).output().ok()?;
    let name = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (!name.is_empty()).then_some(name)
}

/// The command line of a desktop entry.
fn command_of(name: &str) -> Option<String> {
    let own = env::home_dir().map(|home| home.join(".local/share"));
    let own = env::var_os("XDG_DATA_HOME").map(PathBuf::from).or(own);
    let others = env::var_os("XDG_DATA_DIRS").unwrap_or_else(|| "/usr/local/share:/usr/share".into());
    let mut folders = own.into_iter().chain(env::split_paths(&others));
    let text = folders.find_map(|folder| fs::read_to_string(folder.join("applications").join(name)).ok())?;
    let line = text.lines().find_map(|line| line.strip_prefix("Exec="))?;
    Some(line.to_owned())
}

/// Whether a command line starts a program in a sandbox, judged by its words, by the targets of links, or by
/// the text of a script.
fn is_sandboxed(line: &str) -> bool {
    let tells = |text: &str| {
        ["/snap/", "/bin/snap", "flatpak"]
            .iter()
            .any(|sign| text.contains(sign))
    };
    let program_tells = |word| {
        find(word).is_some_and(|path| {
            let link = path.canonicalize().unwrap_or_default();
            tells(&path.to_string_lossy()) || tells(&link.to_string_lossy()) || tells(&script(&path))
        })
    };
    tells(line) || line.split_whitespace().any(program_tells)
}

/// Path of a program.
fn find(program: &str) -> Option<PathBuf> {
    let path = env::var_os("PATH").unwrap_or_default();
    // `join` keeps an absolute path unchanged.
    let mut candidates = env::split_paths(&path).map(|folder| folder.join(program));
    candidates.find(|candidate| candidate.is_file())
}

/// Beginning of a script; empty if the file is not a script.
fn script(path: &Path) -> String {
    let mut start = Vec::new();
    let read = File::open(path).and_then(|file| file.take(4096).read_to_end(&mut start));
    match read {
        Ok(_) if start.starts_with(b"#!") => String::from_utf8_lossy(&start).into_owned(),
        _ => String::new(),
    }
}
