//! HTML pages that need nothing else: one document with its own style, scripts and data, and a
//! Content-Security-Policy that lets the browser load exactly these and nothing from a network.
//!
//! Pages are written with [maud](https://maud.lambda.xyz): templates are checked when the program is
//! compiled, and every value is escaped unless it is marked as markup. Style and script are allowed
//! by their SHA-256 digests (CSP level 3, §2.3.1), so that neither attributes with handlers or
//! styles nor anything that came in with the data can act.

use base64::Engine as _;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};

/// A page.
#[derive(Debug)]
pub struct Page<'a> {
    /// What the tab of the browser says.
    pub title: &'a str,
    /// The style sheet.
    pub style: &'a str,
    /// Scripts, which run when the page has been read.
    pub scripts: &'a [&'a str],
    /// Data for the scripts: the id of their element, and JSON.
    pub data: &'a [(&'a str, String)],
    /// The content of the page.
    pub body: Markup,
}

impl Page<'_> {
    /// The document.
    pub fn document(self) -> String {
        let policy = policy(self.style, self.scripts);
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta http-equiv="Content-Security-Policy" content=(policy);
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    title { (self.title) }
                    style { (PreEscaped(self.style)) }
                }
                body {
                    (self.body)
                    @for (id, json) in self.data {
                        script type="application/json" id=(id) { (PreEscaped(within_script(json))) }
                    }
                    @for script in self.scripts { script { (PreEscaped(script)) } }
                }
            }
        };
        page.into_string() + "\n"
    }
}

/// Within a script element nothing may look like its end or like a comment; in JSON `<` occurs in
/// strings only.
fn within_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

fn policy(style: &str, scripts: &[&str]) -> String {
    let mut policy = format!(
        "default-src 'none'; base-uri 'none'; form-action 'none'; style-src {}",
        digest(style)
    );
    if !scripts.is_empty() {
        let scripts: Vec<String> = scripts.iter().map(|script| digest(script)).collect();
        policy += &format!("; script-src {}", scripts.join(" "));
    }
    policy
}

fn digest(content: &str) -> String {
    let digest = base64::engine::general_purpose::STANDARD.encode(Sha256::digest(content));
    format!("'sha256-{digest}'")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_own_style_and_script_are_allowed() {
        let data = [("data", String::from(r#"{"a":"</script><!--"}"#))];
        let page = Page {
            title: "a < b & \"c\"",
            style: "p{}",
            scripts: &["x()"],
            data: &data,
            body: html! { p { ("<script>") } },
        };
        let text = page.document();
        // Digests by `printf 'p{}' | openssl dgst -sha256 -binary | base64`.
        assert!(text.contains("style-src 'sha256-gG2yISYereRMiG2lMXrbiUgi0Ubw9p7QCeWcroOvy9Y='; script-src 'sha256-D6IGS8VMvCoyaR/l0h9tERrBTATY01CoPS7l6xDv0kI='"), "{text}");
        assert!(text.contains("<title>a &lt; b &amp; &quot;c&quot;</title>"), "{text}");
        assert!(text.contains("<p>&lt;script&gt;</p>"), "{text}");
        assert!(text.contains(r#"{"a":"\u003c/script>\u003c!--"}"#), "{text}");
    }
}
