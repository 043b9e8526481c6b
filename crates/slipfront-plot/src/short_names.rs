//! Shortening of names: common parts are cut, and differences are kept.

use crate::text::Text;

/// Method of cutting a name.
type Cut = fn(&[char], usize) -> String;

/// Cuts that keep a number of characters of a name, from its start, its end, or both.
const CUTS: [Cut; 3] = [
    |name, kept| text(&name[..kept]).trim_end().to_owned() + "\u{2026}",
    |name, kept| "\u{2026}".to_owned() + text(&name[name.len() - kept..]).trim_start(),
    |name, kept| {
        let (start, end) = (kept.div_ceil(2), name.len() - kept / 2);
        text(&name[..start]) + "\u{2026}" + &text(&name[end..])
    },
];

fn text(letters: &[char]) -> String {
    letters.iter().collect()
}

/// Names cut to at most the width `room`. Different names remain different; if that is impossible, they are
/// numbered.
pub(crate) fn fitted_names(names: &[&str], size: u32, room: f64) -> Vec<Text> {
    let whole: Vec<Vec<char>> = names.iter().map(|name| name.chars().collect()).collect();
    // The names without their common start.
    let start = common(&whole);
    let rest = whole.iter().map(|name| name[start.min(name.len())..].to_vec());
    let rest: Vec<Vec<char>> = rest.collect();
    let ways = CUTS
        .iter()
        .map(|&cut| (&whole, "", cut))
        .chain([(&rest, "\u{2026}", CUTS[0])]);
    for (cut_from, before, cut) in ways {
        let cuts = whole.iter().zip(cut_from);
        let written = cuts.map(|(name, from)| shortened(name, from, before, cut, size, room));
        let written: Vec<String> = written.collect();
        let differ = |a: usize, b: usize| names[a] == names[b] || written[a] != written[b];
        if (0..names.len()).all(|a| (0..a).all(|b| differ(a, b))) {
            return written.iter().map(|name| Text::plain(name, size)).collect();
        }
    }
    let numbered =
        |(index, name): (usize, &&str)| Text::shortened(&format!("{}: {name}", index + 1), size, room);
    names.iter().enumerate().map(numbered).collect()
}

/// The name if it fits, or else `before` and as much of the part `from` of the name as fits.
fn shortened(name: &[char], from: &[char], before: &str, cut: Cut, size: u32, room: f64) -> String {
    let fits = |name: &str| Text::plain(name, size).width() <= room;
    let name = text(name);
    if fits(&name) {
        return name;
    }
    let mut cuts = (1..from.len())
        .rev()
        .map(|kept| before.to_owned() + &cut(from, kept));
    cuts.find(|cut| fits(cut)).unwrap_or_default()
}

/// The folder that all names begin with, with its slash, and the names without it. A folder that is a
/// complete name does not count, and a single name has no common folder.
pub(crate) fn without_common_folder<'n>(names: &[&'n str]) -> (&'n str, Vec<&'n str>) {
    let letters: Vec<Vec<char>> = names.iter().map(|name| name.chars().collect()).collect();
    let Some(first) = names.first().filter(|_| names.len() > 1) else {
        return ("", names.to_vec());
    };
    let shared: usize = first.chars().take(common(&letters)).map(char::len_utf8).sum();
    let folder = first[..shared].rfind('/').map_or(0, |slash| slash + 1);
    if names.iter().any(|name| name.len() == folder) {
        return ("", names.to_vec());
    }
    (
        &first[..folder],
        names.iter().map(|name| &name[folder..]).collect(),
    )
}

/// Number of characters with which all names start.
fn common(names: &[Vec<char>]) -> usize {
    let Some((first, others)) = names.split_first() else {
        return 0;
    };
    let is_common = |&at: &usize| others.iter().all(|name| name.get(at) == first.get(at));
    (0..first.len()).take_while(is_common).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(names: &[&str], room: f64) -> Vec<String> {
        let texts = fitted_names(names, 30, room);
        assert!(texts.iter().all(|text| text.width() <= room), "{names:?}");
        let letters = |text: Text| text.runs.into_iter().map(|run| run.text).collect();
        texts.into_iter().map(letters).collect()
    }

    #[test]
    fn names_stay_whole_where_there_is_room() {
        assert_eq!(fitted(&["slow", "fast"], 400.0), ["slow", "fast"]);
    }

    #[test]
    fn names_are_cut_where_they_are_alike() {
        let speeds = ["results/a_rather_long_name_0.1", "results/a_rather_long_name_0.2"];
        let cut = fitted(&speeds, 250.0);
        assert!(
            cut[0].starts_with('\u{2026}') && cut[0].ends_with("name_0.1"),
            "{cut:?}"
        );
        let folders = ["slow/results_of_a_long_run", "fast/results_of_a_long_run"];
        let cut = fitted(&folders, 250.0);
        assert!(
            cut[0].starts_with("slow/res") && cut[0].ends_with('\u{2026}'),
            "{cut:?}"
        );
        let middle = [
            "results_of_a_study/circle/run_with_everything",
            "results_of_a_study/groove/run_with_everything",
        ];
        let cut = fitted(&middle, 250.0);
        assert!(cut[0].contains("circle") && cut[1].contains("groove"), "{cut:?}");
    }

    #[test]
    fn a_common_folder_is_named_once() {
        let names = ["results/steel/a", "results/steel/b1"];
        assert_eq!(without_common_folder(&names), ("results/steel/", vec!["a", "b1"]));
        for apart in [
            &["a", "b"][..],
            &["results/a"],
            &["results/", "results/a"],
            &["/a", "b"],
            &[],
        ] {
            assert_eq!(without_common_folder(apart), ("", apart.to_vec()));
        }
        // A run that is given twice keeps its name.
        assert_eq!(without_common_folder(&["r/a", "r/a"]).1, ["a", "a"]);
    }

    #[test]
    fn names_that_differ_nowhere_in_sight_are_numbered() {
        let [a, b] = ["x", "y"].map(|letter| format!("{0}{letter}{0}b{0}", "a".repeat(40)));
        let c = format!("c{a}");
        let cut = fitted(&[&a, &b, &c], 200.0);
        assert!(cut[0].starts_with("1: ") && cut[2].starts_with("3: "), "{cut:?}");
        // Two equal names cannot be distinguished.
        assert_eq!(fitted(&[&a, &a], 200.0)[0], fitted(&[&a, &a], 200.0)[1]);
    }
}
