//! A block-diagonal matrix over scattered states, with a decay rate for the states of no block: the approximate Jacobian
//! of linearly implicit steps. Nothing is allocated after it is made.

/// A = square blocks on their own states, -decay on the diagonal of the others.
///
/// ```
/// use klingel_engine::integrate::Blocks;
/// let mut a = Blocks::new(vec![vec![0, 2]], &[0.0, 5.0, 0.0]);
/// a.block_mut(0).1.copy_from_slice(&[-1.0, 2.0, 0.0, -3.0]); // by rows
/// let mut y = [0.0; 3];
/// a.multiply(&[1.0, 1.0, 1.0], &mut y);
/// assert_eq!(y, [1.0, -5.0, -3.0]);
/// a.factor(0.1); // of 1 - 0.1 A
/// a.solve(&mut y); // (1 - 0.1 A)^-1 A x
/// assert!((y[1] + 5.0 / 1.5).abs() < 1e-15 && (y[2] + 3.0 / 1.3).abs() < 1e-15);
/// ```
#[derive(Clone, Debug)]
pub struct Blocks {
    blocks: Vec<Block>,
    /// Of the states of no block: place and decay rate \[1/s\].
    decays: Vec<(usize, f64)>,
    shift: f64,
}

#[derive(Clone, Debug)]
struct Block {
    states: Vec<usize>,
    matrix: Vec<f64>,
    /// L and U of 1 - shift A, rows exchanged as `pivots` tell.
    lu: Vec<f64>,
    pivots: Vec<usize>,
    /// Right-hand side and solution.
    part: Vec<f64>,
}

impl Blocks {
    /// Nil blocks over these states; `decay` is one rate a state \[1/s\], used where no block is.
    pub fn new(blocks: Vec<Vec<usize>>, decay: &[f64]) -> Self {
        let inside = |i: &usize| blocks.iter().any(|b| b.contains(i));
        let decays = (0..decay.len()).filter(|i| !inside(i)).map(|i| (i, decay[i])).collect();
        let block = |states: Vec<usize>| {
            let n = states.len();
            let (matrix, lu) = (vec![0.0; n * n], vec![0.0; n * n]);
            Block { states, matrix, lu, pivots: vec![0; n], part: vec![0.0; n] }
        };
        Self { blocks: blocks.into_iter().map(block).collect(), decays, shift: 0.0 }
    }

    /// How many blocks there are.
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// The states of block `b`.
    pub fn states(&self, b: usize) -> &[usize] {
        &self.blocks[b].states
    }

    /// Block `b`: its states, and its matrix by rows.
    pub fn block_mut(&mut self, b: usize) -> (&[usize], &mut [f64]) {
        let Block { states, matrix, .. } = &mut self.blocks[b];
        (states, matrix)
    }

    /// y = A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        for &(i, decay) in &self.decays {
            y[i] = -decay * x[i];
        }
        for Block { states, matrix, .. } in &self.blocks {
            for (row, &i) in matrix.chunks_exact(states.len()).zip(states) {
                y[i] = row.iter().zip(states).map(|(a, &j)| a * x[j]).sum();
            }
        }
    }

    /// Makes ready to solve with 1 - shift A \[shift in s\].
    pub fn factor(&mut self, shift: f64) {
        self.shift = shift;
        self.blocks.iter_mut().for_each(|b| b.factor(shift));
    }

    /// y <- (1 - shift A)^-1 y, with the shift and the matrix of the last `factor`.
    pub fn solve(&mut self, y: &mut [f64]) {
        for &(i, decay) in &self.decays {
            y[i] /= 1.0 + self.shift * decay;
        }
        self.blocks.iter_mut().for_each(|b| b.solve(y));
    }
}

impl Block {
    /// Gauss with row pivots; a singular matrix leaves infinities, which the caller meets as a state that is not finite.
    fn factor(&mut self, shift: f64) {
        let n = self.states.len();
        for (to, a) in self.lu.iter_mut().zip(&self.matrix) {
            *to = -shift * a;
        }
        (0..n).for_each(|i| self.lu[i * n + i] += 1.0);
        for k in 0..n {
            let size = |i: usize| self.lu[i * n + k].abs();
            let pivot = (k + 1..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
            self.pivots[k] = pivot;
            if pivot != k {
                (0..n).for_each(|j| self.lu.swap(k * n + j, pivot * n + j));
            }
            let (upper, lower) = self.lu.split_at_mut((k + 1) * n);
            let top = &upper[k * n..];
            for row in lower.chunks_exact_mut(n) {
                row[k] /= top[k];
                let factor = row[k];
                row[k + 1..].iter_mut().zip(&top[k + 1..]).for_each(|(a, t)| *a -= factor * t);
            }
        }
    }

    fn solve(&mut self, y: &mut [f64]) {
        let Self { states, lu, pivots, part, .. } = self;
        let n = states.len();
        part.iter_mut().zip(states.iter()).for_each(|(p, &i)| *p = y[i]);
        (0..n).for_each(|k| part.swap(k, pivots[k]));
        let dot = |row: &[f64], x: &[f64]| -> f64 { row.iter().zip(x).map(|(a, x)| a * x).sum() };
        for i in 0..n {
            part[i] -= dot(&lu[i * n..i * n + i], part);
        }
        for i in (0..n).rev() {
            let row = &lu[i * n..(i + 1) * n];
            part[i] = (part[i] - dot(&row[i + 1..], &part[i + 1..])) / row[i];
        }
        states.iter().zip(part.iter()).for_each(|(&i, p)| y[i] = *p);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_solved_is_the_shifted_matrix() {
        // the first pivot of the block is nil, so rows must change places
        let mut a = Blocks::new(vec![vec![3, 0, 1]], &[7.0, 7.0, 4.0, 7.0]);
        a.block_mut(0).1.copy_from_slice(&[2.0, 3.0, -1.0, 4.0, 0.0, 2.0, -6.0, 1.0, 9.0]);
        a.factor(0.5);
        let y = [0.3, -1.2, 2.0, 0.7];
        let (mut x, mut ax) = (y, [0.0; 4]);
        a.solve(&mut x);
        a.multiply(&x, &mut ax);
        for i in 0..4 {
            assert!((x[i] - 0.5 * ax[i] - y[i]).abs() < 1e-14, "{i}");
        }
        assert_eq!(x[2], 2.0 / 3.0);
    }
}
