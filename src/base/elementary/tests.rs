//! Own functions against those of the standard library and against exact values.

use super::{acos, asin, atan, atan2, cos, cosh, exp, exp_m1, hypot, ln, ln_1p, log10, powf, powi};
use super::{acosh, asinh, atanh, cbrt, log2, sin, sin_cos, sinh, tan, tanh};

/// Arguments without order in an interval.
fn draws(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let mut state = 2006_u64;
    (0..20_000).map(move |_| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mixed = (state ^ state >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        low + (high - low) * ((mixed >> 11) as f64 / (1_u64 << 53) as f64)
    })
}

/// Distance in units of the last place.
fn ulps(a: f64, b: f64) -> u64 {
    if a == b || (a.is_nan() && b.is_nan()) { 0 } else { a.to_bits().abs_diff(b.to_bits()) }
}

/// The system's functions are within a unit or two of the exact value.
#[test]
fn functions_of_one_number_are_those_of_the_standard_library_but_for_the_last_digit() {
    type Unary = fn(f64) -> f64;
    let table: [(&str, Unary, Unary, f64, f64); 19] = [
        ("exp", exp, f64::exp, -740.0, 709.0),
        ("exp_m1", exp_m1, f64::exp_m1, -5.0, 5.0),
        ("ln", ln, f64::ln, 0.0, 1e3),
        ("ln_1p", ln_1p, f64::ln_1p, -0.99, 5.0),
        ("log10", log10, f64::log10, 0.0, 1e3),
        ("log2", log2, f64::log2, 0.0, 1e3),
        ("sin", sin, f64::sin, -1e5, 1e5),
        ("cos", cos, f64::cos, -1e5, 1e5),
        ("tan", tan, f64::tan, -1e5, 1e5),
        ("asin", asin, f64::asin, -1.0, 1.0),
        ("acos", acos, f64::acos, -1.0, 1.0),
        ("atan", atan, f64::atan, -20.0, 20.0),
        ("sinh", sinh, f64::sinh, -20.0, 20.0),
        ("cosh", cosh, f64::cosh, -20.0, 20.0),
        ("tanh", tanh, f64::tanh, -20.0, 20.0),
        ("asinh", asinh, |x: f64| x.asinh(), 1.0, 1e3),
        ("acosh", acosh, |x: f64| x.acosh(), 1.5, 1e3),
        ("atanh", atanh, |x: f64| x.atanh(), 0.1, 0.9),
        ("cbrt", cbrt, f64::cbrt, -1e3, 1e3),
    ];
    let special = [0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e-320, 1e22];
    for (name, own, system, low, high) in table {
        for x in draws(low, high).chain(draws(low / 1e3, high / 1e3)).chain(special) {
            let (own, system) = (own(x), system(x));
            assert!(ulps(own, system) <= 4, "{name}({x:?}) = {own:?}, not {system:?}");
            let same_sign = own.is_sign_negative() == system.is_sign_negative();
            assert!(same_sign || own.is_nan(), "{name}({x:?}) = {own:?}, not {system:?}");
        }
    }
}

#[test]
fn sine_and_cosine_are_those_computed_alone() {
    let special = [0.0, -0.0, f64::INFINITY, f64::NAN, 1e-320, -1e-9, 1e22, f64::MAX];
    let angles = draws(-1e5, 1e5).chain(draws(-7.0, 7.0)).chain(draws(-0.05, 0.05));
    for x in angles.chain(special) {
        let (sine, cosine) = sin_cos(x);
        assert_eq!([ulps(sine, sin(x)), ulps(cosine, cos(x))], [0, 0], "{x:?}");
        assert_eq!(sine.is_sign_negative(), sin(x).is_sign_negative(), "{x:?}");
    }
}

#[test]
fn powers_are_those_of_the_standard_library_but_for_the_last_digit() {
    let exponents = [-0.25, -0.2, 1.5, 1.0, -1.0, 3.0, -2.0, 0.5, -0.5, 2.0, 1.0 / 3.0, 17.0];
    for x in draws(1e-3, 30.0).chain(draws(0.9, 1.1)).chain(draws(-1e5, 1e5)) {
        for y in exponents.into_iter().chain([x]) {
            let (own, system) = (powf(x, y), x.powf(y));
            assert!(ulps(own, system) <= 1, "{x:?} ^ {y:?} = {own:?}, not {system:?}");
        }
    }
    let special = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        2.0,
        -3.0,
        0.5,
        -0.5,
        1e300,
        -1e300,
        1e-310,
        f64::MAX,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
        1e18,
        -1e18,
        4_503_599_627_370_497.0,
    ];
    for x in special {
        for y in special {
            let (own, system) = (powf(x, y), x.powf(y));
            let same = own == system && own.is_sign_negative() == system.is_sign_negative();
            assert!(
                same || own.is_nan() && system.is_nan(),
                "{x:?} ^ {y:?} = {own:?}, not {system:?}"
            );
        }
    }
}

/// Powers that the approximation decides are those that `pxfm` rounds correctly.
#[test]
fn the_approximation_of_a_power_never_rounds_the_wrong_way() {
    let pairs = draws(1e-3, 30.0).zip(draws(-40.0, 40.0));
    for (x, y) in pairs.chain(draws(0.99, 1.01).zip(draws(-3e4, 3e4))) {
        assert_eq!(powf(x, y).to_bits(), pxfm::f_pow(x, y).to_bits(), "{x:?} ^ {y:?}");
    }
}

