//! Tests of building, differentiating and solving expressions.

use super::*;
use proptest::prelude::*;

/// An expression of x0, x1, x2 before the pool sees it.
#[derive(Debug, Clone)]
enum Tree {
    Constant(f64),
    Variable(u32),
    Neg(Box<Tree>),
    Binary(char, Box<Tree>, Box<Tree>),
    Apply(&'static str, Box<Tree>),
    If(Box<Tree>, Box<Tree>, Box<Tree>),
}

impl Tree {
    fn value(&self, x: &[f64]) -> f64 {
        match self {
            Tree::Constant(value) => *value,
            Tree::Variable(i) => x[*i as usize],
            Tree::Neg(a) => -a.value(x),
            Tree::Binary(operator, a, b) => {
                let (a, b) = (a.value(x), b.value(x));
                match operator {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    '/' => a / b,
                    _ => a.powf(b),
                }
            }
            Tree::Apply(name, a) => {
                let function = function::find(name).unwrap().get();
                function.value.of(&[a.value(x)])
            }
            Tree::If(a, b, c) => {
                if a.value(x) > 0.0 {
                    b.value(x)
                } else {
                    c.value(x)
                }
            }
        }
    }

    /// Whether every part is finite and has a finite derivative: not so `tanh(x / 0)` and `sqrt(0)
    /// * 0`.
    fn regular(&self, x: &[f64]) -> bool {
        self.value(x).is_finite()
            && match self {
                Tree::Constant(_) | Tree::Variable(_) => true,
                Tree::Apply("sqrt" | "log", a) => a.regular(x) && a.value(x) > 0.0,
                Tree::Neg(a) | Tree::Apply(_, a) => a.regular(x),
                Tree::Binary('^', a, b) => a.regular(x) && b.regular(x) && a.value(x) > 0.0,
                Tree::Binary(_, a, b) => a.regular(x) && b.regular(x),
                Tree::If(a, b, c) => a.regular(x) && b.regular(x) && c.regular(x),
            }
    }

