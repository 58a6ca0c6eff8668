//! .mtl files, as programs write them, and the names that tie them to .obj files.

use super::obj::{MTL, OBJ};
use super::{loaded, png};
use zfail_scene::{AlphaMode, Material, Scene, Wrap};

#[test]
fn obj_without_its_other_files() {
    let scene = loaded(&[("a.obj", OBJ.as_bytes())]);
    assert_eq!(scene.materials.len(), 1);
    assert_eq!(scene.notices[1], "material library `sub\\wood.mtl` is not there: its materials are shown grey");
    let scene = loaded(&[("a.obj", OBJ.as_bytes()), ("sub/wood.mtl", MTL.as_bytes())]);
    assert!(scene.notices[1].contains("texture `bark.png` is not there: shown without it"), "{:?}", scene.notices);
    let outside = OBJ.replace("sub\\wood.mtl", "../secret.mtl");
    assert!(loaded(&[("a.obj", outside.as_bytes())]).notices[1].contains("`../secret.mtl` lies outside"));
}

/// A square of two triangles, each of a material of its own.
fn two(first: &[u8], second: &[u8], mtllib: &[u8]) -> Vec<u8> {
    let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n";
    let faces = [b"usemtl ", first, b"\nf 1/1 2/2 3/3\nusemtl ", second, b"\nf 1/1 3/2 4/3\n"].concat();
    [b"mtllib ", mtllib, b"\n", square, &faces].concat()
}

/// The materials of the two triangles.
fn shown<'a>(scene: &'a Scene, obj: &str) -> [&'a Material; 2] {
    let primitives = &scene.meshes[0].primitives;
    let material = |t: u32| {
        let of = primitives.iter().find(|p| p.triangles.contains(&t)).unwrap_or_else(|| panic!("{obj}"));
        &scene.materials[of.material.unwrap()]
    };
    [material(0), material(1)]
}

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const GREY: [f32; 3] = [0.8; 3];

#[track_caller]
fn colours(files: &[(&str, &[u8])]) -> ([[f32; 3]; 2], Vec<String>) {
    let mut scene = loaded(files);
    let colors = shown(&scene, files[0].0).map(|material| [0, 1, 2].map(|c| material.base_color[c]));
    scene.notices.pop();
    (colors, scene.notices)
}

#[test]
fn names_are_bytes() {
    // "red" and "green" in GBK, cp1251, Shift-JIS and UTF-8; the first three are all the same where they are decoded lossily.
    for (red, green) in [
        (b"\xba\xec".as_slice(), b"\xc2\xcc".as_slice()),
        (b"\xea\xf0", b"\xe7\xe5"),
        (b"\x90\xd4", b"\x97\xce"),
        ("\u{7d05}".as_bytes(), "\u{7dd1}".as_bytes()),
        (b"Material #25", b"Material #26"),
        (b"a b", b"a  b"),
    ] {
        let mtl = [b"newmtl ", red, b"\nKd 1 0 0\nnewmtl ", green, b"\nKd 0 1 0\n"].concat();
        let files = [("a.obj", two(red, green, b"a.mtl")), ("a.mtl", mtl)];
        let (colors, notices) = colours(&files.each_ref().map(|(name, bytes)| (*name, bytes.as_slice())));
        assert_eq!((colors, notices.len()), ([RED, GREEN], 0), "{:?}", String::from_utf8_lossy(red));
    }
}

#[test]
fn encodings_and_comments() {
    let mtl = "newmtl red # the first\n\tKd 1 0 0 # red\nnewmtl green\nKd 0 1 0";
    let wide: Vec<u8> = format!("\u{feff}{mtl}").encode_utf16().flat_map(u16::to_be_bytes).collect();
    for mtl in [mtl.as_bytes(), mtl.replace('\n', "\r").as_bytes(), format!("\u{feff}{mtl}").as_bytes(), &wide] {
        for red in [b"red".as_slice(), b"red # again", b" red\t"] {
            let obj = two(red, b"green", b"\"a.MTL\" # here");
            assert_eq!(colours(&[("a.obj", &obj), ("A.mtl", mtl)]), ([RED, GREEN], Vec::new()));
        }
    }
}

#[test]
fn several_libraries() {
    let (red, green) = (b"newmtl red\nKd 1 0 0\n", b"newmtl green\nKd 0 1 0\nnewmtl red\nKd 0 0 0\n");
    for names in ["r.mtl g g.mtl", "none.mtl r.mtl g g.mtl", "r.mtl\nmtllib g g.mtl", "r.mtl \\\n g g.mtl"] {
        let obj = two(b"red", b"green", names.as_bytes());
        let (colors, notices) = colours(&[("a.obj", &obj), ("r.mtl", red), ("g g.mtl", green)]);
        assert_eq!(colors, [RED, GREEN], "{names}: the first that has the name");
        assert_eq!(notices.len(), usize::from(names.contains("none")), "{notices:?}");
    }
    let obj = two(b"red", b"blue", b"r.mtl");
    let (colors, notices) = colours(&[("a.obj", &obj), ("r.mtl", red)]);
    assert_eq!((colors, notices), ([RED, GREY], vec!["1 material that no library has is shown grey (`blue`)".into()]));
}

