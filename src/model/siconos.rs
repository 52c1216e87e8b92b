//! LCPs in the text format of Siconos (`linearComplementarity_printInFile`, `NM_write_in_file`): n, the storage of M
//! (0 dense, 1 sparse blocks, 2 sparse), its sizes, its entries, then q. Dense matrices and blocks stand column by
//! column, as in Fortran; blocks and sparse entries are counted from 0.

use super::memory;

/// Larger numbers are refused: their squares must stay finite (as everywhere in scenarios).
const LARGEST: f64 = 1e150;

/// M by rows, and q.
#[derive(Clone, Debug, PartialEq)]
pub struct SiconosLcp {
    /// n × n.
    pub matrix: Vec<Vec<f64>>,
    /// n.
    pub q: Vec<f64>,
}

/// What is wrong, and on which line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct SiconosError {
    /// From 1.
    pub line: usize,
    /// What was found and expected.
    pub message: String,
}

/// Words with their lines.
struct Words<'t> {
    words: std::iter::Peekable<std::vec::IntoIter<(usize, &'t str)>>,
    /// How many there were.
    count: usize,
    line: usize,
}

/// Reads the text of a file.
///
/// # Errors
/// What does not fit, with its line.
pub fn read(text: &str) -> Result<SiconosLcp, SiconosError> {
    let all: Vec<(usize, &str)> = text
        .lines()
        .enumerate()
        .flat_map(|(line, text)| text.split_whitespace().map(move |word| (line + 1, word)))
        .collect();
    let mut words = Words { count: all.len(), words: all.into_iter().peekable(), line: 1 };
    let n = words.whole("the number of rows n")?;
    if n == 0 {
        return Err(words.error("n is 0: an LCP has at least one row".into()));
    }
    // Each row has an entry of q at least.
    if n > words.count {
        return Err(words.error(format!("n is {n}, but the file has only {} numbers", words.count)));
    }
    if let Some(refusal) = memory::refusal(memory::for_joints(n as f64)) {
        return Err(words.error(format!("an LCP of {n} rows {refusal}")));
    }
    let storage = words.whole("the storage of M (0 dense, 1 sparse blocks, 2 sparse)")?;
    words.square(n)?;
    let mut matrix = vec![vec![0.0; n]; n];
    match storage {
        0 => {
            words.square(n)?;
            for j in 0..n {
                for row in &mut matrix {
                    row[j] = words.real(&format!("an entry of column {} of M", j + 1))?;
                }
            }
        }
        1 => words.blocks(&mut matrix)?,
        2 => words.sparse(&mut matrix)?,
        other => return Err(words.error(format!("the storage of M is {other}, expected 0, 1 or 2"))),
    }
    let q = (0..n).map(|i| words.real(&format!("entry {} of q", i + 1))).collect::<Result<_, _>>()?;
    if let Some((line, word)) = words.words.next() {
        return Err(SiconosError { line, message: format!("`{}` follows after the {n} entries of q", short(word)) });
    }
    Ok(SiconosLcp { matrix, q })
}

impl<'t> Words<'t> {
    fn error(&self, message: String) -> SiconosError {
        SiconosError { line: self.line, message }
    }

