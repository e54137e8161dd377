/// The page of one run.
import {Chart, distancePlot, methodLook} from './charts.js';
import {columnsOf, metricColumns, ranking} from './columns.js';
import {dataTable} from './tables.js';
import {about, busyWarning, choice, converged, day, count, counted, explained, fold, formula, grouped, h, known, number, rowsOf, seconds, unique} from './text.js';
import {View} from './view.js';

const statusText = status => (status || 'unknown status').replace(/_/g, ' ');

/// "after 39 s" and the like of a method: the sentence that one wants to know, beside the cloth. It is about the last level that has a state.
function sentence(run, row) {
  const method = run.results.methods[row.method], last = method.levels?.filter(level => level.mesh).at(-1), status = last?.status || '', tolerance = run.tolerance(row.method);
  const finished = !['running', 'aborted', 'cancelled', 'failed'].includes(method.status);
  const rest = !last ? null : !converged(status) ? `not at rest: ${statusText(status)}, force residual ${number(last.force_residual)}`
    : status !== 'converged' || !tolerance ? 'at rest to rounding'
    : tolerance < 1 ? `at rest: unbalanced force below ${Number((100 * tolerance).toPrecision(3))} % of the load` : `ended at force residual ${number(last.force_residual)}`;  // 1: no balance is asked for
  const stability = !last?.stability || !converged(status) ? null : last.stability.verdict === 'untested' ? 'stability not tested' : last.stability.verdict;
  const way = !last ? method.status || 'no level is complete' : finished || status === method.status ? null : method.status === 'running' ? 'still running' : `then ${method.status}`;
  const crossing = known(row.intersections) ? counted(row.intersections, 'intersection') : null;
  const preview = known(row.preview_seconds) ? h('span', {}, 'preview after ', h('b', {class: 'preview-time'}, seconds(row.preview_seconds))) : null;
  const end = last ? h('span', {}, finished ? 'end after ' : `level ${last.level} so far, after `, h('b', {}, seconds(row.seconds))) : null;
  const parts = [preview, end, last ? `${count(last.vertices)} vertices` : null, crossing, rest, stability, way].filter(part => part !== null);
  const good = converged(method.status || '') && !(row.intersections > 0);
  return h('li', {class: good ? 'good' : 'poor'}, h('b', {}, row.method), ': ', parts.flatMap((part, k) => k ? [', ', part] : [part]), '.');
}

function troubles(run) {
  const items = run.order.flatMap(name => (run.results.methods[name].levels || []).filter(level => level.message || !converged(level.status || '')).map(level =>
    h('li', {}, h('b', {}, name), `, level ${level.level}: `, converged(level.status || '') ? level.message
      : `${statusText(level.status)} after ${counted(level.iterations ?? 0, 'iteration')} at force residual ${number(level.force_residual)}${level.message ? ': ' + level.message : ''}`)));
  const remarks = [...(run.results.remarks || []), ...run.notes].map(text => h('li', {}, text));
  return items.length + remarks.length ? h('ul', {class: 'remarks', id: 'remarks'}, items, remarks) : null;
}

/// The state on top, and what one wants to know of it.
function hero(run) {
  const picture = run.pictures[0] ? h('img', {class: 'fallback', src: 'data:image/png;base64,' + run.pictures[0].png, alt: run.pictures[0].alt}) : null;
  const facts = h('div', {class: 'facts'}, h('ul', {class: 'sentences'}, run.rows.map(row => sentence(run, row))), busyWarning(run.rows),
    run.results.complete ? null : h('p', {class: 'poor', id: 'incomplete'}, run.results.aborted ? `The run was aborted (${run.results.aborted}).` : 'The run is not complete.',
      ' These are the figures it had written.'), troubles(run));
  if (!run.view) return h('section', {class: 'hero flat', id: 'in-3d'}, h('div', {class: 'viewer'}, picture || h('p', {class: 'absent'}, 'The run has no state to show yet.')), facts);
  for (const method of run.view.methods) {
    let total = 0;  // time since the method's start
    for (const level of run.results.methods[method.name].levels || []) {
      total = level.from_initial_state ? level.seconds : total + level.seconds;
      Object.assign(method.levels.find(each => each.level === level.level)?.states.at(-1) ?? {}, {total});
    }
  }
  const first = run.view.methods.find(method => method.levels.length).name;
  const view = window.drapeViewer = new View(run.view, {first, beside: true, picture});
  return h('section', {class: 'hero', id: 'in-3d'}, view.element, facts, view.controls);
}

