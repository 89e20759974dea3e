//! Triangle meshes of OBJ and STL files, by the libraries `tobj` and `stl_io`.

use std::collections::HashMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Points and triangles as a file has them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Polyhedron {
    pub(crate) points: Vec<[f64; 3]>,
    pub(crate) faces: Vec<[u16; 3]>,
}

/// Why a file is no mesh.
#[derive(Debug)]
pub(crate) enum FileError {
    /// It is neither NAME.obj nor NAME.stl.
    Kind,
    /// It cannot be read.
    Unreadable(String),
    /// A face of more than three corners; or points and lines.
    NotTriangles,
    /// Not a number, or nothing that an edge of the mesh could be measured by.
    Coordinate { vertex: usize },
    /// Nothing in it.
    Empty,
    /// More vertices than indices can name.
    TooMany { vertices: usize },
}

impl std::fmt::Display for FileError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Kind => write!(f, "the name ends neither with .obj nor with .stl"),
            Self::Unreadable(why) => write!(f, "{why}"),
            Self::NotTriangles => write!(f, "it holds something other than triangles"),
            Self::Coordinate { vertex } => write!(f, "vertex {vertex} has a coordinate that is not finite"),
            Self::Empty => write!(f, "it holds no triangle"),
            Self::TooMany { vertices } => write!(f, "its {vertices} vertices are more than {}", u16::MAX - 1),
        }
    }
}

impl std::error::Error for FileError {}

/// Reads NAME.obj or NAME.stl. Vertices of an STL file, and those of several objects, are one where their bits agree.
pub(crate) fn read(path: &Path) -> Result<Polyhedron, FileError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let (points, faces) = match extension.as_deref() {
        Some("obj") => obj(path)?,
        Some("stl") => stl(path)?,
        _ => return Err(FileError::Kind),
    };
    weld(&points, &faces)
}

type Soup = (Vec<[f32; 3]>, Vec<[usize; 3]>);

fn unreadable(error: impl std::fmt::Display) -> FileError {
    FileError::Unreadable(error.to_string())
}

fn obj(path: &Path) -> Result<Soup, FileError> {
    let options =
        tobj::LoadOptions { triangulate: false, ignore_points: true, ignore_lines: true, ..Default::default() };
    let file = File::open(path).map_err(unreadable)?;
    // Materials do not matter.
    let read = tobj::load_obj_buf(&mut BufReader::new(file), &options, |_| Ok(Default::default()));
    let (models, _) = read.map_err(unreadable)?;
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for tobj::Model { mesh, .. } in models {
        if mesh.face_arities.iter().any(|corners| *corners != 3) {
            return Err(FileError::NotTriangles);
        }
        let first = points.len();
        points.extend(mesh.positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]]));
        faces.extend(mesh.indices.chunks_exact(3).map(|f| [f[0], f[1], f[2]].map(|i| first + i as usize)));
    }
    Ok((points, faces))
}

fn stl(path: &Path) -> Result<Soup, FileError> {
    let file = File::open(path).map_err(unreadable)?;
    let mesh = stl_io::read_stl(&mut BufReader::new(file)).map_err(unreadable)?;
    Ok((mesh.vertices.iter().map(|v| v.0).collect(), mesh.faces.iter().map(|face| face.vertices).collect()))
}

/// Makes one vertex of those at the same place and leaves out those that no face names.
fn weld(points: &[[f32; 3]], faces: &[[usize; 3]]) -> Result<Polyhedron, FileError> {
    let (mut places, mut out) = (HashMap::new(), Polyhedron::default());
    for face in faces {
        let mut corners = [0; 3];
        for (corner, vertex) in corners.iter_mut().zip(face) {
            let vertex = *vertex;
            let point = points.get(vertex).filter(|p| p.iter().all(|c| c.is_finite()));
            let point = point.ok_or(FileError::Coordinate { vertex })?;
            // −0 is 0.
            let place = *places.entry(point.map(|c| (c + 0.0).to_bits())).or_insert_with(|| {
                out.points.push(point.map(f64::from));
                out.points.len() - 1
            });
            *corner = u16::try_from(place).unwrap_or(u16::MAX);
        }
        out.faces.push(corners);
    }
    let vertices = out.points.len();
    match () {
        () if out.faces.is_empty() => Err(FileError::Empty),
        () if vertices >= usize::from(u16::MAX) => Err(FileError::TooMany { vertices }),
        () => Ok(out),
    }
}
