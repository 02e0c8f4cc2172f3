//! Diagrams of the guide: boxes and arrows.

use super::shipped::project;
use gapilib::internals::plot::{Anchor, Letters, Svg, Writing};

const INK: &str = "#222222";
const LINE: &str = "stroke=\"#444444\" stroke-width=\"1.4\"";
/// Fills of boxes: plain, of what the program does, of what is refused.
const PLAIN: &str = "#ffffff";
const BLUE: &str = "#d6e6f2";
const ORANGE: &str = "#f6dfcc";
const GREEN: &str = "#d5ebe2";

/// A picture under construction, 640 pixels wide.
struct Diagram(Svg);

/// The diagram of this name.
pub(crate) fn diagram(name: &str) -> Option<String> {
    Some(match name {
        "map" => map(),
        "scripts" => scripts(),
        "crossing" => crossing(),
        "survival" => survival(),
        "ranks" => ranks(),
        "islands" => islands(),
        "states" => states(),
        "permissions" => permissions(),
        "live_view" => {
            let file = "gapilib_cli__live__draw__tests__a_run_is_seen_at_one_glance.snap";
            terminal(&format!("src/cli/live/snapshots/{file}"), "The live view of a run")
        }
        "teach_screen" => terminal("tests/teach/screen_crossover.snap", "A step of gapi teach"),
        "teach_what_if" => terminal("tests/teach/screen_what_if.snap", "A run and a changed one"),
        _ => return None,
    })
}

fn writing(size: f64) -> Writing {
    Writing { size, bold: false, upright: false, colour: INK }
}

impl Diagram {
    fn new(height: f64, title: &str) -> Diagram {
        Diagram(Svg::new(640.0, height, title, Letters::Text))
    }

    /// A box with lines of text in its middle, the first one bold.
    fn field(&mut self, [x, y, width, height]: [f64; 4], fill: &str, lines: &[&str]) {
        self.0.rectangle([x, y, width, height], &format!("fill=\"{fill}\" {LINE} rx=\"5\""));
        let top = y + height / 2.0 - 8.0 * (lines.len() as f64 - 1.0) + 4.5;
        for (k, line) in lines.iter().enumerate() {
            let at = (x + width / 2.0, top + 16.0 * k as f64);
            self.0.text(at, Anchor::Middle, Writing { bold: k == 0, ..writing(12.5) }, line);
        }
    }

    /// An arrow, with words beside its middle.
    fn arrow(&mut self, from: (f64, f64), to: (f64, f64), words: &str) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy);
        let (ux, uy) = (dx / length, dy / length);
        let wing =
            |side: f64| (to.0 - 9.0 * ux - side * 4.5 * uy, to.1 - 9.0 * uy + side * 4.5 * ux);
        self.0.polyline(&[from, to], LINE);
        self.0.polyline(&[wing(1.0), to, wing(-1.0)], LINE);
        let middle = ((from.0 + to.0) / 2.0, (from.1 + to.1) / 2.0);
        let (at, anchor) = match dx.abs() > dy.abs() {
            true => ((middle.0, middle.1 - 6.0), Anchor::Middle),
            false => ((middle.0 + 7.0, middle.1 + 4.0), Anchor::Start),
        };
        self.0.text(at, anchor, writing(11.5), words);
    }

    fn words(&mut self, at: (f64, f64), words: &str) {
        self.0.text(at, Anchor::Start, writing(12.5), words);
    }

    fn finish(self) -> String {
        self.0.finish()
    }
}

/// A screen of the terminal, as the snapshot of a test has it.
fn terminal(file: &str, title: &str) -> String {
    const CHARACTER: [f64; 2] = [7.8, 16.0];
    let text = std::fs::read_to_string(project(file)).expect("a snapshot");
    let (_, screen) = text.split_once("\n---\n").expect("a head");
    let lines: Vec<&str> = screen.lines().map(|line| line.trim_matches('"')).collect();
    let columns = lines.iter().map(|line| line.chars().count()).max().unwrap_or_default();
    let width = CHARACTER[0] * columns as f64;
    let height = CHARACTER[1] * lines.len() as f64;
    let mut svg = Svg::new(width + 16.0, height + 16.0, title, Letters::Text);
    let mut widths = Vec::new();
    for (k, line) in lines.iter().enumerate() {
        let mut column = 0;
        for word in line.split(' ') {
            let length = word.chars().count();
            if length > 0 {
                let at = (8.0 + CHARACTER[0] * column as f64, 20.0 + CHARACTER[1] * k as f64);
                svg.text(at, Anchor::Start, writing(13.0), word);
                widths.push(CHARACTER[0] * length as f64);
            }
            column += length + 1;
        }
    }
    // Each word has its place and its width, whatever face the viewer has.
    let drawn = svg.finish();
    let (head, words) = drawn.split_once("<text ").expect("words");
    let of_width = |(word, width): (&str, &f64)| {
        format!("<text textLength=\"{width:.1}\" lengthAdjust=\"spacingAndGlyphs\" {word}")
    };
    let words: String = words.split("<text ").zip(&widths).map(of_width).collect();
    format!("{head}{words}").replacen(
        "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif",
        "'DejaVu Sans Mono', 'Liberation Mono', monospace",
        1,
    )
}

