//! A flat model becomes a [`Dae`]: every variable a scalar, every equation a pair of scalars.

use super::builder::{Builder, Folding};
use super::calls_of_statements::AssertArguments;
use super::dae::{Dae, StateSelect, Variable, VariableKind};
use super::equation::{Assertion, Equation, Instance, Level};
use super::errors::{
    ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_SUPPORTED, PARAMETER_CYCLE, UNRESOLVED_REFERENCE,
};
use super::execution::Loops;
use super::expressions::{Lowered, Lowering, size_fault};
use super::function::Inverts;
use super::loops::LoopVariable;
use crate::diag::{Diagnostic, suggest};
use crate::fault;
use crate::flatten::{self, BaseType, FlatModel, Part, Variability};
use crate::source::Span;
use crate::symbolic::{Expr, Inverse, VarId, up_to_rounding};
use crate::syntax::ast::{self, EquationKind, Expression, ExpressionKind};
use rustc_hash::FxHashMap;
use std::ops::Range;
use std::sync::Arc;

/// Largest number of scalar equations.
const MAX_EQUATIONS: usize = 5_000_000;

/// The scalar system of a flat model.
pub(super) fn build(flat: &FlatModel) -> Result<Dae, Diagnostic> {
    let mut builder = Builder::new(flat);
    if let Err(error) = lower_all(flat, &mut builder) {
        let missing = builder.scalars.missing_strings.first();
        return Err(missing.map_or(error.clone(), |why| error.or_else("here", why)));
    }
    Ok(finished(builder))
}

fn lower_all(flat: &FlatModel, builder: &mut Builder) -> Result<(), Diagnostic> {
    builder.declare();
    builder.find_varying_strings();
    builder.find_discrete();
    builder.fold_constants()?;
    builder.dae.instances = flat.parts.iter().map(|part| part.instance.clone()).collect();
    builder.find_states();
    builder.bindings()?;
    let owners_of = |range| owners(&flat.parts, range);
    let owners = owners_of(|part| &part.equations);
    for (position, equation) in flat.equations.iter().enumerate() {
        builder.place.instance = owners.get(&position).copied();
        builder.equation(equation, &mut Vec::new())?;
    }
    let owners = owners_of(|part| &part.algorithms);
    for (position, statements) in flat.algorithms.iter().enumerate() {
        builder.place.instance = owners.get(&position).copied();
        builder.algorithm(statements)?;
    }
    builder.place.initial = true;
    let asserted = builder.dae.assertions.len();
    let owners = owners_of(|part| &part.initial_equations);
    for (position, equation) in flat.initial_equations.iter().enumerate() {
        builder.place.instance = owners.get(&position).copied();
        builder.equation(equation, &mut Vec::new())?;
    }
    builder.place.instance = None;
    for statements in &flat.initial_algorithms {
        builder.algorithm(statements)?;
    }
    builder.move_to_start(asserted);
    builder.partition_clocks()
}

/// The system with the code of its functions.
fn finished(mut builder: Builder) -> Dae {
    builder.dae.warnings.append(&mut builder.scalars.missing_strings);
    let (functions, warnings) = builder.calls.functions.finish();
    builder.dae.warnings.extend(warnings);
    for (function, code) in functions.codes.iter().enumerate() {
        for (input, inverse) in &code.inverses {
            let is_exact =
                match super::function::inverts(&functions, function as u32, *input, inverse) {
                    Inverts::Everywhere => true,
                    Inverts::Somewhere => false,
                    Inverts::Nowhere => continue,
                };
            let inverse = Inverse { is_exact, ..inverse.clone() };
            builder.dae.pool.declare_inverse(function as u32, *input, inverse);
        }
    }
    builder.dae.functions = Arc::new(functions);
    builder.dae
}

impl<'a> Builder<'a> {
    /// All scalars, time first.
    fn declare(&mut self) {
        let mut time = scalar_of_nothing("time", VariableKind::Time, Span::NONE);
        time.unit = "s".into();
        time.description = "simulated time".into();
        self.dae.variables.push(time);
        for variable in self.flat.variables.values() {
            self.scalars.first.push(VarId(self.dae.variables.len() as u32));
            for position in 0..variable.len() {
                let mut scalar = declared(variable, position);
                if matches!(variable.base, BaseType::Enumeration(_)) {
                    // The default is the first literal (MLS §4.9.5).
                    scalar.start = Some(self.dae.pool.constant(1.0));
                }
                self.dae.variables.push(scalar);
            }
        }
    }

