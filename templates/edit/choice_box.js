/* A list of choices below an input: typing selects those that contain the text, arrow keys select, other texts remain allowed. */
class ChoiceBox {
  /* `choices`: texts, or objects with `text` and `hint`. `onpick` is called with a text after a click. */
  constructor(input, choices, onpick) {
    this.input = input;
    this.choices = choices.map((one) => (typeof one === 'string' ? { text: one, hint: '' } : one));
    this.at = -1;
    this.isFiltered = false;
    this.list = make('ul', { class: 'choices', role: 'listbox', id: 'choices', 'aria-label': 'Choices' });
    this.list.addEventListener('pointerdown', (event) => {
      const option = event.target.closest('li');
      event.preventDefault();
      if (option) onpick(option.dataset.text);
    });
    document.body.append(this.list);
    setAttributes(input, { role: 'combobox', 'aria-expanded': 'true', 'aria-controls': 'choices', 'aria-autocomplete': 'list' });
    input.addEventListener('input', () => {
      this.isFiltered = true;
      this.at = -1;
      this.draw();
    });
    this.draw();
  }

  get found() {
    const word = this.input.value.trim().toLowerCase();
    if (!this.isFiltered || !word) return this.choices;
    const starts = this.choices.filter((one) => one.text.toLowerCase().startsWith(word));
    const others = this.choices.filter((one) => !starts.includes(one) && `${one.text} ${one.hint}`.toLowerCase().includes(word));
    return [...starts, ...others];
  }

  draw() {
    const found = this.found;
    if (this.at < 0 && !this.isFiltered) this.at = found.findIndex((one) => one.text === this.input.value);
    else if (this.at < 0 && this.isFiltered && this.input.value.trim() && found.length) this.at = 0;
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
    return chosen ? chosen.text : this.input.value;
  }

  close() {
    this.list.remove();
  }
}
