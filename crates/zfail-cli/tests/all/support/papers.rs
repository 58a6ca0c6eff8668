//! The papers' sections, and where a text cites them.

/// A paper with numbered sections.
pub struct Paper {
    pub name: &'static str,
    /// Numbers and titles.
    pub sections: &'static [(&'static str, &'static str)],
    pub figures: usize,
    pub images: usize,
    /// What is told in one section, and in which.
    pub topics: &'static [(&'static str, &'static str)],
}

pub const EVERITT_KILGARD: Paper = Paper {
    name: "E&K",
    sections: &[
        ("1", "Introduction"),
        ("2", "Previous Work"),
        ("2.1", "Pre-Stencil Testing Work"),
        ("2.2", "Stencil Testing-Based Work"),
        ("2.2.1", "The Original Approach"),
        ("2.2.2", "Near and Far Plane Clipping and Capping"),
        ("2.2.3", "Zpass vs. Zfail Stenciled Shadow Volumes"),
        ("3", "Our Algorithm"),
        ("3.1", "Requirements"),
        ("3.2", "Approach"),
        ("3.2.1", "Far Plane at Infinity"),
        ("3.2.2", "Infinite Shadow Volume Polygons"),
        ("3.3", "Rendering Procedure"),
        ("3.4", "Optimizations"),
        ("4", "Improved Hardware Support"),
        ("4.1", "Wrapping Stencil Arithmetic"),
        ("4.2", "Depth Clamping"),
        ("4.3", "Two-Sided Stencil Testing"),
        ("5", "Examples"),
        ("6", "Future Work"),
        ("7", "Conclusions"),
        ("8", "Acknowledgements"),
    ],
    figures: 5,
    images: 0,
    topics: &[
        ("depth clamping", "4.2"),
        ("two-sided stencil testing", "4.3"),
        ("seriously undermines the robustness", "2.2.2"),
        ("near plane ledge", "2.2.2"),
        ("may not extend far enough", "2.2.3"),
        ("must be perspective, not orthographic", "3.1"),
        ("step 6", "3.3"),
        ("quite unlikely", "4.1"),
        ("alias with", "4.1"),
    ],
};

pub const MCGUIRE: Paper = Paper {
    name: "McG",
    sections: &[
        ("1", "Introduction"),
        ("2", "Shadow Volumes"),
        ("3", "Related Work"),
        ("4", "Data Structures"),
        ("5", "Hardware Capabilities"),
        ("6", "Shadow Determination Algorithm"),
        ("7", "Analysis"),
        ("8", "A Rendering System"),
    ],
    figures: 4,
    images: 7,
    topics: &[
        ("no uniform adjustment", "3"),
        ("only moved the problem", "3"),
        ("none-the-less incorrect", "3"),
        ("with a single point", "3"),
        ("identically replicated in software", "4"),
        ("every 256th stair", "4"),
        ("parts off screen", "6"),
        ("occlusion pyramid", "6"),
        ("ComputeSilhouetteEdges", "6"),
        ("DrawSides", "6"),
        ("DrawDarkCap", "6"),
        ("DrawLightCap", "6"),
        ("SetDepthBounds", "6"),
        ("Three cases", "7"),
    ],
};

/// What is wrong with the citations of a text. C has no sections.
pub fn faults(text: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for sentence in sentences(text) {
        for paper in [&EVERITT_KILGARD, &MCGUIRE] {
            let cited = citations(&sentence, paper);
            let mut fault = |message: String| faults.push(format!("{} {message}: {sentence}", paper.name));
            for citation in &cited {
                check(paper, citation, &mut fault);
            }
            let sections: Vec<&str> = cited.iter().filter(|c| c.kind == Kind::Section).map(|c| &*c.number).collect();
            let lower = sentence.to_lowercase();
            for (topic, section) in paper.topics.iter().filter(|(topic, _)| lower.contains(&topic.to_lowercase())) {
                // "E&K 3.1 asks, and 4.1 finds": further on in the sentence, a number stands alone.
                let alone = section.contains('.') && sentence.split([' ', ',', ')']).any(|word| word == *section);
                if !sections.is_empty() && !sections.contains(section) && !alone {
                    fault(format!("tells of '{topic}' in section {section}, not in {sections:?}"));
                }
            }
        }
    }
    faults
}

