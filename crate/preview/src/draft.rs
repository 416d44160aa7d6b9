//! The draft itself: a scene on the GPU, and the passes that draw it.

use crate::bounds::Bounds;
use crate::facets;
use crate::instance::{Instance, Instances, Units};
use crate::materials;
use crate::mesh::{Mesh, Uploaded};
use crate::pipelines::Pipelines;
use crate::solid::{Kind, Solid};
use crate::targets::{Sampling, Targets};
use crate::view::{Air, Lights, Tone, View};
use scene::{Camera, Scene, Shape};

/// Elements that the draft takes; of more, the first ones are drawn.
pub const MAX_ELEMENTS: usize = 200_000;

/// Numbers of a scene's elements and lights that are drawn or left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drawn {
    /// Elements that are drawn.
    pub elements: usize,
    /// Elements without anything to see: no size, numbers that are not finite, or a soft element
    /// whose strength is not positive (it carves, or does nothing).
    pub invisible: usize,
    /// Elements left out because of [`MAX_ELEMENTS`] or the device's memory limits.
    pub left_out: usize,
    /// Lights left out: the draft takes [`crate::MAX_LIGHTS`], the strongest.
    pub lights_left_out: usize,
}

/// A scene on the GPU, drawn as offset surfaces.
///
/// Make one for a device, hand it scenes with [`Draft::set_scene`] and draw with
/// [`Draft::render`]. Before the first scene it draws an empty one.
pub struct Draft {
    pipelines: Pipelines,
    /// The instances of hard elements, and of soft ones.
    instances: [[Instances; Kind::COUNT]; 2],
    /// The mesh that is drawn in place of the soft ones.
    mesh: Option<Uploaded>,
    bindings: wgpu::BindGroup,
    units: Units,
    lights: Lights,
    tone: Tone,
    air: Air,
    sampling: Sampling,
    targets: Option<Targets>,
    generation: u64,
}

