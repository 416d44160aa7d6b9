//! Small model, written in every format.

use glam::DVec3;

pub struct Model {
    pub positions: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub triangles: Vec<[usize; 3]>,
}

/// Returns a tetrahedron about the origin, seen counter-clockwise from outside; its numbers are
/// exact in every format.
pub fn tetrahedron() -> Model {
    let positions = [
        [1.0, 1.0, 1.5],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let positions: Vec<DVec3> = positions.map(DVec3::from).to_vec();
    Model {
        normals: positions.iter().map(|p| p.normalize()).collect(),
        positions,
        triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
    }
}

fn floats(values: impl IntoIterator<Item = DVec3>) -> Vec<u8> {
    let numbers = values.into_iter().flat_map(|v| v.to_array());
    numbers.flat_map(|x| (x as f32).to_le_bytes()).collect()
}

impl Model {
    pub fn obj(&self, with_normals: bool) -> Vec<u8> {
        let mut text = String::from("# four faces\nmtllib none.mtl\n");
        for p in &self.positions {
            text += &format!("v {} {} {}\n", p.x, p.y, p.z);
        }
        for n in &self.normals {
            text += &format!("vn {} {} {}\n", n.x, n.y, n.z);
        }
        for t in &self.triangles {
            text += &format!(
                "f{}\n",
                t.iter()
                    .map(|i| match with_normals {
                        true => format!(" {}//{}", i + 1, i + 1),
                        false => format!(" {}", i + 1),
                    })
                    .collect::<String>()
            );
        }
        text.into_bytes()
    }

    pub fn ascii_stl(&self) -> Vec<u8> {
        let mut text = String::from("solid a vertex in its name\n");
        for t in &self.triangles {
            text += " facet normal 0 0 0\n  outer loop\n";
            for i in t {
                let p = self.positions[*i];
                text += &format!("   vertex {:e} {} {}\n", p.x, p.y, p.z);
            }
            text += "  endloop\n endfacet\n";
        }
        (text + "endsolid\n").into_bytes()
    }

    pub fn binary_stl(&self) -> Vec<u8> {
        // Some programs begin binary files like text.
        let mut bytes = b"solid but binary".to_vec();
        bytes.resize(80, b' ');
        bytes.extend((self.triangles.len() as u32).to_le_bytes());
        for t in &self.triangles {
            bytes.extend(floats([DVec3::ZERO]));
            bytes.extend(floats(t.map(|i| self.positions[i])));
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn ply_heading(&self, format: &str) -> String {
        format!(
            "ply\nformat {format} 1.0\ncomment by hand\nelement vertex {}\n\
             property uchar shade\nproperty float x\nproperty double y\nproperty float z\n\
             property float nx\nproperty float ny\nproperty float nz\nelement other 1\n\
             property list uchar short what\nelement face {}\n\
             property list uchar int vertex_indices\nproperty short part\nend_header\n",
            self.positions.len(),
            self.triangles.len()
        )
    }

    pub fn ascii_ply(&self) -> Vec<u8> {
        let mut text = self.ply_heading("ascii");
        for (p, n) in self.positions.iter().zip(&self.normals) {
            text += &format!("7 {} {} {} {} {} {}\n", p.x, p.y, p.z, n.x, n.y, n.z);
        }
        text += "2 -5 6\n";
        for [a, b, c] in &self.triangles {
            text += &format!("3 {a} {b} {c} 1\n");
        }
        text.into_bytes()
    }

    /// Returns a GLB file with these nodes, of which the first is the scene's, and more fields.
    pub fn glb_with(&self, nodes: &str, more: &str) -> Vec<u8> {
        let mut numbers: Vec<u8> = Vec::new();
        // Positions and normals are interleaved.
        for (p, n) in self.positions.iter().zip(&self.normals) {
            numbers.extend(floats([*p, *n]));
        }
        let vertices = numbers.len();
        let indices = self.triangles.iter().flatten();
        numbers.extend(indices.flat_map(|i| (*i as u16).to_le_bytes()));
        let (size, count) = (numbers.len(), self.positions.len());
        // Several nodes without a parent are the scene's all.
        let scene = match nodes.matches("children").count() {
            0 => "",
            _ => r#""scenes":[{"nodes":[0]}],"scene":0,"#,
        };
        let mut json = format!(
            r#"{{"asset":{{"version":"2.0"}},{more}{scene}"nodes":{nodes},
            "meshes":[{{"primitives":[
                {{"attributes":{{"POSITION":0,"NORMAL":1}},"indices":2}},
                {{"attributes":{{"POSITION":0}},"mode":1}}]}}],
            "accessors":[
                {{"bufferView":0,"componentType":5126,"count":{count},"type":"VEC3"}},
                {{"bufferView":0,"byteOffset":12,"componentType":5126,"count":{count},
                "type":"VEC3"}},
                {{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}}],
            "bufferViews":[
                {{"buffer":0,"byteOffset":0,"byteLength":{vertices},"byteStride":24}},
                {{"buffer":0,"byteOffset":{vertices},"byteLength":{}}}],
            "buffers":[{{"byteLength":{size}}}]}}"#,
            3 * self.triangles.len(),
            size - vertices
        );
        while !json.len().is_multiple_of(4) {
            json.push(' ');
        }
        while !numbers.len().is_multiple_of(4) {
            numbers.push(0);
        }
        let mut bytes = b"glTF".to_vec();
        let whole = 12 + 8 + json.len() + 8 + numbers.len();
        for word in [2, whole as u32, json.len() as u32] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(b"JSON");
        bytes.extend(json.into_bytes());
        bytes.extend((numbers.len() as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(numbers);
        bytes
    }
}

pub fn glb(model: &Model) -> Vec<u8> {
    model.glb_with(r#"[{"mesh":0}]"#, "")
}

pub fn binary_ply(model: &Model, big_endian: bool) -> Vec<u8> {
    let format = match big_endian {
        true => "binary_big_endian",
        false => "binary_little_endian",
    };
    let mut bytes = model.ply_heading(format).into_bytes();
    let mut add = |word: &[u8]| {
        let mut word = word.to_vec();
        if big_endian {
            word.reverse();
        }
        bytes.extend(word);
    };
    for (p, n) in model.positions.iter().zip(&model.normals) {
        add(&[7]);
        add(&(p.x as f32).to_le_bytes());
        add(&p.y.to_le_bytes());
        for x in [p.z, n.x, n.y, n.z] {
            add(&(x as f32).to_le_bytes());
        }
    }
    add(&[2]);
    add(&(-5i16).to_le_bytes());
    add(&6i16.to_le_bytes());
    for t in &model.triangles {
        add(&[3]);
        for i in t {
            add(&(*i as i32).to_le_bytes());
        }
        add(&1i16.to_le_bytes());
    }
    bytes
}

pub fn png_of(
    width: u32,
    height: u32,
    colour: png::ColorType,
    depth: png::BitDepth,
    data: &[u8],
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().expect("a heading");
    writer.write_image_data(data).expect("as many bytes");
    writer.finish().expect("an end");
    bytes
}
