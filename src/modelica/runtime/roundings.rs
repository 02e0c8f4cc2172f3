//! Roundings (`floor`, `integer`, `div`, …) that keep their values between events (MLS §3.7.2).

use super::instants::AT_ONCE;
use super::system::System;

impl System {
    /// Evaluates every rounding at the values of the variables; whether one changed.
    pub(super) fn update_roundings(&mut self, t: f64) -> bool {
        let program = self.program.clone();
        let mut changed = false;
        for (rounding, code) in program.events.roundings.iter().zip(&program.events.rounded) {
            let value = match rounding.time {
                Some((rate, rest)) => {
                    let direction = if self.relations.is_at_start { 0.0 } else { rate };
                    rounded_in_time(rate * t + self.registers[rest as usize], direction)
                }
                None => match code.tape.run(&mut self.registers) {
                    Ok(()) => self.registers[code.outputs[0] as usize].floor(),
                    Err(_) => continue,
                },
            };
            let slot = &mut self.registers[rounding.register as usize];
            if *slot != value {
                changed = true;
                self.events.unstable = rounding.register;
            }
            *slot = value;
        }
        changed
    }

    /// Whether what is rounded decreases in time and is whole at `t`.
    pub(super) fn rounds_down_after(&self, t: f64) -> bool {
        self.program.events.roundings.iter().any(|rounding| {
            rounding.time.is_some_and(|(rate, rest)| {
                let value = rate * t + self.registers[rest as usize];
                rounded_in_time(value, rate) != rounded_in_time(value, 0.0)
            })
        })
    }

    /// For every rounding the time at which it jumps next, if it is one of time.
    pub(super) fn jumps_of_roundings(&self) -> impl Iterator<Item = Option<f64>> {
        self.program.events.roundings.iter().map(|rounding| {
            let (factor, rest) = rounding.time?;
            let value = self.registers[rounding.register as usize];
            let next = if factor > 0.0 { value + 1.0 } else { value };
            Some((next - self.registers[rest as usize]) / factor)
        })
    }
}

/// `floor`; at a jump the value that follows in the direction of the rate.
fn rounded_in_time(value: f64, rate: f64) -> f64 {
    let nearest = value.round();
    if (value - nearest).abs() > AT_ONCE * value.abs().max(1.0) {
        return value.floor();
    }
    if rate >= 0.0 { nearest } else { nearest - 1.0 }
}