    /// Values of constants and of parameters that cannot be set.
    fn fold_constants(&mut self) -> Result<(), Diagnostic> {
        (0..self.flat.variables.len()).try_for_each(|position| self.fold(position))
    }

    /// Replaces a constant or fixed parameter by its value if its binding has one.
    pub(super) fn fold(&mut self, position: usize) -> Result<(), Diagnostic> {
        let variable = &self.flat.variables[position];
        let fixed = variable.variability <= Variability::Parameter && !variable.is_tunable();
        match (self.scalars.folding[position], &variable.binding) {
            (Folding::Done, _) => return Ok(()),
            (Folding::InProgress, _) => {
                return Err(fault!(PARAMETER_CYCLE, "`{}` depends on itself", variable.name)
                    .at(variable.span));
            }
            (Folding::Unvisited, Some(binding)) if fixed && variable.base != BaseType::String => {
                self.scalars.folding[position] = Folding::InProgress;
                self.calls.functions.take_exhausted();
                let array = self.parameter_value(binding, &variable.dims)?;
                if let (Some(words), Variability::Constant) =
                    (self.calls.functions.take_exhausted(), variable.variability)
                {
                    let name = &variable.name;
                    return Err(fault!(NO_CONSTANT_VALUE, "`{name}` has no value: {words}";
                        help: "{}", crate::budget::REMEDY)
                    .at(binding.span));
                }
                for (at, element) in array.elements.iter().enumerate() {
                    if let Some(value) = self.dae.pool.as_constant(*element) {
                        let id = self.scalars.first[position].0 as usize + at;
                        self.dae.variables[id].kind = VariableKind::Constant(value);
                    }
                }
            }
            _ => {}
        }
        self.scalars.folding[position] = Folding::Done;
        Ok(())
    }

    /// Bindings of parameters, binding equations of variables, attributes.
    fn bindings(&mut self) -> Result<(), Diagnostic> {
        let parts = self.flat.parts.iter().zip(0..);
        let instances: FxHashMap<&str, Instance> =
            parts.map(|(part, number)| (&*part.instance, Instance(number))).collect();
        for (position, variable) in self.flat.variables.values().enumerate() {
            if variable.base == BaseType::String {
                self.varying_text(position)?;
                continue;
            }
            let first = self.scalars.first[position].0 as usize;
            let holder = variable.name.rsplit_once('.').map_or("", |(holder, _)| holder);
            let instance = instances.get(holder).copied();
            let is_parameter =
                variable.variability <= Variability::Parameter || is_bound_object(variable);
            if let Some(values) = self.known_values(position) {
                // Known from the pass before: a function that prints is not called again.
                for (at, value) in values.into_iter().enumerate() {
                    self.dae.variables[first + at].binding = Some(self.dae.pool.constant(value));
                }
            } else if let Some(binding) = &variable.binding {
                let array = match self.sized(binding, &variable.dims) {
                    Err(e)
                        if is_parameter && [NOT_SUPPORTED, NO_CONSTANT_VALUE].contains(&e.code) =>
                    {
                        // A function that prints is called now, and its value stays; one that
                        // writes files is called when the simulation starts.
                        self.parameter_value(binding, &variable.dims).map_err(|_| e)?
                    }
                    array => array?,
                };
                for (at, element) in array.elements.into_iter().enumerate() {
                    if is_parameter {
                        self.dae.variables[first + at].binding = Some(element);
                    } else {
                        let left = self.dae.pool.variable(VarId((first + at) as u32));
                        let equation = Equation::new(left, element, binding.span);
                        if matches!(binding.kind, ExpressionKind::Field { .. }) {
                            self.allow_continuous(equation);
                        }
                        self.dae.equations.push(Equation { instance, ..equation });
                    }
                }
            }
            self.attributes(variable, first)?;
        }
        Ok(())
    }

