'use strict';
/** A walk of node-canopen over one node: its own EDS reader, SDO client, NMT master, PDOs, SYNC and EMCY consumer. */

const { Device, DataType, Eds, SdoCode, rawToType, typeToRaw } = require('canopen');

const MASTER = 126, INVALID = 2 ** 31;
const PATIENCE = 120000, SHORT = 40;  // ms, for a frame that must be received and for one that must not
const UPLOAD = 600000;              // ms, for all segments of a long value, such as the EDS in 1021h
const SIZES = { [DataType.INTEGER8]: 1, [DataType.INTEGER16]: 2, [DataType.INTEGER32]: 4, [DataType.UNSIGNED8]: 1,
  [DataType.UNSIGNED16]: 2, [DataType.UNSIGNED32]: 4 };
const SIGNED = [DataType.INTEGER8, DataType.INTEGER16, DataType.INTEGER32];
const HARMLESS = { 0x6040: 6, 0x6060: 1, 0x6098: 17 };  // values that do not move a drive, and that drives accept
const STATE = { preOperational: 0x7F, operational: 5, stopped: 4, bootUp: 0 };

const hex = (value, digits) => value.toString(16).toUpperCase().padStart(digits, '0');
const bytes = (data) => [...data].map((byte) => hex(byte, 2)).join(' ');

class Walk {
  constructor(channel, sheet, nodeId, report) {
    Object.assign(this, { channel, nodeId, report });
    this.sheet = Eds.fromFile(sheet);
    this.device = new Device({ id: MASTER });
    const eds = this.device.eds;
    eds.addSdoClientParameter(nodeId, 0x600 + nodeId, 0x580 + nodeId);
    eds.addEmcyConsumer(0x80 + nodeId);
    eds.addHeartbeatConsumer(nodeId, 500);
    eds.setSyncCobId(0x80);
    eds.setSyncGenerationEnable(true);
    this.send = (message) => channel.send(message);
    this.receive = (message) => this.device.receive(message);
    this.device.on('message', this.send);
    channel.on('message', this.receive);
    this.device.start();
    this.device.nmt.setState(STATE.operational);
  }

  async run() {
    for (const part of [this.uploadAll, this.downloadAll, this.states, this.pdos, this.emergencies, this.heartbeats]) {
      try {
        await this.reset();
        await part.call(this);
      } catch (problem) {
        this.report.check('walk', part.name, problem.message, 'its end');
      }
    }
    this.channel.off('message', this.receive);
    this.device.stop();
  }

  // ---- used by all parts ----

  /** Resolves to `pick` of the next event of an emitter, or to "nothing" after this time. Call it before the event. */
  event(emitter, name, pick, milliseconds = PATIENCE) {
    return new Promise((resolve) => {
      const end = (value) => {
        clearTimeout(timer);
        emitter.off(name, listener);
        resolve(value);
      };
      const listener = (event) => {
        const picked = pick(event);
        if (picked !== undefined) end(picked);
      };
      const timer = setTimeout(end, milliseconds, 'nothing');
      emitter.on(name, listener);
    });
  }

  state(wanted) {
    return this.event(this.device.nmt, 'heartbeat',
      ({ deviceId, state }) => deviceId === this.nodeId && state === wanted ? state : undefined);
  }

  frame(canId, milliseconds = PATIENCE) {
    return this.event(this.channel, 'message', ({ id, data }) => id === canId ? bytes(data) : undefined, milliseconds);
  }

  emcy() {
    return this.event(this.device.emcy, 'emergency',
      ({ cobId, em }) => cobId === 0x80 + this.nodeId ? `${hex(em.code, 4)}h ${bytes(em.info)}` : undefined);
  }

  async reset() {
    const bootUp = this.event(this.channel, 'message',
      ({ id, data }) => id === 0x700 + this.nodeId && data[0] === STATE.bootUp ? bytes(data) : undefined);
    this.device.nmt.resetNode(this.nodeId);
    this.report.check('boot-up', 'reset', await bootUp, '00');
  }

