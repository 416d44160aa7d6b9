//! Polygonal data of VTK, in all the ways that it is written.

use crate::common::{check, drawing, graph, message, remarks, with};
use limbs::{Graph, Reading};
use std::fmt::Write as _;

/// A trunk that is listed for each of two outlets: points with radii, and lines.
const POINTS: [[f64; 4]; 8] = [
    [0.0, 0.0, 0.0, 1.0],
    [0.0, 0.0, 2.0, 0.875],
    [0.0, 0.5, 4.0, 0.75],
    [1.0, 0.5, 6.0, 0.5],
    [0.0, 0.0, 0.0, 1.0],
    [0.0, 0.0, 2.0, 0.875],
    [0.0, 0.5, 4.0, 0.75],
    [-1.0, 0.5, 6.0, 0.25],
];
const LINES: [&[i64]; 2] = [&[0, 1, 2, 3], &[4, 5, 6, 7]];
const RADII: &str = "MaximumInscribedSphereRadius";

/// Way in which arrays are written.
#[derive(Clone, Copy, Debug)]
struct Coding {
    format: &'static str,
    is_raw: bool,
    is_packed: bool,
    is_long: bool,
    big_endian: bool,
    is_double: bool,
    /// Whether lengths are encoded apart from what follows.
    is_apart: bool,
}

fn base64(bytes: &[u8]) -> String {
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let word = (0..3).fold(0, |word, i| {
            word << 8 | u32::from(*chunk.get(i).unwrap_or(&0))
        });
        for i in 0..4 {
            match i <= chunk.len() {
                true => text.push(char::from(letters[(word >> (18 - 6 * i) & 63) as usize])),
                false => text.push('='),
            }
        }
    }
    text
}

impl Coding {
    fn word(self, bytes: &[u8]) -> Vec<u8> {
        let mut bytes = bytes.to_vec();
        if self.big_endian {
            bytes.reverse();
        }
        bytes
    }

    fn length(self, length: usize) -> Vec<u8> {
        match self.is_long {
            true => self.word(&(length as u64).to_le_bytes()),
            false => self.word(&(length as u32).to_le_bytes()),
        }
    }

    fn float(self, x: f64) -> Vec<u8> {
        match self.is_double {
            true => self.word(&x.to_le_bytes()),
            false => self.word(&(x as f32).to_le_bytes()),
        }
    }

    /// Encodes the bytes of an array's numbers. Packed ones are in blocks of 40 bytes.
    fn encode(self, bytes: &[u8]) -> Vec<u8> {
        let (mut head, mut data) = (Vec::new(), Vec::new());
        if self.is_packed {
            let blocks: Vec<&[u8]> = bytes.chunks(40).collect();
            let last = bytes.len() % 40;
            for length in [blocks.len(), 40, last] {
                head.extend(self.length(length));
            }
            for block in blocks {
                let packed = miniz_oxide::deflate::compress_to_vec_zlib(block, 6);
                head.extend(self.length(packed.len()));
                data.extend(packed);
            }
        } else {
            head.extend(self.length(bytes.len()));
            data.extend(bytes);
        }
        if self.is_raw {
            head.extend(data);
            return head;
        }
        if self.is_apart {
            return (base64(&head) + &base64(&data)).into_bytes();
        }
        head.extend(data);
        base64(&head).into_bytes()
    }

