//! Long inputs: a piece that is repeated where its format allows any number of it.

/// Length of the long inputs, in bytes.
pub const LONG_BYTES: usize = 300_000;

/// A text of [`LONG_BYTES`]: `begin`, then `piece` with numbers from 0 in the places of its `#`, then `end`.
pub(crate) fn many(begin: &str, piece: &str, end: &str) -> Vec<u8> {
    let mut text = begin.to_owned();
    for number in 0.. {
        let next = piece.replace('#', &number.to_string());
        if text.len() + next.len() + end.len() > LONG_BYTES {
            break;
        }
        text += &next;
    }
    (text + end).into_bytes()
}

/// A text of [`LONG_BYTES`]: half of it made of `open`, the other half of `close`, around `inner`.
pub(crate) fn nested(begin: &str, open: &str, inner: &str, close: &str, end: &str) -> Vec<u8> {
    let levels = (LONG_BYTES - begin.len() - inner.len() - end.len()) / (open.len() + close.len());
    [begin, &open.repeat(levels), inner, &close.repeat(levels), end]
        .concat()
        .into_bytes()
}
