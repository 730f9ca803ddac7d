// The search, by lunr over the index of MkDocs. It works for files and on a server.
(() => {
  // What is wider than the page scrolls by keyboard.
  const scrolls = () => {
    for (const block of document.querySelectorAll('main pre, main table')) {
      if (block.scrollWidth > block.clientWidth) block.tabIndex = 0;
      else block.removeAttribute('tabindex');
    }
  };
  addEventListener('resize', scrolls);
  scrolls();
  // On a narrow screen the text comes first.
  const narrow = matchMedia('(max-width: 45rem)');
  const menu = document.querySelector('.menu');
  const fold = () => { menu.open = !narrow.matches; };
  narrow.addEventListener('change', fold);
  fold();
  const query = document.getElementById('query');
  const results = document.getElementById('results');
  const pages = new Map(searchIndex.docs.map((page) => [page.location, page]));
  let index = null;
  const search = (text) => {
    index ??= lunr(function build() {
      this.ref('location');
      this.field('title', { boost: 10 });
      this.field('text');
      // Pages for users come first.
      for (const page of pages.values()) this.add(page, { boost: page.location.startsWith('developers/') ? 0.1 : 1 });
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
