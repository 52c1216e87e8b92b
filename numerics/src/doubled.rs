//! Arithmetic in doubled precision.
//!
//! A [`Doubled`] is the unevaluated sum of two f64, some 32 digits, by error-free transformations (Dekker 1971;
//! Hida, Li, Bailey, *Algorithms for quad-double precision floating point arithmetic*, 2001). Work on whole vectors is
//! compiled for several kinds of processors, and the one at hand is asked for its fused product once for a vector; the
//! bytes of the results are the same with and without.

use std::fmt;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};
use pulp::{Arch, Simd, WithSimd};

use crate::products::Split;

/// Whether every processor that the program is compiled for has a fused product.
const FUSED: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// hi + lo, |lo| ≤ ½ ulp(hi).
#[derive(Clone, Copy, Default, PartialEq)]
pub struct Doubled {
    hi: f64,
    lo: f64,
}

impl Doubled {
    /// a·b exactly, as long as what is rounded away is not below the numbers there are.
    #[inline]
    pub fn product(a: f64, b: f64) -> Doubled {
        Doubled::product_as::<FUSED>(a, b)
    }

    /// The same; `FUSED`: the processor is known to have a fused product. Where it is not, calling one costs more than
    /// the halves of the digits multiplied one by one.
    #[inline(always)]
    fn product_as<const FUSED: bool>(a: f64, b: f64) -> Doubled {
        if FUSED {
            let hi = a * b;
            return Doubled { hi, lo: a.mul_add(b, -hi) };
        }
        let (hi, lo) = Split::new(a).times(&Split::new(b));
        if lo.is_finite() { Doubled { hi, lo } } else { Doubled::large_product(a, b) }
    }

    /// A product of numbers whose halves overflow. Not inlined, so that no fused product is called for in vain beside it.
    #[cold]
    #[inline(never)]
    fn large_product(a: f64, b: f64) -> Doubled {
        Doubled::product_as::<true>(a, b)
    }

    #[inline(always)]
    fn times<const FUSED: bool>(self, other: Doubled) -> Doubled {
        let product = Doubled::product_as::<FUSED>(self.hi, other.hi);
        Doubled::ordered_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }

    /// The nearest f64.
    #[inline]
    pub fn to_f64(self) -> f64 {
        self.hi
    }

    /// Square root; of a number below zero, zero.
    pub fn sqrt(self) -> Doubled {
        if self.hi <= 0.0 {
            return Doubled::default();
        }
        // One step of Newton's method from the f64 root doubles its digits.
        let root = self.hi.sqrt();
        let rest = self - Doubled::product(root, root);
        Doubled::ordered_sum(root, rest.hi / (2.0 * root))
    }

    /// What rounding to the nearest f64 leaves.
    #[inline]
    pub fn tail(self) -> f64 {
        self.lo
    }

    /// hi + lo of any two numbers.
    #[inline]
    pub fn sum(a: f64, b: f64) -> Doubled {
        let hi = a + b;
        let part = hi - a;
        Doubled { hi, lo: (a - (hi - part)) + (b - part) }
    }

    /// As [`Doubled::sum`], for |a| ≥ |b|.
    #[inline]
    fn ordered_sum(a: f64, b: f64) -> Doubled {
        let hi = a + b;
        Doubled { hi, lo: b - (hi - a) }
    }
}

impl fmt::Debug for Doubled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:e} + {:e}", self.hi, self.lo)
    }
}

impl From<f64> for Doubled {
    #[inline]
    fn from(value: f64) -> Doubled {
        Doubled { hi: value, lo: 0.0 }
    }
}

impl Neg for Doubled {
    type Output = Doubled;

    #[inline]
    fn neg(self) -> Doubled {
        Doubled { hi: -self.hi, lo: -self.lo }
    }
}

impl Add for Doubled {
    type Output = Doubled;

    #[inline]
    fn add(self, other: Doubled) -> Doubled {
        let high = Doubled::sum(self.hi, other.hi);
        let low = Doubled::sum(self.lo, other.lo);
        let sum = Doubled::ordered_sum(high.hi, high.lo + low.hi);
        Doubled::ordered_sum(sum.hi, sum.lo + low.lo)
    }
}

impl Sub for Doubled {
    type Output = Doubled;

    #[inline]
    fn sub(self, other: Doubled) -> Doubled {
        self + -other
    }
}

impl Mul for Doubled {
    type Output = Doubled;

    #[inline]
    fn mul(self, other: Doubled) -> Doubled {
        self.times::<FUSED>(other)
    }
}

impl Div for Doubled {
    type Output = Doubled;

    fn div(self, other: Doubled) -> Doubled {
        let first = self.hi / other.hi;
        let rest = self - other * Doubled::from(first);
        let second = rest.hi / other.hi;
        let rest = rest - other * Doubled::from(second);
        Doubled::ordered_sum(first, second) + Doubled::from(rest.hi / other.hi)
    }
}

