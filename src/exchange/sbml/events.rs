//! Events of SBML as when-equations; where their order or a delay matters, as an algorithm that
//! executes one pending event in each event iteration.

use super::document::Event;
use super::roles::Role;
use super::translation::{Translation, real};
use crate::Refusal;
use crate::diag::Fault;
use crate::expression::{Context, Expression, Function, printed};
use crate::names::{identifier, quoted};
use crate::registry::BAD_OPTION;
use std::collections::{BTreeMap, BTreeSet};

/// Names of what is made for an event.
struct Parts {
    trigger: String,
    ready: String,
    fires: String,
    pending: String,
    due: String,
    /// Values at the time of the trigger, by target.
    values: BTreeMap<String, String>,
}

/// Translates all events.
pub(super) fn translate(own: &mut Translation<'_>) -> Result<(), Refusal> {
    own.document.events.iter_mut().for_each(|event| at_an_instant(&mut event.trigger));
    let events = own.document.events.clone();
    events.iter().try_for_each(|event| check(own, event))?;
    match is_simple(&events) {
        true => events.iter().for_each(|event| simple(own, event)),
        false => general(own, &events),
    }
    own.check_size()
}

/// A trigger `time == t` is true at an instant, which no step needs to meet: from then on it stays true.
fn at_an_instant(trigger: &mut Expression) {
    let Expression::Call(function @ Function::Equal, sides) = trigger else { return };
    if let [first, second] = sides.as_mut_slice() {
        if *second == Expression::Time {
            std::mem::swap(first, second);
        }
        if *first == Expression::Time {
            *function = Function::GreaterOrEqual;
        }
    }
}

fn check(own: &Translation<'_>, event: &Event) -> Result<(), Refusal> {
    let refuse = |fault: Fault| Err(Refusal::new(event.place.clone(), fault));
    for (target, _) in &event.assignments {
        match own.quantity(target) {
            None => return refuse(Fault::new(BAD_OPTION, format!("nothing declares `{target}`"))),
            Some(_) if matches!(own.roles.get(target), Role::Algebraic) => {
                let message = format!(
                    "the event assigns `{target}`, which an algebraic rule determines; this is not supported"
                );
                return refuse(Fault::new(BAD_OPTION, message));
            }
            Some(_) => {}
        }
    }
    Ok(())
}

/// Whether no event can see what another one does at the same time.
fn is_simple(events: &[Event]) -> bool {
    let mut targets = BTreeSet::new();
    let all = || events.iter().flat_map(|event| &event.assignments);
    let is_alone = all().all(|(target, _)| targets.insert(target));
    let plain = |event: &Event| {
        event.delay.is_none()
            && event.initial_value
            && (events.len() == 1
                || event.uses_trigger_values && event.persistent && event.priority.is_none())
    };
    is_alone && events.iter().all(plain)
}

/// An expression as an event sees it before anything is assigned.
fn before(own: &Translation<'_>, math: &Expression) -> Expression {
    let assigned = own.document.events.iter().flat_map(|event| &event.assignments);
    let assigned: BTreeSet<String> = assigned.map(|(target, _)| own.stored(target)).collect();
    own.expanded(math, &assigned).replaced(&|part| match part {
        Expression::Name(name) if assigned.contains(name) => Some(Expression::Pre(name.clone())),
        _ => None,
    })
}

/// The new value of what is stored; amounts follow from the sizes before the event.
fn stored_value(own: &Translation<'_>, target: &str, value: Expression) -> Expression {
    match own.size_of(target) {
        None => value,
        Some(size) => value.times(before(own, &size)),
    }
}

/// An event as a when-equation.
fn simple(own: &mut Translation<'_>, event: &Event) {
    let trigger = printed(&event.trigger, Context::Boolean);
    let title = if event.title.is_empty() { &event.id } else { &event.title };
    let mut lines = vec![format!("when {trigger} then // {}", title.replace('\n', " "))];
    for (target, math) in &event.assignments {
        let value = stored_value(own, target, before(own, math));
        let stored = identifier(&own.stored(target));
        lines.push(match own.roles.get(target) {
            Role::State => format!("  reinit({stored}, {});", real(&value)),
            _ => format!("  {stored} = {};", real(&value)),
        });
    }
    lines.push("end when;".to_owned());
    if event.assignments.is_empty() {
        return;
    }
    own.class.equations.extend(lines);
}

/// Events one after the other, in the order of their priorities: at an event, every iteration executes
/// one of those that are pending.
fn general(own: &mut Translation<'_>, events: &[Event]) {
    let all: Vec<Parts> = events.iter().map(|event| parts(own, event)).collect();
    for (place, event) in events.iter().enumerate() {
        conditions(own, (events, &all), place);
        executed(own, event, &all[place]);
    }
    for (event, parts) in events.iter().zip(&all) {
        triggered(own, event, parts);
    }
}

fn parts(own: &mut Translation<'_>, event: &Event) -> Parts {
    let mut fresh = |what: &str| own.document.names.fresh(&format!("{}_{what}", event.id));
    let keeps = event.uses_trigger_values;
    let values = event.assignments.iter().filter(|_| keeps);
    Parts {
        trigger: fresh("trigger"),
        ready: fresh("ready"),
        fires: fresh("fires"),
        pending: fresh("pending"),
        due: event.delay.as_ref().map_or(String::new(), |_| fresh("due")),
        values: values.map(|(target, _)| (target.clone(), fresh(target))).collect(),
    }
}

/// A Boolean variable.
fn flag(name: &str) -> Expression {
    Expression::Condition(identifier(name))
}

fn and(conditions: Vec<Expression>) -> Expression {
    Expression::call(Function::And, conditions)
}

