/* The areas of the dictionary and their objects as a tree. The selected objects are the rows of the spreadsheet. */
class ObjectTree {
  constructor(element, { select, open }) {
    Object.assign(this, { element, select, open });
    this.areas = [];
    this.items = [];
    this.closed = new Set();
    this.active = 0;
    this.anchor = 0;
    this.chosen = new Set(['all']);
    this.body = make('div', { class: 'tree-body', role: 'presentation' });
    this.empty = make('p', { class: 'empty', text: 'No object matches.', hidden: true });
    element.append(this.body, this.empty);
    setAttributes(element, { role: 'tree', tabindex: 0, 'aria-multiselectable': 'true' });
    this.view = new VirtualRows({ scroller: element, body: this.body, create: () => this.create(), draw: (row, at) => this.draw(row, at) });
    element.addEventListener('keydown', (event) => this.key(event));
    element.addEventListener('click', (event) => this.click(event));
    element.addEventListener('focus', () => this.show());
  }

  /* `areas`: [{ id, name, objects: [{ index, name, kind, errors, warnings, changed, locked }] }], without those that are filtered. */
  setAreas(areas, isFiltered) {
    this.areas = areas;
    this.isFiltered = isFiltered;
    this.layOut();
  }

  layOut() {
    const before = this.items[this.active]?.id;
    const count = this.areas.reduce((sum, area) => sum + area.objects.length, 0);
    this.items = count ? [{ id: 'all', level: 1, name: this.isFiltered ? 'All that match' : 'All objects', count }] : [];
    this.areas.forEach((area) => {
      if (area.objects.length === 0) return;
      const isOpen = !this.closed.has(area.id);
      this.items.push({ id: area.id, level: 1, name: area.name, count: area.objects.length, area, isOpen });
      if (!isOpen) return;
      area.objects.forEach((object, at) => this.items.push({
        id: object.index, level: 2, object, area, place: at + 1, size: area.objects.length,
      }));
    });
    const at = this.items.findIndex((one) => one.id === before);
    if (at >= 0) this.active = at;
    this.active = Math.max(0, Math.min(this.active, this.items.length - 1));
    /* Another object in place of one that was removed. */
    if (this.items.length && !this.items.some((one) => this.chosen.has(one.id)) && this.chosenIndices.size === 0) {
      this.anchor = this.active;
      this.chosen = new Set([this.items[this.active].id]);
    }
    this.empty.hidden = this.items.length > 0;
    /* A tree without items would have a role that it cannot have. */
    setAttributes(this.element, { role: this.items.length ? 'tree' : 'group', 'aria-multiselectable': this.items.length ? 'true' : null });
    this.view.reset(this.items.length, this.items.length ? this.active : -1);
    this.show(false);
  }

  create() {
    const parts = { turn: make('span', { class: 'turn', 'aria-hidden': 'true' }), index: make('span', { class: 'mono' }), name: make('span', { class: 'name' }),
      count: make('span', { class: 'quiet' }), marks: make('span', { class: 'marks' }) };
    const element = make('div', {}, ...Object.values(parts));
    element.parts = parts;
    return element;
  }

  draw(element, at) {
    const item = this.items[at];
    const { turn, index, name, count, marks } = element.parts;
    const isChosen = this.isChosen(item);
    element.item = at;
    element.className = `tree-row level-${item.level}${at === this.active ? ' active' : ''}${isChosen ? ' chosen' : ''}${item.object?.locked ? ' locked' : ''}`;
    setText(turn, item.area && !item.object ? (item.isOpen ? '\u25BE' : '\u25B8') : '');
    setText(index, item.object ? `${item.object.index}h` : '');
    setText(name, item.object ? item.object.name : item.name);
    setText(count, item.object ? '' : String(item.count));
    marks.replaceChildren(...(item.object ? markElements(item.object) : []));
    const areas = this.areas.filter((area) => area.objects.length).length;
    setAttributes(element, {
      id: `tree-${at}`, role: 'treeitem', 'aria-level': item.level, 'aria-selected': String(isChosen),
      'aria-expanded': item.area && !item.object ? String(item.isOpen) : null,
      'aria-setsize': item.object ? item.size : areas + 1,
      'aria-posinset': item.object ? item.place : item.area ? this.areas.filter((area) => area.objects.length).indexOf(item.area) + 2 : 1,
      title: item.object ? `${item.object.index}h ${item.object.name}` : null,
    });
  }

  isChosen(item) {
    return this.chosen.has(item.id);
  }