/// What goes into the program and what comes out.
fn map() -> String {
    let mut own = Diagram::new(220.0, "From model and data to values with intervals and a verdict");
    let inputs: [[&str; 2]; 3] = [
        ["model", "Modelica, .mo or .fmu"],
        ["measured data", ".csv, .mat, .xlsx"],
        ["problem or script", ".toml or .mos"],
    ];
    for (k, lines) in inputs.iter().enumerate() {
        let y = 10.0 + 70.0 * k as f64;
        own.field([10.0, y, 180.0, 56.0], PLAIN, lines);
        own.arrow((190.0, y + 28.0), (250.0, 108.0), "");
    }
    own.field([250.0, 72.0, 120.0, 72.0], BLUE, &["gapi", "simulates", "and searches"]);
    let outputs: [[&str; 2]; 3] = [
        ["values", "with 95 % intervals"],
        ["verdict", "what the data determine"],
        ["report, figures, model", "in the folder results"],
    ];
    for (k, lines) in outputs.iter().enumerate() {
        let y = 10.0 + 70.0 * k as f64;
        own.arrow((370.0, 108.0), (440.0, y + 28.0), "");
        own.field([440.0, y, 190.0, 56.0], GREEN, lines);
    }
    own.finish()
}

/// Which script calls which, and what passes between them.
fn scripts() -> String {
    let mut own = Diagram::new(250.0, "The four scripts and the variables that pass between them");
    own.field([20.0, 95.0, 130.0, 50.0], PLAIN, &["GAPILib.mos", "main script"]);
    own.field([240.0, 20.0, 170.0, 50.0], BLUE, &["GAPILib_INI.mos", "the one to edit"]);
    own.field([240.0, 165.0, 170.0, 50.0], PLAIN, &["GAPILib_CYCLE.mos", "the generations"]);
    own.field([480.0, 165.0, 150.0, 50.0], PLAIN, &["..._SIM_SISO.mos", "simulation"]);
    own.arrow((150.0, 110.0), (240.0, 50.0), "");
    own.words((150.0, 70.0), "1 runs");
    own.arrow((150.0, 130.0), (240.0, 185.0), "");
    own.words((150.0, 175.0), "2 runs");
    own.arrow((410.0, 180.0), (480.0, 180.0), "");
    own.arrow((480.0, 204.0), (410.0, 204.0), "");
    own.words((395.0, 156.0), "New_Generation");
    own.words((418.0, 232.0), "Eval_Mod");
    own.arrow((325.0, 70.0), (325.0, 165.0), "settings, Xexp, Yexp, New_Generation");
    own.finish()
}

/// Two parents, a crossing point, their children, and a mutated gene.
fn crossing() -> String {
    let mut own = Diagram::new(250.0, "Two parents exchange the genes after the crossing point");
    let rows: [(&str, [(&str, &str); 2]); 4] = [
        ("parent 1", [("9.895", BLUE), ("3.163", BLUE)]),
        ("parent 2", [("6.905", ORANGE), ("3.867", ORANGE)]),
        ("child 1", [("9.895", BLUE), ("3.867", ORANGE)]),
        ("child 2, one gene mutated", [("6.905", ORANGE), ("7.412", GREEN)]),
    ];
    own.words((255.0, 18.0), "V0");
    own.words((415.0, 18.0), "tau");
    for (k, (name, genes)) in rows.into_iter().enumerate() {
        let y = 28.0 + 46.0 * k as f64 + if k > 1 { 24.0 } else { 0.0 };
        own.words((10.0, y + 22.0), name);
        for (j, (value, fill)) in genes.into_iter().enumerate() {
            own.field([190.0 + 160.0 * j as f64, y, 150.0, 36.0], fill, &[value]);
        }
    }
    own.0.polyline(&[(345.0, 22.0), (345.0, 246.0)], &format!("{LINE} stroke-dasharray=\"6 4\""));
    own.words((352.0, 128.0), "crossing point");
    own.finish()
}

