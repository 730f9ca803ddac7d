/* A list of choices below an input: typing selects those that contain the text, arrow keys select, other texts remain allowed. */
class ChoiceBox {
  static maxShown = 300;

  /* `choices`: texts, or objects with `text` and `hint`. `onpick` is called with a text after a click. `isList`: the text has several
     values with commas, and the choices are for the last one. */
  constructor(input, choices, onpick, { isList = false } = {}) {
    this.input = input;
    this.isList = isList;
    this.choices = choices.map((one) => (typeof one === 'string' ? { text: one, hint: '' } : one));
    this.listeners = new AbortController();
    this.at = -1;
    this.isFiltered = false;
    this.list = make('ul', { class: 'choices', role: 'listbox', id: 'choices', 'aria-label': 'Choices' });
    this.list.addEventListener('pointerdown', (event) => {
      const option = event.target.closest('li');
      event.preventDefault();
      if (option) onpick(this.head + option.dataset.text);
    });
    /* A modal dialog is above all other elements. */
    (input.closest('dialog, main') ?? document.body).append(this.list);
    setAttributes(input, { role: 'combobox', 'aria-expanded': 'true', 'aria-controls': 'choices', 'aria-autocomplete': 'list' });
    input.addEventListener('input', () => {
      this.isFiltered = true;
      this.at = -1;
      this.draw();
    }, { signal: this.listeners.signal });
    this.draw();
  }

  /* The values before the one that is typed. */
  get head() {
    return this.isList ? this.input.value.match(/^(.*,\s*)?/)[0] : '';
  }

  get word() {
    return this.input.value.slice(this.head.length).trim();
  }

  get found() {
    const word = this.word.toLowerCase();
    if (!this.isFiltered || !word) return this.choices.slice(0, ChoiceBox.maxShown);
    const equal = [], starts = [], others = [];
    for (const one of this.choices) {
      const text = one.text.toLowerCase();
      if (text === word) equal.push(one);
      else if (text.startsWith(word)) starts.push(one);
      else if (text.includes(word) || one.hint.toLowerCase().includes(word)) others.push(one);
    }
    return [...equal, ...starts, ...others].slice(0, ChoiceBox.maxShown);
  }

  draw() {
    const found = this.found;
    if (this.at < 0 && !this.isFiltered) this.at = found.findIndex((one) => one.text === this.word);
    else if (this.at < 0 && this.isFiltered && this.word && found.length) this.at = 0;
    this.list.replaceChildren(...found.map((one, at) => make('li', {
      role: 'option', id: `choice-${at}`, 'aria-selected': String(at === this.at), 'data-text': one.text,
    }, one.text, one.hint && make('small', { text: ` ${one.hint}` }))));
    this.list.hidden = found.length === 0;
    const box = this.input.getBoundingClientRect();
    const below = innerHeight - box.bottom, above = box.top;
    const isBelow = below > 200 || below > above;
    const { style } = this.list;
    style.left = `${Math.max(4, Math.min(box.left, innerWidth - 180))}px`;
    style.minWidth = `${box.width}px`;
    style.maxHeight = `${Math.min(320, (isBelow ? below : above) - 8)}px`;
    style.top = isBelow ? `${box.bottom + 1}px` : 'auto';
    style.bottom = isBelow ? 'auto' : `${innerHeight - box.top + 1}px`;
    setAttributes(this.input, { 'aria-activedescendant': this.at >= 0 && found.length ? `choice-${this.at}` : null });
    this.list.children[this.at]?.scrollIntoView({ block: 'nearest' });
  }

  /* Returns whether the key belongs to the list. */
  key(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const found = this.found;
    if (!step || found.length === 0) return false;
    event.preventDefault();
    this.at = (this.at + step + found.length) % found.length;
    this.draw();
    return true;
  }

  /* The selected choice, else the text. */
  get value() {
    const chosen = this.found[this.at];
    return chosen ? this.head + chosen.text : this.input.value;
  }

  close() {
    this.listeners.abort();
    this.list.remove();
    setAttributes(this.input, { 'aria-expanded': 'false', 'aria-controls': null, 'aria-activedescendant': null });
  }
}
