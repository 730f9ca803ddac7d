// Prints the result of each SQL statement of a file: `node query.mjs FILE`.
import { readFileSync } from "node:fs";
import { DuckDBInstance } from "@duckdb/node-api";

const instance = await DuckDBInstance.create(":memory:");
const connection = await instance.connect();
for (const statement of readFileSync(process.argv[2], "utf8").split(";")) {
  if (statement.trim() === "") continue;
  const result = await connection.runAndReadAll(statement);
  for (const row of result.getRowObjectsJson()) console.log(JSON.stringify(row));
}
