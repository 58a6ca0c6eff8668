//! The viewer without its window: what is open, what is said, and what every action does.
//!
//! Data flow: input -> [`Session`] -> [`Stage`] -> the window. Scenes are loaded on a thread of their own, so that the
//! window stays alive meanwhile; until one is there, and if it cannot be shown, the old one stays.

use crate::action::Action;
use crate::message::Message;
use crate::panel::{self, Desk};
use crate::picture::{self, Hand, Outcome};
use crate::recent::Recent;
use crate::session::{Look, Session};
use crate::stage::Stage;
use crate::{Host, Options, command_line, screenshot, shortcuts};
use std::panic::{self as unwinding, AssertUnwindSafe};
use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use zfail_render::Gpu;
use zfail_scene::{Animated, SavedView};

/// A scene that a thread has loaded.
#[derive(Debug)]
pub struct Loaded {
    source: String,
    /// Which of the requests this answers.
    request: u64,
    result: Result<Box<Animated>, String>,
}

/// Hands a loaded scene to the window's thread.
pub type Deliver = Arc<dyn Fn(Loaded) + Send + Sync>;

/// Everything but the window.
pub struct Viewer<'g> {
    gpu: &'g Gpu,
    host: Host,
    deliver: Deliver,
    /// How scenes are shown before the first one is open.
    look: Look,
    flags: Vec<String>,
    folder: PathBuf,
    /// The open scene.
    pub stage: Option<Stage<'g>>,
    desk: Desk,
    hand: Hand,
    recent: Recent,
    messages: Vec<Message>,
    /// What is being loaded, and the number of the request.
    loading: (Option<String>, u64),
    /// Pixels of the last picture.
    size: [u32; 2],
    /// Whether the user wants to leave.
    pub done: bool,
}

impl<'g> Viewer<'g> {
    /// A viewer that begins to load the scene that `options` name.
    pub fn new(gpu: &'g Gpu, host: Host, options: Options, deliver: Deliver) -> Self {
        let mut viewer = Self {
            gpu,
            host,
            deliver,
            look: Look { settings: options.settings, overlays: Vec::new() },
            flags: options.flags,
            folder: options.folder,
            stage: None,
            desk: Desk::new(options.panels),
            hand: Hand::default(),
            recent: Recent::load(),
            messages: Vec::new(),
            loading: (None, 0),
            size: options.size,
            done: false,
        };
        if let Some(source) = options.scene {
            viewer.open(source);
        }
        viewer
    }

    /// Lays out a frame in `ui`; `seconds` have passed since the last one. Afterwards the picture is up to date.
    pub fn frame(&mut self, ui: &mut egui::Ui, seconds: f64) -> Option<egui::Rect> {
        let mut actions = shortcuts::pressed(ui.ctx());
        let loading = self.loading.0.as_deref();
        let (stage, gpu) = (self.stage.as_mut(), &self.gpu.info);
        panel::show(ui, &mut self.desk, stage, &self.recent, &mut self.messages, loading, gpu, &mut actions);
        let area = egui::CentralPanel::default().frame(egui::Frame::NONE).show(ui, |ui| match &mut self.stage {
            None => {
                panel::welcome(ui, &self.recent, loading, &mut actions);
                None
            }
            Some(stage) => {
                let session = &mut stage.session;
                Some(picture::picture(ui, session, &mut self.hand, self.desk.handles, seconds))
            }
        });
        actions.into_iter().for_each(|action| self.perform(action));
        let outcome = area.inner?;
        self.draw(ui.ctx(), outcome, seconds);
        Some(outcome.area)
    }

    /// Brings the picture up to date.
    fn draw(&mut self, context: &egui::Context, outcome: Outcome, seconds: f64) {
        let Some(stage) = &mut self.stage else { return };
        let scale = context.pixels_per_point();
        let full = [outcome.area.width(), outcome.area.height()].map(|side| (side * scale).round().max(0.0) as u32);
        if full.contains(&0) {
            return;
        }
        self.size = full;
        stage.session.advance(seconds.min(0.25));
        let playing = stage.session.is_moving();
        let edited = stage.session.changes.picture && context.egui_is_using_pointer();
        let moving = outcome.moving || playing || edited;
        if let Err(error) = stage.draw(full, moving) {
            self.say(Message::Error((self.host.explain)(&error)));
        } else if playing {
            context.request_repaint();
        } else if moving {
            // In case this was the last motion, the picture is drawn at full size then.
            context.request_repaint_after_secs(0.15);
        }
    }

