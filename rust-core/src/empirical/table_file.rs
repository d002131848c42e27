//! Tables of the empirical model as files: NumPy's npz, a zip of arrays.
//!
//! In Python `numpy.load("table.npz")` gives the arrays by name:
//!
//! | array | type | over |
//! | --- | --- | --- |
//! | `friction_velocity` (cm/s), `footprint` (m), `incidence`, `wind_azimuth`, `theta_r` (degrees) | float64 | themselves: the grid |
//! | `mean`, `std`, `approximate` (f of the facets over rho, 1/sr), `whitecaps` (share) | float32 | all five, in this order |
//! | `sigma`, `u_sigma`, `delta`, `u_delta` (radians), `fitted` (share) | float32 | the first four |
//! | `metadata` | bytes | JSON: `json.loads(t["metadata"].tobytes())` |
//!
//! The metadata have the format's name and version, the version of this crate, the parameters by the vocabulary's names
//! and the units of all arrays. Every array has a check sum.

use super::table::{ADDED, Grid, MADE_WITH, SHARED, Table, kept};
use crate::config::Parameters;
use crate::config::vocabulary::Value;
use crate::error::Error;
use npyz::WriterBuilder;
use serde_json::{Map, json};
use std::io::{Cursor, Read, Seek, Write};
use std::path::Path;
use std::sync::LazyLock;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// What the metadata call the format.
const FORMAT: &str = "prob-water empirical table";
/// Files of other versions are refused.
const FORMAT_VERSION: u64 = 1;
/// Longer metadata, and longer axes, are refused unread.
const LONGEST: u64 = 1 << 20;
const IN_PLANE: [&str; 4] = ["mean", "std", "whitecaps", "approximate"];
const WIDTHS: [&str; 5] = ["sigma", "u_sigma", "delta", "u_delta", "fitted"];

/// The table that comes with the crate: `cargo run --release -p prob-water-cli -- table build` makes it anew.
static STANDARD: &[u8] = include_bytes!("../../data/table.npz");

impl Table {
    /// The table that comes with the crate: w* from 2 to 62.9 cm/s, footprints from 0.02 to 1 m, the model's defaults.
    pub fn standard() -> &'static Self {
        static TABLE: LazyLock<Table> =
            LazyLock::new(|| Table::read(STANDARD, "the crate's own").expect("is checked by the tests"));
        &TABLE
    }

    /// Reads a file; refused where it is no table, or not a whole one, or one of another version.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let name = path.display().to_string();
        let bytes = std::fs::read(path)
            .map_err(|e| Error::Table { name: name.clone(), reason: format!("cannot be read: {e}") })?;
        Self::read(&bytes, &name)
    }

    /// Reads what a file holds; `name` is for refusals.
    pub fn read(bytes: &[u8], name: &str) -> Result<Self, Error> {
        parse(bytes).map_err(|reason| Error::Table { name: name.into(), reason })
    }

    /// The same bytes for the same table.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.write(Cursor::new(vec![])).expect("memory takes whatever it is given").into_inner()
    }

    fn write<W: Write + Seek>(&self, out: W) -> std::io::Result<W> {
        let mut zip = ZipWriter::new(out);
        let shape = self.grid.shape();
        add(&mut zip, "metadata", &[self.metadata().len()], self.metadata().bytes())?;
        for (name, axis, _) in self.grid.axes() {
            add(&mut zip, name, &[axis.len()], axis.iter().copied())?;
        }
        for (name, values) in IN_PLANE.iter().zip(&self.in_plane) {
            add(&mut zip, name, &shape, values.iter().copied())?;
        }
        for (name, values) in WIDTHS.iter().zip(&self.widths) {
            add(&mut zip, name, &shape[..4], values.iter().copied())?;
        }
        Ok(zip.finish()?)
    }

    /// What the file says of itself.
    pub fn metadata(&self) -> String {
        let usual = Parameters::default();
        let told = |name: &&&str| !ADDED.contains(*name) || self.parameters.get(name) != usual.get(name);
        let parameters: Map<_, _> = SHARED
            .iter()
            .filter(told)
            .chain(&MADE_WITH)
            .filter_map(|name| {
                let value = match self.parameters.get(name)? {
                    Value::Flag(x) => json!(x),
                    Value::Number(x) if x.is_finite() && x.fract() == 0.0 => json!(x as i64),
                    Value::Number(x) if x.is_finite() => json!(x),
                    other => json!(other.to_string()),
                };
                Some(((*name).into(), value))
            })
            .collect();
        let metadata = json!({
            "format": FORMAT,
            "format_version": FORMAT_VERSION,
            "prob_water": self.version,
            "parameters": parameters,
            "shape": ["friction_velocity", "footprint", "incidence", "wind_azimuth", "theta_r"],
            "units": {
                "friction_velocity": "cm/s",
                "footprint": "m",
                "incidence": "degrees",
                "wind_azimuth": "degrees the wind comes from, from the plane of incidence, away from the source",
                "theta_r": "degrees from the vertical, positive away from the source",
                "mean": "1/sr, facets' f over rho, a whitecap counting as 0: mean over instances",
                "std": "1/sr, of the same: standard deviation over instances",
                "whitecaps": "share of instances in which a whitecap is seen",
                "approximate": "1/sr, near the mean: what the facets would reflect on level water",
                "sigma": "radians, sigma(0) of Eq. 89",
                "u_sigma": "radians, standard deviation over instances",
                "delta": "radians, of Eq. 90",
                "u_delta": "radians, standard deviation over instances",
                "fitted": "share of instances whose lobe across the plane has a peak",
            },
        });
        serde_json::to_string_pretty(&metadata).expect("has nothing that JSON lacks")
    }
}