    /// The values of a variable with a binding all of whose scalars are constants.
    fn known_values(&self, position: usize) -> Option<Vec<f64>> {
        let variable = &self.flat.variables[position];
        variable.binding.as_ref()?;
        let first = self.scalars.first[position].0 as usize;
        let scalars = &self.dae.variables[first..first + variable.len()];
        let value = |scalar: &Variable| match scalar.kind {
            VariableKind::Constant(value) => Some(value),
            _ => None,
        };
        scalars.iter().map(value).collect()
    }

    fn attributes(&mut self, variable: &flatten::Variable, first: usize) -> Result<(), Diagnostic> {
        for (name, attribute) in &variable.attributes {
            let e = &attribute.value;
            match *name {
                "start" | "min" | "max" | "nominal" | "fixed" | "stateSelect" => {}
                "unit" | "displayUnit" => {
                    if let ExpressionKind::String(text) = &e.kind {
                        for scalar in &mut self.dae.variables[first..first + variable.len()] {
                            match *name {
                                "unit" => scalar.unit = text.clone(),
                                _ => scalar.display_unit = text.clone(),
                            }
                        }
                    }
                    continue;
                }
                _ => continue,
            }
            let array = Lowering::new(self).array(e)?;
            if !array.dims.is_empty() && array.dims != variable.dims {
                return Err(size_fault(&variable.dims, &array.dims).at(e.span));
            }
            for at in 0..variable.len() {
                let element = array.elements[if array.dims.is_empty() { 0 } else { at }];
                let known = match *name {
                    "fixed" | "stateSelect" => self.evaluate_structural(element)?,
                    _ => None,
                };
                let scalar = &mut self.dae.variables[first + at];
                match *name {
                    "start" => scalar.start = Some(element),
                    "min" => scalar.min = Some(element),
                    "max" => scalar.max = Some(element),
                    "nominal" => scalar.nominal = Some(element),
                    "stateSelect" => scalar.state_select = state_select(known, e.span)?,
                    _ => match known {
                        Some(value) => scalar.fixed = value != 0.0,
                        None => {
                            return Err(fault!(
                                NOT_SUPPORTED,
                                "`fixed` must be known at translation"
                            )
                            .at(e.span));
                        }
                    },
                }
            }
            if *name == "fixed" && variable.variability == Variability::Parameter {
                self.free_parameters(first..first + variable.len(), e.span)?;
            }
        }
        Ok(())
    }

    /// Parameters with `fixed = false` are found by the initial system; a binding is a start value.
    fn free_parameters(
        &mut self,
        scalars: std::ops::Range<usize>,
        span: Span,
    ) -> Result<(), Diagnostic> {
        for scalar in &mut self.dae.variables[scalars] {
            match scalar.kind {
                _ if scalar.fixed => {}
                VariableKind::Parameter { .. } => {
                    scalar.kind = VariableKind::Solved;
                    scalar.start = scalar.start.or(scalar.binding.take());
                }
                _ => {
                    let name = &scalar.name;
                    return Err(fault!(
                        NOT_SUPPORTED,
                        "`{name}` is a structural parameter and cannot have `fixed = false`"
                    )
                    .at(span));
                }
            }
        }
        Ok(())
    }

    fn equation(&mut self, equation: &ast::Equation, loops: &mut Loops) -> Result<(), Diagnostic> {
        if self.dae.equations.len() > MAX_EQUATIONS {
            return Err(
                fault!(NOT_SUPPORTED, "more than {MAX_EQUATIONS} equations").at(equation.span)
            );
        }
        match &equation.kind {
            EquationKind::Equal { left, right } => {
                for pair in self.equal(left, right, equation.span, loops)? {
                    self.push(pair);
                }
                Ok(())
            }
            EquationKind::For { indices, body } => self.for_equation(indices, body, loops),
            EquationKind::If { branches, otherwise } => {
                for pair in self.if_equation(branches, otherwise, equation.span, loops)? {
                    self.push(pair);
                }
                Ok(())
            }
            EquationKind::Call(call) => self.call_equation(call, loops),
            EquationKind::When { branches } if self.is_clocked(branches) => {
                self.clocked_when(branches, equation.span, loops)
            }
            EquationKind::When { branches } => self.when_equation(branches, equation.span, loops),
            EquationKind::Connect { .. } => {
                Err(fault!(NOT_SUPPORTED, "a connection is left in the flat model")
                    .at(equation.span))
            }
        }
    }

