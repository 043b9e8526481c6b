//! Drawings that a case reads as texture: as other programs write them, and those that are refused.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use slipfront::surface::Part;
use slipfront_case::arrays;
use slipfront_case::case::Case;
use slipfront_case::texture_file::textured_blocks;
use test_case::test_case;

/// Parts of an SVG or DXF in blocks of 1 mm.
fn parts(name: &str, text: &str) -> Result<Vec<Part>, String> {
    let read = arrays::drawing(Path::new(name), &mut text.as_bytes(), 1.0);
    read.map(|drawing| drawing.parts)
        .map_err(|error| error.to_string())
}

/// A case with this drawing on blocks of 1 mm.
fn case(name: &str, text: &str, blocks: &str, more: &str) -> Result<Case, String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    let keys = format!(
        "slider.blocks = {blocks}\nslider.block_size = '1 mm'\n[[texture]]\nshape = 'drawing'\nfile = '{name}'\n{more}"
    );
    Case::parse(&keys, "case", folder.path(), &[]).map_err(|error| error.to_string())
}

/// The textured blocks, the top row first.
fn picture(name: &str, text: &str) -> String {
    let blocks = textured_blocks(&case(name, text, "[6, 4]", "").unwrap());
    let rows = blocks.chunks(6).rev();
    let row = |row: &[bool]| {
        row.iter()
            .map(|&textured| if textured { '#' } else { '.' })
            .collect()
    };
    rows.map(row).collect::<Vec<String>>().join("/")
}

/// A letter that no turn or mirror leaves as it is.
const LETTER: &str = "#...../#...../#...../###...";

fn page(inside: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='6mm' height='4mm' viewBox='0 0 6 4'>{inside}</svg>"
    )
}

const PATH: &str = "<path d='M0 4H3V3H1V0H0Z'/>";

#[test_case(&page(PATH); "absolute")]
#[test_case(&page("<path d='m0,4 3,0 0-1-2,0v-3h-1z'/>"); "relative")]
#[test_case(&page("<polygon points='0,4 3,4 3,3 1,3 1,0 0,0'/>"); "a polygon")]
#[test_case(&page("<rect width='1' height='4'/><rect y='3' width='3' height='1'/>"); "rectangles that overlap")]
#[test_case(&page("<path d='M0 0h3v4h-3z M1 0v3h2v-3z'/>"); "an outline turned the other way is a hole")]
#[test_case(&page("<path fill-rule='evenodd' d='M0 0h3v4h-3z M1 0h2v3h-2z'/>"); "even odd")]
#[test_case(&page("<g transform='translate(0 4) scale(1,-1)'><g transform='rotate(-90)'><path d='M0 0 V3 h-1 V1 H-4 V0z' transform='translate(0,0)'/></g></g>"); "turned and mirrored")]
#[test_case("<?xml version='1.0' encoding='UTF-8'?>\n<!-- Created with Inkscape -->\n<svg width='6mm' height='4mm' viewBox='0 0 22.677165 15.118110' \
    xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
    xmlns:sodipodi='http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd'><sodipodi:namedview/><defs><path d='M0 0h9v9z'/></defs>\
    <g inkscape:label='Ebene 1' inkscape:groupmode='layer' transform='matrix(3.7795276,0,0,3.7795276,-37.795276,0)'>\
    <path style='fill:#ff0000;stroke:#000000;stroke-width:0.1;fill-rule:evenodd' d='m 10,4 h 3 v -1 h -2 v -3 h -1 z'/></g>\
    <g inkscape:label='Hilfslinien' style='display:none'><path d='M0 0h6v4z'/></g></svg>"; "as Inkscape writes")]
