//! A drawing as a tree of elements, with limits for files that may be damaged or malicious. Its styles and
//! groups need the elements around each, so that it is not read piece by piece as other XML is.

use roxmltree::{Document, ParsingOptions};
use slipfront_base::text::single_line;

/// Largest number of namespaces of a document, and of attributes of an element. Drawings need
/// about twenty.
const NAMES_MAX: usize = 64;

/// Reads XML with at most `nodes_max` nodes: elements, comments and the texts between them. Errors call the
/// file `name`.
///
/// # Errors
/// A sentence if the text is not XML, or exceeds a limit.
pub(super) fn parse<'x>(name: &str, xml: &'x str, nodes_max: u32) -> Result<Document<'x>, String> {
    limit_names(name, xml)?;
    let options = ParsingOptions {
        nodes_limit: nodes_max,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(xml, options)
        .map_err(|error| format!("`{name}` is no XML ({})", single_line(&error.to_string())))
}

/// Refuses XML with many namespaces or attributes. The parser compares each attribute with all others of its
/// element, and each element with all namespaces around it, so that its time would grow with the cube of the
/// text length.
///
/// # Errors
/// A sentence with the exceeded limit, and both numbers.
fn limit_names(name: &str, xml: &str) -> Result<(), String> {
    let namespaces = xml.matches("xmlns").count();
    if namespaces > NAMES_MAX {
        return Err(format!(
            "`{name}` declares {namespaces} namespaces, and at most {NAMES_MAX} are read"
        ));
    }
    // Attribute values contain no `<`, so all attributes of an element come before the next `<`.
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
