/* A drawing of `edsc document`, as the server draws it. Its rules are in the style of the page, which the policy of the page requires. */
class NetworkDrawing {
  static leastScale = 0.8;  /* a wider drawing is scrolled, so that its texts can be read */

  /* `pick(name)` is called with the node that is clicked. */
  constructor({ title, pick = () => {} }) {
    const id = `drawing-${title.toLowerCase().replaceAll(' ', '-')}`;
    this.source = null;
    this.node = '';
    this.scroll = make('div', { class: 'drawing', tabindex: 0, role: 'group', 'aria-labelledby': id });
    this.texts = make('ul', { class: 'drawing-texts' });
    this.element = make('section', { 'aria-labelledby': id }, make('h2', { id, text: title }), this.scroll,
      make('details', { class: 'drawing-text' }, make('summary', { text: `${title} as text` }), this.texts));
    this.scroll.addEventListener('click', (event) => {
      const text = event.target.closest?.('g')?.querySelector('title')?.textContent;
      if (text) pick(text);
    });
  }

  /* `source`: SVG, or null. The texts in it are texts: it is parsed as XML, and scripts in it do not run. */
  show(source) {
    this.element.hidden = !source;
    if (source === this.source) return;
    this.source = source;
    const svg = source && new DOMParser().parseFromString(source.replace(/<style>[^]*?<\/style>/, ''), 'image/svg+xml').documentElement;
    if (svg) svg.style.minWidth = `${NetworkDrawing.leastScale * svg.getAttribute('width')}px`;
    const { scrollLeft } = this.scroll;
    this.scroll.replaceChildren(...(svg ? [document.adoptNode(svg)] : []));
    this.scroll.scrollLeft = scrollLeft;
    const textsOf = (selector) => [...this.scroll.querySelectorAll(selector)].map((one) => one.textContent);
    const sentences = textsOf('svg > desc').flatMap((text) => text.split(/(?<=\.) /));
    this.texts.replaceChildren(...[...sentences, ...textsOf('g:not(:has(.box)) > title')].map((text) => make('li', { text })));
    this.mark();
  }

  /* The node gets a thick outline, and is scrolled into view. */
  highlight(name) {
    if (this.node === name) return;
    this.node = name;
    this.mark();
    const box = this.scroll.querySelector('.chosen .box');
    if (!box) return;
    const outer = this.scroll.getBoundingClientRect(), inner = box.getBoundingClientRect();
    if (inner.left < outer.left) this.scroll.scrollLeft -= outer.left - inner.left;
    else if (inner.right > outer.right) this.scroll.scrollLeft += inner.right - outer.right;
  }

  mark() {
    for (const one of this.scroll.querySelectorAll('g')) one.classList.toggle('chosen', one.querySelector('title')?.textContent === this.node);
  }
}
