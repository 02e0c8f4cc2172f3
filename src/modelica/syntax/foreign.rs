//! What other languages write otherwise: punctuation at the place where the grammar stops, and names.

use super::ast::{Expression, ExpressionKind, UnaryOperator};
use super::keywords::is_keyword;

/// What is wrong, and what Modelica writes.
pub(super) struct Remedy {
    pub(super) message: String,
    pub(super) help: String,
}

/// The text around the place where the grammar stopped.
pub(super) struct Surroundings<'t> {
    /// Up to the end of the token before.
    pub(super) head: &'t str,
    /// Blanks between that token and the one found.
    pub(super) gap: &'t str,
    pub(super) found: &'t str,
    /// What follows the token found.
    pub(super) tail: &'t str,
    /// What the grammar expected, in Modelica words.
    pub(super) expected: &'t str,
}

impl Surroundings<'_> {
    /// The first remedy that fits.
    pub(super) fn remedy(&self) -> Option<Remedy> {
        self.operator()
            .or_else(|| self.decimal_comma())
            .or_else(|| self.loop_range())
            .or_else(|| self.late_value())
            .or_else(|| self.unit_or_product())
            .or_else(|| self.missing_section())
            .or_else(|| self.returned_value())
    }

    /// `**`, `+=`
    fn operator(&self) -> Option<Remedy> {
        let last = self.head.chars().next_back().filter(|_| self.gap.is_empty())?;
        match (last, self.found) {
            ('*', "*") => Some(Remedy {
                message: "`**` is not an operator".to_owned(),
                help: "write `^` for the power: `x^2`".to_owned(),
            }),
            ('+' | '-' | '*' | '/', "=") => {
                let before = self.head[..self.head.len() - 1].trim_end();
                let name = &before[before.trim_end_matches(is_part_of_name).len()..];
                Some(Remedy {
                    message: format!("`{last}=` is not an operator"),
                    help: format!("write `{name} := {name} {last} ...`"),
                })
            }
            _ => None,
        }
    }

    /// `0,5`: where entries are separated, the grammar stops after the comma, elsewhere at it.
    fn decimal_comma(&self) -> Option<Remedy> {
        let (head, decimals) = match self.found {
            "," => (self.head, &self.tail[..self.tail.len() - after_digits(self.tail).len()]),
            decimals => (self.head.strip_suffix(',')?, decimals),
        };
        let whole = number_at_end(head)?;
        let is_number = |text: &str| !text.is_empty() && after_digits(text).is_empty();
        let is_decimal = self.gap.is_empty() && is_number(whole) && is_number(decimals);
        is_decimal.then(|| Remedy {
            message: "a comma separates entries; numbers have a decimal point".to_owned(),
            help: format!("write `{whole}.{decimals}`"),
        })
    }

    /// `for k = 1:3`
    fn loop_range(&self) -> Option<Remedy> {
        let (before, name) = split_word(self.head);
        let (_, keyword) = split_word(before.trim_end());
        if self.found != "=" || keyword != "for" || name.is_empty() {
            return None;
        }
        let line = self.tail.split(['\n', '\u{1e}', ';']).next().unwrap_or_default();
        let range = line.split(" loop").next().unwrap_or_default().trim();
        Some(Remedy {
            message: "`=` does not give a loop its range".to_owned(),
            help: format!("write `for {name} in {range} loop`"),
        })
    }

    /// `Real x "level" = 1`
    fn late_value(&self) -> Option<Remedy> {
        let follows_description =
            self.head.ends_with('"') && self.expected.contains("`annotation`");
        (self.found == "=" && follows_description).then(|| Remedy {
            message: "the value of a declaration precedes its description".to_owned(),
            help: "write `Real x = 1 \"level\"`".to_owned(),
        })
    }

    /// `2k`, `5 s`, `5 [s]`
    fn unit_or_product(&self) -> Option<Remedy> {
        let number = number_at_end(self.head).filter(|_| !self.gap.contains(['\n', '\u{1e}']))?;
        let is_letter = |c: char| c.is_ascii_alphabetic() || c == '_';
        let is_name = self.found.starts_with(is_letter) && !is_keyword(self.found);
        if is_name && self.gap.is_empty() {
            return Some(Remedy {
                message: format!("`*` is missing between `{number}` and `{}`", self.found),
                help: format!("write `{number}*{}`", self.found),
            });
        }
        let ends = |text: &str| {
            let text = text.trim_start_matches([' ', '\t']);
            text.is_empty() || text.starts_with([';', '"', '\n', '\u{1e}'])
        };
        let unit = match self.found {
            "[" => {
                let (unit, rest) = self.tail.split_once(']')?;
                Some(unit).filter(|unit| !unit.contains('\n') && ends(rest))
            }
            name => Some(name).filter(|_| is_name && ends(self.tail)),
        }?;
        Some(Remedy {
            message: format!("`{unit}` after a number is not a unit"),
            help: format!("write the unit as an attribute: `Real x(unit = \"{unit}\") = {number}`"),
        })
    }

    /// `return x`
    fn returned_value(&self) -> Option<Remedy> {
        let (_, word) = split_word(self.head);
        let is_value = word == "return" && !self.gap.contains(['\n', '\u{1e}']);
        is_value.then(|| Remedy {
            message: "`return` takes no value".to_owned(),
            help: "assign the value to an output of the function, `y := ...;`: what the outputs \
                   have at the end is returned"
                .to_owned(),
        })
    }

    /// An equation among the declarations.
    fn missing_section(&self) -> Option<Remedy> {
        let begins = ["der", "if", "for", "when", "assert", "reinit"].contains(&self.found);
        (begins && self.expected.contains("`equation`")).then(|| Remedy {
            message: format!("unexpected `{}` among declarations", self.found),
            help: "write `equation` on a line above the first equation".to_owned(),
        })
    }
}

