"""Writes the problems of this folder: data, and what is true of them. Needs numpy and scipy.

    python3 make.py

Nothing here comes from the program. Every number that a problem claims is a closed form, a linear
regression, or a profile of the sum of squares over the whole range by scipy, from the data as they
stand in the file. An interval has 95 %: sums of squares up to `least (1 + t^2/f)` with Student's t for
f degrees of freedom, points minus the parameters that the data distinguish; with a given sigma, up to
`least + 1.96^2`.
"""

import math
import pathlib

import numpy as np
from scipy import optimize, stats

HERE = pathlib.Path(__file__).parent
OPEN = "open"


def number(value):
    return float(f"{value:.12g}")


class Problem:
    """A problem: why a careless tool fails at it, its files, and what is true."""

    def __init__(self, name, text, model, ranges, outputs='{ y = "y" }', x="x", head="", tail=""):
        self.name, self.text = name, " ".join(text.split())
        self.files = [("modelica", "M.mo", model.strip("\n") + "\n")]
        lines = [f"{key} = {value}" for key, value in ranges.items()]
        toml = 'model = "M"\nfiles = ["M.mo"]\n' + head + "\n[parameters]\n" + "\n".join(lines)
        toml += f'\n\n[[experiment]]\ndata = "d.csv"\nx = {{ variable = "{x}", column = "x" }}\n'
        toml += f"outputs = {outputs}\n" + tail
        self.files.append(("toml", "p.toml", toml))
        self.claims, self.parameters = [], {}

    def data(self, file="d.csv", **columns):
        names, rows = list(columns), zip(*columns.values())
        text = ",".join(names) + "\n"
        for row in rows:
            text += ",".join(cell if isinstance(cell, str) else f"{cell:.12g}" for cell in row) + "\n"
        self.files.append(("csv", file, text))
        return self

    def says(self, *patterns):
        self.claims.append(("says", list(patterns)))
        return self

    def never(self, *patterns):
        self.claims.append(("never", list(patterns)))
        return self

    def key(self, key, value):
        self.claims.append((key, value))
        return self

    def reads(self, pattern, value, within):
        self.claims.append(("reads", (pattern, value, within)))
        return self

    def of(self, name, verdict, value=None, ends=None, within=0.02, none=False, parts=None):
        """What is true of a parameter; `within` of the width of its interval."""
        own = {"verdict": [verdict] if isinstance(verdict, str) else list(verdict)}
        if value is not None:
            own["value"] = [number(v) for v in value]
        if none:
            own["interval"] = False
        if ends is not None:
            known = [end for end in ends if end is not OPEN]
            width = abs(known[1] - known[0]) if len(known) == 2 else abs(known[0]) if known else 0
            for side, end in zip(("least", "most"), ends):
                own[side] = OPEN if end is OPEN else [number(end), number(within * width)]
        if parts is not None:
            own["parts"] = [[number(end) for end in part] for part in parts]
            width = min(part[1] - part[0] for part in parts)
            own["within"] = number(within * width)
        self.parameters[name] = own
        return self

    def text_of_claims(self):
        def put(value):
            if isinstance(value, bool):
                return "true" if value else "false"
            if isinstance(value, str):
                return f"'{value}'"
            if isinstance(value, list):
                return "[" + ", ".join(put(part) for part in value) + "]"
            return repr(value)

        lines = []
        for key, value in self.claims:
            if key == "reads":
                pattern, number_, within = value
                tail = f"is = {number(number_)!r}, within = {number(within)!r}"
                lines.append(f"[[reads]]\npattern = '{pattern}'\n{tail.replace(', ', chr(10))}\n")
            else:
                lines.insert(0, f"{key} = {put(value)}\n")
        for name, own in self.parameters.items():
            body = "".join(f"{key} = {put(value)}\n" for key, value in own.items())
            lines.append(f"[parameters.{name}]\n{body}")
        return "\n".join(lines)

    def write(self):
        text = f"# {self.name}\n\n{self.text}\n"
        for kind, name, content in self.files + [("toml", None, self.text_of_claims())]:
            label = f"{kind},file={name}" if name else "toml,claims"
            text += f"\n```{label}\n{content.rstrip(chr(10))}\n```\n"
        (HERE / f"{self.name}.md").write_text(text)


def line(columns, y, sigma=None, names=None):
    """Linear regression: values, standard errors, the quantile, residual sum, covariance."""
    a = np.column_stack(columns)
    y = np.asarray(y, float)
    w = np.ones(len(y)) if sigma is None else 1 / np.broadcast_to(sigma, len(y))
    aw, yw = a * w[:, None], y * w
    scale = np.linalg.norm(aw, axis=0)
    values = np.linalg.lstsq(aw / scale, yw, rcond=None)[0] / scale
    rest = yw - aw @ values
    freedom = len(y) - a.shape[1]
    inverse = np.linalg.inv((aw / scale).T @ (aw / scale)) / np.outer(scale, scale)
    variance = 1 if sigma is not None else rest @ rest / freedom
    t = 1.959963985 if sigma is not None else stats.t.ppf(0.975, freedom)
    return values, np.sqrt(np.diag(inverse) * variance), t, rest @ rest, inverse * variance


def ends_of(value, error, t):
    return value - t * error, value + t * error


def solve(residuals, box, logs, k=None, v=None, starts=12, first=None):
    """The least sum of squares, with parameter `k` fixed at `v`."""
    free = [j for j in range(len(box)) if j != k]
    low = np.array([math.log(box[j][0]) if logs[j] else box[j][0] for j in free])
    high = np.array([math.log(box[j][1]) if logs[j] else box[j][1] for j in free])

    def unpacked(z):
        values = np.empty(len(box))
        if k is not None:
            values[k] = v
        for place, j in enumerate(free):
            values[j] = math.exp(min(z[place], high[place])) if logs[j] else z[place]
        return values

    if not free:
        r = residuals(unpacked([]))
        return r @ r, unpacked([]), np.array([])
    random = np.random.default_rng(7)
    tries = [] if first is None else list(first)
    tries += [low + (high - low) * random.random(len(free)) for _ in range(starts)]
    best = (math.inf, None, None)
    for z in tries:
        z = np.clip(z, low + 1e-9 * (high - low), high - 1e-9 * (high - low))
        try:
            found = optimize.least_squares(
                lambda z: residuals(unpacked(z)), z, bounds=(low, high), x_scale=high - low,
                xtol=1e-13, ftol=1e-13, gtol=1e-13, max_nfev=200)
        except ValueError:
            continue
        if 2 * found.cost < best[0]:
            best = (2 * found.cost, unpacked(found.x), found.x)
    return best


def profile(residuals, box, logs, k, freedom=None, grid=80, starts=0, also=None):
    """Parts of the range of parameter `k` within the 95 % limit; `OPEN` where the range ends them. The
    grid is dense near the best value and near `also(best)`; `starts` more fits from other places at each
    point of it."""
    best = solve(residuals, box, logs)
    least = best[0]
    limit = least + 3.841458821 if freedom is None else least * (1 + stats.t.ppf(0.975, freedom)**2 / freedom)
    go = (lambda v: math.log(v)) if logs[k] else (lambda v: v)
    back = math.exp if logs[k] else (lambda z: z)
    low, high = go(box[k][0]), go(box[k][1])
    near = (high - low) * 10 ** np.linspace(-7, 0, 40)
    centers = [go(best[1][k])] + ([go(also(best[1]))] if also else [])
    dense = {z for center in centers for z in (center, *(center - near), *(center + near))}
    points = sorted(z for z in dense | set(np.linspace(low, high, grid)) if low <= z <= high)
    others = np.delete(best[2], k)
    last = [others]

    def above(z):
        v = min(max(back(z), box[k][0]), box[k][1])
        found = solve(residuals, box, logs, k, v, starts, [others, last[0]])
        last[0] = found[2]
        return found[0] - limit

    heights = [above(z) for z in points]
    parts, start = [], OPEN if heights[0] <= 0 else None
    for (a, ha), (b, hb) in zip(zip(points, heights), zip(points[1:], heights[1:])):
        if (ha > 0) != (hb > 0):
            cross = back(optimize.brentq(above, a, b, xtol=1e-10 * (abs(a) + abs(b))))
            if ha > 0:
                start = cross
            else:
                parts.append((start, cross))
                start = None
    if heights[-1] <= 0:
        parts.append((start, OPEN))
    return parts, best[1], best[0]


