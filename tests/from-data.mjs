// The data of the gallery's group "From data", made by formulas: `node tests/from-data.mjs` writes
// them to www/examples. They are ours, and free to use.
import { writeFileSync } from 'node:fs';
import { deflateRawSync, crc32 } from 'node:zlib';

const folder = new URL('../www/examples/', import.meta.url);
const round = (x, digits) => String(+x.toFixed(digits));
const add = (a, b, t = 1) => a.map((x, i) => x + t * b[i]);
const unit = (a) => a.map((x) => x / Math.hypot(...a));
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
// Numbers from 0 to 1 that look random: the fractional part of n times the golden ratio, squared.
const noise = (n) => (n * n * 0.618033988749895) % 1;

// Turns a direction by an angle away from itself, towards an azimuth about itself.
function lean(way, angle, azimuth) {
  const x = unit(cross(way, Math.abs(way[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
  const y = cross(way, x);
  const aside = add(x.map((v) => v * Math.cos(azimuth)), y, Math.sin(azimuth));
  return unit(add(way.map((v) => v * Math.cos(angle)), aside, Math.sin(angle)));
}

// A neuron: a soma, and trunks that wind and fork in two; where a line of the radius r forks, both
// its children have r/2^(2/3) (Rall's power of 3/2).
function neuron() {
  const rows = ['# A neuron, made by a formula (tests/from-data.mjs): lengths in micrometres.', '1 1 0 0 0 7 -1'];
  let id = 1, n = 3;
  const grow = (parent, from, way, radius, type, level) => {
    let at = from;
    const steps = 4 + Math.floor(3 * noise(n++));
    for (let i = 0; i < steps; i += 1) {
      way = lean(way, 0.34 * noise(n++), 6.283 * noise(n++));
      at = add(at, way, 7 + 3 * noise(n++));
      rows.push([++id, type, ...at.map((x) => round(x, 1)), round(radius * (1 - 0.05 * i), 2), parent].join(' '));
      parent = id;
    }
    const azimuth = 6.283 * noise(n++);
    for (let side = 0; side < 2 && level < (type === 2 ? 2 : 3); side += 1) {
      grow(parent, at, lean(way, 0.55, azimuth + Math.PI * side), radius * 0.8 * 2 ** (-2 / 3), type, level + 1);
    }
  };
  for (let k = 0; k < 5; k += 1) {
    const way = unit([Math.cos(1.26 * k + 0.3), Math.sin(1.26 * k + 0.3) + 0.2, 0.7 * noise(k + 1) - 0.35]);
    grow(1, way.map((x) => 5 * x), way, 2.6, 3, 1);
  }
  grow(1, [0, -5, 0], [0.1, -1, 0.1], 1.4, 2, 1);
  return `${rows.join('\n')}\n`;
}

// A vessel tree: each branch forks into two whose radii obey Murray's law, r³ = a³ + b³, and which
// are twelve radii long.
function vessels() {
  const points = [], radii = [], lines = [];
  const point = (at, radius) => points.push(at) && radii.push(radius) && points.length - 1;
  const grow = (start, from, way, radius, level, n) => {
    const line = [start];
    let at = from;
    for (let i = 1; i <= 4; i += 1) {
      way = lean(way, 0.16, 2.4 * n + 1.1 * i);
      at = add(at, way, 3 * radius);
      line.push(point(at, radius));
    }
    lines.push(line);
    if (level === 5) return;
    const share = 0.5 + 0.22 * noise(n + 1);
    for (const [part, side, angle] of [[share, 0, 0.45], [1 - share, 1, 0.75]]) {
      const next = lean(way, angle, 2.1 * level + Math.PI * side);
      grow(line[4], at, next, radius * Math.cbrt(part), level + 1, 2 * n + side);
    }
  };
  grow(point([0, 0, 0], 3), [0, 0, 0], [0, 0, 1], 3, 1, 1);
  const array = (name, type, values, components = 1) =>
    `<DataArray type="${type}" Name="${name}" NumberOfComponents="${components}" format="ascii">${values.join(' ')}</DataArray>`;
  const ends = lines.map((sum => (line) => (sum += line.length))(0));
  return `<?xml version="1.0"?>
<!-- A vessel tree that obeys Murray's law, made by a formula (tests/from-data.mjs). -->
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian"><PolyData>
<Piece NumberOfPoints="${points.length}" NumberOfLines="${lines.length}">
<PointData>${array('MaximumInscribedSphereRadius', 'Float64', radii.map((r) => round(r, 3)))}</PointData>
<Points>${array('Points', 'Float64', points.flat().map((x) => round(x, 2)), 3)}</Points>
<Lines>${array('connectivity', 'Int64', lines.flat())}
${array('offsets', 'Int64', ends)}</Lines>
</Piece></PolyData></VTKFile>
`;
}

// A tree as a table of cylinders: the trunk and the branches bend upwards, and a branch that leaves
// at a share t of its parent is (1 − t)^(3/5) times as long.
function tree() {
  const rows = ['id,parent,start_x,start_y,start_z,end_x,end_y,end_z,radius'];
  let id = 0, n = 11;
  const grow = (parent, from, way, length, radius, level) => {
    const pieces = [9, 6, 3][level];
    let at = from, before = parent;
    for (let i = 0; i < pieces; i += 1) {
      way = unit(add(lean(way, 0.22 * noise(n++), 6.283 * noise(n++)), [0, 0, 0.1 * level]));
      const end = add(at, way, length / pieces);
      const own = radius * (1 - 0.85 * (i / pieces));
      rows.push([++id, before, ...at.map((x) => round(x, 2)), ...end.map((x) => round(x, 2)), round(own, 3)].join(','));
      before = id;
      const t = (i + 1) / pieces;
      if (t > 0.25 + 0.1 * level && t < 1) {
        for (let side = 0; side < 2 && level < 2; side += 1) {
          const out = lean(way, 1.15 - 0.4 * t, 2.4 * n++ + Math.PI * side);
          grow(before, end, out, [0.62, 0.45][level] * length * (1.1 - t) ** 0.6, 0.5 * own, level + 1);
        }
      }
      at = end;
    }
  };
  grow(0, [0, 0, 0], [0.05, 0, 1], 8.5, 0.3, 0);
  return `${rows.join('\n')}\n`;
}

// Dodecahedrane, C₂₀H₂₀: carbons at a regular dodecahedron's corners with bonds of 1.546 Å, each
// with a hydrogen 1.09 Å farther out.
function molecule() {
  const phi = (1 + Math.sqrt(5)) / 2;
  const corners = [];
  for (const a of [-1, 1]) for (const b of [-1, 1]) {
    for (const c of [-1, 1]) corners.push([a, b, c]);
    for (let k = 0; k < 3; k += 1) {
      const corner = [0, a / phi, b * phi];
      corners.push([0, 1, 2].map((i) => corner[(i + k) % 3]));
    }
  }
  // The edge of this dodecahedron is 2/φ long, its corners are √3 from the middle.
  const size = 1.546 * phi / 2, far = (size * Math.sqrt(3) + 1.09) / Math.sqrt(3);
  const line = (symbol, corner, by) => [symbol, ...corner.map((x) => (x * by).toFixed(4))].join(' ');
  return ['40', 'Dodecahedrane, C20H20, made by a formula (tests/from-data.mjs)',
    ...corners.map((c) => line('C', c, size)), ...corners.map((c) => line('H', c, far)), ''].join('\n');
}

// A lattice of body-centred cells in a sphere, whose beams are thick below and thin above.
function lattice() {
  const nodes = new Map(), points = [], beams = [];
  const node = (p) => {
    const key = p.join();
    if (!nodes.has(key)) nodes.set(key, points.push(p) - 1);
    return nodes.get(key);
  };
  const isIn = (p) => Math.hypot(...p) <= 23;
  for (let x = -20; x <= 20; x += 10) for (let y = -20; y <= 20; y += 10) for (let z = -20; z <= 20; z += 10) {
    const p = [x, y, z];
    for (const ways of [[[10, 0, 0], [0, 10, 0], [0, 0, 10]], [-5, 5].flatMap((a) => [-5, 5].flatMap((b) => [-5, 5].map((c) => [a, b, c])))]) {
      for (const way of ways) {
        const q = add(p, way);
        if (isIn(p) && isIn(q)) beams.push([node(p), node(q)]);
      }
    }
  }
  const radius = (i) => round(1.15 - 0.03 * points[i][2], 2);
  return `<?xml version="1.0"?>
<!-- A graded lattice in a sphere, made by a formula (tests/from-data.mjs). -->
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02" requiredextensions="b">
<resources><object id="1" type="model" name="lattice"><mesh><vertices>
${points.map(([x, y, z]) => `<vertex x="${x}" y="${y}" z="${z}"/>`).join('\n')}
</vertices><triangles/><b:beamlattice radius="1" minlength="0.01" cap="sphere"><b:beams>
${beams.map(([a, b]) => `<b:beam v1="${a}" v2="${b}" r1="${radius(a)}" r2="${radius(b)}"/>`).join('\n')}
</b:beams></b:beamlattice></mesh></object></resources>
<build><item objectid="1"/></build></model>
`;
}

// A zip archive of packed members, all of one day.
function zip(members) {
  const parts = [], entries = [];
  let at = 0;
  for (const [name, text] of members) {
    const content = Buffer.from(text), packed = deflateRawSync(content, { level: 9 });
    const fields = Buffer.alloc(26);
    fields.writeUInt16LE(20, 0);
    fields.writeUInt16LE(8, 4);
    fields.writeUInt16LE(0x5c21, 8);
    fields.writeUInt32LE(crc32(content), 10);
    fields.writeUInt32LE(packed.length, 14);
    fields.writeUInt32LE(content.length, 18);
    fields.writeUInt16LE(name.length, 22);
    const local = Buffer.concat([Buffer.from('PK\x03\x04'), fields, Buffer.from(name), packed]);
    const rest = Buffer.alloc(14);
    rest.writeUInt32LE(at, 10);
    entries.push(Buffer.concat([Buffer.from('PK\x01\x02\x14\0'), fields, rest, Buffer.from(name)]));
    parts.push(local);
    at += local.length;
  }
  const list = Buffer.concat(entries), end = Buffer.alloc(18);
  end.writeUInt16LE(entries.length, 4);
  end.writeUInt16LE(entries.length, 6);
  end.writeUInt32LE(list.length, 8);
  end.writeUInt32LE(at, 12);
  return Buffer.concat([...parts, list, Buffer.from('PK\x05\x06'), end]);
}

const TYPES = `<?xml version="1.0"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
`;
const RELATIONS = `<?xml version="1.0"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r0" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
`;

for (const [name, content] of [
  ['neuron.swc', neuron()],
  ['vessels.vtp', vessels()],
  ['tree.csv', tree()],
  ['dodecahedrane.xyz', molecule()],
  ['lattice.3mf', zip([['[Content_Types].xml', TYPES], ['_rels/.rels', RELATIONS], ['3D/3dmodel.model', lattice()]])],
]) writeFileSync(new URL(name, folder), content);
