//! What the last picture cost and what it was made of.

use crate::stage::Stage;
use egui::{Grid, Ui};
use zfail_render::LightFigures;

/// Times and counts.
pub fn figures(ui: &mut Ui, stage: &Stage<'_>, gpu: &wgpu::AdapterInfo) {
    let Some(drawn) = &stage.last else { return };
    let stats = &drawn.stats;
    let [width, height] = drawn.size;
    let time = drawn.time.as_secs_f64() * 1e3;
    ui.strong(format!("{time:.1} ms    {width} x {height}"));
    let passes = [("planning", Some(stats.planning_ms)), ("GPU", stats.gpu_ms), ("shading", stats.shading_ms)];
    ui.horizontal_wrapped(|ui| {
        for (name, time) in passes.iter().filter_map(|(name, time)| time.map(|time| (name, time))) {
            ui.label(format!("{name} {time:.2} ms"));
        }
    });
    let total = |count: fn(&LightFigures) -> u32| stats.lights.iter().map(count).sum::<u32>();
    Grid::new("totals").num_columns(2).spacing([12.0, 2.0]).show(ui, |ui| {
        for (name, count) in [
            ("casters", total(|light| light.casters)),
            ("  case 1: z-pass", total(|light| light.cases[0])),
            ("  case 2: z-fail without light cap", total(|light| light.cases[1])),
            ("  case 3: z-fail with light cap", total(|light| light.cases[2])),
            ("  without a volume", total(|light| light.culled.values().sum())),
            ("triangles: sides", total(|light| light.triangles.sides)),
            ("  dark caps", total(|light| light.triangles.dark_cap)),
            ("  light caps", total(|light| light.triangles.light_cap)),
            ("vertices", total(|light| light.vertices)),
        ] {
            ui.label(name);
            number(ui, Some(count.into()));
        }
        ui.label("fragments");
        number(ui, stats.lights.iter().map(|light| light.fragments).sum());
    });
    if stats.lights.len() > 1 {
        egui::CollapsingHeader::new("By light")
            .id_salt("figures by light")
            .show(ui, |ui| by_light(ui, stage, &stats.lights));
    }
    ui.weak(format!("{} ({})", gpu.name, gpu.backend));
}

/// The end of a row: a number, if it is known.
fn number(ui: &mut Ui, count: Option<u64>) {
    let text = count.map_or("-".to_owned(), grouped);
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.label(text));
    ui.end_row();
}

fn by_light(ui: &mut Ui, stage: &Stage<'_>, lights: &[LightFigures]) {
    Grid::new("figures by light").num_columns(5).striped(true).spacing([10.0, 2.0]).show(ui, |ui| {
        for title in ["light", "cases 1/2/3", "triangles", "fragments", "ms"] {
            ui.weak(title);
        }
        ui.end_row();
        for (i, light) in lights.iter().enumerate() {
            let name = stage.session.scene.lights.get(i).map_or("", |light| &light.name);
            let triangles = light.triangles;
            ui.add(egui::Label::new(name).truncate());
            ui.monospace(light.cases.map(|count| count.to_string()).join("/"));
            ui.monospace(grouped((triangles.sides + triangles.dark_cap + triangles.light_cap).into()));
            ui.monospace(light.fragments.map_or("-".to_owned(), grouped));
            ui.monospace(light.shadow_ms.map_or("-".to_owned(), |ms| format!("{ms:.2}")));
            ui.end_row();
        }
    });
}

/// A number with its thousands apart.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().filter_map(|group| std::str::from_utf8(group).ok()).collect();
    groups.join(" ")
}

#[cfg(test)]
mod tests {
    #[test]
    fn thousands_stand_apart() {
        assert_eq!([0, 999, 1000, 1_234_567].map(super::grouped), ["0", "999", "1 000", "1 234 567"]);
    }
}
