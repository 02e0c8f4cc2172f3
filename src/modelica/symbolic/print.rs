//! Expressions as Modelica text.

use super::node::{Expr, Node, VarId};
use super::pool::Pool;

/// Longest text: shared subexpressions are written out wherever they occur, so the text of a small
/// pool can be exponentially long.
const LONGEST: usize = 20_000;

/// The text of an expression; a user function `i` is written `f<i>.<output>(…)`. Strings of more
/// than some thousand characters end in `…`.
pub fn print(pool: &Pool, expr: Expr, name: &dyn Fn(VarId) -> String) -> String {
    let mut text = String::new();
    let mut pending = vec![Piece::Operand(expr, 0)];
    while let Some(piece) = pending.pop() {
        if text.len() > LONGEST {
            text.push('…');
            return text;
        }
        match piece {
            Piece::Text(piece) => text.push_str(&piece),
            Piece::Operand(expr, binding) => {
                let node = pool.node(expr);
                let parenthesised = precedence(node) < binding;
                let pieces = pieces(pool, node, name);
                if parenthesised {
                    pending.push(Piece::Text(")".into()));
                }
                pending.extend(pieces.into_iter().rev());
                if parenthesised {
                    text.push('(');
                }
            }
        }
    }
    text
}

enum Piece {
    Text(String),
    /// An operand and how strongly it must bind to stand without parentheses.
    Operand(Expr, u8),
}

/// How strongly an operator binds (MLS §3.2).
fn precedence(node: &Node) -> u8 {
    match node {
        Node::If(..) => 0,
        Node::Or(..) => 1,
        Node::And(..) => 2,
        Node::Not(_) => 3,
        Node::Relation(..) => 4,
        Node::Add(..) | Node::Sub(..) | Node::Neg(_) => 5,
        Node::Constant(value) if value.0.is_sign_negative() => 5,
        Node::Mul(..) | Node::Div(..) => 6,
        Node::Pow(..) => 7,
        _ => 8,
    }
}

fn pieces(pool: &Pool, node: &Node, name: &dyn Fn(VarId) -> String) -> Vec<Piece> {
    let binary = |a: &Expr, symbol: &str, b: &Expr, left: u8, right: u8| {
        vec![
            Piece::Operand(*a, left),
            Piece::Text(format!(" {symbol} ")),
            Piece::Operand(*b, right),
        ]
    };
    let prefixed = |symbol: &str, a: &Expr, binding: u8| {
        vec![Piece::Text(symbol.to_owned()), Piece::Operand(*a, binding)]
    };
    match node {
        Node::Constant(value) => vec![Piece::Text(format!("{:?}", value.0))],
        Node::Variable(variable) => vec![Piece::Text(name(*variable))],
        Node::Neg(a) => prefixed("-", a, 6),
        Node::Not(a) => prefixed("not ", a, 4),
        Node::Add(a, b) => binary(a, "+", b, 5, 6),
        Node::Sub(a, b) => binary(a, "-", b, 5, 6),
        Node::Mul(a, b) => binary(a, "*", b, 6, 7),
        Node::Div(a, b) => binary(a, "/", b, 6, 7),
        Node::Pow(a, b) => binary(a, "^", b, 8, 8),
        Node::Relation(operator, a, b) => binary(a, operator.symbol(), b, 5, 5),
        Node::And(a, b) => binary(a, "and", b, 2, 3),
        Node::Or(a, b) => binary(a, "or", b, 1, 2),
        Node::If(condition, a, b) => vec![
            Piece::Text("if ".into()),
            Piece::Operand(*condition, 1),
            Piece::Text(" then ".into()),
            Piece::Operand(*a, 1),
            Piece::Text(" else ".into()),
            Piece::Operand(*b, 0),
        ],
        Node::Apply(id, arguments) => call(id.get().name.to_owned(), arguments.iter()),
        Node::Call { function, output, arguments } => {
            call(format!("f{function}.{output}"), pool.entries(*arguments).iter().copied())
        }
        Node::CallDerivative { function, output, inputs, arguments } => {
            let inputs: Vec<String> = inputs.iter().map(u32::to_string).collect();
            let head = format!("f{function}.{output}'{}", inputs.join("'"));
            call(head, pool.entries(*arguments).iter().copied())
        }
        Node::List(entries) => call(String::new(), entries.iter().copied()),
        Node::Solution { matrix, right, output, .. } => {
            call(format!("solve.{output}"), [*matrix, *right].into_iter())
        }
    }
}

fn call(head: String, arguments: impl Iterator<Item = Expr>) -> Vec<Piece> {
    let mut pieces = vec![Piece::Text(head), Piece::Text("(".into())];
    for (position, argument) in arguments.enumerate() {
        if position > 0 {
            pieces.push(Piece::Text(", ".into()));
        }
        pieces.push(Piece::Operand(argument, 0));
    }
    pieces.push(Piece::Text(")".into()));
    pieces
}
