//! MAT version 5 (which programs call 6, and 7 when compressed): a header of 128 bytes, then
//! elements of type, size and data, padded to 8 bytes; a matrix is an element of elements.
//!
//! Read: the numeric classes, characters, logical values, the fields of structures, which in arrays
//! are named `run(2).t`, and the elements of cells, `signals{2}`.
//! Skipped with a warning: objects, sparse matrices, functions and other opaque values, complex
//! values, arrays of more than two dimensions.

use super::errors::{BAD_MAT_FILE, UNREADABLE_MATRIX};
use super::matrix::{self, MatFile, Matrix, MatrixKind, Version};
use super::number::{ByteOrder, Storage};
use super::reader::Reader;
use crate::diag::Fault;
use crate::{bail, fault};
use std::io::Read;

/// Bytes that the compressed elements of one file may have when inflated: 256 MiB.
pub const MAX_INFLATED: u64 = 256 << 20;

const MAX_DEPTH: usize = 32;
const HEADER: usize = 128;

const MI_MATRIX: u32 = 14;
const MI_COMPRESSED: u32 = 15;
const MI_UTF8: u32 = 16;
const MI_UTF16: u32 = 17;
const MI_UTF32: u32 = 18;

/// The byte order of a version 5 file; `None` if it is no such file.
pub(crate) fn byte_order(bytes: &[u8]) -> Option<ByteOrder> {
    match bytes.get(126..HEADER)? {
        _ if bytes[..4].contains(&0) => None,
        b"IM" => Some(ByteOrder::Little),
        b"MI" => Some(ByteOrder::Big),
        _ => None,
    }
}

pub(crate) fn read(bytes: &[u8], order: ByteOrder) -> Result<MatFile, Fault> {
    let mut file = File { found: MatFile::new(Version::V5), inflatable: MAX_INFLATED };
    let mut reader = Reader::new(&bytes[HEADER..], order);
    while !reader.is_empty() {
        file.read_top_level(&mut reader)?;
    }
    Ok(file.found)
}

struct File {
    found: MatFile,
    /// Bytes that may still be inflated.
    inflatable: u64,
}

/// An element: its type and its data.
struct Element<'a> {
    kind: u32,
    data: &'a [u8],
}

impl File {
    fn read_top_level(&mut self, reader: &mut Reader) -> Result<(), Fault> {
        let kind = reader.u32("an element")?;
        let size = reader.u32("an element")? as usize;
        let data = reader.take(size, "an element")?;
        if kind != MI_COMPRESSED {
            reader.pad(size.wrapping_neg() % 8);
            return self.read_variable(Element { kind, data }, reader.order);
        }
        let inflated = self.inflate(data)?;
        let mut inner = Reader::new(&inflated, reader.order);
        let kind = inner.u32("a compressed element")?;
        let size = inner.u32("a compressed element")? as usize;
        let data = inner.take(size, "a compressed element")?;
        self.read_variable(Element { kind, data }, reader.order)
    }

    /// Inflates at most what the file may still use; memory grows with the data, not with sizes
    /// that the file claims.
    fn inflate(&mut self, data: &[u8]) -> Result<Vec<u8>, Fault> {
        let mut inflated = Vec::new();
        let limit = self.inflatable + 1;
        let mut decoder = flate2::read::ZlibDecoder::new(data).take(limit);
        if decoder.read_to_end(&mut inflated).is_err() {
            bail!(BAD_MAT_FILE, "a compressed element is damaged");
        }
        let used = inflated.len() as u64;
        if used >= limit {
            bail!(
                BAD_MAT_FILE,
                "the compressed data inflate to more than {} MiB", MAX_INFLATED >> 20;
                help: "save only the matrices that are needed"
            );
        }
        self.inflatable -= used;
        Ok(inflated)
    }

    fn read_variable(&mut self, element: Element, order: ByteOrder) -> Result<(), Fault> {
        if element.kind != MI_MATRIX {
            bail!(BAD_MAT_FILE, "expected a matrix, got an element of type {}", element.kind);
        }
        self.read_matrix(element.data, order, "", 0)
    }

    /// Reads one matrix; `path` is the dotted name of a field and empty at the top.
    fn read_matrix(
        &mut self,
        data: &[u8],
        order: ByteOrder,
        path: &str,
        depth: usize,
    ) -> Result<(), Fault> {
        if depth > MAX_DEPTH {
            bail!(BAD_MAT_FILE, "structures are nested deeper than {MAX_DEPTH} levels");
        }
        if data.is_empty() && !path.is_empty() {
            self.found.insert(path.to_owned(), Matrix::from_columns(0, 0, Vec::new()));
            return Ok(());
        }
        let mut reader = Reader::new(data, order);
        let flags = read_flags(&mut reader)?;
        let sizes = if flags.class.has_sizes() { read_sizes(&mut reader)? } else { Vec::new() };
        let own = read_name(&mut reader)?;
        let name = if path.is_empty() { own } else { path.to_owned() };
        if name.is_empty() {
            self.found.warnings.push("an element without a name is skipped".to_owned());
            return Ok(());
        }
        if let Some(reason) = flags.unreadable(&sizes) {
            self.found.skip(name, reason);
            return Ok(());
        }
        match flags.class {
            Class::Structure => self.read_structures(&mut reader, &name, &sizes, depth),
            Class::Cell => {
                let names = elements(&name, &sizes, ['{', '}'])?;
                let fault = whole(&name, "a cell array", names.first());
                self.found.fail(name, fault);
                self.read_elements(&mut reader, &names, depth)
            }
            _ => self.read_values(&mut reader, name, &flags, [sizes[0], sizes[1]]),
        }
    }

