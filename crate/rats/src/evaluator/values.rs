//! The values that `report` tells: of materials, lights, the camera, settings and variables.

use super::palette::Surface;
use super::state::Evaluator;
use crate::value::Value;
use scene::{Background, Light, LightKind, Rgb};
use std::collections::BTreeMap;

/// Most things of a kind whose values are told.
const MOST: usize = 40;

/// Returns a line for each of some things, and one for the number of those left out.
fn list<T>(things: impl Iterator<Item = T>, line: impl Fn(T) -> String) -> Vec<String> {
    let mut things = things;
    let mut lines: Vec<String> = things.by_ref().take(MOST).map(line).collect();
    let left_out = things.count();
    if left_out > 0 {
        lines.push(format!("… and {left_out} more"));
    }
    lines
}

fn colour([r, g, b]: Rgb) -> String {
    format!("{r} {g} {b}")
}

fn place(p: glam::DVec3) -> String {
    format!("{} {} {}", p.x, p.y, p.z)
}

/// Returns `value` behind a word, or nothing if it is the usual one.
fn unless<T: PartialEq>(word: &str, value: T, usual: T, write: impl Fn(T) -> String) -> String {
    if value == usual {
        return String::new();
    }
    format!(", {word} {}", write(value))
}

fn number(x: f64) -> String {
    x.to_string()
}

/// Returns whether a word of `report` asks for what one of these names.
fn is_asked(word: &str, names: &[&str]) -> bool {
    word == "all" || names.contains(&word)
}

/// Returns the word for whether something is on.
fn switch(is_on: bool) -> &'static str {
    if is_on { "on" } else { "off" }
}

/// Returns the values of a material.
fn material(surface: &Surface) -> String {
    let (finish, flesh) = (&surface.finish, &surface.flesh);
    let black = [0.0; 3];
    let mut line = format!(
        "{}: diffuse {}, ambient {}",
        finish.name,
        colour(finish.diffuse),
        colour(finish.ambient)
    );
    line += &unless("specular", finish.specular, black, colour);
    line += &unless("reflective", finish.reflective, black, colour);
    line += &unless("transparent", finish.transparent, black, colour);
    line += &unless("shine", finish.shine, 0.0, |x| x.to_string());
    line += &unless("index", finish.index, 1.0, |x| x.to_string());
    line += &unless("dispersion", finish.dispersion, 0.0, |x| x.to_string());
    line += &unless("layers", finish.layers.len(), 0, |n| n.to_string());
    line += &unless("radius", flesh.radius, 0.0, number);
    if let Some(end) = flesh.end_radius {
        line += &format!(" to {end}");
    }
    if let Some(b) = flesh.blobbiness {
        line += &format!(", blobbiness {b}");
    }
    if let Some(end) = flesh.end_blobbiness {
        line += &format!(" to {end}");
    }
    line += &unless("depth", flesh.depth, 0.0, number);
    line += &unless("strength", flesh.strength, 1.0, number);
    line += &unless("restriction", flesh.restriction, 0.0, number);
    if let Some(kernel) = flesh.kernel {
        line += &format!(", kernel {}", kernel.name());
    }
    line
}

/// Returns the values of a light.
fn light(light: &Light) -> String {
    let kind = match light.kind {
        LightKind::Point { position } => format!("point, position {}", place(position)),
        LightKind::Distant { towards } => format!("distant, direction {}", place(-towards)),
        LightKind::Spot {
            position,
            direction,
            angle,
            ..
        } => format!(
            "spot, position {}, direction {}, angle {angle}",
            place(position),
            place(direction)
        ),
    };
    let size = unless("size", light.size, 0.0, number);
    let shadow = if light.shadow { "" } else { ", noshadow" };
    format!("{} {kind}{size}{shadow}", colour(light.colour))
}

/// Returns a background's value.
pub fn background(background: &Background) -> String {
    match background {
        Background::Colour(only) => format!("the background {}", colour(*only)),
        Background::Gradient(colours) => format!("a background of {} colours", colours.len()),
        Background::Image(_) => String::from("an image as the background"),
    }
}

