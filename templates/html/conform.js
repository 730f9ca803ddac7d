'use strict';
const filter = document.querySelector('.filter');
filter.hidden = false;
filter.addEventListener('click', (event) => {
  const chosen = event.target.closest('button');
  if (!chosen) return;
  for (const button of filter.children) button.setAttribute('aria-pressed', String(button === chosen));
  for (const one of document.querySelectorAll('.case')) {
    one.hidden = chosen.dataset.verdict !== '' && one.dataset.verdict !== chosen.dataset.verdict;
  }
  for (const area of document.querySelectorAll('.area')) area.hidden = !area.querySelector('.case:not([hidden])');
});
