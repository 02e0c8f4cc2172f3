//! Functions in C that a library brings along (MLS §12.9), as a user meets them: the library
//! `tests/external/Foreign`. Without a C compiler the tests that need one say so and pass.

use crate::support::program::{folder, gapi};
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

fn library() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/external").display().to_string()
}

/// Whether there is a C compiler, said if there is none.
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn is_there_a_compiler() -> bool {
    let named = std::env::var("CC").ok();
    let found = named.as_deref().into_iter().chain(["cc", "gcc", "clang"]).any(|name| {
        Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success())
    });
    if !found {
        eprintln!("skipped: there is no C compiler");
    }
    found
}

fn run(here: &TempDir, arguments: &[&str]) -> (i32, String, String) {
    let library = library();
    gapi(here, &[arguments, &["--library", &library, "--allow-external"]].concat())
}

/// The output of a script, each value on a line.
fn script(text: &str) -> (i32, String, String) {
    run(&folder(&[("a.mos", text)]), &["run", "a.mos"])
}

/// The last row of the results of a simulation, by column.
fn last_values(model: &str, more: &[&str]) -> Vec<(String, f64)> {
    let here = folder(&[]);
    let model = format!("Foreign.Examples.{model}");
    let arguments = [&["simulate", "--model", &model, "--output", "r.csv"], more].concat();
    let (code, _, errors) = run(&here, &arguments);
    assert_eq!(code, 0, "{errors}");
    let mut csv = csv::Reader::from_path(here.path().join("r.csv")).expect("results");
    let names = csv.headers().expect("a header").clone();
    let last = csv.records().last().expect("a row").expect("readable");
    let number = |text: &str| text.parse().expect("a number");
    names.iter().map(str::to_owned).zip(last.iter().map(number)).collect()
}

fn value(values: &[(String, f64)], name: &str) -> f64 {
    let found =
        values.iter().find(|(known, _)| known == name || known.starts_with(&format!("{name} ")));
    found.unwrap_or_else(|| panic!("no `{name}` in {values:?}")).1
}

#[test]
fn nothing_is_compiled_without_permission() {
    let here = folder(&[("a.mos", "Foreign.triple(2, 3)\n")]);
    let (code, out, errors) = gapi(&here, &["run", "a.mos", "--library", &library()]);
    let said = format!("{out}{errors}");
    assert_eq!(code, 1, "{said}");
    for word in
        ["external-refused", "`Foreign.triple`", "`triple`", "scalars.c", "--allow-external"]
    {
        assert!(said.contains(word), "{word}: {said}");
    }
    let model = ["simulate", "--model", "Foreign.Examples.Arrays", "--library", &library()];
    let (code, out, errors) = gapi(&here, &model);
    assert!(code == 1 && format!("{out}{errors}").contains("external-refused"), "{out}{errors}");
}

/// Each library has its own permission.
#[test]
fn another_library_is_not_allowed() {
    let here = folder(&[("a.mos", "Foreign.triple(2, 3)\n")]);
    let other = ["run", "a.mos", "--library", &library(), "--allow-external=Other"];
    let (code, out, errors) = gapi(&here, &other);
    assert!(code == 1 && errors.contains("--allow-external=Foreign"), "{out}{errors}");
    if is_there_a_compiler() {
        let own = [&other[..4], &["--allow-external=Foreign"]].concat();
        let (code, out, errors) = gapi(&here, &own);
        assert!(code == 0 && out.contains("= 9"), "{out}{errors}");
    }
}