    fn build(&self, pool: &mut Pool) -> Expr {
        match self {
            Tree::Constant(value) => pool.constant(*value),
            Tree::Variable(i) => pool.variable(VarId(*i)),
            Tree::Neg(a) => {
                let a = a.build(pool);
                pool.neg(a)
            }
            Tree::Binary(operator, a, b) => {
                let (a, b) = (a.build(pool), b.build(pool));
                match operator {
                    '+' => pool.add(a, b),
                    '-' => pool.sub(a, b),
                    '*' => pool.mul(a, b),
                    '/' => pool.div(a, b),
                    _ => pool.pow(a, b),
                }
            }
            Tree::Apply(name, a) => {
                let a = a.build(pool);
                pool.function(name, &[a])
            }
            Tree::If(a, b, c) => {
                let (a, b, c) = (a.build(pool), b.build(pool), c.build(pool));
                let zero = pool.constant(0.0);
                let condition = pool.relation(RelationOperator::Greater, a, zero);
                pool.if_then_else(condition, b, c)
            }
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        prop_oneof![Just(0.0), Just(1.0), Just(-1.0), Just(2.0), -3.0..3.0]
            .prop_map(Tree::Constant),
        (0u32..3).prop_map(Tree::Variable),
    ];
    leaf.prop_recursive(5, 40, 3, |inner| {
        let boxed = inner.prop_map(Box::new);
        prop_oneof![
            boxed.clone().prop_map(Tree::Neg),
            (prop::sample::select(vec!['+', '-', '*', '/', '^']), boxed.clone(), boxed.clone())
                .prop_map(|(operator, a, b)| Tree::Binary(operator, a, b)),
            (prop::sample::select(vec!["sin", "exp", "tanh", "sqrt", "log", "abs"]), boxed.clone())
                .prop_map(|(name, a)| Tree::Apply(name, a)),
            (boxed.clone(), boxed.clone(), boxed).prop_map(|(a, b, c)| Tree::If(a, b, c)),
        ]
    })
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(0.3..1.7)
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * (1.0 + a.abs().max(b.abs()))
}

/// Central difference and an estimate of its error, from two step sizes.
fn difference(f: &dyn Fn(f64) -> f64) -> (f64, f64) {
    let partial = |h: f64| (f(h) - f(-h)) / (2.0 * h);
    let (wide, narrow) = (partial(2e-5), partial(1e-5));
    (narrow, (wide - narrow).abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn constructors_keep_the_value(tree in tree(), x in point()) {
        let expected = tree.value(&x);
        prop_assume!(expected.is_finite() && expected.abs() < 1e6);
        let mut pool = Pool::new();
        let expr = tree.build(&mut pool);
        let value = evaluate(&pool, expr, &x[..]);
        prop_assert!(close(value, expected, 1e-9), "{value} is not {expected}");
    }

    #[test]
    fn derivative_agrees_with_differences(tree in tree(), x in point(), which in 0usize..3) {
        let mut pool = Pool::new();
        let expr = tree.build(&mut pool);
        let partial = derivative(&mut pool, expr, VarId(which as u32));
        let at = |h: f64| {
            let mut x = x;
            x[which] += h;
            evaluate(&pool, expr, &x[..])
        };
        let (expected, uncertainty) = difference(&at);
        // Near a pole or a jump the difference says nothing.
        prop_assume!(tree.regular(&x) && at(0.0).abs() < 1e4);
        prop_assume!(expected.is_finite() && uncertainty < 1e-6 * (1.0 + expected.abs()));
        let value = evaluate(&pool, partial, &x[..]);
        prop_assert!(close(value, expected, 1e-5), "{value} is not {expected}");
    }

    #[test]
    fn substitution_is_evaluation_of_the_replacement(a in tree(), b in tree(), x in point()) {
        let mut pool = Pool::new();
        let (outer, inner) = (a.build(&mut pool), b.build(&mut pool));
        let replaced = substitute(&mut pool, outer, &|v| (v == VarId(1)).then_some(inner));
        let moved = [x[0], evaluate(&pool, inner, &x[..]), x[2]];
        let expected = evaluate(&pool, outer, &moved[..]);
        prop_assume!(expected.is_finite() && expected.abs() < 1e6);
        prop_assert!(close(evaluate(&pool, replaced, &x[..]), expected, 1e-9));
    }

    #[test]
    fn a_solution_solves(a in tree(), b in tree(), x in point()) {
        let mut pool = Pool::new();
        let (left, right) = (a.build(&mut pool), b.build(&mut pool));
        let Some(solution) = solve(&mut pool, left, right, VarId(0)) else { return Ok(()) };
        prop_assert!(!pool.depends_on(solution.value, VarId(0)));
        prop_assert!(!pool.depends_on(solution.divisor, VarId(0)));
        let divisor = evaluate(&pool, solution.divisor, &x[..]);
        let solved = [evaluate(&pool, solution.value, &x[..]), x[1], x[2]];
        let (l, r) = (evaluate(&pool, left, &solved[..]), evaluate(&pool, right, &solved[..]));
        prop_assume!(divisor.abs() > 1e-3 && solved[0].abs() < 1e3 && l.abs() < 1e6);
        prop_assume!(r.is_finite());
        prop_assert!(close(l, r, 1e-7), "{l} is not {r} at {solved:?}");
    }
}

#[test]
fn every_function_has_the_derivative_of_its_value() {
    let candidates = [[0.3, 0.8], [0.7, -0.4], [-0.6, 0.9], [2.3, 1.1], [-2.6, -0.7]];
    // Random values have no derivative.
    let smooth = |function: &function::Function| function.name != "RandomUniform";
    for (id, function) in function::functions().filter(|(_, function)| smooth(function)) {
        let mut checked = 0;
        for x in candidates.iter().map(|x| &x[..function.arity()]) {
            if !function.accepts(x) {
                continue;
            }
            let mut pool = Pool::new();
            let arguments: Vec<Expr> =
                (0..function.arity() as u32).map(|i| pool.variable(VarId(i))).collect();
            let expr = pool.apply(id, &arguments);
            for which in 0..function.arity() {
                let partial = derivative(&mut pool, expr, VarId(which as u32));
                let at = |h: f64| {
                    let mut x = x.to_vec();
                    x[which] += h;
                    evaluate(&pool, expr, &x[..])
                };
                let (expected, _) = difference(&at);
                let value = evaluate(&pool, partial, x);
                assert!(
                    close(value, expected, 1e-8),
                    "{} for argument {which} at {x:?}: {value} is not {expected}",
                    function.name
                );
                checked += 1;
            }
        }
        assert!(checked > 0, "no point lies in the domain of {}", function.name);
    }
}

#[test]
fn every_function_has_a_finite_value_exactly_in_its_domain() {
    let points = [-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0];
    for (_, function) in function::functions() {
        for x in points.iter().flat_map(|x| points.iter().map(move |y| [*x, *y])) {
            let x = &x[..function.arity()];
            // Rust defines atan2(0, 0), Modelica does not.
            let excluded = function.name == "atan2" && x == [0.0, 0.0];
            let finite = function.value.of(x).is_finite() && !excluded;
            assert_eq!(finite, function.accepts(x), "{} at {x:?}", function.name);
        }
    }
}

#[test]
fn rounding_functions_follow_the_examples_of_the_specification() {
    let value = |name: &str, x: &[f64]| function::find(name).unwrap().get().value.of(x);
    assert_eq!(value("mod", &[3.0, 1.4]), 3.0 - 2.0 * 1.4);
    assert_eq!(value("mod", &[-3.0, 1.4]), -3.0 + 3.0 * 1.4);
    assert_eq!(value("rem", &[3.0, 1.4]), 3.0 - 2.0 * 1.4);
    assert_eq!(value("rem", &[-3.0, 1.4]), -3.0 + 2.0 * 1.4);
    assert_eq!(value("div", &[-7.0, 2.0]), -3.0);
    assert_eq!(value("integer", &[-0.5]), -1.0);
    assert_eq!(value("sign", &[0.0]), 0.0);
    assert!(value("min", &[f64::NAN, 1.0]).is_nan());
    assert!(value("max", &[1.0, f64::NAN]).is_nan());
}

#[test]
fn random_numbers_are_uniform_and_repeatable() {
    let draw = |x: f64| function::find("RandomUniform").unwrap().get().value.of(&[x]);
    let draws: Vec<f64> = (0..10_000).map(|n| draw(f64::from(n) / 1000.0)).collect();
    assert!(draws.iter().all(|x| (0.0..1.0).contains(x)));
    let moment = |power: i32| draws.iter().map(|x| x.powi(power)).sum::<f64>() / 10_000.0;
    // Four standard deviations of the means of x and x².
    assert!((moment(1) - 0.5).abs() < 4.0 * (1.0f64 / 12.0).sqrt() / 100.0);
    assert!((moment(2) - 1.0 / 3.0).abs() < 4.0 * (4.0f64 / 45.0).sqrt() / 100.0);
    assert_eq!(draw(0.7), draws[700]);
    assert_eq!(draw(-0.0), draw(0.0));
}

#[test]
fn function_names_are_unique_and_found() {
    let mut names: Vec<&str> = function::functions()
        .flat_map(|(_, f)| std::iter::once(f.name).chain(f.aliases.iter().copied()))
        .collect();
    for (id, function) in function::functions() {
        assert_eq!(function::find(function.name), Some(id));
    }
    assert_eq!(function::find("ln"), function::find("log"));
    assert_eq!(function::find("der"), None);
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn local_rules_simplify() {
    let mut pool = Pool::new();
    let (x, y) = (pool.variable(VarId(0)), pool.variable(VarId(1)));
    let (zero, one, two) = (pool.constant(0.0), pool.constant(1.0), pool.constant(2.0));
    assert_eq!(pool.add(x, zero), x);
    assert_eq!(pool.mul(x, one), x);
    assert_eq!(pool.mul(zero, x), zero);
    assert_eq!(pool.pow(x, one), x);
    assert_eq!(pool.pow(x, zero), one);
    assert_eq!(pool.sub(x, x), zero);
    assert_eq!(pool.add(x, y), pool.add(y, x));
    let minus_x = pool.neg(x);
    assert_eq!(pool.neg(minus_x), x);
    assert_eq!(pool.add(y, minus_x), pool.sub(y, x));
    let minus_y = pool.neg(y);
    assert_eq!(pool.mul(minus_x, minus_y), pool.mul(x, y));
    assert_eq!(pool.if_then_else(one, x, y), x);
    assert_eq!(pool.relation(RelationOperator::Less, one, two), one);
}

#[test]
fn what_has_no_finite_value_is_not_folded() {
    let mut pool = Pool::new();
    let (zero, one) = (pool.constant(0.0), pool.constant(1.0));
    let quotient = pool.div(one, zero);
    assert_eq!(pool.node(quotient), &Node::Div(one, zero));
    let quotient = pool.div(zero, zero);
    assert_eq!(pool.node(quotient), &Node::Div(zero, zero));
    let logarithm = pool.function("log", &[zero]);
    assert!(pool.as_constant(logarithm).is_none());
}

#[test]
fn an_equation_through_exp_is_inverted() {
    let mut pool = Pool::new();
    let (x, y) = (pool.variable(VarId(0)), pool.variable(VarId(1)));
    let two = pool.constant(2.0);
    let inner = pool.mul(two, x);
    let power = pool.function("exp", &[inner]);
    let left = pool.add(power, y);
    let five = pool.constant(5.0);
    let solution = solve(&mut pool, left, five, VarId(0)).unwrap();
    let value = evaluate(&pool, solution.value, &[0.0, 1.0][..]);
    assert!(close(value, 0.5 * 4f64.ln(), 1e-15));
    let square = pool.pow(x, two);
    assert!(solve(&mut pool, square, five, VarId(0)).is_none());
}

#[test]
fn a_call_is_differentiated_by_the_chain_rule() {
    let mut pool = Pool::new();
    let x = pool.variable(VarId(0));
    let square = pool.mul(x, x);
    let call = pool.call(7, 1, &[square, x]);
    let partial = derivative(&mut pool, call, VarId(0));
    let text = print(&pool, partial, &|v| format!("x{}", v.0));
    assert_eq!(text, "f7.1'0(x0 * x0, x0) * (x0 + x0) + f7.1'1(x0 * x0, x0)");
    let second = derivative(&mut pool, partial, VarId(0));
    let text = print(&pool, second, &|v| format!("x{}", v.0));
    assert!(text.contains("f7.1'0'1(x0 * x0, x0)"), "{text}");
}

#[test]
fn printed_expressions_have_the_parentheses_they_need() {
    let mut pool = Pool::new();
    let (x, y) = (pool.variable(VarId(0)), pool.variable(VarId(1)));
    let mut text = |build: &dyn Fn(&mut Pool) -> Expr| {
        let expr = build(&mut pool);
        print(&pool, expr, &|v| ["x", "y"][v.0 as usize].to_owned())
    };
    let printed = text(&|p| {
        let sum = p.add(x, y);
        let difference = p.sub(x, sum);
        let two = p.constant(2.0);
        let power = p.pow(difference, two);
        p.div(x, power)
    });
    assert_eq!(printed, "x / (x - (x + y)) ^ 2.0");
    let printed = text(&|p| {
        let less = p.relation(RelationOperator::Less, x, y);
        let not = p.not(less);
        let minus = p.constant(-1.5);
        let power = p.pow(minus, x);
        let other = p.relation(RelationOperator::Greater, x, y);
        let both = p.and(not, other);
        p.if_then_else(both, power, y)
    });
    assert_eq!(printed, "if not x < y and x > y then (-1.5) ^ x else y");
    let printed = text(&|p| {
        let less = p.relation(RelationOperator::Less, x, y);
        let not = p.not(less);
        p.and(less, not)
    });
    assert_eq!(printed, "0.0", "nothing and its opposite");
}

#[test]
fn depth_is_no_limit() {
    let mut pool = Pool::new();
    let x = pool.variable(VarId(0));
    let mut expr = x;
    for _ in 0..20_000 {
        expr = pool.function("sin", &[expr]);
        expr = pool.add(expr, x);
    }
    assert!(evaluate(&pool, expr, &[0.1][..]).is_finite());
    let partial = derivative(&mut pool, expr, VarId(0));
    assert_eq!(pool.variables(partial), vec![VarId(0)]);
    assert!(print(&pool, partial, &|_| "x".into()).ends_with('…'));
    let one = pool.constant(1.0);
    let at_one = substitute(&mut pool, expr, &|_| Some(one));
    assert!(pool.as_constant(at_one).is_some());
}

#[test]
fn solutions_of_linear_systems_have_values_and_derivatives() {
    let mut pool = Pool::new();
    let [x, y] = [0, 1].map(|v| pool.variable(VarId(v)));
    let one = pool.constant(1.0);
    let sine = pool.function("sin", &[x]);
    // x u + sin(x) v = 1, u + y v = y
    let matrix = pool.list(&[x, sine, one, y]);
    let right = pool.list(&[one, y]);
    let exact = |x: f64, y: f64| (y - y * x.sin()) / (x * y - x.sin());
    let u = pool.solution(matrix, right, 0);
    assert!((evaluate(&pool, u, &[2.0, 3.0][..]) - exact(2.0, 3.0)).abs() < 1e-14);
    for (at, step) in [(0, [1e-6, 0.0]), (1, [0.0, 1e-6])] {
        let partial = derivative(&mut pool, u, VarId(at));
        let difference =
            (exact(2.0 + step[0], 3.0 + step[1]) - exact(2.0 - step[0], 3.0 - step[1])) / 2e-6;
        assert!((evaluate(&pool, partial, &[2.0, 3.0][..]) - difference).abs() < 1e-8);
    }
    // Of a second derivative too.
    let partial = derivative(&mut pool, u, VarId(0));
    let curvature = derivative(&mut pool, partial, VarId(0));
    let difference = (exact(2.001, 3.0) - 2.0 * exact(2.0, 3.0) + exact(1.999, 3.0)) / 1e-6;
    assert!((evaluate(&pool, curvature, &[2.0, 3.0][..]) - difference).abs() < 1e-4);
    let zero = pool.constant(0.0);
    let nothing = pool.list(&[zero, zero]);
    // Zero solves any homogeneous system; whether it is the only solution, solving tells.
    let solved = pool.solution(matrix, nothing, 1);
    assert_eq!(evaluate(&pool, solved, &[2.0, 3.0][..]), 0.0);
}

#[test]
fn outputs_of_a_call_share_its_arguments() {
    let mut pool = Pool::new();
    let arguments: Vec<Expr> = (0..50).map(|v| pool.variable(VarId(v))).collect();
    let outputs: Vec<Expr> = (0..50).map(|output| pool.call(0, output, &arguments)).collect();
    assert_eq!(pool.len(), 50 + 1 + 50);
    assert_eq!(pool.variables(outputs[7]).len(), 50);
    assert_eq!(pool.reachable(&outputs).len(), pool.len());
}

#[test]
fn containing_tells_what_is_made_of_a_leaf() {
    let mut pool = Pool::new();
    let (x, y) = (pool.variable(VarId(0)), pool.variable(VarId(1)));
    let mut containing = Containing::new(|pool, e| pool.as_variable(e) == Some(VarId(1)));
    let square = pool.mul(x, x);
    assert!(!containing.contains(&pool, square));
    let sum = pool.add(square, y);
    assert!(containing.contains(&pool, sum) && containing.contains(&pool, y));
    assert!(
        pool.any_variable(sum, |v| v == VarId(1)) && !pool.any_variable(square, |v| v == VarId(1))
    );
}