    fn read_structures(
        &mut self,
        reader: &mut Reader,
        name: &str,
        sizes: &[usize],
        depth: usize,
    ) -> Result<(), Fault> {
        let length = read_element(reader)?;
        let length = match &*integers(&length, reader.order)? {
            [length] if *length > 0 => *length as usize,
            _ => bail!(BAD_MAT_FILE, "structure `{name}` has a malformed field name length"),
        };
        let fields: Vec<String> = read_element(reader)?
            .data
            .chunks(length)
            .map(|field| {
                let end = field.iter().position(|byte| *byte == 0).unwrap_or(field.len());
                String::from_utf8_lossy(&field[..end]).into_owned()
            })
            .collect();
        let owners = match sizes {
            [1, 1] => vec![name.to_owned()],
            _ => elements(name, sizes, ['(', ')'])?,
        };
        if owners.first().is_none_or(|owner| owner != name) {
            let fault = whole(name, "an array of structures", owners.first());
            self.found.fail(name.to_owned(), fault);
        }
        for owner in owners {
            let paths: Vec<String> =
                fields.iter().map(|field| format!("{owner}.{field}")).collect();
            self.read_elements(reader, &paths, depth)?;
        }
        Ok(())
    }

    /// Reads matrices that follow each other, one for each of these names.
    fn read_elements(
        &mut self,
        reader: &mut Reader,
        names: &[String],
        depth: usize,
    ) -> Result<(), Fault> {
        for name in names {
            let element = read_element(reader)?;
            if element.kind != MI_MATRIX {
                bail!(BAD_MAT_FILE, "`{name}` is not a matrix");
            }
            self.read_matrix(element.data, reader.order, name, depth + 1)?;
        }
        Ok(())
    }

    fn read_values(
        &mut self,
        reader: &mut Reader,
        name: String,
        flags: &Flags,
        [rows, columns]: [usize; 2],
    ) -> Result<(), Fault> {
        let element = read_element(reader)?;
        let size = matrix::size(&name, rows, columns)?;
        let values = decode_values(&element, reader.order, size)
            .filter(|values| values.len() == size)
            .ok_or_else(|| {
                let (kind, bytes) = (element.kind, element.data.len());
                fault!(
                    BAD_MAT_FILE,
                    "matrix `{name}` is {rows} by {columns}, but its data are {bytes} bytes of \
                     type {kind}"
                )
            })?;
        let rounded = values.iter().any(|value| value.abs() >= (1_u64 << 53) as f64);
        if rounded && matches!(storage(element.kind), Some(Storage::I64 | Storage::U64)) {
            self.found.warnings.push(format!("integers of `{name}` beyond 2^53 are rounded"));
        }
        let kind = match flags.class {
            Class::Char => MatrixKind::Char,
            _ if flags.is_logical => MatrixKind::Logical,
            _ => MatrixKind::Numeric,
        };
        self.found.insert(name, Matrix { rows, columns, values, kind });
        Ok(())
    }
}

/// What a matrix is, from its flags.
struct Flags {
    class: Class,
    is_complex: bool,
    is_logical: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Cell,
    Structure,
    Object,
    Char,
    Sparse,
    Numeric,
    Function,
    Opaque,
}

impl Class {
    fn from_number(number: u32) -> Option<Class> {
        Some(match number {
            1 => Class::Cell,
            2 => Class::Structure,
            3 => Class::Object,
            4 => Class::Char,
            5 => Class::Sparse,
            6..=15 => Class::Numeric,
            16 => Class::Function,
            17 => Class::Opaque,
            _ => return None,
        })
    }

    /// Opaque values have their name where others have their sizes.
    fn has_sizes(self) -> bool {
        self != Class::Opaque
    }
}

impl Flags {
    /// Why it cannot be read as real matrices, if so.
    fn unreadable(&self, sizes: &[usize]) -> Option<&'static str> {
        Some(match self.class {
            Class::Object => "it is an object; save its data as matrices",
            Class::Sparse => "it is a sparse matrix; convert it with `full` before saving",
            Class::Function => "it is a function handle",
            Class::Opaque => {
                "it is an object of a class (such as a table or a string array); save its data as matrices"
            }
            _ if self.is_complex => "it is complex; save only its real part",
            _ if sizes.len() != 2 => {
                "it has more than two dimensions; save a two-dimensional slice"
            }
            _ => return None,
        })
    }
}

