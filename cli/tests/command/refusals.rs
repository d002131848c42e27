use crate::refuse;

/// Arguments, then what the message has to name.
#[test]
fn arguments() {
    for (arguments, named) in [
        ("", &["subcommand"][..]),
        ("breeze", &["breeze"]),
        ("wind --gust 3", &["--gust"]),
        ("wind --ior 0.9", &["ior", "0.9", "1 to 4"]),
        ("wind --ior 1.3 --ior 1.4", &["--ior"]),
        ("wind --footprint", &["--footprint"]),
        ("wind --footprint 0", &["footprint", "0 m"]),
        ("wind --footprint -inf", &["footprint", "-inf"]),
        ("wind --wind-direction north", &["wind_direction", "north"]),
        ("wind --wind-direction nan", &["wind_direction", "nan"]),
        ("wind --wind-speed -1", &["wind_speed", "-1"]),
        ("wind --wind-speed 36.1", &["wind_speed", "36.1", "36.00 m/s"]),
        ("wind --friction-velocity 239", &["friction_velocity", "239", "238.65"]),
        ("wind --beaufort 13", &["beaufort", "13", "0 to 12"]),
        ("wind --beaufort 2.5", &["beaufort", "2.5"]),
        ("wind --wind-speed 5 --beaufort 3", &["wind_speed", "beaufort"]),
        ("wind --friction-velocity 5 --wind-height 3", &["friction_velocity", "wind_height"]),
        ("wind --wind-height 101", &["wind_height", "101", "0.1 to 100"]),
        ("wind --wavelength 0.1", &["wavelength", "0.1", "0.2 to 200"]),
        ("wind --surface wavy", &["surface", "wavy", "flat"]),
        ("wind --whitecaps maybe", &["whitecaps", "maybe"]),
        ("wind --table --ior 1.3", &["--table", "--ior"]),
        ("wind --output no/such/folder/out.csv", &["no/such/folder/out.csv"]),
        ("brdf --surface instance", &["column x is missing", "x,y"]),
        ("spectrum --surface flat", &["surface = flat is not served here: allowed is instance"]),
        ("spectrum --wind-speed 0", &["no waves", "k_min", "--wave-number"]),
        ("spectrum --wind-speed 0.05", &["no waves", "--wave-number"]),
        ("spectrum --points 1", &["--points", "1"]),
        ("spectrum --points 10000001", &["--points", "10000001"]),
        ("spectrum --points many", &["--points", "many"]),
        ("spectrum --wave-number 0.1,0", &["--wave-number", "0", "above 0"]),
        ("spectrum --wave-number -1", &["--wave-number", "-1"]),
        ("spectrum --wave-number 1,inf", &["--wave-number", "inf"]),
        ("spectrum --wave-number nan", &["--wave-number", "nan"]),
        ("spectrum --wave-number 1,,2", &["--wave-number", "not a number"]),
        ("surface", &["--points", "--grid", "--waves"]),
        ("surface --waves --grid 1,1,1", &["--waves", "--grid"]),
        ("surface --points - --grid 1,1,1", &["--points", "--grid"]),
        ("surface --waves --surface flat", &["surface = flat"]),
        ("surface --waves --instance -1", &["-1"]),
        ("surface --waves --depth 0", &["depth", "0"]),
        ("surface --waves --components 0", &["components", "0", "1 to 65536"]),
        ("surface --grid 2,2", &["--grid", "NX,NY,STEP"]),
        ("surface --grid 2,2.5,1", &["--grid", "2.5", "whole number"]),
        ("surface --grid 2,2,x", &["--grid", "x is not a number"]),
        ("surface --grid 0,2,1", &["--grid", "100000000 points"]),
        ("surface --grid 10001,10000,1", &["--grid", "100000000 points"]),
        ("surface --grid 10000000000,10000000000,1", &["--grid", "100000000 points"]),
        ("surface --grid 2,2,0", &["--grid", "above 0 m"]),
        ("surface --grid 2,2,nan", &["--grid", "above 0 m"]),
        ("surface --grid 2,2,inf", &["--grid", "1e9 m"]),
        ("surface --points no-such-file.csv", &["no-such-file.csv"]),
        ("surface --points -", &["column \"ix\" is unknown, expected x,y"]),
        ("scenario", &["FILE.toml"]),
        ("scenario no-such-file.toml", &["no-such-file.toml"]),
        ("scenario no-such-file.toml --threads 0", &["--threads", "0"]),
        ("scenario no-such-file.toml --threads 1025", &["--threads", "1025"]),
        ("brdf no-such-file.csv", &["no-such-file.csv"]),
        ("brdf a.csv b.csv", &["b.csv"]),
        ("brdf --ior 0.9", &["ior", "0.9"]),
    ] {
        let message = refuse(arguments, "ix,iy,iz,ox,oy,oz\n");
        for text in named {
            assert!(message.contains(text), "{arguments}: {message} does not name {text}");
        }
    }
}

#[test]
fn headers() {
    for (header, named) in [
        ("", "ix is missing"),
        ("ix,iy,iz,ox,oy", "oz is missing"),
        ("ix,iy,iz,ox,oy,oz,nx,nz", "ny is missing"),
        ("ix,iy,iz,ox,oy,oz,f", "\"f\" is unknown"),
        ("ix,iy,iz,ox,oy,oz,ix", "ix is there twice"),
        ("0,0,1,0,0,1", "header is missing"),
    ] {
        let message = refuse("brdf", &format!("{header}\n0,0,1,0,0,1\n"));
        let message = if header.is_empty() { refuse("brdf", "") } else { message };
        assert!(message.contains(named), "{header}: {message}");
    }
}

#[test]
fn rows() {
    for (row, named) in [
        ("0,0,1,0,0", "column oz is missing"),
        ("0,0,1,0,0,1,7", "\"7\" follows the last column, oz"),
        ("0,0,1,0,x,1", "oy = \"x\" is not a number"),
        ("0,,1,0,0,1", "iy = \"\" is not a number"),
        ("0,\"a\nb\",1,0,0,1", "iy = \"a b\" is not a number"),
        ("0,0,1,0,0,nan", "ox,oy,oz = (0, 0, NaN)"),
        ("0,0,inf,0,0,1", "ix,iy,iz = (0, 0, inf)"),
        ("0,0,1,0,0,1.001", "ox,oy,oz = (0, 0, 1.001)"),
    ] {
        for json in ["", "--json"] {
            // The good rows before and after it must not be written.
            let input = format!("ix,iy,iz,ox,oy,oz\n0,0,1,0,0,1\n{row}\n0,0,1,0,0,1\n");
            let message = refuse(&format!("brdf {json}"), &input);
            assert!(message.contains(&format!("row 2: {named}")), "{row}: {message}");
        }
    }
    let message = refuse("brdf", "ix,iy,iz,ox,oy,oz,nx,ny,nz\n0,0,1,0,0,1,0,0,-1\n");
    assert!(message.contains("row 1: nx,ny,nz = (0, 0, -1)"), "{message}");
}
