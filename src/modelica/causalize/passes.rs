//! The passes of causalization: one table, executed from top to bottom.

use super::causalized::{Alias, CausalizedDae};
use super::dummy_derivatives::ChosenStates;
use super::event_system::{self, EventSystem, Purpose};
use super::hidden_constraints::{hidden_constraints, may_be_dependent};
use super::initial_system::{self, InitialSystem};
use super::zero_coefficients::ZeroCoefficients;
use super::{
    alias_elimination, blt, constant_conditions, discrete, homotopy, index_reduction,
    parameter_order, preferred_states, reinit, report, state_select, zero_coefficients,
    zero_derivatives,
};
use crate::diag::Diagnostic;
use crate::flatten::FlatModel;
use crate::lower::{self, Dae, DefaultValues, Equation};
use crate::symbolic::VarId;

/// A pass of causalization.
#[derive(Debug)]
pub struct Pass {
    /// Its name for `--dump`.
    pub name: &'static str,
    /// What it does, in one line.
    pub what: &'static str,
    run: fn(&mut Causalization<'_>) -> Result<(), Diagnostic>,
    /// Writes the blocks that it makes; without, a dump shows the equations after it.
    pub(super) write_blocks: Option<WriteBlocks>,
}

type WriteBlocks = fn(&CausalizedDae, &mut String) -> std::fmt::Result;

const fn pass(
    name: &'static str,
    what: &'static str,
    run: fn(&mut Causalization<'_>) -> Result<(), Diagnostic>,
) -> Pass {
    Pass { name, what, run, write_blocks: None }
}

impl Pass {
    const fn writing(mut self, write_blocks: WriteBlocks) -> Pass {
        self.write_blocks = Some(write_blocks);
        self
    }
}

/// The passes, in order.
pub const PASSES: &[Pass] = &[
    pass(
        "build",
        "scalarization: arrays expanded to scalars, relations outside `noEvent` keep their value between events",
        |system| system.lower(),
    ),
    pass("order_parameters", "parameter bindings in order of dependence", |system| {
        system.order_parameters()
    }),
    pass("fold_parameters", "evaluated parameters replaced by numbers", |system| {
        system.fold_parameters()
    }),
    pass("eliminate_aliases", "alias elimination: `a = b` and `a = -b`", |system| {
        system.eliminate_aliases()
    }),
    pass("fold_conditions", "branches that are never taken are removed", |system| {
        system.fold_conditions()
    }),
    pass("drop_vanishing", "derivatives with zero coefficients removed", |system| {
        system.drop_zero_derivatives()
    }),
    pass(
        "separate_discrete",
        "equations of discrete variables turned into assignments at events",
        |system| system.separate_discrete(),
    ),
    pass(
        "reduce_index",
        "index reduction: constraints between states differentiated, states selected",
        |system| system.reduce_index(),
    ),
    pass("sort_blocks", "BLT: matching, strongly connected components, tearing", |system| {
        system.sort_blocks()
    })
    .writing(report::write_blocks),
    pass(
        "sort_events",
        "the same for the system at events, discrete equations included",
        |system| system.sort_events(),
    )
    .writing(report::write_event_blocks),
    pass("sort_initial", "the same for the initialization problem", |system| system.sort_initial())
        .writing(report::write_initial_blocks),
];

/// How often constraints that sorting has brought to light are differentiated; each time all of them are.
const MOST_REDUCTIONS: usize = 10;

/// A system on its way through the passes.
pub(super) struct Causalization<'a> {
    flat: &'a FlatModel,
    /// Parameters of zero that the structure takes as numbers.
    zeros: &'a ZeroCoefficients,
    purpose: Purpose,
    dae: Dae,
    parameters: Vec<VarId>,
    aliases: Vec<Option<Alias>>,
    chosen: ChosenStates,
    /// What index reduction began with, but for the expressions.
    before: (Dae, Vec<Option<Alias>>),
    /// The equations after the start, and what they are solved for.
    actual: Vec<Equation>,
    unknowns: Vec<VarId>,
    blocks: Vec<super::Block>,
    events: EventSystem,
    initial: InitialSystem,
}

/// Is shown the name of a pass, the system after it, and the aliases known so far.
pub(super) type Show<'a> = dyn FnMut(&str, &Dae, &[Option<Alias>]) + 'a;

/// Executes all passes.
pub(super) fn run_passes(
    flat: &FlatModel,
    zeros: &ZeroCoefficients,
    show: &mut Show<'_>,
) -> Result<CausalizedDae, Diagnostic> {
    let mut system = Causalization::new(flat, zeros, Purpose::Solution);
    for pass in PASSES {
        (pass.run)(&mut system)?;
        if pass.write_blocks.is_none() {
            show(pass.name, &system.dae, &system.aliases);
        }
    }
    Ok(system.finish())
}

/// Executes all passes as far as they find out what is wrong with a system; how many blocks were solved.
pub(super) fn check(flat: &FlatModel) -> Result<usize, Diagnostic> {
    let zeros = ZeroCoefficients::default();
    let mut system = Causalization::new(flat, &zeros, Purpose::Check);
    PASSES.iter().try_for_each(|pass| (pass.run)(&mut system))?;
    Ok(system.blocks.len() + system.events.blocks.len() + system.initial.blocks.len())
}

impl<'a> Causalization<'a> {
    fn new(flat: &'a FlatModel, zeros: &'a ZeroCoefficients, purpose: Purpose) -> Self {
        Causalization {
            flat,
            zeros,
            purpose,
            dae: Dae::default(),
            parameters: Vec::new(),
            aliases: Vec::new(),
            chosen: ChosenStates::default(),
            before: Default::default(),
            actual: Vec::new(),
            unknowns: Vec::new(),
            blocks: Vec::new(),
            events: EventSystem::default(),
            initial: InitialSystem::default(),
        }
    }

