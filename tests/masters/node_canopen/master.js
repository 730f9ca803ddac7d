#!/usr/bin/env node
'use strict';
/** master.js ADDRESS EDS_DIR EXCEPTIONS NAME=NODE-ID...: node-canopen tests nodes, one after the other. */

const path = require('path');
const { Channel } = require('./socketcand');
const { Report, readExceptions } = require('./report');
const { Walk } = require('./walk');

async function main([address, sheets, table, ...nodes]) {
  const exceptions = readExceptions(table), channel = await Channel.open(address);
  channel.setMaxListeners(100);
  let failed = 0;
  for (const node of nodes) {
    const [name, nodeId] = node.split('='), begin = Date.now();
    const report = new Report(name, exceptions);
    await new Walk(channel, path.join(sheets, `${name.replaceAll('_', '-')}.eds`), Number(nodeId), report).run();
    console.log(`${report.summary()} (${((Date.now() - begin) / 1000).toFixed(1)} s)`);
    failed += report.failures();
  }
  channel.close();
  return failed ? 1 : 0;
}

main(process.argv.slice(2)).then((code) => { process.exitCode = code; }, (problem) => {
  console.error(problem);
  process.exitCode = 2;
});
