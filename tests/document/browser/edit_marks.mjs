// edit_marks.mjs CHROMIUM URL SAMPLES: times of the page of edsc edit in ms, as JSON. 1000h must be ro: another access type is a finding.
import { watch, withPage } from './browser.mjs';

const [chromium, url, samples] = process.argv.slice(2);

// In the page, before its script: the time of the first frame with entries and findings.
const recordOpening = () => {
  const look = () => {
    const isReady = document.querySelector('.grid-row [role=gridcell]') && document.getElementById('findings').firstChild;
    if (isReady) requestAnimationFrame(() => { globalThis.openedAt = performance.now(); });
    else requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
};

const opened = async (page) => {
  await page.waitForFunction(() => globalThis.openedAt);
  return page.evaluate(() => globalThis.openedAt);
};

// From the key that accepts a cell to the frame after the new findings.
const keyToFindings = (page) => page.evaluate(() => new Promise((resolve) => {
  const grid = document.getElementById('grid'), findings = document.getElementById('findings');
  const start = performance.now();
  const observer = new MutationObserver(() => {
    observer.disconnect();
    requestAnimationFrame(() => requestAnimationFrame(() => resolve(performance.now() - start)));
  });
  observer.observe(findings, { childList: true, subtree: true, characterData: true });
  const target = document.activeElement;
  if (!grid.contains(target)) throw new Error('no cell is edited');
  target.dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter', bubbles: true, cancelable: true }));
}));

// The time of the page's thread for each frame of a scroll, also on a busy computer: script, styles, layout and painting.
const scrolled = async (page, count) => {
  const session = await page.createCDPSession();
  await session.send('Performance.enable', { timeDomain: 'threadTicks' });
  const now = async () => (await session.send('Performance.getMetrics')).metrics.find(({ name }) => name === 'TaskDuration').value * 1000;
  const times = [];
  for (let at = 0; at < count; ++at) {
    const before = await now();
    await page.evaluate(() => new Promise((resolve) => {
      document.getElementById('grid').scrollTop += 140;
      requestAnimationFrame(() => requestAnimationFrame(resolve));
    }));
    times.push(await now() - before);
  }
  await session.detach();
  return times;
};

console.log(JSON.stringify(await withPage(chromium, async (page) => {
  const { errors } = watch(page);
  const found = { open: [], key: [], scroll: [] };
  await page.evaluateOnNewDocument(recordOpening);
  await page.goto(url, { waitUntil: 'load' });
  found.open.push(await opened(page));
  for (let at = 0; at < 10; ++at) {
    await page.reload({ waitUntil: 'load' });
    found.open.push(await opened(page));
  }
  found.entries = await page.$eval('#grid', (grid) => Number(grid.getAttribute('aria-rowcount')) - 1);
  await page.focus('#grid');
  found.scroll = await scrolled(page, Number(samples));
  await page.keyboard.type('/');
  await page.keyboard.type('1000h');
  await page.waitForFunction(() => document.getElementById('found').textContent.startsWith('1 of'));
  for (const key of ['Enter', 'End', 'Enter']) await page.keyboard.press(key);
  const column = await page.$$eval('[role=columnheader]', (all) => all.findIndex((one) => one.textContent === 'Access'));
  for (let at = 0; at < column; ++at) await page.keyboard.press('ArrowRight');
  for (let at = 0; at < Number(samples); ++at) {
    await page.keyboard.type(at % 2 === 0 ? 'rw' : 'ro');
    found.key.push(await keyToFindings(page));
    await page.keyboard.press('ArrowUp');
  }
  return { ...found, errors };
})));
