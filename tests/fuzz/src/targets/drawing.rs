//! Outlines of drawings.

use std::path::Path;

use slipfront_case::arrays;

use crate::checks::readable;
use crate::long::{many, nested};
use crate::target::{Memory, Target, Time};

/// Most corners of a drawing.
const MAX_CORNERS: usize = 1 << 20;

/// SVG as of several programs.
pub(crate) const SVG: Target = Target {
    name: "svg",
    check: |input| drawing("a.svg", input),
    generated: || {
        let page = "<svg xmlns='http://www.w3.org/2000/svg' width='6mm' height='4mm' viewBox='0 0 6 4'>";
        let all = "<style>.a{fill:red}</style><g transform='rotate(30 1 2) skewX(3)' style='fill:#123;fill-rule:evenodd'>\
                   <path class='a' d='M0 0h1v1l-1 .5zm2 2c1 1 2 2 3 0s1 1 2 0q1 1 2 0t1 1a1 2 30 0 1 1 1z'/><rect width='2' height='1' rx='.2'/>\
                   <circle cx='1mm' r='2'/><ellipse rx='1' ry='2'/><polygon points='0,0 1,0 1 1'/></g><g display='none'/>";
        vec![format!("{page}{all}</svg>").into_bytes()]
    },
    files: &[],
    dictionary: None,
    max_bytes: 2048,
    // A corner has 16 bytes, in lists that grow, and a node of XML some 100.
    memory: Memory {
        bytes: 160 << 20,
        per_byte: 512,
    },
    time: Time::READING,
    mutations: 1500,
    repetitions: 20,
    long: || {
        let svg = "<svg width='6mm' height='4mm'>";
        vec![
            many(&format!("{svg}<path d='M0 0"), "L1 #", "z'/></svg>"),
            many(&format!("{svg}<path d='M0 0"), "a1e3 1e3 0 0 1 1 1", "z'/></svg>"),
            many(svg, "<circle r='#'/>", "</svg>"),
            many(&format!("{svg}<path style='"), "fill:#;", "' d=''/></svg>"),
            many(&format!("{svg}<path transform='"), "rotate(#)", "' d=''/></svg>"),
            many(&format!("{svg}<style>"), ".a#{fill:red}", "</style></svg>"),
            many(&format!("{svg}<path class='"), " a#", "' d=''/></svg>"),
            nested(svg, "<g>", "<circle r='1'/>", "</g>", "</svg>"),
        ]
    },
};

/// DXF with every kind of line.
pub(crate) const DXF: Target = Target {
    name: "dxf",
    check: |input| drawing("a.dxf", input),
    generated: || vec![dxf(LINES)],
    files: &[],
    dictionary: None,
    max_bytes: 2048,
    // A pair of a code and a value of a byte each has 24 bytes, in lists that grow.
    memory: Memory {
        bytes: 160 << 20,
        per_byte: 256,
    },
    time: Time::READING,
    mutations: 1500,
    repetitions: 20,
    long: || {
        let head = String::from_utf8_lossy(&dxf("")).replace("0\nENDSEC\n0\nEOF\n", "");
        let tail = "\n0\nENDSEC\n0\nEOF\n";
        let with = |begin: &str, piece: &str| many(&format!("{head}{begin}"), piece, tail);
        vec![
            with("", "\n0\nCIRCLE\n40\n#"),
            with("", "\n0\nLINE\n10\n#\n11\n1#"),
            with("", "\n0\nLINE\n10\n1\n11\n0"),
            with("0\nLWPOLYLINE\n70\n1", "\n10\n#\n20\n1\n42\n1"),
            with("0\nSPLINE\n71\n3", "\n40\n#\n10\n#\n20\n1"),
            with("", "\n0\nINSERT\n2\nB\n70\n1000"),
            with("0\nPOLYLINE", "\n0\nVERTEX\n10\n#"),
        ]
    },
};

const LINES: &str = "0,LWPOLYLINE,70,1,10,0,20,0,42,1,10,3,20,0,0,CIRCLE,8,a,10,1,40,1,0,ARC,8,b,40,1,50,0,51,180,0,LINE,8,b,10,1,11,-1,\
                     0,ELLIPSE,11,1,40,.5,0,POLYLINE,70,1,0,VERTEX,10,1,0,VERTEX,20,1,0,VERTEX,10,2,0,SEQEND,0,INSERT,2,B,41,2,70,2,44,3,\
                     0,SPLINE,70,8,71,2,40,0,40,0,40,0,40,1,40,1,40,1,10,0,20,0,10,1,20,2,10,0,20,0";

/// A DXF in mm with these entities, in which a comma stands for the end of a line.
fn dxf(entities: &str) -> Vec<u8> {
    let begin = "0,SECTION,2,HEADER,9,$INSUNITS,70,4,0,ENDSEC,0,SECTION,2,TABLES,0,LAYER,2,off,70,1,0,ENDSEC,\
                 0,SECTION,2,BLOCKS,0,BLOCK,2,B,10,1,0,CIRCLE,40,1,0,ENDBLK,0,ENDSEC,0,SECTION,2,ENTITIES,";
    format!("{begin}{entities}\n0,ENDSEC,0,EOF,")
        .replace(',', "\n")
        .into_bytes()
}

fn drawing(name: &str, input: &[u8]) {
    match arrays::drawing(Path::new(name), &mut &*input, 0.1) {
        Err(error) => readable(&error),
        Ok(drawing) => {
            let rings: Vec<_> = drawing.parts.iter().flat_map(|part| &part.rings).collect();
            assert!(!rings.is_empty() && rings.iter().all(|ring| ring.len() > 2));
            let corners = rings.into_iter().flatten();
            let count = corners
                .map(|corner| assert!(corner.iter().all(|length| length.is_finite())))
                .count();
            assert!(count <= MAX_CORNERS);
            drawing.notes.iter().for_each(readable);
        }
    }
}
