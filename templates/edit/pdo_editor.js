/* PDOs: their list, the parameters and the frame of one of them, and the objects that it can map. The server says what fits. */
class PdoEditor {
  static cobIdKinds = [
    { value: 'predefined', text: 'pre-defined' }, { value: 'node', text: '$NODEID + number' }, { value: 'fixed', text: 'fixed CAN-ID' },
    { value: 'disabled', text: 'disabled' },
  ];

  constructor(element, { change, announce, reveal, showSection }) {
    Object.assign(this, { element, change, announce, reveal, showSection });
    this.list = [];
    this.found = [];
    this.at = 0;
    this.candidate = 0;
    this.isLocked = false;
    this.buildList();
    this.buildMain();
  }

  buildList() {
    this.newTpdo = make('button', { type: 'button', text: 'New TPDO', onclick: () => this.add('tpdo') });
    this.newRpdo = make('button', { type: 'button', text: 'New RPDO', onclick: () => this.add('rpdo') });
    this.items = make('ul', { class: 'item-list', role: 'listbox', tabindex: 0, 'aria-label': 'PDOs' });
    this.items.addEventListener('keydown', (event) => {
      const next = { ArrowUp: this.at - 1, ArrowDown: this.at + 1, Home: 0, End: this.list.length - 1 }[event.key];
      if (next !== undefined && !event.altKey) {
        event.preventDefault();
        this.select(next);
      } else if (event.key === 'Enter') {
        event.preventDefault();
        this.candidates.focus();
      } else if (event.key === 'Delete' && event.ctrlKey) {
        event.preventDefault();
        this.remove();
      }
    });
    this.items.addEventListener('click', (event) => {
      const item = event.target.closest('li');
      if (item) this.select([...this.items.children].indexOf(item));
    });
    this.element.append(make('div', { class: 'pdo-list-side' },
      make('div', { class: 'actions', role: 'group', 'aria-label': 'PDOs' }, this.newTpdo, this.newRpdo), this.items));
  }

  buildMain() {
    const set = (key) => (text, isForced) => this.send({ [key]: text }, isForced);
    this.fields = {
      kind: new FormField({ label: 'COB-ID', kind: 'choice', choices: PdoEditor.cobIdKinds, change: (kind, isForced) => this.setKind(kind, isForced) }),
      value: new FormField({ label: 'CAN-ID or offset', change: (value, isForced) => this.send({ cob_id: { kind: this.kind, value } }, isForced) }),
      type: new FormField({ label: 'Transmission type', change: set('type') }),
      inhibit: new FormField({ label: 'Inhibit time in ms', change: set('inhibit_ms') }),
      event: new FormField({ label: 'Event timer in ms', change: set('event_ms') }),
      sync: new FormField({ label: 'SYNC start value', change: set('sync_start') }),
    };
    this.title = make('h2', { id: 'pdo-title' });
    this.removeButton = make('button', { type: 'button', class: 'small', text: 'Remove this PDO', onclick: () => this.remove() });
    this.bitsElement = make('div', { class: 'bits' });
    this.bits = new PdoBits(this.bitsElement, {
      arrange: (entries, text) => this.arrange(entries, text), drop: (object, place) => this.map(object, place), activate: () => this.showActive(),
    });
    this.earlier = make('button', { type: 'button', class: 'small', text: 'Move earlier', onclick: () => this.bits.moveBy(-1) });
    this.later = make('button', { type: 'button', class: 'small', text: 'Move later', onclick: () => this.bits.moveBy(1) });
    this.unmap = make('button', { type: 'button', class: 'small', text: 'Remove from PDO', onclick: () => this.bits.removeActive() });
    this.activeText = make('span', {});
    this.mapped = make('tbody');
    this.lockedText = make('p', { class: 'quiet' });
    this.empty = make('p', { class: 'empty', text: 'No PDO. New TPDO or New RPDO adds one.' });
    this.main = make('div', { class: 'pdo-main' }, this.empty, this.content = make('div', {},
      make('div', { class: 'pdo-head' }, this.title, this.removeButton),
      make('div', { class: 'pdo-fields' }, ...Object.values(this.fields).map((field) => field.element)),
      this.lockedText,
      make('div', { class: 'pdo-work' },
        make('div', {}, this.bitsElement,
          make('div', { class: 'pdo-active' }, this.activeText, this.earlier, this.later, this.unmap),
          make('div', { class: 'mapped-scroll', tabindex: 0, role: 'group', 'aria-label': 'Mapping entries' }, make('table', { class: 'mapped-table' },
            make('thead', {}, make('tr', {}, ...['Sub', 'Entry', 'Object', 'Name', 'Bits'].map((text) => make('th', { scope: 'col', text })))), this.mapped))),
        this.buildCandidates())));
    this.element.append(this.main);
  }

