//! Nets, their evaluation, and the ways into them.

pub(super) mod coons;
pub(super) mod eval;
pub(super) mod hermite;
pub(super) mod nets;
pub(super) mod quadrics;
pub(super) mod splines;
