//! Models linearized through their exact Jacobian.
//!
//! ```text
//!   ẋ = f(t, x, u, v),  0 = g(t, x, u, v),  y = h(t, x, u, v)
//!   A = f_x − f_v g_v⁻¹ g_x     B = f_u − f_v g_v⁻¹ g_u
//!   C = h_x − h_v g_v⁻¹ g_x     D = h_u − h_v g_v⁻¹ g_u
//! ```
//!
//! The continuous inputs u at the top level are made states that do not change, so that the
//! columns of x and u are found in the same way. The derivative of each is a state too: where
//! something depends on it, the model is no system of this form and is refused.

use super::linear::Linear;
use super::simulation::{self, SimulationOptions, Translated};
use crate::Session;
use crate::causalize;
use crate::codegen::errors::NOT_LINEARIZED;
use crate::codegen::{Access, LinearPart, Program};
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::flatten::{Attribute, BaseType, FlatModel, Variability, Variable};
use crate::results::ResultTable;
use crate::sim::{
    Events, Failure, OutputGrid, Residual, Settings, SimErrorKind, Simulator, Trajectory,
};
use crate::source::{SourceId, Span};
use crate::syntax;
use crate::syntax::ast::{
    CausalityPrefix, Comment, Equation, EquationKind, Expression, ExpressionKind,
};
use nalgebra::DMatrix;
use std::sync::Arc;

/// Simulates the model translated last and linearizes it where the simulation ends. `outputs`: names of
/// variables; empty for the outputs of the model itself.
///
/// # Errors
/// A simulation that fails, a singular loop, an output that depends on the derivative of an input, names
/// that the model does not have.
pub fn linearized(
    session: &mut Session,
    options: &SimulationOptions,
    outputs: &[String],
) -> Result<Linear, Vec<Diagnostic>> {
    let before = session.current_values();
    let linear = linearized_variant(session, options, outputs);
    session.restore_values(before);
    linear
}

fn linearized_variant(
    session: &mut Session,
    options: &SimulationOptions,
    outputs: &[String],
) -> Result<Linear, Vec<Diagnostic>> {
    let at = session.call_site();
    let one = |error: Diagnostic| vec![error];
    let mut inputs = Vec::new();
    let model = session
        .vary_current(|model, flat| with_states_for_inputs(model, flat.clone(), &mut inputs))?;
    LinearPart::refuse(model.program.sorted()).at(at).map_err(one)?;
    let done =
        simulation::simulate(session, &model, options).map_err(|unfinished| one(unfinished.why))?;
    let time = done.table.time.last().copied().unwrap_or(0.0);
    let last =
        |name: &str| Ok::<f64, Fault>(done.table.column(name)?.last().copied().unwrap_or(f64::NAN));
    let y0: Result<Vec<f64>, Fault> = model.state_names().map(|name| last(name)).collect();
    let y0 = y0.at(at).map_err(one)?;
    let system = session.system_with_values(&model).map_err(one)?;
    let settings = simulation::settings(&model.program.experiment(), options).at(at);
    let settings = Settings { output: OutputGrid::At(vec![time]), ..settings.map_err(one)? };
    let places = Places::of(&model, &inputs).at(at).map_err(one)?;
    let outputs = match outputs {
        [] => outputs_of(&model.program),
        names => {
            let place = |name: &String| model.program.find_variable(name);
            names.iter().map(place).collect::<Result<_, _>>().at(at).map_err(one)?
        }
    };
    let slopes = reduced(system, (&settings, time), &y0, &outputs)
        .map_err(|_| {
            Fault::new(
                NOT_LINEARIZED,
                format!("the derivatives of `{}` cannot be computed at this point", model.problem),
            )
        })
        .and_then(|slopes| {
            slopes.ok_or_else(|| {
                Fault::new(
                    NOT_LINEARIZED,
                    format!("the algebraic equations of `{}` are singular", model.problem),
                )
            })
        });
    let slopes = slopes.at(at).map_err(one)?;
    places.check(&slopes, &inputs, &model.problem).at(at).map_err(one)?;
    let own: Vec<String> = inputs.iter().map(|input| slope_element(input)).collect();
    let is_of_model = |name: &str| !own.iter().any(|slope| name.contains(slope.as_str()));
    let results = done.table.only(is_of_model);
    Ok(places.linear(&model, &slopes, &y0, inputs, &outputs, results))
}

