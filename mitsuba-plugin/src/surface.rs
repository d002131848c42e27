//! What the shim of the shape calls: a sea's mesh over a cxx bridge.

use prob_water::vocabulary::{Builder, ENTRIES, Value, whole};
use prob_water::{Error, Layout, Mesh, Surface};

#[cxx::bridge(namespace = "prob_water")]
mod ffi {
    /// `prob_water::mesh::Level`.
    struct Level {
        texcoords: Vec<f32>,
        footprints: Vec<f32>,
        faces: Vec<u32>,
    }

    /// `prob_water::mesh::Vertices`.
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
        fn set_center(self: &mut MeshOptions, x: f64, y: f64);
        fn configure(self: &MeshOptions) -> Result<Box<SeaMesh>>;
        /// Every name that the above know.
        fn mesh_vocabulary() -> Vec<String>;

        /// A sea whose mesh fits into its budgets.
        type SeaMesh;
        fn time(self: &SeaMesh) -> f64;
        fn components(self: &SeaMesh) -> u32;
        fn level(self: &SeaMesh) -> Level;
        /// Moves the waves to a time in s.
        fn set_time(self: &mut SeaMesh, time: f64) -> Result<()>;
        fn vertices(self: &SeaMesh) -> Vertices;
        /// `name = value` lines.
        fn describe(self: &SeaMesh) -> String;
    }
}

/// Numbers beside the vocabulary.
const LAYOUT: [&str; 5] = ["radius", "azimuth", "opening", "vertices", "memory"];
/// So many components are a sea by themselves.
const COMPONENTS: f64 = 512.0;

/// Parameters of the shape being collected.
struct MeshOptions {
    sea: Builder,
    layout: Layout,
}

fn mesh_options() -> Box<MeshOptions> {
    let mut sea = Builder::on(Surface::Instance);
    sea.set("components", &Value::Number(COMPONENTS)).expect("is in range");
    Box::new(MeshOptions { sea, layout: Layout::default() })
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

    fn set_center(&mut self, x: f64, y: f64) {
        self.layout.center = [x, y];
    }

    fn configure(&self) -> Result<Box<SeaMesh>, Error> {
        let water = self.sea.parameters()?.configure()?;
        Ok(Box::new(SeaMesh(Mesh::new(&water, &self.layout)?)))
    }
}

/// A sea whose mesh fits into its budgets.
struct SeaMesh(Mesh);

impl SeaMesh {
    fn time(&self) -> f64 {
        self.0.water.parameters.time
    }

    fn components(&self) -> u32 {
        self.0.water.parameters.components
    }

    fn level(&self) -> ffi::Level {
        let level = self.0.level();
        ffi::Level { texcoords: level.texcoords, footprints: level.footprints, faces: level.faces }
    }

    fn set_time(&mut self, time: f64) -> Result<(), Error> {
        self.0.water = prob_water::Parameters { time, ..self.0.water.parameters }.configure()?;
        Ok(())
    }

    fn vertices(&self) -> ffi::Vertices {
        let vertices = self.0.vertices(self.time());
        ffi::Vertices {
            positions: vertices.positions,
            normals: vertices.normals,
            whitecaps: vertices.whitecaps,
        }
    }

    fn describe(&self) -> String {
        self.0.to_string()
    }
}
