//! Files of the cache: written whole under another name and renamed, so that processes never see a part of one.
//! A file is a SHA-256 of its content and the content; one that does not match is as good as none.

use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use std::{env, fs, io, process};

/// Variable that names the cache folder; `off` does without one.
const VARIABLE: &str = "KLINGEL_CACHE";
const EXTENSION: &str = "table";
const SUM: usize = 32;
/// Tables kept; the ones written longest ago go first.
const KEPT: usize = 16;

/// Where compiled contact tables are kept: `$KLINGEL_CACHE`, or `klingel` in the user's cache folder; none if there is none.
pub fn folder() -> Option<PathBuf> {
    let set = |name: &str| env::var_os(name).filter(|value| !value.is_empty());
    match set(VARIABLE) {
        Some(off) if off == "off" => None,
        Some(folder) => Some(folder.into()),
        None => {
            let home = || set("HOME").map(|home| PathBuf::from(home).join(".cache"));
            set("XDG_CACHE_HOME").map(PathBuf::from).or_else(home).map(|cache| cache.join("klingel"))
        }
    }
}

/// The content kept under `name`, if it is there and undamaged.
pub(super) fn read(folder: &Path, name: &str) -> Option<Vec<u8>> {
    let mut bytes = fs::read(place(folder, name)).ok()?;
    let (sum, content) = bytes.split_at_checked(SUM)?;
    if Sha256::digest(content).as_slice() != sum {
        return None;
    }
    bytes.drain(..SUM);
    Some(bytes)
}

/// Keeps `content` under `name`, and removes the oldest tables beyond [`KEPT`].
pub(super) fn write(folder: &Path, name: &str, content: &[u8]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    // Threads of one process wait for each other, so its number makes the name unique.
    let draft = folder.join(format!("{name}.{}.draft", process::id()));
    let mut bytes = Sha256::digest(content).to_vec();
    bytes.extend_from_slice(content);
    let written = fs::write(&draft, bytes).and_then(|()| fs::rename(&draft, place(folder, name)));
    if written.is_err() {
        // What is left of the draft is of no use; the first error is the one to tell.
        let _ = fs::remove_file(&draft);
    }
    written?;
    prune(folder)
}

fn place(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.{EXTENSION}"))
}

/// The tables of a folder, the newest first, with their sizes in bytes.
fn tables(folder: &Path) -> io::Result<Vec<(PathBuf, u64)>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        // Another process may remove it at the same time.
        if let (true, Ok(data)) = (path.extension().is_some_and(|e| e == EXTENSION), fs::metadata(&path)) {
            found.push((data.modified().unwrap_or(SystemTime::UNIX_EPOCH), path, data.len()));
        }
    }
    found.sort_by(|a, b| b.cmp(a));
    Ok(found.into_iter().map(|(_, path, size)| (path, size)).collect())
}

/// Name, size in bytes and whether the check sum is right, of every table of a folder; another process may remove some
/// meanwhile, which then do not count.
pub fn check(folder: &Path) -> Vec<(String, u64, bool)> {
    let look = |(path, size): (PathBuf, u64)| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let whole = read(folder, &name).is_some();
        (whole || path.exists()).then_some((name, size, whole))
    };
    tables(folder).unwrap_or_default().into_iter().filter_map(look).collect()
}

fn prune(folder: &Path) -> io::Result<()> {
    for (path, _) in tables(folder)?.into_iter().skip(KEPT) {
        match fs::remove_file(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fresh(name: &str) -> PathBuf {
        let folder = env::temp_dir().join(format!("klingel-{}-{name}", process::id()));
        let _ = fs::remove_dir_all(&folder);
        folder
    }

    #[test]
    fn what_was_kept_comes_back_and_what_is_damaged_does_not() {
        let folder = fresh("damage");
        assert_eq!(read(&folder, "a"), None);
        write(&folder, "a", b"a table").unwrap();
        assert_eq!(read(&folder, "a").as_deref(), Some(&b"a table"[..]));
        for damage in [&b"short"[..], &[0; 80]] {
            fs::write(place(&folder, "a"), damage).unwrap();
            assert_eq!(read(&folder, "a"), None);
        }
        write(&folder, "a", b"again").unwrap();
        assert_eq!(read(&folder, "a").as_deref(), Some(&b"again"[..]));
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn only_the_newest_tables_are_kept() {
        let folder = fresh("many");
        for i in 0..KEPT + 3 {
            write(&folder, &format!("{i}"), &[7; 10]).unwrap();
        }
        fs::write(place(&folder, &format!("{}", KEPT + 1)), [0; 42]).unwrap();
        let kept = check(&folder);
        assert_eq!(
            (kept.len(), kept.iter().filter(|(_, size, whole)| *size == 42 && *whole).count()),
            (KEPT, KEPT - 1)
        );
        assert!(read(&folder, &format!("{}", KEPT + 2)).is_some());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_an_error_to_tell() {
        let folder = fresh("file");
        fs::write(&folder, b"not a folder").unwrap();
        assert!(write(&folder, "a", b"x").is_err());
        fs::remove_file(folder).unwrap();
    }
}