    fn lower(&mut self) -> Result<(), Diagnostic> {
        self.dae = lower::lower(self.flat)?;
        zero_coefficients::evaluate(&mut self.dae, self.zeros);
        Ok(())
    }

    fn order_parameters(&mut self) -> Result<(), Diagnostic> {
        self.parameters = parameter_order::order_parameters(&mut self.dae)?;
        Ok(())
    }

    fn fold_parameters(&mut self) -> Result<(), Diagnostic> {
        let parameters = std::mem::take(&mut self.parameters);
        self.parameters = lower::fold_parameters(&mut self.dae, parameters);
        self.dae.defaults = DefaultValues::of_parameters(&self.dae, &self.parameters);
        super::declared_ranges::warn_of_values_outside(&mut self.dae);
        Ok(())
    }

    fn eliminate_aliases(&mut self) -> Result<(), Diagnostic> {
        self.aliases = alias_elimination::eliminate_aliases(&mut self.dae);
        Ok(())
    }

    fn fold_conditions(&mut self) -> Result<(), Diagnostic> {
        constant_conditions::fold_conditions(&mut self.dae);
        Ok(())
    }

    fn drop_zero_derivatives(&mut self) -> Result<(), Diagnostic> {
        zero_derivatives::drop_zero_derivatives(&mut self.dae, &self.aliases);
        Ok(())
    }

    fn separate_discrete(&mut self) -> Result<(), Diagnostic> {
        discrete::separate_discrete(&mut self.dae, &self.aliases)?;
        reinit::assign_discrete(&mut self.dae, &self.aliases);
        Ok(())
    }

    fn reduce_index(&mut self) -> Result<(), Diagnostic> {
        let pool = std::mem::take(&mut self.dae.pool);
        self.before = (self.dae.clone(), self.aliases.clone());
        self.dae.pool = pool;
        if !self.reduce_to_preferred_states() {
            self.chosen = index_reduction::reduce_index(&mut self.dae, &mut self.aliases, &[])?;
        }
        Ok(())
    }

    /// Index reduction with states that are preferred and not differentiated; whether there are any
    /// that can be states.
    fn reduce_to_preferred_states(&mut self) -> bool {
        let mut preferred = preferred_states::preferred(&self.dae, &self.aliases);
        while !preferred.is_empty() {
            preferred_states::declare_derivatives(&mut self.dae, &mut self.aliases, &preferred);
            let reduced =
                index_reduction::reduce_index(&mut self.dae, &mut self.aliases, &preferred);
            let n_preferred = preferred.len();
            match reduced {
                Ok(chosen) => {
                    preferred.retain(|v| chosen.states.binary_search(v).is_ok());
                    if preferred.len() == n_preferred {
                        self.chosen = chosen;
                        return true;
                    }
                }
                Err(_) => preferred.clear(),
            }
            self.restore();
        }
        false
    }

    /// The system before index reduction.
    fn restore(&mut self) {
        let pool = std::mem::take(&mut self.dae.pool);
        (self.dae, self.aliases) = self.before.clone();
        self.dae.pool = pool;
    }