    pub(super) fn push(&mut self, equation: Equation) {
        let equation = Equation { instance: self.place.instance, ..equation };
        match self.place.initial {
            true => self.dae.initial_equations.push(equation),
            false => self.dae.equations.push(equation),
        }
    }

    /// The scalar equations of `left = right`.
    pub(super) fn equal(
        &mut self,
        left: &Expression,
        right: &Expression,
        span: Span,
        loops: &[LoopVariable<Expr>],
    ) -> Result<Vec<Equation>, Diagnostic> {
        if let ExpressionKind::Tuple(targets) = &left.kind {
            return self.tuple_equal(targets, right, span, loops);
        }
        let live = self.place.in_when;
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        lowering.live = live;
        let (mut a, mut b) = (lowering.lower(left)?, lowering.lower(right)?);
        if matches!(a, Lowered::Numbered(_)) || matches!(b, Lowered::Numbered(_)) {
            for (side, e) in [(&mut a, left), (&mut b, right)] {
                if !matches!(side, Lowered::Numbered(_)) {
                    *side = lowering.run_time_string(e)?;
                }
            }
            let left = lowering.number_of_text(a, span)?;
            let right = lowering.number_of_text(b, span)?;
            return Ok(vec![Equation::new(left, right, span)]);
        }
        let is_empty = |side: &Lowered<Expr>| side.shape().is_some_and(|shape| shape.is_empty());
        if (is_part_of_nothing(left) || is_part_of_nothing(right)) && is_empty(&a) && is_empty(&b) {
            return Ok(Vec::new());
        }
        let pairs = pairs(&a, &b, span)?;
        let of_record = |e: &Expression| matches!(e.kind, ExpressionKind::Field { .. });
        let is_record = matches!(a, Lowered::Record(_)) || of_record(left) || of_record(right);
        if is_record && !live && !self.place.initial {
            pairs.iter().for_each(|pair| self.allow_continuous(*pair));
        }
        Ok(pairs)
    }

    /// Lets an Integer within a record or among several outputs, such as the phase in the state of a
    /// medium or the indices of elements that are sorted, change between events where the function
    /// that computes it lets it. MLS §3.8.4 does not; libraries do it.
    fn allow_continuous(&mut self, pair: Equation) {
        for (side, other) in [(pair.left, pair.right), (pair.right, pair.left)] {
            if let Some(variable) = self.dae.pool.as_variable(side)
                && self.dae.variable(variable).kind == VariableKind::Discrete
                && self.dae.variable(variable).base != BaseType::Real
                && self.dae.varies(other)
            {
                self.dae.variables[variable.0 as usize].kind = VariableKind::Unknown;
            }
        }
    }

