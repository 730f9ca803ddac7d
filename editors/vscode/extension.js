"use strict";
// Starts `edsc lsp` for VS Code: the program of the setting, of PATH, or the one in this extension.

const childProcess = require("child_process");
const fs = require("fs");
const { promisify } = require("util");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { candidates } = require("./programs");

const execFile = promisify(childProcess.execFile);
const selector = [
  { language: "canopen-eds" },
  { pattern: "**/*.{xdd,xdc}" },
  { language: "json" },
  { language: "jsonc" },
];

let client;
let running = "";

/** The first program that prints its version, or null. */
async function findProgram(extensionFolder) {
  const setting = vscode.workspace.getConfiguration("edsc").get("path", "");
  for (const program of candidates(setting, process.env, process.platform, extensionFolder, fs.existsSync)) {
    try {
      const { stdout } = await execFile(program, ["--version"], { timeout: 10000 });
      return { program, version: stdout.trim() };
    } catch (problem) {
      if (setting) {
        vscode.window.showErrorMessage(`edsc: ${program} cannot be started: ${problem.message}`);
      }
    }
  }
  return null;
}

async function start(context) {
  const found = await findProgram(context.extensionPath);
  if (!found) {
    vscode.window.showErrorMessage("edsc: no program was found; the setting edsc.path may name one.");
    return;
  }
  running = `${found.version} (${found.program})`;
  const run = { command: found.program, args: ["lsp"] };
  client = new LanguageClient("edsc", "edsc", { run, debug: run }, {
    documentSelector: selector,
    synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher("**/*.{eds,dcf,overlay,xdd,xdc,json}") },
  });
  await client.start();
  const status = vscode.languages.createLanguageStatusItem("edsc", selector);
  status.text = found.version;
  status.detail = found.program;
  context.subscriptions.push(status);
}

async function stop() {
  const ending = client;
  client = undefined;
  if (ending) await ending.stop();
}

async function activate(context) {
  context.subscriptions.push(
    vscode.commands.registerCommand("edsc.showVersion", () => {
      vscode.window.showInformationMessage(running || "edsc is not running");
    }),
    vscode.commands.registerCommand("edsc.restart", async () => {
      await stop();
      await start(context);
    }),
  );
  await start(context);
}

module.exports = { activate, deactivate: stop };
