/* Tabs: arrow keys, Home and End select one. */
class Tabs {
  constructor(list, show = () => {}) {
    this.tabs = [...list.querySelectorAll('[role=tab]')];
    this.show = show;
    list.addEventListener('click', (event) => {
      const tab = event.target.closest('[role=tab]');
      if (tab) this.select(tab.id, false);
    });
    list.addEventListener('keydown', (event) => {
      const { shown } = this;
      const at = shown.indexOf(document.activeElement);
      const next = { ArrowRight: at + 1, ArrowLeft: at - 1 + shown.length, Home: 0, End: shown.length - 1 }[event.key];
      if (next === undefined || at < 0) return;
      event.preventDefault();
      this.select(shown[next % shown.length].id, true);
    });
  }

  get shown() {
    return this.tabs.filter((tab) => !tab.hidden);
  }

  get selected() {
    return this.tabs.find((tab) => tab.getAttribute('aria-selected') === 'true').id;
  }

  select(id, isFocused) {
    for (const tab of this.tabs) {
      const isSelected = tab.id === id;
      setAttributes(tab, { 'aria-selected': String(isSelected), tabindex: isSelected ? null : -1 });
      byId(tab.getAttribute('aria-controls')).hidden = !isSelected;
      if (isSelected && isFocused) tab.focus();
    }
    this.show(id);
  }
}
