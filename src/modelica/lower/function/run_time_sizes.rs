//! Sizes inside a statement of a function that a computed Integer decides: `s := sum(p[1:n])`.
//!
//! The statement is compiled for every value that the Integer can have beside the arrays of the
//! statement, and the values become a chain of branches: also negative ones, for which `1:n` is empty, and
//! those beyond the arrays by as much as is added to the Integer, as in `p[1:n - 3]`. Another value is a
//! fault at run time. This
//! is the last resort: constants, loops that are unrolled and calls compiled for known arguments
//! come first, as their code is shorter.

use super::emitter::Operand;
use super::mark::Mark;
use super::statements::Body;
use crate::bytecode::Instruction;
use crate::diag::Diagnostic;
use crate::eval::ValueType;
use crate::execute::execute;
use crate::fault;
use crate::functions::{self, Meaning};
use crate::inference::subscript_uses;
use crate::lower::errors::NO_CONSTANT_VALUE;
use crate::lower::expressions::{Lowered, Operations as _};
use crate::name::Ident;
use crate::symbolic::RelationOperator;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ForIndex, Statement, StatementKind,
};
use crate::syntax::visit::{Visit, walk_expression, walk_reference};

/// The largest dimension of arrays for which a statement is compiled size by size.
const MOST: usize = 64;
/// A value of an Integer that fits no statement in which arrays of the largest dimension bound it.
const BEYOND: usize = 2 * MOST + 1;
/// Integers that decide sizes of one statement: `y[i:j] := x[k:k + j - i]` has three.
const MAX_INTEGERS: usize = 3;

impl Body<'_, '_> {
    /// Where the code is now.
    pub(super) fn mark(&self) -> Mark {
        Mark {
            emitter: self.emitter.checkpoint(),
            branches: self.branches.len(),
            breaks: self.breaks.iter().map(Vec::len).collect(),
            returns: self.returns.len(),
        }
    }

    /// Forgets the code since a mark, and its jumps.
    pub(super) fn restore(&mut self, mark: &Mark) {
        self.emitter.rollback(mark.emitter);
        self.branches.truncate(mark.branches);
        self.breaks.truncate(mark.breaks.len());
        self.returns.truncate(mark.returns);
        for (breaks, n) in self.breaks.iter_mut().zip(&mark.breaks) {
            breaks.truncate(*n);
        }
    }

    /// A statement, some sizes in which may be known only at run time.
    pub(super) fn statement_of_any_size(&mut self, s: &Statement) -> Result<(), Diagnostic> {
        let mark = self.mark();
        match execute(self, s) {
            Err(e) if e.code == NO_CONSTANT_VALUE && self.instances.sizes_at_run_time => {
                self.restore(&mark);
                self.size_by_size(s, e)
            }
            result => result.map(|_| ()),
        }
    }

    /// The statement for each value of the first Integer that makes its sizes known, perhaps with
    /// others.
    fn size_by_size(&mut self, s: &Statement, error: Diagnostic) -> Result<(), Diagnostic> {
        let is_simple = matches!(
            s.kind,
            StatementKind::Assign { .. }
                | StatementKind::MultiAssign { .. }
                | StatementKind::Call(_)
        );
        if !is_simple || self.bound_integers >= MAX_INTEGERS {
            return Err(error);
        }
        let largest = self.largest_dimension(s);
        if largest > MOST {
            return Err(error);
        }
        let mut names = Names::default();
        names.statement(s);
        let added = names.numbers_in_ranges.min(MOST);
        // What is known in one branch is not known after it.
        let known_once = std::mem::take(&mut self.known_once);
        self.bound_integers += 1;
        let mut result = Err(error);
        for name in self.deciding_integers(s) {
            let mark = self.mark();
            result = self.branch_by_branch(s, name, (largest as i64 + 1, added as i64));
            match &result {
                Err(e) if e.code == NO_CONSTANT_VALUE => self.restore(&mark),
                _ => break,
            }
        }
        self.bound_integers -= 1;
        self.known_once = known_once;
        result
    }

