/* Entries as a spreadsheet: a row for each entry, a column for each key. It holds no rules of CANopen: an edit goes to the server,
   which changes the file or rejects the text. A rejected text remains in its cell, with the message below the row, and a button if it can
   be applied anyway. */
class EntryGrid {
  /* `columns`: { key, title, width: the least in rem, share: of the rest, kind: 'text' | 'number' | 'choice' | 'fixed',
     choices: () => texts }.
     `change(edits, isForced)`: sends [{ row, key, text }]; returns the rejections, { text, canForce }, by the places in `edits`. */
  constructor(element, { columns, change, activate, act }) {
    Object.assign(this, { element, columns, change, activate, act });
    this.rows = [];
    this.slots = [];
    this.slotOfRow = [];
    this.rejected = new Map();
    this.sent = new Map();
    this.active = { row: 0, column: 0 };
    this.anchor = { row: 0, column: 0 };
    this.editor = null;
    this.isLocked = false;
    this.head = make('div', { class: 'grid-head', role: 'rowgroup' }, make('div', { role: 'row', class: 'grid-row', 'aria-rowindex': 1 },
      ...columns.map((column, at) => make('span', {
        role: 'columnheader', class: `cell ${column.kind}`, 'aria-colindex': at + 1, text: column.title, title: column.help,
      }))));
    this.body = make('div', { class: 'grid-body', role: 'rowgroup' });
    this.empty = make('p', { class: 'empty', hidden: true });
    element.append(this.head, this.body, this.empty);
    element.style.setProperty('--columns', columns.map(({ width, share }) => (share ? `minmax(${width}rem, ${share}fr)` : `${width}rem`)).join(' '));
    element.style.setProperty('--least', `${columns.reduce((sum, column) => sum + column.width, 0)}rem`);
    setAttributes(element, { role: 'grid', tabindex: 0, 'aria-colcount': columns.length, 'aria-multiselectable': 'true' });
    this.view = new VirtualRows({
      scroller: element, body: this.body, create: () => this.createRow(), draw: (row, at) => this.drawSlot(row, at),
      headHeight: () => this.head.offsetHeight,
    });
    element.addEventListener('keydown', (event) => this.key(event));
    element.addEventListener('pointerdown', (event) => this.press(event));
    element.addEventListener('dblclick', (event) => {
      if (this.placeOf(event.target) && !this.editor) this.edit();
    });
    document.addEventListener('copy', (event) => this.copy(event));
    document.addEventListener('paste', (event) => this.paste(event));
    element.addEventListener('focus', () => this.showActive());
    element.addEventListener('scroll', () => {
      if ((element.scrollLeft > 0) !== element.classList.contains('shifted')) element.classList.toggle('shifted', element.scrollLeft > 0);
    }, { passive: true });
  }

  /* Rows */

  /* `rows`: { id, section, cells: { KEY: text }, choices, locked, marks }. The same entry stays active. */
  setRows(rows, emptyText = '') {
    const before = this.rows[this.active.row]?.id;
    const typed = this.takeTyped();
    this.rows = rows;
    this.placeOfId = new Map(rows.map((row, at) => [row.id, at]));
    const at = this.placeOfId.get(before);
    if (at !== undefined) {
      const moved = at - this.active.row;
      this.active.row = at;
      this.anchor.row = Math.max(0, Math.min(rows.length - 1, this.anchor.row + moved));
    } else {
      this.active.row = Math.min(this.active.row, Math.max(0, rows.length - 1));
      this.anchor = { ...this.active };
    }
    setText(this.empty, emptyText);
    this.empty.hidden = rows.length > 0;
    this.layOut();
    if (typed && this.rows[this.active.row]?.id === typed.id) this.edit(typed.text);
  }

  /* The text of an open editor, which closes: the rows below it move. */
  takeTyped() {
    if (!this.editor) return null;
    const typed = { id: this.rows[this.editor.row].id, text: this.editor.input.value };
    this.closeEditor();
    this.element.focus({ preventScroll: true });
    return typed;
  }

