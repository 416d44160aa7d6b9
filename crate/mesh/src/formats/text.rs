//! Texts of files, in whichever way they are written.

use std::borrow::Cow;

/// Decodes the text of a file: UTF-16 behind its byte-order mark, else UTF-8 with a mark or
/// without. What is neither becomes U+FFFD. Zeros at the end of UTF-8 are left out, and lines that
/// end with carriage returns alone end with line feeds.
#[must_use]
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    let text = match bytes {
        [0xFF, 0xFE, rest @ ..] => Cow::Owned(widen(rest, u16::from_le_bytes)),
        [0xFE, 0xFF, rest @ ..] => Cow::Owned(widen(rest, u16::from_be_bytes)),
        _ => {
            let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
            let end = text.iter().rposition(|byte| *byte != 0);
            String::from_utf8_lossy(&text[..end.map_or(0, |last| last + 1)])
        }
    };
    match text.contains('\r') && !text.contains('\n') {
        true => Cow::Owned(text.replace('\r', "\n")),
        false => text,
    }
}

/// Whether a file begins with the byte-order mark of UTF-16.
#[must_use]
pub fn is_wide(bytes: &[u8]) -> bool {
    matches!(bytes, [0xFF, 0xFE, ..] | [0xFE, 0xFF, ..])
}

/// Decodes UTF-16 of either order of bytes.
fn widen(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units)
        .map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}
