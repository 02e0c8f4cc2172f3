//! What is read and printed reads back as the same tree. Seeds: `tests/grammar/valid`.
#![no_main]

use gapilib::source::SourceId;
use gapilib::syntax::visit::{WithoutSpans, rewrite_script, rewrite_stored_definition};
use gapilib::syntax::{parse_script, parse_stored_definition, print};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    if let Ok(mut tree) = parse_script(SourceId::NONE, text) {
        let printed = print::script(&tree);
        let mut again = parse_script(SourceId::NONE, &printed).expect("the printed script is read");
        rewrite_script(&mut WithoutSpans, &mut tree);
        rewrite_script(&mut WithoutSpans, &mut again);
        assert_eq!(tree, again, "{printed}");
    }
    if let Ok(mut tree) = parse_stored_definition(SourceId::NONE, text) {
        let printed = print::stored_definition(&tree);
        let mut again =
            parse_stored_definition(SourceId::NONE, &printed).expect("the printed file is read");
        rewrite_stored_definition(&mut WithoutSpans, &mut tree);
        rewrite_stored_definition(&mut WithoutSpans, &mut again);
        assert_eq!(tree, again, "{printed}");
    }
});
