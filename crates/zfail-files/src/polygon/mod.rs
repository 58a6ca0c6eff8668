//! Polygons to triangles.
//!
//! In: corners in order. Out: triangles that have the polygon's edges for their boundary, each edge once, and are wound as
//! the polygon is. No corner is dropped for lying on a straight edge: the neighbour has it too, and a body must stay closed.

mod flat;
mod region;

#[cfg(test)]
mod tests;

use glam::DVec3;

/// Convex polygons become fans, all others constrained Delaunay triangulations of the region that they bound, seen along
/// their vector area; both in O(n log n) for n corners.
///
/// A region with a hole is a polygon that runs along a bridge to the hole and back. A polygon that crosses itself gets
/// triangles that overlap near the crossings, with its edges for their boundary all the same; one that crosses itself
/// all over, or has no region when it is seen from there, becomes a fan.
#[derive(Default)]
pub(crate) struct Triangulator {
    crossing: u64,
    tangled: u64,
}

impl Triangulator {
    /// Adds the triangles of the polygon `corners` to `triangles`.
    pub fn cut(&mut self, corners: &[u32], position: impl Fn(u32) -> [f32; 3], triangles: &mut Vec<[u32; 3]>) {
        if corners.len() > 3 {
            let places: Vec<DVec3> = corners.iter().map(|&v| DVec3::from(position(v).map(f64::from))).collect();
            if let Some(flat) = flat::project(&places).filter(|flat| !flat::is_convex(flat)) {
                if let Some(region) = region::cover(&flat, &places) {
                    self.crossing += u64::from(region.crosses);
                    return triangles.extend(region.triangles.iter().map(|t| t.map(|corner| corners[corner])));
                }
                self.tangled += 1;
            }
        }
        if let [hub, rim @ ..] = corners {
            triangles.extend(rim.windows(2).map(|edge| [*hub, edge[0], edge[1]]));
        }
    }

    /// What was wrong with the polygons so far.
    pub fn notice(&self) -> Option<String> {
        let cross = |count: u64, what: &str| match count {
            0 => None,
            1 => Some(format!("a polygon crosses itself{what}")),
            _ => Some(format!("{count} polygons cross themselves{what}")),
        };
        let crossing = cross(self.crossing, ": their triangles overlap near the crossings");
        let tangled = cross(self.tangled, " all over: their corners are joined to the first, whatever lies between");
        let notices: Vec<String> = crossing.into_iter().chain(tangled).collect();
        (!notices.is_empty()).then(|| notices.join("; "))
    }
}
