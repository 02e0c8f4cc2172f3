//! The small package `Modelica` of `models/`.

use crate::shipped;
use gapilib::value::Value;

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
