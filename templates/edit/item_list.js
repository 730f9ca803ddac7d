/* A list of which one item is selected: by arrow keys, Home, End or a click. Alt+arrow moves it, Ctrl+Delete removes it. */
class ItemList {
  /* `select(at)` after another item is selected; `enter()` at Enter; `move(step)` is optional. */
  constructor({ id, label, select, enter, remove, move = () => {} }) {
    Object.assign(this, { id, select, enter, remove, move });
    this.at = 0;
    this.items = [];
    this.element = make('ul', { class: 'item-list', id, role: 'listbox', tabindex: 0, 'aria-label': label });
    this.element.addEventListener('keydown', (event) => this.key(event));
    this.element.addEventListener('click', (event) => {
      const item = event.target.closest('li');
      if (item) this.go([...this.element.children].indexOf(item));
    });
  }

  key(event) {
    const { key, altKey, ctrlKey } = event;
    const step = { ArrowUp: -1, ArrowDown: 1 }[key];
    const next = { ArrowUp: this.at - 1, ArrowDown: this.at + 1, Home: 0, End: this.items.length - 1 }[key];
    if (step && altKey) this.move(step);
    else if (next !== undefined && !altKey) this.go(next);
    else if (key === 'Enter') this.enter();
    else if (key === 'Delete' && ctrlKey) this.remove();
    else return;
    event.preventDefault();
  }

  go(at) {
    if (this.items.length === 0) return;
    this.at = Math.max(0, Math.min(this.items.length - 1, at));
    this.draw();
    this.element.children[this.at].scrollIntoView({ block: 'nearest' });
    this.select(this.at);
  }

  /* Focuses the list, or `other` if it is empty and therefore hidden. */
  focusOr(other) {
    (this.items.length ? this.element : other).focus();
  }

  /* `items`: { title, note, detail, marks }. */
  show(items, at) {
    this.items = items;
    this.at = Math.max(0, Math.min(items.length - 1, at));
    this.draw();
  }

  draw() {
    this.element.hidden = this.items.length === 0;
    this.element.replaceChildren(...this.items.map(({ title, note, detail, marks }, at) => make('li', {
      role: 'option', id: `${this.id}-${at}`, 'aria-selected': String(at === this.at), class: at === this.at ? 'active' : null,
    }, make('b', { text: title }), make('span', {}, note, ...(marks.errors || marks.warnings ? [' ', make('span', { class: 'marks' }, ...markElements(marks))] : [])),
    detail && make('small', { text: detail }))));
    setAttributes(this.element, { 'aria-activedescendant': this.items.length ? `${this.id}-${this.at}` : null });
  }
}

/* The members of an item that the file has, such as `every_ms 50, event`. */
const membersText = (fields, left) => fields.filter((field) => field.present && !left.includes(field.member) && (field.kind !== 'flag' || field.value === '1'))
  .map((field) => (field.kind === 'flag' ? field.member : `${field.member} ${memberText(field)}`)).join(', ');