fn add<W: Write + Seek, T: npyz::AutoSerialize>(
    zip: &mut ZipWriter<W>,
    name: &str,
    shape: &[usize],
    values: impl Iterator<Item = T>,
) -> std::io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(9))
        .last_modified_time(zip::DateTime::default());
    zip.start_file(npyz::npz::file_name_from_array_name(name), options)?;
    let shape: Vec<u64> = shape.iter().map(|n| *n as u64).collect();
    let mut array = npyz::WriteOptions::new().default_dtype().shape(&shape).writer(zip).begin_nd()?;
    array.extend(values)?;
    array.finish()
}

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

fn parse(bytes: &[u8]) -> Result<Table, String> {
    let mut zip = ZipArchive::new(Cursor::new(bytes))
        .map_err(|e| format!("is no npz file, or a truncated one: {e}"))?;
    let metadata = array::<u8>(&mut zip, "metadata", &[], LONGEST)?;
    let metadata: serde_json::Value =
        serde_json::from_slice(&metadata).map_err(|e| format!("its metadata are no JSON: {e}"))?;
    let told = |name: &str| metadata.get(name).cloned().unwrap_or_default();
    if told("format") != FORMAT {
        return Err(format!("its format is {}, expected \"{FORMAT}\"", told("format")));
    }
    if told("format_version") != FORMAT_VERSION {
        return Err(format!("its format_version is {}, expected {FORMAT_VERSION}", told("format_version")));
    }
    let mut parameters = told("parameters");
    // Files that do not tell are of Eqs. 53-54 alone.
    if let Some(told) = parameters.as_object_mut() {
        told.entry("whitecap_onset").or_insert(json!("ramp"));
    }
    let untold = |name: &&&str| !ADDED.contains(name) && parameters.get(name).is_none();
    if let Some(missing) = SHARED.iter().find(untold) {
        return Err(format!("its metadata do not tell {missing}"));
    }
    let parameters = kept(|name| {
        Some(match parameters.get(name)? {
            serde_json::Value::Bool(x) => Value::Flag(*x),
            serde_json::Value::Number(x) => Value::Number(x.as_f64()?),
            serde_json::Value::String(x) => Value::Text(x.clone()),
            other => Value::Text(other.to_string()),
        })
    });
    let mut axes =
        Grid::default().axes().map(|(name, ..)| array::<f64>(&mut zip, name, &[], LONGEST)).into_iter();
    let mut axis = || axes.next().expect("five");
    let grid = Grid {
        friction_velocity: axis()?,
        footprint: axis()?,
        incidence: axis()?,
        wind_azimuth: axis()?,
        theta_r: axis()?,
    };
    grid.check().map_err(|e| e.to_string())?;
    let shape = grid.shape();
    let mut all = |name: &&str, shape: &[usize]| {
        let count = shape.iter().product::<usize>() as u64;
        let values = array::<f32>(&mut zip, name, shape, count)?;
        // Only delta, an angle to either side, may be below 0.
        match values.iter().find(|x| !x.is_finite() || (**x < 0.0 && **name != *"delta")) {
            Some(wrong) => Err(format!("its array {name} holds {wrong}")),
            None => Ok(values),
        }
    };
    let [mean, std, whitecaps, approximate] = IN_PLANE.each_ref().map(|name| all(name, &shape));
    let [sigma, u_sigma, delta, u_delta, fitted] = WIDTHS.each_ref().map(|name| all(name, &shape[..4]));
    Ok(Table {
        version: told("prob_water").as_str().ok_or("its metadata do not tell what made it")?.into(),
        parameters: parameters.and_then(|p| p.configure().map(|_| p)).map_err(|e| e.to_string())?,
        in_plane: [mean?, std?, whitecaps?, approximate?],
        widths: [sigma?, u_sigma?, delta?, u_delta?, fitted?],
        grid,
    })
}