    fn next(&mut self, what: &str) -> Result<&'t str, SiconosError> {
        match self.words.next() {
            Some((line, word)) => {
                self.line = line;
                Ok(word)
            }
            None => Err(self.error(format!("the file ends where {what} is expected"))),
        }
    }

    fn whole(&mut self, what: &str) -> Result<usize, SiconosError> {
        let word = self.next(what)?;
        word.parse().map_err(|_| self.error(format!("expected {what}, found `{}`", short(word))))
    }

    fn real(&mut self, what: &str) -> Result<f64, SiconosError> {
        let word = self.next(what)?;
        let value: Option<f64> = word.parse().ok().filter(|value: &f64| value.abs() <= LARGEST);
        value.ok_or_else(|| self.error(format!("expected {what}, a finite number, found `{}`", short(word))))
    }

    /// Rows and columns of M.
    fn square(&mut self, n: usize) -> Result<(), SiconosError> {
        let (rows, columns) = (self.whole("the number of rows of M")?, self.whole("the number of columns of M")?);
        if (rows, columns) == (n, n) {
            return Ok(());
        }
        Err(self.error(format!("M is {rows} × {columns}, expected {n} × {n}")))
    }

    /// Ends of the blocks, the last of them n.
    fn ends(&mut self, count: usize, n: usize, what: &str) -> Result<Vec<usize>, SiconosError> {
        let mut ends: Vec<usize> = Vec::new();
        for _ in 0..count {
            let end = self.whole(&format!("the end of a block of {what}"))?;
            let before = ends.last().copied().unwrap_or(0);
            if end <= before || end > n {
                return Err(
                    self.error(format!("a block of {what} ends at {end}, expected more than {before} and at most {n}"))
                );
            }
            ends.push(end);
        }
        if ends.last() != Some(&n) {
            return Err(self.error(format!("the blocks do not cover all {n} {what}")));
        }
        Ok(ends)
    }

    /// Sparse blocks (compressed rows of blocks).
    fn blocks(&mut self, matrix: &mut [Vec<f64>]) -> Result<(), SiconosError> {
        let n = matrix.len();
        let count = self.whole("the number of blocks")?;
        if count == 0 {
            return Ok(());
        }
        let (down, across) =
            (self.whole("the number of rows of blocks")?, self.whole("the number of columns of blocks")?);
        let rows = self.ends(down, n, "rows")?;
        let columns = self.ends(across, n, "columns")?;
        let (filled_rows, filled) =
            (self.whole("the length of the row index")?, self.whole("the length of the column index")?);
        if filled != count || filled_rows > down + 1 || filled_rows == 0 {
            let message = format!(
                "the indices have {filled_rows} and {filled} entries, expected at most {} and {count}",
                down + 1
            );
            return Err(self.error(message));
        }
        let mut starts = Vec::new();
        for _ in 0..filled_rows {
            let start = self.whole("an entry of the row index")?;
            if start > count || starts.last().is_some_and(|before| *before > start) {
                return Err(self.error(format!("the row index goes to {start}, expected to rise to at most {count}")));
            }
            starts.push(start);
        }
        let mut of_column = Vec::new();
        for _ in 0..count {
            let column = self.whole("an entry of the column index")?;
            if column >= across {
                return Err(self.error(format!("there is no column {column} of blocks, expected 0 to {}", across - 1)));
            }
            of_column.push(column);
        }
        let start = |ends: &[usize], block: usize| if block == 0 { 0 } else { ends[block - 1] };
        for (row, pair) in starts.windows(2).enumerate() {
            for (block, &column) in of_column.iter().enumerate().take(pair[1]).skip(pair[0]) {
                let number = self.whole("the number of a block")?;
                if number != block {
                    return Err(self.error(format!("block {number} stands where block {block} is expected")));
                }
                for j in start(&columns, column)..columns[column] {
                    for entries in &mut matrix[start(&rows, row)..rows[row]] {
                        entries[j] = self.real(&format!("an entry of block {block}"))?;
                    }
                }
            }
        }
        if starts.last() != Some(&count) {
            return Err(self.error(format!("the row index ends before block {count}")));
        }
        Ok(())
    }

    /// Sparse, as CSparse prints it: a line of its version, a line of sizes, triplets or columns.
    fn sparse(&mut self, matrix: &mut [Vec<f64>]) -> Result<(), SiconosError> {
        let n = matrix.len();
        let origin = self.whole("the kind of sparse storage (1 triplets, 2 columns, 3 rows)")?;
        // "CSparse Version 3.1.4, …", then "triplet: 3-by-3, nzmax: 9 nnz: 5" or "3-by-3, nzmax: 9 nnz: 5, 1-norm: 2".
        let mut triplets = false;
        let (rows, columns) = loop {
            let word = self.next("the sizes, like 3-by-3")?;
            triplets |= word == "triplet:";
            if let Some(sizes) = word.trim_end_matches(',').split_once("-by-") {
                break sizes;
            }
        };
        if (rows.parse(), columns.parse()) != (Ok(n), Ok(n)) {
            return Err(self.error(format!("M is {} × {}, expected {n} × {n}", short(rows), short(columns))));
        }
        self.word("nzmax:")?;
        self.next("a number after `nzmax:`")?;
        self.word("nnz:")?;
        let word = self.next("the number of entries")?;
        let count: usize = word
            .trim_end_matches(',')
            .parse()
            .map_err(|_| self.error(format!("expected the number of entries, found `{}`", short(word))))?;
        if self.words.next_if(|(_, word)| *word == "1-norm:").is_some() {
            self.next("the norm")?;
        }
        let entries = if triplets { self.triplets(n, count)? } else { self.compressed(n, count)? };
        for (i, j, value) in entries {
            // CSparse prints the rows of such a matrix as columns.
            let (i, j) = if origin == 3 && !triplets { (j, i) } else { (i, j) };
            matrix[i][j] += value;
        }
        Ok(())
    }

    /// "0 1 : 2.5" an entry.
    fn triplets(&mut self, n: usize, count: usize) -> Result<Vec<(usize, usize, f64)>, SiconosError> {
        let mut entries = Vec::new();
        for _ in 0..count {
            let (i, j) = (self.index(n, "row")?, self.index(n, "column")?);
            self.word(":")?;
            entries.push((i, j, self.real("an entry of M")?));
        }
        Ok(entries)
    }

    /// "col 0 : locations 0 to 1", then "0 : 2.5" an entry.
    fn compressed(&mut self, n: usize, count: usize) -> Result<Vec<(usize, usize, f64)>, SiconosError> {
        let mut entries = Vec::new();
        for j in 0..n {
            self.word("col")?;
            let number = self.index(n, "column")?;
            if number != j {
                return Err(self.error(format!("column {number} stands where column {j} is expected")));
            }
            self.word(":")?;
            self.word("locations")?;
            let first = self.whole("the first location")?;
            self.word("to")?;
            // An empty column ends before it begins.
            let word = self.next("the last location")?;
            let end = word.parse::<i64>().ok().and_then(|last| usize::try_from(last.checked_add(1)?).ok());
            let seen = entries.len();
            let Some(end) = end.filter(|end| first == seen && (first..=count).contains(end)) else {
                let message = format!("column {j} has the locations {first} to {}, expected {seen} on", short(word));
                return Err(self.error(message));
            };
            for _ in first..end {
                let i = self.index(n, "row")?;
                self.word(":")?;
                entries.push((i, j, self.real("an entry of M")?));
            }
        }
        if entries.len() < count {
            return Err(self.error(format!("there are {} entries, expected {count}", entries.len())));
        }
        Ok(entries)
    }

    fn index(&mut self, n: usize, what: &str) -> Result<usize, SiconosError> {
        let index = self.whole(&format!("the number of a {what}"))?;
        if index < n {
            return Ok(index);
        }
        Err(self.error(format!("there is no {what} {index}, expected 0 to {}", n - 1)))
    }

    fn word(&mut self, expected: &str) -> Result<(), SiconosError> {
        let word = self.next(&format!("`{expected}`"))?;
        if word == expected {
            Ok(())
        } else {
            Err(self.error(format!("expected `{expected}`, found `{}`", short(word))))
        }
    }
}

