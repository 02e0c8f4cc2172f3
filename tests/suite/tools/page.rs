//! The page of `gapi teach --html` in a real browser: every control is used, on a desktop and on a
//! phone. Where there is no browser, the test says so and passes.

use crate::support::browser::{chromium, reports};
use crate::support::program::{folder, gapi};
use crate::support::shipped::project;
use std::path::Path;
use std::process::Command;

/// The page after all that its scripts do, as the browser has it then.
fn shown(chromium: &Path, here: &Path, page: &str) -> String {
    let out = Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--window-size=1280,800"])
        .args(["--virtual-time-budget=60000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", here.join("profile").display()))
        .arg(format!("file://{}", here.join(page).display()))
        .output()
        .expect("the browser starts");
    String::from_utf8_lossy(&out.stdout).into_owned()
}

#[test]
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn every_control_of_the_page_does_what_it_should() {
    let Some(chromium) = chromium() else {
        eprintln!("skipped: no Chromium; GAPILIB_CHROMIUM names one");
        return;
    };
    used(
        &chromium,
        ("search.mos", crate::tools::teach::SEARCH),
        "tests/page/use_every_control.js",
        50,
    );
}

#[test]
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn calls_of_operators_are_shown_as_tables() {
    let Some(chromium) = chromium() else {
        eprintln!("skipped: no Chromium; GAPILIB_CHROMIUM names one");
        return;
    };
    let script = ("operators.mos", crate::tools::teach::OPERATORS);
    used(&chromium, script, "tests/page/use_operators.js", 60);
}

/// Uses the page of a script on a desktop and on a phone; the walk through it reports at least so many
/// checks, and none that failed.
fn used(chromium: &Path, script: (&str, &str), walk: &str, checks: usize) {
    let here = folder(&[script]);
    let (code, _, errors) = gapi(&here, &["teach", script.0, "--html", "steps.html"]);
    assert_eq!(code, 0, "{errors}");
    let page = std::fs::read_to_string(here.path().join("steps.html")).unwrap();
    let walk = std::fs::read_to_string(project(walk)).unwrap();
    // The script of the test is not the page's own.
    let open = page.replace("http-equiv=\"Content-Security-Policy\"", "name=\"policy\"");
    let page = open.replace("</body>", &format!("<script>{walk}</script></body>"));
    std::fs::write(here.path().join("tested.html"), page).unwrap();
    let phone = "<body><script>onmessage = e => typeof e.data === 'string' && document.body.replaceChildren(e.data)</script>\
        <iframe src=\"tested.html\" width=\"390\" height=\"844\" style=\"border: 0\"></iframe>";
    std::fs::write(here.path().join("phone.html"), phone).unwrap();
    for (page, width) in [("tested.html", 1280), ("phone.html", 390)] {
        let mut reports = reports(&shown(chromium, here.path(), page));
        assert_eq!(reports.pop(), Some(format!("width {width}")), "{reports:#?}");
        let wrong: Vec<&String> = reports.iter().filter(|line| !line.starts_with("ok")).collect();
        assert!(wrong.is_empty() && reports.len() > checks, "{page}: {wrong:#?}");
    }
}
