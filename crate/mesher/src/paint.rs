//! Colours and materials of meshes.

use crate::caps::{self, Caps};
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use field::Skeleton;
use glam::DVec3;
use mesh::{Group, Material, TriangleMesh, roughness_from_phong};
use scene::flat_ends::FlatEnd;
use scene::{Element, Finish, Scene, Surface};
use std::collections::BTreeMap;

/// The material of a finish.
fn material(finish: &Finish) -> Material {
    Material {
        name: finish.name.clone(),
        color: finish
            .diffuse
            .map(|c| if c > 0.0 { c.min(1.0) } else { 0.0 }),
        roughness: roughness_from_phong(f64::from(finish.shine)),
    }
}

/// The colours of a soft surface: those of its elements, mixed by their shares.
pub struct Paint<'a> {
    surface: &'a Surface,
    /// The material of each primitive.
    of: Vec<u32>,
    materials: Vec<Material>,
    ends: Vec<FlatEnd>,
}

impl<'a> Paint<'a> {
    /// The colours of a surface.
    pub fn new(scene: &Scene, surface: &'a Surface) -> Self {
        let mut numbers = BTreeMap::new();
        let mut materials = Vec::new();
        let of = surface.element().iter().map(|element| {
            let finish = scene.elements[*element as usize].finish;
            *numbers.entry(finish).or_insert_with(|| {
                materials.push(material(&scene.finishes[finish as usize]));
                materials.len() as u32 - 1
            })
        });
        Self {
            of: of.collect(),
            materials,
            ends: scene.flat_ends(surface.body()),
            surface,
        }
    }

    /// Gives a mesh one group with the material that most primitives have, further ones of flat
    /// ends, and vertex colours if there are several materials.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn apply(
        &self,
        mesh: &mut TriangleMesh,
        threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Caps, MeshError> {
        let mut counts = vec![0; self.materials.len()];
        self.of.iter().for_each(|i| counts[*i as usize] += 1);
        // The first of the most frequent ones.
        let most = (0..counts.len()).rev().max_by_key(|i| counts[*i]);
        mesh.groups = vec![Group {
            name: String::new(),
            material: most.map(|i| self.materials[i].clone()),
            triangles: 0..mesh.triangles.len() as u32,
        }];
        if self.materials.len() > 1 {
            let colors = map_told(threads, &mesh.positions, progress, |p| self.color(*p))?;
            mesh.colors = Some(colors);
        }
        Ok(caps::part(mesh, &self.ends))
    }

    fn color(&self, point: DVec3) -> [f32; 3] {
        let mut shares = Vec::new();
        self.surface.function().shares(point, &mut shares);
        let total: f64 = shares.iter().map(|(_, share)| share).sum();
        let mut color = [0.0; 3];
        for (i, share) in shares {
            let own = self.materials[self.of[i as usize] as usize].color;
            for (sum, own) in color.iter_mut().zip(own) {
                *sum += f64::from(own) * share / total;
            }
        }
        color.map(|c| c as f32)
    }
}

/// Meshes of hard elements, sorted by finish.
pub struct Parts<'a> {
    scene: &'a Scene,
    of_finish: BTreeMap<u32, Vec<TriangleMesh>>,
}

