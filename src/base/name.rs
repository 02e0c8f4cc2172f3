//! Identifiers and dotted names, interned: comparing two is comparing two addresses.

use rustc_hash::FxHashSet;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::{LazyLock, Mutex};

/// An identifier (`IDENT`, MLS §2.3.1), without the quotes of a quoted one only where it was
/// written without them: `'a b'` keeps its quotes, because they are part of the name.
#[derive(Clone, Copy)]
pub struct Ident(&'static str);

static INTERNED: LazyLock<Mutex<FxHashSet<&'static str>>> = LazyLock::new(Default::default);

impl Ident {
    /// The identifier with this text. Interned strings live as long as the program; their number is
    /// bounded by the distinct identifiers read.
    pub fn new(text: &str) -> Ident {
        let mut interned = match INTERNED.lock() {
            Ok(guard) => guard,
            Err(poisoned) => poisoned.into_inner(),
        };
        if let Some(known) = interned.get(text) {
            return Ident(known);
        }
        let leaked: &'static str = Box::leak(text.to_owned().into_boxed_str());
        interned.insert(leaked);
        Ident(leaked)
    }

    /// The text.
    #[inline]
    pub fn as_str(self) -> &'static str {
        self.0
    }

    /// The array and the subscripts of a part of a flat name, such as `c` and 2 of `c[2]`. No
    /// identifier that is read from a text has them.
    pub fn subscripted(self) -> Option<(Ident, Vec<usize>)> {
        let (array, subscripts) = self.0.strip_suffix(']')?.rsplit_once('[')?;
        let subscripts: Result<Vec<usize>, _> =
            subscripts.split(',').map(|subscript| subscript.trim().parse()).collect();
        Some((Ident::new(array.trim_end()), subscripts.ok()?))
    }
}

impl serde::Serialize for Ident {
    fn serialize<S: serde::Serializer>(&self, target: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(target)
    }
}

impl<'de> serde::Deserialize<'de> for Ident {
    fn deserialize<D: serde::Deserializer<'de>>(source: D) -> Result<Ident, D::Error> {
        <&str>::deserialize(source).map(Ident::new)
    }
}

impl PartialEq for Ident {
    #[inline]
    fn eq(&self, other: &Ident) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Eq for Ident {}

impl Hash for Ident {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.0.as_ptr() as usize).hash(state);
    }
}

impl PartialOrd for Ident {
    #[inline]
    fn partial_cmp(&self, other: &Ident) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ident {
    #[inline]
    fn cmp(&self, other: &Ident) -> std::cmp::Ordering {
        self.0.cmp(other.0)
    }
}

impl PartialEq<str> for Ident {
    fn eq(&self, other: &str) -> bool {
        self.0 == other
    }
}

impl PartialEq<&str> for Ident {
    fn eq(&self, other: &&str) -> bool {
        self.0 == *other
    }
}

impl fmt::Debug for Ident {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.0)
    }
}

impl fmt::Display for Ident {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

impl From<&str> for Ident {
    fn from(text: &str) -> Ident {
        Ident::new(text)
    }
}

/// A dotted name such as `Modelica.Units.SI`, with or without the leading dot of a global one.
#[derive(
    Debug,
    Clone,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Default,
    serde::Serialize,
    serde::Deserialize,
)]
pub struct Name {
    /// Whether it begins with a dot (MLS §5.3.3: looked up globally).
    pub global: bool,
    /// The identifiers, first to last.
    pub parts: Vec<Ident>,
}

impl Name {
    /// The name made of these identifiers.
    pub fn new(parts: impl IntoIterator<Item = Ident>) -> Name {
        Name { global: false, parts: parts.into_iter().collect() }
    }

    /// Parses `A.B.'c d'`; a leading dot makes it global. Quoted identifiers may hold dots.
    pub fn parse(text: &str) -> Name {
        let (global, rest) = match text.strip_prefix('.') {
            Some(rest) => (true, rest),
            None => (false, text),
        };
        let mut parts = Vec::new();
        let mut quoted = false;
        let mut start = 0;
        for (at, character) in rest.char_indices() {
            match character {
                '\'' => quoted = !quoted,
                '.' if !quoted => {
                    parts.push(Ident::new(&rest[start..at]));
                    start = at + 1;
                }
                _ => {}
            }
        }
        if start < rest.len() {
            parts.push(Ident::new(&rest[start..]));
        }
        Name { global, parts }
    }

    /// The last identifier; `None` for the empty name.
    pub fn last(&self) -> Option<Ident> {
        self.parts.last().copied()
    }

    /// The first identifier; `None` for the empty name.
    pub fn first(&self) -> Option<Ident> {
        self.parts.first().copied()
    }

    /// This name with one more identifier.
    pub fn child(&self, ident: Ident) -> Name {
        let mut name = self.clone();
        name.parts.push(ident);
        name
    }

    /// The name without its last identifier.
    pub fn parent(&self) -> Name {
        let mut name = self.clone();
        name.parts.pop();
        name
    }

    /// Whether it is a single identifier.
    pub fn is_simple(&self) -> bool {
        self.parts.len() == 1 && !self.global
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.global {
            f.write_str(".")?;
        }
        for (at, part) in self.parts.iter().enumerate() {
            if at > 0 {
                f.write_str(".")?;
            }
            f.write_str(part.as_str())?;
        }
        Ok(())
    }
}

impl From<Ident> for Name {
    fn from(ident: Ident) -> Name {
        Name::new([ident])
    }
}
