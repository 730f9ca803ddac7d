/* A value with its label. It is sent when the input loses the focus or at Enter; a rejected text remains, with a message below. */
class FormField {
  static count = 0;

  /* `kind`: 'text', 'choice' with `choices`: [{ value, text }], or 'check'. `change(text, isForced)` returns a message if it is rejected,
     and is forced by Ctrl+Enter; without `change`, the text remains in the field for its dialog. `complete()` returns the choices of a text, of which a list has several. The label of
     a compact field is for screen readers. */
  constructor({ label, kind = 'text', choices = [], hint = '', isWide = false, isCompact = false, isList = false, complete, change }) {
    Object.assign(this, { label, kind, change });
    const id = `field-${++FormField.count}`;
    this.value = '';
    this.message = make('p', { class: 'field-message', id: `${id}-message`, hidden: true });
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
      ...(kind === 'check' ? [this.input, name] : [name, this.input]), this.hint, this.message);
    if (complete) this.completion = new Completion(this.input, { complete, isList, pick: () => this.send() });
    this.input.addEventListener('change', () => this.send());
    this.input.addEventListener('keydown', (event) => {
      if (event.key === 'Enter' && event.ctrlKey && this.change && this.isRejected) {
        event.preventDefault();
        this.send(true);
      } else if (event.key === 'Enter' && kind === 'text') {
        event.preventDefault();
        this.send();
      } else if (event.key === 'Escape' && kind === 'text' && this.change && (this.isRejected || this.input.value !== this.value)) {
        event.preventDefault();
        this.reject('');
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
    if (isNew) this.reject('');
    if (!isTyped && !this.isRejected) this.show(text);
    if (hint !== undefined) setText(this.hint, hint);
    this.lock(isLocked);
  }

  lock(isLocked) {
    this.isLocked = isLocked;
    if (this.kind === 'text') this.input.readOnly = isLocked || document.body.classList.contains('lost');
    else this.input.disabled = isLocked || document.body.classList.contains('lost');
    this.element.classList.toggle('locked', isLocked);
  }

  reject(message) {
    this.isRejected = Boolean(message);
    setText(this.message, message);
    this.message.hidden = !message;
    setAttributes(this.input, { 'aria-invalid': message ? 'true' : null });
  }

  async send(isForced = false) {
    const text = this.text.trim();
    if (!this.change || this.isLocked || this.input.readOnly) return;
    if (text === this.value) {
      this.reject('');
      this.show(this.value);
      return;
    }
    if (this.sending === text) return;
    this.sending = text;
    const message = await this.change(text, isForced);
    this.sending = undefined;
    this.reject(message ?? '');
    if (!message) this.show(this.value);
  }
}
