-- plclint in Neovim 0.8 and later: copy it to a file that your init.lua requires.

local extensions = { 'awl', 'stl', 'il', 'st', 'ld', 'gr7', 'sfc', 'dfb', 'fef', 'scy' }
local is_program = {}
for _, extension in ipairs(extensions) do
  is_program[extension] = true
end

local function start(buffer)
  local name = vim.api.nvim_buf_get_name(buffer)
  local extension = name:match('%.([^./\\]+)$')
  local is_configuration = vim.fs.basename(name) == 'plclint.toml'
  if not is_configuration and not (extension and is_program[extension:lower()]) then
    return
  end
  local folder = vim.fs.dirname(name)
  local marks = vim.fs.find({ 'plclint.toml', '.git' }, { upward = true, path = folder })
  vim.lsp.start({
    name = 'plclint',
    cmd = { vim.env.PLCLINT or 'plclint', 'server' },
    root_dir = marks[1] and vim.fs.dirname(marks[1]) or folder,
  }, { bufnr = buffer })
end

vim.api.nvim_create_autocmd({ 'BufReadPost', 'BufNewFile' }, {
  group = vim.api.nvim_create_augroup('plclint', {}),
  callback = function(event) start(event.buf) end,
})

-- Files of the vendor's tools are in Windows-1252 as a rule, and end with CR LF.
vim.opt.fileencodings = { 'ucs-bom', 'utf-8', 'cp1252' }