  upload(index, subIndex) { return this.device.sdo.upload({ deviceId: this.nodeId, index, subIndex, timeout: UPLOAD }); }

  download(index, subIndex, data) {
    return this.device.sdo.download({ deviceId: this.nodeId, index, subIndex, data, timeout: PATIENCE });
  }

  async read(index, subIndex, dataType) { return rawToType(await this.upload(index, subIndex), dataType); }

  write(index, subIndex, value, dataType) { return this.download(index, subIndex, typeToRaw(value, dataType)); }

  /** The result of an SDO transfer. */
  async outcome(transfer) {
    try {
      const data = await transfer;
      return data === undefined ? 'taken' : `reads ${bytes(data)}`;
    } catch (problem) {
      if (problem.code === undefined) throw problem;
      return problem.code === SdoCode.TIMEOUT ? 'no answer' : `abort ${hex(problem.code, 8)}`;
    }
  }

  // ---- the object dictionary ----

  /** All entries of the EDS: index, sub-index, and the DataObject with the rest. */
  * entries() {
    for (const object of this.sheet.values()) {
      if (object.subNumber === undefined) {
        yield { index: object.index, sub: 0, object };
      } else {
        for (let sub = 0; sub < 255; ++sub) {
          if (object.at(sub) && object.at(sub).accessType) yield { index: object.index, sub, object: object.at(sub) };
        }
      }
    }
  }

  /** The default as bytes; node-ID formulas, which node-canopen does not support, are computed here. */
  defaultOf({ dataType, defaultValue }) {
    if (defaultValue === undefined || defaultValue === '') return undefined;
    if (!(dataType in SIZES)) return Buffer.from(defaultValue);
    const formula = defaultValue.toUpperCase().includes('$NODEID');
    const rest = defaultValue.toUpperCase().replace('$NODEID', '').replace('+', '').trim();
    const value = (formula ? this.nodeId : 0) + (rest ? Number(rest.replace('0X', '0x')) : 0);
    const data = Buffer.alloc(8);
    data.writeBigInt64LE(BigInt(value));
    return data.subarray(0, SIZES[dataType]);
  }

  async uploadAll() {
    for (const { index, sub, object } of this.entries()) {
      const name = `${hex(index, 4)}h:${hex(sub, 2)}`;
      const readable = object.accessType !== 'wo';
      const check = readable ? 'default' : 'write-only';
      if (this.report.skips(name, check)) continue;
      let got = await this.outcome(this.upload(index, sub));
      if (!readable) {
        this.report.check(check, name, got, 'abort 06010001');
        continue;
      }
      const wanted = this.defaultOf(object), size = SIZES[object.dataType];
      // An answer without a size has four bytes here: the EDS defines how many are valid.
      if (size && got.startsWith('reads') && got.length > 5 + 3 * size) got = got.slice(0, 5 + 3 * size);
      this.report.check(check, name, got, wanted ? `reads ${bytes(wanted)}` : got.startsWith('reads') ? got : 'reads a value');
    }
  }

