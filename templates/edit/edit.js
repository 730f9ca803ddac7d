/* The page: the parts of the state on the screen, and what the user does as changes. */
const announcements = byId('announcements');
const announce = (text) => {
  announcements.textContent = '';
  requestAnimationFrame(() => setText(announcements, text));
};

let grid = null;  /* of an EDS, DCF or overlay */
let networkView = null;  /* of a network file */
let rowsOfObject = new Map();
let marksOfSection = new Map();
let isFirst = true;

const client = new EditClient({ update: (names) => update(names), connect: (problem) => showConnection(problem) });
const part = (name) => client.parts.get(name);

/* Changes */

const rejectedText = (rejected) => {
  const texts = [rejected.message, ...(rejected.findings ?? []).map((one) => one.message)].filter(Boolean);
  return [...new Set(texts)].join('; ') || 'rejected';
};

/* Why an edit is rejected, and whether it can be applied anyway. */
const rejectionOf = (rejected) => ({ text: rejectedText(rejected), canForce: Boolean(rejected.can_force) });

/* Sends changes as one step. Returns a rejection, or null. What can be forced is asked. */
const change = async (changes, { isForced = false, canAsk = true } = {}) => {
  const rejected = await client.send('change', { changes, force: isForced });
  if (!rejected) return null;
  if (rejected.can_force && canAsk) askToForce(rejected, changes);
  return rejectionOf(rejected);
};

const askToForce = (rejected, changes) => {
  const force = make('button', { type: 'button', class: 'danger', text: 'Apply anyway', onclick: async () => {
    const rejection = await change(changes, { isForced: true, canAsk: false });
    if (rejection) dialog.reject(rejection.text);
    else dialog.close();
  } });
  const dialog = new Dialog({ title: 'This edit was rejected', actions: [force], body: [
    ...(rejected.message ? [make('p', { text: rejected.message })] : []),
    ...(rejected.findings?.length ? [make('ul', { class: 'finding-list' }, ...rejected.findings.map((one) => findingElement(one, {})))] : []),
  ] });
};

/* A finding is allowed with a reason, which becomes a comment of the file. */
const askForReason = (fix) => {
  const reason = make('input', { type: 'text', id: 'reason', maxlength: 200, required: true });
  const allow = make('button', { type: 'button', class: 'main', text: 'Allow', onclick: () => send() });
  const send = async () => {
    const text = reason.value.trim();
    const rejection = text ? await change(fix.changes.map((one) => ({ ...one, reason: text })), { canAsk: false }) : { text: 'State the reason.' };
    if (rejection) dialog.reject(rejection.text);
    else dialog.close();
  };
  reason.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') send();
  });
  const dialog = new Dialog({ title: fix.title, actions: [allow], body: [make('label', { for: 'reason', text: 'Reason' }), reason] });
  reason.focus();
};

/* Edits of cells are one step. A rejected one does not stop the others. Returns the rejections by the places of the edits. */
const maxRejected = 50;
const changeCells = async (edits, isForced) => {
  const rejections = [];
  let open = edits.map((edit, at) => ({ at, change: { do: 'set', section: edit.row.section, key: edit.key, value: valueOf(edit.key, edit.text) } }));
  for (let count = 0; open.length > 0; ++count) {
    const rejected = await client.send('change', { changes: open.map((one) => one.change), force: isForced });
    if (!rejected) break;
    const rejection = rejectionOf(rejected);
    if (rejected.index === null || rejected.index === undefined || count === maxRejected) {
      for (const one of open) rejections[one.at] = rejection;
      break;
    }
    const [failed] = open.splice(rejected.index, 1);
    rejections[failed.at] = rejection;
  }
  const first = rejections.find(Boolean);
  if (first) announce(first.text);
  return rejections;
};

const yes = /^(yes|y|1|0x1|true)$/i;
const valueOf = (key, text) => (key === 'PDOMapping' && text ? (yes.test(text) ? '1' : /^(no|n|0|false)$/i.test(text) ? '0' : text) : text);

/* Rows of the spreadsheet */

