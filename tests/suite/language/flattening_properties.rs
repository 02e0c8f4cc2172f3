//! No damaged model makes flattening or compilation panic, hang or run out of stack: the corpora
//! with tokens deleted, doubled, exchanged or replaced by others of the same file.

use gapilib::internals::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::name::Name;
use gapilib::internals::source::SourceId;
use gapilib::internals::syntax::parse_stored_definition;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// The files of the corpora, as tokens with the blanks between them.
static CORPUS: LazyLock<Vec<Vec<String>>> = LazyLock::new(|| {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for folder in ["tests/flattening", "tests/structure", "tests/grammar/valid", "models"] {
        modelica_files(&root.join(folder), &mut files);
    }
    files.sort();
    let read = |path: &PathBuf| std::fs::read_to_string(path).expect("the text is UTF-8");
    files.iter().map(|path| tokens(&read(path))).collect()
});

fn modelica_files(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the corpus is there") {
        let path = entry.expect("the entry is readable").path();
        if path.is_dir() {
            modelica_files(&path, out);
        } else if path.extension().is_some_and(|extension| extension == "mo") {
            out.push(path);
        }
    }
}

/// Words, numbers, blanks and single other characters; strings stay whole.
fn tokens(text: &str) -> Vec<String> {
    let kind = |c: char| match c {
        _ if c.is_alphanumeric() || c == '_' => 1,
        _ if c.is_whitespace() => 2,
        _ => 0,
    };
    let mut tokens: Vec<String> = Vec::new();
    let mut last = 0;
    let mut quoted = false;
    for c in text.chars() {
        let joins = quoted || (kind(c) != 0 && kind(c) == last);
        match tokens.last_mut() {
            Some(token) if joins => token.push(c),
            _ => tokens.push(c.to_string()),
        }
        quoted ^= c == '"';
        last = if quoted || c == '"' { 0 } else { kind(c) };
    }
    tokens
}

