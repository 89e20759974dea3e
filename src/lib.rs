#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]
//! TODO front page

#[cfg(any(test, feature = "std"))]
extern crate std;

pub mod forward;
pub mod geometry;
#[cfg(feature = "graphics")]
#[cfg_attr(docsrs, doc(cfg(feature = "graphics")))]
pub mod graphics;
pub mod num;
pub mod patch;
#[cfg(feature = "std")]
#[cfg_attr(docsrs, doc(cfg(feature = "std")))]
pub mod reference;
pub mod render;