/* In the order of the columns, of each member of an entry: the least width of its column in rem, and its share of the rest. */
const widths = { name: [11.5, 2.5], type: [9.2, 0.3], access: [4.7, 0], pdo: [3.4, 0], default: [6.6, 1], value: [6.6, 1], low: [6.1, 0.7], high: [6.1, 0.7],
  unit: [4.6, 0.4], factor: [4.2, 0.3] };
const kinds = { type: 'choice', access: 'choice', pdo: 'choice', default: 'number', value: 'number', low: 'number', high: 'number' };

const shortTitles = { type: 'Type', pdo: 'PDO', default: 'Default', value: 'Value' };

const columnsOf = (choices, kind) => [
  { key: 'entry', title: 'Entry', width: 6.6, kind: 'fixed', draw: (row) => [make('span', { class: 'mono', text: row.cells.entry }),
    ...(row.marks ? [make('span', { class: 'marks' }, ...markElements(row.marks))] : [])] },
  ...Object.keys(widths).flatMap((member) => choices.columns.filter((one) => one.member === member && (member !== 'value' || kind === 'dcf'))).map((one) => ({
    key: one.key, member: one.member, title: shortTitles[one.member] ?? one.label, help: one.label, width: widths[one.member][0], share: widths[one.member][1], kind: kinds[one.member] ?? 'text',
    choices: { type: () => part('choices').types.map((type) => ({ text: type.name, hint: type.bits ? plural(type.bits, 'bit') : '' })),
      access: () => part('choices').access, pdo: () => ['yes', 'no'] }[one.member],
  })),
];

const entryText = (object, entry) => (entry.sub === '' || object.entries.length === 1 && entry.section.length <= 4 ? `${object.index}h` : `${object.index}h:${entry.sub}`);

const rowsOf = (object) => {
  const known = rowsOfObject.get(object.index);
  if (known?.object === object) return known.rows;
  const rows = object.entries.map((entry) => {
    const isHead = entry.sub === '' && object.entries.length > 1;
    const cells = { entry: entryText(object, entry) };
    for (const column of grid.columns.slice(1)) {
      if (column.member === 'pdo') cells[column.key] = isHead ? undefined : entry.pdo ? 'yes' : 'no';
      else cells[column.key] = isHead && column.member !== 'name' ? undefined : entry[column.member] ?? '';
    }
    if (isHead) {
      const type = grid.columns.find((column) => column.member === 'type');
      if (type) cells[type.key] = object.kind;
    }
    return { id: entry.section, section: entry.section, index: object.index, label: `${cells.entry} ${entry.name}`, object, entry, cells, isHead,
      locked: Boolean(entry.locked), lockedKeys: isHead ? grid.columns.filter((column) => column.member !== 'name').map((column) => column.key) : [],
      marks: null };
  });
  for (const row of rows) setMarks(row);
  rowsOfObject.set(object.index, { object, rows });
  return rows;
};

const noMarks = { errors: 0, warnings: 0 };
const marksOf = (section) => marksOfSection.get(section.toLowerCase()) ?? noMarks;
const setMarks = (row) => {
  const { errors, warnings } = marksOf(row.section);
  row.marks = errors || warnings || row.entry.changed ? { errors, warnings, changed: row.entry.changed } : null;
};

const countMarks = (findings) => {
  marksOfSection = new Map();
  const add = (name, severity) => {
    const key = name.toLowerCase();
    const marks = marksOfSection.get(key) ?? { errors: 0, warnings: 0 };
    if (severity === 'error') ++marks.errors;
    else if (severity === 'warning') ++marks.warnings;
    marksOfSection.set(key, marks);
  };
  for (const one of findings.list) {
    if (one.section) add(one.section, one.severity);
    if (one.object && one.object.toLowerCase() !== one.section?.toLowerCase()) add(`object ${one.object}`, one.severity);
    else if (one.object) add(`object ${one.object}`, one.severity);
  }
};

/* The tree and the rows of what is chosen */

const filter = new ObjectFilter(document.querySelector('.filters'), () => {
  tree.chooseAll();
  showObjects();
});
const tree = new ObjectTree(byId('tree'), {
  select: () => showRows(),
  open: () => {
    mainTabs.select('tab-objects', false);
    byId('grid').focus();
  },
});

