//! Checks of what a scene begins with beside its own particles: cloths, boxes, strands, ropes and soft bodies.

use super::check_shape::check_shape;
use super::filling::MOST_OF_SOFT;
use super::numbers::{Checked, above_zero, check_breaking, finite, zero_or_more};
use super::tuft::along;
use super::{Air, BoxForm, Boxes, Cloth, Curl, Field, Form, Growth, Scatter, SceneError, SceneFile, StrandAir, Tuft};
use crate::cloth::{ClothSprings, Sheet};
use crate::math::{dot, length};
use crate::motion::Motion;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use glam::Vec3;

/// As many particles as the sheets of a scene may have: with springs of all kinds, a run takes about 3 GB.
const MOST_OF_SHEETS: u64 = 1 << 22;
/// As many boxes as a scene may have: they take about 9 kB each.
const MOST_BOXES: u64 = 1 << 16;
/// As many particles as the strands of a scene may have.
const MOST_OF_STRANDS: u64 = 1 << 22;

impl SceneFile {
    pub(super) fn check_fabrics(&self) -> Result<(), SceneError> {
        let mut count = 0u64;
        for (i, cloth) in self.cloths.iter().enumerate() {
            let at = format!("cloths[{i}]");
            let refuse = |field: &str, message: &str| Err(SceneError::value(format!("{at}.{field}"), message));
            cloth.check_springs(&at)?;
            cloth.check_material(&at)?;
            finite(&format!("{at}.drag"), &[cloth.drag])?;
            finite(&format!("{at}.elasticity"), &[cloth.elasticity])?;
            finite(&format!("{at}.velocity"), &cloth.velocity.to_array())?;
            check_breaking(&format!("{at}.breaks_at"), cloth.breaks_at)?;
            if let Some(gas) = cloth.gas {
                zero_or_more(&format!("{at}.gas.amount"), gas.amount)?;
                finite(&format!("{at}.gas.outside"), &[gas.outside])?;
            }
            if cloth.gas.is_some() && matches!(cloth.form, Form::Sheet(_)) {
                return refuse("gas", "a sheet has no inside; only a closed mesh can hold gas");
            }
            let place = |sheet: &Sheet| [sheet.corner, sheet.sides[0], sheet.sides[1]];
            if matches!(&cloth.form, Form::Sheet(sheet) if !place(sheet).iter().all(|v| v.is_finite())) {
                return refuse("form", "corner and sides have to be finite");
            }
            if matches!(&cloth.form, Form::Sheet(sheet) if !(length(sheet.sides[0].cross(sheet.sides[1])) > 0.0)) {
                return refuse("form", "its sides have to be longer than zero and not parallel: they span no area");
            }
            if let Some(cells) =
                cloth.sheet().map(|sheet| sheet.cells).filter(|cells| cells.contains(&0) && cloth.needs_triangles())
            {
                let message = format!(
                    "has to be 1 at least along both sides, not {cells:?}: without triangles there is nothing to weigh or to stretch"
                );
                return refuse("form.sheet.cells", &message);
            }
            let more = cloth.count().unwrap_or(0);
            count = count.saturating_add(more);
            if count > MOST_OF_SHEETS {
                let message = format!(
                    "makes {more} particles; the sheets of a scene may have {MOST_OF_SHEETS}: take fewer cells"
                );
                return refuse("form", &message);
            }
            if let Some(number) =
                cloth.fixed.iter().find(|&&n| cloth.count().is_some_and(|count| u64::from(n) >= count))
            {
                return refuse(
                    "fixed",
                    &format!("particle {number} is out of range; there are {}, from 0", cloth.count().unwrap_or(0)),
                );
            }
            self.check_material(&at, cloth.material)?;
        }
        Ok(())
    }

