//! Films as plain pictures one after the other (YUV4MPEG2), for other programs.
//!
//! Every pixel has its own luma and chroma (4:4:4), in the full range from 0 to 255, by the matrix of BT.601 as in JPEG
//! files: back in red, green and blue a channel is off by one at most.

use image::RgbImage;
use std::fmt;
use std::io::{self, Write};
use y4m::{Colorspace, Encoder, Frame, Ratio, VendorExtensionString, encode};

/// Writes pictures as they come.
pub(super) struct Yuv<W: Write> {
    encoder: Encoder<W>,
}

impl<W: Write> Yuv<W> {
    /// Begins with the size of a picture and how many there are to a second.
    pub(super) fn begin(output: W, frame: &RgbImage, fps: f64) -> io::Result<Self> {
        let range = VendorExtensionString::new(b"COLORRANGE=FULL".to_vec()).map_err(other)?;
        let encoder = encode(frame.width() as usize, frame.height() as usize, rate(fps))
            .with_colorspace(Colorspace::C444)
            .append_vendor_extension(range)
            .write_header(output)
            .map_err(other)?;
        Ok(Self { encoder })
    }

    pub(super) fn push(&mut self, frame: &RgbImage) -> io::Result<()> {
        let planes = planes(frame);
        let [luma, blue, red] = &planes;
        self.encoder.write_frame(&Frame::new([luma, blue, red], None)).map_err(other)
    }
}

/// Frames a second as a fraction, to the thousandth.
fn rate(fps: f64) -> Ratio {
    if fps.fract() == 0.0 { Ratio::new(fps as usize, 1) } else { Ratio::new((1000.0 * fps).round() as usize, 1000) }
}

/// Luma, and what blue and red are more than that.
fn planes(frame: &RgbImage) -> [Vec<u8>; 3] {
    let plane = |weights: [f32; 3], middle: f32| {
        let value = |[red, green, blue]: [f32; 3]| weights[0] * red + weights[1] * green + weights[2] * blue + middle;
        frame.pixels().map(|pixel| (value(pixel.0.map(f32::from)) + 0.5) as u8).collect()
    };
    [
        plane([0.299, 0.587, 0.114], 0.0),
        plane([-0.168_735_9, -0.331_264_1, 0.5], 128.0),
        plane([0.5, -0.418_687_6, -0.081_312_4], 128.0),
    ]
}

fn other(error: y4m::Error) -> io::Error {
    match error {
        y4m::Error::IoError(error) => error,
        error => io::Error::other(error),
    }
}

impl<W: Write> fmt::Debug for Yuv<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Yuv").finish_non_exhaustive()
    }
}
