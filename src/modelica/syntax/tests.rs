//! Reading, in small.

use super::ast::{ExpressionKind, InteractiveKind, Script, StatementKind};
use super::*;

fn script(text: &str) -> Script {
    parse_script(SourceId::NONE, text).unwrap_or_else(|error| panic!("{error:?}"))
}

/// One letter per statement: what kind it is and whether `;` ends it.
fn shape(text: &str) -> String {
    let letter = |kind: &InteractiveKind| match kind {
        InteractiveKind::Statement(statement) => match statement.kind {
            StatementKind::Assign { .. } => 'a',
            StatementKind::MultiAssign { .. } => 'm',
            StatementKind::For { .. } => 'f',
            StatementKind::If { .. } => 'i',
            StatementKind::While { .. } => 'w',
            StatementKind::When { .. } => 'h',
            _ => 's',
        },
        InteractiveKind::Expression(_) => 'e',
        InteractiveKind::Declaration(_) => 'd',
        InteractiveKind::Class(_) => 'c',
        InteractiveKind::Import(_) => 'p',
        InteractiveKind::Command { .. } => 'b',
    };
    script(text)
        .statements
        .iter()
        .flat_map(|one| std::iter::once(letter(&one.kind)).chain(one.semicolon.then_some(';')))
        .collect()
}

/// A script of many pieces, each of which is read by itself.
fn long_script(last: &str) -> String {
    let one = "x = 1; // a remark\nif x > 0 then\n  y = {1, 2};\nend if\nf(x)\n";
    one.repeat(4000) + last
}

#[test]
fn a_long_script_is_read_piece_by_piece_with_the_same_places() {
    let text = long_script("z = 2\n");
    let script = parse_script(SourceId::NONE, &text).expect("a script");
    assert_eq!(script.statements.len(), 4000 * 3 + 1);
    for statement in &script.statements {
        let written = &text[statement.span.start as usize..statement.span.end as usize];
        assert!(
            matches!(written, "x = 1" | "f(x)" | "z = 2") || written.starts_with("if x > 0"),
            "{written:?}"
        );
    }
}

#[test]
fn an_error_late_in_a_long_script_has_its_place() {
    for (last, code) in [
        ("z = 2 +;\n", "syntax-error"),
        ("z = (2\n", "unclosed-bracket"),
        ("end for\n", "mismatched-end"),
    ] {
        let text = long_script(last);
        let error = parse_script(SourceId::NONE, &text).expect_err("an error");
        assert_eq!(error.code.slug, code);
        assert!(error.span().start as usize >= text.len() - last.len(), "{last:?} {error:?}");
    }
}

#[test]
fn line_ends_close_statements() {
    assert_eq!(shape("x = 1\ny := 2; z = x\n+ y\nf(x,\n y)\n"), "aa;ae");
    assert_eq!(shape("f() // comment\ng()"), "ee");
    assert_eq!(shape("x = if a then 1\n else 2\ny = 3"), "aa");
    assert_eq!(shape("\u{feff}x = 1\r\ny = 2\r\n/* z\n */\r\n"), "aa");
}

#[test]
fn blocks_close_with_and_without_semicolon() {
    assert_eq!(
        shape("for i in 1:3 loop\n x = i\n f(x);\nend for\ny = 1\nwhile c loop end while;"),
        "faw;"
    );
    assert_eq!(shape("if a\n then\n x = 1\n elseif b then y = 2\n else\n z = 3\n end if"), "i");
    assert_eq!(shape("when a then x = 1; elsewhen b then y = 2; end when\nz"), "he");
}

#[test]
fn commands_are_not_calls() {
    assert_eq!(shape("clear\ncd\ncd ..\ncd C:/Test\nexit; clearlog"), "bbbbb;b");
    assert_eq!(shape("cd(\"x\")\ncd();exit(0)\nclear = 1\ncd := 2\n"), "ee;eaa");
    assert_eq!(shape("f()\ncd C:/a b // c\nx = 1"), "eba");
}

#[test]
fn classes_in_scripts_are_strict() {
    assert_eq!(
        shape(
            "function f\n input Real x;\n output Real y;\nalgorithm\n y := x\n ;\nend f\nf(1)\nx=1"
        ),
        "cea"
    );
    assert_eq!(
        shape("type T = Real(unit=\"V\")\nReal x = 1;\nparameter Real p[2,3] = {{1}}\nimport A.B;"),
        "cd;dp;"
    );
    assert!(parse_script(SourceId::NONE, "function f\n input Real x\n algorithm end f;").is_err());
}

#[test]
fn assignments_take_several_forms() {
    assert_eq!(shape("(a, , b) := f(x);a.b[1].c = 3 \"why\"\n(a, b) := (1, 2)\n"), "m;am");
}

