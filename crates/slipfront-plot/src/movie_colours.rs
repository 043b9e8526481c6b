//! The colours of a movie, at most 256.

use crate::lattice_map::MARK;
use crate::style::{BLACK, BLANK, CURVES, GREY, Rgb, WHITE, ramp};

/// Number of colours of the ramp.
const RAMP: usize = 192;
/// Number of steps from a colour of lines and letters to white, for smooth edges.
const SHADES: usize = 14;
/// Number of leading bits of each channel that the lookup of the nearest colour uses.
const BITS: u32 = 5;

/// A palette with a lookup table for its nearest colours.
pub(crate) struct Colours {
    palette: Vec<Rgb>,
    /// Nearest colour for the leading bits of red, green and blue.
    nearest: Vec<u8>,
}

impl Default for Colours {
    fn default() -> Self {
        let mut palette: Vec<Rgb> = (0..RAMP).map(|k| ramp(k as f64 / (RAMP - 1) as f64)).collect();
        palette.extend([BLANK, WHITE]);
        for colour in [BLACK, CURVES[0], MARK, GREY] {
            palette.extend((0..SHADES).map(|k| mixed(colour, WHITE, k as f64 / SHADES as f64)));
        }
        let nearest = (0..1_u32 << (3 * BITS)).map(|bits| nearest_of(&palette, unpacked(bits)));
        let nearest = nearest.collect();
        Self { palette, nearest }
    }
}

impl Colours {
    pub(crate) fn palette(&self) -> &[Rgb] {
        &self.palette
    }

    /// The number of the nearest colour.
    pub(crate) fn nearest(&self, colour: Rgb) -> u8 {
        let leading = colour.map(|channel| u32::from(channel) >> (8 - BITS));
        let bits = leading
            .into_iter()
            .fold(0, |bits, channel| bits << BITS | channel);
        self.nearest[bits as usize]
    }
}

/// Representative of all colours with these leading bits. The ends of the range are exact, so that white
/// stays white.
fn unpacked(bits: u32) -> Rgb {
    let largest = (1 << BITS) - 1;
    let channel = |k: u32| ((bits >> (BITS * (2 - k)) & largest) * 255 / largest) as u8;
    [channel(0), channel(1), channel(2)]
}

fn nearest_of(palette: &[Rgb], colour: Rgb) -> u8 {
    let distance = |&(_, other): &(usize, &Rgb)| {
        let channels = colour.iter().zip(other);
        channels
            .map(|(one, other)| {
                let difference = i32::from(*one) - i32::from(*other);
                difference * difference
            })
            .sum::<i32>()
    };
    let nearest = palette.iter().enumerate().min_by_key(distance);
    nearest.map_or(0, |(index, _)| index as u8)
}

/// Linear mix of two colours.
fn mixed(from: Rgb, to: Rgb, share: f64) -> Rgb {
    [0, 1, 2].map(|channel| {
        let (from, to) = (f64::from(from[channel]), f64::from(to[channel]));
        (from + share * (to - from)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_of_pictures_are_found_again() {
        let colours = Colours::default();
        assert!(colours.palette().len() < 256);
        for colour in [
            WHITE,
            BLANK,
            BLACK,
            MARK,
            CURVES[0],
            ramp(0.0),
            ramp(1.0),
            ramp(0.3),
        ] {
            let found = colours.palette()[usize::from(colours.nearest(colour))];
            let far = colour
                .iter()
                .zip(found)
                .map(|(one, other)| one.abs_diff(other))
                .max();
            // The lookup ignores three bits (up to 7), and the ramp has 192 steps of at most 3.
            assert!(far <= Some(9), "{colour:?} {found:?}");
        }
        assert_eq!(colours.palette()[usize::from(colours.nearest(WHITE))], WHITE);
    }
}
