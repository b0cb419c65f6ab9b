//! Gives the extension a hash of the sources it was built from, so that a stale build is noticed.
//! SHA-256 over the sorted paths below the workspace (crates/**, Cargo.toml, Cargo.lock): path, NUL, content, NUL.

use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = vec![root.join("Cargo.toml"), root.join("Cargo.lock")];
    collect(&root.join("crates"), &mut files);
    let mut named: Vec<(String, PathBuf)> = files
        .into_iter()
        .filter_map(|f| Some((f.strip_prefix(&root).ok()?.to_string_lossy().replace('\\', "/"), f)))
        .collect();
    named.sort();
    let mut hash = Sha256::new();
    for (name, file) in &named {
        println!("cargo:rerun-if-changed={}", file.display());
        hash.update(name.as_bytes());
        hash.update([0]);
        hash.update(std::fs::read(file).unwrap_or_default());
        hash.update([0]);
    }
    println!("cargo:rerun-if-changed=../../crates");
    let hex: String = hash.finalize().iter().map(|b| format!("{b:02x}")).collect();
    println!("cargo:rustc-env=KLINGEL_SOURCE_HASH={hex}");
    println!("cargo:rustc-env=KLINGEL_PROFILE={}", std::env::var("PROFILE").unwrap_or_default());
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|e| e == "rs" || e == "toml") {
            files.push(path);
        }
    }
}