impl Draft {
    /// A draft of an empty scene. Compiles the shaders.
    #[must_use]
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let pipelines = Pipelines::new(device);
        let empty = Scene::default();
        let materials = materials::upload(device, queue, &empty);
        let units = Bounds::of(&empty).units();
        Self {
            bindings: pipelines.bind_materials(device, &materials.view),
            pipelines,
            instances: Default::default(),
            mesh: None,
            units,
            lights: Lights::new(&[], units).0,
            tone: Tone::of(&empty),
            air: Air::new(&empty, units, 0.0),
            sampling: Sampling::default(),
            targets: None,
            generation: 0,
        }
    }

    /// Replaces the scene: its elements at the radius that counts ([`Scene::radius`]), materials,
    /// lights, background and gamma. The scene's own camera is not used, and a mesh stays. Returns
    /// the numbers of what is drawn.
    pub fn set_scene(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        scene: &Scene,
    ) -> Drawn {
        let materials = materials::upload(device, queue, scene);
        self.bindings = self.pipelines.bind_materials(device, &materials.view);
        self.tone = Tone::of(scene);
        self.units = Bounds::of(scene).units();
        let (lights, lights_left_out) = Lights::new(&scene.lights, self.units);
        self.lights = lights;
        self.air = Air::of(scene, self.units);

        let mut drawn = Drawn {
            lights_left_out,
            ..Drawn::default()
        };
        let limit = Instances::limit(device);
        let mut both: [[Vec<Instance>; Kind::COUNT]; 2] = Default::default();
        let detail = facets::detail(scene);
        for element in &scene.elements {
            let lists = &mut both[usize::from(scene.is_soft(element))];
            let is_quadric = matches!(element.shape, Shape::Quadric(_));
            if is_quadric && lists[Kind::Patch as usize].len() >= facets::MOST {
                drawn.left_out += 1;
                continue;
            }
            let solids = Solid::of(scene, element, detail);
            if solids.is_empty() {
                drawn.invisible += 1;
                continue;
            }
            let room = solids
                .iter()
                .all(|solid| lists[solid.kind as usize].len() + solids.len() <= limit);
            if drawn.elements == MAX_ELEMENTS || !room {
                drawn.left_out += 1;
                continue;
            }
            drawn.elements += 1;
            for solid in solids {
                let paint = element.paint.as_ref().filter(|_| solid.kind == Kind::Patch);
                let finish = paint.map_or(element.finish, |paint| paint.finish);
                let material = materials.slot(finish as usize);
                let solid = solid.move_origin_near(self.units.center);
                lists[solid.kind as usize].push(Instance::new(&solid, material, self.units));
            }
        }
        for (instances, lists) in self.instances.iter_mut().zip(&both) {
            for (kind, list) in Kind::ALL.into_iter().zip(lists) {
                instances[kind as usize].write(device, queue, kind, list);
            }
        }
        drawn
    }

    /// Draws a mesh in place of the scene's soft elements from now on, or with `None` their offset
    /// surfaces again. One that has no triangles, or is too large for the device, counts as none.
    /// Returns whether there is one.
    pub fn set_mesh(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        mesh: Option<&Mesh<'_>>,
    ) -> bool {
        self.mesh = mesh.and_then(|mesh| Uploaded::new(device, queue, mesh));
        self.mesh.is_some()
    }

    /// Sets the number of samples of each pixel.
    pub fn set_sampling(&mut self, sampling: Sampling) {
        self.sampling = sampling;
    }

    /// Draws the scene from a camera into a picture of `size` pixels and gives its view
    /// (`Rgba8Unorm`, gamma applied, no sRGB conversion; opaque).
    ///
    /// The rays are those of [`Camera::projection`] for `size`. The view's size is `size`, except
    /// where the device's textures are smaller: then it is the largest of the same proportions.
    /// The view stays the same from call to call while [`Draft::generation`] does.
    pub fn render(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        camera: &Camera,
        size: [u32; 2],
    ) -> &wgpu::TextureView {
        let targets = match self.targets.take() {
            Some(targets) if targets.serve(size, self.sampling) => targets,
            _ => {
                self.generation += 1;
                Targets::new(device, &self.pipelines, size, self.sampling)
            }
        };
        let view = View::new(
            camera,
            size,
            targets.samples,
            self.units,
            self.tone,
            &self.lights,
            self.air,
        );
        queue.write_buffer(&self.pipelines.view, 0, bytemuck::bytes_of(&view));
        let tone = [self.tone.gamma, 0.0, 0.0, 0.0];
        queue.write_buffer(&self.pipelines.tone, 0, bytemuck::bytes_of(&tone));

        if let Some(mesh) = &self.mesh {
            mesh.place(queue, self.units);
        }
        self.draw_elements(encoder, &targets);
        if let Some((_, samples)) = &targets.oversized {
            self.resolve(encoder, &targets.view, samples);
        }
        &self.targets.insert(targets).view
    }

    /// Counts how often the picture's texture was made anew, because the size or the sampling
    /// changed. When it differs, the view must be registered elsewhere again.
    #[must_use]
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The picture drawn last, for reading it back (`COPY_SRC`).
    #[must_use]
    pub fn texture(&self) -> Option<&wgpu::Texture> {
        self.targets.as_ref().map(|targets| &targets.picture)
    }

    /// Size of the picture drawn last, in pixels.
    #[must_use]
    pub fn size(&self) -> Option<[u32; 2]> {
        self.targets.as_ref().map(|targets| targets.size)
    }

    fn draw_elements(&self, encoder: &mut wgpu::CommandEncoder, targets: &Targets) {
        let [red, green, blue] = self.tone.background;
        let colour = targets
            .oversized
            .as_ref()
            .map_or(&targets.view, |(view, _)| view);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("draft"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: colour,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color {
                        r: red,
                        g: green,
                        b: blue,
                        a: 1.0,
                    }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &self.bindings, &[]);
        if !self.air.is_plain() {
            pass.set_pipeline(&self.pipelines.backdrop);
            pass.draw(0..3, 0..1);
        }
        let [hard, soft] = &self.instances;
        let drawn = [Some(hard), Some(soft).filter(|_| self.mesh.is_none())];
        for (kind, instances) in drawn
            .into_iter()
            .flatten()
            .flat_map(|lists| Kind::ALL.into_iter().zip(lists))
        {
            pass.set_pipeline(&self.pipelines.elements[kind as usize]);
            instances.draw(&mut pass, kind.cover().1);
        }
        if let Some(mesh) = &self.mesh {
            pass.set_pipeline(&self.pipelines.mesh);
            mesh.draw(&mut pass);
        }
    }

    fn resolve(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        view: &wgpu::TextureView,
        samples: &wgpu::BindGroup,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("resolve"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&self.pipelines.resolve);
        pass.set_bind_group(0, samples, &[]);
        pass.draw(0..3, 0..1);
    }
}
