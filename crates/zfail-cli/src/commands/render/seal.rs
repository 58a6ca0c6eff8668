//! Which frames are there already: a picture's seal says what it answers.
//!
//! In: a request (everything that decides how a frame looks) and files. Out: whether the files are its answer.
//!
//! The seal is a digest of the request, of the picture's own pixels and of the files beside it, and stands in the
//! picture's metadata. So no list has to be kept in step with the files: whatever a killed run, a full disk, a changed
//! scene or another program leaves behind either proves to be the answer, or is rendered again.

use crate::output::Format;
use bytemuck::{NoUninit, cast_slice};
use std::fmt::{self, Debug, Write};
use std::fs;
use std::mem::{swap, take};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::Xxh3;
use zfail_scene::{Animated, Mesh};

/// A digest of everything that decides how a frame looks.
#[derive(Clone)]
pub struct Request(Xxh3);

impl Request {
    /// What all frames share: what is asked for, and the scene as it is after loading, so that a change in any file that
    /// it was made of counts. `scene` is the same afterwards.
    pub fn new(asked: &impl Debug, scene: &mut Animated) -> Self {
        Self(Xxh3::new()).with(&env!("CARGO_PKG_VERSION")).with(asked).with_scene(scene)
    }

    /// The request with one more detail.
    #[must_use]
    pub fn with(mut self, detail: &impl Debug) -> Self {
        // The digest takes everything.
        let _ = writeln!(self, "{detail:?}");
        self
    }

    fn with_scene(mut self, animated: &mut Animated) -> Self {
        // Long lists go in as bytes: to write out a hundred million numbers would take longer than to render them. They
        // are put aside for the rest, so that whatever else a scene has counts without being named here.
        let lists: Vec<Mesh> = animated.scene.meshes.iter_mut().map(take_lists).collect();
        let pixels: Vec<Vec<u8>> = animated.scene.images.iter_mut().map(|image| take(&mut image.rgba)).collect();
        for mesh in &lists {
            self.list(&mesh.positions);
            self.list(&mesh.normals);
            self.list(&mesh.tangents);
            self.list(&mesh.uv0);
            self.list(&mesh.uv1);
            self.list(&mesh.colors);
            self.list(&mesh.triangles);
        }
        pixels.iter().for_each(|rgba| self.list(rgba));
        let request = self.with(animated);
        for (mesh, mut lists) in animated.scene.meshes.iter_mut().zip(lists) {
            swap_lists(mesh, &mut lists);
        }
        for (image, rgba) in animated.scene.images.iter_mut().zip(pixels) {
            image.rgba = rgba;
        }
        request
    }

    fn list<T: NoUninit>(&mut self, list: &[T]) {
        self.0.update(&(list.len() as u64).to_le_bytes());
        self.0.update(cast_slice(list));
    }

    /// The seal of the answer that has these pixels and these files beside them.
    pub fn seal(&self, pixels: &[u8], sides: &[Vec<u8>]) -> String {
        let mut digest = self.clone();
        digest.list(pixels);
        sides.iter().for_each(|side| digest.list(side));
        format!("{:032x}", digest.0.digest128())
    }

    /// Whether `picture` is the whole answer, together with `sides`.
    pub fn is_answered(&self, picture: &Path, format: Format, size: [u32; 2], sides: &[PathBuf]) -> bool {
        let Ok(file) = fs::read(picture) else { return false };
        let sealed = format.read(size, &file);
        let sides: Result<Vec<Vec<u8>>, _> = sides.iter().map(fs::read).collect();
        matches!((sealed, sides), (Some(sealed), Ok(sides)) if self.seal(&sealed.pixels, &sides) == sealed.seal)
    }
}

/// The long lists of a mesh, which has none afterwards.
fn take_lists(mesh: &mut Mesh) -> Mesh {
    let mut lists = Mesh::default();
    swap_lists(mesh, &mut lists);
    lists
}

fn swap_lists(a: &mut Mesh, b: &mut Mesh) {
    swap(&mut a.positions, &mut b.positions);
    swap(&mut a.normals, &mut b.normals);
    swap(&mut a.tangents, &mut b.tangents);
    swap(&mut a.uv0, &mut b.uv0);
    swap(&mut a.uv1, &mut b.uv1);
    swap(&mut a.colors, &mut b.colors);
    swap(&mut a.triangles, &mut b.triangles);
}

impl Write for Request {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Animated {
        zfail_builtin::animated("lantern").expect("a scene with meshes and an image")
    }

    fn seal(change: impl FnOnce(&mut Animated)) -> String {
        let mut scene = scene();
        change(&mut scene);
        Request::new(&"asked", &mut scene).seal(b"pixels", &[])
    }

    #[test]
    fn every_change_breaks_the_seal() {
        let untouched = seal(|_| ());
        assert_eq!(untouched, seal(|_| ()));
        let changes: [fn(&mut Animated); 6] = [
            |a| a.scene.meshes[0].positions[0][1] += 1e-3,
            |a| a.scene.meshes[0].triangles.truncate(1),
            |a| a.scene.images[0].rgba[7] ^= 1,
            |a| a.scene.materials[0].roughness += 0.01,
            |a| a.scene.lights[0].intensity += 1e-3,
            |a| a.scene.instances[0].world_from_object.translation.x += 1e-12,
        ];
        for (i, change) in changes.into_iter().enumerate() {
            assert_ne!(seal(change), untouched, "change {i}");
        }
        let request = Request::new(&"asked", &mut scene());
        assert_ne!(Request::new(&"asked otherwise", &mut scene()).seal(b"pixels", &[]), untouched);
        assert_ne!(request.clone().with(&0.5).seal(b"pixels", &[]), untouched);
        assert_ne!(request.seal(b"Pixels", &[]), untouched);
        assert_ne!(request.seal(b"pixels", &[vec![]]), untouched);
        assert_ne!(
            request.seal(b"", &[b"ab".to_vec(), b"c".to_vec()]),
            request.seal(b"", &[b"a".to_vec(), b"bc".to_vec()])
        );
    }

    #[test]
    fn the_scene_is_only_read() {
        let (mut read, untouched) = (scene(), scene());
        Request::new(&(), &mut read);
        assert_eq!(format!("{read:?}"), format!("{untouched:?}"));
        assert!(!untouched.scene.images[0].rgba.is_empty() && !untouched.scene.meshes[0].positions.is_empty());
    }
}
