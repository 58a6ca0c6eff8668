//! What stands in for the codecs in a build without them: a refusal that names the remedy.

/// What to do about it.
const REMEDY: &str = "which this build of zfail cannot decompress: build it with the feature \"codecs\"";

pub(crate) mod draco {
    use super::REMEDY;
    use crate::gltf::buffers::Buffers;
    use crate::gltf::schema::Root;
    use crate::shared::error::{Result, invalid};
    use crate::shared::limits::Budget;

    /// Refuses compressed primitives.
    pub fn expand(root: &mut Root, _: &mut Buffers<'_>, _: &Budget, _: &mut [String]) -> Result<()> {
        for (m, mesh) in root.meshes.iter().enumerate() {
            if let Some(p) = mesh.primitives.iter().position(|primitive| primitive.extensions.draco.is_some()) {
                return Err(invalid(format!("meshes[{m}].primitives[{p}]"), format!("holds Draco geometry, {REMEDY}")));
            }
        }
        Ok(())
    }
}

pub(crate) mod meshopt {
    use super::REMEDY;
    use crate::gltf::schema::{BufferView, Meshopt};
    use crate::shared::error::{Result, invalid};
    use crate::shared::limits::Budget;

    /// Refuses the compressed buffer view at JSON path `path`.
    pub fn decode(_: &Meshopt, _: &BufferView, _: &[u8], _: &Budget, path: &str) -> Result<Vec<u8>> {
        Err(invalid(path, format!("holds meshopt data, {REMEDY}")))
    }
}

pub(crate) mod ktx {
    use super::REMEDY;

    /// The first bytes of every KTX 2.0 file.
    pub const SIGNATURE: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

    /// A container that nothing here opens.
    pub enum Ktx {}

    impl Ktx {
        /// Refuses.
        pub fn open(_: &[u8]) -> Result<Self, String> {
            Err(format!("it is a KTX 2.0 image, {REMEDY}"))
        }

        /// Width and height of no image.
        pub fn dimensions(&self) -> (u32, u32) {
            match *self {}
        }

        /// Texels of no image.
        pub fn rgba(&self) -> Result<Vec<u8>, String> {
            match *self {}
        }
    }
}
