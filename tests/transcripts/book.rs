//! The README, CONTRIBUTING and the pages of `docs/`: what they show to type is typed. Of each page, in a folder of its
//! own beside the scenarios and the examples,
//!
//! * blocks ```` ```LANGUAGE file=NAME ```` are written to files,
//! * the lines of blocks ```` ```sh ```` are run by a shell, `stickslip` being the program under test,
//! * and so are those of blocks ```` ```bash ````, with the scripts in `stand-ins` in place of programs of others that they
//!   need (Cargo, Slurm, GNU parallel …),
//! * blocks ```` ```python ```` are run by Python, the client of the repository driving the program under test,
//! * blocks ```` ```text serve ```` are lines to `stickslip serve` and its answers by turns, `…` standing for any text,
//! * blocks ```` ```json ```` must be JSON, blocks ```` ```jsonc ```` members of an object, with comments,
//! * blocks ```` ```stickslip ```` are one session, beginning on the beam, that must not fail,
//! * the lines of blocks ```` ```text output ```` must stand in what all that shows, one after another (a line may be
//!   the beginning of one that is shown; blanks count as one),
//! * blocks ```` ```text ````, ```` ```toml ```` and ```` ```sql ```` are read by people and programs of others; there are no
//!   other blocks.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use jsonc_parser::ParseOptions;
use jsonc_parser::cst::CstRootNode;

use super::lines::side_by_side;

/// A fenced block of a page: the words after the fence, and its lines.
struct Block {
    words: Vec<String>,
    text: String,
}

impl Block {
    fn language(&self) -> &str {
        self.words.first().map_or("", String::as_str)
    }

    fn file(&self) -> Option<&str> {
        self.words.iter().find_map(|word| word.strip_prefix("file="))
    }
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<Block> = None;
    for line in page.lines() {
        let begins = line.trim_start().starts_with("```") || line.trim_start().starts_with("~~~");
        assert!(!begins || line.starts_with("```"), "a block that this test would not find: {line}");
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(words)) => {
                open =
                    Some(Block { words: words.split_whitespace().map(str::to_owned).collect(), text: String::new() });
            }
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(block), None) => {
                block.text.push_str(line);
                block.text.push('\n');
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block is not closed");
    blocks
}

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const PROGRAM: &str = env!("CARGO_BIN_EXE_stickslip");

/// What runs in a folder with the program under test on its path.
fn command(folder: &Path, name: &str, arguments: &[&str]) -> Command {
    let mut path = Path::new(ROOT).join("tests/transcripts/stand-ins").into_os_string();
    for part in [Path::new(PROGRAM).parent().unwrap().as_os_str(), &std::env::var_os("PATH").unwrap_or_default()] {
        path.push(":");
        path.push(part);
    }
    let mut command = Command::new(name);
    command.args(arguments).current_dir(folder).env("PATH", path).env("HOME", folder);
    command.env_remove("NO_COLOR").env_remove("COLUMNS").env("TERM", "xterm");
    command.env("ROOT", ROOT).env("STICKSLIP", PROGRAM).env("PYTHONPATH", Path::new(ROOT).join("python"));
    command.env("PYTHONDONTWRITEBYTECODE", "1");
    command
}

fn shell(folder: &Path, arguments: &[&str], script: &str) -> Output {
    command(folder, "bash", &[arguments, &["-c", script]].concat()).output().unwrap()
}

/// Whether a line is `shown` with any text in place of each `…`.
fn is_shown(shown: &str, line: &str) -> bool {
    let mut rest = line;
    shown.split('…').enumerate().all(|(index, part)| match rest.find(part) {
        Some(at) if index > 0 || at == 0 => {
            rest = &rest[at + part.len()..];
            true
        }
        _ => false,
    }) && (rest.is_empty() || shown.ends_with('…'))
}

/// Gives the requests of a block to `serve`, and compares its answers.
fn try_serve(folder: &Path, name: &str, block: &str) {
    let lines: Vec<&str> = block.lines().collect();
    let requests: String = lines.iter().step_by(2).map(|line| format!("{line}\n")).collect();
    fs::write(folder.join("requests"), requests).unwrap();
    let run = shell(folder, &[], "stickslip serve < requests");
    let answers = String::from_utf8(run.stdout).unwrap();
    assert_eq!(answers.lines().count() * 2, lines.len(), "{name}: {answers}");
    for (shown, answer) in lines.iter().skip(1).step_by(2).zip(answers.lines()) {
        // the page has a blank after each colon and comma
        let shown = shown.replace("\": ", "\":").replace(", \"", ",\"").replace(", {", ",{").replace(", [", ",[");
        assert!(is_shown(&shown.replace(", …", "…"), answer), "{name}: {shown}\nis not\n{answer}");
    }
}

