//! Properties of the parser: printing and reading again gives the same tree, and no text makes it
//! panic.

use gapilib::internals::name::{Ident, Name};
use gapilib::internals::source::{SourceId, Span, Spanned};
use gapilib::internals::syntax::ast::{
    Arguments, BinaryOperator, Comment, ComponentReference, Expression, ExpressionKind, ForIndex,
    InteractiveKind, InteractiveStatement, NamedArgument, ReferencePart, Script, Statement,
    StatementKind, Subscript, UnaryOperator,
};
use gapilib::internals::syntax::visit::{
    Rewrite, WithoutSpans, rewrite_script, rewrite_stored_definition,
};
use gapilib::internals::syntax::{parse_expression, parse_script, parse_stored_definition, print};
use proptest::prelude::*;

const BINARY: [BinaryOperator; 18] = [
    BinaryOperator::Add,
    BinaryOperator::Subtract,
    BinaryOperator::Multiply,
    BinaryOperator::Divide,
    BinaryOperator::Power,
    BinaryOperator::ElementwiseAdd,
    BinaryOperator::ElementwiseSubtract,
    BinaryOperator::ElementwiseMultiply,
    BinaryOperator::ElementwiseDivide,
    BinaryOperator::ElementwisePower,
    BinaryOperator::Less,
    BinaryOperator::LessEqual,
    BinaryOperator::Greater,
    BinaryOperator::GreaterEqual,
    BinaryOperator::Equal,
    BinaryOperator::NotEqual,
    BinaryOperator::And,
    BinaryOperator::Or,
];

const UNARY: [UnaryOperator; 5] = [
    UnaryOperator::Plus,
    UnaryOperator::Minus,
    UnaryOperator::ElementwisePlus,
    UnaryOperator::ElementwiseMinus,
    UnaryOperator::Not,
];

fn node(kind: ExpressionKind) -> Expression {
    Expression::new(kind, Span::NONE)
}

fn ident() -> impl Strategy<Value = Ident> {
    prop_oneof![
        Just("x"),
        Just("y1"),
        Just("_z"),
        Just("'a b.\\' c'"),
        Just("ifx"),
        Just("cd"),
        Just("exit"),
        Just("ende")
    ]
    .prop_map(Ident::new)
}

fn spanned(ident: Ident) -> Spanned<Ident> {
    Spanned { node: ident, span: Span::NONE }
}

fn subscript(inner: BoxedStrategy<Expression>) -> impl Strategy<Value = Subscript> {
    prop_oneof![
        1 => Just(Subscript::All(Span::NONE)),
        1 => Just(Subscript::Index(node(ExpressionKind::End))),
        3 => inner.prop_map(Subscript::Index),
    ]
}

fn reference(inner: BoxedStrategy<Expression>) -> impl Strategy<Value = ComponentReference> {
    let part = (ident(), prop::collection::vec(subscript(inner), 0..3))
        .prop_map(|(name, subscripts)| ReferencePart { name, subscripts });
    (any::<bool>(), prop::collection::vec(part, 1..3))
        .prop_map(|(global, parts)| ComponentReference { global, parts, span: Span::NONE })
}

fn function() -> impl Strategy<Value = ComponentReference> {
    let names = prop::collection::vec(ident(), 1..3);
    prop_oneof![
        names.prop_map(|parts| ComponentReference::from_name(&Name::new(parts), Span::NONE)),
        Just(ComponentReference::from_name(&Ident::new("der").into(), Span::NONE)),
    ]
}

fn indices(inner: BoxedStrategy<Expression>) -> impl Strategy<Value = Vec<ForIndex>> {
    let index = (ident(), prop::option::of(inner))
        .prop_map(|(name, range)| ForIndex { name: spanned(name), range });
    prop::collection::vec(index, 1..3)
}

fn named(inner: BoxedStrategy<Expression>) -> impl Strategy<Value = Vec<NamedArgument>> {
    let argument =
        (ident(), inner).prop_map(|(name, value)| NamedArgument { name: spanned(name), value });
    prop::collection::vec(argument, 0..3)
}

fn arguments(inner: BoxedStrategy<Expression>) -> impl Strategy<Value = Arguments> {
    let partial = (prop::collection::vec(ident(), 1..3), named(inner.clone())).prop_map(
        |(function, named)| {
            node(ExpressionKind::PartialApplication { function: Name::new(function), named })
        },
    );
    let positional = prop_oneof![5 => inner.clone(), 1 => partial];
    let plain = (prop::collection::vec(positional, 0..3), named(inner.clone()))
        .prop_map(|(positional, named)| Arguments { positional, named, iterators: Vec::new() });
    let reduction = (inner.clone(), indices(inner)).prop_map(|(element, iterators)| Arguments {
        positional: vec![element],
        named: Vec::new(),
        iterators,
    });
    prop_oneof![3 => plain, 1 => reduction]
}

