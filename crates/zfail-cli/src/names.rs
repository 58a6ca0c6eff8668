//! Choosing among things by name or number, and helping those who mistype.

use crate::error::Error;

/// Below this similarity a suggestion would only confuse.
const SIMILAR: f64 = 0.7;

/// The name in `names` that `wanted` most likely means.
pub fn nearest<'a>(wanted: &str, names: &[&'a str]) -> Option<&'a str> {
    let wanted = wanted.to_lowercase();
    let similarity = |name: &str| strsim::jaro_winkler(&wanted, &name.to_lowercase());
    let best = names.iter().copied().max_by(|a, b| similarity(a).total_cmp(&similarity(b)))?;
    (similarity(best) >= SIMILAR).then_some(best)
}

/// Index of the thing that `wanted` numbers or names; `what` is its kind, for the message.
///
/// A number is an index first, and a name if there is no such index.
///
/// # Errors
/// Lists what there is and suggests the nearest name.
pub fn index_of(what: &str, wanted: &str, names: &[&str]) -> Result<usize, Error> {
    if let Ok(index) = wanted.parse::<usize>()
        && index < names.len()
    {
        return Ok(index);
    }
    names.iter().position(|name| *name == wanted).ok_or_else(|| unknown_index(what, wanted, names))
}

/// The error for a `wanted` that is not among `names`.
pub fn unknown(what: &str, wanted: &str, names: &[&str]) -> Error {
    refuse(what, wanted, names, names.iter().map(|name| (*name).to_owned()))
}

/// The error for a `wanted` that neither numbers nor names one of `names`.
pub fn unknown_index(what: &str, wanted: &str, names: &[&str]) -> Error {
    refuse(what, wanted, names, names.iter().enumerate().map(|(i, name)| format!("{i} '{name}'")))
}

fn refuse(what: &str, wanted: &str, names: &[&str], items: impl Iterator<Item = String>) -> Error {
    /// A city has thousands of lights; nobody reads that many names.
    const LISTED: usize = 24;
    let mut list = items.take(LISTED).collect::<Vec<_>>().join(", ");
    if list.is_empty() {
        "none".clone_into(&mut list);
    } else if names.len() > LISTED {
        list += &format!(" and {} more", names.len() - LISTED);
    }
    let hint = nearest(wanted, names).map(|name| format!(" (did you mean '{name}'?)")).unwrap_or_default();
    Error::usage(format!("unknown {what} '{wanted}'{hint}; there are: {list}"))
}

#[cfg(test)]
mod tests {
    use super::{index_of, nearest};

    #[test]
    fn the_nearest_name_is_suggested_and_a_far_one_is_not() {
        assert_eq!(nearest("Haal", &["stairs", "hall", "cell"]), Some("hall"));
        assert_eq!(nearest("zzzz", &["stairs", "hall", "cell"]), None);
    }

    #[test]
    fn a_number_is_an_index_and_then_a_name() {
        assert_eq!(index_of("camera", "1", &["1", "0"]).unwrap(), 1);
        assert_eq!(index_of("camera", "7", &["a", "7"]).unwrap(), 1);
        assert_eq!(index_of("camera", "b", &["a", "b"]).unwrap(), 1);
    }

    #[test]
    fn an_unknown_name_lists_what_there_is() {
        let message = index_of("camera", "fron", &["front", "top"]).unwrap_err().to_string();
        assert_eq!(message, "unknown camera 'fron' (did you mean 'front'?); there are: 0 'front', 1 'top'");
        let message = super::unknown("command", "rendr", &["render", "info"]).to_string();
        assert_eq!(message, "unknown command 'rendr' (did you mean 'render'?); there are: render, info");
        let message = super::unknown("light", "x", &["l"; 30]).to_string();
        assert!(message.ends_with("l, l and 6 more"), "{message}");
        let message = index_of("camera", "x", &[]).unwrap_err().to_string();
        assert_eq!(message, "unknown camera 'x'; there are: none");
    }
}