  /* Two rows of height below a row with a rejected text are for its message. */
  layOut() {
    this.slots = [];
    this.slotOfRow = [];
    const withMessage = new Set([...this.rejected.values()].map((one) => this.placeOfId?.get(one.id)));
    this.rows.forEach((_, row) => {
      this.slotOfRow.push(this.slots.length);
      this.slots.push({ row });
      if (withMessage.has(row)) this.slots.push({ messageOf: row }, { isTail: true });
    });
    setAttributes(this.element, { 'aria-rowcount': this.rows.length + 1 });
    this.view.reset(this.slots.length, this.slotOfRow[this.active.row] ?? -1);
    this.showActive(false);
  }

  redraw() {
    this.view.reset(this.slots.length);
  }

  keyOf(row, column) {
    return `${row.id} ${column.key}`;
  }

  createRow() {
    const cells = this.columns.map((column, at) => {
      const cell = make('span', { role: 'gridcell', 'aria-colindex': at + 1 });
      cell.column = at;
      return cell;
    });
    const row = make('div', { role: 'row', class: 'grid-row' }, ...cells);
    row.cells = cells;
    return row;
  }

  isLockedCell(row, column) {
    return this.isLocked || column.kind === 'fixed' || row.locked || row.lockedKeys?.includes(column.key) || row.cells[column.key] === undefined;
  }

  drawSlot(element, at) {
    const slot = this.slots[at];
    if (slot.row === undefined) {
      this.drawMessage(element, slot);
      return;
    }
    if (element.firstChild !== element.cells[0]) element.replaceChildren(...element.cells);
    const row = this.rows[slot.row];
    element.row = slot.row;
    element.className = `grid-row${row.locked ? ' locked' : ''}${row.isHead ? ' object-head' : ''}`;
    setAttributes(element, { role: 'row', 'aria-rowindex': slot.row + 2, 'aria-hidden': null });
    const { top, bottom, left, right } = this.selected;
    this.columns.forEach((column, place) => {
      const cell = element.cells[place];
      if (this.editor?.cell === cell && this.editor.row === slot.row) return;
      const rejected = this.rejected.get(this.keyOf(row, column));
      const sent = this.sent.get(this.keyOf(row, column));
      const isActive = slot.row === this.active.row && place === this.active.column;
      const isSelected = slot.row >= top && slot.row <= bottom && place >= left && place <= right;
      const text = rejected ? rejected.text : sent ?? row.cells[column.key] ?? '';
      const isLocked = this.isLockedCell(row, column);
      const names = `cell ${column.kind}${isLocked && column.kind !== 'fixed' ? ' fixed-cell' : ''}${isActive ? ' active' : ''}` +
        `${isSelected && !isActive ? ' selected' : ''}${rejected ? ' rejected' : ''}${sent !== undefined ? ' sent' : ''}`;
      if (cell.className !== names) cell.className = names;
      if (column.draw) {
        if (cell.drawnRow !== row || cell.drawnMarks !== row.marks) cell.replaceChildren(...column.draw(row));
        Object.assign(cell, { drawnRow: row, drawnMarks: row.marks });
      } else {
        setText(cell, text);
      }
      cell.id = `entry-${slot.row}-${place}`;
      setAttributes(cell, {
        'aria-selected': String(isSelected), 'aria-readonly': isLocked ? 'true' : 'false',
        'aria-invalid': rejected ? 'true' : null, 'aria-describedby': rejected ? `message-${slot.row}` : null, title: row.titles?.[column.key],
      });
    });
  }

  drawMessage(element, slot) {
    element.row = slot.messageOf;
    if (slot.isTail) {
      element.className = 'grid-row tail';
      element.replaceChildren();
      setAttributes(element, { role: 'presentation', 'aria-rowindex': null, 'aria-hidden': 'true' });
      return;
    }
    const row = this.rows[slot.messageOf];
    const lines = this.columns.map((column) => [column, this.rejected.get(this.keyOf(row, column))]).filter(([, one]) => one);
    element.className = 'grid-row message';
    setAttributes(element, { role: 'row', 'aria-rowindex': null, 'aria-hidden': null });
    const id = `message-${slot.messageOf}`;
    const shown = element.firstChild;
    /* A button keeps the focus. */
    if (shown?.id === id && shown.lines?.length === lines.length && lines.every(([, one], at) => one === shown.lines[at][1])) return;
    const cell = make('span', { role: 'gridcell', class: 'message-text', id },
      ...lines.flatMap(([column, one], at) => [at > 0 && ' ', make('b', { text: `${column.title}: ` }), one.message,
        one.canForce && forceButton(`${column.title} of ${row.label}`, () => this.applyAnyway(row, column))]));
    cell.lines = lines;
    element.replaceChildren(cell);
  }

