/* Elements of the page. Texts are set as text, never as HTML: names of files and objects may have any characters. */
const byId = (id) => document.getElementById(id);

/* make('button', { type: 'button', class: 'quiet', text: 'Undo', onclick: undo }, child...): attributes that are undefined, null
   or false are left out. */
const make = (tag, attributes = {}, ...children) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === 'text') element.textContent = value;
    else if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.filter((child) => child !== undefined && child !== null && child !== false));
  return element;
};

/* Text that does not change costs no layout. */
const setText = (element, text) => {
  if (element.textContent !== text) element.textContent = text;
};

const setAttributes = (element, attributes) => {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) element.removeAttribute(name);
    else if (element.getAttribute(name) !== String(value)) element.setAttribute(name, value);
  }
};

const plural = (count, one, many = `${one}s`) => `${count} ${count === 1 ? one : many}`;

/* A text for screen readers that is not visible. */
const hidden = (text) => make('span', { class: 'hidden', text });

/* Applies the text of a field or cell for which it is named, which was rejected for the errors that it adds. */
const forceButton = (name, force) => make('button', { type: 'button', class: 'small danger', text: 'Apply anyway', 'aria-label': `Apply anyway: ${name}`,
  title: 'Ctrl+Enter in the field', onclick: force });

/* Calls at most once in a frame. */
const onceInFrame = (action) => {
  let isAsked = false;
  return () => {
    if (isAsked) return;
    isAsked = true;
    requestAnimationFrame(() => {
      isAsked = false;
      action();
    });
  };
};
