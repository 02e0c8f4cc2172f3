//! Codes of the genetic algorithm.

use crate::codes;

codes! {
    /// A seed that the generator cannot start from.
    BAD_SEED = "bad-seed":
        "## What it means\n\nThe seed of `Ram_Gen_ARENA` consists of six whole numbers. The first three must be in 0..4294967086 and not all zero, the last three in 0..4294944442 and not all zero. The message names the invalid entry.\n\n## Example\n\n`Ram_Gen_ARENA([12345, 12345, 12345, 12345, 12345, -1], 10)`\n\n## What to do\n\nCorrect that entry; {12345, 12345, 12345, 12345, 12345, 12345} is the usual seed. To continue the sequence of a call, pass its second output `Seed_Next`.",
    /// Numbers of parents, elites and individuals that do not fit together.
    BAD_POPULATION = "bad-population":
        "## What it means\n\nA generation consists of `N_Elitism` elites, `N_Parents` children and random individuals up to `N_Population`. The given numbers do not allow that.\n\n## Example\n\n`N_Population = 100; N_Parents = 100; N_Elitism = 1;`\n\n## What to do\n\nMake `N_Parents + N_Elitism` at most `N_Population`, with at least one parent; the paper uses 100, 70 and 1.",
    /// A mutation factor that is not a probability.
    BAD_MUTATION_FACTOR = "bad-mutation-factor":
        "## What it means\n\n`F_Mut` is the probability that a gene is replaced by a random value, so it must be between 0 and 1.\n\n## Example\n\n`F_Mut = 25;`\n\n## What to do\n\nUse a number from 0 to 1, such as 0.25.",
    /// A search range that is empty or not finite.
    BAD_RANGE = "bad-range":
        "## What it means\n\nThe search range of an estimated parameter is empty (its minimum is above its maximum), is not a pair of finite numbers, or exceeds the `min` and `max` that the model declares for the parameter.\n\n## Example\n\n`Param_Min = {0.1}; Param_Max = {0.01};`\n\n## What to do\n\nCorrect the range, or change `min` and `max` in the model if they are too narrow.",
    /// A crossing point outside the genome.
    BAD_CROSS_POINT = "bad-cross-point":
        "## What it means\n\nCrossover exchanges the genes after each crossing point, so a crossing point must be between 1 and the number of genes minus one (0 and the number of genes are also accepted; they exchange all genes or none).\n\n## Example\n\n`Cross(70, 1, Pop, {9})` for genomes of 6 genes.\n\n## What to do\n\nChoose crossing points between 1 and `N_Parameters - 1`.",
    /// A user's operator whose outputs are not genes.
    BAD_OPERATOR = "bad-operator":
        "## What it means\n\nYour function replaces an operator of the genetic algorithm. Its inputs or outputs do not match that kind of operator, or it failed, or it returned unusable values: a gene that is NaN, or probabilities that are all zero.\n\n## Example\n\n`crossover = \"mean\"` with a function that returns one child.\n\n## What to do\n\nDeclare the inputs and outputs that the message lists, and return a number for every gene. `gapi help --operators` shows the declarations.",
    /// Arguments of a genetic operator whose sizes do not fit together.
    SIZE_MISMATCH = "population-size-mismatch":
        "## What it means\n\nTwo arrays that describe the same individuals, genes or points have different sizes.\n\n## Example\n\nA population of 6 genes with search ranges for 5.\n\n## What to do\n\nUse matching sizes; the message names both arrays with their sizes.",
}