  async downloadAll() {
    for (const { index, sub, object } of this.entries()) {
      const name = `${hex(index, 4)}h:${hex(sub, 2)}`, size = SIZES[object.dataType];
      const number = (value) => {
        const data = Buffer.alloc(8);
        data.writeBigInt64LE(BigInt(value));
        return data.subarray(0, size);
      };
      const trials = [];
      if (['ro', 'const'].includes(object.accessType) || !size) {
        trials.push(['read-only', Buffer.alloc(size || 1), 'abort 06010002']);
      } else {
        const { lowLimit: low, highLimit: high } = object;
        const start = this.defaultOf(object) || number(low || high || 0);
        const isSigned = SIGNED.includes(object.dataType), bits = 8 * size - (isSigned ? 1 : 0);
        if (low !== undefined) trials.push(['low', number(low), 'taken']);
        if (low > (isSigned ? -(2 ** bits) : 0)) trials.push(['below', number(low - 1), 'abort 06090032']);
        if (high !== undefined) trials.push(['high', number(high), 'taken']);
        if (high < 2 ** bits - 1) trials.push(['above', number(high + 1), 'abort 06090031']);
        trials.push(['long', Buffer.concat([start, Buffer.alloc(1)]), 'abort 06070012']);
        if (size > 1) trials.push(['short', start.subarray(0, size - 1), 'abort 06070013']);
        trials.push(['restore', start, 'taken']);
      }
      for (const [check, data, wanted] of trials) {
        if (this.report.skips(name, check)) continue;
        let got = await this.outcome(this.download(index, sub, data));
        if (got === 'taken' && object.accessType !== 'wo') {
          const back = (await this.upload(index, sub)).subarray(0, size);
          if (!back.equals(data)) got = `taken, reads ${bytes(back)}`;
        }
        this.report.check(check, name, got, wanted);
      }
    }
  }

  // ---- NMT, PDOs, EMCY, error control ----

  async states() {
    const nmt = this.device.nmt;
    await this.write(0x1017, 0, 10, DataType.UNSIGNED16);
    for (const [name, command] of [['operational', 'startNode'], ['stopped', 'stopNode'],
      ['preOperational', 'enterPreOperational'], ['stopped', 'stopNode'], ['operational', 'startNode']]) {
      const told = this.state(STATE[name]);
      nmt[command](this.nodeId);
      this.report.check('nmt', name, await told, STATE[name]);
      const answer = this.frame(0x580 + this.nodeId, name === 'stopped' ? SHORT : PATIENCE);
      this.channel.send({ id: 0x600 + this.nodeId, data: Buffer.from([0x40, 0, 0x10, 0, 0, 0, 0, 0]) });
      this.report.check('nmt', `SDO in ${name}`, await answer !== 'nothing', name !== 'stopped');
    }
    const bootUp = this.state(STATE.bootUp);
    nmt.resetCommunication(this.nodeId);
    this.report.check('nmt', 'reset communication', await bootUp, STATE.bootUp);
    const silent = this.event(nmt, 'timeout', (deviceId) => deviceId === this.nodeId ? 'silent' : undefined);
    this.report.check('nmt', 'heartbeat time after it', await silent, 'silent');
  }

  async mapping(communication) {
    const entries = [];
    for (let sub = 1; sub <= await this.read(communication + 0x200, 0, DataType.UNSIGNED8); ++sub) {
      const value = await this.read(communication + 0x200, sub, DataType.UNSIGNED32);
      const [index, subIndex] = [value >>> 16, value >>> 8 & 0xFF], object = this.sheet.getEntry(index);
      if (!object) return [];  // a dummy
      const { dataType } = object.subNumber === undefined ? object : object.at(subIndex);
      entries.push({ index, subIndex, dataType, name: `${hex(index, 4)}h:${hex(subIndex, 2)}` });
    }
    return entries;
  }

  async pdos() {
    for (const object of this.sheet.values()) {
      const transmit = object.index >= 0x1800 && object.index < 0x1A00;
      if (!transmit && !(object.index >= 0x1400 && object.index < 0x1600)) continue;
      const cobId = await this.read(object.index, 1, DataType.UNSIGNED32);
      const entries = await this.mapping(object.index), name = `${hex(object.index, 4)}h:01`;
      if (cobId >= INVALID || entries.length === 0 || this.report.skips(name, transmit ? 'tpdo' : 'rpdo')) continue;
      const canId = cobId & 0x7FF;
      if (transmit) await this.tpdo(object, name, cobId, canId, entries);
      else await this.rpdo(name, canId, entries);
    }
  }

