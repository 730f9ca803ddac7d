/* A value with its label. It is sent when the input loses the focus or at Enter; a rejected text remains, with a message below, and a
   button if it can be applied anyway. */
class FormField {
  static count = 0;

  /* `kind`: 'text', 'choice' with `choices`: [{ value, text }], or 'check'. `change(text, isForced)` returns a rejection or null, and is
     forced by Ctrl+Enter or the button; without `change`, the text remains in the field, and `force()` is called by the button.
     `complete()` returns the choices of a text, of which a list has several. The label of a compact field is for screen readers. */
  constructor({ label, kind = 'text', choices = [], hint = '', isWide = false, isCompact = false, isList = false, complete, change,
    force = () => this.send(true) }) {
    Object.assign(this, { label, kind, change });
    const id = `field-${++FormField.count}`;
    this.value = '';
    this.message = make('p', { id: `${id}-message` });
    this.force = forceButton(label, force);
    this.force.hidden = true;
    this.problem = make('div', { class: 'field-problem', hidden: true }, this.message, this.force);
    this.hint = make('span', { class: 'field-hint', id: `${id}-hint`, text: hint });
    const name = make('label', { for: id, class: isCompact ? 'hidden' : null, text: label });
    if (kind === 'choice') {
      this.input = make('select', { id });
      this.setChoices(choices);
    } else {
      this.input = make('input', { id, type: kind === 'check' ? 'checkbox' : 'text', autocomplete: 'off', spellcheck: 'false' });
    }
    setAttributes(this.input, { 'aria-describedby': `${id}-hint ${id}-message` });
    this.element = make('div', { class: `field ${kind}${isWide || isCompact ? ' wide' : ''}` },
      ...(kind === 'check' ? [this.input, name] : [name, this.input]), this.hint, this.problem);
    if (complete) this.completion = new Completion(this.input, { complete, isList, pick: () => this.send() });
    /* Tab from a rejected text, to the button, does not send it again. */
    this.input.addEventListener('change', () => {
      if (this.text.trim() !== this.rejectedText) this.send();
    });
    this.input.addEventListener('keydown', (event) => {
      if (event.key === 'Enter' && event.ctrlKey && this.change && this.isRejected) {
        event.preventDefault();
        this.send(true);
      } else if (event.key === 'Enter' && kind === 'text') {
        event.preventDefault();
        this.send();
      } else if (event.key === 'Escape' && kind === 'text' && this.change && (this.isRejected || this.input.value !== this.value)) {
        event.preventDefault();
        this.reject(null);
        this.show(this.value);
      }
    });
  }

  setChoices(choices) {
    if (this.input.dataset.choices === JSON.stringify(choices)) return;
    this.input.dataset.choices = JSON.stringify(choices);
    this.input.replaceChildren(...choices.map((one) => make('option', { value: one.value, text: one.text })));
    this.show(this.value);
  }

  get text() {
    return this.kind === 'check' ? (this.input.checked ? '1' : '0') : this.input.value;
  }

  show(text) {
    if (this.kind === 'check') this.input.checked = text === '1';
    else if (this.input.value !== text) this.input.value = text;
  }

  /* A new value of the file. A text that is being typed, or was rejected, remains. */
  set(text, { isLocked = false, hint } = {}) {
    const isTyped = document.activeElement === this.input && this.kind === 'text' && this.input.value !== this.value;
    const isNew = text !== this.value;
    this.value = text;
    if (isNew) this.reject(null);
    if (!isTyped && !this.isRejected) this.show(text);
    if (hint !== undefined) setText(this.hint, hint);
    this.lock(isLocked);
  }

  lock(isLocked) {
    this.isLocked = isLocked;
    if (this.kind === 'text') this.input.readOnly = isLocked || document.body.classList.contains('lost');
    else this.input.disabled = isLocked || document.body.classList.contains('lost');
    this.force.disabled = isLocked || document.body.classList.contains('lost');
    this.element.classList.toggle('locked', isLocked);
  }

  get isRejected() {
    return this.rejectedText !== undefined;
  }

  /* `rejection`: { text, canForce } of the text of the field, or null. */
  reject(rejection) {
    this.rejectedText = rejection ? this.text.trim() : undefined;
    if (!rejection?.canForce && document.activeElement === this.force) this.input.focus();
    setText(this.message, rejection?.text ?? '');
    this.force.hidden = !rejection?.canForce;
    this.problem.hidden = !rejection;
    setAttributes(this.input, { 'aria-invalid': rejection ? 'true' : null });
  }

  async send(isForced = false) {
    const text = this.text.trim();
    if (!this.change || this.isLocked || this.input.readOnly) return;
    if (text === this.value) {
      this.reject(null);
      this.show(this.value);
      return;
    }
    if (this.sending === text && !isForced) return;
    this.sending = text;
    const rejection = await this.change(text, isForced);
    this.sending = undefined;
    this.reject(rejection);
    if (!rejection) this.show(this.value);
  }
}
