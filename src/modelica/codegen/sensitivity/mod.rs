//! Forward sensitivities: derivatives of a simulation by some of its parameters, carried along with
//! the variables.
//!
//! With s = dy/dp for each of the m parameters,
//!
//! ```text
//! between events   s_x' = f_y s + f_p,     0 = g_y s + g_p
//! at the start     the initial system, differentiated
//! at an event      dτ = −(φ_y s + φ_p) / φ̇          the time τ of a crossing φ(t, y, p) = 0
//!                  d  = s + ẋ⁻ dτ                    the total derivative before it
//!                  d⁺ = the event's equations, differentiated, of d and dτ
//!                  s⁺ = d⁺ − ẋ⁺ dτ
//! ```
//!
//! Discrete variables keep their total derivative d⁺ between events. There is a column for each
//! parameter that the solution depends on (`directions`). Between events f_y is the Jacobian of the
//! integrator, and code computes f_p alone (`right_sides`); all else is made from the expressions of
//! the model, column by column; torn loops by the theorem of implicit functions, with their
//! Jacobians. External functions alone are differentiated by central differences, as in
//! the Jacobian.
//!
//! References: [Brenan, Campbell & Petzold 1996](gapilib_base::bibliography#brenan-campbell-petzold-1996);
//! jumps as in [Galán, Feehery & Barton 1999](gapilib_base::bibliography#galan-feehery-barton-1999).

mod blocks;
mod code;
mod directions;
mod right_sides;

pub(super) use blocks::through_blocks;
pub use code::SensitivityCode;
pub(crate) use right_sides::RightSidesSpace;
