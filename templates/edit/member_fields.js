/* The members of an object of a network file as fields. A member that the file does not have is empty, or not checked. */

/* A field of the state as a field of a form. `complete(offers)` returns the choices of its text. */
const memberField = (field, { complete, change }) => new FormField({
  label: field.member, kind: field.kind === 'flag' ? 'check' : 'text', hint: memberHint(field), isList: field.kind === 'list',
  complete: field.offers ? () => complete(field.offers) : undefined, change,
});

/* The meaning of the table of members, which is Markdown. */
const memberHint = ({ kind, hint }) => hint.replaceAll('`', '') + (kind === 'list' ? '; several with commas' : '');

const memberText = ({ kind, value }) => (kind === 'list' ? value.join(', ') : value);

/* A text of a form as a value of a change. A flag that is not set is removed. */
const memberValue = ({ kind }, text) => {
  if (kind === 'flag') return text === '1' ? '1' : '';
  return kind === 'list' ? text.split(',').map((one) => one.trim()).filter(Boolean) : text;
};

/* A key of JSON as a part of a pointer (RFC 6901). */
const pointerPart = (key) => key.replaceAll('~', '~0').replaceAll('/', '~1');

const isWithin = (pointer, outer) => pointer === outer || pointer.startsWith(`${outer}/`);

class MemberFields {
  /* `set(pointer, value, isForced)` returns a rejection or null; `focus()` is called when a field gets the focus. */
  constructor({ set, complete, focus, announce }) {
    Object.assign(this, { set, complete, focus, announce });
    this.fields = new Map();
    this.element = make('div', { class: 'member-fields' });
  }

  /* `key` names the object: a text that was rejected remains only while the same one is shown. */
  show(key, fields, isLocked) {
    const shape = JSON.stringify([key, fields.map((field) => [field.member, field.pointer, field.kind, field.offers])]);
    if (shape !== this.shape) this.build(fields);
    this.shape = shape;
    for (const field of fields) this.fields.get(field.pointer).set(memberText(field), { isLocked, hint: memberHint(field) });
  }

  /* The focus stays at the member, also in another object. */
  build(fields) {
    const focused = [...this.fields.values()].find((one) => one.element.contains(document.activeElement))?.label;
    this.fields = new Map(fields.map((field) => [field.pointer, this.fieldOf(field)]));
    const elements = (isFlag) => fields.filter((field) => (field.kind === 'flag') === isFlag).map((field) => this.fields.get(field.pointer).element);
    const flags = elements(true);
    this.element.replaceChildren(...elements(false), ...(flags.length ? [make('div', { class: 'checks' }, ...flags)] : []));
    if (focused) [...this.fields.values()].find((one) => one.label === focused)?.input.focus();
  }

  fieldOf(field) {
    const one = memberField(field, {
      complete: this.complete,
      change: async (text, isForced) => {
        const rejection = await this.set(field.pointer, memberValue(field, text), isForced);
        if (rejection && !one.element.isConnected) this.announce(`${field.member}: ${rejection.text}`);
        return rejection;
      },
    });
    one.input.addEventListener('focus', () => this.focus());
    return one;
  }

  /* Focuses the field of a member, or of the object that has it. */
  reveal(pointer) {
    for (const [own, field] of this.fields) {
      if (!isWithin(pointer, own)) continue;
      field.input.focus();
      return true;
    }
    return false;
  }
}
