//! Matrix Market files: real or integer, array or coordinate, general or symmetric
//! (<https://math.nist.gov/MatrixMarket/formats.html>).

use crate::model::memory;

/// What is wrong with a file, and on which line.
#[derive(Debug, PartialEq)]
pub struct MatrixError {
    /// From 1.
    pub line: usize,
    /// What was found and expected.
    pub message: String,
    /// What to do.
    pub help: String,
}

/// What the size of a matrix must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// 2m × 2m for m contact pairs with one tangential joint each, 3m × 3m with two.
    OfPairs {
        /// m.
        pairs: usize,
        /// 1 or 2.
        tangents: usize,
    },
    /// As many rows as columns, at least one.
    Square,
    /// A row and a column for each of this many displacements.
    OfDofs(usize),
    /// A force for each of this many displacements: one column.
    Forces(usize),
}

impl Size {
    /// The order of the rows of contact pairs.
    pub fn order(self) -> &'static str {
        match self {
            Size::OfPairs { tangents: 2, .. } => "all normals, then t1 and t2 of each pair",
            _ => "all normals, then all tangentials",
        }
    }

    /// Why `rows` × `columns` does not fit: what was expected, and what to do.
    fn check(self, rows: usize, columns: usize) -> Result<(), (String, String)> {
        let (fits, expected, help) = match self {
            Size::OfPairs { pairs, tangents } => {
                let (each, count) = (1 + tangents, (1 + tangents) * pairs);
                let help = format!("rows and columns: {}", self.order());
                (rows == count && columns == rows, format!("expected {each}m × {each}m = {count} × {count}"), help)
            }
            Size::Square => (
                rows == columns && rows > 0,
                "expected a square one with at least one row".into(),
                "M has a row for each entry of q".into(),
            ),
            Size::OfDofs(count) => (
                rows == count && columns == rows,
                format!("expected {count} × {count}: `dofs` has {count} entries"),
                "rows and columns stand in the order of `dofs`".into(),
            ),
            Size::Forces(count) => (
                rows == count && columns == 1,
                format!("expected {count} × 1: `dofs` has {count} entries"),
                "a column of forces in the order of `dofs`".into(),
            ),
        };
        if fits { Ok(()) } else { Err((expected, help)) }
    }

    /// Bytes that a file with this many entries takes.
    fn bytes(self, rows: usize, entries: usize) -> f64 {
        match self {
            Size::OfPairs { .. } | Size::Square => memory::for_joints(rows as f64),
            Size::OfDofs(_) | Size::Forces(_) => memory::for_entries(entries as f64),
        }
    }
}

/// What a file holds.
#[derive(Debug, PartialEq)]
pub struct Entries {
    /// Number of rows.
    pub rows: usize,
    /// Whether only the lower triangle is given.
    pub symmetric: bool,
    /// (row, column, value) in the order of the file, each place once.
    pub entries: Vec<(usize, usize, f64)>,
}

/// Reads a square matrix, row by row.
pub fn read(text: &str, size: Size) -> Result<Vec<Vec<f64>>, MatrixError> {
    let Entries { rows, symmetric, entries } = entries(text, size)?;
    let mut matrix = vec![vec![0.0; rows]; rows];
    for (i, j, value) in entries {
        matrix[i][j] = value;
        if symmetric {
            matrix[j][i] = value;
        }
    }
    Ok(matrix)
}

