//! What each statistic means, in one line with its threshold, and its section of the guide.

/// One of them.
pub(super) struct Explanation {
    /// The heading in the guide, in lower case as it stands within a sentence.
    pub(super) topic: &'static str,
    /// The line.
    pub(super) line: &'static str,
}

impl Explanation {
    /// The id of the section of the guide.
    pub(super) fn anchor(&self) -> String {
        super::guide::anchor(self.topic)
    }
}

pub(super) const STANDARD_ERROR: Explanation = Explanation {
    topic: "the standard error",
    line: "The standard error is the scatter of an estimate if the experiment were repeated; a parameter counts as identifiable when it is below half of the value, or its interval below a quarter of a linear search range.",
};
pub(super) const INTERVAL: Explanation = Explanation {
    topic: "the 95 % interval",
    line: "The 95 % interval contains the true value in 95 of 100 repetitions, if the model is right and the errors are independent.",
};
pub(super) const BAND: Explanation = Explanation {
    topic: "the fit and its bands",
    line: "The band is where the model's curve lies with 95 % confidence; a point far outside it and the scatter of the others is an outlier or a fault of the model.",
};
pub(super) const RMSE: Explanation = Explanation {
    topic: "the RMSE",
    line: "RMSE is the root of the mean squared residual, in the unit of the variable: it should be about as large as the error of the measurement.",
};
pub(super) const R_SQUARED: Explanation = Explanation {
    topic: "R squared",
    line: "R² is the part of the variation of the data that the model explains; 1 is all of it, below 0 the mean of the data would fit better. It says nothing about parameters.",
};
pub(super) const RUNS: Explanation = Explanation {
    topic: "runs of the residuals",
    line: "A run is a row of residuals of equal sign; far fewer than expected show that the model misses something systematic. All tests of the residuals together raise a false alarm in at most 1 of 100 cases.",
};
pub(super) const AUTOCORRELATION: Explanation = Explanation {
    topic: "the autocorrelation",
    line: "The autocorrelation compares each residual with the next; beyond ±2/√points neighbours are alike or opposed, and standard errors are too small.",
};
pub(super) const WATERFALL: Explanation = Explanation {
    topic: "the waterfall",
    line: "Each descent is a local search from another start, sorted by where it ended; a plateau at the left means that several starts reach the same minimum. One reached from at least three starts is trusted.",
};
pub(super) const CONVERGENCE: Explanation = Explanation {
    topic: "convergence",
    line: "The best so far can only fall; the best of the generation shows what the last population knew. A curve that still falls at the end says that the search was cut off.",
};
pub(super) const CORRELATION: Explanation = Explanation {
    topic: "correlations",
    line: "Estimates correlated beyond ±0.95 can be exchanged for each other: the data determine a combination of the two, not each one.",
};
pub(super) const CONDITION: Explanation = Explanation {
    topic: "the condition number",
    line: "The condition number of the sensitivities says how much small errors of the data are magnified; above 10 000 the estimates are unreliable.",
};
pub(super) const ELLIPSE: Explanation = Explanation {
    topic: "confidence ellipses",
    line: "The ellipse holds both values together with 95 % confidence, from the linearized model; a long, narrow one means that only a combination is identifiable.",
};
pub(super) const PROFILE: Explanation = Explanation {
    topic: "profiles",
    line: "Each point is a new fit with this parameter fixed; the interval ends where the curve crosses the 95 % limit. A curve that stays below the limit has no end there: the parameter is not identifiable in that direction.",
};
pub(super) const SENSITIVITY: Explanation = Explanation {
    topic: "sensitivity indices",
    line: "How much of the objective's variation over the whole search range comes from each parameter; one whose largest figure is near 0 hardly matters.",
};
pub(super) const FRONT: Explanation = Explanation {
    topic: "the front",
    line: "On the front no objective becomes smaller without another becoming larger; the knee is farthest from the line between the ends.",
};
pub(super) const MINIMA: Explanation = Explanation {
    topic: "other minima",
    line: "These parameters fit as well within the 95 % limit: the data do not decide between them and the result.",
};

/// All, for the test that the guide has a section on each.
#[cfg(test)]
pub(super) const ALL: [&Explanation; 16] = [
    &STANDARD_ERROR,
    &INTERVAL,
    &BAND,
    &RMSE,
    &R_SQUARED,
    &RUNS,
    &AUTOCORRELATION,
    &WATERFALL,
    &CONVERGENCE,
    &CORRELATION,
    &CONDITION,
    &ELLIPSE,
    &PROFILE,
    &SENSITIVITY,
    &FRONT,
    &MINIMA,
];
