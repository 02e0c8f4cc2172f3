//! Problems, populations, statistics and reports; runs that are interrupted, watched and divided.

mod claims;
mod correlated_outputs;
mod digits;
mod fuel_cell_benchmark;
mod gapilib;
mod identification_sets;
mod identified_models;
mod identify;
mod laboratory;
mod measured_time;
mod nist_problems;
mod operators;
mod points_over_variables;
mod process_noise;
mod ranks;
mod relative_data;
mod report_page;
mod resume;
mod scale;
mod script_reports;
mod searches;
mod shards;
mod spectra;
mod watching;
mod whole_runs;