macro_rules! assign {
    ($($trait:ident $method:ident $operator:tt),*) => {$(
        impl $trait for Doubled {
            #[inline]
            fn $method(&mut self, other: Doubled) {
                *self = *self $operator other;
            }
        }
    )*};
}

assign!(AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign /);

impl Zero for Doubled {
    #[inline]
    fn zero() -> Doubled {
        Doubled::default()
    }

    #[inline]
    fn is_zero(&self) -> bool {
        self.hi == 0.0
    }
}

impl One for Doubled {
    #[inline]
    fn one() -> Doubled {
        Doubled::from(1.0)
    }
}

/// Work on vectors.
trait Work {
    type Output;

    /// `FUSED`: the processor has a fused product.
    fn run<const FUSED: bool>(self) -> Self::Output;
}

/// [`Work`] as compiled for the processor at hand.
struct Compiled<W>(W);

impl<W: Work> WithSimd for Compiled<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> W::Output {
        if S::IS_SCALAR { self.0.run::<FUSED>() } else { self.0.run::<true>() }
    }
}

fn run<W: Work>(work: W) -> W::Output {
    Arch::new().dispatch(Compiled(work))
}

/// high + low += matrix · x, the rounding errors of every product and sum carried along in `low` (Ogita, Rump, Oishi
/// 2005), column by column as the matrix is stored.
pub fn add_response(high: &mut [f64], low: &mut [f64], matrix: &[f64], x: &[f64]) {
    struct Response<'a> {
        high: &'a mut [f64],
        low: &'a mut [f64],
        matrix: &'a [f64],
        x: &'a [f64],
    }
    impl Work for Response<'_> {
        type Output = ();

        #[inline(always)]
        fn run<const FUSED: bool>(self) {
            let Response { high, low, matrix, x } = self;
            let columns = matrix.chunks_exact(high.len().max(1)).zip(x).filter(|(_, x)| **x != 0.0);
            for (column, x) in columns {
                for ((high, low), entry) in high.iter_mut().zip(low.iter_mut()).zip(column) {
                    let Doubled { hi: product, lo: product_error } = Doubled::product_as::<FUSED>(*entry, *x);
                    let next = *high + product;
                    let back = next - *high;
                    *low += (*high - (next - back)) + (product - back) + product_error;
                    *high = next;
                }
            }
        }
    }
    run(Response { high, low, matrix, x });
}

/// Σ a_i b_i.
pub fn dot(a: &[Doubled], b: &[Doubled]) -> Doubled {
    struct Dot<'a>(&'a [Doubled], &'a [Doubled]);
    impl Work for Dot<'_> {
        type Output = Doubled;

        #[inline(always)]
        fn run<const FUSED: bool>(self) -> Doubled {
            std::iter::zip(self.0, self.1).fold(Doubled::zero(), |sum, (a, b)| sum + a.times::<FUSED>(*b))
        }
    }
    run(Dot(a, b))
}

/// target += factor · x.
pub fn add_multiple(target: &mut [Doubled], factor: Doubled, x: &[Doubled]) {
    struct Multiple<'a>(&'a mut [Doubled], Doubled, &'a [Doubled]);
    impl Work for Multiple<'_> {
        type Output = ();

        #[inline(always)]
        fn run<const FUSED: bool>(self) {
            let Multiple(target, factor, x) = self;
            for (target, x) in std::iter::zip(target, x) {
                *target += factor.times::<FUSED>(*x);
            }
        }
    }
    run(Multiple(target, factor, x));
}

/// A x; of the symmetric A the lower triangle by columns: where each starts among the entries (and the end), the row and
/// the value of each entry.
pub fn symmetric_times(column_start: &[u32], rows: &[u32], values: &[Doubled], x: &[Doubled]) -> Vec<Doubled> {
    struct Times<'a> {
        column_start: &'a [u32],
        rows: &'a [u32],
        values: &'a [Doubled],
        x: &'a [Doubled],
    }
    impl Work for Times<'_> {
        type Output = Vec<Doubled>;

        #[inline(always)]
        fn run<const FUSED: bool>(self) -> Vec<Doubled> {
            let Times { column_start, rows, values, x } = self;
            let mut y = vec![Doubled::zero(); x.len()];
            for (column, range) in column_start.windows(2).enumerate() {
                let range = range[0] as usize..range[1] as usize;
                let (own, mut sum) = (x[column], Doubled::zero());
                for (&row, value) in std::iter::zip(&rows[range.clone()], &values[range]) {
                    let row = row as usize;
                    sum += value.times::<FUSED>(x[row]);
                    if row != column {
                        y[row] += value.times::<FUSED>(own);
                    }
                }
                y[column] += sum;
            }
            y
        }
    }
    run(Times { column_start, rows, values, x })
}
