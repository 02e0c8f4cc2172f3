//! Codes of the genetic algorithm.

use crate::codes;

codes! {
    /// A seed that the generator cannot start from.
    BAD_SEED = "bad-seed":
        "## What it means\n\nThe generator behind `Ram_Gen_ARENA` starts from six whole numbers. The first three lie in 0..4294967086 and are not all zero, the last three lie in 0..4294944442 and are not all zero. The message names the entry that breaks this.\n\n## Example\n\n`Ram_Gen_ARENA([12345, 12345, 12345, 12345, 12345, -1], 10)`\n\n## What to do\n\nCorrect that entry; {12345, 12345, 12345, 12345, 12345, 12345} is the usual seed. To go on where a call stopped, pass its second output `Seed_Next`.",
    /// Numbers of parents, elites and individuals that do not fit together.
    BAD_POPULATION = "bad-population":
        "## What it means\n\nA generation consists of `N_Elitism` elites, `N_Parents` children and random individuals that fill it up to `N_Population`. The numbers given do not allow that.\n\n## Example\n\n`N_Population = 100; N_Parents = 100; N_Elitism = 1;`\n\n## What to do\n\nMake `N_Parents + N_Elitism` at most `N_Population`, with at least one parent; the paper uses 100, 70 and 1.",
    /// A mutation factor that is no probability.
    BAD_MUTATION_FACTOR = "bad-mutation-factor":
        "## What it means\n\n`F_Mut` is the probability that a gene is replaced by a random value, so it lies between 0 and 1.\n\n## Example\n\n`F_Mut = 25;`\n\n## What to do\n\nUse a number from 0 to 1, such as 0.25.",
    /// A search range that is empty or not finite.
    BAD_RANGE = "bad-range":
        "## What it means\n\nThe search range of an identified parameter is empty (its minimum is above its maximum), is not a pair of finite numbers, or reaches outside the `min` and `max` that the model declares for the parameter.\n\n## Example\n\n`Param_Min = {0.1}; Param_Max = {0.01};`\n\n## What to do\n\nCorrect the range; for limits of the model itself, change `min` and `max` there if they are too narrow.",
    /// A crossing point outside the genome.
    BAD_CROSS_POINT = "bad-cross-point":
        "## What it means\n\nCrossover exchanges the genes behind each crossing point, so a crossing point lies from 1 to the number of genes less one (0 and the number of genes itself are accepted; they exchange all or nothing).\n\n## Example\n\n`Cross(70, 1, Pop, {9})` for genomes of 6 genes.\n\n## What to do\n\nDraw the crossing points between 1 and `N_Parameters - 1`.",
    /// A user's operator whose outputs are no genes.
    BAD_OPERATOR = "bad-operator":
        "## What it means\n\nA function of yours takes the place of an operator of the genetic algorithm. It has other inputs or outputs than that kind of operator, or it failed, or it returned what cannot be used: a gene that is NaN, or probabilities that are all zero.\n\n## Example\n\n`crossover = \"mean\"` with a function that returns one child.\n\n## What to do\n\nGive the function the inputs and outputs that the message names, and return a number for every gene. `gapi help --operators` shows the declarations.",
    /// Arguments of a genetic operator whose sizes do not fit together.
    SIZE_MISMATCH = "population-size-mismatch":
        "## What it means\n\nTwo arrays that describe the same individuals, genes or points have different sizes.\n\n## Example\n\nA population of 6 genes with search ranges for 5.\n\n## What to do\n\nMake the sizes agree; the message names both arrays with their sizes.",
}
