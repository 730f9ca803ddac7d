/* A modal dialog that removes itself when it closes; Escape closes it, and the focus returns. */
class Dialog {
  static count = 0;

  /* `actions`: buttons after Cancel. `onclose` is called however it closes. */
  constructor({ title, body, actions = [], cancel = 'Cancel', onclose = () => {} }) {
    const id = `dialog-${++Dialog.count}`;
    this.before = document.activeElement;
    this.message = make('p', { class: 'dialog-message', role: 'alert' });
    this.element = make('dialog', { 'aria-labelledby': id },
      make('div', { class: 'dialog-head' }, make('h2', { id, text: title })),
      make('div', { class: 'dialog-body' }, ...body),
      make('div', { class: 'dialog-foot' }, this.message, make('button', { type: 'button', text: cancel, onclick: () => this.close() }), ...actions));
    this.element.addEventListener('close', () => {
      this.element.remove();
      /* A list that is empty now is hidden. */
      const isShown = this.before?.isConnected && this.before.checkVisibility();
      (isShown ? this.before : document.querySelector('[role=tab][aria-selected=true]'))?.focus();
      onclose();
    });
    document.body.append(this.element);
    this.element.showModal();
  }

  reject(text) {
    setText(this.message, text);
  }

  close() {
    this.element.close();
  }
}

/* What Save would write: the diff, the findings that the edits add and fix, and what they break for others. */
class SaveDialog {
  constructor({ client, saved }) {
    Object.assign(this, { client, saved });
  }

  async open() {
    if (this.dialog) return;
    const review = await this.client.ask('POST', 'review', {});
    if (review.error || this.dialog) return;
    const list = (title, findings) => findings.length > 0 && make('section', {}, make('h3', { text: `${title}: ${findings.length}` }),
      make('div', { class: 'box', tabindex: 0, role: 'group', 'aria-label': title }, make('ul', { class: 'finding-list' }, ...findings.map((one) => findingElement(one, {})))));
    const broken = review.broken.map((one) => make('li', { class: 'warning' },
      make('p', {}, one.message, one.breaks?.length && make('span', { class: 'quiet', text: `, breaks ${one.breaks.join(' and ')}` }))));
    const raise = make('input', { type: 'checkbox', id: 'raise-revision' });
    this.button = make('button', { type: 'button', class: 'main', text: 'Save', onclick: () => this.save(raise.checked) });
    this.dialog = new Dialog({
      title: 'Save these edits?', actions: [this.button], onclose: () => { this.dialog = null; },
      body: [
        make('section', {}, make('h3', { text: 'Changed lines' }),
          make('div', { class: 'box', tabindex: 0, role: 'group', 'aria-label': 'Changed lines' }, make('pre', {}, ...(review.diff ? diffLines(review.diff) : [make('span', { class: 'line quiet', text: 'None.' })])))),
        list('New findings', review.new),
        list('Fixed findings', review.fixed),
        review.new.length + review.fixed.length === 0 && make('p', { class: 'quiet', text: 'No finding is new or fixed.' }),
        broken.length > 0 && make('section', {}, make('h3', { text: 'Breaking changes since the last commit' }),
          make('div', { class: 'box', tabindex: 0, role: 'group', 'aria-label': 'Breaking changes' }, make('ul', { class: 'finding-list' }, ...broken))),
        review.can_raise_revision && make('label', { class: 'check' }, raise, 'Raise the major revision, as for an incompatible device'),
      ],
    });
    this.button.focus();
  }

  async save(isRaised) {
    this.button.disabled = true;
    const rejected = await this.client.send('save', { raise_revision: isRaised });
    this.button.disabled = false;
    if (rejected) {
      this.dialog.reject(rejected.message);
      return;
    }
    this.dialog.close();
    this.saved();
  }
}

/* The keys of the page: of an EDS, DCF or overlay, and of a network file. */
const deviceKeys = [
  ['F1', 'this list'], ['/', 'search'], ['Ctrl+S', 'review and save'], ['Ctrl+Z, Ctrl+Y', 'undo, redo'], ['Alt+1, Alt+2, Alt+3', 'tab Device, Objects, PDOs'],
  ['Ctrl+Alt+N', 'new object'], ['Ctrl+Delete', 'remove the selected objects or entries'],
  ['arrow keys, Page Up, Page Down, Home, End', 'move in the tree, the entries, a frame'], ['Shift+arrow, Ctrl+A', 'select several rows: an edit changes all of them'],
  ['Enter, F2, or any character', 'edit a cell'], ['Enter, Tab', 'accept'], ['Ctrl+Enter', 'apply a text that was rejected for its errors'], ['Escape', 'discard the typed or rejected text'],
  ['Delete', 'clear a cell; remove an object from a PDO'], ['Ctrl+C, Ctrl+V', 'copy and paste cells'],
  ['Alt+arrow', 'move an object in a PDO'], ['Enter in the mappable objects', 'map the object'],
];
const networkKeys = [
  ['F1', 'this list'], ['Ctrl+S', 'review and save'], ['Ctrl+Z, Ctrl+Y', 'undo, redo'], ['Alt+1, Alt+2, Alt+3', 'tab Network, Nodes, Signals'],
  ['Ctrl+Alt+N', 'new node, or new signal in the tab Signals'], ['arrow keys, Home, End', 'select a node or signal; scroll the drawing'],
  ['Enter in the list', 'go to the fields'], ['Alt+arrow', 'move a signal'], ['Ctrl+Delete', 'remove the selected node or signal'],
  ['Enter, Tab', 'accept a text'], ['Ctrl+Enter', 'apply a text that was rejected for its errors'],
  ['Down, Up in a field', 'choices of a field'], ['Escape', 'close the choices; discard the typed or rejected text'],
];

const openKeys = (rows) => new Dialog({ title: 'Keys', cancel: 'Close', body: [make('table', { class: 'key-table' },
  make('thead', {}, make('tr', {}, make('th', { scope: 'col', text: 'Key' }), make('th', { scope: 'col', text: 'Effect' }))),
  make('tbody', {}, ...rows.map(([keys, effect]) => make('tr', {}, make('td', {}, make('kbd', { text: keys })), make('td', { text: effect })))))] });