/// The names of the elements of an array of structures or cells: by one index where it has one row
/// or one column.
fn elements(name: &str, sizes: &[usize], [open, close]: [char; 2]) -> Result<Vec<String>, Fault> {
    /// More elements than this are not columns of measured data.
    const MOST: usize = 100_000;
    let [rows, columns] = [sizes[0], sizes[1]];
    let size = matrix::size(name, rows, columns)?;
    if size > MOST {
        bail!(BAD_MAT_FILE, "`{name}` has {size} elements; at most {MOST} are read");
    }
    let is_vector = rows == 1 || columns == 1;
    let one = |at: usize| match is_vector {
        true => format!("{name}{open}{}{close}", at + 1),
        false => format!("{name}{open}{},{}{close}", at % rows + 1, at / rows + 1),
    };
    Ok((0..size).map(one).collect())
}

/// Why a variable with elements is not a matrix itself.
fn whole(name: &str, what: &str, first: Option<&String>) -> Fault {
    let fault = fault!(UNREADABLE_MATRIX, "`{name}` cannot be read: it is {what}");
    fault.help_if(first.map(|first| format!("name one of its elements, such as `{first}`")))
}

fn read_flags(reader: &mut Reader) -> Result<Flags, Fault> {
    let element = read_element(reader)?;
    let mut flags = Reader::new(element.data, reader.order);
    let flags = flags.u32("the flags of a matrix")?;
    let class = flags & 0xff;
    let Some(class) = Class::from_number(class) else {
        bail!(BAD_MAT_FILE, "a matrix has the unknown class {class}");
    };
    Ok(Flags { class, is_complex: flags & 0x0800 != 0, is_logical: flags & 0x0200 != 0 })
}

fn read_sizes(reader: &mut Reader) -> Result<Vec<usize>, Fault> {
    let element = read_element(reader)?;
    let sizes = integers(&element, reader.order)?;
    if sizes.len() < 2 || sizes.iter().any(|size| *size < 0) {
        bail!(BAD_MAT_FILE, "a matrix has malformed sizes");
    }
    Ok(sizes.iter().map(|size| *size as usize).collect())
}

fn read_name(reader: &mut Reader) -> Result<String, Fault> {
    let bytes = read_element(reader)?.data;
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    Ok(String::from_utf8_lossy(&bytes[..end]).into_owned())
}

/// The next element of a matrix; small ones keep their data within the tag.
fn read_element<'a>(reader: &mut Reader<'a>) -> Result<Element<'a>, Fault> {
    let tag = reader.u32("an element")?;
    let (small, kind) = (tag >> 16, tag & 0xffff);
    if small > 4 {
        bail!(BAD_MAT_FILE, "a small data element claims {small} bytes");
    }
    if small > 0 {
        let data = reader.take(4, "a small data element")?;
        return Ok(Element { kind, data: &data[..small as usize] });
    }
    let size = reader.u32("an element")? as usize;
    let data = reader.take(size, "an element")?;
    reader.pad(size.wrapping_neg() % 8);
    Ok(Element { kind, data })
}

fn storage(kind: u32) -> Option<Storage> {
    Some(match kind {
        1 => Storage::I8,
        2 => Storage::U8,
        3 => Storage::I16,
        4 => Storage::U16,
        5 => Storage::I32,
        6 => Storage::U32,
        7 => Storage::F32,
        9 => Storage::F64,
        12 => Storage::I64,
        13 => Storage::U64,
        MI_UTF16 => Storage::U16,
        MI_UTF32 => Storage::U32,
        _ => return None,
    })
}

fn integers(element: &Element, order: ByteOrder) -> Result<Vec<i32>, Fault> {
    match storage(element.kind) {
        Some(kind @ (Storage::I32 | Storage::U32)) => {
            let values = kind.decode(element.data, order);
            Ok(values.into_iter().map(|value| value as i32).collect())
        }
        _ => bail!(BAD_MAT_FILE, "expected integers as sizes, got type {}", element.kind),
    }
}

/// The values of an element; `size` is how many the matrix has, which tells apart UTF-8 counted in
/// bytes from UTF-8 counted in characters.
fn decode_values(element: &Element, order: ByteOrder, size: usize) -> Option<Vec<f64>> {
    if element.kind != MI_UTF8 || element.data.len() == size {
        let storage = if element.kind == MI_UTF8 { Storage::U8 } else { storage(element.kind)? };
        return element
            .data
            .len()
            .is_multiple_of(storage.size())
            .then(|| storage.decode(element.data, order));
    }
    let text = std::str::from_utf8(element.data).ok()?;
    Some(match text.chars().count() == size {
        true => text.chars().map(|letter| f64::from(u32::from(letter))).collect(),
        false => text.encode_utf16().map(f64::from).collect(),
    })
}
