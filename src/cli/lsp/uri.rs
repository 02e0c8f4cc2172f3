//! Names of files in the protocol.

use lsp_types::Uri;
use percent_encoding::{AsciiSet, CONTROLS, percent_decode_str, utf8_percent_encode};
use std::path::{Path, PathBuf};

/// What the path of a URI does not contain as it is (RFC 3986 §3.3). Editors write the colon of a
/// drive as `%3A`.
const ESCAPED: &AsciiSet = &CONTROLS
    .add(b' ')
    .add(b'"')
    .add(b'#')
    .add(b'%')
    .add(b':')
    .add(b'<')
    .add(b'>')
    .add(b'?')
    .add(b'[')
    .add(b'\\')
    .add(b']')
    .add(b'^')
    .add(b'`')
    .add(b'{')
    .add(b'|')
    .add(b'}');

/// The path of a `file:` name; `None` for others, such as those of documents never saved, and for those
/// of other machines (RFC 8089 §2): a part of the path in the place of the machine would name a file
/// far above the one that was meant.
pub(crate) fn path(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.as_str().strip_prefix("file://")?;
    let (machine, path) = rest.split_at(rest.find('/')?);
    if !(machine.is_empty() || machine.eq_ignore_ascii_case("localhost")) {
        return None;
    }
    let decoded = percent_decode_str(path).decode_utf8().ok()?;
    let is_drive =
        matches!(decoded.as_bytes(), [b'/', letter, b':', ..] if letter.is_ascii_alphabetic());
    Some(PathBuf::from(if cfg!(windows) && is_drive { &decoded[1..] } else { &decoded }))
}

/// The `file:` name of an absolute path; `None` for a relative one.
pub(crate) fn of_path(path: &Path) -> Option<Uri> {
    if !path.is_absolute() {
        return None;
    }
    let text = path.to_str()?;
    let text = if cfg!(windows) { text.replace('\\', "/") } else { text.to_owned() };
    let slash = if text.starts_with('/') { "" } else { "/" };
    format!("file://{slash}{}", utf8_percent_encode(&text, ESCAPED)).parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn paths_and_names_are_translated_back() {
        for text in ["/a/b.mo", "/Größe/a b#?%[1]:.mo", "/a\\b/😀.mos"] {
            let uri = of_path(Path::new(text)).expect("absolute");
            assert_eq!(path(&uri), Some(PathBuf::from(text)), "{}", uri.as_str());
        }
        assert_eq!(of_path(Path::new("a.mo")), None);
        for other in ["untitled:Untitled-1", "file://%2Fetc/passwd", "file://machine/a.mo"] {
            assert_eq!(path(&other.parse().expect("a name")), None, "{other}");
        }
        let local = path(&"file://localhost/a.mo".parse().expect("a name"));
        assert_eq!(local.as_deref(), Some(Path::new("/a.mo")));
    }
}
