//! Outlines as DXF of AutoCAD 2000, the oldest version with ellipses, in millimetres: a layer of its own
//! colour for each texture, and one for the slider.

use std::f64::consts::TAU;

use slipfront::surface::{Contour, Piece};

use super::drawing::OutlineDrawing;
use crate::arrays::SLIDER_LAYER;

/// Handles of the parts of every drawing; entities and layers have handles from [`FIRST_FREE`] up.
const MODEL_SPACE: u64 = 0x1f;
const PAPER_SPACE: u64 = 0x1b;
const FIRST_FREE: u64 = 0x100;
/// The blocks of every drawing.
const SPACES: [(&str, u64); 2] = [("*Model_Space", MODEL_SPACE), ("*Paper_Space", PAPER_SPACE)];

/// The drawing as the text of a file.
pub(super) fn text(drawing: &OutlineDrawing) -> String {
    let mut entities = File::new();
    let outlines = drawing.layers.iter().map(|layer| (&*layer.name, &layer.contours));
    for (layer, contours) in std::iter::once((SLIDER_LAYER, &drawing.slider)).chain(outlines) {
        for contour in contours {
            entities.contour(layer, contour, drawing.block);
        }
    }
    let mut tables = File {
        next_handle: entities.next_handle,
        ..File::new()
    };
    tables.tables(drawing);
    tables.blocks();
    let mut file = File::new();
    file.section("HEADER");
    let next_handle = tables.next_handle;
    file.pairs(&format!("9 $ACADVER 1 AC1015 9 $HANDSEED 5 {next_handle:X}"));
    // Unit millimetre, metric system.
    file.pairs("9 $INSUNITS 70 4 9 $MEASUREMENT 70 1 0 ENDSEC");
    file.text += &tables.text;
    file.section("ENTITIES");
    file.text += &entities.text;
    file.pairs("0 ENDSEC");
    file.section("OBJECTS");
    file.pairs("0 DICTIONARY 5 C 330 0 100 AcDbDictionary 281 1 3 ACAD_GROUP 350 D");
    file.pairs("0 DICTIONARY 5 D 330 C 100 AcDbDictionary 281 1 0 ENDSEC 0 EOF");
    file.text
}

/// Text of a part of the file.
struct File {
    text: String,
    next_handle: u64,
}

impl File {
    fn new() -> Self {
        Self {
            text: String::new(),
            next_handle: FIRST_FREE,
        }
    }

    /// Adds codes and their values, each on a line of its own. They have blanks between them, and an empty
    /// value is written `""`.
    fn pairs(&mut self, pairs: &str) {
        for word in pairs.split(' ') {
            self.text += word.trim_matches('"');
            self.text.push('\n');
        }
    }

    fn section(&mut self, name: &str) {
        self.pairs(&format!("0 SECTION 2 {name}"));
    }

    fn handle(&mut self) -> u64 {
        self.next_handle += 1;
        self.next_handle - 1
    }

    /// Begins an entity of this kind and class, which belongs to the space `owner`.
    fn entity(&mut self, kind: &str, class: &str, owner: u64, layer: &str) {
        let handle = self.handle();
        self.pairs(&format!(
            "0 {kind} 5 {handle:X} 330 {owner:X} 100 AcDbEntity 8 {layer} 100 {class}"
        ));
    }

    /// A closed line. `block` is the length of a block, the unit of its coordinates.
    fn contour(&mut self, layer: &str, contour: &Contour, block: f64) {
        let Contour::Ellipse(ellipse) = contour else {
            return self.polyline(layer, &contour.pieces(), block);
        };
        let [x, y] = ellipse.center.map(|length| length * block);
        let [a, b] = ellipse.semi_axes.map(|length| length * block);
        if a == b {
            self.entity("CIRCLE", "AcDbCircle", MODEL_SPACE, layer);
            return self.pairs(&format!("10 {x} 20 {y} 30 0 40 {a}"));
        }
        let [c, s] = ellipse.axis;
        self.entity("ELLIPSE", "AcDbEllipse", MODEL_SPACE, layer);
        // DXF requires the longer axis first.
        let ([major_x, major_y], ratio) = if a > b {
            ([a * c, a * s], b / a)
        } else {
            ([-b * s, b * c], a / b)
        };
        self.pairs(&format!(
            "10 {x} 20 {y} 30 0 11 {major_x} 21 {major_y} 31 0 40 {ratio} 41 0 42 {TAU}"
        ));
    }

