//! Contact tables of profile pairs: compiled once, then taken from memory or from the cache folder.
//! A table is known by a hash of everything it depends on: profiles, placement, material, method and builder.

pub mod disk;

use klingel_physics::contact::{ContactError, ContactTable, Material, NormalContact, PairGeometry, Profile};
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};
use std::time::Instant;

/// Where a table came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Compiled now.
    Compiled,
    /// Read from the cache folder.
    Disk,
    /// Used before by this process.
    Memory,
}

/// A table and what it took to have it.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub table: Arc<ContactTable>,
    pub origin: Origin,
    /// Time on the clock \[s\].
    pub seconds: f64,
    /// Why the table could not be kept on disk.
    pub unkept: Option<String>,
}

/// Tables live as long as the process: runs of a study share them.
static TABLES: Mutex<Option<HashMap<String, Arc<ContactTable>>>> = Mutex::new(None);

/// The table of a pair; others who want one wait while it is compiled.
///
/// # Errors
/// What [`ContactTable::build`] refuses.
pub fn contact_table(
    pair: &PairGeometry,
    material: &Material,
    normal: NormalContact,
) -> Result<Prepared, ContactError> {
    let start = Instant::now();
    let name = hash(pair, material, normal);
    let mut tables = TABLES.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let tables = tables.get_or_insert_with(HashMap::new);
    let (table, origin, unkept) = if let Some(table) = tables.get(&name) {
        (Arc::clone(table), Origin::Memory, None)
    } else {
        let folder = disk::folder();
        let kept = folder.as_ref().and_then(|f| disk::read(f, &name)).and_then(|b| ContactTable::from_bytes(&b));
        let (table, origin, unkept) = match kept {
            Some(table) => (table, Origin::Disk, None),
            None => {
                let table = ContactTable::build(pair, material, normal)?;
                let written = folder.map_or(Ok(()), |f| disk::write(&f, &name, &table.to_bytes()));
                (table, Origin::Compiled, written.err().map(|e| e.to_string()))
            }
        };
        let table = Arc::new(table);
        tables.insert(name, Arc::clone(&table));
        (table, origin, unkept)
    };
    Ok(Prepared { table, origin, seconds: start.elapsed().as_secs_f64(), unkept })
}

/// SHA-256, in hexadecimal digits, of what a table depends on.
fn hash(pair: &PairGeometry, material: &Material, normal: NormalContact) -> String {
    let mut hash = Sha256::new();
    hash.update(env!("KLINGEL_BUILDER_HASH"));
    hash.update(format!("{normal:?}"));
    for x in
        [pair.rail_inclination, pair.gauge, pair.flange_back, pair.radius, material.youngs_modulus, material.poisson]
    {
        hash.update(x.to_le_bytes());
    }
    for Profile { y, z, slope } in [&pair.wheel, &pair.rail] {
        for column in [y, z, slope] {
            hash.update(column.len().to_le_bytes());
            column.iter().for_each(|x| hash.update(x.to_le_bytes()));
        }
    }
    hash.finalize().iter().map(|b| format!("{b:02x}")).collect()
}