/// The variant of a model whose continuous inputs are states, `None` without such; `inputs` are
/// their names.
fn with_states_for_inputs(
    model: &Translated,
    mut flat: FlatModel,
    inputs: &mut Vec<String>,
) -> Result<Option<Translated>, Diagnostic> {
    let free = |variable: &&Variable| {
        variable.causality == Some(CausalityPrefix::Input)
            && variable.binding.is_none()
            && variable.variability == Variability::Continuous
            && variable.base == BaseType::Real
    };
    let free: Vec<Variable> = flat.variables.values().filter(free).cloned().collect();
    if free.is_empty() {
        return Ok(None);
    }
    for variable in free {
        make_state(&mut flat, &variable);
        inputs.extend(element_names(&variable));
    }
    let program = Program::compile(causalize::causalize(&flat)?)?;
    Ok(Some(Translated::new(&model.problem, flat, program)))
}

/// The name of the derivative of an input.
fn slope_name(input: &str) -> String {
    format!("'derivative of {}'", input.replace('\'', "\""))
}

/// der(u) = rate, der(rate) = 0.
fn make_state(flat: &mut FlatModel, input: &Variable) {
    let literal = |kind| Attribute { value: Expression::new(kind, Span::NONE), is_final: false };
    let always = literal(ExpressionKind::Integer(crate::lower::StateSelect::Always as i64 + 1));
    let mut state = Variable { causality: None, ..input.clone() };
    state.attributes.insert("fixed", literal(ExpressionKind::Boolean(true)));
    state.attributes.insert("stateSelect", always);
    let slope: Arc<str> = slope_name(&input.name).into();
    let mut of_slope = Variable { name: slope.clone(), description: None, ..state.clone() };
    of_slope.attributes.retain(|name, _| matches!(*name, "fixed" | "stateSelect"));
    let mut equation = |left: String, right: String| {
        let side = |text: String| syntax::parse_expression(SourceId::NONE, &text);
        if let (Ok(left), Ok(right)) = (side(left), side(right)) {
            let kind = EquationKind::Equal { left, right };
            let comment = Comment::default();
            flat.equations.push(Equation { kind, comment, span: input.span });
        }
    };
    let zero = match input.dims.as_slice() {
        [] => "0".to_owned(),
        dims => {
            format!("zeros({})", dims.iter().map(usize::to_string).collect::<Vec<_>>().join(", "))
        }
    };
    equation(format!("der({})", input.name), slope.to_string());
    equation(format!("der({slope})"), zero);
    flat.variables.insert(input.name.clone(), state);
    flat.variables.insert(slope, of_slope);
}

/// The scalars of a variable, row-major.
fn element_names(variable: &Variable) -> Vec<String> {
    let mut names = vec![variable.name.to_string()];
    if variable.dims.is_empty() {
        return names;
    }
    let mut subscripts = vec![String::new()];
    for size in &variable.dims {
        let extended = |before: &String| {
            let comma = if before.is_empty() { "" } else { "," };
            (1..=*size).map(|i| format!("{before}{comma}{i}")).collect::<Vec<_>>()
        };
        subscripts = subscripts.iter().flat_map(extended).collect();
    }
    let name = names.remove(0);
    subscripts.iter().map(|subscript| format!("{name}[{subscript}]")).collect()
}

/// Positions of the outputs of the model itself, Real and continuous.
fn outputs_of(program: &Program) -> Vec<usize> {
    let variables = program.variables().iter().enumerate();
    let outputs = variables.filter(|(_, v)| {
        v.causality == Some(CausalityPrefix::Output) && matches!(v.base, BaseType::Real)
    });
    outputs.map(|(at, _)| at).collect()
}

