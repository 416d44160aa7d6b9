// Rays through the octree of a body: crate/cells/src/octree.rs says what its cells are. A program's last files read its
// data and have the formulas of terms that leaves list, and those of their profiles:
//     fn four(i: u32) -> vec4<u32>
//     fn plain_term(kind: u32, at: u32, count: u32, p: vec3f) -> vec4f
//     fn profile_of_term(kind: u32, at: u32, count: u32, p: vec3f) -> vec4f

const THRESHOLD: f32 = 1.0;
// Words of cells: less than this lead to eight words of parts, a word of this or more tells by its two upper bits.
const OUTSIDE: u32 = 0x40000000u;
const INSIDE: u32 = 0x80000000u;
const LEAF: u32 = 0xc0000000u;
const PLACE: u32 = 0x3fffffffu;

// Evaluations of cubics and terms for a pixel.
var<private> evaluations: u32;

fn four_floats(i: u32) -> vec4f {
    return bitcast<vec4f>(four(i));
}

struct Cell {
    word: u32,
    half: f32,
    center: vec3f,
}

// The smallest cell around a point.
fn cell_at(root: Cell, point: vec3f) -> Cell {
    var cell = root;
    for (var i = 0u; i < 40u; i++) {
        if cell.word >= OUTSIDE {
            break;
        }
        let upper = point >= cell.center;
        let part = select(0u, 1u, upper.x) + select(0u, 2u, upper.y) + select(0u, 4u, upper.z);
        let words = four(cell.word + (part >> 2u));
        let pair = select(words.xy, words.zw, (part & 2u) != 0u);
        cell.word = select(pair.x, pair.y, (part & 1u) != 0u);
        cell.half *= 0.5;
        cell.center += select(vec3f(-cell.half), vec3f(cell.half), upper);
    }
    return cell;
}

// Value, less the threshold, and gradient of a leaf's cubic at a point.
fn cubic(cell: Cell, point: vec3f) -> vec4f {
    evaluations++;
    let place = (cell.word & PLACE) + 1u;
    let p = (point - cell.center) / cell.half;
    let a = four_floats(place);
    let b = four_floats(place + 1u);
    let c = four_floats(place + 2u);
    let d = four_floats(place + 3u);
    let e = four_floats(place + 4u);
    // Coefficients of 1 x y z; xx yy zz xy; xz yz xyz xxx; yyy zzz xxy xxz; xyy yyz xzz yzz.
    let square = vec3f(b.x, b.y, b.z);
    let mixed = vec3f(b.w, c.x, c.y);
    let cube = vec3f(c.w, d.x, d.y);
    let pp = p * p;
    let value = a.x - THRESHOLD
        + dot(a.yzw, p)
        + dot(square, pp)
        + dot(mixed, p.xxy * p.yzz)
        + dot(cube, pp * p)
        + c.z * p.x * p.y * p.z
        + pp.x * (d.z * p.y + d.w * p.z)
        + pp.y * (e.x * p.x + e.y * p.z)
        + pp.z * (e.z * p.x + e.w * p.y);
    let gradient = a.yzw
        + 2.0 * square * p
        + 3.0 * cube * pp
        + mixed.xxy * p.yxx
        + mixed.yzz * p.zzy
        + c.z * p.yxx * p.zzy
        + vec3f(2.0 * p.x * (d.z * p.y + d.w * p.z), pp.x * d.z, pp.x * d.w)
        + vec3f(pp.y * e.x, 2.0 * p.y * (e.x * p.x + e.y * p.z), pp.y * e.y)
        + vec3f(pp.z * e.z, pp.z * e.w, 2.0 * p.z * (e.z * p.x + e.w * p.y));
    return vec4f(value, gradient / cell.half);
}

// Value, less the threshold, and gradient of the function in a leaf: its cubic, and the terms that it lists.
fn field_at(cell: Cell, head: vec4<u32>, point: vec3f) -> vec4f {
    var sum = cubic(cell, point);
    for (var i = 0u; i < head.y; i++) {
        evaluations++;
        let term = four(head.w + i);
        var jet = plain_term(term.x & 0xffffu, term.y, term.w, point);
        if term.x > 0xffffu {
            let factor = profile_of_term(term.x >> 16u, term.z, term.w, point);
            jet = vec4f(jet.x * factor.x, jet.yzw * factor.x + jet.x * factor.yzw);
        }
        sum += jet;
    }
    return sum;
}

