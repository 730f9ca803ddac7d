/* A new node or signal: its fields are sent together. */
class MemberDialog {
  /* `fields` of the state without pointers; `complete(offers, valueOf)` returns choices, where `valueOf(member)` is a text of this
     dialog; `add(members, name, isForced)` returns a rejection or null. `isNamed`: it has a name beside its members. `closed(isAdded)`. */
  constructor({ title, fields, isNamed = false, complete, add, closed }) {
    Object.assign(this, { fields, add, isAdded: false });
    const valueOf = (member) => this.inputs.get(member)?.text.trim() ?? '';
    this.inputs = new Map(fields.map((field) => [field.member, memberField(field, { complete: (offers) => complete(offers, valueOf) })]));
    this.name = isNamed ? new FormField({ label: 'name', hint: 'name of the node in signals and in the generated code' }) : null;
    this.button = make('button', { type: 'button', class: 'main', text: 'Add', onclick: () => this.send() });
    const elements = (isFlag) => fields.filter((field) => (field.kind === 'flag') === isFlag).map((field) => this.inputs.get(field.member).element);
    const flags = elements(true);
    this.force = make('button', { type: 'button', class: 'danger', text: 'Add anyway', title: 'Ctrl+Enter', hidden: true, onclick: () => this.send(true) });
    this.dialog = new Dialog({ title, actions: [this.force, this.button], onclose: () => closed(this.isAdded), body: [
      make('div', { class: 'member-fields' }, this.name?.element, ...elements(false), flags.length > 0 && make('div', { class: 'checks' }, ...flags))] });
    this.dialog.element.addEventListener('keydown', (event) => {
      if (event.key === 'Enter' && (event.ctrlKey || event.target.matches('input[type=text]'))) this.send(event.ctrlKey);
    });
    this.dialog.element.querySelector('.field input').focus();
  }

  get members() {
    const values = this.fields.map((field) => [field.member, memberValue(field, this.inputs.get(field.member).text.trim())]);
    return Object.fromEntries(values.filter(([, value]) => value.length > 0));
  }

  async send(isForced = false) {
    const name = this.name?.text.trim();
    if (name === '') {
      this.dialog.reject('Type a name.');
      this.name.input.focus();
      return;
    }
    this.button.disabled = this.force.disabled = true;
    const rejection = await this.add(this.members, name, isForced);
    this.button.disabled = this.force.disabled = false;
    this.force.hidden = !rejection?.canForce;
    this.isAdded = !rejection;
    if (rejection) this.dialog.reject(rejection.text);
    else this.dialog.close();
  }
}