  /** Type 1: the TPDO follows each SYNC of node-canopen, with the values that SDO reads in the mapped objects. */
  async tpdo(object, name, cobId, canId, entries) {
    if (object.at(2).accessType !== 'rw') return;
    const id = [object.index, 1];
    await this.write(...id, cobId + INVALID, DataType.UNSIGNED32);
    await this.write(object.index, 2, 1, DataType.UNSIGNED8);
    await this.write(...id, cobId, DataType.UNSIGNED32);
    this.device.nmt.startNode(this.nodeId);
    await this.upload(0x1000, 0);  // it has entered the state by now
    const frame = this.frame(canId);
    this.device.sync.write();
    const parts = [];
    const got = await frame;
    for (const { index, subIndex, dataType } of entries) {
      parts.push(bytes((await this.upload(index, subIndex)).subarray(0, SIZES[dataType])));
    }
    this.report.check('tpdo', name, got.split(' ').length, parts.join(' ').split(' ').length);
    if (!entries.some((entry) => this.report.skips(entry.name, 'tpdo-value'))) {
      entries.forEach((entry, i) => {
        const at = parts.slice(0, i).join(' ').length + (i > 0);
        this.report.check('tpdo-value', entry.name, got.slice(at, at + parts[i].length), parts[i]);
      });
    }
    await this.reset();
  }

  /** node-canopen sends its own objects in a TPDO to the node's RPDO. */
  async rpdo(name, canId, entries) {
    const values = [];
    const eds = this.device.eds;
    const dataObjects = entries.map(({ index, subIndex, dataType }, i) => {
      const object = this.sheet.getEntry(index), { highLimit, lowLimit } =
        object.subNumber === undefined ? object : object.at(subIndex);
      values.push(HARMLESS[index] ?? Math.max(lowLimit ?? 0, Math.min(highLimit ?? 0x35, 0x35)));
      const entry = eds.addEntry(0x2000 + i, { parameterName: `RPDO ${canId} ${i}`, dataType });
      entry.value = values[i];
      return entry;
    });
    eds.addTransmitPdo({ cobId: canId, transmissionType: 254, eventTime: 0, dataObjects });
    this.device.nmt.startNode(this.nodeId);
    this.device.pdo.write(canId);
    for (const [i, { index, subIndex, dataType, name: entry }] of entries.entries()) {
      this.report.check('rpdo-value', entry, await this.read(index, subIndex, dataType), values[i]);
    }
    eds.removeTransmitPdo(canId);
    dataObjects.forEach((_, i) => eds.removeEntry(0x2000 + i));
    await this.reset();
  }

  async emergencies() {
    for (const object of this.sheet.values()) {
      if (object.index < 0x1400 || object.index >= 0x1600) continue;
      const cobId = await this.read(object.index, 1, DataType.UNSIGNED32), entries = await this.mapping(object.index);
      const size = entries.reduce((sum, { dataType }) => sum + SIZES[dataType], 0);
      if (cobId >= INVALID || size === 0) continue;
      this.device.nmt.startNode(this.nodeId);
      const raised = this.emcy();
      this.channel.send({ id: cobId & 0x7FF, data: Buffer.alloc(size - 1) });
      this.checkEmcy(await raised, '8210');
      this.report.check('emcy', '1001h', await this.read(0x1001, 0, DataType.UNSIGNED8), 0x11);
      return;
    }
  }

  checkEmcy(got, code) {
    this.report.check('emcy', `${code}h:00`, got.slice(0, 5), `${code}h`);
    this.report.check('emcy-info', `${code}h:00`, got.slice(6), '00 00 00 00 00');
  }

  /** The node watches node-canopen's heartbeat, which starts and ends. */
  async heartbeats() {
    const consumer = this.sheet.getEntry(0x1016);
    if (!consumer || consumer.at(1).accessType !== 'rw') return;
    await this.write(0x1016, 1, MASTER * 0x10000 + 100, DataType.UNSIGNED32);
    const lost = this.emcy();
    this.device.eds.setHeartbeatProducerTime(30);
    setTimeout(() => this.device.eds.setHeartbeatProducerTime(0), 100);
    this.checkEmcy(await lost, '8130');
  }
}

module.exports = { Walk };
