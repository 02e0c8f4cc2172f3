//! Words of the standard: causality, variability, types.

use crate::xml::real;

/// Makes an enumeration with its words in the standard.
macro_rules! words {
    ($(#[$doc:meta])* $name:ident { $($(#[$of:meta])* $variant:ident = $word:literal,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
        pub enum $name {
            $($(#[$of])* $variant,)*
        }

        impl $name {
            /// All of them.
            pub const ALL: &[$name] = &[$($name::$variant),*];

            /// The word of the standard.
            pub fn word(self) -> &'static str {
                match self {
                    $($name::$variant => $word,)*
                }
            }

            /// The one of this word.
            pub fn of_word(word: &str) -> Option<$name> {
                $name::ALL.iter().copied().find(|one| one.word() == word)
            }
        }
    };
}

words! {
    /// The part of a variable.
    Causality {
        /// Set before initialization (or later, if tunable), constant otherwise.
        Parameter = "parameter",
        /// Follows from parameters.
        CalculatedParameter = "calculatedParameter",
        /// Sets sizes of arrays (FMI 3.0).
        StructuralParameter = "structuralParameter",
        /// Set from outside.
        Input = "input",
        /// For outside.
        Output = "output",
        /// Visible, for information.
        #[default]
        Local = "local",
        /// Time.
        Independent = "independent",
    }
}

words! {
    /// When a variable may change.
    Variability {
        /// Never.
        Constant = "constant",
        /// Not after initialization.
        Fixed = "fixed",
        /// At events, from outside.
        Tunable = "tunable",
        /// At events.
        Discrete = "discrete",
        /// Always.
        #[default]
        Continuous = "continuous",
    }
}

words! {
    /// Where the first value of a variable comes from.
    Initial {
        /// From its start value.
        #[default]
        Exact = "exact",
        /// From an iteration that begins at its start value.
        Approx = "approx",
        /// From other variables.
        Calculated = "calculated",
    }
}

words! {
    /// How a variable depends on another one.
    DependencyKind {
        /// In any way.
        #[default]
        Dependent = "dependent",
        /// Linearly, with a constant factor.
        Constant = "constant",
        /// Linearly, with a factor that parameters may change.
        Fixed = "fixed",
        /// Linearly, with a factor that changes from outside.
        Tunable = "tunable",
        /// Linearly, with a factor that changes at events.
        Discrete = "discrete",
    }
}

words! {
    /// A predefined type; FMI 2.0 calls `Float64` `Real` and `Int32` `Integer`.
    Kind {
        /// 32 bits.
        Float32 = "Float32",
        /// 64 bits.
        #[default]
        Float64 = "Float64",
        /// 8 bits with sign.
        Int8 = "Int8",
        /// 8 bits.
        UInt8 = "UInt8",
        /// 16 bits with sign.
        Int16 = "Int16",
        /// 16 bits.
        UInt16 = "UInt16",
        /// 32 bits with sign.
        Int32 = "Int32",
        /// 32 bits.
        UInt32 = "UInt32",
        /// 64 bits with sign.
        Int64 = "Int64",
        /// 64 bits.
        UInt64 = "UInt64",
        /// True or false.
        Boolean = "Boolean",
        /// Text.
        String = "String",
        /// Bytes.
        Binary = "Binary",
        /// Literals by their numbers.
        Enumeration = "Enumeration",
        /// Ticks.
        Clock = "Clock",
    }
}

impl Kind {
    /// Whether its values are real numbers.
    pub fn is_float(self) -> bool {
        matches!(self, Kind::Float32 | Kind::Float64)
    }

    /// Whether a text is a value of this type, as schemas write values.
    pub fn holds(self, text: &str) -> bool {
        match self {
            Kind::Float32 | Kind::Float64 => real(text).is_some(),
            Kind::Int8 => text.parse::<i8>().is_ok(),
            Kind::UInt8 => text.parse::<u8>().is_ok(),
            Kind::Int16 => text.parse::<i16>().is_ok(),
            Kind::UInt16 => text.parse::<u16>().is_ok(),
            Kind::Int32 => text.parse::<i32>().is_ok(),
            Kind::UInt32 => text.parse::<u32>().is_ok(),
            Kind::Int64 | Kind::Enumeration => text.parse::<i64>().is_ok(),
            Kind::UInt64 => text.parse::<u64>().is_ok(),
            Kind::Boolean => matches!(text, "true" | "false" | "1" | "0"),
            Kind::String => true,
            Kind::Binary => {
                text.len().is_multiple_of(2) && text.bytes().all(|c| c.is_ascii_hexdigit())
            }
            Kind::Clock => false,
        }
    }

    /// What its values are.
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Kind::Float32 | Kind::Float64 => "a real number",
            Kind::Int8 => "a whole number of 8 bits with sign",
            Kind::UInt8 => "a whole number of 8 bits without sign",
            Kind::Int16 => "a whole number of 16 bits with sign",
            Kind::UInt16 => "a whole number of 16 bits without sign",
            Kind::Int32 => "a whole number of 32 bits with sign",
            Kind::UInt32 => "a whole number of 32 bits without sign",
            Kind::Int64 | Kind::Enumeration => "a whole number of 64 bits with sign",
            Kind::UInt64 => "a whole number of 64 bits without sign",
            Kind::Boolean => "`true` or `false`",
            Kind::String => "a text",
            Kind::Binary => "an even number of hexadecimal digits",
            Kind::Clock => "left out: clocks have no values",
        }
    }

    /// The type of this name in FMI 2.0.
    pub(crate) fn of_word_2(word: &str) -> Option<Kind> {
        Some(match word {
            "Real" => Kind::Float64,
            "Integer" => Kind::Int32,
            "Boolean" => Kind::Boolean,
            "String" => Kind::String,
            "Enumeration" => Kind::Enumeration,
            _ => return None,
        })
    }

    /// Its name in FMI 2.0; `None` for types which that has not.
    pub(crate) fn word_2(self) -> Option<&'static str> {
        Some(match self {
            Kind::Float64 => "Real",
            Kind::Int32 => "Integer",
            Kind::Boolean => "Boolean",
            Kind::String => "String",
            Kind::Enumeration => "Enumeration",
            _ => return None,
        })
    }
}
