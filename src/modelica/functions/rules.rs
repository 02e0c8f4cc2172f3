//! What is known of the value of a call from its arguments: type, sizes, variability.

use super::{Argument, Builtin, Meaning};
use crate::symbolic::function::ResultType;

/// The type of the elements of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TypeRule {
    /// `Real`
    Real,
    /// `Integer`
    Integer,
    /// `Boolean`
    Boolean,
    /// `String`
    String,
    /// `Clock`
    Clock,
    /// That of the first argument where it is sampled at the ticks of a clock, else Boolean.
    Sampled,
    /// That of the argument at this position.
    As(usize),
    /// The one that all arguments have: Real where one of them is.
    Joined,
    /// No value, or one whose type nothing tells.
    Unknown,
}

impl From<ResultType> for TypeRule {
    fn from(result: ResultType) -> TypeRule {
        match result {
            ResultType::Real => TypeRule::Real,
            ResultType::Integer => TypeRule::Integer,
            ResultType::AsArguments => TypeRule::Joined,
        }
    }
}

/// The sizes of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShapeRule {
    /// A scalar.
    Scalar,
    /// Those of the argument at this position.
    As(usize),
    /// Those of the arguments that are arrays (MLS §12.4.6).
    Elementwise,
    /// A scalar of one array; of several arguments, theirs.
    Reduced,
    /// One for each dimension of the first argument, or a scalar with a second argument.
    SizeOf,
    /// Those of its plan.
    Planned,
    /// No value, or none that this tells.
    Unknown,
}

/// How a value varies (MLS §3.8).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariabilityRule {
    /// As its arguments do.
    OfArguments,
    /// During a simulation, whatever the arguments.
    Always,
    /// Not at all: it looks at sizes or at the structure, not at values.
    Never,
}

/// Which arguments of an array function must be known numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Known {
    /// None.
    Nothing,
    /// Sizes, from the argument at the first position up to before the second.
    Sizes(usize, usize),
    /// A dimension or a number of dimensions at this position.
    Dimension(usize),
}

impl Known {
    /// Whether the argument at a position must be a known number.
    pub fn contains(self, position: usize) -> bool {
        match self {
            Known::Nothing => false,
            Known::Sizes(first, end) => (first..end).contains(&position),
            Known::Dimension(at) => at == position,
        }
    }
}

/// What a caller knows of the arguments of a call; asked for only where a rule needs it.
pub(crate) trait ArgumentShapes {
    /// How many there are.
    fn count(&self) -> usize;
    /// The sizes of one; `None` where they are not known.
    fn dims(&mut self, at: usize) -> Option<Vec<usize>>;
    /// The value of one that is an Integer; `None` where it is not known.
    fn number(&mut self, at: usize) -> Option<i64>;
    /// The value of one that is a size of the result; `None` where it is not known.
    fn size(&mut self, at: usize) -> Option<i64> {
        self.number(at)
    }
}

impl Builtin {
    /// The sizes of the value of a call; `None` where the arguments do not tell them.
    pub(crate) fn shape_of(&self, arguments: &mut dyn ArgumentShapes) -> Option<Vec<usize>> {
        match self.shape {
            ShapeRule::Scalar => Some(Vec::new()),
            ShapeRule::As(at) => arguments.dims(at),
            ShapeRule::Reduced if arguments.count() == 1 => Some(Vec::new()),
            ShapeRule::SizeOf if arguments.count() == 1 => Some(vec![arguments.dims(0)?.len()]),
            ShapeRule::SizeOf => Some(Vec::new()),
            ShapeRule::Elementwise | ShapeRule::Reduced => {
                let all: Option<Vec<_>> =
                    (0..arguments.count()).map(|at| arguments.dims(at)).collect();
                all?.into_iter().max_by_key(Vec::len)
            }
            ShapeRule::Planned => self.planned_shape(arguments),
            ShapeRule::Unknown => None,
        }
    }

    fn planned_shape(&self, arguments: &mut dyn ArgumentShapes) -> Option<Vec<usize>> {
        let Meaning::Plan(plan, known) = self.meaning else { return None };
        self.check_count(arguments.count()).ok()?;
        let mut shapes = Vec::with_capacity(arguments.count());
        for at in 0..arguments.count() {
            shapes.push(match (known.contains(at), known) {
                (true, Known::Sizes(..)) => (Vec::new(), arguments.size(at)?),
                (true, _) => (Vec::new(), arguments.number(at)?),
                (false, _) => (arguments.dims(at)?, 0),
            });
        }
        let known: Vec<Argument<'_>> =
            shapes.iter().map(|(dims, number)| Argument { dims, number: *number }).collect();
        plan(&known).ok().map(|plan| plan.dims)
    }
}
