/* Rows of equal height, of which only those on the screen are in the document. */
class VirtualRows {
  static overscan = 6;  /* rows above and below, so that a step of the wheel draws nothing empty */

  /* `scroller` scrolls and `body` has the rows; `create()` returns an element for a row, and `draw(element, at)` fills it. */
  constructor({ scroller, body, create, draw, headHeight = () => 0 }) {
    Object.assign(this, { scroller, body, create, draw, headHeight });
    this.count = 0;
    this.shown = new Map();
    this.free = [];
    this.kept = -1;
    this.probe = make('div', { class: 'row-height' });
    body.parentElement.append(this.probe);
    this.drawSoon = onceInFrame(() => this.update());
    scroller.addEventListener('scroll', this.drawSoon, { passive: true });
    new ResizeObserver(() => {
      this.measure();
      this.drawSoon();
    }).observe(scroller);
    this.measure();
  }

  measure() {
    const height = this.probe.getBoundingClientRect().height || 28;
    if (height === this.height) return;
    this.height = height;
    this.placeAll();
  }

  placeAll() {
    this.body.style.height = `${this.count * this.height}px`;
    for (const [at, element] of this.shown) element.style.top = `${at * this.height}px`;
  }

  /* Draws all visible rows again. `kept` stays in the document also if it is not visible: it has the focus. */
  reset(count, kept = this.kept) {
    this.count = count;
    this.kept = kept < count ? kept : -1;
    this.placeAll();
    for (const [at, element] of [...this.shown]) if (at >= count) this.remove(at, element);
    this.update(true);
  }

  keep(at) {
    this.kept = at;
  }

  /* Draws one row again if it is in the document. */
  redraw(at) {
    const element = this.shown.get(at);
    if (element) this.draw(element, at);
  }

  remove(at, element) {
    element.remove();
    this.shown.delete(at);
    if (this.free.length < 80) this.free.push(element);
  }

  range() {
    const top = this.scroller.scrollTop;
    const visible = Math.ceil((this.scroller.clientHeight || 600) / this.height) + 1;
    const first = Math.max(0, Math.floor(top / this.height) - VirtualRows.overscan);
    return [first, Math.min(this.count, first + visible + 2 * VirtualRows.overscan)];
  }

  update(isAll = false) {
    const [first, end] = this.range();
    for (const [at, element] of [...this.shown]) if ((at < first || at >= end) && at !== this.kept) this.remove(at, element);
    const wanted = [];
    for (let at = first; at < end; ++at) wanted.push(at);
    if (this.kept >= 0 && this.kept < first) wanted.unshift(this.kept);
    if (this.kept >= end && this.kept < this.count) wanted.push(this.kept);
    let next = this.body.firstElementChild;
    for (const at of wanted) {
      let element = this.shown.get(at);
      if (element && !isAll) {
        if (element === next) next = next.nextElementSibling;
        else this.body.insertBefore(element, next);
        continue;
      }
      if (!element) {
        element = this.free.pop() ?? this.create();
        element.style.top = `${at * this.height}px`;
        this.shown.set(at, element);
      }
      this.draw(element, at);
      if (element === next) next = next.nextElementSibling;
      else this.body.insertBefore(element, next);
    }
  }

  scrollTo(at) {
    const head = this.headHeight();
    const top = at * this.height, bottom = top + this.height + head;
    if (top < this.scroller.scrollTop) this.scroller.scrollTop = top;
    else if (bottom > this.scroller.scrollTop + this.scroller.clientHeight) {
      this.scroller.scrollTop = bottom - this.scroller.clientHeight;
    }
    this.update();
  }

  get rowsOfPage() {
    return Math.max(1, Math.floor((this.scroller.clientHeight - this.headHeight()) / this.height) - 1);
  }
}
