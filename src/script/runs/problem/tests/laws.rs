//! Errors and priors that are not normal, and what their likelihood is.

use super::*;
use std::f64::consts::TAU;

const MODEL: &str = "model M\n  parameter Real p = 1;\n  parameter Real s = 1;\n  Real a = p;\n  \
                     Real deviation = s;\nend M;\n";
const MEASURED: [f64; 9] = [1.0, 2.0, 3.0, 2.5, 2.2, 9.0, 2.1, 1.8, 2.4];

/// A fit of the constant p; `parameters` after its range.
fn fitted(parameters: &str, output: &str, measured: &[f64]) -> Solution {
    let problem = format!(
        "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
         p = {{ min = 0.1, max = 9{parameters}\n[[experiment]]\ndata = \"d.csv\"\n\
         outputs = {{ a = {{ column = \"a\", {output} }} }}\n"
    );
    let rows = measured.iter().enumerate().map(|(k, y)| format!("{k},{y}\n"));
    let data = format!("time,a\n{}", rows.collect::<String>());
    solved(&[("p.toml", problem), ("M.mo", MODEL.into()), ("d.csv", data)])
}

#[track_caller]
fn is(solution: &Solution, value: f64, deviation: Option<f64>, negative: f64) {
    let own = &solution.parameters[0];
    let text = solution.text();
    assert!((own.value - value).abs() < 1e-4 * value, "{value}\n{text}");
    let found = solution.likelihood.negative_log_likelihood.unwrap();
    assert!((found - negative).abs() < 1e-6 * negative.abs(), "{found} {negative}\n{text}");
    if let Some(deviation) = deviation {
        let found = own.deviation.unwrap();
        assert!((found - deviation).abs() < 1e-3 * deviation, "{found} {deviation}\n{text}");
    }
}

/// The median, whose standard error is that of the Fisher information 1/b² of each point.
#[test]
fn laplace_errors_have_the_median() {
    let sum: f64 = MEASURED.iter().map(|y| (y - 2.2).abs()).sum();
    let found = fitted(" }", "sigma = 0.5, error = \"laplace\"", &MEASURED);
    is(&found, 2.2, Some(0.5 / 3.0), sum / 0.5);
    // n (ln 2b + 1), b being the mean absolute error; nine points have eight degrees of freedom.
    let found = fitted(" }", "error = \"laplace\"", &MEASURED);
    let scale = sum / 9.0;
    is(&found, 2.2, Some(scale / 8.0_f64.sqrt()), 9.0 * ((2.0 * scale).ln() + 1.0));
    let logarithms: Vec<f64> = MEASURED.iter().map(|y| y.ln()).collect();
    let sum: f64 = logarithms.iter().map(|y| (y - 2.2_f64.ln()).abs()).sum();
    let found = fitted(" }", "sigma = 0.5, error = \"loglaplace\"", &MEASURED);
    is(&found, 2.2, None, sum / 0.5 + logarithms.iter().sum::<f64>());
}

/// `scipy.stats.t(4, p, 0.5)`, and with the scale that is most likely.
#[test]
fn student_errors_are_those_of_scipy() {
    let found = fitted(" }", "sigma = 0.5, error = \"student\"", &MEASURED);
    is(&found, 2.194_462_404_676_697, Some(0.197_202_659), 16.501_053_698_131_482);
    let scale = found.series[0].sigma.unwrap();
    assert!((scale - 0.5).abs() < 1e-12, "the scale is the one that was given: {scale}");
    let found = fitted(" }", "sigma = \"estimate\", error = \"student\"", &MEASURED);
    is(&found, 2.200_720_203_585_628, None, 16.128_984_345_061_337);
    let text = found.text();
    assert!(text.contains("Scales of the errors estimated with the parameters"), "{text}");
    let normal = fitted(" }", "sigma = 0.5", &MEASURED);
    let many =
        fitted(" }", "sigma = 0.5, error = \"student\", degrees_of_freedom = 1e9", &MEASURED);
    let [a, b] = [&normal, &many].map(|own| own.likelihood.negative_log_likelihood.unwrap());
    assert!((a - b).abs() < 1e-5, "{a} {b}");
}

/// A scale that is a parameter of the model has the same optimum as one that is estimated apart.
#[test]
fn the_model_may_compute_the_scale() {
    let parameters = " }\ns = { min = 0.01, max = 9 }";
    let found = fitted(parameters, "sigma = \"deviation\", error = \"student\"", &MEASURED);
    is(&found, 2.200_720_203_585_628, None, 16.128_984_345_061_337);
    // Fisher information: (ν + 1)/((ν + 3) s²) of p, 2ν/((ν + 3) s²) of s.
    let s = 0.696_399_350_627_991_2;
    let expected = [s * (7.0_f64 / 5.0 / 9.0).sqrt(), s * (7.0_f64 / 8.0 / 9.0).sqrt()];
    for (own, expected) in found.parameters.iter().zip(expected) {
        let deviation = own.deviation.unwrap();
        assert!((deviation - expected).abs() < 1e-3 * expected, "{}", found.text());
    }
}

/// The mean, with the variance of the mean of counts.
#[test]
fn counts_have_the_variance_of_their_expectation() {
    let counts = [3.0, 5.0, 0.0, 4.0, 2.0, 4.0];
    let found = fitted(" }", "error = \"poisson\"", &counts);
    // -Σ ln(e^-3 3^y/y!)
    let factorials: f64 = [6.0_f64, 120.0, 1.0, 24.0, 2.0, 24.0].iter().map(|f| f.ln()).sum();
    is(&found, 3.0, Some((3.0_f64 / 6.0).sqrt()), 18.0 - 18.0 * 3.0_f64.ln() + factorials);
    assert_eq!(found.series[0].sigma, None);
}

/// A Laplace prior moves the mean by 1/(n b) towards its centre, or holds the parameter there.
#[test]
fn laplace_priors_hold_parameters_at_their_centre() {
    let mean = MEASURED.iter().sum::<f64>() / 9.0;
    let half_log = 0.5 * std::f64::consts::TAU.ln();
    let square = |p: f64| MEASURED.iter().map(|y| 0.5 * (y - p) * (y - p) + half_log).sum::<f64>();
    let prior = ", prior = { distribution = \"laplace\", median = 1, scale = 0.2 } }";
    let found = fitted(prior, "sigma = 1", &MEASURED);
    let p = mean - 1.0 / (9.0 * 0.2);
    is(&found, p, None, square(p) + (p - 1.0) / 0.2 + 0.4_f64.ln());
    let prior = ", prior = { distribution = \"laplace\", median = 1, scale = 0.02 } }";
    let found = fitted(prior, "sigma = 1", &MEASURED);
    let own = found.parameters[0].value;
    assert!((own - 1.0).abs() < 1e-3, "{}", found.text());
}

/// A density that ends at limits has the integral 1 between them: `scipy.stats.truncnorm` and the
/// distribution of Laplace.
#[test]
fn truncated_priors_are_normalized() {
    for (prior, probability) in [
        ("mean = 1, sd = 2", 0.999_968_328_758_167 - 0.326_355_220_287_919_8),
        (
            "distribution = \"laplace\", median = 1, scale = 2",
            1.0 - 0.5 * (-4.0_f64).exp() - 0.5 * (-0.45_f64).exp(),
        ),
    ] {
        let of = |limits: &str| {
            let parameter = format!(", prior = {{ {prior}{limits} }} }}");
            let found = fitted(&parameter, "sigma = 1", &MEASURED);
            found.likelihood.negative_log_likelihood.unwrap()
        };
        let difference = of(", min = 0.1, max = 9") - of("");
        assert!((difference - probability.ln()).abs() < 1e-6, "{difference} {probability}");
    }
}

/// `scipy.stats.norm` with logcdf for two values below 1.5 and logsf for one above 4.
#[test]
fn values_beyond_limits_have_the_probability_of_that() {
    let measured = [0.3, 2.0, 3.0, 2.5, 2.2, 1.5, 9.0, 2.1, 1.8, 2.4];
    let with = |more: &str| format!("{more}, below = 1.5, above = 4");
    let found = fitted(" }", &with("sigma = 0.8"), &measured);
    is(&found, 2.241_745_996_475_219_5, Some(0.259_813_161_8), 13.340_797_160_141_873);
    let sigma = found.series[0].sigma.unwrap();
    assert!((sigma - 0.8).abs() < 1e-12, "limits have no part in it: {sigma}");
    let found = fitted(" }", &with("sigma = \"estimate\""), &measured);
    is(&found, 2.225_314_038_349_760_3, None, 13.080_638_727_881_94);
    let found =
        fitted(" }\ns = { min = 0.01, max = 9 }", &with("sigma = \"deviation\""), &measured);
    is(&found, 2.225_314_038_349_760_3, None, 13.080_638_727_881_94);
    let found = fitted(" }", &with("sigma = 0.3, error = \"lognormal\""), &measured);
    is(&found, 2.163_873_833_417_892_6, None, 12.999_453_331_190_427);
}

/// Two values beside limits do not have a scale.
#[test]
fn limits_alone_have_no_scale() {
    let files = [
        (
            "p.toml",
            "model = \"M\"\nfiles = [\"M.mo\"]\n[parameters]\np = { min = 0.1, max = 9 }\n\
             [[experiment]]\ndata = \"d.csv\"\noutputs = { a = { column = \"a\", below = 1 } }\n"
                .to_owned(),
        ),
        ("M.mo", MODEL.into()),
        ("d.csv", "time,a\n0,0.5\n1,0.6\n2,2\n3,3\n4,0\n".into()),
    ];
    let mut session = Session::new(Box::new(world(&files)));
    let errors = solve(&mut session, Path::new("p.toml"), &RunOptions::default()).unwrap_err();
    let said = format!("{errors:?}");
    assert!(said.contains("cannot be estimated from 2 points"), "{said}");
}

/// Densities of priors are those of the coordinate in which they are given.
#[test]
fn constants_of_priors_are_in_the_likelihood() {
    let negative = |prior: &str| {
        let prior = format!(", prior = {prior} }}");
        let own = fitted(&prior, "sigma = 1", &MEASURED);
        own.likelihood.negative_log_likelihood.unwrap()
    };
    let without = fitted(" }", "sigma = 1", &MEASURED).likelihood.negative_log_likelihood.unwrap();
    for (prior, constant) in [
        ("\"uniform\"", 8.9_f64.ln()),
        ("\"loguniform\"", 90.0_f64.ln().ln()),
        ("{ distribution = \"uniform\", min = 0, max = 20 }", 20.0_f64.ln()),
        ("{ distribution = \"loguniform\", min = 0.1, max = 10, base = 10 }", 2.0_f64.ln()),
    ] {
        let found = negative(prior) - without;
        assert!((found - constant).abs() < 1e-9, "{prior}: {found} {constant}");
    }
    let [natural, decimal] =
        ["", ", base = 10"].map(|base| negative(&format!("{{ median = 2, factor = 3{base} }}")));
    let of_base = 10.0_f64.ln().ln();
    assert!((natural - decimal - of_base).abs() < 1e-9, "{natural} {decimal}");
}

/// The density of a log-normal prior of the value is 1/p times that of ln p: it moves the best value, and
/// its constants are in the likelihood.
#[test]
fn a_log_normal_prior_can_be_one_of_the_value() {
    for (sd, limits, constant) in [
        (0.1, "", 0.0),
        (0.5, "", 0.0),
        // ln (Φ((ln 9 - 1)/0.5) - Φ((ln 0.1 - 1)/0.5))
        (0.5, ", min = 0.1, max = 9", -0.008_357_502_417_995),
    ] {
        let negative = |p: f64| {
            let data: f64 = MEASURED.iter().map(|y| 0.5 * (y - p).powi(2) + 0.5 * TAU.ln()).sum();
            data + 0.5 * ((p.ln() - 1.0) / sd).powi(2) + (sd * p * TAU.sqrt()).ln() + constant
        };
        let numbers = format!("distribution = \"lognormal\", mean = 1, sd = {sd}{limits}");
        let found = fitted(&format!(", prior = {{ {numbers} }} }}"), "sigma = 1", &MEASURED);
        let p = found.parameters[0].value;
        let own = found.likelihood.negative_log_likelihood.unwrap();
        assert!((own - negative(p)).abs() < 1e-8, "{own} {}", negative(p));
        let beside = negative(1.001 * p).min(negative(0.999 * p));
        assert!(negative(p) < beside, "{p} is not a minimum");
    }
}

/// A given sigma is believed also where others are estimated: their scatter says nothing of it.
#[test]
fn given_deviations_stay_beside_estimated_ones() {
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\n[parameters]\n\
                   p = { min = 0.1, max = 9 }\n[[experiment]]\ndata = \"d.csv\"\n\
                   outputs = { a = { column = \"a\", sigma = 1 } }\n[[experiment]]\n\
                   data = \"e.csv\"\noutputs = { a = { column = \"a\", sigma = \"estimate\" } }\n";
    let estimated = [0.5, 1.5, 2.0, 1.1];
    let rows = estimated.iter().enumerate().map(|(k, y)| format!("{k},{y}\n"));
    let found = solved(&[
        ("p.toml", problem.into()),
        ("M.mo", MODEL.into()),
        ("d.csv", "time,a\n0,1\n1,1.3\n2,0.8\n".into()),
        ("e.csv", format!("time,a\n{}", rows.collect::<String>())),
    ]);
    let own = &found.parameters[0];
    let p = own.value;
    let variance = estimated.iter().map(|y| (y - p).powi(2)).sum::<f64>() / 4.0;
    // The estimated variance has four degrees of freedom, less what p follows of its points.
    let freedom = 4.0 - 4.0 / variance / (3.0 + 4.0 / variance);
    let unbiased = variance * 4.0 / freedom;
    let share = 4.0 / unbiased / (3.0 + 4.0 / unbiased);
    let inflation = 1.0 + 4.0 * share * (1.0 - share) / freedom;
    let expected = (inflation / (3.0 + 4.0 / unbiased)).sqrt();
    let near = |own: f64, expected: f64| {
        assert!((own - expected).abs() < 1e-3 * expected, "{own} {expected}\n{}", found.text());
    };
    near(own.deviation.unwrap(), expected);
    // Satterthwaite's degrees of freedom are 5.27, of which the quantile of Student is 2.5315.
    near(freedom / share.powi(2), 5.269_834);
    near(found.likelihood.quantile.unwrap(), 2.531_493);
    // A new measurement has the given sigma, or the estimated one.
    for (band, variance) in found.inferred.bands.iter().zip([1.0, unbiased]) {
        near(band.points[0].confidence.unwrap(), 2.531_493 * expected);
        near(band.points[0].prediction.unwrap(), 2.531_493 * (expected.powi(2) + variance).sqrt());
    }
}

/// The likelihood of given sigmas is that of these, whatever the residuals are, and missing ones are
/// estimated as they are by default.
#[test]
fn the_likelihood_takes_given_sigmas_as_given() {
    let fit = |fitness: &str, sigma: &str| {
        let problem = format!(
            "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n{fitness}\n[parameters]\n\
             p = {{ min = 0.1, max = 9 }}\ns = {{ min = 0.1, max = 9 }}\n[[experiment]]\n\
             data = \"d.csv\"\noutputs = {{ a = {{ column = \"a\", sigma = 0.5 }}, \
             deviation = {{ column = \"b\"{sigma} }} }}\n"
        );
        let data = "time,a,b\n0,1,3\n1,2,4\n2,3,3.2\n3,2.5,3.7\n".to_owned();
        solved(&[("p.toml", problem), ("M.mo", MODEL.into()), ("d.csv", data)])
    };
    for sigma in [", sigma = 2", ""] {
        let [usual, likely] = ["", "fitness = \"log_likelihood\""].map(|own| fit(own, sigma));
        let logs = [&usual, &likely].map(|own| own.likelihood.negative_log_likelihood.unwrap());
        assert!((logs[0] - logs[1]).abs() < 1e-9, "{logs:?}");
        assert!((likely.fitness - logs[1]).abs() < 1e-9, "{}", likely.text());
        for (a, b) in usual.parameters.iter().zip(&likely.parameters) {
            let [a, b] = [a, b].map(|own| own.deviation.unwrap());
            assert!((a - b).abs() < 1e-6 * a, "{a} {b}\n{}", likely.text());
        }
    }
}

/// What has as many points as scales of its own has no residuals, whatever the noise is.
#[test]
fn a_point_with_a_scale_of_its_own_does_not_deny_the_noise() {
    let problem = "model = \"Free\"\nfiles = [\"tank.mo\"]\nbands = false\n[parameters]\n\
                   k = { min = 0.1, max = 5 }\n[[experiment]]\ndata = \"d.csv\"\n\
                   outputs = { h = \"h\" }\n[[experiment]]\ndata = \"e.csv\"\n\
                   outputs = { h = { column = \"h\", scale = \"estimate\" } }\n";
    let noisy = |t: f64| height(t, 1.0, 0.0) + 0.01 * (7.0 * t).sin();
    let found = solved(&[
        ("p.toml", problem.into()),
        ("d.csv", table("time,h", |t| noisy(t).to_string())),
        ("e.csv", "time,h\n1,30\n".into()),
    ]);
    let text = found.text();
    assert!(found.parameters[0].deviation.is_some(), "{text}");
    assert!(!text.contains("no noise"), "{text}");
    assert!(
        text.contains("The only point of experiment 2 / h would be fitted exactly with any value"),
        "{text}"
    );
}

/// Where one output fits and another does not, the fit is not worse than a constant.
#[test]
fn ranges_are_not_blamed_where_a_part_of_the_data_fits() {
    let problem = "model = \"Free\"\nfiles = [\"tank.mo\"]\nbands = false\n[parameters]\n\
                   k = { min = 0.1, max = 5 }\ngain = { min = 0.1, max = 5 }\n[[experiment]]\n\
                   data = \"d.csv\"\n\
                   outputs = { h = { column = \"h\", sigma = 0.01 }, q = { column = \"q\", sigma = 1 } }\n";
    let row = |t: f64| {
        let h = height(t, 1.0, 0.0);
        format!("{},{}", h + 0.01 * (7.0 * t).sin(), 3.0 + t)
    };
    let found = solved(&[("p.toml", problem.into()), ("d.csv", table("time,h,q", row))]);
    let text = found.text();
    assert!(text.contains("The fit of experiment 1 / q is worse than a constant"), "{text}");
    assert!(!text.contains("fit alike") && text.contains("gain has no effect"), "{text}");
}

const GEL: &str = "model = \"Free\"\nfiles = [\"tank.mo\"]\nbands = false\n[parameters]\n\
                   k = { min = 0.1, max = 5 }\n[[experiment]]\ndata = \"d.csv\"\n[experiment.outputs]\n";

/// A scale that outputs share has one sign, whichever of them states it.
#[test]
fn outputs_that_share_a_scale_share_its_sign() {
    let rows = table("time,h,p", |t| {
        let h = -3.0 * height(t, 1.0, 0.0);
        format!("{},{}", h + 0.01 * (7.0 * t).sin(), h + 0.01 * (5.0 * t).sin())
    });
    let any = "h = { column = \"h\", scale = \"gel\" }\n\
               p = { column = \"p\", scale = { name = \"gel\", sign = \"any\" } }\n";
    let found = solved(&[("p.toml", format!("{GEL}{any}")), ("d.csv", rows.clone())]);
    for series in &found.series {
        let scale = series.scale.as_ref().unwrap().value;
        assert!((scale + 3.0).abs() < 0.02, "{scale}\n{}", found.text());
    }
    let positive = any.replace("\"gel\" }", "{ name = \"gel\", sign = \"positive\" } }");
    let files = [("p.toml", format!("{GEL}{positive}")), ("d.csv", rows)];
    let mut session = Session::new(Box::new(world(&files)));
    let errors = solve(&mut session, Path::new("p.toml"), &RunOptions::default()).err().unwrap();
    assert!(errors[0].message.contains("the scale `gel` has two signs"), "{}", errors[0].message);
    assert_eq!(errors[0].labels.len(), 2, "both places");
}

/// Missing points of replicates are said once, and an estimated deviation that outputs share once.
#[test]
fn replicates_and_shared_deviations_are_said_once() {
    let outputs = "h = { columns = [\"a\", \"b\"], sigma = \"estimate s\" }\n\
                   p = { column = \"a\", sigma = \"estimate s\" }\n";
    let data = table("time,a,b", |t| match t {
        1.0 => ",".into(),
        2.0 => format!("{},", height(t, 1.0, 0.0)),
        _ => format!("{},{}", height(t, 1.0, 0.0) + 0.01, height(t, 1.0, 0.0) - 0.01),
    });
    let found = solved(&[("p.toml", format!("{GEL}{outputs}")), ("d.csv", data)]);
    let text = found.text();
    assert!(
        text.contains(
            "3 points of experiment 1 / h have no number and are left out (rows 5, 9); 31 points are \
             used."
        ),
        "{text}"
    );
    assert_eq!(text.matches("of experiment 1 / h have no number").count(), 1, "{text}");
    let sigmas = text.lines().find(|line| line.contains("estimated with the parameters")).unwrap();
    assert!(sigmas.contains(": s 0.0") && sigmas.ends_with(" (h, p)."), "{sigmas}");
}

/// Where other data are missed by many of their deviations, the sum that is searched is not the exponential
/// of the likelihood: profiles end where the likelihood says so.
#[test]
fn profiles_of_estimated_deviations_end_beside_data_that_are_missed() {
    let data = table("time,h,p", |t| {
        let h = height(t, 1.0, 0.0);
        format!("{},{}", h + 0.01 * (7.0 * t).sin(), -h)
    });
    let fit = |second: &str| {
        let problem = format!("{GEL}h = {{ column = \"h\", sigma = \"estimate\" }}\n{second}");
        let options = RunOptions { profile: true, ..RunOptions::default() };
        let found = solved_with(&[("p.toml", problem), ("d.csv", data.clone())], &options);
        let profile = found.profiles.as_ref().unwrap().profiles[0].clone();
        let half = 0.5 * (profile.interval[1].unwrap() - profile.interval[0].unwrap());
        (half / found.parameters[0].deviation.unwrap(), found.likelihood.quantile.unwrap())
    };
    // Of no positive scale, p says nothing of k.
    for (second, misses) in
        [("", false), ("p = { column = \"p\", scale = \"estimate\", sigma = 1e-3 }\n", true)]
    {
        let (ratio, quantile) = fit(second);
        assert!((ratio / quantile - 1.0).abs() < 0.1, "{misses}: {ratio} {quantile}");
    }
}

/// Data whose deviation is estimated may leave a standard deviation larger than that of the prior.
#[test]
fn a_prior_that_the_data_do_not_narrow_is_said_so() {
    let found =
        fitted(", prior = { mean = 2.2, sd = 0.1 } }", "sigma = \"estimate\"", &[1.6, 2.2, 2.8]);
    let text = found.text();
    assert!(found.parameters[0].deviation.unwrap() > 0.1, "{text}");
    assert!(text.contains("the data do not reduce the standard deviation 0.1 of p"), "{text}");
}
