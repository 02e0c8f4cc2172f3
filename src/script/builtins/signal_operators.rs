//! Numbers about a curve between two times: smallest and largest value, means, slew rate, harmonics.
//! The curve is linear between the points of the result; means are those of the trapezoidal rule, with
//! which sines that are sampled at equal distances over whole periods have exact ones.

use super::{Args, Builtin, Failure, Family};
use crate::diag::Fault;
use crate::elementary;
use crate::errors::{BAD_ARGUMENT, NO_WINDOW};
use crate::results::ResultTable;
use crate::value::{FromValue, Value};
use crate::{Dialect, Session};
use crate::{bail, fault};

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.Plot"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: SIGNAL_OPERATOR_VALUE, run: signal_operator_value },
        Builtin { header: PLOT_SIGNAL_OPERATOR, run: plot_signal_operator },
        Builtin { header: PLOT_SIGNAL_OPERATOR_HARMONIC, run: plot_signal_operator_harmonic },
    ],
};

/// Times beyond this stand for the begin and the end of the results.
const UNBOUNDED: f64 = 1e99;

/// How far, relative to a period, the length of a window may miss whole periods.
const WHOLE: f64 = 1e-6;

/// The operators, in the order of the literals of `SignalOperator`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Operator {
    Min,
    Max,
    ArithmeticMean,
    RectifiedMean,
    Rms,
    AcCoupledRms,
    SlewRate,
    Thd,
    FirstHarmonic,
}

impl Operator {
    fn take(args: &mut Args) -> Result<Operator, Fault> {
        use Operator::*;
        let number = match args.take::<Value>("signalOperator")? {
            Value::Enumeration(literal)
                if literal.definition.name.to_string() == "SignalOperator" =>
            {
                literal.ordinal
            }
            Value::Integer(number) => number,
            other => bail!(
                BAD_ARGUMENT,
                "`signalOperator` is a {}", other.type_name();
                help: "use a literal of `SignalOperator`, such as `SignalOperator.RMS`"
            ),
        };
        let all = [
            Min,
            Max,
            ArithmeticMean,
            RectifiedMean,
            Rms,
            AcCoupledRms,
            SlewRate,
            Thd,
            FirstHarmonic,
        ];
        let found = usize::try_from(number - 1).ok().and_then(|at| all.get(at).copied());
        match found {
            Some(operator) => Ok(operator),
            None => bail!(BAD_ARGUMENT, "`signalOperator` is {number}, outside 1 to {}", all.len()),
        }
    }
}

const SIGNAL_OPERATOR_VALUE: &str = r#"
function signalOperatorValue "The value of a signal operator over a part of a curve."
  input String variablePath "a variable of the last result, or \"Name[end].variable\" of the last result of a model or result file";
  input Any signalOperator "literal of SignalOperator: Min, Max, ArithmeticMean, RectifiedMean, RMS, ACCoupledRMS, SlewRate (largest derivative), THD, FirstHarmonic (its amplitude)";
  input Real startTime = -1e100 "s; default: the begin of the result";
  input Real stopTime = 1e100 "s; default: the end of the result";
  input Real period = 0.0 "s, for THD and FirstHarmonic: the last whole periods count";
  output Real value;
end signalOperatorValue;
"#;

fn signal_operator_value(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let operator = Operator::take(&mut args)?;
    let period: f64 = args.take("period")?;
    Ok(value(session, &mut args, operator, (period, 1))?.into())
}

const PLOT_SIGNAL_OPERATOR: &str = r#"
function plotSignalOperator "The value of a signal operator over a part of a curve; nothing is drawn."
  input String variablePath "a variable of the last result, or \"Name[end].variable\" of the last result of a model or result file";
  input Any signalOperator "literal of SignalOperator, see signalOperatorValue";
  input Real startTime "s";
  input Real stopTime "s";
  input Real period = 0.0 "s, for THD and FirstHarmonic: the last whole periods count";
  input Integer id = 0 "has no effect";
  output Real value;
end plotSignalOperator;
"#;