#[test]
fn integer_powers_multiply_in_a_fixed_order() {
    assert_eq!(powi(1.1, 0), 1.0);
    assert_eq!(powi(1.1, 1), 1.1);
    assert_eq!(powi(1.1, 2), 1.1 * 1.1);
    assert_eq!(powi(1.1, 3), 1.1 * (1.1 * 1.1));
    assert_eq!(powi(1.1, -2), 1.0 / (1.1 * 1.1));
    assert_eq!(powi(10.0, 22), 1e22);
    assert_eq!(powi(2.0, i32::MIN), 0.0);
}

#[test]
fn lengths_neither_overflow_nor_lose_digits() {
    for (x, y) in draws(-30.0, 30.0).zip(draws(-1.0, 3.0)) {
        assert!(ulps(hypot(x, y), x.hypot(y)) <= 1, "hypot({x:?}, {y:?})");
    }
    assert_eq!(hypot(3e300, -4e300), 5e300);
    assert_eq!(hypot(3e-310, 4e-310), 5e-310);
    assert_eq!(hypot(-0.0, 0.0), 0.0);
    assert_eq!(hypot(f64::NAN, f64::INFINITY), f64::INFINITY);
    assert!(hypot(f64::NAN, 1.0).is_nan());
    assert!(hypot(1.0, f64::NAN).is_nan());
}

#[test]
fn angles_have_the_signs_of_ieee_754() {
    for y in [0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
        for x in [0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(atan2(y, x).to_bits(), y.atan2(x).to_bits(), "atan2({y:?}, {x:?})");
        }
    }
    for (y, x) in draws(-30.0, 30.0).zip(draws(-1.0, 3.0)) {
        assert!(ulps(atan2(y, x), y.atan2(x)) <= 1, "atan2({y:?}, {x:?})");
    }
}

/// Values computed with 120 digits and rounded; the GNU library 2.36 misses them by a unit.
#[test]
fn bits_are_those_of_the_exact_value() {
    type Unary = fn(f64) -> f64;
    let table: [(&str, Unary, f64, u64); 28] = [
        ("exp", exp, -14.141_578, 0x3ea8_37d7_5928_70be),
        ("exp", exp, 16.503_819, 0x416c_0d0b_3009_e735),
        ("ln", ln, 9.695_355, 0x4002_2c55_3662_ad5e),
        ("ln", ln, 0.376_358, 0xbfef_4557_42da_5ed2),
        ("log10", log10, 6.608_58, 0x3fea_3e53_7358_7ff7),
        ("log10", log10, 14.857_503, 0x3ff2_c04a_4460_6ac9),
        ("sin", sin, 8.553_995, 0x3fe8_7984_43ca_3e53),
        ("sin", sin, 0.677_171, 0x3fe4_0d08_0f73_ca9b),
        ("cos", cos, -1.300_582, 0x3fd1_1583_16f2_fd37),
        ("cos", cos, -7.286_363, 0x3fe1_343a_b2f6_8559),
        ("tan", tan, -1.886_033, 0x4008_8810_ad87_f885),
        ("tan", tan, 5.003_153, 0xc00a_bbe3_c4ca_882b),
        ("asin", asin, -0.988_163, 0xbff6_ab22_1aca_cbd2),
        ("asin", asin, -0.433, 0xbfdc_a90e_1c28_f6a5),
        ("acos", acos, 0.272_724, 0x3ff4_b692_47cf_20e2),
        ("acos", acos, 0.324_688, 0x3ff3_d782_4a79_37f9),
        ("atan", atan, -1.449_411, 0xbfee_f07e_49f3_8a33),
        ("atan", atan, -4.116_031, 0xbff5_51c3_2e36_7491),
        ("sinh", sinh, 5.628_499, 0x4061_63d9_5b4c_6aa7),
        ("sinh", sinh, -1.915_248, 0xc00a_90b5_5e9f_a991),
        ("cosh", cosh, -4.019_474, 0x403b_d84a_9e33_f483),
        ("cosh", cosh, 4.757_715, 0x404d_1f3c_3b23_37e1),
        ("tanh", tanh, -1.116_319, 0xbfe9_cd15_a451_4e5d),
        ("tanh", tanh, 1.227_467, 0x3fea_f060_cd38_0c59),
        ("exp_m1", exp_m1, 0.917_423, 0x3ff8_0b99_da9e_0aab),
        ("exp_m1", exp_m1, 1.808_385, 0x4014_6700_48ea_caf1),
        ("ln_1p", ln_1p, 0.626_621, 0x3fdf_22e5_4493_2673),
        ("ln_1p", ln_1p, -0.270_059, 0xbfd4_258b_8a93_c045),
    ];
    for (name, own, x, bits) in table {
        assert_eq!(own(x).to_bits(), bits, "{name}({x:?})");
    }
    assert_eq!(powf(25.0566, -3.9231).to_bits(), 0x3ecb_4367_c0d6_3ac0);
    assert_eq!(powf(5.5257, -5.4641).to_bits(), 0x3f17_0486_6076_7298);
    assert_eq!(powf(11.002, -6.3152).to_bits(), 0x3e91_c505_edb6_c122);
    assert_eq!(powf(16.3409, 5.6509).to_bits(), 0x415b_6357_e59d_c21e);
}
