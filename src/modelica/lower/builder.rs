//! What lowering knows while it goes through a flat model.

use super::clocks::Clocks;
use super::dae::Dae;
use super::equation::Instance;
use super::execution::{Execution, Loops};
use super::expressions::{Lowered, Lowering};
use super::function::{CallResults, Instances};
use crate::diag::Diagnostic;
use crate::flatten::FlatModel;
use crate::symbolic::{Containing, Expr, Pool, RelationOperator, VarId};
use crate::syntax::ast::Expression;
use indexmap::IndexMap;
use rustc_hash::{FxBuildHasher, FxHashMap};

/// The most statements that the functions of one model may carry out when it is compiled.
pub(super) const MAX_STATEMENTS: usize = 1_000_000;

/// What is known about a flat variable so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Folding {
    Unvisited,
    InProgress,
    Done,
}

/// Builds a [`Dae`] from a flat model.
pub(super) struct Builder<'a> {
    pub(super) flat: &'a FlatModel,
    pub(super) dae: Dae,
    pub(super) scalars: Scalars,
    pub(super) place: Context,
    pub(super) calls: Calls,
    /// The algorithm in progress.
    pub(super) execution: Execution,
    /// Clocked operators and equations.
    pub(super) clocks: Clocks,
    /// Values of records that functions compute, which the bindings of their components share.
    pub(super) records: FxHashMap<(RecordAt, Context), Lowered<Expr>>,
}

/// A record within the flat model, by its address there.
pub(super) type RecordAt = *const Expression;

/// The scalars of the flat variables, and those that lowering declares for them.
pub(super) struct Scalars {
    /// First scalar of every flat variable.
    pub(super) first: Vec<VarId>,
    pub(super) folding: Vec<Folding>,
    pub(super) derivatives: FxHashMap<VarId, VarId>,
    /// `pre` of every variable that needs it.
    pub(super) previous: IndexMap<VarId, VarId, FxBuildHasher>,
    /// Discrete variables that hold conditions.
    pub(super) conditions: FxHashMap<Expr, VarId>,
    /// Variables that hold relations.
    pub(super) relations: FxHashMap<(RelationOperator, Expr, Expr), VarId>,
    /// Warnings that parameters have no text because what gives it was run and failed: a file
    /// that cannot be read, say.
    pub(super) missing_strings: Vec<Diagnostic>,
}

/// Where in the model the equation or statement at hand stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(super) struct Context {
    /// Whose it is.
    pub(super) instance: Option<Instance>,
    /// Whether it is an initial one.
    pub(super) initial: bool,
    /// Whether it is in the body of a when-clause.
    pub(super) in_when: bool,
    /// Whether it is evaluated at the start alone: a parameter, or the body of `when initial()`.
    pub(super) at_start: bool,
    /// How many branches of if-equations are around it whose conditions are not known.
    pub(super) branches: usize,
}

/// Calls of user functions.
pub(super) struct Calls {
    /// How deep they are nested.
    pub(super) depth: usize,
    /// How many statements the one at hand may still carry out.
    pub(super) inlined: usize,
    /// How many statements of algorithms may still be evaluated symbolically.
    pub(super) statements: usize,
    /// Whether parameters on which Strings depend are evaluated.
    pub(super) evaluates_string_parameters: bool,
    /// Statements that became functions so far.
    pub(super) statement_functions: usize,
    /// Functions that cannot be expressions.
    pub(super) functions: Instances,
    /// What calls came to.
    pub(super) results: CallResults,
    /// Whether expressions contain variables of functions without value.
    pub(super) undefined: Containing<fn(&Pool, Expr) -> bool>,
    /// How many calls of impure functions were read.
    pub(super) impure: u32,
    /// The calls of functions that write, in the statement at hand.
    pub(super) written: Vec<Expr>,
}

impl<'a> Builder<'a> {
    /// Knows nothing of the model yet.
    pub(super) fn new(flat: &'a FlatModel) -> Builder<'a> {
        let dae = Dae {
            name: flat.name.clone(),
            pool: Pool::new(),
            experiment: flat.experiment,
            ..Dae::default()
        };
        Builder {
            flat,
            dae,
            scalars: Scalars::new(flat.variables.len()),
            place: Context::default(),
            calls: Calls::new(flat.strict),
            execution: Execution::default(),
            clocks: Clocks::default(),
            records: FxHashMap::default(),
        }
    }

    /// What is lowered without what it asserts: it may be undone, or need not hold.
    pub(super) fn without_assertions<R>(&mut self, lower: impl FnOnce(&mut Self) -> R) -> R {
        let asserted = self.dae.assertions.len();
        let result = lower(self);
        self.dae.assertions.truncate(asserted);
        result
    }

    /// Lowers what a statement contains.
    pub(super) fn statement_lowering(&mut self, loops: &Loops) -> Lowering<'_, Self> {
        let live = self.place.in_when;
        let mut lowering = Lowering::new(self);
        lowering.loops = loops.clone();
        lowering.live = live;
        lowering
    }
}

impl Scalars {
    fn new(variables: usize) -> Scalars {
        Scalars {
            first: Vec::new(),
            folding: vec![Folding::Unvisited; variables],
            derivatives: FxHashMap::default(),
            previous: IndexMap::default(),
            conditions: FxHashMap::default(),
            relations: FxHashMap::default(),
            missing_strings: Vec::new(),
        }
    }
}

impl Calls {
    fn new(strict: bool) -> Calls {
        Calls {
            depth: 0,
            inlined: 0,
            statements: MAX_STATEMENTS,
            evaluates_string_parameters: false,
            statement_functions: 0,
            functions: Instances::new(strict),
            results: CallResults::default(),
            undefined: Containing::new(|pool, e| pool.as_constant(e).is_some_and(f64::is_nan)),
            impure: 0,
            written: Vec::new(),
        }
    }
}
