/* A table whose rows have keys, in their order. */
class KeyedTable {
  constructor(body, classes) {
    this.body = body;
    this.classes = classes;
    this.rows = new Map();
  }

  row(key, order) {
    let row = this.rows.get(key);
    if (row) return row;
    const element = document.createElement('tr');
    for (const name of this.classes) element.insertCell().className = name;
    row = { element, order, cells: [...element.cells] };
    let next = this.body.firstElementChild;
    while (next && next.order <= order) next = next.nextElementSibling;
    element.order = order;
    this.body.insertBefore(element, next);
    this.rows.set(key, row);
    return row;
  }

  remove(key) {
    this.rows.get(key)?.element.remove();
    this.rows.delete(key);
  }
}
