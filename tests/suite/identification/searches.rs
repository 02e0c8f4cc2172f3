//! Several searches with different seeds: the best one is the result, as if it had been the only one.

use crate::support::program::{folder, gapi};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const MODEL: &str = "model Wave
  parameter Real w = 1;
  parameter Real a = 1;
  Real y = a*sin(w*time);
end Wave;
";

/// A search that is too short, so that its result depends on the seed.
const PROBLEM: &str = "model = \"Wave\"
files = [\"Wave.mo\"]
[parameters]
w = { min = 0.1, max = 30 }
a = { min = 0.1, max = 9 }
[method]
name = \"genetic\"
population = 8
polish = false
[stop]
generations = 4
[[experiment]]
data = \"d.csv\"
x = \"time\"
outputs = { y = \"y\" }
";

fn here() -> TempDir {
    let points = (0..25).map(|k| f64::from(k) * 0.25);
    let rows: String = points.map(|t| format!("{t},{:.2}\n", 2.0 * (3.0 * t).sin())).collect();
    let data = format!("time,y\n{rows}");
    folder(&[("Wave.mo", MODEL), ("p.toml", PROBLEM), ("d.csv", &data)])
}

fn identify(here: &TempDir, arguments: &[&str]) -> String {
    let (code, text, errors) = gapi(here, &[&["identify", "p.toml"], arguments].concat());
    assert_eq!(code, 0, "{errors}");
    text
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = entries.map(|path| {
        (path.file_name().unwrap().to_string_lossy().into_owned(), fs::read(path).unwrap())
    });
    named.filter(|(name, _)| name != "timing.json" && name != "run.lock").collect()
}

/// The files of a folder but for those by which a run that was not divided goes on with higher limits.
fn results(here: &TempDir, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let mut all = files(&here.path().join(folder));
    all.retain(|name, _| !name.starts_with("finished"));
    all
}

/// Seed and objective of each line.
fn searches(folder: &Path) -> Vec<(String, f64)> {
    let text = fs::read_to_string(folder.join("searches.csv")).unwrap();
    let row = |line: &str| {
        let mut cells = line.split(',').skip(1);
        (cells.next().unwrap().to_owned(), cells.next().unwrap().parse().unwrap())
    };
    text.lines().skip(1).map(row).collect()
}

#[test]
fn the_result_is_that_of_the_best_search() {
    let here = here();
    let text = identify(&here, &["--searches", "6", "--out", "six"]);
    let six = searches(&here.path().join("six"));
    assert_eq!(six.len(), 6);
    let best = six.iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert!(best.1 < six[0].1, "the first search is not the best one here: {six:?}");
    assert!(text.contains("of 6 with different seeds found the best objective"), "{text}");
    // Alone, with that seed.
    let alone = format!("seed = [{}]\n{PROBLEM}", best.0.replace(' ', ", "));
    fs::write(here.path().join("p.toml"), alone).unwrap();
    identify(&here, &["--out", "alone"]);
    let (six, alone) = (files(&here.path().join("six")), files(&here.path().join("alone")));
    for name in ["history.csv", "individuals.csv", "fit.csv", "Calibrated.mo"] {
        assert!(six[name] == alone[name], "`{name}` differs");
    }
    assert!(!alone.contains_key("searches.csv") && !six.contains_key("run-2.journal"));
}

#[test]
fn shards_divide_the_searches() {
    let here = here();
    let study = ["--searches", "6", "--profile", "--bootstrap"];
    identify(&here, &[&study[..], &["--out", "whole"]].concat());
    for number in ["1/3", "2/3", "3/3"] {
        let out = number.replace('/', "of");
        let text = identify(&here, &[&study[..], &["--shard", number, "--out", &out]].concat());
        assert!(text.contains("searches belong to other shards"), "{text}");
        // The searches of a shard beside the first.
        let own = text.lines().filter(|line| line.starts_with("search ")).count();
        assert_eq!(own, if number == "3/3" { 1 } else { 2 }, "{text}");
    }
    let merge = ["report", "--merge", "1of3", "2of3", "3of3", "--out", "merged"];
    let (code, text, errors) = gapi(&here, &merge);
    assert_eq!(code, 0, "{errors}");
    assert!(!text.lines().any(|line| line.starts_with("search ")), "{text}");
    let (whole, merged) = (results(&here, "whole"), results(&here, "merged"));
    assert_eq!(whole.keys().collect::<Vec<_>>(), merged.keys().collect::<Vec<_>>());
    for (name, bytes) in &whole {
        assert!(bytes == &merged[name], "`{name}` differs");
    }
}

#[test]
fn a_study_that_was_killed_goes_on_with_the_searches_that_it_has() {
    let here = here();
    let study = ["--searches", "4"];
    identify(&here, &[&study[..], &["--out", "whole"]].concat());
    // What a kill behind the third search leaves: journals of the first two whole, of the third in parts.
    identify(&here, &["--searches", "4", "--out", "killed", "--shard", "1/1"]);
    let whole = files(&here.path().join("whole"));
    let killed = here.path().join("killed");
    let known = gapilib::internals::identify::problem::ShardFile::from_bytes(
        &fs::read(killed.join("shard.part")).unwrap(),
    );
    let journal = known.expect("whole").journal;
    files(&killed).keys().for_each(|name| fs::remove_file(killed.join(name)).unwrap());
    fs::write(killed.join("run.journal"), &journal[..journal.len() - 7]).unwrap();
    let text = identify(&here, &[&study[..], &["--out", "killed", "--resume"]].concat());
    assert!(text.contains("resumed after 3 generations"), "{text}");
    assert_eq!(whole, files(&killed));
}

#[test]
fn all_searches_go_on_where_a_limit_has_ended_them() {
    let here = here();
    let generations = |n: usize| {
        let problem = PROBLEM.replace("generations = 4", &format!("generations = {n}"));
        fs::write(here.path().join("p.toml"), problem).unwrap();
    };
    let raised = ["--searches", "3", "--out", "raised"];
    let text = identify(&here, &raised);
    assert!(text.contains("continue from here with higher limits"), "{text}");
    generations(9);
    let text = identify(&here, &[&raised[..], &["--resume"]].concat());
    assert_eq!(text.matches("resumed after 4 generations").count(), 3, "{text}");
    identify(&here, &["--searches", "3", "--out", "whole"]);
    let (whole, raised) = (files(&here.path().join("whole")), files(&here.path().join("raised")));
    assert!(whole.contains_key("finished-3.journal") && !whole.contains_key("run-3.journal"));
    for (name, bytes) in &whole {
        assert!(bytes == &raised[name], "`{name}` differs");
    }
}

#[test]
fn several_objectives_have_no_best_search() {
    let here = here();
    let two = PROBLEM.replace("name = \"genetic\"", "name = \"nsga2\"");
    let two = two.replace("polish = false\n", "");
    let two = format!("fitness = [\"rmse\", \"mae\"]\n{two}");
    fs::write(here.path().join("p.toml"), two).unwrap();
    let (code, _, errors) = gapi(&here, &["identify", "p.toml", "--searches", "3"]);
    assert!(code == 1 && errors.contains("has several"), "{errors}");
}

/// Where the first seed finds nothing, the others do.
#[test]
fn a_shard_whose_first_search_fails_leaves_the_others() {
    let here = here();
    let model = MODEL.replace(
        "  Real y = a*sin(w*time);",
        "  Real y = a*sin(w*time);\nequation\n  assert(w > 0.14 and w < 0.17, \"too fast\");",
    );
    fs::write(here.path().join("Wave.mo"), model).unwrap();
    let problem = PROBLEM.replace("generations = 4", "generations = 1");
    fs::write(here.path().join("p.toml"), problem).unwrap();
    let text = identify(&here, &["--searches", "5", "--out", "whole"]);
    let whole = searches(&here.path().join("whole"));
    assert!(whole[0].1.is_infinite() && whole.iter().any(|own| own.1.is_finite()), "{whole:?}");
    assert!(text.contains("without any simulation that succeeded"), "{text}");
    // An infinite objective survives `result.json`.
    let (code, _, errors) = gapi(&here, &["report", "whole"]);
    assert_eq!(code, 0, "{errors}");
    for (number, out) in [("1/2", "s1"), ("2/2", "s2")] {
        let shard = ["identify", "p.toml", "--searches", "5", "--shard", number, "--out", out];
        assert_eq!(gapi(&here, &shard).0, 1, "a shard alone has no result");
    }
    let (code, _, errors) = gapi(&here, &["report", "--merge", "s1", "s2", "--out", "merged"]);
    assert_eq!(code, 0, "{errors}");
    assert_eq!(results(&here, "whole"), results(&here, "merged"));
}

#[test]
fn numbers_of_searches_are_checked() {
    let here = here();
    for wrong in ["0", "1000000000"] {
        fs::write(here.path().join("p.toml"), format!("searches = {wrong}\n{PROBLEM}")).unwrap();
        let (code, _, errors) = gapi(&here, &["identify", "p.toml"]);
        assert!(code == 1 && errors.contains("from 1 to 100000"), "{errors}");
    }
}

/// A journal of an earlier study is seen before anything is simulated, and a run that ends removes it.
#[test]
fn journals_of_earlier_searches_are_not_forgotten() {
    let here = here();
    let out = here.path().join("out");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("run-2.journal"), "of another time").unwrap();
    let study = ["identify", "p.toml", "--searches", "3", "--out", "out"];
    let (code, text, errors) = gapi(&here, &study);
    assert!(code == 1 && errors.contains("run-2.journal") && text.is_empty(), "{text}{errors}");
    identify(&here, &["--out", "out", "--fresh"]);
    assert!(!out.join("run-2.journal").exists());
}

#[test]
fn searches_that_do_not_depend_on_the_seed_are_told() {
    let here = here();
    let problem = PROBLEM.replace(
        "name = \"genetic\"\npopulation = 8\npolish = false",
        "name = \"levenberg_marquardt\"",
    );
    fs::write(here.path().join("p.toml"), problem).unwrap();
    let text = identify(&here, &["--searches", "3", "--out", "out"]);
    assert!(text.contains("they do not show that no other result exists"), "{text}");
}
