//! Messages on standard input and output: a header with the length, then JSON (LSP §Base Protocol).

use lsp_server::Message;
use std::io::{self, BufRead, Read as _, Write};

/// Bytes of a message at most: a header that asks for more is not believed.
const LONGEST: usize = 256 << 20;

/// Bytes of a line of a header at most.
const LONGEST_LINE: u64 = 1 << 12;

/// What was read.
#[derive(Debug)]
pub(super) enum Frame {
    /// A message.
    Message(Message),
    /// Something that is none, and why.
    Malformed(String),
    /// The other side has closed the connection.
    End,
}

/// The next message.
///
/// # Errors
/// Standard input cannot be read.
pub(super) fn read(input: &mut impl BufRead) -> io::Result<Frame> {
    let mut length: Option<usize> = None;
    loop {
        let mut line = Vec::new();
        let read = input.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line)?;
        if read == 0 {
            return Ok(Frame::End);
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim();
        match (text.split_once(':'), length) {
            (Some((name, value)), _) if name.eq_ignore_ascii_case("Content-Length") => {
                length = value.trim().parse().ok().filter(|length| *length <= LONGEST);
            }
            (None, Some(length)) if text.is_empty() => return content(input, length),
            _ => {}
        }
    }
}

fn content(input: &mut impl BufRead, length: usize) -> io::Result<Frame> {
    let mut bytes = Vec::new();
    let read = input.take(length as u64).read_to_end(&mut bytes)?;
    if read < length {
        return Ok(Frame::End);
    }
    Ok(match serde_json::from_slice(&bytes) {
        Ok(message) => Frame::Message(message),
        Err(error) => Frame::Malformed(error.to_string()),
    })
}

/// Writes a message.
///
/// # Errors
/// Standard output cannot be written.
pub(super) fn write(output: &mut impl Write, message: &Message) -> io::Result<()> {
    message.write(output)?;
    output.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(text: &str) -> Vec<Frame> {
        let mut input = io::Cursor::new(text.as_bytes());
        let mut found = Vec::new();
        loop {
            match read(&mut input).expect("memory is readable") {
                Frame::End => return found,
                frame => found.push(frame),
            }
        }
    }

    #[test]
    fn what_is_no_message_is_passed() {
        let exit = r#"{"jsonrpc":"2.0","method":"exit"}"#;
        let good = format!("Content-Length: {}\r\n\r\n{exit}", exit.len());
        let text = format!(
            "Content-Length: 5\r\n\r\n{{\"a\":nonsense\nContent-Length: 99999999999999999999\r\n\r\n{good}"
        );
        let found = frames(&text);
        assert!(matches!(found.as_slice(), [Frame::Malformed(_), Frame::Message(_)]), "{found:?}");
        assert!(frames("Content-Length: 50\r\n\r\n{}").is_empty());
    }
}
