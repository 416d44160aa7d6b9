// What all of the draft's pictures share: the camera, the lights, the air, and the shading of a point.
//
// Lengths are in *draft units*: the scene is moved and scaled so that its middle is the origin and
// its radius 1, whatever units the author chose.

struct Light {
    // w = 1: where a point light stands. w = 0: the direction towards a distant light.
    place: vec4f,
    // w: of a spot, the angle over which it fades, in radians.
    colour: vec4f,
    // Of a spot, where it shines to; w: the angle at which its light ends, in radians. w = 0: no spot.
    aim: vec4f,
}

struct View {
    // Unit vector to the right in the picture; w: tangent of half the horizontal angle of view.
    right: vec4f,
    // Unit vector up in the picture; w: tangent of half the vertical angle of view.
    up: vec4f,
    // Unit vector into the picture; w, and that of the eye: where the middle of the picture lies, as tangents up and to the right.
    forward: vec4f,
    eye: vec4f,
    // x, y: one over the number of samples across and down; z: gamma; w: how many lights count.
    picture: vec4f,
    lights: array<Light, 8>,
    // Unit vector up; w: how many colours the background has.
    zenith: vec4f,
    // Colours from above to below.
    background: array<vec4f, 4>,
    // The fog's colour; w: one over the distance at which 1/e of the light is left, 0 without fog.
    fog: vec4f,
    // The ground's colour; w: 1 if there is one.
    ground: vec4f,
    // Light of the sky from above and from the horizon; w of the first: 1 if there is a sky.
    sky: vec4f,
    horizon: vec4f,
    // x: the ground's height; y: the height up to which fog is dense; z: one over the height over which it thins out, 0
    // if it does not; w: 1 for filmic tone.
    levels: vec4f,
}

@group(0) @binding(0) var<uniform> view: View;
// Three texels a material: ambient and shine, diffuse, specular.
@group(0) @binding(1) var materials: texture_2d<f32>;

// As in crate/preview/src/materials.rs.
const MATERIALS_A_ROW: u32 = 512u;

// Share of a spot's light that goes against the unit vector `towards`; 1 of other lights.
fn spot(light: Light, towards: vec3f) -> f32 {
    if light.aim.w <= 0.0 {
        return 1.0;
    }
    let angle = acos(clamp(-dot(towards, light.aim.xyz), -1.0, 1.0));
    return smoothstep(0.0, 1.0, (light.aim.w - angle) / max(light.colour.w, 1e-6));
}

// Light of the sky on a surface, as if nothing stood before it: about the mean over all directions, by their cosines. From
// straight above 2/3 of it have the colour of the zenith.
fn daylight(normal: vec3f) -> vec3f {
    let up = 1.0 + dot(normal, view.zenith.xyz);
    return view.sky.w * mix(view.horizon.rgb, view.sky.rgb, up * up / 6.0);
}

// The length of a path through fog as if all of it were as dense as below.
fn thick(from_height: f32, slope: f32, distance: f32) -> f32 {
    if view.levels.z == 0.0 {
        return distance;
    }
    // Eight pieces, each as dense as in its middle.
    var sum = 0.0;
    for (var i = 0; i < 8; i++) {
        let height = from_height + slope * distance * (f32(i) + 0.5) / 8.0 - view.levels.y;
        sum += exp(-max(height, 0.0) * view.levels.z);
    }
    return distance * sum / 8.0;
}

// What is left of light that comes from a distance, and the fog's own.
fn foggy(light: vec3f, gaze: vec3f, distance: f32) -> vec3f {
    let way = thick(dot(view.eye.xyz, view.zenith.xyz), dot(gaze, view.zenith.xyz), distance);
    return mix(view.fog.rgb, light, exp(-way * view.fog.w));
}

// Light as the picture writes it: tone, then gamma.
fn written(light: vec3f) -> vec4f {
    let over = max(light - vec3f(0.6), vec3f(0.0)) / 0.4;
    let film = min(light, vec3f(0.6)) + 0.4 * over / (vec3f(1.0) + over);
    let toned = select(light, film, view.levels.w > 0.5);
    return vec4f(pow(clamp(toned, vec3f(0.0), vec3f(1.0)), vec3f(1.0 / view.picture.z)), 1.0);
}

// The way from the eye through a place of the picture, in samples, to the plane at the distance 1 along the view: the ray of
// the projection that the tracer uses too, through the middle of the sample.
fn way_at(position: vec2f) -> vec3f {
    let across = vec2f(2.0, -2.0) * (position * view.picture.xy) + vec2f(-1.0, 1.0);
    return view.forward.xyz
        + (across.x * view.right.w + view.eye.w) * view.right.xyz
        + (across.y * view.up.w + view.forward.w) * view.up.xyz;
}

// The parameters of Phong's model at a point.
struct Look {
    ambient: vec3f,
    shine: f32,
    diffuse: vec3f,
    specular: vec3f,
}

fn look_of(material: u32) -> Look {
    let texel = vec2u((material % MATERIALS_A_ROW) * 3u, material / MATERIALS_A_ROW);
    let ambient = textureLoad(materials, texel, 0);
    let diffuse = textureLoad(materials, texel + vec2u(1u, 0u), 0).rgb;
    let specular = textureLoad(materials, texel + vec2u(2u, 0u), 0).rgb;
    return Look(ambient.rgb, ambient.w, diffuse, specular);
}

// Colour of a point: Phong's model with all lights. `gaze` is the unit vector from the eye to it, `normal` is turned to the
// eye. A program's last file says how much of a light's way is free:
//     fn unblocked(light: u32, place: vec3f, normal: vec3f, towards: vec3f, limit: f32) -> f32
fn phong(look: Look, place: vec3f, gaze: vec3f, normal: vec3f) -> vec3f {
    let mirrored = reflect(gaze, normal);
    var colour = look.ambient + look.diffuse * daylight(normal);
    for (var i = 0u; i < 8u; i++) {
        if f32(i) >= view.picture.w {
            break;
        }
        let light = view.lights[i];
        let way = light.place.xyz - light.place.w * place;
        let towards = way / max(length(way), 1e-30);
        let slope = dot(normal, towards);
        if slope <= 0.0 {
            continue;
        }
        let limit = select(1e30, length(way), light.place.w > 0.5);
        let share = spot(light, towards) * unblocked(i, place, normal, towards, limit);
        // No highlight away from the mirror's side, even for an exponent of 0. (And pow of
        // nothing is undefined on a GPU.)
        let gleam = dot(mirrored, towards);
        let highlight = select(0.0, pow(max(gleam, 1e-20), look.shine), gleam > 0.0);
        colour += share * light.colour.rgb * (look.diffuse * slope + look.specular * highlight);
    }
    return colour;
}
