/* The values of entries that a node has besides its EDS or DCF, as rows of entry and value. */
class SetValues {
  /* `change(changes, isForced)` and `remove(changes)` return a rejection or null. */
  constructor({ change, remove, announce, focus }) {
    Object.assign(this, { change, removeItems: remove, announce, focus });
    this.rows = new Map();
    this.body = make('tbody');
    const complete = () => this.node.objects.filter((one) => !this.node.values.some((value) => value.entry === one.text)).map(({ text, name }) => ({ text, hint: name }));
    this.entry = new FormField({ label: 'New entry', isCompact: true, complete });
    this.value = new FormField({ label: 'Value of the new entry', isCompact: true, force: () => this.add(true) });
    this.addButton = make('button', { type: 'button', class: 'small', text: 'Add', 'aria-label': 'Add the entry', onclick: () => this.add() });
    const last = make('tr', {}, ...[this.entry.element, this.value.element, this.addButton].map((one) => make('td', {}, one)));
    last.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' || event.target.localName === 'button') return;
      event.preventDefault();
      if (!event.ctrlKey && this.entry.text.trim() && event.target === this.entry.input) this.value.input.focus();
      else this.add(event.ctrlKey);
    });
    this.element = make('section', { class: 'set-values', 'aria-labelledby': 'set-title' }, make('h3', { id: 'set-title', text: 'Values of entries (set)' }),
      make('table', { class: 'set-table' },
        make('thead', {}, make('tr', {}, ...['Entry', 'Value', ''].map((text) => (text ? make('th', { scope: 'col', text }) : make('td'))))),
        this.body, make('tfoot', {}, last)));
    this.element.addEventListener('focusin', () => this.focus());
  }

  show(node, isLocked) {
    if (this.node?.pointer !== node.pointer) this.clear();
    this.node = node;
    const shape = JSON.stringify(node.values.map((one) => one.pointer));
    if (shape !== this.shape) this.build(node.values);
    this.shape = shape;
    const names = new Map(node.objects.map((one) => [one.text.toLowerCase(), one.name]));
    for (const one of node.values) {
      const { entry, value, button } = this.rows.get(one.pointer);
      entry.set(one.entry, { isLocked, hint: names.get(one.entry.toLowerCase()) ?? '' });
      value.set(one.value, { isLocked });
      button.disabled = isLocked;
    }
    for (const field of [this.entry, this.value]) field.lock(isLocked);
    this.addButton.disabled = isLocked;
  }

  clear() {
    for (const field of [this.entry, this.value]) {
      field.show('');
      field.reject(null);
    }
  }

  build(values) {
    const hadFocus = this.body.contains(document.activeElement);
    const complete = () => this.node.objects.map(({ text, name }) => ({ text, hint: name }));
    this.rows = new Map(values.map(({ pointer, entry }) => [pointer, {
      entry: new FormField({ label: `Entry ${entry}`, isCompact: true, complete, change: (name, isForced) => this.change([name ? { do: 'rename', pointer, name } : { do: 'remove', pointer }], isForced) }),
      value: new FormField({ label: `Value of ${entry}`, isCompact: true, change: (value, isForced) => this.change([{ do: 'set', pointer, value }], isForced) }),
      button: make('button', { type: 'button', class: 'small', text: 'Remove', 'aria-label': `Remove ${entry}`, onclick: () => this.remove(pointer, entry) }),
    }]));
    this.body.replaceChildren(...[...this.rows.values()].map(({ entry, value, button }) => make('tr', {}, ...[entry.element, value.element, button].map((one) => make('td', {}, one)))));
    if (hadFocus) this.entry.input.focus();
  }

  async add(isForced = false) {
    const entry = this.entry.text.trim(), value = this.value.text.trim();
    this.entry.reject(entry ? null : { text: 'Type an entry, such as 6083h.' });
    this.value.reject(value || !entry ? null : { text: 'Type a value.' });
    if (!entry || !value) {
      (entry ? this.value : this.entry).input.focus();
      return;
    }
    const rejection = await this.change([{ do: 'set', pointer: `${this.node.pointer}/set/${pointerPart(entry)}`, value }], isForced);
    this.value.reject(rejection);
    if (rejection) return;
    this.clear();
    this.entry.input.focus();
    this.announce(`${entry} added.`);
  }

  async remove(pointer, entry) {
    const rejection = await this.removeItems([{ do: 'remove', pointer }]);
    this.announce(rejection?.text ?? `${entry} removed.`);
    if (!document.querySelector('dialog')) this.entry.input.focus();
  }

  /* Focuses the value of an entry. */
  reveal(pointer) {
    const row = this.rows.get(pointer);
    row?.value.input.focus();
    return Boolean(row);
  }
}