/// Not even what runs when a shared object is loaded: a model is only checked.
#[test]
#[cfg(unix)]
fn check_executes_nothing() {
    if !is_there_a_compiler() {
        return;
    }
    let here = folder(&[]);
    let ran = here.path().join("ran");
    let code = format!(
        "#include <stdio.h>\n__attribute__((constructor)) static void at_loading(void) \
         {{ FILE *file = fopen(\\\"{}\\\", \\\"w\\\"); if (file) fclose(file); }}\n\
         double twice(double x) {{ return 2*x; }}",
        ran.display()
    );
    let model = format!(
        "model M function twice input Real x; output Real y; external \"C\" y = twice(x) \
         annotation(Include = \"{code}\"); end twice; parameter Real p = twice(3); \
         Real x = p; end M;"
    );
    std::fs::write(here.path().join("M.mo"), model).expect("written");
    for arguments in [&["check", "M.mo"][..], &["check", "M.mo", "--model", "M"]] {
        let (_, out, errors) = gapi(&here, &[arguments, &["--allow-external"]].concat());
        assert!(!errors.contains("external-refused") && !ran.exists(), "{out}{errors}");
    }
    let (code, out, errors) = gapi(&here, &["simulate", "M.mo", "--allow-external=M"]);
    assert!(code == 0 && ran.exists(), "{out}{errors}");
}

/// Functions that read and write as many elements as they declare, and what they are called with.
const DECLARED_SIZES: &str = include_str!("../../data/models/c_functions_declared_sizes.mo");

/// C reads and writes beyond no array, whatever a model or a script passes.
#[test]
fn arrays_and_objects_are_those_that_functions_declare() {
    if !is_there_a_compiler() {
        return;
    }
    let here = folder(&[("Sizes.mo", DECLARED_SIZES)]);
    let (size, unknown) = ("size", "sizes are not declared");
    let of_records = "a component of an array of records";
    for (number, (call, wanted)) in [
        ("Sizes.three({1, 2, 3})", Ok("6")),
        ("Sizes.three({1, 2})", Err(size)),
        ("Sizes.first(2, {1, 2})", Ok("3")),
        ("Sizes.first(3, {1, 2})", Err(size)),
        ("Sizes.lengths({\"a\", \"bc\"})", Ok("3")),
        ("Sizes.lengths({\"a\"})", Err(size)),
        ("Sizes.pair(Sizes.Pair({1, 2}))", Ok("3")),
        ("Sizes.pair(Sizes.Pair({1}))", Err(size)),
        ("Sizes.row(Sizes.Row(2, {1, 2}))", Ok("2")),
        ("Sizes.row(Sizes.Row(3, {1, 2}))", Err(size)),
        ("Sizes.all_rows({Sizes.Row(2, {1, 2}), Sizes.Row(2, {3, 4})})", Err("a record")),
        ("Sizes.in_rows({Sizes.Row(2, {1, 2}), Sizes.Row(2, {3, 4})})", Err(of_records)),
        ("Sizes.one_row({Sizes.Row(2, {1, 2}), Sizes.Row(2, {3, 4})})", Err(of_records)),
        ("Sizes.each_row({Sizes.Row(2, {1, 2}), Sizes.Row(2, {3, 4})})", Ok("10")),
        ("Sizes.each_row({Sizes.Row(2, {1, 2}), Sizes.Row(3, {3, 4})})", Err(size)),
        ("sum(Sizes.open_output(1))", Err(unknown)),
        ("Sizes.open_local(1)", Err(unknown)),
        ("Sizes.of_large(Sizes.Large(5))", Ok("5")),
        ("Sizes.of_large(Sizes.Small(5))", Err("Sizes.Small")),
    ]
    .into_iter()
    .enumerate()
    {
        let script = format!("openModel(\"Sizes.mo\");\nprint(String({call}));\n");
        let model =
            format!("model M{number} parameter Real p = {call}; Real x = p; end M{number};");
        std::fs::write(here.path().join("s.mos"), script).expect("written");
        std::fs::write(here.path().join(format!("M{number}.mo")), model).expect("written");
        let file = format!("M{number}.mo");
        for arguments in [
            &["run", "s.mos", "--overwrite"][..],
            &["simulate", &file, "--library", "Sizes.mo", "--output", "r.csv"],
        ] {
            let (code, out, errors) = gapi(&here, &[arguments, &["--allow-external"]].concat());
            match wanted {
                Err(word) => assert!(
                    code == 1 && errors.contains(word) && errors.contains("┌─ "),
                    "{call} {arguments:?} {code}: {out}{errors}"
                ),
                Ok(value) => {
                    let results = std::fs::read_to_string(here.path().join("r.csv"));
                    let said = out.clone() + &results.unwrap_or_default();
                    assert!(code == 0 && said.contains(value), "{call} {code}: {said}{errors}");
                }
            }
            _ = std::fs::remove_file(here.path().join("r.csv"));
        }
    }
}

