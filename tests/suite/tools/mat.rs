//! Matrices in files: against files of other programs, an independent reader, and damage.

use gapilib::Fault;
use gapilib::internals::mat::{self, MatFile, Matrix, MatrixKind, Storage, Version};
use proptest::prelude::*;
use std::path::PathBuf;

const A: [f64; 6] = [1.5, 4.0, -2.0, 5.0, 3.25, -6.5];

fn data(name: &str) -> Vec<u8> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/mat").join(name);
    std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn open(name: &str) -> MatFile {
    mat::read(&data(name)).unwrap_or_else(|fault| panic!("{name}: {fault}"))
}

#[track_caller]
fn is_a(file: &MatFile, name: &str, change: fn(f64) -> f64) {
    let matrix = file.matrix(name).unwrap();
    assert_eq!((matrix.rows, matrix.columns), (2, 3), "{name}");
    assert_eq!(matrix.values, A.map(change), "{name}");
}

fn message(result: Result<MatFile, Fault>) -> String {
    result.expect_err("the file is refused").message
}

#[track_caller]
fn holds_plain_matrices(file: &MatFile) {
    is_a(file, "A", |a| a);
    let x = file.matrix("x").unwrap();
    assert_eq!((x.rows, x.columns, &*x.values), (5, 1, &[0.0, 0.25, 0.5, 0.75, 1.0][..]));
    assert_eq!(file.matrix("scalar").unwrap().values, [42.0]);
    let text = file.matrix("text").unwrap();
    assert_eq!((text.kind, text.row_strings()), (MatrixKind::Char, vec!["hello".to_owned()]));
}

#[test]
fn reads_version_4_of_scipy_and_octave() {
    for name in ["scipy_v4.mat", "octave_v4.mat"] {
        let file = open(name);
        assert_eq!(file.version, Version::V4);
        holds_plain_matrices(&file);
    }
    assert!(open("scipy_v4.mat").matrix("empty").unwrap().values.is_empty());
    let octave = open("octave_v4.mat");
    assert_eq!(octave.matrix("r").unwrap().values, [1.0, 2.0, 3.0, 4.0]);
    assert_eq!(octave.matrix("names").unwrap().row_strings(), ["one", "three"]);
}

#[test]
fn reads_every_number_type_of_version_4() {
    let file = open("scipy_v4_types.mat");
    is_a(&file, "f4", |a| a);
    is_a(&file, "i4", f64::trunc);
    is_a(&file, "i2", f64::trunc);
    is_a(&file, "u2", |a| a.abs().trunc());
    is_a(&file, "u1", |a| a.abs().trunc());
    assert_eq!(file.matrix("names").unwrap().row_strings(), ["one", "three"]);
    assert_eq!(file.matrix("z").unwrap_err().code, mat::errors::UNREADABLE_MATRIX);
    assert_eq!(file.warnings, ["`z` is skipped: it is complex; save only its real part"]);
}

#[test]
fn reads_version_4_in_the_other_byte_order_and_by_rows() {
    let big = open("raw_v4_big_endian.mat");
    is_a(&big, "A", |a| a);
    is_a(&big, "f4", |a| a);
    is_a(&big, "i4", f64::trunc);
    is_a(&big, "i2", f64::trunc);
    is_a(&big, "u2", |a| a.abs().trunc());
    assert_eq!(big.matrix("text").unwrap().row_strings(), ["hello"]);
    let rows = open("raw_v4_rows.mat");
    is_a(&rows, "A", |a| a);
    is_a(&rows, "f4", |a| a);
    assert!(rows.matrix("sparse").unwrap_err().message.contains("sparse"));
    assert_eq!(rows.matrix("last").unwrap().values, [8.0]);
}

