#!/usr/bin/env python3
"""Neovim, a client of others, with `edsc lsp`: a finding, its fix, a rename and the canonical form. Exit code 77: it is not installed.

    neovim_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
RK5C = SOURCE_DIR / "eds/rk5c.eds"

# Functions of Neovim 0.7 on. `step` runs in the buffer of the file when its first diagnostics have arrived.
SCRIPT = """
local function wait(condition) assert(vim.wait(20000, condition, 20), "no answer") end
vim.cmd("edit " .. vim.env.EDS)
local client = vim.lsp.start_client({ name = "edsc", cmd = { vim.env.EDSC, "lsp" }, root_dir = vim.fn.getcwd() })
vim.lsp.buf_attach_client(0, client)
wait(function() return #vim.diagnostic.get(0) > 0 end)
local result = {}
local function request(method, params)
  local answers = vim.lsp.buf_request_sync(0, method, params, 20000)
  for _, answer in pairs(answers) do
    assert(not answer.err, vim.inspect(answer.err))
    return answer.result
  end
end
local function apply(edit) vim.lsp.util.apply_workspace_edit(edit, vim.lsp.get_client_by_id(client).offset_encoding) end
%s
vim.cmd("write")
vim.fn.writefile({ vim.fn.json_encode(result) }, vim.env.RESULT)
vim.cmd("qall!")
"""


class Neovim(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.eds = self.folder / "rk5c.eds"
        self.text = RK5C.read_text(encoding="utf-8")

    def run_in_neovim(self, text: str, step: str) -> dict[str, object]:
        self.eds.write_text(text, encoding="utf-8")
        script = self.folder / "step.lua"
        script.write_text(SCRIPT % step, encoding="utf-8")
        result = self.folder / "result.json"
        environment = {**os.environ, "EDS": str(self.eds), "EDSC": str(EDSC), "RESULT": str(result), "HOME": str(self.folder),
                       "XDG_STATE_HOME": str(self.folder), "XDG_CACHE_HOME": str(self.folder)}
        ended = subprocess.run(["nvim", "--headless", "--clean", "-n", "-c", f"luafile {script}", "-c", "cquit"], cwd=self.folder,
                               env=environment, capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        return json.loads(result.read_text())

    def rules(self) -> set[str]:
        result = subprocess.run([EDSC, "check", self.eds, "--format", "json"], capture_output=True, text=True, check=False)
        return {one["rule"] for one in json.loads(result.stdout)["diagnostics"]}

    def wrong_count(self) -> str:
        wrong = self.text.replace("[MandatoryObjects]\nSupportedObjects=3", "[MandatoryObjects]\nSupportedObjects=7")
        self.assertNotEqual(wrong, self.text)
        return wrong

    def test_finding_and_fix(self) -> None:
        result = self.run_in_neovim(self.wrong_count(), """
local found = vim.tbl_filter(function(one) return one.code == "object-list-count" end, vim.diagnostic.get(0))
result.found = #found
local at = { line = found[1].lnum, character = 0 }
local actions = request("textDocument/codeAction", { textDocument = vim.lsp.util.make_text_document_params(),
  range = { start = at, ["end"] = { line = at.line, character = 40 } }, context = { diagnostics = {} } })
for _, action in ipairs(actions) do
  if action.isPreferred then apply(action.edit or request("codeAction/resolve", action).edit) break end
end
wait(function()
  return #vim.tbl_filter(function(one) return one.code == "object-list-count" end, vim.diagnostic.get(0)) == 0
end)
""")
        self.assertEqual(result["found"], 1)
        self.assertEqual(self.eds.read_text(encoding="utf-8"), self.text)
        self.assertNotIn("object-list-count", self.rules())

    def test_rename(self) -> None:
        line = self.text.split("\n").index("[1017]")
        self.run_in_neovim(self.wrong_count(), f"""
local params = {{ textDocument = vim.lsp.util.make_text_document_params(), position = {{ line = {line}, character = 2 }}, newName = "2F17" }}
apply(request("textDocument/rename", params))
""")
        renamed = self.eds.read_text(encoding="utf-8")
        self.assertIn("\n[2F17]\n", renamed)
        self.assertIn("=0x2F17\n", renamed)
        self.assertNotIn("0x1017", renamed)

    def test_format(self) -> None:
        text = self.wrong_count().replace("ObjectType=", "ObjectType = ")
        self.run_in_neovim(text, """
local edits = request("textDocument/formatting", { textDocument = vim.lsp.util.make_text_document_params(), options = { tabSize = 2, insertSpaces = true } })
vim.lsp.util.apply_text_edits(edits, vim.api.nvim_get_current_buf(), vim.lsp.get_client_by_id(client).offset_encoding)
""")
        wanted = self.folder / "wanted.eds"
        wanted.write_text(text, encoding="utf-8")
        formatted = subprocess.run([EDSC, "format", wanted], capture_output=True, text=True, check=True).stdout
        self.assertEqual(self.eds.read_text(encoding="utf-8"), formatted)


if __name__ == "__main__":
    if not shutil.which("nvim"):
        print("skipped: nvim is not installed")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
