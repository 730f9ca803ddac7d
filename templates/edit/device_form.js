/* The sections of the file that are not objects, as a form: identity once, as the server writes it to both of its places. */
class DeviceForm {
  /* `set(section, key, value, isForced)` returns a rejection or null; `focus(section)` is called with the section of the field that gets the focus. */
  constructor(element, { set, focus }) {
    Object.assign(this, { element, set, focus });
    this.fields = new Map();
    this.groups = make('div', { class: 'form-groups' });
    element.append(this.groups);
  }

  /* `device`: the part of the state. `isLocked`: an offered journal or a conflict. */
  show(device, isLocked) {
    const groups = [{ title: 'Identity', note: 'also in 1018h', fields: device.identity },
      ...device.groups.map((group) => ({ ...group, fields: group.fields.map((field) => ({ ...field, section: group.section })) }))];
    const shape = JSON.stringify(groups.map((group) => [group.title, group.fields.map((field) => [field.section, field.key, field.kind])]));
    if (shape !== this.shape) this.build(groups);
    this.shape = shape;
    for (const group of groups) {
      for (const field of group.fields) {
        this.fields.get(`${field.section} ${field.key}`).set(field.kind === 'flag' ? (field.flag ?? field.value.trim()) : field.value, { isLocked });
      }
    }
  }

  build(groups) {
    this.fields.clear();
    this.groups.replaceChildren(...groups.filter((group) => group.fields.length).map((group, at) => {
      const title = `form-group-${at}`;
      const fieldOf = (field) => {
        const one = new FormField({ label: field.label, kind: field.kind === 'flag' ? 'check' : 'text', hint: field.object ? `${field.object}` : '',
          change: (text, isForced) => this.set(field.section, field.key, text, isForced) });
        one.input.addEventListener('focus', () => this.focus(field.section));
        this.fields.set(`${field.section} ${field.key}`, one);
        return one.element;
      };
      const flags = group.fields.filter((field) => field.kind === 'flag');
      return make('section', { class: 'form-group', 'aria-labelledby': title },
        make('h2', { id: title }, group.title, group.note && make('small', { text: group.note })),
        ...group.fields.filter((field) => field.kind !== 'flag').map(fieldOf),
        flags.length > 0 && make('div', { class: 'checks' }, ...flags.map(fieldOf)));
    }));
  }

  /* Focuses a field that a finding names. */
  reveal(section, key) {
    const lower = `${section} ${key ?? ''}`.toLowerCase();
    for (const [name, field] of this.fields) {
      if (name.toLowerCase().startsWith(lower)) {
        field.input.focus();
        return true;
      }
    }
    return false;
  }
}
