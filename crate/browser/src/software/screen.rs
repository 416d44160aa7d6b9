//! Takes egui's output away from eframe's idle GPU and puts it on the canvas.

use egui::{Context, FullOutput, Plugin};
use wasm_bindgen::{Clamped, JsCast, JsValue};
use web_sys::{CanvasRenderingContext2d, HtmlCanvasElement, ImageData};

use painter::Painter;

/// A line width that no line has. A canvas forgets it together with its pixels when its size is
/// set, even to the same size, and so shows that it must be painted anew.
const MARK: f64 = 7.0;

/// Paints everything that egui shows on a canvas, which has no context yet.
///
/// # Errors
/// If the browser gives no context for drawing.
pub fn install(context: &Context, canvas: &HtmlCanvasElement) -> Result<(), String> {
    let settings = js_sys::Object::new();
    // The window is opaque, and its pixels are written rather than drawn.
    for (name, value) in [("alpha", false), ("willReadFrequently", true)] {
        js_sys::Reflect::set(&settings, &name.into(), &value.into())
            .map_err(|error| format!("{error:?}"))?;
    }
    let target = canvas
        .get_context_with_context_options("2d", &settings)
        .ok()
        .flatten()
        .and_then(|context| context.dyn_into::<CanvasRenderingContext2d>().ok())
        .ok_or("the canvas cannot be drawn on")?;
    context.add_plugin(Screen {
        canvas: canvas.clone(),
        target,
        painter: Painter::default(),
    });
    Ok(())
}

struct Screen {
    canvas: HtmlCanvasElement,
    target: CanvasRenderingContext2d,
    painter: Painter,
}

impl Screen {
    fn paint(&mut self, context: &Context, output: &mut FullOutput) -> Result<(), JsValue> {
        let size = [self.canvas.width(), self.canvas.height()];
        if size.contains(&0) {
            return Ok(());
        }
        if self.target.line_width() != MARK {
            self.target.set_line_width(MARK);
            self.painter.forget();
        }
        let primitives =
            context.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point);
        let changed = self.painter.paint(
            size.map(|side| side as usize),
            output.pixels_per_point,
            &primitives,
            context.global_style().visuals.panel_fill.to_opaque(),
        );
        if changed.is_empty() {
            return Ok(());
        }
        let image = ImageData::new_with_u8_clamped_array_and_sh(
            Clamped(self.painter.pixels()),
            size[0],
            size[1],
        )?;
        for area in changed {
            self.target
                .put_image_data_with_dirty_x_and_dirty_y_and_dirty_width_and_dirty_height(
                    &image,
                    0.0,
                    0.0,
                    f64::from(area.x0),
                    f64::from(area.y0),
                    f64::from(area.x1 - area.x0),
                    f64::from(area.y1 - area.y0),
                )?;
        }
        Ok(())
    }
}

impl Plugin for Screen {
    fn debug_name(&self) -> &'static str {
        "software screen"
    }

    fn output_hook(&mut self, context: &Context, output: &mut FullOutput) {
        self.painter.set_textures(&mut output.textures_delta);
        if let Err(error) = self.paint(context, output) {
            web_sys::console::error_2(&"The window could not be drawn:".into(), &error);
        }
        self.painter.free_textures(&mut output.textures_delta);
        // Nothing is left for the idle GPU.
        output.shapes.clear();
    }
}
