//! Lines of a journal, one for each run: `<checksum> <json>`.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// The line of an entry with its line break.
pub(crate) fn to_line(entry: &impl Serialize) -> Vec<u8> {
    // Our own struct of numbers and strings: serialisation cannot fail.
    let json = serde_json::to_string(entry).unwrap_or_default();
    format!("{} {json}\n", checksum(json.as_bytes())).into_bytes()
}

/// An entry that a line of a journal can hold.
pub trait JournalEntry: DeserializeOwned {
    /// Keys, at least one of which is in every entry of this kind in any version of slipfront.
    const KEYS: &'static [&'static str];
}

/// A complete line of a journal.
pub(super) enum Line<T> {
    Entry(T),
    /// An entry of this kind, written by another version of slipfront.
    OfOtherVersion,
    OfOtherKind,
}

/// The line of a journal without its line break; none if it fails its checksum.
pub(super) fn parse_line<T: JournalEntry>(line: &[u8]) -> Option<Line<T>> {
    let (sum, json) = line.split_at_checked(CHECKSUM)?;
    let json = json.strip_prefix(b" ")?;
    if checksum(json).as_bytes() != sum {
        return None;
    }
    if let Ok(entry) = serde_json::from_slice(json) {
        return Some(Line::Entry(entry));
    }
    let keys: Map<String, Value> = serde_json::from_slice(json).unwrap_or_default();
    let is_of_kind = T::KEYS.iter().any(|key| keys.contains_key(*key));
    Some(if is_of_kind {
        Line::OfOtherVersion
    } else {
        Line::OfOtherKind
    })
}

/// Whether a line has the form of an entry, damaged or not. A file without any such line is not a journal.
pub(super) fn looks_like_ours(line: &[u8]) -> bool {
    line.get(CHECKSUM) == Some(&b' ') && line.get(CHECKSUM + 1) == Some(&b'{')
}

/// Whether the last line may be the beginning of an entry: it ends within the checksum, or consists of zeros,
/// as after a power failure.
pub(super) fn may_begin_ours(line: &[u8]) -> bool {
    let (sum, blank) = line.split_at(line.len().min(CHECKSUM));
    let is_beginning = sum.iter().all(u8::is_ascii_hexdigit) && b" ".starts_with(blank);
    is_beginning || line.iter().all(|&byte| byte == 0)
}

/// Number of characters of a checksum.
const CHECKSUM: usize = 16;

fn checksum(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..CHECKSUM].to_owned()
}
