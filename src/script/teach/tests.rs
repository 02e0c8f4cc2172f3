//! Traces written, read and walked.

use super::sample::{self, POPULATION};
use super::{Step, Trace, TraceCursor, page, plain};
use base64::Engine as _;
use proptest::prelude::*;
use std::io::Read as _;

#[test]
fn every_step_as_text() {
    let mut walk = sample::walk();
    let mut text = String::new();
    loop {
        text.push_str(&format!("{}\n", plain::step(&walk)));
        if !walk.forward() || walk.number() > 0 {
            break;
        }
    }
    text.push_str(&plain::summary(&walk));
    assert!(text.lines().all(|line| line.chars().count() <= plain::WIDTH));
    sample::snapshots().bind(|| insta::assert_snapshot!("every_step_as_text", text));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn what_the_trace_computes_is_what_was_simulated(seed in 1u32..1_000_000, count in 1usize..12) {
        let run = sample::run(count, f64::from(seed));
        let trace = Trace::read(&run.bytes).unwrap();
        let read: Vec<&Vec<f64>> = trace.generations.iter().map(|g| &g.genes).collect();
        prop_assert_eq!(read, run.simulated.iter().collect::<Vec<_>>());
    }

    #[test]
    fn back_undoes_forward(moves in proptest::collection::vec(0u8..4, 0..40)) {
        let mut walk = sample::walk();
        for kind in moves {
            match kind {
                0 => walk.forward_phase(),
                1 => walk.forward_generation(),
                2 => walk.back(),
                _ => walk.forward(),
            };
            let before = (walk.number(), walk.progress());
            if walk.forward() {
                prop_assert!(walk.back());
                prop_assert_eq!((walk.number(), walk.progress()), before);
            }
        }
    }
}

#[test]
fn a_trace_is_small() {
    let generations = 200;
    let run = sample::run(generations, 12345.0);
    let genes = generations * POPULATION * 2;
    assert!(run.bytes.len() < 50 * genes, "{} bytes for {genes} genes", run.bytes.len());
}

#[test]
fn a_trace_cut_anywhere_is_read_up_to_there() {
    let bytes = sample::run(3, 12345.0).bytes;
    let mut generations = 0;
    for cut in 0..bytes.len() {
        match Trace::read(&bytes[..cut]) {
            Ok(trace) => {
                assert!(trace.generations.len() >= generations, "cut at {cut}");
                generations = trace.generations.len();
                let mut walk = TraceCursor::new(trace);
                while walk.forward() {
                    plain::step(&walk);
                }
                assert_eq!(walk.step(), Step::Stop);
            }
            Err(_) => assert_eq!(generations, 0, "cut at {cut}"),
        }
    }
    assert_eq!(generations, 3);
}

#[test]
fn damaged_traces_are_no_panic() {
    let bytes = sample::run(2, 12345.0).bytes;
    for at in (16..bytes.len()).step_by(5) {
        for flip in [1, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[at] ^= flip;
            if let Ok(trace) = Trace::read(&damaged) {
                let mut walk = TraceCursor::new(trace);
                while walk.forward() {
                    plain::step(&walk);
                }
            }
        }
    }
}

#[test]
fn damaged_traces_of_operators_are_no_panic() {
    let bytes = sample::operators();
    for at in 16..bytes.len() {
        for flip in [1, 2, 0x80, 0xff] {
            let mut damaged = bytes.clone();
            damaged[at] ^= flip;
            if let Ok(trace) = Trace::read(&damaged) {
                page::page(trace.clone(), None, None);
                let mut walk = TraceCursor::new(trace);
                while walk.forward() {
                    plain::step(&walk);
                }
            }
        }
    }
}

#[test]
fn a_page_is_whole_and_needs_no_network() {
    let trace = Trace::read(&sample::run(3, 12345.0).bytes).unwrap();
    let text = page::page(trace, Some(r#"{"parameters": []}"#), None);
    assert!(text.contains("default-src 'none'"), "the browser may load from elsewhere");
    // The policy refuses attributes with styles.
    assert!(!text.contains("style:") && !text.contains(" style="));
    assert!(!text.contains("src=") && !text.contains("@import") && !text.contains("url("));
    let data = text.split_once(r#"id="data">"#).unwrap().1.split_once("</script>").unwrap().0;
    let data: serde_json::Value = serde_json::from_str(data).unwrap();
    assert_eq!(data["generations"].as_array().unwrap().len(), 3);
    assert_eq!(data["parameters"][1], "slope");
    assert_eq!(data["y"], serde_json::json!([1.0, 4.0, 7.0]));
}

/// A run with so many generations of the sample's size; its best improves in each of the first ones.
#[test]
fn a_page_of_a_long_run_is_compressed_and_stays_small() {
    let trace = Trace::read(&sample::run(3000, 12345.0).bytes).unwrap();
    let text = page::page(trace, None, None);
    assert!(text.len() < 3_000_000, "{} bytes", text.len());
    let data = text.split_once(r#"id="packed-data">""#).unwrap().1.split_once('"').unwrap().0;
    let bytes = base64::engine::general_purpose::STANDARD.decode(data).unwrap();
    let mut json = String::new();
    flate2::read::GzDecoder::new(&bytes[..]).read_to_string(&mut json).unwrap();
    let data: serde_json::Value = serde_json::from_str(&json).unwrap();
    let numbers: Vec<u64> = data["generations"]
        .as_array()
        .unwrap()
        .iter()
        .map(|g| g["number"].as_u64().unwrap())
        .collect();
    let kept = &data["kept"];
    assert_eq!(kept["improvements"], kept["of"], "{kept}");
    assert_eq!(numbers.last(), Some(&3000));
    let first = kept["first"].as_u64().unwrap();
    assert!(first > 100 && numbers[..first as usize].iter().copied().eq(1..=first));
}
