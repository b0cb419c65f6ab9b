//! The table's file: a header of text lines that a person can read, then numbers, little endian.
//! Each coefficient takes two bytes; the header tells what they are worth, how they were made and their check sum.

use super::CreepError;
use super::lookup::{ROW, Spline};
use sha2::{Digest, Sha256};

const TITLE: &str = "klingel creep table 1";
/// Largest whole number of a coefficient.
const MOST: f64 = i16::MAX as f64;

/// What a table was made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    pub poisson: f64,
    /// Elements along and across at every node, and those of the correction.
    pub coarse: [usize; 2],
    pub fine: [usize; 2],
    /// SHA-256 over the sources of the solver (`Maker::solver`), and over the rest of the file.
    pub solver: String,
    pub checksum: String,
    /// Intervals from the middle to the surface of the ball of creepages along each axis, and over the slenderness.
    pub intervals: [usize; 4],
}

/// Coefficients of the stored quarter: u1 and u3 from 0, u2 from below -1, the slenderness fastest, three forces each.
pub(super) struct Quarter {
    pub intervals: [usize; 4],
    pub scale: Vec<[f64; 3]>,
    pub nodes: Vec<[f64; 3]>,
}

impl Quarter {
    /// Nodes along each axis.
    pub fn lengths([n1, n2, n3, nq]: [usize; 4]) -> [usize; 4] {
        [n1 + 2, 2 * n2 + 3, n3 + 2, nq + 3]
    }
}

/// The file of these coefficients.
pub(super) fn write(quarter: &Quarter, poisson: f64, [coarse, fine]: [[usize; 2]; 2], solver: &str) -> Vec<u8> {
    let unit = [0, 1, 2].map(|k| quarter.nodes.iter().fold(f64::MIN_POSITIVE, |most, c| most.max(c[k].abs())) / MOST);
    let mut numbers: Vec<u8> = quarter.scale.iter().flatten().flat_map(|s| s.to_le_bytes()).collect();
    numbers.extend(quarter.nodes.iter().flat_map(|c| {
        [0, 1, 2].map(|k| (c[k] / unit[k]).round() as i16).into_iter().flat_map(i16::to_le_bytes).collect::<Vec<_>>()
    }));
    let join = |numbers: &[usize]| numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let head = format!(
        "{TITLE}\npoisson: {poisson}\ncoarse: {}\nfine: {}\nintervals: {}\nunits: {} {} {}\nsolver: {solver}\n",
        join(&coarse),
        join(&fine),
        join(&quarter.intervals),
        unit[0],
        unit[1],
        unit[2],
    );
    let sum = checksum(head.as_bytes(), &numbers);
    [head.into_bytes(), format!("checksum: {sum}\n\n").into_bytes(), numbers].concat()
}

/// Provenance and spline of a file.
pub(super) fn read(bytes: &[u8]) -> Result<(Provenance, Spline), CreepError> {
    let end = bytes.windows(2).position(|pair| pair == b"\n\n").ok_or_else(|| damaged("it has no header"))?;
    let header = core::str::from_utf8(&bytes[..end]).map_err(|_| damaged("its header is no text"))?;
    let numbers = &bytes[end + 2..];
    let mut lines = header.lines();
    if lines.next() != Some(TITLE) {
        return Err(damaged(&format!("it does not begin with \"{TITLE}\"")));
    }
    let entries: Vec<(&str, &str)> = lines.filter_map(|line| line.split_once(": ")).collect();
    let entry = |key: &str| {
        let found = entries.iter().find(|(name, _)| *name == key).map(|(_, value)| *value);
        found.ok_or_else(|| damaged(&format!("its header has no {key}")))
    };
    let provenance = Provenance {
        poisson: parse::<_, 1>(entry("poisson")?)?[0],
        coarse: parse(entry("coarse")?)?,
        fine: parse(entry("fine")?)?,
        solver: entry("solver")?.into(),
        checksum: entry("checksum")?.into(),
        intervals: parse(entry("intervals")?)?,
    };
    let head = header.find("checksum: ").map_or(header, |end| &header[..end]);
    if checksum(head.as_bytes(), numbers) != provenance.checksum {
        return Err(damaged("header and numbers do not fit their check sum"));
    }
    let spline = spline(provenance.intervals, parse(entry("units")?)?, numbers)?;
    Ok((provenance, spline))
}

fn spline(intervals: [usize; 4], unit: [f64; 3], numbers: &[u8]) -> Result<Spline, CreepError> {
    let [l1, l2, l3, lq] = Quarter::lengths(intervals);
    let (scale, nodes) = numbers.split_at_checked(lq * 24).ok_or_else(|| damaged("numbers are missing"))?;
    if nodes.len() != l1 * l2 * l3 * lq * 6 {
        return Err(damaged("its numbers are not as many as its header says"));
    }
    let scale = scale.chunks_exact(24).map(|row| [0, 8, 16].map(|at| f64::from_le_bytes(chunk(row, at)))).collect();
    let stored = |i: usize, j: usize, k: usize, q: usize, force: usize| {
        let at = ((((i * l2 + j) * l3 + k) * lq + q) * 3 + force) * 2;
        f64::from(i16::from_le_bytes(chunk(nodes, at))) * unit[force]
    };
    // One node before u1 = 0 and one before u3 = 0 repeat those behind, with the signs of their mirror images.
    let [m1, m2, m3, mq] = Spline::lengths(intervals);
    let mut all = Vec::with_capacity((mq - 2) * m1 * m2 * m3 * ROW);
    for first in 0..mq - 2 {
        for (i, along) in mirrored(m1) {
            for j in 0..m2 {
                for (k, across) in mirrored(m3) {
                    let j = if across < 0.0 { m2 - 1 - j } else { j };
                    for q in first..first + 3 {
                        all.push((along * stored(i, j, k, q, 0)) as f32);
                        all.extend([1, 2].map(|force| (across * stored(i, j, k, q, force)) as f32));
                        all.push(0.0);
                    }
                }
            }
        }
    }
    Ok(Spline::new(intervals, scale, all))
}

/// Stored place and sign of each node of an axis that begins one step before 0.
fn mirrored(len: usize) -> impl Iterator<Item = (usize, f64)> {
    (0..len).map(|i| if i == 0 { (1, -1.0) } else { (i - 1, 1.0) })
}

fn chunk<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    core::array::from_fn(|i| bytes[at + i])
}

fn parse<T: core::str::FromStr + Copy + Default, const N: usize>(text: &str) -> Result<[T; N], CreepError> {
    let numbers: Vec<T> = text.split(' ').filter_map(|word| word.parse().ok()).collect();
    numbers.try_into().map_err(|_| damaged(&format!("\"{text}\" in its header is not {N} numbers")))
}

/// SHA-256 over all that comes before and behind its own line.
fn checksum(head: &[u8], numbers: &[u8]) -> String {
    hex(&Sha256::new().chain_update(head).chain_update(numbers).finalize())
}

pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

fn damaged(what: &str) -> CreepError {
    CreepError::Table { problem: what.into() }
}
