//! Failures of simulations in the model's words: time, variables and places.

use super::execution::FailedOperation;
use crate::bytecode::{self, Reason};
use crate::causalize::Block;
use crate::codegen::errors::{
    ASSERTION_FAILED, DOMAIN_ERROR, INITIALIZATION_FAILED, SIMULATION_FAILED,
};
use crate::codegen::memory::Memory;
use crate::codegen::program::{Program, number_of_equations};
use crate::diag::{Code, Diagnostic};
use crate::fault;
use crate::sim::{Failure, Offending, SimError, SimErrorKind};
use crate::source::Span;
use crate::symbolic::VarId;
use crate::symbolic::function::Function;

/// What an operation has failed with.
fn why(operation: FailedOperation) -> String {
    match operation {
        FailedOperation::Division => "a division by zero or an overflow of a division".to_owned(),
        FailedOperation::Power => "a power without a finite result".to_owned(),
        FailedOperation::Function(function) => {
            format!("`{}` has no value: {}", function.name, domain(function))
        }
        FailedOperation::Other => "an operation without a finite result".to_owned(),
    }
}

/// What a function needs of its argument.
fn domain(function: &Function) -> &'static str {
    function.domain.map_or("the result is not finite", |domain| domain.words)
}

impl From<&bytecode::Failure> for Failure {
    fn from(failure: &bytecode::Failure) -> Failure {
        let bytecode::Failure { function, at, reason } = *failure;
        Failure::Function { function, at, reason: reason as u8 }
    }
}

impl Program {
    /// A failed simulation in the model's words.
    pub fn explain(&self, error: &SimError) -> Diagnostic {
        self.explain_with(error, None)
    }

    /// The same; `external`: the words of the external function that failed.
    pub(super) fn explain_with(&self, error: &SimError, external: Option<&str>) -> Diagnostic {
        let when = format!("at t = {}", error.time);
        match error.kind {
            SimErrorKind::Evaluation(failure) => self.explain_failure(failure, &when, external),
            SimErrorKind::Initialization(
                Failure::Newton { block } | Failure::Singular { block },
            ) => self.explain_block(self.block(block), &when, INITIALIZATION_FAILED),
            SimErrorKind::Initialization(failure) => self.explain_failure(failure, &when, external),
            other => self.explain_end(other, error.offending, &when),
        }
    }

    /// A simulation that ended where nothing failed by itself.
    fn explain_end(
        &self,
        kind: SimErrorKind,
        offending: Option<Offending>,
        when: &str,
    ) -> Diagnostic {
        let reason = match kind {
            SimErrorKind::StepSize => "the step size became too small",
            SimErrorKind::StepBudget => "the limit on the number of steps was reached",
            SimErrorKind::TimeBudget => "the time limit was reached",
            SimErrorKind::Singular => "the Jacobian is singular",
            SimErrorKind::Chattering => "events follow each other without end (chattering)",
            SimErrorKind::Accumulation => {
                "events accumulate, infinitely many up to this time (Zeno behaviour), and there \
                 is no solution beyond"
            }
            _ => "a value is not finite",
        };
        let (words, span) = match offending.and_then(|offending| self.offending(offending)) {
            Some((words, span)) => (format!("{reason}; {words}"), span),
            None => (reason.to_owned(), self.first_span()),
        };
        let may_escape =
            matches!((kind, offending), (SimErrorKind::StepSize, Some(Offending::Unknown(_))));
        let help = may_escape.then(|| {
            "check sign and range of the equations for it: the solution may grow beyond all bounds at \
             this time"
                .to_owned()
        });
        fault!(SIMULATION_FAILED, "the simulation of `{}` stopped {when}: {words}", self.name())
            .help_if(help)
            .at(span)
    }

    /// What was in the way, and where it is written.
    fn offending(&self, offending: Offending) -> Option<(String, Span)> {
        let dae = &self.sorted.dae;
        match offending {
            Offending::Unknown(at) => {
                let variable = dae.variable(*self.continuous.unknowns.get(at as usize)?);
                Some((format!("`{}` changes fastest", variable.name), variable.span))
            }
            Offending::Crossing(at) => {
                let relation =
                    dae.relations.get(*self.switching.crossing_relations.get(at as usize)?)?;
                Some(("this relation switches repeatedly".to_owned(), relation.span))
            }
        }
    }

    fn first_span(&self) -> Span {
        self.sorted.dae.equations.first().map_or(Span::NONE, |equation| equation.span)
    }

