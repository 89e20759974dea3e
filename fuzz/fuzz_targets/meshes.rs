//! Patches that share points, edges and corners in every way, legal shapes or not: topology and tessellation do not
//! panic, no triangle has two equal corners, and the mesh is what was counted.
#![no_main]

use arbitrary::{Result, Unstructured};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{RationalTensorNet, RationalTriangleNet, SurfaceNet, TensorNet, TriangleNet};
use embedded_surfaces::subdivide::{
    Buffer, MeshBuffers, MeshVertex, PatchTopology, SubdivideError, Tessellation, Tolerance, tessellate, topology,
};

/// Larger meshes are begun only.
const MOST: usize = 2000;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    // Short input is an `Err` of `arbitrary`, which is fine.
    let _ = run(&mut Unstructured::new(bytes));
});

struct Patch {
    triangle: bool,
    degrees: (usize, usize),
    points: Vec<Point3>,
    weights: Option<Vec<I16F16>>,
}

/// A patch over few different points, so that edges meet, collapse and run there and back.
fn patch(u: &mut Unstructured<'_>, alphabet: &[Point3]) -> Result<Patch> {
    let triangle = u.arbitrary()?;
    let m = u.int_in_range(1..=4)?;
    let degrees = if triangle { (m, m) } else { (m, u.int_in_range(1..=4)?) };
    let count = if triangle { (m + 1) * (m + 2) / 2 } else { (m + 1) * (degrees.1 + 1) };
    let points = (0..count).map(|_| u.choose(alphabet).copied()).collect::<Result<_>>()?;
    let mut weight = || Ok(I16F16::from_bits(1 << u.int_in_range(0..=30)?));
    let weights = (0..count).map(|_| weight()).collect::<Result<Vec<_>>>()?;
    let weights = u.ratio(1, 3)?.then_some(weights);
    Ok(Patch { triangle, degrees, points, weights })
}

impl Patch {
    fn net(&self) -> Option<SurfaceNet<'_>> {
        let (m, weights) = (self.degrees.0, self.weights.as_deref());
        Some(if self.triangle {
            let net = TriangleNet::new(m, &self.points).ok()?;
            match weights {
                None => SurfaceNet::Triangle(net),
                Some(weights) => SurfaceNet::RationalTriangle(RationalTriangleNet::new(net, weights).ok()?),
            }
        } else {
            let net = TensorNet::new(self.degrees, &self.points).ok()?;
            match weights {
                None => SurfaceNet::Tensor(net),
                Some(weights) => SurfaceNet::RationalTensor(RationalTensorNet::new(net, weights).ok()?),
            }
        })
    }
}

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let zeros = u.int_in_range(0..=16)?;
    let mut coordinate = || Ok(u.arbitrary::<i32>()? >> zeros / 2 << zeros);
    let mut point = || Ok(Point3::from_bits(coordinate()?, coordinate()?, coordinate()?));
    let alphabet = (0..7).map(|_| point()).collect::<Result<Vec<_>>>()?;
    let count = u.int_in_range(1..=4)?;
    let patches = (0..count).map(|_| patch(u, &alphabet)).collect::<Result<Vec<_>>>()?;
    let nets: Vec<_> = patches.iter().filter_map(Patch::net).collect();
    let mut table = vec![PatchTopology::default(); nets.len()];
    if topology(&nets, &mut table).is_err() {
        return Ok(());
    }
    // A fraction of the size, so that there are some triangles and not millions.
    let extent = alphabet.iter().flat_map(|p| p.to_array()).map(|c| c.to_bits().unsigned_abs()).max().unwrap_or(1);
    let tolerance = I16F16::from_bits((extent >> u.int_in_range(2..=7)?).clamp(1, i32::MAX as u32) as i32);
    let Ok(tessellation) = Tolerance::new(tolerance).and_then(|t| tessellate(&nets, &table, t)) else { return Ok(()) };
    for triangle in tessellation.clone().take(MOST) {
        let [a, b, c] = triangle.map(|vertex| vertex.point);
        assert!(a != b && b != c && c != a);
        assert!(triangle.iter().all(|vertex| vertex.patch < nets.len()));
    }
    if tessellation.clone().count() <= MOST {
        mesh(&tessellation);
    }
    Ok(())
}

fn mesh(tessellation: &Tessellation<'_, SurfaceNet<'_>>) {
    let size = tessellation.size();
    let count = tessellation.clone().count();
    let (mut vertices, mut triangles) = (vec![MeshVertex::BLANK; 3 * count], vec![[0; 3]; count]);
    let mut index = vec![0; 3 * count + 1];
    let buffers = MeshBuffers { vertices: &mut vertices, triangles: &mut triangles, index: &mut index };
    match tessellation.mesh(buffers) {
        Ok(mesh) => {
            assert!(mesh.corners().eq(tessellation.clone().map(|t| t.map(|vertex| vertex.point))));
            assert!(mesh.triangles().len() <= size.triangles && mesh.vertices().len() <= size.vertices, "{size:?}");
        }
        Err(error) => assert!(matches!(error, SubdivideError::Buffer { buffer: Buffer::Index, .. }), "{error}"),
    }
}