fn plot_signal_operator(session: &mut Session, args: Args) -> Result<Value, Failure> {
    draws_nothing(session, args.command());
    signal_operator_value(session, args)
}

const PLOT_SIGNAL_OPERATOR_HARMONIC: &str = r#"
function plotSignalOperatorHarmonic "The amplitude of a harmonic, or the total harmonic distortion, of a part of a curve; nothing is drawn."
  input String variablePath "a variable of the last result, or \"Name[end].variable\" of the last result of a model or result file";
  input Any signalOperator "SignalOperator.FirstHarmonic or SignalOperator.THD";
  input Real startTime "s";
  input Real stopTime "s";
  input Real period "s; the last whole periods count";
  input Real intervalLength = 0.0 "has no effect: the points of the result are used";
  input Any window = 1 "only 1, the rectangular window";
  input Integer harmonicNo = 1 "which harmonic; 1 for the fundamental one";
  input Integer id = 0 "has no effect";
  output Real value;
end plotSignalOperatorHarmonic;
"#;

fn plot_signal_operator_harmonic(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    draws_nothing(session, args.command());
    let operator = Operator::take(&mut args)?;
    if !matches!(operator, Operator::FirstHarmonic | Operator::Thd) {
        return Err(fault!(
            BAD_ARGUMENT,
            "`plotSignalOperatorHarmonic` computes `SignalOperator.FirstHarmonic` and \
             `SignalOperator.THD`";
            help: "use `plotSignalOperator` for the other operators"
        )
        .into());
    }
    let window = match args.take::<Value>("window")? {
        Value::Enumeration(literal) => literal.ordinal,
        other => i64::from_value(other)?,
    };
    if window != 1 {
        let text = "only the rectangular window is supported: `window = 1`";
        return Err(Fault::new(BAD_ARGUMENT, text).into());
    }
    let harmonic: i64 = args.take("harmonicNo")?;
    let Some(harmonic) = u32::try_from(harmonic).ok().filter(|number| *number > 0) else {
        return Err(fault!(BAD_ARGUMENT, "`harmonicNo` is {harmonic}, less than 1").into());
    };
    let period: f64 = args.take("period")?;
    Ok(value(session, &mut args, operator, (period, harmonic))?.into())
}

fn draws_nothing(session: &mut Session, command: &'static str) {
    if session.output.is_first_without_window(command) {
        session.note(NO_WINDOW, format!("`{command}` draws nothing here; it returns the value"));
    }
}

fn value(
    session: &mut Session,
    args: &mut Args,
    operator: Operator,
    (period, harmonic): (f64, u32),
) -> Result<f64, Fault> {
    let path: String = args.take("variablePath")?;
    let limits: [f64; 2] = [args.take("startTime")?, args.take("stopTime")?];
    let (table, name) = super::plotting::curve(session, &path)?;
    let (limits, outside) = within(&table, limits)?;
    if let Some(text) = outside {
        let note = fault!(BAD_ARGUMENT, "`{path}`: {text}").at(session.call_site()).note();
        session.report(note);
    }
    let curve = Curve::of(&table, &name, limits)?;
    match operator {
        Operator::Thd | Operator::FirstHarmonic => {
            let curve = curve.last_periods(period)?;
            match operator {
                Operator::Thd => curve.distortion(period),
                _ => Ok(curve.amplitude(period, harmonic)),
            }
        }
        _ => curve.value(operator),
    }
}

/// The part of the requested interval that the results have, and what is outside of them.
fn within(
    table: &ResultTable,
    [start, stop]: [f64; 2],
) -> Result<([f64; 2], Option<String>), Fault> {
    let (Some(first), Some(last)) = (table.time.first(), table.time.last()) else {
        bail!(BAD_ARGUMENT, "the result has no points")
    };
    let limits = [start.max(*first), stop.min(*last)];
    if limits[0] > limits[1] {
        bail!(
            BAD_ARGUMENT,
            "the result has no points from {start} to {stop}: it goes from {first} to {last}"
        );
    }
    // The last point may miss the stop time by rounding.
    let rounding = 1e-9 * (last - first);
    let is_outside =
        |limit: f64, own: f64| limit.abs() < UNBOUNDED && (limit - own).abs() > rounding;
    let outside = is_outside(start, limits[0]) || is_outside(stop, limits[1]);
    let text = format!(
        "the result goes from {first} to {last}, and not from {start} to {stop}: what it has counts"
    );
    Ok((limits, outside.then_some(text)))
}