/// A line with every run of blanks as one.
fn words(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn try_page(page: &Path) {
    let name = page.file_name().unwrap().to_string_lossy();
    let blocks = blocks(&fs::read_to_string(page).unwrap());
    let folder = tempfile::tempdir().unwrap();
    for beside in ["scenarios", "examples"] {
        std::os::unix::fs::symlink(Path::new(ROOT).join(beside), folder.path().join(beside)).unwrap();
    }
    let mut shown = String::new();
    for block in &blocks {
        if let Some(file) = block.file() {
            fs::write(folder.path().join(file), &block.text).unwrap();
        }
    }
    for block in blocks.iter().filter(|block| block.file().is_none()) {
        let words: Vec<&str> = block.words.iter().map(String::as_str).collect();
        let run = match words[..] {
            ["sh" | "bash"] => shell(folder.path(), &["-e"], &block.text),
            ["python"] => command(folder.path(), "python3", &["-c", &block.text]).output().unwrap(),
            ["json"] => {
                let read = serde_json::from_str::<serde_json::Value>(&block.text);
                read.unwrap_or_else(|error| panic!("{name}: {error}"));
                continue;
            }
            ["jsonc"] => {
                let read = CstRootNode::parse(&format!("{{{}}}", block.text), &ParseOptions::default());
                read.unwrap_or_else(|error| panic!("{name}: {error}"));
                continue;
            }
            ["text", "serve"] => {
                try_serve(folder.path(), &name, &block.text);
                continue;
            }
            ["stickslip"] | ["text", "output"] | ["text" | "toml" | "sql"] => continue,
            _ => panic!("{name}: what is a block of {words:?}?"),
        };
        shown.push_str(&String::from_utf8_lossy(&run.stdout));
        assert!(run.status.success(), "{name}: {}\n{}", block.text, String::from_utf8_lossy(&run.stderr));
    }
    let session: String =
        blocks.iter().filter(|block| block.language() == "stickslip").map(|block| block.text.as_str()).collect();
    fs::write(folder.path().join("page.stick"), session).unwrap();
    let run = shell(folder.path(), &[], "stickslip replay page.stick");
    shown.push_str(&String::from_utf8_lossy(&run.stdout));
    let last = shown.lines().rev().take(3).collect::<Vec<_>>().join(" < ");
    assert!(run.status.success(), "{name}: {}after: {last}", String::from_utf8_lossy(&run.stderr));

    let shown: Vec<String> = shown.lines().map(words).collect();
    let mut from = 0;
    for block in blocks.iter().filter(|block| block.words == ["text", "output"]) {
        for line in block.text.lines().map(words) {
            let found = shown[from..].iter().position(|shown| shown.starts_with(&line));
            let found = found.unwrap_or_else(|| panic!("{name}: `{line}` is not shown:\n{}", shown.join("\n")));
            from += found + 1;
        }
    }
}

fn pages() -> Vec<PathBuf> {
    let docs = Path::new(ROOT).join("docs");
    let mut pages: Vec<PathBuf> = fs::read_dir(docs).unwrap().map(|entry| entry.unwrap().path()).collect();
    pages.retain(|page| page.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    pages.extend(["README.md", "CONTRIBUTING.md"].map(|page| Path::new(ROOT).join(page)));
    pages
}

/// The targets of links `](TARGET)` of a page that lead to files.
fn links(page: &str) -> Vec<String> {
    let targets = page.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    let files = targets.map(|(target, _)| target.split('#').next().unwrap_or("").to_owned());
    files.filter(|target| !target.is_empty() && !target.contains("://")).collect()
}

#[test]
fn every_page_is_in_the_contents_and_every_link_leads_somewhere() {
    let pages = pages();
    let contents = links(&fs::read_to_string(pages[0].parent().unwrap().join("SUMMARY.md")).unwrap());
    for page in pages {
        let name = page.file_name().unwrap().to_string_lossy();
        assert!(
            ["SUMMARY.md", "README.md", "CONTRIBUTING.md"].contains(&&*name) || contents.contains(&name.to_string()),
            "{name} is not in SUMMARY.md"
        );
        for link in links(&fs::read_to_string(&page).unwrap()) {
            assert!(page.parent().unwrap().join(&link).exists(), "{name}: {link} is not there");
        }
    }
}

#[test]
fn what_the_pages_show_is_what_happens() {
    let pages = pages();
    assert!(pages.len() >= 15, "{}", pages.len());
    side_by_side(&pages, |page| try_page(page));
}

/// The texts `stickslip-WORD/NUMBER` of a file.
fn formats(text: &str) -> Vec<String> {
    let starts = text.match_indices("\"stickslip-").map(|(at, _)| &text[at + 1..]);
    let quoted = starts.filter_map(|rest| rest.split_once('"')).map(|(format, _)| format.to_owned());
    quoted.filter(|format| format.rsplit_once('/').is_some_and(|(_, number)| number.parse::<u32>().is_ok())).collect()
}

#[test]
fn every_format_has_its_line_among_the_versions() {
    let page = fs::read_to_string(Path::new(ROOT).join("docs/versions.md")).unwrap();
    let (mut folders, mut found) = (vec![Path::new(ROOT).join("src")], 0);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() {
                folders.push(entry);
                continue;
            }
            for format in formats(&fs::read_to_string(&entry).unwrap()) {
                found += 1;
                let earlier = format == "stickslip-sweep/1";
                assert!(earlier || page.contains(&format!("| `{format}` |")), "{format} of {}", entry.display());
            }
        }
    }
    assert!(found >= 5, "{found}");
}
