//! Text for a terminal of 80 columns.
//!
//! In: items of any length and number. Out: wrapped lines, and of long lists those items that matter most.

/// Columns.
const WIDTH: usize = 80;
/// Longer lists are cut short.
const LISTED: usize = 12;

/// Text in the making.
#[derive(Default)]
pub struct Page(String);

impl Page {
    /// The text.
    pub fn finish(self) -> String {
        self.0
    }

    /// An empty line.
    pub fn gap(&mut self) {
        self.0.push('\n');
    }

    /// Adds `text` after `indent` columns. Where it is wrapped, it goes on two columns further right.
    pub fn line(&mut self, indent: usize, text: &str) {
        let mut column = 0;
        for word in text.split_whitespace() {
            let length = word.chars().count();
            if column == 0 {
                self.0 += &" ".repeat(indent);
                column = indent;
            } else if column + 1 + length > WIDTH {
                self.0.push('\n');
                self.0 += &" ".repeat(indent + 2);
                column = indent + 2;
            } else {
                self.0.push(' ');
                column += 1;
            }
            self.0 += word;
            column += length;
        }
        self.0.push('\n');
    }

    /// A heading with the number of items and a remark, then the items with their index: those that `weight` most, in
    /// order, and of equal ones the first. Each is a line and more lines that belong to it.
    pub fn list<T>(
        &mut self,
        heading: &str,
        remark: &str,
        items: &[T],
        weight: impl Fn(&T) -> usize,
        lines: impl Fn(&T) -> Vec<String>,
    ) {
        self.gap();
        self.line(0, &format!("{heading}: {}{remark}", items.len()));
        let mut listed: Vec<usize> = (0..items.len()).collect();
        listed.sort_by_key(|&i| std::cmp::Reverse(weight(&items[i])));
        listed.truncate(LISTED);
        listed.sort_unstable();
        for &i in &listed {
            let mut lines = lines(&items[i]).into_iter();
            self.line(2, &format!("{i} {}", lines.next().unwrap_or_default()));
            lines.for_each(|line| self.line(6, &line));
        }
        if items.len() > listed.len() {
            self.line(2, &format!("and {} more; --json has them all", items.len() - listed.len()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LISTED, Page, WIDTH};

    #[test]
    fn lines_stay_within_the_terminal() {
        let mut page = Page::default();
        page.line(4, &"word ".repeat(50));
        let text = page.finish();
        assert!(
            text.lines()
                .all(|line| line.chars().count() <= WIDTH && line.starts_with("    w") || line.starts_with("      w"))
        );
        assert_eq!(text.split_whitespace().count(), 50);
        assert!(text.lines().count() > 3);
    }

    #[test]
    fn of_a_long_list_the_greatest_items_are_shown() {
        let mut page = Page::default();
        let items: Vec<usize> = (0..40).collect();
        page.list("things", " (all)", &items, |item| *item, |item| vec![format!("thing {item}"), "more".to_owned()]);
        let text = page.finish();
        assert!(text.starts_with("\nthings: 40 (all)\n  28 thing 28\n      more\n  29 thing 29\n"), "{text}");
        assert!(
            text.ends_with(&format!("  39 thing 39\n      more\n  and {} more; --json has them all\n", 40 - LISTED)),
            "{text}"
        );
    }
}