#[test_case("<?xml version='1.0'?>\n<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd'>\n\
    <svg xmlns='http://www.w3.org/2000/svg' width='0.6cm' height='4mm' viewBox='0 0 600 400'><defs><style type='text/css'><![CDATA[ \
    .str0 {stroke:#373435;stroke-width:7.62}\n.fil0,.fil1 {fill:#373435;fill-rule:nonzero} ]]></style></defs>\
    <g id='Layer_x0020_1'><metadata id='CorelCorpID_0Corel-Layer'/><polygon class='fil0 str0' points='0,400 300,400 300,300 100,300 100,0 0,0 '/></g></svg>"; "as CorelDRAW writes")]
#[test_case("<svg xmlns='http://www.w3.org/2000/svg' width='6mm' height='4mm'><rect width='1mm' height='4mm'/><rect y='3mm' width='3mm' height='1mm'/></svg>"; "in lengths with units")]
#[test_case("<svg xmlns='http://www.w3.org/2000/svg' width='6mm' height='4mm' viewBox='-3 10 6 4'><path d='M-3 14H0v-1h-2v-3h-1z'/></svg>"; "a page that begins elsewhere")]
#[test_case(&page(&format!("{PATH}<g id='SLIDER' fill='none' stroke='black'><rect width='6' height='4'/></g><g visibility='hidden'><circle r='9'/></g>")); "with the edge of the slider")]
fn the_letter_of_an_svg_is_upright(text: &str) {
    assert_eq!(picture("letter.svg", text), LETTER);
}

/// A DXF with these lines, in which a comma stands for the end of a line.
fn dxf(unit: &str, before: &str, entities: &str) -> String {
    let text = format!(
        "0,SECTION,2,HEADER,9,$ACADVER,1,AC1015,9,$INSUNITS,70,{unit},0,ENDSEC,{before}0,SECTION,2,ENTITIES,{entities},0,ENDSEC,0,EOF,"
    );
    text.replace(',', "\n")
}

const LETTER_DXF: &str =
    "0,LWPOLYLINE,8,0,90,6,70,1,10,0,20,0,10,3,20,0,10,3,20,1,10,1,20,1,10,1,20,4,10,0,20,4";

#[test_case(&dxf("4", "", LETTER_DXF); "a polyline")]
#[test_case(&dxf("6", "", &LETTER_DXF.replace(",10,3", ",10,0.003").replace(",10,1", ",10,1e-3").replace(",20,4", ",20,4E-3").replace(",20,1", ",20,.001")); "in metres")]
#[test_case(&dxf("4", "", "0,LINE,8,a,10,0,20,0,11,3,21,0,0,LINE,8,a,10,3,20,1,11,3,21,0.001,0,LINE,8,a,10,1,20,4,11,1.001,21,1,\
    0,LINE,8,a,10,1,20,1,11,3,21,1,0,LINE,8,a,10,0,20,4,11,0,21,0,0,LINE,8,a,10,0,20,4,11,1,21,4"); "lines in any order")]
#[test_case(&dxf("4", "", "0,POLYLINE,8,0,66,1,70,1,0,VERTEX,8,0,10,0,20,0,0,VERTEX,8,0,10,3,20,0,0,VERTEX,8,0,10,3,20,1,0,VERTEX,8,0,10,1,20,1,\
    0,VERTEX,8,0,10,1,20,4,0,VERTEX,8,0,10,0,20,4,0,SEQEND,8,0"); "an old polyline")]
#[test_case(&dxf("4", "", &LETTER_DXF.replace(",10,", ",10,-").replace("10,-0", "10,0").replace(",90", ",230,-1,90")); "seen from below")]
#[test_case(&dxf("4", &format!("0,SECTION,2,BLOCKS,0,BLOCK,2,part,10,1,20,2,{LETTER_DXF},0,ENDBLK,0,ENDSEC,"), "0,INSERT,2,PART,8,0,10,1,20,2"); "a block")]
#[test_case(&dxf("4", "0,SECTION,2,BLOCKS,0,BLOCK,2,bar,0,LWPOLYLINE,8,0,70,1,10,0,20,0,10,1,20,0,10,1,20,-1,10,0,20,-1,0,ENDBLK,0,ENDSEC,",
    "0,INSERT,2,bar,8,0,10,0,20,0,42,-1,41,3,0,INSERT,2,bar,8,1,10,0,20,1,50,90,41,3,0,INSERT,2,bar,8,2,10,0,20,1,70,1,71,3,45,1,42,-1"); "turned and mirrored blocks in rows")]
#[test_case(&dxf("4", "0,SECTION,2,TABLES,0,TABLE,2,LAYER,0,LAYER,2,off,70,0,62,-7,0,LAYER,2,frozen,70,1,62,7,0,ENDTAB,0,ENDSEC,",
    &format!("{LETTER_DXF},0,CIRCLE,8,OFF,10,0,20,0,40,9,0,TEXT,8,frozen,0,CIRCLE,8,SLIDER,10,0,20,0,40,9,0,VIEWPORT,67,1")); "layers not shown")]
