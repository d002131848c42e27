use crate::{close, float, refuse, succeed, table, vectors};
use serde_json::Value;

#[test]
fn reproduces_the_reference_vectors() {
    let expected = vectors("facet.csv");
    let expected = table(&expected);
    let (mut seen, mut tilted, mut lit) = (0, 0, 0);
    for row in expected[1..].iter().step_by(25) {
        let azimuth = float(row[1]).to_degrees();
        let parameters = format!(
            "--friction-velocity {} --wind-direction {azimuth} --footprint {} --ior {} --whitecaps false",
            row[0], row[2], row[3]
        );
        // A flat row goes in without normals, which then are up.
        let columns = if row[12] == "1" { 4..10 } else { 4..13 };
        let input = format!("{}\n{}\n", expected[0][columns.clone()].join(","), row[columns].join(","));
        let text = succeed(&format!("brdf {parameters}"), &input);
        let found = table(&text)[1].last().copied().unwrap();
        close(found, row[13]);
        seen += 1;
        tilted += usize::from(row[12] != "1");
        lit += usize::from(float(found) > 0.0);
    }
    assert!(seen >= 12 && tilted > 3 && tilted < seen && lit > 6, "{seen} {tilted} {lit}");
}

#[test]
fn input_stays_as_it_was_in_any_order() {
    let input = "oz,ox,oy,iz,ix,iy\r\n1.0,0,-0.0,8e-1,+0.60,0\n\n1,0,0, 1 ,0,0";
    let text = succeed("brdf", input);
    let rows = table(&text);
    assert_eq!(rows[0].join(","), "oz,ox,oy,iz,ix,iy,f");
    assert_eq!(rows[1][..6].join(","), "1.0,0,-0.0,8e-1,+0.60,0");
    assert_eq!(rows[2][..6].join(","), "1,0,0, 1 ,0,0");
    let sorted = succeed("brdf -", "ix,iy,iz,ox,oy,oz\n.6,0,.8,0,0,1\n0,0,1,0,0,1\n");
    for row in [1, 2] {
        assert!(float(rows[row][6]) > 0.0);
        assert_eq!(rows[row][6], table(&sorted)[row][6]);
    }
}

#[test]
fn below_the_horizon_is_black() {
    let text = succeed("brdf", "ix,iy,iz,ox,oy,oz\n0,0,-1,0,0,1\n0,0,1,0.6,0,-0.8\n0,0,1,0,0,1\n");
    let f: Vec<_> = table(&text)[1..].iter().map(|row| float(row[6])).collect();
    assert_eq!(f[..2], [0.0, 0.0]);
    assert!(f[2] > 0.0);
}

#[test]
fn header_alone_gives_header_alone() {
    assert_eq!(succeed("brdf", "ix,iy,iz,ox,oy,oz\n"), "ix,iy,iz,ox,oy,oz,f\n");
    assert_eq!(succeed("brdf --json", "ix,iy,iz,ox,oy,oz,nx,ny,nz"), "[]\n");
}

#[test]
fn json_holds_the_same_numbers() {
    let input = "ix,iy,iz,ox,oy,oz,nx,ny,nz\n0.60,0,8e-1,0,0,1,0,0,1\n0,0,1,0,0,1,.28,0,.96\n";
    let text = succeed("brdf --beaufort 4", input);
    let json: Value = serde_json::from_str(&succeed("brdf --beaufort 4 --json", input)).unwrap();
    let rows = table(&text);
    assert_eq!(json.as_array().unwrap().len(), 2);
    for (row, object) in rows[1..].iter().zip(json.as_array().unwrap()) {
        let object = object.as_object().unwrap();
        assert_eq!(object.keys().collect::<Vec<_>>(), rows[0]);
        for (text, value) in row.iter().zip(object.values()) {
            assert_eq!(value.as_f64().unwrap(), float(text));
        }
    }
}