fn leaf() -> impl Strategy<Value = Expression> {
    let real = prop_oneof![
        prop::num::f64::POSITIVE | prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL,
        Just(0.0),
        Just(f64::INFINITY)
    ];
    prop_oneof![
        real.prop_map(|value| ExpressionKind::Real(value.abs())),
        (0..i64::MAX).prop_map(ExpressionKind::Integer),
        any::<bool>().prop_map(ExpressionKind::Boolean),
        ".{0,8}".prop_map(|text| ExpressionKind::String(text.into())),
        "[\\\\\"nt\n\r'/*]{0,6}".prop_map(|text| ExpressionKind::String(text.into())),
        ident().prop_map(|name| {
            let reference = ComponentReference::from_name(&name.into(), Span::NONE);
            ExpressionKind::Reference(reference)
        }),
        Just(ExpressionKind::Tuple(Vec::new())),
    ]
    .prop_map(node)
}

fn expression() -> BoxedStrategy<Expression> {
    leaf().prop_recursive(5, 40, 4, |inner| compound(inner).prop_map(node)).boxed()
}

fn compound(inner: BoxedStrategy<Expression>) -> impl Strategy<Value = ExpressionKind> {
    let list = prop::collection::vec(inner.clone(), 0..4);
    let rows = prop::collection::vec(prop::collection::vec(inner.clone(), 1..3), 1..3);
    let branches = prop::collection::vec((inner.clone(), inner.clone()), 1..3);
    let boxed = inner.clone().prop_map(Box::new);
    prop_oneof![
        4 => (prop::sample::select(&BINARY[..]), inner.clone(), inner.clone()).prop_map(
            |(operator, left, right)| Expression::operation(operator, left, right, Span::NONE).kind
        ),
        2 => (prop::sample::select(&UNARY[..]), boxed.clone())
            .prop_map(|(operator, operand)| ExpressionKind::Unary { operator, operand }),
        1 => (branches, boxed.clone())
            .prop_map(|(branches, otherwise)| ExpressionKind::If { branches, otherwise }),
        1 => (boxed.clone(), prop::option::of(boxed.clone()), boxed.clone())
            .prop_map(|(start, step, stop)| ExpressionKind::Range { start, step, stop }),
        1 => reference(inner.clone()).prop_map(ExpressionKind::Reference),
        1 => (function(), arguments(inner.clone()).prop_map(Box::new))
            .prop_map(|(function, arguments)| ExpressionKind::Call { function, arguments }),
        1 => list.prop_map(ExpressionKind::Array),
        1 => (boxed.clone(), indices(inner.clone()))
            .prop_map(|(element, indices)| ExpressionKind::ArrayIteration { element, indices }),
        1 => rows.prop_map(ExpressionKind::Matrix),
        1 => prop::collection::vec(prop::option::of(inner.clone()), 2..4)
            .prop_map(ExpressionKind::Tuple),
        1 => (boxed.clone(), prop::collection::vec(subscript(inner), 1..3))
            .prop_map(|(base, subscripts)| ExpressionKind::Subscripted { base, subscripts }),
        1 => (boxed, ident()).prop_map(|(base, name)| ExpressionKind::Field { base: base.into(), name }),
    ]
}

fn statement() -> BoxedStrategy<Statement> {
    let made = |kind| Statement { kind, comment: Comment::default(), span: Span::NONE };
    let simple = prop_oneof![
        (reference(expression()), expression())
            .prop_map(|(target, value)| StatementKind::Assign { target, value }),
        (prop::collection::vec(prop::option::of(reference(expression())), 2..4), expression())
            .prop_map(|(targets, value)| StatementKind::MultiAssign { targets, value }),
        Just(StatementKind::Break),
        Just(StatementKind::Return),
    ];
    simple
        .prop_map(made)
        .prop_recursive(3, 10, 3, move |inner| {
            let body = prop::collection::vec(inner, 0..3);
            let branches = prop::collection::vec((expression(), body.clone()), 1..3);
            prop_oneof![
                (branches.clone(), body.clone())
                    .prop_map(|(branches, otherwise)| StatementKind::If { branches, otherwise }),
                (indices(expression()), body.clone())
                    .prop_map(|(indices, body)| StatementKind::For { indices, body }),
                (expression(), body)
                    .prop_map(|(condition, body)| StatementKind::While { condition, body }),
                branches.prop_map(|branches| StatementKind::When { branches }),
            ]
            .prop_map(made)
        })
        .boxed()
}

fn script() -> impl Strategy<Value = Script> {
    let kind = prop_oneof![
        statement().prop_map(InteractiveKind::Statement),
        expression().prop_map(InteractiveKind::Expression),
    ];
    // A statement that begins with a dot reads as the rest of an open line.
    let one =
        kind.prop_map(|kind| InteractiveStatement { kind, semicolon: true, span: Span::NONE });
    (prop::collection::vec((one, any::<bool>()), 0..5)).prop_map(|all| {
        let mut statements: Vec<InteractiveStatement> = Vec::new();
        for (mut one, semicolon) in all {
            one.semicolon = semicolon;
            if let Some(before) = statements.last_mut() {
                before.semicolon |= print_one(&one).starts_with('.');
            }
            statements.push(one);
        }
        Script { statements, span: Span::NONE }
    })
}

