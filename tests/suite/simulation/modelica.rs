//! The small package `Modelica` of `models/`.

use crate::support::shipped;
use gapilib::Value;

/// The numbers of expressions, row by row, computed in one session.
fn numbers(expressions: &[&str]) -> Vec<Vec<f64>> {
    let statement = |(at, expression)| format!("x{at} := {expression};\n");
    let script: String = expressions.iter().enumerate().map(statement).collect();
    let run = shipped::run("test.mos", &script);
    assert_eq!(run.errors, "");
    let value = |at| run.session.variable(&format!("x{at}")).expect("assigned");
    (0..expressions.len()).map(|at| flattened(value(at))).collect()
}

fn flattened(value: &Value) -> Vec<f64> {
    match value {
        Value::Boolean(value) => vec![f64::from(u8::from(*value))],
        Value::Array(_) => value.as_reals().expect("an array of numbers").into_owned(),
        scalar => vec![scalar.as_real().expect("a number")],
    }
}

/// Factors multiplied give the matrix; columns of Q are orthonormal.
#[test]
fn factors_of_matrices_make_up_the_matrix() {
    let run = shipped::run(
        "test.mos",
        "A := [1, 2; 3, 4; 5, 7];\n\
         (Q, R, p) := Modelica.Math.Matrices.QR(A);\n\
         wrong1 := Modelica.Math.Matrices.norm(Q*R - A[:, p]);\n\
         wrong2 := Modelica.Math.Matrices.norm(transpose(Q)*Q - identity(2));\n\
         (Q, R, p) := Modelica.Math.Matrices.QR(A, false);\n\
         wrong3 := Modelica.Math.Matrices.norm(Q*R - A) + abs(R[2, 1]);\n\
         (s, U, VT) := Modelica.Math.Matrices.singularValues(A);\n\
         wrong4 := Modelica.Math.Matrices.norm(U[:, 1:2]*diagonal(s)*VT - A);\n\
         B := [1, 2; 3, 4];\n\
         (values, V) := Modelica.Math.Matrices.eigenValues(B);\n\
         wrong5 := Modelica.Math.Matrices.norm(B*V - V*diagonal(values[:, 1]));\n",
    );
    assert_eq!(run.errors, "");
    for name in ["wrong1", "wrong2", "wrong3", "wrong4", "wrong5"] {
        let wrong = run.session.variable(name).and_then(Value::as_real).expect("a number");
        assert!(wrong < 1e-12, "{name}: {wrong}");
    }
}

/// A generator gives the same numbers for the same seeds, and others for others; their mean and
/// variance are those of the equal distribution, 1/2 and 1/12.
#[test]
fn random_numbers_are_equally_distributed_and_repeatable() {
    for generator in ["Xorshift64star", "Xorshift128plus", "Xorshift1024star"] {
        let run = shipped::run(
            "test.mos",
            &format!(
                "import G = Modelica.Math.Random.Generators.{generator};\n\
                 s := G.initialState(614657, 30020);\n\
                 (first, s1) := G.random(s); (again, s1) := G.random(s);\n\
                 (other, s1) := G.random(G.initialState(614658, 30020));\n\
                 sum1 := 0; sum2 := 0;\n\
                 for i in 1:2000 loop (r, s) := G.random(s); sum1 := sum1 + r; sum2 := sum2 + (r - 0.5)^2; end for;\n\
                 mean := sum1/2000; variance := sum2/2000;\n"
            ),
        );
        assert_eq!(run.errors, "", "{generator}");
        let number = |name| run.session.variable(name).and_then(Value::as_real).expect("a number");
        assert_eq!(number("first").to_bits(), number("again").to_bits(), "{generator}");
        assert_ne!(number("first").to_bits(), number("other").to_bits(), "{generator}");
        assert!((number("mean") - 0.5).abs() < 0.03, "{generator}");
        assert!((number("variance") - 1.0 / 12.0).abs() < 0.006, "{generator}");
    }
}

