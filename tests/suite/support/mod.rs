//! What several suites share: no tests, only what makes them short.

pub(crate) mod browser;
pub(crate) mod cluster;
pub(crate) mod conformance;
pub(crate) mod flat_class;
pub(crate) mod guide;
pub(crate) mod guide_charts;
pub(crate) mod guide_diagrams;
pub(crate) mod identified;
pub(crate) mod program;
pub(crate) mod shipped;
pub(crate) mod simulated;
pub(crate) mod transcript;
