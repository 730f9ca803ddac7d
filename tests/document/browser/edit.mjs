// edit.mjs CHROMIUM URL STORY [ARGUMENT...]: what a user does with the page of edsc edit, by keyboard alone, and what it then shows,
// as JSON.
import { readFileSync, renameSync, writeFileSync } from 'node:fs';
import { inScheme, violations, watch, withPage } from './browser.mjs';

const [chromium, url, story, ...parameters] = process.argv.slice(2);

class User {
  constructor(page) {
    this.page = page;
    this.seen = watch(page);
  }

  async open(address = url) {
    await this.page.goto(address, { waitUntil: 'load' });
    await this.until(() => document.querySelector('.grid-row [role=gridcell], .workspace.of-network #section-text > *'));
    await this.frame();
  }

  // The end of the transitions of buttons, which axe would see.
  still() {
    return this.page.evaluate(() => Promise.allSettled(document.getAnimations().map((one) => one.finished)));
  }

  frame() {
    return this.page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  }

  // Keys such as `Control+Shift+z`.
  async press(...keys) {
    for (const all of keys) {
      const parts = all.split('+');
      const key = parts.pop();
      for (const part of parts) await this.page.keyboard.down(part);
      await this.page.keyboard.press(key);
      for (const part of parts.reverse()) await this.page.keyboard.up(part);
    }
  }

  async times(count, key) {
    for (let at = 0; at < count; ++at) await this.press(key);
  }

  type(text) {
    return this.page.keyboard.type(text);
  }

  async replace(text) {
    await this.press('Control+a');
    await this.type(text);
  }

  // Presses Tab until an element that matches has the focus.
  async tabTo(selector, key = 'Tab') {
    for (let at = 0; at < 80; ++at) {
      if (await this.page.evaluate((one) => document.activeElement?.matches(one), selector)) return;
      await this.press(key);
    }
    throw new Error(`Tab does not reach ${selector}`);
  }

  async tabToLabel(label) {
    const id = await this.page.evaluate((text) => [...(document.querySelector('dialog') ?? document).querySelectorAll('label')]
      .find((one) => one.textContent.startsWith(text) && one.checkVisibility()).htmlFor, label);
    await this.tabTo(`#${id}`);
  }

  until(what, ...values) {
    return this.page.waitForFunction(what, { timeout: 60_000 }, ...values);
  }

  // Until the name of the last edit has this text.
  edited(text) {
    return this.until((one) => document.getElementById('undo').textContent.includes(one), text);
  }

  text(selector) {
    return this.page.$eval(selector, (one) => one.textContent);
  }

  // What a screen reader reads: the name of the element with the focus, or of its active cell.
  focused() {
    return this.page.evaluate(() => {
      const focus = document.activeElement;
      const active = document.getElementById(focus.getAttribute('aria-activedescendant') ?? '');
      return (active ?? focus).getAttribute('aria-label') ?? (active ?? focus).textContent;
    });
  }

  async dialog() {
    await this.until(() => document.querySelector('dialog[open]'));
    await this.frame();
  }

  noDialog() {
    return this.until(() => !document.querySelector('dialog'));
  }

  async save() {
    await this.press('Control+s');
    await this.dialog();
    const shown = await this.text('dialog');
    await this.press('Enter');
    await this.until(() => document.getElementById('file-state').textContent.includes('saved') && !document.querySelector('dialog'));
    return shown;
  }

  // `kind`: how often the arrow key moves from the first kind of object.
  async newObject(kind, values) {
    await this.press('Control+Alt+n');
    await this.dialog();
    await this.press('Shift+Tab');
    await this.times(kind, 'ArrowRight');
    for (const text of values) {
      await this.press('Tab');
      if (text === false) continue;
      if (text === true) await this.press('Space');
      else if (await this.page.evaluate(() => document.activeElement.localName === 'select')) await this.type(text);
      else await this.replace(text);
    }
    await this.press('Enter');
    await this.noDialog();
    await this.frame();
  }

  // Moves in the spreadsheet to a column.
  async toColumn(name) {
    const column = await this.page.$$eval('[role=columnheader]', (all, text) => all.findIndex((one) => one.textContent === text), name);
    if (column < 0) throw new Error(`no column ${name}`);
    await this.press('Home');
    await this.times(column, 'ArrowRight');
  }

