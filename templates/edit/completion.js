/* Choices for an input of a form: they open while a text is typed, or by an arrow key. */
class Completion {
  /* `complete()` returns the choices; `pick()` is called after one of them is in the input. */
  constructor(input, { complete, isList = false, pick }) {
    Object.assign(this, { input, complete, isList, pick });
    this.box = null;
    setAttributes(input, { role: 'combobox', 'aria-expanded': 'false', 'aria-autocomplete': 'list' });
    input.addEventListener('input', () => this.open(true));
    input.addEventListener('blur', () => this.close());
    input.addEventListener('keydown', (event) => this.key(event), { capture: true });
  }

  open(isFiltered) {
    if (this.box || this.input.readOnly) return;
    const choices = this.complete();
    if (choices.length === 0) return;
    this.box = new ChoiceBox(this.input, choices, (text) => this.take(text), { isList: this.isList });
    if (!isFiltered) return;
    this.box.isFiltered = true;
    this.box.draw();
  }

  close() {
    this.box?.close();
    this.box = null;
  }

  take(text) {
    this.input.value = text;
    this.close();
    this.pick();
  }

  /* Keys of an open list do not reach the form. */
  key(event) {
    const isArrow = event.key === 'ArrowDown' || event.key === 'ArrowUp';
    if (!this.box) {
      if (!isArrow) return;
      event.preventDefault();
      this.open(false);
      return;
    }
    const isPicked = event.key === 'Enter' && this.box.found[this.box.at] !== undefined;
    if (!isPicked && event.key !== 'Escape' && !this.box.key(event)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (isPicked) this.take(this.box.value);
    else if (event.key === 'Escape') this.close();
  }
}
