// The plane z = 0, thickened to a slab. a.x: half the thickness, 0 for a plane; a.y: see scene.wgsl.

fn meet_plane(ray: Ray, solid: Solid) -> Hit {
    let faces = between(ray.origin.z, ray.direction.z, solid.a.x);
    if faces.x > faces.y {
        return MISS;
    }
    return Hit(faces.y < 1e29, boundary(ray, faces.x, faces.y), vec3f(0.0, 0.0, 1.0), WHITE);
}
