//! A trace of the run for learners, written while scripts run.

use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::identify::Study;
use crate::source::Span;
use crate::teach::{ScriptLine, Subject, Tracer};
use std::path::{Path, PathBuf};

/// A trace that has as many bytes unwritten is written.
const PIECE: usize = 1 << 14;

/// Where the trace goes, and who writes it.
#[derive(Default)]
pub(super) struct Tracing {
    active: Option<(PathBuf, Tracer)>,
}

impl Session {
    /// Records the calls of the paper's functions from here on in a file, which is rewritten. The
    /// host that requests the trace has permitted the file (`permit_file` of the session's world): scripts
    /// do not.
    ///
    /// # Errors
    ///
    /// `file-error` when it cannot be written.
    pub fn trace_to(&mut self, path: &Path) -> Result<(), Fault> {
        let path = self.world.absolute(path);
        self.world.write_safely(&path, &[])?;
        self.extension::<Tracing>().active = Some((path, Tracer::default()));
        self.at_end(write_rest);
        Ok(())
    }

    /// Whether there is a tracer that records calls of operators by name.
    pub(crate) fn traces_operations(&mut self) -> bool {
        let active = &self.extension::<Tracing>().active;
        active.as_ref().is_some_and(|(_, tracer)| tracer.takes_operations())
    }

    /// Tells the tracer, if there is one, what the call at hand has done.
    pub(crate) fn traced(
        &mut self,
        record: impl FnOnce(&mut Tracer, ScriptLine),
    ) -> Result<(), Fault> {
        let Some((path, mut tracer)) = self.extension::<Tracing>().active.take() else {
            return Ok(());
        };
        let place = self.place_of_call(&mut tracer);
        record(&mut tracer, place);
        let written = match tracer.unwritten() {
            size if size >= PIECE => self.world.append_file(&path, &tracer.take_bytes()),
            _ => Ok(()),
        };
        // A trace that cannot be written ends, and says so once.
        if written.is_ok() {
            self.extension::<Tracing>().active = Some((path, tracer));
        }
        written
    }

    fn place_of_call(&self, tracer: &mut Tracer) -> ScriptLine {
        let span = self.call_site();
        match (self.sources.get(span.source), self.sources.line_column(span)) {
            (Some(source), Some(at)) => {
                tracer.place(Path::new(&*source.name), &source.text, at.line)
            }
            _ => ScriptLine::default(),
        }
    }
}

/// What is identified, as a trace tells it.
pub(super) fn subject(study: &Study) -> Subject {
    Subject {
        model: study.model.clone(),
        parameters: study.parameters.iter().map(|p| p.name.clone()).collect(),
        units: study.parameters.iter().map(|p| p.unit.clone()).collect(),
        x_name: study.axis(&study.x).title(),
        y_name: study.axis(&study.y).title(),
    }
}

fn write_rest(session: &mut Session) -> Result<(), Diagnostic> {
    let Some((path, mut tracer)) = session.extension::<Tracing>().active.take() else {
        return Ok(());
    };
    let bytes = tracer.take_bytes();
    session.world.append_file(&path, &bytes).map_err(|fault| fault.at(Span::NONE))
}
