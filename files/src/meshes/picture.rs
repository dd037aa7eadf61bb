//! Pictures as meshes: the ink of a .png as a flat surface, one metre wide, about the origin, facing +z.

use super::MeshData;
use crate::fault::Fault;
use image::ImageFormat;
use std::io::Cursor;

/// The largest number of pixels that are looked at.
const MAX_PIXELS: u64 = 1 << 24;

/// Reads a picture. Its ink is what is opaque by half or more; in a picture without anything transparent, what is darker than half.
/// Pixels of ink side by side are one rectangle, so that points spread evenly over the mesh are spread evenly over the ink.
pub(super) fn read(bytes: &[u8]) -> Result<MeshData, Fault> {
    let unreadable = |error: image::ImageError| Fault::new(format!("is no picture that can be read: {error}"));
    let reader = || image::ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
    let (width, height) = reader().into_dimensions().map_err(unreadable)?;
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        let message = format!("has {width} x {height} pixels: at most {MAX_PIXELS} are read; make it smaller");
        return Err(Fault::new(message));
    }
    let picture = reader().decode().map_err(unreadable)?.into_luma_alpha8();
    let is_clear = picture.pixels().any(|pixel| pixel[1] < 128);
    let is_ink = |x: u32, y: u32| {
        let [light, opacity] = picture[(x, y)].0;
        if is_clear { opacity >= 128 } else { light < 128 }
    };
    let mut mesh = MeshData::default();
    for y in 0..height {
        let mut x = 0;
        while x < width {
            let from = x;
            while x < width && is_ink(x, y) {
                x += 1;
            }
            if x > from {
                mesh.add_rectangle([from, x], [y, y + 1], [width, height]);
            }
            x += 1;
        }
    }
    if mesh.triangles.is_empty() {
        return Err(Fault::new("has no ink: nothing opaque, or nothing dark where all is opaque"));
    }
    Ok(mesh)
}

impl MeshData {
    /// Adds the rectangle between two columns and two rows of so many.
    fn add_rectangle(&mut self, [left, right]: [u32; 2], [top, bottom]: [u32; 2], [width, height]: [u32; 2]) {
        let scale = 1.0 / f64::from(width);
        let corner = |x: u32, y: u32| {
            let (x, y) = (f64::from(x) - 0.5 * f64::from(width), 0.5 * f64::from(height) - f64::from(y));
            [(x * scale) as f32, (y * scale) as f32, 0.0]
        };
        let first = self.vertices.len() as u32;
        self.vertices.extend([corner(left, bottom), corner(right, bottom), corner(right, top), corner(left, top)]);
        self.add_polygon(&[first, first + 1, first + 2, first + 3]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, Rgba, RgbaImage};

    fn png(picture: RgbaImage) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        DynamicImage::from(picture).write_to(&mut bytes, ImageFormat::Png).expect("it is written");
        bytes.into_inner()
    }

    /// Area, and the mean of the corners.
    fn measure(mesh: &MeshData) -> (f32, [f32; 3]) {
        let corner = |i: u32| glam::Vec3::from(mesh.vertices[i as usize]);
        let area = mesh.triangles.iter().map(|&[a, b, c]| {
            let normal = (corner(b) - corner(a)).cross(corner(c) - corner(a));
            assert!(normal.z > 0.0);
            0.5 * normal.z
        });
        let mean = mesh.vertices.iter().map(|&v| glam::Vec3::from(v)).sum::<glam::Vec3>() / mesh.vertices.len() as f32;
        (area.sum(), mean.to_array())
    }

    #[test]
    fn ink_is_what_is_opaque_or_what_is_dark() {
        let clear = RgbaImage::from_fn(8, 4, |x, y| Rgba([255, 255, 255, if x < 2 && y == 0 { 255 } else { 0 }]));
        let mesh = read(&png(clear)).expect("it has ink");
        // Two pixels of an eighth of a metre each, at the upper left.
        let (area, mean) = measure(&mesh);
        assert!((area - 2.0 / 64.0).abs() < 1e-6 && mesh.triangles.len() == 2, "{area}");
        assert!((mean[0] + 0.375).abs() < 1e-6 && (mean[1] - 0.1875).abs() < 1e-6, "{mean:?}");

        let checkered = RgbaImage::from_fn(5, 5, |x, y| {
            let light = if (x + y).is_multiple_of(2) { 0 } else { 250 };
            Rgba([light, light, light, 255])
        });
        let mesh = read(&png(checkered)).expect("it has ink");
        assert!((measure(&mesh).0 - 13.0 / 25.0).abs() < 1e-6);
    }

    #[test]
    fn what_is_no_picture_or_has_no_ink_is_told() {
        let said = |bytes: &[u8]| read(bytes).expect_err("it is none").of("a.png").to_string();
        assert!(said(b"no picture").contains("is no picture that can be read"));
        let blank = png(RgbaImage::from_pixel(3, 3, Rgba([255; 4])));
        assert!(said(&blank).contains("has no ink"));
        assert!(said(&blank[..blank.len() / 2]).contains("is no picture that can be read"));
    }
}
