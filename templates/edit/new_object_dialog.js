/* New objects: of the standards, described here, copied, or from another EDS. */
class NewObjectDialog {
  static kinds = [['standard', 'Of the standard'], ['VAR', 'VAR'], ['ARRAY', 'ARRAY'], ['RECORD', 'RECORD'], ['copy', 'Copy'], ['import', 'From another EDS']];

  /* `state()`: { choices, standard, objects }; `change(changes)` returns a rejection or null; `added(index)` shows the object. */
  constructor({ client, state, change, added }) {
    Object.assign(this, { client, state, change, added });
  }

  open(from = '') {
    if (this.dialog) return;
    this.kind = 'standard';
    this.from = from;
    this.picked = new Set();
    this.imported = [];
    this.fields = make('div', {});
    const kinds = make('fieldset', { class: 'kinds' }, make('legend', { text: 'Kind' }), ...NewObjectDialog.kinds.map(([kind, text]) => make('label', {},
      make('input', { type: 'radio', name: 'new-kind', value: kind, checked: kind === this.kind, onchange: () => this.show(kind) }), text)));
    this.button = make('button', { type: 'submit', class: 'main', text: 'Add' });
    this.dialog = new Dialog({ title: 'New object', body: [kinds, this.fields], actions: [this.button], onclose: () => { this.dialog = null; } });
    const form = make('form', { class: 'dialog-form' });
    form.append(...this.dialog.element.children);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.add();
    });
    this.dialog.element.append(form);
    this.show(this.kind);
    this.query?.focus();
  }

  input(label, value = '', hint = '') {
    const id = `new-${label.toLowerCase().replaceAll(/[^a-z]+/g, '-')}`;
    const input = make('input', { id, type: 'text', autocomplete: 'off', spellcheck: 'false', 'aria-describedby': hint ? `${id}-hint` : null });
    input.value = value;
    return { input, element: make('div', { class: 'field' }, make('label', { for: id, text: label }), input, hint && make('span', { class: 'field-hint', id: `${id}-hint`, text: hint })) };
  }

  select(label, texts, value) {
    const id = `new-${label.toLowerCase()}`;
    const input = make('select', { id }, ...texts.map((text) => make('option', { text, selected: text === value })));
    return { input, element: make('div', { class: 'field' }, make('label', { for: id, text: label }), input) };
  }

  show(kind) {
    this.kind = kind;
    this.picked.clear();
    this.query = null;
    this.dialog.reject('');
    const { choices, standard } = this.state();
    if (kind === 'standard') {
      this.fields.replaceChildren(...this.list(standard.objects));
    } else if (kind === 'copy') {
      this.copyFrom = this.input('Object', this.from);
      this.copyTo = this.input('New index', '', 'one or more, such as 2010h 2020h');
      this.fields.replaceChildren(this.copyFrom.element, this.copyTo.element);
    } else if (kind === 'import') {
      const file = make('input', { type: 'file', id: 'new-file', accept: '.eds,.dcf', onchange: () => this.read(file.files[0]) });
      this.found = make('div', {});
      this.fields.replaceChildren(make('div', { class: 'field' }, make('label', { for: 'new-file', text: 'EDS or DCF' }), file), this.found);
    } else {
      this.index = this.input('Index', this.nextIndex());
      this.name = this.input('Name');
      this.type = this.select('Type', choices.types.map((one) => one.name), 'UNSIGNED16');
      this.access = this.select('Access', choices.access, 'rw');
      this.elements = this.input(kind === 'ARRAY' ? 'Elements' : 'Entries', '2', 'without sub-index 0');
      const id = 'new-mappable';
      this.mappable = make('input', { type: 'checkbox', id });
      this.fields.replaceChildren(this.index.element, this.name.element, this.type.element, this.access.element,
        ...(kind === 'VAR' ? [] : [this.elements.element]), make('div', { class: 'field check' }, this.mappable, make('label', { for: id, text: 'PDO-mappable' })));
    }
  }

  /* The first index of the manufacturer's area that no object has. */
  nextIndex() {
    const used = new Set(this.state().objects);
    for (let index = 0x2000; index < 0x6000; ++index) {
      const text = index.toString(16).toUpperCase();
      if (!used.has(text)) return `${text}h`;
    }
    return '';
  }

  /* Objects to check, with a search. */
  list(objects) {
    const found = make('ul', { class: 'pick' });
    const count = make('p', { class: 'quiet', role: 'status' });
    const draw = () => {
      const words = this.query.value.toLowerCase().split(/\s+/).filter(Boolean);
      const shown = objects.filter((one) => words.every((word) => `${one.index}h ${one.name}`.toLowerCase().includes(word)));
      found.replaceChildren(...shown.slice(0, 300).map((one) => {
        const box = make('input', { type: 'checkbox', checked: this.picked.has(one.index) });
        box.addEventListener('change', () => {
          if (box.checked) this.picked.add(one.index);
          else this.picked.delete(one.index);
          tell();
        });
        return make('li', {}, make('label', {}, box, make('span', { class: 'mono', text: `${one.index}h` }), make('span', { text: one.name })));
      }));
      this.only = words.length && shown.length === 1 ? shown[0].index : null;
      tell(shown.length);
    };
    const tell = (shown) => {
      if (shown !== undefined) this.shown = shown;
      setText(count, `${this.shown} of ${plural(objects.length, 'object')}${this.picked.size ? `, ${this.picked.size} chosen` : ''}`);
    };
    this.query = make('input', { type: 'search', 'aria-label': 'Search objects', placeholder: 'Index or name', autocomplete: 'off', spellcheck: 'false', oninput: draw });
    draw();
    return [this.query, make('div', { class: 'box' }, found), count];
  }

  async read(file) {
    if (!file) return;
    const answer = await this.client.ask('POST', 'import', { text: await file.text() });
    this.dialog?.reject(answer.error ?? '');
    this.found.replaceChildren(...(answer.objects ? this.list(answer.objects) : []));
    this.query?.focus();
  }

  get changes() {
    const { kind } = this;
    const index = (text) => text.trim().replace(/^0x/i, '').replace(/h$/i, '').toUpperCase();
    if (kind === 'standard' || kind === 'import') {
      const objects = this.picked.size ? [...this.picked] : this.only ? [this.only] : [];
      return objects.length ? [{ do: 'new', kind, objects: objects.sort() }] : [];
    }
    if (kind === 'copy') {
      const to = this.copyTo.input.value.split(/[\s,;]+/).filter(Boolean).map(index);
      return to.length ? [{ do: 'new', kind, from: index(this.copyFrom.input.value), to }] : [];
    }
    const change = { do: 'new', kind, index: index(this.index.input.value), name: this.name.input.value.trim(), type: this.type.input.value,
      access: this.access.input.value, mappable: this.mappable.checked };
    if (kind !== 'VAR') change.elements = Number(this.elements.input.value);
    return [change];
  }

  async add() {
    const { changes } = this;
    if (changes.length === 0) {
      this.dialog.reject(this.kind === 'copy' ? 'Type a new index.' : 'Choose an object.');
      return;
    }
    this.button.disabled = true;
    const rejected = await this.change(changes);
    this.button.disabled = false;
    if (rejected) {
      this.dialog.reject([rejected.message, ...(rejected.findings ?? []).map((one) => one.message)].filter(Boolean).join(' '));
      return;
    }
    const [first] = changes;
    this.dialog.close();
    this.added(first.index ?? first.objects?.[0] ?? first.to[0]);
  }
}
