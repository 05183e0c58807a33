-- What a user of Neovim sees: an error and its fix, completion, hover, colours, hints, lenses, a rename across files.
local function expect(condition, words)
  if not condition then
    io.stderr:write("FAILED: " .. words .. "\n")
    vim.cmd("cquit 1")
  end
  io.stdout:write("ok: " .. words .. "\n")
end

-- Milliseconds, far more than a slow machine needs.
local patience = 180000

local function eventually(words, check)
  expect(vim.wait(patience, check, 20), words)
end

local function place(text, behind)
  for number, line in ipairs(vim.api.nvim_buf_get_lines(0, 0, -1, false)) do
    local first, last = line:find(text, 1, true)
    if first then
      return { line = number - 1, character = behind and last or first - 1 }
    end
  end
  error("not in the text: " .. text)
end

local function ask(method, parameters)
  parameters.textDocument = { uri = vim.uri_from_bufnr(0) }
  local answers = vim.lsp.buf_request_sync(0, method, parameters, patience) or {}
  for _, answer in pairs(answers) do
    return answer.result
  end
end

eventually("the server attaches", function()
  local client = vim.lsp.get_clients({ bufnr = 0 })[1]
  return client ~= nil and client.initialized
end)

local at = place("template: <pick-place>", false)
vim.api.nvim_buf_set_text(0, at.line, at.character + 11, at.line, at.character + 21, { "pick-plaice" })
eventually("a misspelt name is underlined", function()
  local found = vim.diagnostic.get(0)
  return #found == 1 and found[1].code == "unknown-name"
end)
vim.cmd("undo")
eventually("the diagnostic goes when it is mended", function()
  return #vim.diagnostic.get(0) == 0
end)

local items = ask("textDocument/completion", { position = place("before <evt-p", true) })
local labels = vim.tbl_map(function(item) return item.label end, items.items or items)
expect(vim.tbl_contains(labels, "evt-pick-start"), "events are completed")

local hover = ask("textDocument/hover", { position = place("Scenario part-to", true) })
expect(hover.contents.value:find("4 scenarios", 1, true) ~= nil, "hover counts scenarios")

local tokens = ask("textDocument/semanticTokens/full", {})
expect(#tokens.data > 100, "words have their colours")

local last = vim.api.nvim_buf_line_count(0)
local range = { start = { line = 0, character = 0 }, ["end"] = { line = last, character = 0 } }
expect(#ask("textDocument/inlayHint", { range = range }) >= 4, "variables have hints")

eventually("the lens above the scenario is shown", function()
  for _, mark in ipairs(vim.api.nvim_buf_get_extmarks(0, -1, 0, -1, { details = true })) do
    for _, chunk in ipairs(mark[4].virt_text or {}) do
      if chunk[1] == "Run" then
        return true
      end
    end
  end
  return false
end)

local edit = ask("textDocument/rename", { position = place("places.left", true), newName = "near_ws" })
expect(vim.tbl_count(edit.changes) == 2, "a rename reaches the scene")

vim.cmd("write")
vim.cmd("edit ../ownrobot/tidy.bddx")
local model = vim.api.nvim_get_current_buf()
vim.cmd("edit ../ownrobot/carrying.py")
local class = place("class Carry", true)
vim.api.nvim_buf_set_text(0, class.line, class.character, class.line, class.character, { "ing" })
eventually("an unsaved class counts for the model that names it", function()
  return vim.iter(vim.diagnostic.get(model)):any(function(found)
    return found.code == "python-source" and found.message:find("did you mean 'Carrying'", 1, true)
  end)
end)
vim.cmd("edit! ../pickplace/bench.scene")

for _, client in ipairs(vim.lsp.get_clients()) do
  client:stop()
end
vim.cmd("qall!")
