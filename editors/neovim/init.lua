-- plclint in Neovim 0.7 and later: copy it to a file that your init.lua requires.

local extensions = { 'awl', 'stl', 's5', 'il', 'st', 'ld', 'gr7', 'sfc', 'dfb', 'fef', 'scy' }
-- Symbol tables: a new name changes them, too.
local tables = { 'sdf', 'asc', 'seq', 'dif' }
local is_program = {}
for _, list in ipairs({ extensions, tables }) do
  for _, extension in ipairs(list) do
    is_program[extension] = true
  end
end

local function parent(path)
  return vim.fn.fnamemodify(path, ':h')
end

-- The folder above a file that has a configuration or a repository, else its own.
local function root_of(name)
  local folder = parent(name)
  local at = folder
  while true do
    for _, mark in ipairs({ 'plclint.toml', '.git' }) do
      if vim.loop.fs_stat(at .. '/' .. mark) then
        return at
      end
    end
    local above = parent(at)
    if above == at then
      return folder
    end
    at = above
  end
end

-- One server a folder.
local clients = {}

local function start(buffer)
  local name = vim.api.nvim_buf_get_name(buffer)
  local extension = name:match('%.([^./\\]+)$')
  local is_configuration = vim.fn.fnamemodify(name, ':t') == 'plclint.toml'
  if not is_configuration and not (extension and is_program[extension:lower()]) then
    return
  end
  local root = root_of(name)
  local config = {
    name = 'plclint',
    cmd = { vim.env.PLCLINT or 'plclint', 'server' },
    root_dir = root,
    workspace_folders = { { uri = vim.uri_from_fname(root), name = root } },
  }
  if vim.lsp.start then
    vim.lsp.start(config, { bufnr = buffer })
    return
  end
  -- Before 0.8.
  local id = clients[root]
  if not id or vim.lsp.client_is_stopped(id) then
    config.capabilities = vim.lsp.protocol.make_client_capabilities()
    id = vim.lsp.start_client(config)
    clients[root] = id
  end
  if id then
    vim.lsp.buf_attach_client(buffer, id)
  end
end

vim.api.nvim_create_autocmd({ 'BufReadPost', 'BufNewFile' }, {
  group = vim.api.nvim_create_augroup('plclint', {}),
  callback = function(event) start(event.buf) end,
})

-- Files of the vendor's tools are in Windows-1252 as a rule, and end with CR LF.
vim.opt.fileencodings = { 'ucs-bom', 'utf-8', 'cp1252' }
