/* The bus load: a text, a bar, and the messages that cause it. */
class BusLoad {
  constructor() {
    this.text = make('p', { id: 'load-text', role: 'status' });
    this.bar = make('div', { class: 'load-fill' });
    this.track = make('div', { class: 'load-bar', role: 'meter', 'aria-labelledby': 'load-text', 'aria-valuemin': 0, 'aria-valuemax': 100 }, this.bar);
    this.body = make('tbody');
    const columns = ['Message', 'Sender', 'CAN-ID', 'Load in %', 'Response in ms'];
    this.table = make('div', { class: 'load-messages', tabindex: 0, role: 'group', 'aria-labelledby': 'messages-title' }, make('table', { class: 'mapped-table' },
      make('thead', {}, make('tr', {}, ...columns.map((text, at) => make('th', { scope: 'col', class: at > 2 ? 'number' : null, text })))), this.body));
    this.element = make('section', { class: 'bus-load', 'aria-labelledby': 'load-title' }, make('h2', { id: 'load-title', text: 'Bus load' }), this.text, this.track);
    this.messages = make('section', { 'aria-labelledby': 'messages-title' }, make('h2', { id: 'messages-title', text: 'Messages' }), this.table);
  }

  /* `load`: the part of the state, or null if the file has no bit rate. */
  show(load) {
    const percent = load?.percent ?? 0;
    setText(this.text, load ? `${load.is_over ? 'Too high: ' : ''}${load.text}` : 'The bus load is not known.');
    this.text.classList.toggle('over', load?.is_over ?? false);
    this.track.hidden = !load;
    this.track.classList.toggle('over', load?.is_over ?? false);
    this.bar.style.width = `${Math.min(100, percent)}%`;
    setAttributes(this.track, { 'aria-valuenow': Math.min(100, Math.round(percent)), 'aria-valuetext': load?.text });
    const messages = load?.messages ?? [];
    this.messages.hidden = messages.length === 0;
    const shape = JSON.stringify(messages);
    if (shape === this.shape) return;
    this.shape = shape;
    this.body.replaceChildren(...messages.map((one) => make('tr', {}, make('td', { text: one.name }), make('td', { text: one.sender }), make('td', { class: 'mono', text: one.can_id }),
      make('td', { class: 'number', text: one.load_percent.toFixed(2) }), make('td', { class: 'number', text: one.response_ms === null ? 'no bound' : one.response_ms.toFixed(2) }))));
  }
}
