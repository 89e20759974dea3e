//! How patches are drawn.

use crate::num::I16F16;

/// How patches are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Style {
    /// Lambert shading with exact normals, two-sided.
    #[default]
    Shaded,
    /// Lambert shading with a Blinn–Phong highlight.
    Glossy(Gloss),
    /// The same level, 255, everywhere.
    Flat,
    /// A level by depth: near what is nearest in the scene, far what is farthest, linear in between.
    DepthCued {
        /// The level of the nearest depth.
        near: u8,
        /// The level of the farthest depth.
        far: u8,
    },
    /// Iso-parametric curves.
    Wire(Lines),
    /// The edges of the control nets.
    Net {
        /// Whether what lies behind a patch is left out.
        hidden: bool,
    },
    /// Normals as short lines from the points of a coarse lattice, towards the viewer.
    Normals {
        /// Where normals stand: at the crossings of this many intervals in each direction.
        lines: Lines,
        /// Their length in pixels.
        length: u8,
    },
}

/// Which faces of patches are drawn.
///
/// The outward normal is S_r × S_s (S_u × S_v for triangles), unless the scene's table of patches says that it points
/// inwards.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cull {
    /// Both: patches are two-sided.
    #[default]
    None,
    /// The outer one. Pieces of patches that face away from the viewer everywhere are left out, nothing that faces the
    /// viewer is; what is drawn next to a silhouette is lit by its outward normal, so the light does not jump there.
    Back,
}

/// How patches are filled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Fill {
    /// Exact points, close enough together to leave no pixel centre out: the reference quality.
    #[default]
    Exact,
    /// Facets between the exact points of a coarse grid: the fast path. Needs
    /// [`Scene::with_topology`](super::Scene::with_topology).
    ///
    /// Segments are counted per edge class, the classes k, k + 64, k + 128, … together: scenes with more than 64 classes
    /// may get more segments than they need.
    Grid {
        /// How far the surface may be from its facets on the screen, in pixels; positive.
        tolerance: I16F16,
    },
}

#[cfg(feature = "defmt")]
impl defmt::Format for Fill {
    fn format(&self, f: defmt::Formatter<'_>) {
        match self {
            Self::Exact => defmt::write!(f, "Exact"),
            Self::Grid { tolerance } => {
                let bits = tolerance.to_bits();
                defmt::write!(f, "Grid {{ tolerance: {}/2^16 }}", bits);
            }
        }
    }
}

/// A highlight: specular·max(0, N·H)^exponent is added to the level, with H halfway between light and viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Gloss {
    specular: u8,
    exponent: u8,
}

impl Gloss {
    /// A highlight of at most `specular` levels; a larger `exponent` makes it smaller. Exponents above 32 are taken
    /// as 32: there the level is still within 2 of exact arithmetic.
    ///
    /// ```
    /// use embedded_surfaces::render::{Gloss, Style};
    /// let porcelain = Style::Glossy(Gloss::new(90, 24));
    /// # let _ = porcelain;
    /// ```
    #[must_use]
    pub const fn new(specular: u8, exponent: u8) -> Self {
        Self { specular, exponent: if exponent > 32 { 32 } else { exponent } }
    }

    /// The most levels that it adds.
    #[must_use]
    pub const fn specular(self) -> u8 {
        self.specular
    }

    /// The exponent, at most 32.
    #[must_use]
    pub const fn exponent(self) -> u8 {
        self.exponent
    }
}

/// Which iso-parametric curves are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Lines {
    /// Intervals between curves in each direction; 1 draws the boundary alone, 0 counts as 1.
    pub intervals: u8,
    /// Whether what lies behind a patch is left out. Lines get [`Lines::BIAS`] pixels of lead over surfaces.
    pub hidden: bool,
}

impl Lines {
    /// How much farther than a surface, in pixels, a line may lie and still be seen: lines on a surface that is seen
    /// at a slant would break up otherwise.
    pub const BIAS: u32 = 3;

    /// The boundary curves alone, seen through.
    pub const BOUNDARY: Self = Self { intervals: 1, hidden: false };

    /// Curves at k/`intervals`, seen through.
    #[must_use]
    pub const fn every(intervals: u8) -> Self {
        Self { intervals, hidden: false }
    }

    /// The same curves with hidden lines removed.
    #[must_use]
    pub const fn without_hidden(self) -> Self {
        Self { hidden: true, ..self }
    }

    pub(super) fn count(self) -> u32 {
        u32::from(self.intervals.max(1))
    }
}

impl Style {
    /// Whether a style draws lines, and whether patches hide them.
    pub(super) const fn lines(self) -> Option<bool> {
        match self {
            Self::Wire(Lines { hidden, .. })
            | Self::Net { hidden }
            | Self::Normals { lines: Lines { hidden, .. }, .. } => Some(hidden),
            _ => None,
        }
    }

    /// How far a style draws beyond the patch, in pixels.
    pub(super) const fn reach(self) -> u8 {
        if let Self::Normals { length, .. } = self { length } else { 0 }
    }

    /// Whether levels need normals.
    pub(super) const fn needs_normals(self) -> bool {
        matches!(self, Self::Shaded | Self::Glossy(_))
    }
}
