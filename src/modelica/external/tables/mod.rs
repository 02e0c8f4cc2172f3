//! `ModelicaStandardTables_*`: the tables of `Modelica.Blocks` (interface of versions 3.2 to 4).
//!
//! Not handled: tables defined by a C function `usertab`. Splines need abscissae that increase
//! strictly, as in the standard library.

mod curve;
mod one;
mod source;
mod spline;
mod surface;
mod time;
mod two;

pub(crate) use source::names_a_file;

use super::Entry;
use super::call::Call;
use crate::diag::Fault;

pub(crate) const ENTRIES: &[Entry] = &[
    Entry::pure("ModelicaStandardTables_CombiTimeTable_init", "tfannnannn->o", time::init),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_init2", "ftannnannnnnn->o", time::init2),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_init3", "ftannnannnnnntn->o", time::init3),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_close", "o", close),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_read", "onn->n", read),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_getValue", "onnnn->n", time::value),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_getDerValue", "onnnnn->n", time::derivative),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_getDer2Value", "onnnnnn->n", time::second),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_minimumTime", "o->n", time::minimum),
    Entry::pure("ModelicaStandardTables_CombiTimeTable_maximumTime", "o->n", time::maximum),
    Entry::stepwise(
        "ModelicaStandardTables_CombiTimeTable_nextTimeEvent",
        "on->n",
        time::next_event,
    ),
    Entry::pure("ModelicaStandardTables_CombiTable1D_init", "tfannann->o", one::init),
    Entry::pure("ModelicaStandardTables_CombiTable1D_init2", "ftannannnn->o", one::init2),
    Entry::pure("ModelicaStandardTables_CombiTable1D_init3", "ftannannnntn->o", one::init3),
    Entry::pure("ModelicaStandardTables_CombiTable1D_close", "o", close),
    Entry::pure("ModelicaStandardTables_CombiTable1D_read", "onn->n", read),
    Entry::pure("ModelicaStandardTables_CombiTable1D_getValue", "onn->n", one::value),
    Entry::pure("ModelicaStandardTables_CombiTable1D_getDerValue", "onnn->n", one::derivative),
    Entry::pure("ModelicaStandardTables_CombiTable1D_getDer2Value", "onnnn->n", one::second),
    Entry::pure("ModelicaStandardTables_CombiTable1D_minimumAbscissa", "o->n", one::minimum),
    Entry::pure("ModelicaStandardTables_CombiTable1D_maximumAbscissa", "o->n", one::maximum),
    Entry::pure("ModelicaStandardTables_CombiTable2D_init", "tfannn->o", two::init),
    Entry::pure("ModelicaStandardTables_CombiTable2D_init2", "ftannnnn->o", two::init2),
    Entry::pure("ModelicaStandardTables_CombiTable2D_init3", "ftannnnntn->o", two::init3),
    Entry::pure("ModelicaStandardTables_CombiTable2D_close", "o", close),
    Entry::pure("ModelicaStandardTables_CombiTable2D_read", "onn->n", read),
    Entry::pure("ModelicaStandardTables_CombiTable2D_getValue", "onn->n", two::value),
    Entry::pure("ModelicaStandardTables_CombiTable2D_getDerValue", "onnnn->n", two::derivative),
    Entry::pure("ModelicaStandardTables_CombiTable2D_getDer2Value", "onnnnnn->n", two::second),
    Entry::pure("ModelicaStandardTables_CombiTable2D_minimumAbscissa", "oA", two::minimum),
    Entry::pure("ModelicaStandardTables_CombiTable2D_maximumAbscissa", "oA", two::maximum),
];

/// Tables are freed with the model that made them.
fn close(_: &mut Call<'_>) -> Result<(), Fault> {
    Ok(())
}

/// Tables are read when they are made: this confirms it (interface of version 3.2).
fn read(call: &mut Call<'_>) -> Result<(), Fault> {
    call.give(1.0)
}
