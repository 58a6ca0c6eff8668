//! Real and broken files from the model folder: `$ZFAIL_ASSETS`, or `shared/assets` beside the checkout.

use crate::build::{assert_sound, load_bytes};
use std::path::{Path, PathBuf};
use zfail_files::Limits;
use zfail_plan::glam::{DMat4, DVec3};
use zfail_scene::{Scene, world_triangle};

/// The model folder, or a printed reason and nothing.
pub fn assets() -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    let folder = std::env::var_os("ZFAIL_ASSETS").map_or(default, PathBuf::from);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no model folder at {}", folder.display());
    None
}

fn drawn_triangles(scene: &Scene) -> usize {
    scene.instances.iter().map(|i| scene.meshes[i.mesh].triangles.len()).sum()
}

/// Name, triangles drawn (each instance counted), instances, images, lights, cameras, lower and upper corner.
type Expected = (&'static str, usize, usize, usize, usize, usize, [f64; 3], [f64; 3]);

#[rustfmt::skip]
const REAL: &[Expected] = &[
    ("CesiumMan/CesiumMan.glb",                   4672,   1,  1, 0, 0, [-0.569, 0.0, -0.131],       [0.569, 1.507, 0.181]),
    ("FlightHelmet/FlightHelmet.glb",             94722,  6, 15, 0, 0, [-0.204, 0.0, -0.172],       [0.163, 0.716, 0.200]),
    ("Fox/Fox.glb",                               576,    1,  1, 0, 0, [-12.593, -0.122, -88.095],  [12.593, 78.907, 66.625]),
    ("GlassVaseFlowers/GlassVaseFlowers.glb",     14036,  4,  4, 0, 0, [-0.054, 0.0, -0.068],       [0.164, 0.203, 0.074]),
    ("LightsPunctualLamp/LightsPunctualLamp.glb", 6000,   3,  7, 5, 0, [-0.312, 0.011, -0.362],     [0.815, 1.875, 0.360]),
    ("MorphStressTest/MorphStressTest.glb",       2412,   1,  3, 0, 0, [-2.0, -0.1, -0.5],          [2.0, 0.5, 0.5]),
    ("NegativeScaleTest/NegativeScaleTest.glb",   7724,  11,  2, 0, 0, [-5.162, -4.454, -0.5],      [5.162, 4.454, 0.5]),
    ("RiggedFigure/RiggedFigure.glb",             256,    1,  0, 0, 0, [-0.589, 0.0, -0.131],       [0.589, 1.450, 0.195]),
    ("SimpleInstancing/SimpleInstancing.glb",     1500, 125,  0, 0, 0, [-1.667; 3],                 [12.732; 3]),
    ("Suzanne/Suzanne.gltf",                      3936,   1,  2, 0, 0, [-1.337, -0.975, -0.801],    [1.337, 0.950, 0.826]),
    ("ToyCar/ToyCar.glb",                         108936, 3,  8, 0, 8, [-0.035, -0.016, -0.037],    [0.038, 0.013, 0.037]),
    ("WaterBottle/WaterBottle.glb",               4510,   1,  4, 0, 0, [-0.054, -0.130, -0.054],    [0.054, 0.130, 0.054]),
    ("cad-featuretype/cad-featuretype.glb",       3476,   1,  0, 0, 0, [-2.5, -1.25, 0.0],          [2.5, 1.25, 1.375]),
    ("cat-statue/cat-statue.glb",                 4622,   1,  3, 0, 0, [-0.396, -1.0, -0.667],      [0.396, 1.0, 0.667]),
    ("cesium-balloon-ktx2/cesium-balloon-ktx2.glb", 13224,  1,  3, 0, 0, [-7.023, -1.700, -7.447],       [7.447, 16.842, 7.023]),
    ("dream-apartment/dream-apartment.glb",        177934, 1,  0, 0, 0, [0.444, -0.099, -11.434],       [12.806, 2.681, -0.130]),
    ("helicopter-draco/helicopter-draco.glb",      219187, 14, 0, 0, 0, [-2.307, 0.245, -3.360],        [2.833, 2.391, 1.779]),
    ("ingenuity/ingenuity.glb",                    9060,   1,  9, 0, 0, [-0.495, -0.006, -0.553],       [0.491, 0.556, 0.554]),
    ("garage/garage.glb",                         11358,  1,  0, 0, 0, [-3.430, -0.048, -3.483],    [3.350, 2.928, 4.066]),
    ("godot-room/godot-room.glb",                 63720, 17,  0, 0, 0, [-5.0, 0.0, -5.0],           [5.0, 5.0, 5.0]),
    ("kaykit-knight/kaykit-knight.glb",           6952,  15,  1, 0, 0, [-1.303, 0.0, -0.579],       [1.387, 2.467, 1.998]),
    ("retroufo/retroufo.glb",                     16428, 77,  0, 0, 0, [-73.148, -53.554, -73.148], [80.513, 41.325, 80.512]),
    ("truck-town/truck-town.glb",                 30477, 20,  2, 0, 0, [-1024.0, -4.640, -1024.0],  [1024.0, 17.756, 1024.0]),
    ("zdm2/zdm2.glb",                             58772,  1,  0, 0, 0, [-33.879, -11.968, -29.290], [43.321, 23.984, 30.310]),
];

#[test]
fn real_files() {
    let Some(assets) = assets() else { return };
    let mut wrong = Vec::new();
    for &(file, triangles, instances, images, lights, cameras, min, max) in REAL {
        let scene = zfail_files::load(&assets.join(file)).unwrap_or_else(|e| panic!("{e}"));
        assert_sound(&scene);
        let found = [
            drawn_triangles(&scene),
            scene.instances.len(),
            scene.images.len(),
            scene.lights.len(),
            scene.cameras.len(),
        ];
        let bounds = scene.bounds();
        let near = |found: DVec3, expected: [f64; 3]| found.abs_diff_eq(expected.into(), 1e-3);
        if found != [triangles, instances, images, lights, cameras] || !near(bounds.min, min) || !near(bounds.max, max)
        {
            wrong.push(format!("{file}: {found:?}, {}, {}", bounds.min, bounds.max));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Triangles drawn, and what the first notice says if there is one.
enum Outcome {
    Error(&'static str),
    Loads(usize, &'static str),
}
use Outcome::{Error, Loads};

#[rustfmt::skip]
const BROKEN: &[(&str, Outcome)] = &[
    ("validator/accessor__alignment.gltf",                       Error("buffers[0]: has neither a uri nor a binary chunk")),
    ("validator/accessor__invalid_sparse_count_and_stride.gltf", Error("buffers[0]: has neither a uri nor a binary chunk")),
    // What nothing drawn uses is never read, here and in others.
    ("validator/accessor_data__invalid_elements_float.gltf",     Loads(0, "the scene has no triangles")),
    ("validator/asset__min_version_invalid.gltf",                Error("asset.minVersion")),
    ("validator/buffer__invalid_uri_data.gltf",                  Error("buffers[0].uri: cannot read `data:application/octet-stream;;base64,AA==`")),
    ("validator/buffer__not_found.gltf",                         Error("buffers[0].uri: cannot read `not_found.bin`")),
    ("validator/buffer_view__invalid_length.gltf",               Loads(0, "the scene has no triangles")),
    ("validator/buffer_view__unresolved_buffer.gltf",            Loads(0, "the scene has no triangles")),
    ("validator/glb__empty_file.glb",                            Error("it is empty")),
    ("validator/glb__invalid_magic.glb",                         Error("neither with the GLB signature nor")),
    ("validator/glb__length_mismatch.glb",                       Loads(0, "says 49 bytes, the file has 48")),
    ("validator/glb__truncated_chunk_data.glb",                  Error("the chunk at byte 12 says 28 bytes, 27 follow")),
    ("validator/glb__truncated_chunk_header.glb",                Error("a chunk header at byte 12 is cut off")),
    ("validator/image__png_eos.gltf",                            Loads(0, "image \"png_eos.png\" is damaged (")),
    ("validator/json__bom.gltf",                                 Loads(0, "the JSON begins with a byte order mark")),
    ("validator/mesh__accessor_unequal_count.gltf",              Loads(0, "the scene has no triangles")),
    // Bounds are computed from the vertices.
    ("validator/mesh__position_accessor_no_bounds.gltf",         Loads(0, "the scene has no triangles")),
    ("validator/mesh__unresolved_positions.gltf",                Loads(0, "the scene has no triangles")),
    ("validator/mesh_data__index_buffer_oob.gltf",               Loads(0, "the scene has no triangles")),
    ("validator/mesh_data__index_buffer_primitive_restart.gltf", Loads(0, "the scene has no triangles")),
    // A mesh of points: its joints are never read.
    ("validator/mesh_data__joints_weights_complex.gltf",         Loads(0, "mesh \"mesh 0\": 1 primitive of points or lines")),
    ("validator/node__infinite_transform.gltf",                  Error("nodes[0]: its world transform is beyond all measure")),
    ("validator/node__matrix_indecomposable.gltf",               Error("nodes[0].matrix: its last row is not 0 0 0 1")),
    ("validator/node__node_loop.gltf",                           Error("nodes[0]: is or hangs below its own descendant")),
    ("validator/node__node_parent_override.gltf",                Loads(0, "1 node is drawn again below a second parent")),
    // Joints need no common root to be posed.
    ("validator/skin__no_common_root.gltf",                      Loads(0, "the scene has no triangles")),
    ("validator/skin_data__invalid_ibm.gltf",                    Loads(0, "the scene has no triangles")),
    ("other/IndexOutOfRange.gltf",                               Loads(11, "1 triangle with a vertex that is not there: left out")),
    ("other/Mesh_NoPosition_00.gltf",                            Loads(0, "mesh \"triangle\": 1 primitive without POSITION")),
    // Points.
    ("other/Mesh_PrimitiveRestart_00.gltf",                      Loads(0, "2 primitives of points or lines: not drawn")),
    ("other/cubeSomeBadIndices.glb",                             Loads(8, "4 triangles with a vertex that is not there: left out")),
    ("other/fuzz.glb",                                           Loads(12, "")),
    ("other/zero-sized-bin-chunk.glb",                           Loads(1, "")),
    ("edge-valid/Animation_Skin_09.gltf",                        Loads(11, "")),
    ("edge-valid/Box With Spaces.gltf",                          Loads(12, "")),
    ("edge-valid/Compatibility_05.gltf",                         Loads(2, "FAKE_materials_quantumRendering is ignored")),
    ("edge-valid/MeshPrimitiveModes.gltf",                       Loads(16, "mesh \"mesh with POINTS\"")),
    ("edge-valid/Mesh_PrimitiveMode_05.gltf",                    Loads(2, "")),
    ("edge-valid/Node_NegativeScale_04.gltf",                    Loads(54, "")),
    ("edge-valid/SimpleSparseAccessor.gltf",                     Loads(12, "")),
];

#[test]
fn broken_and_unusual_files() {
    let Some(assets) = assets() else { return };
    for (file, expected) in BROKEN {
        let path = assets.join("invalid").join(file);
        match (zfail_files::load(&path), expected) {
            (Ok(scene), Loads(triangles, notice)) => {
                assert_sound(&scene);
                assert_eq!(drawn_triangles(&scene), *triangles, "{file}");
                let first = scene.notices.first().map_or("", String::as_str);
                assert!(if notice.is_empty() { first.is_empty() } else { first.contains(notice) }, "{file}: {first}");
            }
            (Err(e), Error(message)) => {
                let text = e.to_string();
                assert!(text.starts_with(&path.display().to_string()) && text.contains(message), "{text}");
            }
            (Ok(scene), Error(_)) => panic!("{file} loads, with notices {:?}", scene.notices),
            (Err(e), Loads(..)) => panic!("{e}"),
        }
    }
}

/// An independent reading of the same file: world-space triangles through the `gltf` crate and its importer.
fn reference_triangles(path: &Path) -> Vec<[DVec3; 3]> {
    fn visit(node: &gltf::Node<'_>, parent: DMat4, buffers: &[gltf::buffer::Data], triangles: &mut Vec<[DVec3; 3]>) {
        let world = parent * DMat4::from_cols_array_2d(&node.transform().matrix().map(|column| column.map(f64::from)));
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            let reader = primitive.reader(|buffer| Some(&buffers[buffer.index()]));
            let at = |p: [f32; 3]| world.transform_point3(DVec3::from(p.map(f64::from)));
            let positions: Vec<DVec3> = reader.read_positions().unwrap().map(at).collect();
            let indices: Vec<u32> = match reader.read_indices() {
                Some(indices) => indices.into_u32().collect(),
                None => (0..positions.len() as u32).collect(),
            };
            triangles.extend(indices.as_chunks().0.iter().map(|t: &[u32; 3]| t.map(|v| positions[v as usize])));
        }
        node.children().for_each(|child| visit(&child, world, buffers, triangles));
    }
    let (document, buffers, _) = gltf::import(path).unwrap();
    let mut triangles = Vec::new();
    let scene = document.default_scene().unwrap();
    scene.nodes().for_each(|node| visit(&node, DMat4::IDENTITY, &buffers, &mut triangles));
    triangles
}

/// Greatest distance between corresponding vertices; infinite if the counts differ.
fn difference(a: &[[DVec3; 3]], b: &[[DVec3; 3]]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    a.as_flattened().iter().zip(b.as_flattened()).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max)
}

#[test]
fn geometry_agrees_with_an_independent_reader() {
    let Some(assets) = assets() else { return };
    for file in [
        "FlightHelmet/FlightHelmet.glb",
        "godot-room/godot-room.glb",
        "zdm2/zdm2.glb",
        "Suzanne/Suzanne.gltf",
        "garage/garage.glb",
        "retroufo/retroufo.glb",
        "cad-featuretype/cad-featuretype.glb",
    ] {
        let path = assets.join(file);
        let scene = zfail_files::load(&path).unwrap_or_else(|e| panic!("{e}"));
        let instances = scene.instances.iter().flat_map(|i| {
            let mesh = &scene.meshes[i.mesh];
            (0..mesh.triangles.len()).map(|t| world_triangle(mesh, &i.world_from_object, t))
        });
        let (ours, reference) = (instances.collect::<Vec<_>>(), reference_triangles(&path));
        // The reference's transforms are in single precision.
        let tolerance = 1e-5 * scene.bounds().half().length();
        let found = difference(&ours, &reference);
        println!("{file}: {} triangles, largest difference {found:.1e}", ours.len());
        assert!(found <= tolerance, "{file}: {found} > {tolerance}");
        let mut moved = ours;
        moved[7][1].x += 3.0 * tolerance;
        assert!(difference(&moved, &reference) > tolerance, "the comparison sees a moved vertex");
    }
}

/// The GLB file at `path` with every `TANGENT` renamed, so that a reader does not see it.
fn without_tangents(path: &Path) -> Vec<u8> {
    let mut bytes = std::fs::read(path).unwrap();
    let found: Vec<usize> = bytes.windows(9).enumerate().filter(|(_, w)| w == b"\"TANGENT\"").map(|(i, _)| i).collect();
    assert!(!found.is_empty(), "{}", path.display());
    found.iter().for_each(|&i| bytes[i + 1] = b'_');
    bytes
}

#[test]
fn made_tangents_agree_with_those_of_exporters() {
    let Some(assets) = assets() else { return };
    for file in ["FlightHelmet/FlightHelmet.glb", "WaterBottle/WaterBottle.glb"] {
        let path = assets.join(file);
        let given = zfail_files::load(&path).unwrap_or_else(|e| panic!("{e}"));
        let made = load_bytes(&without_tangents(&path), &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
        let tangents = |scene: &Scene| scene.meshes.iter().flat_map(|m| m.tangents.clone()).collect::<Vec<_>>();
        let (given, made) = (tangents(&given), tangents(&made));
        let agree = |(a, b): &(&[f32; 4], &[f32; 4])| a[3] == b[3] && (0..3).map(|i| a[i] * b[i]).sum::<f32>() > 0.9;
        let share = given.iter().zip(&made).filter(agree).count() as f64 / given.len() as f64;
        println!("{file}: {:.2} % of {} tangents agree", 100.0 * share, given.len());
        assert!(given.len() == made.len() && share > 0.95, "{file}: {share}");
    }
}
