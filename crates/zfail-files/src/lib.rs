//! Scenes from files, and to files: glTF 2.0, .obj, .stl and .ply are read, binary glTF is written.
//!
//! In: a file. Out: a [`Scene`](zfail_scene::Scene) and the notices about what was repaired or left out; with
//! [`load_animated`] also its animations, as poses at any time. [`write::to_glb`] goes the other way.
//!
//! Data flow: `load` (bytes to a document) -> `obj`, `stl` and `ply` become glTF documents, too (`plain`, with `polygon`)
//! -> `gltf` (a document to a scene), with `images` for its pictures. `shared` is what all of them need: limits, faults,
//! and the names of other files.
//!
//! Whatever the bytes are, the result is a scene that satisfies the scene types' invariants or a [`LoadError`]; what
//! was repaired or left out is in [`Scene::notices`](zfail_scene::Scene::notices).
//!
//! # What is not looked at
//! Whatever nothing in the scene to draw uses: other scenes and their nodes, what hidden nodes hold, and meshes, skins,
//! accessors and buffer views that are left over. Broken ones do no harm.
//!
//! # Repairs
//! What is there is loaded, with a notice that says what was wrong; an error is only what cannot be drawn truthfully.
//! - Left out: points and lines, primitives without positions, what remains of a triangle list after the last whole
//!   triangle, triangles with vertices that are not there, not finite, or moved by joints that are not there, meshes that a
//!   node's scale shrinks to a line or a point, images that are missing, unreadable, too large or of other formats than PNG,
//!   JPEG, WebP and KTX 2.0, normals, tangents, texture coordinates and colours that cannot be read, cameras and lights
//!   that make no sense, what [`extension_treatment`] says is ignored, animations of what extensions add and of nodes that
//!   have a matrix, channels that move something a second time or whose data are broken, and any optional part of the JSON
//!   that is not of its type.
//! - Replaced: missing normals (flat ones, on vertices of their own) and those without a direction, texture
//!   coordinates and colours that are not finite, rotations without length, joint weights that do not add up to 1, inverse
//!   bind matrices of zeros (the identity). Textures without a readable image: by plain factors, but without metal or glow
//!   where the texture was to confine these, and opaque where it was to mask or to let light through.
//! - Sorted: key frames.
//! - Chosen: all nodes where the file has no scene, or one that names none. A node that hangs below two others is drawn
//!   below both; one that the scene lists beside its parent is drawn below it, once.
//! - Approximated: materials, as [`extension_treatment`] says of each extension.
//! - Tolerated: text that is nearly JSON, byte order marks, chunks and accessors that are not aligned, missing bounds of
//!   accessors, the restart value as a vertex in lists of triangles, lengths that promise more than anything needs, bytes
//!   after the end, key frames before time 0 and two at the same time.
//! - Told, but drawn as it is: normals that disagree with the triangles.
//! - Baked into meshes of their own, in world space: skins (at rest, until an animation bends them) and meshes that their
//!   node flattens into a plane.
//! - Moved: a mesh far from its own origin, exactly, with the translation in its instances.
//! - While an animation flattens a mesh or makes it vanish, it keeps an invisible thickness, so that transforms stay
//!   invertible; what an animation takes beyond 10^15 m stays at its place of rest, or in its rest pose, meanwhile.
//!
//! # Extensions
//! - Geometry: KHR_draco_mesh_compression, EXT_meshopt_compression, KHR_meshopt_compression (what is compressed replaces
//!   the fallback, which need not exist), KHR_mesh_quantization, EXT_mesh_gpu_instancing.
//! - Images: KHR_texture_basisu, EXT_texture_webp (each before the texture's own source, which takes over where the
//!   extension's image cannot be read), KHR_texture_transform.
//! - Nodes: KHR_node_visibility; what is hidden neither is drawn nor casts, and hidden lights do not shine.
//! - Lights and materials: KHR_lights_punctual and what [`extension_treatment`] tells.
//!
//! # Other formats
//! - .obj with .mtl: groups become one mesh. y is up. Missing libraries and textures leave a surface grey or plain.
//! - .stl, binary or ASCII, and .ply with polygons or strips, normals, colours (sRGB) and texture coordinates: z is up.
//! - None has units: one unit is one metre. All surfaces are shown from both sides. Polygons are cut
//!   into triangles, concave ones without overlaps.
//! - Text is in any superset of ASCII, or UTF-16; lines end in LF, CR LF or CR. A face, an attribute of a face or a line
//!   of a library that cannot be used is left out, and counted in a notice.
//! - A model that lies far from its file's origin keeps that origin in double precision.
//!
//! # Extras
//! What glTF has no word for, in the extras of nodes:
//! - `castShadow`, a boolean: whether the meshes at and below the node block light, unless a node between says otherwise.
//! - `receiveShadow`, a boolean: whether shadows fall on them, inherited alike.
//!
//! And on the nodes of lights:
//! - `shadowExclude`, an array of names: what is at and below nodes of these names casts no shadow from the light.
//! - `falloff`, an array of two or more numbers, not negative: irradiance per intensity from the light to its range, which
//!   must be given, at equal steps and linear between. It replaces the inverse-square law of a point or spot light.
//! - `cookie`, the index of a texture whose colours (sRGB) a spot light projects, over the square around its outer cone,
//!   upright as seen from the light: right is the node's +x, up its +y. A mirrored node does not mirror it.
//! - `box`, three numbers above 0: half extents, in metres along the node's axes, of a box around the light beyond which a
//!   point or spot light reaches nothing. As with the range, a node's scale does not change it.
//!
//! A value of the last three that does not fit is left out, with a notice: it may mean something else to its author.
//!
//! Everything else that breaks the specification and bears on where the scene's surfaces are is an error.

#[cfg(not(feature = "codecs"))]
mod absent;
mod gltf;
mod images;
mod info;
mod load;
mod obj;
mod plain;
mod ply;
mod polygon;
mod shared;
mod stl;
pub mod write;

pub use gltf::{Treatment, extension_treatment};
pub use info::{ChannelInfo, FileInfo, MorphInfo, SkinInfo};
pub use load::{load, load_animated, load_variant, load_with};
pub use shared::{Fault, Limits, LoadError};
