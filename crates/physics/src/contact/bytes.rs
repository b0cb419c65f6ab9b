//! A contact table as bytes and back, bitwise: for a cache on disk, which checks that they are whole.
//! Little-endian: format, axes, then each array with its length before it.

use super::ContactTable;
use super::spline::Axis;

/// Changes whenever the layout does.
const FORMAT: u64 = 2;

impl ContactTable {
    /// The whole table as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = FORMAT.to_le_bytes().to_vec();
        let mut number = |x: u64| bytes.extend_from_slice(&x.to_le_bytes());
        for axis in &self.space {
            [axis.least.to_bits(), axis.step.to_bits(), axis.len as u64].into_iter().for_each(&mut number);
        }
        [self.radius, self.borders[0], self.borders[1], self.rail_top].iter().for_each(|x| number(x.to_bits()));
        for array in self.arrays() {
            number(array.len() as u64);
            array.iter().for_each(|x| number(x.to_bits()));
        }
        bytes
    }

    /// The table that [`Self::to_bytes`] wrote; none if the bytes are of another format or not whole.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut words = Words(bytes);
        if words.number()? != FORMAT {
            return None;
        }
        let mut axis = || {
            let (least, step) = (words.float()?, words.float()?);
            Some(Axis { least, step, len: usize::try_from(words.number()?).ok()? })
        };
        let space = [axis()?, axis()?, axis()?];
        let (radius, borders, rail_top) = (words.float()?, [words.float()?, words.float()?], words.float()?);
        let touch = words.array()?;
        let load = [words.array()?, words.array()?, words.array()?];
        let detail = [words.array()?, words.array()?, words.array()?];
        let table = Self { plane: [space[0], space[1]], touch, radius, space, load, detail, borders, rail_top };
        // Reading a table relies on these lengths.
        let plane = space[0].len.checked_mul(space[1].len)?;
        let nodes = plane.checked_mul(space[2].len)?;
        let whole = words.0.is_empty()
            && table.touch.len() == plane.checked_mul(6)?
            && table.load.iter().all(|l| nodes.checked_mul(6) == Some(l.len()))
            && table.detail.iter().all(|d| nodes.checked_mul(2) == Some(d.len()));
        whole.then_some(table)
    }

    fn arrays(&self) -> impl Iterator<Item = &Vec<f64>> {
        core::iter::once(&self.touch).chain(&self.load).chain(&self.detail)
    }
}

/// Words of eight bytes, taken one after the other.
struct Words<'a>(&'a [u8]);

impl Words<'_> {
    fn number(&mut self) -> Option<u64> {
        let (word, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u64::from_le_bytes(*word))
    }
    fn float(&mut self) -> Option<f64> {
        self.number().map(f64::from_bits)
    }
    fn array(&mut self) -> Option<Vec<f64>> {
        let len = usize::try_from(self.number()?).ok()?.checked_mul(8)?;
        let (array, rest) = self.0.split_at_checked(len)?;
        self.0 = rest;
        let word = |w: &[u8]| f64::from_le_bytes(core::array::from_fn(|i| w[i]));
        Some(array.chunks_exact(8).map(word).collect())
    }
}
