#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]
//! TODO front page

#[cfg(feature = "std")]
extern crate std;
#[cfg(test)]
extern crate std;

pub mod forward;
pub mod geometry;
pub mod num;
pub mod patch;
