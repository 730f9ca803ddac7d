/* A network file: its members as forms, its nodes and signals, and what they mean for the bus. */
class NetworkView {
  /* `change(changes, isForced)` returns a rejection or null, and `remove(changes)` also asks to force them; `showText(pointer)` shows the
     lines of a member; `tabs` selects one. */
  constructor({ change, remove, announce, showText, tabs }) {
    Object.assign(this, { tabs });
    this.pointer = '';
    this.showText = (pointer) => {
      this.pointer = pointer;
      showText(pointer);
    };
    const complete = (offers, from) => this.choicesOf(offers, from);
    const marksOf = (pointer) => this.marksOf(pointer);
    this.groups = [];
    this.groupList = make('div', { class: 'form-groups' });
    byId('view-network').append(this.groupList);
    this.set = (pointer, value, isForced) => change([{ do: 'set', pointer, value }], isForced);
    this.announce = announce;
    const options = { change, remove, set: this.set, announce, complete, showText: this.showText, marksOf };
    this.nodes = new NodeEditor(byId('view-nodes'), { ...options, select: (node) => this.drawing.highlight(node?.name ?? '') });
    this.signals = new SignalEditor(byId('view-signals'), options);
    this.drawing = new NetworkDrawing({ title: 'Drawing', pick: (name) => this.pick(name) });
    this.cycle = new NetworkDrawing({ title: 'SYNC cycle' });
    this.load = new BusLoad();
    byId('picture').append(this.load.element, this.drawing.element, this.cycle.element, this.load.messages);
    this.findings = [];
  }

  /* `state`: the part `network`, or null if the text is not a network file. `lists`: of the entries of nodes. `findings`: their
     list. */
  show(state, lists, findings, isLocked) {
    const network = state && { ...state, nodes: state.nodes.map((node) => ({ ...node, objects: lists[node.objects] ?? [] })) };
    this.network = network;
    this.findings = findings;
    byId('workspace').classList.toggle('text-only', !network);
    byId('not-network').hidden = Boolean(network);
    if (!network) {
      this.showText('');
      return;
    }
    this.drawing.show(network.drawing);
    this.cycle.show(network.cycle);
    this.load.show(network.load);
    if (!this.hasPlace(this.pointer)) this.showText('');
    this.showGroups(network.groups, isLocked);
    this.nodes.show(network, isLocked);
    this.signals.show(network, isLocked);
  }

  /* Whether the file has what the text is of: an edit or undo removes it. */
  hasPlace(pointer) {
    const { groups, nodes, signals } = this.network;
    const parts = groups.filter(({ pointer: own, fields }) => own !== '' && fields.some((field) => field.present));
    return pointer === '' || [...parts, ...nodes, ...signals].some((one) => isWithin(pointer, one.pointer));
  }

  showGroups(groups, isLocked) {
    const shape = JSON.stringify(groups.map((group) => [group.title, group.pointer]));
    if (shape !== this.shape) {
      this.shape = shape;
      this.groups = groups.map((group, at) => new MemberFields({
        set: this.set, announce: this.announce, complete: (offers) => this.choicesOf(offers), focus: () => this.showGroupText(at) }));
      this.groupList.replaceChildren(...groups.map(({ title }, at) => make('section', { class: 'form-group', 'aria-labelledby': `network-group-${at}` },
        make('h2', { id: `network-group-${at}`, text: title }), this.groups[at].element)));
    }
    groups.forEach((group, at) => this.groups[at].show(group.pointer, group.fields, isLocked));
  }

  /* The lines of a group, or of the file if it does not have the group. */
  showGroupText(at) {
    const { pointer, fields } = this.network.groups[at];
    this.showText(fields.some((field) => field.present) ? pointer : '');
  }

  /* Choices for a text: `from` is the sending node of a signal. */
  choicesOf(offers, from = '') {
    const { nodes } = this.network;
    const node = nodes.find((one) => one.name === from);
    const others = nodes.filter((one) => one.name !== from);
    const entries = (one) => one.objects.map(({ text, name }) => ({ text: `${one.name}.${text}`, hint: name }));
    if (offers === 'nodes') return nodes.map(({ name }) => name);
    /* A master without a file has no objects: it sends those of a receiver, and receives under its name. */
    if (offers === 'objects') return node?.objects.length ? node.objects.map(({ text, name }) => ({ text, hint: name })) : others.flatMap(entries);
    return others.flatMap((one) => (one.objects.length ? entries(one) : [{ text: one.name, hint: '' }]));
  }

  marksOf(pointer) {
    const count = (severity) => this.findings.filter((one) => one.severity === severity && isWithin(one.section, pointer)).length;
    return { errors: count('error'), warnings: count('warning') };
  }

  pick(name) {
    const at = this.network.nodes.findIndex((one) => one.name === name);
    if (at < 0) return;
    this.tabs.select('tab-nodes', false);
    this.nodes.list.go(at);
    this.nodes.list.element.focus();
  }

  /* Shows the member that a finding is at. */
  reveal(pointer) {
    if (!this.network) return;
    const [, part] = pointer.split('/');
    const views = { nodes: this.nodes, signals: this.signals };
    this.tabs.select(`tab-${views[part] ? part : 'network'}`, false);
    const isFound = views[part] ? views[part].reveal(pointer) : this.groups.some((group) => group.reveal(pointer));
    if (isFound) return;
    byId(`tab-${views[part] ? part : 'network'}`).focus();
    this.showText(pointer);
  }

  /* Shows the text of what is selected in a tab. */
  showTab(id) {
    const selected = { 'tab-nodes': this.nodes.node, 'tab-signals': this.signals.signal }[id];
    this.showText(selected?.pointer ?? '');
  }

  /* A new item of the list that is shown. */
  add() {
    if (!this.network) return;
    if (this.tabs.selected === 'tab-signals') this.signals.add();
    else {
      this.tabs.select('tab-nodes', false);
      this.nodes.add();
    }
  }
}