#[test]
fn powers_bind_tighter_than_signs() {
    let kind = |text: &str| {
        parse_expression(SourceId::NONE, text).unwrap_or_else(|error| panic!("{error:?}")).kind
    };
    assert!(matches!(kind("-2^2"), ExpressionKind::Unary { .. }));
    assert!(matches!(kind("-2*3"), ExpressionKind::Unary { .. }));
    assert!(matches!(kind("-a+b"), ExpressionKind::Binary { .. }));
    assert!(matches!(kind("not a and b"), ExpressionKind::Binary { .. }));
    assert!(matches!(kind("1:2:3"), ExpressionKind::Range { step: Some(_), .. }));
    assert_eq!(kind("1e-7"), ExpressionKind::Real(1e-7));
    assert_eq!(kind("007"), ExpressionKind::Integer(7));
    assert_eq!(kind("99999999999999999999"), ExpressionKind::Real(1e20));
}

#[test]
fn hostile_nesting_is_an_error() {
    for text in ["(".repeat(100_000), "{".repeat(300), "- ".repeat(100_000), "not ".repeat(600)] {
        assert!(parse_expression(SourceId::NONE, &format!("{text}1")).is_err());
    }
    let sums = format!("{}1{}", "(".repeat(300), "+1*2)".repeat(300));
    assert!(parse_expression(SourceId::NONE, &sums).is_err());
    let list = format!("{{{}1}}", "a + (b * c), if x then y else z, ".repeat(2_000));
    assert!(parse_expression(SourceId::NONE, &list).is_ok());
    let conditions = "if a then b else ".repeat(10_000);
    assert!(parse_expression(SourceId::NONE, &format!("{conditions}c")).is_err());
    let loops = "for i in 1:2 loop ".repeat(10_000);
    assert!(parse_script(SourceId::NONE, &loops).is_err());
    assert!(parse_script(SourceId::NONE, &format!("x = {}", "(1;\n".repeat(10_000))).is_err());
    let classes: String = (0..10_000).map(|i| format!("model M{i} ")).collect();
    assert!(parse_stored_definition(SourceId::NONE, &classes).is_err());
}

#[test]
fn bytes_are_utf8_or_latin1() {
    assert_eq!(decode("\u{feff}x = \"é\"".as_bytes()), ("x = \"é\"".to_owned(), None));
    let (text, warning) = decode(b"x\n// 20 \xb0C");
    assert_eq!(text, "x\n// 20 °C");
    let message = warning.map(|fault| fault.message).unwrap_or_default();
    assert!(message.contains("line 2"), "{message}");
}

#[test]
fn places_end_with_the_last_token() {
    let text = "x = a + b // comment\n  \nf (1) ;";
    let script = parse_script(SourceId(0), text).unwrap_or_else(|error| panic!("{error:?}"));
    let written = |at: usize| {
        let span = script.statements[at].span;
        &text[span.start as usize..span.end as usize]
    };
    assert_eq!((written(0), written(1)), ("x = a + b", "f (1)"));
    let InteractiveKind::Statement(statement) = &script.statements[0].kind else {
        panic!("an assignment is a statement");
    };
    let StatementKind::Assign { value, .. } = &statement.kind else { panic!("it assigns") };
    assert_eq!(&text[value.span.start as usize..value.span.end as usize], "a + b");
}

#[test]
fn problems_of_simulate_model_are_read() {
    let text = "A.M(redeclare package P = Q, p = 2, c(d = 3))";
    let (name, arguments) = parse_class_with_modification(SourceId::NONE, text)
        .unwrap_or_else(|error| panic!("{error:?}"));
    assert_eq!((name.to_string().as_str(), arguments.len()), ("A.M", 3));
    let (name, arguments) = parse_class_with_modification(SourceId::NONE, " M ")
        .unwrap_or_else(|error| panic!("{error:?}"));
    assert_eq!((name.to_string().as_str(), arguments.len()), ("M", 0));
    assert!(parse_class_with_modification(SourceId::NONE, "M(p = 2").is_err());
    assert!(parse_class_with_modification(SourceId::NONE, "").is_err());
}

#[test]
fn moderate_nesting_is_read() {
    let brackets = format!("{}x{}", "{(f(".repeat(60), "))}".repeat(60));
    let sum = format!("x{}", " + x".repeat(490));
    let conditions = format!("{}c", "if a then b else ".repeat(150));
    for text in [brackets, sum, conditions] {
        let tree =
            parse_expression(SourceId::NONE, &text).unwrap_or_else(|error| panic!("{error}"));
        let again = parse_expression(SourceId::NONE, &print::expression(&tree));
        assert!(again.is_ok(), "{text}");
    }
}