  buildCandidates() {
    this.query = make('input', { type: 'search', 'aria-label': 'Search mappable objects', placeholder: 'Search', autocomplete: 'off', spellcheck: 'false' });
    this.query.addEventListener('input', () => {
      this.candidate = 0;
      this.showCandidates();
    });
    this.query.addEventListener('keydown', (event) => {
      if (event.key === 'ArrowDown' || event.key === 'Enter') {
        event.preventDefault();
        this.candidates.focus();
      }
    });
    this.candidates = make('div', { class: 'mappable-list', tabindex: 0 });
    this.candidateBody = make('div', { class: 'mappable-body', role: 'presentation' });
    this.noCandidates = make('p', { class: 'empty', hidden: true });
    this.candidates.append(this.candidateBody, this.noCandidates);
    this.reason = make('p', { role: 'status' });
    this.mapButton = make('button', { type: 'button', text: 'Map', onclick: () => this.mapCandidate() });
    this.candidateTitle = make('h3', { id: 'mappable-title' });
    this.view = new VirtualRows({ scroller: this.candidates, body: this.candidateBody, create: () => this.createCandidate(), draw: (row, at) => this.drawCandidate(row, at) });
    this.candidates.addEventListener('keydown', (event) => {
      const page = this.view.rowsOfPage;
      const next = { ArrowUp: this.candidate - 1, ArrowDown: this.candidate + 1, Home: 0, End: this.found.length - 1,
        PageUp: this.candidate - page, PageDown: this.candidate + page }[event.key];
      if (next !== undefined && !event.altKey) {
        event.preventDefault();
        this.selectCandidate(next);
      } else if (event.key === 'Enter') {
        event.preventDefault();
        this.mapCandidate();
      }
    });
    this.candidates.addEventListener('click', (event) => {
      const row = event.target.closest('.mappable-row');
      if (row) this.selectCandidate(row.at);
    });
    this.candidates.addEventListener('dblclick', (event) => {
      if (event.target.closest('.mappable-row')) this.mapCandidate();
    });
    this.candidates.addEventListener('dragstart', (event) => {
      const object = this.found[event.target.closest('.mappable-row')?.at];
      if (!object || this.reasonOf(object)) {
        event.preventDefault();
        return;
      }
      event.dataTransfer.setData('application/x-mappable', JSON.stringify(object));
      event.dataTransfer.effectAllowed = 'copyMove';
    });
    return make('section', { class: 'mappable', 'aria-labelledby': 'mappable-title' },
      make('div', { class: 'mappable-head' }, this.candidateTitle, this.query), this.candidates,
      make('div', { class: 'mappable-foot' }, this.reason, this.mapButton));
  }

  /* State */

  get pdo() {
    return this.list[this.at];
  }

  static nameOf(pdo) {
    return `${pdo.direction.toUpperCase()} ${pdo.number}`;
  }

  /* `pdos`, `all`: parts of the state; `all` has the candidates of both directions. */
  show(pdos, all, isLocked) {
    const before = this.wanted ?? this.pdo?.id;
    this.list = pdos.list;
    this.next = pdos.next;
    this.all = all;
    this.isLocked = isLocked;
    const at = this.list.findIndex((one) => one.id === before);
    if (at >= 0 && this.wanted) this.wanted = undefined;
    this.at = Math.max(0, Math.min(this.list.length - 1, at >= 0 ? at : this.at));
    this.showList();
    this.showPdo();
  }

  showList() {
    for (const [button, direction] of [[this.newTpdo, 'tpdo'], [this.newRpdo, 'rpdo']]) button.disabled = this.isLocked || this.next[direction] === null;
    this.items.hidden = this.list.length === 0;
    this.items.replaceChildren(...this.list.map((pdo, at) => {
      const times = [pdo.type.text && `type ${pdo.type.text}`, pdo.inhibit_ms && `inhibit ${pdo.inhibit_ms} ms`, pdo.event_ms && `timer ${pdo.event_ms} ms`].filter(Boolean);
      return make('li', { role: 'option', id: `pdo-${pdo.id}`, 'aria-selected': String(at === this.at),
        class: `${at === this.at ? 'active' : ''} ${pdo.cob_id.kind === 'disabled' ? 'disabled-pdo' : ''}`.trim() },
      make('b', { text: PdoEditor.nameOf(pdo) }), make('span', { text: pdo.cob_id.kind === 'disabled' ? 'disabled' : pdo.cob_id.label }),
      make('small', { text: [...times, `${pdo.used_bits} of 64 bits`].join(', ') }));
    }));
    setAttributes(this.items, { 'aria-activedescendant': this.pdo ? `pdo-${this.pdo.id}` : null });
  }

