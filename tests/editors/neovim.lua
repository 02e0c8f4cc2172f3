-- Neovim as a client of `gapi lsp`:
--   GAPI=target/debug/gapi nvim --headless -u NONE -S tests/editors/neovim.lua
local here = vim.fn.fnamemodify(debug.getinfo(1, 'S').source:sub(2), ':p:h')
package.path = here .. '/../../editors/neovim/?.lua;' .. package.path

local failed = false

local function check(what, found, expected)
  local is_equal = vim.deep_equal(found, expected)
  failed = failed or not is_equal
  local shown = is_equal and '' or ': ' .. vim.inspect(found) .. ', expected ' .. vim.inspect(expected)
  io.stdout:write((is_equal and 'ok ' or 'not ok ') .. what .. shown .. '\n')
end

local function wait(what, condition)
  if not vim.wait(20000, condition, 20) then
    failed = true
    io.stdout:write('not ok ' .. what .. ': nothing happened\n')
  end
end

local function request(method, line, column)
  local params = {
    textDocument = vim.lsp.util.make_text_document_params(),
    position = { line = line, character = column },
    context = { includeDeclaration = true, triggerKind = 1 },
  }
  local results = vim.lsp.buf_request_sync(0, method, params, 20000)
  local _, first = next(results or {})
  return first and first.result
end

local function tests()
  vim.cmd('filetype on')
  require('gapilib').setup({ path = vim.env.GAPI })
  local folder = vim.fn.tempname()
  vim.fn.mkdir(folder, 'p')
  local file = folder .. '/Decay.mo'
  vim.fn.writefile({
    'model Decay "😀"', '  parameter Real k(unit = "1/s") = 1;', '  Real x(start = 1);', 'equation',
    '  der(x) = -kk*x;', 'end Decay;',
  }, file)
  vim.cmd('edit ' .. file)
  check('the type of the file', vim.bo.filetype, 'modelica')
  wait('diagnostics', function() return #vim.diagnostic.get(0) > 0 end)
  local found = vim.diagnostic.get(0)
  check('one diagnostic', #found, 1)
  check('its place', { found[1].lnum, found[1].col }, { 4, 12 })
  check('its code', found[1].code, 'unknown-name')
  -- Typing corrects it.
  vim.api.nvim_buf_set_text(0, 4, 12, 4, 14, { 'k' })
  wait('no diagnostics', function() return #vim.diagnostic.get(0) == 0 end)
  check('diagnostics are gone', #vim.diagnostic.get(0), 0)
  local hover = request('textDocument/hover', 4, 12)
  check('the unit in the hover', hover.contents.value:find('unit `1/s`', 1, true) ~= nil, true)
  local definition = request('textDocument/definition', 4, 12)
  check('the definition', definition.range.start.line, 1)
  check('references', #request('textDocument/references', 4, 12), 2)
  -- Renaming changes the buffer.
  vim.api.nvim_win_set_cursor(0, { 5, 12 })
  vim.lsp.buf.rename('rate')
  wait('renamed', function() return vim.fn.getline(5):find('rate') end)
  check('the use', vim.fn.getline(5), '  der(x) = -rate*x;')
  check('the declaration', vim.fn.getline(2), '  parameter Real rate(unit = "1/s") = 1;')
  -- Half-typed text is completed.
  vim.fn.append(3, '  Real y = ra')
  local items = request('textDocument/completion', 3, 13)
  local labels = vim.tbl_map(function(item) return item.label end, items.items or items)
  check('completion', vim.tbl_contains(labels, 'rate'), true)
  vim.fn.setline(4, 'Real   y = rate ;')
  local format = vim.lsp.buf.formatting_sync or vim.lsp.buf.format
  format(nil, 20000)
  check('formatting', vim.fn.getline(4), '  Real y = rate;')
  -- A second file, a script.
  vim.cmd('write')
  vim.fn.writefile({ 'simulateModl("Decay")' }, folder .. '/run.mos')
  vim.cmd('edit ' .. folder .. '/run.mos')
  wait('diagnostics of the script', function() return #vim.diagnostic.get(0) > 0 end)
  check('one server', #vim.lsp.get_active_clients(), 1)
  check('the code', vim.diagnostic.get(0)[1].code, 'unknown-function')
  local client = vim.lsp.get_active_clients()[1]
  client.stop()
  wait('the end of the server', function() return client.is_stopped() end)
  check('the server has ended', client.is_stopped(), true)
end

local done, reason = pcall(tests)
check('no error', done or reason, true)
vim.cmd(failed and 'cquit 1' or 'qall!')
