//! Sizes and colours shared by all pictures. One unit of length is one pixel of the PNG at 300 dots per inch.

/// Pixels in an inch.
pub(crate) const DPI: f64 = 300.0;
/// Pixels in a millimetre.
pub(crate) const MM: f64 = DPI / 25.4;
/// Width of a journal's column, 85 mm.
pub(crate) const COLUMN_WIDTH: f64 = 85.0 * MM;
/// Width of a journal's text, 175 mm.
pub(crate) const TEXT_WIDTH: f64 = 175.0 * MM;

/// Size of all text: 8 pt.
pub(crate) const SIZE_TEXT: u32 = 33;
/// Size of titles and of numbers in cells that do not fit in the usual size: 7 pt.
pub(crate) const SIZE_NARROW: u32 = 29;

/// Width of a curve: 0.9 pt.
pub(crate) const WIDTH_CURVE: f64 = 3.75;
/// Width of a mean or an outline: 0.6 pt.
pub(crate) const WIDTH_MARK: f64 = 2.5;
/// Width of frames and ticks: 0.5 pt.
pub(crate) const WIDTH_FRAME: f64 = 2.0;
/// Width of leaders: 0.35 pt.
pub(crate) const WIDTH_LEADER: f64 = 1.5;
/// Opacity of bars: the error bar in front of a bar must be visible.
pub(crate) const OPACITY_BAR: f64 = 0.65;
/// Radius of the points of a curve.
pub(crate) const RADIUS_MARKER: f64 = 8.0;
/// Distance between the picture's edge and its content.
pub(crate) const MARGIN: f64 = 14.0;
/// Length by which a tick reaches out of its frame.
pub(crate) const TICK_LENGTH: f64 = 9.0;

/// A colour: red, green, blue.
pub(crate) type Rgb = [u8; 3];

pub(crate) const BLACK: Rgb = [0x1a, 0x1a, 0x1a];
pub(crate) const GREY: Rgb = [0x77, 0x77, 0x77];
pub(crate) const WHITE: Rgb = [0xff, 0xff, 0xff];
/// Colour of blocks without a value.
pub(crate) const BLANK: Rgb = [0xd9, 0xd9, 0xd9];

/// Okabe and Ito's palette, distinguishable with any colour vision; its yellow is left out because it is too
/// pale for a line.
pub(crate) const CURVES: [Rgb; 7] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0xe6, 0x9f, 0x00],
    [0x56, 0xb4, 0xe9],
    [0x00, 0x00, 0x00],
];

/// Style that distinguishes a curve from others.
#[derive(Clone, Copy)]
pub(crate) struct CurveStyle {
    pub(crate) colour: Rgb,
    /// Lengths of the curve's dashes and of the gaps after them; empty for a solid line.
    pub(crate) dashes: &'static [f64],
}

/// Dashes that distinguish curves of one colour.
const DASHES: [&[f64]; 4] = [&[], &[20.0, 8.0], &[6.0, 6.0], &[20.0, 6.0, 6.0, 6.0]];

/// The style of curve `index`: curves beyond the colours of the palette are dashed.
pub(crate) fn curve_style(index: usize) -> CurveStyle {
    CurveStyle {
        colour: CURVES[index % CURVES.len()],
        dashes: DASHES[index / CURVES.len() % DASHES.len()],
    }
}

/// The colour of bar `index` out of `count`. More bars than the palette has colours run through [`ramp`].
pub(crate) fn bar_colour(index: usize, count: usize) -> Rgb {
    if count <= CURVES.len() {
        return CURVES[index % CURVES.len()];
    }
    // The ramp's last tenth is a yellow too pale for a line.
    ramp(0.9 * index as f64 / (count - 1) as f64)
}

/// Viridis, perceptually uniform, from 0 (dark) to 1 (bright).
pub(crate) fn ramp(value: f64) -> Rgb {
    colorous::VIRIDIS.eval_continuous(value).as_array()
}
