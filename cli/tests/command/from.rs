//! `--from`: the sea of a file.

use crate::{refuse, succeed};
use exr::prelude::*;
use prob_water::whitecap::WhitecapOnset;
use prob_water::{
    Average, FootprintMeasure, Fresnel, Hiding, OffPlaneModel, Parameters, Readings, Salinity, SlopeBudget,
    SlopeMeasure, SlopeStatistics, SpectrumModel, Surface, Wind,
};
use std::fs;
use std::path::Path;

const ROWS: &str = "ix,iy,iz,ox,oy,oz\n0,0,1,0,0,1\n0.6,0,0.8,-0.48,0.36,0.8\n";

pub fn text(text: &str) -> AttributeValue {
    AttributeValue::Text(Text::new_or_panic(text))
}

/// An image of one pixel with attributes.
pub fn image(path: &Path, attributes: &[(&str, AttributeValue)]) {
    let channels = SpecificChannels::rgb(|_: Vec2<usize>| (0.1_f32, 0.2_f32, 0.3_f32));
    let mut image = Image::from_channels((1, 1), channels);
    let other = attributes.iter().map(|(name, value)| (Text::new_or_panic(name), value.clone()));
    image.layer_data.attributes.other.extend(other);
    image.write().to_file(path).unwrap();
}

/// A folder with one file of TOML.
struct Sea(tempfile::TempDir);

impl Sea {
    fn new(toml: &str) -> Self {
        let sea = Self(tempfile::tempdir().unwrap());
        fs::write(sea.path(), toml).unwrap();
        sea
    }

    fn path(&self) -> std::path::PathBuf {
        self.0.path().join("sea.toml")
    }

    /// Arguments that name the file.
    fn with(&self, arguments: &str) -> String {
        format!("{arguments} --from {}", self.path().display())
    }
}

/// Other than every default.
fn unusual(wind: Wind, surface: Surface) -> Parameters {
    Parameters {
        wind,
        wind_direction: -100.0 / 3.0,
        footprint: Some(0.21),
        footprint_measure: FootprintMeasure::OneOverE,
        surface,
        average: Average::Report,
        across: OffPlaneModel::Slopes,
        components: 7,
        instances: 30,
        seed: 9_007_199_254_740_991,
        time: 1.0 / 3.0,
        depth: 1e23,
        fetch: 7654.321,
        spectrum: SpectrumModel::Elfouhaily,
        swell_height: 0.7,
        swell_period: 9.5,
        swell_direction: Some(100.0 / 3.0),
        slopes: SlopeStatistics::BreonHenriot,
        slope_budget: SlopeBudget::Closed,
        wavelength: 1.064,
        ior: Some(4.0 / 3.0),
        extinction: Some(1.0 / 7.0),
        water: Salinity::Fresh,
        temperature: Some(20.0 / 3.0),
        salinity: Some(0.1),
        fresnel: Fresnel::Exact,
        slope_measure: SlopeMeasure::Slope,
        readings: Readings::AS_PRINTED,
        whitecaps: false,
        whitecap_onset: WhitecapOnset::Step,
        whitecap_lifetime: 2.5,
        shadowing: false,
        hiding: Hiding::Once,
        gram_charlier: false,
    }
}

fn flags(parameters: &Parameters) -> String {
    let flag = |entry: &prob_water::vocabulary::Entry| {
        Some(format!("--{} {}", entry.name.replace('_', "-"), parameters.get(entry.name)?))
    };
    prob_water::vocabulary::ENTRIES.iter().filter_map(flag).collect::<Vec<_>>().join(" ")
}

#[test]
fn what_the_library_shows_is_read() {
    let winds =
        [Wind::Speed { speed: 9.3, height: 19.5 }, Wind::FrictionVelocity(0.1 + 7.2), Wind::Beaufort(6)];
    for wind in winds {
        for (subcommand, surface) in [
            ("surface --grid 3,2,0.5 --json", Surface::Instance),
            ("spectrum --points 5", Surface::Instance),
            ("wind", Surface::Instance),
            ("brdf", Surface::Flat),
        ] {
            let parameters = unusual(wind, surface);
            let shown = parameters.configure().unwrap().to_string();
            let file = Sea::new(&shown);
            let expected = succeed(&format!("{subcommand} {}", flags(&parameters)), ROWS);
            assert_eq!(succeed(&file.with(subcommand), ROWS), expected);
            let exr = file.0.path().join("render.exr");
            image(&exr, &[("scene", text("a sea")), ("prob_water", text(&shown))]);
            assert_eq!(succeed(&format!("{subcommand} --from {}", exr.display()), ROWS), expected);
        }
    }
}

#[test]
fn flags_stand_above_the_file() {
    let file = Sea::new("wind_speed = 7\nwind_height = 19.5\nfootprint = 0.3\nwhitecaps = false");
    for (given, same) in [
        ("--footprint 1", "--wind-speed 7 --wind-height 19.5 --footprint 1 --whitecaps false"),
        ("--beaufort 9", "--beaufort 9 --footprint 0.3 --whitecaps false"),
        ("--wind-speed 4", "--wind-speed 4 --footprint 0.3 --whitecaps false"),
    ] {
        let found = succeed(&file.with(&format!("brdf {given}")), ROWS);
        assert_eq!(found, succeed(&format!("brdf {same}"), ROWS));
    }
}