    /// Shows a message in the window and on the terminal.
    fn say(&mut self, message: Message) {
        (self.host.say)(&message);
        self.messages.retain(|old| *old != message);
        self.messages.push(message);
    }

    /// Does what is asked for.
    fn perform(&mut self, action: Action) {
        if self.stage.as_mut().is_some_and(|stage| stage.session.perform(&action)) {
            return;
        }
        match action {
            Action::Quit => self.done = true,
            Action::Panels => self.desk.visible = !self.desk.visible,
            Action::Help => self.desk.help = !self.desk.help,
            Action::Open(source) => self.open(source),
            Action::Screenshot => self.save(false),
            Action::SaveView => self.save(true),
            _ => {}
        }
    }

    /// Begins to load a scene.
    pub fn open(&mut self, source: String) {
        let request = self.loading.1 + 1;
        self.loading = (Some(source.clone()), request);
        let (load, deliver) = (Arc::clone(&self.host.load), Arc::clone(&self.deliver));
        let work = move || {
            let result = unwinding::catch_unwind(AssertUnwindSafe(|| load(&source)))
                .unwrap_or_else(|_| Err(format!("'{source}' cannot be loaded, because of a fault in this program")));
            deliver(Loaded { source, request, result: result.map(Box::new) });
        };
        if let Err(error) = thread::Builder::new().name("loader".to_owned()).spawn(work) {
            self.loading.0 = None;
            self.say(Message::Error(format!("no thread could be started: {error}")));
        }
    }

    /// Shows a loaded scene, unless another one was asked for since.
    pub fn loaded(&mut self, loaded: Loaded) {
        let Loaded { source, request, result } = loaded;
        if request != self.loading.1 {
            return;
        }
        self.loading.0 = None;
        let explain = self.host.explain;
        let shown = result.and_then(|animated| {
            let look = self.stage.as_ref().map_or(&self.look, |stage| &stage.session.look).clone();
            let session = Session::new(source.clone(), *animated, look);
            Stage::new(self.gpu, session).map_err(|error| format!("cannot show '{source}': {}", explain(&error)))
        });
        match shown {
            Ok(stage) => {
                self.messages.clear();
                let notices: Vec<Message> = stage.session.scene.notices.iter().cloned().map(Message::Note).collect();
                notices.into_iter().for_each(|notice| self.say(notice));
                if !source.starts_with("builtin:") {
                    self.recent.add(&source);
                }
                self.stage = Some(stage);
                self.hand = Hand::default();
            }
            Err(error) => self.say(Message::Error(error)),
        }
    }

    /// Saves the picture, and with it the view.
    fn save(&mut self, view: bool) {
        let size = self.desk.still_size(self.size);
        match self.try_save(size, view) {
            Ok(messages) => messages.into_iter().for_each(|message| self.say(message)),
            Err(error) => self.say(Message::Error(error)),
        }
    }

    fn try_save(&self, size: [u32; 2], view: bool) -> Result<Vec<Message>, String> {
        let Some(stage) = &self.stage else { return Ok(Vec::new()) };
        let pixels = stage.still(size).map_err(|error| (self.host.explain)(&error))?;
        let png = (self.host.encode)(size, &pixels)?;
        let session = &stage.session;
        let json = view.then(|| SavedView::new(&session.scene, &session.rig.camera).to_json());
        let mut files = Vec::new();
        files.extend(json.as_ref().map(|json| ("json", json.as_bytes())));
        files.push(("png", png.as_slice()));
        let stem = screenshot::stem(&session.source);
        let paths = screenshot::save(&self.folder, &stem, &files)
            .map_err(|error| format!("cannot save into '{}': {error}", self.folder.display()))?;
        let saved = |path: &PathBuf| Message::Done(format!("saved {}", path.display()));
        Ok(match &paths[..] {
            [view, picture] => {
                let line = command_line::render(session, size, view, picture, &self.flags);
                vec![saved(view), saved(picture), Message::Command(line)]
            }
            others => others.iter().map(saved).collect(),
        })
    }
}
