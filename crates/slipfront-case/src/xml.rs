//! XML from files that may be damaged or malicious, read piece by piece.

use std::borrow::Cow;
use std::io::BufRead;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use slipfront_base::text::single_line;

/// Largest size of a tag, and of a text between two tags, bytes: a cell of a workbook has 32 767 characters
/// at most.
const PIECE_MAX_BYTES: u64 = 1 << 20;
/// Largest length of a path of elements, bytes.
const PATH_MAX_BYTES: usize = 1 << 12;

/// A piece of XML.
pub enum Piece<'x> {
    /// An element begins.
    Start(Attributes<'x>),
    /// Text directly within an element, which may come in several pieces.
    Text(&'x str),
    /// An element ends.
    End,
}

/// Names and values of the attributes of an element; names are without the prefix of their namespace.
pub struct Attributes<'x>(Vec<(&'x str, Cow<'x, str>)>);

impl<'x> Attributes<'x> {
    fn read(element: &'x BytesStart<'_>) -> Result<Self, quick_xml::Error> {
        let mut found = Vec::new();
        // Names that occur twice are not looked for, since this takes the square of their number.
        for attribute in element.attributes().with_checks(false) {
            let attribute = attribute?;
            if attribute.key.as_namespace_binding().is_none() {
                let name = attribute.key.local_name().into_inner();
                found.push((name, attribute.normalized_value(XmlVersion::Implicit1_0)?));
            }
        }
        Ok(Self(found))
    }

    /// The value of the first attribute of this name.
    pub fn get(&self, name: &str) -> Option<&str> {
        let found = self.0.iter().find(|(of, _)| *of == name);
        found.map(|(_, value)| value.as_ref())
    }
}

/// Reads XML from its beginning to its end. `each` is given the path of the open elements, such as
/// `worksheet/sheetData/row`, whose names are without the prefix of their namespace, and what was read there;
/// memory for what is open is bounded. At most `nodes` elements, texts, comments and attributes are read; it
/// becomes the number that is left. Errors call the file `name`.
///
/// # Errors
/// A sentence if the text is not XML or exceeds a limit, or the one that `each` returns.
pub fn read(
    name: &str,
    source: impl BufRead,
    nodes: &mut usize,
    each: &mut dyn FnMut(&str, Piece<'_>) -> Result<(), String>,
) -> Result<(), String> {
    let no_xml = |why: &str| format!("`{name}` is no XML ({})", single_line(why));
    let refused = |error: quick_xml::Error| no_xml(&error.to_string());
    let mut reader = Reader::from_reader(source.take(PIECE_MAX_BYTES));
    reader.config_mut().expand_empty_elements = true;
    let (mut path, mut buffer, mut has_root) = (String::new(), Vec::new(), false);
    let most = *nodes;
    let mut count = |more: usize| {
        let left = nodes.checked_sub(more);
        *nodes = left.ok_or_else(|| {
            format!("`{name}` has more than the {most} elements, texts and attributes that may still be read")
        })?;
        Ok::<_, String>(())
    };
    loop {
        buffer.clear();
        reader.get_mut().set_limit(PIECE_MAX_BYTES);
        let event = reader.read_event_into(&mut buffer);
        if reader.get_ref().limit() == 0 {
            return Err(format!(
                "`{name}` has a tag or a text of more than {} KiB",
                PIECE_MAX_BYTES >> 10
            ));
        }
        let event = event.map_err(refused)?;
        count(usize::from(!matches!(event, Event::End(_) | Event::Eof)))?;
        match event {
            Event::Start(element) => {
                if !path.is_empty() {
                    path.push('/');
                }
                path.push_str(element.local_name().into_inner());
                if path.len() > PATH_MAX_BYTES {
                    return Err(format!(
                        "`{name}` has elements within each other that are too deep"
                    ));
                }
                has_root = true;
                let attributes = Attributes::read(&element).map_err(refused)?;
                count(attributes.0.len())?;
                each(&path, Piece::Start(attributes))?;
            }
            Event::End(_) => {
                each(&path, Piece::End)?;
                path.truncate(path.rfind('/').unwrap_or(0));
            }
            Event::Text(text) => each(&path, Piece::Text(&text))?,
            Event::CData(text) => each(&path, Piece::Text(&text))?,
            Event::GeneralRef(reference) => {
                let text = format!("&{};", &*reference);
                let text = quick_xml::escape::unescape(&text).map_err(|error| refused(error.into()))?;
                each(&path, Piece::Text(&text))?;
            }
            Event::DocType(_) => return Err(no_xml("it declares a type of document")),
            Event::Eof if !path.is_empty() => return Err(no_xml(&format!("it ends within `{path}`"))),
            Event::Eof if !has_root => return Err(no_xml("it has no element")),
            Event::Eof => return Ok(()),
            Event::Empty(_) | Event::Comment(_) | Event::Decl(_) | Event::PI(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use test_case::test_case;

    use super::*;

    /// All pieces of a text, one a line.
    fn pieces(text: &str) -> Result<String, String> {
        let mut found = String::new();
        read("a.xml", text.as_bytes(), &mut 9, &mut |path, piece| {
            found += &match piece {
                Piece::Start(attributes) => format!("{path} begins {:?}\n", attributes.get("t")),
                Piece::Text(text) => format!("{path} has {text}\n"),
                Piece::End => format!("{path} ends\n"),
            };
            Ok(())
        })?;
        Ok(found)
    }

    /// A namespace called `t` is no attribute `t`.
    #[test]
    fn elements_have_paths_attributes_and_texts() {
        let found = pieces("<x:a xmlns:t='u'><b t='&lt;1'/>2&#51;<![CDATA[<4]]></x:a>").unwrap();
        assert_eq!(
            found,
            "a begins None\na/b begins Some(\"<1\")\na/b ends\na has 2\na has 3\na has <4\na ends\n"
        );
    }

    #[test_case("", "has no element"; "nothing")]
    #[test_case("<a><b></b>", "ends within `a`"; "a file that was cut")]
    #[test_case("<a></b>", "no XML"; "another end")]
    #[test_case("<a b=1/>", "no XML"; "no quotes")]
    #[test_case("<a>&b;</a>", "no XML"; "an unknown entity")]
    #[test_case("<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>", "type of document"; "entities of its own")]
    #[test_case("<a>1<!-- 2 --><b c='3' d='4'/>5<e/><f/><g/></a>", "more than the 9 elements"; "many nodes")]
    #[test_case(&format!("<a>{}</a>", " ".repeat(1 << 20)), "more than 1024 KiB"; "a long text")]
    #[test_case(&format!("<{}>", "a".repeat(1 << 13)), "too deep"; "deep elements")]
    fn what_is_wrong_is_said(text: &str, sentence: &str) {
        let error = pieces(text).unwrap_err();
        assert!(error.contains(sentence), "{error}");
    }
}
