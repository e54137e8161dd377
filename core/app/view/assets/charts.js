'use strict';
// Shared by the pages of one run and of several runs: colours, axes, plots that follow the theme, and export of
// plots and tables.
const drape = (() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const charts = new Map();
  const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const short = value => Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3)
    ? value.toExponential(2).replace('e+', 'e') : String(Number(value.toPrecision(3)));
  const superscript = n => String(n).replace(/./g, c => c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]);

  // Measures (those that the run's metrics declare), targets and costs of errors, by their names in errors.csv.
  const measures = Object.fromEntries(data.measures.map(measure => [measure.name, measure.label]));
  const targets = {reference: 'the reference', own: 'the method’s own finest state'};
  const costKinds = {seconds: 'time [s]', iterations: 'Newton iterations', flops: 'flops of factorisations'};

  /// `name` is the column's in exported data.
  function axis(title, logarithmic, name = title) {
    const options = {
      name,
      type: logarithmic ? 'logarithmic' : 'linear',
      title: {display: true, text: title, color: colour('--soft')},
      grid: {color: colour('--line'), borderColor: colour('--line')},
      ticks: {color: colour('--soft'), maxRotation: 0},
    };
    if (logarithmic) {
      options.ticks.autoSkip = false;
      options.ticks.callback = value => {
        const power = Math.log10(value);
        if (Math.abs(power - Math.round(power)) > 1e-6) return '';
        return Math.round(power) >= -2 && Math.round(power) <= 3 ? String(Number(value.toPrecision(1)))
          : '10' + superscript(Math.round(power));
      };
      options.grid.color = context => {
        const power = context.tick ? Math.log10(context.tick.value) : 0;
        return Math.abs(power - Math.round(power)) < 1e-6 ? colour('--line') : 'transparent';
      };
    }
    return options;
  }

  /// Entries of a legend, at most so many: the last one then counts those that it leaves out. Chart.js has no
  /// dashes in its legend.
  const lineLabels = most => chart => {
    const items = Chart.defaults.plugins.legend.labels.generateLabels(chart)
      .filter(item => item.text && item.text !== 'tolerance')
      .map(item => Object.assign(item, {lineDash: chart.data.datasets[item.datasetIndex].borderDash}));
    if (items.length <= most) return items;
    const rest = {text: (items.length - most + 1) + ' more', datasetIndex: undefined, strokeStyle: 'transparent',
      fillStyle: 'transparent'};
    return [...items.slice(0, most - 1), Object.assign({}, items[most - 1], rest)];
  };

  /// Hides or shows a line; the entry that counts the rest has none.
  function toggleLine(event, item, legend) {
    if (item.datasetIndex !== undefined) Chart.defaults.plugins.legend.onClick.call(legend, event, item, legend);
  }

  function save(name, type, text) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([text], {type}));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  const quoted = cell => cell === null || cell === undefined ? ''
    : /[",\n]/.test(cell) ? '"' + String(cell).replace(/"/g, '""') + '"' : String(cell);
  const csv = rows => rows.map(row => row.map(quoted).join(',') + '\n').join('');
  /// Rows, the first of which are names, as a list of objects.
  const records = rows => JSON.stringify(rows.slice(1).map(row =>
    Object.fromEntries(rows[0].map((name, k) => [name, row[k] === undefined ? null : row[k]]))), null, 1);

  /// Two export buttons below `element`; `rows` is called when one is pressed.
  function offer(element, name, what, rows) {
    const note = document.createElement('p');
    note.className = 'data';
    note.append('data: ');
    for (const [kind, type, text] of [['CSV', 'text/csv', csv], ['JSON', 'application/json', records]]) {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = kind;
      button.setAttribute('aria-label', kind + ' of ' + what);
      button.addEventListener('click', () => save(name + '.' + kind.toLowerCase(), type, text(rows())));
      note.append(button, ' ');
    }
    element.append(note);
  }

  /// The data of a plot: one row per point of its lines, or per bar.
  function rowsOf(chart) {
    const sets = chart.data.datasets.filter(set => set.label);
    if (chart.config.type === 'bar') {
      const ranged = sets.filter(set => set.ranges);
      return [['name', ...sets.map(set => set.label), ...ranged.flatMap(() => ['lowest', 'highest'])],
        ...chart.data.labels.map((label, k) => [label, ...sets.map(set => set.data[k]),
          ...ranged.flatMap(set => set.ranges[k] || [null, null])])];
    }
    const {x, y} = chart.options.scales, extra = [...new Set(sets.flatMap(set =>
      set.data.flatMap(point => Object.keys(point).filter(key => key !== 'x' && key !== 'y'))))];
    return [['series', x.name, y.name, ...extra],
      ...sets.flatMap(set => set.data.map(p => [set.label, p.x, p.y, ...extra.map(key => p[key])]))];
  }

  /// Draws a plot, or redraws it; `count` is the number of its points, `most` that of its legend's entries.
  function show(id, config, count, most = Infinity) {
    const canvas = document.getElementById(id);
    if (!canvas) return;
    const figure = canvas.closest('figure'), first = !charts.has(id);
    if (!first && charts.get(id)) charts.get(id).destroy();
    let note = figure.querySelector('p.absent');
    if (!note) {
      note = document.createElement('p');
      note.className = 'absent';
      note.textContent = 'Nothing was recorded for this plot.';
      figure.append(note);
    }
    note.hidden = count > 0;
    canvas.parentElement.hidden = !count;
    charts.set(id, null);
    if (!count) return;
    config.options.animation = false;
    config.options.responsive = true;
    config.options.maintainAspectRatio = false;
    config.options.plugins = Object.assign({
      legend: {position: 'bottom', onClick: toggleLine, labels: {color: colour('--ink'), usePointStyle: true,
        pointStyle: 'line', boxWidth: 34, font: {size: 11}, generateLabels: lineLabels(most)}},
    }, config.options.plugins);
    charts.set(id, new Chart(canvas, config));
    if (!figure.querySelector('p.data'))
      offer(figure, id, canvas.getAttribute('aria-label'), () => rowsOf(charts.get(id)));
  }

  /// A method's look, the same on every page: colour and mark are its solver's, dashes tell methods of one solver
  /// and lines that coincide apart.
  const marks = ['circle', 'rect', 'triangle', 'rectRot'], dashes = [[], [9, 5], [2, 3], [12, 4, 2, 4]];
  function methodStyle(name) {
    const {style} = data.methods.find(method => method.name === name) || {style: marks.length - 1};
    const same = data.methods.filter(method => method.style === style).findIndex(method => method.name === name);
    return {borderColor: colour('--solver-' + style), backgroundColor: colour('--solver-' + style),
      borderDash: dashes[(style + Math.max(same, 0)) % dashes.length], pointStyle: marks[style]};
  }

  const tooltip = {callbacks: {label: item => item.dataset.label + ': ' + short(item.parsed.x) + ', ' +
    short(item.parsed.y)}};

  /// Choices above a plot, by the name of its select element; calls `draw` when one changes. Opens on the first
  /// target that has data.
  function choices(id, draw, hasData) {
    const select = name => document.getElementById(id + '-' + name);
    for (const [name, words] of [['measure', measures], ['target', targets], ['cost', costKinds]]) {
      if (!select(name)) continue;
      for (const [value, text] of Object.entries(words)) select(name).add(new Option(text, value));
      select(name).addEventListener('change', draw);
    }
    select('target').value = Object.keys(targets).find(hasData) || Object.keys(targets)[0];
    return () => Object.fromEntries(['measure', 'target', 'cost'].map(name => [name, select(name).value]));
  }

  /// Calls `draw` now and whenever the theme changes; paper is light.
  function follow(draw) {
    const theme = document.documentElement.dataset;
    Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
    draw();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
    addEventListener('beforeprint', () => { theme.theme = 'light'; draw(); });
    addEventListener('afterprint', () => { delete theme.theme; draw(); });
  }

  /// A cell's text for export: d_H_fit, no dashes for absent values, no spaces within numbers.
  function wordsOf(cell) {
    const copy = cell.cloneNode(true);
    copy.querySelectorAll('sub, sup').forEach(part => part.replaceWith('_' + part.textContent));
    return copy.textContent.trim().replace(/^–$/, '').replace(/\u202f/g, '');
  }

  /// The cells by row and column; one that spans several stands in each. Of every column the name that is shown,
  /// and the one that tables have of it elsewhere.
  function gridOf(table) {
    const grid = [];
    [...table.rows].forEach((row, r) => {
      grid[r] = grid[r] || [];
      for (const cell of row.cells) {
        let c = 0;
        while (grid[r][c] !== undefined) ++c;
        for (let i = 0; i < cell.rowSpan; ++i)
          for (let j = 0; j < cell.colSpan; ++j) (grid[r + i] = grid[r + i] || [])[c + j] = cell;
      }
    });
    const heads = table.tHead ? table.tHead.rows.length : 1, body = grid.slice(heads);
    const names = grid[0].map((_, c) =>
      [...new Set(grid.slice(0, heads).map(row => wordsOf(row[c])))].join(' ').trim());
    return {names, columns: names.map((name, c) => grid[0][c].dataset.column || name), body};
  }

  /// Names and values. A column of medians gives three: median, lowest and highest.
  function cellsOf(table) {
    const {names, columns, body} = gridOf(table);
    const spreadOf = cell => cell && cell.querySelector('[data-spread]');
    const ranged = names.map((_, c) => body.some(row => spreadOf(row[c])));
    const values = (cell, c) => {
      const range = spreadOf(cell), words = cell && wordsOf(cell);
      return range ? range.dataset.spread.split(' ') : ranged[c] ? [words, '', ''] : [words];
    };
    return [columns.flatMap((name, c) => ranged[c] ? [name, name + '_lowest', name + '_highest'] : [name]),
      ...body.map(row => names.flatMap((_, c) => values(row[c], c)))];
  }

  /// No table is wider than the page: its columns move together or, if that is not enough, every row becomes a block
  /// of values below their names.
  function fitTables() {
    for (const frame of document.querySelectorAll('.scroll')) {
      frame.classList.remove('compact', 'stacked');
      for (const name of ['compact', 'stacked'])
        if (frame.scrollWidth > frame.clientWidth) frame.classList.add(name);
    }
  }

  document.querySelectorAll('.scroll').forEach((frame, k) => {
    const title = frame.closest('section').querySelector('h2').textContent;
    frame.tabIndex = 0;  // scrolls by the arrow keys
    frame.setAttribute('role', 'region');
    frame.setAttribute('aria-label', 'table: ' + title);
    const below = document.createElement('div');
    frame.after(below);
    const table = frame.querySelector('table'), {names, body} = gridOf(table);
    for (const row of body)
      row.forEach((cell, c) => { cell.dataset.name = names[c]; });
    offer(below, 'table-' + (k + 1), 'the table: ' + title, () => cellsOf(table));
  });
  fitTables();
  addEventListener('resize', fitTables);
  document.addEventListener('toggle', fitTables, true);  // a closed part of the page has no width

  return {data, colour, short, axis, methodStyle, show, choices, follow, tooltip, measures, targets, costKinds};
})();
