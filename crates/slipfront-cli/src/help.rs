//! The help of the whole command: subcommands, grouped by purpose.

/// Groups of subcommands, each with its heading.
const GROUPS: [(&str, &[&str]); 7] = [
    ("Run a case", &["run", "check", "lab"]),
    ("Pictures", &["plot", "movie"]),
    ("Several runs", &["study", "converge"]),
    ("Design and calibration", &["design", "calibrate"]),
    ("Exchange", &["texture", "export", "verify"]),
    ("Validation", &["family", "paper"]),
    ("About slipfront", &["completions", "man", "licences", "help"]),
];

/// Help on the subcommand that clap adds.
const HELP: &str = "Print this help, or the help of a subcommand";

/// Width of the column of subcommand names.
const NAMES: usize = 12;

/// The template of the help of a command with these subcommands.
///
/// # Panics
/// If a subcommand is in no group, or a group contains an unknown one.
pub(crate) fn template(command: &clap::Command) -> String {
    let about = |name: &str| match command.find_subcommand(name) {
        Some(subcommand) => subcommand.get_about().map(ToString::to_string),
        None => (name == "help").then(|| HELP.to_owned()),
    };
    let row = |name: &&str| {
        let about = about(name).unwrap_or_else(|| panic!("no subcommand {name}"));
        format!("  {name:NAMES$} {about}\n")
    };
    let group = |(heading, names): (&str, &[&str])| {
        format!("{heading}:\n{}\n", names.iter().map(row).collect::<String>())
    };
    let listed = || GROUPS.iter().flat_map(|(_, names)| *names);
    for subcommand in command.get_subcommands() {
        let name = subcommand.get_name();
        assert!(listed().any(|listed| *listed == name), "{name} is in no group");
    }
    let groups: String = GROUPS.into_iter().map(group).collect();
    format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{groups}Options:\n{{options}}{{after-help}}"
    )
}
