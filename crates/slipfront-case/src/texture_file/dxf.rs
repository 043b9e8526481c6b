//! Outlines as DXF of AutoCAD 2000, the oldest version with ellipses, in millimetres: a layer of its own
//! colour for each texture, and one for the slider.

use std::f64::consts::TAU;
use std::fmt::Display;

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
    let layers: Vec<(&str, u16)> = drawing
        .layers
        .iter()
        .map(|layer| (layer.name.as_str(), layer.color().1))
        .collect();
    let mut entities = File::new();
    let outlines = drawing
        .layers
        .iter()
        .map(|layer| (layer.name.as_str(), &layer.contours));
    for (layer, contours) in std::iter::once((SLIDER_LAYER, &drawing.slider)).chain(outlines) {
        for contour in contours {
            entities.contour(layer, contour, drawing.block);
        }
    }
    let mut tables = File {
        next_handle: entities.next_handle,
        ..File::new()
    };
    tables.tables(&layers);
    tables.blocks();
    let mut file = File::new();
    file.section("HEADER");
    file.pairs(&[
        (9, &"$ACADVER"),
        (1, &"AC1015"),
        (9, &"$HANDSEED"),
        (5, &hex(tables.next_handle)),
    ]);
    // Unit millimetre, metric system.
    file.pairs(&[
        (9, &"$INSUNITS"),
        (70, &4),
        (9, &"$MEASUREMENT"),
        (70, &1),
        (0, &"ENDSEC"),
    ]);
    file.text += &tables.text;
    file.section("ENTITIES");
    file.text += &entities.text;
    file.pairs(&[(0, &"ENDSEC")]);
    file.section("OBJECTS");
    file.pairs(&[
        (0, &"DICTIONARY"),
        (5, &"C"),
        (330, &0),
        (100, &"AcDbDictionary"),
        (281, &1),
        (3, &"ACAD_GROUP"),
        (350, &"D"),
    ]);
    file.pairs(&[
        (0, &"DICTIONARY"),
        (5, &"D"),
        (330, &"C"),
        (100, &"AcDbDictionary"),
        (281, &1),
    ]);
    file.pairs(&[(0, &"ENDSEC"), (0, &"EOF")]);
    file.text
}

