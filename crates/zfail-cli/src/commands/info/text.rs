//! The report as a person reads it: details of what is few, sums of what is many.

use super::mesh::MeshReport;
use super::page::Page;
use super::report::{
    AnimationReport, CameraReport, ExtensionReport, ImageReport, InstanceReport, LightReport, MaterialReport, Report,
};
use std::collections::BTreeMap;
use zfail_files::FileInfo;

/// The whole report.
pub fn text(report: &Report) -> String {
    let mut page = Page::default();
    let instances = count(report.instances.len(), "instance");
    page.line(0, &format!("scene '{}': {} in {instances}", report.scene, count(report.triangles, "triangle")));
    if let Some([min, max]) = report.bounds {
        page.line(0, &format!("from {} to {} m", point(min), point(max)));
    }
    if let Some(info) = &report.file {
        file(&mut page, info);
    }
    if !report.extensions.is_empty() {
        page.list("extensions", "", &report.extensions, |e| usize::from(e.required), |e| vec![extension(e)]);
    }
    page.list("meshes", &all_meshes(&report.meshes), &report.meshes, |mesh| mesh.triangles, mesh);
    let none = if report.lights.is_empty() { " (rendering adds a directional one)" } else { "" };
    page.list("lights", none, &report.lights, |_| 0, |it| vec![light(it)]);
    let none = if report.cameras.is_empty() { " (rendering adds one that frames the scene)" } else { "" };
    page.list("cameras", none, &report.cameras, |_| 0, |it| vec![camera(it)]);
    page.list("animations", "", &report.animations, |_| 0, |it| vec![animation(it)]);
    page.list("materials", &all_materials(&report.materials), &report.materials, |_| 0, |it| vec![material(it)]);
    page.gap();
    page.line(0, &format!("textures: {}, images: {}", report.textures, all_images(&report.images)));
    page.line(0, &all_instances(&report.instances));
    page.gap();
    page.line(0, &format!("notices: {}", report.notices.len()));
    report.notices.iter().for_each(|notice| page.line(2, notice));
    page.finish()
}

fn file(page: &mut Page, info: &FileInfo) {
    let generator = info.generator.as_ref().map(|generator| format!(", generator '{generator}'")).unwrap_or_default();
    page.line(0, &format!("{} {}{generator}", info.format, info.version));
    if !info.skins.is_empty() {
        let joints = info.skins.iter().map(|skin| skin.joints).sum();
        page.line(0, &format!("{} with {}", count(info.skins.len(), "skin"), count(joints, "joint")));
    }
    if !info.morphs.is_empty() {
        let targets = info.morphs.iter().map(|morph| morph.targets).sum();
        page.line(0, &format!("{} with {}", count(info.morphs.len(), "mesh"), count(targets, "morph target")));
    }
}

fn extension(extension: &ExtensionReport) -> String {
    let required = if extension.required { " (required)" } else { "" };
    format!("{}{required}: {}", extension.name, extension.treatment)
}

/// The sums over many meshes.
fn all_meshes(meshes: &[MeshReport]) -> String {
    if meshes.len() < 2 {
        return String::new();
    }
    let sum = |of: fn(&MeshReport) -> usize| meshes.iter().map(of).sum::<usize>();
    let triangles = sum(|mesh| mesh.triangles);
    let closed: f64 = meshes.iter().map(|mesh| mesh.closed_share * mesh.triangles as f64).sum();
    format!(
        ", together {}, {}, {} closed; {} boundary, {} non-manifold and {} inconsistently wound edges",
        count(triangles, "triangle"),
        count(sum(|mesh| mesh.vertices), "vertex"),
        percent(closed / triangles.max(1) as f64),
        sum(|mesh| mesh.boundary_edges),
        sum(|mesh| mesh.non_manifold_edges),
        sum(|mesh| mesh.inconsistent_edges),
    )
}

