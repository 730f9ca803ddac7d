// Prints the messages of DBC files as JSON, by file; fails if candied reports an error.
"use strict";

const fs = require("fs");
const { Dbc } = require("candied");

const files = {};
for (const path of process.argv.slice(2)) {
  const dbc = new Dbc();
  const data = dbc.load(fs.readFileSync(path, "latin1"));
  if (dbc.errors.size !== 0) throw new Error(`${path}: ${JSON.stringify([...dbc.errors])}`);
  files[path] = [...data.messages.values()];
}
process.stdout.write(JSON.stringify(files, (_, value) => (value instanceof Map ? Object.fromEntries(value) : value)));
