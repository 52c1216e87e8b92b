//! A report as a list of blocks, written as Markdown or as one file of HTML.

use super::style::Style;
use super::table::{Align, Table};
use crate::text::number::{DIGITS, heading};
use crate::text::printable::{is_unprintable, xml as escaped};

/// Longer tables show this many rows of their beginning and of their end.
const ENDS: usize = 20;

/// A part of a report.
#[derive(Clone, Debug)]
pub enum Block {
    /// A heading of a section.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// A table; how to get the rows that are left out of a long one.
    Table(Table, &'static str),
    /// A figure in SVG: a short name, what it shows, its text.
    Figure {
        /// For the name of its file.
        name: String,
        /// What it shows.
        title: String,
        /// The picture.
        svg: String,
    },
}

/// A report.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Its title.
    pub title: String,
    /// Its parts.
    pub blocks: Vec<Block>,
}

/// Heads of a table and its rows as they are shown; `None` stands for those that are left out.
fn shown(table: &Table) -> (Vec<String>, Vec<Option<Vec<String>>>) {
    let columns = table.printed(DIGITS, &Style::default());
    let row = |index: usize| Some(columns.iter().map(|column| column.cells[index].trim().to_owned()).collect());
    let heads = columns.iter().map(|column| heading(&column.head, Some(&column.unit))).collect();
    let count = table.rows.len();
    // leaving out two rows and saying so saves nothing
    if count <= 2 * ENDS + 2 {
        return (heads, (0..count).map(row).collect());
    }
    (heads, (0..ENDS).map(row).chain([None]).chain((count - ENDS..count).map(row)).collect())
}

fn left_out(table: &Table, how: &str) -> String {
    format!("… {} rows left out: {how}", table.rows.len() - 2 * ENDS)
}

const STYLE: &str = "body{font-family:Helvetica,Arial,'DejaVu Sans',sans-serif;line-height:1.45;max-width:60rem;\
margin:2rem auto;padding:0 1.5rem;color:#1a1a1a}h1{font-size:1.5rem;margin-bottom:.3rem}h2{font-size:1.15rem;\
margin-top:2rem;border-bottom:1px solid #c8c8c8;padding-bottom:.2rem}table{border-collapse:collapse;font-size:.85rem;\
font-variant-numeric:tabular-nums;margin:.6rem 0}th,td{padding:.15rem .7rem;text-align:left;vertical-align:top}\
th{border-bottom:1.5px solid #767676}td{border-bottom:1px solid #e6e6e6}.n{text-align:right;white-space:nowrap}\
.more{color:#767676}figure{margin:1.2rem 0}svg{max-width:100%;height:auto}footer{margin-top:3rem;color:#767676;\
font-size:.8rem}@media print{figure,tr{break-inside:avoid}h2{break-after:avoid}}";

impl Report {
    /// One file of HTML, figures within it; `footer` stands at the end.
    pub fn html(&self, footer: &str) -> String {
        let mut text = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
             content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n<style>{STYLE}</style>\n</head>\n\
             <body>\n<h1>{0}</h1>\n",
            escaped(&self.title)
        );
        for block in &self.blocks {
            match block {
                Block::Heading(heading) => text.push_str(&format!("<h2>{}</h2>\n", escaped(heading))),
                Block::Text(words) => text.push_str(&format!("<p>{}</p>\n", html_text(words))),
                Block::Table(table, how) => text.push_str(&html_table(table, how)),
                Block::Figure { svg, .. } => text.push_str(&format!("<figure>\n{svg}</figure>\n")),
            }
        }
        text.push_str(&format!("<footer>{}</footer>\n</body>\n</html>\n", escaped(footer)));
        text
    }

    /// Markdown; `file` gives the name of the file of a figure.
    pub fn markdown(&self, footer: &str, file: &dyn Fn(&str) -> String) -> String {
        let mut text = format!("# {}\n\n", plain(&self.title));
        for block in &self.blocks {
            match block {
                Block::Heading(heading) => text.push_str(&format!("## {}\n\n", plain(heading))),
                Block::Text(words) => text.push_str(&format!("{}\n\n", plain(words))),
                Block::Table(table, how) => text.push_str(&markdown_table(table, how)),
                Block::Figure { name, title, .. } => {
                    text.push_str(&format!("![{}](<{}>)\n\n", plain(title), link(&file(name))));
                }
            }
        }
        text.push_str(&format!("---\n\n{}\n", plain(footer)));
        text
    }
}

/// Words with what stands in backticks as code, where they come in pairs.
fn html_text(words: &str) -> String {
    let parts: Vec<&str> = words.split('`').collect();
    if parts.len().is_multiple_of(2) {
        return escaped(words);
    }
    let part = |(index, part): (usize, &&str)| match index % 2 {
        0 => escaped(part),
        _ => format!("<code>{}</code>", escaped(part)),
    };
    parts.iter().enumerate().map(part).collect()
}