fn mesh(mesh: &MeshReport) -> Vec<String> {
    let mut lines = vec![format!(
        "'{}': {}, {} ({} after welding), {} closed",
        mesh.name,
        count(mesh.triangles, "triangle"),
        count(mesh.vertices, "vertex"),
        mesh.points,
        percent(mesh.closed_share)
    )];
    if mesh.boundary_edges + mesh.non_manifold_edges + mesh.inconsistent_edges > 0 {
        lines.push(format!(
            "edges: {} boundary, {} non-manifold, {} inconsistently wound",
            mesh.boundary_edges, mesh.non_manifold_edges, mesh.inconsistent_edges
        ));
    }
    let mut rules = BTreeMap::new();
    for part in &mesh.parts {
        let (parts, triangles) = rules.entry((part.casting, part.why)).or_insert((0, 0));
        *parts += 1;
        *triangles += part.triangles as usize;
    }
    for ((casting, why), (parts, triangles)) in rules.into_iter().rev() {
        let (triangles, parts) = (count(triangles, "triangle"), count(parts, "part"));
        lines.push(format!("casts {casting}: {triangles} in {parts} ({why})"));
    }
    let masked = mesh.surfaces.iter().filter(|surface| surface.alpha == "mask" && surface.casts);
    let masked: usize = masked.map(|surface| surface.triangles).sum();
    if masked > 0 {
        lines.push(format!("casts as if it had no holes: {} with an alpha mask", count(masked, "triangle")));
    }
    let through: usize = mesh.surfaces.iter().filter(|surface| !surface.casts).map(|surface| surface.triangles).sum();
    if through > 0 {
        lines.push(format!("casts nothing: {} that let light through", count(through, "triangle")));
    }
    // A triangle that lets light through may be degenerate too; it is not counted twice.
    let degenerate = mesh.not_casting.saturating_sub(through);
    if degenerate > 0 {
        lines.push(format!("casts nothing: {} without area", count(degenerate, "triangle")));
    }
    lines
}

fn light(light: &LightReport) -> String {
    let mut text = format!("'{}': {}", light.name, light.kind);
    if let Some(position) = light.position {
        text += &format!(" at {}", point(position));
    }
    if let Some(direction) = light.direction {
        text += &format!(" towards {}", point(direction));
    }
    if let Some([inner, outer]) = light.cone {
        text += &format!(", cone {inner:.1} to {outer:.1} degrees");
    }
    if let Some(range) = light.range {
        text += &format!(", range {range:.3} m");
    }
    let unit = if light.position.is_some() { "cd" } else { "lx" };
    text += &format!(", {} {unit}, colour {}", light.intensity, point(light.color.map(f64::from)));
    if !light.falloff.is_empty() {
        text += &format!(", falloff by {} samples", light.falloff.len());
    }
    if let Some(texture) = light.cookie {
        text += &format!(", cookie texture {texture}");
    }
    if let Some(half) = light.half_extents {
        text += &format!(", box {} m", point(half.map(|half| 2.0 * half)));
    }
    if light.excluded_instances > 0 {
        text += &format!("; excludes {}", count(light.excluded_instances, "caster"));
    }
    text
}

fn camera(camera: &CameraReport) -> String {
    let extent = match (camera.yfov, camera.ymag) {
        (Some(yfov), _) => format!(", {yfov:.1} degrees high"),
        (None, Some(ymag)) => format!(", {:.3} m high", 2.0 * ymag),
        (None, None) => String::new(),
    };
    let (position, direction) = (point(camera.position), point(camera.direction));
    format!("'{}': {} at {position} towards {direction}{extent}", camera.name, camera.kind)
}

fn animation(animation: &AnimationReport) -> String {
    let mut text = format!("'{}': {:.3} s", animation.name, animation.duration);
    if let Some(channels) = animation.channels {
        let kinds = [
            (channels.nodes, "nodes"),
            (channels.joints, "joints"),
            (channels.weights, "morph weights"),
            (channels.other, "something else"),
        ];
        let moved = kinds.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{} of {what}", count(*n, "channel")));
        text += &moved.map(|moved| format!(", {moved}")).collect::<String>();
    }
    if !animation.moves {
        text += "; nothing that is rendered moves";
    }
    text
}

fn all_materials(materials: &[MaterialReport]) -> String {
    let with = |alpha: &str| materials.iter().filter(|material| material.alpha == alpha).count();
    format!(" ({} opaque, {} mask, {} blend)", with("opaque"), with("mask"), with("blend"))
}

fn material(material: &MaterialReport) -> String {
    let mut text = format!("'{}': {}", material.name, material.alpha);
    if material.double_sided {
        text += ", double-sided";
    }
    if material.unlit {
        text += ", unlit";
    }
    if material.textures > 0 {
        text += &format!(", {}", count(material.textures, "texture"));
    }
    text
}

fn all_images(images: &[ImageReport]) -> String {
    let largest = images.iter().map(|image| image.size).max_by_key(|[w, h]| u64::from(*w) * u64::from(*h));
    largest.map_or_else(|| "0".to_owned(), |[w, h]| format!("{} (up to {w}x{h} pixels)", images.len()))
}

fn all_instances(instances: &[InstanceReport]) -> String {
    let mirrored = instances.iter().filter(|instance| instance.mirrored).count();
    let silent = instances.iter().filter(|instance| !instance.casts_shadow).count();
    let exempt = match instances.iter().filter(|instance| !instance.receives_shadow).count() {
        0 => String::new(),
        exempt => format!(", {exempt} receive none"),
    };
    format!("instances: {} ({mirrored} mirrored, {silent} cast no shadow{exempt})", instances.len())
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
        (_, "vertex") => format!("{n} vertices"),
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