    /// `if n == 0 then s(0) elseif n == 1 then s(1) …`, another value being a fault.
    fn branch_by_branch(
        &mut self,
        s: &Statement,
        name: Ident,
        (largest, added): (i64, i64),
    ) -> Result<(), Diagnostic> {
        let Some(integer) = self.integer(name) else { return Ok(()) };
        self.check_bounded(s, (name, integer))?;
        let (mut ends, mut refused) = (Vec::new(), None);
        for number in 0..=largest {
            let branch = self.branch(s, (name, integer), number, &mut ends)?;
            refused = branch.err().or(refused);
        }
        // Beyond the arrays, what does not fit once does not fit farther on.
        let above: Vec<i64> = (largest + 1..=largest + added).collect();
        let below: Vec<i64> = (1..=largest + added).map(|number| -number).collect();
        for values in [above, below] {
            for number in values {
                if self.branch(s, (name, integer), number, &mut ends)?.is_err() {
                    break;
                }
            }
        }
        if let (true, Some(error)) = (ends.is_empty(), refused) {
            return Err(error);
        }
        let text = format!("the value of `{name}`, on which sizes depend, does not fit them");
        let message = self.emitter.message(text.into());
        let a = self.emitter.register(Operand::Constant(0.0));
        self.emitter.emit(Instruction::Assert { a, message });
        ends.into_iter().for_each(|end| self.emitter.land(end));
        Ok(())
    }

    /// `if n == number then s(number)`, and a jump to the end; the error where sizes do not fit.
    fn branch(
        &mut self,
        s: &Statement,
        (name, integer): (Ident, Operand),
        number: i64,
        ends: &mut Vec<usize>,
    ) -> Result<Result<(), Diagnostic>, Diagnostic> {
        let mark = self.mark();
        let value = Operand::Constant(number as f64);
        let is_it = self.relation(RelationOperator::Equal, integer, value, true, s.span);
        let skip = self.emitter.jump_unless(is_it);
        match self.statement_with(s, (name, integer), value) {
            Ok(()) => {
                ends.push(self.emitter.jump());
                self.emitter.land(skip);
                Ok(Ok(()))
            }
            Err(e) if e.code == NO_CONSTANT_VALUE => Err(e),
            Err(e) => {
                self.restore(&mark);
                Ok(Err(e))
            }
        }
    }

    /// The statement where an Integer has another operand than its own.
    fn statement_with(
        &mut self,
        s: &Statement,
        (name, own): (Ident, Operand),
        other: Operand,
    ) -> Result<(), Diagnostic> {
        self.bind(name, other);
        let compiled = self.statement_of_any_size(s);
        self.bind(name, own);
        compiled
    }

    /// Refuses a statement that makes arrays of any size that an Integer gives, as `sum(1:n)` does.
    fn check_bounded(
        &mut self,
        s: &Statement,
        integer: (Ident, Operand),
    ) -> Result<(), Diagnostic> {
        let mut made = MadeArrays { name: integer.0, found: false };
        made.statement(s);
        if !made.found {
            return Ok(());
        }
        let mark = self.mark();
        let compiled = self.statement_with(s, integer, Operand::Constant(BEYOND as f64));
        self.restore(&mark);
        match compiled {
            Ok(()) => Err(fault!(
                NO_CONSTANT_VALUE,
                "the sizes of arrays here depend on `{}`, whose value is not known at translation",
                integer.0
            )
            .at(s.span)),
            Err(e) if e.code == NO_CONSTANT_VALUE => Err(e),
            Err(_) => Ok(()),
        }
    }

    /// The register of a scalar Integer of the function or of a loop.
    fn integer(&self, name: Ident) -> Option<Operand> {
        if let Some(variable) = self.loops.iter().rev().find(|variable| variable.name == name) {
            let is_free = self.loop_sizes && matches!(variable.value, Operand::Register(_));
            return is_free.then_some(variable.value);
        }
        let of_function = super::component_of(self.function, name.as_str())?;
        match self.local(&[name])? {
            Lowered::Array(array)
                if array.dims.is_empty() && of_function.value_type == ValueType::Integer =>
            {
                let operand = *array.elements.first()?;
                matches!(operand, Operand::Register(_)).then_some(operand)
            }
            _ => None,
        }
    }

    /// Gives an Integer another operand.
    fn bind(&mut self, name: Ident, operand: Operand) {
        if let Some(own) = self.loops.iter_mut().rev().find(|own| own.name == name) {
            own.value = operand;
        } else if let Some((_, value)) = self.locals.iter_mut().find(|(own, _)| *own == name) {
            *value = Lowered::scalar(operand);
        }
    }

