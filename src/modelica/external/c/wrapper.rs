//! The C text of a unit.
//!
//! A wrapper takes a row of pointers, one for each argument and one for the result:
//!
//! ```c
//! int gapi_call_0(void **at) {
//!     if (gapi_enter()) return 1;
//!     *(double *)at[2] = mean((double *)at[0], *(size_t *)at[1]);
//!     return 0;
//! }
//! ```

use super::declaration::{Argument, Declaration, Scalar};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// `ModelicaUtilities.h` (MLS §12.9.6).
pub const HEADER: &str = include_str!("ModelicaUtilities.h");
/// The functions of the header.
pub const UTILITIES: &str = include_str!("utilities.c");

/// The C file for some functions; wrappers have their numbers.
pub fn source(declarations: &[Declaration]) -> String {
    let mut text = String::from("#include \"ModelicaUtilities.h\"\n#include <setjmp.h>\n");
    let mut seen = BTreeSet::new();
    for declaration in declarations {
        let include = declaration.include.as_deref().unwrap_or_default().trim();
        if !include.is_empty() && seen.insert(include) {
            let _ = writeln!(text, "{include}");
        }
    }
    text += "\nextern jmp_buf *gapi_back;\n";
    for (number, declaration) in declarations.iter().enumerate() {
        if declaration.include.as_deref().unwrap_or_default().trim().is_empty() {
            prototype(&mut text, declaration);
        }
        wrapper(&mut text, number, declaration);
    }
    text
}

fn c_type(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Real => "double",
        Scalar::Whole => "int",
        Scalar::Text => "const char *",
        Scalar::Object => "void *",
    }
}

/// Without `Include` the function has no other declaration (MLS §12.9.4).
fn prototype(text: &mut String, declaration: &Declaration) {
    let types = declaration.arguments.iter().map(|argument| match argument {
        Argument::Value(scalar) => c_type(*scalar).to_owned(),
        Argument::Size => "size_t".to_owned(),
        Argument::Output(scalar) | Argument::Array(scalar) => format!("{} *", c_type(*scalar)),
    });
    let types = types.collect::<Vec<_>>();
    let types = if types.is_empty() { "void".to_owned() } else { types.join(", ") };
    let result = declaration.result.map_or("void", c_type);
    let _ = writeln!(text, "extern {result} {}({types});", declaration.function);
}

fn wrapper(text: &mut String, number: usize, declaration: &Declaration) {
    let arguments = declaration.arguments.iter().enumerate().map(|(at, argument)| match argument {
        Argument::Value(scalar) => format!("*({} *)at[{at}]", c_type(*scalar)),
        Argument::Size => format!("*(size_t *)at[{at}]"),
        // Libraries declare `char **` and `const char **`.
        Argument::Output(Scalar::Text) | Argument::Array(Scalar::Text) => {
            format!("(void *)at[{at}]")
        }
        Argument::Output(scalar) | Argument::Array(scalar) => {
            format!("({} *)at[{at}]", c_type(*scalar))
        }
    });
    let arguments = arguments.collect::<Vec<_>>().join(", ");
    let after = declaration.arguments.len();
    let result = match declaration.result {
        Some(scalar) => format!("*({} *)at[{after}] = ", c_type(scalar)),
        None => String::new(),
    };
    let _ = write!(
        text,
        "int gapi_call_{number}(void **at) {{\n    jmp_buf back;\n    (void)at;\n    \
         gapi_back = &back;\n    if (setjmp(back)) {{ gapi_back = 0; return 1; }}\n    \
         {result}{}({arguments});\n    gapi_back = 0;\n    return 0;\n}}\n",
        declaration.function
    );
}
