//! Durations in printed form.

use std::time::Duration;

use indicatif::HumanDuration;

/// Duration of a computation, by its bounds in s.
pub(super) fn duration([least, most]: [f64; 2]) -> String {
    if most.is_infinite() {
        return match least {
            least if least < 1.0 => "at least a fraction of a second".to_owned(),
            least => format!("at least {}", rounded(least)),
        };
    }
    if most < 1.0 {
        return "less than a second".to_owned();
    }
    let [least, most] = [least, most].map(rounded);
    if least == most {
        return format!("about {most}");
    }
    let unit = |text: &str| {
        text.split_once(' ')
            .map(|(_, unit)| unit.trim_end_matches('s').to_owned())
    };
    let least = match least.split_once(' ') {
        Some((number, _)) if unit(&least) == unit(&most) => number,
        _ => &least,
    };
    format!("{least} to {most}")
}

/// Seconds in the largest unit that is not too coarse.
fn rounded(seconds: f64) -> String {
    HumanDuration(Duration::from_secs_f64(seconds.clamp(1.0, 1e15))).to_string()
}
