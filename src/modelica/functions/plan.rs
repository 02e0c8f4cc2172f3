//! How the elements of an array are made from those of others. The interpreter makes values of a
//! plan, lowering makes expressions, and its sizes are those of the call.

use crate::diag::Fault;

/// What is known of an argument before anything is computed.
#[derive(Debug, Clone, Copy)]
pub struct Argument<'a> {
    /// Its sizes; none for a scalar.
    pub dims: &'a [usize],
    /// Its value where the plan depends on it (see [`Known`](super::Known)).
    pub number: i64,
}

/// Makes the plan of a call, or says what does not fit.
pub(crate) type PlanOf = fn(&[Argument<'_>]) -> Result<Plan, Fault>;

/// Sizes and elements of an array.
pub struct Plan {
    /// Its sizes; none for a scalar.
    pub dims: Vec<usize>,
    /// Its elements by position, the last dimension fastest.
    pub elements: Elements,
}

/// The elements of a plan.
pub enum Elements {
    /// Those of one argument, whatever they are, at these positions.
    Rearranged(usize, Box<dyn Fn(usize) -> usize>),
    /// The same number everywhere.
    Same(i64),
    /// One by one.
    Each(Box<dyn Fn(usize) -> Element>),
}

/// One element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Element {
    /// A number.
    Integer(i64),
    /// An element of an argument.
    Of(Pick),
    /// Minus an element of an argument.
    Negative(Pick),
    /// `a*b`
    Product(Pick, Pick),
    /// `a*b - c*d`
    Determinant([Pick; 2], [Pick; 2]),
    /// `a + (b - a)*numerator/denominator`
    Between(Pick, Pick, f64, f64),
}

/// An element of an argument: which argument and which position, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pick {
    /// Position of the argument.
    pub argument: usize,
    /// Position of the element in it.
    pub at: usize,
}

impl Plan {
    /// Elements of the first argument at other places.
    pub(super) fn rearranged(dims: Vec<usize>, at: impl Fn(usize) -> usize + 'static) -> Plan {
        Plan { dims, elements: Elements::Rearranged(0, Box::new(at)) }
    }

    /// The elements of the first argument in their order, in other sizes.
    pub(super) fn reshaped(dims: Vec<usize>) -> Plan {
        Plan::rearranged(dims, |at| at)
    }

    /// Elements made one by one.
    pub(super) fn each(dims: Vec<usize>, element: impl Fn(usize) -> Element + 'static) -> Plan {
        Plan { dims, elements: Elements::Each(Box::new(element)) }
    }

    /// How the element at a position is made.
    pub fn element(&self, at: usize) -> Element {
        match &self.elements {
            Elements::Rearranged(argument, of) => {
                Element::Of(Pick { argument: *argument, at: of(at) })
            }
            Elements::Same(value) => Element::Integer(*value),
            Elements::Each(element) => element(at),
        }
    }

    /// Number of elements; `None` where it exceeds all bounds.
    pub fn count(&self) -> Option<usize> {
        self.dims.iter().try_fold(1usize, |count, size| count.checked_mul(*size))
    }
}

/// Element `at` of argument `argument`.
pub(super) const fn of(argument: usize, at: usize) -> Pick {
    Pick { argument, at }
}