  select(at) {
    if (this.list.length === 0) return;
    this.at = Math.max(0, Math.min(this.list.length - 1, at));
    for (const field of Object.values(this.fields)) field.reject(null);
    this.candidate = 0;
    this.showList();
    this.showPdo();
    this.items.children[this.at].scrollIntoView({ block: 'nearest' });
    this.showSection(this.pdo.mapping || this.pdo.communication);
  }

  /* Shows the PDO of a communication or mapping parameter. */
  revealObject(index) {
    const at = this.list.findIndex((one) => one.communication === index || one.mapping === index);
    if (at < 0) return false;
    this.select(at);
    this.items.focus();
    return true;
  }

  showPdo() {
    const { pdo } = this;
    this.empty.hidden = Boolean(pdo);
    this.content.hidden = !pdo;
    if (!pdo) return;
    const isLocked = this.isLocked;
    setText(this.title, `${PdoEditor.nameOf(pdo)}, ${pdo.used_bits} of 64 bits`);
    this.removeButton.disabled = isLocked;
    this.kind = pdo.cob_id.kind;
    this.fields.kind.setChoices(pdo.cob_id.kind === 'none' ? [{ value: 'none', text: 'missing' }, ...PdoEditor.cobIdKinds] : PdoEditor.cobIdKinds);
    this.fields.kind.set(pdo.cob_id.kind, { isLocked, hint: pdo.cob_id.label });
    this.fields.value.set(pdo.cob_id.text, { isLocked });
    this.fields.value.element.hidden = !['node', 'fixed'].includes(pdo.cob_id.kind);
    this.fields.type.set(pdo.type.text, { isLocked, hint: pdo.type.label });
    this.fields.inhibit.set(pdo.inhibit_ms, { isLocked });
    this.fields.event.set(pdo.event_ms, { isLocked });
    this.fields.sync.set(pdo.sync_start, { isLocked });
    setText(this.lockedText, pdo.locked ? `The mapping cannot be changed: ${pdo.locked}.` : '');
    this.bits.setEntries(pdo.entries.map((one) => ({ ...one, entry: `${one.index}h:${one.sub}`, isDummy: one.dummy })), {
      isLocked: isLocked || Boolean(pdo.locked), label: PdoEditor.nameOf(pdo) });
    this.mapped.replaceChildren(...pdo.entries.map((one, at) => make('tr', {}, ...[
      String(at + 1), one.raw, `${one.index}h:${one.sub}`, one.name, String(one.bits)].map((text, place) => make('td', { text, class: place === 1 || place === 2 ? 'mono' : null })))));
    this.mapped.closest('.mapped-scroll').hidden = pdo.entries.length === 0;
    setText(this.candidateTitle, `Objects for ${pdo.direction === 'tpdo' ? 'a TPDO' : 'an RPDO'}`);
    this.showCandidates();
  }

  showActive() {
    const one = this.pdo?.entries[this.bits.activeEntry];
    setText(this.activeText, one ? `${one.name}, ${one.index}h:${one.sub}, ${plural(one.bits, 'bit')}, entry ${one.raw}` : 'Free bits');
    const isFixed = !one || this.bits.isLocked;
    this.earlier.disabled = isFixed || this.bits.activeEntry === 0;
    this.later.disabled = isFixed || this.bits.activeEntry === this.pdo.entries.length - 1;
    this.unmap.disabled = isFixed;
  }

  /* Candidates */

  showCandidates() {
    const words = this.query.value.trim().toLowerCase().split(/\s+/).filter(Boolean);
    const list = this.all[this.pdo.direction] ?? [];
    this.found = list.filter((one) => {
      const text = `${one.index}h:${one.sub} ${one.index}${one.sub} ${one.name} ${one.raw}`.toLowerCase();
      return words.every((word) => text.includes(word));
    });
    this.candidate = Math.max(0, Math.min(this.candidate, this.found.length - 1));
    setText(this.noCandidates, list.length ? 'No object matches.' : 'No object is mappable in this direction. Set PDO of an entry.');
    this.noCandidates.hidden = this.found.length > 0;
    setAttributes(this.candidates, { role: this.found.length ? 'listbox' : 'group', 'aria-label': 'Mappable objects' });
    this.view.reset(this.found.length, this.found.length ? this.candidate : -1);
    this.showCandidate();
  }

