//! Figures of one scene: from overlays to drawings, and these onto the target.

use crate::canvas::Canvas;
use crate::drawing::{Drawing, Vertex, flat};
use crate::model::Model;
use crate::over_picture::{self, Picture};
use crate::paper::Paper;
use crate::plans::Plans;
use crate::{Error, Options, Overlay, alternate, clip_space, pyramid};
use zfail_plan::view::View;
use zfail_render::{Gpu, wgpu};
use zfail_scene::{Light, Pose, Scene};

/// Draws figures of a scene, as often and of as many kinds as wanted.
#[derive(Debug)]
pub struct Figures<'g> {
    gpu: &'g Gpu,
    model: Model,
    plans: Plans,
    canvas: Canvas<'g>,
    /// Whether the scene's surfaces on the device are those of the model.
    uploaded: bool,
    last: Option<(Request, Drawing)>,
}

/// What a drawing was made for.
#[derive(Clone, Debug, PartialEq)]
struct Request {
    overlays: Vec<Overlay>,
    view: View,
    options: Options,
}

impl<'g> Figures<'g> {
    /// Takes what figures need of `scene`.
    ///
    /// # Errors
    /// If the scene is inconsistent or the device fails.
    pub fn new(gpu: &'g Gpu, scene: &Scene) -> Result<Self, Error> {
        let figures = Self {
            gpu,
            model: Model::new(scene)?,
            plans: Plans::default(),
            canvas: Canvas::new(gpu),
            uploaded: false,
            last: None,
        };
        gpu.check()?;
        Ok(figures)
    }

    /// Replaces the scene; pipelines and textures stay.
    ///
    /// # Errors
    /// If the scene is inconsistent. The old one stays then.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<(), Error> {
        self.model = Model::new(scene)?;
        self.plans = Plans::default();
        self.moved();
        Ok(())
    }

    /// Moves the scene's instances and lights, and the vertices of meshes that bend.
    ///
    /// # Errors
    /// If the pose bends a mesh that is rigid or has another number of vertices.
    pub fn set_pose(&mut self, pose: &Pose) -> Result<(), Error> {
        self.moved();
        self.model.set_pose(pose)
    }

    /// Replaces the lights, of which there may be more or fewer than before.
    pub fn set_lights(&mut self, lights: &[Light]) {
        self.model.set_lights(lights);
        self.last = None;
    }

    fn moved(&mut self) {
        self.uploaded = false;
        self.last = None;
    }

    /// Draws `overlays` over the picture of `view` that `target` holds, or instead of it if one of them
    /// [replaces the picture](Overlay::replaces_picture): the first such one does, and those of the others that have a
    /// meaning there are drawn into it.
    ///
    /// `target` is `Rgba8Unorm` with sRGB encoded by hand, single-sampled, a render attachment, and of the view's size, as
    /// `zfail_render::Renderer::shown`.
    ///
    /// # Errors
    /// If `options` name a light that does not exist, a caster cannot be planned, or the device fails.
    pub fn draw(
        &mut self,
        overlays: &[Overlay],
        view: &View,
        options: &Options,
        target: &wgpu::Texture,
    ) -> Result<(), Error> {
        check_target(target, view)?;
        if overlays.is_empty() {
            return Ok(());
        }
        let request = Request { overlays: overlays.to_vec(), view: *view, options: options.clone() };
        let drawing = match self.last.take() {
            Some((last, drawing)) if last == request => drawing,
            _ => {
                let drawing = self.compose(&request)?;
                self.canvas.set_drawing(&drawing, view.size)?;
                drawing
            }
        };
        if !self.uploaded {
            self.canvas.set_scene(&surfaces(&self.model))?;
            self.uploaded = true;
        }
        self.canvas.draw(&drawing, &target.create_view(&wgpu::TextureViewDescriptor::default()), view.size);
        self.last = Some((request, drawing));
        self.gpu.check()?;
        Ok(())
    }

    fn compose(&mut self, Request { overlays, view, options }: &Request) -> Result<Drawing, Error> {
        let count = self.model.lights.len();
        let lights: Vec<usize> = options.lights.clone().unwrap_or_else(|| (0..count).collect());
        if let Some(&index) = lights.iter().find(|&&l| l >= count) {
            return Err(Error::UnknownLight { index, count });
        }
        let (model, plans) = (&mut self.model, &mut self.plans);
        let Some(&kind) = overlays.iter().find(|o| o.replaces_picture()) else {
            let picture = Picture { overlays, view, lights: &lights, technique: options.technique };
            return over_picture::compose(model, plans, &picture);
        };
        let from = options.from.unwrap_or_default().sane();
        let paper = Paper { overlays, view, lights: &lights, technique: options.technique, from };
        match kind {
            Overlay::ClipSpace => clip_space::compose(model, plans, &paper),
            Overlay::Pyramid => pyramid::compose(model, plans, &paper),
            _ => alternate::compose(model, plans, &paper),
        }
    }
}

/// What hides, in the order and with the corners in which light caps are drawn.
fn surfaces(model: &Model) -> Vec<Vertex> {
    let mut vertices = Vec::new();
    for (i, instance) in model.instances.iter().enumerate() {
        let mirrored = model.place(i).mirrored;
        for (t, face) in model.meshes[instance.mesh].faces.iter().enumerate().filter(|(_, face)| face.solid) {
            let side = match (face.double_sided, mirrored) {
                (true, _) => 0.0,
                (false, false) => 1.0,
                (false, true) => -1.0,
            };
            let [r, g, b] = face.color;
            vertices.extend(flat(model.corners(i, t), [r, g, b, 255], side));
        }
    }
    vertices
}

fn check_target(target: &wgpu::Texture, view: &View) -> Result<(), Error> {
    let size = [target.width(), target.height()];
    let fault = if target.format() != wgpu::TextureFormat::Rgba8Unorm {
        format!("its target has the format {:?} instead of Rgba8Unorm", target.format())
    } else if target.sample_count() != 1 {
        format!("its target has {} samples per pixel instead of 1", target.sample_count())
    } else if !target.usage().contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
        "its target is no render attachment".to_owned()
    } else if size != view.size {
        format!("its target has the size {size:?}, and the view {:?}", view.size)
    } else {
        return Ok(());
    };
    Err(Error::Unfit(fault))
}