def noise(seed, n, size):
    return size * np.random.default_rng(seed).standard_normal(n)


def noise_where(holds, n, size):
    """The first noise for which this holds."""
    return next(e for e in (noise(seed, n, size) for seed in range(1000)) if holds(e))


def static(declared, formula, inputs="input Real x;"):
    return f"model M\n  parameter Real {declared};\n  {inputs}\n  output Real y = {formula};\nend M;"


def between(low, high):
    return f"{{ min = {low}, max = {high} }}"


problems = []


def problem(build):
    problems.append(build)
    return build


TRUE, PRACTICAL = "identifiable", "practically_non_identifiable"
STRUCTURAL, WITHOUT = "structurally_non_identifiable", "without_effect"


# Ends of ranges


@problem
def slope_against_bound():
    x = np.arange(10.0)
    falls = lambda e: 0.3 < -line([np.ones(10), x], e)[0][1] / line([np.ones(10), x], e)[1][1] < 1.5
    y = np.round(2 + noise_where(falls, 10, 0.06), 3)
    (b, c), errors, _, rest, _ = line([np.ones(10), x], y)
    residuals = lambda p: p[0] + p[1] * x - y
    box, logs = [(-10, 10), (0, 10)], [False, False]
    (_, most), = profile(residuals, box, logs, 1, 8)[0]
    (low, high), = profile(residuals, box, logs, 0, 8)[0]
    assert c < 0 and abs(c / errors[1]) < 2
    return Problem(
        "slope_against_bound",
        f"""A level that cannot fall: the regression gives the slope {c:.4f}, {-c / errors[1]:.2f} standard
        errors below the lower end 0 of its range. These data bound it from above only.""",
        static("b = 1, c = 1", "b + c*x"), {"b": between(-10, 10), "c": between(0, 10)},
    ).data(x=x, y=y).of("b", TRUE, (y.mean(), 1e-4), (low, high), 0.1).of(
        "c", PRACTICAL, (0, 1e-6), (OPEN, most), 0.03).never("any value", "not a minimum")


@problem
def product_beside_a_bound():
    x = np.arange(12.0) / 4
    columns = [np.ones(12), x, x * x]
    pulls = lambda e: 0.8 < -line(columns, e)[0][2] / line(columns, e)[1][2] < 1.8
    y = np.round(2 + 0.5 * x + noise_where(pulls, 12, 0.05), 3)
    _, wide, *_ = line(columns, y)
    (m, d), errors, t, _, _ = line(columns[:2], y)
    residuals = lambda p: p[0] + p[1] * x + p[2] * x * x - y
    box, logs = [(0, 100), (-10, 10), (0, 10)], [False, False, False]
    # The curvature counts: 12 points less 3 combinations.
    errors = errors * math.sqrt(10 / 9)
    (low, high), = profile(residuals, box, logs, 1, 9)[0]
    (_, most), = profile(residuals, box, logs, 2, 9)[0]
    assert wide[1] > 2 * errors[1]
    return Problem(
        "product_beside_a_bound",
        f"""Only the product a b is determined, and the curvature c stands at the end 0 of its range. The
        standard error of the slope d is that of the straight line, {100 * errors[1] / d:.2f} % with 9
        degrees of freedom; with a
        free curvature it would be {100 * wide[1] / d:.2f} %, which the interval beside it contradicts.""",
        static("a = 1, b = 1, c = 1, d = 1", "a*b + d*x + c*x^2"),
        {"a": between(0.1, 10), "b": between(0.1, 10), "c": between(0, 10), "d": between(-10, 10)},
    ).data(x=x, y=y).of("a", STRUCTURAL, none=True).of("b", STRUCTURAL, none=True).of(
        "c", PRACTICAL, (0, 1e-6), (OPEN, most), 0.05).of("d", TRUE, (d, 1e-4), (low, high), 0.1).reads(
        r"(?m)^  d +\S+ +([.0-9]+) %", 100 * errors[1] / d, 0.06).says(r"a\*b").never("any value")


@problem
def fault_code():
    x = np.arange(40.0) / 8
    y = np.round(3 - 0.4 * x + noise(61, 40, 0.01), 3)
    y[5] = 99
    (a, b), _, _, least, _ = line([np.ones(40), x], y)
    assert least > 0.5 * (y @ y)
    return Problem(
        "fault_code",
        """One reading is 99, the fault code of an instrument. The fit is bad, and all descents lead to it:
        that is a matter of the data, and no other minimum has to be looked for. The report names the
        reading.""",
        static("a = 1, b = 1", "a + b*x"), {"a": between(-50, 50), "b": between(-50, 50)},
    ).data(x=x, y=y).of("a", [], (a, 1e-3)).of("b", [], (b, 1e-3)).says(
        "row 6", "reached by (12 of 12|13 of 13|14 of 14|15 of 15) descents").never("not a minimum")


@problem
def beyond_upper_bound():
    x = np.arange(12.0)
    y = np.round(0.5 + 1.3 * x + noise(2, 12, 0.02), 3)
    (_, a), errors, t, _, _ = line([np.ones(12), x], y)
    b = np.mean(y - x)
    return Problem(
        "beyond_upper_bound",
        """The optimum a = 1.3 lies far beyond the upper end 1 of its range: no interval of a can be given,
        and the range, not the data, has decided the value.""",
        static("a = 0.5, b = 0", "b + a*x"), {"a": between(0, 1), "b": between(-10, 10)},
    ).data(x=x, y=y).of("a", [], (1, 1e-6), none=True).of("b", [TRUE], (b, 1e-4)).says(
        "a lies at the upper end 1 of its search range: the optimum lies beyond it").reads(
        r"beyond it, by ([-+.0-9e]+) standard errors", (a - 1) / errors[1], 0.05 * (a - 1) / errors[1]).never(
        "a is practically", "any value")


@problem
def decay_beyond_its_range():
    x = np.arange(0, 205, 5.0)
    y = np.round(10 * np.exp(-0.01 * x) + noise(4, len(x), 0.05), 3)
    return Problem(
        "decay_beyond_its_range",
        """A rate of 0.01/s and a range from 0.1 to 10, drawn around the model's 1: at its lower end the fit
        is worse than a constant. The range says so, first of all; it is no statement on the rate.""",
        static("k = 1", "10*exp(-k*x)"), {"k": between(0.1, 10)},
    ).data(x=x, y=y).of("k", [], (0.1, 1e-9), none=True).says(
        "k lies at the lower end 0.1 of its search range.*down to 0.001.*drawn around", "worse than a constant",
        "Minimum found within the search ranges").never("any value", "k is practically")


