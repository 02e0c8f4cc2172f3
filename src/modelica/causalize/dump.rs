//! The system after any pass, in the model's own names, and what the passes leave of its size.

use super::blt::incidence;
use super::causalized::{Alias, Block};
use super::index_reduction::unknowns;
use super::{PASSES, causalize_and_show};
use crate::diag::Diagnostic;
use crate::flatten::FlatModel;
use crate::lower::{Dae, Equation, VariableKind};
use crate::symbolic::{Expr, VarId, print};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The system after a pass of [`PASSES`], as text; `None` if there is no such pass.
///
/// # Errors
/// Those of the passes up to this one.
pub fn dump(flat: &FlatModel, pass: &str) -> Result<Option<String>, Diagnostic> {
    let Some(pass) = PASSES.iter().find(|known| known.name == pass) else { return Ok(None) };
    let mut text = None;
    let causalized = causalize_and_show(flat, &mut |done, dae, aliases| {
        if done == pass.name {
            text = Some(system(dae, aliases));
        }
    });
    let Some(write_blocks) = pass.write_blocks else {
        return match text {
            // A later pass may fail.
            Some(text) => Ok(Some(text)),
            None => causalized.map(|_| None),
        };
    };
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_blocks(&causalized?, &mut text);
    Ok(Some(text))
}

/// How many equations, continuous variables, nonzeros and aliases every pass leaves, and the sizes of blocks.
///
/// # Errors
/// Those of the passes.
pub fn sizes(flat: &FlatModel) -> Result<String, Diagnostic> {
    let mut text = format!(
        "{:20}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n",
        "", "equations", "variables", "nonzeros", "aliases", "discrete", "initial"
    );
    let sorted = causalize_and_show(flat, &mut |pass, dae, aliases| {
        let _ = writeln!(text, "{pass:20}{}", counts(dae, aliases));
    })?;
    let _ = writeln!(text, "states {}", sorted.states.len());
    let stages = [
        ("between events", &sorted.blocks),
        ("at events", &sorted.event_blocks),
        ("initially", &sorted.initial_blocks),
    ];
    for (stage, blocks) in stages {
        let _ = writeln!(text, "{stage}: {}", block_sizes(blocks));
    }
    Ok(text)
}

fn counts(dae: &Dae, aliases: &[Option<Alias>]) -> String {
    let none = vec![None; dae.variables.len()];
    let open = unknowns(dae, if aliases.is_empty() { &none } else { aliases }, &[]);
    let nonzeros: usize = {
        let graph = incidence(dae, &dae.equations, &open);
        (0..dae.equations.len()).map(|row| graph.unknowns(row).len()).sum()
    };
    format!(
        "{:>10}{:>10}{nonzeros:>10}{:>10}{:>10}{:>10}",
        dae.equations.len(),
        open.len(),
        aliases.iter().flatten().count(),
        dae.events.equations.len(),
        dae.initial_equations.len()
    )
}

/// `12 blocks; linear 4 by 2; 3 torn 3 by 1`: equations of the loops, and those left to be solved
/// together; the largest first.
fn block_sizes(blocks: &[Block]) -> String {
    let mut counts: BTreeMap<(Reverse<usize>, usize, &str), usize> = BTreeMap::new();
    for block in blocks {
        let (kind, size, left) = match block {
            Block::Assignment(_) => continue,
            Block::Linear(solved) => ("linear", solved.assignments.len(), solved.unknowns.len()),
            Block::Loop(torn) => {
                let n = torn.iteration.len();
                ("torn", torn.assignments.len() + n, n)
            }
        };
        *counts.entry((Reverse(size), left, kind)).or_default() += 1;
    }
    let mut text = format!("{} blocks", blocks.len());
    for ((Reverse(size), left, kind), count) in counts {
        let times = if count == 1 { String::new() } else { format!("{count} ") };
        let _ = write!(text, "; {times}{kind} {size} by {left}");
    }
    text
}

fn system(dae: &Dae, aliases: &[Option<Alias>]) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_system(dae, aliases, &mut text);
    text
}

fn write_system(dae: &Dae, aliases: &[Option<Alias>], out: &mut String) -> std::fmt::Result {
    let shown = |e: Expr| print(&dae.pool, e, &|v: VarId| dae.variable(v).name.to_string());
    writeln!(out, "{}", dae.name)?;
    for (variable, alias) in dae.variables.iter().zip(aliases.iter().map(Some).chain(forever())) {
        let name = &variable.name;
        if let Some(Some(alias)) = alias {
            let sign = if alias.negated { "-" } else { "" };
            writeln!(out, "alias {name} = {sign}{}", dae.variable(alias.of).name)?;
            continue;
        }
        let value = match (variable.kind, variable.binding) {
            (VariableKind::Constant(value), _) => format!(" = {value:?}"),
            (VariableKind::Parameter { .. }, Some(binding)) => format!(" = {}", shown(binding)),
            _ => String::new(),
        };
        writeln!(out, "{} {name}{value}", word(variable.kind))?;
    }
    for relation in &dae.relations {
        let (left, right) = (shown(relation.left), shown(relation.right));
        let name = &dae.variable(relation.variable).name;
        writeln!(out, "event {name} = {left} {} {right}", relation.operator.symbol())?;
    }
    let parts: [(&str, &[Equation]); 3] = [
        ("equation", &dae.equations),
        ("at events", &dae.events.equations),
        ("initially", &dae.initial_equations),
    ];
    for (part, equations) in parts {
        for equation in equations {
            writeln!(out, "{part} {} = {}", shown(equation.left), shown(equation.right))?;
        }
    }
    Ok(())
}

fn forever<'a>() -> impl Iterator<Item = Option<&'a Option<Alias>>> {
    std::iter::repeat(None)
}

fn word(kind: VariableKind) -> &'static str {
    match kind {
        VariableKind::Time => "time",
        VariableKind::Constant(_) => "constant",
        VariableKind::Parameter { tunable: true } => "parameter",
        VariableKind::Parameter { tunable: false } => "evaluated parameter",
        VariableKind::Solved => "parameter solved for",
        VariableKind::Unknown => "unknown",
        VariableKind::Derivative(_) => "derivative",
        VariableKind::Discrete => "discrete",
        VariableKind::Previous(_) => "previous",
        VariableKind::Frozen => "frozen",
        VariableKind::Delayed => "delayed",
        VariableKind::Signal => "signal",
        VariableKind::Text => "text",
        VariableKind::Clock => "clock",
    }
}
