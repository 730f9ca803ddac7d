'use strict';
/** A socketcand server as the channel of node-canopen: `send({ id, data })`, and 'message' with received frames. */

const { EventEmitter } = require('events');
const net = require('net');

class Channel extends EventEmitter {
  /** Resolves in the raw mode. `address`: socketcand:127.0.0.1:29536/vcan0 */
  static async open(address) {
    const [, host, port, bus] = /^socketcand:([^/]+):(\d+)\/(\w+)$/.exec(address);
    const channel = new Channel();
    channel.socket = net.connect(Number(port), host);
    channel.socket.setNoDelay(true);
    channel.socket.setEncoding('latin1');
    channel.text = '';
    channel.socket.on('data', (piece) => channel.take(piece));
    channel.socket.on('error', (problem) => { throw problem; });
    for (const [answer, next] of [['hi', `< open ${bus} >`], ['ok', '< rawmode >'], ['ok', '']]) {
      const [said] = await new Promise((resolve) => channel.once('element', (...words) => resolve(words)));
      if (said !== answer) throw new Error(`${address}: ${said} instead of ${answer}`);
      if (next) channel.socket.write(next);
    }
    return channel;
  }

  take(piece) {
    this.text += piece;
    let end;
    while ((end = this.text.indexOf('>')) >= 0) {
      const words = this.text.slice(this.text.indexOf('<') + 1, end).trim().split(/ +/);
      this.text = this.text.slice(end + 1);
      this.emit('element', ...words);
      if (words[0] === 'frame') {
        this.emit('message', { id: parseInt(words[1], 16), data: Buffer.from(words.slice(3).join(''), 'hex') });
      }
    }
  }

  send({ id, data }) {
    const bytes = [...data].map((byte) => byte.toString(16)).join(' ');
    this.socket.write(`< send ${id.toString(16)} ${data.length} ${bytes} >`);
  }

  /** Sends a remote frame, which node-canopen does not support. */
  request(id, size) { this.socket.write(`< sendrtr ${id.toString(16)} ${size} >`); }

  close() { this.socket.end(); }
}

module.exports = { Channel };