fn the_letter_of_a_dxf_is_upright(text: &str) {
    assert_eq!(picture("letter.dxf", text), LETTER);
}

/// Outlines within each other are holes and islands, on one layer; on two layers both are filled.
#[test]
fn outlines_within_each_other_on_one_layer_of_a_dxf_are_holes() {
    let square = |layer: &str, from: f64, to: f64| {
        format!(
            "0,LWPOLYLINE,8,{layer},70,1,10,{from},20,{from},10,{to},20,{from},10,{to},20,{to},10,{from},20,{to}"
        )
    };
    let two = |layer: &str| {
        dxf(
            "4",
            "",
            &format!("{},{}", square("0", 0.0, 4.0), square(layer, 1.0, 3.0)),
        )
    };
    assert_eq!(picture("a.dxf", &two("0")), "####../#..#../#..#../####..");
    assert_eq!(picture("a.dxf", &two("1")), "####../####../####../####..");
}

/// Area of an outline.
fn area(ring: &[[f64; 2]]) -> f64 {
    let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
    0.5 * pairs.map(|(p, q)| p[0] * q[1] - q[0] * p[1]).sum::<f64>().abs()
}

const TOP: f64 = 2.0 / 3.0;

#[test_case("a.svg", &page("<circle cx='3' cy='2' r='1.5'/>"), 2.25 * PI)]
#[test_case("a.svg", &page("<ellipse cx='3' cy='2' rx='2' ry='1' transform='rotate(30 3 2)'/>"), 2.0 * PI)]
#[test_case("a.svg", &page("<rect width='3' height='2' ry='0.5'/>"), 6.0 - 0.25 * (4.0 - PI))]
#[test_case("a.svg", &page("<path d='M1 2A1.5 1 0 0 1 4 2 1.5 1 0 01 1 2z'/>"), 1.5 * PI; "arcs with flags that touch")]
#[test_case("a.svg", &page("<path d='M2 1a1 1 0 1 0 1 1h-1z'/>"), 0.75 * PI; "the larger arc")]
#[test_case("a.svg", &page("<path d='M2 1a1 1 0 0 1 1 1h-1z'/>"), 0.25 * PI; "the smaller arc")]
#[test_case("a.svg", &page("<path d='M1 2a0.1 0.1 90 0 0 2 0z'/>"), 0.5 * PI; "radii that are too short")]
#[test_case("a.svg", &page("<path d='M0 0Q1 2 2 0z'/>"), 2.0 * TOP)]
#[test_case("a.svg", &page("<path d='M0 0q.5 1 1 0t1 0V2H0z'/>"), 4.0 - 0.0; "a smooth quadratic curve")]
#[test_case("a.svg", &page("<path d='M0 0C0 1 1 1 1 0z'/>"), 0.6)]
#[test_case("a.svg", &page("<path d='M0 0c0 1 1 1 1 0s1-1 1 0V2H0z'/>"), 4.0; "a smooth cubic curve")]
#[test_case("a.dxf", &dxf("4", "", "0,CIRCLE,10,3,20,2,40,1.5"), 2.25 * PI)]
#[test_case("a.dxf", &dxf("4", "", "0,ELLIPSE,10,3,20,2,11,1,21,1,40,0.5,41,0,42,6.283185307179586"), PI)]
#[test_case("a.dxf", &dxf("4", "", "0,ARC,10,3,20,2,40,1,50,270,51,90,0,ARC,10,3,20,2,40,1,50,90,51,-90"), PI; "two arcs")]
#[test_case("a.dxf", &dxf("4", "", "0,ELLIPSE,10,3,20,2,11,2,21,0,40,0.5,41,0,42,3.141592653589793,0,LINE,10,1,20,2,11,5,21,2"), PI; "half an ellipse")]
#[test_case("a.dxf", &dxf("4", "", "0,LWPOLYLINE,70,1,10,1,20,1,42,1,10,3,20,1,42,1"), PI; "two bulges")]
#[test_case("a.dxf", &dxf("4", "", "0,LWPOLYLINE,70,1,10,1,20,1,42,-0.414213562373095,10,2,20,2,10,2,20,1"), 0.25 * PI; "a quarter, clockwise")]
#[test_case("a.dxf", &dxf("4", "", "0,SPLINE,70,8,71,2,40,0,40,0,40,0,40,1,40,1,40,1,10,0,20,0,10,1,20,2,10,2,20,0,0,LINE,10,0,20,0,11,2,21,0"), 2.0 * TOP; "a spline")]
#[test_case("a.dxf", &dxf("4", "", "0,SPLINE,70,8,71,2,40,0,40,0,40,0,40,1,40,2,40,2,40,2,10,0,20,0,10,0,20,1,10,2,20,1,10,2,20,0,0,LINE,10,0,20,0,11,2,21,0"), 5.0 / 3.0; "a spline of two spans")]
fn curves_enclose_their_area(name: &str, text: &str, wanted: f64) {
    let parts = parts(name, text).unwrap();
    let [Part { rings, .. }] = &parts[..] else {
        panic!("{parts:?}")
    };
    let found: f64 = rings.iter().map(|ring| area(ring)).sum();
    // Chords within a ten-thousandth of a block of curves that are at most ten blocks long, and corners
    // rounded to a hundredth where lines are joined.
    assert!((found - wanted).abs() < 1e-3, "{found} {wanted}");
}

