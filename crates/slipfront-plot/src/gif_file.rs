//! Animated GIF files.

use std::borrow::Cow;

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};

use crate::movie::MovieSize;
use crate::picture_error::PictureError;

/// An animated GIF file of pictures of a movie, which begins again when it has ended. For every picture, the
/// file holds only the rectangle that differs from the previous picture.
pub struct MovieGif {
    encoder: Encoder<Vec<u8>>,
    /// Width and height of the pictures in pixels.
    pixels: [usize; 2],
    /// The pixels of the previous picture.
    before: Vec<u8>,
    /// Index of a colour that no pixel has, for pixels that do not change.
    transparent: u8,
}

impl MovieGif {
    /// A file without pictures, which will be of this size and have these colours, at most 255.
    ///
    /// # Errors
    /// When there are more than 255 colours.
    pub fn new(palette: &[[u8; 3]], size: MovieSize) -> Result<Self, PictureError> {
        let transparent = palette.len();
        let mut colours = palette.concat();
        colours.extend([255; 3]);
        let [width, height] = size.pixels().map(|pixels| pixels as u16);
        let mut encoder = Encoder::new(Vec::new(), width, height, &colours)?;
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(Self {
            encoder,
            pixels: size.pixels(),
            before: Vec::new(),
            transparent: transparent as u8,
        })
    }

    /// Adds a picture that is shown for `delay` hundredths of a second.
    ///
    /// # Errors
    /// When the picture has the wrong number of pixels.
    pub fn add(&mut self, pixels: Vec<u8>, delay: u16) -> Result<(), PictureError> {
        let [width, height] = self.pixels;
        let [left, top, right, bottom] = if self.before.len() == pixels.len() {
            changed(&self.before, &pixels, width)
        } else {
            [0, 0, width, height]
        };
        let is_first = self.before.is_empty();
        let mut part = Vec::with_capacity((right - left) * (bottom - top));
        for row in top..bottom {
            let row = row * width + left..row * width + right;
            if is_first {
                part.extend_from_slice(&pixels[row]);
            } else {
                let pairs = self.before[row.clone()].iter().zip(&pixels[row]);
                part.extend(pairs.map(|(before, now)| if before == now { self.transparent } else { *now }));
            }
        }
        let frame = Frame {
            delay,
            dispose: DisposalMethod::Keep,
            transparent: (!is_first).then_some(self.transparent),
            left: left as u16,
            top: top as u16,
            width: (right - left) as u16,
            height: (bottom - top) as u16,
            buffer: Cow::Owned(part),
            ..Frame::default()
        };
        self.before = pixels;
        Ok(self.encoder.write_frame(&frame)?)
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// No error can be foreseen, because the file is written to memory.
    pub fn finish(self) -> Result<Vec<u8>, PictureError> {
        Ok(self.encoder.into_inner()?)
    }
}

impl From<EncodingError> for PictureError {
    fn from(error: EncodingError) -> Self {
        Self::Gif(error.to_string())
    }
}

/// Left, top, right and bottom of the rectangle of pixels that differ; one pixel where none differs.
fn changed(before: &[u8], now: &[u8], width: usize) -> [usize; 4] {
    let differing = (0..now.len()).filter(|&pixel| before[pixel] != now[pixel]);
    let rectangle = differing.fold([usize::MAX, usize::MAX, 0, 0], |[left, top, right, _], pixel| {
        let (column, row) = (pixel % width, pixel / width);
        [left.min(column), top.min(row), right.max(column + 1), row + 1]
    });
    if rectangle[2] > 0 { rectangle } else { [0, 0, 1, 1] }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOVIE_PIXELS: [usize; 2] = MovieSize::Usual.pixels();

    /// A program that reads the file shows the colours of the pictures, whatever part of them the file holds.
    #[test]
    fn what_is_shown_is_what_was_drawn() {
        let palette = [[0, 0, 0], [255, 0, 0], [0, 255, 0]];
        let size = MOVIE_PIXELS[0] * MOVIE_PIXELS[1];
        let mut second = vec![0; size];
        second[5 * MOVIE_PIXELS[0] + 7] = 1;
        let mut third = second.clone();
        third[399 * MOVIE_PIXELS[0] + 799] = 2;
        third[5 * MOVIE_PIXELS[0] + 7] = 0;
        let pictures = [vec![0; size], second.clone(), second, third];
        let mut file = MovieGif::new(&palette, MovieSize::Usual).unwrap();
        for (picture, delay) in pictures.iter().zip([8, 8, 8, 40]) {
            file.add(picture.clone(), delay).unwrap();
        }
        let bytes = file.finish().unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::Indexed);
        let mut decoder = options.read_info(&bytes[..]).unwrap();
        assert_eq!(
            [decoder.width(), decoder.height()],
            MOVIE_PIXELS.map(|pixels| pixels as u16)
        );
        let mut shown = vec![0; size];
        let mut number = 0;
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            let (left, top, width) = (frame.left as usize, frame.top as usize, frame.width as usize);
            for (k, &colour) in frame.buffer.iter().enumerate() {
                if Some(colour) != frame.transparent {
                    shown[(top + k / width) * MOVIE_PIXELS[0] + left + k % width] = colour;
                }
            }
            assert_eq!(shown, pictures[number], "picture {number}");
            assert_eq!(frame.delay, [8, 8, 8, 40][number]);
            number += 1;
        }
        assert_eq!(number, pictures.len());
    }
}
