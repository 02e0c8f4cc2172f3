//! What scripts and models may read, write and remove: files, permissions, the policy.

pub mod faults;
pub mod files;
mod grants;
pub mod permissions;
pub mod policy;
pub mod process;
