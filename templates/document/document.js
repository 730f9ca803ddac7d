'use strict';
(() => {
  const byId = (id) => document.getElementById(id);
  const form = document.querySelector('form.tools');

  /* Opens what a link leads to, also if a filter hides it. */
  const reveal = () => {
    const target = byId(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    const object = target.closest('.object');
    if (object && form && object.closest('.gone')) form.reset();
    for (let one = target; one; one = one.parentElement) if (one.localName === 'details') one.open = true;
    target.scrollIntoView();
  };

  /* Closed details are not printed. */
  let opened = [];
  addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll('details:not([open])')];
    for (const one of opened) one.open = true;
  });
  addEventListener('afterprint', () => {
    for (const one of opened) one.open = false;
  });

  const copy = async (button) => {
    try {
      await navigator.clipboard.writeText(button.textContent);
    } catch {
      getSelection().selectAllChildren(button);
      document.execCommand('copy');
    }
    button.classList.add('done');
    setTimeout(() => button.classList.remove('done'), 1500);
  };
  document.addEventListener('click', (event) => {
    const button = event.target.closest('.copy');
    if (button) copy(button);
  });

  if (form) {
    const status = form.querySelector('.count');
    const filters = { area: byId('area'), type: byId('type'), access: byId('access'), pdo: byId('pdo') };
    const query = byId('query'), changed = byId('changed'), differs = byId('differs');
    const maxOpened = 20;  /* objects that a search expands, if it finds not more */
    const entryWord = /^(?:0x)?([0-9a-f]{4})h?(?:[:.-](?:0x)?([0-9a-f]{1,2})h?)?$/;

    /* The texts of an object without those that every object has: the kind with its line, and the heads of its tables. */
    const textOf = (object) => {
      let text = object.textContent.replace(/ [A-Z]+, line \d+/, ' ');
      for (const head of object.querySelectorAll('thead')) text = text.replace(head.textContent, ' ');
      return text.toLowerCase();
    };

    /* What is searched, read from the page once. */
    let areas;
    const readPage = () => {
      areas = [...document.querySelectorAll('.area')].map((area) => ({
        heading: area.querySelector('h3'),
        id: area.dataset.area,
        chunks: [...area.querySelectorAll('.chunk')].map((chunk) => ({
          element: chunk,
          shown: chunk.children.length,
          objects: [...chunk.children].map((object) => ({
            element: object,
            index: object.id.slice(0, 4).toLowerCase(),
            differs: object.classList.length > 1,
            summary: object.firstElementChild.textContent.toLowerCase(),
            text: textOf(object),
            rows: [...object.querySelectorAll('tr[data-t]')],
            shown: true,
          })),
        })),
      }));
    };

    const wordsOf = (text) => text.toLowerCase().split(/\s+/).filter(Boolean).map((word) => {
      const entry = entryWord.exec(word);
      return { word, index: entry && entry[1], sub: entry && entry[2] && entry[2].padStart(2, '0') };
    });
    const subOf = (row) => row.firstElementChild.textContent.toLowerCase();
    const matchesWord = (object, { word, index, sub }) =>
      index && index === object.index ? !sub || object.rows.some((row) => subOf(row) === sub) : object.text.includes(word);
    const matchesRow = (row, wanted) =>
      (!wanted.type || row.dataset.t === wanted.type) && (!wanted.access || row.dataset.a === wanted.access) &&
      (!wanted.pdo || (row.dataset.p || '').split(' ').includes(wanted.pdo)) &&
      (!wanted.changed || row.dataset.c !== undefined);

    /* Not `hidden`: without its box, an element costs a pass over all objects. */
    const setShown = (element, isShown) => element.classList.toggle('gone', !isShown);

    /* Chunks that grow have no layout until the next frame, which only lays out those in view. */
    const grownChunks = new Set();
    const grow = (chunk) => {
      chunk.style.contentVisibility = 'hidden';
      if (grownChunks.size === 0) {
        requestAnimationFrame(() => {
          for (const one of grownChunks) one.style.contentVisibility = '';
          grownChunks.clear();
        });
      }
      grownChunks.add(chunk);
    };

    let marked = [], expanded = [];
    const show = (object, words) => {
      if (words.some(({ word, sub }) => sub || !object.summary.includes(word))) {
        if (!object.element.open) expanded.push(object.element);
        object.element.open = true;
      }
      for (const row of object.rows) {
        const text = row.textContent.toLowerCase();
        const isHit = words.every((one) => one.sub ? subOf(row) === one.sub : text.includes(one.word));
        if (isHit) { row.classList.add('hit'); marked.push(row); }
      }
    };

    const search = () => {
      if (!areas) readPage();
      const words = wordsOf(query.value);
      const wanted = { type: filters.type.value, access: filters.access.value, pdo: filters.pdo.value,
                       changed: changed && changed.checked };
      const byRow = Boolean(wanted.type || wanted.access || wanted.pdo || wanted.changed);
      const isFound = (object) =>
        words.every((word) => matchesWord(object, word)) && !(differs && differs.checked && !object.differs) &&
        (!byRow || object.rows.some((row) => matchesRow(row, wanted)));
      for (const row of marked) row.classList.remove('hit');
      for (const one of expanded) one.open = false;
      marked = [];
      expanded = [];
      const found = [];
      let count = 0, all = 0;
      for (const area of areas) {
        const inArea = !filters.area.value || filters.area.value === area.id;
        let inAreaCount = 0;
        for (const chunk of area.chunks) {
          let shown = 0;
          const results = chunk.objects.map((object) => inArea && isFound(object));
          chunk.objects.forEach((object, at) => {
            ++all;
            if (!results[at]) return;
            ++shown;
            if (found.length <= maxOpened) found.push(object);
          });
          if (shown) {
            chunk.objects.forEach((object, at) => {
              if (object.shown !== results[at]) setShown(object.element, object.shown = results[at]);
            });
            if (shown > chunk.shown) grow(chunk.element);
            if (shown !== chunk.shown) chunk.element.style.setProperty('--n', chunk.shown = shown);
          }
          setShown(chunk.element, shown > 0);
          inAreaCount += shown;
        }
        setShown(area.heading, inAreaCount > 0);
        count += inAreaCount;
      }
      if (words.length > 0 && count <= maxOpened) for (const object of found) show(object, words);
      status.textContent = count === all ? `${all} object${all === 1 ? '' : 's'}` : `${count} of ${all} objects`;
    };

    const setAll = (open) => {
      for (const area of areas || (readPage(), areas)) {
        for (const chunk of area.chunks) {
          if (chunk.element.closest('.gone')) continue;
          for (const object of chunk.objects) if (object.shown) object.element.open = open;
        }
      }
    };

    form.hidden = false;
    form.addEventListener('input', search);
    form.addEventListener('submit', (event) => event.preventDefault());
    form.addEventListener('reset', () => {
      query.value = '';
      for (const one of Object.values(filters)) one.value = '';
      for (const one of [changed, differs]) if (one) one.checked = false;
      search();
    });
    byId('open').addEventListener('click', () => setAll(true));
    byId('close').addEventListener('click', () => setAll(false));
    addEventListener('keydown', (event) => {
      const isTyping = event.target.matches && event.target.matches('input, select');
      if (event.key === '/' && !isTyping && !event.ctrlKey && !event.metaKey && !event.altKey) {
        event.preventDefault();
        query.focus();
        query.select();
      } else if (event.key === 'Escape' && event.target === query) {
        query.value = '';
        search();
      }
    });
    /* Browsers keep what was typed before a reload. */
    (window.requestIdleCallback || setTimeout)(() => {
      if (!areas) readPage();
      if (query.value || Object.values(filters).some((one) => one.value)) search();
    });
  }
  addEventListener('hashchange', reveal);
  if (location.hash) reveal();
})();
