//! .obj, .stl and .ply files, written here and loaded.

use crate::build::assert_sound;
use crate::hostile::Random;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use tempfile::TempDir;
use zfail_plan::glam::DVec3;
use zfail_plan::scene::{AlphaMode, Scene, world_triangle};
use zfail_scene::{Limits, LoadError};

/// Loads the first of `files`, which lie in one folder.
fn load(files: &[(&str, &[u8])]) -> Result<Scene, LoadError> {
    let folder = TempDir::new().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join("model").join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    fs::write(folder.path().join("secret.mtl"), "newmtl a\n").unwrap();
    zfail_scene::load_with(&folder.path().join("model").join(files[0].0), &Limits { bytes: 1 << 26, image_side: 64 })
}

#[track_caller]
fn loaded(files: &[(&str, &[u8])]) -> Scene {
    let scene = load(files).unwrap_or_else(|e| panic!("{e}"));
    assert_sound(&scene);
    scene
}

#[track_caller]
fn fails(files: &[(&str, &[u8])], expected: &str) {
    let error = load(files).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains(expected) && !error.contains("glTF validator"), "{error}\nlacks {expected:?}");
}

fn world_triangles(scene: &Scene) -> Vec<[DVec3; 3]> {
    let of = |i: &zfail_plan::scene::Instance| {
        let mesh = &scene.meshes[i.mesh];
        (0..mesh.triangles.len()).map(|t| world_triangle(mesh, &i.world_from_object, t)).collect::<Vec<_>>()
    };
    scene.instances.iter().flat_map(of).collect()
}

fn png() -> Vec<u8> {
    use image::ImageEncoder;
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    encoder.write_image(&[9; 4], 1, 1, image::ExtendedColorType::Rgba8).unwrap();
    bytes
}

const OBJ: &str = "# a quad and a triangle\r
mtllib sub\\wood.mtl
o board
v 0 0 0 1 0 0
v 1 0 0 1 0 0
v 1 1 0 1 0 0
v 0 1 0 0 0 1
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl wood
f 1/1 2/2 \\
  3/3 4/4
g other
usemtl glass
f -4 -3 -2
p 1
l 1 2
";

const MTL: &str = "newmtl wood
Kd 0.5 0.25 1
Ke 0 0 2
Ns 30
map_Kd -s 1 1 1 bark.png
newmtl glass
Tr 0.75
Pr 0.125
Pm 1
";

#[test]
fn obj_with_materials() {
    let scene = loaded(&[("a b.OBJ", OBJ.as_bytes()), ("sub/wood.mtl", MTL.as_bytes()), ("sub/bark.png", &png())]);
    assert_eq!(scene.notices, ["OBJ has neither axes nor units: y is taken as up, and one unit as one metre"]);
    assert_eq!((scene.meshes.len(), scene.images.len(), scene.name.as_str()), (1, 1, "a b"));
    let mesh = &scene.meshes[0];
    let materials: Vec<_> = mesh.primitives.iter().map(|p| (p.triangles.clone(), p.material.unwrap())).collect();
    assert_eq!(materials, [(0..2, 0), (2..3, 1)]);
    let corner = |t: usize, c: usize| mesh.triangles[t][c] as usize;
    assert_eq!(mesh.positions[corner(1, 2)], [0.0, 1.0, 0.0]);
    assert_eq!(mesh.uv0[corner(1, 2)], [0.0, 0.0], "v is turned over");
    assert_eq!(mesh.normals[corner(0, 0)], [0.0, 0.0, 1.0]);
    assert_eq!((mesh.colors[corner(0, 0)], mesh.colors[corner(1, 2)]), ([1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]));
    let [wood, glass, _] = &scene.materials[..] else { panic!("{:?}", scene.materials) };
    assert_eq!((wood.base_color, wood.emissive, wood.metallic), ([0.5, 0.25, 1.0, 1.0], [0.0, 0.0, 2.0], 0.0));
    assert!(wood.base_color_texture.is_some() && wood.double_sided && (wood.roughness - 0.5).abs() < 1e-3);
    assert_eq!((glass.alpha, glass.base_color[3], glass.roughness), (AlphaMode::Blend, 0.25, 0.125));
    assert_eq!(world_triangles(&scene)[2], [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]);
}