    /// The variable that the equation of this number is solved for, or the parameter of this number.
    pub(super) fn variable_of(&self, origin: u32) -> Option<VarId> {
        let sorted = &self.sorted;
        let blocks = sorted.blocks.iter().chain(&sorted.event_blocks).chain(&sorted.initial_blocks);
        let mut assignments = blocks.flat_map(Block::assignments);
        let solved = assignments.find(|a| a.equation == origin as usize).map(|a| a.variable);
        let declared = || origin.checked_sub(number_of_equations(sorted) as u32).map(VarId);
        let is_variable = |v: &VarId| (v.0 as usize) < sorted.dae.variables.len();
        solved.or_else(declared).filter(is_variable)
    }

    /// That the variable of an equation has no value, and why.
    pub(super) fn failed_value(&self, origin: u32, operation: u32, when: &str) -> String {
        let variable = self.variable_of(origin).map(|v| &*self.sorted.dae.variable(v).name);
        match (variable.filter(|name| !name.starts_with('$')), FailedOperation::of(operation)) {
            (Some(name), FailedOperation::Function(function)) => {
                let (words, function) = (domain(function), function.name);
                format!("`{name}` has no value {when}: in `{function}`, {words}")
            }
            (Some(name), operation) => format!("`{name}` has no value {when}: {}", why(operation)),
            (None, operation) => format!("{} {when}", why(operation)),
        }
    }

    fn without_value(&self, origin: u32, operation: u32, when: &str) -> Diagnostic {
        match self.linear_loop(origin) {
            Some(names) => fault!(
                SIMULATION_FAILED,
                "the linear algebraic loop of {names} has no unique solution {when}: its equations \
                 depend on each other, or contradict each other, with the values that they have then";
                help: "change the parameters that their coefficients consist of, or replace one of \
                       the equations"
            )
            .at(self.place(origin)),
            None => fault!(DOMAIN_ERROR, "{} {when}", why(FailedOperation::of(operation)))
                .at(self.place(origin)),
        }
    }

    fn explain_failure(&self, failure: Failure, when: &str, external: Option<&str>) -> Diagnostic {
        match failure {
            Failure::Domain { origin, operation } => self.without_value(origin, operation, when),
            Failure::Function { function, at, reason } => {
                let reason = Reason::ALL.get(usize::from(reason)).copied();
                let reason = reason.unwrap_or(Reason::NotFinite);
                let failure = bytecode::Failure { function, at, reason };
                let functions = &self.sorted.dae.functions;
                let (mut words, span) = functions.explain(&failure);
                if functions.message(&failure).is_some() {
                    return fault!(ASSERTION_FAILED, "{words} ({when})").at(span);
                }
                let external = external.filter(|_| failure.reason == Reason::External);
                let known = external.map(str::to_owned).or_else(|| self.external_message(failure));
                if let Some(message) = known {
                    words = format!("{words}: {message}");
                }
                fault!(DOMAIN_ERROR, "{words} ({when})").at(span)
            }
            Failure::Assertion { assertion } => match self.sorted.dae.assertion(assertion) {
                Some(failed) => {
                    fault!(ASSERTION_FAILED, "{} ({when})", failed.message).at(failed.span)
                }
                None => fault!(ASSERTION_FAILED, "an assertion fails {when}").at(self.first_span()),
            },
            Failure::Newton { block } => {
                self.explain_block(self.block(block), when, SIMULATION_FAILED)
            }
            Failure::Singular { block } => self.explain_singular(self.block(block), when),
            Failure::Initialization { block } => {
                let block = self.sorted.initial_blocks.get(block as usize);
                self.explain_block(block, when, INITIALIZATION_FAILED)
            }
            Failure::Inconsistent { check } => {
                let place = self.sorted.initial_checks.get(check as usize).map(|e| e.span);
                fault!(INITIALIZATION_FAILED,
                    "the initial values of `{}` are inconsistent: this does not hold {when}",
                    self.name(); help: "remove this initial equation or `fixed` start value, or change its value")
                .at(place.unwrap_or(Span::NONE))
            }
            Failure::EventIteration { variable } => self.explain_iteration(variable, when),
        }
    }

    /// Why an external function has no result, if it fails with the default parameters too.
    fn external_message(&self, failure: bytecode::Failure) -> Option<String> {
        if failure.reason != Reason::External {
            return None;
        }
        let mut memory = Memory::new(&self.registers);
        for (_, tape) in &self.values.parameter_tapes {
            if tape.run(&mut memory).is_err() && memory.calls.failure == Some(failure) {
                return Some(memory.calls.message().to_owned());
            }
        }
        None
    }