/// The pieces of a garment: how the cloth of each is stretched and pressed at the end, and behind that on every level.
function garment(run) {
  const rowsAt = levels => levels.flatMap(([method, level]) => (level.pieces || []).map(row => ({method, level: level.level, ...row})));
  const levels = run.order.flatMap(method => (run.results.methods[method].levels || []).filter(level => level.pieces?.length).map(level => [method, level]));
  if (!levels.length) return null;
  const ends = levels.filter(([method], k) => levels[k + 1]?.[0] !== method), names = Object.keys(rowsAt(ends)[0]);
  const table = (id, what, rows) => dataTable(id, what, columnsOf(names, names.filter(name => !['method', 'level'].includes(name) || unique(rows.map(row => row[name])).length > 1), run.of), rows);
  return h('section', {id: 'garment'}, h('h2', {}, 'The garment, by piece'), table('pieces', 'of pieces', rowsAt(ends)),
    levels.length > ends.length ? fold('On every level', table('pieces-of-levels', 'of pieces on every level', rowsAt(levels))) : null);
}

function previews(run) {
  const shown = run.pictures.filter(picture => picture.fine !== undefined);
  if (!shown.length) return null;
  return h('section', {id: 'previews'}, h('h2', {}, 'Previews on their ends'),
    explained('The end of each method, and as a blue line the outline of its preview, the state of its coarsest level. The closer the line follows the cloth, the ' +
      'more accurate the preview.'),
    h('div', {class: 'pictures'}, shown.map(({method, coarse, fine, png, alt}) => {
      const {levels, consistency = []} = run.results.methods[method], of = l => levels.find(each => each.level === l);
      const off = consistency.find(pair => pair.coarse === coarse && pair.fine === fine)?.distance_rms;
      return h('figure', {}, h('img', {src: 'data:image/png;base64,' + png, alt, loading: 'lazy'}), h('figcaption', {}, h('b', {}, method),
        `: ${count(of(coarse).vertices)} vertices on ${count(of(fine).vertices)}` + (known(off) ? `, off by ${number(100 * off)} % of the diagonal, RMS` : '')));
    })));
}

/// The states on a method's way, with their cost and errors; of a method whose levels do not build on each other, the last level's.
function curves(run, method, cost, y) {
  const begin = run.results.methods[method]?.levels?.filter(level => level.from_initial_state).at(-1)?.level ?? 0;
  const rows = run.errors.filter(row => row.method === method && row.level >= begin);
  return rows.map((row, k) => ({x: row[cost], y: row[y], level: row.level, end: rows[k + 1]?.level !== row.level}));
}

function distances(run) {
  const levels = Object.values(run.results.methods).flatMap(method => method.levels || []), recorded = !levels.length || levels.some(level => level.snapshots);
  const plot = distancePlot('distance', 'How soon a method comes near: each point is a state on the way, the larger ones are ends of levels. Lower and further left is better.', 360,
    {measures: run.measures, rows: run.errors, absent: run.results.measured === false ? 'Not measured yet: drape report of the run’s folder does.' : recorded ? 'errors.csv is missing or empty: a run writes it once all its methods have ended.' : 'No states were recorded in this run (snapshots: 0).'},
    (cost, y) => run.order.map((name, k) => ({label: name, ...methodLook(run.methods, name), width: k ? 1.8 : 2.6, points: curves(run, name, cost, y)})));
  plot.draw();
  const {reference = {}} = run.results;
  return h('section', {id: 'errors-section'}, h('h2', {}, 'Distance against time'), explained('A method’s own interpolation prolongs every state to the finest level, where it is ' +
    'compared with the target. ', reference.file ? `The reference is the file ${reference.file}.` : reference.method ? `The reference is ${reference.method}’s end` +
    (reference.chosen === 'lowest' ? ', the lowest in energy of all that have converged' : '') + (reference.force_tolerance ? `, solved on to a force residual of ${number(reference.force_tolerance)}` : '') + '.'
    : 'This run has no reference.', ' The target’s own line ends at zero, which a logarithmic axis does not show. A line that reaches another equilibrium, with other folds, levels off.'),
  ...plot.elements);
}

function methodTable(run) {
  const measure = ranking(run.measures), few = ['method', 'status', 'preview_seconds', 'seconds', 'cpu_seconds', 'iterations', 'preview_' + measure, 'error_' + measure, 'energy_released'];
  const rows = run.rows.map(row => ({...row, peak_memory_bytes: run.results.methods[row.method].peak_memory_bytes}));
  return h('section', {id: 'summary'}, h('h2', {}, 'Methods'), explained('A row per method: the cost and quality of its end, and of its preview, the state of its coarsest level. Time ' +
    'counts the levels that the end builds on: of a direct method only the finest. Energy released: how far the finest level’s energy, without contact and strain limits, has fallen ' +
    'since the scene’s start. One start cannot tell which method is better: a sweep over starts can. ', Object.values(run.results.metrics || {}).filter(m => m.scope === 'state' && m.text).map(m => m.text + ' ').join('')),
  dataTable('methods', 'of methods', columnsOf([...run.table.columns.filter(name => !['sweep', 'run', 'seed', 'pass'].includes(name)), 'peak_memory_bytes'], few, run.of), rows),
  fold('Every level', levelTable(run)), consistency(run));
}