fn not(condition: Expression) -> Expression {
    Expression::call(Function::Not, vec![condition])
}

/// Declares the conditions of the event at `place`: its trigger, whether it is ready, and whether it is
/// the one that is executed.
fn conditions(own: &mut Translation<'_>, (events, all): (&[Event], &[Parts]), place: usize) {
    let (event, parts) = (&events[place], &all[place]);
    let mut ready = vec![Expression::Condition(format!("pre({})", identifier(&parts.pending)))];
    if event.delay.is_some() {
        let due = Expression::Pre(parts.due.clone());
        ready.push(Expression::call(Function::GreaterOrEqual, vec![Expression::Time, due]));
    }
    if !event.persistent {
        ready.push(flag(&parts.trigger));
    }
    if !event.initial_value {
        // An event of the start is executed after the initialization.
        ready.push(not(Expression::Condition("initial()".to_owned())));
    }
    let mut fires = vec![flag(&parts.ready)];
    for (other, others) in all.iter().enumerate().filter(|(other, _)| *other != place) {
        let ready = flag(&others.ready);
        match precedes(own, [&events[other], event], other < place) {
            Expression::Truth(true) => fires.push(not(ready)),
            Expression::Truth(false) => {}
            condition => fires.push(not(and(vec![ready, condition]))),
        }
    }
    let title = if event.title.is_empty() { &event.id } else { &event.title };
    let trigger = identifier(&parts.trigger);
    own.class.declarations.push(format!("Boolean {trigger} {};", quoted(title)));
    own.class.declarations.push(format!("Boolean {};", identifier(&parts.ready)));
    own.class.declarations.push(format!("Boolean {};", identifier(&parts.fires)));
    for (name, value) in
        [(&parts.trigger, &event.trigger), (&parts.ready, &and(ready)), (&parts.fires, &and(fires))]
    {
        let value = printed(value, Context::Boolean);
        own.class.equations.push(format!("{} = {value};", identifier(name)));
    }
}

/// Whether the first event is executed before the second where both are ready.
fn precedes(own: &Translation<'_>, events: [&Event; 2], is_earlier: bool) -> Expression {
    let [a, b] = events.map(|event| event.priority.as_ref().map(|priority| before(own, priority)));
    let (Some(a), Some(b)) = (&a, &b) else {
        // Without a priority, any order is right.
        return Expression::Truth(
            a.is_some() && b.is_none() || a.is_some() == b.is_some() && is_earlier,
        );
    };
    match (a.value(), b.value()) {
        (Some(a), Some(b)) => Expression::Truth(a > b || a == b && is_earlier),
        _ => {
            let function = if is_earlier { Function::GreaterOrEqual } else { Function::Greater };
            Expression::call(function, vec![a.clone(), b.clone()])
        }
    }
}

/// What the trigger of an event does: the event is pending, and keeps values for its assignments.
fn triggered(own: &mut Translation<'_>, event: &Event, parts: &Parts) {
    let [trigger, pending, due] =
        [&parts.trigger, &parts.pending, &parts.due].map(|name| identifier(name));
    let mut lines = vec![format!("when {trigger} then")];
    let mut keep = |own: &mut Translation<'_>, name: &str, math: &Expression| {
        lines.push(format!("  {name} := {};", real(&before(own, math))));
        if event.initial_value {
            own.class.declarations.push(format!("discrete Real {name}(start = 0, fixed = true);"));
        } else {
            own.class.declarations.push(format!("discrete Real {name};"));
            own.class.initial.push(format!("pre({name}) = {};", real(math)));
        }
    };
    if let Some(delay) = &event.delay {
        keep(own, &due, &Expression::sum(vec![Expression::Time, delay.clone()]));
    }
    for (target, math) in event.assignments.iter().filter(|_| event.uses_trigger_values) {
        keep(own, &identifier(&parts.values[target]), math);
    }
    if event.delay.is_some() || event.persistent {
        let message =
            format!("event {} is triggered again before it is executed; not supported", event.id);
        lines.insert(1, format!("  assert(not pre({pending}), {message:?});"));
    }
    lines.extend([format!("  {pending} := true;"), "end when;".to_owned()]);
    if event.initial_value {
        own.class
            .declarations
            .push(format!("discrete Boolean {pending}(start = false, fixed = true);"));
    } else {
        own.class.declarations.push(format!("discrete Boolean {pending};"));
        own.class.initial.push(format!("pre({pending}) = {trigger};"));
    }
    if !event.persistent {
        let when = format!("when not {trigger} then");
        lines.extend([when, format!("  {pending} := false;"), "end when;".to_owned()]);
    }
    own.class.algorithm.extend(lines);
}

/// The assignments of an event.
fn executed(own: &mut Translation<'_>, event: &Event, parts: &Parts) {
    let fires = identifier(&parts.fires);
    let mut lines =
        vec![format!("when {fires} then"), format!("  {} := false;", identifier(&parts.pending))];
    let mut reinits = Vec::new();
    for (target, math) in &event.assignments {
        let value = parts.values.get(target).map(Expression::name);
        let value = stored_value(own, target, value.unwrap_or_else(|| before(own, math)));
        let stored = identifier(&own.stored(target));
        match own.roles.get(target) {
            Role::State => reinits.push(format!("  reinit({stored}, {});", real(&value))),
            _ => lines.push(format!("  {stored} := {};", real(&value))),
        }
    }
    lines.push("end when;".to_owned());
    own.class.algorithm.extend(lines);
    if !reinits.is_empty() {
        own.class.equations.push(format!("when {fires} then"));
        own.class.equations.extend(reinits);
        own.class.equations.push("end when;".to_owned());
    }
}
