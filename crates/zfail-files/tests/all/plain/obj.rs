//! .obj files, as programs write them.

use super::{fails, loaded, png, told, world_triangles};
use zfail_plan::glam::DVec3;
use zfail_scene::AlphaMode;

pub const OBJ: &str = "# a quad and a triangle\r
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

pub const MTL: &str = "newmtl wood
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
    assert_eq!(scene.notices[0], "2 statements of points and lines: not drawn, since they have no surface");
    assert_eq!(scene.notices[1..], ["OBJ has neither axes nor units: y is taken as up, and one unit as one metre"]);
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

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

/// The same two triangles.
fn quad() -> Vec<[DVec3; 3]> {
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    vec![[a, b, c], [a, c, d]]
}

#[test]
fn however_it_is_written() {
    let wide = |unit: fn(u16) -> [u8; 2]| format!("\u{feff}{QUAD}").encode_utf16().flat_map(unit).collect();
    let texts: Vec<Vec<u8>> = [
        QUAD.to_owned(),
        QUAD.replace('\n', "\r"),
        QUAD.replace('\n', "\r\n"),
        QUAD.replace('\n', " # a comment\n"),
        QUAD.replace('\n', "\n\n \n#c:\\\n"),
        QUAD.replace(' ', "\t ").replace('v', "  v").replace('f', "\tf"),
        QUAD.replace("1 0 0", "+1 0. 0e+0").replace("1 1 0", "1.0E0 .1e1 -0"),
        QUAD.replace("1 0 0", "1 0 0 1").replace("1 1 0", "1 1 0 0.5"),
        QUAD.replace("f 1 2 3 4", "f 1 2 \\\n 3\\\r\n4"),
        QUAD.replace("f 1 2 3 4", "f -4 -3 -2 -1"),
        QUAD.replace("f 1 2 3 4", "f +1/ 2// 3 4/"),
        QUAD.replace("f 1 2 3 4", "fo 1 2 3 4"),
        format!("f 1 2 3 4\n{}", QUAD.replace("f 1 2 3 4", "")),
        format!("\u{feff}{QUAD}"),
        format!("g\ng a\\\no\nusemtl\nusemtl \ns off\nmtllib\nlod 1\nwhatever 3 4\n1 2 3\n{QUAD}"),
        format!("{QUAD}\0\0\0\u{1a}"),
    ]
    .into_iter()
    .map(String::into_bytes)
    .chain([wide(u16::to_le_bytes), wide(u16::to_be_bytes)])
    .collect();
    for text in texts {
        let scene = loaded(&[("a.obj", &text)]);
        assert_eq!(world_triangles(&scene), quad(), "{:?}", String::from_utf8_lossy(&text));
        assert_eq!(scene.notices.len(), 1, "{:?}", scene.notices);
    }
}

#[test]
fn what_cannot_be_drawn_is_left_out() {
    let with = |more: &str, notice: &str| {
        let (triangles, notices) = told(&[("a.obj", format!("{QUAD}{more}").as_bytes())]);
        assert_eq!((triangles, notices.as_slice()), (2, [notice.to_owned()].as_slice()), "{more}");
    };
    with("f 1 2\nf 3\nf\n", "3 faces of fewer than three corners are left out (line 6)");
    let there = "but there are 4)";
    with(
        "f 1 2 9",
        &format!("1 face with a vertex that is not there is left out (line 6: refers to vertex 9, {there}"),
    );
    with(
        "f 1 2 -5",
        &format!("1 face with a vertex that is not there is left out (line 6: refers to vertex -5, {there}"),
    );
    with(
        "f 1 2 0",
        &format!("1 face with a vertex that is not there is left out (line 6: refers to vertex 0, {there}"),
    );
    let huge = "9223372036854775807";
    let missing = format!("line 6: refers to vertex {huge}, {there}");
    with(&format!("f 1 2 {huge}"), &format!("1 face with a vertex that is not there is left out ({missing}"));
    with("f 1 2 x 3", "1 face that cannot be read is left out (line 6: `x` is no corner)");
    let nowhere = |n: &str| format!("{n} with a vertex that is not finite, or beyond 5e14, ");
    for vertex in ["nan 0 0", "-1.#IND 0 0", "0 inf 0", "0 1e300 0", "1 x 0", "1 2", ""] {
        let left_out = nowhere("2 triangles") + "are left out (line 7)";
        with(&format!("v {vertex}\nf 1 2 5 3\n"), &left_out);
    }
    with("p 1\nl 1 2 3\n", "2 statements of points and lines: not drawn, since they have no surface");
    with("cstype bezier\nsurf 0 1 0 1 1 2 3 4\nend\n", "1 free-form surface: not drawn, since only polygons are");
    with("call other.obj 1\n", "1 call of other files: not followed");
}

#[test]
fn nothing_to_draw() {
    fails(&[("a.obj", b"")], "the file: has no faces; export it again with the faces");
    fails(&[("a.obj", b"v 0 0 0\nl 1 1\n")], "has points or lines and no faces; make surfaces of them");
    fails(&[("a.obj", b"surf 1\n")], "has free-form surfaces and no faces; export them as polygons");
    let lost = "has no faces but those with a vertex that is not there (line 1: refers to vertex -3, but there are 0)";
    fails(&[("a.obj", b"f -3 -2 -1\n")], lost);
    fails(&[("a.obj", b"v x 0 0\nf 1 1 1\n")], "has no triangles but those with a vertex that is not finite");
}