/// An object's numbers, those of its objects as name.part.
const flat = (object, skipped) => Object.fromEntries(Object.entries(object).flatMap(([key, value]) => skipped.includes(key) ? []
  : value !== null && typeof value === 'object' ? (Array.isArray(value) ? [] : Object.entries(value).map(([part, v]) => [`${key}.${part}`, v])) : [[key, value]]));

function levelTable(run) {
  // Energies that count from the potentials' origin depend on the scene's place.
  const skipped = ['energy', 'energy_parts', 'energy_on_finest', 'mesh', 'mesh_checksum', 'snapshots', 'not_measured'];
  const rows = run.order.flatMap(method => (run.results.methods[method].levels || []).map(level => ({method, ...flat(level, skipped)})));
  const few = ['method', 'level', 'status', 'vertices', 'iterations', 'seconds', 'energy_released', 'force_residual'];
  return dataTable('levels', 'of levels', columnsOf(unique(rows.flatMap(Object.keys)), few, run.of), rows);
}

/// How close coarse levels are to finer ones, with the scene's start in place of the coarse level as a rival.
function consistency(run) {
  const columns = metricColumns(run.results.metrics, 'pair').filter(column => column.shown !== 'stored');
  const pairs = run.order.flatMap(method => (run.results.methods[method].consistency || []).map(pair => ({method, levels: `${pair.coarse} → ${pair.fine}`, ...flat(pair, ['of_start']), of_start: flat(pair.of_start ?? {}, [])})));
  if (!pairs.length || !columns.length) return null;
  const starts = unique(pairs.map(pair => pair.levels)).map(levels => ({levels, method: 'flat start', ...Object.fromEntries(columns.map(({name, better}) => {
    const values = pairs.filter(pair => pair.levels === levels).map(pair => pair.of_start?.[name]).filter(known);
    return [name, values.length ? Math[better === 'higher' ? 'max' : 'min'](...values) : null];
  }))}));
  const shown = ['levels', 'method', ...columns.map(column => column.name)];
  const texts = Object.values(run.results.metrics).filter(m => m.scope === 'pair' && m.text && m.columns.some(c => c.shown !== 'stored')).map(m => formula(m.text + ' '));
  return fold('How close coarse levels are to finer ones', h('p', {}, 'The method’s own interpolation prolongs the coarse state to the fine mesh, where it is compared with the fine one. ', ...texts.flat(),
    'The flat start is the scene’s start in place of the coarse state: where it is best, the measure does not compare the methods.'),
  dataTable('consistency', 'of pairs of levels', columnsOf(shown, shown, run.of), [...pairs, ...starts].sort((a, b) => a.levels.localeCompare(b.levels))));
}