fn print_one(statement: &InteractiveStatement) -> String {
    print::script(&Script { statements: vec![statement.clone()], span: Span::NONE })
}

/// A piece of text that is likely to confuse.
fn piece() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "(",
        ")",
        "[",
        "]",
        "{",
        "}",
        ";",
        ",",
        "\n",
        " ",
        "=",
        ":=",
        "==",
        ".",
        ":",
        "+",
        "-",
        "end",
        "if",
        "then",
        "else",
        "elseif",
        "for",
        "loop",
        "when",
        "while",
        "end if",
        "end for",
        "model M",
        "end M",
        "function f",
        "extends",
        "annotation(",
        "x",
        "1",
        "1.5e",
        "\"",
        "'",
        "//",
        "/*",
        "*/",
        "cd ",
        "clear",
        "equation",
        "algorithm",
        "protected",
        "import A.*",
        "\u{1e}",
        "\u{feff}",
        "ö",
        "\\",
        "#",
        "not ",
        "pure(",
        "der(",
        "enumeration(",
        "redeclare ",
        "each ",
        "break",
        "(,)",
    ])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn expressions_read_back(tree in expression()) {
        let text = print::expression(&tree);
        let again = parse_expression(SourceId::NONE, &text);
        let mut again = again.map_err(|error| TestCaseError::fail(format!("{error}: {text}")))?;
        WithoutSpans.expression(&mut again);
        prop_assert_eq!(again, tree, "{}", text);
    }

    #[test]
    fn scripts_read_back(tree in script()) {
        let text = print::script(&tree);
        let again = parse_script(SourceId::NONE, &text);
        let mut again = again.map_err(|error| TestCaseError::fail(format!("{error}: {text}")))?;
        rewrite_script(&mut WithoutSpans, &mut again);
        prop_assert_eq!(again, tree, "{}", text);
    }

    #[test]
    fn no_text_makes_the_parser_panic(pieces in prop::collection::vec(piece(), 0..30)) {
        let text: String = pieces.concat();
        let spaced = pieces.join(" ");
        for text in [&text, &spaced] {
            script_reads_back(text)?;
            classes_read_back(text)?;
        }
    }
}

/// If the text is a script, its printed form is the same script.
fn script_reads_back(text: &str) -> Result<(), TestCaseError> {
    let Ok(mut tree) = parse_script(SourceId::NONE, text) else { return Ok(()) };
    let printed = print::script(&tree);
    let again = parse_script(SourceId::NONE, &printed);
    let mut again =
        again.map_err(|error| TestCaseError::fail(format!("{error}: {text:?} as {printed:?}")))?;
    rewrite_script(&mut WithoutSpans, &mut tree);
    rewrite_script(&mut WithoutSpans, &mut again);
    prop_assert_eq!(again, tree, "{:?} as {:?}", text, printed);
    Ok(())
}

/// If the text is a file of classes, its printed form is the same file.
fn classes_read_back(text: &str) -> Result<(), TestCaseError> {
    let Ok(mut tree) = parse_stored_definition(SourceId::NONE, text) else { return Ok(()) };
    let printed = print::stored_definition(&tree);
    let again = parse_stored_definition(SourceId::NONE, &printed);
    let mut again =
        again.map_err(|error| TestCaseError::fail(format!("{error}: {text:?} as {printed:?}")))?;
    rewrite_stored_definition(&mut WithoutSpans, &mut tree);
    rewrite_stored_definition(&mut WithoutSpans, &mut again);
    prop_assert_eq!(again, tree, "{:?} as {:?}", text, printed);
    Ok(())
}

/// The corpora with a piece cut out, doubled, or replaced.
#[test]
fn damaged_texts_make_no_panic_and_read_back() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/grammar");
    for kind in ["valid", "invalid"] {
        for entry in std::fs::read_dir(folder.join(kind)).expect("the corpus is there") {
            let path = entry.expect("the entry is readable").path();
            if path.extension().is_none_or(|extension| extension == "snap") {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("the text is UTF-8");
            for damaged in damages(&text) {
                script_reads_back(&damaged).unwrap_or_else(|error| panic!("{error}"));
                classes_read_back(&damaged).unwrap_or_else(|error| panic!("{error}"));
            }
        }
    }
}

/// Some twenty damaged versions of a text.
fn damages(text: &str) -> impl Iterator<Item = String> {
    let places: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
    let step = (places.len() / 20).max(1);
    places.clone().into_iter().step_by(step).enumerate().map(move |(number, at)| {
        let (head, tail) = text.split_at(at);
        let next = tail.chars().next().map_or(0, char::len_utf8);
        match number % 4 {
            0 => format!("{head}{}", &tail[next..]),
            1 => format!("{head}{}{tail}", &tail[..next]),
            2 => head.to_owned(),
            _ => format!("{head} ;\n{tail}"),
        }
    })
}