/// Reads the entries of a matrix.
pub fn entries(text: &str, size: Size) -> Result<Entries, MatrixError> {
    let mut lines = text.lines().enumerate().map(|(k, line)| (k + 1, line.trim()));
    let (number, banner) = lines.next().unwrap_or((1, ""));
    let header = Header::parse(banner).map_err(|message| {
        error(
            number,
            message,
            "the first line is `%%MatrixMarket matrix array|coordinate real|integer general|symmetric`",
        )
    })?;
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('%'));
    let last = text.lines().count().max(1);
    let (number, sizes) = lines.next().ok_or_else(|| error(last, "the line with the sizes is missing", ""))?;
    let sizes = words::<usize>(number, sizes, if header.coordinate { 3 } else { 2 })?;
    let (rows, columns) = (sizes[0], sizes[1]);
    size.check(rows, columns)
        .map_err(|(expected, help)| error(number, format!("the matrix is {rows} × {columns}, {expected}"), &help))?;
    // An array has at least its lower triangle in the file, and every number two bytes.
    let claimed = if header.coordinate { sizes[2] } else { rows.saturating_mul(columns) / 2 };
    if claimed > text.len() {
        return Err(error(number, format!("{claimed} entries are announced, more than the file has characters"), ""));
    }
    if let Some(refusal) = memory::refusal(size.bytes(rows, claimed)) {
        return Err(error(number, format!("a matrix of {rows} rows {refusal}"), "use a smaller one"));
    }
    // Of an array column by column; of a symmetric one the lower triangle.
    let first = |column: usize| if header.symmetric { column } else { 0 };
    let mut places = (0..columns).flat_map(|j| (first(j)..rows).map(move |i| (i, j)));
    let in_array = if header.symmetric && rows == columns { rows * (rows + 1) / 2 } else { rows * columns };
    let expected = if header.coordinate { sizes[2] } else { in_array };
    let mut entries = Vec::with_capacity(expected);
    let mut seen = std::collections::HashSet::new();
    for (number, line) in lines {
        if entries.len() == expected {
            return Err(error(number, format!("found more than the {expected} entries announced"), ""));
        }
        let entry = if header.coordinate {
            let (i, j, value) = header.coordinate_entry(number, line, [rows, columns])?;
            if !seen.insert((i, j)) {
                return Err(error(
                    number,
                    format!("row {}, column {} is given twice", i + 1, j + 1),
                    "give every entry once",
                ));
            }
            (i, j, value)
        } else {
            // As many places as entries are expected.
            let (i, j) = places.next().unwrap_or_default();
            (i, j, real(number, words::<&str>(number, line, 1)?[0])?)
        };
        entries.push(entry);
    }
    if entries.len() < expected {
        return Err(error(last, format!("the file ends after {} of {expected} entries", entries.len()), ""));
    }
    Ok(Entries { rows, symmetric: header.symmetric, entries })
}

struct Header {
    coordinate: bool,
    symmetric: bool,
}

impl Header {
    fn parse(banner: &str) -> Result<Self, String> {
        let lower = banner.to_ascii_lowercase();
        let words: Vec<&str> = lower.split_whitespace().collect();
        let ["%%matrixmarket", "matrix", layout, field, symmetry] = words[..] else {
            return Err("this is not a Matrix Market file".into());
        };
        let coordinate = match layout {
            "coordinate" => true,
            "array" => false,
            other => {
                return Err(format!("unknown layout `{other}`, expected array or coordinate"));
            }
        };
        if !matches!(field, "real" | "integer" | "double") {
            return Err(format!("entries are `{field}`, expected real or integer"));
        }
        let symmetric = match symmetry {
            "symmetric" => true,
            "general" => false,
            other => {
                return Err(format!("the matrix is `{other}`, expected general or symmetric"));
            }
        };
        Ok(Header { coordinate, symmetric })
    }

    fn coordinate_entry(
        &self,
        number: usize,
        line: &str,
        [rows, columns]: [usize; 2],
    ) -> Result<(usize, usize, f64), MatrixError> {
        let parts = words::<&str>(number, line, 3)?;
        let index = |word: &str, size: usize| {
            word.parse::<usize>()
                .ok()
                .filter(|index| (1..=size).contains(index))
                .map(|index| index - 1)
                .ok_or_else(|| error(number, format!("`{word}` is not a row or column, expected 1 to {size}"), ""))
        };
        let (i, j) = (index(parts[0], rows)?, index(parts[1], columns)?);
        if self.symmetric && j > i {
            return Err(error(
                number,
                format!("row {}, column {} lies above the diagonal", i + 1, j + 1),
                "a symmetric file holds the lower triangle only",
            ));
        }
        Ok((i, j, real(number, parts[2])?))
    }
}

fn real(number: usize, word: &str) -> Result<f64, MatrixError> {
    // The same bound as for numbers of a scenario: squares must stay finite.
    word.parse::<f64>()
        .ok()
        .filter(|value| value.abs() <= 1e150)
        .ok_or_else(|| error(number, format!("expected a finite number, found `{}`", shortened(word)), ""))
}

fn words<'l, T: TryFromWord<'l>>(number: usize, line: &'l str, count: usize) -> Result<Vec<T>, MatrixError> {
    let found: Vec<&str> = line.split_whitespace().collect();
    if found.len() != count {
        let message = format!("expected {count} numbers on this line, found {}", found.len());
        return Err(error(number, message, ""));
    }
    found
        .into_iter()
        .map(|word| {
            T::try_from_word(word).ok_or_else(|| {
                let message = format!("expected a whole number, found `{}`", shortened(word));
                error(number, message, "")
            })
        })
        .collect()
}

