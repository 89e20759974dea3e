//! Subdivision as a verb of the nets that own their points.

use super::exact::{Direction, Half, Quarter};
use super::rounded::{Cut, Source};
use crate::patch::{Curve, RationalCurve, RationalTensor, RationalTriangle, Tensor, Triangle};

impl<const K: usize> Curve<K> {
    /// The halves 0 ..= 1/2 and 1/2 ..= 1, each coordinate within 2^-17.
    ///
    /// ```
    /// use embedded_surfaces::patch::CubicCurve;
    /// let arch = CubicCurve::from_ints([[0, 0, 0], [0, 80, 0], [80, 80, 0], [80, 0, 0]])?;
    /// let [first, second] = arch.subdivide();
    /// assert_eq!(first, CubicCurve::from_ints([[0, 0, 0], [0, 40, 0], [20, 60, 0], [40, 60, 0]])?);
    /// assert_eq!(first.points()[3], second.points()[0]);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn subdivide(&self) -> [Self; 2] {
        let source = Source::new((K - 1, 0), &self.points, None);
        Half::ALL.map(|half| {
            let mut out = *self;
            source.cut(Cut::Half(Direction::R, half), &mut out.points, &mut []);
            out
        })
    }
}

impl<const N: usize, const LEN: usize> Triangle<N, LEN> {
    /// The four children at T1, T2, T3 and in the middle ([`Quarter::ALL`]), each coordinate within 2^-17 (Tian Jie,
    /// Algorithm 1). All have the parent's orientation.
    ///
    /// ```
    /// use embedded_surfaces::patch::FlatTriangle;
    /// let [_, _, _, middle] = FlatTriangle::from_ints([[0, 0, 0], [80, 0, 0], [0, 80, 0]])?.subdivide();
    /// assert_eq!(middle, FlatTriangle::from_ints([[40, 40, 0], [0, 40, 0], [40, 0, 0]])?);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn subdivide(&self) -> [Self; 4] {
        let source = Source::new((N, N), &self.points, None);
        Quarter::ALL.map(|quarter| {
            let mut out = *self;
            source.cut(Cut::Triangle(quarter), &mut out.points, &mut []);
            out
        })
    }
}

/// The quarters of a square, the second parameter running faster.
const SQUARES: [(Half, Half); 4] = [
    (Half::First, Half::First),
    (Half::First, Half::Second),
    (Half::Second, Half::First),
    (Half::Second, Half::Second),
];

impl<const M: usize, const H: usize> Tensor<M, H> {
    /// The four quarters, (first, first), (first, second), (second, first), (second, second) halves in (r, s), each
    /// coordinate within 2^-17.
    ///
    /// ```
    /// use embedded_surfaces::patch::BilinearPatch;
    /// let square = BilinearPatch::from_ints([[[0, 0, 0], [0, 8, 0]], [[8, 0, 0], [8, 8, 8]]])?;
    /// let quarters = square.subdivide();
    /// assert_eq!(quarters[3], BilinearPatch::from_ints([[[4, 4, 2], [4, 8, 4]], [[8, 4, 4], [8, 8, 8]]])?);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn subdivide(&self) -> [Self; 4] {
        SQUARES.map(|(r, s)| self.cut(Cut::Tensor(r, s)))
    }

    /// The two halves in one direction, each coordinate within 2^-17.
    #[must_use]
    pub fn bisect(&self, direction: Direction) -> [Self; 2] {
        Half::ALL.map(|half| self.cut(Cut::Half(direction, half)))
    }

    fn cut(&self, part: Cut) -> Self {
        let mut out = *self;
        let source = Source::new((M - 1, H - 1), self.points.as_flattened(), None);
        source.cut(part, out.points.as_flattened_mut(), &mut []);
        out
    }
}

impl<const K: usize> RationalCurve<K> {
    /// The halves 0 ..= 1/2 and 1/2 ..= 1: points and weights of the exact halves, each rounded once to 2^-16.
    #[must_use]
    pub fn subdivide(&self) -> [Self; 2] {
        let source = Source::new((K - 1, 0), &self.net.points, Some(&self.weights));
        Half::ALL.map(|half| {
            let mut out = *self;
            source.cut(Cut::Half(Direction::R, half), &mut out.net.points, &mut out.weights);
            out
        })
    }
}

impl<const N: usize, const LEN: usize> RationalTriangle<N, LEN> {
    /// The four children at T1, T2, T3 and in the middle: points and weights of the exact ones, each rounded once to
    /// 2^-16.
    #[must_use]
    pub fn subdivide(&self) -> [Self; 4] {
        let source = Source::new((N, N), &self.net.points, Some(&self.weights));
        Quarter::ALL.map(|quarter| {
            let mut out = *self;
            source.cut(Cut::Triangle(quarter), &mut out.net.points, &mut out.weights);
            out
        })
    }
}

impl<const M: usize, const H: usize> RationalTensor<M, H> {
    /// The four quarters, in the order of [`Tensor::subdivide`]: points and weights of the exact ones, each rounded
    /// once to 2^-16.
    #[must_use]
    pub fn subdivide(&self) -> [Self; 4] {
        SQUARES.map(|(r, s)| self.cut(Cut::Tensor(r, s)))
    }

    /// The two halves in one direction, rounded likewise.
    #[must_use]
    pub fn bisect(&self, direction: Direction) -> [Self; 2] {
        Half::ALL.map(|half| self.cut(Cut::Half(direction, half)))
    }

    fn cut(&self, part: Cut) -> Self {
        let (mut out, weights) = (*self, self.weights.as_flattened());
        let source = Source::new((M - 1, H - 1), self.net.points.as_flattened(), Some(weights));
        source.cut(part, out.net.points.as_flattened_mut(), out.weights.as_flattened_mut());
        out
    }
}
