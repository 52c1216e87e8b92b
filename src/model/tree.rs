//! The values of a JSON text with their places, in one list: 16 bytes for a value or a key, so that a file of many
//! numbers takes hardly more room than its text. Read in one pass, by the grammar of RFC 8259 with comments and trailing
//! commas: a matrix is millions of numbers.

/// As deep as values may lie in one another.
const DEEPEST: usize = 512;

/// What kind of value stands somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Object,
    Array,
    String,
    Number,
    Boolean,
    Null,
}

/// A value, or the key before one.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Byte offset in the text.
    start: u32,
    /// Number of the cell after this value and all that is in it.
    next: u32,
    /// Entries of an object or a list, bytes of anything else.
    extent: u32,
    kind: Kind,
}

/// See the module.
pub struct Tree<'t> {
    text: &'t str,
    /// In the order of the text; a key stands before its value.
    cells: Vec<Cell>,
    /// Cells of the strings that are written with escapes, ascending, and what they say.
    escaped: Vec<(u32, String)>,
}

impl<'t> Tree<'t> {
    /// Reads JSON in which comments and trailing commas may stand; `None` for anything else.
    pub fn read(text: &'t str) -> Option<Tree<'t>> {
        u32::try_from(text.len()).ok()?;
        // Behind each of these stands a value, or a key.
        let most = 1 + text.bytes().filter(|byte| matches!(byte, b'{' | b'[' | b',' | b':')).count();
        let tree = Tree { text, cells: Vec::with_capacity(most), escaped: Vec::new() };
        let mut reader = Reader { tree, bytes: text.as_bytes(), at: 0 };
        reader.value(0)?;
        let is_end = reader.next().is_none() && reader.at == text.len();
        is_end.then_some(reader.tree)
    }

    /// The outermost value.
    pub fn root(&self) -> Node<'_> {
        Node { tree: self, at: 0 }
    }
}

struct Reader<'t> {
    tree: Tree<'t>,
    bytes: &'t [u8],
    /// Offset of what is read next.
    at: usize,
}

impl Reader<'_> {
    /// The next byte behind blanks and comments, not taken; `None` at the end, and at a comment that does not end.
    fn next(&mut self) -> Option<u8> {
        loop {
            self.at += match &self.bytes[self.at..] {
                [b' ' | b'\n' | b'\r' | b'\t', ..] => 1,
                [b'/', b'/', rest @ ..] => {
                    2 + rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len())
                }
                [b'/', b'*', rest @ ..] => 4 + rest.windows(2).position(|two| two == b"*/")?,
                rest => return rest.first().copied(),
            };
        }
    }

    /// Puts the cell of what was read from `start` on down.
    fn cell(&mut self, kind: Kind, start: usize) -> usize {
        let at = self.tree.cells.len();
        let extent = (self.at - start) as u32;
        self.tree.cells.push(Cell { start: start as u32, next: at as u32 + 1, extent, kind });
        at
    }

    /// The value that comes next.
    fn value(&mut self, depth: usize) -> Option<()> {
        match self.next()? {
            b'{' => self.entries(Kind::Object, depth),
            b'[' => self.entries(Kind::Array, depth),
            b'"' => self.string(),
            b't' => self.word(Kind::Boolean, "true"),
            b'f' => self.word(Kind::Boolean, "false"),
            b'n' => self.word(Kind::Null, "null"),
            _ => self.number(),
        }
    }

    fn word(&mut self, kind: Kind, word: &str) -> Option<()> {
        let start = self.at;
        self.bytes[start..].starts_with(word.as_bytes()).then_some(())?;
        self.at += word.len();
        self.cell(kind, start);
        Some(())
    }

    fn takes(&mut self, one_of: &[u8]) -> bool {
        let found = self.bytes.get(self.at).is_some_and(|byte| one_of.contains(byte));
        self.at += usize::from(found);
        found
    }

    fn digits(&mut self) -> Option<()> {
        let count = self.bytes[self.at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        self.at += count;
        (count > 0).then_some(())
    }

    fn number(&mut self) -> Option<()> {
        let start = self.at;
        self.takes(b"-");
        // No digit follows a leading zero.
        if !self.takes(b"0") {
            self.digits()?;
        }
        if self.takes(b".") {
            self.digits()?;
        }
        if self.takes(b"eE") {
            self.takes(b"+-");
            self.digits()?;
        }
        self.cell(Kind::Number, start);
        Some(())
    }

    /// A string, from its quotation mark on.
    fn string(&mut self) -> Option<()> {
        let start = self.at;
        let mut is_plain = true;
        self.at += 1;
        loop {
            match self.bytes.get(self.at)? {
                b'"' => break,
                b'\\' => {
                    is_plain = false;
                    self.at += 2;
                }
                0..b' ' => return None,
                _ => self.at += 1,
            }
        }
        self.at += 1;
        let at = self.cell(Kind::String, start);
        if !is_plain {
            let says = serde_json::from_str(&self.tree.text[start..self.at]).ok()?;
            self.tree.escaped.push((at as u32, says));
        }
        Some(())
    }

    /// An object or a list, from its bracket on.
    fn entries(&mut self, kind: Kind, depth: usize) -> Option<()> {
        if depth == DEEPEST {
            return None;
        }
        let at = self.cell(kind, self.at);
        let end = if kind == Kind::Object { b'}' } else { b']' };
        let mut count = 0;
        self.at += 1;
        while self.next()? != end {
            if kind == Kind::Object {
                (self.next()? == b'"').then_some(())?;
                self.string()?;
                (self.next()? == b':').then_some(())?;
                self.at += 1;
            }
            self.value(depth + 1)?;
            count += 1;
            match self.next()? {
                b',' => self.at += 1,
                byte if byte == end => {}
                _ => return None,
            }
        }
        self.at += 1;
        let next = self.tree.cells.len() as u32;
        let cell = &mut self.tree.cells[at];
        (cell.next, cell.extent) = (next, count);
        Some(())
    }
}

