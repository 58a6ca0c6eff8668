//! The page of a comparison: one HTML file that needs nothing else, neither a server nor the network.
//!
//! In: the table and the pictures. Out: the page. Every picture is in it once, as a PNG in a data URI in the gallery; the
//! slider borrows them from there. Without scripts the table and the gallery remain.

use super::pictures::{FALSE_SHADOW, LIGHT_LEAKS, Pictures};
use super::record::{MethodRecord, MethodResult, Record};
use crate::error::Error;
use crate::output::encode;
use crate::output::html::escape;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// A picture of the gallery.
struct Figure {
    /// Of the element.
    id: String,
    caption: String,
    /// What it shows, for those who do not see it.
    alt: String,
    /// The PNG.
    uri: String,
}

/// The whole page.
///
/// # Errors
/// If a picture cannot be encoded.
pub fn html(record: &Record, pictures: &Pictures) -> Result<String, Error> {
    let (shown, differences) = figures(record, pictures)?;
    let scene = escape(&record.scene);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Shadows of {scene}, by method</title>\n<style>\n{STYLE}</style>\n\
         <h1>Shadows of {scene}, by method</h1>\n"
    );
    page += &introduction(record);
    page += &slider(&shown, &differences);
    page += &table(record);
    for (heading, figures) in groups(&shown, &differences) {
        let _ = writeln!(page, "<h2>{heading}</h2>\n<div class=\"gallery\">");
        for figure in figures {
            page += &figure.html(pictures.size);
        }
        page += "</div>\n";
    }
    let _ = writeln!(page, "<script>\n{SCRIPT}</script>\n</html>");
    Ok(page)
}

fn introduction(record: &Record) -> String {
    let [width, height] = record.size;
    let lights = match record.lights.len() {
        1 => "one light".to_owned(),
        n => format!("{n} lights"),
    };
    format!(
        "<p>The scene as the camera <em>{}</em> sees it, with {lights}, at {width}&thinsp;&times;&thinsp;{height} pixels. \
         The pictures differ by their shadows alone. The truth is ray-cast in double precision; {} of its verdicts, lit or \
         in shadow, are beyond doubt, and a method is wrong where it contradicts one of them.</p>\n\
         <p class=\"quiet\">Rendered on {} ({}, driver {}). In the pictures of differences \
         <span class=\"key\" style=\"background:{}\"></span> is lit and should be in shadow, \
         <span class=\"key\" style=\"background:{}\"></span> is in shadow and should be lit.</p>\n",
        escape(&record.camera),
        grouped(record.verdicts as u64),
        escape(&record.adapter),
        escape(&record.backend),
        escape(&record.driver),
        color(LIGHT_LEAKS),
        color(FALSE_SHADOW),
    )
}

/// The pictures by what they show.
fn groups<'a>(shown: &'a [Figure], differences: &'a [Figure]) -> impl Iterator<Item = (&'static str, &'a [Figure])> {
    let groups = [("Pictures", shown), ("Where they are wrong", differences)];
    groups.into_iter().filter(|(_, figures)| !figures.is_empty())
}

fn slider(shown: &[Figure], differences: &[Figure]) -> String {
    // What is wrong most is seen first.
    let first_right = differences.first().or(shown.last()).map_or("", |figure| figure.id.as_str());
    let select = |side: &str, label: &str, selected: &str| {
        let mut html = format!("<label>{label}<select id=\"{side}\">");
        for (group, figures) in groups(shown, differences) {
            let _ = write!(html, "<optgroup label=\"{group}\">");
            for Figure { id, caption, .. } in figures {
                let selected = if id == selected { " selected" } else { "" };
                let _ = write!(html, "<option value=\"{id}\"{selected}>{}</option>", escape(caption));
            }
            html += "</optgroup>";
        }
        html + "</select></label>"
    };
    format!(
        "<section id=\"compare\" aria-label=\"Compare two pictures\" hidden>\n<div class=\"choose\">{}{}</div>\n\
         <div class=\"slider\" id=\"slider\"><img id=\"under\" alt=\"\"><img id=\"over\" alt=\"\"><span class=\"bar\"></span>\
         <input id=\"at\" type=\"range\" min=\"0\" max=\"1000\" step=\"5\" value=\"500\" \
         aria-label=\"Divider between the left and the right picture\"></div>\n\
         <p class=\"quiet\">Drag the divider, or move it with the arrow keys.</p>\n</section>\n",
        select("left", "Left", "picture-truth"),
        select("right", "Right", first_right),
    )
}

fn table(record: &Record) -> String {
    let mut html = format!(
        "<h2>What each method does</h2>\n<div class=\"scroll\"><table>\n<caption>Wrong pixels of {} verdicts, and costs, of \
         all lights together. Times are of this machine, for one picture of each light by itself.</caption>\n<thead><tr>",
        grouped(record.verdicts as u64)
    );
    for head in ["Method", "Wrong pixels", "Triangles", "Vertices", "Fragments", "Passes", "Time, ms", "Why"] {
        let _ = write!(html, "<th scope=\"col\">{head}</th>");
    }
    html += "</tr></thead>\n<tbody>\n";
    for row in &record.methods {
        html += &row_of(row);
    }
    html + "</tbody></table></div>\n"
}

