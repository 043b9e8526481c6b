//! The font of a PDF: the letters of the picture as glyphs, with their widths and the characters that they
//! represent, so that the text can be searched and copied.

use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish as _, Name, Pdf, Rect, Ref, Str};

use crate::canvas::{Canvas, Primitive};
use crate::font::UNITS_PER_EM;
use crate::text::CAP_HEIGHT;
use crate::truetype::{ASCENT, DESCENT, font_of, units};

/// Thousandths of the font size in a unit of the font.
const THOUSANDTHS: f32 = 1000.0 / UNITS_PER_EM;

/// Letters of a picture in the order of their codes: glyph 1 is the first of them.
pub(crate) struct PdfFont {
    letters: Vec<char>,
}

/// The objects of a font in a file.
pub(crate) struct FontObjects {
    /// The font that pages name.
    pub(crate) font: Ref,
    /// Parts of the font.
    pub(crate) glyphs: Ref,
    pub(crate) descriptor: Ref,
    pub(crate) file: Ref,
    pub(crate) characters: Ref,
}

impl PdfFont {
    /// The font of all texts of a canvas.
    pub(crate) fn new(canvas: &Canvas) -> Self {
        let texts = canvas
            .elements
            .iter()
            .filter_map(|element| match &element.primitive {
                Primitive::Letters(letters) => Some(letters.text.chars()),
                _ => None,
            });
        let mut letters: Vec<char> = texts.flatten().collect();
        letters.sort_unstable();
        letters.dedup();
        Self { letters }
    }

    /// Numbers of the glyphs of a text, two bytes each.
    pub(crate) fn encoded(&self, text: &str) -> Vec<u8> {
        let glyph = |letter| self.letters.binary_search(&letter).map_or(0, |index| index + 1);
        text.chars()
            .flat_map(|letter| (glyph(letter) as u16).to_be_bytes())
            .collect()
    }

    /// Name of the font. A font subset has a prefix of six capital letters before its name, which is the same
    /// for equal subsets.
    fn name(&self) -> String {
        let hash = |hash: u32, letter: &char| hash.wrapping_mul(31).wrapping_add(u32::from(*letter));
        let mut rest = self.letters.iter().fold(7, hash);
        let mut tag = String::new();
        for _ in 0..6 {
            tag.push(char::from(b'A' + (rest % 26) as u8));
            rest /= 26;
        }
        tag + "+DejaVuSans"
    }

    /// Writes the font to a file; `packed` compresses the contents of a stream.
    pub(crate) fn write(&self, pdf: &mut Pdf, at: &FontObjects, packed: impl Fn(&[u8]) -> Vec<u8>) {
        let name = self.name();
        let name = Name(name.as_bytes());
        let system = SystemInfo {
            registry: Str(b"Adobe"),
            ordering: Str(b"Identity"),
            supplement: 0,
        };
        pdf.type0_font(at.font)
            .base_font(name)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(at.glyphs)
            .to_unicode(at.characters);
        let mut glyphs = pdf.cid_font(at.glyphs);
        glyphs
            .subtype(CidFontType::Type2)
            .base_font(name)
            .system_info(system)
            .font_descriptor(at.descriptor)
            .cid_to_gid_map_predefined(Name(b"Identity"));
        let widths = self
            .letters
            .iter()
            .map(|&letter| units(letter) as f32 * THOUSANDTHS);
        glyphs.widths().consecutive(1, widths);
        glyphs.finish();
        let [descent, ascent] = [DESCENT, ASCENT].map(|units| f32::from(units) * THOUSANDTHS);
        pdf.font_descriptor(at.descriptor)
            .name(name)
            // The font has its own character codes.
            .flags(FontFlags::SYMBOLIC)
            .bbox(Rect::new(-1000.0, descent, 2000.0, ascent))
            .italic_angle(0.0)
            .ascent(ascent)
            .descent(descent)
            .cap_height(1000.0 * CAP_HEIGHT as f32)
            .stem_v(80.0)
            .font_file2(at.file);
        let file = font_of(&self.letters);
        pdf.stream(at.file, &packed(&file))
            .filter(Filter::FlateDecode)
            .pair(Name(b"Length1"), file.len() as i32);
        let mut characters = UnicodeCmap::new(Name(b"Characters"), system);
        for (index, &letter) in self.letters.iter().enumerate() {
            characters.pair(index as u16 + 1, letter);
        }
        let characters = characters.finish();
        pdf.stream(at.characters, &packed(characters.as_slice()))
            .filter(Filter::FlateDecode);
    }
}