/// What of `mtl` becomes of the material `m`.
#[track_caller]
fn material(mtl: &str) -> (Material, Vec<String>, Scene) {
    let obj = two(b"m", b"m", b"a.mtl");
    let mut scene = loaded(&[("a.obj", &obj), ("a.mtl", mtl.as_bytes()), ("t.png", &png()), ("t 2.png", &png())]);
    scene.notices.pop();
    (scene.materials[0].clone(), scene.notices.clone(), scene)
}

#[test]
fn one_odd_line_costs_that_line() {
    let (material, notices, _) = material("newmtl m\nKd 1 0 0\nNs high\nPr 0.25\nKe x\n");
    assert_eq!((&material.base_color[..3], material.roughness), (RED.as_slice(), 0.25));
    assert_eq!(notices, ["material library `a.mtl`: 2 lines that cannot be read are ignored (line 3, `Ns high`)"]);
}

#[test]
fn nothing_is_invisible() {
    for (mtl, alpha, statement) in [
        ("Tr 1.000000", 1.0, "`Tr 1`"),
        ("d 0.0", 1.0, "`d 0`"),
        ("d 0\nTr 1", 1.0, "`d 0`"),
        ("d -halo 0", 1.0, "`d 0`"),
        ("Tr 0.25", 0.75, ""),
        ("d 0.5", 0.5, ""),
        ("d 1\nTr 1", 1.0, ""),
        ("Tr 0", 1.0, ""),
        ("", 1.0, ""),
    ] {
        let (material, notices, _) = material(&format!("newmtl m\n{mtl}\n"));
        let blended = if alpha < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque };
        assert_eq!((material.base_color[3], material.alpha), (alpha, blended), "{mtl}");
        assert_eq!(notices.iter().any(|n| n.contains("would make it invisible: shown opaque")), !statement.is_empty());
        assert!(notices.iter().all(|n| n.contains(statement)), "{notices:?}");
    }
}

#[test]
fn textures() {
    let map = |options: &str| {
        let (material, notices, scene) = material(&format!("newmtl m\nKd 0 0 0\nmap_Kd {options}\n"));
        let texture = material.base_color_texture.unwrap_or_else(|| panic!("{options}: {notices:?}"));
        assert!(notices.is_empty(), "{notices:?}");
        (texture.uv_from_mesh, scene.textures[texture.texture], material.base_color)
    };
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for plain in ["t.png", "  t.png # the bark", "C:\\art\\T.PNG", "-blendu off -cc on -texres 64 -bm 2 t 2.png"] {
        assert_eq!(map(plain).0, identity, "{plain}");
        assert_eq!((map(plain).1.wrap_u, map(plain).2), (Wrap::Repeat, [1.0; 4]));
    }
    assert_eq!(map("-s 4 2 1 t.png").0, [[4.0, 0.0, 0.0], [0.0, 2.0, -1.0]]);
    assert_eq!(map("-o 0.5 0.25 -s 2 2 t.png").0, [[2.0, 0.0, 0.5], [0.0, 2.0, -1.25]]);
    assert_eq!((map("-clamp on t.png").1.wrap_u, map("-clamp on t.png").1.wrap_v), (Wrap::Clamp, Wrap::Clamp));
    assert_eq!(map("-mm 0 0.5 t.png").2, [0.5, 0.5, 0.5, 1.0]);
    let (normal, _, _) = material("newmtl m\nnorm -bm 0.5 t.png\n");
    assert_eq!((normal.normal_texture.is_some(), normal.normal_scale), (true, 0.5));
    let (absent, notices, scene) = material("newmtl m\nKd 0 0 0\nmap_Kd q.tga\nmap_Bump t.png\n");
    assert_eq!((&absent.base_color[..3], scene.images.len()), (GREY.as_slice(), 0));
    assert_eq!(notices[0], "material library `a.mtl`: maps left out: map_bump");
    assert_eq!(notices[1], "material \"m\": texture `q.tga` is not there: shown without it");
}

#[test]
fn pictures_keep_their_names() {
    let obj = two(b"m", b"m", b"a.mtl");
    let mtl = b"newmtl m\nmap_Kd s/q.r%.tga\n";
    let scene = loaded(&[("a.obj", &obj), ("a.mtl", mtl), ("s/q.r%.tga", b"no picture")]);
    assert!(scene.notices.iter().any(|notice| notice.contains("\"s/q.r%.tga\"")), "{:?}", scene.notices);
}
