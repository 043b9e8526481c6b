//! The files of a case: how much of them there may be, and names that lead nowhere else.

/// Most bytes of all files of a case.
pub const MAX_FILES: u64 = 64 << 20;

/// Characters that stand for themselves in names of files on every system.
fn is_plain(c: char) -> bool {
    c.is_alphanumeric() || "_-. ()+".contains(c)
}

/// Tells whether `name` is a name within a folder, and not a path that may lead out of the folder.
pub fn is_plain_name(name: &str) -> bool {
    !name.is_empty() && name.len() <= 100 && !name.starts_with('.') && name.chars().all(is_plain)
}

/// The name of a file as a plain one.
pub(crate) fn plain_name(path: &str) -> String {
    let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let name = name.trim_start_matches('.').chars();
    name.map(|c| if is_plain(c) { c } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_within_their_folder() {
        for path in ["a/../b.png", "..\\b.png", "/b.png", "b.png", ".b.png"] {
            assert_eq!(plain_name(path), "b.png", "{path}");
        }
        assert_eq!(plain_name("C:b*.png"), "C_b_.png");
        assert!(is_plain_name("run (2)") && is_plain_name("M\u{fc}nchen-1.0"));
        for name in ["", ".", "..", "a/b", "a\\b", "C:b", ".hidden", "a\nb"] {
            assert!(!is_plain_name(name), "{name:?}");
        }
    }
}
