#!/usr/bin/env node
'use strict';
/** slave.js ADDRESS NODE-ID [EDS]: npm's canopen as a slave, its SDO server, NMT state machine and heartbeat, with 2000h and
 * 2001h, or with the objects of the EDS. What it does not have is a boot-up message. A request that ends it starts it again. */

const { Device, Eds, ObjectType, DataType, AccessType } = require('canopen');
const { Channel } = require('./socketcand');

function dictionary() {
  const eds = new Eds();
  const entry = (index, parameterName, dataType, defaultValue) => eds.addEntry(index, {
    parameterName, objectType: ObjectType.VAR, dataType, accessType: AccessType.READ_WRITE, defaultValue });
  entry(0x1017, 'Producer heartbeat time', DataType.UNSIGNED16, 0);  // setHeartbeatProducerTime makes an UNSIGNED32 of it
  entry(0x2000, 'Number', DataType.UNSIGNED16, 0);
  entry(0x2001, 'Longer value', DataType.VISIBLE_STRING, '');
  return eds;
}

async function main([address, nodeIdText, file]) {
  const nodeId = Number(nodeIdText), channel = await Channel.open(address);
  let device;
  const start = () => {
    const eds = file ? Eds.fromFile(file) : dictionary();
    eds.addSdoServerParameter(0, 0x580 + nodeId, 0x600 + nodeId);
    device = new Device({ id: nodeId, eds });
    device.on('message', (message) => channel.send(message));
    device.start();
  };
  start();
  channel.on('message', (message) => device.receive(message));
  process.on('uncaughtException', (problem) => {
    console.log(`crashed: ${problem.message}`);
    start();
  });
  console.log('started');
}

main(process.argv.slice(2)).catch((problem) => {
  console.error(problem);
  process.exitCode = 2;
});