/// What happens to the text, at places given as fractions of its length.
#[derive(Debug, Clone)]
enum Damage {
    Delete(f64),
    Double(f64),
    Exchange(f64, f64),
    Replace(f64, f64),
    Write(f64, &'static str),
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = || 0.0..1.0f64;
    prop_oneof![
        1 => at().prop_map(Damage::Delete),
        1 => at().prop_map(Damage::Double),
        3 => (at(), at()).prop_map(|(a, b)| Damage::Exchange(a, b)),
        6 => (at(), at()).prop_map(|(a, b)| Damage::Replace(a, b)),
        3 => (at(), prop::sample::select(PIECES)).prop_map(|(a, piece)| Damage::Write(a, piece)),
    ]
}

const PIECES: &[&str] = &[
    "0",
    "-1",
    "9223372036854775807",
    "1e308",
    "true",
    "\"text\"",
    "time",
    "end",
    "der(x)",
    "{}",
    "{1, 2}",
    "[1, 2; 3, 4]",
    "1:0",
    "1:1000000000000",
    "fill(1, 0)",
    "zeros(1000000, 1000000)",
    "x",
    "Real",
    "Integer",
    ":",
    "each ",
    "final ",
    "partial ",
    "inner ",
    "parameter ",
    "constant ",
    "extends ",
    "function ",
    "record ",
    "if true then 1 else 2",
    "size(x, 1)",
];

/// The texts with their damages, changed at words and signs, not at blanks.
fn damaged(tokens: &[String], damages: &[Damage]) -> String {
    let mut tokens = tokens.to_vec();
    for damage in damages {
        let solid: Vec<usize> =
            (0..tokens.len()).filter(|at| !tokens[*at].trim().is_empty()).collect();
        let place = |fraction: f64| solid[(fraction * solid.len() as f64) as usize];
        if solid.is_empty() {
            break;
        }
        match *damage {
            Damage::Delete(at) => tokens[place(at)].clear(),
            Damage::Double(at) => {
                let token = &mut tokens[place(at)];
                *token = format!("{token} {token}");
            }
            Damage::Exchange(a, b) => tokens.swap(place(a), place(b)),
            Damage::Replace(a, b) => tokens[place(a)] = tokens[place(b)].clone(),
            Damage::Write(at, piece) => tokens[place(at)] = piece.to_owned(),
        }
    }
    tokens.concat()
}

/// Flattens and compiles every class of a text and makes every function of it ready, whatever comes
/// of it.
fn compile_all(text: &str) {
    let Ok(file) = parse_stored_definition(SourceId::NONE, text) else { return };
    let mut library = Library::new();
    if library.load(&file).is_err() {
        return;
    }
    for class in library.all() {
        if let Ok(flattened) = flatten(&library, &class, &[]) {
            let _ = causalize::causalize(&flattened.model).map(Program::compile);
        }
        let _ = library.function(&class);
    }
}

/// The same damages everywhere. `PROPTEST_RNG_SEED` and `PROPTEST_CASES` ask for others and more;
/// each case damages every file of the corpora once.
fn config() -> ProptestConfig {
    let asked = ProptestConfig::default();
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { asked.cases } else { 4 };
    let rng_seed = match asked.rng_seed {
        RngSeed::Random => RngSeed::Fixed(1),
        fixed => fixed,
    };
    ProptestConfig { cases, rng_seed, failure_persistence: None, ..asked }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn damaged_models_never_make_the_compiler_panic(
        damages in prop::collection::vec(prop::collection::vec(damage(), 1..3), 8),
    ) {
        for (number, tokens) in CORPUS.iter().enumerate() {
            compile_all(&damaged(tokens, &damages[number % damages.len()]));
        }
    }
}

/// `count` pieces made from their numbers, from 1, in a row.
fn repeated(count: usize, piece: impl Fn(usize) -> String) -> String {
    (1..=count).map(piece).collect()
}

fn refused(text: &str) -> bool {
    let file = parse_stored_definition(SourceId::NONE, text).expect("Modelica");
    let mut library = Library::new();
    library.load(&file).expect("a loadable file");
    flatten(&library, &Name::parse("P.Main"), &[]).is_err()
}

#[test]
fn models_that_grow_without_bound_are_refused() {
    let doubled = repeated(60, |n| format!("model M{n} M{0} a; M{0} b; end M{n};", n - 1));
    let extended =
        repeated(90, |n| format!("model M{n} extends M{0}; extends M{0}; end M{n};", n - 1));
    for text in [
        format!("model M0 end M0; {doubled} model Main M60 m; end Main;").as_str(),
        &format!("model M0 end M0; {extended} model Main extends M90; X x; end Main;"),
        "model Main Real x[100000, 100000]; end Main;",
        "model A end A; model Main A a[100000, 100000]; end Main;",
        "model Main Main m[2]; end Main;",
        "record R R r; end R; model Main R r; end Main;",
        "type T = T; model Main T t; end Main;",
        "type T = U[2]; type U = T[2]; model Main T t; end Main;",
        "model Main extends Main; end Main;",
        "model A extends Main; end A; model Main extends A; end Main;",
        "package A extends B.C; end A; package B extends A.D; end B; model Main A.X x; end Main;",
        "model Main Real x; equation for i in 1:1000000000000 loop x = 1; end for; end Main;",
        "model Main Real x; equation for i in 1:1000, j in 1:1000 loop x = 1; end for; end Main;",
        "model Main parameter Real p[:] = fill(1, 1000000000, 1000000000); end Main;",
        "constant Real a = b; constant Real b = a; model Main Real x = a; end Main;",
        "constant Real a = P.a; model Main Real x = a; end Main;",
        "import P.*; import Q = P.Q; model Main Q.R.S x; end Main;",
    ] {
        assert!(refused(&format!("package P {text} end P;")), "{text}");
    }
}

#[test]
fn functions_that_never_end_are_refused_where_a_size_needs_them() {
    let model = "model Main parameter Integer n = f(1); Real x[n] = ones(n); end Main;";
    let function = "function f input Integer n; output Integer m; algorithm";
    for body in ["m := f(n);", "while true loop m := n; end while;"] {
        assert!(refused(&format!("package P {model} {function} {body} end f; end P;")), "{body}");
    }
}

#[test]
fn long_chains_end_in_an_answer() {
    let chain = repeated(3000, |n| format!("parameter Integer p{n} = p{};", n - 1));
    let text = format!("model Main parameter Integer p0 = 1; {chain} Real x[p3000]; end Main;");
    assert!(refused(&format!("package P {text} end P;")));
    let sum = repeated(150, |n| format!(" + {n}"));
    let (calls, closing) = (repeated(150, |_| "sin(".into()), ")".repeat(150));
    let header = "input Real x; output Real y; algorithm y :=";
    let functions = repeated(500, |n| format!("function f{n} {header} f{}(x); end f{n};", n - 1));
    for text in [
        format!("model Main Real x = 0{sum}; end Main;"),
        format!("model Main Real x = {calls}1{closing}; end Main;"),
        format!(
            "{functions} function f0 {header} x; end f0; model Main Real x = f500(1); end Main;"
        ),
    ] {
        let _ = refused(&format!("package P {text} end P;"));
    }
}