#[test_case("a.svg", &page(PATH).replace("6mm", "6"), "states no true size: its `width` is \"6\"")]
#[test_case("a.svg", &page(PATH).replace("4mm", "4px"), "states no true size: its `height` is \"4px\"")]
#[test_case("a.svg", &page(PATH).replace("width='6mm'", ""), "give width and height of the page in mm")]
#[test_case("a.svg", &page(PATH).replace("6mm", "100%"), "states no true size")]
#[test_case("a.svg", &page(PATH).replace("6mm", "-6mm"), "give one above 0")]
#[test_case("a.svg", &page(PATH).replace("6mm", "12mm"), "not to scale")]
#[test_case("a.svg", &page(PATH).replace("'0 0 6 4'", "'0 0 6'"), "viewBox")]
#[test_case("a.svg", &page("\n<text>a</text>"), "a <text> in line 2 which has no outline")]
#[test_case("a.svg", &page("<use href='#a'/>"), "a <use> in line 1")]
#[test_case("a.svg", &page("<image/>"), "a <image> in line 1")]
#[test_case("a.svg", &page("<g fill='none'><path stroke='red' d='M0 0h1v1z'/></g>"), "a line and no fill")]
#[test_case("a.svg", &page("<line x2='1' stroke='red'/>"), "a line and no fill")]
#[test_case("a.svg", &page("<path d='M0 0h1v1'/>"), "with an open line: close it")]
#[test_case("a.svg", &page("<path d='M0 0h1v1z m3 3h1v1'/>"), "with an open line: close it")]
#[test_case("a.svg", &page("<path d='M0 0h1v1k'/>"), "unreadable coordinates")]
#[test_case("a.svg", &page("<path d='M0 0h1e308h1e308v1z'/>"), "finite")]
#[test_case("a.svg", &page("<path transform='turn(3)' d='M0 0h1v1z'/>"), "unreadable transform")]
#[test_case("a.svg", &page("<polygon points='1 2 3'/>"), "unreadable coordinates")]
#[test_case("a.svg", &page("<circle r='10%'/>"), "no length")]
#[test_case("a.svg", &page("<rect width='-1' height='1'/>"), "no length")]
#[test_case("a.svg", &page(&format!("{PATH}<circle r='1' fill='#FFF'/>")), "filled with white")]
#[test_case("a.svg", &page("<style>#a {fill:none}</style>"), "only rules for classes")]
#[test_case("a.svg", &page("<rect width='1' height='1' clip-path='url(#a)'/>"), "that a `clip-path` changes")]
#[test_case("a.svg", &page("<g display='none'><rect width='1' height='1'/></g>"), "no outline of a texture (not shown, and so no texture: 1 element")]
#[test_case("a.svg", "<svg", "is not a readable drawing")]
#[test_case("a.svg", "<!DOCTYPE svg [<!ENTITY a 'b'>]><svg/>", "declares entities")]
#[test_case("a.svg", "<html/>", "begins with <html>")]
#[test_case("a.svg", &page(&"<g>".repeat(200)).replace("</svg>", &("</g>".repeat(200) + "</svg>")), "within more than 32 groups")]
#[test_case("a.svg", &page("<circle r='1e14'/>"), "more than 1048576 corners")]
#[test_case("a.dxf", "AutoCAD Binary DXF\r\n\x1a\0", "is a binary DXF")]
#[test_case("a.dxf", "hello\nworld\n", "line 1 is \"hello\"")]
#[test_case("a.dxf", "0\nSECTION\n2\nHEADER\n0\nENDSEC\n", "has no EOF")]
#[test_case("a.dxf", &dxf("0", "", LETTER_DXF), "states no unit of length: its $INSUNITS is \"0\"")]
#[test_case("a.dxf", &dxf("4", "", LETTER_DXF).replace("$INSUNITS", "$LUNITS"), "its $INSUNITS is missing")]
#[test_case("a.dxf", &dxf("4", "", &LETTER_DXF.replace("70,1", "70,0")), "a line that is not closed (line 19 of the file)")]
#[test_case("a.dxf", &dxf("4", "", "0,LINE,11,1,0,LINE,11,1,0,LINE,10,1,11,0"), "more than two lines that end at one point")]
#[test_case("a.dxf", &dxf("4", "", &format!("{LETTER_DXF},{LETTER_DXF}")), "the same outline twice on layer 0")]
#[test_case("a.dxf", &dxf("4", "", "0,MTEXT,8,0"), "a MTEXT in line 19 which is no line in the plane")]
#[test_case("a.dxf", &dxf("4", "", "0,POLYLINE,70,64"), "no line in the plane")]
#[test_case("a.dxf", &dxf("4", "", "0,CIRCLE,40,1,210,1,230,0"), "does not lie in the plane")]
#[test_case("a.dxf", &dxf("4", "", "0,CIRCLE,40,one"), "with \"one\" for a number")]
#[test_case("a.dxf", &dxf("4", "", "0,INSERT,2,part"), "of the block \"part\", which is not in the file")]
#[test_case("a.dxf", &dxf("4", "0,SECTION,2,BLOCKS,0,BLOCK,2,a,0,INSERT,2,a,0,ENDBLK,0,ENDSEC,", "0,INSERT,2,a"), "within 32 other blocks")]
#[test_case("a.dxf", &dxf("4", "0,SECTION,2,BLOCKS,0,BLOCK,2,a,0,INSERT,2,b,70,99,71,99,0,ENDBLK,0,BLOCK,2,b,0,INSERT,2,c,70,99,71,99,0,ENDBLK,0,BLOCK,2,c,0,ENDBLK,0,ENDSEC,", "0,INSERT,2,a"), "more than 1048576 corners")]
#[test_case("a.dxf", &dxf("4", "", "0,SPLINE,71,3,40,0,40,1,10,0,20,0"), "is no B-spline")]
#[test_case("a.dxf", &dxf("4", "", "0,SPLINE,71,1,40,0,40,1,41,1,41,2"), "with weights")]
#[test_case("a.pdf", "", ".svg or .dxf")]
fn drawings_are_refused_with_the_place_and_the_remedy(name: &str, text: &str, part: &str) {
    let said = parts(name, text).unwrap_err();
    assert!(said.contains(part), "{said}");
}

#[test]
fn what_is_not_shown_is_told_and_copies_are_repeated() {
    let text = page("<rect width='1' height='1' y='3'/>\n<circle r='9' display='none'/>");
    let warnings = case("a.svg", &text, "[6, 4]", "").unwrap().warnings();
    let said = "a.svg: not shown, and so no texture: 1 element, the first in line 2";
    assert!(
        warnings.iter().any(|warning| warning.ends_with(said)),
        "{warnings:?}"
    );
    let many = "<path d='M0 0".to_owned() + &"L1 4 2 0".repeat(60_000) + "z'/>";
    let said = case("a.svg", &page(&many), "[40, 400]", "array = [2, 1000]").unwrap_err();
    assert!(said.contains("outlines cross rows of blocks"), "{said}");
}
