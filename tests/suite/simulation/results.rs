//! Results of simulations as files.

use gapilib::internals::mat;
use gapilib::results::{self, ResultTable, Series, Values, errors};
use proptest::prelude::*;
use std::process::Command;

fn example() -> ResultTable {
    let mut table = ResultTable::new(vec![0.0, 0.5, 0.5, 1.0]);
    let x = Values::Trajectory(vec![1.0, 2.0, -2.0, -3.0]);
    table.series = vec![
        Series::new("minus_x", Values::Alias { of: 2, negated: true }),
        Series::new("p", Values::Constant(2.5)),
        Series {
            name: "cell.x[1]".to_owned(),
            unit: "Pa".to_owned(),
            description: "Überdruck".to_owned(),
            values: x,
        },
        Series::new("minus_p", Values::Alias { of: 1, negated: true }),
        Series::new("same_x", Values::Alias { of: 2, negated: false }),
    ];
    table
}

fn columns(table: &ResultTable) -> Vec<(String, Vec<f64>)> {
    table.names().map(|name| (name.to_owned(), table.column(name).unwrap())).collect()
}

#[test]
fn every_format_reads_what_it_wrote() {
    for entry in results::FORMATS {
        let format = results::format(entry.name).unwrap();
        let read = format.read(&format.write(&example()).unwrap()).unwrap();
        assert_eq!(columns(&read), columns(&example()), "{}", entry.name);
    }
}

#[test]
fn mat_keeps_aliases_units_and_descriptions() {
    let format = results::format_of_file("out/dsres.mat").unwrap();
    let read = format.read(&format.write(&example()).unwrap()).unwrap();
    let x = &read.series[2];
    assert_eq!((&*x.unit, &*x.description), ("Pa", "Überdruck"));
    assert_eq!(x.values, Values::Alias { of: 0, negated: true });
    assert_eq!(read.series[4].values, Values::Alias { of: 0, negated: true });
    assert_eq!(read.series[1].values, Values::Constant(2.5));
}

#[test]
fn mat_reads_both_layouts_and_both_precisions() {
    let format = results::format("mat").unwrap();
    for file in ["binTrans_double", "binTrans_single", "binNormal_double", "binNormal_single"] {
        let root = env!("CARGO_MANIFEST_DIR");
        let bytes = std::fs::read(format!("{root}/tests/data/mat/result_{file}.mat")).unwrap();
        let table = format.read(&bytes).unwrap();
        assert_eq!(table.time_name, "Time");
        let x = [1.0, 2.0, -2.0, -3.0];
        let expected = [
            ("Time", [0.0, 0.5, 0.5, 1.0]),
            ("p", [2.5; 4]),
            ("x", x),
            ("minus_x", x.map(|x| -x)),
            ("same_x", x),
            ("minus_p", [-2.5; 4]),
        ];
        assert_eq!(columns(&table), expected.map(|(name, v)| (name.to_owned(), v.to_vec())));
        let units: Vec<&str> = table.series.iter().map(|series| &*series.unit).collect();
        assert_eq!(units, ["m", "Pa", "", "", ""]);
    }
}

#[test]
fn mat_has_the_layout_that_other_programs_expect() {
    let bytes = results::format("mat").unwrap().write(&example()).unwrap();
    let file = mat::read(&bytes).unwrap();
    assert_eq!(
        file.matrix("Aclass").unwrap().row_strings(),
        ["Atrajectory", "1.1", "", "binTrans"]
    );
    let names: Vec<&String> = file.arrays.keys().collect();
    assert_eq!(names, ["Aclass", "name", "description", "dataInfo", "data_1", "data_2"]);
    let info = file.matrix("dataInfo").unwrap();
    let rows: Vec<Vec<f64>> = (0..6).map(|j| info.column(j)[..2].to_vec()).collect();
    let expected = [[0, 1], [2, -2], [1, 2], [2, 2], [1, -2], [2, 2]];
    assert_eq!(rows, expected.map(|row| row.map(f64::from).to_vec()));
    assert_eq!(file.matrix("data_1").unwrap().values, [0.0, 2.5, 1.0, 2.5]);
}

#[test]
fn a_constant_that_changes_is_the_line_between_its_values() {
    let text = |lines: &[&str]| mat::Matrix::from_text(lines);
    let rows = |rows: &[[f64; 2]]| {
        mat::Matrix::from_rows(&rows.iter().map(|row| row.to_vec()).collect::<Vec<_>>())
    };
    let bytes = mat::write_v4([
        ("Aclass", &text(&["Atrajectory", "1.1", "", "binNormal"])),
        ("name", &text(&["time", "p"])),
        ("description", &text(&["", ""])),
        ("dataInfo", &rows(&[[0.0, 1.0], [1.0, -2.0]])),
        ("data_1", &rows(&[[0.0, 1.0], [4.0, 3.0]])),
        ("data_2", &mat::Matrix::column_vector(vec![0.0, 1.0, 4.0])),
    ]);
    let table = results::format("mat").unwrap().read(&bytes.unwrap()).unwrap();
    assert_eq!(table.column("p").unwrap(), [-1.0, -1.5, -3.0]);
}

