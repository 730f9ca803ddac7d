/* The server of this page: it has the file, and the page has a copy of its state in parts. */
class EditClient {
  static sessionKey = 'edsc-session';
  static retryMs = 1000;

  /* `update(names)` is called with the names of the parts that changed; `connect(problem)` with '' while the server answers. */
  constructor({ update, connect }) {
    Object.assign(this, { update, connect });
    this.version = 0;
    this.parts = new Map();
    this.last = Promise.resolve();
    this.problem = 'connecting';
  }

  /* The token of the address is used once: a reload of the page uses the session. */
  async start() {
    const token = new URLSearchParams(location.search).get('token');
    history.replaceState(null, '', location.pathname);
    this.session = sessionStorage.getItem(EditClient.sessionKey) ?? '';
    if (token) {
      const answer = await this.fetch('POST', 'session', { token }).catch(() => null);
      if (answer?.ok) {
        this.session = (await answer.json()).session;
        sessionStorage.setItem(EditClient.sessionKey, this.session);
      }
    }
    addEventListener('pagehide', () => {
      if (this.session) this.fetch('POST', 'close', {}, { keepalive: true }).catch(() => {});
    });
    await this.poll();
  }

  fetch(method, path, body, options = {}) {
    const headers = { 'X-Edsc-Session': this.session };
    if (body) headers['Content-Type'] = 'application/json';
    return fetch(path, { method, headers, body: body && JSON.stringify(body), cache: 'no-store', ...options });
  }

  setProblem(problem) {
    if (this.problem === problem) return;
    this.problem = problem;
    this.connect(problem);
  }

  async poll() {
    for (let isFirst = true; ; isFirst = false) {
      try {
        const answer = await this.fetch('GET', `state?since=${this.version}${isFirst || this.problem ? '' : '&wait=1'}`);
        if (answer.ok) {
          this.take(await answer.json());
          this.setProblem('');
          continue;
        }
        this.setProblem(answer.status === 403 ? 'session' : 'lost');
        if (answer.status === 403) return;
      } catch {
        this.setProblem('lost');
      }
      await new Promise((resolve) => setTimeout(resolve, EditClient.retryMs));
    }
  }

  /* An answer that is not newer than the state has nothing new: that to a change and that to the waiting request have the same parts. */
  take(update) {
    if (update.version <= this.version) return;
    this.version = update.version;
    const names = new Set([...Object.keys(update.parts ?? {}), ...(update.removed ?? [])]);
    for (const [name, part] of Object.entries(update.parts ?? {})) this.parts.set(name, part);
    for (const name of update.removed ?? []) this.parts.delete(name);
    if (names.size) this.update(names);
  }

  /* Requests that change the file are sent one after another. Returns why the request is rejected: { message, index, findings,
     can_force }, or null. */
  send(path, body = {}) {
    const result = this.last.then(() => this.post(path, body));
    this.last = result.catch(() => {});
    return result;
  }

  async post(path, body) {
    try {
      const answer = await this.fetch('POST', path, { since: this.version, ...body });
      const content = await answer.json();
      if (!answer.ok) return { message: content.error ?? `The server answers with status ${answer.status}.`, index: null };
      if (content.rejected) return content.rejected;
      this.take(content);
      return null;
    } catch {
      this.setProblem('lost');
      return { message: 'The server does not answer. The change was not made.', index: null };
    }
  }

  /* An answer without effect on the state: { error } if there is none. */
  async ask(method, path, body) {
    try {
      const answer = await this.fetch(method, path, body);
      return await answer.json();
    } catch {
      this.setProblem('lost');
      return { error: 'The server does not answer.' };
    }
  }
}
