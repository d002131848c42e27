//! Surfaces that a type does not serve are refused by name.

use prob_water::{
    EmpiricalLobe, Ensemble, EnsembleLobe, Error, Exact, InstanceLobe, Layout, Mesh, Parameters, Surface,
    Table, Water,
};

const ALL: [Surface; 4] = [Surface::Flat, Surface::Instance, Surface::Ensemble, Surface::Empirical];
const DRAWN: &[Surface] = &[Surface::Instance, Surface::Ensemble, Surface::Empirical];

fn water(surface: Surface) -> Water {
    Parameters { surface, ..Parameters::default() }.configure().unwrap()
}

/// One default of the footprint, whoever asks.
#[test]
fn footprints() {
    for surface in ALL {
        let expected = if surface == Surface::Flat { f64::INFINITY } else { 0.15 };
        let water = water(surface);
        assert_eq!([water.footprint, water.parameters.footprint()], [expected; 2]);
        let given = Parameters { footprint: Some(expected), ..water.parameters }.configure().unwrap();
        assert_eq!(given.variances, water.variances);
        let other = Parameters { footprint: Some(0.4), ..water.parameters }.configure().unwrap();
        assert_eq!(other.footprint, 0.4);
    }
}

#[test]
fn others_are_refused() {
    type New = fn(&Water) -> Result<(), Error>;
    let all: [(&str, &[Surface], New); 9] = [
        ("Water::lobe", &[Surface::Flat], |w| w.lobe().map(drop)),
        ("Ensemble", DRAWN, |w| Ensemble::new(w).map(drop)),
        ("Exact", DRAWN, |w| Exact::new(w).map(drop)),
        ("ReferenceModel", DRAWN, |w| prob_water::empirical::ReferenceModel::new(w).map(drop)),
        ("InstanceLobe", &[Surface::Instance], |w| InstanceLobe::new(w).map(drop)),
        ("InstanceLobe, fading", &[Surface::Instance], |w| InstanceLobe::fading(w).map(drop)),
        ("EnsembleLobe", &[Surface::Ensemble], |w| EnsembleLobe::new(w).map(drop)),
        ("EmpiricalLobe", &[Surface::Empirical], |w| EmpiricalLobe::new(w, Table::standard()).map(drop)),
        ("Mesh", &[Surface::Instance], |w| Mesh::new(w, &Layout::default()).map(drop)),
    ];
    for (name, served, new) in all {
        for surface in ALL {
            let found = new(&water(surface));
            if served.contains(&surface) {
                assert!(found.is_ok(), "{name} {surface:?}: {found:?}");
                continue;
            }
            let error = found.expect_err(name);
            assert_eq!(error.parameters(), ["surface"]);
            let text = error.to_string();
            let start =
                format!("surface = {} is not served here: allowed is {}", surface.name(), served[0].name());
            assert!(text.starts_with(&start), "{text}");
        }
    }
    let text = water(Surface::Ensemble).lobe().unwrap_err().to_string();
    assert!(text.ends_with("flat; EnsembleLobe is the BRDF of ensemble"), "{text}");
    // What lies at a point is there for all.
    let up = [0.0, 0.0, 1.0];
    for surface in ALL {
        let flat = Parameters { footprint: Some(0.15), ..Parameters::default() }.configure().unwrap();
        let wavy =
            Parameters { footprint: Some(0.15), surface, ..Parameters::default() }.configure().unwrap();
        assert_eq!(wavy.local_lobe().eval(up, up, None), flat.lobe().unwrap().eval(up, up, None));
    }
}
