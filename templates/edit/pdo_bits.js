/* The frame of a PDO: 8 bytes by 8 bits, in which each mapped object has its place. A row is a byte; an object has a cell in each byte. */
class PdoBits {
  /* `arrange(entries)` gets the mapped objects in a new order, or without one. `drop(object, place)` adds a dragged one. */
  constructor(element, { arrange, drop, activate }) {
    Object.assign(this, { element, arrange, drop, activate });
    this.entries = [];
    this.cells = [];
    this.active = { byte: 0, cell: 0 };
    this.awaited = null;  /* { entries, place }: the entries that an edit makes, and the place of the one that is active then */
    this.isLocked = false;
    setAttributes(element, { tabindex: 0, role: 'grid', 'aria-label': 'Frame: bytes and bits', 'aria-colcount': 9 });
    element.addEventListener('keydown', (event) => this.key(event));
    element.addEventListener('click', (event) => {
      const cell = event.target.closest('.bit-cell');
      if (!cell) return;
      element.focus({ preventScroll: true });
      this.moveTo(cell.byte, cell.place);
    });
    element.addEventListener('dragstart', (event) => {
      const cell = event.target.closest?.('.bit-cell');
      if (!cell || cell.entry < 0 || this.isLocked) {
        event.preventDefault();
        return;
      }
      event.dataTransfer.setData('application/x-mapped', String(cell.entry));
      event.dataTransfer.effectAllowed = 'move';
    });
    element.addEventListener('dragover', (event) => {
      const types = event.dataTransfer.types;
      if (this.isLocked || !(types.includes('application/x-mapped') || types.includes('application/x-mappable'))) return;
      event.preventDefault();
      this.markTarget(this.placeOf(event));
    });
    element.addEventListener('dragleave', () => this.markTarget(-1));
    element.addEventListener('drop', (event) => {
      event.preventDefault();
      const place = this.placeOf(event);
      this.markTarget(-1);
      const moved = event.dataTransfer.getData('application/x-mapped');
      if (moved !== '') this.move(Number(moved), place);
      else this.drop(JSON.parse(event.dataTransfer.getData('application/x-mappable')), place);
    });
  }

  placeOf(event) {
    const cell = event.target.closest?.('.bit-cell');
    return cell && cell.entry >= 0 ? cell.entry : this.entries.length;
  }

  markTarget(place) {
    for (const cell of this.cells.flat()) cell.classList.toggle('target', place >= 0 && cell.entry === (place < this.entries.length ? place : -1));
  }

  /* `entries`: [{ name, entry: '6041h:00', raw, bits, offset }]. */
  setEntries(entries, { isLocked = false, label = '', bytes = 8 } = {}) {
    this.entries = entries;
    this.isLocked = isLocked;
    setAttributes(this.element, { 'aria-label': `Frame of ${label}: bytes and bits`, 'aria-rowcount': bytes + 1 });
    this.cells = Array.from({ length: bytes }, (_, byte) => this.cellsOf(byte));
    const scale = make('div', { role: 'row', class: 'bit-row scale', 'aria-rowindex': 1 }, make('span', { role: 'columnheader', text: '' }, hidden('byte')),
      ...Array.from({ length: 8 }, (_, bit) => make('span', { role: 'columnheader', 'aria-label': `bit ${bit}`, text: String(bit) })));
    this.element.replaceChildren(scale, ...this.cells.map((cells, byte) => make('div', { role: 'row', class: 'bit-row', 'aria-rowindex': byte + 2 },
      make('span', { role: 'rowheader', class: 'byte', text: String(byte) }, hidden('. byte')), ...cells)));
    const awaited = this.hasAwaited() && this.cellOfEntry(this.awaited.place);
    if (awaited) {
      this.moveTo(awaited.byte, awaited.place);
      return;
    }
    this.active.byte = Math.min(this.active.byte, bytes - 1);
    this.active.cell = Math.min(this.active.cell, this.cells[this.active.byte].length - 1);
    this.showActive();
  }

  hasAwaited() {
    const wanted = this.awaited?.entries ?? [];
    return wanted.length > 0 && wanted.length === this.entries.length && wanted.every((one, place) => one.raw === this.entries[place].raw);
  }