fn short(word: &str) -> String {
    word.chars().take(30).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// [[2, 1], [0, 3]], q = (−5, −6.5).
    fn expected() -> SiconosLcp {
        SiconosLcp { matrix: vec![vec![2.0, 1.0], vec![0.0, 3.0]], q: vec![-5.0, -6.5] }
    }

    #[test]
    fn all_storages_give_the_same_lcp() {
        for text in [
            // Column by column.
            "2\n0\n2\n2\n2\t2\n2 0\n1 3\n-5.0 -6.5\n",
            // One block, and four of them without the zero one.
            "2\n1\n2\n2\n1\n1\n1\n2\t\n2\t\n2\n1\n0\t1\t\n0\t\n0\n 2e0\n 0\n 1.0\n 3.0\n -5 -6.5 ",
            "2\n1\n2\n2\n3\n2\n2\n1\t2\t\n1\t2\t\n3\n3\n0\t2\t3\t\n0\t1\t1\t\n0\n2\n1\n1\n2\n3\n-5 -6.5",
            // Triplets, columns, rows.
            "2\n2\n2\n2\n1\nCSparse Version 3.1.4, Oct 10, 2014.  Copyright (c) Timothy A. Davis, 2006-2014\n\
             triplet: 2-by-2, nzmax: 4 nnz: 3\n    0 0 : 2\n    0 1 : 1\n    1 1 : 3.0\n-5 -6.5\n",
            "2\n2\n2\n2\n2\nCSparse Version 3.1.4, Oct 10, 2014.  Copyright (c) Timothy A. Davis\n\
             2-by-2, nzmax: 3 nnz: 3, 1-norm: 4\n    col 0 : locations 0 to 0\n      0 : 2\n    \
             col 1 : locations 1 to 2\n      0 : 1\n      1 : 3\n-5 -6.5\n",
            "2\n2\n2\n2\n3\nCSparse Version 3.1.4\n2-by-2, nzmax: 3 nnz: 3, 1-norm: 4\n    col 0 : locations 0 to 1\n      \
             0 : 2\n      1 : 1\n    col 1 : locations 2 to 2\n      1 : 3\n-5 -6.5\n",
        ] {
            assert_eq!(read(text), Ok(expected()), "{text}");
        }
    }

    #[test]
    fn errors_name_their_line() {
        for (text, line, part) in [
            ("", 1, "ends where the number of rows n"),
            ("x", 1, "found `x`"),
            ("0", 1, "at least one row"),
            ("3000000000\n0", 1, "only 2 numbers"),
            ("1\n7\n1\n1", 4, "storage of M is 7"),
            ("2\n0\n2\n3\n", 4, "2 × 3"),
            ("1\n0\n1\n1\n1 1\n1e999\n0", 6, "finite"),
            ("1\n0\n1\n1\n1 1\n2", 6, "entry 1 of q"),
            ("1\n0\n1\n1\n1 1\n2\n3\n4 5", 8, "`4` follows"),
            ("2\n1\n2\n2\n1\n1\n1\n3\n", 8, "ends at 3"),
            ("2\n2\n2\n2\n1\nCSparse\ntriplet: 2-by-2, nzmax: 1 nnz: 1\n 5 0 : 1\n0 0", 8, "no row 5"),
            ("2\n2\n2\n2\n1\nCSparse\ntriplet: 2-by-2, nzmax: 1 nnz: 1\n 0 0 1\n0 0", 8, "expected `:`"),
        ] {
            let error = read(text).unwrap_err();
            assert_eq!(error.line, line, "{text}: {error}");
            assert!(error.message.contains(part), "{text}: {error}");
        }
    }
}