#[test]
fn interpolation_is_linear_and_takes_the_value_after_an_event() {
    let table = example();
    let found = table.interpolate("minus_x", &[0.0, 0.25, 0.5, 0.75, 1.0]).unwrap();
    assert_eq!(found, [-1.0, -1.5, 2.0, 2.5, 3.0]);
    assert_eq!(table.interpolate("Time", &[0.3]).unwrap(), [0.3]);
    let fault = table.interpolate("p", &[1.5]).unwrap_err();
    assert_eq!(fault.code, errors::OUTSIDE_RESULTS);
    assert_eq!(fault.message, "`p` at time 1.5: the results go from 0 to 1");
    assert!(table.interpolate("p", &[f64::NAN]).is_err());
}

#[test]
fn unknown_variable_is_answered_with_the_nearest_name() {
    let fault = example().column("minus_y").unwrap_err();
    assert_eq!(fault.code, errors::UNKNOWN_RESULT_VARIABLE);
    assert_eq!(fault.helps, ["did you mean `minus_x`?"]);
}

#[test]
fn a_table_that_contradicts_itself_is_refused() {
    let broken = |change: fn(&mut ResultTable)| {
        let mut table = example();
        change(&mut table);
        for entry in results::FORMATS {
            let fault = results::format(entry.name).unwrap().write(&table).unwrap_err();
            assert_eq!(fault.code, errors::BAD_RESULT_TABLE);
        }
    };
    broken(|table| table.time[0] = 2.0);
    broken(|table| table.time[0] = f64::NAN);
    broken(|table| table.time.push(2.0));
    broken(|table| table.series[0].name = "p".to_owned());
    broken(|table| table.series[0].values = Values::Alias { of: 9, negated: false });
    broken(|table| table.series[0].values = Values::Alias { of: 0, negated: false });
}

#[test]
fn files_that_hold_no_results_are_refused() {
    let format = results::format("mat").unwrap();
    let x = mat::Matrix::column_vector(vec![1.0]);
    let fault = format.read(&mat::write_v4([("x", &x)]).unwrap()).unwrap_err();
    assert_eq!(fault.code, errors::BAD_RESULT_FILE);
    let fault = results::format("csv").unwrap().read(b"i,V\n1,2\n").unwrap_err();
    assert_eq!(fault.message, "the first column is not `time`");
    assert!(results::format("xlsx").is_err());
}

/// Python with scipy and DyMat, if present, reads our file as an independent witness.
#[test]
#[allow(clippy::print_stderr, reason = "a skipped check must be visible")]
fn python_reads_our_results() {
    const CHECK: &str = "
import sys, DyMat
d = DyMat.DyMatFile(sys.argv[1])
assert sorted(d.names()) == ['cell.x[1]', 'minus_p', 'minus_x', 'p', 'same_x'], d.names()
x = [1, 2, -2, -3]
assert list(d.data('cell.x[1]')) == x and list(d.data('same_x')) == x
assert list(d.data('minus_x')) == [-v for v in x]
assert list(d.data('p')) == [2.5, 2.5] and list(d.data('minus_p')) == [-2.5, -2.5]
assert list(d.abscissa('cell.x[1]', valuesOnly=True)) == [0, .5, .5, 1]
";
    let present = Command::new("python3").args(["-c", "import DyMat, scipy.io"]).output();
    if !present.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: python3 with scipy and DyMat is not here");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.mat");
    std::fs::write(&path, results::format("mat").unwrap().write(&example()).unwrap()).unwrap();
    let output = Command::new("python3").args(["-c", CHECK]).arg(&path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn numbers_survive_every_format(values in proptest::collection::vec(proptest::num::f64::NORMAL, 1..20)) {
        let mut table = ResultTable::new((0..values.len()).map(|i| i as f64 / 3.0).collect());
        table.series.push(Series::new("x", Values::Trajectory(values)));
        for entry in results::FORMATS {
            let format = results::format(entry.name).unwrap();
            prop_assert_eq!(&format.read(&format.write(&table).unwrap()).unwrap(), &table);
        }
    }

    #[test]
    fn damaged_results_never_panic(at in any::<prop::sample::Index>(), value in any::<u8>()) {
        let format = results::format("mat").unwrap();
        let mut bytes = format.write(&example()).unwrap();
        let at = at.index(bytes.len());
        bytes[at] = value;
        if let Ok(table) = format.read(&bytes) {
            columns(&table);
        }
    }
}
