//! Bars of the named variants of a parametric study.

use serde::{Deserialize, Serialize};

use crate::axis::{DrawnAxis, drawable};
use crate::canvas::Canvas;
use crate::category_axis::{CategoryAxis, MIN_SLOT};
use crate::estimate::Estimate;
use crate::frame::{left_room, left_side, upright_room};
use crate::geometry::Area;
use crate::legend::{Legend, LegendSample};
use crate::note::Note;
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::series::{cross, error_bar};
use crate::size::PictureSize;
use crate::style::{BLACK, COLUMN_WIDTH, MARGIN, OPACITY_BAR, Rgb, WIDTH_FRAME, bar_colour};
use crate::text::Text;
use crate::ticks::{Direction, MAX_STEPS};

const HEIGHT: f64 = 560.0;
/// Width of a bar below which the picture becomes wider.
const MIN_BAR_WIDTH: f64 = 14.0;
/// Fraction of its slot that a single bar fills, and fraction that all bars of a group fill together.
const SHARE_ALONE: f64 = 0.6;
const SHARE_GROUP: f64 = 0.8;
/// Largest width of a bar.
const MAX_BAR_WIDTH: f64 = 130.0;

/// Bars of named variants.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BarChart {
    /// Quantity that the bars show.
    pub y_title: String,
    /// Quantity that varies from name to name below the bars; may be empty.
    pub x_title: String,
    /// Quantity that varies within a group, for the legend; may be empty.
    pub legend_title: String,
    /// Meaning of the intervals, below the names; may be empty.
    pub note: String,
    /// The groups, from the left.
    pub groups: Vec<BarGroup>,
}

/// Bars next to each other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BarGroup {
    /// The group's name; not shown if there is one group only.
    pub label: String,
    /// Bars of the group, from the left.
    pub bars: Vec<Bar>,
}

/// One bar.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bar {
    /// Name of the bar, unique within its group; bars with the same name have the same colour.
    pub label: String,
    /// Height of the bar; without a mean its slot stays empty.
    pub value: Estimate,
}

/// Draws bars from zero with error bars, usually as wide as a journal's column (85 mm), or wider if there are
/// too many.
///
/// One group is drawn as bars of one colour, each with its name below. With several groups, each group has
/// its name below, and a legend names the bars.
///
/// # Errors
///
/// No bar, or a size that leaves no room for the bars.
pub fn bars(chart: &BarChart, size: PictureSize) -> Result<Picture, PictureError> {
    let places = Places::new(chart);
    if places.bars.is_empty() {
        return Err(PictureError::Nothing("bar"));
    }
    let y = value_axis(&places.bars);
    let left = left_room(&y.placed(HEIGHT, 0.0).ticks(Direction::Y, MAX_STEPS));
    let narrowest = MIN_SLOT.max(MIN_BAR_WIDTH * places.legend.len() as f64 / SHARE_GROUP);
    let least = left + narrowest * places.names.len() as f64 + MARGIN;
    // A requested width is used unchanged, or refused.
    let whole = match size.width_mm {
        None => size.width(COLUMN_WIDTH).max(least),
        Some(_) => size.wide_enough(COLUMN_WIDTH, least)?,
    };
    let width = (whole - left - MARGIN).round();
    let patches = places.legend.iter().map(|&name| (name, LegendSample::Patch));
    let legend = Legend::new(&chart.legend_title, patches, left, left + width);
    let above = MARGIN + legend.height;
    let names = CategoryAxis::new(&places.names, &chart.x_title, width);
    let note = Note::new(&chart.note, left + 0.5 * width, whole);
    let height = size.panel(HEIGHT, above + names.height + note.height, 1)?;
    let area = Area::new(left, above, width, height);
    let y = y.placed(area.bottom(), area.y);

    let mut canvas = Canvas::sized(whole, area.bottom() + names.height + note.height, size);
    note.draw(&mut canvas);
    let title = Text::fitted(&chart.y_title, upright_room(area, canvas.height));
    left_side(&mut canvas, area, 0.0, &y.ticks(Direction::Y, MAX_STEPS), &title);
    legend.draw(&mut canvas);
    names.draw(&mut canvas, area);
    let slot = area.width / places.names.len() as f64;
    let bar_width = places.bar_width(slot);
    for placed in &places.bars {
        let middle = area.x + slot * (placed.name as f64 + 0.5) + bar_width * placed.step;
        draw_bar(&mut canvas, &y, placed, middle, bar_width);
    }
    canvas.line((area.x, y.at(0.0)), (area.right(), y.at(0.0)), WIDTH_FRAME, BLACK);
    canvas.frame(area);
    canvas.finish()
}

