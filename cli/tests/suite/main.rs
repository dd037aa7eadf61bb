//! The program from outside: its command line, its files, the course's scenes; and the formats it reads and writes.

mod air;
mod bad_input;
mod check;
mod command_line;
mod compare;
mod compare_rays;
mod conversion;
mod course;
mod films;
mod fuzz;
mod lab;
mod looks;
mod onset;
#[cfg(unix)]
mod outputs;
mod pace;
mod random;
mod recorded;
mod recorded_bodies;
mod recordings;
mod remarks;
mod remarks_silent;
mod robustness;
mod round_trip;
mod scenes;
mod scn;
mod sinks;
mod sprites;
mod stall;
mod styles;
mod tool;
mod touching;
mod worlds;