  /* The indices of the objects that the chosen items stand for. */
  get chosenIndices() {
    const found = new Set();
    for (const area of this.areas) {
      const isArea = this.chosen.has('all') || this.chosen.has(area.id);
      for (const object of area.objects) if (isArea || this.chosen.has(object.index)) found.add(object.index);
    }
    return found;
  }

  show(isScrolled = true) {
    const has = this.items.length > 0;
    setAttributes(this.element, { 'aria-activedescendant': has ? `tree-${this.active}` : null });
    if (!has) return;
    this.view.keep(this.active);
    if (isScrolled) this.view.scrollTo(this.active);
  }

  choose(at, isExtended) {
    if (this.items.length === 0) return;
    this.active = Math.max(0, Math.min(this.items.length - 1, at));
    if (!isExtended) this.anchor = this.active;
    const [first, last] = [Math.min(this.anchor, this.active), Math.max(this.anchor, this.active)];
    this.chosen = new Set(this.items.slice(first, last + 1).map((one) => one.id));
    this.redraw();
    this.show();
    this.select(this.items[this.active]);
  }

  /* All objects of a new search or filter. */
  chooseAll() {
    this.chosen = new Set(['all']);
    this.active = this.anchor = 0;
  }

  /* Selects an object that a link or a finding names. */
  reveal(index) {
    const area = this.areas.find((one) => one.objects.some((object) => object.index === index));
    if (!area) return false;
    if (this.closed.delete(area.id)) this.layOut();
    const at = this.items.findIndex((one) => one.id === index && one.object);
    this.choose(at, false);
    return true;
  }

  redraw() {
    this.view.reset(this.items.length, this.active);
  }

  setOpen(item, isOpen) {
    if (isOpen) this.closed.delete(item.area.id);
    else this.closed.add(item.area.id);
    this.layOut();
  }

  key(event) {
    const { key, shiftKey, ctrlKey, metaKey, altKey } = event;
    if (altKey || this.items.length === 0) return;
    const item = this.items[this.active];
    const isArea = item.area && !item.object;
    const moves = { ArrowUp: this.active - 1, ArrowDown: this.active + 1, Home: 0, End: this.items.length - 1,
      PageUp: this.active - this.view.rowsOfPage, PageDown: this.active + this.view.rowsOfPage };
    if (key in moves) {
      event.preventDefault();
      this.choose(moves[key], shiftKey);
    } else if (key === 'ArrowRight' || key === 'ArrowLeft') {
      event.preventDefault();
      const isRight = key === 'ArrowRight';
      if (isArea && item.isOpen !== isRight) this.setOpen(item, isRight);
      else if (item.object && !isRight) this.choose(this.items.findIndex((one) => one.area === item.area), false);
      else if (isArea && isRight) this.choose(this.active + 1, false);
    } else if (key === 'Enter') {
      event.preventDefault();
      this.open();
    } else if (key === ' ') {
      event.preventDefault();
      this.toggle(item);
    } else if ((ctrlKey || metaKey) && key.toLowerCase() === 'a') {
      event.preventDefault();
      this.chosen = new Set(['all']);
      this.redraw();
      this.select(item);
    }
  }

  toggle(item) {
    if (!this.chosen.delete(item.id)) this.chosen.add(item.id);
    if (this.chosen.size === 0) this.chosen.add(item.id);
    this.redraw();
    this.select(item);
  }

  click(event) {
    const row = event.target.closest('.tree-row');
    if (!row) return;
    const item = this.items[row.item];
    if (item.area && !item.object && event.target.closest('.turn')) {
      this.setOpen(item, !item.isOpen);
      return;
    }
    this.element.focus({ preventScroll: true });
    if (event.ctrlKey || event.metaKey) {
      this.active = this.anchor = row.item;
      this.toggle(item);
    } else {
      this.choose(row.item, event.shiftKey);
    }
  }
}

/* The signs of an object or entry: each has a text too. */
const markElements = ({ errors = 0, warnings = 0, changed = false }) => [
  ...(errors ? [make('span', { class: 'mark error', title: plural(errors, 'error') }, make('span', { 'aria-hidden': 'true', text: '\u2715' }), hidden(plural(errors, 'error')))] : []),
  ...(warnings ? [make('span', { class: 'mark warning', title: plural(warnings, 'warning') }, make('span', { 'aria-hidden': 'true', text: '!' }), hidden(plural(warnings, 'warning')))] : []),
  ...(changed ? [make('span', { class: 'mark changed', title: 'changed since the last commit' }, make('span', { 'aria-hidden': 'true', text: '\u25CF' }), hidden('changed since the last commit'))] : []),
];
