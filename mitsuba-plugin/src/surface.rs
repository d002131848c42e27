//! What the shim of the shape calls: a sea's mesh over a cxx bridge.

use glam::{DAffine3, DMat3, DVec3, Vec3};
use prob_water::vocabulary::{Builder, ENTRIES, Value, whole};
use prob_water::{Error, Layout, Mesh, Surface};

#[cxx::bridge(namespace = "prob_water")]
mod ffi {
    /// `prob_water::mesh::StaticGeometry`.
    struct StaticGeometry {
        texcoords: Vec<f32>,
        footprints: Vec<f32>,
        faces: Vec<u32>,
    }

    /// `prob_water::mesh::Vertices`, in the world.
    struct Vertices {
        positions: Vec<f32>,
        normals: Vec<f32>,
        whitecaps: Vec<f32>,
    }

    extern "Rust" {
        /// Parameters of the shape being collected.
        type MeshOptions;
        fn mesh_options() -> Box<MeshOptions>;
        fn set_number(self: &mut MeshOptions, name: &str, value: f64) -> Result<()>;
        fn set_flag(self: &mut MeshOptions, name: &str, value: bool) -> Result<()>;
        fn set_text(self: &mut MeshOptions, name: &str, value: &str) -> Result<()>;
        fn set_center(self: &mut MeshOptions, center: [f64; 3]) -> Result<()>;
        /// From the shape's own coordinates to the world's: the upper three rows of the matrix.
        fn set_to_world(self: &mut MeshOptions, rows: [f64; 12]) -> Result<()>;
        fn configure(self: &MeshOptions) -> Result<Box<SeaMesh>>;
        /// Every name that the above know.
        fn mesh_vocabulary() -> Vec<String>;

        /// A sea whose mesh fits into its budgets.
        type SeaMesh;
        fn time(self: &SeaMesh) -> f64;
        fn components(self: &SeaMesh) -> u32;
        fn level(self: &SeaMesh) -> StaticGeometry;
        /// Moves the waves to a time in s.
        fn set_time(self: &mut SeaMesh, time: f64) -> Result<()>;
        fn vertices(self: &SeaMesh) -> Vertices;
        /// `name = value` lines.
        fn describe(self: &SeaMesh) -> String;
    }
}

/// Numbers beside the vocabulary.
const LAYOUT: [&str; 5] = ["radius", "azimuth", "opening", "vertices", "memory"];
/// Of the scalar products of what `to_world` makes of the axes.
const TOLERANCE: f64 = 1e-4;
/// So many components are a sea by themselves.
const COMPONENTS: f64 = 512.0;

/// Parameters of the shape being collected.
struct MeshOptions {
    sea: Builder,
    layout: Layout,
    to_world: DAffine3,
}

fn mesh_options() -> Box<MeshOptions> {
    let mut sea = Builder::on(Surface::Instance);
    sea.set("components", &Value::Number(COMPONENTS)).expect("is in range");
    Box::new(MeshOptions { sea, layout: Layout::default(), to_world: DAffine3::IDENTITY })
}

fn mesh_vocabulary() -> Vec<String> {
    ENTRIES.iter().map(|e| e.name).chain(LAYOUT).map(String::from).collect()
}

impl MeshOptions {
    fn set(&mut self, name: &str, value: Value) -> Result<(), String> {
        let l = &mut self.layout;
        match (name, &value) {
            ("surface" | "instances" | "average" | "across", _) => {
                return Err(format!("{name} = {value} has no meaning here: the shape is one drawn sea"));
            }
            ("radius", Value::Number(x)) => l.radius = *x,
            ("azimuth", Value::Number(x)) => l.azimuth = *x,
            ("opening", Value::Number(x)) => l.opening = *x,
            ("vertices", Value::Number(_)) => {
                l.vertices = whole("vertices", &value).map_err(|e| e.to_string())?
            }
            ("memory", Value::Number(_)) => l.memory = whole("memory", &value).map_err(|e| e.to_string())?,
            _ if LAYOUT.contains(&name) => return Err(format!("{name} = {value} is not a number")),
            _ => return self.sea.set(name, &value).map_err(|e| e.to_string()),
        }
        Ok(())
    }

    fn set_number(&mut self, name: &str, value: f64) -> Result<(), String> {
        self.set(name, Value::Number(value))
    }

    fn set_flag(&mut self, name: &str, value: bool) -> Result<(), String> {
        self.set(name, Value::Flag(value))
    }

    fn set_text(&mut self, name: &str, value: &str) -> Result<(), String> {
        self.set(name, Value::Text(value.into()))
    }

    fn set_center(&mut self, [x, y, z]: [f64; 3]) -> Result<(), String> {
        if z != 0.0 {
            return Err(format!("center has z = {z}: allowed is 0"));
        }
        self.layout.center = [x, y];
        Ok(())
    }

    /// Waves stay as steep as they are, and z stays up for them.
    fn set_to_world(&mut self, rows: [f64; 12]) -> Result<(), String> {
        let column = |k: usize| DVec3::new(rows[k], rows[4 + k], rows[8 + k]);
        let matrix = DMat3::from_cols(column(0), column(1), column(2));
        let is_rotation = (matrix.transpose() * matrix).abs_diff_eq(DMat3::IDENTITY, TOLERANCE)
            && matrix.determinant() > 0.0;
        if !is_rotation || !column(3).is_finite() {
            let allowed = "allowed are rotations and shifts";
            return Err(format!("to_world scales, shears, mirrors or is not finite: {allowed}"));
        }
        self.to_world = DAffine3 { matrix3: matrix, translation: column(3) };
        Ok(())
    }

    fn configure(&self) -> Result<Box<SeaMesh>, Error> {
        let water = self.sea.parameters()?.configure()?;
        Ok(Box::new(SeaMesh { mesh: Mesh::new(&water, &self.layout)?, to_world: self.to_world }))
    }
}

/// A sea whose mesh fits into its budgets.
struct SeaMesh {
    mesh: Mesh,
    to_world: DAffine3,
}

impl SeaMesh {
    fn time(&self) -> f64 {
        self.mesh.water.parameters.time
    }

    fn components(&self) -> u32 {
        self.mesh.water.parameters.components
    }

    fn level(&self) -> ffi::StaticGeometry {
        let level = self.mesh.level();
        ffi::StaticGeometry { texcoords: level.texcoords, footprints: level.footprints, faces: level.faces }
    }

    fn set_time(&mut self, time: f64) -> Result<(), Error> {
        self.mesh.water = prob_water::Parameters { time, ..self.mesh.water.parameters }.configure()?;
        Ok(())
    }

    fn vertices(&self) -> ffi::Vertices {
        let vertices = self.mesh.vertices(self.time());
        let map = |values: &[f32], transform: &dyn Fn(DVec3) -> DVec3| {
            let (vectors, _) = values.as_chunks();
            let mapped = vectors.iter().map(|v| transform(Vec3::from_array(*v).as_dvec3()).as_vec3());
            mapped.flat_map(|v| v.to_array()).collect()
        };
        ffi::Vertices {
            positions: map(&vertices.positions, &|p| self.to_world.transform_point3(p)),
            normals: map(&vertices.normals, &|n| self.to_world.transform_vector3(n).normalize()),
            whitecaps: vertices.whitecaps,
        }
    }

    fn describe(&self) -> String {
        self.mesh.to_string()
    }
}