/// A value, or a key.
#[derive(Clone, Copy)]
pub struct Node<'d> {
    tree: &'d Tree<'d>,
    at: u32,
}

impl<'d> Node<'d> {
    fn cell(self) -> Cell {
        self.tree.cells[self.at as usize]
    }

    /// Its number among the values and keys of the text.
    pub fn number(self) -> u32 {
        self.at
    }

    /// The value or key of a [`number`](Node::number).
    pub fn numbered(self, number: u32) -> Node<'d> {
        Node { at: number, ..self }
    }

    pub fn kind(self) -> Kind {
        self.cell().kind
    }

    /// Byte offset of its first character; of a string, of its quotation mark.
    pub fn start(self) -> usize {
        self.cell().start as usize
    }

    /// As it is written: of a number, a string or a word.
    fn written(self) -> &'d str {
        let cell = self.cell();
        &self.tree.text[cell.start as usize..(cell.start + cell.extent) as usize]
    }

    /// What a string says.
    pub fn as_str(self) -> Option<&'d str> {
        if self.kind() != Kind::String {
            return None;
        }
        match self.tree.escaped.binary_search_by_key(&self.at, |escaped| escaped.0) {
            Ok(at) => Some(&self.tree.escaped[at].1),
            Err(_) => self.written().get(1..self.cell().extent as usize - 1),
        }
    }

    /// Whether a string is written without escapes, so that its characters stand one by one after the quotation mark.
    pub fn is_written_plainly(self) -> bool {
        self.as_str().is_some_and(|says| says.len() + 2 == self.cell().extent as usize)
    }

    /// The digits of a number.
    pub fn as_number(self) -> Option<&'d str> {
        (self.kind() == Kind::Number).then(|| self.written())
    }

    pub fn as_bool(self) -> Option<bool> {
        (self.kind() == Kind::Boolean).then(|| self.written() == "true")
    }

    /// The entries of a list; none of anything else.
    pub fn items(self) -> Entries<'d> {
        self.entries_of(Kind::Array)
    }

    /// The keys of an object and their values; none of anything else.
    pub fn properties(self) -> impl ExactSizeIterator<Item = (Node<'d>, Node<'d>)> {
        self.entries_of(Kind::Object).map(|key| (key, key.value()))
    }

    fn entries_of(self, kind: Kind) -> Entries<'d> {
        let left = if self.kind() == kind { self.cell().extent as usize } else { 0 };
        Entries { next: Node { at: self.at + 1, ..self }, left, keyed: kind == Kind::Object }
    }

    /// The value that follows a key.
    pub fn value(self) -> Node<'d> {
        Node { at: self.at + 1, ..self }
    }

    /// The value under a key; the first where the key stands twice.
    pub fn get(self, key: &str) -> Option<Node<'d>> {
        self.properties().find(|(name, _)| name.as_str() == Some(key)).map(|(_, value)| value)
    }
}