const objectOf = (index) => part(`object/${index}`);

const showObjects = () => {
  const { words } = filter;
  const isActive = filter.isActive;
  let count = 0, all = 0;
  const areas = part('tree').areas.map((area) => ({ ...area, objects: area.objects.flatMap((index) => {
    ++all;
    const object = objectOf(index);
    if (!object || (isActive && !(filter.matchesObject(object, words) && object.entries.some((entry) => filter.matchesEntry(entry, marksOf))))) return [];
    ++count;
    const marks = marksOfSection.get(`object ${index.toLowerCase()}`) ?? noMarks;
    return [{ index, name: object.name, kind: object.kind, errors: marks.errors, warnings: marks.warnings, changed: object.changed,
      locked: object.entries.every((entry) => entry.from_base || entry.locked) }];
  }) }));
  tree.setAreas(areas, isActive);
  setText(byId('found'), isActive ? `${count} of ${plural(all, 'object')}` : plural(all, 'object'));
  setText(byId('filter-count'), filter.count ? `(${filter.count})` : '');
  showRows();
};

let shownKey = '';
const showRows = () => {
  if (!grid) return;
  const chosen = tree.chosenIndices;
  const rows = [];
  const objects = [];
  const isFiltered = filter.count > 0;
  for (const area of part('tree').areas) {
    for (const index of area.objects) {
      if (!chosen.has(index)) continue;
      const object = objectOf(index);
      if (!object) continue;
      objects.push(object);
      for (const row of rowsOf(object)) if (!isFiltered || filter.matchesEntry(row.entry, marksOf)) rows.push(row);
    }
  }
  const key = [...tree.chosen].join(' ');
  if (key !== shownKey) {
    shownKey = key;
    grid.active.row = grid.anchor.row = 0;
    byId('grid').scrollTop = 0;
  }
  grid.setRows(rows, objects.length ? 'No entry matches the filters.' : tree.items.length ? 'No object is chosen.' : 'No object.');
  const [first] = objects;
  const title = byId('objects-title');
  if (objects.length === 1) {
    title.replaceChildren(make('span', { class: 'mono', text: `${first.index}h` }), ` ${first.name} `,
      make('small', { text: [first.kind, first.mapped_by?.length && `mapped by ${first.mapped_by.join(', ')}`].filter(Boolean).join(', ') }));
  } else {
    title.replaceChildren(plural(objects.length, 'object'), make('small', { text: plural(rows.length, 'row') }));
  }
  byId('remove-object').disabled = isLocked() || objects.length === 0;
  showActiveRow(grid.activeRow);
};

const showActiveRow = (row) => {
  const count = grid.selectedRows.length;
  setText(byId('grid-hint'), row ? (count > 1 ? `${count} rows are selected: an edit changes all of them.`
    : row.locked ? 'This entry cannot be changed.' : row.entry.from_base ? 'This entry is from the base. A change is written to the overlay.'
      : 'Enter edits, Delete clears, Ctrl+V pastes cells, Shift+arrow selects several rows.') : '');
  side.showSection(row?.section ?? null);
};

/* Removes the selected sub-entries, else the chosen objects. */
const removeSelected = async () => {
  const chosen = [...tree.chosenIndices];
  if (chosen.length === 0 || isLocked()) return;
  const rows = grid.selectedRows;
  const isSub = (row) => row.entry.sub !== '' && row.object.entries.length > 1 && row.entry.sub !== '00';
  if (rows.some((row) => row.entry.sub === '00' && row.object.entries.length > 1) && rows.length === 1 && byId('grid').contains(document.activeElement)) {
    announce('Sub-index 0 is removed with its object: select the row of the object.');
    return;
  }
  const isGridFocused = byId('grid').contains(document.activeElement);
  const sections = isGridFocused && rows.length && rows.every(isSub) ? rows.map((row) => row.section)
    : isGridFocused && rows.length ? [...new Set(rows.map((row) => row.index))] : chosen;
  const rejection = await change(sections.map((section) => ({ do: 'remove', section })));
  announce(rejection?.text ?? `${sections.length === 1 ? `${sections[0]} removed` : `${sections.length} removed`}.`);
};

