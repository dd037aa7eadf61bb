//! Remarks on colours that are hardly meant.

use crate::math::max;
use crate::particles::Color;
use crate::scene::{Light, Material, SceneFile, VaryingBuf};
use alloc::format;
use alloc::string::String;
use core::fmt::Arguments;

/// What no surface returns of the light that falls on it, nor any sky sends: more is a byte that has not been divided by 255, say.
const BRIGHT: f32 = 2.0;

/// The largest factor of a colour that may be meant.
const FACTOR: f32 = 32.0;

/// The brightest that lamps are drawn.
const DAZZLING: f32 = 100.0;

impl SceneFile {
    /// Remarks on colours beyond what they are drawn with, and on more glow than all.
    pub(super) fn add_colors(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        for (i, material) in self.materials.iter().enumerate() {
            let Material { ambient, diffuse, specular, transmission, emission, glow, shininess, .. } = material;
            let colors = [ambient, diffuse, specular, transmission, emission];
            let names = ["ambient", "diffuse", "specular", "transmission", "emission"];
            for (name, color) in names.into_iter().zip(colors) {
                add(format_args!("materials[{i}].{name}"), bright(*color));
            }
            let more = || format!("{glow} counts as 1, a glow and nothing else");
            add(format_args!("materials[{i}].glow"), (*glow > 1.0).then(more));
            let dull = || format!("{shininess} counts as 1, the widest highlight");
            add(format_args!("materials[{i}].shininess"), (*shininess < 0.0).then(dull));
        }
        for (i, light) in self.lights.iter().enumerate() {
            let most = largest(light.color());
            let less = || format!("{most} is drawn as {DAZZLING}, the most there is");
            add(format_args!("lights[{i}].color"), (most > DAZZLING).then(less));
            let nowhere = matches!(light, Light::Directional { direction, .. } if *direction == [0.0; 3]);
            add(format_args!("lights[{i}].direction"), nowhere.then(|| "0 is no direction to shine in".into()));
        }
        add(format_args!("ambient"), bright(self.ambient));
        add(format_args!("background"), bright(self.background));
        if let Some(sky) = self.sky {
            let named = [("zenith", sky.zenith), ("horizon", sky.horizon), ("ground", sky.ground.unwrap_or_default())];
            for (name, color) in named {
                add(format_args!("sky.{name}"), bright(color));
            }
        }
        let fog = self.fog.and_then(|fog| fog.color);
        add(format_args!("fog.color"), fog.and_then(bright));
        self.add_scales(add);
    }

    /// Remarks on colours by the other of the two scales, bytes for particles, and from 0 to 1 for all else: those of particles are then too
    /// clear to be seen, and factors over a life so large that all is white.
    fn add_scales(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        for (i, particle) in self.particles.iter().enumerate() {
            add(format_args!("particles[{i}].color"), particle.color.and_then(unscaled));
        }
        for (i, emitter) in self.emitters.iter().enumerate() {
            add(format_args!("emitters[{i}].color"), emitter.color.and_then(unscaled));
        }
        for (i, material) in self.materials.iter().enumerate() {
            let keys = material.life.color.iter().flat_map(VaryingBuf::curves).flatten();
            let most = keys.flat_map(|[_, rgb @ ..]| rgb).fold(0.0, |most, &factor| max(most, factor));
            let bytes = || {
                format!(
                    "{most} is a factor of what the particle's colour has, whose bytes end at 255: take shares, from 0 to 1"
                )
            };
            add(format_args!("materials[{i}].life.color"), (most > FACTOR).then(bytes));
        }
    }
}

/// A remark on a particle's colour that seems to be meant from 0 to 1.
fn unscaled(color: Color) -> Option<String> {
    let [.., opacity] = color;
    let bytes = || {
        "red, green, blue and opacity of particles are bytes from 0 to 255, and an opacity of 1 of 255 is not seen; multiply by 255".into()
    };
    (opacity == 1 && color.iter().all(|&part| part <= 1)).then(bytes)
}

impl Light {
    /// Its colour.
    #[must_use]
    pub fn color(&self) -> [f32; 3] {
        let (Self::Directional { color, .. }
        | Self::Point { color, .. }
        | Self::Spot { color, .. }
        | Self::Area { color, .. }) = self;
        *color
    }
}

fn largest(color: [f32; 3]) -> f32 {
    color.into_iter().fold(0.0, f32::max)
}

fn bright(color: [f32; 3]) -> Option<String> {
    let most = largest(color);
    let divided = || format!("{most} is far beyond white: red, green, blue are from 0 to 1, bytes divided by 255");
    (most > BRIGHT).then(divided)
}