  /* The active cell and the selection */

  get selected() {
    const { active, anchor } = this;
    return { top: Math.min(active.row, anchor.row), bottom: Math.max(active.row, anchor.row),
      left: Math.min(active.column, anchor.column), right: Math.max(active.column, anchor.column) };
  }

  get activeRow() {
    return this.rows[this.active.row];
  }

  get selectedRows() {
    const { top, bottom } = this.selected;
    return this.rows.slice(top, bottom + 1);
  }

  showActive(isScrolled = true) {
    const slot = this.slotOfRow[this.active.row];
    if (slot === undefined) {
      setAttributes(this.element, { 'aria-activedescendant': null });
      return;
    }
    this.view.keep(slot);
    if (isScrolled) this.view.scrollTo(slot);
    else this.view.update();
    setAttributes(this.element, { 'aria-activedescendant': `entry-${this.active.row}-${this.active.column}` });
    if (isScrolled) this.showColumn();
  }

  /* Narrow screens show a part of the columns. */
  showColumn() {
    const element = this.view.shown.get(this.slotOfRow[this.active.row]);
    const cell = element?.cells[this.active.column];
    if (!cell) return;
    const fixed = matchMedia('(max-width: 45rem)').matches ? 0 : element.cells[0].offsetWidth;
    const left = cell.offsetLeft, right = left + cell.offsetWidth;
    if (this.active.column === 0) this.element.scrollLeft = 0;
    else if (left - fixed < this.element.scrollLeft) this.element.scrollLeft = left - fixed;
    else if (right > this.element.scrollLeft + this.element.clientWidth) this.element.scrollLeft = right - this.element.clientWidth;
  }

  moveTo(row, column, isExtended = false) {
    if (this.rows.length === 0) return;
    const before = this.selected, beforeRow = this.active.row;
    this.active = { row: Math.max(0, Math.min(this.rows.length - 1, row)), column: Math.max(0, Math.min(this.columns.length - 1, column)) };
    if (!isExtended) this.anchor = { ...this.active };
    const after = this.selected;
    this.showActive();
    for (const [, element] of this.view.shown) {
      const at = element.row;
      const isIn = (range) => at >= range.top && at <= range.bottom;
      if (isIn(before) || isIn(after)) this.view.redraw(this.slotOfRow[at]);
    }
    if (beforeRow !== this.active.row || before.top !== after.top || before.bottom !== after.bottom) this.activate?.(this.activeRow);
  }

  goTo(id, key) {
    const row = this.placeOfId?.get(id);
    if (row === undefined) return false;
    const column = this.columns.findIndex((one) => one.key === key);
    this.moveTo(row, column < 0 ? this.active.column : column);
    return true;
  }

  placeOf(target) {
    const cell = target.closest?.('[role=gridcell]');
    const row = cell?.parentElement;
    if (!row || row.row === undefined || cell.column === undefined) return null;
    return { row: row.row, column: cell.column };
  }

  press(event) {
    if (event.button !== 0 || event.target.closest('.editor')) return;
    const place = this.placeOf(event.target);
    if (!place) return;
    if (this.editor) this.commit(false);
    this.element.focus({ preventScroll: true });
    this.moveTo(place.row, place.column, event.shiftKey);
    if (event.shiftKey) event.preventDefault();
  }

