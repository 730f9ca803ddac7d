#!/usr/bin/env node
'use strict';
/** slave.js ADDRESS NODE-ID: npm's canopen as a slave, its SDO server, NMT state machine and heartbeat, with 2000h and 2001h.
 * What it does not have is a boot-up message. */

const { Device, Eds, ObjectType, DataType, AccessType } = require('canopen');
const { Channel } = require('./socketcand');

async function main([address, nodeIdText]) {
  const nodeId = Number(nodeIdText), channel = await Channel.open(address), eds = new Eds();
  eds.addSdoServerParameter(0, 0x580 + nodeId, 0x600 + nodeId);
  const entry = (index, parameterName, dataType, defaultValue) => eds.addEntry(index, {
    parameterName, objectType: ObjectType.VAR, dataType, accessType: AccessType.READ_WRITE, defaultValue });
  entry(0x1017, 'Producer heartbeat time', DataType.UNSIGNED16, 0);  // setHeartbeatProducerTime makes an UNSIGNED32 of it
  entry(0x2000, 'Number', DataType.UNSIGNED16, 0);
  entry(0x2001, 'Longer value', DataType.VISIBLE_STRING, '');
  const device = new Device({ id: nodeId, eds });
  device.on('message', (message) => channel.send(message));
  channel.on('message', (message) => device.receive(message));
  device.start();
  console.log('started');
}

main(process.argv.slice(2)).catch((problem) => {
  console.error(problem);
  process.exitCode = 2;
});
