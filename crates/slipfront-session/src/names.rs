//! Files of a case: their largest total size, and names that cannot lead out of a folder.

/// Largest total size of the files of a case, bytes.
pub const MAX_FILES: u64 = 64 << 20;

/// Characters that are valid in file names on every system.
fn is_plain(c: char) -> bool {
    c.is_alphanumeric() || "_-. ()+".contains(c)
}

/// Whether `name` is a name inside a folder, and not a path that may lead out of it.
pub fn is_plain_name(name: &str) -> bool {
    !name.is_empty() && name.len() <= 100 && !name.starts_with('.') && name.chars().all(is_plain)
}

/// Converts the name of a file to a plain one.
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