    /// Writes the whole file.
    fn file(self) -> Vec<u8> {
        let float = if self.is_double { "Float64" } else { "Float32" };
        let points: Vec<f64> = POINTS.iter().flat_map(|p| p[..3].to_vec()).collect();
        let radii: Vec<f64> = POINTS.iter().map(|p| p[3]).collect();
        let corners: Vec<i64> = LINES.concat();
        let arrays = [
            (
                "<PointData>",
                "Label",
                "UInt8",
                1,
                vec![7.0; 8],
                "</PointData>",
            ),
            (
                "<PointData Scalars=\"x\">",
                RADII,
                float,
                1,
                radii,
                "</PointData>",
            ),
            ("<Points>", "Points", float, 3, points, "</Points>"),
            (
                "<Lines>",
                "connectivity",
                "Int64",
                1,
                corners.iter().map(|i| *i as f64).collect(),
                "",
            ),
            ("", "offsets", "Int32", 1, vec![4.0, 8.0], "</Lines>"),
        ];
        let mut text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\" \
             header_type=\"{}\"{}>\n<PolyData>\n<Piece NumberOfPoints=\"8\" NumberOfVerts=\"0\" \
             NumberOfLines=\"2\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
            if self.big_endian {
                "BigEndian"
            } else {
                "LittleEndian"
            },
            if self.is_long { "UInt64" } else { "UInt32" },
            if self.is_packed {
                " compressor=\"vtkZLibDataCompressor\""
            } else {
                ""
            },
        );
        let mut appended = Vec::new();
        for (before, name, kind, size, values, after) in arrays {
            let bytes: Vec<u8> = values
                .iter()
                .flat_map(|x| match kind {
                    "UInt8" => vec![*x as u8],
                    "Int32" => self.word(&(*x as i32).to_le_bytes()),
                    "Int64" => self.word(&(*x as i64).to_le_bytes()),
                    _ => self.float(*x),
                })
                .collect();
            let content = match self.format {
                "ascii" => values.iter().map(|x| format!(" {x}\n")).collect(),
                "binary" => format!("\n  {}\n", String::from_utf8(self.encode(&bytes)).unwrap()),
                _ => String::new(),
            };
            let _ = writeln!(
                text,
                "{before}<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{size}\" \
                 format=\"{}\" offset=\"{}\">{content}</DataArray>{after}",
                self.format,
                appended.len()
            );
            if self.format == "appended" {
                appended.extend(self.encode(&bytes));
            }
        }
        text += "</Piece>\n</PolyData>\n";
        let mut file = text.into_bytes();
        if self.format == "appended" {
            let encoding = if self.is_raw { "raw" } else { "base64" };
            file.extend(format!("<AppendedData encoding=\"{encoding}\">\n _").bytes());
            file.extend(appended);
            file.extend(b"\n</AppendedData>\n");
        }
        file.extend(b"</VTKFile>\n");
        file
    }
}

const ASCII: Coding = Coding {
    format: "ascii",
    is_raw: false,
    is_packed: false,
    is_long: false,
    big_endian: false,
    is_double: true,
    is_apart: true,
};

fn check_trunk(graph: &Graph) {
    check(graph);
    assert_eq!((graph.nodes.len(), graph.limbs.len()), (5, 4));
    assert_eq!(graph.facts().free_ends, 3);
    let drawing = drawing(graph);
    assert_eq!(drawing[0], [[-1.0, 0.5, 6.0, 0.25], [0.0, 0.5, 4.0, 0.75]]);
    assert_eq!(drawing[1], [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 2.0, 0.875]]);
    assert!(remarks(graph)[0].starts_with("2 limbs are listed more than once"));
}

#[test]
fn all_codings_of_xml_mean_the_same() {
    check_trunk(&graph("a.vtp", ASCII.file()));
    for bits in 0..64 {
        let [
            is_packed,
            is_long,
            big_endian,
            is_double,
            is_apart,
            appended,
        ] = [0, 1, 2, 3, 4, 5].map(|bit| bits >> bit & 1 == 1);
        for is_raw in [false, true] {
            if is_raw && !appended {
                continue;
            }
            let coding = Coding {
                format: if appended { "appended" } else { "binary" },
                is_raw,
                is_packed,
                is_long,
                big_endian,
                is_double,
                is_apart,
            };
            let read = limbs::read("a.vtp", &coding.file(), &Reading::default());
            match read {
                Ok(Some(graph)) => check_trunk(&graph),
                other => panic!("{coding:?}: {other:?}"),
            }
        }
    }
}

