//! XML of files that may be broken or made to break their reader.

use roxmltree::{Document, ParsingOptions};
use slipfront_base::text::single_line;

/// Most namespaces of a document, and most attributes of one of its elements. Height maps and workbooks take
/// some ten.
const NAMES_MAX: usize = 64;

/// Reads XML of at most `nodes_max` nodes: elements, comments and the texts between them. Its file is called
/// `name`.
///
/// # Errors
/// A sentence on what is no XML, or of which there is too much.
pub fn parse<'x>(name: &str, xml: &'x str, nodes_max: u32) -> Result<Document<'x>, String> {
    limit_names(name, xml)?;
    let options = ParsingOptions {
        nodes_limit: nodes_max,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(xml, options)
        .map_err(|error| format!("`{name}` is no XML ({})", single_line(&error.to_string())))
}

/// Refuses XML with many namespaces or attributes: the parser compares each with all others of its element,
/// and each element with all namespaces around it, so that its time would grow with the cube of the length of
/// the text.
///
/// # Errors
/// What there is too much of, with both numbers.
fn limit_names(name: &str, xml: &str) -> Result<(), String> {
    let namespaces = xml.matches("xmlns").count();
    if namespaces > NAMES_MAX {
        return Err(format!(
            "`{name}` declares {namespaces} namespaces, and at most {NAMES_MAX} are read"
        ));
    }
    // No value of an attribute contains a `<`, so that all attributes of an element stand before the next
    // one.
    let begins_value = |after: &&str| after.trim_start().starts_with(['"', '\'']);
    let of_element = |piece: &str| piece.split('=').skip(1).filter(begins_value).count();
    let attributes = xml.split('<').map(of_element).max().unwrap_or(0);
    if attributes > NAMES_MAX {
        return Err(format!(
            "an element of `{name}` has {attributes} attributes, and at most {NAMES_MAX} are read"
        ));
    }
    Ok(())
}