impl<'a> Parts<'a> {
    /// No meshes yet.
    pub fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            of_finish: BTreeMap::new(),
        }
    }

    /// Adds a mesh of an element. Where that has paint the vertices get the colour at the nearest
    /// corner, and the finish is the one that the colours multiply.
    pub fn add(&mut self, mesh: &TriangleMesh, element: &Element) {
        let mut mesh = mesh.clone();
        let mut finish = element.finish;
        if let Some((paint, corners)) = self.paint(element) {
            finish = paint.finish;
            let base = material(&self.scene.finishes[finish as usize]).color;
            let color = |position: &DVec3| {
                let off = |i: &usize| corners[*i].distance_squared(*position);
                let nearest = (0..3).min_by(|i, j| off(i).total_cmp(&off(j)));
                let own = paint.corners[nearest.unwrap_or(0)];
                [0, 1, 2].map(|k| base[k] * own[k])
            };
            mesh.colors = Some(mesh.positions.iter().map(color).collect());
        }
        self.of_finish.entry(finish).or_default().push(mesh);
    }

    /// The paint of a triangle or patch, with its corners.
    fn paint<'e>(&self, element: &'e Element) -> Option<(&'e scene::Paint, [DVec3; 3])> {
        let Some(&Skeleton::Triangle { corners }) = element.shape.skeleton() else {
            return None;
        };
        let paint = element.paint.as_deref()?;
        ((paint.finish as usize) < self.scene.finishes.len()).then_some((paint, corners))
    }

    /// One mesh with a group for each finish, and with vertex colours if there is paint. If asked,
    /// vertices at the same place become one: their normals are added up, and their colours
    /// averaged.
    pub fn mesh(self, is_welded: bool) -> TriangleMesh {
        let mut all = TriangleMesh::default();
        let (mut normals, mut colors) = (Vec::new(), Vec::new());
        let mut is_painted = false;
        let mut places = BTreeMap::new();
        for (finish, meshes) in self.of_finish {
            let start = all.triangles.len() as u32;
            let finish = &self.scene.finishes[finish as usize];
            let material = material(finish);
            for mesh in meshes {
                is_painted |= mesh.colors.is_some();
                let mut add = |i: usize| {
                    let position = mesh.positions[i];
                    let normal = mesh.normals.as_ref().map_or(DVec3::ZERO, |n| n[i]);
                    let color = mesh.colors.as_ref().map_or(material.color, |c| c[i]);
                    let next = all.positions.len() as u32;
                    // −0 is 0.
                    let key = (position + 0.0).to_array().map(f64::to_bits);
                    let place = if is_welded {
                        *places.entry(key).or_insert(next)
                    } else {
                        next
                    };
                    if place == next {
                        all.positions.push(position);
                        normals.push(DVec3::ZERO);
                        colors.push(([0.0; 3], 0));
                    }
                    normals[place as usize] += normal;
                    let (sum, count) = &mut colors[place as usize];
                    *sum = [0, 1, 2].map(|k| sum[k] + f64::from(color[k]));
                    *count += 1;
                    place
                };
                let numbers: Vec<u32> = (0..mesh.positions.len()).map(&mut add).collect();
                let triangles = mesh
                    .triangles
                    .iter()
                    .map(|t| t.map(|i| numbers[i as usize]));
                // Without those that welding has made flat.
                all.triangles
                    .extend(triangles.filter(|[a, b, c]| a != b && b != c && c != a));
            }
            all.groups.push(Group {
                name: finish.name.clone(),
                material: Some(material),
                triangles: start..all.triangles.len() as u32,
            });
        }
        if normals.iter().any(|normal| *normal != DVec3::ZERO) {
            all.normals = Some(normals);
        }
        if is_painted {
            let mean = |(sum, count): ([f64; 3], u32)| sum.map(|c| (c / f64::from(count)) as f32);
            all.colors = Some(colors.into_iter().map(mean).collect());
        }
        all
    }
}

/// A mesh with the colours of its materials at its vertices, if it has none there.
pub fn colored(mesh: &TriangleMesh) -> TriangleMesh {
    let mut colored = mesh.clone();
    colored.colors.get_or_insert_with(|| {
        let mut of = vec![[1.0; 3]; mesh.positions.len()];
        for group in &mesh.groups {
            let range = group.triangles.start as usize..group.triangles.end as usize;
            for i in mesh.triangles[range].as_flattened() {
                of[*i as usize] = group.material.as_ref().map_or([1.0; 3], |m| m.color);
            }
        }
        of
    });
    colored
}

/// The connected parts of a mesh, with its normals and vertex colours.
pub fn shells(mesh: &TriangleMesh) -> Vec<TriangleMesh> {
    let roots = roots(mesh);
    let mut number = BTreeMap::new();
    let mut shells: Vec<(TriangleMesh, BTreeMap<u32, u32>)> = Vec::new();
    for triangle in &mesh.triangles {
        let own = *number
            .entry(roots[triangle[0] as usize])
            .or_insert_with(|| {
                shells.push((TriangleMesh::default(), BTreeMap::new()));
                shells.len() - 1
            });
        let (shell, places) = &mut shells[own];
        let corners = triangle.map(|i| {
            *places.entry(i).or_insert_with(|| {
                let from = i as usize;
                shell.positions.push(mesh.positions[from]);
                if let Some(normals) = &mesh.normals {
                    shell.normals.get_or_insert_default().push(normals[from]);
                }
                if let Some(colors) = &mesh.colors {
                    shell.colors.get_or_insert_default().push(colors[from]);
                }
                shell.positions.len() as u32 - 1
            })
        });
        shell.triangles.push(corners);
    }
    shells.into_iter().map(|(shell, _)| shell).collect()
}

/// For each vertex the lowest number of one in the same connected part.
pub fn roots(mesh: &TriangleMesh) -> Vec<u32> {
    let mut root: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    fn find(root: &mut [u32], mut i: u32) -> u32 {
        while root[i as usize] != i {
            root[i as usize] = root[root[i as usize] as usize];
            i = root[i as usize];
        }
        i
    }
    for [a, b, c] in &mesh.triangles {
        for other in [*b, *c] {
            let [one, other] = [find(&mut root, *a), find(&mut root, other)];
            root[one.max(other) as usize] = one.min(other);
        }
    }
    (0..root.len() as u32).map(|i| find(&mut root, i)).collect()
}