#[test]
fn concave_faces_do_not_overlap() {
    let arrow = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\nf 1 2 4\n";
    let triangles = world_triangles(&loaded(&[("a.obj", arrow.as_bytes())]));
    assert_eq!(triangles.len(), 3);
    assert!(triangles.iter().all(|[a, b, c]| (*b - *a).cross(*c - *a).z > 0.0), "{triangles:?}");
}

#[test]
fn obj_without_its_other_files() {
    let scene = loaded(&[("a.obj", OBJ.as_bytes())]);
    assert_eq!(scene.materials.len(), 1);
    assert!(scene.notices[0].starts_with("material library `sub/wood.mtl` is not below"), "{:?}", scene.notices);
    let scene = loaded(&[("a.obj", OBJ.as_bytes()), ("sub/wood.mtl", MTL.as_bytes())]);
    assert!(scene.notices[0].contains("texture `bark.png` is not below"), "{:?}", scene.notices);
    let outside = OBJ.replace("sub\\wood.mtl", "../secret.mtl");
    assert!(loaded(&[("a.obj", outside.as_bytes())]).notices[0].contains("`../secret.mtl` is not below"));
}

#[test]
fn obj_damage() {
    let with = |from: &str, to: &str, expected: &str| fails(&[("a.obj", OBJ.replace(from, to).as_bytes())], expected);
    with("v 1 1 0", "v 1 x 0", "line 6 or the group before it: ");
    with("v 1 1 0", "v 1 nan 0", "vertex ");
    with("f -4", "f -9999/-4", "line 17: the corner -9999/-4");
    with("f -4", "f 1/9223372036854775807", "line 17: the corner 1/9223372036854775807");
    with("f -4", "f 99", "line 19 or the group before it: ");
    with("f ", "# ", "the file: has no faces");
    fails(&[("a.obj", b"")], "the file: has no faces");
}

const PLY: &str = "ply
format ascii 1.0
comment TextureFile bark.png
element vertex 4
property double x
property float y
property float z
property uchar red
property uchar green
property uchar blue
property float s
property float t
element extra 1
property int unused
element face 2
property list uchar int vertex_indices
end_header
0 0 0 255 0 0 0 0
1 0 0 255 0 0 1 0
1 1 0 255 0 0 1 1
0 1 2 0 0 255 0 1
7
4 0 1 2 3
3 0 2 3
";

/// The same file in binary, with either byte order.
fn binary_ply(big: bool) -> Vec<u8> {
    let (header, body) = PLY.split_at(PLY.find("end_header\n").unwrap() + 11);
    let order = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = header.replace("ascii", order).into_bytes();
    let lines: Vec<Vec<f64>> =
        body.lines().map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect()).collect();
    let mut push = |number: &[u8]| bytes.extend(number.iter().rev().copied());
    let mut put = |value: f64, size: usize, float: bool| {
        let number = match (size, float) {
            (8, _) => value.to_be_bytes().to_vec(),
            (4, true) => (value as f32).to_be_bytes().to_vec(),
            (4, false) => (value as i32).to_be_bytes().to_vec(),
            _ => vec![value as u8],
        };
        if big { push(&number.iter().rev().copied().collect::<Vec<_>>()) } else { push(&number) }
    };
    for vertex in &lines[..4] {
        for (value, size) in vertex.iter().zip([8, 4, 4, 1, 1, 1, 4, 4]) {
            put(*value, size, true);
        }
    }
    put(lines[4][0], 4, false);
    for face in &lines[5..] {
        put(face[0], 1, false);
        face[1..].iter().for_each(|&i| put(i, 4, false));
    }
    bytes
}

#[test]
fn ply_encodings() {
    for bytes in [PLY.as_bytes().to_vec(), binary_ply(false), binary_ply(true)] {
        let scene = loaded(&[("a.ply", &bytes), ("bark.png", &png())]);
        assert_eq!(scene.notices, ["PLY has neither axes nor units: z is taken as up, and one unit as one metre"]);
        let triangles = world_triangles(&scene);
        assert_eq!(triangles.len(), 3);
        assert_eq!(triangles[1], [DVec3::ZERO, DVec3::new(1.0, 0.0, -1.0), DVec3::new(0.0, 2.0, -1.0)]);
        let mesh = &scene.meshes[0];
        let last = mesh.triangles[2][2] as usize;
        assert_eq!((mesh.colors[last], mesh.uv0[last]), ([0.0, 0.0, 1.0, 1.0], [0.0, 0.0]));
        assert!(scene.materials[0].base_color_texture.is_some());
    }
}