    pub(super) fn check_boxes(&self) -> Checked {
        let mut count = 0u64;
        for (i, boxes) in self.boxes.iter().enumerate() {
            let at = |field: &str| format!("boxes[{i}].{field}");
            boxes.check_size(&at)?;
            let spacing = boxes.spacing.unwrap_or_default();
            let vectors = [boxes.position, spacing, boxes.turn, boxes.velocity, boxes.spin, boxes.load];
            let names = ["position", "spacing", "turn", "velocity", "spin", "load"];
            for (name, vector) in names.into_iter().zip(vectors) {
                finite(&at(name), &vector.to_array())?;
            }
            if boxes.load.to_array().into_iter().any(|load| load.abs() >= 1.0) {
                return Err(SceneError::value(at("load"), "has to be within -1 and 1, a share of the mass of a side"));
            }
            let Scatter { position, turn, velocity, spin, seed: _ } = boxes.scatter.unwrap_or_default();
            for (name, number) in [("position", position), ("turn", turn), ("velocity", velocity), ("spin", spin)] {
                zero_or_more(&at(&format!("scatter.{name}")), number)?;
            }
            if let BoxForm::Solid(solid) = &boxes.form {
                above_zero(&at("form.solid.within"), solid.within)?;
                if !(1..=255).contains(&solid.pieces) {
                    return Err(SceneError::value(at("form.solid.pieces"), "has to be from 1 to 255"));
                }
            }
            finite(&at("drag"), &[boxes.drag])?;
            finite(&at("elasticity"), &[boxes.elasticity])?;
            count = count.saturating_add(boxes.number());
            if count > MOST_BOXES {
                let message = format!("makes {} boxes; a scene may have {MOST_BOXES}", boxes.number());
                return Err(SceneError::value(at("count"), message));
            }
            self.check_material(&format!("boxes[{i}]"), boxes.material)?;
        }
        Ok(())
    }

    pub(super) fn check_strands(&self) -> Checked {
        let mut count = 0u64;
        for (i, tuft) in self.strands.iter().enumerate() {
            let at = format!("strands[{i}]");
            tuft.check(&at, self)?;
            count = count.saturating_add(tuft.particles());
            if count > MOST_OF_STRANDS {
                let message =
                    format!("makes {} particles; the strands of a scene may have {MOST_OF_STRANDS}", tuft.particles());
                return Err(SceneError::value(at, message));
            }
        }
        Ok(())
    }
}

impl SceneFile {
    /// Checks ropes, and ties but for what they tie.
    pub(super) fn check_ropes(&self) -> Checked {
        let mut count = 0u64;
        for (i, cord) in self.ropes.iter().enumerate() {
            let at = format!("ropes[{i}]");
            cord.check(&at)?;
            self.check_material(&at, cord.material)?;
            count = count.saturating_add(cord.particles());
            if count > MOST_OF_STRANDS {
                let message =
                    format!("makes {} particles; the ropes of a scene may have {MOST_OF_STRANDS}", cord.particles());
                return Err(SceneError::value(at, message));
            }
        }
        self.ties.iter().enumerate().try_for_each(|(i, tie)| tie.check(&format!("ties[{i}]")))
    }
}

impl SceneFile {
    /// Checks soft bodies, but for what their meshes say.
    pub(super) fn check_soft_bodies(&self) -> Checked {
        let mut count = 0u64;
        for (i, body) in self.soft_bodies.iter().enumerate() {
            let at = format!("soft_bodies[{i}]");
            body.check(&at)?;
            self.check_material(&at, body.material)?;
            let more = body.particles().unwrap_or(0);
            count = count.saturating_add(more);
            if count > MOST_OF_SOFT {
                let message = format!(
                    "makes {more} particles; the soft bodies of a scene may have {MOST_OF_SOFT}: take a wider one"
                );
                return Err(SceneError::value(format!("{at}.spacing"), message));
            }
        }
        Ok(())
    }
}

impl StrandAir {
    /// Checks it; beside it there is so much linear drag.
    pub(super) fn check(&self, at: &str, drag: f32) -> Checked {
        let Self { diameter, density, viscosity, friction } = *self;
        if drag != 0.0 {
            return Err(SceneError::value(format!("{at}.drag"), "say either drag or air"));
        }
        above_zero(&format!("{at}.air.diameter"), diameter.unwrap_or(1.0))?;
        let numbers = [("density", density), ("viscosity", viscosity), ("friction", friction)];
        numbers.into_iter().try_for_each(|(name, number)| zero_or_more(&format!("{at}.air.{name}"), number))
    }
}

impl Boxes {
    /// Checks how large they are and what they weigh; `at` makes the name of a field.
    fn check_size(&self, at: &impl Fn(&str) -> String) -> Checked {
        if let Some(sides) = self.sides {
            sides.to_array().into_iter().try_for_each(|side| above_zero(&at("sides"), side))?;
        } else if !self.form.has_size() {
            return Err(SceneError::value(at("sides"), "are missing: say how large it is along x, y and z, in m"));
        }
        match self.density {
            Some(_) if self.mass != 0.0 => Err(SceneError::value(at("density"), "say either density or mass")),
            Some(density) => above_zero(&at("density"), density),
            None if self.mass == 0.0 => {
                Err(SceneError::value(at("mass"), "is missing, or zero: say it, in kg, or the density, in kg/m³"))
            }
            None => above_zero(&at("mass"), self.mass),
        }
    }
}