    /// Sorts, and begins again with index reduction where constraints between states come to light.
    fn sort_blocks(&mut self) -> Result<(), Diagnostic> {
        self.sort_reduced()?;
        for _ in 0..MOST_REDUCTIONS {
            let n_given = self.before.0.equations.len();
            let constraints =
                hidden_constraints(&mut self.dae, &self.actual, &self.blocks, n_given);
            if constraints.is_empty() {
                break;
            }
            self.restore();
            for (number, equation) in constraints {
                self.dae.equations[number] = equation;
            }
            self.reduce_index()?;
            self.sort_reduced()?;
        }
        self.before = Default::default();
        let strict = self.flat.strict;
        state_select::check_state_select(&mut self.dae, &self.aliases, &self.chosen, strict)
    }

    fn sort_reduced(&mut self) -> Result<(), Diagnostic> {
        let ChosenStates { states, selections } = &self.chosen;
        reinit::check_reinits(&self.dae, &self.aliases, states, selections)?;
        self.unknowns = index_reduction::unknowns(&self.dae, &self.aliases, states);
        self.actual = homotopy::actual_equations(&mut self.dae);
        let (purpose, equations) = (self.purpose, &self.actual);
        let n_given = self.before.0.equations.len();
        let is_needed = |dae: &Dae, block: &[usize], members: &[VarId]| {
            purpose.needs(dae, members)
                || may_be_dependent(dae, equations, (block, members), n_given)
        };
        self.blocks = blt::sort_blocks(&mut self.dae, equations, &self.unknowns, is_needed)?;
        Ok(())
    }

    fn sort_events(&mut self) -> Result<(), Diagnostic> {
        let (dae, equations) = (&mut self.dae, &self.actual);
        self.events = event_system::sort_events(dae, equations, &self.unknowns, self.purpose)?;
        Ok(())
    }

    fn sort_initial(&mut self) -> Result<(), Diagnostic> {
        let ChosenStates { states, selections } = &self.chosen;
        self.initial = initial_system::sort_initial(
            &mut self.dae,
            states,
            selections,
            &self.unknowns,
            &self.aliases,
            self.purpose,
        )?;
        Ok(())
    }

    fn finish(self) -> CausalizedDae {
        let mut iterated = self.events.iterated;
        iterated.extend(self.initial.iterated);
        iterated.sort_unstable();
        iterated.dedup();
        CausalizedDae {
            dae: self.dae,
            aliases: self.aliases,
            states: self.chosen.states,
            selections: self.chosen.selections,
            blocks: self.blocks,
            event_blocks: self.events.blocks,
            initial_blocks: self.initial.blocks,
            initial_checks: self.initial.checks,
            iterated,
            parameters: self.parameters,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::causalize::{Block, causalize};
    use crate::flatten::{BaseType, Library, flatten};
    use crate::source::SourceMap;
    use crate::syntax::parse_stored_definition;

    /// Three pairs of unknowns in a loop, and a value that only events change.
    const LOOPS: &str = include_str!("passes/loops.mo");

    fn flat(name: &str, text: &str) -> FlatModel {
        let sources = SourceMap::default();
        let source = sources.add(name, text);
        let file = parse_stored_definition(source, text).expect("Modelica");
        let mut library = Library::new();
        let names = library.load(&file).expect("a class");
        flatten(&library, &names[0], &[]).expect("a model").model
    }

    #[test]
    fn a_check_solves_discrete_blocks_alone() {
        let flat = flat("Loops.mo", LOOPS);
        let solved = causalize(&flat).expect("it can be solved");
        let is_real = |v: VarId| solved.dae.variable(v).base == BaseType::Real;
        // The condition is a Boolean at events and at the start; what is left out is Real.
        let discrete = |blocks: &[Block]| {
            let assigned = blocks
                .iter()
                .filter(|block| matches!(block, Block::Assignment(a) if !is_real(a.variable)));
            assigned.count()
        };
        let needed = discrete(&solved.event_blocks) + discrete(&solved.initial_blocks);
        assert!(solved.blocks.len() >= 6 && needed > 0);
        assert_eq!(check(&flat).expect("nothing is wrong"), needed);
    }

    /// The second equation says that `w` is twice `u`, so that one of them cannot be a state.
    const HIDDEN: &str = include_str!("passes/hidden.mo");

    #[test]
    fn a_check_finds_what_hidden_constraints_make_wrong() {
        let mut flat = flat("Hidden.mo", HIDDEN);
        assert_eq!(causalize(&flat).expect("it can be solved").states.len(), 1);
        check(&flat).expect("a warning");
        flat.strict = true;
        let wrong = check(&flat).expect_err("two states are asked for");
        assert_eq!(wrong.code, lower::errors::STATE_SELECT);
        assert_eq!(Some(wrong), causalize(&flat).err());
    }
}
