//! The intervals of `min` and `max` (MLS §4.9) of the variables that a simulation computes.

use super::System;
use crate::codegen::Access;
use crate::flatten::BaseType;
use crate::source::Span;

/// The interval that a variable is declared with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeclaredRange {
    /// Its position in [`Program::variables`](crate::codegen::Program::variables).
    pub variable: usize,
    /// Its smallest and largest value; infinite without.
    pub limits: [f64; 2],
    /// Its `nominal`, 1 without.
    pub nominal: f64,
    /// Its declaration.
    pub span: Span,
}

impl System {
    /// The intervals of all observed numbers that have one, with the parameters of this system.
    pub fn declared_ranges(&self) -> Vec<DeclaredRange> {
        let dae = &self.program.sorted.dae;
        let values = dae.defaults.with_parameters(dae, |at| self.registers[at]);
        let range = |(at, info): (usize, &crate::codegen::VariableInfo)| {
            let declared = dae.variable(info.variable);
            let is_number = matches!(info.base, BaseType::Real | BaseType::Integer);
            let is_limited = declared.min.is_some() || declared.max.is_some();
            let is_observed = matches!(info.access, Access::Observed { .. });
            (is_number && is_limited && is_observed).then(|| {
                let attributes = values.attributes(dae, declared);
                DeclaredRange {
                    variable: at,
                    limits: [
                        attributes.min.unwrap_or(f64::NEG_INFINITY),
                        attributes.max.unwrap_or(f64::INFINITY),
                    ],
                    nominal: attributes.nominal.unwrap_or(1.0).abs(),
                    span: declared.span,
                }
            })
        };
        self.program.variables().iter().enumerate().filter_map(range).collect()
    }
}
