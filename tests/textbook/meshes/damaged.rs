//! Damaged files: whatever is cut off or changed, reading ends with a mesh or with problems in words, and at once.

use std::fs;
use std::panic::catch_unwind;
use std::path::Path;
use std::time::{Duration, Instant};

use rand::{Rng, RngCore, SeedableRng};
use stickslip::model::mesh::overview::Overview;
use stickslip::model::mesh::{Mesh, MeshProblem, read_abaqus, read_gmsh};

type Read = fn(&[u8]) -> Result<Mesh, Vec<MeshProblem>>;

/// Name, reader and bytes of every small seed of the fuzz targets.
fn seeds() -> Vec<(String, Read, Vec<u8>)> {
    let gmsh: Read = |bytes| read_gmsh(bytes, "a.msh");
    let abaqus: Read = |bytes| read_abaqus(bytes, "a.inp", None);
    let mut seeds = Vec::new();
    for (folder, read) in [("gmsh", gmsh), ("abaqus", abaqus)] {
        for entry in fs::read_dir(Path::new("fuzz/seeds").join(folder)).expect("the seeds") {
            let path = entry.expect("an entry").path();
            seeds.push((path.display().to_string(), read, fs::read(&path).expect("a file")));
        }
    }
    seeds.sort_by(|a, b| a.0.cmp(&b.0));
    seeds
}

/// Reads it, and lists what it holds; panics where that panics, takes long or says nothing.
fn judge(name: &str, read: Read, bytes: &[u8]) -> bool {
    let start = Instant::now();
    let found = catch_unwind(|| read(bytes).map(|mesh| Overview::of(&mesh)));
    let shown = || format!("{name}: {:?}", String::from_utf8_lossy(bytes));
    let found = found.unwrap_or_else(|_| panic!("{}", shown()));
    assert!(start.elapsed() < Duration::from_secs(5), "{}", shown());
    if let Err(problems) = &found {
        assert!(!problems.is_empty() && problems.len() < 10, "{}", shown());
        assert!(problems.iter().all(|p| !p.message.is_empty() && !p.help.is_empty()), "{}", shown());
    }
    found.is_ok()
}

#[test]
fn seeds_are_read_and_cut_off_anywhere_they_end_in_words() {
    let seeds = seeds();
    assert!(seeds.len() >= 6, "{} seeds", seeds.len());
    for (name, read, bytes) in seeds {
        assert!(judge(&name, read, &bytes), "{name}: {:?}", read(&bytes).err());
        let whole = bytes.trim_ascii_end().len();
        for end in 0..whole {
            let is_read = judge(&name, read, &bytes[..end]);
            // In an .inp file lines may be missing at the end, and what follows the elements of a .msh.
            let is_whole = name.contains("abaqus") || bytes[..end].windows(12).any(|word| word == b"$EndElements");
            assert!(!is_read || is_whole, "{name} cut off at {end}");
        }
    }
}

#[test]
fn changed_bytes_words_and_lines_end_in_a_mesh_or_in_words() {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(20261126);
    const WORDS: &[&str] = &[
        "0",
        "-1",
        "2147483648",
        "18446744073709551615",
        "1e308",
        "-1e-320",
        "nan",
        "inf",
        "$EndNodes",
        "$Nodes",
        "*NODE",
        "*ELEMENT, TYPE=CPS8",
        ",",
        ",,",
        "\"",
        "99999999999999999999",
        "3.5",
        "*NSET, NSET=x, GENERATE",
        "1, 4000000000, 1",
        "*ELSET, ELSET=a",
        "a",
        "*SURFACE, NAME=s",
        "*INCLUDE, INPUT=a.inp",
        "\u{fffd}",
        "",
    ];
    for (name, read, bytes) in seeds() {
        for _ in 0..400 {
            let mut changed = bytes.clone();
            for _ in 0..random.random_range(1..4) {
                let at = random.random_range(0..changed.len());
                match random.random_range(0..5) {
                    0 => changed[at] = (random.next_u32() & 0xff) as u8,
                    1 => drop(changed.remove(at)),
                    2 => changed.insert(at, b"0123456789 -.,\n$*"[random.random_range(0..17)]),
                    3 => {
                        // A word for another one.
                        let from = changed[..at].iter().rposition(u8::is_ascii_whitespace).map_or(0, |k| k + 1);
                        let to =
                            changed[at..].iter().position(u8::is_ascii_whitespace).map_or(changed.len(), |k| at + k);
                        let word = WORDS[random.random_range(0..WORDS.len())].bytes();
                        changed.splice(from.min(to)..to, word);
                    }
                    _ => {
                        // A piece again, somewhere.
                        let end = (at + random.random_range(1..60)).min(changed.len());
                        let piece = changed[at..end].to_vec();
                        let to = random.random_range(0..changed.len());
                        changed.splice(to..to, piece);
                    }
                }
                if changed.is_empty() {
                    changed.push(b'\n');
                }
            }
            judge(&name, read, &changed);
        }
    }
}

/// Sets of sets that double at every step, chains of them, and claims of 2³¹ entries cost nothing.
#[test]
fn claims_and_chains_cost_nothing() {
    let mut doubling =
        "*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n*NSET, NSET=s0\n1, 2\n".to_owned();
    for k in 0..20_000 {
        doubling += &format!("*NSET, NSET=s{}\ns{k}, s{k}\n", k + 1);
    }
    doubling += "*NSET, NSET=all, GENERATE\n1, 18446744073709551615, 1\n";
    let start = Instant::now();
    let mesh = read_abaqus(doubling.as_bytes(), "a.inp", None).expect("a mesh");
    assert_eq!(mesh.groups.last().map(|group| group.members.count()), Some(3));
    for claim in ["2147483648", "18446744073709551615"] {
        for section in ["$Nodes", "$Elements", "$PhysicalNames"] {
            let text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{section}\n{claim}\n1 0 0 0\n");
            let problems = read_gmsh(text.as_bytes(), "a.msh").expect_err("a claim");
            assert!(problems[0].message.contains(&format!("said to be {claim}")), "{problems:?}");
            assert_eq!(problems[0].line, 5);
        }
        let text = format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {claim} 1 {claim}\n2 1 0 {claim}\n1\n");
        let problems = read_gmsh(text.as_bytes(), "a.msh").expect_err("a claim");
        assert!(problems[0].message.contains(&format!("said to be {claim}")), "{problems:?}");
    }
    assert!(start.elapsed() < Duration::from_secs(5));
}
