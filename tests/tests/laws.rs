//! All tests of laws in one program, so that the engine is compiled for them once: `cargo test -p pointmass-tests --test laws walls`.

mod adaptive;
mod alike;
mod all_pairs;
mod balls;
#[path = "barnes_hut/main.rs"]
mod barnes_hut;
mod births;
mod blows;
mod bonds_on_scenery;
mod carried;
mod chains_of_bodies;
#[path = "circles/main.rs"]
mod circles;
mod clusters;
mod clusters_at_walls;
mod collisions;
mod company;
mod compounds;
mod constraints;
#[path = "contacts/main.rs"]
mod contacts;
mod crowds;
mod density;
mod drops;
mod emission;
mod extend;
mod faces;
#[path = "forces/main.rs"]
mod forces;
mod foreign_words;
mod free_flight;
mod goals;
mod hulls;
mod hung_sheets;
mod identity;
mod implicit;
#[path = "indices/main.rs"]
mod indices;
mod integrators;
mod isotropic_sheets;
mod laden_sheets;
mod ledger;
mod ledges;
mod lengths;
mod likeness;
mod lives;
mod looks;
mod mesh_floors;
mod pegs;
mod pendulums;
mod pieces;
#[path = "rays/main.rs"]
mod rays;
mod reapers;
mod rigid;
mod rocking;
mod rolling;
mod rooms;
mod rope_energy;
mod ropes;
mod rounding;
mod sampling;
mod scripted;
#[path = "sheet_contacts/main.rs"]
mod sheet_contacts;
mod sheets;
mod shell_crushes;
mod shell_meshes;
mod sleep;
mod slender;
mod soft_bodies;
mod sound;
mod springs;
mod static_friction;
mod still;
mod stopped;
mod storage;
mod straight_paths;
mod strain_limits;
mod strands;
mod threads;
mod through_sides;
mod tied_bodies;
mod ties;
mod tunnelling;
mod turned_strands;
#[path = "walls/main.rs"]
mod walls;
mod ways;
