//! Clock inference (MLS §16.7.5): the intervals and shifts of all sub-partitions, from those given.

use super::Base;
use super::conversion::{Grid, Rational};
use super::partitions::{Link, Partitions};
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::builder::Builder;
use crate::lower::errors::{CLOCK_CONFLICT, NOT_SUPPORTED};
use num_traits::CheckedDiv;
use std::collections::VecDeque;

impl Builder<'_> {
    /// The intervals of all sub-partitions.
    pub(super) fn infer_intervals(
        &mut self,
        partitions: &mut Partitions,
    ) -> Result<(), Diagnostic> {
        let links = self.links(partitions);
        self.follow(partitions, &links)?;
        self.default_clocks(partitions, &links)?;
        check_links(partitions, &links)?;
        (0..partitions.subs.len()).try_for_each(|at| self.check_sub(partitions, at))
    }

    /// Intervals along the conversions, from every one that is known.
    fn follow(&self, partitions: &mut Partitions, links: &[Link]) -> Result<(), Diagnostic> {
        let mut near: Vec<Vec<usize>> = vec![Vec::new(); partitions.subs.len()];
        for (at, link) in links.iter().enumerate() {
            near[link.argument].push(at);
            near[link.value].push(at);
        }
        let mut open: VecDeque<usize> =
            (0..near.len()).filter(|at| partitions.subs[*at].grid.is_some()).collect();
        while let Some(from) = open.pop_front() {
            let Some(grid) = partitions.subs[from].grid else { continue };
            for link in near[from].iter().map(|at| links[*at]) {
                let (to, follows) = match link.argument == from {
                    true => (link.value, link.conversion.forward(grid)),
                    false => (link.argument, link.conversion.backward(grid)),
                };
                let Some(follows) = follows else { continue };
                let follows = follows.map_err(|()| {
                    fault!(
                        NOT_SUPPORTED,
                        "the interval of this clock is a fraction of too large \
                        numbers"
                    )
                    .at(link.span)
                })?;
                match partitions.subs[to].grid {
                    None => {
                        partitions.subs[to].grid = Some(follows);
                        open.push_back(to);
                    }
                    Some(known) if known == follows => {}
                    Some(known) => {
                        return Err(conflict(partitions, to, link, known, follows));
                    }
                }
            }
        }
        Ok(())
    }

    /// `Clock(1.0)` for the fastest part of partitions without any clock.
    fn default_clocks(
        &mut self,
        partitions: &mut Partitions,
        links: &[Link],
    ) -> Result<(), Diagnostic> {
        for base in 0..partitions.bases.len() {
            let members: Vec<usize> =
                (0..partitions.subs.len()).filter(|at| partitions.subs[*at].base == base).collect();
            if members.iter().any(|at| partitions.subs[*at].grid.is_some()) {
                continue;
            }
            let Some(first) = members.first() else { continue };
            partitions.subs[*first].grid = Some(Grid::of(Rational::from(1)));
            self.follow(partitions, links)?;
            let intervals = members.iter().filter_map(|at| partitions.subs[*at].grid);
            let Some(fastest) = intervals.map(|grid| grid.interval).min() else { continue };
            for at in &members {
                if let Some(grid) = &mut partitions.subs[*at].grid {
                    let scaled = |value: Rational| value.checked_div(&fastest).unwrap_or(value);
                    (grid.interval, grid.shift) = (scaled(grid.interval), scaled(grid.shift));
                }
            }
            let span = partitions.bases[base].span;
            partitions.bases[base].clock = Base::Rational(Rational::from(1));
            self.dae.warnings.push(
                fault!(CLOCK_CONFLICT, "no clock is given for this: it ticks every second";
                    help: "give one, such as `sample(u, Clock(0.1))`")
                .at(span)
                .warning(),
            );
        }
        Ok(())
    }

    /// What a sub-partition must be to tick with its base.
    fn check_sub(&self, partitions: &Partitions, at: usize) -> Result<(), Diagnostic> {
        let sub = &partitions.subs[at];
        let name = self.name_for_message(sub.variable);
        let Some(grid) = sub.grid else {
            return Err(fault!(CLOCK_CONFLICT, "the clock of {name} cannot be inferred";
                help: "give it a clock, or the conversion a factor")
            .at(sub.span));
        };
        if grid.is_before_base() {
            return Err(fault!(CLOCK_CONFLICT, "the clock of {name} starts before its base clock")
                .at(sub.span));
        }
        let is_timed =
            matches!(partitions.bases[sub.base].clock, Base::Rational(_) | Base::Real(_));
        let is_on_ticks = grid.interval.is_integer() && grid.shift.is_integer();
        if !is_timed && !is_on_ticks {
            return Err(fault!(NOT_SUPPORTED,
                "the clock of {name} ticks between the ticks of a clock whose next tick is not known";
                help: "only every n-th tick of such a clock can be used")
            .at(sub.span));
        }
        Ok(())
    }
}

fn conflict(
    partitions: &Partitions,
    sub: usize,
    link: Link,
    known: Grid,
    follows: Grid,
) -> Diagnostic {
    let words = |grid: Grid| match grid.shift == Rational::from(0) {
        true => format!("interval {}", grid.interval),
        false => format!("interval {} and shift {}", grid.interval, grid.shift),
    };
    let unit = match partitions.bases[partitions.subs[sub].base].clock {
        Base::Rational(_) => "seconds",
        _ => "ticks of the base clock",
    };
    fault!(
        CLOCK_CONFLICT,
        "two clocks for one partition: by this conversion {}, but {} otherwise, in {unit}",
        words(follows),
        words(known)
    )
    .at(link.span)
    .related(partitions.subs[sub].span, "given here")
}

/// Where factors are inferred, they must be whole numbers.
fn check_links(partitions: &Partitions, links: &[Link]) -> Result<(), Diagnostic> {
    for link in links {
        let (argument, value) =
            (partitions.subs[link.argument].grid, partitions.subs[link.value].grid);
        if let (Some(argument), Some(value)) = (argument, value)
            && !link.conversion.admits(argument, value)
        {
            return Err(fault!(
                CLOCK_CONFLICT,
                "the factor of this conversion cannot be inferred: the intervals are {} and {}",
                argument.interval,
                value.interval
            )
            .at(link.span));
        }
    }
    Ok(())
}
