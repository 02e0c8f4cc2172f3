// Tables that the user gives: their encoding, their columns, and how a script names them.

/** The text of a file: UTF-8, or else Windows-1252 (which contains Latin-1), as spreadsheets write. */
export function decodedText(bytes) {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

/** The cells of the first line that is not a comment: separated by tabs, semicolons or commas. */
export function columns(text) {
  const head = text.replace(/^\ufeff/, "").split(/\r?\n/).find((line) => line.trim() && !/^\s*#/.test(line)) ?? "";
  const by = ["\t", ";", ","].find((sign) => head.includes(sign)) ?? ",";
  return { by, names: head.split(by).map((cell) => cell.trim().replace(/^"(.*)"$/, "$1")) };
}

/** The commands of scripts that read tables. */
const READERS = /\b(Exp_Adq_SISO|Exp_Adq_MIMO|Exp_Adq\w*|GAPILib\.Experiment|readCSV|readRealMatrix|readMatrix|readFile)\s*\(/;

/** What to do with a table, in a sentence or two. */
export function advice(name, text, files) {
  if (!text.trim()) return { isWarning: true, text: `${name} is empty: there is no table in it.` };
  const { names } = columns(text);
  // Lines with a number in a cell: neither comments nor names nor units.
  const { by } = columns(text);
  const isRow = (line) => !/^\s*#/.test(line) && line.split(by).some((cell) => /^\s*"?[-+]?[\d.,]*\d[\d.,]*(e[-+]?\d+)?"?\s*$/i.test(cell));
  const rows = text.split(/\r?\n/).filter(isRow).length;
  const listed = names.slice(0, 8).map((one) => `"${one}"`).join(", ") + (names.length > 8 ? ", ..." : "");
  const used = Object.entries(files).map(([path, content]) => [path, typeof content === "string" && /\.mos$/.test(path) && READERS.exec(content)]).find(([, found]) => found);
  const problem = Object.keys(files).find((path) => /\.toml$/.test(path));
  const where = problem ? `Name it in ${problem}, where the data are described.`
    : used ? `Name it in ${used[0].split("/").at(-1)}, in the line with ${used[1][1]}.`
    : `A script reads it with Exp_Adq_SISO("${name}", "X", "Y"), X and Y being names of columns.`;
  return { isWarning: rows === 0, text: `${name}: ${rows} rows with the columns ${listed}. ${rows === 0 ? "There are no rows with numbers in it. " : ""}${where}` };
}

/** Where a cell of a table is: the column in the text, from 1, of the cell in this column. */
export function placeOfCell(text, line, column) {
  const { by } = columns(text);
  const cells = (text.split(/\r?\n/)[line - 1] ?? "").split(by);
  return cells.slice(0, column - 1).reduce((sum, cell) => sum + cell.length + 1, 0) + 1;
}