#[test]
fn attributes_cost_no_more_than_themselves() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 -1\nvn -1.#IND 0 1\nvt 0.25 0.5\n";
    let with = |faces: &str| loaded(&[("a.obj", format!("{text}{faces}").as_bytes())]);
    let whole = with("f 1/1/1 2/1/1 3/1/1\n");
    assert_eq!((whole.meshes[0].normals[0], whole.meshes[0].uv0[0]), ([0.0, 0.0, -1.0], [0.25, 0.5]));
    let beyond = "1 face with normals or texture coordinates that are not there, or not finite: shown without them";
    for corner in ["3//9", "3//-3", "3//0", "3//x", "3//2"] {
        let scene = with(&format!("f 1//1 2//1 {corner}\nf 1/1/1 3/1/1 4/1/1\n"));
        assert_eq!(scene.notices[0], beyond, "{corner}");
        let mesh = &scene.meshes[0];
        let normals: Vec<f32> = mesh.triangles.iter().map(|t| mesh.normals[t[0] as usize][2]).collect();
        assert_eq!(normals, [1.0, -1.0], "only the face itself is shown flat");
    }
    let scene = with("f 1/1/1 2/1/1 3//1\n");
    assert!(scene.notices[0].contains("at some corners only"), "{:?}", scene.notices);
    assert_eq!((scene.meshes[0].normals[0], scene.meshes[0].uv0[0]), ([0.0, 0.0, -1.0], [0.0, 0.0]));
}

#[test]
fn corners_that_are_alike_share_a_vertex() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\nf 1//2 3//2 4//2\n";
    assert_eq!(loaded(&[("a.obj", text.as_bytes())]).meshes[0].positions.len(), 7);
}

#[test]
fn colours() {
    let text = "v 0 0 0\nv 0 0 1 0 0 1\nv 0 1 0\nv 1 0 0 1 .6 .3\nf 1 2 3\nf 1 4 3\nf 1 3 1\n";
    let scene = loaded(&[("a.obj", text.as_bytes())]);
    assert_eq!(scene.notices[0], "3 faces with vertices that lack the colour that others have: white there");
    let mesh = &scene.meshes[0];
    let color = |t: usize, c: usize| mesh.colors[mesh.triangles[t][c] as usize];
    assert_eq!((color(0, 0), color(0, 1), color(1, 1)[0]), ([1.0; 4], [0.0, 0.0, 1.0, 1.0], 1.0));
    let bytes = "v 0 0 0 255 0 0 1\nv 1 0 0 255 0 0 1\nv 1 1 0 0 51 0 1\nf 1 2 3\n";
    let mesh = &loaded(&[("a.obj", bytes.as_bytes())]).meshes[0];
    assert_eq!(mesh.colors[0], [1.0, 0.0, 0.0, 1.0]);
    assert!((mesh.colors[2][1] - 0.0331).abs() < 1e-4, "{:?}", mesh.colors);
}

/// A post on a plate, in the coordinates of a survey and near the origin.
fn surveyed(origin: DVec3) -> Vec<u8> {
    let mut text = "v 0 0 0\n".to_owned();
    for [x, y, z] in
        [[-4.0, 0.0, -4.0], [4.0, 0.0, -4.0], [4.0, 0.0, 4.0], [-0.06, 0.0, 0.0], [0.06, 0.0, 0.0], [0.06, 2.0, 0.0]]
    {
        let [x, y, z] = (DVec3::new(x, y, z) + origin).to_array();
        text.push_str(&format!("v {x:.3} {y:.3} {z:.3}\n"));
    }
    (text + "f 2 3 4\nf 5 6 7\n").into_bytes()
}

#[test]
fn surveyed_models_keep_their_shape() {
    let near = world_triangles(&loaded(&[("a.obj", &surveyed(DVec3::ZERO))]));
    let origin = DVec3::new(442_311.37, 112.4, -5_411_027.83);
    let scene = loaded(&[("a.obj", &surveyed(origin))]);
    let far = world_triangles(&scene);
    let differences =
        near.as_flattened().iter().zip(far.as_flattened()).map(|(near, far)| (*far - *near - origin).length());
    let worst = differences.fold(0.0, f64::max);
    assert!(worst < 1e-6, "{worst} m off; single precision would be off by 0.2 m");
    let rounded = far[1][0].x as f32;
    assert!((f64::from(rounded) - far[1][0].x).abs() > 1e-3, "the test would not notice single precision");
    assert_eq!(scene.instances[0].world_from_object.translation.y, 112.4 + 1.0);
}

/// Many attributes at one position, many materials, many continued lines: what takes the square of them, takes minutes.
#[test]
fn nothing_takes_the_square_of_a_file() {
    use std::fmt::Write;
    let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned();
    for i in 1..=20_000 {
        write!(text, "vt {i} 0\nvn {i} 0 1\nusemtl {i}\nf 1/{i}/{i} 2/{i}/{i} \\\n3/{i}/{i}\nmtllib {i}.mtl\n")
            .unwrap();
    }
    text.push_str(&"\\\n".repeat(100_000));
    let start = std::time::Instant::now();
    assert_eq!(world_triangles(&loaded(&[("a.obj", text.as_bytes())])).len(), 20_000);
    assert!(start.elapsed().as_secs() < 5, "{:?}", start.elapsed());
}