/// Puts values of a legacy file behind their heading.
fn put(is_text: bool, file: &mut Vec<u8>, heading: &str, values: &[f64], kind: &str) {
    file.extend(heading.bytes());
    file.push(b'\n');
    for value in values {
        match (is_text, kind) {
            (true, _) => file.extend(format!("{value} ").bytes()),
            (false, "int") => file.extend((*value as i32).to_be_bytes()),
            (false, "vtktypeint64") => file.extend((*value as i64).to_be_bytes()),
            (false, "double") => file.extend(value.to_be_bytes()),
            (false, _) => file.extend((*value as f32).to_be_bytes()),
        }
    }
    file.push(b'\n');
}

/// Writes a legacy file.
fn legacy(is_text: bool, version: u32) -> Vec<u8> {
    let kind = if is_text { "ASCII" } else { "BINARY" };
    let mut file =
        format!("# vtk DataFile Version {version}.0\nmade up\n{kind}\nDATASET POLYDATA\n")
            .into_bytes();
    let points: Vec<f64> = POINTS.iter().flat_map(|p| p[..3].to_vec()).collect();
    put(is_text, &mut file, "POINTS 8 double", &points, "double");
    file.extend(b"METADATA\nINFORMATION 1\nNAME L2 LOCATION x\nDATA 2 0 1\n\n");
    let corners: Vec<f64> = LINES.concat().iter().map(|i| *i as f64).collect();
    if version == 5 {
        file.extend(b"LINES 3 8\n");
        put(
            is_text,
            &mut file,
            "OFFSETS vtktypeint64",
            &[0.0, 4.0, 8.0],
            "vtktypeint64",
        );
        put(
            is_text,
            &mut file,
            "CONNECTIVITY vtktypeint64",
            &corners,
            "vtktypeint64",
        );
    } else {
        let cells: Vec<f64> = LINES
            .iter()
            .flat_map(|line| std::iter::once(4.0).chain(line.iter().map(|i| *i as f64)))
            .collect();
        put(is_text, &mut file, "LINES 2 10", &cells, "int");
    }
    put(
        is_text,
        &mut file,
        "CELL_DATA 2\nSCALARS which int 1\nLOOKUP_TABLE default",
        &[0.0, 1.0],
        "int",
    );
    file.extend(b"POINT_DATA 8\n");
    put(is_text, &mut file, "NORMALS n float", &[0.0; 24], "float");
    file.extend(b"FIELD FieldData 2\n");
    put(
        is_text,
        &mut file,
        "Abscissas 1 8 float",
        &[0.5; 8],
        "float",
    );
    let radii: Vec<f64> = POINTS.iter().map(|p| p[3]).collect();
    put(
        is_text,
        &mut file,
        &format!("{RADII} 1 8 double"),
        &radii,
        "double",
    );
    file
}

#[test]
fn legacy_files_mean_the_same() {
    for is_text in [true, false] {
        for version in [2, 3, 5] {
            check_trunk(&graph("a.vtk", legacy(is_text, version)));
        }
    }
    let text = String::from_utf8(legacy(true, 3)).unwrap();
    for (from, to, told) in [
        ("POINTS 8", "POINTS 9", "line 7: `METADATA` is no number"),
        (
            "POINTS 8",
            "POINTS 99999999",
            "99999999 points; 2000000 are the limit",
        ),
        ("0.5 4", "0.5 four", "line 6: `four` is no number"),
        (
            "LINES 2 10",
            "LINES 2 9",
            "these cells have not as many corners as they say",
        ),
        ("4 4 5 6 7", "4 4 5 6 77", "has point 77 (from 0) of 8"),
        ("4 4 5 6 7", "4 4 5 6 -7", "has point -7 (from 0) of 8"),
        ("ASCII", "TEXT", "line 3: `ASCII` or `BINARY`"),
        (
            "POLYDATA",
            "UNSTRUCTURED_GRID",
            "line 4: only `DATASET POLYDATA`",
        ),
        ("LINES 2 10", "POLYGONS 2 10", "has no lines"),
        ("# vtk", "# abc", "is no VTK file"),
        (
            "POINTS 8 double",
            "POINTS 8 real",
            "line 5: `real` is no type",
        ),
    ] {
        let broken = text.replacen(from, to, 1);
        assert_ne!(broken, text, "{from}");
        let message = message("a.vtk", broken);
        assert!(message.contains(told), "{to}: {message}");
    }
    let binary = legacy(false, 3);
    for end in 1..binary.len() - 64 {
        let read = limbs::read("a.vtk", &binary[..end], &Reading::default());
        assert!(read.is_err(), "{end}");
    }
    assert!(message("a.vtk", &binary[..200]).contains("cut off"));
}

