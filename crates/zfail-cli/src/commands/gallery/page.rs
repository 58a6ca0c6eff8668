//! The gallery's page: every scene with its description and pictures, as one HTML file without dependencies.

use crate::output::html::escape;
use std::fmt::Write;
use zfail_scene::Scene;

const STYLE: &str = "\
body { background: #16181c; color: #d8dade; font: 15px/1.5 system-ui, sans-serif; margin: 2em; }
img { width: min(32em, 100%); border-radius: 4px; }
a { color: inherit; }";

/// The page's body, as far as it is written.
#[derive(Default)]
pub struct Page(String);

impl Page {
    /// Begins the section of a scene.
    pub fn scene(&mut self, name: &str, description: &str, scene: &Scene) {
        let triangles: usize = scene.instances.iter().map(|instance| scene.meshes[instance.mesh].triangles.len()).sum();
        let (name, description) = (escape(name), escape(description));
        let _ = write!(
            self.0,
            "<h2>{name}</h2>\n<p>{description}<br>\n{triangles} triangles, lights: {}, \
             <a href=\"{name}.glb\">{name}.glb</a>, <code>zfail render builtin:{name} -o {name}.png</code></p>\n",
            scene.lights.len()
        );
    }

    /// Adds a picture to the section.
    pub fn picture(&mut self, file: &str, camera: &str) {
        let (file, camera) = (escape(file), escape(camera));
        let _ = writeln!(self.0, "<a href=\"{file}\"><img src=\"{file}\" alt=\"{camera}\" title=\"{camera}\"></a>");
    }

    /// The whole page.
    pub fn finish(self) -> String {
        let Self(body) = self;
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>zfail: built-in scenes</title>\n\
             <style>\n{STYLE}\n</style>\n<h1>zfail: built-in scenes</h1>\n{body}</html>\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::Page;
    use zfail_scene::Scene;

    #[test]
    fn names_and_descriptions_are_text_and_not_markup() {
        let mut page = Page::default();
        page.scene("hall", "E&K <Fig. 2>", &Scene::default());
        page.picture("hall.png", "the \"eye\"");
        let page = page.finish();
        assert!(
            page.contains("E&amp;K &lt;Fig. 2&gt;") && page.contains("src=\"hall.png\" alt=\"the &quot;eye&quot;\"")
        );
    }
}