    /// `(a, , b) = f(x)`
    fn tuple_equal(
        &mut self,
        targets: &[Option<Expression>],
        right: &Expression,
        span: Span,
        loops: &[LoopVariable<Expr>],
    ) -> Result<Vec<Equation>, Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &right.kind else {
            return Err(fault!(ARRAY_MISMATCH, "an output list needs a function call").at(span));
        };
        let live = self.place.in_when;
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        lowering.live = live;
        let name = function.name();
        let outputs = match super::expressions::FunctionCalls::function(lowering.target, &name) {
            Some(user) => lowering.outputs_for(targets, &user, arguments, right.span)?,
            None => lowering.builtin_outputs(&name.to_string(), function, arguments, right.span)?,
        };
        let mut equations = Vec::new();
        for (position, target) in targets.iter().enumerate() {
            let Some(target) = target else { continue };
            let Some(output) = outputs.get(position) else {
                return Err(fault!(ARRAY_MISMATCH, "`{name}` has {} outputs", outputs.len())
                    .at(target.span));
            };
            let value = lowering.lower(target)?;
            let pairs = pairs(&value, output, span)?;
            if !live && !lowering.target.place.initial {
                pairs.iter().for_each(|pair| lowering.target.allow_continuous(*pair));
            }
            equations.extend(pairs);
        }
        Ok(equations)
    }

    fn for_equation(
        &mut self,
        indices: &[ast::ForIndex],
        body: &[ast::Equation],
        loops: &mut Loops,
    ) -> Result<(), Diagnostic> {
        let Some((index, inner)) = indices.split_first() else {
            return body.iter().try_for_each(|equation| self.equation(equation, loops));
        };
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.clone();
        for variable in lowering.loop_variables(index)? {
            loops.push(variable);
            let result = self.for_equation(inner, body, loops);
            loops.pop();
            result?;
        }
        Ok(())
    }

    /// Equations of all branches, pairwise: `0 = if c then left₁ - right₁ else left₂ - right₂`,
    /// with common left sides kept.
    fn if_equation(
        &mut self,
        branches: &[(Expression, Vec<ast::Equation>)],
        otherwise: &[ast::Equation],
        span: Span,
        loops: &mut Loops,
    ) -> Result<Vec<Equation>, Diagnostic> {
        let Some(((condition, body), rest)) = branches.split_first() else {
            return self.collect(otherwise, loops);
        };
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.clone();
        let is_initial = super::when::is_initial(condition);
        let condition = lowering.scalar(condition)?;
        if let Some(known) = self.dae.pool.as_constant(condition) {
            return match known != 0.0 {
                true => self.collect(body, loops),
                false => self.if_equation(rest, otherwise, span, loops),
            };
        }
        self.place.branches += 1;
        let asserted = self.dae.assertions.len();
        let first = self.collect(body, loops)?;
        self.dae.guard_assertions(asserted, condition);
        let asserted = self.dae.assertions.len();
        let second = self.if_equation(rest, otherwise, span, loops)?;
        self.place.branches -= 1;
        let not = self.dae.pool.not(condition);
        self.dae.guard_assertions(asserted, not);
        if first.len() != second.len() {
            return Err(fault!(
                super::errors::UNBALANCED_MODEL,
                "the branches of this if-equation have different numbers of equations, {} and {}",
                first.len(),
                second.len()
            )
            .help_if((first.is_empty() || second.is_empty()).then(|| {
                "write an equation for the same variables in each branch, also in `else`: without \
                 it they are not determined there"
                    .to_owned()
            }))
            .at(span));
        }
        // Paired by position, equations for different variables would be one, and the variables of
        // all branches one loop: the compressors of IBPSA, off with k = 1 and on with k/(k - 1).
        // The branch of `initial()` keeps its order unless a variable needs an equation of its own:
        // paired otherwise, the loops of the hysteresis models of the standard library become
        // linear, and chatter at their turning points.
        let reorders = !is_initial || first.iter().any(|e| self.determines_discrete(e));
        let second = if reorders { in_order_of(&first, second) } else { second };
        let pool = &mut self.dae.pool;
        let merged = first.into_iter().zip(second).map(|(a, b)| {
            if a.left == b.left {
                let right = pool.if_then_else(condition, a.right, b.right);
                return Equation { right, ..a };
            }
            let (x, y) = (pool.sub(a.left, a.right), pool.sub(b.left, b.right));
            let left = pool.constant(0.0);
            Equation { left, right: pool.if_then_else(condition, x, y), ..a }
        });
        Ok(merged.collect())
    }

    fn determines_discrete(&self, equation: &Equation) -> bool {
        let variable = self.dae.pool.as_variable(equation.left);
        variable.is_some_and(|v| self.dae.variable(v).base != BaseType::Real)
    }

    /// The equations of a branch, not yet part of the system.
    pub(super) fn collect(
        &mut self,
        body: &[ast::Equation],
        loops: &mut Loops,
    ) -> Result<Vec<Equation>, Diagnostic> {
        let list = |builder: &mut Self| match builder.place.initial {
            true => std::mem::take(&mut builder.dae.initial_equations),
            false => std::mem::take(&mut builder.dae.equations),
        };
        let before = list(self);
        let result = body.iter().try_for_each(|equation| self.equation(equation, loops));
        let collected = list(self);
        match self.place.initial {
            true => self.dae.initial_equations = before,
            false => self.dae.equations = before,
        }
        result.map(|()| collected)
    }

    fn call_equation(
        &mut self,
        call: &Expression,
        loops: &[LoopVariable<Expr>],
    ) -> Result<(), Diagnostic> {
        let ExpressionKind::Call { function, arguments } = &call.kind else {
            return Err(fault!(NOT_SUPPORTED, "this is not an equation").at(call.span));
        };
        let name = function.name().to_string();
        match name.as_str() {
            "assert" => {
                let first = self.dae.assertions.len();
                self.assertion(arguments, call.span, loops)?;
                if let Some(active) = self.activity_here() {
                    self.dae.guard_assertions(first, active);
                }
                Ok(())
            }
            _ if name.starts_with("Connections.") => Ok(()),
            "transition" | "initialState" => {
                self.state_equation(&name, arguments, call.span, loops)
            }
            _ if self.activity_here().is_some() => Err(fault!(
                NOT_SUPPORTED,
                "a call of `{name}` as an equation of a state of a state machine"
            )
            .at(call.span)),
            _ => {
                let said = if self.place.initial { None } else { self.printing(call, loops)? };
                match said {
                    Some(Level::Message) => {
                        self.warn_of_telling(&name, call.span);
                        Ok(())
                    }
                    Some(_) => Ok(()),
                    None => self.call_statement(call, loops, self.place.initial),
                }
            }
        }
    }

    pub(super) fn assertion(
        &mut self,
        arguments: &ast::Arguments,
        span: Span,
        loops: &[LoopVariable<Expr>],
    ) -> Result<(), Diagnostic> {
        let AssertArguments { condition, message, level } = AssertArguments::new(arguments, span)?;
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.to_vec();
        lowering.live = true;
        let condition = lowering.scalar(condition)?;
        let level = match level {
            Some(level) if lowering.shaping(level)? == 1.0 => Level::Warning,
            _ => Level::Error,
        };
        let condition = up_to_rounding(&mut lowering.target.dae.pool, condition);
        let parts = self.parts_of_message(message, loops);
        self.dae.assertions.push(Assertion::new(condition, parts, level, span));
        Ok(())
    }
}

