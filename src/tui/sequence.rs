//! An escape sequence whose first byte came alone: on a slow line the rest of a key comes a moment after its ESC, which
//! the terminal library then takes for the key Esc.

use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// For this long after an Esc, what comes may belong to it. Nobody types `[` that quickly after Esc, and nobody sees
/// Esc come that much later.
pub const WAIT: Duration = Duration::from_millis(50);

/// What characters after an Esc make of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Joined {
    /// The sequence goes on.
    More,
    /// All of it is this key.
    Key(KeyCode),
    /// It begins a pasted text.
    Paste,
    /// All of it is nothing that the screen knows.
    Nothing,
    /// They do not belong together.
    Apart,
}

/// What follows an Esc, character by character.
pub fn join(after: &str) -> Joined {
    let mut characters = after.chars();
    let (lead, rest) = (characters.next(), characters.as_str());
    match (lead, rest) {
        (Some('[' | 'O'), "") => Joined::More,
        (Some('['), rest) => match rest.char_indices().next_back() {
            // parameters, then one final character
            Some(_) if rest == "200~" => Joined::Paste,
            Some((_, last)) if rest.len() < 24 && matches!(last, '0'..='9' | ';' | '<') => Joined::More,
            Some((at, last @ ('@'..='~'))) => named(&rest[..at], last).map_or(Joined::Nothing, Joined::Key),
            _ => Joined::Apart,
        },
        (Some('O'), rest) => match rest {
            "A" | "B" | "C" | "D" | "H" | "F" => named("", rest.chars().next().unwrap_or_default()),
            "P" => Some(KeyCode::F(1)),
            "Q" => Some(KeyCode::F(2)),
            "R" => Some(KeyCode::F(3)),
            "S" => Some(KeyCode::F(4)),
            _ => None,
        }
        .map_or(Joined::Apart, Joined::Key),
        _ => Joined::Apart,
    }
}

/// The key of a control sequence; held modifiers are passed over.
fn named(parameters: &str, last: char) -> Option<KeyCode> {
    let number = parameters.split(';').next().unwrap_or_default();
    Some(match (last, number) {
        ('A', _) => KeyCode::Up,
        ('B', _) => KeyCode::Down,
        ('C', _) => KeyCode::Right,
        ('D', _) => KeyCode::Left,
        ('H', _) | ('~', "1" | "7") => KeyCode::Home,
        ('F', _) | ('~', "4" | "8") => KeyCode::End,
        ('Z', _) => KeyCode::BackTab,
        ('~', "2") => KeyCode::Insert,
        ('~', "3") => KeyCode::Delete,
        ('~', "5") => KeyCode::PageUp,
        ('~', "6") => KeyCode::PageDown,
        _ => return None,
    })
}

/// The events that `first` and what `next` gives within [`WAIT`] stand for.
///
/// # Errors
/// Those of `next`.
pub fn joined<E>(first: Event, mut next: impl FnMut() -> Result<Option<Event>, E>) -> Result<Vec<Event>, E> {
    let mut events = vec![first];
    if character(&events[0]) != Some(KeyCode::Esc) {
        return Ok(events);
    }
    let mut after = String::new();
    while let Some(event) = next()? {
        let code = character(&event);
        events.push(event);
        let Some(KeyCode::Char(c)) = code else { break };
        after.push(c);
        match join(&after) {
            Joined::More => {}
            Joined::Key(code) => return Ok(vec![Event::Key(KeyEvent::new(code, KeyModifiers::NONE))]),
            Joined::Paste => return pasted(next),
            Joined::Nothing => return Ok(Vec::new()),
            Joined::Apart => break,
        }
    }
    Ok(events)
}

/// A pasted text whose end is marked by nothing but a pause.
fn pasted<E>(mut next: impl FnMut() -> Result<Option<Event>, E>) -> Result<Vec<Event>, E> {
    let mut text = String::new();
    let mut last = None;
    while let Some(event) = next()? {
        match character(&event) {
            Some(KeyCode::Char(c)) => text.push(c),
            Some(KeyCode::Enter) => text.push('\n'),
            Some(KeyCode::Tab) => text.push('\t'),
            _ => {
                last = Some(event);
                break;
            }
        }
    }
    Ok([Event::Paste(text)].into_iter().chain(last).collect())
}

/// The key of an event that may be a byte of a sequence.
fn character(event: &Event) -> Option<KeyCode> {
    match event {
        Event::Key(key)
            if key.kind == KeyEventKind::Press && key.modifiers.difference(KeyModifiers::SHIFT).is_empty() =>
        {
            Some(key.code)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(code: KeyCode) -> Event {
        Event::Key(KeyEvent::new(code, KeyModifiers::NONE))
    }

    /// What an Esc and characters after it become, and what is left of them.
    fn after_esc(text: &str) -> (Vec<Event>, String) {
        let mut rest = text.chars();
        let found = joined(key(KeyCode::Esc), || Ok::<_, ()>(rest.next().map(|c| key(KeyCode::Char(c)))));
        (found.unwrap(), rest.collect())
    }

    #[test]
    fn a_key_in_two_pieces_is_one() {
        for (text, code) in [
            ("[A", KeyCode::Up),
            ("OB", KeyCode::Down),
            ("[1;5C", KeyCode::Right),
            ("[5~", KeyCode::PageUp),
            ("[3~", KeyCode::Delete),
            ("[Z", KeyCode::BackTab),
            ("OP", KeyCode::F(1)),
        ] {
            assert_eq!(after_esc(&format!("{text}q")), (vec![key(code)], "q".to_owned()), "{text}");
        }
        // none of a pasted text is taken for keys
        assert_eq!(after_esc("[200~set q 1").0, [Event::Paste("set q 1".to_owned())]);
        // a click of the mouse in two pieces is lost, and none of it is taken for keys
        assert_eq!(after_esc("[<0;12;5Mq"), (Vec::new(), "q".to_owned()));
    }

    #[test]
    fn an_esc_before_other_keys_stays_one() {
        let keys = |text: &str| -> Vec<Event> {
            [key(KeyCode::Esc)].into_iter().chain(text.chars().map(|c| key(KeyCode::Char(c)))).collect()
        };
        for text in ["", "q", "[", "Ox", "[ü"] {
            assert_eq!(after_esc(text), (keys(text), String::new()), "{text}");
        }
        assert_eq!(after_esc("q["), (keys("q"), "[".to_owned()));
        let other =
            joined(key(KeyCode::Char('x')), || -> Result<Option<Event>, ()> { panic!("nothing is waited for") });
        assert_eq!(other, Ok(vec![key(KeyCode::Char('x'))]));
    }
}