fn row_of(row: &MethodRecord) -> String {
    let (name, title, source) = (row.method, escape(row.title), escape(row.source));
    let mut html = format!("<tr id=\"row-{name}\"><th scope=\"row\">");
    match &row.result {
        Some(result) => {
            let kind = if result.wrong_pixels > 0 { "difference" } else { "picture" };
            let _ = write!(html, "<button data-shows=\"{kind}-{name}\">{title}</button>");
        }
        None => html += &title,
    }
    let _ = write!(html, "<small>{source}</small></th>");
    match &row.result {
        Some(result) => html += &numbers(result),
        None => {
            let why = escape(row.unavailable.as_deref().unwrap_or("it has not run"));
            let _ = write!(html, "<td class=\"why\" colspan=\"6\">Not available: {why}</td>");
        }
    }
    let _ = writeln!(html, "<td class=\"why\">{}</td></tr>", escape(row.why));
    html
}

fn numbers(result: &MethodResult) -> String {
    let class = if result.wrong_pixels == 0 { "none" } else { "some" };
    let mut html =
        format!("<td class=\"{class}\" data-label=\"Wrong pixels\">{}</td>", grouped(result.wrong_pixels as u64));
    for (label, value) in [
        ("Triangles", grouped(result.triangles)),
        ("Vertices", grouped(result.vertices)),
        ("Fragments", grouped(result.fragments)),
        ("Passes", grouped(result.passes.into())),
        ("Time, ms", format!("{:.1}", result.milliseconds())),
    ] {
        let _ = write!(html, "<td data-label=\"{label}\">{value}</td>");
    }
    html
}

/// The pictures, the truth first, and of methods that are wrong the pictures of differences, the worst first.
fn figures(record: &Record, pictures: &Pictures) -> Result<(Vec<Figure>, Vec<Figure>), Error> {
    let scene = &record.scene;
    let uri = |rgb: &[u8]| -> Result<String, Error> {
        Ok(format!("data:image/png;base64,{}", STANDARD.encode(encode::png_picture(pictures.size, rgb, None)?)))
    };
    let mut shown = vec![Figure {
        id: "picture-truth".to_owned(),
        caption: "The truth, ray-cast".to_owned(),
        alt: format!("{scene} with its true shadows"),
        uri: uri(&pictures.truth)?,
    }];
    let mut differences = Vec::new();
    for drawn in &pictures.methods {
        let (name, title) = (drawn.method.name(), drawn.method.title());
        let row = record.methods.iter().find(|row| row.method == name);
        let wrong = row.and_then(|row| row.result.as_ref()).map_or(0, |result| result.wrong_pixels);
        shown.push(Figure {
            id: format!("picture-{name}"),
            caption: title.to_owned(),
            alt: format!("{scene} as shadowed by {title}"),
            uri: uri(&drawn.picture)?,
        });
        if wrong == 0 {
            continue;
        }
        let figure = Figure {
            id: format!("difference-{name}"),
            caption: format!("{title}: {} wrong", grouped(wrong as u64)),
            alt: format!("{scene} in grey, with the {wrong} pixels marked that {title} has wrong"),
            uri: uri(&drawn.difference)?,
        };
        differences.push((wrong, figure));
    }
    differences.sort_by_key(|(wrong, _)| std::cmp::Reverse(*wrong));
    Ok((shown, differences.into_iter().map(|(_, figure)| figure).collect()))
}

impl Figure {
    fn html(&self, [width, height]: [u32; 2]) -> String {
        let (alt, caption) = (escape(&self.alt), escape(&self.caption));
        format!(
            "<figure><img id=\"{}\" src=\"{}\" width=\"{width}\" height=\"{height}\" alt=\"{alt}\">\
             <figcaption>{caption}</figcaption></figure>\n",
            self.id, self.uri
        )
    }
}

/// A colour as CSS.
fn color([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A number with narrow spaces between groups of three digits.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(2 * digits.len());
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::pictures::MethodPictures;
    use super::super::record::tests::record;
    use super::*;
    use zfail_methods::Method;

    fn page() -> String {
        let drawn = |method| MethodPictures { method, picture: vec![1; 6], difference: vec![2; 6] };
        let methods = vec![drawn(Method::Mcguire), drawn(Method::HeidmannTwoPass)];
        html(&record(0), &Pictures { size: [2, 1], truth: vec![0; 6], methods }).unwrap()
    }

    #[test]
    fn it_needs_nothing_from_elsewhere() {
        let page = page();
        let sources: Vec<&str> = page.split(" src=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        assert_eq!(sources.len(), 4);
        assert!(sources.iter().all(|source| source.starts_with("data:image/png;base64,")), "{sources:?}");
        for foreign in ["http:", "https:", "url(", "@import", "<link", "href="] {
            assert!(!page.contains(foreign), "{foreign}");
        }
    }

    #[test]
    fn every_method_has_a_row_and_what_is_wrong_most_is_shown_first() {
        let page = page();
        for name in ["heidmann-two-pass", "mcguire", "ray-query"] {
            assert!(page.contains(&format!("<tr id=\"row-{name}\">")), "{name}");
        }
        assert!(page.contains("Not available: no &lt;rays&gt; here"));
        assert!(page.contains("<td class=\"some\" data-label=\"Wrong pixels\">7</td>"));
        assert!(page.contains("a &amp; b.glb") && !page.contains("a & b.glb"));
        assert!(page.contains("<option value=\"difference-heidmann-two-pass\" selected>"));
        assert!(page.contains("id=\"difference-heidmann-two-pass\"") && !page.contains("difference-mcguire"));
        assert!(page.contains("<button data-shows=\"picture-mcguire\">"));
    }

    #[test]
    fn digits_come_in_groups_of_three() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1\u{202f}000", "1\u{202f}234\u{202f}567"]);
    }
}
