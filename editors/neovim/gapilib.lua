-- The language server of gapilib for Modelica files and scripts, in Neovim 0.7 and later.
local M = {}

-- The folder of the outermost package around a file, or the folder of the file.
local function root_of(file)
  local folder = vim.fn.fnamemodify(file, ':p:h')
  local root = folder
  while vim.fn.filereadable(root .. '/../package.mo') == 1 do
    root = vim.fn.fnamemodify(root, ':h')
  end
  return root
end

local client_id

local function start(options, buffer)
  local config = {
    name = 'gapilib',
    cmd = vim.list_extend({ options.path or 'gapi', 'lsp' }, options.arguments or {}),
    root_dir = root_of(vim.api.nvim_buf_get_name(buffer)),
    init_options = { libraries = options.libraries or {} },
    capabilities = options.capabilities,
    on_attach = options.on_attach,
    on_exit = function() client_id = nil end,
  }
  -- One server for all folders: it finds the library of each file by itself.
  client_id = client_id or vim.lsp.start_client(config)
  if client_id then
    vim.lsp.buf_attach_client(buffer, client_id)
  end
end

function M.setup(options)
  options = options or {}
  local group = vim.api.nvim_create_augroup('gapilib', {})
  -- Neovim takes `.mo` for something else.
  for pattern, filetype in pairs({ ['*.mo'] = 'modelica', ['*.mos'] = 'modelica-script' }) do
    vim.api.nvim_create_autocmd({ 'BufRead', 'BufNewFile' }, {
      group = group,
      pattern = pattern,
      callback = function(event) vim.bo[event.buf].filetype = filetype end,
    })
  end
  vim.api.nvim_create_autocmd('FileType', {
    group = group,
    pattern = { 'modelica', 'modelica-script' },
    callback = function(event)
      local buffer = event.buf
      vim.bo[buffer].commentstring = '// %s'
      vim.bo[buffer].shiftwidth = 2
      vim.bo[buffer].expandtab = true
      start(options, buffer)
    end,
  })
  vim.api.nvim_create_user_command('GapiRun', function()
    vim.cmd('write')
    vim.cmd('split | terminal ' .. vim.fn.shellescape(options.path or 'gapi') .. ' run '
      .. vim.fn.shellescape(vim.fn.expand('%:p')))
  end, {})
end

return M
