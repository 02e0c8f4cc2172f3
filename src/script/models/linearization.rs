//! Models linearized where a simulation ends, by their exact [`LinearPart`] there:
//!
//! ```text
//!   ẋ = f_x x + f_v v + f_u(s) u,  0 = g_x x + g_v v + g_u(s) u,  y = h_x x + h_v v + h_u(s) u
//!   A = f_x − f_v g_v⁻¹ g_x     B(s) = f_u − f_v g_v⁻¹ g_u
//!   C = h_x − h_v g_v⁻¹ g_x     D(s) = h_u − h_v g_v⁻¹ g_u        B(s) = Σ s^k B_k
//! ```
//!
//! The continuous inputs u at the top level are states that do not change, each the first of a chain with its
//! derivatives ([`input_chain`]).

use super::exported::with_inputs_to_come;
use super::input_chain;
use super::linear::Linear;
use super::simulation::{self, SimulationOptions, Translated};
use crate::Session;
use crate::causalize;
use crate::codegen::errors::NOT_LINEARIZED;
use crate::codegen::{InputChain, LinearEntry, LinearPart, ORDERS, Program, VariableInfo};
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::flatten::{BaseType, FlatModel, Variability, Variable};
use crate::results::ResultTable;
use crate::source::Span;
use crate::syntax::ast::CausalityPrefix;
use nalgebra::DMatrix;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Simulates the model translated last and linearizes it where the simulation ends. `outputs`: names of
/// variables; empty for the outputs of the model itself.
///
/// # Errors
/// A simulation that fails, a singular loop, names that the model does not have, inputs that states determine.
pub fn linearized(
    session: &mut Session,
    options: &SimulationOptions,
    outputs: &[String],
) -> Result<Linear, Vec<Diagnostic>> {
    let before = session.models.current.clone();
    let linear =
        with_inputs_to_come(session, |session| linearized_variant(session, options, outputs));
    session.models.current = before;
    linear
}

fn linearized_variant(
    session: &mut Session,
    options: &SimulationOptions,
    outputs: &[String],
) -> Result<Linear, Vec<Diagnostic>> {
    let at = session.call_site();
    let one = |error: Diagnostic| vec![error];
    let mut variant = None;
    let model = session.vary_current(|model, flat| {
        let (made, translated) = Variant::of(model, flat.clone(), outputs, at)?;
        variant = Some(made);
        Ok(Some(translated))
    })?;
    let Some(variant) = variant else { return Err(Vec::new()) };
    let done =
        simulation::simulate(session, &model, options).map_err(|unfinished| one(unfinished.why))?;
    variant.linear(&model.problem, &done.table).at(at).map_err(one)
}

/// A model compiled with its linear part.
struct Variant {
    linear: LinearPart,
    /// The chains of the inputs.
    chains: Vec<InputChain>,
    /// The states without those of the inputs, and the outputs.
    states: Vec<String>,
    outputs: Vec<String>,
    /// The variables of the model itself.
    own: BTreeSet<Arc<str>>,
}

impl Variant {
    /// The model with chains for its inputs and with its linear part.
    fn of(
        model: &Translated,
        mut flat: FlatModel,
        outputs: &[String],
        at: Span,
    ) -> Result<(Variant, Translated), Diagnostic> {
        let variables = model.program.variables();
        let outputs: Vec<String> = match outputs {
            [] => outputs_of(&model.program),
            names => {
                let found = names.iter().map(|name| model.program.find_variable(name));
                let found: Vec<usize> = found.collect::<Result<_, _>>().at(at)?;
                found.into_iter().map(|place| variables[place].name.to_string()).collect()
            }
        };
        let mut chains = Vec::new();
        for input in free_inputs(&flat) {
            chains.extend(input_chain::add(&mut flat, input).at(at)?);
        }
        let mut sorted = causalize::causalize(&flat)?;
        let linear = LinearPart::add_to(&mut sorted, &chains, &outputs).at(at)?;
        let states = LinearPart::states(&sorted, &chains).at(at)?;
        let own = variables.iter().map(|variable| variable.name.clone()).collect();
        let program = Program::compile(sorted)?;
        let variant = Variant { linear, chains, states, outputs, own };
        Ok((variant, Translated::new(&model.problem, flat, program)))
    }

