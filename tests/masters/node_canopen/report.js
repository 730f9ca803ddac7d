'use strict';
/** The checks of a walk, with the exceptions of exceptions.tsv, like report.py. */

const fs = require('fs');

const SKIP = 'skip', ANY = 'any';

function readExceptions(path) {
  return fs.readFileSync(path, 'utf-8').split('\n').flatMap((text, i) => {
    if (!text || text.startsWith('#')) return [];
    const [device, entries, checks, outcome] = text.split('\t');
    const devices = device.split(',').map((one) => new RegExp(`^${one.replaceAll('*', '.*')}$`));
    return [{ line: i + 1, devices, entries: entries.split(',').map(pattern), checks: checks.split(','), outcome }];
  });
}

/** "1400h-15FFh:01", "1003h:01-10" or "6040h:*". */
function pattern(text) {
  const [, first, last, low, high] = /^([0-9A-F]{4})h(?:-([0-9A-F]{4})h)?:(?:\*|([0-9A-F]{2})(?:-([0-9A-F]{2}))?)$/.exec(text);
  const number = (digits, otherwise) => digits ? parseInt(digits, 16) : otherwise;
  return { first: number(first), last: number(last, number(first)), low: number(low, 0), high: number(high, number(low, 255)) };
}

function covers(row, device, entry, check) {
  const place = /^([0-9A-F]{4})h:([0-9A-F]{2})$/.exec(entry);
  if (!place || !row.checks.includes(check) || !row.devices.some((one) => one.test(device))) return false;
  const [index, sub] = [parseInt(place[1], 16), parseInt(place[2], 16)];
  return row.entries.some((one) => one.first <= index && index <= one.last && one.low <= sub && sub <= one.high);
}

class Report {
  constructor(device, exceptions) {
    Object.assign(this, { device, exceptions, passed: {}, failed: {}, excepted: 0 });
  }

  exception(entry, check) { return this.exceptions.find((row) => covers(row, this.device, entry, check)); }

  skips(entry, check) {
    const row = this.exception(entry, check);
    if (!row || row.outcome !== SKIP) return false;
    ++this.excepted;
    return true;
  }

  check(check, entry, got, wanted) {
    [got, wanted] = [String(got), String(wanted)];
    const row = this.exception(entry, check);
    if (row && got !== wanted) ++this.excepted;
    const good = row && row.outcome !== wanted ? row.outcome === ANY || row.outcome === got : got === wanted;
    const counts = good ? this.passed : this.failed;
    counts[check] = (counts[check] || 0) + 1;
    if (!good) console.log(`${this.device}: ${check} ${entry}: ${got}, wanted ${row ? row.outcome : wanted}`);
    return good;
  }

  failures() { return Object.values(this.failed).reduce((sum, one) => sum + one, 0); }

  summary() {
    const ok = Object.values(this.passed).reduce((sum, one) => sum + one, 0);
    const kinds = Object.keys({ ...this.passed, ...this.failed }).sort();
    const parts = kinds.map((kind) => `${kind} ${this.passed[kind] || 0}` +
      (this.failed[kind] ? ` (${this.failed[kind]} FAILED)` : ''));
    return `${this.device}: ${ok} checks ok, ${this.failures()} failed, ${this.excepted} by exception: ${parts.join(', ')}`;
  }
}

module.exports = { Report, readExceptions };