#[test]
fn reads_versions_5_and_7_of_scipy() {
    for name in ["scipy_v5.mat", "scipy_v7.mat"] {
        let file = open(name);
        assert_eq!(file.version, Version::V5);
        holds_plain_matrices(&file);
        is_a(&file, "f4", |a| a);
        ["i1", "i2", "i4", "i8"].iter().for_each(|i| is_a(&file, i, f64::trunc));
        ["u1", "u2", "u4", "u8"].iter().for_each(|u| is_a(&file, u, |a| a.abs().trunc()));
        is_a(&file, "flag", |a| f64::from(a > 0.0));
        assert_eq!(file.matrix("flag").unwrap().kind, MatrixKind::Logical);
        assert_eq!(file.matrix("names").unwrap().row_strings(), ["one", "three"]);
        assert_eq!(file.matrix("accent").unwrap().row_strings(), ["été η"]);
        is_a(&file, "s.a", |a| a);
        assert_eq!(file.matrix("s.b.c").unwrap().values, [7.0]);
        assert_eq!(file.matrix("s.t").unwrap().row_strings(), ["inner"]);
        is_a(&file, "cell{1}", |a| a);
        assert_eq!(file.matrix("cell{2}").unwrap().row_strings(), ["x"]);
        assert_eq!(file.column("many(2).a").unwrap().values, [2.0]);
        assert_eq!(file.column("many[1].a").unwrap().values, [1.0]);
        for (name, element) in [("cell", "`cell{1}`"), ("many", "`many(1)`")] {
            let fault = file.matrix(name).unwrap_err();
            assert_eq!(fault.code, mat::errors::UNREADABLE_MATRIX, "{name}");
            assert!(fault.helps.iter().any(|help| help.contains(element)), "{:?}", fault.helps);
        }
        for name in ["cube", "z", "sparse"] {
            let fault = file.matrix(name).unwrap_err();
            assert_eq!(fault.code, mat::errors::UNREADABLE_MATRIX, "{name}");
            assert!(file.warnings.iter().any(|w| w.starts_with(&format!("`{name}` is skipped"))));
        }
        assert!(file.warnings.contains(&"integers of `big` beyond 2^53 are rounded".to_owned()));
        assert_eq!(file.warnings.len(), 4, "{:?}", file.warnings);
    }
}

