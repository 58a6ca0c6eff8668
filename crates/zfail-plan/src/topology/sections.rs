//! Sections of a mesh: parts that lie together, which planning can decide on by themselves.
//!
//! In: a welded mesh. Out: its casting triangles in sections that share no vertex, and each section's topology. Everitt &
//! Kilgard 2002, section 3.4, render the caps of those "subsets" of occluders that need them; a whole city may be one mesh, of
//! which a single house stands between the light and the eye.
//!
//! Sections hold whole components of triangles connected through vertices, for a volume's sides and caps share vertices, not
//! only edges. Components are put together by place, halving along the longest axis, so that boxes around sections are small.

use super::{ConeTree, ConvexPart, Edge, Fan, NONE, Part, REVERSED, Topology, convex};
use crate::bounds::Bounds;
use glam::DVec3;
use std::ops::Range;

/// How many sections a mesh of many parts is divided into, about.
const SECTIONS: usize = 96;
/// Triangles below which a section is not worth deciding about.
const SMALL: usize = 128;

/// Some parts of a mesh that lie together.
#[derive(Clone, Debug)]
pub struct Section {
    /// Of these parts alone; without sections of its own.
    pub topology: Topology,
    /// The mesh's vertex that is vertex 0 here; those of a section follow one another.
    pub first_vertex: u32,
}

/// The triangles of a component, and where it is.
struct Component {
    triangles: Vec<u32>,
    center: DVec3,
}

/// Numbers the vertices of a mesh anew, section by section, in the order of their first use, with those that nothing casting uses at
/// the end. Returns the vertices of each section; none where the mesh is one.
pub(super) fn number(
    positions: &mut Vec<[f32; 3]>,
    triangles: &mut [[u32; 3]],
    casts: impl Fn(usize, [u32; 3]) -> bool,
) -> Vec<Range<u32>> {
    let casting: Vec<u32> = (0..triangles.len() as u32).filter(|&t| casts(t as usize, triangles[t as usize])).collect();
    if casting.len() <= SMALL {
        return Vec::new();
    }
    let mut components = components(positions, triangles, &casting);
    if components.len() < 2 {
        return Vec::new();
    }
    let most = (casting.len() / SECTIONS).max(SMALL);
    let mut groups = Vec::new();
    halve(&mut components, most, &mut groups);
    if groups.len() < 2 {
        return Vec::new();
    }
    let mut numbers = vec![NONE; positions.len()];
    let mut next = 0;
    let mut number = |t: u32| {
        for v in triangles[t as usize] {
            if numbers[v as usize] == NONE {
                numbers[v as usize] = next;
                next += 1;
            }
        }
        next
    };
    let mut ranges = Vec::with_capacity(groups.len());
    let mut start = 0;
    for mut group in groups {
        group.sort_unstable();
        let end = group.into_iter().map(&mut number).last().unwrap_or(start);
        ranges.push(start..end);
        start = end;
    }
    (0..triangles.len() as u32).for_each(|t| {
        number(t);
    });
    let mut placed = vec![[0.0; 3]; positions.len()];
    for (position, &number) in positions.iter().zip(&numbers) {
        placed[number as usize] = *position;
    }
    *positions = placed;
    triangles.iter_mut().for_each(|triangle| *triangle = triangle.map(|v| numbers[v as usize]));
    ranges
}

/// Casting triangles by the component that they belong to.
fn components(positions: &[[f32; 3]], triangles: &[[u32; 3]], casting: &[u32]) -> Vec<Component> {
    let mut roots: Vec<u32> = (0..positions.len() as u32).collect();
    for &t in casting {
        let [a, b, c] = triangles[t as usize];
        for other in [b, c] {
            let (a, b) = (root_of(&mut roots, a), root_of(&mut roots, other));
            roots[a.max(b) as usize] = a.min(b);
        }
    }
    let mut component_of = vec![NONE; positions.len()];
    let mut components: Vec<(Vec<u32>, Bounds)> = Vec::new();
    for &t in casting {
        let corners = triangles[t as usize];
        let slot = &mut component_of[root_of(&mut roots, corners[0]) as usize];
        if *slot == NONE {
            *slot = components.len() as u32;
            components.push((Vec::new(), Bounds::EMPTY));
        }
        let (members, bounds) = &mut components[*slot as usize];
        members.push(t);
        corners.iter().for_each(|&v| bounds.add(DVec3::from(positions[v as usize].map(f64::from))));
    }
    components.into_iter().map(|(triangles, bounds)| Component { triangles, center: bounds.center() }).collect()
}

