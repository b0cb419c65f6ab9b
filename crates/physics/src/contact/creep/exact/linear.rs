//! Linear algebra of the exact solver: dense LU and GMRES (Saad & Schultz 1986) with a preconditioner on the right.
//! Written out here because the matrices are many, small and only known through their products.

/// Factors of a square matrix with row exchanges.
pub(super) struct Lu {
    n: usize,
    factors: Vec<f64>,
    exchanges: Vec<usize>,
}

impl Lu {
    /// `matrix` row by row.
    pub fn new(n: usize, mut matrix: Vec<f64>) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            /// The same operations for wider registers; without fused operations the result is the same bitwise.
            #[target_feature(enable = "avx2")]
            fn wide(n: usize, matrix: &mut [f64]) -> Vec<usize> {
                factorise(n, matrix)
            }
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the feature was just found.
                let exchanges = unsafe { wide(n, &mut matrix) };
                return Self { n, factors: matrix, exchanges };
            }
        }
        let exchanges = factorise(n, &mut matrix);
        Self { n, factors: matrix, exchanges }
    }

    /// Turns the right-hand side into the solution.
    pub fn solve(&self, x: &mut [f64]) {
        let n = self.n;
        for (k, &pivot) in self.exchanges.iter().enumerate() {
            x.swap(k, pivot);
        }
        for i in 0..n {
            x[i] -= dot(&self.factors[i * n..][..i], &x[..i]);
        }
        for i in (0..n).rev() {
            let row = &self.factors[i * n..][..n];
            x[i] = (x[i] - dot(&row[i + 1..], &x[i + 1..])) / row[i];
        }
    }
}

/// Leaves the factors in the matrix's place.
#[inline(always)]
fn factorise(n: usize, matrix: &mut [f64]) -> Vec<usize> {
    let mut exchanges = Vec::with_capacity(n);
    for k in 0..n {
        let size = |i: usize| matrix[i * n + k].abs();
        let pivot = (k..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
        exchanges.push(pivot);
        if pivot != k {
            let (upper, lower) = matrix.split_at_mut(pivot * n);
            upper[k * n..][..n].swap_with_slice(&mut lower[..n]);
        }
        let (upper, lower) = matrix.split_at_mut((k + 1) * n);
        let row = &upper[k * n + k..][..n - k];
        for other in lower.chunks_exact_mut(n) {
            let factor = other[k] / row[0];
            other[k] = factor;
            if factor != 0.0 {
                axpy(&mut other[k + 1..], -factor, &row[1..]);
            }
        }
    }
    exchanges
}

#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = [0.0; 4];
    let ((a4, a1), (b4, b1)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    for (a, b) in a4.iter().zip(b4) {
        for l in 0..4 {
            sum[l] += a[l] * b[l];
        }
    }
    (sum[0] + sum[1]) + (sum[2] + sum[3]) + a1.iter().zip(b1).map(|(a, b)| a * b).sum::<f64>()
}

/// y += factor x
#[inline(always)]
pub(super) fn axpy(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

pub(super) fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

/// x with |b - A x| <= tolerance |b|, or the best of `most` products A v; `precondition` is nearly the inverse of A.
pub(super) fn gmres(
    b: &[f64],
    mut product: impl FnMut(&[f64]) -> Vec<f64>,
    mut precondition: impl FnMut(&[f64]) -> Vec<f64>,
    tolerance: f64,
    most: usize,
) -> Vec<f64> {
    let scaled = |v: &[f64], factor: f64| v.iter().map(|x| factor * x).collect::<Vec<f64>>();
    let size = norm(b);
    let mut x = vec![0.0; b.len()];
    if size == 0.0 {
        return x;
    }
    let (mut basis, mut images) = (vec![scaled(b, 1.0 / size)], Vec::<Vec<f64>>::new());
    // Columns of the upper triangle, rotations that made it, and the right-hand side that they turned.
    let (mut columns, mut rotations, mut right) = (Vec::<Vec<f64>>::new(), Vec::<[f64; 2]>::new(), vec![size]);
    for j in 0..most {
        let z = precondition(&basis[j]);
        let mut v = product(&z);
        images.push(z);
        let mut column: Vec<f64> = Vec::with_capacity(j + 1);
        for q in &basis {
            let h = dot(&v, q);
            axpy(&mut v, -h, q);
            column.push(h);
        }
        for (i, [c, s]) in rotations.iter().enumerate() {
            (column[i], column[i + 1]) = (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
        }
        let rest = norm(&v);
        let pivot = column[j].hypot(rest);
        let [c, s] = [column[j] / pivot, rest / pivot];
        column[j] = pivot;
        columns.push(column);
        rotations.push([c, s]);
        let turned = right[j];
        right[j] = c * turned;
        right.push(-s * turned);
        if right[j + 1].abs() <= tolerance * size {
            break;
        }
        basis.push(scaled(&v, 1.0 / rest));
    }
    let m = columns.len();
    let mut y = vec![0.0; m];
    for i in (0..m).rev() {
        let known: f64 = (i + 1..m).map(|j| columns[j][i] * y[j]).sum();
        y[i] = (right[i] - known) / columns[i][i];
        axpy(&mut x, y[i], &images[i]);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix that needs row exchanges, and its product.
    fn example(n: usize) -> (Vec<f64>, impl Fn(&[f64]) -> Vec<f64>) {
        let at =
            move |i: usize, j: usize| ((i * 7 + j * j * 3 + 1) as f64).sin() + if (i + 2) % n == j { 9.0 } else { 0.0 };
        let matrix = (0..n * n).map(|k| at(k / n, k % n)).collect();
        (matrix, move |x: &[f64]| (0..n).map(|i| (0..n).map(|j| at(i, j) * x[j]).sum()).collect())
    }

    #[test]
    fn both_solve_what_the_matrix_made() {
        let n = 23;
        let (matrix, product) = example(n);
        let exact: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
        let b = product(&exact);
        let lu = Lu::new(n, matrix);
        let mut direct = b.clone();
        lu.solve(&mut direct);
        let iterated = gmres(&b, &product, |v| v.to_vec(), 1e-12, n);
        for ((d, i), e) in direct.iter().zip(&iterated).zip(&exact) {
            assert!((d - e).abs() < 1e-11 && (i - e).abs() < 1e-9, "{d} {i} {e}");
        }
        // With the inverse as its preconditioner it is done at once.
        let mut products = 0;
        let counted = |v: &[f64]| {
            products += 1;
            product(v)
        };
        let inverse = |v: &[f64]| {
            let mut x = v.to_vec();
            lu.solve(&mut x);
            x
        };
        gmres(&b, counted, inverse, 1e-10, n);
        assert_eq!(products, 1);
        assert_eq!(gmres(&[0.0; 3], |v| v.to_vec(), |v| v.to_vec(), 1e-3, 9), [0.0; 3]);
    }
}
