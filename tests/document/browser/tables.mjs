// tables.mjs FILE: the tables of a Markdown file as JSON, each with the heading before it.
import { marked } from 'marked';
import { readFileSync } from 'node:fs';

let heading = '';
const tables = [];
const plain = (cell) => marked.parseInline(cell.text);
for (const token of marked.lexer(readFileSync(process.argv[2], 'utf8'))) {
  if (token.type === 'heading') heading = marked.parseInline(token.text);
  if (token.type === 'table') {
    tables.push({ heading, header: token.header.map(plain), rows: token.rows.map((row) => row.map(plain)) });
  }
}
console.log(JSON.stringify(tables));