/// Rows of the states' derivatives, then of the outputs; columns of the states. `None` where the
/// algebraic equations are singular.
fn reduced(
    mut system: crate::runtime::System,
    (settings, time): (&Settings, f64),
    y0: &[f64],
    outputs: &[usize],
) -> Result<Option<DMatrix<f64>>, Failure> {
    system.solve_loops(false);
    let (n, m, p) = (system.n_differential(), system.n_algebraic(), outputs.len());
    let mut y = vec![0.0; n + m];
    system.initialize(settings.start, &mut y)?;
    if settings.start < time {
        // Discrete variables have the values there that events have given them.
        let done =
            Simulator::new().resume(&mut system, settings, &mut y, &mut Trajectory::default());
        if let Err(error) = done {
            return Err(match error.kind {
                SimErrorKind::Initialization(failure) | SimErrorKind::Evaluation(failure) => {
                    failure
                }
                _ => Failure::Singular { block: 0 },
            });
        }
        system.solve_loops(false);
    }
    y[..n].copy_from_slice(y0);
    system.handle_event(time, &mut y)?;
    let whole = system.dense_jacobian(time, &y)?;
    let of_outputs = system.jacobian_of(outputs, time, &y)?;
    let mut rows = DMatrix::zeros(n + p, n + m);
    rows.view_mut((0, 0), (n, n + m)).copy_from(&whole.view((0, 0), (n, n + m)));
    rows.view_mut((n, 0), (p, n + m)).copy_from(&of_outputs);
    if m == 0 {
        return Ok(Some(rows));
    }
    let (g_x, g_v) = (whole.view((n, 0), (m, n)), whole.view((n, n), (m, m)));
    let Some(v_x) = g_v.into_owned().lu().solve(&g_x.into_owned()) else { return Ok(None) };
    let (of_x, of_v) = (rows.view((0, 0), (n + p, n)), rows.view((0, n), (n + p, m)));
    Ok(Some(of_x - of_v * v_x))
}

/// Where states and inputs stand among the states of the variant.
struct Places {
    states: Vec<usize>,
    /// With the sign that an input has as the alias of a state.
    inputs: Vec<(usize, f64)>,
    slopes: Vec<(usize, f64)>,
}

impl Places {
    fn of(model: &Translated, inputs: &[String]) -> Result<Places, Fault> {
        let names: Vec<String> = model.state_names().map(|name| name.to_string()).collect();
        let access = |name: &str| {
            let at = model.program.find_variable(name)?;
            match model.program.variables()[at].access {
                Access::Observed { column, negated } => Ok(Some((column, negated))),
                _ => Ok::<_, Fault>(None),
            }
        };
        let columns: Vec<_> = names.iter().map(|name| access(name)).collect::<Result<_, _>>()?;
        let place = |name: &str| {
            let input = access(name)?;
            let found = columns.iter().enumerate().find_map(|(at, state)| {
                let ((column, negated), (of, sign)) = (input?, (*state)?);
                (column == of).then_some((at, if negated == sign { 1.0 } else { -1.0 }))
            });
            found.ok_or_else(|| {
                fault!(
                    NOT_LINEARIZED,
                    "`{}` cannot be linearized: its states determine its input `{name}`",
                    model.problem
                )
            })
        };
        let of_inputs = inputs.iter().map(|name| place(name)).collect::<Result<Vec<_>, _>>()?;
        let slope = |name: &String| place(&slope_element(name));
        let of_slopes = inputs.iter().map(slope).collect::<Result<Vec<_>, _>>()?;
        let taken = |at: &usize| of_inputs.iter().chain(&of_slopes).any(|(of, _)| of == at);
        let states = (0..names.len()).filter(|at| !taken(at)).collect();
        Ok(Places { states, inputs: of_inputs, slopes: of_slopes })
    }

    /// Refuses models in which something but the input depends on its derivative.
    fn check(&self, slopes: &DMatrix<f64>, inputs: &[String], problem: &str) -> Result<(), Fault> {
        let n = self.states.len() + self.inputs.len() + self.slopes.len();
        let rows = self.states.iter().copied().chain(n..slopes.nrows());
        for row in rows {
            for (input, (column, _)) in inputs.iter().zip(&self.slopes) {
                if slopes[(row, *column)] != 0.0 {
                    return Err(fault!(NOT_LINEARIZED,
                        "`{problem}` depends on the derivative of its input `{input}`, so it is \
                         not a linear system of its states and inputs";
                        help: "filter the input with a first-order block"));
                }
            }
        }
        Ok(())
    }

