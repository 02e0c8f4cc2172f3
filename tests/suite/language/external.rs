//! External functions under their external names: values against independent computations, and
//! models that use them.

use gapilib::Fault;
use gapilib::internals::external::{self, Call, Object, Outside, Slot, SlotKind};
use std::sync::Arc;

/// An argument.
#[derive(Clone)]
pub(super) enum Arg<'a> {
    Number(f64),
    Array(&'a [usize], &'a [f64]),
    Text(&'a str),
    Object(&'a Object),
    /// A text to be written.
    Out,
}

use Arg::{Array, Number, Text};

/// What a call leaves: its result, every number and text after it, and the objects.
#[derive(Debug)]
pub(super) struct Done {
    pub(super) result: f64,
    text: String,
    pub(super) numbers: Vec<f64>,
    written: Vec<Arc<str>>,
    objects: Vec<Object>,
}

/// One file, named `table.txt`.
struct OneFile(&'static str);

impl Outside for OneFile {
    fn read(&mut self, path: &str) -> Result<Vec<u8>, Fault> {
        assert!(path.starts_with("table."), "{path} is wanted");
        Ok(self.0.as_bytes().to_vec())
    }
}

/// A clock that stands still.
struct Clock(u64);

impl Outside for Clock {
    fn unix_seconds(&mut self) -> Result<u64, Fault> {
        Ok(self.0)
    }
}

#[test]
fn the_time_is_a_date_and_a_time_of_day() {
    let at = |seconds: u64| {
        let args = vec![Number(f64::NAN); 7];
        let done = call_with("ModelicaInternal_getTime", &args, &mut Clock(seconds));
        done.expect("a time").numbers[..7].to_vec()
    };
    assert_eq!(at(0), [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1970.0]);
    assert_eq!(at(951_782_399), [0.0, 59.0, 59.0, 23.0, 28.0, 2.0, 2000.0]);
    assert_eq!(at(951_868_799), [0.0, 59.0, 59.0, 23.0, 29.0, 2.0, 2000.0]);
    assert_eq!(at(1_798_761_599), [0.0, 59.0, 59.0, 23.0, 31.0, 12.0, 2026.0]);
    assert_eq!(at(4_107_542_400), [0.0, 0.0, 0.0, 0.0, 1.0, 3.0, 2100.0]);
}

fn call_with(name: &str, args: &[Arg<'_>], outside: &mut dyn Outside) -> Result<Done, Fault> {
    let entry = external::find(name).unwrap_or_else(|| panic!("there is no `{name}`"));
    let (mut numbers, mut texts, mut objects) = (vec![0.0], Vec::<Arc<str>>::new(), Vec::new());
    let mut slots = Vec::new();
    for arg in args {
        let first = numbers.len() as u32;
        let scalar = |kind, first| Slot { kind, first, dims: Box::new([]) };
        slots.push(match arg {
            Number(value) => {
                numbers.push(*value);
                scalar(SlotKind::Number, first)
            }
            Array(dims, values) => {
                numbers.extend(*values);
                let dims = dims.iter().map(|n| *n as u32).collect();
                Slot { kind: SlotKind::Number, first, dims }
            }
            Arg::Object(object) => {
                numbers.push(objects.len() as f64);
                objects.push(Object::clone(object));
                scalar(SlotKind::Object, first)
            }
            Text(text) => {
                texts.push((*text).into());
                scalar(SlotKind::Text, texts.len() as u32 - 1)
            }
            Arg::Out => {
                texts.push("".into());
                scalar(SlotKind::Text, texts.len() as u32 - 1)
            }
        });
    }
    let result = entry.signature.split_once("->").map(|(_, kind)| Slot {
        kind: match kind {
            "o" => SlotKind::Object,
            "t" => SlotKind::Text,
            _ => SlotKind::Number,
        },
        first: if kind == "t" { texts.len() as u32 } else { 0 },
        dims: Box::new([]),
    });
    entry.check(&slots, result.as_ref())?;
    let mut written = Vec::new();
    (entry.run)(&mut Call {
        name: entry.name,
        arguments: &slots,
        result: result.as_ref(),
        numbers: &mut numbers,
        strings: &texts,
        written: &mut written,
        objects: &mut objects,
        outside,
    })?;
    let text = written.last().map_or(String::new(), |(_, text)| text.to_string());
    let result = numbers.remove(0);
    let written = written.into_iter().map(|(_, text)| text).collect();
    Ok(Done { result, text, numbers, written, objects })
}

pub(super) fn call(name: &str, args: &[Arg<'_>]) -> Result<Done, Fault> {
    call_with(name, args, &mut ())
}

#[track_caller]
pub(super) fn near(value: f64, expected: f64) {
    assert!((value - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{value}, not {expected}");
}

const POINTS: [f64; 12] = [0.0, 1.0, 1.0, 3.0, 2.5, 2.0, 3.0, 2.0, 5.0, 5.0, 6.5, 4.0];

/// A table of one variable through [`POINTS`].
fn curve(smoothness: f64, extrapolation: f64) -> Object {
    let made = call(
        "ModelicaStandardTables_CombiTable1D_init2",
        &[
            Text("NoName"),
            Text("NoName"),
            Array(&[6, 2], &POINTS),
            Number(6.0),
            Number(2.0),
            Array(&[1], &[2.0]),
            Number(1.0),
            Number(smoothness),
            Number(extrapolation),
            Number(0.0),
        ],
    );
    made.expect("a table").objects.remove(0)
}

fn at(table: &Object, u: f64) -> f64 {
    let args = [Arg::Object(table), Number(1.0), Number(u)];
    call("ModelicaStandardTables_CombiTable1D_getValue", &args).expect("a value").result
}

fn slope(table: &Object, u: f64) -> f64 {
    let args = [Arg::Object(table), Number(1.0), Number(u), Number(1.0)];
    call("ModelicaStandardTables_CombiTable1D_getDerValue", &args).expect("a slope").result
}

/// What Fritsch-Butland's and Steffen's splines give: on these points they are one.
const MONOTONE: ([f64; 6], [f64; 6]) = (
    [1.726, 2.549925925925926, 2.0, 3.944, 4.496, 4.232],
    [2.66, -0.9955555555555555, 0.0, 2.16, -0.88, -0.8533333333333334],
);

/// Values and slopes at six abscissae, computed with another program.
const SPLINES: [(f64, [f64; 6], [f64; 6]); 4] = [
    (
        2.0,
        [
            1.9304,
            2.5651911111111114,
            1.9630682352941173,
            3.8350374331550814,
            4.818363636363636,
            4.4694545454545445,
        ],
        [
            2.7973333333333334,
            -0.8999111111111109,
            0.03444705882352918,
            1.9734224598930483,
            -0.9463636363636366,
            -1.371818181818182,
        ],
    ),
    (
        6.0,
        [
            1.8528888888888886,
            2.539843007186291,
            1.9569649427282192,
            3.820047768698932,
            4.737662162162162,
            4.390054054054055,
        ],
        [
            2.806137566137566,
            -0.8593792940061595,
            0.03573759111419619,
            1.940911376492772,
            -1.0295270270270276,
            -1.2586486486486486,
        ],
    ),
    (4.0, MONOTONE.0, MONOTONE.1),
    (5.0, MONOTONE.0, MONOTONE.1),
];

#[test]
fn splines_are_those_of_their_authors() {
    for (smoothness, values, slopes) in SPLINES {
        let table = curve(smoothness, 2.0);
        let abscissae = [0.3, 1.7, 2.8, 4.2, 5.9, 6.2];
        for ((u, value), expected) in abscissae.into_iter().zip(values).zip(slopes) {
            near(at(&table, u), value);
            near(slope(&table, u), expected);
        }
        for (point, u) in POINTS.chunks(2).map(|point| (point[1], point[0])) {
            near(at(&table, u), point);
        }
    }
}

#[test]
fn beyond_its_ends_a_table_goes_on_as_it_is_told() {
    let linear = curve(1.0, 2.0);
    near(at(&linear, 0.5), 2.0);
    near(at(&linear, -1.0), -1.0);
    near(at(&linear, 8.0), 3.0);
    let held = curve(1.0, 1.0);
    near(at(&held, -1.0), 1.0);
    near(slope(&held, -1.0), 0.0);
    near(at(&held, 8.0), 4.0);
    let periodic = curve(1.0, 3.0);
    near(at(&periodic, 7.0), at(&linear, 0.5));
    near(at(&periodic, -0.5), at(&linear, 6.0));
    let constant = curve(3.0, 2.0);
    near(at(&constant, 2.4), 3.0);
    near(at(&constant, 2.5), 2.0);
    near(at(&constant, 6.5), 4.0);
    near(at(&constant, 8.0), 3.0);
    let spline = curve(2.0, 2.0);
    near(at(&spline, 7.5), 4.0 + slope(&spline, 6.5));
    let refused = curve(1.0, 4.0);
    let args = [Arg::Object(&refused), Number(1.0), Number(7.0)];
    let fault = call("ModelicaStandardTables_CombiTable1D_getValue", &args).expect_err("refused");
    assert!(fault.message.contains("7 is outside the table range 0 to 6.5"), "{fault}");
}

#[test]
fn tables_that_make_no_sense_are_refused() {
    let init = |table: &[f64], columns: f64| {
        let size = [table.len() / 2, 2];
        let args = [
            Text("NoName"),
            Text("NoName"),
            Array(&size, table),
            Number(size[0] as f64),
            Number(2.0),
            Array(&[1], &[columns]),
            Number(1.0),
            Number(1.0),
        ];
        call("ModelicaStandardTables_CombiTable1D_init", &args).expect_err("refused").message
    };
    assert!(init(&[0.0, 1.0, 0.0, 2.0], 2.0).contains("must increase strictly"));
    assert!(init(&[0.0, 1.0, 1.0, f64::NAN], 2.0).contains("contains NaN"));
    assert!(init(&[0.0, 1.0, 1.0, 2.0], 3.0).contains("no column 3"));
    assert!(init(&[], 2.0).contains("at least one row"));
    let fault = call("ModelicaStrings_length", &[Number(1.0)]).expect_err("different type");
    assert_eq!(fault.code.slug, "external-call");
}

/// A table over time: extrapolation, shift of the abscissa, time events.
fn over_time(points: &[f64], smoothness: f64, extrapolation: f64, events: f64) -> Object {
    let rows = points.len() / 2;
    let args = [
        Text("NoName"),
        Text("NoName"),
        Array(&[rows, 2], points),
        Number(rows as f64),
        Number(2.0),
        Number(0.0),
        Array(&[1], &[2.0]),
        Number(1.0),
        Number(smoothness),
        Number(extrapolation),
        Number(0.5),
        Number(events),
        Number(0.0),
    ];
    let made = call("ModelicaStandardTables_CombiTimeTable_init2", &args);
    made.expect("a table").objects.remove(0)
}

fn next_event(table: &Object, time: f64) -> f64 {
    let args = [Arg::Object(table), Number(time)];
    call("ModelicaStandardTables_CombiTimeTable_nextTimeEvent", &args).expect("a time").result
}

fn at_time(table: &Object, time: f64, next: f64) -> f64 {
    let args = [Arg::Object(table), Number(1.0), Number(time), Number(next), Number(next)];
    call("ModelicaStandardTables_CombiTimeTable_getValue", &args).expect("a value").result
}

#[test]
fn a_time_table_jumps_where_its_event_has_been_handled() {
    let step = [0.0, 0.0, 1.0, 1.0, 1.0, 5.0, 2.0, 5.0];
    let table = over_time(&step, 1.0, 1.0, 1.0);
    near(next_event(&table, 0.0), 0.5);
    near(next_event(&table, 0.5), 1.5);
    near(at_time(&table, 1.0, 1.5), 0.5);
    near(at_time(&table, 1.5, 1.5), 1.0);
    near(at_time(&table, 1.5, 2.5), 5.0);
    near(next_event(&table, 1.5), 2.5);
    assert_eq!(next_event(&table, 2.5), f64::MAX);
    near(at_time(&table, 4.0, f64::MAX), 5.0);
    let jumps = over_time(&step, 1.0, 1.0, 2.0);
    near(next_event(&jumps, 0.0), 1.5);
    assert_eq!(next_event(&jumps, 1.5), f64::MAX);
    assert_eq!(next_event(&over_time(&step, 1.0, 1.0, 3.0), 0.0), f64::MAX);
    let periodic = over_time(&[0.0, 0.0, 1.0, 1.0, 2.0, 0.0], 1.0, 3.0, 1.0);
    near(next_event(&periodic, 2.5), 3.5);
    near(next_event(&periodic, 3.5), 4.5);
    near(at_time(&periodic, 5.0, 5.5), 0.5);
}

#[test]
fn a_period_begins_where_the_last_one_ends() {
    // In constant segments, with jumps at both ends; 1.5 = 1 + shift is reached but for rounding.
    let points = [0.6, -2.0, 0.6, -3.0, 0.7, -2.0, 1.0, -5.0, 1.0, -4.0];
    let table = over_time(&points, 3.0, 3.0, 1.0);
    for time in [1.5, 1.5 + 1e-15, 1.9, 2.3] {
        near(at_time(&table, time, next_event(&table, time)), -3.0);
    }
    near(at_time(&table, 1.65, next_event(&table, 1.65)), -2.0);
}

#[test]
fn a_table_of_two_variables_is_bilinear() {
    let grid = [0.0, 1.0, 3.0, 0.0, 2.0, 4.0, 2.0, 6.0, 16.0];
    let made = |smoothness: f64, extrapolation: f64| {
        let args = [
            Text("NoName"),
            Text("NoName"),
            Array(&[3, 3], &grid),
            Number(3.0),
            Number(3.0),
            Number(smoothness),
            Number(extrapolation),
            Number(0.0),
        ];
        let made = call("ModelicaStandardTables_CombiTable2D_init2", &args);
        made.expect("a table").objects.remove(0)
    };
    let value = |table: &Object, x: f64, y: f64| {
        let args = [Arg::Object(table), Number(x), Number(y)];
        call("ModelicaStandardTables_CombiTable2D_getValue", &args).expect("a value").result
    };
    let table = made(1.0, 2.0);
    near(value(&table, 1.0, 2.0), 7.0);
    near(value(&table, 2.0, 3.0), 16.0);
    // (2 + 2x) + (y - 1)(1 + 2x) is the function on the whole plane.
    near(value(&table, 3.0, -1.0), 8.0 - 2.0 * 7.0);
    near(value(&made(1.0, 1.0), 3.0, -1.0), 6.0);
    near(value(&made(3.0, 2.0), 1.9, 2.9), 2.0);
    let args = [1.0, 2.0, 0.5, 0.25].map(Number);
    let args: Vec<Arg<'_>> = std::iter::once(Arg::Object(&table)).chain(args).collect();
    let derivative = call("ModelicaStandardTables_CombiTable2D_getDerValue", &args);
    near(derivative.expect("a slope").result, 0.5 * 4.0 + 0.25 * 3.0);
}

/// Extrapolation; values, first derivatives in the direction (1, 1/2) and second derivatives with
/// the second rates (1/4, -2) at [`PLACES`], computed with another program.
type Surface = (f64, f64, [f64; 6], [f64; 6], [f64; 6]);

const PLACES: [[f64; 2]; 6] =
    [[0.5, 1.0], [2.7, 2.5], [3.9, 4.8], [5.0, 6.0], [-1.0, 2.5], [1.5, 7.0]];

const SURFACES: [Surface; 4] = [
    (
        2.0,
        2.0,
        [-0.762789089345, 1.02147841106, -0.009800445172, -4.18375, 0.18366951028, 3.469468599034],
        [
            1.292117044019,
            -8.574861203171,
            0.342743812527,
            -4.668125,
            5.306698672187,
            -0.62672705314,
        ],
        [
            4.777048967281,
            -3.165359755269,
            -0.267085567629,
            5.1503125,
            -36.075107126285,
            -4.870664251208,
        ],
    ),
    (
        2.0,
        3.0,
        [-0.762789089345, 1.02147841106, -0.009800445172, 0.103248373102, -0.865, 0.958289850603],
        [
            1.292117044019,
            -8.574861203171,
            0.342743812527,
            1.73144013815,
            -2.598986158986,
            1.892775472724,
        ],
        [
            4.777048967281,
            -3.165359755269,
            -0.267085567629,
            4.642216995775,
            11.600047885184,
            -0.088598924181,
        ],
    ),
    (
        3.0,
        2.0,
        [2.04, 3.32, -1.06, -1.505, -1.02, 0.73],
        [0.0, 0.0, 0.0, -1.4725, 3.83, -1.41],
        [0.0, 0.0, 0.0, 1.89375, -20.3125, -2.205],
    ),
    (
        1.0,
        2.0,
        [-0.2975, 0.719, -0.1213, -1.505, -1.02, 0.73],
        [-0.62125, -6.285, 0.12875, -1.4725, 3.83, -1.41],
        [4.58125, 8.1, 0.15525, 1.89375, -20.3125, -2.205],
    ),
];

#[test]
fn a_table_of_two_variables_is_smooth_with_akimas_slopes() {
    #[rustfmt::skip]
    let grid = [
        0.0, 0.0, 2.0, 3.0, 5.0,
        0.0, 2.04, -2.56, 0.42, -0.57,
        1.0, -0.45, -0.22, -2.02, -0.23,
        2.5, -0.87, 3.32, 0.23, -0.35,
        3.0, -0.28, -0.67, -1.06, -0.39,
        4.0, 0.48, -0.24, 0.96, -0.2,
    ];
    for (smoothness, extrapolation, values, slopes, curvatures) in SURFACES {
        let args = [
            Text("NoName"),
            Text("NoName"),
            Array(&[6, 5], &grid),
            Number(6.0),
            Number(5.0),
            Number(smoothness),
            Number(extrapolation),
            Number(0.0),
        ];
        let made = call("ModelicaStandardTables_CombiTable2D_init2", &args);
        let table = made.expect("a table").objects.remove(0);
        for (at, [x, y]) in PLACES.into_iter().enumerate() {
            let result = |what: &str, rates: &[f64]| {
                let numbers = [x, y].into_iter().chain(rates.iter().copied()).map(Number);
                let args: Vec<Arg<'_>> = [Arg::Object(&table)].into_iter().chain(numbers).collect();
                let name = format!("ModelicaStandardTables_CombiTable2D_{what}");
                let entry = external::find(&name).expect("it is there");
                call(entry.name, &args).expect("a value").result
            };
            let close = |value: f64, expected: f64| {
                assert!((value - expected).abs() < 1e-10, "{value} is not {expected}");
            };
            close(result("getValue", &[]), values[at]);
            close(result("getDerValue", &[1.0, 0.5]), slopes[at]);
            close(result("getDer2Value", &[1.0, 0.5, 0.25, -2.0]), curvatures[at]);
        }
    }
}

#[test]
fn a_file_that_nobody_grants_is_not_read() {
    let args = [Text("none.txt"), Text("t"), Array(&[2], &[0.0, 0.0])];
    let fault = call("ModelicaIO_readMatrixSizes", &args).expect_err("refused");
    assert_eq!(fault.code.slug, "external-outside");
}

#[test]
fn tables_are_read_from_files() {
    let read = |file: &str, content: &'static str| {
        let args = [
            Text(file),
            Text("b"),
            Array(&[0, 2], &[]),
            Number(0.0),
            Number(2.0),
            Array(&[1], &[3.0]),
            Number(1.0),
            Number(1.0),
            Number(2.0),
            Number(0.0),
            Text(";"),
            Number(1.0),
        ];
        call_with("ModelicaStandardTables_CombiTable1D_init3", &args, &mut OneFile(content))
    };
    let text = "#1\ndouble a(1,2)\n0 0\ndouble b(2,3) # the table\n0 0 1\n2 4 5\n";
    near(at(&read("table.txt", text).expect("a table").objects[0], 1.0), 3.0);
    // Without delimiter and header lines the file comes first too, as in version 4.0.0.
    let args = [
        Text("table.txt"),
        Text("b"),
        Array(&[0, 2], &[]),
        Number(0.0),
        Number(2.0),
        Array(&[1], &[3.0]),
        Number(1.0),
        Number(1.0),
        Number(2.0),
        Number(0.0),
    ];
    let made = call_with("ModelicaStandardTables_CombiTable1D_init2", &args, &mut OneFile(text));
    near(at(&made.expect("a table").objects[0], 1.0), 3.0);
    let csv = "x; y; z\n0; 0; 1\n2; 4; 5\n";
    near(at(&read("table.csv", csv).expect("a table").objects[0], 1.0), 3.0);
    let fault = read("table.csv", "x; y; z\n0; 0; one\n").expect_err("no number");
    assert!(fault.message.contains("no number in line 2: `one`"), "{fault}");
    let args = [Text("table.txt")];
    let fault = call("ModelicaInternal_countLines", &args).expect_err("nobody reads files");
    assert_eq!(fault.code.slug, "external-outside");
}

#[test]
fn strings_are_scanned_as_documented() {
    let hash = |text| call("ModelicaStrings_hashString", &[Text(text)]).expect("a hash").result;
    assert_eq!(hash("this is a test"), 1827717433.0);
    assert_eq!(hash("Controller.noise1"), -1025762750.0);
    let part = |from: f64, to: f64| {
        let args = [Text("This is line 111"), Number(from), Number(to)];
        call("ModelicaStrings_substring", &args).expect("a text").text
    };
    assert_eq!(part(9.0, 12.0), "line");
    assert_eq!(part(9.0, 0.0), "");
    assert_eq!(part(-3.0, 4.0), "This");
    assert_eq!(part(9.0, -1.0), "l");
    assert_eq!(part(14.0, 99.0), "111");
    assert_eq!(part(40.0, 99.0), "");
    let scan = |name: &str, text: &str| {
        let args = [Text(text), Number(1.0), Number(0.0), Number(0.0), Number(0.0)];
        let numbers = call(name, &args).expect("a token").numbers;
        (numbers[2], numbers[3])
    };
    let integer = |text| scan("ModelicaStrings_scanInteger", text);
    assert_eq!(integer("  -12 x"), (6.0, -12.0));
    assert_eq!(integer("12.5"), (1.0, 0.0));
    assert_eq!(integer("+"), (1.0, 0.0));
    let real = |text| scan("ModelicaStrings_scanReal", text);
    assert_eq!(real(" 1.5e-3,"), (8.0, 0.0015));
    assert_eq!(real("-7"), (3.0, -7.0));
    assert_eq!(real(".5"), (1.0, 0.0));
    assert_eq!(real("1e"), (1.0, 0.0));
    let token = |name: &str, text: &str| {
        let args = [Text(text), Number(1.0), Number(0.0), Arg::Out];
        let done = call(name, &args).expect("a token");
        (done.numbers[1], done.written[0].to_string())
    };
    assert_eq!(token("ModelicaStrings_scanIdentifier", " a_1+b"), (5.0, "a_1".into()));
    assert_eq!(token("ModelicaStrings_scanIdentifier", "1a"), (1.0, "".into()));
    assert_eq!(token("ModelicaStrings_scanString", " \"ab\" c"), (6.0, "ab".into()));
    assert_eq!(token("ModelicaStrings_scanString", "\"ab"), (1.0, "".into()));
}

#[test]
fn random_numbers_are_those_of_the_standard_library() {
    let run = |name: &str, state: &[f64]| {
        let size = [state.len()];
        let args = [Array(&size, state), Array(&size, state), Number(0.0)];
        let numbers = call(name, &args).expect("a number").numbers;
        (numbers[state.len()..2 * state.len()].to_vec(), numbers[2 * state.len()])
    };
    let mut state = vec![1.0, 0.0];
    for (next, number) in [
        ([-1989354211.0, 1206177355.0], 0.7808350500503596),
        ([-955010875.0, 602321399.0], 0.6402388791967286),
        ([-779129102.0, 923993986.0], 0.7151341146832786),
    ] {
        let (found, value) = run("ModelicaRandom_xorshift64star", &state);
        assert_eq!((found.as_slice(), value), (next.as_slice(), number));
        state = found;
    }
    let mut state = vec![1.0, 0.0, 2.0, 0.0];
    for number in [0.5000000000004547, 0.500000000001819, 0.5000038146990848] {
        let (found, value) = run("ModelicaRandom_xorshift128plus", &state);
        assert_eq!(value, number);
        state = found;
    }
    assert_eq!(state, [33554700.0, 0.0, 33558869.0, 16384.0]);
    let mut state: Vec<f64> = (1..=16).flat_map(|word| [f64::from(word), 0.0]).collect();
    state.push(0.0);
    for number in [0.2513150092458146, 0.5358190340172654, 0.5259321584469488] {
        let (found, value) = run("ModelicaRandom_xorshift1024star", &state);
        assert_eq!(value, number);
        state = found;
    }
    assert_eq!((state[6], state[7], state[32]), (-2142240766.0, 2.0, 3.0));
}

/// The values are those of another program, whose amplitudes are those of the definition divided
/// by n/2 + 1.
#[test]
fn a_signal_is_transformed_for_every_even_number_of_values() {
    let transform = |signal: &[f64]| {
        let n = signal.len();
        let (work, half) = (vec![0.0; 3 * n + 2 * (n / 2 + 1)], vec![0.0; n / 2 + 1]);
        let args = [
            Array(&[n], signal),
            Number(n as f64),
            Array(&[work.len()], &work),
            Number(work.len() as f64),
            Array(&[half.len()], &half),
            Array(&[half.len()], &half),
        ];
        let done = call("ModelicaFFT_kiss_fftr", &args).expect("a transform");
        let first = n + 1 + work.len() + 1;
        (done.result, done.numbers[first..first + 2 * half.len()].to_vec())
    };
    let signal = [1.0, 2.0, -1.0, 3.0, 0.5, -2.0, 4.0, 1.0, 0.0, 2.0];
    let expected = [
        [
            1.75,
            0.2542425747988771,
            0.2930181236693417,
            1.3659854569925673,
            1.4182251589305277,
            0.25,
        ],
        [
            0.0,
            0.8112596768592,
            -2.0434668895846757,
            0.4982147506853503,
            -2.526466697852003,
            std::f64::consts::PI,
        ],
    ];
    let (result, found) = transform(&signal);
    assert_eq!(result, 0.0);
    found.iter().zip(expected.concat()).for_each(|(value, expected)| near(*value, expected));
    assert_eq!(transform(&signal[..7]).0, 1.0);
}