  // Selects an object by the search, and moves to its entries.
  async find(words) {
    await this.press('/');
    await this.replace(words);
    await this.until(() => document.getElementById('found').textContent.startsWith('1 of'));
    await this.press('Enter', 'End', 'Enter');
    await this.frame();
  }

  // Accepts the choice for the typed text, if there are choices.
  async pick() {
    if (await this.page.$('.choices:not([hidden])')) await this.press('Enter');
  }

  // Fills fields of a dialog, and accepts it.
  async fill(values) {
    await this.dialog();
    for (const [label, text] of values) {
      await this.tabToLabel(label);
      await this.replace(text);
      await this.pick();
    }
    await this.press('Enter');
    await this.noDialog();
    await this.frame();
  }

  items(id) {
    return this.page.$$eval(`#${id} li b`, (all) => all.map((one) => one.textContent));
  }

  // Removes the items of the list that has the focus, also where this adds an error.
  async removeAll(id) {
    for (let left = (await this.items(id)).length; left > 0; --left) {
      await this.press('Control+Delete');
      await this.until((list, count) => document.querySelectorAll(`#${list} li`).length < count || document.querySelector('dialog'), id, left);
      if (await this.page.$('dialog')) {
        await this.tabTo('dialog .danger');
        await this.press('Enter');
        await this.noDialog();
      }
      await this.frame();
    }
  }

  // What is drawn, and the bus load.
  async picture() {
    return { drawn: await this.page.$$eval('.drawing g > title', (all) => all.map((one) => one.textContent)), load: await this.text('#load-text'),
      value: Number(await this.page.$eval('.load-bar', (one) => one.getAttribute('aria-valuenow'))),
      messages: await this.page.$$eval('.load-messages tbody tr', (all) => all.map((row) => [...row.children].map((one) => one.textContent))) };
  }

  rows() {
    return this.page.$$eval('.grid-body .grid-row:not(.message):not(.tail)', (rows) => rows.map((row) => [...row.children].map((cell) => cell.textContent)));
  }

  banners() {
    return this.page.$$eval('.banner', (all) => all.map((one) => one.textContent));
  }

  pdo() {
    return this.page.$$eval('.bit-cell.mapped', (all) => all.map((one) => one.getAttribute('aria-label')));
  }
}

