// A page in headless Chromium, with what it logs and requests.
import puppeteer from 'puppeteer-core';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const minutes = 60_000;

export async function withPage(chromium, use) {
  const browser = await puppeteer.launch({
    executablePath: chromium, timeout: 5 * minutes, protocolTimeout: 20 * minutes,
    args: ['--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage'],
  });
  try {
    const page = await browser.newPage();
    page.setDefaultTimeout(10 * minutes);
    await page.setViewport({ width: 1300, height: 1000 });
    return await use(page);
  } finally {
    await browser.close();
  }
}

// Errors and warnings of the page, and requests of anything besides the page itself, or the server that it comes from.
export function watch(page) {
  const seen = { errors: [], requests: [] };
  page.on('console', (message) => {
    if (['error', 'warn', 'warning'].includes(message.type())) seen.errors.push(message.text());
  });
  page.on('pageerror', (error) => seen.errors.push(String(error)));
  page.on('dialog', (dialog) => {
    seen.errors.push(`dialog ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on('request', (request) => {
    const { origin, protocol } = new URL(request.url());
    const isPage = request.isNavigationRequest() && ['file:', 'http:'].includes(protocol);
    const isOwn = protocol === 'http:' && origin === new URL(page.url()).origin;
    if (!isPage && !isOwn && protocol !== 'data:') seen.requests.push(request.url());
  });
  return seen;
}

export async function open(page, file, hash = '') {
  await page.goto('about:blank');
  await page.goto(pathToFileURL(file).href + hash, { waitUntil: 'load' });
}

export const inScheme = (page, scheme) => page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: scheme }]);

// `rule: element` of each violation. The page's policy forbids added scripts, so axe is evaluated.
export async function violations(page) {
  await page.evaluate(axe);
  return page.evaluate(async () => {
    const { violations: found } = await globalThis.axe.run(document, { resultTypes: ['violations'] });
    return found.flatMap((one) => one.nodes.map((node) => `${one.id}: ${node.html.slice(0, 200)}`));
  });
}

export const openAll = (page) => page.evaluate(() => {
  for (const one of document.querySelectorAll('details')) one.open = true;
});

// Types a text into the search, or selects in a filter, as a user does.
export async function type(page, text) {
  await page.click('#query', { clickCount: 3 });
  await page.keyboard.press('Backspace');
  if (text) await page.keyboard.type(text);
}

// The indices of the objects that are visible in the next frame, and the status.
export const results = (page) => page.evaluate(async () => {
  await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  const isVisible = (one) => one.firstElementChild.checkVisibility();
  return {
    objects: [...document.querySelectorAll('.object')].filter(isVisible).map((one) => one.id),
    status: document.querySelector('[role=status]').textContent,
  };
});
