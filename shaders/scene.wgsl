// Rays through a whole scene: its bodies (march.wgsl), its hard shapes, its ground; light and colour where they meet something.
// crate/cells/src/pack.rs lays out the data. Follows view.wgsl, sky.wgsl, solid.wgsl, the shapes' files and march.wgsl.

struct Frame {
    // A point straight ahead of the eye, near the scene; w: how far ahead.
    middle: vec4f,
    // Numbers of bodies, of planes, of nodes of the hierarchy of other hard shapes; a bit for each light that casts shadows.
    counts: vec4u,
    // Where bodies, hard shapes and the hierarchy begin in the data.
    places: vec4u,
}

@group(0) @binding(2) var<uniform> frame: Frame;

// What a ray meets first. `normal` has any length.
struct Meeting {
    met: bool,
    t: f32,
    normal: vec3f,
    paint: vec3f,
    // Number of a material, or MIXED and where a leaf's mixture begins.
    look: u32,
    // How far above the surface rays to lights begin: by what is less than a pixel, but of patches, whose light is that of a
    // round surface, above their neighbours.
    lift: f32,
    cell: Cell,
}

const MIXED: u32 = 0x80000000u;
const LIFT: f32 = 2e-4;
const LIFT_OF_PATCH: f32 = 4e-3;

// The lift of the surface that is seen.
var<private> lift: f32;

// Whether the plane of a patch is met within it.
fn is_in_patch(ray: Ray, solid: Solid) -> bool {
    if abs(ray.direction.z) < 1e-12 {
        return false;
    }
    let s = -ray.origin.z / ray.direction.z;
    let at = ray.origin.xy + s * ray.direction.xy;
    let p = solid.a.xy;
    let q = solid.a.zw;
    let r = solid.b.xy;
    let room = 1e-6 * area(p, q, r);
    return area(at, q, r) >= -room && area(at, r, p) >= -room && area(at, p, q) >= -room;
}

fn meet_solid(place: u32, origin: vec3f, direction: vec3f, first: f32, last: f32) -> Meeting {
    var out: Meeting;
    out.met = false;
    let own = four_floats(place);
    let rotation = four_floats(place + 1u);
    let low = four(place + 4u);
    let high = four(place + 5u);
    let solid = Solid(
        four_floats(place + 2u),
        four_floats(place + 3u),
        bitcast<vec3f>(low.xyz),
        bitcast<vec3f>(high.xyz),
    );
    let unit = own.w;
    let offset = unrotate(rotation, origin - own.xyz) / unit;
    var ray: Ray;
    ray.direction = unrotate(rotation, direction);
    let start = dot(offset, ray.direction);
    ray.origin = offset - start * ray.direction;
    ray.start = start + first / unit;
    var hit = MISS;
    switch high.w {
        case 0u: {
            hit = meet_sphere(ray, solid);
        }
        case 1u: {
            hit = meet_cylinder(ray, solid);
        }
        case 2u: {
            hit = meet_arc(ray, solid);
        }
        case 3u: {
            hit = meet_triangle(ray, solid);
        }
        case 4u: {
            hit = meet_plane(ray, solid);
        }
        default: {
            if is_in_patch(ray, solid) {
                hit = meet_patch(ray, solid);
            }
        }
    }
    let t = (hit.s - start) * unit;
    // A soft plane within its body's octree is drawn with the body.
    let away = abs(origin + t * direction);
    let is_beyond = high.w != 4u || max(away.x, max(away.y, away.z)) >= solid.a.y;
    if hit.met && hit.s > ray.start && t < last && is_beyond {
        out.met = true;
        out.t = t;
        out.normal = rotate(rotation, hit.normal);
        out.paint = hit.paint;
        out.look = low.w;
        out.lift = select(LIFT, LIFT_OF_PATCH, high.w > 4u);
    }
    return out;
}