// The first place from 0 to 1 where the cubic with these coefficients, of 1 u u² u³, has left its sign; more than 1 if there is
// none.
fn first_root(c: vec4f, sign: f32) -> f32 {
    // Places where it turns.
    let square = c.z * c.z - 3.0 * c.w * c.y;
    var turns = vec2f(2.0);
    if square > 0.0 {
        let sum = -(c.z + select(-1.0, 1.0, c.z >= 0.0) * sqrt(square));
        let one = sum / select(3.0 * c.w, 1e-30, abs(c.w) < 1e-30);
        let other = c.y / select(sum, 1e-30, abs(sum) < 1e-30);
        turns = vec2f(min(one, other), max(one, other));
    }
    var low = 0.0;
    var high = 2.0;
    for (var i = 0u; i < 3u; i++) {
        var place = 1.0;
        if i == 0u {
            place = turns.x;
        }
        if i == 1u {
            place = turns.y;
        }
        if place <= low || place > 1.0 {
            continue;
        }
        if sign * (c.x + place * (c.y + place * (c.z + place * c.w))) < 0.0 {
            high = place;
            break;
        }
        low = place;
    }
    if high > 1.5 {
        return 2.0;
    }
    // Newton's steps between the bounds.
    var u = 0.5 * (low + high);
    for (var i = 0u; i < 10u; i++) {
        let value = c.x + u * (c.y + u * (c.z + u * c.w));
        let slope = c.y + u * (2.0 * c.z + u * 3.0 * c.w);
        if sign * value < 0.0 {
            high = u;
        } else {
            low = u;
        }
        let next = u - value / select(slope, 1e-30, abs(slope) < 1e-30);
        u = select(0.5 * (low + high), next, next > low && next < high);
    }
    return u;
}

// A crossing of a ray with a body's surface.
struct Crossing {
    met: bool,
    t: f32,
    // Of the function: it points inwards.
    gradient: vec3f,
    cell: Cell,
}

// Most cells that a ray passes.
const MOST_CELLS: u32 = 1024u;

// The first crossing of a ray with a body's surface; of `entries` only those where it goes in.
fn march(root: Cell, origin: vec3f, direction: vec3f, first: f32, last: f32, entries: bool) -> Crossing {
    var out: Crossing;
    out.met = false;
    let safe = select(direction, vec3f(1e-20), abs(direction) < vec3f(1e-20));
    let inverse = 1.0 / safe;
    let middles = (root.center - origin) * inverse;
    let reach = root.half * abs(inverse);
    let enter = middles - reach;
    let leave = middles + reach;
    var t = max(max(enter.x, enter.y), max(enter.z, first));
    let end = min(min(leave.x, leave.y), min(leave.z, last));
    // 1 inside, -1 outside, 0 as long as it is not known.
    var side = 0.0;
    var gradient = vec3f(0.0);
    for (var i = 0u; i < MOST_CELLS; i++) {
        if t >= end {
            break;
        }
        let point = origin + t * direction;
        let cell = cell_at(root, point);
        let outer = (cell.center - origin) * inverse + cell.half * abs(inverse);
        var exit = min(max(min(outer.x, min(outer.y, outer.z)), t), end);
        if cell.word < LEAF {
            let known = select(-1.0, 1.0, cell.word >= INSIDE);
            let goes = side * known < 0.0 && !(entries && known < 0.0);
            if goes && dot(gradient, gradient) > 0.0 {
                out.met = true;
                out.t = t;
                out.gradient = gradient;
                return out;
            }
            side = known;
        } else {
            // Look, number of terms, longest span, where the terms begin.
            let head = four(cell.word & PLACE);
            exit = min(exit, t + bitcast<f32>(head.z));
            let here = field_at(cell, head, point);
            let there = field_at(cell, head, origin + exit * direction);
            out.cell = cell;
            let known = select(-1.0, 1.0, here.x >= 0.0);
            // At the edge of two cells their cubics differ a little.
            if side * known < 0.0 && !(entries && known < 0.0) {
                out.met = true;
                out.t = t;
                out.gradient = here.yzw;
                return out;
            }
            side = known;
            gradient = there.yzw;
            let span = exit - t;
            let slopes = span * vec2f(dot(here.yzw, direction), dot(there.yzw, direction));
            let rise = there.x - here.x;
            let c = vec4f(
                here.x,
                slopes.x,
                3.0 * rise - 2.0 * slopes.x - slopes.y,
                slopes.x + slopes.y - 2.0 * rise,
            );
            let u = first_root(c, side);
            if u <= 1.0 {
                t += u * span;
                if !(entries && side > 0.0) {
                    let found = field_at(cell, head, origin + t * direction);
                    let slope = dot(found.yzw, direction);
                    let step = -found.x / select(slope, 1e30, abs(slope) < 1e-20);
                    out.met = true;
                    out.t = t + clamp(step, -0.05 * span, 0.05 * span);
                    out.gradient = found.yzw;
                    return out;
                }
                side = -side;
                t += 2e-6 * max(1.0, abs(t));
                continue;
            }
        }
        t = exit + 2e-6 * max(1.0, abs(exit));
    }
    return out;
}