/// Which of four old individuals and their offspring stay, as `survivors.mos` prints it.
fn survival() -> String {
    let mut own = Diagram::new(240.0, "Which individuals of two generations survive");
    let all = [
        ("1", 5.0),
        ("2", 1.0),
        ("3", 4.0),
        ("4", 3.0),
        ("1.1", 2.0),
        ("2.1", 6.0),
        ("3.1", 0.5),
        ("4.1", 7.0),
    ];
    let kept: [(&str, [&str; 4]); 4] = [
        ("elitism", ["3.1", "2", "1.1", "2.1"]),
        ("generational", ["1.1", "2.1", "3.1", "4.1"]),
        ("mu_plus_lambda", ["3.1", "2", "1.1", "4"]),
        ("crowding", ["1.1", "2", "3.1", "4"]),
    ];
    own.words((10.0, 22.0), "individual");
    own.words((10.0, 44.0), "fitness");
    for (k, (name, fitness)) in all.into_iter().enumerate() {
        let x = 170.0 + 58.0 * k as f64;
        own.words((x + 8.0, 22.0), name);
        own.words((x + 8.0, 44.0), &fitness.to_string());
        for (row, (_, survivors)) in kept.iter().enumerate() {
            let fill = if survivors.contains(&name) { BLUE } else { PLAIN };
            own.field([x, 58.0 + 44.0 * row as f64, 44.0, 32.0], fill, &[]);
        }
    }
    for (row, (name, _)) in kept.iter().enumerate() {
        own.words((10.0, 78.0 + 44.0 * row as f64), name);
    }
    own.finish()
}

/// What rank 0 and the others send each other.
fn ranks() -> String {
    let mut own = Diagram::new(230.0, "Rank 0 distributes the individuals of a generation");
    own.field([20.0, 80.0, 180.0, 70.0], BLUE, &["rank 0", "script, optimizer,", "all files"]);
    for (k, name) in ["rank 1", "rank 2", "rank 3"].into_iter().enumerate() {
        let y = 15.0 + 75.0 * k as f64;
        own.field([450.0, y, 160.0, 50.0], PLAIN, &[name, "simulates"]);
        own.arrow((200.0, 105.0), (450.0, y + 17.0), "");
        own.arrow((450.0, y + 33.0), (200.0, 125.0), "");
    }
    own.words((215.0, 20.0), "once: the compiled model");
    own.words((215.0, 38.0), "then: chunks of individuals");
    own.words((215.0, 200.0), "back: simulated points");
    own.finish()
}

/// Four populations in a ring.
fn islands() -> String {
    let mut own = Diagram::new(210.0, "Four islands send their best individuals round a ring");
    let places = [(80.0, 15.0), (400.0, 15.0), (400.0, 135.0), (80.0, 135.0)];
    for (k, (x, y)) in places.into_iter().enumerate() {
        let name = format!("island {}", k + 1);
        own.field([x, y, 160.0, 56.0], BLUE, &[&name, "20 individuals"]);
    }
    own.arrow((240.0, 43.0), (400.0, 43.0), "best individuals");
    own.arrow((480.0, 71.0), (480.0, 135.0), "every 10 generations");
    own.arrow((400.0, 163.0), (240.0, 163.0), "");
    own.arrow((160.0, 135.0), (160.0, 71.0), "");
    own.finish()
}

/// The states of the batch and their transitions.
fn states() -> String {
    let mut own = Diagram::new(155.0, "States and transitions of the batch");
    own.0.circle((25.0, 45.0), 6.0, "fill=\"#222222\"");
    own.arrow((31.0, 45.0), (70.0, 45.0), "");
    own.field([70.0, 18.0, 120.0, 54.0], BLUE, &["fill", "rate = 0.5"]);
    own.field([300.0, 18.0, 120.0, 54.0], BLUE, &["rest", "rate = 0"]);
    own.field([510.0, 18.0, 120.0, 54.0], BLUE, &["drain", "rate = -0.25"]);
    own.arrow((190.0, 45.0), (300.0, 45.0), "measured >= 2");
    own.arrow((420.0, 45.0), (510.0, 45.0), "after 5 s");
    own.0.polyline(&[(570.0, 72.0), (570.0, 140.0), (130.0, 140.0)], LINE);
    own.arrow((130.0, 140.0), (130.0, 72.0), "");
    own.words((300.0, 132.0), "measured <= 0.5");
    own.finish()
}

/// Which folders may be read and written.
fn permissions() -> String {
    let mut own = Diagram::new(250.0, "What scripts and models may read and write by default");
    let rows: [(f64, &str, &str, &str); 7] = [
        (0.0, "study/", GREEN, "read; new files and folders of the kinds that scripts write"),
        (1.0, "fit.mos, Cell.mo, cell.csv", GREEN, "read"),
        (1.0, "models/", GREEN, "read"),
        (1.0, "results/fit/", ORANGE, "the output folder: read, written, replaced, removed"),
        (0.0, "libraries: --library, MODELICAPATH", GREEN, "read"),
        (0.0, "everything else", PLAIN, "not read, not written"),
        (0.0, "/proc, /sys, /dev", PLAIN, "never, unless the command line names one"),
    ];
    for (k, (depth, name, fill, words)) in rows.into_iter().enumerate() {
        let (x, y) = (10.0 + 24.0 * depth, 8.0 + 34.0 * k as f64);
        own.field([x, y, 240.0, 26.0], fill, &[name]);
        own.words((x.max(34.0) + 250.0, y + 18.0), words);
    }
    own.finish()
}
