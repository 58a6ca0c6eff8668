//! `zfail view` as a person uses it: a window on a virtual display, keys and mouse, and the files that come of it.
#![cfg(all(target_os = "linux", feature = "view"))]

use crate::support::{command, has_gpu, zfail};
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use std::{env, iter};

/// The longest that anything here may take.
const PATIENCE: Duration = Duration::from_secs(40);

/// Ends a process that is left over.
struct Reaped(Child);

impl Drop for Reaped {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A virtual display, and the name that programs know it by.
struct Display {
    _server: Reaped,
    name: String,
}

impl Display {
    /// Starts one; `None` if this machine lacks something for it and the tests are to be skipped.
    fn start() -> Option<Self> {
        let missing: Vec<&str> = ["Xvfb", "xdotool"].into_iter().filter(|program| !is_there(program)).collect();
        let why = || format!("{} not found; 'cargo xtask test' says what to install", missing.join(" and "));
        zfail_testing::display(missing.is_empty().then_some(()).ok_or_else(why))?;
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "800x600x24", "-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let stdout = server.stdout.take().expect("it is a pipe");
        let server = Reaped(server);
        let mut number = String::new();
        BufReader::new(stdout).read_line(&mut number).expect("Xvfb says its number");
        Some(Self { _server: server, name: format!(":{}", number.trim()) })
    }

    /// Does as `xdotool` with these words.
    #[track_caller]
    fn input(&self, words: &str) -> String {
        let mut tool = Command::new("xdotool");
        let output = tool.args(words.split_whitespace()).env("DISPLAY", &self.name).output().expect("xdotool starts");
        assert!(output.status.success(), "xdotool {words}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }
}

fn is_there(program: &str) -> bool {
    env::var_os("PATH").is_some_and(|path| env::split_paths(&path).any(|folder| folder.join(program).exists()))
}

/// The viewer in its window.
struct Window<'d> {
    display: &'d Display,
    folder: &'d Path,
    process: Reaped,
    /// How many files it has saved.
    saved: usize,
}

impl<'d> Window<'d> {
    fn open(display: &'d Display, folder: &'d Path, scene: &str) -> Self {
        let args = ["view", scene, "--size", "320x200", "--no-panels", "--exposure", "1"];
        let child = command(folder, &args)
            .env("DISPLAY", &display.name)
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_STATE_HOME", folder.join("state"))
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .expect("the viewer starts");
        let window = Self { display, folder, process: Reaped(child), saved: 0 };
        let id = display.input("search --sync --onlyvisible --name zfail");
        display.input(&format!("windowmove {id} 0 0 windowfocus --sync {id}"));
        window
    }

    /// Presses a key and waits until the window is still again.
    fn key(&mut self, keys: &str) {
        self.display.input(&format!("key {keys}"));
        self.settle();
    }

    /// Moves from one place of the window to another with a button held.
    fn drag(&mut self, button: u32, from: [i32; 2], to: [i32; 2]) {
        let [x, y] = [0, 1].map(|i| (from[i] + to[i]) / 2);
        self.display.input(&format!("mousemove {} {} sleep 0.1 mousedown {button} sleep 0.1", from[0], from[1]));
        self.display.input(&format!("mousemove {x} {y} sleep 0.1 mousemove {} {} sleep 0.1", to[0], to[1]));
        self.display.input(&format!("mouseup {button}"));
        // Out of the way, so that nothing is highlighted.
        self.display.input("mousemove 4 4");
        self.settle();
    }

    /// Saves the picture by its key, and reads it.
    fn screenshot(&mut self) -> Vec<u8> {
        self.display.input("key F12");
        self.next_picture()
    }

    fn next_picture(&mut self) -> Vec<u8> {
        self.saved += 1;
        let path = self.folder.join(format!("room-{:03}.png", self.saved));
        let start = Instant::now();
        loop {
            if let Ok(image) = image::open(&path) {
                return image.into_rgb8().into_raw();
            }
            assert!(start.elapsed() < PATIENCE, "{} does not come", path.display());
            sleep(Duration::from_millis(50));
        }
    }

    /// Waits until the viewer has used next to no time for a while; returns the least share of a core that it used.
    fn settle(&mut self) {
        let start = Instant::now();
        let mut quiet = 0;
        while quiet < 3 {
            quiet = if self.busy(Duration::from_millis(100)) < 0.02 { quiet + 1 } else { 0 };
            assert!(start.elapsed() < PATIENCE, "the viewer does not come to rest");
        }
    }

