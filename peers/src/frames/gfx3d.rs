//! `embedded-3dgfx`: record and execute, Gouraud, its own light model; the camera so far away that perspective hardly
//! shows. Its vertices are whole pixels, and a vertex is placed once for each of its triangles.

use super::super::{counter, room};
use super::Screen;
use super::mesh::{MOST_TRIANGLES, MOST_VERTICES, Mesh};
use super::triangles::Target;
use super::view::{AREA, Shot};
use core::fmt::{Error, Result};
use embedded_3dgfx::engine::K3dengine;
use embedded_3dgfx::pipeline::command_buffer::CommandBuffer;
use embedded_3dgfx::pipeline::renderer::FrameCtx;
use embedded_3dgfx::pipeline::vertex::mesh::{Geometry, K3dMesh, RenderMode};
use embedded_graphics_core::pixelcolor::{Rgb565, WebColors};
use nalgebra::{Point3, Vector3};

/// How far the camera is, in pixels.
const DISTANCE: f32 = 2000.0;

struct Model {
    vertices: [[f32; 3]; MOST_VERTICES],
    normals: [[f32; 3]; MOST_VERTICES],
    faces: [[usize; 3]; MOST_TRIANGLES],
    face_normals: [[f32; 3]; MOST_TRIANGLES],
    commands: CommandBuffer<{ MOST_TRIANGLES + 8 }>,
}

impl Model {
    const EMPTY: Self = Self {
        vertices: [[0.0; 3]; MOST_VERTICES],
        normals: [[0.0; 3]; MOST_VERTICES],
        faces: [[0; 3]; MOST_TRIANGLES],
        face_normals: [[0.0; 3]; MOST_TRIANGLES],
        commands: CommandBuffer::new(),
    };

    /// The mesh turned to the view: x right, y up, z to the viewer, in pixels from the middle of the screen.
    fn fill(&mut self, mesh: &Mesh, shot: &Shot) -> (usize, usize) {
        let rows = shot.matrix.map(|row| row.map(|c| c as f32 / 2_097_152.0));
        let [scale_squared, ..] = rows.map(|[a, b, c, _]| a * a + b * b + c * c);
        // Newton's root, for there is none in `core`.
        let scale = (0..20).fold(0.01, |root, _| 0.5 * (root + scale_squared / root));
        let mut vertices = 0;
        for ((out, normal_out), (point, normal)) in self.vertices.iter_mut().zip(&mut self.normals).zip(mesh.vertices())
        {
            let turned =
                |v: &[i16; 3]| rows.map(|[a, b, c, _]| a * f32::from(v[0]) + b * f32::from(v[1]) + c * f32::from(v[2]));
            let [x, y, z] = turned(point);
            *out = [x + rows[0][3] - 160.0, 120.0 - y - rows[1][3], -z - rows[2][3]];
            let [x, y, z] = turned(normal).map(|c| c / scale / 16_384.0);
            *normal_out = [x, -y, -z];
            vertices += 1;
        }
        for ((face, normal), indices) in self.faces.iter_mut().zip(&mut self.face_normals).zip(mesh.triangles()) {
            // Counter-clockwise with y up.
            let [a, b, c] = indices.map(usize::from);
            *face = [a, c, b];
            let of = |k: usize| [0, 1, 2].map(|index: usize| self.normals[face[index]][k]).iter().sum::<f32>() / 3.0;
            *normal = [of(0), of(1), of(2)];
        }
        (vertices, mesh.triangles().len())
    }
}

pub(crate) fn draw(screen: &mut Screen, mesh: &Mesh, shot: &Shot) -> core::result::Result<u32, Error> {
    let model = room::room!(Model, Model::EMPTY);
    let (vertices, faces) = model.fill(mesh, shot);
    let mut engine = K3dengine::new(AREA.width as u16, AREA.height as u16);
    engine.camera.set_position(Point3::new(0.0, 0.0, DISTANCE));
    engine.camera.set_target(Point3::new(0.0, 0.0, 0.0));
    engine.camera.set_fovy(0.119_857); // 2 atan(120 / 2000)
    engine.camera.set_near_far(DISTANCE - 250.0, DISTANCE + 250.0);
    let geometry = Geometry {
        vertices: &model.vertices[..vertices],
        faces: &model.faces[..faces],
        colors: &[],
        lines: &[],
        normals: &model.face_normals[..faces],
        vertex_normals: &model.normals[..vertices],
        uvs: &[],
        texture_id: None,
    };
    let mut object = K3dMesh::new(geometry);
    object.set_color(Rgb565::CSS_BURLY_WOOD);
    object.set_render_mode(RenderMode::GouraudLightDir(Vector3::new(-2.0 / 7.0, 3.0 / 7.0, -6.0 / 7.0)));
    let commands = &mut model.commands;
    let mut done: Result = Err(Error);
    let counted = counter::count(|| {
        screen.colour.fill(0);
        let (width, height) = (AREA.width as usize, AREA.height as usize);
        let recorded = engine.record(core::iter::once(&object), commands, None);
        let Screen { colour, depth } = screen;
        let mut frame = FrameCtx { zbuffer: depth, width, height };
        let executed = recorded.and_then(|()| engine.execute(&mut Target(colour), &mut frame, commands, None));
        done = executed.map(|_| ()).map_err(|_| Error);
    });
    done.map(|()| counted)
}