#[test]
fn a_missing_compiler_is_named() {
    let here = folder(&[("a.mos", "Foreign.triple(2, 3)\n")]);
    let mut command = Command::new(env!("CARGO_BIN_EXE_gapi"));
    command.args(["run", "a.mos", "--allow-external", "--library", &library()]);
    let output = command.env("CC", "no-such-compiler").current_dir(here.path()).output();
    let output = output.expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("external-compiler") && said.contains("`no-such-compiler`"), "{said}");
    assert!(said.contains("apt install gcc"), "{said}");
}

#[test]
fn scripts_call_scalars_arrays_and_strings() {
    if !is_there_a_compiler() {
        return;
    }
    let (code, out, errors) = script(
        "Foreign.triple(2, 3)\n\
         (w, r, n, l) := Foreign.parts(-2.75, true, Foreign.Level.low)\n\
         {w, r}\nn\nl\n\
         Foreign.transposed([1, 2, 3; 4, 5, 6])\n\
         Foreign.weighted({1, 2, 3}, {1, 10, 100})\n\
         Foreign.greeting(\"Anna\")\n\
         Foreign.longest({\"a\", \"bcd\", \"ef\"})\n",
    );
    assert_eq!(code, 0, "{out}{errors}");
    let expected = [
        "= 9",
        "-2",
        "-0.75",
        "true",
        "Level.middle",
        "1.0, 4.0",
        "2.0, 5.0",
        "3.0, 6.0",
        "= 321",
        "\"Hello, Anna\"",
        "\"bcd\"",
    ];
    for word in expected {
        assert!(out.contains(word), "{word}: {out}{errors}");
    }
}

#[test]
fn errors_of_c_have_a_place_and_messages_are_shown() {
    if !is_there_a_compiler() {
        return;
    }
    let (code, out, errors) = script("Foreign.root(4)\nForeign.talk(3)\nForeign.root(-1)\n");
    let said = format!("{out}{errors}");
    assert_eq!(code, 1, "{said}");
    for word in ["= 2", "x is 3", "Warning: this is the end", "-1 has no real root", "a.mos:3"] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let here = folder(&[]);
    let (code, out, errors) = run(&here, &["simulate", "--model", "Foreign.Examples.Fails"]);
    let said = format!("{out}{errors}");
    assert!(code == 1 && said.contains("has no real root"), "{said}");
}

#[test]
fn objects_have_a_state_and_are_freed() {
    if !is_there_a_compiler() {
        return;
    }
    let (code, out, errors) = script(
        "c := Foreign.Counter(5);\n\
         Foreign.next(c)\nForeign.next(c)\n\
         Foreign.alive()\n\
         c := Foreign.Counter(50);\n\
         Foreign.next(c)\nForeign.alive()\n",
    );
    assert_eq!(code, 0, "{out}{errors}");
    let values: Vec<&str> = out.lines().filter_map(|line| line.trim().strip_prefix("= ")).collect();
    assert_eq!(values, ["6", "7", "1", "51", "1"], "{out}{errors}");
}

/// It is neither pure nor impure by its declaration, and gives other values without other inputs.
#[test]
fn functions_without_inputs_are_called_at_every_event() {
    if !is_there_a_compiler() {
        return;
    }
    let model = "model M\n  function f\n    output Real y;\n    external \"C\" y = f()\n      \
                 annotation(Include = \"double f(void) { static double x = 0; return ++x; }\");\n  \
                 end f;\n  discrete Real x(start = 0, fixed = true);\n  \
                 discrete Real step(start = 1, fixed = true);\nequation\n  \
                 when sample(0.1, 0.1) then\n    x = f();\n    step = x - pre(x);\n  end when;\n  \
                 assert(abs(step - 1) < 1e-9, \"a call is missing\");\nend M;\n";
    let here = folder(&[("M.mo", model)]);
    let (code, out, errors) =
        gapi(&here, &["simulate", "M.mo", "--allow-external", "--output", "r.csv"]);
    assert_eq!(code, 0, "{out}{errors}");
}

