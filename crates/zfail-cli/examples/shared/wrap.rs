//! Paragraphs in lines of the width that documents here have.

/// A Markdown text; tables, headings and code as they are.
pub fn wrapped(text: &str) -> String {
    text.split("\n\n").map(paragraph).collect::<Vec<_>>().join("\n\n")
}

fn paragraph(paragraph: &str) -> String {
    const WIDTH: usize = 120;
    if paragraph.starts_with(['|', '#', ' ', '\n']) {
        return paragraph.to_owned();
    }
    let mut text = String::new();
    let mut length = 0;
    for word in paragraph.split(' ') {
        if length > 0 {
            let breaks = length + 1 + word.chars().count() > WIDTH;
            text.push(if breaks { '\n' } else { ' ' });
            length = if breaks { 0 } else { length + 1 };
        }
        text += word;
        length += word.chars().count();
    }
    text
}
