"use strict";
// The programs that the extension may start. It does not need VS Code, so that a test can call it.

const path = require("path");

/**
 * The paths to try, in order: the setting alone if there is one; else `edsc` in the folders of PATH, then the program in the
 * extension. Folders of PATH that are not absolute are skipped: they would depend on the opened folder.
 */
function candidates(setting, environment, platform, extensionFolder, exists) {
  if (setting) return [setting];
  const isWindows = platform === "win32";
  const paths = isWindows ? path.win32 : path.posix;
  const name = isWindows ? "edsc.exe" : "edsc";
  const variable = environment.PATH || environment.Path || "";
  const folders = variable.split(paths.delimiter).filter((folder) => paths.isAbsolute(folder));
  const all = [...folders.map((folder) => paths.join(folder, name)), paths.join(extensionFolder, "bin", name)];
  return all.filter((program) => exists(program));
}

module.exports = { candidates };