// axe and the marks of the focus. `views`: the keys, and selectors to which Tab moves, that show each; `after` leaves it.
const accessOf = async (user, views, after) => {
  const found = { violations: {}, overflow: {}, focus: [] };
  const press = async (keys) => {
    for (const key of keys) await (/^[#.]/.test(key) ? user.tabTo(key) : user.press(key));
  };
  for (const scheme of ['light', 'dark']) {
    await inScheme(user.page, scheme);
    for (const [view, keys] of Object.entries(views)) {
      await press(keys);
      await user.frame();
      if (parameters[0]) await user.page.screenshot({ path: `${parameters[0]}/edit-${view}-${scheme}.png` });
      found.violations[`${view} ${scheme}`] = await violations(user.page);
      if (await user.page.$('dialog')) await user.press('Escape');
      await press(after[view] ?? []);
    }
  }
  await inScheme(user.page, 'light');
  await user.page.setViewport({ width: 320, height: 256 });
  for (const key of ['Alt+1', 'Alt+2', 'Alt+3']) {
    await user.press(key);
    await user.frame();
    if (parameters[0]) await user.page.screenshot({ path: `${parameters[0]}/edit-zoom-${Object.keys(views)[0]}-${key}.png`, fullPage: true });
    found.overflow[key] = await user.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  }
  await user.page.setViewport({ width: 1300, height: 1000 });
  // Each stop of Tab is visible, and has a mark: an outline, or that of its active row or cell.
  await user.press('Alt+2');
  for (let at = 0; at < 40; ++at) {
    const stop = await user.page.evaluate(() => {
      const focus = document.activeElement;
      const active = document.getElementById(focus.getAttribute('aria-activedescendant') ?? '') ?? focus;
      const style = getComputedStyle(active);
      return { name: focus.id || focus.className || focus.localName, isBody: focus === document.body, isVisible: active.checkVisibility(),
        isMarked: style.outlineStyle !== 'none' || style.boxShadow !== 'none' };
    });
    if (!stop.isBody && !(stop.isVisible && stop.isMarked)) found.focus.push(stop);
    await user.press('Tab');
  }
  await user.page.emulateMediaFeatures([{ name: 'prefers-reduced-motion', value: 'reduce' }]);
  found.moving = await user.page.$$eval('button, .tree-row', (all) => all.filter((one) => getComputedStyle(one).transitionDuration !== '0s').length);
  return found;
};

const stories = {
  // Five objects and two PDOs in a new EDS.
  async make(user) {
    await user.open();
    await user.newObject(1, ['2000h', 'Motor temperature', 'INTEGER16', 'ro', true]);
    await user.newObject(1, ['2001h', 'Speed', 'INTEGER32', 'ro', true]);
    await user.newObject(1, ['2002h', 'Setpoint', 'INTEGER32', 'rww', true]);
    await user.newObject(2, ['2003h', 'Gains', false, false, '4', false]);
    await user.press('Control+Alt+n');
    await user.dialog();
    await user.type('1010');
    await user.press('Enter');
    await user.noDialog();
    await user.frame();

    await user.find('2002h');
    await user.toColumn('Low limit');
    await user.type('-1000');
    await user.press('Tab');
    await user.type('3E8h');
    await user.press('Enter');
    await user.until(() => document.querySelector('.grid').textContent.includes('-1000'));

    await user.press('Alt+3', 'Tab', 'Enter');
    await user.tabTo('.mappable-list');
    for (const words of ['temperature', 'speed']) {
      await user.tabTo('.mappable input', 'Shift+Tab');
      await user.replace(words);
      await user.press('Enter', 'Enter');
      await user.until((word) => document.querySelector('.bits').textContent.toLowerCase().includes(word), words);
    }
    await user.tabTo('.bits', 'Shift+Tab');
    const before = await user.pdo();
    // The new state arrives before the answer to the edit, as it can on a busy computer.
    await user.page.evaluate(() => {
      const send = window.fetch;
      window.fetch = async (path, options) => {
        const answer = await send(path, options);
        if (path === 'change') await new Promise((resolve) => setTimeout(resolve, 1000));
        return answer;
      };
    });
    await user.press('Home', 'Alt+ArrowDown');
    await user.until(() => document.querySelector('.bit-cell').textContent.startsWith('Speed'));
    const read = await user.focused();
    const after = await user.pdo();
    await user.press('Alt+3');
    await user.tabToLabel('Event timer');
    await user.replace('100');
    await user.press('Enter');
    await user.until(() => document.querySelector('.item-list').textContent.includes('timer 100 ms'));
    await user.press('Alt+3', 'Tab', 'Tab', 'Enter');
    await user.until(() => document.getElementById('pdo-title').textContent.startsWith('RPDO 1'));
    await user.tabTo('.mappable input');
    await user.replace('setpoint');
    await user.press('Enter', 'Enter');
    await user.until(() => document.querySelector('.bits').textContent.includes('Setpoint'));
    const findings = await user.text('#findings');
    const review = await user.save();
    return { before, after, read, findings, review, state: await user.text('#file-state') };
  },

  // A rejected cell keeps its text; several rows and pasted cells are one step each; undo and redo.
  async cells(user) {
    const [words, column] = parameters;
    await user.open();
    await user.find(words);
    await user.toColumn(column);
    await user.press('Control+End', 'Home');
    await user.toColumn(column);
    await user.type('12z');
    await user.press('Enter');
    await user.until(() => document.querySelector('.rejected'));
    const rejected = { cell: await user.text('.rejected'), message: await user.text('.message'), state: await user.text('#file-state'),
      invalid: await user.page.$eval('.rejected', (one) => one.getAttribute('aria-invalid')) };
    await user.press('Control+End');
    await user.toColumn(column);
    await user.press('Escape');
    await user.until(() => !document.querySelector('.rejected'));
    await user.press('Shift+ArrowUp', 'Shift+ArrowUp');
    await user.type('64h');
    await user.press('Enter');
    await user.until(() => document.getElementById('file-state').textContent.includes('1 unsaved edit'));
    const several = await user.rows();
    const undoName = await user.text('#undo');
    await user.press('Control+z');
    await user.until(() => document.getElementById('file-state').textContent.includes('saved') && document.getElementById('undo').disabled);
    const undone = await user.rows();
    const redoName = await user.text('#redo');
    await user.press('Control+y');
    await user.until(() => document.getElementById('redo').disabled);
    const redone = await user.rows();
    // Cells from another program.
    await user.press('Control+Home', 'ArrowDown', 'ArrowDown');
    await user.toColumn('Name');
    await user.page.evaluate(() => {
      const data = new DataTransfer();
      data.setData('text/plain', 'First\r\nSecond\r\n');
      document.activeElement.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true, cancelable: true }));
    });
    await user.until(() => document.getElementById('file-state').textContent.includes('2 unsaved edits'));
    const pasted = await user.rows();
    await user.save();
    return { rejected, several, undone, redone, pasted, undoName, redoName };
  },

  // Edits that stay unsaved.
  async leave(user) {
    await user.open();
    await user.find(parameters[0]);
    await user.toColumn('Name');
    await user.type('Unsaved name');
    await user.press('Enter');
    await user.edited('Unsaved name');
    return { state: await user.text('#file-state') };
  },

  async restore(user) {
    await user.open();
    const offered = await user.banners();
    const isLocked = await user.page.$eval('#new-object', (one) => one.disabled);
    await user.tabTo('.banner button', 'Shift+Tab');
    await user.tabTo('.banner button.main', 'Shift+Tab');
    await user.press('Enter');
    await user.until(() => document.getElementById('file-state').textContent.includes('unsaved'));
    await user.save();
    return { offered, isLocked, after: await user.banners() };
  },

  // Another program changes the file: another line, then the line of an edit.
  async disk(user) {
    const [file, words, otherFrom, otherTo, mineFrom, theirs] = parameters;
    const replace = (from, to) => {
      const text = readFileSync(file, 'utf8');
      if (!text.includes(from)) throw new Error(`${from} is missing`);
      writeFileSync(`${file}.new`, text.replace(from, to));
      renameSync(`${file}.new`, file);
    };
    await user.open();
    await user.find(words);
    await user.toColumn('Name');
    await user.type('My name');
    await user.press('Enter');
    await user.edited('My name');
    replace(otherFrom, otherTo);
    await user.until((text) => document.getElementById('banners').textContent.includes(text), 'changed');
    const merged = { banners: await user.banners(), rows: await user.rows() };
    replace(mineFrom, theirs);
    await user.until(() => document.querySelector('.banner .versions'));
    const conflict = await user.banners();
    await user.tabTo('.banner button', 'Shift+Tab');
    const isFocused = await user.focused();
    await user.tabTo('.banner .versions ~ button', 'Shift+Tab');
    while (await user.focused() !== 'Keep my edit') await user.press('Shift+Tab');
    await user.press('Enter');
    await user.until(() => !document.querySelector('.banner .versions'));
    await user.find(words);
    await user.save();
    return { merged, conflict, isFocused };
  },

  // Two pages of one file.
  async pair(user) {
    await user.open();
    const second = new User(await user.page.browser().newPage());
    await second.page.setViewport({ width: 1300, height: 1000 });
    await second.open(parameters[0]);
    await user.page.bringToFront();
    await user.find(parameters[1]);
    await user.toColumn('Name');
    await user.type('Of the first page');
    await user.press('Enter');
    await user.edited('Of the first page');
    await second.page.bringToFront();
    await second.edited('Of the first page');
    await second.press('Control+z');
    await second.until(() => document.getElementById('undo').disabled);
    await user.page.bringToFront();
    await user.until(() => document.getElementById('undo').disabled);
    await user.page.reload({ waitUntil: 'load' });
    await user.until(() => document.querySelector('.grid-row [role=gridcell]'));
    return { address: user.page.url(), seen: second.seen, state: await user.text('#file-state') };
  },

  // Texts of the file are texts on the page. The first object and each of its names.
  async hostile(user) {
    await user.open();
    await user.press('/');
    await user.until(() => document.activeElement.id === 'query');
    await user.press('Enter', 'Home', 'Enter', 'Control+End');
    await user.frame();
    const { names, images, scripts } = await user.page.evaluate(() => ({
      names: [...document.querySelectorAll('.tree-row .name')].map((one) => one.textContent), images: document.querySelectorAll('img, b script').length,
      scripts: document.scripts.length }));
    for (const key of ['Alt+1', 'Alt+3', 'Alt+2']) {
      await user.press(key);
      await user.frame();
    }
    return { names, images, scripts, title: await user.page.title(), isHacked: await user.page.evaluate(() => Boolean(globalThis.hacked)) };
  },

  // axe in each tab and dialog, in both schemes, and the width of the page at 400 % zoom.
  async access(user) {
    await user.open();
    return accessOf(user, { objects: ['Alt+2'], pdos: ['Alt+3'], device: ['Alt+1'], filters: ['#filters summary', 'Enter'], new: ['Alt+2', 'Control+Alt+n'], keys: ['F1'] },
      { filters: ['Enter'] });
  },

  async networkAccess(user) {
    await user.open();
    return accessOf(user, { network: ['Alt+1'], nodes: ['Alt+2'], node: ['Control+Alt+n'], signals: ['Alt+3'], signal: ['Control+Alt+n'],
      choices: ['Alt+3', '#view-signals [role=combobox]', 'ArrowDown'], text: ['.drawing-text summary', 'Enter'], keys: ['F1'] }, { choices: ['Escape'], text: ['Enter'] });
  },

  async lost(user) {
    await user.open();
    process.kill(Number(parameters[0]), 'SIGKILL');
    await user.until(() => document.querySelector('.banner.bad'));
    await user.find(parameters[1]);
    await user.toColumn('Name');
    await user.type('x');
    return { banners: await user.banners(), editors: await user.page.$$eval('.editor', (all) => all.length),
      isLocked: await user.page.$eval('#new-object', (one) => one.disabled) };
  },

  async withoutScript(user) {
    await user.page.setJavaScriptEnabled(false);
    await user.page.goto(url, { waitUntil: 'load' });
    return { text: await user.page.$eval('noscript', (one) => one.textContent), isVisible: await user.page.$eval('noscript p', (one) => one.checkVisibility()) };
  },

  // What does not fit is disabled, with its reason. The PDO has 64 bits.
  async full(user) {
    await user.open();
    await user.press('Alt+3');
    await user.tabTo('.mappable-list');
    await user.press('Home', 'Enter');
    await user.frame();
    const found = { reason: await user.text('.mappable-foot'), option: await user.page.$eval('.mappable-row', (one) => one.getAttribute('aria-disabled')),
      state: await user.text('#file-state') };
    await user.tabTo('.bits', 'Shift+Tab');
    await user.press('End', 'Delete');
    await user.until(() => document.querySelector('.bit-cell.free'));
    return { ...found, after: await user.pdo(), fits: await user.page.$eval('.mappable-foot button', (one) => one.getAttribute('aria-disabled')) };
  },

  // A finding and its fix.
  async fix(user) {
    await user.open();
    const before = await user.text('#findings-count');
    await user.tabTo('#findings .small');
    const name = await user.focused();
    await user.press('Enter');
    await user.until((text) => document.getElementById('findings-count').textContent !== text, before);
    await user.frame();
    const found = { name, before, after: await user.text('#findings-count'), told: await user.text('#announcements') };
    await user.save();
    return found;
  },

  // A finding is allowed with a reason.
  async reason(user) {
    await user.open();
    const before = await user.text('#findings-count');
    await user.tabTo('#findings .small');
    for (let at = 0; at < 20 && !(await user.focused()).startsWith('Allow'); ++at) await user.press('Tab');
    const name = await user.focused();
    await user.press('Enter');
    await user.dialog();
    await user.press('Enter');
    await user.until(() => document.querySelector('.dialog-message').textContent);
    const asked = await user.text('.dialog-message');
    await user.type(parameters[0]);
    await user.press('Enter');
    await user.noDialog();
    await user.until((text) => document.getElementById('findings-count').textContent !== text, before);
    return { name, asked, before, after: await user.text('#findings-count'), review: await user.save() };
  },

  // The ParameterValue of a DCF, beside its DefaultValue.
  async value(user) {
    const [words, text] = parameters;
    await user.open();
    await user.find(words);
    const columns = await user.page.$$eval('[role=columnheader]', (all) => all.map((one) => one.textContent));
    await user.press('Control+End');
    await user.toColumn('Value');
    const before = await user.rows();
    await user.type(text);
    await user.press('Enter');
    await user.until(() => document.getElementById('file-state').textContent.includes('1 unsaved edit'));
    return { columns, before, after: await user.rows(), state: await user.text('#file-state'), review: await user.save() };
  },

  // Lines that cannot be read are shown.
  async unreadable(user) {
    await user.open();
    const banners = await user.banners();
    const problems = await violations(user.page);
    await user.tabTo('.banner pre', 'Shift+Tab');
    const read = await user.focused();
    await user.find(parameters[0]);
    await user.toColumn('Name');
    await user.type(parameters[1]);
    await user.press('Enter');
    await user.edited(parameters[1]);
    await user.save();
    return { banners, problems, read, after: await user.banners() };
  },

  // A cell that was rejected is applied anyway by the button of its message.
  async anywayCell(user) {
    const [words, column, text] = parameters;
    await user.open();
    await user.find(words);
    await user.press('Control+End');
    await user.toColumn(column);
    await user.type(text);
    await user.press('Enter');
    await user.tabTo('.message-text .danger');
    const found = { name: await user.focused(), message: await user.text('.message-text'), state: await user.text('#file-state'),
      problems: await violations(user.page) };
    await user.press('Enter');
    await user.until(() => document.getElementById('file-state').textContent.includes('1 unsaved edit'));
    await user.until(() => !document.querySelector('.rejected'));
    return { ...found, rows: await user.rows(), focus: await user.page.evaluate(() => document.activeElement.id), review: await user.save() };
  },

  // By mouse: an object is dragged into the frame, and then before the first one.
  async drag(user) {
    const { page } = user;
    await user.open();
    await user.press('Alt+3');
    await user.frame();
    const middle = async (selector, at = 0) => {
      const box = await (await page.$$(selector))[at].boundingBox();
      return [box.x + box.width / 2, box.y + box.height / 2];
    };
    const drag = async (from, to) => {
      await page.mouse.move(...from);
      await page.mouse.down();
      await page.mouse.move(from[0] + 5, from[1] + 5, { steps: 3 });
      await page.mouse.move(...to, { steps: 10 });
      await page.mouse.up();
    };
    await drag(await middle('.mappable-row', 1), await middle('.bit-cell.free'));
    await user.until(() => document.querySelectorAll('.bit-cell.mapped.first').length === 2);
    const added = await user.pdo();
    await drag(await middle('.bit-cell.mapped.first', 1), await middle('.bit-cell.mapped.first', 0));
    await user.until((text) => document.querySelector('.bit-cell').getAttribute('aria-label') !== text, added[0]);
    return { added, moved: await user.pdo() };
  },

  // Objects of another EDS.
  async other(user) {
    const [file, words] = parameters;
    await user.open();
    await user.press('Control+Alt+n');
    await user.dialog();
    await user.press('Shift+Tab', 'ArrowUp');
    await (await user.page.$('#new-file')).uploadFile(file);
    await user.until(() => document.querySelector('.pick input'));
    const offered = await user.page.$$eval('.pick li', (all) => all.map((one) => one.textContent));
    await user.replace(words);
    await user.tabTo('.pick input');
    await user.press('Space', 'Enter');
    await user.noDialog();
    await user.save();
    return { offered };
  },

  // An edit that breaks masters: the review says so, and raises the major revision.
  async revision(user) {
    const [words, column, text] = parameters;
    await user.open();
    await user.find(words);
    await user.toColumn(column);
    await user.type(text);
    await user.press('Enter');
    await user.until(() => document.getElementById('file-state').textContent.includes('unsaved'));
    await user.press('Control+s');
    await user.dialog();
    const review = await user.text('dialog');
    await user.tabTo('#raise-revision', 'Shift+Tab');
    await user.press('Space');
    await user.tabTo('dialog .main');
    await user.press('Enter');
    await user.until(() => document.getElementById('file-state').textContent.includes('saved') && !document.querySelector('dialog'));
    return { review };
  },

  // The number of objects that each filter finds.
  async filters(user) {
    const found = {};
    await user.open();
    await user.tabTo('#filters summary', 'Shift+Tab');
    await user.press('Enter');
    for (const [name, id, text] of [['const', '#filter-access', 'const'], ['tpdo', '#filter-mappable', 'in a T']]) {
      await user.tabTo(id);
      await user.type(text);
      await user.frame();
      found[name] = await user.text('#found');
      await user.tabTo('.filters button');
      await user.press('Enter');
      await user.until(() => !document.getElementById('found').textContent.includes(' of '));
      await user.tabTo('#filter-findings', 'Shift+Tab');
    }
    await user.press('/');
    await user.type('no such object');
    await user.frame();
    return { ...found, none: await user.text('#found'), grid: await user.text('.grid .empty') };
  },

  // The base of an overlay is grey; an edit goes to the overlay.
  async overlay(user) {
    await user.open();
    await user.find(parameters[0]);
    const hint = await user.text('#grid-hint');
    await user.toColumn(parameters[1]);
    await user.type(parameters[2]);
    await user.press('Enter');
    await user.until(() => document.getElementById('file-state').textContent.includes('unsaved'));
    const diff = await user.save();
    return { hint, diff, base: await user.text('#file-state') };
  },

  // A new node and a new signal change the drawing and the load; a node-ID is rejected, and one that another node has is forced; undo;
  // values of entries; the order of signals.
  async network(user) {
    const [node, members, signal, entry, value, used] = parameters.map((one, at) => ([1, 2].includes(at) ? Object.entries(JSON.parse(one)) : one));
    await user.open();
    const before = { ...await user.picture(), tabs: await user.page.$$eval('[role=tab]:not([hidden])', (all) => all.map((one) => one.textContent)),
      isTreeShown: await user.page.$eval('#tree', (one) => one.checkVisibility()) };
    await user.press('Alt+2', 'Control+Alt+n');
    await user.fill([['name', node], ...members]);
    await user.until((name) => document.querySelector('.drawing .chosen title')?.textContent === name, node);
    const withNode = await user.picture();
    const read = await user.page.$eval('#nodes', (one) => document.getElementById(one.getAttribute('aria-activedescendant')).textContent);

    await user.press('Alt+2');
    await user.tabToLabel('node_id');
    await user.replace('200');
    await user.press('Enter');
    await user.until(() => document.activeElement.getAttribute('aria-invalid') === 'true');
    const rejected = await user.page.evaluate(() => ({ text: document.activeElement.value,
      message: document.getElementById(document.activeElement.getAttribute('aria-describedby').split(' ')[1]).textContent }));
    const state = await user.text('#file-state');
    await user.press('Escape');
    await user.replace(used);
    await user.press('Enter');
    await user.until(() => document.activeElement.getAttribute('aria-invalid') === 'true');
    await user.press('Control+Enter');
    await user.until(() => !document.getElementById('findings-count').textContent.startsWith('0 errors'));
    const forced = await user.text('#findings');
    await user.tabTo('#nodes', 'Shift+Tab');
    await user.press('Control+z');
    await user.until(() => document.getElementById('findings-count').textContent.startsWith('0 errors'));

    await user.press('Alt+3', 'Control+Alt+n');
    await user.fill(signal);
    await user.until((count) => document.querySelectorAll('.drawing:first-of-type g').length !== count, withNode.drawn.length);
    const withSignal = { ...await user.picture(), signals: await user.items('signals') };
    await user.press('Control+z');
    await user.until((text) => document.getElementById('load-text').textContent === text, withNode.load);
    const undone = { ...await user.picture(), signals: await user.items('signals') };
    await user.press('Control+y');
    await user.until((text) => document.getElementById('load-text').textContent === text, withSignal.load);

    await user.tabTo('#signals');
    await user.press('End', 'Alt+ArrowUp');
    await user.until((name) => document.querySelector('#signals li:last-child b').textContent !== name, withSignal.signals.at(-1));
    const moved = await user.items('signals');

    await user.press('Alt+2');
    await user.tabToLabel('New entry');
    await user.replace(entry);
    await user.pick();
    await user.press('Enter');
    await user.type(value);
    await user.press('Enter');
    await user.until(() => document.querySelector('.set-table tbody tr'));
    await user.tabTo('#nodes', 'Shift+Tab');
    await user.press('Enter');
    await user.replace('renamed');
    await user.press('Enter');
    await user.until(() => document.querySelector('.drawing .chosen title')?.textContent === 'renamed');
    const name = await user.page.evaluate(() => document.activeElement.value);
    const review = await user.save();
    return { before, withNode, read, rejected, state, forced, withSignal, undone, moved, name, signals: await user.items('signals'), review };
  },

  // A field that was rejected is applied anyway by its button: with the keyboard, and with the mouse.
  async anyway(user) {
    const [used] = parameters;
    const isApplied = () => user.until(() => !document.getElementById('findings-count').textContent.startsWith('0 errors'));
    const reject = async () => {
      await user.press('Alt+2');
      await user.tabToLabel('node_id');
      await user.replace(used);
      await user.press('Enter');
      await user.until(() => document.querySelector('.field-problem .danger:not([hidden])')?.checkVisibility());
    };
    await user.open();
    await reject();
    await user.still();
    const problems = await violations(user.page);
    await user.press('Tab');
    const name = await user.focused();
    await user.press('Enter');
    await isApplied();
    await user.until(() => !document.querySelector('.field-problem:not([hidden])'));
    const focus = await user.page.evaluate(() => document.activeElement.value);
    await user.tabTo('#nodes', 'Shift+Tab');
    await user.press('Control+z');
    await user.until(() => document.getElementById('undo').disabled);
    await reject();
    await user.page.click('.field-problem .danger:not([hidden])');
    await isApplied();
    return { problems, name, focus, review: await user.save() };
  },

  // A new node that was rejected is added anyway.
  async anywayNode(user) {
    const [node, members] = parameters.map((one, at) => (at === 1 ? Object.entries(JSON.parse(one)) : one));
    await user.open();
    await user.press('Alt+2', 'Control+Alt+n');
    await user.dialog();
    for (const [label, text] of [['name', node], ...members]) {
      await user.tabToLabel(label);
      await user.replace(text);
      await user.pick();
    }
    await user.press('Enter');
    await user.until(() => document.querySelector('dialog .danger:not([hidden])'));
    await user.still();
    const problems = await violations(user.page);
    await user.tabTo('dialog .danger');
    await user.press('Enter');
    await user.noDialog();
    return { problems, nodes: await user.items('nodes') };
  },

  // The text of a new signal and of one that is moved; where the focus is after the last signal and node are removed.
  async emptyNetwork(user) {
    const signal = Object.entries(JSON.parse(parameters[0]));
    const line = () => user.text('#section-text');
    await user.open();
    await user.press('Alt+3', 'Control+Alt+n');
    await user.fill(signal);
    await user.until((text) => document.getElementById('section-text').textContent.includes(text), signal.at(-1)[1]);
    const added = await line();
    await user.press('Alt+ArrowUp');
    await user.edited('move');
    await user.frame();
    const moved = await line();
    await user.removeAll('signals');
    const afterSignals = await user.focused();
    await user.press('Alt+2');
    await user.tabTo('#nodes');
    await user.removeAll('nodes');
    return { added, moved, afterSignals, afterNodes: await user.focused() };
  },

  // Another program adds a signal before the selected one.
  async signalBefore(user) {
    const [file, from, to] = parameters;
    await user.open();
    await user.press('Alt+3');
    await user.tabTo('#signals');
    await user.press('End');
    const before = await user.text('#signal-title');
    const count = (await user.items('signals')).length;
    writeFileSync(file, readFileSync(file, 'utf8').replace(from, to));
    await user.until((old) => document.querySelectorAll('#signals li').length > old, count);
    const after = await user.text('#signal-title');
    await user.until((text) => document.getElementById('section-text').textContent.startsWith(text), parameters[3]);
    return { before, after };
  },

  async hostileNetwork(user) {
    await user.open();
    for (const key of ['Alt+1', 'Alt+2', 'Alt+3']) {
      await user.press(key);
      await user.frame();
    }
    return { names: await user.items('nodes'), drawn: (await user.picture()).drawn, images: await user.page.$$eval('img', (all) => all.length),
      scripts: await user.page.evaluate(() => document.scripts.length), isHacked: await user.page.evaluate(() => Boolean(globalThis.hacked)) };
  },

  // A text that is not JSON, and after its correction in an editor.
  async brokenNetwork(user) {
    const [file, from, to] = parameters;
    const good = readFileSync(file, 'utf8');
    const shown = () => user.page.evaluate(() => ({
      isFormShown: [...document.querySelectorAll('.middle > .tabs, .middle > .view')].some((one) => one.checkVisibility()),
      isPictureShown: document.getElementById('picture').checkVisibility(), findings: document.getElementById('findings-count').textContent,
      text: document.getElementById('section-text').textContent }));
    await user.open();
    writeFileSync(file, good.replace(from, to));
    await user.until(() => document.querySelector('.text-only'));
    await user.until((text) => document.getElementById('section-text').textContent.includes(text), to);
    const broken = { ...await shown(), violations: await violations(user.page) };
    writeFileSync(file, good);
    await user.until(() => !document.querySelector('.text-only'));
    return { broken, corrected: await shown() };
  },
};

const found = await withPage(chromium, async (page) => {
  const user = new User(page);
  try {
    return { ...await stories[story](user), seen: user.seen };
  } catch (error) {
    await page.screenshot({ path: `${process.cwd()}/failed-${story}.png` });
    throw error;
  }
});
console.log(JSON.stringify(found));
