//! The bar of all colours beside a map.

use crate::canvas::Canvas;
use crate::color_image::Image;
use crate::frame::widest;
use crate::geometry::Area;
use crate::style::TICK_LENGTH;
use crate::ticks::Tick;

/// How wide a colour bar is.
pub(crate) const BAR_WIDTH: f64 = 30.0;
/// It is drawn no shorter than this.
pub(crate) const BAR_MIN_HEIGHT: f64 = 180.0;

/// How wide a bar is with these numbers beside it.
pub(crate) fn bar_room(ticks: &[Tick]) -> f64 {
    BAR_WIDTH + TICK_LENGTH + 7.0 + widest(ticks)
}

/// Draws a bar of all colours, dark at its foot.
pub(crate) fn colour_bar(canvas: &mut Canvas, area: Area, ticks: &[Tick]) {
    let levels = (0..=254).rev().collect();
    canvas.image(Image {
        area,
        columns: 1,
        levels,
    });
    canvas.frame(area);
    for (y, text) in ticks {
        canvas.tick_right((area.right(), *y), text);
    }
}
