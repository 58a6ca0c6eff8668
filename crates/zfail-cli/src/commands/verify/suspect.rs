//! A driver's bug told from ours.
//!
//! In: a report that has not passed. Out: an [`Opinion`], from two more experiments: the same pictures on another
//! adapter, and the plainest technique on this one. The same program gives every adapter the same volumes; so what one
//! draws right and the other wrong points to the driver of the latter.

use super::examined::draw;
use super::light::TechniqueReport;
use super::report::{Opinion, Report, Suspect};
use super::variants::{self, Variant};
use crate::input::Shot;
use zfail_oracle::Truth;
use zfail_render::wgpu::DeviceType;
use zfail_render::{Adapter, Gpu, GpuOptions, Renderer};

/// What is known about a mismatch.
#[derive(Clone, Debug, Default)]
struct Evidence {
    /// Edges of volumes that do not cancel.
    open_edges: u64,
    /// This adapter, by name and driver.
    here: String,
    /// Whether even the plainest technique is wrong here; `None` if it could not be drawn.
    plainest_wrong: Option<bool>,
    /// Another adapter, and whether the techniques that are wrong here are wrong there.
    elsewhere: Option<(String, bool)>,
}

/// Makes the experiments.
pub fn find(shot: &Shot, gpu: &Gpu, renderer: &mut Renderer<'_>, truths: &[Truth], report: &Report) -> Opinion {
    let here = describe(&gpu.info.name, &report.backend, &report.driver);
    if report.closure.open_edges > 0 {
        return judge(&Evidence { open_edges: report.closure.open_edges, here, ..Evidence::default() });
    }
    let names: Vec<String> = report.wrong_techniques().iter().map(|&name| name.to_owned()).collect();
    let plainest_wrong = any_wrong(renderer, shot, truths, &[Variant::plainest()]);
    let elsewhere = other_adapter(gpu).and_then(|adapter| {
        let other = Gpu::new(&adapter.options()).ok()?;
        let mut renderer = Renderer::new(&other, &shot.scene).ok()?;
        let wrong = any_wrong(&mut renderer, shot, truths, &variants::chosen(&names))?;
        let info = &other.info;
        Some((describe(&info.name, &info.backend.to_string(), &info.driver_info), wrong))
    });
    judge(&Evidence { open_edges: 0, here, plainest_wrong, elsewhere })
}

/// Whether any of `variants` gives a wrong picture; `None` if one cannot be drawn.
fn any_wrong(renderer: &mut Renderer<'_>, shot: &Shot, truths: &[Truth], variants: &[Variant]) -> Option<bool> {
    let mut wrong = false;
    for variant in variants {
        let images = draw(renderer, shot, variant).ok()?;
        for (truth, (mask, counts)) in truths.iter().zip(images.shadow.iter().zip(&images.stencil)) {
            wrong |= !TechniqueReport::new(variant.name, truth, mask, counts).ok()?.passes();
        }
    }
    Some(wrong)
}

/// An adapter other than `gpu`'s, preferably in software: those are the most exact.
fn other_adapter(gpu: &Gpu) -> Option<Adapter> {
    let (mut software, hardware): (Vec<_>, Vec<_>) = Gpu::adapters(&GpuOptions::default())
        .into_iter()
        .filter(|other| (other.info.backend, &other.info.name) != (gpu.info.backend, &gpu.info.name))
        .partition(|other| other.info.device_type == DeviceType::Cpu);
    software.extend(hardware);
    software.into_iter().next()
}

fn describe(name: &str, backend: &str, driver: &str) -> String {
    format!("{name} ({backend}, driver {driver})")
}

