/* The signals of a network file: their list, and the members of one of them. */
class SignalEditor {
  /* `change(changes, isForced)`, `remove(changes)` and `set(pointer, value, isForced)` return a rejection or null; `complete(offers, from)`
     returns choices for a signal of the node `from`. */
  constructor(element, { change, remove, set, announce, complete, showText, marksOf }) {
    Object.assign(this, { change, removeItems: remove, announce, complete, showText, marksOf });
    this.signals = [];
    this.newSignal = [];
    this.addButton = make('button', { type: 'button', text: 'New signal', 'aria-haspopup': 'dialog', 'aria-keyshortcuts': 'Control+Alt+N', onclick: () => this.add() });
    this.list = new ItemList({ id: 'signals', label: 'Signals', select: (at) => this.selectAt(at), enter: () => this.fields.reveal(this.signal?.fields[0].pointer ?? ''),
      remove: () => this.remove(), move: (step) => this.moveBy(step) });
    this.empty = make('p', { class: 'empty', text: 'No signal. New signal adds one.' });
    this.title = make('h2', { id: 'signal-title' });
    this.earlier = make('button', { type: 'button', class: 'small', text: 'Move up', onclick: () => this.moveBy(-1) });
    this.later = make('button', { type: 'button', class: 'small', text: 'Move down', onclick: () => this.moveBy(1) });
    this.removeButton = make('button', { type: 'button', class: 'small', text: 'Remove this signal', onclick: () => this.remove() });
    this.fields = new MemberFields({
      set, announce, focus: () => this.showText(this.signal.pointer),
      complete: (offers) => complete(offers, this.textOf('from')),
    });
    this.content = make('section', { class: 'member-main', 'aria-labelledby': 'signal-title' },
      make('div', { class: 'member-head' }, this.title, make('div', { class: 'actions' }, this.earlier, this.later, this.removeButton)), this.fields.element);
    element.append(make('div', { class: 'member-side' }, make('div', { class: 'actions', role: 'group', 'aria-label': 'Signals' }, this.addButton), this.list.element),
      this.empty, this.content);
  }

  get signal() {
    return this.signals[this.list.at];
  }

  textOf(member) {
    const field = this.signal?.fields.find((one) => one.member === member);
    return field ? memberText(field) : '';
  }

  show({ signals, new_signal: newSignal }, isLocked) {
    const at = this.wanted ?? this.placeIn(signals);
    const isMoved = this.wanted === undefined && at !== this.list.at;
    this.signals = signals;
    this.newSignal = newSignal;
    this.isLocked = isLocked;
    this.addButton.disabled = isLocked;
    this.list.show(signals.map((one) => ({ title: one.title, detail: membersText(one.fields, ['from', 'object', 'to']), marks: this.marksOf(one.pointer) })),
      at);
    this.wanted = undefined;
    this.showSignal();
    if (isMoved && this.content.checkVisibility()) this.showText(this.signal.pointer);
  }

  /* Where the selected signal is: another program, another page or undo can add, remove and move those before it. */
  placeIn(signals) {
    const textOf = (one) => JSON.stringify([one?.title, one?.fields.map((field) => field.value)]);
    const text = textOf(this.signal);
    const found = signals.findIndex((one) => textOf(one) === text);
    return found < 0 || textOf(signals[this.list.at]) === text ? this.list.at : found;
  }

  showSignal() {
    const { signal, isLocked } = this;
    this.empty.hidden = Boolean(signal);
    this.content.hidden = !signal;
    if (!signal) return;
    setText(this.title, `Signal ${signal.title}`);
    this.removeButton.disabled = isLocked;
    this.earlier.disabled = isLocked || this.list.at === 0;
    this.later.disabled = isLocked || this.list.at === this.signals.length - 1;
    /* A pointer names another signal after one before it is removed. */
    this.fields.show(`${signal.pointer} of ${this.signals.length}`, signal.fields, isLocked);
  }

  selectAt(at) {
    this.list.at = at;
    this.showSignal();
    this.showText(this.signal.pointer);
  }

  reveal(pointer) {
    const at = this.signals.findIndex((one) => isWithin(pointer, one.pointer));
    if (at < 0) return false;
    this.list.go(at);
    if (!this.fields.reveal(pointer)) this.list.element.focus();
    return true;
  }

  /* Sends changes after which the signal at `wanted` is selected. */
  async changeAndSelect(changes, wanted, isForced) {
    this.wanted = wanted;
    const rejection = await this.change(changes, isForced);
    this.wanted = undefined;
    return rejection;
  }

  async moveBy(step) {
    const { signal } = this;
    const to = this.list.at + step;
    if (!signal || this.isLocked || !this.signals[to]) return;
    const rejection = await this.changeAndSelect([{ do: 'move', pointer: signal.pointer, to }], to);
    if (!rejection) this.showText(this.signal.pointer);
    this.announce(rejection?.text ?? `${signal.title} is signal ${to + 1} of ${this.signals.length}.`);
  }

  add() {
    if (this.isLocked || this.dialog) return;
    this.dialog = new MemberDialog({
      title: 'New signal', fields: this.newSignal, complete: (offers, valueOf) => this.complete(offers, valueOf('from')),
      closed: (isAdded) => {
        this.dialog = null;
        if (!isAdded) return;
        this.list.element.focus();
        this.showText(this.signal.pointer);
      },
      add: async (members, name, isForced) => {
        const rejection = await this.changeAndSelect([{ do: 'add', pointer: '/signals/-', members }], this.signals.length, isForced);
        if (!rejection) this.announce(`${this.signal?.title} added.`);
        return rejection;
      },
    });
  }

  async remove() {
    const { signal } = this;
    if (!signal || this.isLocked) return;
    const rejection = await this.removeItems([{ do: 'remove', pointer: signal.pointer }]);
    this.announce(rejection?.text ?? `${signal.title} removed.`);
    if (!document.querySelector('dialog')) this.list.focusOr(this.addButton);
  }
}
