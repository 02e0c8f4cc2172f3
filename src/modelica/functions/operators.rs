//! Operators: what needs more than the values of its arguments, or has a meaning in time (MLS §3.7).

use super::rules::{ShapeRule, TypeRule, VariabilityRule};
use super::{Builtin, Meaning};
use crate::symbolic::function::UnitRule;

/// An operator that the interpreter and lowering treat each in their way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// `size(A)`, `size(A, i)`
    Size,
    /// `ndims(A)`
    NumberOfDimensions,
    /// `String(…)`
    Text,
    /// `Integer(e)`: which literal of its enumeration, from 1.
    Ordinal,
    /// `assert(…)`
    Assert,
    /// `terminate(…)`
    Terminate,
    /// `pure(e)`: the value of `e`.
    Pure,
    /// `noEvent(e)`: the value of `e`, relations inside it without events.
    NoEvent,
    /// `smooth(p, e)`
    Smooth,
    /// `homotopy(actual, simplified)`
    Homotopy,
    /// `semiLinear(x, k⁺, k⁻)`
    SemiLinear,
    /// What has a meaning in models only.
    InTime(Temporal),
}

/// An operator with a meaning in time, or in the structure of a model (MLS §3.7.4, §3.7.5, ch. 15).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Temporal {
    /// `der(x)`
    Derivative,
    /// `pre(y)`
    Pre,
    /// `edge(b)`
    Edge,
    /// `change(v)`
    Change,
    /// `initial()`
    Initial,
    /// `terminal()`
    Terminal,
    /// `sample(start, interval)`
    Sample,
    /// `delay(x, time)`, `delay(x, time, longest)`
    Delay,
    /// `reinit(x, value)`, a statement
    Reinit,
    /// `spatialDistribution(…)`
    SpatialDistribution,
    /// `cardinality(c)`
    Cardinality,
    /// `inStream(v)`
    InStream,
    /// `actualStream(v)`
    ActualStream,
    /// `getInstanceName()`
    InstanceName,
    /// What has a meaning on clocks (MLS ch. 16).
    Clocked(Clocked),
}

/// An operator of clocks and clocked variables (MLS ch. 16).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clocked {
    /// `Clock(…)`
    Constructor,
    /// `sample(u)`, `sample(u, clock)`
    Sample,
    /// `hold(u)`
    Hold,
    /// `previous(u)`
    Previous,
    /// `subSample(u, factor)`
    SubSample,
    /// `superSample(u, factor)`
    SuperSample,
    /// `shiftSample(u, shiftCounter, resolution)`
    ShiftSample,
    /// `backSample(u, backCounter, resolution)`
    BackSample,
    /// `noClock(u)`
    NoClock,
    /// `interval(u)`
    Interval,
    /// `firstTick(u)`
    FirstTick,
    /// What the states of state machines are asked for, or made by (MLS ch. 17).
    State(StateOperator),
}

/// An operator of state machines (MLS §17.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateOperator {
    /// `activeState(state)`
    Active,
    /// `ticksInState()`
    Ticks,
    /// `timeInState()`
    Time,
    /// `transition(from, to, condition, …)`, an equation
    Transition,
    /// `initialState(state)`, an equation
    Initial,
}

/// An operator of the values of expressions.
const fn plain(name: &'static str, operator: Operator) -> Builtin {
    let entry = Builtin::new(name, Meaning::Operator(operator), "MLS §3.7.4");
    Builtin { unit: UnitRule::As(0), ..entry }
}

/// An operator of one variable whose value changes with time.
const fn temporal(name: &'static str, operator: Temporal) -> Builtin {
    Builtin {
        variability: VariabilityRule::Always,
        section: "MLS §3.7.5",
        ..plain(name, Operator::InTime(operator))
    }
}

/// An operator of clocks and of what they drive, of these arguments.
const fn clocked(
    name: &'static str,
    operator: Clocked,
    inputs: &'static [&'static str],
    least: usize,
) -> Builtin {
    let entry = temporal(name, Temporal::Clocked(operator));
    Builtin { inputs, least, most: inputs.len(), section: "MLS §16.5", ..entry }
}

