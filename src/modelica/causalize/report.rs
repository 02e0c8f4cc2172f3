//! The sorted system as text, for `--dump` and snapshots.

use super::causalized::{Assignment, Block, CausalizedDae, LinearLoop};
use crate::lower::VariableKind;
use crate::symbolic::{Expr, Node, VarId, print};
use std::fmt::Write;

/// Counts, aliases and blocks.
pub fn report(sorted: &CausalizedDae) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write_report(sorted, &mut out);
    out
}

fn write_report(sorted: &CausalizedDae, out: &mut String) -> std::fmt::Result {
    let dae = &sorted.dae;
    let count =
        |test: &dyn Fn(VariableKind) -> bool| dae.variables.iter().filter(|v| test(v.kind)).count();
    let loops = sorted.blocks.iter().filter(|b| !matches!(b, Block::Assignment(_))).count();
    writeln!(out, "{}", dae.name)?;
    writeln!(out, "  states {}", sorted.states.len())?;
    writeln!(out, "  equations {}", dae.equations.len())?;
    writeln!(out, "  aliases {}", sorted.aliases.iter().flatten().count())?;
    writeln!(out, "  parameters {}", count(&|k| matches!(k, VariableKind::Parameter { .. })))?;
    writeln!(out, "  constants {}", count(&|k| matches!(k, VariableKind::Constant(_))))?;
    writeln!(out, "  relations {}", dae.relations.len())?;
    writeln!(out, "  blocks {}", sorted.blocks.len())?;
    writeln!(out, "  algebraic loops {loops}")?;
    for (position, alias) in sorted.aliases.iter().enumerate() {
        if let Some(alias) = alias {
            let sign = if alias.negated { "-" } else { "" };
            let name = &dae.variables[position].name;
            writeln!(out, "alias {name} = {sign}{}", dae.variable(alias.of).name)?;
        }
    }
    for relation in &dae.relations {
        let (left, right) = (text(sorted, relation.left), text(sorted, relation.right));
        let name = &dae.variable(relation.variable).name;
        writeln!(out, "event {name} = {left} {} {right}", relation.operator.symbol())?;
    }
    write_blocks(sorted, out)?;
    write_events(sorted, out)?;
    if !dae.initial_equations.is_empty() {
        writeln!(out, "initially")?;
        write_initial_blocks(sorted, out)?;
    }
    Ok(())
}

/// The blocks between events.
pub(super) fn write_blocks(sorted: &CausalizedDae, out: &mut String) -> std::fmt::Result {
    sorted.blocks.iter().try_for_each(|block| write_block(sorted, block, out))
}

/// The blocks at events.
pub(super) fn write_event_blocks(sorted: &CausalizedDae, out: &mut String) -> std::fmt::Result {
    sorted.event_blocks.iter().try_for_each(|block| write_block(sorted, block, out))
}

/// The blocks of the initial system.
pub(super) fn write_initial_blocks(sorted: &CausalizedDae, out: &mut String) -> std::fmt::Result {
    sorted.initial_blocks.iter().try_for_each(|block| write_block(sorted, block, out))
}

/// What happens at events beside relations that switch.
fn write_events(sorted: &CausalizedDae, out: &mut String) -> std::fmt::Result {
    let dae = &sorted.dae;
    let events = &dae.events;
    let name = |v: VarId| &dae.variable(v).name;
    for sample in &events.samples {
        let (start, interval) = (text(sorted, sample.start), text(sorted, sample.interval));
        writeln!(out, "event {} = sample({start}, {interval})", name(sample.variable))?;
    }
    for recording in &events.recordings {
        let knots = recording.knots.len();
        for track in &recording.tracks {
            writeln!(out, "event {} is recorded at {knots} knots", name(track.value))?;
        }
    }
    for rounding in &events.roundings {
        let argument = text(sorted, rounding.argument);
        writeln!(out, "event {} = floor({argument})", name(rounding.variable))?;
    }
    if !sorted.event_blocks.is_empty() {
        writeln!(out, "at events")?;
        write_event_blocks(sorted, out)?;
    }
    for reinit in &events.reinits {
        let (value, condition) = (text(sorted, reinit.value), text(sorted, reinit.condition));
        writeln!(out, "reinit {} := {value} if {condition}", name(reinit.state))?;
    }
    for iterated in &sorted.iterated {
        writeln!(out, "repeat until {} stays", name(*iterated))?;
    }
    Ok(())
}

fn write_block(sorted: &CausalizedDae, block: &Block, out: &mut String) -> std::fmt::Result {
    let assign = |a: &Assignment| {
        format!("{} := {}", sorted.dae.variable(a.variable).name, text(sorted, a.value))
    };
    match block {
        Block::Assignment(assignment) => writeln!(out, "{}", assign(assignment)),
        Block::Linear(solved) => {
            let names: Vec<&str> =
                solved.unknowns.iter().map(|v| &*sorted.dae.variable(*v).name).collect();
            let n = solved.assignments.len();
            writeln!(out, "linear loop of {n} solved for {}", names.join(", "))?;
            write_matrix(sorted, solved, out)?;
            let is_written =
                |a: &&Assignment| !matches!(sorted.dae.pool.node(a.value), Node::Solution { .. });
            let assignments = solved.assignments.iter().filter(is_written);
            assignments.into_iter().try_for_each(|a| writeln!(out, "  {}", assign(a)))
        }
        Block::Loop(torn) => {
            let names: Vec<&str> =
                torn.iteration.iter().map(|v| &*sorted.dae.variable(*v).name).collect();
            writeln!(
                out,
                "loop of {} over {}",
                torn.assignments.len() + names.len(),
                names.join(", ")
            )?;
            torn.assignments.iter().try_for_each(|a| writeln!(out, "  {}", assign(a)))?;
            torn.residuals.iter().try_for_each(|(r, _)| writeln!(out, "  0 = {}", text(sorted, *r)))
        }
    }
}

/// The rows of a system that is solved by elimination, as `{entries} | right side`.
fn write_matrix(sorted: &CausalizedDae, solved: &LinearLoop, out: &mut String) -> std::fmt::Result {
    let pool = &sorted.dae.pool;
    let Some(first) = solved.assignments.first() else { return Ok(()) };
    let Node::Solution { matrix, right, .. } = *pool.node(first.value) else { return Ok(()) };
    let (entries, rights) = (pool.entries(matrix), pool.entries(right));
    for (row, right) in entries.chunks(rights.len()).zip(rights) {
        let row: Vec<String> = row.iter().map(|e| text(sorted, *e)).collect();
        writeln!(out, "  {{{}}} | {}", row.join(", "), text(sorted, *right))?;
    }
    Ok(())
}

fn text(sorted: &CausalizedDae, e: Expr) -> String {
    print(&sorted.dae.pool, e, &|v: VarId| sorted.dae.variable(v).name.to_string())
}