fn check(paper: &Paper, citation: &Citation, fault: &mut impl FnMut(String)) {
    let number = &citation.number;
    let count = match citation.kind {
        Kind::Section => {
            match paper.sections.iter().find(|(n, _)| n == number) {
                None => fault(format!("has no section {number}")),
                Some((_, title)) => {
                    let same = |a: &str, b: &str| a.eq_ignore_ascii_case(b);
                    let other = |quoted: &String| {
                        // A title shortened at its end is a title.
                        let begins = title.to_lowercase().starts_with(&quoted.to_lowercase());
                        !begins && paper.sections.iter().any(|(_, of_other)| same(of_other, quoted))
                    };
                    if citation.title.as_ref().is_some_and(other) {
                        fault(format!("section {number} is '{title}'"));
                    }
                }
            }
            return;
        }
        Kind::Figure => paper.figures,
        Kind::Image => paper.images,
    };
    if number.parse::<usize>().is_ok_and(|n| n == 0 || n > count) {
        fault(format!("has no {:?} {number}", citation.kind));
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Section,
    Figure,
    Image,
}

struct Citation {
    kind: Kind,
    number: String,
    /// What follows the number in quotation marks.
    title: Option<String>,
}

/// Names a paper goes by, as words.
fn names(paper: &Paper) -> &'static [&'static [&'static str]] {
    match paper.name {
        "E&K" => &[&["E&K"], &["Everitt", "&", "Kilgard"]],
        _ => &[&["McG"], &["McGuire", "et", "al."]],
    }
}

fn citations(sentence: &str, paper: &Paper) -> Vec<Citation> {
    let words: Vec<&str> = sentence.split(' ').collect();
    let mut found = Vec::new();
    for start in 0..words.len() {
        let opens = |word: &str| word.trim_start_matches(['(', '[', '*', '"']).to_owned();
        let begins = |name: &&&[&str]| {
            let word = |k: usize| words.get(start + k).map(|w| opens(w));
            name.iter().enumerate().all(|(k, part)| word(k).is_some_and(|w| w.trim_end_matches(',') == *part))
        };
        if let Some(name) = names(paper).iter().find(begins) {
            follow(&words[start + name.len()..], &mut found);
        }
    }
    found
}

/// Reads the numbers after a paper's name.
fn follow(words: &[&str], found: &mut Vec<Citation>) {
    let mut kind = Kind::Section;
    let mut words = words.iter();
    while let Some(&word) = words.next() {
        let bare = word.trim_matches(|c: char| !c.is_alphanumeric());
        let ends = word.ends_with([')', ';', '.', ':', '|', '*']);
        match bare {
            "2002" | "2003" | "and" => {}
            "section" | "sections" => kind = Kind::Section,
            "Figure" | "Figures" => kind = Kind::Figure,
            "Image" | "Images" => kind = Kind::Image,
            _ if word.starts_with('"') => {
                let mut title = word.to_owned();
                let closed =
                    |text: &str| text.len() > 1 && text.trim_end_matches([',', '.', ';', ')', ':']).ends_with('"');
                while !closed(&title) {
                    let Some(next) = words.next() else { return };
                    title = format!("{title} {next}");
                }
                if let Some(last) = found.last_mut() {
                    last.title = Some(title.trim_matches(|c: char| !c.is_alphanumeric()).to_owned());
                }
                if title.ends_with([')', ';', '.', ':']) {
                    return;
                }
                continue;
            }
            _ if is_number(bare) => found.push(Citation { kind, number: bare.to_owned(), title: None }),
            _ => return,
        }
        if ends {
            return;
        }
    }
}

fn is_number(word: &str) -> bool {
    !word.is_empty() && word.split('.').all(|part| (1..=2).contains(&part.len()) && part.parse::<u8>().is_ok())
}

/// The sentences of a document or of a source file's comments; other lines of source are taken one by one.
fn sentences(text: &str) -> Vec<String> {
    let mut blocks = vec![String::new()];
    for line in text.lines() {
        let line = line.trim();
        let comment = ["//!", "///", "//"].iter().find_map(|marker| line.strip_prefix(marker));
        let content = comment.unwrap_or(line).trim();
        let apart = content.is_empty()
            || content.starts_with(['|', '#', '-'])
            || line.ends_with(['{', '}', ',']) && comment.is_none();
        if apart {
            blocks.push(String::new());
        }
        if let Some(last) = blocks.last_mut() {
            last.push(' ');
            last.push_str(content);
        }
    }
    let mut sentences = Vec::new();
    for block in blocks {
        let words: Vec<&str> = block.split_whitespace().collect();
        let mut begin = 0;
        for end in 1..=words.len() {
            let full_stop = words[end - 1].ends_with('.') && words[end - 1] != "al." && words[end - 1] != "vs.";
            let next_begins = words.get(end).is_none_or(|next| next.starts_with(|c: char| c.is_uppercase()));
            if end == words.len() || full_stop && next_begins {
                sentences.push(words[begin..end].join(" "));
                begin = end;
            }
        }
    }
    sentences
}