    /// A closed line of line segments and circular arcs: an arc of angle `t` has the bulge `tan(t/4)`.
    fn polyline(&mut self, layer: &str, pieces: &[Piece], block: f64) {
        self.entity("LWPOLYLINE", "AcDbPolyline", MODEL_SPACE, layer);
        // The flag 1 closes the line.
        self.pairs(&format!("90 {} 70 1", pieces.len()));
        for piece in pieces {
            let [x, y] = piece.ends()[0].map(|length| length * block);
            self.pairs(&format!("10 {x} 20 {y}"));
            if let Piece::Arc(_, [from, to]) = piece {
                self.pairs(&format!("42 {}", libm::tan(0.25 * (to - from))));
            }
        }
    }

    /// The required tables of a drawing, and its layers.
    fn tables(&mut self, drawing: &OutlineDrawing) {
        self.section("TABLES");
        self.table("VPORT", "8", "", &[]);
        let line_types = ["ByBlock", "ByLayer", "Continuous"];
        let line_types = line_types.map(|name| format!("2 {name} 70 0 3 \"\" 72 65 73 0 40 0"));
        self.table("LTYPE", "5", "AcDbLinetypeTableRecord", &line_types);
        // 7 is black on white, and white on black.
        let of_textures = drawing.layers.iter().map(|layer| (&*layer.name, layer.color().1));
        let layers = [("0", 7), (SLIDER_LAYER, 7)].into_iter().chain(of_textures);
        let layers = layers.map(|(name, color)| format!("2 {name} 70 0 62 {color} 6 Continuous"));
        self.table("LAYER", "2", "AcDbLayerTableRecord", &layers.collect::<Vec<_>>());
        let style = "2 Standard 70 0 40 0 41 1 50 0 71 0 42 1 3 txt 4 \"\"".to_owned();
        self.table("STYLE", "3", "AcDbTextStyleTableRecord", &[style]);
        self.table("VIEW", "6", "", &[]);
        self.table("UCS", "7", "", &[]);
        self.table("APPID", "9", "AcDbRegAppTableRecord", &["2 ACAD 70 0".to_owned()]);
        self.pairs("0 TABLE 2 DIMSTYLE 5 A 330 0 100 AcDbSymbolTable 70 0");
        self.pairs("100 AcDbDimStyleTable 71 0 0 ENDTAB");
        self.pairs("0 TABLE 2 BLOCK_RECORD 5 1 330 0 100 AcDbSymbolTable 70 2");
        for (name, handle) in SPACES {
            self.pairs(&format!(
                "0 BLOCK_RECORD 5 {handle:X} 330 1 100 AcDbSymbolTableRecord"
            ));
            self.pairs(&format!("100 AcDbBlockTableRecord 2 {name}"));
        }
        self.pairs("0 ENDTAB 0 ENDSEC");
    }

    /// The required blocks of a drawing.
    fn blocks(&mut self) {
        self.section("BLOCKS");
        for (name, owner) in SPACES {
            self.entity("BLOCK", "AcDbBlockBegin", owner, "0");
            self.pairs(&format!("2 {name} 70 0 10 0 20 0 30 0 3 {name} 1 \"\""));
            self.entity("ENDBLK", "AcDbBlockEnd", owner, "0");
        }
        self.pairs("0 ENDSEC");
    }

    /// A table of records of a class, each with the pairs of its name and the rest.
    fn table(&mut self, name: &str, handle: &str, class: &str, records: &[String]) {
        let count = records.len();
        self.pairs(&format!(
            "0 TABLE 2 {name} 5 {handle} 330 0 100 AcDbSymbolTable 70 {count}"
        ));
        for record in records {
            let own = self.handle();
            self.pairs(&format!(
                "0 {name} 5 {own:X} 330 {handle} 100 AcDbSymbolTableRecord 100 {class} {record}"
            ));
        }
        self.pairs("0 ENDTAB");
    }
}
