//! What each statistic means, in one line with its threshold, and its section of the guide.

/// One of them.
pub(crate) struct Explanation {
    /// The heading in the guide, in lower case as it stands within a sentence.
    pub(super) topic: &'static str,
    /// The line.
    pub(super) line: &'static str,
}

impl Explanation {
    /// The id of the section of the guide.
    pub fn anchor(&self) -> String {
        super::guide::anchor(self.topic)
    }
}

pub(crate) const STANDARD_ERROR: Explanation = Explanation {
    topic: "the standard error",
    line: "The standard error is the scatter of an estimate over repetitions of the experiment. \
           A parameter is identifiable if the data end its 95 % interval on both sides, within \
           the search range, and on a logarithmic scale within a factor of 10.",
};
pub const INTERVAL: Explanation = Explanation {
    topic: "the 95 % interval",
    line: "The 95 % confidence interval contains the true value in 95 of 100 repetitions, if the \
           model is correct and the errors are independent.",
};
pub const BAND: Explanation = Explanation {
    topic: "the fit and its bands",
    line: "The band is where the model's curve lies with 95 % confidence; a point far outside \
           the band and the scatter of the other points is an outlier or a model error.",
};
pub(crate) const RMSE: Explanation = Explanation {
    topic: "the RMSE",
    line: "RMSE is the root of the mean squared residual, in the unit of the variable: it should be about as large as the error of the measurement.",
};
pub(crate) const R_SQUARED: Explanation = Explanation {
    topic: "R squared",
    line: "R² is the fraction of the variation of the data that the model explains: 1 is all of \
           it; below 0, the mean of the data fits better. It contains no information about \
           parameters.",
};
pub const RUNS: Explanation = Explanation {
    topic: "runs of the residuals",
    line: "A run is a sequence of residuals of the same sign; far fewer runs than expected indicate \
           a systematic model error. All residual tests together raise a false alarm in at most \
           1 of 100 cases.",
};
pub(crate) const AUTOCORRELATION: Explanation = Explanation {
    topic: "the autocorrelation",
    line: "The autocorrelation compares each residual with the next; beyond ±2/√points, \
           neighbours are similar or opposite, and standard errors are too small.",
};
pub(crate) const WATERFALL: Explanation = Explanation {
    topic: "the waterfall",
    line: "Each descent is a local search from a different start, sorted by its final objective; \
           a plateau on the left means that several starts reach the same minimum. A minimum \
           reached from at least three starts is reliable.",
};
pub(crate) const SEARCHES: Explanation = Explanation {
    topic: "searches",
    line: "Each search began with a different seed, sorted by its final objective; a plateau on the left \
           means that the result does not depend on chance. The result is that of the best one.",
};
pub(crate) const CONVERGENCE: Explanation = Explanation {
    topic: "convergence",
    line: "The best so far can only decrease; the best of the generation shows the state of the \
           population. A curve that still decreases at the end may mean that the search stopped too early.",
};
pub(crate) const CORRELATION: Explanation = Explanation {
    topic: "correlations",
    line: "Estimates correlated beyond ±0.95 can compensate each other: a combination of the two \
           is known much better than each one. Their verdicts say whether each one is identifiable.",
};
pub(crate) const CONDITION: Explanation = Explanation {
    topic: "the condition number",
    line: "The condition number of the sensitivities shows how strongly small errors in the data \
           are amplified; above 10,000, the estimates are unreliable.",
};
pub(crate) const ELLIPSE: Explanation = Explanation {
    topic: "confidence ellipses",
    line: "The ellipse contains both values with 95 % joint confidence, from the linearized \
           model; a long, narrow one means that a combination is known much better than each one.",
};
pub(crate) const PROFILE: Explanation = Explanation {
    topic: "profiles",
    line: "Profile likelihood: each point is a new fit with this parameter fixed; the interval \
           ends where the curve crosses the 95 % limit. If the curve stays below the limit, the \
           parameter is not identifiable in that direction.",
};
pub(crate) const SENSITIVITY: Explanation = Explanation {
    topic: "sensitivity indices",
    line: "How much each parameter contributes to the variation of the objective over the whole \
           search range; a parameter whose largest index is near 0 has little influence.",
};
pub(crate) const FRONT: Explanation = Explanation {
    topic: "the front",
    line: "On the Pareto front, no objective can decrease without an increase of another; the \
           knee is the point farthest from the line between the ends.",
};
pub const MINIMA: Explanation = Explanation {
    topic: "other minima",
    line: "These parameters fit equally well within the 95 % limit: the data do not discriminate \
           between them and the result.",
};

/// All, for the test that the guide has a section on each.
#[cfg(test)]
pub(super) const ALL: [&Explanation; 17] = [
    &STANDARD_ERROR,
    &INTERVAL,
    &BAND,
    &RMSE,
    &R_SQUARED,
    &RUNS,
    &AUTOCORRELATION,
    &WATERFALL,
    &SEARCHES,
    &CONVERGENCE,
    &CORRELATION,
    &CONDITION,
    &ELLIPSE,
    &PROFILE,
    &SENSITIVITY,
    &FRONT,
    &MINIMA,
];