#[test]
fn models_call_scalars_and_arrays() {
    if !is_there_a_compiler() {
        return;
    }
    for more in [&[][..], &["--interpret"]] {
        let values = last_values("Scalars", more);
        assert_eq!(value(&values, "whole"), -2.0, "of -2.25, at the event");
        assert!((value(&values, "rest") + 0.25).abs() < 1e-6, "{values:?}");
        assert_eq!(value(&values, "negative"), 1.0);
        assert_eq!(value(&values, "level"), 2.0);
        let x = value(&values, "x");
        assert!((x - (-3.0f64).exp()).abs() < 1e-4, "{x}");
        assert_eq!(value(&values, "y"), 3.0 * x + 2.0);
    }
    let values = last_values("Arrays", &[]);
    assert_eq!(value(&values, "b[3,2]"), 6.0);
    assert_eq!(value(&values, "b[1,1]"), 1.0);
    assert_eq!(value(&values, "y"), 1.0 + 20.0 + 300.0);
}

#[test]
fn the_derivative_annotation_is_used() {
    if !is_there_a_compiler() {
        return;
    }
    let values = last_values("Loop", &[]);
    let x = 2.0f64.cbrt();
    assert!((value(&values, "x") - x).abs() < 1e-6, "{values:?}");
    assert!((value(&values, "v") - 1.0 / (3.0 * x * x)).abs() < 1e-6, "{values:?}");
}

#[test]
fn every_object_of_a_model_has_its_own_state() {
    if !is_there_a_compiler() {
        return;
    }
    let values = last_values("Counters", &[]);
    assert_eq!(value(&values, "i"), 15.0, "five calls from 10 on: {values:?}");
    assert_eq!(value(&values, "j"), 13.0, "three calls from 10 on: {values:?}");
}

/// A library that cannot be linked is named with the linker's words, and disturbs no other function.
#[test]
fn what_the_compiler_refuses_is_shown() {
    if !is_there_a_compiler() {
        return;
    }
    let (_, out, errors) = script("Foreign.missing(1)\nForeign.triple(0, 7)\n");
    let said = format!("{out}{errors}");
    for word in ["external-compiler", "no_such_library", "Foreign/package.mo", "= 7"] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let (_, out, errors) = script("Foreign.fortran(1)\n");
    let said = format!("{out}{errors}");
    assert!(said.contains("external-declaration") && said.contains("FORTRAN 77"), "{said}");
}

/// A damaged file in the cache is compiled anew; one that is whole is used without compiling.
#[test]
fn the_cache_is_safe_against_damage() {
    if !is_there_a_compiler() {
        return;
    }
    let here = folder(&[("a.mos", "Foreign.triple(2, 3)\n")]);
    let cache = here.path().join("cache");
    let run = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gapi"));
        command.args(["run", "a.mos", "--allow-external", "--library", &library()]);
        let output = command.env("XDG_CACHE_HOME", &cache).current_dir(here.path()).output();
        String::from_utf8_lossy(&output.expect("it runs").stdout).into_owned()
    };
    let objects = || -> Vec<std::path::PathBuf> {
        let entries = std::fs::read_dir(cache.join("gapi/external")).expect("a cache");
        let paths = entries.map(|entry| entry.expect("readable").path());
        paths.filter(|path| path.extension().is_some_and(|e| e == "so")).collect()
    };
    let first = run();
    assert!(first.contains("= 9"), "{first}");
    let known = objects();
    assert_eq!(known.len(), 1, "{known:?}");
    let whole = std::fs::read(&known[0]).expect("an object");
    let made = std::fs::metadata(&known[0]).and_then(|file| file.modified()).expect("a time");
    assert_eq!(run(), first);
    let after = std::fs::metadata(&known[0]).and_then(|file| file.modified()).expect("a time");
    assert_eq!(made, after, "it was compiled twice");
    std::fs::write(&known[0], &whole[..whole.len() / 2]).expect("writable");
    assert_eq!(run(), first);
    assert_eq!(std::fs::read(&known[0]).expect("an object").len(), whole.len());
}

