//! What several suites share: no tests, only what makes them short.

pub(crate) mod cluster;
pub(crate) mod conformance;
pub(crate) mod flat_class;
pub(crate) mod shipped;
