#!/usr/bin/env node
'use strict';
/** slave.js ADDRESS NODE_ID SHEET [BEHAVIOUR]: a small slave on a bus of `edsc bus`, with the standard library of Node.js alone:
 * expedited and segmented SDO, NMT, boot-up and heartbeat, and the objects of an EDS. BEHAVIOURS are differences from a slave
 * without a fault. */

const fs = require('fs');
const net = require('net');

const BEHAVIOURS = {
  good: {},
  'good-12': {},
  'ends-at-reset': { endsAtReset: true },
  'starts-by-itself': { startsByItself: true },
  late: { answerDelay: 700 },           // ms
  'empty-text': { emptyText: true },
  vanishes: { vanishesAfter: 40 },      // SDO requests
  'wrong-code': { codeOfSubIndex: 0x06020000 },
};

const OPERATIONAL = 5, PRE_OPERATIONAL = 127, STOPPED = 4;
const STATES = { 1: OPERATIONAL, 2: STOPPED, 128: PRE_OPERATIONAL };
const RESETS = [129, 130];
const HEARTBEAT = '1017.0', STRING = 9;
const EXTENDED_DIGITS = 8;  // of a CAN-ID with 29 bits
const SIZES = { 1: 1, 2: 1, 3: 2, 4: 4, 5: 1, 6: 2, 7: 4 };  // bytes by data type
const TOGGLE_BIT = 0x05030000, COMMAND = 0x05040001, READ_ONLY = 0x06010002, NO_OBJECT = 0x06020000, LENGTH = 0x06070010,
  NO_SUB_INDEX = 0x06090011;

/** The client's side of the protocol socketcand: one bus. */
class Bus {
  constructor(address, received, opened) {
    const [, host, port, bus] = /^socketcand:([^/]+):(\d+)\/(\w+)$/.exec(address);
    this.steps = [`< open ${bus} >`, '< rawmode >'];
    this.received = received;
    this.opened = opened;
    this.text = '';
    this.socket = net.connect(Number(port), host);
    this.socket.setNoDelay(true);
    this.socket.setEncoding('latin1');
    this.socket.on('data', (piece) => this.take(piece));
    this.socket.on('close', () => process.exit(0));
  }

  take(piece) {
    const elements = (this.text + piece).split('>');
    this.text = elements.pop();
    for (const element of elements) {
      const [word, id, , ...data] = element.replace('<', '').trim().split(/ +/);
      const isExtended = id && id.length === EXTENDED_DIGITS;
      if (word === 'frame' && !isExtended) this.received(parseInt(id, 16), Buffer.from(data.join(''), 'hex'));
      else if (word === 'frame' || word === 'rtr') continue;
      else if (this.steps.length > 0) this.socket.write(this.steps.shift());
      else if (word === 'ok') this.opened();
    }
  }

  send(id, data) {
    const bytes = [...data].map((byte) => ` ${byte.toString(16)}`).join('');
    this.socket.write(`< send ${id.toString(16)} ${data.length}${bytes} >`);
  }
}

/** Returns the entries of an EDS by `INDEX.SUB`: their data type, whether they are writable, and their default values. */
function entriesOf(sheet) {
  const entries = {};
  for (const section of fs.readFileSync(sheet, 'utf8').split(/^\[/m)) {
    const name = /^([0-9A-F]{4})(?:sub([0-9A-F]+))?\]/i.exec(section);
    const keys = Object.fromEntries([...section.matchAll(/^(\w+)=(.*?)\s*$/gm)].map(([, key, value]) => [key, value]));
    if (!name || !keys.DataType) continue;
    const type = Number(keys.DataType), value = keys.DefaultValue || '';
    const bytes = Buffer.alloc(SIZES[type] || 0);
    if (type !== STRING) bytes.writeUIntLE(Number(value), 0, bytes.length);
    entries[`${name[1].toUpperCase()}.${parseInt(name[2] || '0', 16)}`] =
      { type, writable: keys.AccessType === 'rw', value: type === STRING ? Buffer.from(value) : bytes };
  }
  return entries;
}

class Abort extends Error {
  constructor(code) {
    super();
    this.code = code;
  }
}

class Slave {
  constructor(nodeId, sheet, behaviour, send) {
    Object.assign(this, { nodeId, sheet, behaviour, send, requests: 0 });
  }

  reset() {
    this.entries = entriesOf(this.sheet);
    if (this.behaviour.emptyText) this.entries['2001.0'].value = Buffer.alloc(0);
    this.transfer = null;
    this.startHeartbeat();
    this.send(0x700 + this.nodeId, Buffer.from([0]));
    this.state = this.behaviour.startsByItself ? OPERATIONAL : PRE_OPERATIONAL;
  }

  startHeartbeat() {
    clearTimeout(this.timer);
    const period = this.entries[HEARTBEAT].value.readUInt16LE();
    const beat = (at) => {
      this.timer = setTimeout(() => {
        this.send(0x700 + this.nodeId, Buffer.from([this.state]));
        beat(at + period);  // a late heartbeat does not delay those after it
      }, Math.max(0, at - performance.now()));
    };
    if (period > 0) beat(performance.now() + period);
  }