#[test]
fn strings_of_objects_are_known_at_translation() {
    if !is_there_a_compiler() {
        return;
    }
    let values = last_values("StringsOfObjects", &[]);
    assert_eq!(value(&values, "y"), 4.0 + 6.0);
}

#[test]
fn code_of_older_libraries_is_compiled() {
    if !is_there_a_compiler() {
        return;
    }
    let (code, out, errors) = script("Foreign.charge(\"Hg+2\")\n");
    assert!(code == 0 && out.contains('2'), "{out}{errors}");
    let (_, out, errors) = script("Foreign.charge(\"SO-4\")\n");
    assert!(out.contains("-4"), "{out}{errors}");
}

/// SystemDynamics: older compilers knew the functions of C without their headers.
#[test]
fn functions_of_c_need_no_headers() {
    if !is_there_a_compiler() {
        return;
    }
    let text = "package P function seven output Integer n; external \"C\" n = seven() \
        annotation(Include = \"int seven() { srand(3); \
        return time(NULL) > 0 && isdigit('7') && fabs(-2.0) == 2.0 ? atoi(\\\"7\\\") : 0; }\"); \
        end seven; end P;";
    let here = folder(&[("P.mo", text), ("a.mos", "openModel(\"P.mo\");\nP.seven()\n")]);
    let (code, out, errors) = run(&here, &["run", "a.mos"]);
    assert_eq!(code, 0, "{out}{errors}");
    assert!(out.ends_with("7\n"), "{out}");
}

/// FCSys calls `ModelicaStrings_skipWhiteSpace`, which nothing that it includes declares.
#[test]
fn code_may_call_functions_of_the_standard_library() {
    if !is_there_a_compiler() {
        return;
    }
    let own = "package P function next output Integer n; external \"C\" n = next() \
        annotation(Include = \"int next() { return ModelicaStrings_behind(atoi(\\\"7\\\")); }\"); \
        end next; end P;";
    let call = "openModel(\"P.mo\");\nP.next()\n";
    let with = format!("loadModel(Modelica);\n{call}");
    let alone = folder(&[("P.mo", own), ("a.mos", call), ("b.mos", &with)]);
    let (code, _, errors) = run(&alone, &["run", "a.mos"]);
    assert!(code == 1 && errors.contains("ModelicaStrings_behind"), "{errors}");

    let sources = "Modelica/Resources/C-Sources";
    std::fs::create_dir_all(alone.path().join(sources)).expect("a folder");
    let header = "int ModelicaStrings_behind(int i);";
    let source = "#include \"ModelicaStrings.h\"\n\
        int ModelicaStrings_behind(int i) { if (i < 0) ModelicaError(\"no\"); return i + 1; }";
    let source = format!("#include \"ModelicaUtilities.h\"\n{source}");
    for (file, text) in [
        ("Modelica/package.mo", "package Modelica annotation(version=\"4.0.0\"); end Modelica;"),
        (&*format!("{sources}/ModelicaStrings.h"), header),
        (&*format!("{sources}/ModelicaStrings.c"), &*source),
    ] {
        std::fs::write(alone.path().join(file), text).expect("writable");
    }
    let here = alone.path().display().to_string();
    let (code, out, errors) = run(&alone, &["run", "b.mos", "--library", &here]);
    assert_eq!(code, 0, "{out}{errors}");
    assert!(out.ends_with("8\n"), "{out}");
}