/// Values of closed forms, or computed by hand.
#[test]
fn functions_give_the_values_of_textbooks() {
    let (e, pi) = (std::f64::consts::E, std::f64::consts::PI);
    let cases: &[(&str, &[f64])] = &[
        ("Modelica.Constants.pi", &[pi]),
        ("Modelica.Constants.F/Modelica.Constants.N_A/1.602176634e-19", &[1.0]),
        ("Modelica.Constants.R/(Modelica.Constants.k*Modelica.Constants.N_A)", &[1.0]),
        // Stefan-Boltzmann, CODATA 2018.
        ("Modelica.Constants.sigma/5.670374419e-8", &[1.0]),
        ("Modelica.Constants.epsilon_0/8.8541878128e-12", &[1.0]),
        ("Modelica.Math.sin(Modelica.Constants.pi/6)", &[0.5]),
        ("Modelica.Math.log10(1000)", &[3.0]),
        ("Modelica.Math.asinh(-2)", &[-(2.0_f64).asinh()]),
        ("Modelica.Math.acosh(2)", &[(2.0_f64).acosh()]),
        ("Modelica.Math.atan3(1, -1, 7)", &[0.75 * pi + 2.0 * pi]),
        ("Modelica.Math.wrapAngle(-1.5707963267948966, true)", &[1.5 * pi]),
        ("Modelica.Math.wrapAngle(9.42477796076938)", &[pi]),
        ("Modelica.Math.isPowerOf2(64)", &[1.0]),
        ("Modelica.Math.isPowerOf2(48)", &[0.0]),
        ("Modelica.Math.BooleanVectors.index({true, false, true})", &[1.0, 3.0]),
        ("Modelica.Math.BooleanVectors.enumerate({true, false, true})", &[1.0, 0.0, 2.0]),
        ("Modelica.Math.BooleanVectors.firstTrueIndex({false, false})", &[0.0]),
        ("Modelica.Math.Vectors.norm({3, -4})", &[5.0]),
        ("Modelica.Math.Vectors.norm({3, -4}, 1)", &[7.0]),
        ("Modelica.Math.Vectors.norm({3, -4}, 3)", &[91.0_f64.cbrt()]),
        ("Modelica.Math.Vectors.normalize({3, 4})", &[0.6, 0.8]),
        ("Modelica.Math.Vectors.find(2, {5, 2, 2})", &[2.0]),
        ("Modelica.Math.Vectors.interpolate({0, 1, 2}, {0, 10, 40}, 1.5)", &[25.0]),
        ("Modelica.Math.Vectors.interpolate({0, 1, 2}, {0, 10, 40}, 3)", &[70.0]),
        ("Modelica.Math.Vectors.relNodePositions(4)", &[0.0, 0.25, 0.75, 1.0]),
        ("Modelica.Math.Vectors.relNodePositions(2)", &[0.0, 1.0]),
        ("Modelica.Math.Matrices.solve([0, 2; 3, 1], {4, 5})", &[1.0, 2.0]),
        ("Modelica.Math.Matrices.inv([0, 2; 4, 0])", &[0.0, 0.25, 0.5, 0.0]),
        ("Modelica.Math.Matrices.det([0, 2, 1; 3, 1, 0; 1, 0, 5])", &[-31.0]),
        ("Modelica.Math.Matrices.trace([1, 2; 3, 4])", &[5.0]),
        ("Modelica.Math.Matrices.norm([3, 0; 4, 5])", &[45.0_f64.sqrt()]),
        ("Modelica.Math.Matrices.norm([1, -2; 3, 4], 1)", &[6.0]),
        ("Modelica.Math.Matrices.frobeniusNorm([1, 2; 2, 4])", &[5.0]),
        ("Modelica.Math.Matrices.cholesky([4, 2; 2, 10])", &[2.0, 1.0, 0.0, 3.0]),
        ("Modelica.Math.Matrices.exp([0, 1; 0, 0], 3)", &[1.0, 3.0, 0.0, 1.0]),
        ("Modelica.Math.Matrices.exp([10, 0; 0, -1])", &[e.powi(10), 0.0, 0.0, 1.0 / e]),
        ("Modelica.Math.Matrices.flipLeftRight([1, 2; 3, 4])", &[2.0, 1.0, 4.0, 3.0]),
        ("Modelica.Math.Matrices.eigenValues([0, 1; -5, -2])", &[-1.0, 2.0, -1.0, -2.0]),
        ("Modelica.Math.Matrices.singularValues([0, 2, 0; 3, 0, 0])", &[3.0, 2.0]),
        ("Modelica.Math.Matrices.rank([1, 2, 3; 2, 4, 6; 1, 0, 1])", &[2.0]),
        ("Modelica.Math.Matrices.rank([1, 0; 0, 0.1], 0.5)", &[1.0]),
        ("Modelica.Math.Matrices.conditionNumber([4, 0; 0, 0.5])", &[8.0]),
        ("Modelica.Math.Matrices.conditionNumber([2, 0; 1, 1], 1)", &[3.0]),
        ("Modelica.Math.Polynomials.evaluate({2, -3, 1}, 4)", &[21.0]),
        ("Modelica.Math.Polynomials.evaluateWithRange({1, 0, 0}, 0, 2, 3)", &[8.0]),
        ("Modelica.Math.Polynomials.derivative({2, -3, 1})", &[4.0, -3.0]),
        ("Modelica.Math.Polynomials.derivativeValue({2, -3, 1}, 4)", &[13.0]),
        ("Modelica.Math.Polynomials.secondDerivativeValue({1, 0, 0, 5}, 2)", &[12.0]),
        ("Modelica.Math.Polynomials.integral({6, 2})", &[3.0, 2.0, 0.0]),
        ("Modelica.Math.Polynomials.integralValue({6, 2}, 2, 1)", &[11.0]),
        ("Modelica.Math.Polynomials.fitting({0, 1, 2, 3}, {1, 2, 5, 10}, 2)", &[1.0, 0.0, 1.0]),
        ("Modelica.Math.Polynomials.roots({2, 0, 8})", &[0.0, 2.0, 0.0, -2.0]),
        ("Modelica.Units.Conversions.from_degC(25)", &[298.15]),
        ("Modelica.Units.Conversions.to_degF(373.15)", &[212.0]),
        ("Modelica.Units.Conversions.from_rpm(60)", &[2.0 * pi]),
        ("Modelica.Units.Conversions.from_bar(2)", &[2e5]),
        ("Modelica.Units.Conversions.to_kmh(10)", &[36.0]),
    ];
    let expressions: Vec<&str> = cases.iter().map(|(expression, _)| *expression).collect();
    for ((expression, expected), given) in cases.iter().zip(numbers(&expressions)) {
        assert_eq!(given.len(), expected.len(), "{expression}");
        for (given, expected) in given.iter().zip(*expected) {
            let error = (given - expected).abs();
            assert!(error <= 1e-9 * expected.abs().max(1e-6), "{expression}: {given} {expected}");
        }
    }
}
