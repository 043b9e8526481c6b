//! The page of the command line lists every subcommand and option, like help and manual pages.

use std::path::Path;

use clap::{Arg, Command};

use crate::reference_page::expect_page;

/// Beginning of the generated part of the page.
const BEGINNING: &str = "\n## ";

#[test]
fn the_page_of_the_command_line_has_every_option() {
    let mut all = slipfront_cli::command_line();
    all.build();
    expect_page("command-line.md", |page| {
        let introduction = page.split(BEGINNING).next().unwrap();
        let commands: String = all.get_subcommands().map(|command| section(command, 2)).collect();
        format!("{introduction}{commands}")
    });
}

/// The files that the examples of the help name are in the repository.
#[test]
fn the_help_names_files_that_exist() {
    fn examples(command: &Command) -> String {
        let own = command
            .get_after_help()
            .map_or(String::new(), ToString::to_string);
        command
            .get_subcommands()
            .map(examples)
            .fold(own, |all, below| all + "\n" + &below)
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let all = examples(&slipfront_cli::command_line());
    let named: Vec<&str> = all
        .split_whitespace()
        .filter(|word| word.starts_with("cases/"))
        .collect();
    assert!(named.len() > 20, "{named:?}");
    for name in named {
        assert!(root.join(name).is_file(), "{name}");
    }
}

/// The section of a subcommand, followed by the sections of its own subcommands.
fn section(command: &Command, level: usize) -> String {
    if command.get_name() == "help" {
        return String::new();
    }
    let name = command.get_bin_name().unwrap();
    let about = command.get_long_about().or(command.get_about()).unwrap();
    let usage = command.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ").replace("\n       ", "\n");
    let help = command
        .get_after_help()
        .map_or(String::new(), ToString::to_string);
    let (help, _) = help.split_once("Exit status").unwrap_or((&help, ""));
    let help = match help.trim() {
        "" => String::new(),
        help => format!("\n```text\n{help}\n```\n"),
    };
    let options: String = command
        .get_arguments()
        .filter(|arg| !arg.is_hide_set())
        .map(row)
        .collect();
    let options = match options.as_str() {
        "" => String::new(),
        rows => format!("\n| option | meaning |\n|---|---|\n{rows}"),
    };
    let heading = "#".repeat(level);
    let below: String = command
        .get_subcommands()
        .map(|command| section(command, level + 1))
        .collect();
    format!("\n{heading} `{name}`\n\n{about}.\n\n```text\n{usage}\n```\n{options}{help}{below}")
}

/// The row of an option or operand.
fn row(arg: &Arg) -> String {
    if ["help", "version"].contains(&arg.get_id().as_str()) {
        return String::new();
    }
    let value = arg.get_value_names().unwrap_or_default().join(" ");
    let takes_value = arg.get_action().takes_values() && !arg.is_positional();
    let value_of = |name: String| {
        if takes_value {
            format!("`{name} {value}`")
        } else {
            format!("`{name}`")
        }
    };
    let names = match (arg.get_short(), arg.get_long()) {
        (Some(short), Some(long)) => format!("`-{short}`, {}", value_of(format!("--{long}"))),
        (Some(short), None) => value_of(format!("-{short}")),
        (None, Some(long)) => value_of(format!("--{long}")),
        (None, None) => format!("`{value}`"),
    };
    let help = arg
        .get_long_help()
        .or(arg.get_help())
        .map_or(String::new(), ToString::to_string);
    let listed = |words: Vec<String>| {
        words
            .iter()
            .map(|word| format!("`{word}`"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let values = arg
        .get_possible_values()
        .iter()
        .map(|value| value.get_name().to_owned())
        .collect::<Vec<_>>();
    let values = match values.as_slice() {
        _ if !arg.get_action().takes_values() => String::new(),
        [] => String::new(),
        _ => format!("; {}", listed(values)),
    };
    let defaults: Vec<String> = arg
        .get_default_values()
        .iter()
        .map(|value| value.to_string_lossy().into_owned())
        .collect();
    let default = match defaults.as_slice() {
        _ if !arg.get_action().takes_values() => String::new(),
        [] => String::new(),
        _ => format!(" [default: {}]", listed(defaults)),
    };
    let meaning = format!("{help}{values}{default}")
        .replace('\n', " ")
        .replace('|', "\\|")
        .replace('<', "\\<");
    format!("| {names} | {meaning} |\n")
}
