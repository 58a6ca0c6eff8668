//! The window: events in, frames out, and sleep in between.
//!
//! Frames are drawn on input, while something moves, and when a panel asks for it; at most at the display's rate. The
//! device belongs to the caller of the event loop, because renderers borrow it.

use crate::canvas::{Canvas, Shown};
use crate::viewer::{Loaded, Viewer};
use crate::{Host, Options, ViewError};
use std::cell::OnceCell;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::{Window, WindowId};
use zfail_render::{Gpu, GpuOptions, RenderError};

/// Opens a window and stays until it is closed.
///
/// # Errors
/// If there is no display or no device that can draw on it, or the device is lost.
pub fn run(options: Options, host: Host) -> Result<(), ViewError> {
    let no_display = |error: winit::error::EventLoopError| ViewError::NoDisplay(without_place(&error.to_string()));
    let events = EventLoop::with_user_event().build().map_err(no_display)?;
    let gpu = OnceCell::new();
    let proxy = Arc::new(Mutex::new(events.create_proxy()));
    let mut app = App { gpu: &gpu, begin: Some((options, host)), proxy, open: None, outcome: Ok(()) };
    events.run_app(&mut app).map_err(no_display)?;
    app.outcome
}

/// An error of winit without the place in its sources that it begins with.
fn without_place(error: &str) -> String {
    let after = error.split_once(".rs:").and_then(|(_, place)| place.split_once(": "));
    after.map_or(error, |(_, reason)| reason).trim_end_matches('.').to_owned()
}

/// The event loop's side.
struct App<'g> {
    gpu: &'g OnceCell<Gpu>,
    /// Until the window is open.
    begin: Option<(Options, Host)>,
    proxy: Arc<Mutex<EventLoopProxy<Loaded>>>,
    open: Option<Open<'g>>,
    outcome: Result<(), ViewError>,
}

/// An open window.
struct Open<'g> {
    gpu: &'g Gpu,
    window: Arc<Window>,
    canvas: Canvas,
    viewer: Viewer<'g>,
    input: egui_winit::State,
    context: egui::Context,
    /// Of the last frame.
    start: Instant,
    /// When the next frame is due without input.
    due: Option<Instant>,
    /// What the driver said when it gave up.
    lost: Arc<OnceLock<String>>,
}

impl<'g> App<'g> {
    fn open(&self, events: &ActiveEventLoop, options: Options, host: Host) -> Result<Open<'g>, ViewError> {
        let [width, height] = options.size;
        let attributes =
            Window::default_attributes().with_title("zfail").with_inner_size(PhysicalSize::new(width, height));
        let window =
            events.create_window(attributes).map_err(|e| ViewError::NoDisplay(without_place(&e.to_string())))?;
        let window = Arc::new(window);
        let (gpu, instance, surface, capabilities) = device(events, &window, &options.gpu)?;
        let lost = Arc::new(OnceLock::new());
        let slot = Arc::clone(&lost);
        gpu.device.set_device_lost_callback(move |reason, message| {
            // Giving the device back at the end is no accident.
            if reason != wgpu::DeviceLostReason::Destroyed {
                let _ = slot.set(message);
            }
        });
        let gpu = self.gpu.get_or_init(|| gpu);
        let canvas = Canvas::new(gpu, instance, Arc::clone(&window), surface, &capabilities)?;
        let context = egui::Context::default();
        crate::panel::style(&context);
        let input = egui_winit::State::new(
            context.clone(),
            egui::ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            None,
            Some(gpu.device.limits().max_texture_dimension_2d as usize),
        );
        let proxy = Arc::clone(&self.proxy);
        let deliver = Arc::new(move |loaded| {
            if let Ok(proxy) = proxy.lock() {
                // With the window closed nobody waits for it.
                let _ = proxy.send_event(loaded);
            }
        });
        let viewer = Viewer::new(gpu, host, options, deliver);
        Ok(Open { gpu, window, canvas, viewer, input, context, start: Instant::now(), due: None, lost })
    }

    fn end(&mut self, events: &ActiveEventLoop, outcome: Result<(), ViewError>) {
        if self.outcome.is_ok() {
            self.outcome = outcome;
        }
        events.exit();
    }
}

