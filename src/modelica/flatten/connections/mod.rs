//! Connections (MLS ch. 9): connection sets over the whole instance tree become equations.
//!
//! Each scalar of a connector has two sides: the inside one, seen by the instance that holds the
//! component with the connector, and the outside one, seen by that component's own connections
//! (MLS §9.1.2). Potentials of a set are equal, flows sum to zero, a flow that no connection sees
//! from the inside is zero, and streams mix (ch. 15). Because the sets are formed over the whole
//! tree, a connector reached through a component (`connect(layer.port.pin, …)`) is in the same set
//! as in the connections made inside that component.

mod collect;
pub(crate) mod end;
mod ends;
mod expandable;
pub(crate) mod graph;
mod operators;
mod overconstrained;
pub(crate) mod own_signals;
mod pairs;
mod set_equations;
pub(crate) mod sets;
mod stream;

pub(crate) use sets::ScalarPair;
pub(crate) use stream::arranged;
