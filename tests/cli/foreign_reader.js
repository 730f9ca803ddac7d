#!/usr/bin/env node
'use strict';
/** foreign_reader.js: reads EDS and DCF files with npm's canopen. Standard input: a path a line; output: a JSON value a line, the
 * entries of the file by `INDEX:SUB` in hexadecimal, or null if canopen does not load it. */

const path = require('path');
const readline = require('readline');
const { Eds } = require(path.join(process.argv[2], 'node_modules', 'canopen'));

function read(file) {
  let eds;
  try {
    eds = Eds.fromFile(file);
  } catch {
    return null;
  }
  const entries = {};
  const add = (index, sub, one) => {
    const raw = one._raw ? Buffer.from(one._raw).toString('hex') : null;
    entries[`${index.toString(16)}:${sub.toString(16)}`] = [one.parameterName, one.dataType ?? null, one.accessType ?? null,
                                                            Boolean(one.pdoMapping), raw];
  };
  for (const object of eds.values()) {
    if (object._subObjects) {
      object._subObjects.forEach((one, sub) => { if (one && sub > 0) add(object.index, sub, one); });
    } else {
      add(object.index, 0, object);
    }
  }
  return entries;
}

readline.createInterface({ input: process.stdin }).on('line', (file) => console.log(JSON.stringify(read(file))));
