//! Lines of an .inp file and of those it includes: keyword lines and data lines.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use super::super::source::shown;
use super::super::{MeshProblem, Place, file};
use crate::text::file::{LARGEST, reason};

/// Most files that are open inside one another, and most that are read in all.
const DEEPEST: usize = 20;
const MOST_FILES: usize = 1000;

/// A keyword line with its parameters.
#[derive(Debug)]
pub struct Keyword {
    /// In capitals, without the star: `NODE`.
    pub name: String,
    /// Names in capitals, values as written.
    parameters: Vec<(String, Option<String>)>,
    pub place: Place,
}

impl Keyword {
    fn parse(text: &str, place: Place) -> Keyword {
        let mut parts = split(text.trim_start_matches('*')).into_iter();
        let words = parts.next().unwrap_or_default().to_ascii_uppercase();
        let name = words.split_whitespace().collect::<Vec<_>>().join(" ");
        let parameters = parts.filter(|part| !part.trim().is_empty()).map(|part| match part.split_once('=') {
            Some((key, value)) => (key.trim().to_ascii_uppercase(), Some(unquoted(value).to_owned())),
            None => (part.trim().to_ascii_uppercase(), None),
        });
        Keyword { name, parameters: parameters.collect(), place }
    }

    /// Whether the parameter is there.
    pub fn has(&self, key: &str) -> bool {
        self.parameters.iter().any(|(known, _)| known == key)
    }

    /// Names of the parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parameters.iter().map(|(name, _)| name.as_str())
    }

    /// The value of a parameter.
    pub fn value(&self, key: &str) -> Option<&str> {
        let (_, value) = self.parameters.iter().find(|(known, _)| known == key)?;
        value.as_deref().filter(|value| !value.is_empty())
    }
}

/// A text between quotation marks or blanks.
pub fn unquoted(text: &str) -> &str {
    text.trim().trim_matches('"').trim()
}

/// At commas outside quotation marks.
fn split(text: &str) -> Vec<&str> {
    let mut quoted = false;
    text.split(|c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    })
    .collect()
}

/// A line that is not a comment.
pub enum Card {
    Keyword(Keyword),
    /// The fields of a data line, trimmed, and whether it goes on in the next one.
    Data {
        fields: Vec<String>,
        goes_on: bool,
        place: Place,
    },
}

struct Open<'a> {
    bytes: Cow<'a, [u8]>,
    at: usize,
    line: u32,
    file: u32,
    path: Option<PathBuf>,
}

/// The lines of a file, with those it includes in their places.
pub struct Cards<'a> {
    open: Vec<Open<'a>>,
    /// Names of all files, the first as the user gave it.
    pub files: Vec<String>,
    folder: Option<&'a Path>,
    total: u64,
    /// Where the line read last stands.
    pub place: Place,
}

impl<'a> Cards<'a> {
    pub fn new(bytes: &'a [u8], name: &str, folder: Option<&'a Path>) -> Self {
        let path = folder.and_then(|folder| Some(folder.join(Path::new(name).file_name()?)));
        Cards {
            open: vec![Open { bytes: Cow::Borrowed(bytes), at: 0, line: 0, file: 0, path }],
            files: vec![name.to_owned()],
            folder,
            total: bytes.len() as u64,
            place: Place { file: 0, line: 1 },
        }
    }

    /// A problem at a place.
    pub fn problem(&self, place: Place, message: impl Into<String>, help: impl Into<String>) -> MeshProblem {
        let file = self.files[place.file as usize].clone();
        MeshProblem { file, line: place.line as usize, message: message.into(), help: help.into() }
    }

    /// Reads another file from here on; its name is relative to the folder of the first one.
    pub fn include(&mut self, name: &str, place: Place) -> Result<(), MeshProblem> {
        let Some(folder) = self.folder else {
            return Err(self.problem(place, "this file cannot include others", "put all lines into one file"));
        };
        let path = folder.join(name);
        let known = |open: &Open<'_>| open.path.as_deref() == Some(&path);
        let shown_name = shown(name.as_bytes());
        if self.open.iter().any(known) || self.open.len() >= DEEPEST || self.files.len() >= MOST_FILES {
            return Err(self.problem(
                place,
                format!("the file {shown_name} includes itself, or too many files include one another"),
                "put all lines into one file",
            ));
        }
        let bytes = file::read(&path).map_err(|error| {
            let message = format!("cannot read the file {shown_name} that is included here: {}", reason(&error));
            self.problem(place, message, "it is looked for beside the mesh file")
        })?;
        self.total += bytes.len() as u64;
        if self.total > LARGEST {
            let message = format!("with {shown_name} the mesh has more than {} MiB", LARGEST >> 20);
            return Err(self.problem(place, message, "mesh more coarsely"));
        }
        let file = self.files.len() as u32;
        self.files.push(name.to_owned());
        self.open.push(Open { bytes: Cow::Owned(bytes), at: 0, line: 0, file, path: Some(path) });
        Ok(())
    }

    /// The next line that is neither blank nor a comment.
    fn line(&mut self) -> Option<(String, Place)> {
        loop {
            let open = self.open.last_mut()?;
            let rest = &open.bytes[open.at..];
            if rest.is_empty() {
                self.open.pop();
                continue;
            }
            let end = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
            let line = String::from_utf8_lossy(&rest[..end]).trim().to_owned();
            open.at += (end + 1).min(rest.len());
            open.line += 1;
            if !line.is_empty() && !line.starts_with("**") {
                self.place = Place { file: open.file, line: open.line };
                return Some((line, self.place));
            }
        }
    }

    /// The next line; keywords that go on after a comma are put together.
    ///
    /// # Errors
    /// A keyword that goes on in a line that holds no parameter.
    pub fn next(&mut self) -> Result<Option<Card>, MeshProblem> {
        let Some((mut line, place)) = self.line() else { return Ok(None) };
        if line.starts_with('*') {
            while line.ends_with(',') {
                let Some((more, at)) = self.line() else { break };
                // Read as parameters such a line would be lost.
                if !more.starts_with(|c: char| c.is_alphabetic()) {
                    return Err(self.problem(
                        place,
                        format!(
                            "the keyword line ends with a comma, so it goes on in line {}, which holds no parameter: {}",
                            at.line,
                            shown(more.as_bytes())
                        ),
                        "remove the comma at its end, or write its parameter",
                    ));
                }
                line += &more;
            }
            return Ok(Some(Card::Keyword(Keyword::parse(&line, place))));
        }
        let goes_on = line.ends_with(',');
        let mut fields: Vec<String> = split(&line).into_iter().map(|field| unquoted(field).to_owned()).collect();
        if goes_on {
            fields.pop();
        }
        Ok(Some(Card::Data { fields, goes_on, place }))
    }
}

/// A whole number.
pub fn whole(field: &str) -> Option<u64> {
    field.strip_prefix('+').unwrap_or(field).parse().ok()
}

/// A number, its exponent perhaps in Fortran's form; an empty field is 0.
pub fn number(field: &str) -> Option<f64> {
    if field.is_empty() {
        return Some(0.0);
    }
    field.parse().ok().or_else(|| field.replace(['d', 'D'], "e").parse().ok())
}