#[test]
fn surveyed_scans_keep_double_precision() {
    let far = PLY.replace("\n1 0 0 255", "\n1000001.1 0 0 255").replace("\n1 1 0 255", "\n1000001.1 1 0 255");
    let far = far.replace("\n0 0 0 255", "\n1000000.1 0 0 255").replace("\n0 1 2 0", "\n1000000.1 1 2 0");
    let scene = loaded(&[("a.ply", far.as_bytes())]);
    let [_, corner, _] = world_triangles(&scene)[0];
    assert!(corner.abs_diff_eq(DVec3::new(1_000_001.1, 0.0, 0.0), 1e-6), "{corner}");
}

#[test]
fn ply_damage() {
    let with = |from: &str, to: &str, expected: &str| fails(&[("a.ply", PLY.replace(from, to).as_bytes())], expected);
    with("element face 2", "element face 0", "is a point cloud");
    with("4 0 1 2 3", "4 0 1 2 4", "face 0: refers to vertex 4, but there are 4");
    with("4 0 1 2 3", "4 0 1 2 -1", "face 0: refers to vertex");
    with("4 0 1 2 3", "4 0 1 2", "line 23");
    with("1 1 0 255", "1 nan 0 255", "line 20: cannot be read: ");
    with("1 1 0 255", "1e300 1 0 255", "vertex 2: has a coordinate");
    with("element vertex 4", "element vertex 999999999999", "element vertex: says 999999999999 elements");
    with("property double x\n", "property double w\n", "element vertex: has no property x");
    with("ply\n", "plx\n", "line 1");
    // Elements without properties take no bytes.
    let endless = "element nothing 18446744073709551615\nelement vertex";
    let endless = PLY.replace("ascii", "binary_little_endian").replace("element vertex", endless);
    fails(&[("a.ply", endless.as_bytes())], "element nothing: says 18446744073709551615 elements");
    let cut = binary_ply(true);
    fails(&[("a.ply", &cut[..cut.len() - 1])], "end of file");
}

const STL: &str = "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 2\nendloop\nendfacet\n\
                   endsolid a\n";

#[test]
fn stl_stands_upright() {
    let scene = loaded(&[("part.Stl", STL.as_bytes())]);
    assert_eq!(scene.notices, ["STL has neither axes nor units: z is taken as up, and one unit as one metre"]);
    assert_eq!(world_triangles(&scene), [[DVec3::ZERO, DVec3::X, DVec3::new(0.0, 2.0, -1.0)]]);
    assert!(scene.materials[0].double_sided);
    fails(&[("a.stl", b"solid")], "the file: has no triangles");
    fails(&[("a.stl", STL.replace("vertex 1", "vertex inf").as_bytes())], "corner 1: has a coordinate");
}

#[test]
fn names_and_contents_must_agree() {
    let wrong = load(&[("a.glb", OBJ.as_bytes())]).map(|_| ()).unwrap_err().to_string();
    assert!(wrong.contains("is not a glTF 2.0 file") && wrong.contains(".obj, .stl or .ply"), "{wrong}");
    assert!(zfail_scene::load(Path::new("/nonexistent/a.obj")).is_err());
    fails(&[("a.obj", &png())], "the file: has no faces");
    fails(&[("a.stl", &png())], "neither ASCII");
    fails(&[("a.ply", &png())], "the file: cannot be read: ");
}

#[test]
fn flipped_and_cut_files() {
    let mut random = Random(5);
    let files: [(&str, Vec<u8>); 4] =
        [("a.obj", OBJ.into()), ("a.stl", STL.into()), ("a.ply", PLY.into()), ("b.ply", binary_ply(true))];
    for (name, original) in files {
        let mut same = 0;
        for round in 0..300 {
            let mut bytes = original.clone();
            if round % 3 == 0 {
                bytes.truncate(random.below(bytes.len()));
            }
            for _ in 0..random.below(4) {
                let at = random.below(original.len());
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << random.below(8);
                }
            }
            let start = Instant::now();
            let result = load(&[(name, &bytes), ("sub/wood.mtl", &bytes)]);
            assert!(start.elapsed() < Duration::from_secs(5), "{name}, round {round}: slow");
            match result {
                Ok(scene) => {
                    assert_sound(&scene);
                    same += 1;
                }
                Err(e) => assert!(!e.to_string().contains('\n') && !e.to_string().contains("decoder failed"), "{e}"),
            }
        }
        assert!(same > 10 && same < 290, "{name}: {same} of 300 loaded");
    }
}
