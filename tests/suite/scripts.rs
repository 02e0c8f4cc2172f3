//! The shipped scripts.

use crate::shipped;
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
