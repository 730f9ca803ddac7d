/* Search and filters: which objects the tree has, and which of their entries the spreadsheet shows. */
class ObjectFilter {
  constructor(form, changed) {
    this.form = form;
    this.fields = { query: byId('query'), findings: byId('filter-findings'), changed: byId('filter-changed'),
      mappable: byId('filter-mappable'), access: byId('filter-access') };
    form.addEventListener('input', changed);
    form.addEventListener('submit', (event) => event.preventDefault());
    form.addEventListener('reset', () => {
      this.fields.query.value = '';
      setTimeout(changed);
    });
    this.fields.query.addEventListener('keydown', (event) => {
      if (event.key === 'Escape' && this.fields.query.value) {
        event.preventDefault();
        this.fields.query.value = '';
        changed();
      } else if (event.key === 'ArrowDown' || event.key === 'Enter') {
        event.preventDefault();
        byId('tree').focus();
      }
    });
  }

  setAccess(texts) {
    const { access } = this.fields;
    if (access.options.length === 1) access.append(...texts.map((text) => make('option', { text })));
  }

  focus() {
    this.fields.query.focus();
    this.fields.query.select();
  }

  clear() {
    this.form.reset();
  }

  get words() {
    return this.fields.query.value.toLowerCase().split(/\s+/).filter(Boolean).map((word) => ({
      word, index: /^(?:0x)?([0-9a-f]{4})h?(?:[:.][0-9a-f]{0,2}h?)?$/.exec(word)?.[1] }));
  }

  /* The number of filters besides the search. */
  get count() {
    const { findings, changed, mappable, access } = this.fields;
    return [findings.checked, changed.checked, mappable.value, access.value].filter(Boolean).length;
  }

  get isActive() {
    return this.count > 0 || this.words.length > 0;
  }

  matchesObject(object, words) {
    if (words.length === 0) return true;
    object.text ??= [`${object.index}h`, object.name, object.kind, ...object.entries.map((one) => `${one.name} ${one.type}`)].join(' ').toLowerCase();
    return words.every(({ word, index }) => (index ? object.index.toLowerCase() === index : object.text.includes(word)));
  }

  /* `marks(section)`: { errors, warnings } of an entry. */
  matchesEntry(entry, marks) {
    const { findings, changed, mappable, access } = this.fields;
    if (findings.checked) {
      const { errors, warnings } = marks(entry.section);
      if (errors + warnings === 0) return false;
    }
    if (changed.checked && !entry.changed) return false;
    const directions = entry.mappable ?? [];
    if (mappable.value && !(mappable.value === 'any' ? directions.length : directions.includes(mappable.value))) return false;
    return !access.value || (entry.access ?? '').toLowerCase() === access.value.toLowerCase();
  }
}
