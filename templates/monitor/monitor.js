(() => {
  'use strict';
  const maxHistories = 400; /* values with a history; of more, those that are plotted */
  const maxEmcys = 200;
  const maxPlots = 8;
  const byId = (id) => document.getElementById(id);
  const seconds = (us) => us / 1e6;
  const hex = (number, digits) => number.toString(16).toUpperCase().padStart(digits, '0');
  const canId = (cobId) => (cobId & 0x20000000 ? `${hex(cobId & 0x1FFFFFFF, 8)}h` : `${hex(cobId, 3)}h`);

  /* A cell that does not change costs no layout. */
  const setText = (cell, text) => {
    if (cell.textContent !== text) cell.textContent = text;
  };

  const nodes = new KeyedTable(byId('nodes'), ['number', '', '', '', 'number', '']);
  const values = new KeyedTable(byId('value-rows'), ['', 'number', '', 'number', 'mono', '', '']);
  const emcys = new KeyedTable(byId('emcys'), ['number', 'number', '']);
  const others = new KeyedTable(byId('others'), ['mono', 'number', 'number']);
  const state = new Map();      /* the newest row of each node, PDO and CAN-ID, also while paused */
  const series = new Map();     /* by key: a value with its history */
  const plots = new Map();
  let histories = 0;
  let emcyRows = [];
  let bus = null;
  let isPaused = false;
  const changed = new Set();

  /* Values and plots */

  const colors = () => {
    const style = getComputedStyle(document.documentElement);
    return Object.fromEntries(['text', 'line', 'field-line'].map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
  };

  const stepped = typeof uPlot === 'undefined' ? null : uPlot.paths.stepped({ align: 1 });
  const plotWidth = () => Math.max(200, byId('plots').clientWidth - 26);

  /* The width of the ticks, the gap and the longest number, such as those of 64 bits, beside the axis. */
  const axisWidth = (chart, texts, at, cycle) => {
    const axis = chart.axes[at];
    if (cycle > 1) return axis._size;  /* as uPlot's own: widths must not swing */
    chart.ctx.font = axis.font[0];
    const longest = Math.max(0, ...(texts ?? []).map((text) => chart.ctx.measureText(text).width));
    return Math.max(70, Math.ceil(axis.ticks.size + axis.gap + longest / devicePixelRatio));
  };

  const makePlot = (one) => {
    const box = document.createElement('div');
    box.className = 'plot';
    const heading = document.createElement('h3');
    heading.textContent = one.title;
    const small = document.createElement('small');
    heading.append(small);
    const close = document.createElement('button');
    close.type = 'button';
    close.textContent = '\u00D7';
    close.setAttribute('aria-label', `Remove the plot of ${one.title}`);
    close.addEventListener('click', () => setPlotted(one, false));
    box.append(heading, close);
    byId('plots').append(box);
    const color = colors();
    const axis = { stroke: color.text, grid: { stroke: color.line, width: 1 }, ticks: { stroke: color.line, width: 1 } };
    const chart = new uPlot({
      width: plotWidth(), height: 170, cursor: { sync: { key: 'time' } }, scales: { x: { time: false } },
      axes: [{ ...axis, label: undefined, values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, { ...axis, size: axisWidth }],
      series: [{}, { stroke: color['field-line'], width: 1.5, paths: stepped, points: { size: 4 } }],
    }, one.history.data, box);
    const canvas = chart.root;
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', `Plot of ${one.title} over time`);
    return { box, chart, small };
  };

  const setPlotted = (one, isPlotted) => {
    if (isPlotted === plots.has(one.key)) return;
    if (isPlotted && plots.size >= maxPlots) setPlotted(plots.values().next().value.one, false);
    if (isPlotted) {
      keep(one);
      const plot = { one, ...makePlot(one) };
      plots.set(one.key, plot);
      drawPlot(plot);
    } else {
      const plot = plots.get(one.key);
      plot.chart.destroy();
      plot.box.remove();
      plots.delete(one.key);
    }
    if (one.box) one.box.checked = isPlotted;
    byId('plots-hint').hidden = plots.size > 0;
  };

  const keep = (one) => {
    if (one.history) return;
    one.history = new ValueHistory();
    ++histories;
  };

  const drawPlot = ({ one, chart, small }) => {
    chart.setData(one.history.data);
    setText(small, one.text);
  };

  const drawPlots = () => plots.forEach(drawPlot);

  const remakePlots = () => {
    for (const { one } of [...plots.values()]) {
      setPlotted(one, false);
      setPlotted(one, true);
    }
  };

  const valueOf = (pdo, value, position) => {
    const key = `${pdo.node_id} ${pdo.pdo} ${position}`;
    let one = series.get(key);
    const object = `${hex(value.index, 4)}h:${hex(value.sub_index, 2)}`;
    if (one && one.object === object) return one;
    if (one) dropValue(one);  /* the PDO was mapped anew */
    one = { key, object, node: pdo.node_id, pdo: pdo.pdo, name: value.name, unit: value.unit, position,
      title: `node ${pdo.node_id} ${value.name || object}${value.unit ? ` in ${value.unit}` : ''}`, text: '',
      isNumber: false, history: null };
    series.set(key, one);
    return one;
  };

  const dropValue = (one) => {
    if (plots.has(one.key)) setPlotted(one, false);
    values.remove(one.key);
    series.delete(one.key);
    if (one.history) --histories;
  };

  /* The values that earlier frames of a PDO had and its last one does not have, such as one that is too short. */
  const notReceived = 'not in the last frame';
  const missing = (pdo) => {
    const found = [];
    for (let position = pdo.values.length; series.has(`${pdo.node_id} ${pdo.pdo} ${position}`); ++position) {
      found.push(series.get(`${pdo.node_id} ${pdo.pdo} ${position}`));
    }
    return found;
  };

  const record = (pdo) => {
    pdo.values.forEach((value, position) => {
      const one = valueOf(pdo, value, position);
      one.text = value.text;
      if (value.number === null) return;
      one.isNumber = true;
      if (histories < maxHistories) keep(one);
      one.history?.add(seconds(pdo.at_us), value.number);
    });
    for (const one of missing(pdo)) one.text = notReceived;
  };

  const showFound = () => {
    const rows = [...values.rows.values()];
    const count = rows.filter((row) => !row.element.hidden).length;
    setText(byId('found'), byId('filter').value.trim() ? `${count} of ${rows.length} values` : '');
  };
  const fits = (row) => row.element.textContent.toLowerCase().includes(byId('filter').value.trim().toLowerCase());

  const pdoNumber = (name) => Number(name.slice(5)) + (name.startsWith('T') ? 0 : 1000);
  const showPdo = (pdo) => {
    const order = pdo.node_id * 1e6 + pdoNumber(pdo.pdo) * 100;
    const count = Math.max(1, pdo.values.length + missing(pdo).length);
    for (let position = 0; position < count; ++position) {
      const key = `${pdo.node_id} ${pdo.pdo} ${position}`;
      const one = series.get(key);
      const isNew = !values.rows.has(key);
      const row = values.row(key, order + position);
      const [plot, node, name, rate, object, label, text] = row.cells;
      if (one?.isNumber && stepped && !plot.firstChild) {
        one.box = document.createElement('input');
        one.box.type = 'checkbox';
        one.box.setAttribute('aria-label', `Plot ${one.title}`);
        one.box.addEventListener('change', () => setPlotted(one, one.box.checked));
        plot.append(one.box);
      }
      setText(node, String(pdo.node_id));
      setText(name, pdo.pdo);
      setText(rate, pdo.per_second.toFixed(1));
      setText(object, one ? one.object : '');
      setText(label, one ? one.name : '');
      setText(text, one ? one.text : pdo.text);
      if (isNew) row.element.hidden = !fits(row);
    }
  };

  /* Nodes, EMCYs, other CAN-IDs */

  const heard = (node) => {
    if (node.heard_us === null || !bus) return '-';
    return `${Math.max(0, seconds(bus.at_us - node.heard_us)).toFixed(1)} s ago${node.late ? ', late' : ''}`;
  };

  const showNode = (node) => {
    const { element, cells } = nodes.row(node.node_id, node.node_id);
    setText(cells[0], String(node.node_id));
    setText(cells[1], (node.name || '-') + (node.simulated ? ' (simulated)' : ''));
    setText(cells[2], node.assumed_state ? `${node.assumed_state}?` : node.state || '-');
    setText(cells[3], heard(node));
    setText(cells[4], String(node.emergencies));
    setText(cells[5], node.emergency || '-');
    element.classList.toggle('bad', node.late || node.error_code !== 0);
  };

  const showEmcys = () => {
    for (const [key, row] of emcys.rows) if (row.order > -emcyRows[0].number) emcys.remove(key);
    for (const emcy of emcyRows) {
      if (emcys.rows.has(emcy.number)) continue;
      const { cells } = emcys.row(emcy.number, -emcy.number);
      setText(cells[0], `${seconds(emcy.at_us).toFixed(3)} s`);
      setText(cells[1], String(emcy.node_id));
      setText(cells[2], emcy.text);
    }
  };

  const showOther = (other) => {
    const { cells } = others.row(other.cob_id, other.cob_id);
    setText(cells[0], canId(other.cob_id));
    setText(cells[1], other.per_second.toFixed(1));
    setText(cells[2], String(other.frames));
  };

  const showBus = () => {
    const load = bus.load_percent === null ? '' : `, load ${bus.load_percent.toFixed(1)} %`;
    setText(byId('summary'), `${seconds(bus.at_us).toFixed(1)} s, ${bus.frames} frames, ${bus.per_second.toFixed(1)} per s${load}`);
  };

  const show = { node: showNode, pdo: showPdo, other: showOther };
  const draw = () => {
    if (isPaused || !bus) return;
    showBus();
    for (const key of changed) {
      const row = state.get(key);
      show[row.kind](row);
    }
    changed.clear();
    showFound();
    for (const row of state.values()) if (row.kind === 'node') showNode(row);
    if (emcyRows.length) showEmcys();
    drawPlots();
  };

  /* Once a frame, however many events have come: a tab in the background, or on a busy computer, records and does not draw. */
  let isDue = false;
  const drawSoon = () => {
    if (isDue) return;
    isDue = true;
    requestAnimationFrame(() => {
      isDue = false;
      draw();
    });
  };

  /* The events of the server */

  const keyOf = { node: (row) => `node ${row.node_id}`, pdo: (row) => `pdo ${row.node_id} ${row.pdo}`,
    other: (row) => `other ${row.cob_id}` };
  const take = (row) => {
    if (row.kind === 'bus') {
      bus = row;
    } else if (row.kind === 'emcy') {
      if (!emcyRows.length || row.number > emcyRows.at(-1).number) emcyRows.push(row);
      emcyRows = emcyRows.slice(-maxEmcys);
    } else {
      const key = keyOf[row.kind](row);
      const before = state.get(key);
      state.set(key, row);
      changed.add(key);
      /* A row also comes if only its rate has changed, and after a new connection. */
      if (row.kind === 'pdo' && row.at_us !== before?.at_us) record(row);
    }
  };

  const connection = byId('connection');
  const showConnection = (isThere, text) => {
    setText(connection, text);
    connection.classList.toggle('bad', !isThere);
  };

  /* The time of the bus comes ten times a second: without it, the connection is lost, even if nothing else says so. */
  const mostSilenceMs = 3000;
  let silence = 0;
  const showSilence = () => showConnection(false, 'no answer from edsc monitor, the values are old');

  const receive = (event) => {
    const { rows } = JSON.parse(event.data);
    /* The EMCYs come by their keys, which are texts. */
    rows.sort((a, b) => (a.kind === 'emcy' && b.kind === 'emcy' ? a.number - b.number : 0));
    rows.forEach(take);
    drawSoon();
    showConnection(true, 'connected');
    clearTimeout(silence);
    silence = setTimeout(showSilence, mostSilenceMs);
  };

  const connect = () => {
    const events = new EventSource(`events${location.search}`);
    events.addEventListener('message', receive);
    events.addEventListener('error', () => {
      clearTimeout(silence);
      showConnection(false,
        'not connected, the values are old: edsc monitor has ended, or too many pages are open. A new run has a new URL.');
      /* The browser tries again if the server is lost, but not if it refuses. */
      if (events.readyState === EventSource.CLOSED) setTimeout(connect, 5000);
    });
  };
  connect();

  /* Buttons and keys */

  const pause = byId('pause');
  const togglePause = () => {
    isPaused = !isPaused;
    pause.setAttribute('aria-pressed', String(isPaused));
    pause.textContent = isPaused ? 'Go on' : 'Pause';
    draw();
  };
  pause.addEventListener('click', togglePause);

  /* A text that a spreadsheet would evaluate as a formula gets an apostrophe; numbers such as -5 are none, also with a unit. */
  const number = /^[+-]?\d+(\.\d+)?(e[+-]?\d+)?( [^=+\-@|!()&;"']*)?$/i;
  const plain = (text) => (/^[=+\-@\t\r\n]/.test(text) && !number.test(text) ? `'${text}` : text);
  const quoted = (text) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  /* RFC 4180: records end with CR LF; a field with a comma, a quotation mark or a line end is in quotation marks. */
  const field = (text) => quoted(plain(text));
  const csv = () => {
    const chosen = plots.size ? [...plots.values()].map((plot) => plot.one) : [...series.values()];
    const lines = ['time,node,pdo,object,name,value,unit'];
    for (const one of chosen) {
      if (!one.history) continue;
      const [times, numbers] = one.history.data;
      const rest = [one.node, one.pdo, one.object, one.name].map((text) => field(String(text))).join(',');
      times.forEach((time, at) => lines.push(`${time.toFixed(6)},${rest},${numbers[at]},${field(one.unit)}`));
    }
    return `${lines.join('\r\n')}\r\n`;
  };
  const save = () => {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([csv()], { type: 'text/csv' }));
    link.download = 'monitor.csv';
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  };
  byId('export').addEventListener('click', save);
  byId('clear').addEventListener('click', () => {
    for (const { one } of [...plots.values()]) setPlotted(one, false);
  });
  byId('filter').addEventListener('input', () => {
    for (const row of values.rows.values()) row.element.hidden = !fits(row);
    showFound();
  });
  if (!stepped) setText(byId('plots-hint'), 'This edsc was built without uPlot (npm): no plots.');

  document.addEventListener('keydown', (event) => {
    if (event.repeat || event.ctrlKey || event.altKey || event.metaKey || event.target.type === 'search') return;
    if (event.key === 'p') togglePause();
    if (event.key === 'e') save();
    if (event.key === '/') {
      byId('filter').focus();
      event.preventDefault();
    }
  });
  for (const query of ['(prefers-color-scheme: dark)', 'print']) matchMedia(query).addEventListener('change', remakePlots);
  addEventListener('resize', () => {
    for (const { chart } of plots.values()) chart.setSize({ width: plotWidth(), height: 170 });
  });
})();