#[test]
fn scenarios_have_seas_too() {
    let file = Sea::new(
        "limits = [0.1]\n[model]\nbeaufort = 3\nseed = 4\ndraws = \"sobol\"\n[[engagement]]\nlaser = 'x'\n",
    );
    assert_eq!(
        succeed(&file.with("surface --waves"), ""),
        succeed("surface --waves --beaufort 3 --seed 4", "")
    );
    assert_eq!(succeed(&file.with("brdf"), ROWS), succeed("brdf --beaufort 3", ROWS));
    assert_eq!(succeed(&Sea::new("").with("brdf"), ROWS), succeed("brdf", ROWS));
}

/// A footprint of `inf` belongs to the surface that the file names.
#[test]
fn another_surface_has_its_own_footprint() {
    let flat = Sea::new("beaufort = 5\nfootprint = inf\nsurface = \"flat\"\n");
    let waves = "surface --waves";
    assert_eq!(succeed(&flat.with(waves), ""), succeed(&format!("{waves} --beaufort 5"), ""));
    let ensemble = "brdf --surface ensemble";
    assert_eq!(succeed(&flat.with(ensemble), ROWS), succeed(&format!("{ensemble} --beaufort 5"), ROWS));
    let afar = Sea::new("beaufort = 5\nfootprint = 0.4\nsurface = 'ensemble'");
    let expected = succeed("spectrum --points 3 --beaufort 5 --footprint 0.4", "");
    assert_eq!(succeed(&afar.with("spectrum --points 3"), ""), expected);
    let message = refuse(&Sea::new("\nsurface = \"instance\"").with("brdf"), ROWS);
    assert!(message.contains("column x is missing"), "{message}");
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    for (toml, named) in [
        ("wind_speed = 5\nwaves = 3", "sea.toml:2: unknown key waves: known are wind_speed, "),
        ("\n\nior = 0.9", "sea.toml:3: ior = 0.9 is out of range"),
        ("surface = 'lumpy'", "sea.toml:1: surface = lumpy is unknown"),
        ("depth = [1, 2]", "sea.toml:1: depth = [1, 2] is not a number, a word"),
        ("depth = 1e999", "sea.toml:1: depth = 1e999 is not a number"),
        ("wind_speed = 5\nbeaufort = 3", "sea.toml:2: wind_speed = 5 and beaufort = 3 are both given"),
        ("model = 3", "sea.toml:1: model = 3 is not a table"),
        ("ior = 1.3\n[model]\n", "sea.toml:1: ior stands outside of [model]"),
        ("[model]\n[model.ior]", "sea.toml:2: ior = "),
        ("wind_speed 5", "sea.toml:1: "),
        ("\u{0}", "sea.toml:1: "),
    ] {
        let message = refuse(&Sea::new(toml).with("wind"), "");
        assert!(message.contains(named), "{toml}: {message}");
    }
    // Not the file's fault.
    assert!(!refuse(&Sea::new("ior = 1.3").with("wind --ior 0.9"), "").contains("sea.toml"));
    assert!(refuse("wind --from no/such/file", "").contains("no/such/file: cannot be read: "));
    assert!(refuse("wind --from .", "").contains(".: cannot be read: "));
    assert!(refuse(&Sea::new("").with("wind --table"), "").contains("--from"));
}

#[test]
fn images_without_a_sea() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("image.exr");
    let refuse = |attributes: &[_], named: &str| {
        image(&path, attributes);
        let message = refuse(&format!("wind --from {}", path.display()), "");
        assert!(message.contains(named), "{message}");
    };
    refuse(&[], "image.exr: this OpenEXR image has no attribute prob_water; its own are none\n");
    refuse(
        &[("scene", text("sea")), ("exposed", AttributeValue::F32(1.0))],
        "has no attribute prob_water; its own are exposed, scene\n",
    );
    let names: Vec<_> = (10..40).map(|i| format!("a{i}")).collect();
    let many: Vec<_> = names.iter().map(|name| (name.as_str(), text("x"))).collect();
    refuse(&many, "its own are a10, a11, a12, a13, a14, a15, a16, a17, a18, a19, a20, a21 and 18 more\n");
    refuse(&[("prob_water", AttributeValue::I32(3))], "the attribute prob_water is not text");
    refuse(&[("prob_water", text("ior = 1.3\nwaves = 2\n"))], "image.exr: prob_water:2: unknown key waves");
    refuse(&[("prob_water", text("# \u{e9}"))], "image.exr: prob_water:1: not UTF-8");
}

/// Neither a truncated image nor one with any byte of its header changed may end in a panic.
#[test]
fn broken_images() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("image.exr");
    image(&path, &[("scene", text("sea")), ("prob_water", text("beaufort = 3\n"))]);
    let whole = fs::read(&path).unwrap();
    let arguments = format!("wind --from {}", path.display());
    let expected = succeed("wind --beaufort 3", "");
    // What follows the header is not looked at.
    let end = whole.len() - 40;
    let (mut refused, mut read) = (0, 0);
    let mut check = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        let output = crate::run(&arguments, "");
        let message = String::from_utf8(output.stderr).unwrap();
        match output.status.code() {
            Some(0) => read += 1,
            Some(2) => {
                assert!(message.contains("image.exr") && message.lines().count() == 1, "{message}");
                refused += 1;
            }
            status => panic!("{status:?}: {message}"),
        }
    };
    for length in (0..end).step_by(3) {
        check(&whole[..length]);
    }
    for at in (4..end).step_by(2) {
        let mut bytes = whole.clone();
        bytes[at] = [0xff, 0x00, 0x80, 0x7f][at / 2 % 4];
        check(&bytes);
    }
    assert!(refused > 50 && read > 10, "{refused} refused, {read} read");
    fs::write(&path, &whole[..end]).unwrap();
    assert_eq!(succeed(&arguments, ""), expected);
}
