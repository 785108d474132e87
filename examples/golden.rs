//! Writes the golden logs of `tests/golden/` that are missing; `--replace` writes all of the newest format again.
//!
//! ```sh
//! cargo run --release --example golden
//! cargo run --release --example golden -- --replace
//! ```

#![expect(clippy::unwrap_used, reason = "a tool of the project stops where files cannot be written")]
#![expect(clippy::print_stdout, reason = "it names what it has written")]

#[path = "../tests/stored_runs/mint.rs"]
mod mint;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let replaces = match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => false,
        ["--replace"] => true,
        _ => panic!("{words:?}: `--replace` is the one word there is"),
    };
    std::fs::create_dir_all(mint::folder()).unwrap();
    for (engine, dimension) in mint::all() {
        let log = mint::place(engine, dimension);
        if replaces || !log.exists() {
            mint::write(engine, dimension, &log);
            println!("{}", log.display());
        }
    }
}