  receive(id, data) {
    if (id === 0 && data.length === 2 && [0, this.nodeId].includes(data[1])) this.command(data[0]);
    if (id === 0x600 + this.nodeId && data.length === 8 && this.state !== STOPPED) this.request(data);
  }

  command(command) {
    if (RESETS.includes(command) && this.behaviour.endsAtReset) process.exit(0);
    if (RESETS.includes(command)) this.reset();
    else this.state = STATES[command] || this.state;
  }

  // ---- SDO server ----

  request(data) {
    this.requests += 1;
    if (this.requests > this.behaviour.vanishesAfter) process.exit(0);
    let response;
    try {
      response = this.respond(data);
    } catch (abort) {
      if (!(abort instanceof Abort)) throw abort;
      response = Buffer.alloc(8, 0);
      (this.transfer ? this.transfer.mux : data.subarray(1, 4)).copy(response, 1);
      response[0] = 0x80;
      response.writeUInt32LE(abort.code, 4);
      this.transfer = null;
    }
    if (response) setTimeout(() => this.send(0x580 + this.nodeId, response), this.behaviour.answerDelay || 0);
  }

  respond(data) {
    switch (data[0] >> 5) {
      case 0: return this.downloadSegment(data);
      case 1: return this.download(data);
      case 2: return this.upload(data);
      case 3: return this.uploadSegment(data);
      case 4: this.transfer = null; return null;
      default: throw new Abort(COMMAND);
    }
  }

  find(data) {
    const index = data.readUInt16LE(1).toString(16).toUpperCase().padStart(4, '0');
    const entry = this.entries[`${index}.${data[3]}`];
    if (entry) return entry;
    const hasObject = Object.keys(this.entries).some((key) => key.startsWith(`${index}.`));
    throw new Abort(hasObject ? this.behaviour.codeOfSubIndex || NO_SUB_INDEX : NO_OBJECT);
  }

  upload(data) {
    this.transfer = null;
    const { value } = this.find(data), response = Buffer.alloc(8, 0);
    data.copy(response, 1, 1, 4);
    const expedited = value.length >= 1 && value.length <= 4;
    response[0] = expedited ? 0x43 | (4 - value.length) << 2 : 0x41;
    if (expedited) value.copy(response, 4);
    else response.writeUInt32LE(value.length, 4);
    if (!expedited) this.transfer = { kind: 'upload', mux: data.subarray(1, 4), value, toggle: 0 };
    return response;
  }

  download(data) {
    this.transfer = null;
    const entry = this.find(data), expedited = data[0] & 2;
    if (!entry.writable) throw new Abort(READ_ONLY);
    if (expedited) this.write(entry, data.subarray(4, data[0] & 1 ? 8 - (data[0] >> 2 & 3) : 8));
    else this.transfer = { kind: 'download', mux: data.subarray(1, 4), entry, value: Buffer.alloc(0), toggle: 0 };
    return Buffer.from([0x60, ...data.subarray(1, 4), 0, 0, 0, 0]);
  }

  write(entry, value) {
    if (entry.type !== STRING && value.length !== SIZES[entry.type]) throw new Abort(LENGTH);
    entry.value = Buffer.from(value);
    if (entry === this.entries[HEARTBEAT]) this.startHeartbeat();
  }

  /** Returns the transfer that a segment belongs to, and changes its toggle bit. */
  segmentOf(kind, data) {
    if (!this.transfer || this.transfer.kind !== kind) throw new Abort(COMMAND);
    if ((data[0] >> 4 & 1) !== this.transfer.toggle) throw new Abort(TOGGLE_BIT);
    this.transfer.toggle ^= 1;
    return this.transfer;
  }

  uploadSegment(data) {
    const transfer = this.segmentOf('upload', data), piece = transfer.value.subarray(0, 7), response = Buffer.alloc(8, 0);
    transfer.value = transfer.value.subarray(7);
    const last = transfer.value.length === 0;
    piece.copy(response, 1);
    response[0] = (data[0] & 0x10) | (7 - piece.length) << 1 | (last ? 1 : 0);
    if (last) this.transfer = null;
    return response;
  }

  downloadSegment(data) {
    const transfer = this.segmentOf('download', data);
    transfer.value = Buffer.concat([transfer.value, data.subarray(1, 8 - (data[0] >> 1 & 7))]);
    if (data[0] & 1) {
      this.write(transfer.entry, transfer.value);
      this.transfer = null;
    }
    return Buffer.from([0x20 | (data[0] & 0x10), 0, 0, 0, 0, 0, 0, 0]);
  }
}

function main([address, nodeId, sheet, name = 'good']) {
  const behaviour = BEHAVIOURS[name];
  if (!behaviour) throw new Error(`no behaviour ${name}`);
  const bus = new Bus(address, (id, data) => slave.receive(id, data), () => {
    slave.reset();
    console.log('started');
  });
  const slave = new Slave(Number(nodeId), sheet, behaviour, (id, data) => bus.send(id, data));
}

main(process.argv.slice(2));