/// The constructor of the objects that couple Buildings with EnergyPlus.
#[test]
fn components_of_records_are_passed() {
    if !is_there_a_compiler() {
        return;
    }
    let model = "model M\n  record Pair\n    Real factor;\n    Integer k[2];\n  end Pair;\n  \
                 record Whole\n    Boolean on;\n    Pair pair;\n  end Whole;\n  \
                 function f\n    input Whole o;\n    input Real x;\n    output Real y;\n    \
                 external \"C\" y = f(o.on, o.pair.factor, o.pair.k, 2, x)\n      \
                 annotation(Include = \"double f(int on, double a, const int *k, int n, double x) \
                 { return (on ? a : 0)*x + k[0] + 10*k[n - 1]; }\");\n  end f;\n  \
                 parameter Whole o = Whole(true, Pair(2, {3, 4}));\n  \
                 Real y = f(o, time);\n  parameter Real p = f(o, 5);\nequation\n  \
                 assert(abs(y - (2*time + 43)) < 1e-9 and p == 53, \"another result\");\nend M;\n";
    let here = folder(&[("M.mo", model)]);
    let (code, out, errors) =
        gapi(&here, &["simulate", "M.mo", "--allow-external", "--output", "r.csv"]);
    assert_eq!(code, 0, "{out}{errors}");
}

/// Modelica_DeviceDrivers: functions in C without outputs fill a package; the functions around them
/// return a number on which the next one depends.
#[test]
fn functions_that_change_an_object_have_values() {
    if !is_there_a_compiler() {
        return;
    }
    let code = "typedef struct { double sum; } sum_t; \
                static void *sum_new(void) { sum_t *s = malloc(sizeof *s); s->sum = 0; return s; } \
                static void sum_free(void *s) { free(s); } \
                static void sum_add(void *s, double x) { ((sum_t *)s)->sum += x; } \
                static double sum_get(void *s, double t) { return ((sum_t *)s)->sum; }";
    let code = format!("Include = \"#include <stdlib.h>\n{code}\"");
    let model = include_str!("../../data/models/c_functions_sum.mo");
    let model = model.replace("Include = \"\"", &code);
    let here = folder(&[("M.mo", &model)]);
    let arguments = ["simulate", "M.mo", "--allow-external", "--output", "r.csv"];
    let (code, out, errors) = gapi(&here, &arguments);
    assert_eq!(code, 0, "{out}{errors}");
}

/// Counters that `out.c = Counter(start)` makes and that connections pass on: 13 and 15 after three events
/// of two counts each from 3, one after the other. `late` counts from a value that is known when the
/// simulation starts.
const COUNTERS: &str = include_str!("../../data/models/c_functions_counters.mo");

#[test]
fn objects_are_passed_through_connections_and_made_when_the_simulation_starts() {
    if !is_there_a_compiler() {
        return;
    }
    let code = "static void *make_counter(double s) { double *p = malloc(sizeof(double)); *p = s; \
                return p; } \
                static void free_counter(void *p) { free(p); } \
                static double count(void *p, double by) { return *(double *)p += by; }";
    let code = format!("annotation(Include = \"#include <stdlib.h>\n{code}\")");
    let here = folder(&[("E.mo", &COUNTERS.replace("{code}", &code))]);
    let last = |model: &str| {
        let options = ["--allow-external", "--stop-time", "3", "--output", "r.csv", "E.mo"];
        let arguments = [&["simulate", "--model", model][..], &options].concat();
        let (code, out, errors) = gapi(&here, &arguments);
        assert_eq!(code, 0, "{out}{errors}");
        assert!(!errors.contains("not locally balanced"), "{errors}");
        let text = std::fs::read_to_string(here.path().join("r.csv")).expect("results");
        let rows: Vec<&str> = text.lines().collect();
        let cells = |row: &str| -> Vec<String> {
            row.split(',').map(|cell| cell.trim_matches('\"').to_owned()).collect()
        };
        cells(rows[0]).into_iter().zip(cells(rows[rows.len() - 1])).collect::<Vec<_>>()
    };
    let of = |values: &[(String, String)], name: &str| -> f64 {
        values.iter().find(|(own, _)| own == name).expect(name).1.parse().expect("a number")
    };
    let connected = last("E.Connected");
    assert_eq!([of(&connected, "a.y"), of(&connected, "b.y")], [13.0, 15.0]);
    assert_eq!(of(&last("E.Late"), "y"), 11.0);
    let twice = ["check", "E.mo", "--model", "E.Twice", "--allow-external"];
    let (code, _, errors) = gapi(&here, &twice);
    assert!(code == 1 && errors.contains("would stand for two external objects"), "{errors}");
}
