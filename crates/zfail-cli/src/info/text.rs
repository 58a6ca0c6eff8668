//! The report as a person reads it.

use super::report::{AnimationReport, CameraReport, FileReport, LightReport, MeshReport, Report};
use std::collections::BTreeMap;
use std::fmt::{self, Display, Formatter};

impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let instances = count(self.instances.len(), "instance");
        writeln!(f, "scene '{}': {} in {instances}", self.scene, count(self.triangles, "triangle"))?;
        if let Some([min, max]) = self.bounds {
            writeln!(f, "from {} to {} m", point(min), point(max))?;
        }
        if let Some(file) = &self.file {
            file.fmt(f)?;
        }
        list(f, "meshes", &self.meshes, "")?;
        list(f, "lights", &self.lights, " (rendering adds a directional one)")?;
        list(f, "cameras", &self.cameras, " (rendering adds one that frames the scene)")?;
        list(f, "animations", &self.animations, "")?;

        let with = |alpha: &str| self.materials.iter().filter(|m| m.alpha == alpha).count();
        writeln!(
            f,
            "\nmaterials: {} ({} opaque, {} mask, {} blend), {} textures, {} images",
            self.materials.len(),
            with("opaque"),
            with("mask"),
            with("blend"),
            self.textures,
            self.images
        )?;
        let mirrored = self.instances.iter().filter(|instance| instance.mirrored).count();
        let silent = self.instances.iter().filter(|instance| !instance.casts_shadow).count();
        writeln!(f, "instances: {} ({mirrored} mirrored, {silent} cast no shadow)", self.instances.len())?;

        writeln!(f, "\nnotices: {}", self.notices.len())?;
        self.notices.iter().try_for_each(|notice| writeln!(f, "  {notice}"))
    }
}

impl Display for FileReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "glTF {}", self.version)?;
        if let Some(generator) = &self.generator {
            write!(f, ", generator '{generator}'")?;
        }
        let morphed = count(self.morphed_meshes, "mesh");
        writeln!(f, "; {}, {morphed} with morph targets", count(self.skins, "skin"))?;
        if self.extensions_used.is_empty() {
            return Ok(());
        }
        let required = |name: &&String| self.extensions_required.contains(name);
        let names = self
            .extensions_used
            .iter()
            .map(|name| if required(&name) { format!("{name} (required)") } else { name.clone() });
        writeln!(f, "extensions: {}", names.collect::<Vec<_>>().join(", "))
    }
}

impl Display for MeshReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "'{}': {} triangles, {} vertices ({} distinct points), {} closed; {} boundary, {} non-manifold and {} \
             inconsistently wound edges",
            self.name,
            self.triangles,
            self.vertices,
            self.points,
            percent(self.closed_share),
            self.boundary_edges,
            self.non_manifold_edges,
            self.inconsistent_edges
        )?;
        let mut kinds = BTreeMap::new();
        for part in &self.parts {
            let (parts, triangles) = kinds.entry((part.casting, part.why)).or_insert((0_usize, 0_u64));
            *parts += 1;
            *triangles += u64::from(part.triangles);
        }
        for ((casting, why), (parts, triangles)) in kinds.into_iter().rev() {
            write!(f, "\n       casts {casting}: {triangles} triangles in {} ({why})", count(parts, "part"))?;
        }
        if self.not_casting > 0 {
            write!(f, "\n       casts nothing: {} triangles (degenerate or blended)", self.not_casting)?;
        }
        Ok(())
    }
}

impl Display for LightReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "'{}': {}", self.name, self.kind)?;
        if let Some(position) = self.position {
            write!(f, " at {}", point(position))?;
        }
        if let Some(direction) = self.direction {
            write!(f, " towards {}", point(direction))?;
        }
        if let Some([inner, outer]) = self.cone {
            write!(f, ", cone {inner:.1} to {outer:.1} degrees")?;
        }
        if let Some(range) = self.range {
            write!(f, ", range {range:.3} m")?;
        }
        let unit = if self.position.is_some() { "cd" } else { "lx" };
        write!(f, ", {} {unit}, colour {}", self.intensity, point(self.color.map(f64::from)))?;
        match self.excluded_instances {
            0 => Ok(()),
            n => write!(f, "; excludes {}", count(n, "caster")),
        }
    }
}

impl Display for CameraReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "'{}': {} at {} towards {}", self.name, self.kind, point(self.position), point(self.direction))?;
        match (self.yfov, self.ymag) {
            (Some(yfov), _) => write!(f, ", {yfov:.1} degrees high"),
            (None, Some(ymag)) => write!(f, ", {:.3} m high", 2.0 * ymag),
            (None, None) => Ok(()),
        }
    }
}

impl Display for AnimationReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "'{}': {:.3} s", self.name, self.duration)?;
        if self.moves { Ok(()) } else { write!(f, ", moves no instance, light or camera") }
    }
}

/// A heading with the number of items, or 0 with the words `if_none`, and each item with its index.
fn list(f: &mut Formatter<'_>, heading: &str, items: &[impl Display], if_none: &str) -> fmt::Result {
    let remark = if items.is_empty() { if_none } else { "" };
    writeln!(f, "\n{heading}: {}{remark}", items.len())?;
    items.iter().enumerate().try_for_each(|(i, item)| writeln!(f, "{i:>5}  {item}"))
}

fn point([x, y, z]: [f64; 3]) -> String {
    // Adding zero turns -0 into 0.
    let number = |x: f64| (x * 1e3).round() / 1e3 + 0.0;
    format!("({} {} {})", number(x), number(y), number(z))
}

/// "1 part", "2 parts".
fn count(n: usize, thing: &str) -> String {
    match (n, thing) {
        (1, _) => format!("1 {thing}"),
        (_, "mesh") => format!("{n} meshes"),
        _ => format!("{n} {thing}s"),
    }
}

/// Never 100 % unless all of it, never 0 % unless none.
fn percent(share: f64) -> String {
    match (share * 100.0).round() {
        100.0 if share < 1.0 => ">99 %".to_owned(),
        0.0 if share > 0.0 => "<1 %".to_owned(),
        rounded => format!("{rounded} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::{percent, point};

    #[test]
    fn rounding_never_claims_all_or_none() {
        assert_eq!(percent(1.0), "100 %");
        assert_eq!(percent(0.999), ">99 %");
        assert_eq!(percent(0.001), "<1 %");
        assert_eq!(percent(0.0), "0 %");
        assert_eq!(point([-0.0, 1.5, -2.000_01]), "(0 1.5 -2)");
    }
}