  key(event) {
    if (this.editor) {
      this.keyInEditor(event);
      return;
    }
    if (event.target !== this.element) return;  /* a button of a message */
    const { key, shiftKey, ctrlKey, metaKey, altKey } = event;
    const isControl = ctrlKey || metaKey;
    const { row, column } = this.active;
    const last = this.rows.length - 1;
    const moves = {
      ArrowUp: () => [isControl ? 0 : row - 1, column],
      ArrowDown: () => [isControl ? last : row + 1, column],
      ArrowLeft: () => [row, isControl ? 0 : column - 1],
      ArrowRight: () => [row, isControl ? this.columns.length - 1 : column + 1],
      Home: () => [isControl ? 0 : row, 0],
      End: () => [isControl ? last : row, this.columns.length - 1],
      PageUp: () => [row - this.view.rowsOfPage, column],
      PageDown: () => [row + this.view.rowsOfPage, column],
    };
    if (moves[key] && !altKey) {
      event.preventDefault();
      this.moveTo(...moves[key](), shiftKey);
    } else if (altKey && key === 'ArrowDown') {
      event.preventDefault();
      this.edit();
    } else if (isControl && key === 'Delete') {
      event.preventDefault();
      this.act?.('remove');
    } else if (isControl && key.toLowerCase() === 'a') {
      event.preventDefault();
      this.anchor = { row: 0, column: 0 };
      this.active = { row: last, column: this.columns.length - 1 };
      this.redraw();
      this.activate?.(this.activeRow);
    } else if (isControl && key === 'Enter') {
      event.preventDefault();
      this.force();
    } else if (key === 'Enter' || key === 'F2') {
      event.preventDefault();
      this.edit();
    } else if (key === 'Delete' || key === 'Backspace') {
      event.preventDefault();
      this.clearSelected();
    } else if (key === 'Escape') {
      this.discard();
    } else if (key.length === 1 && !isControl && !altKey && key !== '/') {
      event.preventDefault();
      this.edit(key === ' ' ? undefined : key);
    }
  }

  /* Edits */

  /* `text` replaces the text of the cell. */
  edit(text) {
    const { row: at, column: place } = this.active;
    const row = this.rows[at], column = this.columns[place];
    if (!row) return;
    if (this.isLockedCell(row, column)) {
      this.act?.('locked', { row, column });
      return;
    }
    this.showActive();
    const cell = this.view.shown.get(this.slotOfRow[at]).cells[place];
    const rejected = this.rejected.get(this.keyOf(row, column));
    const count = this.selectedRows.length;
    const input = make('input', {
      class: 'editor', type: 'text', autocomplete: 'off', spellcheck: 'false',
      'aria-label': `${column.title} of ${row.label}${count > 1 ? `, for ${count} rows` : ''}`,
      'aria-invalid': rejected ? 'true' : null, 'aria-describedby': rejected ? `message-${at}` : null,
    });
    input.value = text ?? (rejected ? rejected.text : row.cells[column.key] ?? '');
    cell.replaceChildren(input, ...(count > 1 ? [make('span', { class: 'applies', text: `${count} rows` })] : []));
    cell.classList.add('editing');
    this.editor = { row: at, cell, input, column, box: null };
    input.focus({ preventScroll: true });
    if (text === undefined) input.select();
    if (column.kind === 'choice') {
      this.editor.box = new ChoiceBox(input, column.choices(row), (chosen) => {
        input.value = chosen;
        this.editor.box.at = -1;
        this.editor.box.isFiltered = false;
        this.commit(true, chosen);
      });
      if (text !== undefined) {
        this.editor.box.isFiltered = true;
        this.editor.box.draw();
      }
    }
    input.addEventListener('blur', () => {
      if (this.editor?.input === input) this.commit(false);
    });
  }

  keyInEditor(event) {
    const { key, shiftKey } = event;
    if (this.editor.box?.key(event)) return;
    if (key === 'Enter') {
      event.preventDefault();
      this.commit(true);
      if (this.selectedRows.length === 1) this.moveTo(this.active.row + (shiftKey ? -1 : 1), this.active.column);
    } else if (key === 'Tab') {
      event.preventDefault();
      this.commit(true);
      this.moveTo(this.active.row, this.active.column + (shiftKey ? -1 : 1));
    } else if (key === 'Escape') {
      event.preventDefault();
      event.stopPropagation();
      this.closeEditor();
      this.element.focus({ preventScroll: true });
    } else if ((key === 'ArrowUp' || key === 'ArrowDown') && !this.editor.box) {
      event.preventDefault();
      this.commit(true);
      this.moveTo(this.active.row + (key === 'ArrowUp' ? -1 : 1), this.active.column);
    }
  }

  closeEditor() {
    const { editor } = this;
    if (!editor) return;
    this.editor = null;
    editor.box?.close();
    editor.cell.replaceChildren();
    this.view.redraw(this.slotOfRow[editor.row]);
  }

  /* Sends the text of the editor for all selected rows. */
  commit(isFocused, chosen) {
    const { editor } = this;
    if (!editor) return;
    const text = chosen ?? (editor.box ? editor.box.value : editor.input.value);
    const column = editor.column;
    const rows = this.selectedRows.filter((row) => !this.isLockedCell(row, column));
    this.closeEditor();
    if (isFocused) this.element.focus({ preventScroll: true });
    this.send(rows.map((row) => ({ row, column, text })));
  }

