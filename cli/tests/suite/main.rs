//! The program from outside: its command line, its files, the course's scenes; and the formats it reads and writes.

mod bad_input;
mod check;
mod command_line;
mod compare;
mod compare_rays;
mod conversion;
mod course;
mod fuzz;
mod lab;
mod random;
mod recordings;
mod robustness;
mod round_trip;
mod scenes;
mod scn;
mod sinks;
mod stall;
mod tool;
