//! Molecules in XYZ and PDB files.

use crate::common::{check, graph, message, remarks, with};
use limbs::Reading;

const WATER: &str = "3\nwater\nO 0.0 0.0 0.1173\nH 0.0 0.7572 -0.4692\n1 0.0 -0.7572 -0.4692\n";

const BONDS: Reading<'_> = Reading {
    radius: None,
    radii: None,
    bonds: true,
};

#[test]
fn atoms_are_balls_of_their_elements() {
    let water = graph("w.xyz", WATER);
    check(&water);
    assert_eq!((water.nodes.len(), water.limbs.len()), (3, 0));
    assert!(water.nodes.iter().all(|node| node.is_ball));
    // Bondi's radii.
    assert_eq!([0, 1, 2].map(|i| water.nodes[i].radius), [1.52, 1.2, 1.2]);
    let oxygen = &water.groups[water.nodes[0].group as usize];
    assert_eq!(oxygen.name, "O");
    let [r, g, b] = oxygen.color.unwrap();
    assert!(r == 1.0 && g < 0.01 && b < 0.01, "oxygen is red");
    assert_eq!(water.nodes[1].group, water.nodes[2].group);
    assert_eq!(water.millimetres, Some(1e-7));
    let bound = with("w.xyz", WATER, BONDS);
    check(&bound);
    assert_eq!(
        bound.limbs.len(),
        2,
        "the hydrogens are too far from each other"
    );
}

#[test]
fn points_are_no_molecule() {
    for points in [
        "0 1 2\n3 4 5\n",
        "3\ncomment\n0 1 2\n3 4 5\n6 7 8\n",
        "# x y z\n1 2 3\n",
        "",
    ] {
        let none = limbs::read("a.xyz", points.as_bytes(), &Reading::default());
        assert_eq!(none.unwrap(), None, "{points:?}");
    }
    assert!(message("w.xyz", WATER.replace("3\nw", "4\nw")).contains("has 3"));
    assert!(message("w.xyz", WATER.replace("H ", "Qq ")).starts_with("line 4: `Qq` is no symbol"));
    assert!(message("w.xyz", WATER.replace("0.7572", "nan")).starts_with("line 4:"));
    let frames = format!("{WATER}{WATER}");
    let first = graph("w.xyz", frames);
    assert_eq!(first.nodes.len(), 3);
    assert!(remarks(&first)[0].starts_with("line 6: the frames behind"));
}

/// A calcium ion, an alpha carbon, its hydrogen, an atom in two places, a second model.
const PDB: &str = "\
HEADER    MADE UP\n\
MODEL        1\n\
ATOM      1  CA  GLY A   1      10.000   0.000   0.000  1.00  0.00           C\n\
ATOM      2 HA11 GLY A   1      11.090   0.000   0.000  1.00  0.00\n\
ATOM      3  N  AGLY A   1       9.000   1.000   0.000  0.50  0.00\n\
ATOM      4  N  BGLY A   1       9.000   1.200   0.000  0.50  0.00\n\
HETATM    5 CA    CA A   2      20.000   0.000   0.000  1.00  0.00\n\
HETATM    6 CL    CL A   3      26.000   0.000   0.000  1.00  0.00\n\
CONECT    5    6\n\
ENDMDL\n\
MODEL        2\n\
ATOM      1  CA  GLY A   1      50.000   0.000   0.000  1.00  0.00           C\n\
ENDMDL\nEND\n";

#[test]
fn pdb_files_are_read_by_columns() {
    let graph = graph("m.pdb", PDB);
    check(&graph);
    let names: Vec<&str> = graph
        .nodes
        .iter()
        .map(|node| &graph.groups[node.group as usize].name[..])
        .collect();
    assert_eq!(names, ["C", "H", "N", "Ca", "Cl"]);
    assert_eq!(
        remarks(&graph),
        ["1 atoms at alternative places are left out"]
    );
    let bound = with("m.pdb", PDB, BONDS);
    let pairs: Vec<[u32; 2]> = bound.limbs.iter().map(|limb| limb.ends).collect();
    assert_eq!(
        pairs,
        [[0, 1], [0, 2], [3, 4]],
        "two by distance, one by `CONECT`"
    );
    let broken = PDB.replace("  20.000", "  2O.000");
    let told = message("m.pdb", broken);
    assert!(
        told.starts_with("line 7: columns 31 to 38: `x` is `2O.000`"),
        "{told}"
    );
    assert!(message("m.pdb", "HEADER\n").contains("no lines `ATOM`"));
}

#[test]
fn every_element_is_found() {
    let symbols = "H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca Sc Ti V Cr Mn Fe Co Ni Cu \
     Zn Ga \
                   Ge As Se Br Kr Rb Sr Y Zr Nb Mo Tc Ru Rh Pd Ag Cd In Sn Sb Te I Xe Cs Ba";
    let mut text = String::from("56\n\n");
    for (symbol, i) in symbols.split(' ').zip(0..) {
        text += &format!("{} {} 0 0\n", symbol.to_lowercase(), 10 * i);
    }
    let graph = graph("a.xyz", &text);
    for (node, symbol) in graph.nodes.iter().zip(symbols.split(' ')) {
        assert_eq!(graph.groups[node.group as usize].name, symbol);
        assert!((1.0..4.0).contains(&node.radius));
    }
    assert!(remarks(&graph)[0].contains("without a known radius"));
}
