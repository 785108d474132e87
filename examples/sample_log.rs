//! Writes a small log with every kind of message, on which readers in other languages are tried:
//!
//! ```sh
//! cargo run --release --example sample_log -- sample.mcap
//! ```

#![expect(clippy::unwrap_used, reason = "a tool of the project stops where a file cannot be written")]

#[path = "../tests/log/sample.rs"]
mod sample;

fn main() {
    let path = std::env::args().nth(1).expect("the path of the log is given");
    sample::write_sample(std::path::Path::new(&path));
}
