//! The library that C programs link, and nothing but it: the calls of `rust-core/src/api/c_api.rs`, declared in
//! `rust-core/include/prob_water.h`.

extern crate model as _;
