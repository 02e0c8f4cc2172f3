//! A picture of one generation and the one it becomes, as SVG: each row is an individual, each
//! column a gene, lines lead from parents to children.

use super::generation::{Generation, Origin};
use super::trace::Trace;
use crate::plot::{Anchor, Letters, Svg, Writing};

const WIDTH: usize = 640;
/// Where the two populations stand, and how wide they are.
const LEFT: usize = 60;
const RIGHT: usize = 400;
const BLOCK: usize = 180;
const TOP: usize = 44;
/// No more individuals than this are drawn.
const MOST: usize = 150;
/// From blue to yellow with rising lightness: readable without colour vision and in grey print.
const SHADES: [[u8; 3]; 7] = [
    [0, 34, 78],
    [43, 68, 111],
    [88, 95, 109],
    [124, 123, 120],
    [166, 157, 117],
    [211, 193, 100],
    [254, 232, 56],
];

/// Generation `number`, from 0, best first, and beside it the next one, if there is one.
pub fn picture(trace: &Trace, number: usize) -> String {
    let generation = &trace.generations[number];
    let next = trace.generations.get(number + 1);
    let order: Vec<usize> = match generation.fitness.is_empty() {
        true => (0..generation.len()).collect(),
        false => generation.order(),
    };
    let order = &order[..order.len().min(MOST)];
    let rows = order.len().max(next.map_or(0, |next| next.len().min(MOST)));
    let high = (420 / rows.max(1)).clamp(6, 24);
    let height = TOP + rows * high + 12;
    let title = format!("Generation {}", number + 1);
    let mut svg = Svg::new(WIDTH as f64, height as f64, &title, Letters::Text);
    let ranges = ranges(generation, next);
    heading(&mut svg, trace, LEFT, &format!("generation {}, best first", number + 1));
    if let Some(next) = next {
        heading(&mut svg, trace, RIGHT, &format!("generation {}", number + 2));
        lines(&mut svg, order, next, high);
        for k in 0..next.len().min(MOST) {
            individual(&mut svg, next, k, &ranges, (RIGHT, TOP + k * high, high));
        }
    }
    for (row, &k) in order.iter().enumerate() {
        individual(&mut svg, generation, k, &ranges, (LEFT, TOP + row * high, high));
    }
    svg.finish()
}

/// Writing from left to right.
fn writing(size: usize, colour: &'static str) -> Writing {
    Writing { size: size as f64, bold: false, upright: false, colour }
}

/// A place of the picture.
fn place(x: usize, y: usize) -> (f64, f64) {
    (x as f64, y as f64)
}

/// The least and the greatest of each gene in both generations.
fn ranges(generation: &Generation, next: Option<&Generation>) -> Vec<(f64, f64)> {
    let both = || [Some(generation), next].into_iter().flatten();
    let column =
        |j: usize| both().flat_map(move |g| g.genes.iter().skip(j).step_by(g.n_genes.max(1)));
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let range = |j| column(j).fold(ends, |(low, high), &gene| (low.min(gene), high.max(gene)));
    (0..generation.n_genes).map(range).collect()
}

fn heading(svg: &mut Svg, trace: &Trace, x: usize, title: &str) {
    let names = &trace.subject.parameters;
    let bold = Writing { bold: true, ..writing(12, "#000000") };
    svg.text(place(x, 16), Anchor::Start, bold, title);
    for (j, name) in names.iter().enumerate() {
        let x = x + (2 * j + 1) * BLOCK / (2 * names.len());
        svg.text(place(x, 36), Anchor::Middle, writing(12, "#000000"), name);
    }
}

/// From each parent to its children: solid from the one before the crossing point, dashed from the
/// other; black from an elite to its copy.
fn lines(svg: &mut Svg, order: &[usize], next: &Generation, high: usize) {
    let middle = |row: usize| TOP + row * high + high / 2;
    for (row, origin) in next.origins.iter().enumerate().take(MOST) {
        let (from, styles) = match origin {
            Origin::Elite { from } => (vec![*from], [("#000000", "none"); 2]),
            Origin::Child { parent, mate, .. } if mate == parent => {
                (vec![*parent], [("#0b5cad", "none"); 2])
            }
            Origin::Child { parent, mate, .. } => {
                (vec![*parent, *mate], [("#0b5cad", "none"), ("#b35900", "5 3")])
            }
            Origin::Random | Origin::Script => continue,
        };
        for (k, (colour, dashes)) in from.into_iter().zip(styles) {
            let Some(before) = order.iter().position(|&at| at == k) else { continue };
            let ends = [place(LEFT + BLOCK + 4, middle(before)), place(RIGHT - 40, middle(row))];
            svg.polyline(&ends, &format!("stroke=\"{colour}\" stroke-dasharray=\"{dashes}\""));
        }
    }
}

/// One row: its number and mark, and a box for each gene.
fn individual(
    svg: &mut Svg,
    generation: &Generation,
    k: usize,
    ranges: &[(f64, f64)],
    (x, y, high): (usize, usize, usize),
) {
    let wide = BLOCK / generation.n_genes.max(1);
    let origin = generation.origins.get(k);
    let failed = generation.failure(k).is_some();
    let (mark, ink) = match origin {
        _ if failed => ("\u{2715}", "#b00020"),
        Some(Origin::Elite { .. }) => ("\u{265b}", "#000000"),
        Some(Origin::Random) => ("?", "#000000"),
        _ => ("", "#000000"),
    };
    let number = format!("{mark} {}", k + 1);
    let writing = writing(high.min(12), ink);
    svg.text(place(x - 6, y + high * 3 / 4), Anchor::End, writing, &number);
    for (j, (gene, (low, top))) in generation.genome(k).iter().zip(ranges).enumerate() {
        let part = if top > low { (gene - low) / (top - low) } else { 0.5 };
        let x = x + j * wide;
        let [r, g, b] = shade(part);
        let sizes = [x, y, wide.saturating_sub(1), high - 1].map(|length| length as f64);
        svg.rectangle(sizes, &format!("fill=\"rgb({r},{g},{b})\""));
        if matches!(origin, Some(Origin::Child { mutated, .. }) if mutated.contains(&j)) {
            let radius = (high / 3).min(4) as f64;
            let middle = place(x + wide / 2, y + high / 2);
            svg.circle(middle, radius, "fill=\"#ffffff\" stroke=\"#000000\"");
        }
    }
}

/// The shade of a place between 0 and 1.
fn shade(part: f64) -> [u8; 3] {
    let place = part.clamp(0.0, 1.0) * (SHADES.len() - 1) as f64;
    SHADES[(place.round() as usize).min(SHADES.len() - 1)]
}

#[cfg(test)]
mod tests {
    use crate::teach::sample;

    #[test]
    fn two_generations_and_their_lines() {
        let svg = super::picture(sample::walk().trace(), 0);
        let count = |part: &str| svg.matches(part).count();
        // Two genes of six individuals twice, and the paper; an elite and two parents of four.
        assert_eq!(count("<rect"), 2 * 6 * 2 + 1);
        assert_eq!(count("<polyline"), 1 + 2 * 4);
        assert_eq!(count("<circle"), 3);
        assert_eq!((count("\u{265b}"), count("generation 2")), (1, 1));
        // The last generation stands alone.
        assert_eq!(super::picture(sample::walk().trace(), 2).matches("<polyline").count(), 0);
    }
}
