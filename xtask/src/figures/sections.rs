//! Two tables of the guide's last chapter, made of the lists beside `compare.md`: from section to module to test, and where the
//! papers are corrected.
//!
//! In: a list, a line for each row, its cells between bars. Out: the chapter, with the table beneath its heading.

/// A list, and where its table stands.
pub struct List {
    /// In `docs/guide/tables`.
    pub file: &'static str,
    /// Of the chapter's section.
    pub heading: &'static str,
    /// Of the table's columns.
    columns: &'static [&'static str],
    /// A row of the table, of the cells of a line.
    row: fn(&[&str]) -> Vec<String>,
}

/// The chapter of the guide that has the tables.
pub const CHAPTER: &str = "11-using-it.md";

/// Section, module, test, figure, reason.
pub const SECTIONS: List = List {
    file: "sections.txt",
    heading: "From section to module to test",
    columns: &["section", "module", "test", "figure"],
    row: |cells| {
        let figure = |name: &str| format!("[`{name}`](figures/{name}.png)");
        let cell = |cell: &str, shown: fn(&str) -> String| if cell == "-" { String::new() } else { shown(cell) };
        let figure = if cells[3] == "-" { cells[4].to_owned() } else { figure(cells[3]) };
        vec![cells[0].to_owned(), cell(cells[1], linked), cell(cells[2], tested), figure]
    },
};

/// Section, what, chapter, test, reason.
pub const CORRECTIONS: List = List {
    file: "corrections.txt",
    heading: "Where the papers are corrected",
    columns: &["paper, section", "what", "chapter", "test"],
    row: |cells| {
        let number = cells[2].split('-').next().unwrap_or_default().trim_start_matches('0');
        // A link within the chapter needs no file.
        let link = cells[2].strip_prefix(CHAPTER).unwrap_or(cells[2]);
        let test = if cells[3] == "-" { cells[4].to_owned() } else { tested(cells[3]) };
        vec![cells[0].to_owned(), cells[1].to_owned(), format!("[{number}]({link})"), test]
    },
};

/// The cells of every line that is neither empty nor a comment, each without space around it.
pub fn rows(list: &str) -> Vec<Vec<&str>> {
    let lines = list.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| line.split('|').map(str::trim).collect()).collect()
}

impl List {
    /// The chapter with this list's table beneath its heading, in place of what stands there up to the next heading.
    ///
    /// # Errors
    /// If the heading is missing, or a line has other than five cells, or has no cell where it gives no reason.
    pub fn put_into(&self, chapter: &str, list: &str) -> Result<String, String> {
        let heading = format!("\n## {}\n", self.heading);
        let (before, rest) = chapter.split_once(&heading).ok_or_else(|| format!("no heading '{}'", self.heading))?;
        let after = rest.find("\n## ").map_or("", |at| &rest[at..]);
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let mut table = line(&self.columns.iter().map(|&name| name.to_owned()).collect::<Vec<_>>());
        table += &format!("|{}\n", "---|".repeat(self.columns.len()));
        for cells in rows(list) {
            let missing = cells.contains(&"-");
            if cells.len() != 5 || missing == cells[4].is_empty() {
                return Err(format!("{}: five cells, and a reason where one is '-': {}", self.file, cells.join(" | ")));
            }
            table += &line(&(self.row)(&cells));
        }
        Ok(format!("{before}{heading}\n{table}{after}"))
    }
}

/// A path from the root as a link from the guide; what names it ends with its folder where it is one of many.
fn linked(path: &str) -> String {
    let parts: Vec<&str> = path.rsplit('/').collect();
    let name = match parts[..] {
        ["lib.rs", _, name, ..] => format!("{name}/src/lib.rs"),
        ["mod.rs" | "tests.rs", folder, ..] => format!("{folder}/{}", parts[0]),
        _ => parts[0].to_owned(),
    };
    format!("[`{name}`](../../{path})")
}

/// A test as a link to its file.
fn tested(test: &str) -> String {
    let (path, function) = test.split_once("::").unwrap_or((test, ""));
    format!("{}: `{function}`", linked(path))
}
