//! .stl files, as programs write them. How words and bytes are taken apart is tested beside the reader.

use super::{fails, loaded, told, world_triangles};
use zfail_plan::glam::DVec3;

pub const STL: &str = "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 2\nendloop\nendfacet\n\
                   endsolid a\n";

#[test]
fn stl_stands_upright() {
    let scene = loaded(&[("part.Stl", STL.as_bytes())]);
    assert_eq!(scene.notices, ["STL has neither axes nor units: z is taken as up, and one unit as one metre"]);
    assert_eq!(world_triangles(&scene), [[DVec3::ZERO, DVec3::X, DVec3::new(0.0, 2.0, -1.0)]]);
    assert!(scene.materials[0].double_sided);
    fails(&[("a.stl", b"solid")], "the file: has no triangles");
    fails(
        &[("a.stl", STL.replace("vertex 1", "vertex inf").as_bytes())],
        "has no triangles but those with a vertex that is",
    );
}

#[test]
fn what_cannot_be_drawn_is_left_out() {
    let with = |facet: &str, triangles: usize, expected: &str| {
        let text = format!("{STL}facet normal 0 0 0\nouter loop\n{facet}\nendloop\nendfacet\n{STL}");
        let (drawn, notices) = told(&[("a.stl", text.as_bytes())]);
        assert_eq!((drawn, notices.as_slice()), (triangles, [expected.to_owned()].as_slice()), "{facet}");
    };
    with("vertex 0 0 0\nvertex 1 0 0", 2, "1 face of fewer than three corners is left out (line 14)");
    let polygons = "1 facet of more than three corners: taken as polygons";
    with("vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0", 4, polygons);
    let nowhere = "1 triangle with a vertex that is not finite, or beyond 5e14, is left out";
    with("vertex 0 0 0\nvertex 1 nan 0\nvertex 1 1 0", 2, &format!("{nowhere} (facet 1)"));
    with("vertex 0 0 0\nvertex 1 x 0\nvertex 1 1 0", 2, &format!("{nowhere} (facet 1)"));
}

/// The title, and the number of triangles that a binary file says that it has, before the corners.
fn binary(title: &[u8], said: u32, corners: &[[f32; 3]]) -> Vec<u8> {
    let mut bytes = title.to_vec();
    bytes.resize(80, 0);
    bytes.extend(said.to_le_bytes());
    for triangle in corners.chunks(3) {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn binary_files() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 2.0]];
    let text = world_triangles(&loaded(&[("a.stl", STL.as_bytes())]));
    for title in [b"".as_slice(), b"solid binary"] {
        assert_eq!(world_triangles(&loaded(&[("a.stl", &binary(title, 1, &corners))])), text);
        let padded = [binary(title, 1, &corners), vec![7; 3]].concat();
        assert_eq!(told(&[("a.stl", &padded)]), (1, Vec::new()));
        let miscounted = "says that it has 9 triangles, but has 1: all are shown".to_owned();
        assert_eq!(told(&[("a.stl", &binary(title, 9, &corners))]), (1, vec![miscounted]));
        let cut = binary(title, 2, &[corners, corners].concat());
        fails(
            &[("a.stl", &cut[..150])],
            "says that it has 2 triangles, but ends after 1; its end is missing: copy or download",
        );
    }
    let broken = [corners, [[0.0; 3], [f32::NAN, 0.0, 0.0], [1.0; 3]]].concat();
    let nowhere = "1 triangle with a vertex that is not finite, or beyond 5e14, is left out (facet 1)".to_owned();
    assert_eq!(told(&[("a.stl", &binary(b"", 2, &broken))]), (1, vec![nowhere]));
    fails(&[("a.stl", b"")], "neither ASCII");
    fails(&[("a.stl", &STL.as_bytes()[..STL.find("vertex 0 1").unwrap()])], "ends within a facet; its end is missing");
}

#[test]
fn surveyed_solids_keep_their_shape() {
    let at = |x: &str, y: &str| {
        let text = STL
            .replace("vertex 0 0 0", &format!("vertex {x}.1 {y}.1 0"))
            .replace("vertex 1 0", &format!("vertex {x}.2 {y}.1"));
        let text = text.replace("vertex 0 1 2", &format!("vertex {x}.1 {y}.2 0"));
        world_triangles(&loaded(&[("a.stl", text.as_bytes())]))[0]
    };
    let (near, far) = (at("0", "0"), at("442307", "5411031"));
    let shift = DVec3::new(442_307.0, 0.0, -5_411_031.0);
    for (near, far) in near.iter().zip(far) {
        assert!((far - *near - shift).length() < 1e-6, "{near} {far}");
    }
}
