-- What a user of Debian's Neovim sees: an error, a lens, and what a run adds to it.
local patience = 180000

local function eventually(words, check)
  if not vim.wait(patience, check, 50) then
    io.stderr:write("FAILED: " .. words .. "\n")
    vim.cmd("cquit 1")
  end
  io.stdout:write("ok: " .. words .. "\n")
end

local function lens(title)
  for _, found in ipairs(vim.lsp.codelens.get(0)) do
    if found.command and found.command.title:find(title, 1, true) then
      return found
    end
  end
end

local function is_shown(title)
  for _, space in pairs(vim.api.nvim_get_namespaces()) do
    for _, mark in ipairs(vim.api.nvim_buf_get_extmarks(0, space, 0, -1, { details = true })) do
      for _, chunk in ipairs(mark[4].virt_text or {}) do
        if chunk[1]:find(title, 1, true) then
          return true
        end
      end
    end
  end
  return false
end

eventually("the server attaches", function()
  return #vim.lsp.buf_get_clients(0) == 1
end)
eventually("the lens above the scenario is shown", function()
  vim.cmd("doautocmd CursorHold")
  return lens("Run") ~= nil and is_shown("Run")
end)

vim.api.nvim_buf_set_lines(0, -1, -1, false, { "Scenario Template (ns=crit) broken {" })
eventually("an error is underlined", function()
  return #vim.diagnostic.get(0) > 0
end)
vim.cmd("undo")
eventually("it goes when the text is right again", function()
  return #vim.diagnostic.get(0) == 0
end)

vim.lsp.stop_client(vim.lsp.get_active_clients())
vim.cmd("qall!")