/// Puts components together by place until no group of several has more than `most` triangles.
fn halve(components: &mut [Component], most: usize, groups: &mut Vec<Vec<u32>>) {
    let triangles: usize = components.iter().map(|component| component.triangles.len()).sum();
    if components.len() == 1 || triangles <= most {
        groups.push(components.iter().flat_map(|component| component.triangles.iter().copied()).collect());
        return;
    }
    let half = Bounds::of(components.iter().map(|component| component.center)).half();
    let axis = (0..3).fold(0, |longest, axis| if half[axis] > half[longest] { axis } else { longest });
    let first = |component: &Component| component.triangles[0];
    components.sort_unstable_by(|a, b| a.center[axis].total_cmp(&b.center[axis]).then(first(a).cmp(&first(b))));
    let mut before = 0;
    let middle = components.iter().position(|component| {
        before += component.triangles.len();
        2 * before >= triangles
    });
    let (lower, upper) = components.split_at_mut((middle.unwrap_or(0) + 1).min(components.len() - 1));
    halve(lower, most, groups);
    halve(upper, most, groups);
}

/// Union-find with path halving.
fn root_of(roots: &mut [u32], mut v: u32) -> u32 {
    while roots[v as usize] != v {
        roots[v as usize] = roots[roots[v as usize] as usize];
        v = roots[v as usize];
    }
    v
}

/// Cuts a mesh whose vertices were numbered section by section into the topologies of those.
pub(super) fn cut(whole: &Topology, vertices: &[Range<u32>]) -> Vec<Section> {
    if vertices.is_empty() {
        return Vec::new();
    }
    let mut sections: Vec<Section> = vertices
        .iter()
        .map(|range| {
            let positions = whole.positions[range.start as usize..range.end as usize].to_vec();
            Section { topology: Topology::of_nothing(positions), first_vertex: range.start }
        })
        .collect();
    let section_of = |v: u32| vertices.partition_point(|range| range.end <= v);
    // By the mesh's triangles: their number in their section.
    let mut local = vec![NONE; whole.triangles.len()];
    for (t, &corners) in whole.triangles.iter().enumerate().filter(|&(t, _)| whole.part_of[t] != NONE) {
        let Section { topology, first_vertex } = &mut sections[section_of(corners[0])];
        local[t] = topology.triangles.len() as u32;
        topology.triangles.push(corners.map(|v| v - *first_vertex));
    }
    let moved = |reference: u32| match reference {
        NONE => NONE,
        _ => local[(reference & !REVERSED) as usize] | reference & REVERSED,
    };
    for edge in &whole.edges {
        let Section { topology, first_vertex } = &mut sections[section_of(edge.vertices[0])];
        let vertices = edge.vertices.map(|v| v - *first_vertex);
        topology.edges.push(Edge { vertices, triangles: edge.triangles.map(moved) });
    }
    for fan in &whole.fans {
        let Section { topology, first_vertex } = &mut sections[section_of(fan.vertices[0])];
        let start = topology.fan_triangles.len() as u32;
        topology.fan_triangles.extend(whole.at(fan).iter().map(|&t| moved(t)));
        let end = topology.fan_triangles.len() as u32;
        topology.fans.push(Fan { vertices: fan.vertices.map(|v| v - *first_vertex), start, end });
    }
    for (p, part) in whole.parts.iter().enumerate() {
        let triangles = whole.triangles_of(p);
        let corner = whole.triangles[triangles[0] as usize][0];
        let topology = &mut sections[section_of(corner)].topology;
        let start = topology.by_part.len() as u32;
        topology.by_part.extend(triangles.iter().map(|&t| local[t as usize]));
        topology.parts.push(Part { triangles: start..topology.by_part.len() as u32, ..part.clone() });
    }
    for group in &whole.twins {
        let corner = whole.triangles[group[0] as usize][0];
        let topology = &mut sections[section_of(corner)].topology;
        topology.twins.push(group.iter().map(|&t| local[t as usize]).collect());
    }
    for Section { topology, .. } in &mut sections {
        topology.part_of = vec![NONE; topology.triangles.len()];
        for (p, part) in topology.parts.iter().enumerate() {
            let triangles = &topology.by_part[part.triangles.start as usize..part.triangles.end as usize];
            triangles.iter().for_each(|&t| topology.part_of[t as usize] = p as u32);
        }
        let convex: Option<ConvexPart> = convex::largest(topology);
        topology.convex = convex;
        topology.bounds = Bounds::of(topology.parts.iter().flat_map(|part| [part.bounds.min, part.bounds.max]));
        topology.cones = ConeTree::new(topology);
    }
    sections
}

#[cfg(test)]
mod tests;