/// Residuals, steps and energies on the way, and the increments of a schedule.
function convergence(run) {
  const series = run.order.flatMap(method => [...grouped(run.iterations.filter(row => row.method === method), row => row.level)].map(([level, rows]) => ({method, level, rows})));
  const finest = Math.max(0, ...series.map(line => line.level)), lowest = {};
  // Energies compare only within one objective: a level's plain energy, or the proxy that a coarse level minimises instead.
  const proxy = (line, row) => known(row.proxy_energy) && line.level !== finest, objective = (line, row) => proxy(line, row) ? row.proxy_energy : row.energy;
  for (const line of series)
    for (const row of line.rows) {
      const key = `${line.level} ${proxy(line, row)}`;
      if (known(objective(line, row))) lowest[key] = Math.min(lowest[key] ?? Infinity, objective(line, row));
    }
  // The decrement is that of the first step size; of a shorter one, ‖p‖ was scaled by the square of their ratio (docs/theory/method.md).
  const step = (line, row) => {
    const first = run.methods[line.method]?.step_size ?? row.step_size;
    return first * row.decrement * Math.min(1, (known(row.step_size) ? row.step_size : first) / first) ** 2;
  };
  const iteration = {title: 'Newton iteration', name: 'row'}, time = {title: 'time [s]', name: 'seconds'}, residual = {title: 'force residual', name: 'force_residual', log: true};
  const plots = {
    residual_seconds: ['force residual over time', time, residual, (line, row) => [row.seconds, row.force_residual]],
    residual_iteration: ['force residual over iterations', iteration, residual, (line, row) => [row.row, row.force_residual]],
    gap: ['energy above the lowest with the same objective, over time', {...time, log: true}, {title: 'energy above the lowest [J]', name: 'gap', log: true},
      (line, row) => [row.seconds, objective(line, row) - lowest[`${line.level} ${proxy(line, row)}`]]],
    step: ['length of Newton steps over iterations', iteration, {title: 'Newton step, RMS [m]', name: 'step', log: true}, (line, row) => [row.row, step(line, row)]]};
  const chart = new Chart('convergence', 'The thinner and paler a line, the coarser its level.');
  const look = line => ({...methodLook(run.methods, line.method), label: `${line.method}, level ${line.level}`, width: 1 + 1.6 * (line.level + 1) / (finest + 1),
    opacity: .5 + .5 * (line.level + 1) / (finest + 1)});
  const draw = kind => {
    const [, x, y, point] = plots[kind], lines = series.map(line => ({...look(line), mark: null, points: line.rows.map(row => { const [a, b] = point(line, row); return {x: a, y: b}; })}));
    const all = lines.flatMap(line => line.points.map(p => p.x)).filter(known);
    for (const tolerance of y === residual && all.length ? unique(run.order.map(run.tolerance)).filter(known) : [])
      lines.push({label: 'tolerance', colour: 'var(--soft)', dash: '5 4', width: 1, points: [Math.min(...all), Math.max(...all)].map(v => ({x: v, y: tolerance}))});
    chart.draw({x, y, series: lines});
  };
  draw('residual_seconds');
  const increments = run.order.flatMap(method => (run.results.methods[method].increments || []).map(row => ({method, ...row})));
  const under = (id, y, title) => {
    const plot = new Chart(id, title + ' of each increment, over pseudo-time: where the lines of levels coincide, the coarse level had the fine one’s response.');
    plot.draw({x: {title: 'pseudo-time', name: 'time'}, y: {title, name: y}, series: series.map(line => ({...look(line),
      points: increments.filter(row => row.method === line.method && (row.level ?? 0) === line.level).map(row => ({x: row.time, y: row[y]}))}))});
    return plot.element;
  };
  const sum = (rows, key) => rows.reduce((all, row) => all + row[key], 0);
  const phases = [...grouped(increments.filter(row => row.phase), row => `${row.method} ${row.level} ${row.phase}`).values()].map(rows =>
    ({phase: rows[0].phase, method: rows[0].method, level: rows[0].level, steps: sum(rows, 'steps'), iterations: sum(rows, 'iterations'), seconds: sum(rows, 'seconds')}));
  return h('section', {id: 'convergence-section'}, h('h2', {}, 'On the way'),
    phases.length ? fold('Phases', dataTable('phases', 'of phases', columnsOf(Object.keys(phases[0]), Object.keys(phases[0]), run.of), phases)) : null,
    increments.length ? fold('Load stepping', increments.some(row => known(row.energy_released)) ? under('increment-energy', 'energy_released', 'energy released [J]') : '', under('increment-steps', 'steps', 'steps')) : null,
    fold('Convergence', h('p', {class: 'controls'}, choice('plot', Object.fromEntries(Object.entries(plots).map(([k, [title]]) => [k, title])), 'residual_seconds', draw, 'convergence-kind')), chart.element),
    fold('Settings: the experiment with all defaults', h('pre', {tabindex: 0}, run.config || 'config.yaml was not stored.')));
}

/// {results, table, measures, methods, errors and iterations as CSV, config, pictures, notes, view}.
export function runPage(data) {
  const {results, table} = data;
  results.methods ||= {};
  const run = {...data, rows: table.rows.filter(row => results.methods[row.method]), errors: rowsOf(data.errors), iterations: rowsOf(data.iterations),
    tolerance: name => data.methods[name]?.tolerance ?? results.tolerance?.force_residual, of: {measures: data.measures, metrics: results.metrics}};
  run.order = run.rows.map(row => row.method);
  return [h('header', {}, h('h1', {}, results.experiment || 'Unnamed experiment'), results.description ? h('p', {class: 'lead'}, results.description) : null),
    run.order.length ? hero(run) : h('p', {class: 'absent'}, 'The run holds no method’s results yet.'),
    ...(run.order.length ? [garment(run), previews(run), distances(run), methodTable(run), convergence(run)] : []), h('footer', {}, about(results), results.ended ? ` · ${day(results.ended)}` : '')];
}
