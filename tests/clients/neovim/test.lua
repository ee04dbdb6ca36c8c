-- Neovim shows findings and hover, applies a quick-fix, and renames. Run by tests/clients/run with editors/neovim/init.lua loaded and
-- the corpus file in the current buffer.

local PATIENCE = 60000

local function fail(message)
  io.stderr:write('Neovim: ' .. message .. '\n')
  vim.cmd('cquit 1')
end

local function check(condition, message)
  if not condition then
    error(message, 2)
  end
end

local function wait(what, is_so)
  check(vim.wait(PATIENCE, is_so, 20), 'waited in vain: ' .. what)
end

-- `W001 12`, lines from 1, in order.
local function sorted(lines)
  table.sort(lines)
  return table.concat(lines, '\n')
end

local function shown()
  local lines = {}
  for _, it in ipairs(vim.diagnostic.get(0)) do
    local code = it.code or (it.user_data and it.user_data.lsp.code)
    table.insert(lines, code .. ' ' .. it.lnum + 1)
  end
  return sorted(lines)
end

-- What the command line finds in the file, with all of its folder on the disk.
local function checked()
  local path = vim.api.nvim_buf_get_name(0)
  local output = vim.fn.tempname()
  vim.fn.system({
    vim.env.PLCLINT, 'check', vim.fn.fnamemodify(path, ':h'), '--format', 'json', '--output', output,
  })
  local lines = {}
  for _, it in ipairs(vim.fn.json_decode(vim.fn.readfile(output)).findings) do
    if it.path == path and it.suppressed == vim.NIL then
      table.insert(lines, it.code .. ' ' .. it.start.line)
    end
  end
  return sorted(lines)
end

local function put_cursor(pattern)
  vim.fn.cursor(1, 1)
  check(vim.fn.search(pattern) > 0, 'no ' .. pattern)
end

local function floating()
  for _, window in ipairs(vim.api.nvim_list_wins()) do
    if vim.api.nvim_win_get_config(window).relative ~= '' then
      return table.concat(vim.api.nvim_buf_get_lines(vim.api.nvim_win_get_buf(window), 0, -1, false), '\n')
    end
  end
end

local function main()
  local expected = checked()
  check(expected:find('T018'), 'the corpus file has a finding to fix')
  wait('findings', function() return shown() == expected end)

  put_cursor('%MB100:8')
  vim.lsp.buf.hover()
  wait('hover', function() return floating() end)
  check(floating():find('%%MB100:8'), 'hover tells of the object: ' .. floating())

  put_cursor('%MW5:=0 THEN')
  vim.fn.search(':=')
  local offered = {}
  vim.ui.select = function(items, options, choose)
    for _, item in ipairs(items) do
      local title = options.format_item and options.format_item(item) or item
      table.insert(offered, title)
      if title:find('Write `=`', 1, true) then
        return choose(item)
      end
    end
    fail('no quick-fix among: ' .. table.concat(offered, ', '))
  end
  vim.lsp.buf.code_action()
  wait('quick-fix', function() return vim.fn.search('IF %MW5=0 THEN', 'nw') > 0 end)
  vim.cmd('write')
  local fixed = checked()
  check(#fixed < #expected, 'the fix mends something')
  wait('findings of the fixed text', function() return shown() == fixed end)

  vim.cmd('undo')
  wait('findings after undo', function() return shown() == expected end)

  -- In the text alone, not on the disk.
  vim.api.nvim_buf_set_lines(0, 3, 3, false, { '! %M500:=%M501 AND;' })
  wait('the findings of what was typed', function() return (shown() .. '\n'):find('X001 4\n') end)

  -- A new name for a symbol goes into the symbol table, too, and is known before anything is saved.
  vim.cmd('edit! convoyeur-s7/convoyeur.awl')
  expected = checked()
  wait('findings with a symbol table', function() return shown() == expected end)
  put_cursor('"Forcage"')
  vim.lsp.buf.rename('Cle de forcage')
  wait('the new name', function() return vim.fn.search('"Cle de forcage"', 'nw') > 0 end)
  check(vim.fn.search('"Forcage"', 'nw') == 0, 'the old name is left')
  local symbols = vim.fn.getbufline(vim.fn.bufnr('convoyeur.sdf'), 1, '$')
  check(table.concat(symbols, '\n'):find('"Cle de forcage"', 1, true), 'the table has the new name')
  vim.fn.append(0, 'x')
  wait('the findings of the next edit', function() return (shown() .. '\n'):find('X001 1\n') end)
  vim.cmd('1delete')
  wait('the findings of the renamed program', function() return shown() == expected end)

  vim.lsp.stop_client(vim.lsp.get_active_clients())
  wait('the end of the server', function() return #vim.lsp.get_active_clients() == 0 end)
end

local is_well, message = pcall(main)
if not is_well then
  local log = vim.fn.readfile(vim.lsp.get_log_path())
  fail(tostring(message) .. '\nshown:\n' .. shown() .. '\nlog:\n' .. table.concat(log, '\n', math.max(1, #log - 20)))
end
print('Neovim ' .. tostring(vim.fn.matchstr(vim.fn.execute('version'), 'NVIM v[0-9.]*')) .. ': all is well')
vim.cmd('qall!')
