// pages.mjs CHROMIUM COMMAND FILE...: prints what it sees as JSON.
import { inScheme, open, openAll, results, type, violations, watch, withPage } from './browser.mjs';

// Each page in light and dark, with everything expanded if the name of the command says so.
async function audit(first, files, isExpanded) {
  const found = {};
  for (const file of files) {
    for (const scheme of ['light', 'dark']) {
      const page = await first.browser().newPage();
      const seen = watch(page);
      await inScheme(page, scheme);
      await open(page, file);
      if (isExpanded) await openAll(page);
      found[`${file} ${scheme}`] = { ...seen, violations: await violations(page) };
      await page.close();
    }
  }
  return found;
}

// Pages of the site of the documents: violations, requests, the links that its search finds, and what is wider than the page.
async function site(first, files) {
  const found = {};
  for (const file of files) {
    for (const [scheme, width] of [['light', 1300], ['dark', 1300], ['light', 390]]) {
      const page = await first.browser().newPage();
      const seen = watch(page);
      await page.setViewport({ width, height: 1000 });
      await inScheme(page, scheme);
      await open(page, file);
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      await type(page, 'pdo-length');
      const links = await page.$$eval('#results a', (all) => all.map((one) => one.getAttribute('href').replace(/^(\.\.?\/)+/, '')));
      const { requests, errors } = structuredClone(seen); // axe itself reads the style sheets
      found[`${file} ${scheme} ${width}`] = { requests, errors, overflow, results: links, violations: await violations(page) };
      await page.close();
    }
  }
  return found;
}

// Searches and filters, keyboard and links of a device page.
async function use(page, [file]) {
  const seen = watch(page);
  const found = { seen };
  await open(page, file);
  found.all = await results(page);
  await page.keyboard.press('/');
  found.focused = await page.evaluate(() => document.activeElement.id);
  for (const text of ['6041h', '6041', '0x6041', '1018h:04', 'target position', 'od::statusword', 'access', 'no such object']) {
    await type(page, text);
    found[text] = await results(page);
  }
  await type(page, '1018h:04');
  found.hits = await page.$$eval('tr.hit', (rows) => rows.map((row) => row.id));
  await page.keyboard.press('Escape');
  found.escaped = await results(page);
  for (const [filter, value] of [['area', '6000'], ['access', 'wo'], ['type', 'INTEGER8'], ['pdo', 'rpdo'], ['pdo', 'tpdo'],
    ['pdo', 'mapped']]) {
    await page.select(`#${filter}`, value);
    found[`${filter} ${value}`] = await results(page);
    await page.click('button[type=reset]');
  }
  found.reset = await results(page);
  await page.select('#area', '6000');
  await page.evaluate(() => { location.hash = '#1018h-02'; });
  await page.waitForFunction(() => document.getElementById('1018h').open);
  found.link = await page.evaluate(() => {
    const row = document.getElementById('1018h-02').getBoundingClientRect();
    return { isVisible: row.top >= 0 && row.bottom <= innerHeight, target: document.querySelector(':target').id };
  });
  await page.click('#objects tr[id="1018h-02"] .copy');
  await page.waitForSelector('.copy.done');
  found.copied = await page.$eval('.copy.done', (button) => button.textContent);
  await open(page, file, '#1018h-03');
  await page.waitForFunction(() => document.getElementById('1018h').open);
  await page.click('#close');
  await page.focus('[id="1018h"] > summary');
  await page.keyboard.press('Enter');
  found.opensByKey = await page.$eval('[id="1018h"]', (one) => one.open);
  await page.click('#open');
  found.expanded = await page.$$eval('.object', (all) => all.every((one) => one.open));
  await page.click('#close');
  await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
  await page.emulateMediaType('print');
  found.printed = await page.evaluate(() => ({
    isOpen: [...document.querySelectorAll('details')].every((one) => one.open),
    tools: document.querySelector('form.tools').checkVisibility(),
  }));
  await page.evaluate(() => dispatchEvent(new Event('afterprint')));
  found.after = await page.$$eval('.object', (all) => all.some((one) => one.open));
  return found;
}

// The rectangles of the drawings by PDO, and their names.
async function drawings(page, [file]) {
  await open(page, file);
  return page.evaluate(() => Object.fromEntries([...document.querySelectorAll('.pdo')].map((pdo) => [pdo.id, {
    label: pdo.querySelector('svg')?.getAttribute('aria-label') ?? null,
    fields: [...pdo.querySelectorAll('rect.field')].map((one) => [Number(one.getAttribute('x')),
      Number(one.getAttribute('width')), one.parentElement.querySelector('title').textContent]),
    properties: Object.fromEntries([...pdo.querySelectorAll('dt')].map(
      (one) => [one.textContent, one.nextElementSibling.textContent])),
  }])));
}

