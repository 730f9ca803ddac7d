'use strict';

/** A CRC of 16 bits without reflection; the parameters are those of node-crc. */
function crc(width, reflectIn, polynomial, initial, initialXor, reflectOut, finalXor, unused, data) {
  if (width !== 16 || reflectIn || reflectOut) throw new RangeError('only plain CRCs of 16 bits');
  let value = initial;
  for (const byte of data) {
    value ^= byte << 8;
    for (let bit = 0; bit < 8; ++bit) value = (value & 0x8000 ? value << 1 ^ polynomial : value << 1) & 0xFFFF;
  }
  return Buffer.from([value >> 8, value & 0xFF]);
}

module.exports = { crc };
