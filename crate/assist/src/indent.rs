//! Tab, Enter and Ctrl+/ in a text: indenting in steps of two blanks, going on with the
//! indentation of the line above, and turning lines into comments.
//!
//! Positions are bytes; a selection is a pair of them in any order.

/// A text after an edit, and the selection to show in it.
pub type Edited = (String, std::ops::Range<usize>);

const STEP: &str = "  ";

fn line_start(text: &str, position: usize) -> usize {
    text[..position]
        .rfind('\n')
        .map_or(0, |newline| newline + 1)
}

/// Applies a change to each line that the selection touches; `change` gives the line's new text.
fn each_line(
    text: &str,
    selection: std::ops::Range<usize>,
    change: impl Fn(&str) -> String,
) -> Edited {
    let start = line_start(text, selection.start);
    let end = text[selection.end..]
        .find('\n')
        .map_or(text.len(), |newline| selection.end + newline);
    let changed: Vec<String> = text[start..end].split('\n').map(change).collect();
    let block = changed.join("\n");
    let selected = start..start + block.len();
    (
        format!("{}{block}{}", &text[..start], &text[end..]),
        selected,
    )
}

/// Acts on Tab: adds two blanks, or moves all selected lines to the right.
#[must_use]
pub fn tab(text: &str, selection: std::ops::Range<usize>) -> Edited {
    if text[selection.clone()].contains('\n') {
        return each_line(text, selection, |line| {
            if line.is_empty() {
                String::new()
            } else {
                format!("{STEP}{line}")
            }
        });
    }
    let at = selection.start + STEP.len();
    (
        format!(
            "{}{STEP}{}",
            &text[..selection.start],
            &text[selection.end..]
        ),
        at..at,
    )
}

/// Acts on Shift+Tab: moves the touched lines to the left.
#[must_use]
pub fn back_tab(text: &str, selection: std::ops::Range<usize>) -> Edited {
    let single = !text[selection.clone()].contains('\n');
    let length = text.len();
    let (edited, selected) = each_line(text, selection.clone(), |line| {
        line.strip_prefix(STEP)
            .or_else(|| line.strip_prefix('\t'))
            .or_else(|| line.strip_prefix(' '))
            .unwrap_or(line)
            .to_owned()
    });
    if single {
        let removed = length - edited.len();
        let start = line_start(text, selection.start);
        let [from, to] = [selection.start, selection.end]
            .map(|position| position.saturating_sub(removed).max(start));
        return (edited, from..to);
    }
    (edited, selected)
}

/// Acts on Enter: begins a line with the indentation of the one before, one step deeper after `{`.
#[must_use]
pub fn enter(text: &str, selection: std::ops::Range<usize>) -> Edited {
    let line = &text[line_start(text, selection.start)..selection.start];
    let blanks = &line[..line.len() - line.trim_start_matches([' ', '\t']).len()];
    let deeper = if line.trim_end().ends_with('{') {
        STEP
    } else {
        ""
    };
    let at = selection.start + 1 + blanks.len() + deeper.len();
    (
        format!(
            "{}\n{blanks}{deeper}{}",
            &text[..selection.start],
            &text[selection.end..]
        ),
        at..at,
    )
}

/// Acts on `}`: on a line of blanks it goes one step to the left, below the line that it closes.
#[must_use]
pub fn brace(text: &str, selection: std::ops::Range<usize>) -> Edited {
    let start = line_start(text, selection.start);
    let blanks = &text[start..selection.start];
    let shorter = blanks
        .strip_suffix(STEP)
        .filter(|_| blanks.trim().is_empty())
        .unwrap_or(blanks);
    let at = start + shorter.len() + 1;
    (
        format!("{}{shorter}}}{}", &text[..start], &text[selection.end..]),
        at..at,
    )
}

/// Acts on Ctrl+/: comments the touched lines out, or in again if all of them are comments.
#[must_use]
pub fn comment(text: &str, selection: std::ops::Range<usize>) -> Edited {
    let start = line_start(text, selection.start);
    let end = text[selection.end..]
        .find('\n')
        .map_or(text.len(), |newline| selection.end + newline);
    let all = text[start..end]
        .split('\n')
        .all(|line| line.trim().is_empty() || line.trim_start().starts_with('#'));
    each_line(text, selection, |line| {
        let blanks = line.len() - line.trim_start().len();
        let (blanks, rest) = line.split_at(blanks);
        if rest.is_empty() {
            line.to_owned()
        } else if all {
            let rest = rest.trim_start_matches('#');
            format!("{blanks}{}", rest.strip_prefix(' ').unwrap_or(rest))
        } else {
            format!("{blanks}# {rest}")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tab_indents_at_the_cursor_and_moves_selected_lines() {
        assert_eq!(tab("ab", 1..1), (String::from("a  b"), 3..3));
        assert_eq!(tab("a\n\nb", 0..4).0, "  a\n\n  b");
        assert_eq!(back_tab("  a\n b\nc", 0..8).0, "a\nb\nc");
        assert_eq!(back_tab("x\n  äb", 6..6), (String::from("x\näb"), 4..4));
    }

    #[test]
    fn enter_goes_on_with_the_indentation() {
        assert_eq!(enter("  a b", 3..4), (String::from("  a\n  b"), 6..6));
        assert_eq!(enter("for i = 1 to 3 {", 16..16).0, "for i = 1 to 3 {\n  ");
        assert_eq!(enter("", 0..0), (String::from("\n"), 1..1));
    }

    #[test]
    fn a_closing_brace_stands_below_what_it_closes() {
        assert_eq!(brace("a {\n    ", 8..8), (String::from("a {\n  }"), 7..7));
        assert_eq!(brace("  a ", 4..4), (String::from("  a }"), 5..5));
        assert_eq!(brace("", 0..0), (String::from("}"), 1..1));
    }

    #[test]
    fn comments_come_and_go() {
        let (out, selected) = comment("a\n  b\n", 0..4);
        assert_eq!(out, "# a\n  # b\n");
        assert_eq!(comment(&out, selected).0, "a\n  b\n");
    }
}