/* Findings, links */

const openPlace = (finding) => {
  if (networkView) {
    networkView.reveal(finding.section);
    return;
  }
  const object = (finding.object || finding.section).slice(0, 4).toUpperCase();
  if (objectOf(object)) {
    if (!tree.areas.some((area) => area.objects.some((one) => one.index === object))) filter.clear();
    mainTabs.select('tab-objects', false);
    setTimeout(() => {
      tree.reveal(object);
      grid.goTo(finding.section);
      byId('grid').focus();
    });
  } else {
    mainTabs.select('tab-device', false);
    deviceForm.reveal(finding.section, finding.key);
    side.showSection(finding.section);
  }
};

const side = new SidePanel({
  client, announce, open: openPlace,
  fix: async (one) => {
    if (one.needs_reason) return askForReason(one);
    const rejection = await change(one.changes);
    announce(rejection?.text ?? `Done: ${one.title}.`);
  },
});

/* Tabs */

const setValue = (section, key, value, isForced) => change([{ do: 'set', section, key, value }], { isForced, canAsk: false });
const deviceForm = new DeviceForm(byId('device-form'), { set: setValue, focus: (section) => side.showSection(section) });
const pdoEditor = new PdoEditor(byId('pdo-editor'), {
  change: (changes, isForced) => change(changes, { isForced, canAsk: changes.some((one) => one.do === 'remove') }), announce, showSection: (title) => side.showSection(title),
});
const mainTabs = new Tabs(document.querySelector('.middle > .tabs'), (id) => showTab(id));
const showTab = (id) => {
  networkView?.showTab(id);
  if (!grid) return;
  if (id === 'tab-device') deviceForm.show(part('device'), isLocked());
  if (id === 'tab-pdos') showPdos();
  if (id === 'tab-objects') {
    grid.isLocked = isLocked();
    grid.redraw();
  }
};
const showPdos = () => pdoEditor.show(part('pdos'), { rpdo: part('candidates/rpdo')?.list, tpdo: part('candidates/tpdo')?.list }, isLocked());

const newObject = new NewObjectDialog({
  client,
  state: () => ({ choices: part('choices'), standard: part('standard'), objects: part('tree').areas.flatMap((area) => area.objects) }),
  change: async (changes) => client.send('change', { changes, force: false }),
  added: (index) => {
    filter.clear();
    mainTabs.select('tab-objects', false);
    setTimeout(() => {
      tree.reveal(index);
      byId('grid').focus();
    });
  },
});
const saveDialog = new SaveDialog({ client, saved: () => announce('Saved.') });

/* State on the screen */

const isLocked = () => {
  const status = part('status');
  return client.problem !== '' || !status || Boolean(status.journal) || status.conflicts.length > 0;
};

const showStatus = () => {
  const file = part('file'), status = part('status');
  setText(byId('file-name'), file.name);
  document.title = `${status.dirty ? '* ' : ''}${file.name} - edsc edit`;
  const state = byId('file-state');
  const fileKinds = { eds: 'EDS', dcf: 'DCF', overlay: `overlay of ${file.base}`, network: 'network file' };
  setText(state, [fileKinds[file.kind], file.encoding, status.dirty ? plural(status.edits, 'unsaved edit') : 'saved'].filter(Boolean).join(', '));
  state.className = status.dirty ? 'dirty' : 'quiet';
  const locked = isLocked();
  for (const [id, label, name] of [['undo', 'Undo', status.undo], ['redo', 'Redo', status.redo]]) {
    const button = byId(id);
    setText(button, name ? `${label}: ${name}` : label);
    setAttributes(button, { title: name ? `${label}: ${name}` : null });
    button.disabled = !name || locked;
  }
  byId('save').disabled = !status.dirty || locked;
  byId('new-object').disabled = locked;
  showBanners();
};

const banner = (kind, text, ...children) => make('div', { class: `banner ${kind}`, role: kind === 'bad' ? 'alert' : null }, make('p', { text }), ...children);
const problems = {
  lost: 'The server does not answer: edsc edit has ended, or the computer slept. Unsaved edits are in its journal; the next run of edsc edit offers them.',
  session: 'This page has no session. Press u in the terminal of edsc edit, and open the URL that it prints.',
};

