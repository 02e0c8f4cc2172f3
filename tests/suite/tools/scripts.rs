//! The shipped scripts.

use crate::support::program::{folder, gapi};
use crate::support::shipped;
use gapilib::internals::source::SourceMap;
use gapilib::internals::{mat, syntax};
use std::path::Path;

#[test]
fn every_script_parses_and_says_first_what_it_shows() {
    for path in shipped::files("scripts", "mos") {
        let text = std::fs::read_to_string(&path).unwrap();
        let runs_only = text.starts_with("// ");
        assert!(runs_only, "{} does not begin with `// what it shows`", path.display());
        let sources = SourceMap::default();
        let source = sources.add(path.display().to_string(), text.clone());
        if let Err(diagnostic) = syntax::parse_script(source, &text) {
            panic!("{}: {diagnostic}", sources.location(diagnostic.span()));
        }
    }
}

/// The numbers of a data file, column by column.
fn columns(path: &Path, names: [&str; 2]) -> [Vec<f64>; 2] {
    let file = mat::read_named(&path.to_string_lossy(), &std::fs::read(path).unwrap()).unwrap();
    names.map(|name| file.matrix(name).unwrap().row_major())
}

#[test]
fn matrices_and_tables_hold_the_same_data() {
    let mut tables = shipped::files("scripts/data", "csv");
    tables
        .retain(|table| table.parent() != Some(shipped::project("scripts/data/stacks").as_path()));
    assert_eq!(tables.len(), 42 + 2 + 4, "measured curves and twins");
    for table in tables {
        let header = std::fs::read_to_string(&table).unwrap();
        let over_time = header.starts_with("t_s,");
        let (x, in_table) = if over_time { ("t", "t_s") } else { ("i", "i_A_per_cm2") };
        let matrices = columns(&table.with_extension("mat"), [x, "V"]);
        assert_eq!(matrices, columns(&table, [in_table, "V"]), "{}", table.display());
        assert!(matrices[0].len() >= 10 && matrices[0].is_sorted(), "{}", table.display());
    }
}

#[test]
fn the_twin_is_the_published_curve() {
    let folder = shipped::project("scripts/data/twin");
    let [i, v] = columns(&folder.join("table4.mat"), ["i", "V"]);
    assert_eq!((i.len(), i[0], i[29]), (30, 0.002, 0.22));
    for (i, v) in i.iter().zip(&v) {
        let total = i + 1.4e-3;
        let expected = 1.2 - 7.2860e-4 * total - 0.0390 * (total / 1.5856e-6).ln()
            + 0.0918 * (1.0 - total / 0.2265).ln();
        assert!((v - expected).abs() < 1e-15, "at {i}: {v} {expected}");
    }
    let [_, noisy] = columns(&folder.join("table4_noise_2mV.mat"), ["i", "V"]);
    let variance = noisy.iter().zip(&v).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / 30.0;
    assert!((0.0015..0.0025).contains(&variance.sqrt()), "{}", variance.sqrt());
}

#[test]
fn measured_data_come_with_their_source() {
    let readme = shipped::project("scripts/data/ecsim_nafion112/README.md");
    let text = std::fs::read_to_string(readme).unwrap();
    assert!(text.contains("CC-BY 4.0") && text.contains("10.26434/chemrxiv.11902023"));
}

/// Authors copy matrices in loops: the individuals in them are the same, so are the units of the data,
/// and least squares follow the script's search.
#[test]
fn rows_that_a_script_copies_element_by_element_stay_those_of_its_individuals() {
    let model =
        "model T\n  parameter Real k = 1;\n  Real y(unit = \"V\") = exp(-k*time);\nend T;\n";
    let script = "xe = {0, 1, 2};\nye = {1, 0.61, 0.37};\npop = [0.2; 0.4; 0.6; 0.8];\n\
                  rows = Eval(\"T.mo\", \"T\", xe, pop, {\"k\"}, \"time\", \"y\");\nCOPY\
                  f = Fit(d, ye);\nprint(String(f[3]));\n";
    let loops = "d = zeros(4, 3);\nfor i in 1:4 loop for j in 1:3 loop d[i,j] := rows[i,j]; \
                 end for; end for;\n";
    let said = ["d = rows;\n", loops].map(|copy| {
        let here = folder(&[("T.mo", model), ("job.mos", &script.replace("COPY", copy))]);
        let (code, out, errors) = gapi(&here, &["run", "job.mos"]);
        assert_eq!(code, 0, "{out}{errors}");
        assert!(out.contains("standard error") && !out.contains("its own function"), "{out}");
        let without = regex::Regex::new(r"(?m)^ +time .*$").unwrap();
        without.replace_all(&out, "").into_owned()
    });
    assert_eq!(said[0], said[1]);
}