impl Evaluator<'_> {
    /// Returns lines with the values that a word of `report` asks for.
    pub(super) fn values_of(&self, word: &str) -> Vec<String> {
        let mut lines = Vec::new();
        if is_asked(word, &["data", "model"]) {
            lines.push(self.shapes());
        }
        if is_asked(word, &["surfaces"]) {
            let mut named: Vec<&Surface> = self.palette.with_names().collect();
            named.sort_by(|a, b| a.finish.name.cmp(&b.finish.name));
            lines.extend(list(named.into_iter(), material));
        }
        if is_asked(word, &["textures"]) {
            lines.push(format!("{} textures", self.palette.textures()));
        }
        if is_asked(word, &["lights"]) {
            lines.extend(list(self.lights.iter(), light));
        }
        if is_asked(word, &["background"]) {
            lines.push(background(&self.air.background()));
            if let Some((sky, _)) = self.air.sky {
                lines.push(format!(
                    "sky {} to {}, samples {}",
                    colour(sky.colour),
                    colour(sky.horizon),
                    sky.samples
                ));
            }
            if let Some(ground) = self.air.ground {
                let height = unless("height", ground.height, None, |h| number(h.unwrap_or(0.0)));
                lines.push(format!("ground {}{height}", colour(ground.colour)));
            }
        }
        if is_asked(word, &["clouds"]) {
            lines.extend(list(self.air.clouds.iter(), |cloud| {
                let at = place(cloud.position);
                let (radius, density) = (cloud.radius, cloud.density);
                let colour = colour(cloud.colour);
                format!("cloud {colour}, position {at}, radius {radius}, density {density}")
            }));
        }
        if is_asked(word, &["cameras"]) {
            lines.push(self.camera_values());
        }
        if is_asked(word, &["fog"]) {
            let distance = self.camera.eye.distance(self.camera.target);
            lines.extend(self.air.fog(distance).map(|fog| {
                let height = unless("height", fog.height, None, |h| number(h.unwrap_or(0.0)));
                format!(
                    "fog {}, distance {}{height}",
                    colour(fog.colour),
                    fog.distance
                )
            }));
        }
        if is_asked(word, &["options"]) {
            lines.push(self.option_values());
        }
        if is_asked(word, &["var"]) {
            let variables: BTreeMap<&str, Value> = self.scope.variables().collect();
            lines.extend(list(variables.into_iter(), |(name, value)| match value {
                Value::Scalar(x) => format!("{name} = {x}"),
                Value::Vector(v) => format!("{name} = {}", place(v)),
                Value::Colour(c) => format!("{name} = rgb({}, {}, {})", c.x, c.y, c.z),
                Value::Name(symbol) => format!("{name} = {}", self.scope.symbols.word(symbol)),
            }));
        }
        lines
    }

    /// Returns the numbers of shapes of each kind.
    fn shapes(&self) -> String {
        let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
        let parts = self.model.parts.iter().filter(|part| !part.removed);
        for part in parts.clone() {
            let bone = part.element.shape.bone();
            *kinds
                .entry(bone.map_or("other", scene::Bone::name))
                .or_default() += 1;
        }
        let soft = parts
            .clone()
            .filter(|part| part.element.flesh.is_some())
            .count();
        let kinds: Vec<_> = kinds
            .iter()
            .map(|(kind, n)| format!("{kind} {n}"))
            .collect();
        let count = parts.count();
        let kinds = if count > 0 {
            format!(": {}", kinds.join(", "))
        } else {
            String::new()
        };
        format!("{count} shapes, {soft} of them soft{kinds}")
    }

    fn camera_values(&self) -> String {
        let camera = &self.camera;
        let lens = self.lens;
        let mut line = format!(
            "eyep {}, vrp {}, vup {}, fov {}",
            place(camera.eye),
            place(camera.target),
            place(camera.up),
            camera.fov
        );
        if let Some(cp) = self.view_plane.cp.or(self.view_plane.parallel) {
            let weight = u8::from(self.view_plane.parallel.is_none());
            line += &format!(", cp {} {weight}", place(cp));
        }
        if let Some(normal) = self.view_plane.normal {
            line += &format!(", vpn {}", place(normal));
        }
        if let Some([left, right, low, high]) = self.view_plane.window {
            line += &format!(", window {left} {right} {low} {high}");
        }
        line += &unless("aperture", lens.aperture, 0.0, number);
        line += &unless("focus", lens.focus, None, |focus| {
            number(focus.unwrap_or(0.0))
        });
        line + &unless("shutter", self.shutter, 0.0, number)
    }

    fn option_values(&self) -> String {
        let settings = &self.settings;
        let [width, height] = settings.frame;
        let samples = match settings.block {
            1 => settings.samples.to_string(),
            block => format!("1/{block}"),
        };
        format!(
            "framesize {width} {height}, sample {samples}, contrast {}, gamma {}, soft {}, double \
             {}, penumbra {}, maxdepth {}, vanish {}, epsilon {}, influence {}, blobscale {}, \
             filename {}",
            colour(settings.contrast),
            settings.gamma,
            switch(settings.soft),
            switch(settings.double_sided),
            switch(settings.penumbra),
            settings.max_depth,
            settings.vanish,
            settings.epsilon,
            settings.influence,
            match settings.blob_scale {
                field::BlobScale::Absolute => "absolute",
                field::BlobScale::Relative => "relative",
            },
            self.output.file(),
        )
    }
}
