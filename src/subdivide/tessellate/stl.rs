//! STL files: triangles without an index.

use super::normal;
use crate::geometry::Point3;
use crate::num::{Coord, Decimal, binary32};
use core::fmt::Write;

/// Writes a binary STL file; returns the number of triangles.
///
/// `write` takes the bytes in order, up to 84 at a time: of a file, a serial line, a flash page. A coordinate becomes
/// the nearest binary32, ties to even, and a facet normal is a unit vector: built from integers, with no
/// floating-point type. The triangles are walked twice, because their number comes first in the file. A triangle without
/// area has the normal (0, 0, 0).
///
/// ```
/// use embedded_surfaces::geometry::Point3;
/// use embedded_surfaces::subdivide::write_stl;
/// let triangle = [Point3::from_ints(0, 0, 0), Point3::from_ints(9, 0, 0), Point3::from_ints(0, 9, 0)];
/// let mut file = Vec::new();
/// let count = write_stl([triangle].into_iter(), |bytes| {
///     file.extend_from_slice(bytes);
///     Ok::<(), std::io::Error>(())
/// })?;
/// assert_eq!((count, file.len()), (1, 84 + 50));
/// assert_eq!(file[84..96], [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3f]); // the normal (0, 0, 1)
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// The first error of `write`.
pub fn write_stl<E>(
    triangles: impl Iterator<Item = [Point3; 3]> + Clone,
    mut write: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<u32, E> {
    let count = triangles.clone().fold(0_u32, |count, _| count.saturating_add(1));
    let mut header = [b' '; 84];
    for (to, from) in header.iter_mut().zip(b"embedded-surfaces") {
        *to = *from;
    }
    fill(&mut header, 80, &[count]);
    write(&header)?;
    for triangle in triangles.take(count as usize) {
        let mut record = [0; 50];
        let normal = normal::of_triangle(triangle).unwrap_or([0; 3]);
        fill(&mut record, 0, &normal.map(|c| binary32(c, normal::UNIT)));
        for (k, corner) in triangle.into_iter().enumerate() {
            fill(&mut record, 12 + 12 * k, &corner.to_array().map(|c| binary32(c.bits(), 16)));
        }
        write(&record)?;
    }
    Ok(count)
}

/// Writes words into a record, little-endian.
fn fill(record: &mut [u8], at: usize, words: &[u32]) {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes());
    for (to, from) in record.iter_mut().skip(at).zip(bytes) {
        *to = from;
    }
}

/// Writes a text STL file: coordinates are exact decimals, normals are rounded to 2^-16.
///
/// ```
/// use embedded_surfaces::geometry::Point3;
/// use embedded_surfaces::subdivide::write_stl_text;
/// let triangle = [Point3::from_ints(0, 0, 0), Point3::from_ints(9, 0, 0), Point3::from_bits(0, 9 << 15, 0)];
/// let mut file = String::new();
/// write_stl_text("sail", [triangle].into_iter(), &mut file)?;
/// assert!(file.starts_with("solid sail\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"));
/// assert!(file.ends_with("vertex 0 4.5 0\nendloop\nendfacet\nendsolid sail\n"));
/// # Ok::<(), core::fmt::Error>(())
/// ```
///
/// # Errors
/// The first error of `out`.
pub fn write_stl_text(
    name: &str,
    triangles: impl Iterator<Item = [Point3; 3]>,
    out: &mut impl Write,
) -> core::fmt::Result {
    writeln!(out, "solid {name}")?;
    for triangle in triangles {
        let [x, y, z] = normal::rounded(normal::of_triangle(triangle).unwrap_or([0; 3])).to_array();
        writeln!(out, "facet normal {} {} {}", Decimal(x.bits()), Decimal(y.bits()), Decimal(z.bits()))?;
        writeln!(out, "outer loop")?;
        for corner in triangle {
            let [x, y, z] = corner.to_array().map(|c| Decimal(c.bits()));
            writeln!(out, "vertex {x} {y} {z}")?;
        }
        writeln!(out, "endloop\nendfacet")?;
    }
    writeln!(out, "endsolid {name}")
}