// The first thing that a ray meets between two places. For a ray to a light `any` is enough, and it passes surfaces that it
// leaves.
fn meet_scene(origin: vec3f, direction: vec3f, first: f32, last: f32, any: bool) -> Meeting {
    var best: Meeting;
    best.met = false;
    best.t = last;
    for (var i = 0u; i < frame.counts.y; i++) {
        let found = meet_solid(frame.places.y + 6u * i, origin, direction, first, best.t);
        if found.met {
            best = found;
        }
    }
    let inverse = 1.0 / select(direction, vec3f(1e-20), abs(direction) < vec3f(1e-20));
    var node = 0u;
    for (var i = 0u; i < 100000u; i++) {
        if node >= frame.counts.z || (any && best.met) {
            break;
        }
        let low = four(frame.places.z + 2u * node);
        let high = four(frame.places.z + 2u * node + 1u);
        let one = (bitcast<vec3f>(low.xyz) - origin) * inverse;
        let other = (bitcast<vec3f>(high.xyz) - origin) * inverse;
        let near = min(one, other);
        let far = max(one, other);
        let enter = max(max(near.x, near.y), max(near.z, first));
        let leave = min(min(far.x, far.y), min(far.z, best.t));
        if enter > leave {
            // On to the node after all those within this one.
            node = low.w;
            continue;
        }
        if high.w != 0xffffffffu {
            let found = meet_solid(frame.places.y + 6u * high.w, origin, direction, first, best.t);
            if found.met {
                best = found;
            }
        }
        node++;
    }
    for (var i = 0u; i < frame.counts.x; i++) {
        if any && best.met {
            break;
        }
        let place = frame.places.x + 2u * i;
        let cube = four_floats(place);
        let root = Cell(four(place + 1u).x, cube.w, cube.xyz);
        let found = march(root, origin, direction, first, best.t, any);
        if found.met {
            best.met = true;
            best.t = found.t;
            best.normal = -found.gradient;
            best.paint = WHITE;
            best.cell = found.cell;
            best.lift = LIFT;
            best.look = four(found.cell.word & PLACE).x;
        }
    }
    return best;
}

// The share of a light that comes to a place.
fn unblocked(light: u32, place: vec3f, normal: vec3f, towards: vec3f, limit: f32) -> f32 {
    if ((frame.counts.w >> light) & 1u) == 0u {
        return 1.0;
    }
    let above = lift + 2e-6 * length(place);
    let found = meet_scene(place + above * normal, towards, above, limit, true);
    return select(1.0, 0.0, found.met);
}

// The look of a place: one material's, or a mixture that changes evenly in a leaf.
fn look_at(met: Meeting, place: vec3f) -> Look {
    if met.look < MIXED {
        var look = look_of(met.look);
        look.ambient *= met.paint;
        look.diffuse *= met.paint;
        return look;
    }
    let start = (met.cell.word & PLACE) + 6u;
    let p = clamp((place - met.cell.center) / met.cell.half, vec3f(-1.0), vec3f(1.0));
    var sums = array<vec4f, 3>();
    for (var i = 0u; i < 3u; i++) {
        sums[i] = four_floats(start + 4u * i)
            + p.x * four_floats(start + 4u * i + 1u)
            + p.y * four_floats(start + 4u * i + 2u)
            + p.z * four_floats(start + 4u * i + 3u);
    }
    let ambient = max(sums[0], vec4f(0.0));
    return Look(ambient.rgb, ambient.w, max(sums[1].rgb, vec3f(0.0)), max(sums[2].rgb, vec3f(0.0)));
}

// What is seen at a place of the picture.
struct Seen {
    colour: vec4f,
    // Unit vector, turned to the eye.
    normal: vec3f,
    // From the eye, in draft units; less than 0 where no surface is.
    distance: f32,
}

fn see(position: vec2f) -> Seen {
    evaluations = 0u;
    lift = LIFT;
    let way = way_at(position);
    let long = length(way);
    let gaze = way / long;
    // The ray starts near the scene, so that it keeps its digits however far away the eye is.
    let before = frame.middle.w * long;
    let origin = frame.middle.xyz + frame.middle.w * (way - view.forward.xyz);
    let met = meet_scene(origin, gaze, -before, 1e30, false);
    let ground = ground_along(gaze);
    var out: Seen;
    out.distance = -1.0;
    if met.met {
        let distance = met.t + before;
        let place = origin + met.t * gaze;
        let outward = normalize(met.normal);
        out.normal = select(outward, -outward, dot(outward, gaze) > 0.0);
        out.distance = distance;
        lift = met.lift;
        if ground.y == 0.0 || distance < ground.x {
            let light = phong(look_at(met, place), place, gaze, out.normal);
            out.colour = written(foggy(light, gaze, distance));
            return out;
        }
    }
    var shade = 1.0;
    lift = LIFT;
    if ground.y > 0.0 {
        let place = view.eye.xyz + ground.x * gaze;
        shade = sun(place);
    }
    out.colour = written(behind(gaze, ground, shade));
    return out;
}

// The share of the lights' light on the ground that is not in shadow.
fn sun(place: vec3f) -> f32 {
    let up = view.zenith.xyz;
    var all = 1e-6;
    var open = 1e-6;
    for (var i = 0u; i < 8u; i++) {
        if f32(i) >= view.picture.w {
            break;
        }
        let light = view.lights[i];
        let way = light.place.xyz - light.place.w * place;
        let towards = way / max(length(way), 1e-30);
        let slope = dot(up, towards);
        if slope > 0.0 {
            let strength = slope * spot(light, towards) * dot(light.colour.rgb, vec3f(1.0));
            all += strength;
            let limit = select(1e30, length(way), light.place.w > 0.5);
            open += strength * unblocked(i, place, up, towards, limit);
        }
    }
    return open / all;
}