/// The help for arguments of a call that may be numbers with decimal commas, `f(1,5)`: a whole number and
/// digits with nothing but a comma between them.
pub(crate) fn decimal_commas<'a>(
    arguments: impl IntoIterator<Item = &'a Expression>,
) -> Option<String> {
    let arguments: Vec<&Expression> = arguments.into_iter().collect();
    let number = |pair: &[&Expression]| {
        let ExpressionKind::Integer(decimals) = &pair[1].kind else { return None };
        let whole = match &pair[0].kind {
            ExpressionKind::Integer(whole) => whole.to_string(),
            ExpressionKind::Unary { operator: UnaryOperator::Minus, operand } => match operand.kind
            {
                ExpressionKind::Integer(whole) => format!("-{whole}"),
                _ => return None,
            },
            _ => return None,
        };
        let [before, after] = [pair[0].span, pair[1].span];
        let digits = (after.end - after.start) as usize;
        (before.end + 1 == after.start).then(|| format!("`{whole}.{decimals:0digits$}`"))
    };
    let numbers: Vec<String> = arguments.windows(2).filter_map(number).collect();
    (!numbers.is_empty()).then(|| {
        format!(
            "a comma separates arguments; if you mean a number, write it with a point: {}",
            numbers.join(" or ")
        )
    })
}

/// The number that a text ends with; not the end of a name such as `x1`.
fn number_at_end(text: &str) -> Option<&str> {
    let number = &text[text.trim_end_matches(is_part_of_name).len()..];
    let is_number = number.starts_with(|c: char| c.is_ascii_digit())
        && number.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
    is_number.then_some(number)
}

fn after_digits(text: &str) -> &str {
    text.trim_start_matches(|c: char| c.is_ascii_digit())
}

fn split_word(text: &str) -> (&str, &str) {
    text.split_at(text.trim_end_matches(is_word).len())
}

fn is_word(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

fn is_part_of_name(character: char) -> bool {
    is_word(character) || character == '.'
}

/// Names of other languages, and what Modelica writes.
const NAMES: &[(&str, &str)] = &[
    ("True", "true"),
    ("TRUE", "true"),
    ("False", "false"),
    ("FALSE", "false"),
    ("pi", "Modelica.Constants.pi"),
    ("PI", "Modelica.Constants.pi"),
    ("t", "time"),
    ("inf", "Modelica.Constants.inf"),
    ("Inf", "Modelica.Constants.inf"),
];

/// Types of other languages.
const TYPES: &[(&str, &str)] = &[
    ("float", "Real"),
    ("double", "Real"),
    ("real", "Real"),
    ("int", "Integer"),
    ("integer", "Integer"),
    ("bool", "Boolean"),
    ("boolean", "Boolean"),
    ("string", "String"),
    ("str", "String"),
];

/// Functions of other languages.
const FUNCTIONS: &[(&str, &str)] = &[
    ("pow", "x^y"),
    ("power", "x^y"),
    ("ln", "log(x)"),
    ("fabs", "abs(x)"),
    ("len", "size(x, 1)"),
    ("numel", "size(x, 1)"),
];

/// Functions of other languages, and the commands of scripts for them.
const COMMANDS: &[(&str, &str)] = &[
    ("rand", "(R, Seed) := Ram_Gen_ARENA(Seed, 3)"),
    ("random", "(R, Seed) := Ram_Gen_ARENA(Seed, 3)"),
];

/// The help for a function of Strings that is called with an array of numbers.
pub(crate) fn array_function(name: &str) -> Option<String> {
    let is_length = name == "length";
    is_length.then(|| {
        "`length` counts the characters of a String; the number of elements is `size(x, 1)`"
            .to_owned()
    })
}

/// The help for a command that a script does not find.
pub(crate) fn command_help(name: &str) -> Option<String> {
    help_of(COMMANDS, name)
}

/// The help for a name that nothing declares.
pub(crate) fn name_help(name: &str) -> Option<String> {
    help_of(NAMES, name)
}

/// The help for a type that nothing declares.
pub(crate) fn type_help(name: &str) -> Option<String> {
    help_of(TYPES, name)
}

/// The help for a function that nothing declares.
pub(crate) fn function_help(name: &str) -> Option<String> {
    help_of(FUNCTIONS, name)
}

fn help_of(table: &[(&str, &str)], name: &str) -> Option<String> {
    let (_, own) = table.iter().find(|(foreign, _)| *foreign == name)?;
    Some(format!("write `{own}`"))
}
