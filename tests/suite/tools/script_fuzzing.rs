//! Scripts made of pieces, in a world in memory: no panic and no hang, whatever they say.

use gapilib::world::MemoryWorld;
use gapilib::{Dialect, Options, Session};
use proptest::prelude::*;

/// Pieces of statements; `@` stands for an expression, `#` for a name.
const STATEMENTS: &[&str] = &[
    "# = @",
    "# := @;",
    "@",
    "#[@] = @",
    "#.# = @",
    "if @ then # = @; else # := @; end if",
    "for i in @ loop # = @; end for",
    "while @ loop # = @; end while;",
    "(#, #) = countMessages()",
    "function # input Real u = @; output Real y; algorithm y := @; end #;",
    "model # parameter Real k = @; Real x(start = 1); equation der(x) = -k*x; end #;",
    "record # Real a = @; end #;",
    "Real #[@] = @;",
    "simulateModel(\"#\", stopTime = @)",
    "simulate(#, stopTime = @);",
    "translateModel(\"#(k = 2)\")",
    "function # input Real u = @; output Real y = @; algorithm for i in @ loop y := @; end for; end #;",
    "model # parameter Real A[2, 2] = [1, 2; 3, 4]; Real x[2] = A*{@, 1}; equation @ = @; end #;",
    "instantiateModel(#);",
    "checkModel(#);",
    "linearize(#, stopTime = @);",
    "loadString(@);",
    "list(#);",
    "setParameterValue(#, k, @);",
    "getErrorString();",
    "RunScript(@)",
    "writeMatrix(\"a.mat\", \"A\", @)",
    "readMatrix(\"a.mat\", \"A\", @, 1)",
    "plotArray(@, @)",
    "simulateExtendedModel(\"#\", initialNames = {\"k\"}, initialValues = @, finalNames = {\"x\"})",
    "import #.#;",
    "clear",
    "cd ..",
    "convertClass(@, \"b\")",
    "regex(@, @, @);",
    "#(@, u = @)",
];

const EXPRESSIONS: &[&str] = &[
    "1",
    "-2.5",
    "1e300",
    "9223372036854775807",
    "true",
    "\"a\"",
    "\"(\"",
    "#",
    "#[@]",
    "#.#",
    "{@, @}",
    "[@, @; @, @]",
    "@ + @",
    "@*@",
    "@/@",
    "@^@",
    "@ < @",
    "@ and @",
    "not @",
    "-@",
    "@:@",
    "@:@:@",
    "{@ for i in @}",
    "sum(@ for i in 1:3)",
    "if @ then @ else @",
    "size(@, 1)",
    "fill(@, 2)",
    "zeros(@)",
    "String(@)",
    "transpose(@)",
    "cat(1, @, @)",
    "sin(@)",
    "#(@)",
    "{}",
    "end",
    "fill(0, 0)",
    "identity(@)",
    "linspace(0, 1, @)",
    "mod(@, @)",
    "#(u = @)",
];

const NAMES: &[&str] = &["a", "b", "f", "M", "R", "x", "k"];

/// Fills the pieces with the next choices; simple pieces where it gets deep.
fn filled(piece: &str, choices: &mut impl Iterator<Item = usize>, depth: usize) -> String {
    let mut text = String::new();
    for character in piece.chars() {
        let choice = choices.next().unwrap_or(0);
        match character {
            '#' => text.push_str(NAMES[choice % NAMES.len()]),
            '@' if depth == 0 => text.push_str(EXPRESSIONS[choice % 8]),
            '@' => {
                let inner = EXPRESSIONS[choice % EXPRESSIONS.len()];
                text.push_str(&filled(inner, choices, depth - 1));
            }
            other => text.push(other),
        }
    }
    text
}

fn script() -> impl Strategy<Value = String> {
    let choices = proptest::collection::vec(0usize..10_000, 20..600);
    choices.prop_map(|choices| {
        let mut choices = choices.into_iter();
        let mut text = String::new();
        while let Some(choice) = choices.next() {
            let piece = STATEMENTS[choice % STATEMENTS.len()];
            text.push_str(&filled(piece, &mut choices, 3));
            text.push('\n');
        }
        text
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: std::env::var("GAPILIB_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(48),
        ..ProptestConfig::default()
    })]

    #[test]
    fn no_script_panics_or_hangs(text in script(), openmodelica in any::<bool>()) {
        let dialect = if openmodelica { Dialect::OpenModelica } else { Dialect::Dymola };
        let world = MemoryWorld::new().interrupted_after(3000);
        let mut session = Session::new(Box::new(world))
            .with_options(Options { dialect: Some(dialect), ..Options::default() });
        let status = session.run_text("fuzz.mos", &text);
        prop_assert!(status.code <= 1 || status.code == 130);
    }

    #[test]
    fn each_statement_alone_does_not_panic(text in script()) {
        let mut session = Session::new(Box::new(MemoryWorld::new().interrupted_after(3000)));
        for line in text.lines() {
            session.run_text("fuzz.mos", line);
        }
    }
}
