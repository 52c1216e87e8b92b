//! The legend of a picture of signs.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr;

use crate::tui::theme::Look;
use crate::view::style::Role;

/// The signs of a picture: those of one meaning together.
#[derive(Default)]
pub struct Legend(Vec<(String, Role, String)>);

impl Legend {
    /// This sign has this meaning.
    pub fn note(&mut self, sign: char, role: Role, word: &str) {
        match self.0.iter_mut().find(|(_, r, w)| *r == role && w == word) {
            Some((signs, ..)) if signs.contains(sign) => {}
            Some((signs, ..)) => signs.push(sign),
            None => self.0.push((sign.to_string(), role, word.to_owned())),
        }
    }

    /// States of pairs first: they are what one looks for.
    pub fn sort(&mut self) {
        self.0.sort_by_key(|(_, role, word)| match (role, word.as_str()) {
            (Role::State(_), _) => 0,
            (_, "load") => 1,
            (_, "before") => 2,
            (_, "undeformed") => 4,
            _ => 3,
        });
    }

    /// Draws it into the last row.
    pub fn draw(&self, look: Look, area: Rect, buffer: &mut Buffer) {
        let mut x = area.x;
        let y = area.bottom().saturating_sub(1);
        for (sign, role, word) in &self.0 {
            let room = usize::from(area.right().saturating_sub(x)).saturating_sub(sign.chars().count() + 1);
            let whole = look.text(word);
            // without its amount sooner than without its name; half a number would be another number
            let name = whole.split_once(" up to ").map(|(name, _)| name.to_owned());
            let Some(word) = [Some(whole), name].into_iter().flatten().find(|word| word.width() <= room) else {
                break;
            };
            let room = usize::from(area.right() - x);
            let (after, _) = buffer.set_stringn(x, y, sign, room, look.role(*role));
            let text = format!(" {word}");
            let room = usize::from(area.right().saturating_sub(after));
            let (after, _) = buffer.set_stringn(after, y, text, room, look.role(Role::Muted));
            x = after.saturating_add(3).min(area.right());
        }
    }
}
