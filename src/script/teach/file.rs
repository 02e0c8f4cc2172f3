//! The file form of a trace: a line that names the format, then one frame for each event, its length
//! in four bytes (little endian) before its content. A file that ends within a frame, because the
//! run was killed, is read up to the last whole one.

use super::errors::BAD_TRACE;
use super::event::Event;
use crate::bail;
use crate::diag::Fault;

/// The first bytes of every trace; the number changes when events of older files would be read as
/// others. A new kind of event after the others changes nothing of that.
const MAGIC: &[u8] = b"gapilib trace 3\n";
/// No event is longer than this; a longer one is a damaged file.
const LONGEST: usize = 1 << 30;

/// What a trace begins with.
pub(crate) fn heading() -> Vec<u8> {
    MAGIC.to_vec()
}

/// Adds the frame of `event`.
pub(crate) fn push(frames: &mut Vec<u8>, event: &Event) {
    let at = frames.len();
    frames.extend([0; 4]);
    let all = postcard::to_extend(event, std::mem::take(frames));
    match all {
        Ok(all) => *frames = all,
        // Neither maps of unknown length nor foreign types occur in events.
        Err(error) => unreachable!("an event has a form as bytes: {error}"),
    }
    let length = (frames.len() - at - 4) as u32;
    frames[at..at + 4].copy_from_slice(&length.to_le_bytes());
}

/// The events of a file, and whether it ends with a whole frame.
///
/// # Errors
///
/// `bad-trace` when it does not begin as a trace.
pub(crate) fn read(bytes: &[u8]) -> Result<(Vec<Event>, bool), Fault> {
    let Some(mut rest) = bytes.strip_prefix(MAGIC) else {
        bail!(
            BAD_TRACE, "this is not a trace of gapilib, or one of another version";
            help: "record the run with `gapi run SCRIPT --trace FILE`"
        );
    };
    let mut events = Vec::new();
    while let Some((length, following)) = rest.split_first_chunk::<4>() {
        let length = u32::from_le_bytes(*length) as usize;
        let frame = following.get(..length).filter(|_| length <= LONGEST);
        match frame.and_then(|frame| postcard::from_bytes(frame).ok()) {
            Some(event) => events.push(event),
            None => return Ok((events, false)),
        }
        rest = &following[length..];
    }
    Ok((events, rest.is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teach::event::{Genes, ScriptLine};

    fn some_events() -> Vec<Event> {
        let place = ScriptLine { script: 0, line: 7 };
        vec![
            Event::Draw { place, seed: [12345.0; 6], count: 3 },
            Event::Simulate {
                place,
                n_genes: 1,
                genes: Genes::All(vec![0.5, f64::NAN]),
                failures: vec![(1, "too much".to_owned())],
            },
            Event::Full,
        ]
    }

    fn written(events: &[Event]) -> Vec<u8> {
        let mut bytes = heading();
        events.iter().for_each(|event| push(&mut bytes, event));
        bytes
    }

    #[test]
    fn what_is_written_is_read() {
        let (events, whole) = read(&written(&some_events())).unwrap();
        assert!(whole);
        assert_eq!(format!("{events:?}"), format!("{:?}", some_events()));
    }

    #[test]
    fn a_file_cut_anywhere_gives_the_events_before() {
        let bytes = written(&some_events());
        let ends: Vec<usize> = (0..=3).map(|k| written(&some_events()[..k]).len()).collect();
        for cut in MAGIC.len()..bytes.len() {
            let (events, whole) = read(&bytes[..cut]).unwrap();
            let expected = ends.iter().filter(|&&end| end <= cut).count() - 1;
            assert_eq!(events.len(), expected, "cut at {cut}");
            assert_eq!(whole, ends.contains(&cut), "cut at {cut}");
        }
    }

    #[test]
    fn another_file_is_refused() {
        assert_eq!(read(b"{}").unwrap_err().code, BAD_TRACE);
        assert_eq!(read(b"").unwrap_err().code, BAD_TRACE);
    }
}
