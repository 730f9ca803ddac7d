/* A unified diff: signs and colors. */
const diffLines = (diff) => diff.split('\n').filter((line, at, all) => line || at < all.length - 1).map((line) => {
  const isHead = /^(---|\+\+\+|@@)/.test(line);
  const kind = isHead ? 'hunk' : { '+': 'added', '-': 'removed' }[line[0]] ?? '';
  return make('span', { class: `line ${kind}`.trim(), text: line || ' ' });
});

/* The section of an EDS, or the pointer of a member of a network file. */
const placeOf = ({ section }) => (section.startsWith('/') ? section : `[${section}]`);

/* One finding, with its place and what fixes it. */
const findingElement = (finding, { open, fix }) => make('li', { class: finding.severity },
  make('p', {}, make('span', { class: 'severity', text: `${finding.severity}: ` }), finding.message),
  make('div', { class: 'place' },
    open && finding.section && make('button', { type: 'button', class: 'link', text: `${placeOf(finding)}, line ${finding.line}`, onclick: () => open(finding) }),
    !(open && finding.section) && finding.line > 0 && make('span', { class: 'quiet', text: `line ${finding.line}` }),
    finding.rule && make('span', { class: 'rule mono', text: finding.rule }),
    ...(fix ? finding.fixes ?? [] : []).map((one) => make('button', { type: 'button', class: 'small', text: one.needs_reason ? `${one.title} …` : `Fix: ${one.title}`, onclick: (event) => fix(one, event) }))));

/* A line of an EDS, and of JSON, after its number. */
const iniLine = (line, count) => {
  const equals = line.indexOf('=');
  if (/^\s*\[/.test(line)) return make('span', { class: 'line header' }, count, line);
  if (/^\s*;/.test(line)) return make('span', { class: 'line quiet' }, count, line);
  if (equals < 0) return make('span', { class: 'line' }, count, line || ' ');
  return make('span', { class: 'line' }, count, make('span', { class: 'key', text: line.slice(0, equals) }), line.slice(equals));
};
const jsonLine = (line, count) => {
  if (/^\s*\/\//.test(line)) return make('span', { class: 'line quiet' }, count, line);
  const parts = line.split(/("(?:[^"\\]|\\.)*"(?=\s*:))/);
  return make('span', { class: 'line' }, count, ...parts.map((part, at) => (at % 2 ? make('span', { class: 'key', text: part }) : part || (line ? null : ' '))));
};

/* Findings, the text of the section, and the unsaved edits as a diff. */
class SidePanel {
  constructor({ client, open, fix, announce }) {
    Object.assign(this, { client, open, fix, announce });
    this.known = null;
    this.section = null;
    this.drawLine = iniLine;
    this.tabs = new Tabs(document.querySelector('.tabs.small'), () => this.showText());
    this.showText = this.showText.bind(this);
  }

  get maxShown() {
    return 500;
  }

  /* The list changes only where a finding is new, so that a button keeps the focus. */
  showFindings(findings) {
    const { errors, warnings, list, more } = findings;
    const summary = errors + warnings + list.length === 0 ? 'none' : `${plural(errors, 'error')}, ${plural(warnings, 'warning')}`;
    setText(byId('findings-count'), summary);
    const items = byId('findings');
    const kept = new Map([...items.children].map((item) => [item.dataset.key, item]));
    const keyOf = (one) => JSON.stringify([one.severity, one.rule, one.message, one.section, one.line, (one.fixes ?? []).map((fix) => fix.title)]);
    const wanted = list.slice(0, this.maxShown).map((one) => {
      const key = keyOf(one);
      const item = kept.get(key);
      if (item) {
        kept.delete(key);
        return item;
      }
      const made = findingElement(one, { open: this.open, fix: this.fix });
      made.dataset.key = key;
      return made;
    });
    if (more > 0) wanted.push(make('li', { class: 'note', text: `${plural(more, 'more finding')}. edsc check lists all.` }));
    if (list.length === 0) wanted.push(make('li', { class: 'note quiet', text: 'No findings.' }));
    const hadFocus = items.contains(document.activeElement);
    if (wanted.length !== items.children.length || wanted.some((item, at) => items.children[at] !== item)) items.replaceChildren(...wanted);
    if (hadFocus && !items.contains(document.activeElement)) byId('findings-scroll').focus();
    const texts = new Set(list.map((one) => `${one.severity}: ${one.message}`));
    if (this.known) {
      const added = [...texts].filter((text) => !this.known.has(text));
      const fixed = [...this.known].filter((text) => !texts.has(text));
      if (added.length) this.announce(`New ${added[0]}${added.length > 1 ? `, and ${added.length - 1} more` : ''}. ${summary}.`);
      else if (fixed.length) this.announce(`${plural(fixed.length, 'finding')} fixed. ${summary}.`);
    }
    this.known = texts;
  }

  /* `title`: of a section, such as 2000sub1; of a network file a pointer, of which the empty one is the whole file; or null. */
  showSection(title) {
    if (title === this.section) return;
    this.section = title;
    this.showText();
  }

  /* Reads what is shown again, after a change. */
  showText() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.readText(), 60);
  }

  async readText() {
    await this.client.last;  /* A change in progress may remove the section. */
    if (this.tabs.selected === 'tab-diff') {
      const { diff = '' } = await this.client.ask('GET', 'diff');
      byId('diff-text').replaceChildren(...(diff ? diffLines(diff) : [make('span', { class: 'line quiet', text: 'No unsaved edits.' })]));
      return;
    }
    const title = this.section;
    const answer = title !== null ? await this.client.ask('GET', `section?title=${encodeURIComponent(title)}`) : { error: 'No entry is selected.' };
    if (title !== this.section) return;
    byId('section-text').replaceChildren(...(answer.lines ? answer.lines.map((line, at) => this.drawLine(line, make('span', { class: 'number', text: String(answer.line + at) })))
      : [make('span', { class: 'line quiet', text: answer.error ?? '' })]));
  }
}
