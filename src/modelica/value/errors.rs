//! Codes of operations on values.

use crate::codes;

codes! {
    /// An operand or argument of a type that does not fit.
    TYPE_MISMATCH = "type-mismatch":
        "## What it means\n\nAn operator, a function or a variable received a value of the wrong type. Only Integer is converted to Real implicitly; nothing is converted to String, Integer or Boolean.\n\n## Example\n\n`\"run\" + 3` adds a String and an Integer.\n\n## What to do\n\nConvert explicitly: `String(3)`, `integer(x)`, `Integer(e)`; for operators between a scalar and an array use the element-wise forms `.+`, `.-`, `./`, `.^`.",
    /// A subscript that names no element.
    INDEX_OUT_OF_RANGE = "index-out-of-range":
        "## What it means\n\nA subscript is outside its dimension. The first element has the subscript 1, the last one `size(a, d)`.\n\n## Example\n\n`v[4]` where `v` has 3 elements.\n\n## What to do\n\nCompare the subscript with `size(v, 1)`; inside the brackets, `end` is the last subscript. What MATLAB writes as `v(1)` is `v[1]` here. An array does not grow by an assignment: give it its size first, `v := zeros(3)`, or join arrays, `v := cat(1, v, {5})`.",
    /// Arrays whose sizes do not go together.
    SIZE_MISMATCH = "size-mismatch":
        "## What it means\n\nThe sizes of two arrays, or of an array and the variable it is assigned to, do not match.\n\n## Example\n\n`{1, 2} + {1, 2, 3}`\n\n## What to do\n\nCompare `size(a)` of both; `transpose`, `vector`, `matrix` and slices change shapes.",
    /// An Integer result outside 64 bits.
    INTEGER_OVERFLOW = "integer-overflow":
        "## What it means\n\nThe exact result of an Integer operation does not fit in 64 bits, or in a model is beyond 9007199254740991 (2^53 - 1): models compute with Reals, in which larger Integers are not exact. It is never wrapped around or rounded.\n\n## Example\n\n`9223372036854775807 + 1`\n\n## What to do\n\nCompute with Reals (write `1.0` for `1`) where the magnitude matters more than the last digit.",
    /// A Real result beyond the largest number.
    REAL_OVERFLOW = "real-overflow":
        "## What it means\n\nA number is larger than the largest Real, about 1.8e308. The result is not replaced by infinity, which would propagate to every number computed from it.\n\n## Example\n\n`exp(1000)`\n\n## What to do\n\nScale the quantities, or compute with logarithms. Use `Modelica.Constants.inf`, which is 1e60, for a limit that is never reached.",
    /// A zero divisor.
    DIVISION_BY_ZERO = "division-by-zero":
        "## What it means\n\nThe divisor of `/`, `./`, `div`, `mod` or `rem` is zero, or zero is raised to a negative power. The result is not replaced by infinity.\n\n## Example\n\n`1 / (x - x)`\n\n## What to do\n\nGuard the division: `if abs(d) > eps then n / d else …`.",
    /// An argument outside the domain of a function.
    DOMAIN_ERROR = "domain-error":
        "## What it means\n\nA function has no real value for its argument, such as the logarithm of a negative number.\n\n## Example\n\n`sqrt(-1)`\n\n## What to do\n\nCheck the argument, or limit it: `log(max(x, 1e-9))`.",
    /// A string that would not fit in memory.
    STRING_TOO_LONG = "string-too-long":
        "## What it means\n\nA string would have more than 268 435 456 (2^28) bytes.\n\n## Example\n\n`for i in 1:100 loop s = s + s; end for`\n\n## What to do\n\nCheck the loop that makes the string longer; write long strings to a file piece by piece, with `print(text, file)`.",
    /// An array that would not fit in memory.
    ARRAY_TOO_LARGE = "array-too-large":
        "## What it means\n\nAn array would have more than 16 777 216 (2^24) elements.\n\n## Example\n\n`zeros(100000, 100000)`\n\n## What to do\n\nCheck the sizes; a `for` loop over a long range does not build an array.",
}