let shownBanners = '';
const showBanners = () => {
  const file = part('file'), status = part('status');
  const key = JSON.stringify([client.problem, status?.journal, status?.conflicts, status?.unreadable, status?.message, file?.notes]);
  if (key === shownBanners) return;
  shownBanners = key;
  const banners = [];
  if (problems[client.problem]) banners.push(banner('bad', problems[client.problem]));
  if (status?.journal) {
    const { edits, names } = status.journal;
    banners.push(banner('', `${plural(edits, 'edit')} ${edits === 1 ? 'was' : 'were'} not saved: ${names.slice(-3).join(', ')}${names.length > 3 ? ', ...' : ''}.`,
      make('button', { type: 'button', class: 'main', text: 'Restore', onclick: () => useJournal(true) }),
      make('button', { type: 'button', text: 'Discard', onclick: () => useJournal(false) })));
  }
  for (const conflict of status?.conflicts ?? []) banners.push(conflictBanner(conflict));
  if (status?.message) banners.push(banner('', status.message));
  for (const note of file?.notes ?? []) banners.push(banner('', note));
  if (status?.unreadable?.length) {
    const lines = status.unreadable;
    banners.push(banner('', `${plural(lines.length, 'line')} cannot be read and ${lines.length === 1 ? 'is' : 'are'} kept:`,
      make('div', { class: 'versions' }, make('pre', { tabindex: 0, text: lines.slice(0, 20).map((one) => `${one.line}: ${one.text}`).join('\n') }))));
  }
  byId('banners').replaceChildren(...banners);
};

const conflictBanner = ({ id, line, base, mine, theirs }) => {
  const version = (title, lines) => make('div', {}, make('b', { text: title }), make('pre', { tabindex: 0, text: lines.join('\n') || '(removed)' }));
  return banner('bad', `Another program changed line ${line}, which you changed too. Before: ${base.join(' / ') || '(nothing)'}`,
    make('div', { class: 'versions' }, version('Your edit', mine), version('The file', theirs)),
    make('button', { type: 'button', text: 'Keep my edit', onclick: () => resolve(id, 'mine') }),
    make('button', { type: 'button', text: 'Keep the file', onclick: () => resolve(id, 'theirs') }));
};
const resolve = async (id, keep) => {
  const rejected = await client.send('resolve', { id, keep });
  announce(rejected ? rejectedText(rejected) : 'The conflict is resolved.');
};
const useJournal = async (use) => {
  const rejected = await client.send('journal', { use });
  announce(rejected ? rejectedText(rejected) : use ? 'The edits are restored.' : 'The edits are discarded.');
  byId('tree').focus();
};

const showConnection = (problem) => {
  document.body.classList.toggle('lost', problem !== '');
  if (problem === 'connecting') return;
  if (part('status')) {
    showStatus();
    showAll();
  }
  showBanners();
  if (problem === 'lost') announce('The server does not answer. Edits are not possible.');
};

const showNetwork = () => networkView?.show(part('network'), part('entries').lists, part('findings').list, isLocked());

const showAll = () => {
  showNetwork();
  if (!grid) return;
  grid.isLocked = isLocked();
  deviceForm.show(part('device'), isLocked());
  showObjects();
  showPdos();
};

const start = () => {
  const file = part('file');
  document.body.classList.remove('loading');
  byId('workspace').hidden = false;
  if (file.kind === 'network') {
    startNetwork();
    return;
  }
  const choices = part('choices');
  grid = new EntryGrid(byId('grid'), {
    columns: columnsOf(choices, file.kind), change: changeCells, activate: showActiveRow,
    act: (what, details) => {
      if (what === 'remove') removeSelected();
      if (what === 'locked') announce(details.row.isHead ? 'Only the name of this row can be changed.' : 'This cell cannot be changed.');
      if (what === 'pasted') announce(`${plural(details.count, 'cell')} pasted${details.skipped ? `, ${details.skipped} skipped` : ''}.`);
    },
  });
  filter.setAccess(choices.access);
  byId('tree').focus();
};

