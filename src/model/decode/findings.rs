//! The problems found so far, and places to report them at.

use std::cell::{Cell, RefCell};

use crate::model::locate::Document;
use crate::model::problem::{LISTED, Problem, Problems};

/// Problems beyond this many are only counted.
const KEPT: usize = 10_000;

struct Finding {
    offset: usize,
    message: String,
    help: String,
}

/// The problems found so far.
#[derive(Default)]
pub struct Findings {
    kept: RefCell<Vec<Finding>>,
    total: Cell<usize>,
}

impl Findings {
    pub(super) fn add(&self, offset: usize, message: String, help: String) {
        let mut kept = self.kept.borrow_mut();
        // what is read twice is told once
        if kept.iter().any(|finding| finding.offset == offset && finding.message == message) {
            return;
        }
        self.total.set(self.total.get() + 1);
        if kept.len() < KEPT {
            kept.push(Finding { offset, message, help });
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.total.get()
    }

    /// The problems in the order of the file, each with its place; `None` without any.
    pub fn into_problems(self, file: &str, document: &Document<'_>) -> Option<Problems> {
        let total = self.total.get();
        let mut findings = self.kept.into_inner();
        if findings.is_empty() {
            return None;
        }
        findings.sort_by_key(|finding| finding.offset);
        findings.truncate(LISTED);
        let problems: Vec<Problem> = findings
            .into_iter()
            .map(|finding| {
                let (line, column) = document.position(finding.offset);
                Problem {
                    line,
                    column,
                    path: document.path_at(finding.offset),
                    message: finding.message,
                    help: finding.help,
                }
            })
            .collect();
        Some(Problems { file: file.to_string(), more: total - problems.len(), problems })
    }
}

/// A place in the text: a value or a key.
#[derive(Clone, Copy)]
pub struct Place<'d> {
    pub(super) offset: usize,
    pub(super) findings: &'d Findings,
}

impl Place<'_> {
    /// Reports a problem at this place.
    pub fn problem(self, message: impl Into<String>, help: impl Into<String>) {
        self.findings.add(self.offset, message.into(), help.into());
    }
}