trait TryFromWord<'l>: Sized {
    fn try_from_word(word: &'l str) -> Option<Self>;
}

impl TryFromWord<'_> for usize {
    fn try_from_word(word: &str) -> Option<Self> {
        word.parse().ok()
    }
}

impl<'l> TryFromWord<'l> for &'l str {
    fn try_from_word(word: &'l str) -> Option<Self> {
        Some(word)
    }
}

fn shortened(word: &str) -> String {
    word.chars().take(30).collect()
}

fn error(line: usize, message: impl Into<String>, help: &str) -> MatrixError {
    MatrixError {
        line,
        message: message.into(),
        help: if help.is_empty() { "correct this line of the matrix file".into() } else { help.into() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expected() -> Vec<Vec<f64>> {
        vec![vec![2.0, -1.0], vec![-1.0, 3.0]]
    }

    #[test]
    fn the_four_layouts_give_the_same_matrix() {
        for text in [
            "%%MatrixMarket matrix array real general\n2 2\n2\n-1\n-1\n3\n",
            "%%MatrixMarket matrix array real symmetric\n% remark\n2 2\n2\n-1\n3\n",
            "%%MatrixMarket matrix coordinate real general\n2 2 4\n1 1 2\n2 1 -1\n1 2 -1\n2 2 3e0\n",
            "%%MatrixMarket matrix coordinate integer symmetric\n2 2 3\n\n1 1 2\n2 1 -1\n2 2 3",
        ] {
            assert_eq!(read(text, Size::OfPairs { pairs: 1, tangents: 1 }).unwrap(), expected(), "{text}");
        }
        let general = "%%MatrixMarket matrix array real general\n2 2\n1\n2\n3\n4\n";
        assert_eq!(read(general, Size::Square).unwrap(), [[1.0, 3.0], [2.0, 4.0]]);
        let sparse = "%%MatrixMarket matrix coordinate real general\n2 2 1\n2 1 5\n";
        assert_eq!(read(sparse, Size::Square).unwrap(), [[0.0, 0.0], [5.0, 0.0]]);
    }

    #[test]
    fn what_a_file_claims_is_not_believed() {
        let banner = "%%MatrixMarket matrix";
        for (text, part) in [
            (format!("{banner} array real general\n2 3\n"), "2 × 3"),
            (format!("{banner} array real general\n0 0\n"), "0 × 0"),
            (format!("{banner} array real general\n3000000000 3000000000\n1\n"), "more than the file"),
            (format!("{banner} coordinate real general\n3000000000 3000000000 1\n1 1 1\n"), "memory"),
            (format!("{banner} coordinate real general\n2 2 99999999999\n1 1 1\n"), "more than the file"),
        ] {
            let error = read(&text, Size::Square).unwrap_err();
            assert_eq!(error.line, 2, "{text}: {error:?}");
            assert!(error.message.contains(part), "{text}: {error:?}");
        }
    }

    #[test]
    fn errors_name_their_line() {
        let banner = "%%MatrixMarket matrix coordinate real symmetric\n";
        for (text, line, part) in [
            ("".to_string(), 1, "not a Matrix Market file"),
            ("%%MatrixMarket matrix array complex general\n".into(), 1, "complex"),
            (banner.to_string(), 1, "sizes"),
            (format!("{banner}2 2\n"), 2, "expected 3 numbers"),
            (format!("{banner}999999999 999999999 1\n"), 2, "999999999 × 999999999"),
            (format!("{banner}2 2 1\n3 1 1.0\n"), 3, "`3`"),
            (format!("{banner}2 2 1\n1 2 1.0\n"), 3, "above the diagonal"),
            (format!("{banner}2 2 1\n1 1 nan\n"), 3, "finite"),
            (format!("{banner}2 2 2\n1 1 1\n1 1 1\n"), 4, "twice"),
            (format!("{banner}2 2 2\n1 1 1\n"), 3, "1 of 2"),
            (format!("{banner}2 2 1\n1 1 1\n2 2 1\n"), 4, "more than"),
        ] {
            let error = read(&text, Size::OfPairs { pairs: 1, tangents: 1 }).unwrap_err();
            assert_eq!(error.line, line, "{text}: {error:?}");
            assert!(error.message.contains(part), "{text}: {error:?}");
        }
    }
}
