//! The command line that makes a picture again.

use crate::session::Session;
use std::path::Path;
use zfail_render::{Exposure, Terminator};

/// `zfail render` with everything that decides how the session looks at `size`, for a POSIX shell. `flags` are those with
/// which the scene was loaded; `view` is the saved view.
#[must_use]
pub fn render(session: &Session, size: [u32; 2], view: &Path, picture: &Path, flags: &[String]) -> String {
    let settings = &session.look.settings;
    let mut words: Vec<String> = ["zfail", "render", &session.source].map(str::to_owned).into();
    let mut option = |name: &str, value: String| words.extend([name.to_owned(), value]);
    option("--view", view.display().to_string());
    if let Some(seconds) = session.playback.seconds {
        option("--animation", session.playback.animation.to_string());
        option("--time", seconds.to_string());
    }
    option("--size", format!("{}x{}", size[0], size[1]));
    option("--samples", settings.samples.to_string());
    option("--technique", settings.technique.to_string());
    option(
        "--exposure",
        match settings.exposure {
            Exposure::Auto => "auto".to_owned(),
            Exposure::Ev(stops) => stops.to_string(),
        },
    );
    if settings.terminator == Terminator::Exact {
        option("--terminator", "exact".to_owned());
    }
    if !session.look.overlays.is_empty() {
        let names: Vec<&str> = session.look.overlays.iter().map(|overlay| overlay.name()).collect();
        option("--overlay", names.join(","));
    }
    words.extend((!settings.shadows).then(|| "--no-shadows".to_owned()));
    words.extend(flags.iter().cloned());
    words.extend(["-o".to_owned(), picture.display().to_string()]);
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:=,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Look;
    use zfail_figures::Overlay;

    #[test]
    fn every_choice_is_on_the_command_line() {
        let room = zfail_builtin::animated("room").expect("it is built in");
        let mut session = Session::new("my room.glb".to_owned(), room, Look::default());
        let line = |session: &Session| {
            render(session, [64, 48], Path::new("a.json"), Path::new("a.png"), &["--blended-shadows".to_owned()])
        };
        assert_eq!(
            line(&session),
            "zfail render 'my room.glb' --view a.json --size 64x48 --samples 1 --technique auto --exposure auto \
             --blended-shadows -o a.png"
        );
        session.look.settings.exposure = Exposure::Ev(-0.1);
        session.look.settings.shadows = false;
        session.look.settings.terminator = Terminator::Exact;
        session.playback.seconds = Some(0.1 + 0.2);
        session.look.toggle(Overlay::Stencil);
        session.look.toggle(Overlay::Volumes);
        let said = line(&session);
        for words in [
            "--exposure -0.1 ",
            " --no-shadows ",
            " --terminator exact ",
            " --time 0.30000000000000004 ",
            " --overlay volumes,stencil ",
        ] {
            assert!(said.contains(words), "{words} in {said}");
        }
    }

    #[test]
    fn a_shell_takes_words_as_they_are() {
        assert_eq!(quoted("builtin:room"), "builtin:room");
        assert_eq!(quoted("it's $HOME"), r"'it'\''s $HOME'");
        assert_eq!(quoted(""), "''");
    }
}
