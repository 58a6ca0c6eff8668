//! Small meshes for tests.
#![allow(dead_code, reason = "tests, benches and the tests that stand alone use a part each")]

pub type Soup = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// Axis-aligned box from -1 to 1, outward, indexed.
pub fn cube() -> Soup {
    let positions = (0..8_u32).map(|i| [0, 1, 2].map(|b| if i >> b & 1 == 0 { -1.0 } else { 1.0 })).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    (positions, triangles)
}

/// A torus around y with `n` by `m` quads.
pub fn torus(n: u32, m: u32, minor: f32) -> Soup {
    let angle = |i: u32, n: u32| (i % n) as f32 / n as f32 * std::f32::consts::TAU;
    let mut positions = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let (u, v) = (angle(i, n), angle(j, m));
            let r = 1.0 + minor * v.cos();
            positions.push([r * u.cos(), minor * v.sin(), r * u.sin()]);
        }
    }
    let at = |i: u32, j: u32| (i % n) * m + j % m;
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
            triangles.extend([[a, d, c], [a, c, b]]);
        }
    }
    (positions, triangles)
}

/// The other winding.
pub fn inverted((positions, triangles): Soup) -> Soup {
    (positions, triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect())
}

/// Both, the second moved by `offset`.
pub fn joined((mut positions, mut triangles): Soup, other: Soup, offset: [f32; 3]) -> Soup {
    let base = positions.len() as u32;
    positions.extend(other.0.into_iter().map(|p| std::array::from_fn(|i| p[i] + offset[i])));
    triangles.extend(other.1.into_iter().map(|t| t.map(|v| v + base)));
    (positions, triangles)
}
