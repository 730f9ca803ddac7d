/* The nodes of a network file: their list, and the members and values of one of them. */
class NodeEditor {
  /* `change(changes, isForced)`, `remove(changes)` and `set(pointer, value, isForced)` return a rejection or null; `select(node)` is
     called with the node that is shown. */
  constructor(element, { change, remove, set, announce, complete, showText, select, marksOf }) {
    Object.assign(this, { change, removeItems: remove, announce, showText, select, marksOf });
    this.nodes = [];
    this.newNode = [];
    this.addButton = make('button', { type: 'button', text: 'New node', 'aria-haspopup': 'dialog', 'aria-keyshortcuts': 'Control+Alt+N', onclick: () => this.add() });
    this.list = new ItemList({ id: 'nodes', label: 'Nodes', select: (at) => this.selectAt(at), enter: () => this.enter(), remove: () => this.remove() });
    this.empty = make('p', { class: 'empty', text: 'No node. New node adds one.' });
    this.title = make('h2', { id: 'node-title' });
    this.removeButton = make('button', { type: 'button', class: 'small', text: 'Remove this node', onclick: () => this.remove() });
    this.nameSlot = make('div', { class: 'member-fields' });
    const focus = () => this.showText(this.node.pointer);
    this.fields = new MemberFields({ set, complete, announce, focus });
    this.values = new SetValues({ change, remove, announce, focus });
    this.complete = complete;
    this.content = make('section', { class: 'member-main', 'aria-labelledby': 'node-title' },
      make('div', { class: 'member-head' }, this.title, this.removeButton), this.nameSlot, this.fields.element, this.values.element);
    element.append(make('div', { class: 'member-side' }, make('div', { class: 'actions', role: 'group', 'aria-label': 'Nodes' }, this.addButton), this.list.element),
      this.empty, this.content);
  }

  get node() {
    return this.nodes[this.list.at];
  }

  show({ nodes, new_node: newNode }, isLocked) {
    const before = this.wanted ?? this.node?.name;
    const found = nodes.findIndex((one) => one.name === before);
    if (found >= 0) this.wanted = undefined;
    this.nodes = nodes;
    this.newNode = newNode;
    this.isLocked = isLocked;
    this.addButton.disabled = isLocked;
    this.list.show(nodes.map((one) => ({
      title: one.name, note: one.fields.find((field) => field.member === 'node_id')?.value, detail: membersText(one.fields, ['node_id']), marks: this.marksOf(one.pointer),
    })), found >= 0 ? found : this.list.at);
    this.showNode();
  }

  showNode() {
    const { node, isLocked } = this;
    this.empty.hidden = Boolean(node);
    this.content.hidden = !node;
    this.select(node);
    if (!node) return;
    setText(this.title, `Node ${node.name}`);
    this.removeButton.disabled = isLocked;
    this.showName(node);
    this.fields.show(node.pointer, node.fields, isLocked);
    this.values.show(node, isLocked);
  }

  showName(node) {
    if (this.named !== node.name) {
      const hadFocus = this.nameSlot.contains(document.activeElement);
      this.name = new FormField({ label: 'name', change: (name, isForced) => this.rename(node, name, isForced) });
      this.nameSlot.replaceChildren(this.name.element);
      this.name.input.addEventListener('focus', () => this.showText(this.node.pointer));
      this.named = node.name;
      if (hadFocus) this.name.input.focus();
    }
    this.name.set(node.name, { isLocked: this.isLocked });
  }

  selectAt(at) {
    this.list.at = at;
    this.showNode();
    this.showText(this.node.pointer);
  }

  enter() {
    if (!this.node) return;
    this.announce(`${this.node.name} is highlighted in the drawing.`);
    this.name.input.focus();
  }

  /* Focuses the member that a finding or the drawing names. */
  reveal(pointer) {
    const at = this.nodes.findIndex((one) => isWithin(pointer, one.pointer));
    if (at < 0) return false;
    this.list.go(at);
    if (!this.values.reveal(pointer) && !this.fields.reveal(pointer)) this.list.element.focus();
    return true;
  }

  rename(node, name, isForced) {
    this.wanted = name;
    return this.change([{ do: 'rename', pointer: node.pointer, name }], isForced).then((rejection) => {
      if (rejection) this.wanted = undefined;
      else this.announce(`${node.name} renamed to ${name}.`);
      return rejection;
    });
  }

  add() {
    if (this.isLocked || this.dialog) return;
    this.dialog = new MemberDialog({
      title: 'New node', isNamed: true, fields: this.newNode, complete: (offers) => this.complete(offers),
      closed: (isAdded) => {
        this.dialog = null;
        if (!isAdded) return;
        this.list.element.focus();
        this.showText(this.node.pointer);
      },
      add: async (members, name, isForced) => {
        this.wanted = name;
        const rejection = await this.change([{ do: 'add', pointer: `/nodes/${pointerPart(name)}`, members }], isForced);
        if (rejection) this.wanted = undefined;
        else this.announce(`${name} added.`);
        return rejection;
      },
    });
  }

  async remove() {
    const { node } = this;
    if (!node || this.isLocked) return;
    const rejection = await this.removeItems([{ do: 'remove', pointer: node.pointer }]);
    this.announce(rejection?.text ?? `${node.name} removed.`);
    if (!document.querySelector('dialog')) this.list.focusOr(this.addButton);
  }
}
