//! The page of `zfail compare` in a real browser: Debian's chromium, driven by playwright-core.
//!
//! `ZFAIL_SCREENSHOTS=DIR` keeps pictures of the page, light and dark, wide and narrow.

use crate::support::{has_gpu, zfail};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs};

/// What the script needs, beside it.
const FILES: [(&str, &str); 3] = [
    ("package.json", include_str!("browser/package.json")),
    ("package-lock.json", include_str!("browser/package-lock.json")),
    ("page.mjs", include_str!("browser/page.mjs")),
];

/// The script in a folder of its own, with playwright-core installed, and the browser to use.
struct Driver {
    script: PathBuf,
    browser: &'static str,
}

impl Driver {
    /// Says what is missing.
    fn new() -> Result<Self, String> {
        let runs = |program: &&str| {
            let probe = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
            probe.is_ok_and(|status| status.success())
        };
        let browsers = ["chromium", "chromium-browser", "google-chrome"];
        let browser = browsers.into_iter().find_map(|name| in_path(name).filter(|_| runs(&name)).map(|_| name));
        let browser = browser.ok_or("chromium is not installed")?;
        if let Some(missing) = ["node", "npm"].iter().find(|program| !runs(program)) {
            return Err(format!("{missing} is not installed"));
        }
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("browser");
        fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
        // Installed for another lock, it is installed anew.
        let lock = fs::read_to_string(folder.join("package-lock.json")).unwrap_or_default();
        let installed = lock == FILES[1].1 && folder.join("node_modules/playwright-core/package.json").exists();
        for (name, text) in FILES {
            fs::write(folder.join(name), text).map_err(|e| e.to_string())?;
        }
        if !installed {
            let output = Command::new("npm")
                .args(["ci", "--ignore-scripts", "--no-audit", "--no-fund"])
                .current_dir(&folder)
                .output()
                .map_err(|e| e.to_string())?;
            if !output.status.success() {
                let _ = fs::remove_file(folder.join("package-lock.json"));
                return Err(format!("npm cannot install playwright-core: {}", String::from_utf8_lossy(&output.stderr)));
            }
        }
        Ok(Self { script: folder.join("page.mjs"), browser })
    }

    /// What is wrong with each page.
    fn examine(&self, record: &Path, pages: &[&Path]) -> Vec<Vec<String>> {
        let mut command = Command::new("node");
        command.arg(&self.script).arg(in_path(self.browser).expect("it was there")).arg(record).args(pages);
        if let Some(folder) = env::var_os("ZFAIL_SCREENSHOTS") {
            command.arg("--screenshots").arg(folder);
        }
        let output = command.output().expect("node starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let found: Value = serde_json::from_slice(&output.stdout).expect("the script prints JSON");
        let of_page = |page: &&Path| serde_json::from_value(found[page.to_str().unwrap()].clone()).unwrap();
        pages.iter().map(of_page).collect()
    }
}

fn in_path(program: &str) -> Option<PathBuf> {
    let folders = env::var_os("PATH")?;
    env::split_paths(&folders).map(|folder| folder.join(program)).find(|path| path.is_file())
}

/// What is changed in a page, and what has to be found then.
struct Fault<'a> {
    changes: Vec<(&'a str, &'a str)>,
    found: &'a [&'a str],
}

#[test]
fn the_page_works_in_a_browser() {
    if !has_gpu() {
        return;
    }
    // Where `cargo xtask test` could get no browser, it says so, and excuses this test.
    let Some(driver) = zfail_testing::browser(Driver::new()) else { return };
    let folder = tempfile::tempdir().unwrap();
    let args = ["compare", "builtin:nested", "-o", "out", "--size", "96x64", "--light", "0", "-q"];
    zfail(folder.path(), &args).ok();
    let out = folder.path().join("out");
    let (page, record) = (out.join("index.html"), out.join("compare.json"));
    let text = fs::read_to_string(&page).unwrap();

    // What has to be found on pages with faults, together as far as one does not hide the other.
    let row = |text: &str| {
        let start = text.find("<tr id=\"row-").unwrap();
        text[start..start + text[start..].find("</tr>").unwrap() + 5].to_owned()
    };
    let first_row = row(&text);
    let faults = [
        Fault {
            found: &[
                "images: picture-truth is 0,0",
                "table: no row of heidmann-two-pass",
                "table: the row of heidmann-two-sided says 9",
                "request: http://127.0.0.1:9/",
                "slider: moving the divider changes nothing",
            ],
            changes: vec![
                ("base64,iVBOR", "base64,AAAAA"),
                (&first_row, ""),
                ("data-label=\"Wrong pixels\">", "data-label=\"Wrong pixels\">9"),
                ("<h1>", "<img src=\"http://127.0.0.1:9/\" alt=\"\"><h1>"),
                ("addEventListener(\"input\", move)", "addEventListener(\"inptu\", move)"),
            ],
        },
        Fault {
            found: &["script: ", "keyboard: Tab does not lead", "phone: at 360"],
            changes: vec![
                ("\"use strict\";", "\"use strict\"; missing();"),
                (".scroll { overflow-x: auto; }", "table { min-width: 50rem; }"),
            ],
        },
    ];
    let mut pages = Vec::new();
    for (i, fault) in faults.iter().enumerate() {
        let broken = fault.changes.iter().fold(text.clone(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        pages.push(out.join(format!("broken-{i}.html")));
        fs::write(&pages[i], broken).unwrap();
    }
    pages.push(page);
    let found = driver.examine(&record, &pages.iter().map(PathBuf::as_path).collect::<Vec<_>>());
    for (fault, found) in faults.iter().zip(&found) {
        for word in fault.found {
            assert!(found.iter().any(|problem| problem.contains(word)), "'{word}' is not in {found:#?}");
        }
    }
    assert_eq!(found.last().unwrap(), &[] as &[String]);
}