#[test]
fn radii_are_found_by_usual_names_or_the_one_given() {
    let text = String::from_utf8(ASCII.file()).unwrap();
    for (name, factor) in [
        ("Radius", 1.0),
        ("vessel_radius", 1.0),
        ("pore.diameter", 0.5),
    ] {
        let graph = graph("a.vtp", text.replace(RADII, name));
        assert_eq!(drawing(&graph)[1][0][3], factor, "{name}");
    }
    let odd = text.replace(RADII, "Thick");
    assert!(message("a.vtp", &odd).contains("no radii above 0"));
    let reading = Reading {
        radii: Some("thick"),
        ..Reading::default()
    };
    check_trunk(&with("a.vtp", &odd, reading));
    let told = limbs::read("a.vtp", text.as_bytes(), &reading)
        .unwrap_err()
        .to_string();
    assert!(told.ends_with(&format!("are `Label`, `{RADII}`")), "{told}");
}

#[test]
fn faults_are_told() {
    let good = String::from_utf8(ASCII.file()).unwrap();
    for (from, to, told) in [
        (" 4\n", " four\n", "`four` is no number"),
        (" 7\n</DataArray></", " 70\n</DataArray></", "has no lines"),
        ("NumberOfPoints=\"8\"", "NumberOfPoints=\"6\"", "of 6"),
        (
            "NumberOfPoints=\"8\"",
            "NumberOfPoints=\"800000000\"",
            "2000000 are the limit",
        ),
        ("format=\"ascii\"", "format=\"hex\"", "`hex` is no format"),
        ("type=\"PolyData\"", "type=\"ImageData\"", "is no VTP file"),
        ("Points>", "Pts>", "of 0"),
        ("<PolyData>", "<!DOCTYPE x><PolyData>", "document type"),
        (
            "header_type",
            "compressor=\"vtkLZ4DataCompressor\" header_type",
            "`vtkLZ4DataCompressor` is not read",
        ),
    ] {
        let broken = match from {
            " 7\n</DataArray></" => good.replace("Lines>", "Polys>"),
            _ => good.replace(from, to),
        };
        assert_ne!(broken, good, "{from}");
        let message = message("a.vtp", broken);
        assert!(message.contains(told), "{to}: {message}");
    }
    for format in ["ascii", "binary", "appended"] {
        for is_packed in [false, true] {
            let coding = Coding {
                format,
                is_packed,
                ..ASCII
            };
            let whole = coding.file();
            for share in 1..20 {
                let part = &whole[..whole.len() * share / 20];
                let read = limbs::read("a.vtp", part, &Reading::default());
                // Of the last twentieth the file could do without most.
                assert!(read.is_err() || share >= 19, "{coding:?} {share}");
            }
        }
    }
    // Blocks that unpack to far more than they say, and lengths beyond everything.
    let bomb = miniz_oxide::deflate::compress_to_vec_zlib(&vec![0; 1 << 20], 9);
    for lengths in [
        [1, 40, 0, bomb.len() as u32],
        [1, u32::MAX, u32::MAX, bomb.len() as u32],
        [u32::MAX, u32::MAX, 0, 4],
        [1, 40, 0, u32::MAX],
    ] {
        let mut bytes: Vec<u8> = lengths.iter().flat_map(|n| n.to_le_bytes()).collect();
        bytes.extend(&bomb);
        let file = good
            .replace(
                "header_type",
                "compressor=\"vtkZLibDataCompressor\" header_type",
            )
            .replacen("format=\"ascii\"", "format=\"binary\"", 2)
            .replacen(" 1\n", &base64(&bytes), 1);
        let told = message("a.vtp", file);
        assert!(told.starts_with("line "), "{told}");
    }
}