    /// Integers that the statement reads and does not assign, those in ranges first.
    fn deciding_integers(&self, s: &Statement) -> Vec<Ident> {
        let mut read = Names::default();
        read.statement(s);
        let assigned: Vec<Ident> = match &s.kind {
            StatementKind::Assign { target, .. } => target.as_ident().into_iter().collect(),
            StatementKind::MultiAssign { targets, .. } => {
                targets.iter().flatten().filter_map(ComponentReference::as_ident).collect()
            }
            _ => Vec::new(),
        };
        let mut found = Vec::new();
        for name in read.in_ranges.into_iter().chain(read.all) {
            let is_new = !found.contains(&name) && !assigned.contains(&name);
            if is_new && self.integer(name).is_some() {
                found.push(name);
            }
        }
        found
    }

    /// The largest dimension of the arrays in a statement.
    fn largest_dimension(&self, s: &Statement) -> usize {
        let mut names = Names::default();
        names.statement(s);
        let of_local = |name: &Ident| self.local(&[*name]).map_or(0, largest_dimension);
        names.all.iter().map(of_local).max().unwrap_or(0)
    }
}

fn largest_dimension(value: &Lowered<Operand>) -> usize {
    match value {
        Lowered::Array(array) => array.dims.iter().copied().max().unwrap_or(0),
        Lowered::Record(fields) => {
            fields.iter().map(|(_, field)| largest_dimension(field)).max().unwrap_or(0)
        }
        _ => 0,
    }
}

/// The first names of the references of a statement.
#[derive(Debug, Default)]
struct Names {
    all: Vec<Ident>,
    /// Those in the ends of ranges.
    in_ranges: Vec<Ident>,
    /// The sum of the Integers that are written there.
    numbers_in_ranges: usize,
    ranges: usize,
}

impl Visit for Names {
    fn expression(&mut self, expression: &Expression) {
        let is_range = matches!(expression.kind, ExpressionKind::Range { .. });
        self.ranges += usize::from(is_range);
        if let (ExpressionKind::Integer(number), 1..) = (&expression.kind, self.ranges) {
            let number = usize::try_from(*number).unwrap_or(0);
            self.numbers_in_ranges = self.numbers_in_ranges.saturating_add(number);
        }
        walk_expression(self, expression);
        self.ranges -= usize::from(is_range);
    }

    fn reference(&mut self, reference: &ComponentReference) {
        if let Some(first) = reference.parts.first() {
            self.all.push(first.name);
            if self.ranges > 0 {
                self.in_ranges.push(first.name);
            }
        }
        walk_reference(self, reference);
    }
}

/// Looks for arrays that a statement makes in a size that an Integer gives: `zeros(n)`, `1:n`. Those of
/// subscripts, and of iterators that are subscripts, are bounded by the arrays that these choose from.
struct MadeArrays {
    name: Ident,
    found: bool,
}

impl MadeArrays {
    fn depends(&self, e: &Expression) -> bool {
        let mut names = Names::default();
        names.expression(e);
        names.all.contains(&self.name)
    }

    fn size(&mut self, e: &Expression) {
        self.found |= self.depends(e);
    }

    fn iterators(&mut self, element: &Expression, indices: &[ForIndex]) {
        for index in indices {
            let uses = subscript_uses(index.name.node, &|search| search.expression(element));
            if let (Some(range), true) = (&index.range, uses.is_empty()) {
                self.size(range);
            }
        }
        self.expression(element);
    }
}

impl Visit for MadeArrays {
    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Range { .. } => self.size(expression),
            ExpressionKind::ArrayIteration { element, indices } => {
                self.iterators(element, indices);
            }
            ExpressionKind::Call { arguments, .. } if !arguments.iterators.is_empty() => {
                arguments.positional.iter().for_each(|e| self.iterators(e, &arguments.iterators));
            }
            ExpressionKind::Call { function, arguments } => {
                let named = function.as_ident().and_then(|name| functions::find(name.as_str()));
                if let Some(Meaning::Plan(_, known)) = named.map(|entry| entry.meaning) {
                    let sizes = arguments.positional.iter().enumerate();
                    sizes.filter(|(at, _)| known.contains(*at)).for_each(|(_, e)| self.size(e));
                }
                walk_expression(self, expression);
            }
            ExpressionKind::Subscripted { base, .. } => self.expression(base),
            _ => walk_expression(self, expression),
        }
    }

    /// Its subscripts are bounded by the array.
    fn reference(&mut self, _: &ComponentReference) {}
}
