//! The report page: what stands in it, and in a real browser how it is laid out, on a desktop and on
//! a phone, light and dark. The browser is found as in `page.rs`; `GAPILIB_AXE` names the file
//! `axe.min.js` of axe-core, whose findings then count too. What is missing is said, and passes.

use crate::support::browser::{chromium, reports};
use crate::support::program::{folder, gapi};
use crate::support::shipped::project;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

const MODEL: &str = include_str!("../../data/models/report_page_model.mo");

/// A problem with these parameters and experiments, and the data of height and flow.
fn solved(problem: &str, arguments: &[&str]) -> (TempDir, String) {
    let mut data = String::from("time,h,q,doubled\n");
    for k in 0..16 {
        let time = 0.25 * f64::from(k);
        // A pattern that no pair of parameters removes.
        let error = 0.004 * f64::from(k * k).sin();
        let h = 2.0 * (-0.8 * time).exp();
        data += &format!("{time},{},{},{}\n", h + error, 0.8 * h - error, 2.0 * h + error);
    }
    let here = folder(&[("p.toml", problem), ("Tank.mo", MODEL), ("a.csv", &data)]);
    let arguments = [&["identify", "p.toml", "--plain", "--out", "."], arguments].concat();
    let (code, _, errors) = gapi(&here, &arguments);
    assert_eq!(code, 0, "{errors}");
    let page = std::fs::read_to_string(here.path().join("report.html")).unwrap();
    (here, page)
}

fn problem(parameters: &str, rest: &str) -> String {
    format!(
        "title = 'Tank <1> & \"2\"'\nmodel = \"Tank\"\nfiles = [\"Tank.mo\"]\n\n[parameters]\n{parameters}\n\
         [method]\nname = \"genetic\"\n\n[stop]\nevaluations = 400\n\n{rest}"
    )
}

const TWO: &str = "k = { min = 0.1, max = 3 }\nh0 = { min = 0.1, max = 5 }\n";

fn two_outputs() -> (TempDir, String) {
    let experiment = "[[experiment]]\nname = \"empties\"\ndata = \"a.csv\"\ntolerance = 1e-9\n\
                      outputs = { h = \"h\", q = \"q\" }\n";
    let kept = experiment.replace("empties", "kept") + "validation = true\n";
    let text = problem(TWO, &format!("{experiment}{kept}"));
    solved(&text, &["--profile", "--sensitivity", "morris"])
}

/// The part of the page from one place to another.
fn between<'a>(page: &'a str, from: &str, to: &str) -> &'a str {
    let (_, rest) = page.split_once(from).unwrap_or_else(|| panic!("no `{from}`"));
    rest.split_once(to).unwrap_or_else(|| panic!("no `{to}`")).0
}

#[test]
fn the_page_needs_nothing_from_elsewhere() {
    let (_, page) = two_outputs();
    let policy = between(&page, "http-equiv=\"Content-Security-Policy\" content=\"", "\"");
    assert!(policy.starts_with("default-src 'none'") && policy.contains("style-src 'sha256-"));
    assert!(!policy.contains("unsafe") && policy.contains("; script-src 'sha256-"), "{policy}");
    assert_eq!(page.matches("<script").count(), 1, "the script whose digest the policy names");
    for unwanted in ["http://", "https://", " src=", "@import", "url(", " style="] {
        assert!(!page.contains(unwanted), "{unwanted}");
    }
    let attributes = page.split_whitespace().filter_map(|word| word.split_once("=\""));
    let handlers: Vec<&str> =
        attributes.map(|(name, _)| name).filter(|name| name.starts_with("on")).collect();
    assert!(handlers.is_empty(), "{handlers:?}");
    assert!(page.contains("<title>Tank &lt;1&gt; &amp; &quot;2&quot;</title>"));
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
}

#[test]
fn every_part_of_the_solution_has_its_section() {
    let (_, page) = two_outputs();
    let nav = between(&page, "<nav", "</nav>");
    let sections = [
        "result",
        "fit",
        "series",
        "residuals",
        "convergence",
        "profiles",
        "sensitivity",
        "traces",
        "run",
        "guide",
    ];
    for id in sections {
        assert!(nav.contains(&format!("href=\"#{id}\"")), "{id}: {nav}");
        assert!(page.contains(&format!(" id=\"{id}\"")), "{id}");
    }
    let result = between(&page, "id=\"result\"", "</table>");
    assert!(
        result.contains("<strong>0.8") && result.contains("\u{a0}s⁻¹") || result.contains("1/s"),
        "{result}"
    );
    assert!(result.contains("identifiable") && result.contains("0.1 to 5"), "{result}");
    let fit = between(&page, "id=\"fit\"", "</section>");
    assert_eq!(fit.matches("<figure>").count(), 1, "beside the table");
    let series = between(&page, "id=\"series\"", "</section>");
    assert_eq!(series.matches("<figure>").count(), 3, "two outputs, twice");
    assert!(series.contains("kept / q / validation"));
    let profiles = between(&page, "id=\"profiles\"", "</section>");
    assert_eq!(profiles.matches("<figure>").count(), 2);
    assert_eq!(profiles.matches(">95 % limit</text>").count(), 1, "one legend for all");
    let ids: Vec<&str> =
        page.match_indices(" id=\"").map(|(at, found)| between(&page[at..], found, "\"")).collect();
    let known: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(known.len(), ids.len(), "an id stands twice: {ids:?}");
    for (at, found) in page.match_indices("href=\"#") {
        let target = between(&page[at..], found, "\"");
        assert!(known.contains(target), "{target}");
    }
}

