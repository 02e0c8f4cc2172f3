//! What scripts and models may read, write and remove: files, permissions, the policy.

pub(in crate::script) mod files;
pub(in crate::script) mod permissions;
pub mod policy;