fn html_table(table: &Table, how: &str) -> String {
    let class = |index: usize| match table.columns.get(index).map(|column| column.align) {
        None | Some(Align::Left) => "",
        Some(_) => " class=\"n\"",
    };
    let line = |tag: &str, cells: &[String]| {
        let cells = cells.iter().enumerate().map(|(i, cell)| format!("<{tag}{}>{}</{tag}>", class(i), escaped(cell)));
        format!("<tr>{}</tr>\n", cells.collect::<String>())
    };
    let (heads, rows) = shown(table);
    let mut text = format!("<table>\n<thead>\n{}</thead>\n<tbody>\n", line("th", &heads));
    for row in rows {
        match row {
            Some(cells) => text.push_str(&line("td", &cells)),
            None => text.push_str(&format!(
                "<tr><td class=\"more\" colspan=\"{}\">{}</td></tr>\n",
                table.columns.len(),
                escaped(&left_out(table, how))
            )),
        }
    }
    text.push_str("</tbody>\n</table>\n");
    text
}

fn markdown_table(table: &Table, how: &str) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let (heads, rows) = shown(table);
    let mut text = line(heads.iter().map(|head| plain(head)).collect());
    let align = |column: &super::table::Column| if column.align == Align::Left { "---" } else { "---:" }.to_owned();
    text.push_str(&line(table.columns.iter().map(align).collect()));
    let mut cut = false;
    for row in rows {
        match row {
            Some(cells) => text.push_str(&line(cells.iter().map(|cell| plain(cell)).collect())),
            None => {
                cut = true;
                text.push_str(&line(table.columns.iter().map(|_| "…".to_owned()).collect()));
            }
        }
    }
    text.push('\n');
    if cut {
        text.push_str(&format!("{}\n\n", plain(&left_out(table, how))));
    }
    text
}

/// Text in Markdown: characters that would be markup are escaped; what steers a terminal is `?`, as in HTML.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#' | '~' | '&' => plain.extend(['\\', c]),
            '\n' | '\t' => plain.push(' '),
            c if is_unprintable(c) => plain.push('?'),
            c => plain.push(c),
        }
    }
    plain
}

/// The name of a file between < and > of a link: what cannot stand there is written by its bytes.
fn link(file: &str) -> String {
    let mut link = String::with_capacity(file.len());
    for c in file.chars() {
        if is_unprintable(c) || matches!(c, '<' | '>' | '\\' | '%') {
            let mut bytes = [0; 4];
            c.encode_utf8(&mut bytes).bytes().for_each(|byte| link.push_str(&format!("%{byte:02X}")));
        } else {
            link.push(c);
        }
    }
    link
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::table::{Cell, Column, Row};

    fn long() -> Table {
        let mut table = Table::new(vec![Column::words("pair"), Column::numbers("x_n", Some("kN".into()))]);
        table.rows =
            (0..100).map(|i| Row::new(vec![Cell::from(format!("j|{i}")), Cell::from(format!("{i}.5"))])).collect();
        table
    }

    #[test]
    fn nothing_that_steers_a_terminal_stands_in_a_report() {
        let hostile = "a\u{1b}[31m\u{9b}\u{202e}\u{2066}b\r\nc\u{7f}";
        let mut table = Table::new(vec![Column::words(hostile)]);
        table.rows = vec![Row::new(vec![Cell::from(hostile)])];
        let figure = Block::Figure { name: "slip".into(), title: hostile.into(), svg: String::new() };
        let blocks = vec![Block::Heading(hostile.into()), Block::Text(hostile.into()), Block::Table(table, ""), figure];
        let report = Report { title: hostile.into(), blocks };
        let file = |name: &str| format!("{hostile}>-{name}.svg");
        let markdown = report.markdown(hostile, &file);
        assert!(markdown.contains("b%0D%0Ac%7F%3E-slip.svg>)"), "{markdown}");
        for text in [markdown, report.html(hostile)] {
            assert!(text.chars().all(|c| c == '\n' || !is_unprintable(c)), "{text:?}");
            assert!(text.contains("b? c?") && !text.contains("b\n"), "{text}");
        }
    }

    #[test]
    fn a_long_table_shows_its_ends_and_says_what_is_left_out() {
        let text = Block::Text("`limit <a>` says so".into());
        let report = Report { title: "T<1>".into(), blocks: vec![text, Block::Table(long(), "`export pairs`")] };
        let html = report.html("end");
        assert!(html.contains("<p><code>limit &lt;a&gt;</code> says so</p>"), "{html}");
        assert!(html.contains("<title>T&lt;1&gt;</title>"));
        assert!(html.contains("<th class=\"n\">x_n [kN]</th>"));
        assert!(html.contains("colspan=\"2\">… 60 rows left out: `export pairs`"));
        assert_eq!(html.matches("<tr>").count(), 1 + 20 + 1 + 20);
        assert!(html.contains("<td>j|19</td>") && !html.contains("<td>j|20</td>") && html.contains("<td>j|80</td>"));
        let markdown = report.markdown("end", &|name| name.to_owned());
        assert!(markdown.starts_with("# T\\<1\\>\n"));
        assert!(markdown.contains("| j\\|19 | 19.5 |\n| … | … |\n| j\\|80 | 80.5 |"), "{markdown}");
    }
}
