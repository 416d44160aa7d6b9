//! Tables of a tree's cylinders.

use crate::common::{check, drawing, graph, message, remarks};

/// A trunk of two cylinders, a branch from the middle of the second's side, a twig on its end.
const ROWS: [[f64; 9]; 4] = [
    // id, parent, start, end, radius
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.3],
    [2.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 4.0, 0.25],
    [3.0, 2.0, 0.2, 0.0, 3.0, 1.2, 0.0, 3.0, 0.1],
    [4.0, 3.0, 1.2, 0.0, 3.0, 2.2, 1.0, 3.0, 0.05],
];

/// Writes the rows with an axis and a length in place of an end, if asked for.
fn table(heading: &str, delimiter: &str, order: &[usize], by_axis: bool) -> String {
    let mut text = format!("{heading}\n");
    for row in ROWS {
        let mut row = row.to_vec();
        let axis: Vec<f64> = (0..3).map(|i| row[5 + i] - row[2 + i]).collect();
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        row.push(length);
        if by_axis {
            for i in 0..3 {
                row[5 + i] = axis[i] / length;
            }
        }
        let cells: Vec<String> = order.iter().map(|i| row[*i].to_string()).collect();
        text += &format!("{}\n", cells.join(delimiter));
    }
    text
}

#[test]
fn the_spellings_of_four_programs_mean_the_same() {
    let tables = [
        // TreeQSM's text, with three columns under one name.
        table(
            "radius (m),length (m),start_point,,,axis_direction,,,parent,extension",
            ",",
            &[8, 9, 2, 3, 4, 5, 6, 7, 1, 0],
            true,
        ),
        table(
            "radius\tlength\tstart_x\tstart_y\tstart_z\taxis_x\taxis_y\taxis_z\tparent",
            "\t",
            &[8, 9, 2, 3, 4, 5, 6, 7, 1],
            true,
        ),
        // SimpleForest.
        table(
            "ID, parentID, startX, startY, startZ, endX, endY, endZ, radius, length",
            ", ",
            &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9],
            false,
        ),
        // aRchi.
        table(
            "\"startX\";\"startY\";\"startZ\";\"endX\";\"endY\";\"endZ\";\"cyl_ID\";\
             \"parent_ID\";\"radius_cyl\"",
            ";",
            &[2, 3, 4, 5, 6, 7, 0, 1, 8],
            false,
        ),
        // rTwig.
        table(
            "id,parent,start_x,start_y,start_z,end_x,end_y,end_z,radius,raw_radius",
            ",",
            &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9],
            false,
        ),
    ];
    let first = graph("a.csv", &tables[2]);
    check(&first);
    // The second cylinder is led through where the branch leaves it.
    assert_eq!((first.nodes.len(), first.limbs.len()), (7, 6));
    let facts = first.facts();
    assert_eq!((facts.components, facts.cycles, facts.free_ends), (1, 0, 3));
    assert!(drawing(&first).contains(&[[0.0, 0.0, 3.0, 0.1], [0.2, 0.0, 3.0, 0.1]]));
    assert!(drawing(&first).contains(&[[0.0, 0.0, 2.0, 0.25], [0.0, 0.0, 3.0, 0.25]]));
    for (table, i) in tables.iter().zip(0..) {
        let other = graph("a.csv", table);
        let (a, b) = (drawing(&first), drawing(&other));
        assert_eq!(a.len(), b.len(), "table {i}");
        for (a, b) in a
            .as_flattened()
            .as_flattened()
            .iter()
            .zip(b.as_flattened().as_flattened())
        {
            assert!((a - b).abs() < 1e-12, "table {i}: {a} {b}");
        }
        assert!(other.remarks.is_empty(), "table {i}: {:?}", other.remarks);
    }
    // The order of rows does not matter where they have ids.
    let mut lines: Vec<&str> = tables[2].lines().collect();
    lines[1..].reverse();
    assert_eq!(drawing(&graph("a.csv", lines.join("\n"))), drawing(&first));
}

#[test]
fn faults_of_tables_are_told() {
    let good = table(
        "id,parent,start_x,start_y,start_z,end_x,end_y,end_z,radius",
        ",",
        &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        false,
    );
    let told = message("a.csv", good.replace("radius", "color"));
    assert!(
        told.starts_with("line 1: a table of cylinders needs"),
        "{told}"
    );
    assert!(
        told.ends_with("`end_x`, `end_y`, `end_z`, `color`"),
        "{told}"
    );
    let told = message("a.csv", good.replace("0.25", "fat"));
    assert_eq!(told, "line 3: `radius` is `fat`, which is no number");
    assert_eq!(
        message("a.csv", good.replace("0.25", "")),
        "line 3: `radius` is missing"
    );
    assert!(message("a.csv", good.replace("0.25", "NaN")).contains("no number"));
    assert!(message("a.csv", good.replace("0.25", "1e300")).starts_with("line 3: a radius must"));
    assert!(message("a.csv", "").contains("the columns here are none"));
    let thin = graph("a.csv", good.replace("0.25", "0"));
    assert!(remarks(&thin)[0].starts_with("line 3: the radius of cylinder 2 is not above 0"));
    let orphan = graph("a.csv", good.replace("4,3,", "4,77,"));
    assert_eq!(
        remarks(&orphan),
        ["line 5: there is no cylinder 77, which is to come before this one"]
    );
    assert_eq!(
        orphan.facts().components,
        1,
        "its start is the end of another"
    );
    let twice = graph("a.csv", good.replace("4,3,", "3,2,"));
    assert!(remarks(&twice)[0].starts_with("line 5: cylinder 3 stands in line 4 already"));
    // Circles of parents have no root.
    check(&graph("a.csv", good.replace("1,0,", "1,4,")));
}
