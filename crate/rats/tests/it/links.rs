//! Links: old ones open, hostile ones do not.

use base64::Engine;
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use rats::link::{self, LinkError, Shared};
use rats::{File, Project};
use scene::Camera;

fn share(name: &str, text: &str) -> Shared {
    Shared {
        project: Project {
            files: vec![File {
                name: name.to_owned(),
                text: text.to_owned(),
            }],
        },
        camera: None,
    }
}

fn fragment_of(version: u8, json: &[u8]) -> String {
    let mut bytes = vec![version];
    bytes.extend(miniz_oxide::deflate::compress_to_vec(json, 9));
    URL_SAFE_NO_PAD.encode(bytes)
}

/// A link of version 1 as it was sent. It must open for ever.
const FROZEN: &str = "\
    AU2NQQ6CQAxFrzL5bgmBGDZzCRO3wKKBDmJkIB0wGjIH8hxezIIuTPMXfW3eXzHJeOVmhl3h-hsH2HKFp4FhMVDvU6\
    EZCWZ-6A_CIo4aNsG0vXPmJOQ7PnNb-TBdWLZDbrJ9Dub9qjxiHRM06hPaOvip4vKYZsk3Ra1uko7VXmaKflG8TH8o\
    35Eb77CF7jF-AA";

#[test]
fn version_1_is_frozen() {
    let mut expected = share(
        "main.rat",
        "surface s diff OrangeRed\nsphere s 1 0 0 0 # é\n",
    );
    expected.camera = Some(Camera {
        eye: glam::DVec3::new(3.0, 3.0, 3.5),
        target: glam::DVec3::ZERO,
        up: glam::DVec3::Z,
        fov: 50.0,
        ..Camera::default()
    });
    assert_eq!(
        link::decode(FROZEN),
        Ok(expected.clone()),
        "{:?}",
        link::encode(&expected)
    );
}

#[test]
fn texts_that_are_no_links_are_refused() {
    for text in ["", "hello world", "!", "AA", "A"] {
        assert_eq!(link::decode(text), Err(LinkError::NotALink), "{text}");
    }
    assert_eq!(
        link::decode(&fragment_of(2, b"{}")),
        Err(LinkError::NewerVersion(2))
    );
    assert_eq!(
        link::decode(&fragment_of(1, b"{}")),
        Err(LinkError::Damaged)
    );
    assert_eq!(
        link::decode(&fragment_of(1, b"\xff")),
        Err(LinkError::Damaged)
    );
    let whole = link::encode(&share("a", "sphere s 1 0 0 0")).expect("a link");
    assert_eq!(
        link::decode(&whole[..whole.len() / 2]),
        Err(LinkError::Damaged)
    );
}

#[test]
fn links_that_are_too_large_are_refused() {
    let long = "A".repeat(link::MAX_FRAGMENT + 1);
    assert_eq!(link::decode(&long), Err(LinkError::TooLong));
    // A bomb: a small fragment that inflates beyond the limit.
    let bomb = fragment_of(1, &vec![b' '; 64 * link::MAX_INFLATED]);
    assert!(bomb.len() < link::MAX_FRAGMENT);
    assert_eq!(link::decode(&bomb), Err(LinkError::TooLarge));
    let large = share("a", &" ".repeat(link::MAX_INFLATED));
    assert_eq!(link::encode(&large), Err(LinkError::TooLarge));
    // Does not deflate, so the fragment is too long.
    let noise: String = (0..link::MAX_FRAGMENT)
        .map(|i| char::from(b' ' + (rats::random::hash(&[i as f64]) * 90.0) as u8))
        .collect();
    assert_eq!(link::encode(&share("a", &noise)), Err(LinkError::TooLong));
}

#[test]
fn contents_that_are_no_project_are_refused() {
    let refused = |shared: Shared| {
        let json = serde_json::to_vec(&shared).expect("json");
        assert!(
            matches!(link::encode(&shared), Err(LinkError::NotAProject(_))),
            "{shared:?}"
        );
        assert!(
            matches!(
                link::decode(&fragment_of(1, &json)),
                Err(LinkError::NotAProject(_))
            ),
            "{shared:?}"
        );
    };
    let good = share("a", "");
    assert!(link::encode(&good).is_ok());
    refused(share("", ""));
    refused(share("a\nb", ""));
    refused(share(&"a".repeat(link::MAX_NAME + 1), ""));
    let mut none = good.clone();
    none.project.files.clear();
    refused(none);
    let mut twice = good.clone();
    twice.project.files.push(twice.project.files[0].clone());
    refused(twice);
    let mut many = good.clone();
    many.project.files = (0..=rats::limits::MAX_FILES)
        .map(|i| File {
            name: i.to_string(),
            text: String::new(),
        })
        .collect();
    refused(many);
    for (eye, fov) in [(1e13, 50.0), (0.0, 0.0), (0.0, 180.0)] {
        let mut odd = good.clone();
        odd.camera = Some(Camera {
            eye: glam::DVec3::splat(eye),
            fov,
            ..Camera::default()
        });
        refused(odd);
    }
    for pixel in [0.0, -1.0, 1e4] {
        let mut odd = good.clone();
        odd.camera = Some(Camera {
            pixel,
            ..Camera::default()
        });
        refused(odd);
    }
}

#[test]
fn errors_are_sentences() {
    let errors = [
        LinkError::TooLong,
        LinkError::TooLarge,
        LinkError::NotALink,
        LinkError::NewerVersion(7),
        LinkError::Damaged,
        LinkError::NotAProject(String::from("it has no file")),
    ];
    for error in errors {
        let sentence = error.to_string();
        assert!(sentence.ends_with('.') && sentence.len() > 20, "{sentence}");
    }
}