impl Cloth {
    fn check_springs(&self, at: &str) -> Checked {
        let ClothSprings { structural, shear, bend } = self.springs;
        for (name, params) in [("structural", structural), ("shear", shear), ("bend", bend)] {
            let Some(params) = params else { continue };
            zero_or_more(&format!("{at}.springs.{name}.ks"), params.ks)?;
            zero_or_more(&format!("{at}.springs.{name}.kd"), params.kd)?;
        }
        if self.is_shell() || [structural, shear, bend].iter().any(Option::is_some) {
            return Ok(());
        }
        let message = "has to name structural, shear or bend springs, such as {\"structural\": {\"ks\": 100}}, unless it is a shell";
        Err(SceneError::value(format!("{at}.springs"), message))
    }

    /// Checks what it weighs, what it is made of and the air around it.
    fn check_material(&self, at: &str) -> Result<(), SceneError> {
        self.check_weight(at)?;
        self.check_hung(at)?;
        if let Some(isotropic) = self.isotropic {
            if self.shell.is_some() || self.hung.is_some() {
                let message =
                    "say one of isotropic, by its modulus, shell, by its stiffness, and hung, by what it does";
                return Err(SceneError::value(format!("{at}.isotropic"), message));
            }
            isotropic.check(&format!("{at}.isotropic"))?;
        }
        if let Some((field, message)) = self.shell.and_then(|params| params.fault()) {
            return Err(SceneError::value(format!("{at}.shell.{field}"), message));
        }
        if let Some(thickness) = self.thickness {
            above_zero(&format!("{at}.thickness"), thickness)?;
        }
        self.check_limits(at)?;
        let Some(Air { density, drag, lift, friction }) = self.air else { return Ok(()) };
        let numbers = [("density", density), ("drag", drag), ("lift", lift), ("friction", friction)];
        numbers.into_iter().try_for_each(|(name, number)| zero_or_more(&format!("{at}.air.{name}"), number))
    }

    fn check_weight(&self, at: &str) -> Checked {
        let by_volume = self.isotropic.and_then(|isotropic| isotropic.density);
        match self.density {
            Some(_) if self.mass != 0.0 => {
                Err(SceneError::value(format!("{at}.density"), "say either density or mass"))
            }
            _ if by_volume.is_some() && (self.density.is_some() || self.mass != 0.0) => {
                let message = "in kg/m³, says what it weighs; say that, or the cloth's density, in kg/m², or its mass";
                Err(SceneError::value(format!("{at}.isotropic.density"), message))
            }
            Some(density) => above_zero(&format!("{at}.density"), density),
            None if by_volume.is_some() => Ok(()),
            None if self.isotropic.is_some() && self.mass == 0.0 => {
                let message = "is missing: say it, in kg/m³, or the cloth's density, in kg/m², or its mass";
                Err(SceneError::value(format!("{at}.isotropic.density"), message))
            }
            None if self.mass == 0.0 => {
                let message = "is missing, or zero: say it, in kg, or the cloth's density, in kg/m²";
                Err(SceneError::value(format!("{at}.mass"), message))
            }
            None => above_zero(&format!("{at}.mass"), self.mass),
        }
    }

    fn check_hung(&self, at: &str) -> Checked {
        let Some(hung) = self.hung else { return Ok(()) };
        let refuse = |field: &str, message: &str| Err(SceneError::value(format!("{at}.hung{field}"), message));
        if self.shell.is_some() {
            return refuse("", "say either hung, by what it does, or shell, by its stiffness");
        }
        if self.density.is_none() {
            return refuse("", "needs the cloth's density, in kg/m², in place of its mass");
        }
        if !matches!(self.form, Form::Sheet(_)) {
            return refuse("", "is for sheets, which have sides to hang along; say shell");
        }
        hung.stretch.into_iter().try_for_each(|percent| above_zero(&format!("{at}.hung.stretch"), percent))?;
        for (name, number) in [("shear", hung.shear), ("bending", hung.bending), ("damping", hung.damping)] {
            zero_or_more(&format!("{at}.hung.{name}"), number)?;
        }
        // What a sheet without area is refused for is said below.
        match self.shell_params().and_then(|params| params.fault()) {
            Some(_) => {
                refuse(".stretch", "makes it stiffer or softer than 32-bit floats can tell; some 0.1 to 10 are usual")
            }
            None => Ok(()),
        }
    }

