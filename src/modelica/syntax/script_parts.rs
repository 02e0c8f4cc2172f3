//! Long scripts: all of a script is read before its first statement is executed, but no more than a
//! part of it is kept as a tree, which takes forty times as much memory as the text.

use super::lower;
use super::parser::{Nodes, Pieces, Rule};
use super::scan::Dialect;
use crate::diag::Diagnostic;
use crate::source::SourceId;
use crate::syntax::ast::InteractiveStatement;
use std::ops::Range;
use std::sync::Arc;

/// Pieces of a part: some for processors to share, and the trees of some 25,000 short statements,
/// which take 15 MB.
const PIECES: usize = 4;

/// A script that can be read, part by part.
#[derive(Debug)]
pub struct ScriptParts {
    pieces: Pieces,
    /// The first part, which is all of most scripts.
    first: Arc<[InteractiveStatement]>,
}

impl ScriptParts {
    /// Reads a `.mos` file; also what `look` finds in its statements, in their order.
    ///
    /// ```
    /// use gapilib_base::source::SourceId;
    /// use gapilib_modelica::syntax::ScriptParts;
    ///
    /// let text = "a = 1;\n".repeat(200_000);
    /// let (script, _) = ScriptParts::read(SourceId::NONE, &text, |_| Vec::<()>::new())?;
    /// let statements = (0..script.count()).map(|at| Ok(script.part(at)?.len()));
    /// assert_eq!(statements.sum::<Result<usize, _>>()?, 200_000);
    /// # Ok::<(), gapilib_base::diag::Diagnostic>(())
    /// ```
    ///
    /// # Errors
    /// The first syntax error of the text.
    pub fn read<T: Send>(
        source: SourceId,
        text: &str,
        look: impl Fn(&[InteractiveStatement]) -> Vec<T> + Sync,
    ) -> Result<(ScriptParts, Vec<T>), Diagnostic> {
        let lower = |at, nodes: Nodes<'_>| {
            let statements = lower::script(nodes)?.statements;
            let found = look(&statements);
            Ok((if at < PIECES { statements } else { Vec::new() }, found))
        };
        let (pieces, read) = Pieces::read(source, text, Rule::script, Dialect::Script, lower)?;
        let (first, found): (Vec<_>, Vec<_>) = read.into_iter().unzip();
        let first = first.into_iter().flatten().collect();
        Ok((ScriptParts { pieces, first }, found.into_iter().flatten().collect()))
    }

    /// How many parts there are; at least one.
    pub fn count(&self) -> usize {
        self.pieces.count().div_ceil(PIECES)
    }

    /// The statements of a part, read again if it is not the first.
    ///
    /// # Errors
    /// None: the text was read before. They are passed on all the same.
    pub fn part(&self, at: usize) -> Result<Arc<[InteractiveStatement]>, Diagnostic> {
        if at == 0 {
            return Ok(self.first.clone());
        }
        let lower = |_, nodes: Nodes<'_>| Ok(lower::script(nodes)?.statements);
        let read = self.pieces.lowered(self.pieces_of(at), lower)?;
        Ok(read.into_iter().flatten().collect())
    }

    fn pieces_of(&self, at: usize) -> Range<usize> {
        let count = self.pieces.count();
        (PIECES * at).min(count)..(PIECES * (at + 1)).min(count)
    }
}