/// The equations of another branch, those with the same left side at the same place.
fn in_order_of(first: &[Equation], second: Vec<Equation>) -> Vec<Equation> {
    let mut places: FxHashMap<Expr, Vec<usize>> = FxHashMap::default();
    for (at, equation) in second.iter().enumerate().rev() {
        places.entry(equation.left).or_default().push(at);
    }
    let mut same = |equation: &Equation| places.get_mut(&equation.left)?.pop();
    let found: Vec<Option<usize>> = first.iter().map(&mut same).collect();
    let mut is_taken = vec![false; second.len()];
    found.iter().flatten().for_each(|at| is_taken[*at] = true);
    let mut others = (0..second.len()).filter(|at| !is_taken[*at]);
    let order = found.into_iter().map(|at| at.or_else(|| others.next()));
    order.flatten().map(|at| second[at]).collect()
}

/// Scalar equations of two values of one shape.
fn pairs(a: &Lowered<Expr>, b: &Lowered<Expr>, span: Span) -> Result<Vec<Equation>, Diagnostic> {
    let (Some(x), Some(y)) = (a.shape(), b.shape()) else {
        return Err(fault!(NOT_SUPPORTED, "equations of Strings are not supported").at(span));
    };
    if x.holds_text() || y.holds_text() {
        return Err(fault!(NOT_SUPPORTED, "equations of Strings are not supported").at(span));
    }
    if x.len() != y.len() || std::mem::discriminant(&x) != std::mem::discriminant(&y) {
        return Err(fault!(
            ARRAY_MISMATCH,
            "the sides of this equation have different numbers of elements, {} and {}",
            x.len(),
            y.len()
        )
        .at(span));
    }
    if let (Lowered::Array(x), Lowered::Array(y)) = (a, b)
        && x.dims != y.dims
    {
        return Err(size_fault(&x.dims, &y.dims).at(span));
    }
    let (mut left, mut right) = (Vec::new(), Vec::new());
    a.append_scalars(&mut left);
    b.append_scalars(&mut right);
    let equation = |(left, right)| Equation::new(left, right, span);
    Ok(left.into_iter().zip(right).map(equation).collect())
}

/// Whether this is what a component of an array of components without elements is written as, such
/// as `ports.C` of `Port ports[0]`: the sizes of its parts are not known, and nothing depends on
/// them.
fn is_part_of_nothing(e: &Expression) -> bool {
    matches!(&e.kind, ExpressionKind::Array(elements) if elements.is_empty())
}

