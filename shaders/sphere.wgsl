// A ball about the origin. a.x: its radius.

fn meet_sphere(ray: Ray, solid: Solid) -> Hit {
    // The ray's origin is its point nearest to the centre, so half the chord follows by Pythagoras.
    let square = solid.a.x * solid.a.x - dot(ray.origin, ray.origin);
    if square < 0.0 {
        return MISS;
    }
    let half_chord = sqrt(square);
    let s = boundary(ray, -half_chord, half_chord);
    return Hit(true, s, ray.origin + s * ray.direction, WHITE);
}