    /// Seconds of processor time that the viewer uses within `span`.
    fn busy(&self, span: Duration) -> f64 {
        let before = self.ticks();
        sleep(span);
        (self.ticks() - before) / 100.0
    }

    /// Hundredths of a second of processor time, user and system.
    fn ticks(&self) -> f64 {
        let stat = fs::read_to_string(format!("/proc/{}/stat", self.process.0.id())).expect("the viewer runs");
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
        [11, 12].map(|i| fields[i].parse::<f64>().expect("a number")).iter().sum()
    }

    /// Leaves by key; returns what was printed.
    fn quit(mut self) -> String {
        self.display.input("key ctrl+q");
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.process.0.try_wait().expect("it is ours") {
                break status;
            }
            assert!(start.elapsed() < PATIENCE, "the viewer does not quit");
            sleep(Duration::from_millis(20));
        };
        assert_eq!(status.code(), Some(0));
        let mut printed = String::new();
        self.process.0.stdout.take().expect("it is a pipe").read_to_string(&mut printed).expect("text");
        printed
    }
}

#[test]
fn a_scene_is_looked_at_changed_and_saved() {
    if !has_gpu() {
        return;
    }
    let Some(display) = Display::start() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = Window::open(&display, folder.path(), "builtin:room");
    window.settle();
    let first = window.screenshot();
    window.settle();
    assert!(window.screenshot() == first, "nothing was done, so the picture is the same");
    window.settle();
    let idle = window.busy(Duration::from_millis(1500));
    assert!(idle <= 0.03, "{idle} s of 1.5 s are used while nothing moves");

    let mut seen = vec![first];
    let mut step = |window: &mut Window<'_>, what: &str| {
        let picture = window.screenshot();
        window.settle();
        assert!(!seen.contains(&picture), "{what} changes the picture");
        seen.push(picture);
    };
    window.drag(1, [160, 20], [200, 40]);
    step(&mut window, "a drag of the camera");
    window.key("x");
    step(&mut window, "switching shadows off");
    window.key("x");
    window.key("l");
    step(&mut window, "a new light at the eye");
    window.key("1");
    step(&mut window, "the new light, as the file's camera sees it,");
    // There, the red light is here.
    window.drag(1, [153, 43], [190, 70]);
    window.key("1");
    step(&mut window, "a drag of a light's handle, whatever became of the camera,");
    window.key("n");
    window.key("Delete");
    step(&mut window, "removing the first light");
    window.key("m");
    step(&mut window, "4 samples");
    window.key("alt+3");
    step(&mut window, "an overlay of silhouettes");

    let save = |window: &mut Window<'_>| {
        window.display.input("key ctrl+s");
        let saved = window.next_picture();
        window.settle();
        saved
    };
    let smooth = save(&mut window);
    // One sample per pixel, in the midst of the animation.
    window.display.input("key m key space sleep 0.5");
    window.key("space");
    let posed = save(&mut window);
    let printed = window.quit();
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines.len(), 2, "{printed}");
    reproduces(folder.path(), lines[0], &smooth, &posed);
    reproduces(folder.path(), lines[1], &posed, &smooth);
}

/// Runs the command line that was printed and compares.
#[track_caller]
fn reproduces(folder: &Path, printed: &str, saved: &[u8], other: &[u8]) {
    let words: Vec<&str> = printed.trim().split(' ').collect();
    assert_eq!(words[0], "zfail", "{printed}");
    let (picture, words) = words[1..].split_last().expect("it is a command line");
    let again: PathBuf = folder.join("again.png");
    assert!(picture.ends_with(".png") && !picture.ends_with("again.png"));
    let args: Vec<&str> = words.iter().copied().chain(iter::once("again.png")).collect();
    zfail(folder, &args).ok();
    let read = |path: &Path| image::open(path).expect("a picture").into_rgb8().into_raw();
    assert!(read(&again) == saved, "the command line makes the very picture");
    assert!(other != saved, "the comparison can fail");
    let view = words.iter().position(|word| *word == "--view").expect("it names the view");
    let without: Vec<&str> =
        args.iter().enumerate().filter(|(i, _)| *i != view && *i != view + 1).map(|(_, w)| *w).collect();
    zfail(folder, &without).ok();
    assert!(read(&again) != saved, "the view matters");
}

#[test]
fn without_a_display_there_is_one_line_and_no_window() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut lonely = command(folder.path(), &["view", "builtin:room"]);
    let output = lonely.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").output();
    let output = output.expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("zfail: error: cannot open a window") && said.lines().count() == 1, "{said}");
}
