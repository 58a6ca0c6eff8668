//! Text that is nearly JSON.
//!
//! In: text that a JSON parser refuses. Out: the same with the faults mended that exporters leave in places that nobody
//! looks at: names in another encoding, control characters and stray backslashes in strings, numbers as C prints them
//! (`nan`, `1.#INF`, `.5`), commas before a closing bracket.

/// What was mended.
#[derive(Default)]
struct Counts {
    strings: usize,
    values: usize,
    commas: usize,
}

/// The mended text, and what was done to it.
pub(super) fn mend(text: &[u8]) -> (String, String) {
    let source = String::from_utf8_lossy(text);
    let mut counts = Counts { strings: usize::from(matches!(source, std::borrow::Cow::Owned(_))), ..Counts::default() };
    let mut mended = String::with_capacity(source.len());
    let mut rest = &*source;
    while let Some(first) = rest.chars().next() {
        rest = match first {
            '"' => string(rest, &mut mended, &mut counts),
            '{' | '}' | '[' | ']' | ',' | ':' => {
                if matches!(first, '}' | ']') && mended.trim_end().ends_with(',') {
                    mended.truncate(mended.trim_end().len() - 1);
                    counts.commas += 1;
                }
                mended.push(first);
                &rest[1..]
            }
            c if c.is_ascii_whitespace() => {
                mended.push(c);
                &rest[1..]
            }
            _ => {
                let end = rest.find(|c: char| c.is_ascii_whitespace() || "{}[],:\"".contains(c)).unwrap_or(rest.len());
                value(&rest[..end], &mut mended, &mut counts);
                &rest[end..]
            }
        };
    }
    let Counts { strings, values, commas } = counts;
    let what = [(strings, "characters in strings"), (values, "values"), (commas, "commas")];
    let what = what.iter().filter(|(count, _)| *count > 0).map(|(_, what)| *what).collect::<Vec<_>>();
    (mended, what.join(", "))
}

/// Copies the string at the begin of `rest`; returns what follows it.
fn string<'a>(rest: &'a str, mended: &mut String, counts: &mut Counts) -> &'a str {
    mended.push('"');
    let mut chars = rest[1..].chars();
    while let Some(c) = chars.next() {
        match c {
            '"' => {
                mended.push('"');
                break;
            }
            '\\' => counts.strings += usize::from(!escape(&mut chars, mended)),
            c if c < ' ' => {
                counts.strings += 1;
                mended.push(' ');
            }
            c => mended.push(c),
        }
    }
    chars.as_str()
}

/// Copies what follows a backslash; returns whether it was sound.
fn escape(chars: &mut std::str::Chars<'_>, mended: &mut String) -> bool {
    let text = chars.as_str();
    let unit = |text: &str| u16::from_str_radix(text.strip_prefix('u')?.get(..4)?, 16).ok();
    let pair = |high: u16| {
        let low = text.get(5..)?.strip_prefix('\\').and_then(unit)?;
        let pair = char::decode_utf16([high, low]).next()?.ok()?;
        (u32::from(pair) > 0xffff).then_some(11)
    };
    let (length, sound) = match (text.chars().next(), unit(text)) {
        (Some('"' | '\\' | '/' | 'b' | 'f' | 'n' | 'r' | 't'), _) => (1, true),
        (Some('u'), Some(first)) if char::from_u32(first.into()).is_some() => (5, true),
        (Some('u'), Some(first)) => match pair(first) {
            Some(length) => (length, true),
            None => (5, false),
        },
        _ => (0, false),
    };
    match (sound, length) {
        (true, _) => {
            mended.push('\\');
            mended.push_str(&text[..length]);
        }
        // Half a character.
        (false, 5) => mended.push(char::REPLACEMENT_CHARACTER),
        _ => mended.push_str("\\\\"),
    }
    *chars = text[length..].chars();
    sound
}

/// Copies a number or a literal.
fn value(token: &str, mended: &mut String, counts: &mut Counts) {
    if matches!(token, "true" | "false" | "null") || serde_json::from_str::<f64>(token).is_ok() {
        mended.push_str(token);
        return;
    }
    counts.values += 1;
    let number = token.bytes().any(|byte| byte.is_ascii_digit()).then(|| token.parse::<f64>().ok()).flatten();
    match number {
        Some(number) => mended.push_str(&number.clamp(f64::MIN, f64::MAX).to_string()),
        None => mended.push_str("null"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn mended(text: &[u8]) -> Value {
        serde_json::from_str(&mend(text).0).unwrap_or(Value::Null)
    }

    #[test]
    fn sound_text_stays() {
        let text = r#" {"a\"\\\u00e9\ud83d\ude00": [1, -2.5e3, true, null, {}], "b": "x, ]"} "#;
        assert_eq!(mend(text.as_bytes()), (text.to_owned(), String::new()));
    }

    #[test]
    fn faults_are_mended() {
        assert_eq!(mended(b"[\"caf\xe9\", \"a\nb\"]"), json!(["caf\u{fffd}", "a b"]));
        assert_eq!(mended(br#"["C:\Users\dot", "\ud83d.", "\u12"]"#), json!([r"C:\Users\dot", "\u{fffd}.", r"\u12"]));
        assert_eq!(mended(b"[nan, -1.#IND, Infinity, 1e999]"), json!([null, null, null, f64::MAX]));
        assert_eq!(mended(b"[.5, 2., +3, 007]"), json!([0.5, 2, 3, 7]));
        assert_eq!(mended(b"{\"a\": [1, 2 , ],}"), json!({"a": [1, 2]}));
        assert_eq!(mend(b"[nan,\"\t\",]").1, "characters in strings, values, commas");
    }

    #[test]
    fn other_faults_remain() {
        for text in ["[1 2]", "{\"a\"}", "[", "\"", "\"\\", "\"\\ud83d", "[1}"] {
            assert_eq!(mended(text.as_bytes()), Value::Null, "{text}");
        }
    }
}