const startNetwork = () => {
  byId('workspace').classList.add('of-network');
  byId('dictionary').hidden = true;
  for (const name of ['device', 'objects', 'pdos']) byId(`tab-${name}`).hidden = true;
  for (const name of ['tab-network', 'tab-nodes', 'tab-signals', 'picture']) byId(name).hidden = false;
  setText(byId('tab-section'), 'Text');
  setText(byId('skip'), 'Skip to the drawing');
  byId('skip').href = '#picture';
  side.drawLine = jsonLine;
  const changeMember = (changes, isForced) => change(changes, { isForced, canAsk: false });
  networkView = new NetworkView({ change: changeMember, remove: change, announce, showText: (pointer) => side.showSection(pointer), tabs: mainTabs });
  mainTabs.select('tab-network', true);
  side.showSection('');
};

const update = (names) => {
  if (!grid && !networkView) start();
  if (networkView) {
    if (names.has('findings')) side.showFindings(part('findings'));
    if (names.has('file') || names.has('status')) showStatus();
    if (!isFirst) side.showText();
    isFirst = false;
    showNetwork();
    return;
  }
  const areObjects = [...names].some((name) => name.startsWith('object/'));
  if (names.has('findings')) {
    countMarks(part('findings'));
    side.showFindings(part('findings'));
    for (const { rows } of rowsOfObject.values()) for (const row of rows) setMarks(row);
  }
  if (names.has('file') || names.has('status')) showStatus();
  grid.isLocked = isLocked();
  if (names.has('device') || names.has('status')) deviceForm.show(part('device'), isLocked());
  if (!isFirst) side.showText();
  isFirst = false;
  if (areObjects || names.has('tree') || names.has('findings') || names.has('status')) showObjects();
  if (names.has('pdos') || names.has('status') || [...names].some((name) => name.startsWith('candidates/'))) showPdos();
};

/* Buttons and keys */

const showKeys = () => openKeys(networkView ? networkKeys : deviceKeys);

const step = async (which) => {
  const name = part('status')?.[which];
  if (!name || isLocked()) return;
  const rejected = await client.send(which);
  announce(rejected ? rejectedText(rejected) : `${which === 'undo' ? 'Undone' : 'Redone'}: ${name}.`);
};
byId('undo').addEventListener('click', () => step('undo'));
byId('redo').addEventListener('click', () => step('redo'));
byId('save').addEventListener('click', () => saveDialog.open());
byId('help').addEventListener('click', () => showKeys());
byId('new-object').addEventListener('click', () => newObject.open(grid.activeRow ? `${grid.activeRow.index}h` : ''));
byId('remove-object').addEventListener('click', () => removeSelected());

document.addEventListener('keydown', (event) => {
  if (event.defaultPrevented || document.querySelector('dialog[open]') || !part('status')) return;
  const { key, ctrlKey, metaKey, shiftKey, altKey, target } = event;
  const isControl = (ctrlKey || metaKey) && !altKey;
  const isTyping = target.matches?.('input:not([type=checkbox]), select, textarea');
  const lower = key.toLowerCase();
  const run = (action) => {
    event.preventDefault();
    action();
  };
  if (isControl && lower === 's') {
    run(async () => {
      if (isTyping) target.blur();
      await client.last;
      if (part('status').dirty && !isLocked()) saveDialog.open();
      else announce('Nothing to save.');
    });
  } else if (isControl && lower === 'z' && !isTyping) run(() => step(shiftKey ? 'redo' : 'undo'));
  else if (isControl && lower === 'y' && !isTyping) run(() => step('redo'));
  else if (ctrlKey && altKey && lower === 'n' && networkView) run(() => networkView.add());
  else if (ctrlKey && altKey && lower === 'n' && grid) run(() => byId('new-object').click());
  else if (altKey && !ctrlKey && ['1', '2', '3'].includes(key) && (grid || part('network'))) run(() => mainTabs.select(mainTabs.shown[key - 1].id, true));
  else if (key === '/' && !isTyping && !ctrlKey && !altKey && grid) run(() => filter.focus());
  else if (key === 'F1') run(() => showKeys());
  else if (ctrlKey && key === 'Delete' && target.id === 'tree') run(() => removeSelected());
});

client.start();
