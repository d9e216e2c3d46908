//! Modules that several test binaries share.

#![allow(dead_code, reason = "each binary uses a part")]

pub mod agree;