/// `surface = ensemble`: the library's numbers, footprint 0.15 unless told, reciprocal; normals are refused.
#[test]
fn the_sea_from_afar() {
    let rows =
        "ix,iy,iz,ox,oy,oz\n0.6,0,0.8,-0.48,0.36,0.8\n-0.48,0.36,0.8,0.6,0,0.8\n0,0,1,0,0,1\n0,0,1,0,1,0\n";
    let text = succeed("brdf --surface ensemble --friction-velocity 24", rows);
    let found: Vec<f64> = table(&text)[1..].iter().map(|row| float(row[6])).collect();
    let water = prob_water::Parameters {
        wind: prob_water::Wind::FrictionVelocity(24.0),
        surface: prob_water::Surface::Ensemble,
        footprint: Some(0.15),
        ..Default::default()
    };
    let lobe = prob_water::EnsembleLobe::new(&water.configure().unwrap()).unwrap();
    close(table(&text)[1][6], &lobe.eval([0.6, 0.0, 0.8], [-0.48, 0.36, 0.8]).to_string());
    assert!((found[0] / found[1] - 1.0).abs() < 1e-11 && found[2] > 0.03 && found[3] == 0.0, "{found:?}");
    let report = prob_water::Parameters { average: prob_water::Average::Report, ..water };
    let lobe = prob_water::EnsembleLobe::new(&report.configure().unwrap()).unwrap();
    let text = succeed("brdf --surface ensemble --average report --friction-velocity 24", rows);
    close(table(&text)[1][6], &lobe.eval([0.6, 0.0, 0.8], [-0.48, 0.36, 0.8]).to_string());
    let with_normals = "ix,iy,iz,ox,oy,oz,nx,ny,nz\n0,0,1,0,0,1,0,0,1\n";
    assert!(refuse("brdf --surface ensemble", with_normals).contains("normals"));
}

/// On one drawn sea: the wave normal and the whitecaps of the place, as `surface` has them.
#[test]
fn a_place_of_a_drawn_sea() {
    let sea = "--wind-speed 9 --seed 4 --time 2.5 --whitecaps false";
    let places = ["3,4", "-70.5,12"];
    let surface = succeed(&format!("surface {sea} --points -"), &format!("x,y\n{}\n", places.join("\n")));
    for (place, point) in places.into_iter().zip(&table(&surface)[1..]) {
        let [nx, ny, nz] = [6, 7, 8].map(|column| float(point[column]));
        let (i, o) = ([0.6, 0.0, 0.8], [-0.48, 0.36, 0.8]);
        let with_normal = format!("ix,iy,iz,ox,oy,oz,nx,ny,nz\n0.6,0,0.8,-0.48,0.36,0.8,{nx},{ny},{nz}\n");
        let about = succeed("brdf --wind-speed 9 --footprint 0.15 --whitecaps false", &with_normal);
        let dot = |v: [f64; 3]| v[0] * nx + v[1] * ny + v[2] * nz;
        let f = float(table(&about)[1][9]) * dot(i) * dot(o) / (nz * i[2] * o[2]);
        let input = format!("x,y,ix,iy,iz,ox,oy,oz\n{place},0.6,0,0.8,-0.48,0.36,0.8\n");
        let found = succeed(&format!("brdf --surface instance {sea}"), &input);
        assert!((float(table(&found)[1][8]) / f - 1.0).abs() < 1e-9, "{found} {f}");
    }
    let no_place = refuse("brdf --surface instance", "ix,iy,iz,ox,oy,oz\n0,0,1,0,0,1\n");
    assert!(no_place.contains("column x is missing"), "{no_place}");
    let nowhere = refuse("brdf --surface instance", "ix,iy,iz,ox,oy,oz,x,y\n0,0,1,0,0,1,nan,0\n");
    assert!(nowhere.contains("row 1") && nowhere.contains("x,y = NaN,0"), "{nowhere}");
}
