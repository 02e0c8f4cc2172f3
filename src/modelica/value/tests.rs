//! Operations on arrays against the definitions, element by element.

use super::construct::{self, Range};
use super::show::{Style, quoted, real, show, six_digits};
use super::{ArrayValue, Elements, FromValue, Index, RealMatrix, RecordValue, Value, format, ops};
use crate::name::{Ident, Name};
use proptest::prelude::*;

fn matrix(rows: usize, columns: usize, elements: Vec<f64>) -> Value {
    Value::Array(ArrayValue::matrix(rows, columns, elements))
}

fn matrices() -> impl Strategy<Value = (usize, usize, Vec<f64>)> {
    (1usize..5, 1usize..5).prop_flat_map(|(rows, columns)| {
        let elements = proptest::collection::vec(-100.0..100.0f64, rows * columns);
        (Just(rows), Just(columns), elements)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_matrix_product_is_the_sums_of_products((m, n, a) in matrices(), p in 1usize..5, seed in -50.0..50.0f64) {
        let b: Vec<f64> = (0..n * p).map(|at| seed + at as f64 * 0.75).collect();
        let product = ops::multiply(&matrix(m, n, a.clone()), &matrix(n, p, b.clone())).unwrap();
        let product = RealMatrix::from_value(product).unwrap();
        prop_assert_eq!((product.rows, product.columns), (m, p));
        for i in 0..m {
            for j in 0..p {
                let expected: f64 = (0..n).map(|k| a[i * n + k] * b[k * p + j]).sum();
                let scale: f64 = (0..n).map(|k| (a[i * n + k] * b[k * p + j]).abs()).sum();
                prop_assert!((product.row(i)[j] - expected).abs() <= 1e-12 * (1.0 + scale));
            }
        }
    }

    #[test]
    fn what_is_assigned_to_a_slice_is_read_from_it((m, n, a) in matrices(), row in 0usize..4, new in -1.0..1.0f64) {
        let row = row % m + 1;
        let mut array = ArrayValue::matrix(m, n, a.clone());
        let subscripts = [Index::One(row as i64), Index::All];
        array.assign(&subscripts, Value::reals(vec![new; n])).unwrap();
        prop_assert_eq!(array.select(&subscripts).unwrap(), Value::reals(vec![new; n]));
        let Elements::Real(after) = &array.elements else { panic!("still Real") };
        for at in 0..m * n {
            let expected = if at / n + 1 == row { new } else { a[at] };
            prop_assert_eq!(after[at], expected);
        }
    }

    #[test]
    fn splitting_undoes_shaping((m, n, a) in matrices()) {
        let whole = matrix(m, n, a);
        let rows = construct::split(&[m], whole.clone()).unwrap();
        prop_assert_eq!(rows.len(), m);
        prop_assert_eq!(construct::array(rows).unwrap(), whole.clone());
        let scalars = construct::split(&[m, n], whole.clone()).unwrap();
        prop_assert_eq!(construct::shaped(&[m, n], scalars).unwrap(), whole);
    }

    #[test]
    fn concatenated_rows_and_columns_are_found_again((m, n, a) in matrices(), extra in 1usize..4) {
        let left = matrix(m, n, a);
        let right = matrix(m, extra, vec![0.5; m * extra]);
        let joined = construct::cat(2, vec![left.clone(), right.clone()]).unwrap();
        let Value::Array(joined) = joined else { panic!("an array") };
        let columns = |from: usize, to: usize| Index::Many((from as i64..=to as i64).collect());
        prop_assert_eq!(joined.select(&[Index::All, columns(1, n)]).unwrap(), left);
        prop_assert_eq!(joined.select(&[Index::All, columns(n + 1, n + extra)]).unwrap(), right);
    }

    #[test]
    fn reals_read_back_equal(x in any::<f64>().prop_filter("finite", |x| x.is_finite())) {
        let text = real(x);
        prop_assert!(text.contains(['.', 'e']));
        prop_assert_eq!(text.parse::<f64>().unwrap().to_bits(), x.to_bits());
    }

    #[test]
    fn six_digits_are_within_half_a_unit_of_the_sixth(x in -1e12..1e12f64) {
        let shown: f64 = six_digits(x).parse().unwrap();
        prop_assert!((shown - x).abs() <= 5.0001e-6 * x.abs());
    }

    #[test]
    fn ranges_stay_within_their_bound(start in -10.0..10.0f64, step in 0.01..3.0f64, count in 0usize..50) {
        let stop = start + step * count as f64;
        let range = Range::new(&Value::Real(start), Some(&Value::Real(step)), &Value::Real(stop)).unwrap();
        prop_assert_eq!(range.count(), count + 1);
        let last = range.get(count).as_real().unwrap();
        prop_assert!(last <= stop && stop - last < 1e-9);
    }

    #[test]
    fn integer_operations_are_exact_or_refused(a in any::<i64>(), b in any::<i64>()) {
        let (left, right) = (Value::Integer(a), Value::Integer(b));
        let exact = i128::from(a) + i128::from(b);
        match ops::add(&left, &right) {
            Ok(sum) => prop_assert_eq!(sum, Value::Integer(i64::try_from(exact).unwrap())),
            Err(_) => prop_assert!(i64::try_from(exact).is_err()),
        }
        let exact = i128::from(a) * i128::from(b);
        match ops::multiply(&left, &right) {
            Ok(product) => prop_assert_eq!(product, Value::Integer(i64::try_from(exact).unwrap())),
            Err(_) => prop_assert!(i64::try_from(exact).is_err()),
        }
    }
}

#[test]
fn matrix_powers_are_repeated_products() {
    let a = matrix(2, 2, vec![1.0, 1.0, 1.0, 0.0]);
    let tenth = ops::power(&a, &Value::Integer(10)).unwrap();
    assert_eq!(tenth, matrix(2, 2, vec![89.0, 55.0, 55.0, 34.0]));
    assert_eq!(ops::power(&a, &Value::Integer(0)).unwrap(), matrix(2, 2, vec![1.0, 0.0, 0.0, 1.0]));
    assert!(ops::power(&a, &Value::Integer(-1)).is_err());
    assert!(ops::power(&matrix(1, 2, vec![1.0, 2.0]), &Value::Integer(2)).is_err());
}

#[test]
fn rows_columns_and_vectors_are_vectors_of_reals() {
    let expected = vec![1.0, 2.0, 3.0];
    assert_eq!(Value::reals(expected.clone()).as_vector().unwrap(), expected);
    assert_eq!(matrix(1, 3, expected.clone()).as_vector().unwrap(), expected);
    assert_eq!(matrix(3, 1, expected.clone()).as_vector().unwrap(), expected);
    assert_eq!(Value::from(vec![1i64, 2, 3]).as_vector().unwrap(), expected);
    assert!(matrix(2, 2, vec![0.0; 4]).as_vector().is_err());
    assert!(Value::from("a").as_vector().is_err());
}

#[test]
fn only_an_integer_becomes_real() {
    assert_eq!(f64::from_value(Value::Integer(2)).unwrap(), 2.0);
    assert!(i64::from_value(Value::Real(2.0)).is_err());
    assert!(String::from_value(Value::Integer(2)).is_err());
    assert!(bool::from_value(Value::Integer(1)).is_err());
    assert!(usize::from_value(Value::Integer(-1)).is_err());
    assert_eq!(Vec::<String>::from_value(Value::reals(vec![])).unwrap(), Vec::<String>::new());
}

#[test]
fn dymola_style_writes_matrices_with_rows_on_lines() {
    let shown = |value: &Value| show(value, Style::Dymola);
    assert_eq!(shown(&matrix(2, 2, vec![1.0, 2.5, -3.0, 1e-7])), "[1.0, 2.5;\n-3.0, 1e-7]");
    assert_eq!(shown(&Value::reals(vec![6.213412958654301, 1.0])), "{6.213412958654301, 1.0}");
    assert_eq!(shown(&Value::reals(vec![])), "{}");
    assert_eq!(shown(&matrix(0, 3, vec![])), "fill(0.0, 0, 3)");
    assert_eq!(shown(&Value::Tuple(vec![true.into(), 1.5.into()])), "true, 1.5");
    assert_eq!(shown(&"a\"b\n".into()), "\"a\\\"b\\n\"");
    assert_eq!(show(&Value::Real(1.0 / 3.0), Style::Transcript), "0.333333");
    assert_eq!(show(&Value::Real(2e-12), Style::Transcript), "2e-12");
    assert_eq!(show(&Value::Real(120.0), Style::Transcript), "120.0");
    assert_eq!(quoted("C:\\x\n", false), "\"C:\\\\x\n\"");
}

#[test]
fn openmodelica_style_writes_records_over_lines() {
    let fields = [("a", 1.5.into()), ("b", 2i64.into()), ("c", "hi".into())];
    let record = Value::Record(RecordValue {
        type_name: Name::parse("R"),
        fields: fields.into_iter().map(|(name, value)| (Ident::new(name), value)).collect(),
    });
    let expected = "record R\n    a = 1.5,\n    b = 2,\n    c = \"hi\"\nend R;";
    assert_eq!(show(&record, Style::OpenModelica), expected);
    assert_eq!(show(&record, Style::Dymola), "R(a = 1.5, b = 2, c = \"hi\")");
}

/// Against the output of C's `printf`.
#[test]
fn formats_are_those_of_c() {
    let shown = |x: f64, f: &str| format::formatted(&Value::Real(x), f).unwrap().to_string();
    assert_eq!(shown(12345.678, "g"), "12345.7");
    assert_eq!(shown(0.00012345, "10.3g"), "  0.000123");
    assert_eq!(shown(1234567.0, "g"), "1.23457e+06");
    assert_eq!(shown(100000.0, "g"), "100000");
    assert_eq!(shown(999999.5, "g"), "1e+06");
    assert_eq!(shown(2.5, "#.3g"), "2.50");
    assert_eq!(shown(-1.5, "08.2f"), "-0001.50");
    assert_eq!(shown(1.5, "+.1e"), "+1.5e+00");
    assert_eq!(shown(1.5e-300, ".2E"), "1.50E-300");
    assert_eq!(shown(f64::INFINITY, "f"), "inf");
    assert_eq!(shown(0.0, "g"), "0");
    for wrong in ["", "5", "q", "1.2.3f", "*f", "99999999999f", "é"] {
        assert!(format::formatted(&Value::Real(1.0), wrong).is_err(), "{wrong}");
    }
}

#[test]
fn subscripts_may_be_booleans_and_vectors() {
    let array = ArrayValue::vector(Elements::Real(vec![1.0, 2.0]));
    let picked = array.select(&[Index::from_value(true.into()).unwrap()]).unwrap();
    assert_eq!(picked, Value::Real(2.0));
    let both = Index::from_value(Value::from(vec![2i64, 1, 2])).unwrap();
    assert_eq!(array.select(&[both]).unwrap(), Value::reals(vec![2.0, 1.0, 2.0]));
    assert!(Index::from_value(Value::Real(1.0)).is_err());
    assert!(array.select(&[Index::One(0)]).is_err());
    assert!(array.select(&[Index::One(i64::MIN)]).is_err());
}

#[test]
fn a_huge_selection_is_refused() {
    let array = ArrayValue::matrix(2, 2, vec![0.0; 4]);
    let many = Index::Many(vec![1; 20_000]);
    assert!(array.select(&[many.clone(), many]).is_err());
}
