//! Checks of what a declared scene looks like: materials, lights, the camera, and what is behind all.

use super::check_shape::check_shape;
use super::numbers::{Checked, check_direction, finite, zero_or_more};
use super::references::MAX_MATERIALS;
use super::{Camera, Fog, Light, Material, SceneError, SceneFile, Sky};
use crate::material::TrailMaterial;
use crate::shape::Shape;
use alloc::format;
use core::f32::consts::FRAC_PI_2;
use glam::Vec3;

impl SceneFile {
    pub(super) fn check_look(&self) -> Checked {
        if self.materials.len() > MAX_MATERIALS {
            return Err(SceneError::value("materials", format!("a scene has at most {MAX_MATERIALS}")));
        }
        for (i, m) in self.materials.iter().enumerate() {
            check_properties(&format!("materials[{i}]"), m)?;
        }
        for (i, light) in self.lights.iter().enumerate() {
            check_light(&format!("lights[{i}]"), light)?;
        }
        if let Some(camera) = &self.camera {
            check_camera(camera)?;
        }
        if let Some(Sky { zenith, horizon, ground }) = self.sky {
            for (name, color) in [("zenith", zenith), ("horizon", horizon), ("ground", ground.unwrap_or(horizon))] {
                check_color(&format!("sky.{name}"), color)?;
            }
        }
        if let Some(Fog { color, density, from }) = self.fog {
            check_color("fog.color", color.unwrap_or_default())?;
            zero_or_more("fog.density", density)?;
            zero_or_more("fog.from", from)?;
        }
        check_color("ambient", self.ambient)?;
        check_color("background", self.background)
    }
}

/// Checks red, green and blue. Lamps may be brighter than white.
fn check_color(at: &str, color: [f32; 3]) -> Checked {
    finite(at, &color)?;
    match color.iter().find(|channel| **channel < 0.0) {
        Some(channel) => Err(SceneError::value(at, format!("has to be red, green, blue from 0 to 1, not {channel}"))),
        None => Ok(()),
    }
}

fn check_camera(camera: &Camera) -> Checked {
    let Camera { eye, towards, up, xfov, near, far, shutter } = *camera;
    finite("camera.eye", &eye)?;
    check_direction("camera.towards", Vec3::from_array(towards))?;
    check_direction("camera.up", Vec3::from_array(up))?;
    if !(xfov > 0.0 && xfov < FRAC_PI_2) {
        let message = format!("has to be above zero and below pi / 2, half the angle in radians, not {xfov}");
        return Err(SceneError::value("camera.xfov", message));
    }
    zero_or_more("camera.near", near)?;
    finite("camera.far", &[far])?;
    if !(far > near) {
        return Err(SceneError::value("camera.far", format!("has to be beyond near, {near} m, not {far} m")));
    }
    zero_or_more("camera.shutter", shutter.unwrap_or(0.0))
}

/// Checks how particles of a material feel and look.
fn check_properties(at: &str, m: &Material) -> Checked {
    for (name, color) in [
        ("ambient", m.ambient),
        ("diffuse", m.diffuse),
        ("specular", m.specular),
        ("transmission", m.transmission),
        ("emission", m.emission),
    ] {
        check_color(&format!("{at}.{name}"), color)?;
    }
    finite(at, &[m.shininess, m.refraction])?;
    zero_or_more(&format!("{at}.size"), m.size)?;
    zero_or_more(&format!("{at}.glow"), m.glow)?;
    if let Some((name, number, meant)) = m.contact.fault() {
        let message = format!("{meant}, not {number}");
        return Err(SceneError::value(format!("{at}.contact.{name}"), message));
    }
    if let Some(sprite) = &m.sprite {
        sprite.check(&format!("{at}.sprite"))?;
    }
    if let Some(shape) = &m.shape {
        let at = format!("{at}.shape");
        if m.sprite.is_some() {
            return Err(SceneError::value(at, "particles are drawn as a shape or with a sprite, not both"));
        }
        if matches!(shape.form, Shape::Plane(_) | Shape::Line(_)) {
            return Err(SceneError::value(format!("{at}.form"), "a particle cannot be drawn as a plane or a line"));
        }
        check_shape(&format!("{at}.form"), &shape.form)?;
    }
    if let Some(TrailMaterial { seconds, width }) = m.trail {
        let at = format!("{at}.trail");
        if !(seconds > 0.0 && seconds.is_finite()) {
            let message = format!("has to be above zero, in seconds, not {seconds}");
            return Err(SceneError::value(format!("{at}.seconds"), message));
        }
        if !(0.0..f32::INFINITY).contains(&width) {
            let message = format!("has to be zero or more, in metres, not {width}");
            return Err(SceneError::value(format!("{at}.width"), message));
        }
    }
    m.life.check(&format!("{at}.life"))
}

/// Checks a light.
fn check_light(at: &str, light: &Light) -> Checked {
    check_color(&format!("{at}.color"), light.color())?;
    match light {
        Light::Directional { direction, .. } => finite(at, direction)?,
        Light::Point { position, attenuation, .. } => finite(at, [*position, *attenuation].as_flattened())?,
        Light::Spot { position, direction, attenuation, cutoff, dropoff, .. } => {
            finite(at, [*position, *direction, *attenuation].as_flattened())?;
            finite(at, &[*cutoff, *dropoff])?;
        }
        Light::Area { position, direction, radius, attenuation, .. } => {
            finite(at, [*position, *direction, *attenuation].as_flattened())?;
            finite(at, &[*radius])?;
            if *radius < 0.0 {
                return Err(SceneError::value(at, format!("the radius has to be zero or more, not {radius}")));
            }
        }
    }
    Ok(())
}