/// Points of a curve in an interval, and at its ends.
struct Curve {
    time: Vec<f64>,
    values: Vec<f64>,
}

impl Curve {
    fn of(table: &ResultTable, name: &str, [start, stop]: [f64; 2]) -> Result<Curve, Fault> {
        let column = table.column(name)?;
        let curve = Curve { time: table.time.clone(), values: column };
        Ok(curve.between(start, stop))
    }

    /// The part between two times; where the curve jumps at its ends, what lies inside counts.
    fn between(&self, start: f64, stop: f64) -> Curve {
        let first = self.time.partition_point(|time| *time <= start);
        let last = self.time.partition_point(|time| *time < stop).max(first);
        let before = first.saturating_sub(1);
        let mut part = Curve { time: vec![start], values: vec![self.at(before, start)] };
        part.time.extend(&self.time[first..last]);
        part.values.extend(&self.values[first..last]);
        if stop > start {
            part.time.push(stop);
            part.values.push(self.at(last.saturating_sub(1), stop));
        }
        part
    }

    /// The value at a time after a point.
    fn at(&self, point: usize, time: f64) -> f64 {
        let next = (point + 1).min(self.time.len() - 1);
        let length = self.time[next] - self.time[point];
        let share = if length > 0.0 { (time - self.time[point]) / length } else { 0.0 };
        self.values[point] + share.min(1.0) * (self.values[next] - self.values[point])
    }

    fn length(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }

    /// The mean of something over time; it is given time and value at both ends of each step.
    fn mean(&self, of_step: impl Fn([f64; 2], [f64; 2]) -> f64) -> f64 {
        let steps = (1..self.time.len()).map(|at| {
            let time = [self.time[at - 1], self.time[at]];
            (time[1] - time[0]) * of_step(time, [self.values[at - 1], self.values[at]])
        });
        steps.sum::<f64>() / self.length()
    }

    fn value(&self, operator: Operator) -> Result<f64, Fault> {
        let values = || self.values.iter().copied();
        match operator {
            Operator::Min => return Ok(values().fold(f64::INFINITY, f64::min)),
            Operator::Max => return Ok(values().fold(f64::NEG_INFINITY, f64::max)),
            _ if self.length() <= 0.0 => {
                bail!(BAD_ARGUMENT, "the interval has no length: it is the time {}", self.time[0])
            }
            _ => {}
        }
        let arithmetic = || self.mean(|_, [a, b]| 0.5 * (a + b));
        let square = |around: f64| {
            let of = |value: f64| (value - around) * (value - around);
            self.mean(|_, [a, b]| 0.5 * (of(a) + of(b))).sqrt()
        };
        Ok(match operator {
            Operator::ArithmeticMean => arithmetic(),
            Operator::RectifiedMean => self.mean(|_, [a, b]| match a * b < 0.0 {
                true => 0.5 * (a * a + b * b) / (a.abs() + b.abs()),
                false => 0.5 * (a.abs() + b.abs()),
            }),
            Operator::AcCoupledRms => square(arithmetic()),
            Operator::SlewRate => self.steepest(),
            _ => square(0.0),
        })
    }

