//! A picture of one generation and the one it becomes, as SVG: each row is an individual, each
//! column a gene, lines lead from parents to children.

use super::generation::{Generation, Origin};
use super::trace::Trace;
use std::fmt::Write as _;

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
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
         width=\"{WIDTH}\" height=\"{height}\" role=\"img\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<title>Generation {}</title>\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        number + 1
    );
    let ranges = ranges(generation, next);
    heading(&mut svg, trace, LEFT, &format!("generation {}, best first", number + 1));
    if let Some(next) = next {
        heading(&mut svg, trace, RIGHT, &format!("generation {}", number + 2));
        lines(&mut svg, order, next, high);
        for k in 0..next.len().min(MOST) {
            individual(&mut svg, next, k, &ranges, (RIGHT, TOP + k * high, high));
        }
    }
    for (place, &k) in order.iter().enumerate() {
        individual(&mut svg, generation, k, &ranges, (LEFT, TOP + place * high, high));
    }
    svg.push_str("</svg>\n");
    svg
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

fn heading(svg: &mut String, trace: &Trace, x: usize, title: &str) {
    let names = &trace.subject.parameters;
    let _ = writeln!(svg, "<text x=\"{x}\" y=\"16\" font-weight=\"bold\">{title}</text>");
    for (j, name) in names.iter().enumerate() {
        let x = x + (2 * j + 1) * BLOCK / (2 * names.len());
        let name = name.replace('&', "&amp;").replace('<', "&lt;");
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"36\" text-anchor=\"middle\">{name}</text>");
    }
}

/// From each parent to its children: solid from the one before the crossing point, dashed from the
/// other; black from an elite to its copy.
fn lines(svg: &mut String, order: &[usize], next: &Generation, high: usize) {
    let middle = |row: usize| TOP + row * high + high / 2;
    for (row, origin) in next.origins.iter().enumerate().take(MOST) {
        let (from, styles) = match origin {
            Origin::Elite { from } => (vec![*from], [("#000000", "none"); 2]),
            Origin::Child { parent, mate, .. } => {
                (vec![*parent, *mate], [("#0b5cad", "none"), ("#b35900", "5 3")])
            }
            Origin::Random | Origin::Script => continue,
        };
        for (k, (colour, dashes)) in from.into_iter().zip(styles) {
            let Some(place) = order.iter().position(|&at| at == k) else { continue };
            let _ = writeln!(
                svg,
                "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{colour}\" \
                 stroke-dasharray=\"{dashes}\"/>",
                LEFT + BLOCK + 4,
                middle(place),
                RIGHT - 40,
                middle(row)
            );
        }
    }
}

/// One row: its number and mark, and a box for each gene.
fn individual(
    svg: &mut String,
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
    let size = high.min(12);
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\" font-size=\"{size}\" fill=\"{ink}\">{mark} \
         {}</text>",
        x - 6,
        y + high * 3 / 4,
        k + 1
    );
    for (j, (gene, (low, top))) in generation.genome(k).iter().zip(ranges).enumerate() {
        let part = if top > low { (gene - low) / (top - low) } else { 0.5 };
        let (x, tall) = (x + j * wide, high - 1);
        let [r, g, b] = shade(part);
        let _ = writeln!(
            svg,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{}\" height=\"{tall}\" fill=\"rgb({r},{g},{b})\"/>",
            wide - 1
        );
        if matches!(origin, Some(Origin::Child { mutated, .. }) if mutated.contains(&j)) {
            let _ = writeln!(
                svg,
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"#ffffff\" stroke=\"#000000\"/>",
                x + wide / 2,
                y + high / 2,
                (high / 3).min(4)
            );
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
        assert_eq!(count("<line"), 1 + 2 * 4);
        assert_eq!(count("<circle"), 3);
        assert_eq!((count("\u{265b}"), count("generation 2")), (1, 1));
        // The last generation stands alone.
        assert_eq!(super::picture(sample::walk().trace(), 2).matches("<line").count(), 0);
    }
}