/// The curve is a solution of the model between the points too, not a line from one to the next.
#[test]
fn the_curve_is_drawn_between_the_measured_points() {
    let (here, page) = two_outputs();
    let json = std::fs::read_to_string(here.path().join("result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&json).unwrap();
    let value = |k: usize| result["parameters"][k]["value"].as_f64().unwrap();
    let curve = result["series"][0]["curve"].as_array().unwrap();
    assert!(curve.len() > 100, "{}", curve.len());
    for point in curve {
        let (time, h) = (point[0].as_f64().unwrap(), point[1].as_f64().unwrap());
        let exact = value(1) * (-value(0) * time).exp();
        assert!((h - exact).abs() < 1e-5, "{time}: {h}, {exact}");
    }
    let fit = between(&page, "id=\"fit\"", "</svg>");
    let longest = fit
        .split("<polyline points=\"")
        .map(|line| line.split_once('"').unwrap().0.split(' ').count());
    assert!(longest.max().unwrap() > 100);
}

#[test]
fn what_is_missing_is_left_out() {
    // As many parameters as points: there is neither a standard error nor a test.
    let text = problem(TWO, "[[experiment]]\ndata = \"b.csv\"\noutputs = { h = \"h\" }\n");
    let here = folder(&[("p.toml", &text), ("Tank.mo", MODEL), ("b.csv", "time,h\n0,2\n1,0.9\n")]);
    let (code, _, errors) = gapi(&here, &["identify", "p.toml", "--plain", "--out", "."]);
    assert_eq!(code, 0, "{errors}");
    let page = std::fs::read_to_string(here.path().join("report.html")).unwrap();
    for absent in ["pairs", "profiles", "sensitivity", "minima", "front"] {
        assert!(!page.contains(&format!(" id=\"{absent}\"")), "{absent}");
        assert!(!page.contains(&format!("href=\"#{absent}\"")), "{absent}");
    }
    let result = between(&page, "id=\"result\"", "</table>");
    assert!(!result.contains("identifiable"), "{result}");
    assert!(between(&page, "<header>", "</header>").contains("no statement on identifiability"));
}

/// The page after all that its scripts do, as the browser has it then; and what its console said.
fn shown(chromium: &Path, here: &Path, page: &str, dark: bool) -> (String, String) {
    let scheme = format!("--blink-settings=preferredColorScheme={}", if dark { 0 } else { 1 });
    let out = Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--window-size=1280,800"])
        .args(["--virtual-time-budget=60000", "--enable-logging=stderr", "--dump-dom", &scheme])
        .arg(format!("--user-data-dir={}", here.join("profile").display()))
        .arg(format!("file://{}", here.join(page).display()))
        .output()
        .expect("the browser starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (text(&out.stdout), text(&out.stderr))
}

#[test]
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn the_page_is_laid_out_for_desktop_and_phone_light_and_dark() {
    let Some(chromium) = chromium() else {
        eprintln!("skipped: no Chromium; GAPILIB_CHROMIUM names one");
        return;
    };
    let axe = std::env::var_os("GAPILIB_AXE").map(|file| std::fs::read_to_string(file).unwrap());
    if axe.is_none() {
        eprintln!("skipped in part: no axe-core; GAPILIB_AXE names its axe.min.js");
    }
    let (here, page) = two_outputs();
    let write = |name: &str, text: &str| std::fs::write(here.path().join(name), text).unwrap();
    let refused = "Content Security Policy";
    let (_, console) = shown(&chromium, here.path(), "report.html", false);
    assert!(!console.contains(refused), "{console}");
    write("styled.html", &page.replace("<h1>", "<h1 style=\"color: red\">"));
    let (_, console) = shown(&chromium, here.path(), "styled.html", false);
    assert!(console.contains(refused), "the policy refuses nothing: {console}");
    let checks = std::fs::read_to_string(project("tests/page/check_report.js")).unwrap();
    let scripts = format!(
        "<script>{}</script><script>{checks}</script></body>",
        axe.as_deref().unwrap_or("")
    );
    // The scripts of the test are not the page's own.
    let open = page.replace("http-equiv=\"Content-Security-Policy\"", "name=\"policy\"");
    write("tested.html", &open.replace("</body>", &scripts));
    write(
        "phone.html",
        "<body><script>onmessage = e => document.body.replaceChildren(e.data)</script><iframe src=\"tested.html\" width=\"390\" height=\"844\" style=\"border: 0\"></iframe>",
    );
    for (page, width, dark) in [
        ("tested.html", 1280, false),
        ("tested.html", 1280, true),
        ("phone.html", 390, false),
        ("phone.html", 390, true),
    ] {
        let mut reports = reports(&shown(&chromium, here.path(), page, dark).0);
        let scheme = if dark { "dark" } else { "light" };
        assert_eq!(reports.pop(), Some(format!("{scheme} {width}")), "{reports:#?}");
        assert_eq!(reports.pop_if(|line| line == "axe").is_some(), axe.is_some());
        let wrong: Vec<&String> = reports.iter().filter(|line| !line.starts_with("ok")).collect();
        assert!(wrong.is_empty() && reports.len() > 7, "{page} {scheme}: {wrong:#?}");
    }
}