/// An operator of state machines, of these arguments.
const fn of_states(
    name: &'static str,
    operator: StateOperator,
    inputs: &'static [&'static str],
    least: usize,
) -> Builtin {
    let entry = clocked(name, Clocked::State(operator), inputs, least);
    Builtin { shape: ShapeRule::Scalar, unit: UnitRule::Unknown, section: "MLS §17.1", ..entry }
}

/// What has no value, or one that nothing is known of.
const fn of_unknown_value(entry: Builtin, (least, most): (usize, usize)) -> Builtin {
    Builtin {
        least,
        most,
        value_type: TypeRule::Unknown,
        shape: ShapeRule::Unknown,
        unit: UnitRule::Unknown,
        ..entry
    }
}

/// What is Boolean, of the sizes of its argument.
const fn boolean(entry: Builtin) -> Builtin {
    Builtin { value_type: TypeRule::Boolean, unit: UnitRule::Unknown, ..entry }
}

/// A Boolean signal.
const fn signal(entry: Builtin, arguments: usize) -> Builtin {
    let entry = boolean(entry);
    Builtin { least: arguments, most: arguments, shape: ShapeRule::Scalar, ..entry }
}

pub(super) const OPERATORS: &[Builtin] = &[
    Builtin {
        inputs: &["A", "i"],
        most: 2,
        value_type: TypeRule::Integer,
        shape: ShapeRule::SizeOf,
        unit: UnitRule::Unknown,
        variability: VariabilityRule::Never,
        section: "MLS §10.3.1",
        ..plain("size", Operator::Size)
    },
    Builtin {
        inputs: &["A"],
        value_type: TypeRule::Integer,
        shape: ShapeRule::Scalar,
        unit: UnitRule::Unknown,
        variability: VariabilityRule::Never,
        section: "MLS §10.3.1",
        ..plain("ndims", Operator::NumberOfDimensions)
    },
    Builtin { inputs: &["expr"], section: "MLS §3.7.4.3", ..plain("noEvent", Operator::NoEvent) },
    Builtin { inputs: &["expr"], section: "MLS §12.3", ..plain("pure", Operator::Pure) },
    Builtin {
        inputs: &["p", "expr"],
        least: 2,
        most: 2,
        value_type: TypeRule::As(1),
        shape: ShapeRule::As(1),
        unit: UnitRule::As(1),
        section: "MLS §3.7.4.2",
        ..plain("smooth", Operator::Smooth)
    },
    Builtin {
        inputs: &["actual", "simplified"],
        least: 2,
        most: 2,
        section: "MLS §3.7.4.3",
        ..plain("homotopy", Operator::Homotopy)
    },
    Builtin {
        value_type: TypeRule::String,
        shape: ShapeRule::Scalar,
        unit: UnitRule::Unknown,
        most: usize::MAX,
        section: "MLS §3.7.1",
        ..plain("String", Operator::Text)
    },
    Builtin {
        value_type: TypeRule::Integer,
        unit: UnitRule::Unknown,
        section: "MLS §3.7.1",
        ..plain("Integer", Operator::Ordinal)
    },
    Builtin {
        inputs: &["condition", "message", "level"],
        section: "MLS §8.3.7",
        ..of_unknown_value(plain("assert", Operator::Assert), (2, 3))
    },
    Builtin {
        inputs: &["message"],
        section: "MLS §8.3.8",
        ..of_unknown_value(plain("terminate", Operator::Terminate), (1, 1))
    },
    Builtin {
        inputs: &["x", "positiveSlope", "negativeSlope"],
        least: 3,
        most: 3,
        value_type: TypeRule::Real,
        shape: ShapeRule::Elementwise,
        unit: UnitRule::Unknown,
        section: "MLS §3.7.2.5",
        ..plain("semiLinear", Operator::SemiLinear)
    },
    Builtin {
        value_type: TypeRule::Real,
        unit: UnitRule::Rate,
        section: "MLS §3.7.4",
        ..temporal("der", Temporal::Derivative)
    },
    temporal("pre", Temporal::Pre),
    boolean(temporal("edge", Temporal::Edge)),
    boolean(temporal("change", Temporal::Change)),
    signal(temporal("initial", Temporal::Initial), 0),
    signal(temporal("terminal", Temporal::Terminal), 0),
    Builtin {
        least: 1,
        most: 2,
        value_type: TypeRule::Sampled,
        section: "MLS §3.7.5, §16.5.1",
        ..temporal("sample", Temporal::Sample)
    },
    Builtin {
        least: 2,
        most: 3,
        value_type: TypeRule::Real,
        section: "MLS §3.7.4.1",
        ..temporal("delay", Temporal::Delay)
    },
    of_unknown_value(temporal("reinit", Temporal::Reinit), (2, 2)),
    Builtin {
        inputs: &["in0", "in1", "x", "positiveVelocity", "initialPoints", "initialValues"],
        section: "MLS §3.7.4.2",
        ..of_unknown_value(temporal("spatialDistribution", Temporal::SpatialDistribution), (4, 6))
    },
    Builtin {
        value_type: TypeRule::Integer,
        shape: ShapeRule::Scalar,
        unit: UnitRule::Unknown,
        variability: VariabilityRule::Never,
        section: "MLS §3.7.4.3",
        ..temporal("cardinality", Temporal::Cardinality)
    },
    Builtin { section: "MLS §15.2", ..temporal("inStream", Temporal::InStream) },
    Builtin { section: "MLS §15.3", ..temporal("actualStream", Temporal::ActualStream) },
    Builtin {
        least: 0,
        most: 0,
        value_type: TypeRule::String,
        shape: ShapeRule::Scalar,
        unit: UnitRule::Unknown,
        variability: VariabilityRule::Never,
        section: "MLS §3.7.4.4",
        ..temporal("getInstanceName", Temporal::InstanceName)
    },
    Builtin {
        value_type: TypeRule::Clock,
        shape: ShapeRule::Scalar,
        unit: UnitRule::Unknown,
        section: "MLS §16.3",
        ..clocked("Clock", Clocked::Constructor, &["", ""], 0)
    },
    Builtin { section: "MLS §16.4", ..clocked("previous", Clocked::Previous, &["u"], 1) },
    clocked("hold", Clocked::Hold, &["u"], 1),
    clocked("subSample", Clocked::SubSample, &["u", "factor"], 1),
    clocked("superSample", Clocked::SuperSample, &["u", "factor"], 1),
    clocked("shiftSample", Clocked::ShiftSample, &["u", "shiftCounter", "resolution"], 1),
    clocked("backSample", Clocked::BackSample, &["u", "backCounter", "resolution"], 1),
    clocked("noClock", Clocked::NoClock, &["u"], 1),
    Builtin {
        value_type: TypeRule::Real,
        shape: ShapeRule::Scalar,
        unit: UnitRule::Unknown,
        section: "MLS §16.10",
        ..clocked("interval", Clocked::Interval, &["u"], 0)
    },
    Builtin {
        value_type: TypeRule::Boolean,
        shape: ShapeRule::Scalar,
        unit: UnitRule::Unknown,
        section: "MLS §16.10",
        ..clocked("firstTick", Clocked::FirstTick, &["u"], 0)
    },
    Builtin {
        value_type: TypeRule::Boolean,
        ..of_states("activeState", StateOperator::Active, &["state"], 1)
    },
    // Flattening adds the instance in which they are written.
    Builtin {
        most: 1,
        value_type: TypeRule::Integer,
        ..of_states("ticksInState", StateOperator::Ticks, &[], 0)
    },
    Builtin {
        most: 1,
        value_type: TypeRule::Real,
        ..of_states("timeInState", StateOperator::Time, &[], 0)
    },
    of_unknown_value(
        of_states("transition", StateOperator::Transition, TRANSITION, 3),
        (3, TRANSITION.len()),
    ),
    of_unknown_value(of_states("initialState", StateOperator::Initial, &["state"], 1), (1, 1)),
];

/// The arguments of `transition`.
const TRANSITION: &[&str] =
    &["from", "to", "condition", "immediate", "reset", "synchronize", "priority"];
