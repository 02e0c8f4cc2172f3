//! The genetic algorithm of GAPILib: random numbers, populations and operators on vectors of
//! genes. Knows nothing of Modelica or of simulation.
//!
//! Operators are chosen from their tables, or written by the user in Modelica ([`operators`]).
//!
//! One generation of the paper's algorithm, on a population ordered by fitness:
//!
//! ```text
//! parents   = truncation(N_Parents)                     best ranks become parents
//! children  = one_point(parents, Cross_Point)           adjacent ranks, genes after each point
//! children  = uniform mutation(children, F_Mut)         one number decides whether and what
//! offspring = elites, children, random individuals      elites unaltered, random ones last
//! ```
//!
//! Every operator is a pure function of its arguments, random numbers included, in a separate file,
//! with an entry in the table of its kind. A file with an entry and a row in the table add one.
//!
//! Reference: [Rubio et al. 2006](gapilib_base::bibliography#rubio-2006).

pub mod crossover;
pub mod errors;
pub mod mutation;
pub mod operators;
pub mod optimizer;
pub mod sampling;
pub mod selection;
pub mod survival;

mod gene;
mod history;
mod hypervolume;
mod individual;
#[cfg(test)]
mod operators_tests;
mod population;
mod rng;

pub use gene::Gene;
pub use history::{Generation, History};
pub use hypervolume::hypervolume;
pub use individual::{FAILED_FITNESS, Individual, has_failed};
pub use population::{Genomes, best, order, sort_by_fitness};
pub use rng::Mrg32k3a;
