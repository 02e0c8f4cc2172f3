//! What scripts and models may read, write and remove: files, permissions, the policy.

pub mod faults;
mod files;
mod grants;
pub mod outdated;
pub mod permissions;
pub mod policy;
pub mod process;
