//! Archives: there and back, as others read and write them, and everything that may be wrong with
//! them.

use archive::{Archive, Error, Member, write};
use std::path::PathBuf;
use std::process::Command;
use trials::trials;

/// An archive of the program `zip` with a folder, a packed text, and a stored one with another
/// name's letters.
fn foreign() -> Option<(PathBuf, Vec<u8>)> {
    let folder = std::env::temp_dir().join(format!("sinew-archive-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("in")).ok()?;
    std::fs::write(folder.join("in/long.txt"), "word ".repeat(500)).ok()?;
    std::fs::write(folder.join("in/ö.txt"), "x").ok()?;
    let done = Command::new("zip")
        .args(["-rq", "-z", "made.zip", "in"])
        .current_dir(&folder)
        .stdin(std::process::Stdio::null())
        .output()
        .ok()?;
    let bytes = std::fs::read(folder.join("made.zip")).ok()?;
    done.status.success().then_some((folder, bytes))
}

#[test]
fn archives_of_another_program_are_read() {
    let Some((folder, bytes)) = foreign() else {
        println!("skipped: there is no program `zip`");
        return;
    };
    std::fs::remove_dir_all(folder).unwrap();
    let archive = Archive::open(&bytes, 10).unwrap();
    let folders: Vec<_> = archive.entries().iter().filter(|e| e.is_folder()).collect();
    assert_eq!(folders.len(), 1);
    for (name, content) in [
        ("in/long.txt", "word ".repeat(500)),
        ("in/ö.txt", String::from("x")),
    ] {
        let entry = archive.entry(name).unwrap();
        assert_eq!(archive.read(entry, 10_000).unwrap(), content.as_bytes());
    }
}

#[test]
fn another_program_finds_nothing_wrong() {
    let members = [
        Member::new("a/long.txt", &[b'a'; 5000]),
        Member {
            packed: true,
            ..Member::new("ö.png", b"\x89PNG")
        },
        Member::new("empty", b""),
    ];
    let bytes = write(&members).unwrap();
    assert!(bytes.len() < 1000, "it is packed");
    let path = std::env::temp_dir().join(format!("sinew-archive-{}.zip", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    let told = Command::new("unzip").arg("-t").arg(&path).output();
    std::fs::remove_file(path).unwrap();
    match told {
        Ok(told) => assert!(told.status.success(), "{told:?}"),
        Err(_) => println!("skipped: there is no program `unzip`"),
    }
}

#[test]
fn members_come_back() {
    trials(|u| {
        let members: Vec<(String, Vec<u8>, bool)> = u.arbitrary()?;
        let given: Vec<Member<'_>> = members
            .iter()
            .map(|(name, bytes, packed)| Member {
                name,
                bytes,
                packed: *packed,
            })
            .collect();
        let bytes = write(&given).unwrap();
        let archive = Archive::open(&bytes, members.len()).unwrap();
        assert_eq!(archive.entries().len(), members.len());
        for (entry, (name, content, _)) in archive.entries().iter().zip(&members) {
            assert_eq!((&entry.name, entry.size), (name, content.len()));
            assert_eq!(archive.read(entry, content.len()).as_ref(), Ok(content));
        }
        Ok(())
    });
}

#[test]
fn bombs_are_not_unpacked() {
    let content = vec![0; 10_000_000];
    let mut bytes = write(&[Member::new("zeros", &content)]).unwrap();
    assert!(bytes.len() < 20_000);
    fn unpack(bytes: &[u8]) -> Result<Vec<u8>, Error> {
        let archive = Archive::open(bytes, 1)?;
        archive.read(&archive.entries()[0], 1_000_000)
    }
    assert_eq!(unpack(&bytes), Err(Error::Large(1_000_000)));
    // The size that the directory tells is a lie.
    let directory = bytes
        .windows(4)
        .rposition(|four| four == b"PK\x01\x02")
        .unwrap();
    bytes[directory + 24..][..4].copy_from_slice(&5_u32.to_le_bytes());
    assert_eq!(unpack(&bytes), Err(Error::Large(1_000_000)));
    let many = vec![Member::new("a", b""); 12];
    let bytes = write(&many).unwrap();
    assert_eq!(Archive::open(&bytes, 11).unwrap_err(), Error::Members(11));
    assert!(write(&vec![Member::new("a", b""); 65_535]).is_err());
}

#[test]
fn what_is_wrong_is_told() {
    let good = write(&[Member::new("a.txt", b"aaaaaaaaaaaaaaaaaaaaaaaa")]).unwrap();
    let directory = good
        .windows(4)
        .rposition(|four| four == b"PK\x01\x02")
        .unwrap();
    let told = |at: usize, byte: u8| {
        let mut bytes = good.clone();
        bytes[at] = byte;
        let archive = Archive::open(&bytes, 9)?;
        archive.read(&archive.entries()[0], 100).map(|_| ())
    };
    assert_eq!(told(directory + 8, 1), Err(Error::Encrypted));
    assert_eq!(told(directory + 10, 12), Err(Error::Method(12)));
    assert_eq!(told(directory + 16, 0), Err(Error::Damaged));
    assert_eq!(told(directory + 42, 9), Err(Error::Broken));
    assert_eq!(told(directory + 42, 255), Err(Error::Broken));
    assert_eq!(told(35, 255), Err(Error::Damaged), "the packed bytes");
    assert_eq!(Archive::open(b"PK\x03\x04", 9).unwrap_err(), Error::Broken);
    let end = good.len() - 22;
    let mut huge = good.clone();
    huge[end + 16..][..4].fill(255);
    assert_eq!(Archive::open(&huge, 9).unwrap_err(), Error::Huge);
}

#[test]
fn no_bytes_do_harm() {
    let good = write(&[Member::new("a", &[7; 99]), Member::new("bc", b"bc")]).unwrap();
    trials(|u| {
        let mut bytes = good.clone();
        for _ in 0..u.int_in_range(0..=4)? {
            let at = u.choose_index(bytes.len())?;
            bytes[at] = u.arbitrary()?;
        }
        bytes.truncate(u.int_in_range(0..=bytes.len())?.max(bytes.len() / 2));
        if let Ok(archive) = Archive::open(&bytes, 5) {
            assert!(archive.entries().len() <= 5);
            for entry in archive.entries() {
                if let Ok(content) = archive.read(entry, 200) {
                    assert!(content.len() <= 200);
                }
            }
        }
        Ok(())
    })
    .cases(2000);
}