    /// The largest derivative; at a jump there is none.
    fn steepest(&self) -> f64 {
        let slope = |at: usize| {
            let length = self.time[at] - self.time[at - 1];
            (length > 0.0).then(|| (self.values[at] - self.values[at - 1]) / length)
        };
        (1..self.time.len()).filter_map(slope).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The last whole periods.
    fn last_periods(&self, period: f64) -> Result<Curve, Fault> {
        if !(period > 0.0 && period.is_finite()) {
            bail!(BAD_ARGUMENT, "`period` is {period}; harmonics need a positive one");
        }
        let count = (self.length() / period + WHOLE).floor();
        if count < 1.0 {
            bail!(
                BAD_ARGUMENT,
                "the interval of {} s is shorter than the period of {period} s",
                self.length()
            );
        }
        let stop = self.time[self.time.len() - 1];
        Ok(self.between((stop - count * period).max(self.time[0]), stop))
    }

    /// The amplitude of a harmonic over whole periods.
    fn amplitude(&self, period: f64, harmonic: u32) -> f64 {
        let start = self.time[0];
        let turns = 2.0 * std::f64::consts::PI * f64::from(harmonic) / period;
        let part = |of: fn((f64, f64)) -> f64| {
            2.0 * self.mean(|time, values| {
                let turned = |end: usize| elementary::sin_cos(turns * (time[end] - start));
                0.5 * (values[0] * of(turned(0)) + values[1] * of(turned(1)))
            })
        };
        elementary::hypot(part(|(sine, _)| sine), part(|(_, cosine)| cosine))
    }

    /// The root mean square of all higher harmonics relative to that of the first.
    fn distortion(&self, period: f64) -> Result<f64, Fault> {
        let all = self.value(Operator::AcCoupledRms)?;
        let first = self.amplitude(period, 1) / std::f64::consts::SQRT_2;
        if first <= f64::EPSILON * all.max(f64::MIN_POSITIVE) {
            bail!(BAD_ARGUMENT, "the curve has no first harmonic of the period {period} s");
        }
        Ok((all * all - first * first).max(0.0).sqrt() / first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn sampled(count: usize, stop: f64, of: impl Fn(f64) -> f64) -> Curve {
        let time: Vec<f64> = (0..=count).map(|at| stop * at as f64 / count as f64).collect();
        let values = time.iter().map(|time| of(*time)).collect();
        Curve { time, values }
    }

    fn near(found: Result<f64, Fault>, expected: f64) {
        let found = found.expect("a value");
        assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
    }

    #[test]
    fn a_sampled_sine_has_exact_means_and_harmonics() {
        let curve = sampled(24, 2.0, |t| {
            let (first, _) = elementary::sin_cos(2.0 * PI * t + 0.3);
            let (_, third) = elementary::sin_cos(6.0 * PI * t);
            1.0 + 2.0 * first + 0.5 * third
        });
        near(curve.value(Operator::ArithmeticMean), 1.0);
        near(curve.value(Operator::AcCoupledRms), (2.0f64 + 0.125).sqrt());
        near(curve.value(Operator::Rms), (1.0f64 + 2.0 + 0.125).sqrt());
        near(Ok(curve.amplitude(1.0, 1)), 2.0);
        near(Ok(curve.amplitude(1.0, 3)), 0.5);
        near(curve.distortion(1.0), 0.25);
    }

    #[test]
    fn a_piecewise_linear_curve_has_an_exact_rectified_mean() {
        let triangle = Curve { time: vec![0.0, 1.0, 3.0], values: vec![-1.0, 1.0, -3.0] };
        near(triangle.value(Operator::RectifiedMean), (0.5 + (0.25 + 2.25)) / 3.0);
        near(triangle.value(Operator::SlewRate), 2.0);
        near(triangle.value(Operator::Min), -3.0);
        near(triangle.between(0.5, 2.0).value(Operator::Max), 1.0);
        near(triangle.between(0.5, 2.0).value(Operator::ArithmeticMean), (0.25 + 0.0) / 1.5);
    }

    #[test]
    fn a_jump_has_no_slope() {
        let step = Curve { time: vec![0.0, 1.0, 1.0, 2.0], values: vec![0.0, 0.0, 5.0, 5.5] };
        near(step.value(Operator::SlewRate), 0.5);
        near(step.value(Operator::ArithmeticMean), 5.25 / 2.0);
        near(step.between(0.0, 1.0).value(Operator::Max), 0.0);
        near(step.between(1.0, 2.0).value(Operator::Min), 5.0);
    }
}