/// A code, and its value.
type GroupPair<'a> = (u16, &'a dyn Display);
/// The class of a record, its name, and its pairs.
type TableRecord<'a> = (&'a str, &'a str, &'a [GroupPair<'a>]);

fn hex(handle: u64) -> String {
    format!("{handle:X}")
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

    /// Adds the lines of each code and its value.
    fn pairs(&mut self, pairs: &[GroupPair]) {
        for (code, value) in pairs {
            self.text += &format!("{code}\n{value}\n");
        }
    }

    fn section(&mut self, name: &str) {
        self.pairs(&[(0, &"SECTION"), (2, &name)]);
    }

    fn handle(&mut self) -> String {
        self.next_handle += 1;
        hex(self.next_handle - 1)
    }

    /// Begins an entity of this kind and class, which belongs to the space `owner`.
    fn entity(&mut self, kind: &str, class: &str, owner: u64, layer: &str) {
        let handle = self.handle();
        self.pairs(&[
            (0, &kind),
            (5, &handle),
            (330, &hex(owner)),
            (100, &"AcDbEntity"),
            (8, &layer),
            (100, &class),
        ]);
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
            return self.pairs(&[(10, &x), (20, &y), (30, &0), (40, &a)]);
        }
        let [c, s] = ellipse.axis;
        self.entity("ELLIPSE", "AcDbEllipse", MODEL_SPACE, layer);
        // DXF requires the longer axis first.
        let (major, ratio) = if a > b {
            ([a * c, a * s], b / a)
        } else {
            ([-b * s, b * c], a / b)
        };
        self.pairs(&[
            (10, &x),
            (20, &y),
            (30, &0),
            (11, &major[0]),
            (21, &major[1]),
            (31, &0),
        ]);
        self.pairs(&[(40, &ratio), (41, &0), (42, &TAU)]);
    }

    /// A closed line of line segments and circular arcs: an arc of angle `t` has the bulge `tan(t/4)`.
    fn polyline(&mut self, layer: &str, pieces: &[Piece], block: f64) {
        self.entity("LWPOLYLINE", "AcDbPolyline", MODEL_SPACE, layer);
        // The flag 1 closes the line.
        self.pairs(&[(90, &pieces.len()), (70, &1)]);
        for piece in pieces {
            let [x, y] = piece.ends()[0].map(|length| length * block);
            self.pairs(&[(10, &x), (20, &y)]);
            if let Piece::Arc(_, [from, to]) = piece {
                self.pairs(&[(42, &libm::tan(0.25 * (to - from)))]);
            }
        }
    }

    /// The required tables of a drawing, and its layers.
    fn tables(&mut self, layers: &[(&str, u16)]) {
        self.section("TABLES");
        self.table("VPORT", "8", &[]);
        let line_types = ["ByBlock", "ByLayer", "Continuous"];
        let solid: &[GroupPair] = &[(70, &0), (3, &""), (72, &65), (73, &0), (40, &0)];
        self.table(
            "LTYPE",
            "5",
            &line_types.map(|name| ("AcDbLinetypeTableRecord", name, solid)),
        );
        // 7 is black on white, and white on black.
        let layers = [&[("0", 7), (SLIDER_LAYER, 7)], layers].concat();
        let pairs: Vec<[GroupPair; 3]> = layers
            .iter()
            .map(|(_, color)| -> [GroupPair; 3] { [(70, &0), (62, color), (6, &"Continuous")] })
            .collect();
        let records = layers.iter().zip(&pairs);
        let records: Vec<TableRecord> = records
            .map(|((name, _), pairs)| ("AcDbLayerTableRecord", *name, &pairs[..]))
            .collect();
        self.table("LAYER", "2", &records);
        let style: &[GroupPair] = &[
            (70, &0),
            (40, &0),
            (41, &1),
            (50, &0),
            (71, &0),
            (42, &1),
            (3, &"txt"),
            (4, &""),
        ];
        self.table("STYLE", "3", &[("AcDbTextStyleTableRecord", "Standard", style)]);
        self.table("VIEW", "6", &[]);
        self.table("UCS", "7", &[]);
        self.table("APPID", "9", &[("AcDbRegAppTableRecord", "ACAD", &[(70, &0)])]);
        self.pairs(&[
            (0, &"TABLE"),
            (2, &"DIMSTYLE"),
            (5, &"A"),
            (330, &0),
            (100, &"AcDbSymbolTable"),
            (70, &0),
        ]);
        self.pairs(&[(100, &"AcDbDimStyleTable"), (71, &0), (0, &"ENDTAB")]);
        self.pairs(&[
            (0, &"TABLE"),
            (2, &"BLOCK_RECORD"),
            (5, &"1"),
            (330, &0),
            (100, &"AcDbSymbolTable"),
            (70, &2),
        ]);
        for (name, handle) in SPACES {
            self.pairs(&[
                (0, &"BLOCK_RECORD"),
                (5, &hex(handle)),
                (330, &1),
                (100, &"AcDbSymbolTableRecord"),
            ]);
            self.pairs(&[(100, &"AcDbBlockTableRecord"), (2, &name)]);
        }
        self.pairs(&[(0, &"ENDTAB"), (0, &"ENDSEC")]);
    }

    /// The required blocks of a drawing.
    fn blocks(&mut self) {
        self.section("BLOCKS");
        for (name, owner) in SPACES {
            for (kind, class) in [("BLOCK", "AcDbBlockBegin"), ("ENDBLK", "AcDbBlockEnd")] {
                self.entity(kind, class, owner, "0");
                if kind == "BLOCK" {
                    self.pairs(&[
                        (2, &name),
                        (70, &0),
                        (10, &0),
                        (20, &0),
                        (30, &0),
                        (3, &name),
                        (1, &""),
                    ]);
                }
            }
        }
        self.pairs(&[(0, &"ENDSEC")]);
    }

    /// A table of records, each with a class, a name and pairs.
    fn table(&mut self, name: &str, handle: &str, records: &[TableRecord]) {
        self.pairs(&[
            (0, &"TABLE"),
            (2, &name),
            (5, &handle),
            (330, &0),
            (100, &"AcDbSymbolTable"),
            (70, &records.len()),
        ]);
        for (class, record, rest) in records {
            let own = self.handle();
            self.pairs(&[
                (0, &name),
                (5, &own),
                (330, &handle),
                (100, &"AcDbSymbolTableRecord"),
                (100, class),
                (2, record),
            ]);
            self.pairs(rest);
        }
        self.pairs(&[(0, &"ENDTAB")]);
    }
}