/// An array of a shape, or of one dimension where none is given, and of at most so many values.
fn array<T: npyz::Deserialize>(
    zip: &mut Archive,
    name: &str,
    shape: &[usize],
    most: u64,
) -> Result<Vec<T>, String> {
    let broken = |e: &dyn std::fmt::Display| format!("its array {name} cannot be read: {e}");
    let file = zip.by_name(&npyz::npz::file_name_from_array_name(name)).map_err(|e| broken(&e))?;
    // Whoever wrote the file may have written anything: no more is unpacked than belongs there, and a header. To the end,
    // where the check sum is.
    let limit = most * size_of::<T>() as u64 + 4096;
    let mut content = vec![];
    file.take(limit).read_to_end(&mut content).map_err(|e| broken(&e))?;
    let array = npyz::NpyFile::new(content.as_slice()).map_err(|e| broken(&e))?;
    let found = array.shape().to_vec();
    let fits = if shape.is_empty() {
        found.len() == 1 && found[0] <= most
    } else {
        found.iter().map(|n| *n as usize).eq(shape.iter().copied())
    };
    if !fits || array.order() != npyz::Order::C {
        let expected = if shape.is_empty() { "one dimension".into() } else { format!("{shape:?}") };
        return Err(format!("its array {name} has the shape {found:?}, expected {expected} in C order"));
    }
    array.into_vec::<T>().map_err(|e| broken(&e))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Surface;
    use crate::empirical::table::Plan;

    fn small() -> Table {
        let sea = Parameters {
            surface: Surface::Empirical,
            instances: 64,
            depth: 20.0,
            ior: Some(1.33),
            seed: 9,
            ..Parameters::default()
        };
        let grid = Grid {
            friction_velocity: vec![8.0, 9.0],
            footprint: vec![0.15],
            incidence: vec![0.0, 80.0],
            wind_azimuth: vec![0.0, 180.0],
            theta_r: vec![-60.0, 0.0, 30.0, 80.0],
        };
        Plan::new(&sea, &grid).unwrap().table().unwrap()
    }

    /// The zip's own arrays, one of them replaced.
    fn with(bytes: &[u8], name: &str, replace: impl Fn(Vec<u8>) -> Vec<u8>) -> Vec<u8> {
        let mut zip = ZipArchive::new(Cursor::new(bytes)).unwrap();
        let mut out = ZipWriter::new(Cursor::new(vec![]));
        for k in 0..zip.len() {
            let mut file = zip.by_index(k).unwrap();
            let file_name = file.name().unwrap().into_owned();
            let mut content = vec![];
            file.read_to_end(&mut content).unwrap();
            if file_name == format!("{name}.npy") {
                content = replace(content);
                if content.is_empty() {
                    continue;
                }
            }
            out.start_file(file_name, SimpleFileOptions::default()).unwrap();
            out.write_all(&content).unwrap();
        }
        out.finish().unwrap().into_inner()
    }

    fn text(content: Vec<u8>, from: &str, to: &str) -> Vec<u8> {
        // The header, which tells the length, is followed by the text.
        let at = content.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
        assert_eq!(from.len(), to.len());
        let mut changed = content;
        changed[at..at + to.len()].copy_from_slice(to.as_bytes());
        changed
    }

    #[test]
    fn what_is_written_can_be_read() {
        let table = small();
        let bytes = table.to_bytes();
        assert_eq!(bytes, table.to_bytes());
        let read = Table::read(&bytes, "small").unwrap();
        assert!(read == table && read.to_bytes() == bytes);
        assert_eq!((read.parameters.depth, read.parameters.seed), (20.0, 9));
        let same = with(&bytes, "none", |content| content);
        assert!(Table::read(&same, "small").unwrap() == table);
    }

    /// The same rows, in whatever order and on however many threads.
    #[test]
    fn the_same_seed_gives_the_same_bytes() {
        let table = small();
        let plan = Plan::new(&table.parameters, &table.grid).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
        let mut rows: Vec<_> =
            pool.install(|| (0..plan.rows()).rev().map(|row| plan.row(row).unwrap()).collect());
        rows.reverse();
        assert_eq!(plan.assemble(&rows).unwrap().to_bytes(), table.to_bytes());
        let other = Parameters { seed: 10, ..table.parameters };
        assert_ne!(Plan::new(&other, &table.grid).unwrap().table().unwrap().to_bytes(), table.to_bytes());
    }

    #[test]
    fn the_standard_table_is_what_its_documentation_says() {
        let table = Table::standard();
        assert_eq!(table.grid, Grid::default());
        let made_with = Parameters { instances: crate::empirical::table::INSTANCES, ..Parameters::default() };
        let made_with = Plan::new(&made_with, &Grid::default()).unwrap();
        assert!(table.to_bytes() == STANDARD, "written anew the file is another");
        // Of all its rows one that takes little, and one where drawn surfaces matter.
        for row in [0, 500] {
            let [_, footprints, incidences, azimuths, _] = table.grid.shape();
            let at = [row / incidences / footprints, row / incidences % footprints, row % incidences];
            let found = made_with.row(row).unwrap();
            for (azimuth, numbers) in found.chunks(found.len() / azimuths).enumerate() {
                let node = table.node([at[0], at[1], at[2], azimuth]);
                let close = |a: f64, b: f32| (a - f64::from(b)).abs() <= 3e-4 * a.abs().max(1e-9);
                assert!(close(node.sigma, numbers[0]) && close(node.u_delta, numbers[3]), "{row} {azimuth}");
                assert!(node.in_plane.iter().zip(&numbers[5..]).all(|(m, x)| close(m.facets, *x)));
            }
        }
    }

    #[test]
    fn refusals_tell_the_reason() {
        let bytes = small().to_bytes();
        let refused = |bytes: &[u8]| {
            let error = Table::read(bytes, "some.npz").unwrap_err();
            assert_eq!(error.parameters(), ["table"]);
            error.to_string()
        };
        for (expected, bytes) in [
            ("no npz file", vec![]),
            ("no npz file", b"mean,std\n1,2\n".to_vec()),
            ("no npz file", bytes[..bytes.len() - 30].to_vec()),
            ("no npz file", bytes[..bytes.len() / 2].to_vec()),
            ("metadata", with(&bytes, "metadata", |_| vec![])),
            ("std", with(&bytes, "std", |_| vec![])),
            ("mean", with(&bytes, "mean", |content| content[..content.len() - 4].to_vec())),
            (
                "expected 1",
                with(&bytes, "metadata", |c| text(c, "\"format_version\": 1", "\"format_version\": 2")),
            ),
            ("format is", with(&bytes, "metadata", |c| text(c, "empirical table", "empirical chair"))),
            ("no JSON", with(&bytes, "metadata", |c| text(c, "\"format\"", "\"format "))),
            (
                "gram_charlier",
                with(&bytes, "metadata", |c| text(c, "\"gram_charlier\"", "\"gram-charlier\"")),
            ),
            (
                "whitecaps",
                with(&bytes, "metadata", |c| text(c, "\"whitecaps\": true", "\"whitecaps\": 1234")),
            ),
            (
                "friction_velocity",
                with(&bytes, "friction_velocity", |mut c| {
                    let last = c.len() - 1;
                    c[last] = 0xc0;
                    c
                }),
            ),
            (
                "sigma",
                with(&bytes, "sigma", |mut c| {
                    let first = c.len() - 1;
                    c[first] |= 0x80;
                    c
                }),
            ),
            (
                "mean",
                with(&bytes, "mean", |mut c| {
                    let last = c.len() - 4;
                    c[last..].copy_from_slice(&f32::NAN.to_le_bytes());
                    c
                }),
            ),
            (
                "shape",
                with(&bytes, "theta_r", |c| {
                    let header = c.len() - 4 * 8;
                    let fewer = text(c[..header].to_vec(), "(4", "(5");
                    [fewer, c[header..].to_vec(), vec![0, 0, 0, 0, 0, 64, 86, 64]].concat()
                }),
            ),
        ] {
            let message = refused(&bytes);
            assert!(message.contains("some.npz") && message.contains(expected), "{expected}: {message}");
        }
        // A flipped bit anywhere changes nothing, or is found.
        let table = small();
        let mut found = 0;
        for at in (0..bytes.len()).step_by(7) {
            let mut flipped = bytes.clone();
            flipped[at] ^= 0x10;
            match Table::read(&flipped, "some.npz") {
                Ok(read) => assert!(read == table, "byte {at}"),
                Err(_) => found += 1,
            }
        }
        assert!(found > bytes.len() / 7 / 2);
        let missing = Table::open(Path::new("/nowhere/table.npz")).unwrap_err().to_string();
        assert!(missing.contains("/nowhere/table.npz") && missing.contains("cannot be read"), "{missing}");
    }
}
