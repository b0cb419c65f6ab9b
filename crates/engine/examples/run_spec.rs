//! Runs a spec from a JSON file and prints how fast: the place to profile the core without Python.
//! `cargo run --release -p klingel-engine --example run_spec -- spec.json`

use klingel_engine::control::Externals;
use klingel_engine::{Progress, Spec, simulate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).ok_or("give the path of a spec (JSON)")?;
    let spec: Spec = serde_json::from_str(&std::fs::read_to_string(path)?)?;
    let series = simulate(&spec, Externals::new(), &Progress::default())?;
    let simulated = series.time.last().copied().unwrap_or(0.0);
    println!("{}: {simulated:.2} s simulated, {:.1} times real time", spec.name, simulated / series.cpu_time);
    println!("{:.2} us a right-hand side", 1e6 * series.cpu_time / series.evaluations as f64);
    if let Some((time, fault)) = series.fault {
        println!("ended at {time:.3} s: {fault}");
    }
    Ok(())
}
