//! Which line of a script decides whether there is another generation: the head of the loop that
//! the generation is made in.

/// The line, from 1, of the innermost `for` or `while` that is open where `line` begins; `None`
/// where there is none.
pub(crate) fn loop_around(script: &[String], line: usize) -> Option<usize> {
    let mut open: Vec<usize> = Vec::new();
    let mut head = None;
    let mut after_end = false;
    let text = without_comments(&script[..script.len().min(line.saturating_sub(1))]);
    for (number, text) in (1..).zip(text.split('\n')) {
        for word in text.split(|c: char| !(c.is_alphanumeric() || c == '_')) {
            match word {
                "" => continue,
                "for" | "while" if after_end => drop(open.pop()),
                "for" | "while" => head = Some(number),
                "loop" => open.extend(head.take()),
                _ => {}
            }
            after_end = word == "end";
        }
    }
    open.last().copied()
}

/// The lines with blanks for comments and strings.
fn without_comments(lines: &[String]) -> String {
    let mut text = String::new();
    let mut inside: Option<&str> = None;
    let whole = lines.join("\n");
    let mut rest = whole.as_str();
    while let Some(c) = rest.chars().next() {
        let begins = ["//", "/*", "\""].into_iter().find(|begin| rest.starts_with(begin));
        let skipped = match (inside, begins) {
            (None, Some(begin)) => {
                inside = Some(match begin {
                    "//" => "\n",
                    "/*" => "*/",
                    _ => "\"",
                });
                begin.len()
            }
            (Some("\""), _) if c == '\\' => 1 + rest[1..].chars().next().map_or(0, char::len_utf8),
            (Some(end), _) if rest.starts_with(end) => {
                inside = None;
                if end == "\n" { 0 } else { end.len() }
            }
            _ => c.len_utf8(),
        };
        let (now, then) = rest.split_at(skipped);
        let kept =
            |c: char| if inside.is_none() && begins.is_none() || c == '\n' { c } else { ' ' };
        text.extend(now.chars().map(kept));
        rest = then;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(line: usize) -> Option<usize> {
        let script = "\
x := {k for k in 1:3}; // for ever
for Run in 1:2 loop
  while min(Fitness) > 1e-3 loop
    Eval
    for k in 1:3 loop print(\"end while \\\" loop\"); end for;
    /* for a
       loop */ Fit
  end while
  Report
end for
After";
        let lines: Vec<String> = script.lines().map(str::to_owned).collect();
        loop_around(&lines, line)
    }

    #[test]
    fn the_innermost_loop_is_found() {
        assert_eq!([around(1), around(2), around(11), around(99)], [None; 4]);
        assert_eq!([around(4), around(5), around(6), around(7), around(8)], [Some(3); 5]);
        assert_eq!([around(3), around(9), around(10)], [Some(2); 3]);
    }
}