@problem
def rate_without_effect_in_its_range():
    x = np.arange(1000, 1400, 20.0)
    y = np.round(10 * np.exp(-0.001 * x) + noise(5, len(x), 0.02), 3)
    return Problem(
        "rate_without_effect_in_its_range",
        """The decay is over in the whole range of the rate before the data begin: all values fit alike, and
        worse than a constant. That is said of the range.""",
        static("k = 1", "10*exp(-k*x)"), {"k": between(0.1, 10)},
    ).data(x=x, y=y).of("k", [], none=True).says(
        "All values of k in its search range, 0.1 to 10, fit alike.*Widen the range").never(
        "any value", "k is practically")


@problem
def small_offset_on_log_range():
    x = np.arange(1, 13.0)
    y = np.round(3 * x + 0.02 + noise(3, 12, 0.1), 3)
    (a, c), errors, _, _, _ = line([x, np.ones(12)], y)
    residuals = lambda p: p[0] * x + p[1] - y
    box, logs = [(0.1, 100), (1e-6, 10)], [True, True]
    (_, most), = profile(residuals, box, logs, 1, 10)[0]
    (((low, high),), best, _) = profile(residuals, box, logs, 0, 10)
    return Problem(
        "small_offset_on_log_range",
        f"""An offset whose logarithm is searched; the regression gives {c:.3f} with a standard error of
        {errors[1]:.3f}. Its logarithm has no lower limit.""",
        static("a = 1, c = 1", "a*x + c"), {"a": between(0.1, 100), "c": between("1e-6", 10)},
    ).data(x=x, y=y).of("a", TRUE, (best[0], 1e-3), (low, high), 0.15).of(
        "c", PRACTICAL, None, (OPEN, most), 0.03).never("any value")


@problem
def small_value_in_wide_range():
    x = np.arange(1, 11.0)
    y = np.round(3e-8 * 1e7 * x * (1 + noise(4, 10, 0.01)), 5)
    (a,), (error,), t, _, _ = line([1e7 * x], y)
    return Problem(
        "small_value_in_wide_range",
        """A value of 3e-8 in the range 0 .. 1: far below a thousandth of the range, and a hundred standard
        errors away from its lower end.""",
        static("a = 0.5", "a*1e7*x"), {"a": between(0, 1)},
    ).data(x=x, y=y).of("a", TRUE, (a, 1e-4 * a), ends_of(a, error, t), 0.01).never(
        "end of its", "consistent with", "any value")


