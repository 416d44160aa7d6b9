//! Random changes of good files: no reader panics or hangs, and what is read keeps the promises of
//! a graph.

use crate::common::check;
use limbs::{Reading, read};
use std::time::Duration;
use trials::arbitrary::{Result, Unstructured};
use trials::{WorkClock, trials};

/// Far above what small files may take on a slow machine.
const PATIENCE: Duration = Duration::from_secs(5);

const FILES: [(&str, &str); 8] = [
    (
        "a.swc",
        "# a\n1 1 0 0 0 5 -1\n2 3 0 8 0 1.5 1\n3 3 0 20 0 1 2\n4 2 0 -8 0 1 1\n",
    ),
    (
        "a.obj",
        "# vt: radius\nvt 0.5\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nl 1/1 2/1 -1/1 1/1\n",
    ),
    (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty \
         float \
         z\nproperty float radius\nelement edge 2\nproperty int vertex1\nproperty int \
         vertex2\nend_header\n0 0 0 .1\n1 0 0 .1\n1 1 0 .1\n0 1\n1 2\n",
    ),
    (
        "a.csv",
        "id,parent,startX,startY,startZ,endX,endY,endZ,radius\n1,0,0,0,0,0,0,1,.2\n\
         2,1,0,0,1,1,0,2,.1\n",
    ),
    ("a.xyz", "2\n\nC 0 0 0\nO 1.2 0 0\n"),
    (
        "a.pdb",
        "ATOM      1  CA  GLY A   1      10.000   0.000   0.000  1.00  0.00           C\nCONECT  \
           1    2\n",
    ),
    (
        "a.vtk",
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 1 \
         1\nLINES 1 3\n2 0 \
         1\nPOINT_DATA 2\nSCALARS radius float 1\nLOOKUP_TABLE default\n1 1\n",
    ),
    (
        "a.vtp",
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"2\"><PointData><DataArray \
         type=\"Float32\" Name=\"radius\">1 2</DataArray></PointData><Points><DataArray \
         type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 1 \
          1</DataArray></Points><Lines><DataArray \
         type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1</DataArray><DataArray \
          type=\"Int64\" \
         Name=\"offsets\" format=\"binary\">CAAAAAIAAAAAAAAA</DataArray></Lines></Piece></PolyData>\
         </VTKFile>",
    ),
];

fn look(name: &str, bytes: &[u8]) {
    let begin = WorkClock::start();
    let reading = Reading {
        radius: Some(1.0),
        radii: None,
        bonds: true,
    };
    match read(name, bytes, &reading) {
        Ok(Some(mut graph)) => {
            check(&graph);
            for written in [
                graph.write_obj(),
                graph.write_swc(),
                graph.write_block("s", "N", &[]),
            ] {
                assert!(!written.text.is_empty());
            }
            graph.simplify(0.1);
            check(&graph);
            if graph.merge(0.5).is_ok() && !graph.nodes.is_empty() {
                check(&graph);
            }
        }
        Ok(None) => {}
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    assert!(begin.elapsed() < PATIENCE, "{name}: {:?}", begin.elapsed());
}

/// Returns a good file with some bytes changed, pieces cut out or put in twice.
fn change(file: &[u8], u: &mut Unstructured<'_>) -> Result<Vec<u8>> {
    let mut bytes = file.to_vec();
    for _ in 0..u.int_in_range(1..=6)? {
        if bytes.is_empty() {
            break;
        }
        let at = u.choose_index(bytes.len())?;
        let end = (at + u.int_in_range(1..=30)?).min(bytes.len());
        match u.int_in_range(0..=4)? {
            0 => bytes[at] = u.arbitrary()?,
            1 => bytes[at] = *u.choose(b"0123456789-.eE \n\t#,;<>\"/\\=NaN")?,
            2 => drop(bytes.drain(at..end)),
            3 => {
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            _ => bytes.truncate(end),
        }
    }
    Ok(bytes)
}

#[test]
fn readers_survive_anything() {
    trials(|u| {
        for (name, file) in FILES {
            look(name, &change(file.as_bytes(), u)?);
        }
        Ok(())
    })
    .cases(600);
}

#[test]
fn packages_survive_anything() {
    let xml = "<model unit=\"inch\"><resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" \
     y=\"0\" \
               z=\"0\"/><vertex x=\"5\" y=\"0\" z=\"0\"/></vertices><b:beamlattice radius=\"1\" \
               clippingmode=\"inside\" clippingmesh=\"1\"><b:beams><b:beam v1=\"0\" v2=\"1\" \
                r1=\"2\"/>\
               </b:beams><b:balls><b:ball vindex=\"0\"/></b:balls></b:beamlattice></mesh></object>\
               <object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 \
                0 1 0 0 \
               0\"/></components></object></resources><build><item \
                objectid=\"2\"/></build></model>";
    trials(|u| {
        let xml = change(xml.as_bytes(), u)?;
        let description = archive::Member {
            packed: true,
            ..archive::Member::new("3D/3dmodel.model", &xml)
        };
        look("a.3mf", &archive::write(&[description]).unwrap());
        Ok(())
    })
    .cases(600);
    for (name, file) in FILES {
        assert!(
            read(
                name,
                file.as_bytes(),
                &Reading {
                    radius: Some(1.0),
                    ..Reading::default()
                }
            )
            .is_ok(),
            "{name}"
        );
    }
}