  createCandidate() {
    const parts = [make('span', { class: 'mono' }), make('span', { class: 'name' }), make('span', { class: 'bits-count' })];
    const element = make('div', { class: 'mappable-row', role: 'option' }, ...parts);
    element.parts = parts;
    return element;
  }

  drawCandidate(element, at) {
    const one = this.found[at];
    const reason = this.reasonOf(one);
    const [entry, name, bits] = element.parts;
    element.at = at;
    setText(entry, `${one.index}h:${one.sub}`);
    setText(name, one.name);
    setText(bits, plural(one.bits, 'bit'));
    element.className = `mappable-row${reason ? ' no-fit' : ''}`;
    setAttributes(element, { id: `candidate-${at}`, 'aria-selected': String(at === this.candidate), 'aria-disabled': reason ? 'true' : null,
      draggable: reason ? null : 'true', title: reason || null, 'aria-setsize': this.found.length, 'aria-posinset': at + 1 });
  }

  /* Why an object cannot be mapped; empty if it can. */
  reasonOf(one) {
    const { pdo } = this;
    if (this.isLocked) return 'edits are not possible now';
    return pdo.locked || pdo.full || (one.bits > pdo.free_bits ? pdo.too_long : '');
  }

  selectCandidate(at) {
    const before = this.candidate;
    this.candidate = Math.max(0, Math.min(this.found.length - 1, at));
    this.view.redraw(before);
    this.view.keep(this.candidate);
    this.view.scrollTo(this.candidate);
    this.view.redraw(this.candidate);
    this.showCandidate();
  }

  showCandidate() {
    const one = this.found[this.candidate];
    setAttributes(this.candidates, { 'aria-activedescendant': one ? `candidate-${this.candidate}` : null });
    const reason = one ? this.reasonOf(one) : '';
    setText(this.reason, one ? (reason ? `${one.name} does not fit: ${reason}` : `${one.name}, ${plural(one.bits, 'bit')}`) : '');
    setAttributes(this.mapButton, { 'aria-disabled': !one || reason ? 'true' : null });
  }

  /* Changes */

  async mapCandidate() {
    const one = this.found[this.candidate];
    if (!one) return;
    const reason = this.reasonOf(one);
    if (reason) this.announce(`${one.name} does not fit: ${reason}.`);
    else await this.map(one, this.pdo.entries.length);
  }

  async map(one, place) {
    const entries = [...this.pdo.entries];
    entries.splice(place, 0, one);
    await this.arrange(entries, `${one.name} mapped to ${PdoEditor.nameOf(this.pdo)}, bit ${entries.slice(0, place).reduce((sum, entry) => sum + entry.bits, 0)}.`);
  }

  async arrange(entries, text) {
    const rejection = await this.send({ entries: entries.map((one) => one.raw) });
    this.announce(rejection?.text ?? text);
  }

  setKind(kind, isForced) {
    if (kind === 'predefined' || kind === 'disabled') return this.send({ cob_id: { kind } }, isForced);
    /* The number is typed next. */
    this.kind = kind;
    this.fields.value.element.hidden = false;
    this.fields.value.input.focus();
    this.fields.value.input.select();
    return this.send({ cob_id: { kind, value: this.pdo.cob_id.text } }, isForced);
  }

  /* Returns a rejection or null. */
  send(values, isForced) {
    const { direction, number } = this.pdo;
    return this.change([{ do: 'pdo', direction, number, ...values }], isForced);
  }

  async add(direction) {
    const number = this.next[direction];
    this.wanted = `${direction}${number}`;
    const rejection = await this.change([{ do: 'pdo', direction, number, cob_id: { kind: 'predefined' }, type: '255', entries: [] }]);
    if (rejection) {
      this.wanted = undefined;
      this.announce(rejection.text);
      return;
    }
    this.announce(`${direction.toUpperCase()} ${number} added.`);
    this.candidates.focus();
  }

  async remove() {
    const { pdo } = this;
    if (!pdo) return;
    const rejection = await this.change([pdo.communication, pdo.mapping].filter(Boolean).map((section) => ({ do: 'remove', section })));
    this.announce(rejection?.text ?? `${PdoEditor.nameOf(pdo)} removed.`);
    this.items.focus();
  }
}