    fn explain_iteration(&self, variable: u32, when: &str) -> Diagnostic {
        let dae = &self.sorted.dae;
        let (relations, roundings) = (dae.relations.iter(), dae.events.roundings.iter());
        let mut frozen = relations.map(|r| (r.variable, r.span));
        let switching = frozen
            .find(|(v, _)| v.0 == variable)
            .or_else(|| roundings.map(|r| (r.variable, r.span)).find(|(v, _)| v.0 == variable));
        let (what, span) = match (switching, dae.variables.get(variable as usize)) {
            (Some((_, span)), _) => ("a relation".to_owned(), span),
            (None, Some(v)) if v.name.starts_with('$') => ("a condition".to_owned(), v.span),
            (None, Some(v)) => (format!("`{}`", v.name), v.span),
            (None, None) => ("a discrete variable".to_owned(), self.first_span()),
        };
        fault!(SIMULATION_FAILED, "event iteration does not converge {when}: {what} keeps changing";
            help: "use `pre(…)` where a variable depends on itself, or add a hysteresis")
        .labelled(span, "keeps changing")
    }

    /// A block by its number: those between events, then those at events.
    fn block(&self, block: u32) -> Option<&Block> {
        let (blocks, at_events) = (&self.sorted.blocks, &self.sorted.event_blocks);
        blocks.iter().chain(at_events).nth(block as usize)
    }

    fn explain_block(&self, block: Option<&Block>, when: &str, code: Code) -> Diagnostic {
        let Some((names, span)) = self.torn_loop(block) else {
            return fault!(code, "an algebraic loop of `{}` did not converge {when}", self.name())
                .at(self.first_span());
        };
        let of_pre = match names.contains("`pre(") {
            true => "; the one of `pre(v)` is that of `v`",
            false => "",
        };
        fault!(code, "the algebraic loop of {names} did not converge {when}";
            help: "give these variables start values near the solution{of_pre}")
        .at(span)
    }

    /// A loop whose Jacobian is singular where all its equations hold.
    fn explain_singular(&self, block: Option<&Block>, when: &str) -> Diagnostic {
        let Some((names, span)) = self.torn_loop(block) else {
            return self.explain_block(block, when, SIMULATION_FAILED);
        };
        fault!(SIMULATION_FAILED,
            "the Jacobian of the algebraic loop of {names} is singular {when}: its equations do not \
             determine a unique solution";
            help: "replace an equation that follows from the others by one that determines these \
                   variables, or give them start values near another solution")
        .at(span)
    }

    /// The iteration variables of a torn loop, and where one of its equations is written.
    fn torn_loop(&self, block: Option<&Block>) -> Option<(String, Span)> {
        let Some(Block::Loop(torn)) = block else { return None };
        let name = |v: &VarId| format!("`{}`", self.sorted.dae.variable(*v).name);
        let names: Vec<String> = torn.iteration.iter().map(name).collect();
        let equation = torn.residuals.first().map_or(u32::MAX, |(_, equation)| *equation as u32);
        Some((names.join(", "), self.place(equation)))
    }

    /// The unknowns of the linear loop that this equation solves for one of them.
    fn linear_loop(&self, equation: u32) -> Option<String> {
        let sorted = &self.sorted;
        let blocks = sorted.blocks.iter().chain(&sorted.event_blocks);
        let unknowns = blocks.chain(&sorted.initial_blocks).find_map(|block| match block {
            Block::Linear(solved) => {
                let first = solved.assignments.iter().take(solved.unknowns.len());
                first
                    .map(|a| a.equation)
                    .any(|e| e == equation as usize)
                    .then_some(&solved.unknowns)
            }
            _ => None,
        })?;
        let name = |v: &VarId| format!("`{}`", self.sorted.dae.variable(*v).name);
        Some(unknowns.iter().map(name).collect::<Vec<_>>().join(", "))
    }

    /// Where an origin is written: equations, initial equations, those of events, then variables.
    pub(super) fn place(&self, origin: u32) -> Span {
        let dae = &self.sorted.dae;
        let equations = dae.equations.iter().chain(&dae.initial_equations);
        let mut spans = equations.chain(&dae.events.equations).map(|e| e.span);
        let declared = || {
            let position = (origin as usize).checked_sub(number_of_equations(&self.sorted))?;
            dae.variables.get(position).map(|v| v.span)
        };
        spans.nth(origin as usize).or_else(declared).unwrap_or(Span::NONE)
    }
}