#[test]
fn reads_versions_6_and_7_of_octave() {
    for name in ["octave_v6.mat", "octave_v7.mat"] {
        let file = open(name);
        holds_plain_matrices(&file);
        is_a(&file, "f4", |a| a);
        is_a(&file, "flag", |a| f64::from(a > 0.0));
        is_a(&file, "i2", f64::round);
        assert_eq!(file.matrix("r").unwrap().values, [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(file.matrix("names").unwrap().row_strings(), ["one", "three"]);
        is_a(&file, "s.a", |a| a);
        assert_eq!(file.matrix("s.b.c").unwrap().values, [7.0]);
        let mut skipped: Vec<&str> =
            file.warnings.iter().map(|w| &w[..w.find(" is").unwrap()]).collect();
        skipped.sort_unstable();
        assert_eq!(skipped, ["`sp`", "`z`"]);
    }
}

#[test]
fn measured_values_are_vectors_or_rows_and_columns() {
    let file = open("scipy_v5.mat");
    let values = |name: &str| file.column(name).map(|column| column.values);
    assert_eq!(values("x").unwrap(), [0.0, 0.25, 0.5, 0.75, 1.0]);
    assert_eq!(values("A[:,2]").unwrap(), [-2.0, 5.0]);
    assert_eq!(values("A[2,:]").unwrap(), [4.0, 5.0, -6.5]);
    assert_eq!(values("A(1, :)").unwrap(), [1.5, -2.0, 3.25]);
    assert_eq!(values("s.a[2,:]").unwrap(), [4.0, 5.0, -6.5]);
    assert_eq!(values("cell{1}[:,1]").unwrap(), [1.5, 4.0]);
    let refused = |name: &str| {
        let fault = values(name).unwrap_err();
        format!("{} {}", fault.message, fault.helps.join(" "))
    };
    assert!(refused("A").contains("2 rows and 3 columns") && refused("A").contains("`A[:,1]`"));
    assert!(refused("A[3,:]").contains("no row 3; it has 2"));
    assert!(refused("A[:,4]").contains("no column 4; it has 3"));
    assert!(refused("text").contains("contains text"));
}

#[test]
fn reads_version_5_in_the_other_byte_order() {
    let file = open("raw_v5_big_endian.mat");
    is_a(&file, "A", |a| a);
    assert_eq!(file.matrix("b").unwrap().values, [7.0, 9.0]);
}

#[test]
fn refuses_what_it_does_not_read_and_says_what_to_do() {
    let mut version_7_3 = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".to_vec();
    version_7_3.resize(600, 0);
    let fault = mat::read(&version_7_3).unwrap_err();
    assert_eq!(fault.code, mat::errors::BAD_MAT_FILE);
    assert_eq!(fault.helps, ["save it with `save -v7 file.mat`"]);
    for bytes in [data("octave_hdf5.mat"), data("octave_text.mat")] {
        let fault = mat::read(&bytes).unwrap_err();
        assert_eq!(fault.code, mat::errors::UNSUPPORTED_MAT_FILE);
        assert_eq!(fault.helps, ["save it with `save -v7 file.mat`"]);
    }
    assert_eq!(message(mat::read(&2000u32.to_le_bytes())), "the numbers are in VAX or Cray format");
    assert_eq!(message(mat::read(b"")), "the file is empty");
    assert_eq!(message(mat::read(b"model M end M;")), "the file is not a MAT file");
}

#[test]
fn reads_version_7_3() {
    let file = open("h5py_v73.mat");
    assert_eq!(file.version, Version::V73);
    is_a(&file, "A", |a| a);
    is_a(&file, "f4", |a| a);
    is_a(&file, "i2", f64::trunc);
    is_a(&file, "u8", |a| a.abs().trunc());
    is_a(&file, "flag", |a| f64::from(a > 0.0));
    assert_eq!(file.matrix("flag").unwrap().kind, MatrixKind::Logical);
    assert_eq!(file.matrix("text").unwrap().row_strings(), ["hello"]);
    assert!(file.matrix("empty").unwrap().values.is_empty());
    assert_eq!(file.matrix("run.t").unwrap().values, [0.0, 1.0, 2.0]);
    for name in ["shuffled", "checked"] {
        let matrix = file.matrix(name).unwrap();
        assert_eq!((matrix.rows, matrix.columns), (300, 2));
        let t: Vec<f64> = (0..300).map(|k| f64::from(k) / 10.0).collect();
        assert_eq!(matrix.column(0), t, "{name}");
        assert_eq!(file.column(&format!("{name}[:,2]")).unwrap().values[299], 29.9 * 29.9);
    }
    for (name, reason) in
        [("z", "complex"), ("cube", "dimensions"), ("cell", "cell"), ("sparse", "sparse")]
    {
        let fault = file.matrix(name).unwrap_err();
        assert_eq!(fault.code, mat::errors::UNREADABLE_MATRIX, "{name}");
        assert!(fault.message.contains(reason), "{}", fault.message);
    }
    assert_eq!(file.matrix("data[:,2]").unwrap_err().code, mat::errors::UNKNOWN_MATRIX);
}

#[test]
fn a_matrix_of_version_7_3_that_claims_more_than_the_limit_takes_no_memory() {
    let mut bytes = data("h5py_v73.mat");
    // The dimensions of A in its dataspace message: 3 and 2, as 64-bit numbers.
    let sizes: Vec<u8> = [3u64, 2].iter().flat_map(|n| n.to_le_bytes()).collect();
    let at = bytes.windows(16).position(|window| window == sizes).unwrap();
    bytes[at..at + 8].copy_from_slice(&(1u64 << 40).to_le_bytes());
    let read = mat::read(&bytes);
    assert!(read.is_err() || read.unwrap().matrix("A").is_err());
}

#[test]
fn unknown_matrix_is_answered_with_the_nearest_name() {
    let fault = open("scipy_v4.mat").matrix("scaler").unwrap_err();
    assert_eq!(fault.code, mat::errors::UNKNOWN_MATRIX);
    assert_eq!(fault.helps[0], "did you mean `scalar`?");
    assert_eq!(fault.helps[1], "the file contains `A`, `x`, `scalar`, `empty`, `text`");
}

#[test]
fn a_hostile_size_takes_no_memory() {
    let record = |rows: u32, columns: u32| {
        let header = [0, rows, columns, 0, 2];
        let mut bytes: Vec<u8> = header.iter().flat_map(|n| n.to_le_bytes()).collect();
        bytes.extend(b"A\0");
        message(mat::read(&bytes))
    };
    assert_eq!(
        record(1 << 30, 2),
        "the file ends too early: matrix `A` needs 17179869184 bytes, 0 remain"
    );
    assert_eq!(
        record(i32::MAX as u32, i32::MAX as u32),
        "matrix `A` claims 4611686014132420609 values"
    );
    assert_eq!(record(0, 1 << 30), "matrix `A` claims 0 rows and 1073741824 columns");
    assert_eq!(record(u32::MAX, 1), "a matrix claims a negative size");
}

#[test]
fn a_compressed_bomb_is_refused() {
    use flate2::write::ZlibEncoder;
    use std::io::Write;
    let mut encoder = ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    let zeros = vec![0; 1 << 20];
    for _ in 0..=mat::MAX_INFLATED >> 20 {
        encoder.write_all(&zeros).unwrap();
    }
    let packed = encoder.finish().unwrap();
    let mut bytes = mat::write_v5([]).unwrap();
    bytes.extend(15u32.to_le_bytes());
    bytes.extend((packed.len() as u32).to_le_bytes());
    bytes.extend(packed);
    assert_eq!(message(mat::read(&bytes)), "the compressed data inflate to more than 256 MiB");
}

#[test]
fn deeply_nested_structures_are_refused() {
    let element = |kind: u32, data: &[u8]| {
        let mut out = Vec::new();
        out.extend(kind.to_le_bytes());
        out.extend((data.len() as u32).to_le_bytes());
        out.extend(data);
        out.resize(out.len().next_multiple_of(8), 0);
        out
    };
    let mut inner = Vec::new();
    for _ in 0..40 {
        let mut body = element(6, &[2, 0, 0, 0, 0, 0, 0, 0]);
        body.extend(element(5, &[1, 0, 0, 0, 1, 0, 0, 0]));
        body.extend(element(1, b"s"));
        body.extend(element(5, &[2, 0, 0, 0]));
        body.extend(element(1, b"f\0"));
        body.extend(element(14, &inner));
        inner = body;
    }
    let mut bytes = mat::write_v5([]).unwrap();
    bytes.extend(element(14, &inner));
    assert_eq!(message(mat::read(&bytes)), "structures are nested deeper than 32 levels");
}

#[test]
fn reads_text_matrices() {
    let text = "#1\n# a comment\ndouble x(2,3) # declared\n1 2.5e1,3\n 4;5\t-6\nchar s(2,5)\nab\nhello\nfloat empty(0,2)\n";
    let file = mat::read(text.as_bytes()).unwrap();
    assert_eq!(file.version, Version::Text);
    assert_eq!(file.matrix("x").unwrap().row_major(), [1.0, 25.0, 3.0, 4.0, 5.0, -6.0]);
    assert_eq!(file.matrix("s").unwrap().row_strings(), ["ab", "hello"]);
    assert_eq!(file.matrix("empty").unwrap().columns, 2);
}

#[test]
fn malformed_text_matrices_are_answered_with_line_and_column() {
    let refused = |text: &str| message(mat::read(text.as_bytes()));
    assert_eq!(refused("#1\ndouble x(1,2)\n1 two\n"), "line 3, column 3: `two` is not a number");
    assert_eq!(refused("#1\ndouble x(1,1)\n1 2\n"), "line 3, column 3: `x` has only 1 numbers");
    assert_eq!(
        refused("#1\ndouble x(2,2)\n1 2\n"),
        "`x` has 2 numbers, but 4 are declared in line 2"
    );
    assert_eq!(refused("#1\nreal x\n"), "line 2, column 1: `real x` does not declare a matrix");
    assert!(refused("#1\ndouble x(18446744073709551615,2)\n1\n").contains("claims"));
}

#[test]
fn reads_tables() {
    let table = mat::read_named(
        "a.CSV",
        b"\xef\xbb\xbf# made by hand\r\n\"i, A\",V\r\n 0.1 ,9e-1\r\n0.2,NaN\r\n",
    )
    .unwrap();
    assert_eq!(table.version, Version::Csv);
    assert_eq!(table.matrix("i, A").unwrap().values, [0.1, 0.2]);
    assert!(table.matrix("V").unwrap().values[1].is_nan());
    let european = mat::read_csv(b"i;V\n0,1;0,95\n").unwrap();
    assert_eq!(european.matrix("V").unwrap().values, [0.95]);
    assert_eq!(table.matrix("v").unwrap_err().message, "`a.CSV` has no column `v`");
}

#[test]
fn malformed_tables_are_answered_with_line_and_column() {
    let refused = |text: &str| message(mat::read_csv(text.as_bytes()));
    assert_eq!(refused("x,y\n1,2\n3,4 V\n"), "line 3, column 2: `4 V` in `y` is not a number");
    assert_eq!(refused("x,y\n1,\n"), "line 2, column 2: `y` has an empty cell");
    assert_eq!(refused("x,y\n1\n"), "line 2, column 2: 1 cells where the header has 2");
    assert_eq!(refused("x,y\n1,2,3\n"), "line 2, column 3: 3 cells where the header has 2");
    assert_eq!(refused("x,x\n1,2\n"), "two columns are named `x`: columns 1 and 2");
    assert_eq!(refused("x,\n1,2\n"), "line 2, column 2: 2 cells where the header has 1");
    assert_eq!(
        refused("1,2\n3,4\n"),
        "line 1, column 1: the first line contains numbers instead of column names"
    );
    assert_eq!(
        refused("i;V\n0,1;1\n0.2;2\n"),
        "line 3, column 1: `0.2` in `i` has a different decimal separator from `0,1` in line 2"
    );
    assert_eq!(refused(""), "the file is empty");
}

#[test]
fn an_independent_reader_reads_version_5() {
    for (from, bytes) in [
        ("ours", written_v5()),
        ("octave", data("octave_v6.mat")),
        ("scipy", data("scipy_v7_numbers.mat")),
    ] {
        let theirs =
            matfile::MatFile::parse(&*bytes).unwrap_or_else(|error| panic!("{from}: {error}"));
        let ours = mat::read(&bytes).unwrap();
        for name in ["A", "x"] {
            let found = theirs.find_by_name(name).unwrap();
            let matrix = ours.matrix(name).unwrap();
            assert_eq!(found.size(), &vec![matrix.rows, matrix.columns]);
            match found.data() {
                matfile::NumericData::Double { real, imag: None } => {
                    assert_eq!(real, &matrix.values)
                }
                other => panic!("{name} is {other:?}"),
            }
        }
    }
}

fn written_v5() -> Vec<u8> {
    let a = Matrix::from_columns(2, 3, A.to_vec());
    let x = Matrix::column_vector(vec![0.0, -1e300]);
    mat::write_v5([("A", &a), ("x", &x)]).unwrap()
}

#[test]
fn what_a_format_cannot_hold_is_refused() {
    let x = Matrix::column_vector(vec![0.5]);
    for name in ["", "1x", "s.a", "a b", &"x".repeat(64)] {
        for fault in [mat::write_v4([(name, &x)]), mat::write_v5([(name, &x)])] {
            assert_eq!(fault.unwrap_err().code, mat::errors::UNWRITABLE_MATRIX);
        }
    }
    let mut out = Vec::new();
    let fault = mat::append_v4(&mut out, "x", &x, Storage::I32).unwrap_err();
    assert_eq!(fault.message, "`x` cannot store the value 0.5");
    assert!(mat::append_v4(&mut out, "x", &x, Storage::U64).is_err());
    assert!(out.is_empty());
}

fn matrices() -> impl Strategy<Value = Matrix> {
    let number =
        prop_oneof![any::<f64>().prop_filter("equal to itself", |x| !x.is_nan()), Just(0.5)];
    let numeric = (0usize..5, 0usize..5).prop_flat_map(move |(rows, columns)| {
        proptest::collection::vec(number.clone(), rows * columns)
            .prop_map(move |values| Matrix::from_columns(rows, columns, values))
    });
    let text =
        proptest::collection::vec("[ -~]{0,6}", 0..4).prop_map(|lines| Matrix::from_text(&lines));
    prop_oneof![numeric, text]
}

fn damaged() -> impl Strategy<Value = Vec<u8>> {
    const FILES: [&str; 8] = [
        "scipy_v4.mat",
        "scipy_v5.mat",
        "scipy_v7.mat",
        "octave_v7.mat",
        "raw_v4_rows.mat",
        "raw_v4_big_endian.mat",
        "raw_v5_big_endian.mat",
        "octave_v6.mat",
    ];
    let changes = proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6);
    (0..FILES.len(), changes, any::<prop::sample::Index>(), any::<bool>()).prop_map(
        |(file, changes, end, cut)| {
            let mut bytes = data(FILES[file]);
            for (at, value) in changes {
                let at = at.index(bytes.len());
                bytes[at] = value;
            }
            if cut {
                bytes.truncate(end.index(bytes.len()));
            }
            bytes
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn writing_and_reading_is_the_identity(first in matrices(), second in matrices()) {
        let arrays = || [("first", &first), ("b_2", &second)];
        for bytes in [mat::write_v4(arrays()).unwrap(), mat::write_v5(arrays()).unwrap()] {
            let file = mat::read(&bytes).unwrap();
            prop_assert_eq!(file.matrix("first").unwrap(), &first);
            prop_assert_eq!(file.matrix("b_2").unwrap(), &second);
            prop_assert!(file.warnings.is_empty());
        }
    }

    #[test]
    fn damage_never_panics(bytes in damaged()) {
        if let Ok(file) = mat::read(&bytes) {
            for matrix in file.arrays.values() {
                prop_assert_eq!(matrix.values.len(), matrix.rows * matrix.columns);
                matrix.row_strings();
            }
        }
    }

    #[test]
    fn every_truncation_is_an_error_or_fewer_matrices(end in any::<prop::sample::Index>()) {
        let bytes = data("scipy_v5.mat");
        let whole = mat::read(&bytes).unwrap();
        if let Ok(part) = mat::read(&bytes[..end.index(bytes.len())]) {
            let told = |file: &mat::MatFile| file.arrays.len() + file.warnings.len();
            prop_assert!(told(&part) < told(&whole));
        }
    }

    #[test]
    fn any_text_is_read_or_refused(text in "(#1\n)?(double |char )?[a-z0-9(),;\"\n#.]{0,60}") {
        let _ = mat::read(text.as_bytes());
        let _ = mat::read_csv(text.as_bytes());
        let _ = mat::read_named("a.txt", text.as_bytes());
    }

    #[test]
    fn damaged_version_7_3_never_panics(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        end in any::<prop::sample::Index>(),
        cut in any::<bool>(),
    ) {
        let mut bytes = data("h5py_v73.mat");
        let length = bytes.len();
        changes.iter().for_each(|(at, value)| bytes[at.index(length)] = *value);
        if cut {
            bytes.truncate(end.index(length));
        }
        let _ = mat::read(&bytes);
    }

    #[test]
    fn tables_in_any_manner_are_read_or_refused(
        text in "([tTU iI\\[\\]/sVm;,\t.\"#%0-9eE:\\-+'a\n]{0,20}\n){0,8}"
    ) {
        if let Ok(file) = mat::read_named("a.dat", text.as_bytes()) {
            for name in file.arrays.keys() {
                prop_assert!(file.column(name).is_ok());
            }
        }
    }
}

/// An archive of entries that are not compressed (APPNOTE of PKZIP, 4.3).
fn archive(entries: &[(&str, &str)]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in entries {
        let mut crc = flate2::Crc::new();
        crc.update(content.as_bytes());
        let offset = bytes.len() as u32;
        // Version, flags, method, time and date.
        let mut header = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
        header.extend(crc.sum().to_le_bytes());
        header.extend([(content.len() as u32).to_le_bytes(); 2].concat());
        header.extend([name.len() as u8, 0, 0, 0]);
        bytes.extend([b"PK\x03\x04", &header[..], name.as_bytes(), content.as_bytes()].concat());
        directory.extend([b"PK\x01\x02\x14\0", &header[..], &[0; 10][..]].concat());
        directory.extend([&offset.to_le_bytes()[..], name.as_bytes()].concat());
    }
    let (count, start) = (entries.len() as u16, bytes.len() as u32);
    let ends = [count.to_le_bytes(), count.to_le_bytes()].concat();
    let size = (directory.len() as u32).to_le_bytes();
    bytes.extend([&directory[..], b"PK\x05\x06\0\0\0\0", &ends, &size].concat());
    bytes.extend([&start.to_le_bytes()[..], &[0, 0]].concat());
    bytes
}

/// A book with these rows in its only sheet, and this shared text.
fn book(rows: &str, text: &str) -> Vec<u8> {
    const MAIN: &str = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    const OFFICE: &str = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    const PACKAGE: &str = "http://schemas.openxmlformats.org/package/2006";
    let relation = |id: &str, kind: &str, target: &str| {
        format!("<Relationship Id=\"{id}\" Type=\"{OFFICE}/{kind}\" Target=\"{target}\"/>")
    };
    let relations = |all: &str| {
        format!("<Relationships xmlns=\"{PACKAGE}/relationships\">{all}</Relationships>")
    };
    archive(&[
        ("[Content_Types].xml", &format!("<Types xmlns=\"{PACKAGE}/content-types\"/>")),
        ("_rels/.rels", &relations(&relation("rId1", "officeDocument", "xl/workbook.xml"))),
        (
            "xl/workbook.xml",
            &format!(
                "<workbook xmlns=\"{MAIN}\" xmlns:r=\"{OFFICE}\"><sheets><sheet name=\"S\" \
                 sheetId=\"1\" r:id=\"rId1\"/></sheets></workbook>"
            ),
        ),
        (
            "xl/_rels/workbook.xml.rels",
            &relations(
                &(relation("rId1", "worksheet", "worksheets/sheet1.xml")
                    + &relation("rId2", "sharedStrings", "sharedStrings.xml")),
            ),
        ),
        ("xl/sharedStrings.xml", &format!("<sst xmlns=\"{MAIN}\"><si><t>{text}</t></si></sst>")),
        (
            "xl/worksheets/sheet1.xml",
            &format!("<worksheet xmlns=\"{MAIN}\"><sheetData>{rows}</sheetData></worksheet>"),
        ),
    ])
}

/// Twenty cells share a text of 16 MiB.
#[test]
fn texts_that_cells_share_are_counted_as_often_as_they_are_read() {
    let rows: String = (1..=20)
        .map(|row| format!("<row r=\"{row}\"><c r=\"A{row}\" t=\"s\"><v>0</v></c></row>"))
        .collect();
    let large = book(&rows, &"a".repeat(16 << 20));
    let message = mat::read_named("large.xlsx", &large).unwrap_err().message;
    assert_eq!(message, "`large.xlsx`: the cells of the sheet `S` contain more than 256 MiB");
}

/// With 32 bits, MWLQKWW2 is A2, and row 4294967299 is row 3.
#[test]
fn references_outside_of_all_spreadsheets_are_no_other_cells() {
    let read = |second: &str, third: &str| {
        let rows = format!(
            "<row r=\"1\"><c r=\"A1\" t=\"s\"><v>0</v></c></row><row r=\"2\"><c r=\"{second}\">\
             <v>5</v></c></row><row r=\"{third}\"><c><v>7</v></c></row>"
        );
        mat::read_named("data.xlsx", &book(&rows, "U"))
    };
    assert_eq!(read("A2", "3").unwrap().matrix("U").unwrap().values, [5.0, 7.0]);
    for (second, third, shown) in [("MWLQKWW2", "3", "MWLQ"), ("A2", "4294967299", "4294967")] {
        let message = read(second, third).unwrap_err().message;
        let expected = format!("a cell reference that begins with `{shown}`");
        assert!(message.contains(&expected), "{message}");
    }
}