    fn linear(
        &self,
        model: &Translated,
        slopes: &DMatrix<f64>,
        y0: &[f64],
        inputs: Vec<String>,
        outputs: &[usize],
        results: ResultTable,
    ) -> Linear {
        let n = y0.len();
        let part = |rows: &[usize], columns: &[(usize, f64)]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
                let (column, sign) = columns[j];
                sign * slopes[(rows[i], column)]
            })
        };
        let of_x: Vec<(usize, f64)> = self.states.iter().map(|at| (*at, 1.0)).collect();
        let of_y: Vec<usize> = (n..slopes.nrows()).collect();
        let names: Vec<String> = model.state_names().map(|name| name.to_string()).collect();
        let states = self.states.iter().map(|at| names[*at].clone()).collect();
        let variables = model.program.variables();
        let outputs = outputs.iter().map(|at| variables[*at].name.to_string()).collect();
        Linear {
            names: [states, inputs, outputs],
            x0: self.states.iter().map(|at| y0[*at]).collect(),
            u0: self.inputs.iter().map(|(at, sign)| sign * y0[*at]).collect(),
            a: part(&self.states, &of_x),
            b: part(&self.states, &self.inputs),
            c: part(&of_y, &of_x),
            d: part(&of_y, &self.inputs),
            results,
        }
    }
}

/// The derivative of an element of an input, `u[2]`.
fn slope_element(input: &str) -> String {
    match input.rfind('[').filter(|_| input.ends_with(']')) {
        Some(at) => format!("{}{}", slope_name(&input[..at]), &input[at..]),
        None => slope_name(input),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::MemoryWorld;

    fn linear(model: &str) -> Result<Linear, Vec<Diagnostic>> {
        let mut session = Session::new(Box::new(MemoryWorld::new()));
        session.load_text("m", model).map_err(|_| Vec::new())?;
        simulation::translate(&mut session, "M")?;
        linearized(
            &mut session,
            &SimulationOptions { stop: Some(0.0), ..SimulationOptions::default() },
            &[],
        )
    }

    fn assert_near(actual: &DMatrix<f64>, expected: &[f64]) {
        let actual: Vec<f64> = actual.transpose().iter().copied().collect();
        assert_eq!(actual.len(), expected.len(), "{actual:?}");
        for (a, b) in actual.iter().zip(expected) {
            assert!((a - b).abs() < 1e-9, "{actual:?} is not {expected:?}");
        }
    }

    #[test]
    fn a_system_with_a_loop_has_its_four_matrices() {
        let linear = linear(
            "model M input Real u(start = 0.5); input Real w[2]; output Real y; output Real z[2]; \
             parameter Real k = 3; Real x(start = 1.5, fixed = true); Real v(start = 1); \
             equation der(x) = -k*x*u + w[1] - v; v + v^3 = x + u; y = 2*x + 3*u^2; \
             z = {v, w[2]}; end M;",
        )
        .expect("a linear model");
        // v = 1 at x + u = 2, and dv = (dx + du)/(1 + 3 v²)
        assert_eq!(linear.names[0], ["x"]);
        assert_eq!(linear.names[1], ["u", "w[1]", "w[2]"]);
        assert_eq!(linear.names[2], ["y", "z[1]", "z[2]"]);
        assert_eq!((linear.x0, linear.u0), (vec![1.5], vec![0.5, 0.0, 0.0]));
        assert_near(&linear.a, &[-1.75]);
        assert_near(&linear.b, &[-4.75, 1.0, 0.0]);
        assert_near(&linear.c, &[2.0, 0.25, 0.0]);
        assert_near(&linear.d, &[3.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn an_input_that_is_connected_or_negated_keeps_its_column() {
        let linear = linear(
            "model M block G input Real u; output Real y; Real x(start = 2, fixed = true); \
             equation der(x) = 4*u; y = x*x; end G; \
             input Real u; output Real y; G g; equation u = -g.u; y = g.y; end M;",
        )
        .expect("a linear model");
        assert_near(&linear.b, &[-4.0]);
        assert_near(&linear.c, &[4.0]);
        assert_near(&linear.d, &[0.0]);
    }

    #[test]
    fn a_derivative_of_an_input_is_refused() {
        let wrong = linear("model M input Real u; output Real y; equation y = der(u); end M;");
        let Err(errors) = wrong else { panic!("it has no matrix D") };
        assert!(errors[0].message.contains("derivative of its input `u`"), "{:?}", errors[0]);
    }
}