  cellsOf(byte) {
    const first = byte * 8, end = first + 8;
    const cells = [];
    let at = first;
    const add = (upTo, place) => {
      const entry = this.entries[place];
      const isFirst = entry && entry.offset === at;
      const isLast = entry && entry.offset + entry.bits === upTo;
      const bits = upTo - at === 1 ? `bit ${at - first}` : `bits ${at - first} to ${upTo - first - 1}`;
      const cell = make('span', {
        role: 'gridcell', class: `bit-cell ${entry ? `mapped tone-${place % 2}` : 'free'}${entry?.isDummy ? ' dummy' : ''}${isFirst ? ' first' : ''}${isLast ? ' last' : ''}`,
        'aria-label': `byte ${byte} ${bits}, ${entry ? entry.name : 'free'}${isFirst ? ` ${entry.entry}` : ''}`, 'aria-selected': 'false', id: `bit-${byte}-${cells.length}`,
        draggable: entry && !this.isLocked ? 'true' : null, title: entry ? `${entry.name}, ${entry.entry}, ${plural(entry.bits, 'bit')}` : null,
      });
      if (isFirst) cell.append(make('span', { class: 'bit-name', text: entry.name }), ' ', ...(upTo - at > 3 ? [make('span', { class: 'bit-entry mono', text: entry.entry })] : []));
      cell.style.gridColumn = `${at - first + 2} / ${upTo - first + 2}`;
      Object.assign(cell, { byte, place: cells.length, entry: entry ? place : -1 });
      cells.push(cell);
      at = upTo;
    };
    this.entries.forEach((entry, place) => {
      const from = Math.max(entry.offset, first), to = Math.min(entry.offset + entry.bits, end);
      if (from >= to) return;
      if (from > at) add(from, -1);
      add(to, place);
    });
    if (at < end) add(end, -1);
    return cells;
  }

  get activeCell() {
    return this.cells[this.active.byte]?.[this.active.cell];
  }

  get activeEntry() {
    return this.activeCell?.entry ?? -1;
  }

  showActive() {
    const entry = this.activeEntry;
    for (const cell of this.cells.flat()) {
      const isActive = cell === this.activeCell;
      cell.classList.toggle('active', isActive);
      cell.classList.toggle('same', entry >= 0 && cell.entry === entry);
      setAttributes(cell, { 'aria-selected': String(isActive) });
    }
    setAttributes(this.element, { 'aria-activedescendant': this.activeCell?.id });
    this.activate(entry);
  }

  moveTo(byte, cell) {
    if (this.cells.length === 0) return;
    this.active.byte = Math.max(0, Math.min(this.cells.length - 1, byte));
    this.active.cell = Math.max(0, Math.min(this.cells[this.active.byte].length - 1, cell));
    this.showActive();
    this.activeCell.scrollIntoView({ block: 'nearest', inline: 'nearest' });
  }

  cellOfEntry(place) {
    return this.cells.flat().find((one) => one.entry === place);
  }

  key(event) {
    const { key, altKey, ctrlKey, metaKey } = event;
    if (ctrlKey || metaKey) return;
    const step = { ArrowUp: -1, ArrowLeft: -1, ArrowDown: 1, ArrowRight: 1 }[key];
    if (altKey && step) {
      event.preventDefault();
      this.moveBy(step);
    } else if (key === 'ArrowUp' || key === 'ArrowDown') {
      event.preventDefault();
      const bit = Number.parseInt(this.activeCell.style.gridColumnStart, 10);
      const byte = Math.max(0, Math.min(this.cells.length - 1, this.active.byte + step));
      const cells = this.cells[byte];
      const at = cells.findIndex((one) => Number.parseInt(one.style.gridColumnStart, 10) <= bit && bit < Number.parseInt(one.style.gridColumnEnd, 10));
      this.moveTo(byte, at);
    } else if (key === 'ArrowLeft' || key === 'ArrowRight') {
      event.preventDefault();
      const all = this.cells.flat();
      const next = all[Math.max(0, Math.min(all.length - 1, all.indexOf(this.activeCell) + step))];
      this.moveTo(next.byte, next.place);
    } else if (key === 'Home') {
      event.preventDefault();
      this.moveTo(0, 0);
    } else if (key === 'End') {
      event.preventDefault();
      this.moveTo(this.cells.length - 1, 99);
    } else if (key === 'Delete' || key === 'Backspace') {
      event.preventDefault();
      this.removeActive();
    }
  }

  moveBy(step) {
    const at = this.activeEntry;
    if (at < 0 || at + step < 0 || at + step >= this.entries.length) return;
    this.move(at, step < 0 ? at - 1 : at + 2);
  }

  /* Moves the object before the one that is now at `place`. */
  async move(at, place) {
    if (this.isLocked || place === at || place === at + 1) return;
    const entries = [...this.entries];
    const [moved] = entries.splice(at, 1);
    const to = place > at ? place - 1 : place;
    entries.splice(to, 0, moved);
    await this.arrangeAndShow(entries, to, `${moved.name} is now object ${to + 1} of ${entries.length}.`);
  }

  /* The new state can arrive before the answer to the edit: the object is active as soon as the entries are shown. */
  async arrangeAndShow(entries, place, text) {
    const awaited = { entries, place };
    this.awaited = awaited;
    await this.arrange(entries, text);
    if (this.awaited === awaited) this.awaited = null;
  }

  async removeActive() {
    const at = this.activeEntry;
    if (at < 0 || this.isLocked) return;
    const entries = this.entries.filter((_, place) => place !== at);
    await this.arrangeAndShow(entries, Math.min(at, entries.length - 1), `${this.entries[at].name} removed.`);
  }
}