fn draw_bar(
    canvas: &mut Canvas,
    y: &DrawnAxis,
    &PlacedBar { bar, colour, .. }: &PlacedBar,
    middle: f64,
    width: f64,
) {
    /// Distance from the foot of a bar to the cross that marks it.
    const LIFT: f64 = 14.0;
    let foot = y.at(0.0);
    if drawable(bar.value.mean) {
        let head = y.at(bar.value.mean);
        // Bars of a group do not touch.
        let left = middle - 0.5 * width + 1.0;
        let area = Area::new(left, foot.min(head), width - 2.0, (foot - head).abs());
        canvas.fill(area, colour, OPACITY_BAR);
    }
    if let Some([low, high]) = bar.value.interval() {
        error_bar(canvas, middle, y.at(low), y.at(high), BLACK);
    }
    if bar.value.crossed {
        cross(canvas, (middle, foot - LIFT));
    }
}

/// The y axis from zero, with all bars and error bars.
fn value_axis(bars: &[PlacedBar]) -> DrawnAxis {
    let extent = |PlacedBar { bar, .. }: &PlacedBar| {
        let mean = bar.value.mean;
        let [low, high] = bar.value.interval().unwrap_or([mean, mean]);
        [0.0, mean, low, high]
    };
    let values: Vec<f64> = bars.iter().flat_map(extent).collect();
    let whole = DrawnAxis::around(&values, false, 0.06);
    // No margin beyond zero, unless bars extend to that side.
    let beyond = |side: f64| values.iter().any(|&value| drawable(value) && value * side > 0.0);
    match (beyond(-1.0), beyond(1.0)) {
        (false, true) => DrawnAxis::linear(0.0, whole.hi),
        (true, false) => DrawnAxis::linear(whole.lo, 0.0),
        _ => whole,
    }
}

/// Places of the bars.
struct Places<'a> {
    names: Vec<&'a str>,
    legend: Vec<&'a str>,
    bars: Vec<PlacedBar<'a>>,
}

struct PlacedBar<'a> {
    bar: &'a Bar,
    /// Index of the name below the bar.
    name: usize,
    /// Offset to the right of the middle of that name's slot, in bar widths.
    step: f64,
    colour: Rgb,
}

impl<'a> Places<'a> {
    fn new(chart: &'a BarChart) -> Self {
        if let [group] = &chart.groups[..] {
            let placed = |(name, bar)| PlacedBar {
                bar,
                name,
                step: 0.0,
                colour: bar_colour(0, 1),
            };
            return Self {
                names: group.bars.iter().map(|bar| bar.label.as_str()).collect(),
                legend: Vec::new(),
                bars: group.bars.iter().enumerate().map(placed).collect(),
            };
        }
        let mut legend: Vec<&str> = Vec::new();
        for bar in chart.groups.iter().flat_map(|group| &group.bars) {
            if !legend.contains(&bar.label.as_str()) {
                legend.push(&bar.label);
            }
        }
        let mut bars = Vec::new();
        for (name, group) in chart.groups.iter().enumerate() {
            for bar in &group.bars {
                let index = legend.iter().position(|label| *label == bar.label).unwrap_or(0);
                bars.push(PlacedBar {
                    bar,
                    name,
                    step: index as f64 - 0.5 * (legend.len() - 1) as f64,
                    colour: bar_colour(index, legend.len()),
                });
            }
        }
        Self {
            names: chart.groups.iter().map(|group| group.label.as_str()).collect(),
            legend,
            bars,
        }
    }

