//! Repetitions of a run with other random numbers: the seed that its scripts begin with is replaced.

use crate::Session;
use crate::diag::Fault;
use crate::ga::Mrg32k3a;

/// Which random numbers the scripts get.
#[derive(Default)]
struct Reseeding {
    /// The stream of the generator; 0 for that of the scripts' own seed.
    stream: u64,
    /// The seed that the scripts began with.
    first: Option<[f64; 6]>,
}

impl Session {
    /// From here on the scripts get random numbers of another stream of the generator (0: their own)
    /// wherever they begin with their first seed, also where they begin with it again.
    pub fn use_stream(&mut self, stream: u64) {
        *self.extension::<Reseeding>() = Reseeding { stream, first: None };
    }

    /// The generator for a seed that a script gives.
    ///
    /// # Errors
    ///
    /// It is not a seed.
    pub(crate) fn generator(&mut self, seed: &[f64]) -> Result<Mrg32k3a, Fault> {
        let rng = Mrg32k3a::new(seed)?;
        let reseeding = self.extension::<Reseeding>();
        let is_first = *reseeding.first.get_or_insert(rng.state()) == rng.state();
        match reseeding.stream {
            stream if stream > 0 && is_first => Ok(rng.stream(stream)),
            _ => Ok(rng),
        }
    }
}