    /// The linear model at the end of a simulation.
    fn linear(self, problem: &str, results: &ResultTable) -> Result<Linear, Fault> {
        let last = |name: &str| {
            Ok::<f64, Fault>(results.column(name)?.last().copied().unwrap_or(f64::NAN))
        };
        let (n, m) = (self.linear.n_states, self.linear.n_algebraic);
        let (inputs, outputs) = (self.chains.len(), self.outputs.len());
        let mut whole = DMatrix::zeros(n + m + outputs, n + m + ORDERS * inputs);
        for LinearEntry { row, column, value } in &self.linear.entries {
            whole[(*row, *column)] = match value {
                Ok(name) => last(name)?,
                Err(number) => *number,
            };
        }
        if whole.iter().any(|entry| !entry.is_finite()) {
            return Err(fault!(
                NOT_LINEARIZED,
                "the derivatives of `{problem}` cannot be computed at this point"
            ));
        }
        let Some(reduced) = reduced(whole, n, m) else {
            return Err(fault!(
                NOT_LINEARIZED,
                "the algebraic equations of `{problem}` are singular"
            ));
        };
        let of_inputs = |row: usize, rows: usize| {
            let entry = |order| {
                let column = move |j: usize| n + ORDERS * j + order;
                DMatrix::from_fn(rows, inputs, |i, j| reduced[(row + i, column(j))])
            };
            std::array::from_fn(entry)
        };
        let input_names: Vec<String> =
            self.chains.into_iter().map(|InputChain { states: [input, ..], .. }| input).collect();
        let all = |names: &[String]| names.iter().map(|name| last(name)).collect::<Result<_, _>>();
        Ok(Linear {
            x0: all(&self.states)?,
            u0: all(&input_names)?,
            a: reduced.view((0, 0), (n, n)).into_owned(),
            b: of_inputs(0, n),
            c: reduced.view((n, 0), (outputs, n)).into_owned(),
            d: of_inputs(n, outputs),
            results: results.only(|name| self.own.contains(name)),
            names: [self.states, input_names, self.outputs],
        })
    }
}

/// The continuous inputs at the top level that have no value of their own.
fn free_inputs(flat: &FlatModel) -> Vec<Variable> {
    let is_free = |variable: &&Variable| {
        variable.causality == Some(CausalityPrefix::Input)
            && variable.binding.is_none()
            && variable.variability == Variability::Continuous
            && variable.base == BaseType::Real
    };
    flat.variables.values().filter(is_free).cloned().collect()
}

/// The outputs of the model itself, Real and continuous.
fn outputs_of(program: &Program) -> Vec<String> {
    let is_output = |variable: &&VariableInfo| {
        variable.causality == Some(CausalityPrefix::Output) && variable.base == BaseType::Real
    };
    let outputs = program.variables().iter().filter(is_output);
    outputs.map(|variable| variable.name.to_string()).collect()
}

/// The Jacobian without its m algebraic unknowns and their equations, which stand after n states; `None`
/// where these equations are singular.
fn reduced(whole: DMatrix<f64>, n: usize, m: usize) -> Option<DMatrix<f64>> {
    if m == 0 {
        return Some(whole);
    }
    let equations = whole.rows(n, m).into_owned();
    let of_unknowns = equations.columns(n, m).into_owned();
    let solved = of_unknowns.lu().solve(&equations.remove_columns(n, m))?;
    let rest = whole.remove_rows(n, m);
    let by_unknowns = rest.columns(n, m).into_owned();
    Some(rest.remove_columns(n, m) - by_unknowns * solved)
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
        assert_near(&linear.b[0], &[-4.75, 1.0, 0.0]);
        assert_near(&linear.c, &[2.0, 0.25, 0.0]);
        assert_near(&linear.d[0], &[3.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn an_input_that_is_connected_or_negated_keeps_its_column() {
        let linear = linear(
            "model M block G input Real u; output Real y; Real x(start = 2, fixed = true); \
             equation der(x) = 4*u; y = x*x; end G; \
             input Real u; output Real y; G g; equation u = -g.u; y = g.y; end M;",
        )
        .expect("a linear model");
        assert_near(&linear.b[0], &[-4.0]);
        assert_near(&linear.c, &[4.0]);
        assert_near(&linear.d[0], &[0.0]);
    }

    /// C der(x) = u − x/R + L der(u), y = x + 2 der(u): what derivatives of the input do has matrices of its own,
    /// and A, B, C and D are not the whole model.
    #[test]
    fn derivatives_of_an_input_have_matrices_of_their_own() {
        let linear = linear(
            "model M input Real u; output Real y; Real x(start = 0, fixed = true); \
             equation 2*der(x) = u - x/4 + 3*der(u); y = x + 2*der(u); end M;",
        )
        .expect("a linear model");
        assert_near(&linear.a, &[-0.125]);
        assert_near(&linear.b[0], &[0.5]);
        assert_near(&linear.b[1], &[1.5]);
        assert_near(&linear.b[2], &[0.0]);
        assert_near(&linear.d[0], &[0.0]);
        assert_near(&linear.d[1], &[2.0]);
        let Err(fault) = linear.matrices() else { panic!("it has no matrix D") };
        assert!(fault.message.contains("derivative of its input `u`"), "{fault:?}");
        // (1.5 s + 0.5)/(s + 0.125) + 2 s
        let found = linear.response((0, 0), &[0.3]).expect("no pole");
        let s = crate::models::linear::Number::new(0.0, 0.3 * std::f64::consts::TAU);
        let expected = (s * 1.5 + 0.5) / (s + 0.125) + s * 2.0;
        assert!((found[0] - expected).norm() < 1e-12, "{found:?} {expected}");
        // 2 s² + 1.75 s + 0.5
        let zeros = linear.zeros((0, 0)).expect("an answer");
        assert_eq!(zeros.len(), 2, "{zeros:?}");
        for s in zeros {
            let value = s * s * 2.0 + s * 1.75 + 0.5;
            assert!(value.norm() < 1e-12, "{s}");
        }
        assert_eq!(linear.gain((0, 0)), Some(4.0));
    }
}