    fn bar_width(&self, slot: f64) -> f64 {
        let width = match self.legend.len() {
            0 => SHARE_ALONE * slot,
            count => SHARE_GROUP * slot / count as f64,
        };
        width.min(MAX_BAR_WIDTH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar(label: &str, mean: f64) -> Bar {
        Bar {
            label: label.to_string(),
            value: Estimate::between(mean - 1.0, mean, mean + 1.0),
        }
    }

    fn chart(groups: &[(&str, &[Bar])]) -> BarChart {
        let group = |&(label, bars): &(&str, &[Bar])| BarGroup {
            label: label.to_string(),
            bars: bars.to_vec(),
        };
        BarChart {
            y_title: "y".to_string(),
            legend_title: "V*".to_string(),
            groups: groups.iter().map(group).collect(),
            ..BarChart::default()
        }
    }

    fn limits(means: &[f64]) -> (f64, f64) {
        let chart = chart(&[("", &means.iter().map(|&mean| bar("", mean)).collect::<Vec<_>>())]);
        let y = value_axis(&Places::new(&chart).bars);
        (y.lo, y.hi)
    }

    #[test]
    fn bars_start_at_zero() {
        let (lo, hi) = limits(&[20.0, 21.0]);
        assert!(lo == 0.0 && hi > 22.0);
        let (lo, hi) = limits(&[-20.0]);
        assert!(lo < -21.0 && hi == 0.0);
        let (lo, hi) = limits(&[-20.0, 5.0]);
        assert!(lo < -21.0 && hi > 6.0);
        // An error bar may reach below.
        assert!(limits(&[0.5]).0 < -0.5);
    }

    #[test]
    fn one_group_names_its_bars_and_several_have_a_legend() {
        let pair = [bar("slow", 3.0), bar("fast", 4.0)];
        let one = bars(&chart(&[("circle", &pair)]), PictureSize::default())
            .unwrap()
            .svg;
        assert!(
            one.contains(">slow</text>") && !one.contains(">circle</text>") && !one.contains(">V*</text>")
        );
        let two = bars(
            &chart(&[("circle", &pair), ("square", &pair[1..])]),
            PictureSize::default(),
        )
        .unwrap()
        .svg;
        for text in ["circle", "square", "slow", "fast", "V*"] {
            assert_eq!(two.matches(&format!(">{text}</text>")).count(), 1, "{text}");
        }
    }

    #[test]
    fn bars_of_one_name_are_coloured_and_placed_alike() {
        let chart = chart(&[
            ("a", &[bar("slow", 1.0), bar("fast", 2.0)]),
            ("b", &[bar("fast", 3.0)]),
        ]);
        let places = Places::new(&chart);
        let [first, second, third] = &places.bars[..] else {
            panic!("three bars")
        };
        assert!(first.colour != second.colour && first.step == -second.step);
        assert!(second.colour == third.colour && second.step == third.step);
    }

    #[test]
    fn bars_that_are_not_whole_are_crossed() {
        let lines = |bar: Bar| {
            bars(&chart(&[("", &[bar])]), PictureSize::default())
                .unwrap()
                .svg
                .matches("fill=\"none\"")
                .count()
        };
        for mean in [2.0, f64::NAN] {
            let mut crossed = bar("a", mean);
            crossed.value.crossed = true;
            assert_eq!(lines(crossed), lines(bar("a", mean)) + 2, "{mean}");
        }
    }

    #[test]
    fn poor_bars_are_drawn_all_the_same() {
        let odd = [
            bar("nothing", f64::NAN),
            bar("no interval", 0.0),
            bar("huge", f64::MAX),
            bar("", 1e-320),
            bar("one endless name ".repeat(20).as_str(), -9e99),
        ];
        for bar in &odd {
            bars(&chart(&[("", std::slice::from_ref(bar))]), PictureSize::default()).unwrap();
        }
        let svg = bars(
            &chart(&[("a", &odd), ("", &[]), ("c", &odd)]),
            PictureSize::default(),
        )
        .unwrap()
        .svg;
        assert!(!svg.contains("NaN") && !svg.contains("inf\""));
        assert_eq!(
            bars(&chart(&[("a", &[]), ("b", &[])]), PictureSize::default())
                .unwrap_err()
                .to_string(),
            "there is no bar to draw"
        );
    }

    #[test]
    fn many_bars_make_a_wider_picture_rather_than_thinner_names() {
        let many: Vec<Bar> = (0..60)
            .map(|i| bar("some variant's name", f64::from(i)))
            .collect();
        let svg = bars(&chart(&[("", &many)]), PictureSize::default()).unwrap().svg;
        let width = svg
            .split_once("viewBox=\"0 0 ")
            .and_then(|(_, rest)| rest.split_once(' '));
        let width: f64 = width.and_then(|(width, _)| width.parse().ok()).unwrap();
        assert!(width > 60.0 * MIN_SLOT);
    }
}
