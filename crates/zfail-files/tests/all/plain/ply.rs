//! .ply files, as programs write them.

use super::{fails, loaded, png, told, world_triangles};
use zfail_plan::glam::DVec3;

pub const PLY: &str = "ply
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
pub fn binary_ply(big: bool) -> Vec<u8> {
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

const TRIANGLE: &str = "ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
1 1 0
3 0 1 2
";

#[test]
fn however_it_is_written() {
    let wide: Vec<u8> = format!("\u{feff}{TRIANGLE}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    let (header, body) = TRIANGLE.split_at(TRIANGLE.find("0 0 0").unwrap());
    let texts: Vec<Vec<u8>> = [
        TRIANGLE.replace('\n', "\r"),
        TRIANGLE.replace('\n', "\r\n"),
        TRIANGLE.replace('\n', " \n"),
        TRIANGLE.replace("property", "  property \t").replace("element", " element "),
        format!("\u{feff}{TRIANGLE}"),
        header.to_owned() + &body.replace('\n', " "),
        header.to_owned() + &body.replace(' ', "\n"),
        header.to_owned() + &body.replace('\n', "\n\n# a comment\ncomment 9 9\n"),
        header.to_owned() + &body.replace("0 0 0", "0 0. .0e+0 7 # more"),
        TRIANGLE.replace("vertex_indices", "polygon").replace("uchar int", "ushort uint64"),
        TRIANGLE.replace("uchar int", "float double"),
        TRIANGLE.replace("uchar int vertex_indices", "uchar int vertex_index"),
        TRIANGLE
            .replace("property float y", "property list uchar int y2\nproperty string z2\nproperty float Y")
            .replace(" 0 0\n", " 2 8 9 name 0 0\n")
            .replace("1 1 0\n", "1 0 name 1 0\n"),
    ]
    .into_iter()
    .map(String::into_bytes)
    .chain([wide])
    .collect();
    let expected = vec![[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 0.0, -1.0)]];
    for text in texts {
        let scene = loaded(&[("a.ply", &text)]);
        assert_eq!(world_triangles(&scene), expected, "{:?}", String::from_utf8_lossy(&text));
        assert_eq!(scene.notices.len(), 1, "{:?}", scene.notices);
    }
}

#[test]
fn elements_in_any_order_and_unknown_lines() {
    let text = "ply\nformat ascii 1.0\ncomment \u{e4} made by hand\nvendor 3\nelement face 1\nproperty uchar red\n\
                property list uchar int vertex_indices\nelement material 1\nproperty float shine\nproperty list int int more\n\
                element empty 99999999999\nelement vertex 3\nproperty float z\nproperty float x\nproperty float y\nend_header\n\
                9 3 0 1 2\n0.5 2 1 1\n0 0 0\n0 1 0\n0 1 1\n";
    let mut bytes = text.as_bytes().to_vec();
    let at = bytes.iter().position(|b| *b == 0xc3).unwrap();
    bytes[at] = 0xff;
    let (triangles, notices) = told(&[("a.ply", &bytes)]);
    assert_eq!(triangles, 1);
    let colours = "colours of faces are left out; those of vertices are used";
    assert_eq!(notices, ["header line `vendor 3` is unknown and ignored", colours]);
}

#[test]
fn strips_restart_and_turn() {
    let text = TRIANGLE.replace("element face 1", "element tristrips 1").replace("uchar int", "int int");
    let text = text
        .replace("vertex 3", "vertex 5")
        .replace("1 1 0\n3 0 1 2", "0 1 0\n1 1 0\n0 2 0\n12 0 1 2 3 -1 2 3 4 4 4 -1 0");
    let scene = loaded(&[("a.ply", text.as_bytes())]);
    let triangles = world_triangles(&scene);
    assert_eq!(triangles.len(), 3, "joints without area are none");
    assert!(triangles.iter().all(|[a, b, c]| (*b - *a).cross(*c - *a).y > 0.0), "all face one way: {triangles:?}");
}

#[test]
fn what_cannot_be_drawn_is_left_out() {
    let with = |count: usize, faces: &str, notice: &str| {
        let text = TRIANGLE.replace("face 1", &format!("face {count}"));
        let (triangles, notices) = told(&[("a.ply", format!("{text}{faces}").as_bytes())]);
        assert_eq!((triangles, notices.as_slice()), (1, [notice.to_owned()].as_slice()), "{faces}");
    };
    let missing = |i: &str| {
        format!("1 face with a vertex that is not there is left out (face 1: refers to vertex {i}, but there are 3)")
    };
    with(2, "3 0 1 3\n", &missing("3"));
    with(2, "3 0 1 -1\n", &missing("-1"));
    with(2, "3 0 1 0.5\n", &missing("0.5"));
    with(3, "2 0 1\n0\n", "2 faces of fewer than three corners are left out (face 1)");
    with(2, "3 0 1\n", "1 face that cannot be read is left out (line 14)");
    with(2, "3 0 x 1\n", "1 face that cannot be read is left out (line 14)");
    with(2, "-3 0 1 2\n", "1 face that cannot be read is left out (line 14)");
    let nowhere = "2 triangles with a vertex that is not finite, or beyond 5e14, are left out (face 0)";
    for vertex in ["nan 1 0", "0 1e16 0", "1 x 0", "1 2"] {
        let text = PLY.replace("1 1 0 255 0 0 1 1", vertex).replace("3 0 2 3", "3 0 1 3");
        let (triangles, notices) = told(&[("a.ply", text.as_bytes()), ("bark.png", &png())]);
        assert_eq!((triangles, notices[0].as_str()), (1, nowhere), "{vertex}");
    }
}

#[test]
fn ply_damage() {
    let with = |from: &str, to: &str, expected: &str| fails(&[("a.ply", PLY.replace(from, to).as_bytes())], expected);
    with(
        "element face 2",
        "element face 0",
        "is a point cloud: it has no faces that could cast or receive a shadow; make a",
    );
    with("4 0 1 2 3\n3 0 2 3\n", "4 0 1 2 3\n", "element face: says that there are 2, but the file ends after 1");
    with("element vertex 4", "element vertex 999999999999", "element vertex: says that there are 999999999999");
    with("property double x\n", "property double w\n", "element vertex: has no property x; export it again with the");
    with("property float z\n", "", "element vertex: has no property z");
    with("ply\n", "plx\n", "line 1: is not `ply`");
    with("format ascii", "format text", "line 2: names an unknown format");
    with("end_header\n", "", "the header: has no line `end_header`; its end is missing");
    let all = PLY.replace("4 0 1 2 3", "4 0 1 2 -1").replace("3 0 2 3", "3 0 2 4294967296");
    let lost = "has no faces but those with a vertex that is not there (face 0: refers to vertex -1, but there are 4)";
    fails(&[("a.ply", all.as_bytes())], lost);
    // Elements without properties take no bytes.
    let endless = "element nothing 18446744073709551615\nelement vertex";
    let endless = PLY.replace("element vertex", endless);
    assert_eq!(loaded(&[("a.ply", endless.as_bytes()), ("bark.png", &png())]).notices.len(), 1);
    let endless =
        PLY.replace("element vertex", "element something 18446744073709551615\nproperty int a\nelement vertex");
    fails(&[("a.ply", endless.as_bytes())], "element something: says that there are 18446744073709551615");
    for big in [false, true] {
        let cut = binary_ply(big);
        fails(&[("a.ply", &cut[..cut.len() - 1])], "element face: says that there are 2, but the file ends after 1");
        let odd = String::from_utf8_lossy(&cut).replace("property float s", "property string s");
        fails(
            &[("a.ply", odd.as_bytes())],
            "element vertex: property s has a type of unknown size; export the file again as ASCII",
        );
    }
}

#[test]
fn colours_of_any_type() {
    let with = |kind: &str, color: &str| {
        let property = format!("property float z\nproperty {kind} red\nproperty {kind} green\nproperty {kind} blue");
        let text = TRIANGLE.replace("property float z", &property).replace(" 0\n", &format!(" 0 {color}\n"));
        loaded(&[("a.ply", text.as_bytes())]).meshes[0].colors[0]
    };
    for (kind, color) in [
        ("uchar", "255 0 0"),
        ("ushort", "65535 0 0"),
        ("int", "255 0 0"),
        ("float", "1 0 0"),
        ("float", "255 0 0"),
        ("char", "127 -1 0"),
    ] {
        assert_eq!(with(kind, color), [1.0, 0.0, 0.0, 1.0], "{kind} {color}");
    }
}

/// Rows of one word under a header of many properties: their product would take minutes.
#[test]
fn short_rows_are_not_read_to_the_end() {
    let properties = "property float a\n".repeat(20_000);
    let text = TRIANGLE.replace("element face", &format!("{properties}element more 20000\n{properties}element face"));
    let (head, tail) = text.split_at(text.find("3 0 1 2").unwrap());
    let start = std::time::Instant::now();
    let (triangles, notices) = told(&[("a.ply", (head.to_owned() + &"1\n".repeat(20_000) + tail).as_bytes())]);
    assert_eq!((triangles, notices), (1, vec!["3 lines of vertices with fewer values than the header says".into()]));
    assert!(start.elapsed().as_secs() < 5, "{:?}", start.elapsed());
}