  clearSelected() {
    const { left, right } = this.selected;
    const edits = [];
    for (const row of this.selectedRows) {
      for (const column of this.columns.slice(left, right + 1)) {
        if (!this.isLockedCell(row, column) && column.kind !== 'choice') edits.push({ row, column, text: '' });
      }
    }
    this.send(edits);
  }

  /* Drops the rejected texts of the selected rows. */
  discard() {
    let isChanged = false;
    const { left, right } = this.selected;
    for (const row of this.selectedRows) {
      for (const column of this.columns.slice(left, right + 1)) isChanged = this.rejected.delete(this.keyOf(row, column)) || isChanged;
    }
    this.anchor = { ...this.active };
    if (isChanged) this.layOut();
    else this.redraw();
  }

  /* Sends the rejected texts of the selected rows again, against the findings that they add. */
  force() {
    const { left, right } = this.selected;
    const edits = [];
    for (const row of this.selectedRows) {
      for (const column of this.columns.slice(left, right + 1)) {
        const rejected = this.rejected.get(this.keyOf(row, column));
        if (rejected) edits.push({ row, column, text: rejected.text });
      }
    }
    this.send(edits, true);
  }

  /* Sends one rejected text again. */
  applyAnyway(row, column) {
    this.element.focus({ preventScroll: true });
    this.goTo(row.id, column.key);
    this.send([{ row, column, text: this.rejected.get(this.keyOf(row, column)).text }], true);
  }

  async send(all, isForced = false) {
    const edits = all.filter(({ row, column, text }) => this.rejected.has(this.keyOf(row, column)) || text.trim() !== (row.cells[column.key] ?? ''));
    for (const { row, column } of all) {
      const key = this.keyOf(row, column);
      if (this.rejected.get(key)) this.rejected.delete(key);
    }
    const changed = edits.filter(({ row, column, text }) => text.trim() !== (row.cells[column.key] ?? ''));
    if (changed.length === 0) {
      if (edits.length) this.layOut();
      return;
    }
    for (const { row, column, text } of changed) this.sent.set(this.keyOf(row, column), text);
    this.redraw();
    const rejections = await this.change(changed.map(({ row, column, text }) => ({ row, key: column.key, text: text.trim() })), isForced);
    changed.forEach(({ row, column, text }, at) => {
      const key = this.keyOf(row, column);
      this.sent.delete(key);
      if (rejections[at]) this.rejected.set(key, { id: row.id, text, message: rejections[at].text, canForce: rejections[at].canForce });
    });
    this.layOut();
  }

  copy(event) {
    if (document.activeElement !== this.element || this.rows.length === 0) return;
    const { left, right } = this.selected;
    const lines = this.selectedRows.map((row) => this.columns.slice(left, right + 1).map((column) => row.cells[column.key] ?? '').join('\t'));
    event.clipboardData.setData('text/plain', lines.join('\n'));
    event.preventDefault();
  }

  /* Cells from the active one on; one text fills all selected cells. */
  paste(event) {
    if (document.activeElement !== this.element || this.rows.length === 0) return;
    event.preventDefault();
    const lines = event.clipboardData.getData('text/plain').replace(/\r\n?/g, '\n').replace(/\n$/, '').split('\n').map((line) => line.split('\t'));
    const { top, left, bottom, right } = this.selected;
    const isFill = lines.length === 1 && lines[0].length === 1;
    const height = isFill ? bottom - top + 1 : lines.length;
    const edits = [];
    let skipped = 0;
    for (let at = 0; at < height; ++at) {
      const row = this.rows[top + at];
      const texts = isFill ? Array(right - left + 1).fill(lines[0][0]) : lines[at];
      texts.forEach((text, place) => {
        const column = this.columns[left + place];
        if (row && column && !this.isLockedCell(row, column)) edits.push({ row, column, text });
        else if (!row || !column || text !== (row.cells[column.key] ?? '')) ++skipped;
      });
    }
    if (!isFill) {
      this.anchor = { row: top, column: left };
      this.active = { row: Math.min(this.rows.length - 1, top + lines.length - 1),
        column: Math.min(this.columns.length - 1, left + Math.max(...lines.map((line) => line.length)) - 1) };
    }
    this.act?.('pasted', { count: edits.length, skipped });
    this.send(edits);
  }
}