// Milliseconds of processor time from an input to the layout of its result.
async function speed(page, [file]) {
  const session = await page.createCDPSession();
  await session.send('Performance.enable', { timeDomain: 'threadTicks' });
  const used = async () => {
    const { metrics } = await session.send('Performance.getMetrics');
    return 1000 * metrics.find(({ name }) => name === 'TaskDuration').value;
  };
  const start = Date.now();
  await open(page, file);
  const found = { loaded: Date.now() - start, times: {} };
  await new Promise((resolve) => setTimeout(resolve, 2000));
  for (const text of ['s', 'sp', 'speed 7', 'object', '3456h', 'nothing', 'parameter 99', '']) {
    const before = await used();
    const status = await page.evaluate((typed) => {
      const query = document.getElementById('query');
      query.value = typed;
      query.dispatchEvent(new Event('input', { bubbles: true }));
      document.body.getBoundingClientRect();
      return document.querySelector('[role=status]').textContent;
    }, text);
    found.times[text] = [await used() - before, status];
  }
  return found;
}

// What is wider than a narrow screen, with everything expanded.
async function narrow(page, [file]) {
  await page.setViewport({ width: 400, height: 1000 });
  await open(page, file);
  await openAll(page);
  return page.evaluate(() => {
    const isCut = (one) => one.getBoundingClientRect().right > innerWidth && !one.closest('.scroll');
    const cards = [...document.querySelectorAll('.pdo')];
    return {
      page: document.documentElement.scrollWidth - innerWidth,
      cut: [...document.querySelectorAll('main *')].filter(isCut).map((one) => one.outerHTML.slice(0, 200)),
      cards: cards.filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.id),
    };
  });
}

// The objects that a checkbox leaves.
async function check(page, [file, box]) {
  await open(page, file);
  await page.click(box);
  return results(page);
}

// The headings of the pages that links of this selector lead to.
async function follow(page, [file, selector]) {
  await open(page, file);
  const links = await page.$$eval(selector, (all) => all.map((one) => one.href));
  const headings = [];
  for (const link of links) {
    await page.goto(link);
    headings.push(await page.$eval('h1', (one) => one.textContent));
  }
  return headings;
}

// Texts of elements, by the selectors that follow the file.
async function texts(page, [file, ...selectors]) {
  const seen = watch(page);
  await open(page, file);
  const found = { seen };
  for (const selector of selectors) {
    found[selector] = await page.$$eval(selector, (all) => all.map((one) => one.textContent.trim()));
  }
  return found;
}

// The pictures that are drawn, with their own sizes.
async function pictures(page, [file]) {
  await open(page, file);
  return page.$$eval('img', (all) => all.map((one) => ({ class: one.className, width: one.naturalWidth, height: one.naturalHeight })));
}

// The height of the tallest row of each table at the width of a phone, in lines of text.
async function lines(page, [file]) {
  await page.setViewport({ width: 390, height: 1000 });
  await open(page, file);
  await openAll(page);
  return page.$$eval('main table', (tables) => tables.map((table) => Math.max(...[...table.rows].map((row) =>
    row.getBoundingClientRect().height / parseFloat(getComputedStyle(row).lineHeight)))));
}

// The tables of an object: the caption and its rows; of a drawn word, each row of cells as [label, bits, class].
async function meaning(page, [file, id]) {
  const seen = watch(page);
  await open(page, file);
  // Text that is not rendered yet is empty: what the browser skips is shown, and the next frame is waited for.
  await page.evaluate((object) => {
    for (const one of document.querySelectorAll('.chunk')) one.style.contentVisibility = 'visible';
    for (const one of document.querySelectorAll(`details[id="${object}"], section[id="${object}"] details`)) one.open = true;
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  }, id);
  return { seen, tables: await page.evaluate((object) => {
    const textOf = (one) => one.innerText.trim();
    const rowOf = (row) => [...row.cells].map((cell) => cell.closest('.bits') && cell.localName === 'td'
      ? [cell.textContent, cell.colSpan, cell.classList[0]] : textOf(cell));
    return [...document.querySelectorAll(`[id="${object}"] table, section[id="${object}"] table`)].map(
      (table) => [table.caption ? textOf(table.caption) : '', ...[...table.rows].map(rowOf)]);
  }, id) };
}

const commands = { meaning, audit, site, 'audit-expanded': (page, files) => audit(page, files, true), use, drawings, speed, narrow, check, follow, texts, pictures, lines };
const [chromium, command, ...rest] = process.argv.slice(2);
console.log(JSON.stringify(await withPage(chromium, (page) => commands[command](page, rest))));
