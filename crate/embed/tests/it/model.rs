use document::intake::Incoming;
use embed::Model;
use glam::DVec3;
use pool::Tools;
use std::time::{Duration, Instant};

fn model(files: &[(&str, &[u8])]) -> Result<Model, String> {
    let files = files.iter().map(|(name, bytes)| Incoming {
        name: (*name).into(),
        bytes: Ok(bytes.to_vec()),
    });
    let mut model = Model::new(files.collect(), Tools::new(|| {}))?;
    let begun = Instant::now();
    while !model.tick() {
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "it is never read"
        );
        std::thread::yield_now();
    }
    Ok(model)
}

/// The field falls through the iso-value at a ball's radius.
#[test]
fn values_are_those_of_the_field() {
    let text = b"surface s diffuse Gold blobbiness -1\nsphere s 1, <3 0 0>";
    let mut model = model(&[("ball.rat", text)]).unwrap();
    assert_eq!(model.errors(), 0);
    let surface = &model.scene().unwrap().surfaces()[0];
    let points: Vec<f64> = (0..30).map(|i| 0.2 * f64::from(i)).collect();
    let truth = points.as_chunks::<3>().0.iter().map(|p| {
        let place = DVec3::from_array(*p);
        surface.function().jet(place).value
    });
    let truth: Vec<f64> = truth.collect();
    assert_eq!(model.values(&points), truth);
    let [inside, outside] = [3.99, 4.01].map(|x| model.values(&[x, 0.0, 0.0])[0]);
    assert!(outside < field::THRESHOLD && field::THRESHOLD < inside);
    assert!(model.values(&[]).is_empty());
}

#[test]
fn films_have_frames() {
    let text = b"var x = 0 += 1\nsurface s diffuse Gold blobbiness -1\nsphere s 1, <x 0 0>";
    let mut model = model(&[("film.rat", text)]).unwrap();
    assert!(model.is_animated(), "{:?}", model.diagnostics());
    let before = model.values(&[5.0, 0.0, 0.0])[0];
    model.set_frame(5);
    assert!(model.tick());
    assert!(model.values(&[5.0, 0.0, 0.0])[0] > before);
}

#[test]
fn files_beside_the_text_are_read() {
    let mesh = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let text = b"read other.rat\nmesh s sheet.obj";
    let other = b"surface s diffuse Gold";
    let files: [(&str, &[u8]); 3] = [
        ("other.rat", other),
        ("sheet.obj", mesh),
        ("main.rat", text),
    ];
    let mut read = model(&files).unwrap();
    assert_eq!(read.errors(), 0, "{:?}", read.diagnostics());
    assert!(!read.scene().unwrap().elements.is_empty());
    let swc: (&str, &[u8]) = ("cell.swc", b"1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n");
    read = model(&[swc]).unwrap();
    assert!(read.values(&[2.5, 0.0, 0.0])[0] > field::THRESHOLD);
}

#[test]
fn mistakes_are_told() {
    let wrong = model(&[("main.rat", b"sphere nothing 1, <0 0 0>")]).unwrap();
    assert_eq!(wrong.errors(), 1);
    let [said] = wrong.diagnostics() else {
        panic!("one message")
    };
    assert_eq!((said.line, said.column), (1, 8));
    for (name, bytes) in [("a.exe", "x"), ("", "x"), ("points.xyz", "0 0 0\n1 0 0\n")] {
        let refused = model(&[(name, bytes.as_bytes())]).err().unwrap();
        assert!(refused.ends_with('.'), "{refused}");
    }
    assert!(model(&[]).is_err());
}