/// Whose the equations at these positions are.
fn owners(parts: &[Part], range: fn(&Part) -> &Range<usize>) -> FxHashMap<usize, Instance> {
    let parts = parts.iter().zip(0..);
    parts
        .flat_map(|(part, number)| range(part).clone().map(move |at| (at, Instance(number))))
        .collect()
}

/// The scalar at a position of a flat variable.
fn declared(variable: &flatten::Variable, position: usize) -> Variable {
    let name: Arc<str> = match variable.dims.is_empty() {
        true => variable.name.clone(),
        false => format!("{}[{}]", variable.name, subscripts(&variable.dims, position)).into(),
    };
    let kind = match (&variable.base, variable.variability) {
        (BaseType::String, _) => VariableKind::Text,
        (BaseType::Clock, _) => VariableKind::Clock,
        // Its constructor runs once, before the simulation, or when it starts.
        (BaseType::ExternalObject(_), _) if variable.binding.is_none() => VariableKind::Discrete,
        (BaseType::ExternalObject(_), _) => VariableKind::Parameter { tunable: false },
        (_, Variability::Constant | Variability::Parameter) => {
            VariableKind::Parameter { tunable: variable.is_tunable() }
        }
        (BaseType::Real, _) => VariableKind::Unknown,
        _ => VariableKind::Discrete,
    };
    Variable {
        name,
        kind,
        base: variable.base.clone(),
        variability: variable.variability,
        causality: variable.causality,
        top_level: variable.top_level,
        protected: variable.protected,
        is_relative: variable.is_relative,
        description: variable.description.clone().unwrap_or_default(),
        ..scalar_of_nothing("", kind, variable.span)
    }
}

/// The value of `stateSelect` by its ordinal.
fn state_select(ordinal: Option<f64>, span: Span) -> Result<StateSelect, Diagnostic> {
    match ordinal {
        Some(1.0) => Ok(StateSelect::Never),
        Some(2.0) => Ok(StateSelect::Avoid),
        Some(3.0) => Ok(StateSelect::Default),
        Some(4.0) => Ok(StateSelect::Prefer),
        Some(5.0) => Ok(StateSelect::Always),
        _ => Err(fault!(NOT_SUPPORTED, "`stateSelect` must be known at translation").at(span)),
    }
}

/// `2,3` for a row-major position.
fn subscripts(dims: &[usize], position: usize) -> String {
    let mut rest = position;
    let mut strings = vec![String::new(); dims.len()];
    for (text, size) in strings.iter_mut().zip(dims).rev() {
        *text = (rest % size + 1).to_string();
        rest /= size;
    }
    strings.join(",")
}

/// A Real without attributes.
pub(crate) fn scalar_of_nothing(name: &str, kind: VariableKind, span: Span) -> Variable {
    Variable {
        name: name.into(),
        kind,
        base: BaseType::Real,
        variability: Variability::Continuous,
        causality: None,
        top_level: false,
        protected: false,
        is_relative: false,
        unit: "".into(),
        display_unit: "".into(),
        description: "".into(),
        binding: None,
        start: None,
        fixed: false,
        min: None,
        max: None,
        nominal: None,
        state_select: StateSelect::Default,
        span,
    }
}

impl Builder<'_> {
    /// The fault of a name that nothing declares.
    pub(super) fn unresolved(&self, path: &str, span: Span) -> Diagnostic {
        fault!(UNRESOLVED_REFERENCE, "there is no variable `{path}` in `{}`", self.flat.name)
            .help_if(suggest::did_you_mean(path, self.flat.variables.keys().map(|n| &**n)))
            .at(span)
    }
}

/// The derivative of a variable, as a variable.
pub(crate) fn derivative_of(source: &Variable, of: VarId) -> Variable {
    let name = format!("der({})", source.name);
    let mut variable = scalar_of_nothing(&name, VariableKind::Derivative(of), source.span);
    if !source.unit.is_empty() {
        variable.unit = format!("{}/s", source.unit).into();
    }
    variable
}

/// An external object that is made before the simulation.
fn is_bound_object(variable: &crate::flatten::Variable) -> bool {
    matches!(variable.base, BaseType::ExternalObject(_)) && variable.binding.is_some()
}