type Drawing = (Gpu, wgpu::Instance, wgpu::Surface<'static>, wgpu::SurfaceCapabilities);

/// The best device that can draw into `window`; GL only where there is nothing else, as [`Gpu::new`] does.
fn device(events: &ActiveEventLoop, window: &Arc<Window>, options: &GpuOptions) -> Result<Drawing, ViewError> {
    let primary = options.backends & wgpu::Backends::PRIMARY;
    let mut failure = RenderError::NoAdapter { detail: String::new() };
    for backends in [primary, options.backends - primary] {
        if backends.is_empty() {
            continue;
        }
        let display = Box::new(events.owned_display_handle());
        let descriptor = wgpu::InstanceDescriptor::new_with_display_handle(display);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor { backends, ..descriptor });
        let Ok(surface) = instance.create_surface(Arc::clone(window)) else { continue };
        match Gpu::for_surface(&instance, &surface, &GpuOptions { backends, ..options.clone() }) {
            Ok((gpu, capabilities)) => return Ok((gpu, instance, surface, capabilities)),
            Err(error) => failure = error,
        }
    }
    Err(failure.into())
}

impl Open<'_> {
    /// Draws a frame.
    fn frame(&mut self) -> Result<(), ViewError> {
        let now = Instant::now();
        let seconds = now.duration_since(self.start).as_secs_f64();
        self.start = now;
        let raw = self.input.take_egui_input(&self.window);
        let (mut area, viewer) = (None, &mut self.viewer);
        let mut output = self.context.run_ui(raw, |ui| area = viewer.frame(ui, seconds));
        self.input.handle_platform_output(&self.window, std::mem::take(&mut output.platform_output));
        let repaint = output.viewport_output.get(&egui::ViewportId::ROOT).map(|viewport| viewport.repaint_delay);
        let picture = viewer.stage.as_ref().and_then(|stage| stage.picture()).zip(area);
        let shown = self.canvas.show(self.gpu, &self.context, output, picture)?;
        if let Some(reason) = self.lost.get() {
            return Err(ViewError::Lost(reason.clone()));
        }
        let wait = match shown {
            Shown::Yes => repaint,
            Shown::Again => Some(Duration::ZERO),
            Shown::Hidden => None,
        };
        // Not all surfaces wait for the display.
        self.due = wait.and_then(|wait| now.checked_add(wait.max(self.period())));
        Ok(())
    }

    /// Of the display.
    fn period(&self) -> Duration {
        let rate = self.window.current_monitor().and_then(|monitor| monitor.refresh_rate_millihertz());
        Duration::from_secs_f64(1e3 / f64::from(rate.unwrap_or(60_000).clamp(10_000, 1_000_000)))
    }
}

impl ApplicationHandler<Loaded> for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        let Some((options, host)) = self.begin.take() else { return };
        match self.open(events, options, host) {
            Ok(open) => {
                open.window.request_redraw();
                self.open = Some(open);
            }
            Err(error) => self.end(events, Err(error)),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, loaded: Loaded) {
        if let Some(open) = &mut self.open {
            open.viewer.loaded(loaded);
            let name = open.viewer.stage.as_ref().map_or("", |stage| &stage.session.scene.name);
            open.window
                .set_title(if name.is_empty() { "zfail".to_owned() } else { format!("{name} - zfail") }.as_str());
            open.window.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        let response = open.input.on_window_event(&open.window, &event);
        match event {
            WindowEvent::CloseRequested => return self.end(events, Ok(())),
            WindowEvent::DroppedFile(path) => open.viewer.open(path.display().to_string()),
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => open.canvas.resize(open.gpu),
            WindowEvent::RedrawRequested => {
                if let Err(error) = open.frame() {
                    return self.end(events, Err(error));
                }
                if open.viewer.done {
                    return self.end(events, Ok(()));
                }
                return;
            }
            WindowEvent::Occluded(false) => {}
            _ if !response.repaint => return,
            _ => {}
        }
        // Input is answered at once, but no sooner than the display can show it.
        let soonest = open.start + open.period();
        open.due = Some(open.due.map_or(soonest, |due| due.min(soonest)));
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        match open.due {
            None => events.set_control_flow(ControlFlow::Wait),
            Some(due) if due <= Instant::now() => {
                open.due = None;
                open.window.request_redraw();
                events.set_control_flow(ControlFlow::Wait);
            }
            Some(due) => events.set_control_flow(ControlFlow::WaitUntil(due)),
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn users_see_reasons_and_not_sources() {
        let with = "os error at /a/winit/src/linux/mod.rs:765: neither DISPLAY nor WAYLAND_DISPLAY is set.";
        assert_eq!(super::without_place(with), "neither DISPLAY nor WAYLAND_DISPLAY is set");
        assert_eq!(super::without_place("the loop was made twice"), "the loop was made twice");
    }
}
