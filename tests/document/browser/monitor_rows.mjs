// monitor_rows.mjs CHROMIUM URL: the page of edsc monitor --web with rows that it gets from here in place of the bus, as JSON.
import { inScheme, watch, withPage } from './browser.mjs';

const [chromium, url] = process.argv.slice(2);

// Before the page: events that this script sends.
function replaceEvents() {
  globalThis.EventSource = class extends EventTarget {
    constructor() {
      super();
      globalThis.send = (rows) => this.dispatchEvent(new MessageEvent('message', { data: JSON.stringify({ rows }) }));
      globalThis.lose = (readyState) => {
        this.readyState = readyState;
        this.dispatchEvent(new Event('error'));
      };
      globalThis.connections = (globalThis.connections ?? 0) + 1;
    }
  };
  globalThis.EventSource.CLOSED = 2;
}

const value = (sub, name, text, number) => ({ index: 0x2000, sub_index: sub, name, text, unit: '', number });
const pdo = (at, perSecond, values, text = '') => ({
  kind: 'pdo', node_id: 5, pdo: 'TPDO 1', at_us: at * 1e6, per_second: perSecond, text, values });
const bus = (at) => ({ kind: 'bus', at_us: at * 1e6, frames: 1, per_second: 1, load_percent: null });

const exported = (page) => page.evaluate(() => {
  URL.createObjectURL = (blob) => {
    globalThis.exported = blob.text();
    return 'data:,';
  };
  document.getElementById('export').click();
  return globalThis.exported;
});

async function use(page) {
  const found = { seen: watch(page), csv: {} };
  const send = (...rows) => page.evaluate((all) => globalThis.send(all), rows);
  const show = (...rows) => page.evaluate((all) => {
    globalThis.send(all);
    return new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  }, rows);
  const texts = () => page.$$eval('#value-rows tr', (rows) => rows.map((row) => row.cells[6].textContent));
  const plots = () => page.$$eval('.plot h3', (all) => all.map((one) => one.textContent));
  const connectionAfter = (...rows) => page.evaluate((all) => {
    globalThis.send(all);
    const one = document.getElementById('connection');
    return [one.className, one.textContent];
  }, rows);
  await page.evaluateOnNewDocument(replaceEvents);
  await page.goto(url, { waitUntil: 'load' });

  found.connected = await connectionAfter(bus(0));
  await show(bus(1), pdo(1, 2, [value(1, '=real', 'nan', null), value(2, 'count', '7', 7)]));
  await show(bus(2), pdo(1, 1, [value(1, '=real', 'nan', null), value(2, 'count', '7', 7)]));
  found.csv.sameFrame = await exported(page);
  await show(bus(3), pdo(3, 1, [value(1, '=real', '1.5', 1.5), value(2, 'count', '8', 8)]));
  found.csv.afterNan = await exported(page);

  for (const box of await page.$$('#value-rows input')) await box.click();
  await show(bus(4), pdo(4, 1, [value(1, '=real', '2.5', 2.5)], 'too short: 4 of 5 bytes'));
  found.short = { texts: await texts(), plots: await plots() };
  await show(bus(5), pdo(5, 1, [], 'too short: 0 of 5 bytes'));
  found.empty = { texts: await texts(), plots: await plots() };
  await show(bus(6), pdo(6, 1, [value(1, '=real', '3.5', 3.5), value(2, 'count', '9', 9)]));
  found.whole = { texts: await texts(), plots: await plots() };
  found.csv.afterShort = await exported(page);

  await show(bus(7), pdo(7, 1, [value(1, '=real', '3.5', 3.5), value(3, 'other', '-9223372036854775808', -(2 ** 63))]));
  found.mappedAnew = { texts: await texts(), plots: await plots() };
  await page.click('#value-rows tr:last-child input');
  // The width beside the axis of the last plot, and whether its one point is drawn.
  found.wide = await page.evaluate(() => document.querySelector('.plot:last-child .u-over').offsetLeft);
  found.drawn = await page.evaluate(() => {
    const canvas = document.querySelector('.plot:last-child canvas');
    const over = document.querySelector('.plot:last-child .u-over');
    const color = getComputedStyle(document.documentElement).getPropertyValue('--field-line').trim();
    const sample = document.createElement('canvas').getContext('2d');
    sample.fillStyle = color;
    sample.fillRect(0, 0, 1, 1);
    const wanted = [...sample.getImageData(0, 0, 1, 1).data];
    const { data } = canvas.getContext('2d').getImageData(over.offsetLeft, over.offsetTop, over.offsetWidth, over.offsetHeight);
    let count = 0;
    for (let at = 0; at < data.length; at += 4) count += wanted.every((part, i) => data[at + i] === part);
    return count;
  });

  const connection = () => page.$eval('#connection', (one) => [one.className, one.textContent]);
  await page.waitForFunction(() => document.getElementById('connection').textContent.includes('no answer'));
  found.silent = await connection();
  found.again = await connectionAfter(bus(8));
  await page.evaluate(() => globalThis.lose(0));
  found.lost = await connection();
  await page.evaluate(() => globalThis.lose(globalThis.EventSource.CLOSED));
  await page.waitForFunction(() => globalThis.connections === 2);
  found.reconnected = await connectionAfter(bus(9));

  const ticks = () => page.$eval('#summary', (one) => one.textContent.split(' ')[0]);
  await show(bus(9));
  const other = await page.browser().newPage();
  await other.bringToFront();
  await page.waitForFunction(() => document.hidden, { polling: 100 });
  await send(bus(20));
  found.hidden = await ticks();
  await page.bringToFront();
  await page.waitForFunction(() => document.getElementById('summary').textContent.startsWith('20.0'), { polling: 100 });
  await other.close();

  for (const repeat of [false, true, true]) {
    await page.evaluate((one) => document.dispatchEvent(new KeyboardEvent('keydown', { key: 'p', repeat: one })), repeat);
  }
  found.isPressed = await page.$eval('#pause', (one) => one.getAttribute('aria-pressed'));
  await page.click('#value-rows tr:last-child input');
  await show(bus(21), pdo(21, 1, [value(1, '=real', '4.5', 4.5), value(3, 'other', '1', 1)]));
  await page.click('#value-rows tr:last-child input');
  found.pausedPlots = await plots();
  await page.setViewport({ width: 320, height: 600 });
  await page.type('#filter', 'REAL');
  found.found = await page.$eval('#found', (one) => one.textContent);
  found.header = await page.$eval('header', (one) => getComputedStyle(one).position);
  await inScheme(page, 'dark');
  await page.emulateMediaType('print');
  found.ink = await page.evaluate(() => getComputedStyle(document.body).color);
  found.printed = await page.evaluate(() => {
    document.body.style.width = '600px';
    return Math.max(...[...document.querySelectorAll('.plot canvas')].map((one) => one.getBoundingClientRect().right))
      <= document.querySelector('.plot').getBoundingClientRect().right;
  });
  return found;
}

console.log(JSON.stringify(await withPage(chromium, use)));
