// The search, by lunr over the index of MkDocs. It works for files and on a server.
(() => {
  for (const block of document.querySelectorAll('pre')) block.tabIndex = 0; // scrolls by keyboard
  const query = document.getElementById('query');
  const results = document.getElementById('results');
  const pages = new Map(searchIndex.docs.map((page) => [page.location, page]));
  let index = null;
  const search = (text) => {
    index ??= lunr(function build() {
      this.ref('location');
      this.field('title', { boost: 10 });
      this.field('text');
      for (const page of pages.values()) this.add(page);
    });
    const words = lunr.tokenizer(text).map(String).filter((word) => word);
    return index.query((all) => {
      for (const word of words) {
        all.term(index.pipeline.runString(word), { boost: 2 });
        all.term(word, { wildcard: lunr.Query.wildcard.TRAILING });
      }
    });
  };
  const row = (found) => {
    const page = pages.get(found.ref);
    const item = document.createElement('li');
    const link = document.createElement('a');
    link.href = `${document.body.dataset.base}/${page.location}`;
    link.textContent = page.title;
    item.append(link, ` ${page.text.slice(0, 120)}`);
    return item;
  };
  const show = () => {
    const text = query.value.trim();
    results.hidden = text === '';
    if (!text) return;
    const found = search(text);
    const list = document.createElement('ol');
    list.append(...found.slice(0, 20).map(row));
    const count = document.createElement('p');
    count.textContent = `${found.length} results for "${text}"`;
    results.replaceChildren(count, list);
  };
  query.addEventListener('input', show);
  query.form.addEventListener('submit', (event) => { event.preventDefault(); show(); });
})();