fn judge(evidence: &Evidence) -> Opinion {
    let Evidence { open_edges, here, plainest_wrong, elsewhere } = evidence;
    let (points_to, because) = match (open_edges, elsewhere, plainest_wrong) {
        (1.., _, _) => (
            Suspect::Zfail,
            "a volume is not closed, which is integer arithmetic that no driver takes part in".to_owned(),
        ),
        (0, Some((other, false)), _) => {
            (Suspect::Driver, format!("the same volumes are right on {other} and wrong on {here}"))
        }
        (0, Some((other, true)), _) => (Suspect::Zfail, format!("it is wrong on {other} as well as on {here}")),
        (0, None, Some(false)) => (
            Suspect::Unknown,
            format!(
                "everitt-kilgard is right on {here}, so it is a step that the wrong techniques add, in zfail or in the \
                 driver's shaders; there is no second adapter to ask"
            ),
        ),
        (0, None, Some(true)) => (
            Suspect::Unknown,
            format!(
                "even everitt-kilgard, which needs nothing but stencil operations, is wrong on {here}; there is no second \
                 adapter to ask"
            ),
        ),
        (0, None, None) => (Suspect::Unknown, format!("{here} does not draw it again, and there is no second adapter")),
    };
    Opinion { points_to, because }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::verify::closure::Closed;
    use crate::commands::verify::light::LightReport;
    use crate::commands::verify::proof::Proof;

    #[test]
    fn what_another_adapter_draws_decides() {
        let known = Evidence { here: "A".to_owned(), plainest_wrong: Some(true), ..Evidence::default() };
        let opinion = |evidence: &Evidence| {
            let Opinion { points_to, because } = judge(evidence);
            assert!(because.contains('A') || points_to == Suspect::Zfail, "{because}");
            points_to
        };
        let elsewhere = |wrong| Evidence { elsewhere: Some(("B".to_owned(), wrong)), ..known.clone() };
        assert_eq!(opinion(&elsewhere(false)), Suspect::Driver);
        assert_eq!(opinion(&elsewhere(true)), Suspect::Zfail);
        assert_eq!(opinion(&known), Suspect::Unknown);
        assert_eq!(opinion(&Evidence { open_edges: 3, ..elsewhere(false) }), Suspect::Zfail);
        let says = |plainest_wrong| judge(&Evidence { plainest_wrong, ..known.clone() }).because;
        assert!(says(Some(false)).contains("a step that the wrong techniques add"));
        assert!(says(Some(true)).contains("even everitt-kilgard"));
        assert!(says(None).contains("does not draw it again"));
    }

    /// Both experiments on this machine, with a truth that every adapter misses and with one that none does.
    #[test]
    fn the_experiments_are_made_on_real_adapters() {
        let Some(gpu) = zfail_testing::gpu(Gpu::new(&GpuOptions::default())) else { return };
        let scene = zfail_builtin::scene("jail").unwrap();
        let view = scene.cameras[0].view([48, 27], &scene.bounds());
        let shot = Shot { scene, camera: String::new(), view, lights: vec![0] };
        let topologies = shot.scene.topologies().unwrap();
        let right = crate::commands::verify::examined::truth(
            &zfail_oracle::Oracle::new(&shot.scene),
            &shot,
            &shot.view,
            &topologies,
            0,
        );
        let mut inverted = right.clone();
        inverted.pixels.iter_mut().for_each(|pixel| pixel.lit = !pixel.lit);

        let mut renderer = Renderer::new(&gpu, &shot.scene).unwrap();
        let variants = variants::chosen(&["auto".to_owned()]);
        let images = [draw(&mut renderer, &shot, &variants[0]).unwrap()];
        let light = |truth| LightReport::new(&shot.scene, 0, truth, &variants, &images, 0).unwrap();
        let (proof, lights) = (Proof::new(&shot.scene, &[0]), vec![light(&inverted)]);
        let report = Report::new(String::new(), [48, 27], &gpu, Closed::default(), lights, Vec::new(), proof);
        assert_eq!((report.passed, report.wrong_techniques()), (false, vec!["auto"]));

        let mut points_to = |truth: Truth| find(&shot, &gpu, &mut renderer, &[truth], &report).points_to;
        let expected = match other_adapter(&gpu) {
            Some(_) => [Suspect::Zfail, Suspect::Driver],
            None => [Suspect::Unknown, Suspect::Unknown],
        };
        assert_eq!([points_to(inverted), points_to(right)], expected);
    }
}