    fn check_limits(&self, at: &str) -> Result<(), SceneError> {
        let Some(params) = self.limits else { return Ok(()) };
        if self.is_shell() {
            let message = "are those of cloth made of springs; a shell is as stiff as its own stretch and shear say";
            return Err(SceneError::value(format!("{at}.limits"), message));
        }
        if self.breaks_at.is_some() {
            let message = "hold triangles together whose springs have broken; it has to go without breaks_at";
            return Err(SceneError::value(format!("{at}.limits"), message));
        }
        let Some((name, message)) = params.fault() else { return Ok(()) };
        let value = match name {
            "warp" => format!("{:?}", params.warp.unwrap_or_default()),
            "weft" => format!("{:?}", params.weft.unwrap_or_default()),
            "shear" => format!("{}", params.shear.unwrap_or_default()),
            "compliance" => format!("{}", params.compliance),
            _ => format!("{}", params.damping),
        };
        let is_empty = params.warp.is_none() && name == "warp";
        let message = if is_empty { message.into() } else { format!("{message}, not {value}") };
        Err(SceneError::value(format!("{at}.limits.{name}"), message))
    }
}

impl Tuft {
    fn check(&self, at: &str, file: &SceneFile) -> Checked {
        let refuse = |field: &str, message: &str| Err(SceneError::value(format!("{at}.{field}"), message));
        if !(1..=10_000).contains(&self.segments) {
            return refuse("segments", &format!("has to be from 1 to 10000, not {}", self.segments));
        }
        for (name, number) in [("radius", self.radius), ("young", self.young), ("density", self.density)] {
            above_zero(&format!("{at}.{name}"), number)?;
        }
        for (name, number) in [("damping", self.damping), ("drag", self.drag), ("width", self.width)] {
            zero_or_more(&format!("{at}.{name}"), number)?;
        }
        if !(0.0..=0.5).contains(&self.poisson) {
            return refuse("poisson", &format!("has to be from 0 to 0.5, not {}", self.poisson));
        }
        self.check_turning(at)?;
        self.air.map_or(Ok(()), |air| air.check(at, self.drag))?;
        if self.attach.is_some() && self.motion.is_some() {
            return refuse("attach", "say either attach or motion: what is attached goes where its body goes");
        }
        finite(&format!("{at}.elasticity"), &[self.elasticity])?;
        if let Some(message) = self.motion.as_ref().and_then(Motion::fault) {
            return refuse("motion", message);
        }
        if let Some(number) = self.fixed.iter().find(|&&number| number > self.segments) {
            return refuse("fixed", &format!("point {number} is out of range; the last is {}", self.segments));
        }
        match &self.form {
            Growth::Curve(places) => {
                finite(&format!("{at}.form.curve"), &places.iter().flat_map(Vec3::to_array).collect::<Vec<_>>())?;
                let way: f32 = places.windows(2).map(|ends| length(ends[1] - ends[0])).sum();
                if !(way > 0.0 && way.is_finite()) {
                    return refuse("form.curve", "has to lead through two places at least that are not the same");
                }
                let points = along(places, self.segments);
                if let Some(before) = points.windows(3).position(turns_back) {
                    let message = format!(
                        "turns back onto itself at point {}: give it a bend, or other segments than {}",
                        before + 1,
                        self.segments
                    );
                    return refuse("form.curve", &message);
                }
            }
            Growth::On(field) => field.check(&format!("{at}.form.on"))?,
        }
        file.check_material(at, self.material)
    }
}

/// Tells whether three places of a strand turn back, so that there is no telling to which side it bends.
fn turns_back(places: &[Vec3]) -> bool {
    let [one, other] = [places[1] - places[0], places[2] - places[1]];
    !(dot(one, other) > -0.9999 * length(one) * length(other))
}

impl Tuft {
    fn check_turning(&self, at: &str) -> Checked {
        let at = format!("{at}.turning");
        finite(&at, &self.turning)?;
        let is_loose = |&end: &usize| self.turning[end] != 0.0 && !self.held[end] && !self.is_clamped(end);
        let Some(end) = [0, 1].into_iter().find(is_loose) else { return Ok(()) };
        let name = ["root", "tip"][end];
        let message =
            format!("needs a {name} that is held, or clamped by two neighbours in fixed: else nothing is turned there");
        Err(SceneError::value(at, message))
    }
}

impl Field {
    fn check(&self, at: &str) -> Checked {
        above_zero(&format!("{at}.length"), self.length)?;
        zero_or_more(&format!("{at}.spread"), self.spread)?;
        finite(&format!("{at}.lean"), &self.lean.to_array())?;
        for corner in self.within.into_iter().flatten() {
            finite(&format!("{at}.within"), &corner.to_array())?;
        }
        if let Some(Curl { radius, pitch }) = self.curl {
            zero_or_more(&format!("{at}.curl.radius"), radius)?;
            above_zero(&format!("{at}.curl.pitch"), pitch)?;
        }
        check_shape(&format!("{at}.shape"), &self.shape)
    }
}