@problem
def slope_at_zero():
    x = np.linspace(-5, 5, 11)
    flat = lambda e: abs(line([np.ones(11), x], e)[0][1] / line([np.ones(11), x], e)[1][1]) < 0.2
    y = np.round(4 + noise_where(flat, 11, 0.1), 3)
    (a, b), errors, t, _, _ = line([np.ones(11), x], y)
    return Problem(
        "slope_at_zero",
        """A slope whose true value is 0: its 95 % interval contains 0, and a standard error in per cent of a
        value that cannot be distinguished from 0 says nothing.""",
        static("a = 1, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
    ).data(x=x, y=y).of("a", TRUE, (a, 1e-5), ends_of(a, errors[0], t), 0.005).of(
        "b", TRUE, (b, 1e-5), ends_of(b, errors[1], t), 0.005).never(r"[0-9]{3,} %", "non-identifiable")


# Combinations


@problem
def product():
    x = np.arange(8.0)
    y = np.round(2.4 * x + 1 + noise(11, 8, 0.02), 3)
    (m, c), errors, t, _, _ = line([x, np.ones(8)], y)
    return Problem(
        "product", "Only the product a b is determined, and the offset c; a and b are not.",
        static("a = 1, b = 1, c = 1", "a*b*x + c"),
        {"a": between(0.1, 10), "b": between(0.1, 10), "c": between(-5, 5)},
    ).data(x=x, y=y).of("a", STRUCTURAL, none=True).of("b", STRUCTURAL, none=True).of(
        "c", TRUE, (c, 1e-5), ends_of(c, errors[1], t), 0.005).says(r"a\*b").reads(
        r"a\*b is ([-+.0-9e]+)", m, 1e-3).reads(
        r"a\*b is [-+.0-9e]+ \(95 % interval ([-+.0-9e]+) \.\.", m - t * errors[0], 2e-3)


@problem
def sum_of_two():
    x = np.arange(8.0)
    y = np.round(2 + 0.5 * x + noise(12, 8, 0.02), 3)
    (s, c), errors, t, _, _ = line([np.ones(8), x], y)
    return Problem(
        "sum_of_two", "Only the sum a + b is determined, and the slope c.",
        static("a = 1, b = 1, c = 1", "a + b + c*x"),
        {"a": between(-5, 5), "b": between(-5, 5), "c": between(-5, 5)},
    ).data(x=x, y=y).of("a", STRUCTURAL, none=True).of("b", STRUCTURAL, none=True).of(
        "c", TRUE, (c, 1e-5), ends_of(c, errors[1], t), 0.005).reads(
        r"a \+ b is ([-+.0-9e]+)", s, 1e-3).reads(
        r"a \+ b is [-+.0-9e]+ \(95 % interval ([-+.0-9e]+) \.\.", s - t * errors[0], 2e-3)


@problem
def difference():
    x = np.arange(1, 9.0)
    y = np.round(0.7 * x + noise(13, 8, 0.02), 3)
    (s,), errors, t, _, _ = line([x], y)
    return Problem(
        "difference", "Only the difference a - b is determined.",
        static("a = 1, b = 1", "(a - b)*x"), {"a": between(-5, 5), "b": between(-5, 5)},
    ).data(x=x, y=y).of("a", STRUCTURAL, none=True).of("b", STRUCTURAL, none=True).reads(
        r"a - b is ([-+.0-9e]+)", s, 1e-3)


@problem
def power():
    x = np.arange(1, 13.0)
    y = np.round(2 * (0.5 * x)**0.7 + noise(14, 12, 0.01), 4)
    (((low, high),), best, _) = profile(lambda p: p[0] * x**p[1] - y, [(0.1, 10), (0.1, 3)], [True, True], 1, 10)
    return Problem(
        "power", """c (a x)^b depends on b and on c a^b: neither c nor a is determined. The form is neither a
        product nor a sum.""",
        static("a = 1, b = 1, c = 1", "c*(a*x)^b"),
        {"a": between(0.01, 100), "b": between(0.1, 3), "c": between(0.01, 100)},
    ).data(x=x, y=y).of("a", STRUCTURAL, none=True).of("c", STRUCTURAL, none=True).of(
        "b", TRUE, (best[1], 1e-4), (low, high), 0.05).says(r"structurally non-identifiable")


@problem
def exponents():
    x = np.arange(10.0)
    y = np.round(np.exp(0.8 - 0.3 * x) + noise(15, 10, 0.005), 4)
    f = lambda p: np.exp(p[0] - p[1] * x) - y
    box, logs = [(-10, 10), (0.01, 5)], [False, True]
    (low, high), = profile(f, box, logs, 1, 8)[0]
    best = solve(f, box, logs)
    return Problem(
        "exponents", "exp(a + b - k x): only the sum of a and b acts.",
        static("a = 0, b = 0, k = 1", "exp(a + b - k*x)"),
        {"a": between(-5, 5), "b": between(-5, 5), "k": between(0.01, 5)},
    ).data(x=x, y=y).of("a", STRUCTURAL, none=True).of("b", STRUCTURAL, none=True).of(
        "k", TRUE, (best[1][1], 1e-4), (low, high), 0.05).reads(r"a \+ b is ([-+.0-9e]+)", best[1][0], 1e-3)


@problem
def scale_of_a_fraction():
    x = np.arange(1, 13.0)
    y = np.round(4 * x / (3 + x) + noise(16, 12, 0.01), 4)
    return Problem(
        "scale_of_a_fraction", """a x/(b + c x) does not change when a, b and c are multiplied by one factor: none of
        the three is determined, two ratios are.""",
        static("a = 1, b = 1, c = 1", "a*x/(b + c*x)"),
        {"a": between(0.01, 100), "b": between(0.01, 100), "c": between(0.01, 100)},
    ).data(x=x, y=y).of("a", STRUCTURAL, none=True).of("b", STRUCTURAL, none=True).of("c", STRUCTURAL, none=True).says(
        r"[Ff]ix one")


@problem
def arrhenius_at_one_temperature():
    x = np.arange(1, 11.0)
    y = np.round(0.4 * x + noise(17, 10, 0.01), 4)
    return Problem(
        "arrhenius_at_one_temperature", """A rate constant k0 exp(-E/(R T)) at one temperature: only the rate is
        determined, at any activation energy.""",
        static("k0 = 1e5, E = 3e4", "k0*exp(-E/(8.314*300))*x"),
        {"k0": between(1, "1e10"), "E": between(1000, 60000)},
    ).data(x=x, y=y).of("k0", STRUCTURAL, none=True).of("E", STRUCTURAL, none=True)


@problem
def time_shift():
    x = np.arange(1, 13.0)
    y = np.round(3 * np.exp(-0.4 * (x - 1)) + noise(18, 12, 0.005), 4)
    f = lambda p: p[0] * np.exp(-p[1] * x) - y
    box, logs = [(0.1, 100), (0.01, 5)], [True, True]
    (low, high), = profile(f, box, logs, 1, 10)[0]
    best = solve(f, box, logs)
    return Problem(
        "time_shift", """x0 exp(-k (t - t0)): a later beginning and a larger start value are the same; k is
        determined.""",
        static("x0 = 1, k = 1, t0 = 0", "x0*exp(-k*(x - t0))"),
        {"x0": between(0.1, 100), "k": between(0.01, 5), "t0": between(-3, 3)},
    ).data(x=x, y=y).of("x0", STRUCTURAL, none=True).of("t0", STRUCTURAL, none=True).of(
        "k", TRUE, (best[1][1], 1e-4), (low, high), 0.05)


@problem
def delay_and_offset():
    x = np.arange(10.0)
    y = np.round(1 + 0.5 * (x - 2) + noise(19, 10, 0.01), 4)
    (c, a), errors, t, _, _ = line([np.ones(10), x], y)
    return Problem(
        "delay_and_offset", "A ramp c + a (t - d): delay and offset are one number, c - a d. The slope is determined.",
        static("c = 0, a = 1, d = 1", "c + a*(x - d)"),
        {"c": between(-5, 5), "a": between(0.01, 5), "d": between(0, 5)},
    ).data(x=x, y=y).of("c", STRUCTURAL, none=True).of("d", STRUCTURAL, none=True).of(
        "a", TRUE, (a, 1e-4), ends_of(a, errors[1], t), 0.02)


@problem
def collinear_inputs():
    x = np.arange(12.0)
    u = np.round(np.sin(x) + 1.5, 3)
    v = np.round(2 * u, 3)
    y = np.round(0.5 * u + 0.7 * v + noise(20, 12, 0.02), 3)
    (s,), errors, t, _, _ = line([u], y)
    return Problem(
        "collinear_inputs", """Two inputs of which one is always twice the other: these data determine a + 2 b, and
        neither a nor b.""",
        "model M\n  parameter Real a = 1, b = 1;\n  input Real u;\n  input Real v;\n  output Real y = a*u + b*v;\nend M;",
        {"a": between(-5, 5), "b": between(-5, 5)}, x="time",
        tail='inputs = { u = "u", v = "v" }\n',
    ).data(x=x, u=u, v=v, y=y).of("a", [STRUCTURAL, PRACTICAL]).of("b", [STRUCTURAL, PRACTICAL]).reads(
        r"(?:a \+ 2\*b|0\.5\*a \+ b) is ([-+.0-9e]+)", s, 2e-3)


@problem
def nearly_collinear():
    x = np.arange(12.0)
    u = np.round(np.sin(x) + 1.5, 3)
    v = np.round(2 * u + noise(121, 12, 0.05), 3)
    y = np.round(0.5 * u + 0.7 * v + noise(21, 12, 0.02), 3)
    (a, b), errors, t, _, _ = line([u, v], y)
    return Problem(
        "nearly_collinear", """Two inputs that differ by little: both values are determined, loosely, and both intervals
        are those of the regression.""",
        "model M\n  parameter Real a = 1, b = 1;\n  input Real u;\n  input Real v;\n  output Real y = a*u + b*v;\nend M;",
        {"a": between(-5, 5), "b": between(-5, 5)}, x="time",
        tail='inputs = { u = { column = "u", interpolation = "linear" }, v = { column = "v", interpolation = "linear" } }\n',
    ).data(x=x, u=u, v=v, y=y).of("a", TRUE, (a, 1e-4), ends_of(a, errors[0], t), 0.01).of(
        "b", TRUE, (b, 1e-4), ends_of(b, errors[1], t), 0.01).says("[Ss]trongly correlated: a and b").never("structurally")


@problem
def michaelis_at_low_concentration():
    x = np.linspace(0.005, 0.05, 12)
    y = np.round(2.01 * x / (2 + x) * (1 + noise(22, 12, 0.02)), 6)
    f = lambda p: (p[0] * x / (p[1] + x) - y) * 1e3
    box, logs = [(0.01, 1000), (0.01, 1000)], [True, True]
    (v_least, v_most), = profile(f, box, logs, 0, 10)[0]
    (k_least, k_most), = profile(f, box, logs, 1, 10)[0]
    assert v_most is OPEN and k_most is OPEN
    return Problem(
        "michaelis_at_low_concentration", """Concentrations far below Km: Vm/Km is determined to some per cent, Vm and
        Km have lower limits only.""",
        static("Vm = 1, Km = 1", "Vm*x/(Km + x)"), {"Vm": between(0.01, 1000), "Km": between(0.01, 1000)},
    ).data(x=x, y=y).of("Vm", PRACTICAL, None, (v_least, OPEN), 0.05).of(
        "Km", PRACTICAL, None, (k_least, OPEN), 0.05).says("Vm/Km").never("any value", "structurally")


@problem
def michaelis_at_high_concentration():
    x = np.linspace(50, 200, 12)
    y = np.round(2 * x / (0.1 + x) + noise(23, 12, 0.02), 4)
    f = lambda p: p[0] * x / (p[1] + x) - y
    box, logs = [(0.01, 1000), (0.001, 100)], [True, True]
    (v_low, v_high), = profile(f, box, logs, 0, 10)[0]
    (((k_least, k_most),), best, _) = profile(f, box, logs, 1, 10)
    assert k_least is OPEN
    return Problem(
        "michaelis_at_high_concentration", """Concentrations far above Km: Vm is determined, of Km an upper limit is
        known.""",
        static("Vm = 1, Km = 1", "Vm*x/(Km + x)"), {"Vm": between(0.01, 1000), "Km": between(0.001, 100)},
    ).data(x=x, y=y).of("Vm", TRUE, (best[0], 0.01), (v_low, v_high), 0.1).of(
        "Km", PRACTICAL, None, (OPEN, k_most), 0.05).never("any value", "structurally")


@problem
def rate_too_fast():
    x = np.linspace(1, 5, 12)
    y = np.round(3 * (1 - np.exp(-20 * x)) + noise(24, 12, 0.01), 4)
    f = lambda p: p[0] * (1 - np.exp(-p[1] * x)) - y
    box, logs = [(0.1, 100), (0.01, 1000)], [True, True]
    (k_least, k_most), = profile(f, box, logs, 1, 10)[0]
    (low, high), = profile(f, box, logs, 0, 10)[0]
    assert k_most is OPEN
    return Problem(
        "rate_too_fast", "All points lie after the end of the rise: A is determined, k has a lower limit only.",
        static("A = 1, k = 1", "A*(1 - exp(-k*x))"), {"A": between(0.1, 100), "k": between(0.01, 1000)},
    ).data(x=x, y=y).of("A", TRUE, None, (low, high), 0.1).of("k", PRACTICAL, None, (k_least, OPEN), 0.05).never(
        "any value", "not a minimum", "in steps")


@problem
def rate_too_slow():
    x = np.linspace(1, 5, 12)
    y = np.round(30 * (1 - np.exp(-0.002 * x)) + noise(25, 12, 0.01), 4)
    f = lambda p: -p[0] * np.expm1(-p[1] * x) - y
    box, logs = [(0.1, 6000), (1e-5, 10)], [True, True]
    (k_least, k_most), = profile(f, box, logs, 1, 10)[0]
    (a_least, a_most), = profile(f, box, logs, 0, 10)[0]
    assert k_least is OPEN and a_most is OPEN
    return Problem(
        "rate_too_slow", """Only the beginning of the rise was measured: A k is determined, A has a lower limit, k an
        upper one.""",
        static("A = 1, k = 1", "A*(1 - exp(-k*x))"), {"A": between(0.1, 6000), "k": between("1e-5", 10)},
    ).data(x=x, y=y).of("A", PRACTICAL, None, (a_least, OPEN), 0.05).of("k", PRACTICAL, None, (OPEN, k_most), 0.05).says(
        r"A\*k").never("any value", "structurally")


# Without effect


@problem
def unused_parameter():
    x = np.arange(8.0)
    y = np.round(2 + 0.5 * x + noise(31, 8, 0.02), 3)
    (a, b), errors, t, _, _ = line([np.ones(8), x], y)
    return Problem(
        "unused_parameter", "d does nothing: no value of it may be stated, and a and b keep their intervals.",
        static("a = 1, b = 1, d = 1", "a + b*x"),
        {"a": between(-5, 5), "b": between(-5, 5), "d": between(0.1, 10)},
    ).data(x=x, y=y).of("a", TRUE, (a, 1e-5), ends_of(a, errors[0], t), 0.03).of(
        "b", TRUE, (b, 1e-5), ends_of(b, errors[1], t), 0.03).of("d", WITHOUT, none=True).says("d has no effect")


@problem
def forgotten_start_value():
    x = np.arange(1, 13.0)
    y = np.round(2 + noise(32, 12, 0.02), 3)
    mean, error, t = y.mean(), y.std(ddof=1) / math.sqrt(12), stats.t.ppf(0.975, 11)
    return Problem(
        "forgotten_start_value", """A tank forgets its start value with exp(-50 t) before the first point at 1 s: x0 has
        no effect that could be measured. u is the mean of the data.""",
        "model M\n  parameter Real x0 = 1, u = 1;\n  Real y(start = x0, fixed = true);\nequation\n  der(y) = 50*(u - y);\nend M;",
        {"x0": between(0.1, 10), "u": between(-10, 10)}, x="time",
    ).data(x=x, y=y).of("x0", [WITHOUT, PRACTICAL]).of("u", TRUE, (mean, 1e-4), ends_of(mean, error, t), 0.05).says(
        "x0 (has no effect|is practically non-identifiable)")


@problem
def rate_at_rest():
    x = np.arange(12.0)
    y = np.round(3 + noise(33, 12, 0.02), 3)
    mean, error, t = y.mean(), y.std(ddof=1) / math.sqrt(12), stats.t.ppf(0.975, 11)
    return Problem(
        "rate_at_rest", "An experiment at rest: the rate k has no effect on the rest state g.",
        "model M\n  parameter Real k = 1, g = 1;\n  Real y(start = 0);\nequation\n  der(y) = k*(g - y);\nend M;",
        {"k": between(0.1, 10), "g": between(-10, 10)}, x="time", tail="steady_state = true\n",
    ).data(x=x, y=y).of("k", WITHOUT, none=True).of("g", TRUE, (mean, 1e-4), ends_of(mean, error, t), 0.05).says(
        "k has no effect")


# Several minima


@problem
def sign():
    x = np.arange(10.0)
    y = np.round(1 + 4 * x + noise(41, 10, 0.1), 3)
    (b, m), errors, t, _, _ = line([np.ones(10), x], y)
    low, high = (math.sqrt(end) for end in ends_of(m, errors[1], t))
    return Problem(
        "sign", "a acts as its square: a = 2 and a = -2 fit equally well, and nothing between them fits.",
        static("a = 1, b = 1", "a^2*x + b"), {"a": between(-5, 5), "b": between(-5, 5)},
    ).data(x=x, y=y).of("a", TRUE, parts=[(-high, -low), (low, high)], within=0.02).of(
        "b", TRUE, (b, 1e-4), ends_of(b, errors[0], t), 0.01)


@problem
def exchange():
    x = np.linspace(0, 5, 21)
    y = np.round(np.exp(-0.5 * x) + np.exp(-3 * x) + noise(42, 21, 0.01), 4)
    f = lambda p: np.exp(-p[0] * x) + np.exp(-p[1] * x) - y
    parts = profile(f, [(0.05, 20), (0.05, 20)], [True, True], 0, 19, starts=2, also=lambda p: p[1])[0]
    assert len(parts) == 2
    return Problem(
        "exchange", "Two rates that can be exchanged: each is one of two numbers, none of them lies between.",
        static("k1 = 1, k2 = 2", "exp(-k1*x) + exp(-k2*x)"), {"k1": between(0.05, 20), "k2": between(0.05, 20)},
    ).data(x=x, y=y).of("k1", TRUE, parts=parts, within=0.06).of("k2", TRUE, parts=parts, within=0.06).never(
        "structurally")


@problem
def ordered():
    x = np.linspace(0, 5, 21)
    y = np.round(np.exp(-0.5 * x) + np.exp(-3 * x) + noise(42, 21, 0.01), 4)
    f = lambda p: np.exp(-p[0] * x) + np.exp(-p[1] * x) - y
    low, high = profile(f, [(0.05, 20), (0.05, 20)], [True, True], 0, 19, starts=2, also=lambda p: p[1])[0]
    return Problem(
        "ordered", "The constraint k1 < k2 removes the exchange: each rate has one interval.",
        static("k1 = 1, k2 = 2", "exp(-k1*x) + exp(-k2*x)"), {"k1": between(0.05, 20), "k2": between(0.05, 20)},
        head='constraints = ["k1 < k2"]\n',
    ).data(x=x, y=y).of("k1", TRUE, None, low, 0.06).of("k2", TRUE, None, high, 0.06).never("separate parts")


@problem
def equal_rates():
    x = np.linspace(0, 5, 21)
    y = np.round(2 * np.exp(-x) + noise(43, 21, 0.01), 4)
    f = lambda p: np.exp(-p[0] * x) + np.exp(-p[1] * x) - y
    parts, best, least = profile(f, [(0.05, 20), (0.05, 20)], [True, True], 0, 19, starts=2, also=lambda p: p[1])
    assert len(parts) == 1
    return Problem(
        "equal_rates", f"""The same two rates where the truth is k1 = k2 = 1 (least squares: {best[0]:.3f}, {best[1]:.3f}):
        the interval of each contains both, and is that of the profile; the linear one is not valid where the
        two derivatives become one.""",
        static("k1 = 1, k2 = 2", "exp(-k1*x) + exp(-k2*x)"), {"k1": between(0.05, 20), "k2": between(0.05, 20)},
    ).data(x=x, y=y).of("k1", TRUE, None, parts[0], 0.1).of("k2", TRUE, None, parts[0], 0.1).never("structurally")


@problem
def phase():
    x = np.linspace(0, 6, 25)
    y = np.round(2 * np.sin(x + 2) + noise(44, 25, 0.05), 3)
    f = lambda p: p[0] * np.sin(x + p[1]) - y
    box = [(0.1, 10), (0, 12)]
    parts, best, _ = profile(f, box, [True, False], 1, 23, starts=2, also=lambda p: (p[1] + 2 * math.pi) % (4 * math.pi))
    (low, high), = profile(f, box, [True, False], 0, 23)[0]
    assert len(parts) == 2
    return Problem(
        "phase", "A phase in the range 0 .. 12: 2 and 2 + 2 pi are the same, and each has its own narrow interval.",
        static("A = 1, p = 1", "A*sin(x + p)"), {"A": between(0.1, 10), "p": between(0, 12)},
    ).data(x=x, y=y).of("A", TRUE, (best[0], 1e-3), (low, high), 0.03).of("p", TRUE, parts=parts, within=0.03)


@problem
def alias():
    x = np.arange(12.0)
    y = np.round(np.cos(x) + noise(45, 12, 0.02), 3)
    parts, _, _ = profile(lambda p: np.cos(p[0] * x) - y, [(0.1, 6.2)], [False], 0, 11, grid=4000)
    assert len(parts) == 2
    return Problem(
        "alias", "A frequency sampled once a second: w = 1 and w = 2 pi - 1 give the same samples.",
        static("w = 1", "cos(w*x)"), {"w": "{ min = 0.1, max = 6.2, scale = \"linear\" }"},
    ).data(x=x, y=y).of("w", TRUE, parts=parts, within=0.02)


@problem
def three_minima():
    x = np.arange(1, 11.0)
    y = np.round(noise(46, 10, 0.1), 3)
    (m,), (error,), t, _, _ = line([x], y)
    parts, _, _ = profile(lambda p: (p[0]**3 - 3 * p[0]) * x - y, [(-3, 3)], [False], 0, 9, grid=4001)
    assert len(parts) == 3
    return Problem(
        "three_minima", "a^3 - 3 a is 0 within its error: at a = 0 and at both square roots of 3, three separate intervals.",
        static("a = 1", "(a^3 - 3*a)*x"), {"a": between(-3, 3)},
    ).data(x=x, y=y).of("a", TRUE, parts=parts, within=0.02)


@problem
def unequal_minima():
    x = np.arange(1, 11.0)
    y = np.round(0.5 * x + noise(47, 10, 0.1), 3)
    f = lambda p: (p[0]**4 - 2 * p[0]**2 + 0.3 * p[0] + 1) * x - y
    parts, best, _ = profile(f, [(-2, 2)], [False], 0, 9, grid=4001)
    return Problem(
        "unequal_minima", f"A polynomial of a that takes the measured slope at {len(parts)} places: as many separate intervals.",
        static("a = 1", "(a^4 - 2*a^2 + 0.3*a + 1)*x"), {"a": between(-2, 2)},
    ).data(x=x, y=y).of("a", TRUE, parts=parts, within=0.03)


# Kinks and steps


@problem
def step_threshold():
    x = np.arange(12.0)
    y = np.round(np.where(x < 4.5, 1, 3) + noise(51, 12, 0.1), 3)
    left, right = y[:5], y[5:]
    error = math.sqrt((5 * left.var() + 7 * right.var()) / 10)
    t = stats.t.ppf(0.975, 10)
    a, b = left.mean(), right.mean()
    return Problem(
        "step_threshold", """A threshold c between the samples 4 and 5: every value between them fits equally well, no
        other fits. The levels are means.""",
        static("a = 0, b = 1, c = 3", "if x < c then a else b"),
        {"a": between(-10, 10), "b": between(-10, 10), "c": between(0.5, 10.5)},
    ).data(x=x, y=y).of("a", TRUE, (a, 1e-4), ends_of(a, error / math.sqrt(5), t), 0.12).of(
        "b", TRUE, (b, 1e-4), ends_of(b, error / math.sqrt(7), t), 0.12).of("c", [TRUE], (4.5, 0.5), (4, 5), 0.05)


@problem
def kink():
    x = np.arange(12.0)
    y = np.round(2 * np.maximum(0, x - 5) + noise(52, 12, 0.1), 3)
    f = lambda p: p[0] * np.maximum(0, x - p[1]) - y
    box, logs = [(0.1, 10), (0.5, 10.5)], [True, True]
    (((c_low, c_high),), best, _) = profile(f, box, logs, 1, 10)
    (a_low, a_high), = profile(f, box, logs, 0, 10)[0]
    return Problem(
        "kink", f"A rise that begins near the sample at 5 (best: {best[1]:.4f}): the sum of squares has a kink there.",
        static("a = 1, c = 3", "a*max(0, x - c)"), {"a": between(0.1, 10), "c": between(0.5, 10.5)},
    ).data(x=x, y=y).of("a", TRUE, (best[0], 1e-3), (a_low, a_high), 0.1).of(
        "c", TRUE, (best[1], 1e-3), (c_low, c_high), 0.1)


@problem
def absolute_value():
    x = np.arange(10.0)
    falls = lambda e: 0.3 < -line([np.ones(10), x], e)[0][1] / line([np.ones(10), x], e)[1][1] < 1
    y = np.round(1 + noise_where(falls, 10, 0.1), 3)
    (b, m), errors, t, _, _ = line([np.ones(10), x], y)
    f = lambda p: p[0] + p[1] * x - y
    most = profile(f, [(-5, 5), (0, 1)], [False, False], 1, 8)[0][0][1]
    assert m < 0
    return Problem(
        "absolute_value", f"""|p| acts; the regression gives {m:.4f}, so p = 0 is best, at a kink. Values to both sides
        are excluded from {most:.4f} on.""",
        static("b = 0, p = 0.5", "b + abs(p)*x"), {"b": between(-5, 5), "p": between(-1, 1)},
    ).data(x=x, y=y).of("b", TRUE, (y.mean(), 1e-3)).of("p", TRUE, (0, 1e-3), (-most, most), 0.03).never("worse than a constant")


@problem
def square_at_zero():
    x = np.arange(10.0)
    falls = lambda e: 0.3 < -line([np.ones(10), x], e)[0][1] / line([np.ones(10), x], e)[1][1] < 1
    y = np.round(1 + noise_where(falls, 10, 0.1), 3)
    f = lambda p: p[0] + p[1] * x - y
    most = math.sqrt(profile(f, [(-5, 5), (0, 1)], [False, False], 1, 8)[0][0][1])
    return Problem(
        "square_at_zero", f"""p^2 acts, and p = 0 is best: the first derivative vanishes there. Values to both sides are
        excluded from {most:.4f} on.""",
        static("b = 0, p = 0.5", "b + p^2*x"), {"b": between(-5, 5), "p": between(-1, 1)},
    ).data(x=x, y=y).of("b", TRUE, (y.mean(), 1e-3)).of("p", TRUE, (0, 1e-2), (-most, most), 0.03)


# Exact and rounded data, few points


@problem
def exact_decay():
    x = np.arange(8.0)
    y = 3 * np.exp(-0.7 * x)
    return Problem(
        "exact_decay", """Data of the model itself to 12 digits: the truth is found, both values are identifiable, and
        without noise there is neither a standard error nor an interval.""",
        static("a = 1, b = 1", "a*exp(-b*x)"), {"a": between(0.1, 10), "b": between(0.1, 10)},
    ).data(x=x, y=y).of("a", TRUE, (3, 1e-8), none=True).of("b", TRUE, (0.7, 1e-8), none=True).never("not a minimum", "outlier")


@problem
def exact_product():
    x = np.arange(8.0)
    y = 3 * np.exp(-0.7 * x)
    return Problem(
        "exact_product", "Exact data of s x0 exp(-k t): the truth of k is found, and s x0; s and x0 are structurally open.",
        static("s = 1, x0 = 1, k = 1", "s*x0*exp(-k*x)"),
        {"s": between(0.1, 10), "x0": between(0.1, 10), "k": between(0.1, 10)},
    ).data(x=x, y=y).of("s", STRUCTURAL, none=True).of("x0", STRUCTURAL, none=True).of(
        "k", TRUE, (0.7, 1e-8), none=True).says(r"s\*x0").never("not a minimum")


@problem
def constant_data():
    x = np.arange(8.0)
    return Problem(
        "constant_data", "All points are 5: a = 5 and b = 0 without any residual; R2 has no meaning, nor has an interval.",
        static("a = 1, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
    ).data(x=x, y=np.full(8, 5.0)).of("a", TRUE, (5, 1e-8), none=True).of("b", TRUE, (0, 1e-8), none=True).never(
        "not a minimum", "NaN", "inf")


@problem
def rounded():
    x = np.arange(20.0)
    y = np.round(1 + 0.0337 * x, 1)
    (a, b), errors, t, _, _ = line([np.ones(20), x], y)
    return Problem(
        "rounded", "Readings with one decimal of a slow rise: none of them is an outlier. The slope has the interval of the regression.",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
    ).data(x=x, y=y).of("a", TRUE, (a, 1e-5), ends_of(a, errors[0], t), 0.01).of(
        "b", TRUE, (b, 1e-5), ends_of(b, errors[1], t), 0.01).never("outlier")


@problem
def three_points():
    x = np.arange(3.0)
    y = np.array([1.1, 1.9, 3.2])
    (a, b), errors, t, _, _ = line([np.ones(3), x], y)
    return Problem(
        "three_points", f"Three points and two parameters: one degree of freedom, so the interval has {t:.2f} standard errors, not two.",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
    ).data(x=x, y=y).of("a", TRUE, (a, 1e-5), ends_of(a, errors[0], t), 0.005).of(
        "b", TRUE, (b, 1e-5), ends_of(b, errors[1], t), 0.005)


@problem
def as_many_points_as_parameters():
    x = np.arange(2.0)
    return Problem(
        "as_many_points_as_parameters", "Two points and two parameters: the fit is exact, and no error can be estimated.",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
    ).data(x=x, y=np.array([1.1, 1.9])).of("a", [TRUE, "none"], (1.1, 1e-6), none=True).of(
        "b", [TRUE, "none"], (0.8, 1e-6), none=True).says("no degrees of freedom")


@problem
def one_point_fewer():
    x = np.arange(1, 3.0)
    return Problem(
        "one_point_fewer", "Two points and a parabola: along (2, -3, 1) nothing changes, so none of the three is determined.",
        static("a = 0, b = 1, c = 1", "a + b*x + c*x^2"),
        {"a": between(-10, 10), "b": between(-10, 10), "c": between(-10, 10)},
    ).data(x=x, y=np.array([1.1, 1.9])).of("a", [STRUCTURAL, PRACTICAL, "none"], none=True).of(
        "b", [STRUCTURAL, PRACTICAL, "none"], none=True).of("c", [STRUCTURAL, PRACTICAL, "none"], none=True).says(
        "points for 3 parameters|no degrees of freedom").never("saddle")


@problem
def many_digits():
    x = np.arange(1, 11.0)
    y = np.round(3 * x * (1 + noise(61, 10, 1e-9)), 11)
    (a,), (error,), t, _, _ = line([x], y)
    low, high = ends_of(a, error, t)
    p = Problem(
        "many_digits", "A slope known to 1e-9: the ends of the interval differ in the tenth digit and must be printed so.",
        static("a = 1", "a*x"), {"a": between(0, 10)},
    )
    p.files.append(("csv", "d.csv", "x,y\n" + "".join(f"{u:g},{v:.11f}\n" for u, v in zip(x, y))))
    return p.of("a", TRUE, (a, 1e-10), (low, high), 0.02).reads(
        r"(?m)^  a .* ([0-9.]+) \.\. [0-9.]+ ", low, 0.1 * (high - low)).reads(
        r"(?m)^  a .* [0-9.]+ \.\. ([0-9.]+) ", high, 0.1 * (high - low))


@problem
def large_offset():
    x = np.arange(12.0)
    y = np.round(1e6 + 0.01 * x + noise(62, 12, 0.001), 4)
    p = Problem(
        "large_offset", "A rise of 0.01 per step on a level of a million: slope and level have the intervals of the regression.",
        static("a = 1, b = 1", "a + b*x"), {"a": between(0, "1e7"), "b": between(-10, 10)},
    )
    p.files.append(("csv", "d.csv", "x,y\n" + "".join(f"{u:g},{v:.4f}\n" for u, v in zip(x, y))))
    (a, b), errors, t, _, _ = line([np.ones(12), x], y - 1e6)
    low, high = ends_of(a, errors[0], t)
    return p.of("b", TRUE, (b, 1e-6), ends_of(b, errors[1], t), 0.01).of(
        "a", TRUE, (1e6 + a, 1e-5)).reads(r"(?m)^  a .* ([0-9.e+]+) \.\. [0-9.e+]+ ", 1e6 + low, 0.1 * (high - low))


@problem
def tiny_units():
    x = np.arange(1, 11.0)
    y = 2e-12 * x * (1 + noise(63, 10, 0.02))
    y = np.array([float(f"{v:.4g}") for v in y])
    (a,), (error,), t, _, _ = line([x], y)
    return Problem(
        "tiny_units", "Currents of some pA: sums of squares of 1e-26 are not zero, and the fit is not exact.",
        static("a = 1e-12", "a*x"), {"a": between("1e-14", "1e-10")},
    ).data(x=x, y=y).of("a", TRUE, (a, 1e-4 * a), ends_of(a, error, t), 0.05).never("exact to the error", "not a minimum")


# Errors of the measurement


@problem
def autocorrelated():
    x = np.arange(60.0)
    e, out = noise(71, 60, 0.05), []
    for v in e:
        out.append((0.9 * out[-1] if out else 0) + v)
    y = np.round(1 + 0.05 * x + np.array(out), 4)
    return Problem(
        "autocorrelated", """Errors of which each is 0.9 of the last and something new: standard errors of independent
        errors are some three times too small, which must be said.""",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
    ).data(x=x, y=y).says("autocorrelat", "standard errors? (are|is)? ?.*too small|too small")


@problem
def growing_errors():
    x = np.arange(1, 61.0)
    y = np.round(1 + 0.5 * x + noise(72, 60, 1) * 0.01 * x**1.5, 4)
    return Problem(
        "growing_errors", "Errors that grow by a factor of several hundred along x: equal weights are wrong, which must be said.",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
    ).data(x=x, y=y).says("spread")


@problem
def one_outlier():
    x = np.arange(15.0)
    y = np.round(1 + 0.5 * x + noise(73, 15, 0.02), 3)
    y[7] += 1
    return Problem(
        "one_outlier", "The eighth row is 1 too large, fifty times the error of the others: it is named, and no other.",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
    ).data(x=x, y=y).says(r"row 8\b", "outlier").never(r"row (?:[1-7]|9|1[0-5])\b", r"rows ")


@problem
def clipped():
    x = np.arange(16.0)
    y = np.round(np.minimum(2 * np.exp(-0.08 * x) + noise(74, 16, 0.01), 1.5), 3)
    return Problem(
        "clipped", "An instrument that reads 1.5 at most: the first rows are equal, at the upper end. They are not outliers.",
        static("a = 1, b = 1", "a*exp(-b*x)"), {"a": between(0.1, 10), "b": between(0.01, 10)},
    ).data(x=x, y=y).says("satur|clip|censor|limit of the (?:instrument|sensor)|equal values").never("outlier")


@problem
def weighted():
    x = np.arange(10.0)
    s = np.round(0.01 + 0.02 * x, 3)
    y = np.round(1 + 0.5 * x + noise(75, 10, 1) * s, 4)
    (a, b), errors, t, chi, _ = line([np.ones(10), x], y, s)
    return Problem(
        "weighted", "Known errors of each row: the weighted regression, with normal quantiles.",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
        outputs='{ y = { column = "y", sigma = "s" } }',
    ).data(x=x, y=y, s=s).of("a", TRUE, (a, 1e-5), ends_of(a, errors[0], t), 0.005).of(
        "b", TRUE, (b, 1e-5), ends_of(b, errors[1], t), 0.005).reads(r"chi-square +([0-9.e+-]+)", chi, 1e-3 * chi)


@problem
def replicates():
    x = np.arange(6.0)
    y = np.round(1 + 0.5 * np.tile(x, 3) + noise(76, 18, 0.05), 3).reshape(3, 6)
    (a, b), errors, t, _, _ = line([np.ones(18), np.tile(x, 3)], y.ravel())
    return Problem(
        "replicates", "Three columns of one output: 18 points, 16 degrees of freedom.",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
        outputs='{ y = ["y1", "y2", "y3"] }',
    ).data(x=x, y1=y[0], y2=y[1], y3=y[2]).of("a", TRUE, (a, 1e-5), ends_of(a, errors[0], t), 0.005).of(
        "b", TRUE, (b, 1e-5), ends_of(b, errors[1], t), 0.005)


@problem
def same_column_twice():
    x = np.arange(10.0)
    y = np.round(1 + 0.5 * x + noise(77, 10, 0.05), 3)
    (a, b), errors, t, _, _ = line([np.ones(10), x], y)
    return Problem(
        "same_column_twice", "One column as two replicates: 10 points, not 20; the intervals do not shrink by the square root of two.",
        static("a = 0, b = 1", "a + b*x"), {"a": between(-10, 10), "b": between(-10, 10)},
        outputs='{ y = ["y", "z"] }',
    ).data(x=x, y=y, z=y).of("a", TRUE, (a, 1e-5), ends_of(a, errors[0], t), 0.02).of(
        "b", TRUE, (b, 1e-5), ends_of(b, errors[1], t), 0.02).says("same numbers")


@problem
def log_normal():
    x = np.arange(12.0)
    y = np.array([float(f"{v:.4g}") for v in 50 * np.exp(-0.3 * x + noise(78, 12, 0.1))])
    (la, nb), errors, t, rest, _ = line([np.ones(12), x], np.log(y))
    sigma = math.sqrt(rest / 12)
    minus = 12 * math.log(sigma) + 6 + 6 * math.log(2 * math.pi) + np.log(y).sum()
    low, high = (math.exp(end) for end in ends_of(la, errors[0], t))
    return Problem(
        "log_normal", """Log-normal errors of an unknown size: the regression of the logarithms. The likelihood is that of
        the data, with the term sum ln y.""",
        static("a = 10, b = 1", "a*exp(-b*x)"), {"a": between(1, 1000), "b": between(0.01, 5)},
        outputs='{ y = { column = "y", sigma = "estimate", error = "lognormal" } }',
    ).data(x=x, y=y).of("a", TRUE, (math.exp(la), 1e-2), (low, high), 0.08).of(
        "b", TRUE, (-nb, 1e-4), ends_of(-nb, errors[1], t), 0.08).reads(r"-log L +([-0-9.e+]+)", minus, 1e-3)


@problem
def prior_and_data():
    x = np.arange(1, 7.0)
    y = np.round(2 * x + noise(79, 6, 0.5), 3)
    (a,), (error,), t, _, _ = line([x], y, 0.5)
    precision = 1 / error**2 + 1 / 0.1**2
    mean, sd = (a / error**2 + 2.1 / 0.1**2) / precision, precision**-0.5
    return Problem(
        "prior_and_data", "A prior counts as one more point: the precisions add.",
        static("a = 1", "a*x"), {"a": "{ min = 0, max = 10, prior = { mean = 2.1, sd = 0.1 } }"},
        outputs='{ y = { column = "y", sigma = 0.5 } }',
    ).data(x=x, y=y).of("a", TRUE, (mean, 1e-4), ends_of(mean, sd, 1.959964), 0.01)


@problem
def prior_alone():
    x = np.arange(1, 7.0)
    y = np.round(2 * x + noise(80, 6, 0.5), 3)
    (a,), (error,), t, _, _ = line([x], y, 0.5)
    return Problem(
        "prior_alone", "Of d only the prior says something: its interval is that of the prior, and it must be said that the data say nothing.",
        static("a = 1, d = 1", "a*x"), {"a": between(0, 10), "d": "{ min = 0, max = 10, prior = { mean = 3, sd = 0.5 } }"},
        outputs='{ y = { column = "y", sigma = 0.5 } }',
    ).data(x=x, y=y).of("a", TRUE, (a, 1e-4), ends_of(a, error, t), 0.01).says(
        r"\bd\b[^.]*(?:no effect|comes (?:mainly |only )?from (?:the|its) prior|prior (?:alone|only|dominates|determines))").never(
        "single point", "from 0.5 to 0.5")


@problem
def two_experiments_that_disagree():
    x = np.arange(1, 9.0)
    y, z = np.round(1 * x + noise(81, 8, 0.02), 3), np.round(2 * x + noise(82, 8, 0.02), 3)
    (k,), _, _, chi, _ = line([np.tile(x, 2)], np.concatenate([y, z]), 0.02)
    p = Problem(
        "two_experiments_that_disagree", """Two experiments with k = 1 and k = 2 and a common k: no value describes both. The value between
        them fits neither, whatever its standard error.""",
        static("k = 1", "k*x"), {"k": between(0, 10)}, outputs='{ y = { column = "y", sigma = 0.02 } }',
        tail='\n[[experiment]]\ndata = "e.csv"\nx = { variable = "x", column = "x" }\noutputs = { y = { column = "y", sigma = 0.02 } }\n',
    ).data(x=x, y=y).data("e.csv", x=x, y=z)
    return p.of("k", [TRUE], (k, 1e-4)).reads(r"chi-square +([0-9.e+-]+)", chi, 1e-3 * chi).says(
        "times the given sigma", "does not describe")


@problem
def integer():
    x = np.arange(1, 9.0)
    p = Problem(
        "integer", "An Integer parameter has no derivative and no values between: it cannot be searched as a real number, which must be said.",
        "model M\n  parameter Integer n = 2;\n  input Real x;\n  output Real y = n*x;\nend M;", {"n": between(1, 10)},
    ).data(x=x, y=3 * x)
    return p.key("fails", True).says("Integer").never("not a minimum")


if __name__ == "__main__":
    for old in HERE.glob("*.md"):
        if old.name != "README.md":
            old.unlink()
    for build in problems:
        build().write()