/// Entries of a list, or keys of an object.
#[derive(Clone)]
pub struct Entries<'d> {
    next: Node<'d>,
    left: usize,
    keyed: bool,
}

impl<'d> Iterator for Entries<'d> {
    type Item = Node<'d>;

    fn next(&mut self) -> Option<Node<'d>> {
        self.left = self.left.checked_sub(1)?;
        let entry = self.next;
        let value = if self.keyed { entry.value() } else { entry };
        self.next = Node { at: value.cell().next, ..entry };
        Some(entry)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for Entries<'_> {}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tree as serde_json has it.
    fn as_json(node: Node<'_>) -> serde_json::Value {
        match node.kind() {
            Kind::Object => node.properties().map(|(k, v)| (k.as_str().unwrap().to_owned(), as_json(v))).collect(),
            Kind::Array => node.items().map(as_json).collect(),
            Kind::String => node.as_str().unwrap().into(),
            Kind::Number => serde_json::from_str(node.as_number().unwrap()).unwrap(),
            Kind::Boolean => node.as_bool().unwrap().into(),
            Kind::Null => serde_json::Value::Null,
        }
    }

    #[test]
    fn the_tree_holds_what_the_text_says() {
        for text in [
            r#"{"a":[1,-2.5e3,[],{}],"b":{"c":null,"d":[true,false]},"":"" }"#,
            r#" [ "plain", "\u00e9\n\"x\"", "ü", {"k\ty": {"deep": [[[0]]]}} ] "#,
            "7",
        ] {
            let tree = Tree::read(text).unwrap();
            assert_eq!(as_json(tree.root()), serde_json::from_str::<serde_json::Value>(text).unwrap());
        }
    }

    #[test]
    fn places_are_those_of_the_text() {
        let text = "{ /* first */ \"a\": [1, \"b\\n\",],\n // x\n \"c\": { \"d\": 4 } , }";
        let tree = Tree::read(text).unwrap();
        let at = |part: &str| text.find(part).unwrap();
        let root = tree.root();
        let (key, list) = root.properties().next().unwrap();
        assert_eq!((key.start(), list.start(), list.items().len()), (at("\"a\""), at("[1"), 2));
        let string = list.items().nth(1).unwrap();
        assert_eq!((string.start(), string.as_str()), (at("\"b"), Some("b\n")));
        assert!(!string.is_written_plainly() && key.is_written_plainly());
        let four = root.get("c").and_then(|c| c.get("d")).unwrap();
        assert_eq!((four.start(), four.as_number()), (at("4 }"), Some("4")));
        assert!(root.get("d").is_none() && four.get("d").is_none() && four.items().len() == 0);
    }

    #[test]
    fn anything_else_is_no_tree() {
        for text in [
            "",
            " ",
            "{",
            "[1",
            "[1 2]",
            "{\"a\" 1}",
            "{\"a\":}",
            "{a:1}",
            "[,]",
            "{,}",
            "[1,,2]",
            "1 2",
            "[1}",
            "'a'",
            "+1",
            ".5",
            "NaN",
            "[1] /* open",
            "{\"a\":1 \"b\":2}",
            "{1:2}",
            "nul",
        ] {
            assert!(Tree::read(text).is_none(), "{text}");
        }
        let nested = |depth: usize| "[".repeat(depth) + &"]".repeat(depth);
        assert!(Tree::read(&nested(DEEPEST)).is_some() && Tree::read(&nested(DEEPEST + 1)).is_none());
    }
}
