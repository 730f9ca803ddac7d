// monitor.mjs CHROMIUM URL SECONDS [SCREENSHOTS]: what a user does with the page of edsc monitor --web, as JSON; then stays
// open for this time. SCREENSHOTS: a folder for them.
import { mkdirSync } from 'node:fs';
import { inScheme, violations, watch, withPage } from './browser.mjs';

const [chromium, url, seconds, screenshots] = process.argv.slice(2);
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// The text of each row of values, and of the bus.
const shown = (page) => page.evaluate(() => ({
  values: [...document.querySelectorAll('#value-rows tr')].map((row) => row.textContent),
  summary: document.getElementById('summary').textContent,
}));

// The share of pixels of the plot that are not transparent.
const drawn = (page) => page.$eval('.plot canvas', (canvas) => {
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let at = 3; at < data.length; at += 4) count += data[at] !== 0;
  return count / (data.length / 4);
});

const exported = async (page) => {
  await page.evaluate(() => {
    URL.createObjectURL = (blob) => {
      globalThis.exported = blob.text();
      return 'data:,';
    };
  });
  await page.keyboard.press('e');
  return page.evaluate(() => globalThis.exported);
};

const memory = async (page) => {
  const session = await page.createCDPSession();
  await session.send('HeapProfiler.collectGarbage');
  const { usedSize } = await session.send('Runtime.getHeapUsage');
  await session.detach();
  return usedSize;
};

async function use(page) {
  const seen = watch(page);
  const found = { seen, violations: {} };
  await page.goto(url, { waitUntil: 'load' });
  await page.waitForFunction(() => document.querySelectorAll('#value-rows input').length >= 2);
  await page.waitForFunction(() => document.querySelectorAll('#nodes tr').length >= 8);
  found.connection = await page.$eval('#connection', (one) => one.textContent);
  found.nodes = await page.$$eval('#nodes tr', (rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
  found.first = await shown(page);
  await page.waitForFunction((before) => [...document.querySelectorAll('#value-rows tr')]
    .some((row, at) => row.textContent !== before[at]), {}, found.first.values);

  const boxes = await page.$$('#value-rows input');
  await boxes[0].click();
  await boxes[1].focus();
  await page.keyboard.press('Space');
  found.plots = await page.$$eval('.plot h3', (all) => all.map((one) => one.firstChild.textContent));
  await page.waitForFunction(() => {
    globalThis.texts ??= new Set();
    return globalThis.texts.add(document.querySelector('.plot small').textContent).size > 12;
  });
  found.drawn = await drawn(page);
  for (const scheme of ['light', 'dark']) {
    await inScheme(page, scheme);
    await wait(500);
    found.violations[scheme] = await violations(page);
    if (screenshots) {
      mkdirSync(screenshots, { recursive: true });
      await page.screenshot({ path: `${screenshots}/monitor-${scheme}.png`, fullPage: true });
    }
  }
  await inScheme(page, 'light');

  await page.keyboard.press('p');
  found.paused = [await shown(page)];
  await wait(1500);
  found.paused.push(await shown(page));
  found.isPressed = await page.$eval('#pause', (one) => one.getAttribute('aria-pressed'));
  await page.click('#pause');
  await page.waitForFunction((before) => document.getElementById('summary').textContent !== before.summary
    && [...document.querySelectorAll('#value-rows tr')].some((row, at) => row.textContent !== before.values[at]), {},
    found.paused[1]);
  found.resumed = await shown(page);

  found.csv = await exported(page);
  await page.keyboard.press('/');
  await page.keyboard.type('no such value');
  found.filtered = await page.$$eval('#value-rows tr', (rows) => rows.filter((row) => row.checkVisibility()).length);
  await page.click('#filter', { clickCount: 3 });
  await page.keyboard.press('Backspace');
  await page.evaluate(() => document.querySelector('.plot').scrollIntoView());
  await page.click('.plot button');
  found.left = await page.$$eval('.plot h3', (all) => all.map((one) => one.firstChild.textContent));
  found.emcys = await page.$$eval('#emcys tr', (rows) => rows.map((row) => row.cells[2].textContent));

  const end = Date.now() + 1000 * Number(seconds);
  found.memory = [await memory(page)];
  while (Date.now() < end) {
    await wait(Math.min(30_000, Math.max(0, end - Date.now())));
    found.memory.push(await memory(page));
  }
  found.last = (await shown(page)).summary;
  return found;
}

console.log(JSON.stringify(await withPage(chromium, use)));
