/// The page of a sweep, or of several runs.
import {Chart, distancePlot, variantLook} from './charts.js';
import {columnsOf, describe, ranking} from './columns.js';
import {dataTable, matcher} from './tables.js';
import {about, busyWarning, choice, converged, count, counted, day, explained, fold, grouped, h, known, rowsOf, spread, tick, unique, words, written} from './text.js';

/// A point of a plot of a spread over repeats.
const point = (x, {median, low, high, count: runs}) => ({x, y: median, low, high, runs});

/// Median and extremes over repeats of a curve of error over cost, a step function, at costs in geometric progression from that
/// at which all have a state to the largest.
function medianCurve(repeats, points = 40) {
  const curves = repeats.map(curve => curve.filter(p => p.x > 0 && p.y > 0)).filter(curve => curve.length);
  if (!curves.length) return [];
  const from = Math.max(...curves.map(curve => curve[0].x)), to = Math.max(...curves.map(curve => curve.at(-1).x));
  const costsOf = from < to ? Array.from({length: points}, (_, k) => k === points - 1 ? to : from * (to / from) ** (k / (points - 1))) : [to];
  return costsOf.map(x => point(x, spread(curves.map(curve => curve.filter(p => p.x <= x).at(-1).y))));
}

/// The thumbnails of a method: a cell has all starts of a variation.
function matrix(all) {
  const chosen = {across: all.keys.reduce((a, b) => all.values(b).length > all.values(a).length && all.values(b).length <= 8 ? b : a), method: all.order[0]};
  const frame = h('div', {id: 'matrix'}), others = () => all.keys.filter(key => key !== chosen.across);
  const tile = runs => {
    const of = run => run.pictures.find(each => each.method === chosen.method), run = runs.find(of) ?? runs[0], picture = of(run);
    const row = all.shownSummary.find(each => each.variation === run.variation && each.method === chosen.method), value = row?.[all.quantity];
    const good = runs.filter(each => each.rows.some(own => own.method === chosen.method && converged(own.status))).length;
    const text = all.keys.map(key => all.keyText(key, run.settings[key])).join(', ');
    const all_of = `${good} of ${counted(runs.length, 'start')} converged`;
    const range = value ? `, ${words(value.low)} … ${words(value.high)} over ${counted(value.count, 'start')}` : '';
    return h(run.report ? 'a' : 'span', {class: 'tile', href: run.report || null, title: `${text}: ${all_of}${range}`},
      picture ? h('img', {src: 'data:image/png;base64,' + picture.png, alt: text}) : h('span', {class: 'blank'}, run.status.replace(/_/g, ' ')),
      h('span', {class: 'value' + (good === runs.length ? '' : ' poor')}, `${good === runs.length ? '' : `✕ ${good} of ${runs.length}: `}${words(value?.median)}`));
  };
  const draw = () => {
    const columns = all.values(chosen.across).filter(value => all.shown.some(run => run.settings[chosen.across] === value));
    const lines = [...new Map(all.shown.map(run => [JSON.stringify(others().map(key => run.settings[key])), run])).values()];
    const line = first => [others().length ? h('p', {class: 'line'}, others().map(key => all.keyText(key, first.settings[key])).join(', ')) : null,
      ...columns.map(value => h('div', {class: 'cell'}, [...grouped(all.shown.filter(run => run.settings[chosen.across] === value &&
        others().every(key => run.settings[key] === first.settings[key])), run => run.variation).values()].map(tile)))];
    const grid = h('div', {class: 'matrix'}, columns.map(value => h('p', {class: 'head'}, all.keyText(chosen.across, value))), lines.map(line).flat());
    grid.style.gridTemplateColumns = `repeat(${columns.length}, minmax(0, 1fr))`;
    grid.style.maxWidth = columns.length * Math.min(260, Math.max(70, (500 / lines.length - 50) * 9 / 7)) + 'px';  // it fits a screen
    frame.replaceChildren(grid);
  };
  all.redraw.push(draw);
  const pick = (label, name, options) => Object.keys(options).length > 1 ? choice(label, options, chosen[name], value => { chosen[name] = value; draw(); }, 'matrix-' + name) : '';
  return h('section', {id: 'runs'}, h('p', {class: 'controls'}, all.chooser, pick('across', 'across', all.keyNames),
    pick('method', 'method', Object.fromEntries(all.order.map(name => [name, name])))), frame);
}

/// A value against a varied key: medians, with ranges over starts. Only numbers are joined by lines.
function against(all) {
  const chosen = {key: all.keys.reduce((a, b) => all.values(b).length > all.values(a).length ? b : a)};
  const chart = new Chart('parameter', 'Medians over the starts that converged and have the value (a reference has no distance from itself), with the range as a line.');
  const draw = () => {
    const values = all.values(chosen.key), numeric = values.every(known), rest = all.keys.filter(key => key !== chosen.key);
    const variant = row => rest.map(key => all.keyText(key, row[key] ?? row.variation)).join(', '), variants = unique(all.shownSummary.map(variant));
    const lines = grouped(all.shownSummary, row => [row.method, variant(row)].filter(part => part).join(', '));
    const wide = numeric && Math.min(...values) > 0 && Math.max(...values) > 20 * Math.min(...values);
    chart.draw({x: {title: all.keyTitle(chosen.key), name: chosen.key, log: wide, categories: numeric ? null : values}, y: {title: describe(all.quantity, all.of).text, name: all.quantity},
      absent: 'No run has this value.', series: [...lines].map(([label, rows]) => ({label, ...variantLook(all.methods, rows[0].method, variants.indexOf(variant(rows[0])), variants.length),
        points: rows.filter(row => row[all.quantity]).map(row => point((chosen.key === 'run' ? row.variation : row[chosen.key]) ?? null, row[all.quantity]))}))});
  };
  all.redraw.push(draw);
  return h('section', {id: 'against'}, h('h2', {}, 'A value against a parameter'), h('p', {class: 'controls'}, choice('against', all.keyNames, chosen.key,
    value => { chosen.key = value; draw(); }, 'parameter-key')), chart.element);
}

function errors(all) {
  const recorded = all.runs.filter(run => run.errors.length), variations = unique(recorded.map(run => run.variation));
  if (!recorded.length) return null;
  const line = (variation, method, cost, y) => medianCurve(recorded.filter(run => run.variation === variation && run.shown.some(row => row.method === method)).map(run =>
    run.errors.filter(row => row.method === method && row.level >= (run.first_levels[method] ?? 0)).map(row => ({x: row[cost], y: row[y]}))));
  const plot = distancePlot('errors', 'Medians over the starts, with a band from the lowest to the highest. Lower and further left is better.', 420,
    {measures: all.measures, rows: recorded.flatMap(run => run.errors)}, (cost, y) => variations.flatMap((variation, v) => all.order.map(method => ({
      label: variations.length > 1 ? `${variation}, ${method}` : method, ...variantLook(all.methods, method, v, variations.length),
      mark: null, band: true, points: line(variation, method, cost, y)}))));
  all.redraw.push(plot.draw);
  return fold('Distance against time', ...plot.elements);
}

function table(all) {
  const measure = ranking(all.measures), keys = all.keys.filter(key => key !== 'run'), state = {medians: all.seeds.length > 1, table: {}};
  const names = all.columns.filter(name => name !== 'pass' && (name !== 'sweep' || keys.includes(name))), frame = h('div');
  const few = ['run', ...keys, 'seed', 'method', 'status', 'converged', 'machine', 'preview_seconds', 'seconds', 'cpu_seconds', 'iterations',
    'preview_' + measure, 'error_' + measure, 'energy_released', 'intersections', 'force_residual'];
  if (keys.length) few.shift();  // the keys tell the runs apart
  const machines = unique(all.rows.map(row => row.machine ?? null));
  if (machines.length < 2) few.splice(few.indexOf('machine'), 1);  // the page says above whether it was busy
  const draw = () => {
    const columns = columnsOf(state.medians ? [...names.slice(0, names.indexOf('method') + 1), 'converged', ...names.slice(names.indexOf('method') + 1)] : names, few, all.of);
    columns.filter(column => keys.includes(column.name)).forEach(column => Object.assign(column,
      {title: all.keyTitle(column.name), text: all.keyTitle(column.name), show: cell => written(cell)}));
    frame.replaceChildren(dataTable('table', 'of runs', columns, state.medians ? all.shownSummary.map(row => ({...row, run: row.variation})) : all.shownRows, state.table));
  };
  all.redraw.push(draw);
  return h('section', {id: 'summary'}, h('h2', {}, 'All runs'), all.seeds.length > 1 ? h('p', {class: 'note', id: 'bold'}, all.table.bold) : null, references(all),
    explained('A row per method and variation: the median over all starts that converged, with the range; n where it is not all of them, as where a method is itself the reference; or a row per ' +
    'method and run. A start is a seed of the noise. The preview is the end of the coarsest level; more energy released is a lower end. Distances are in diagonals of the cloth’s rest shape. Time ' +
    `counts the levels that the end builds on. Times and energies compare only between runs that share ${all.model_keys.join(', ')}.`),
    all.seeds.length > 1 ? h('p', {class: 'controls'}, tick('medians over starts', true, on => { Object.assign(state, {medians: on, table: {}}); draw(); }, 'medians')) : null, frame);
}

function references(all) {
  const own = unique(all.runs.map(run => run.reference?.method).filter(name => name)).map(name =>
    `${name} in ${all.runs.filter(run => run.reference?.method === name).length} of ${counted(all.runs.length, 'run')}`);
  const lowest = all.runs.some(run => run.reference?.chosen === 'lowest') ? ', of each run the one of lowest energy' : '';
  return own.length ? h('p', {class: 'note', id: 'references'}, `The reference is the end of ${own.join(', ')}${lowest}.`) : null;
}

function failures(all) {
  const failed = all.runs.filter(run => run.error || !['converged', 'not_converged'].includes(run.status));
  return failed.length ? fold(`${counted(failed.length, 'run')} without results`, h('ul', {class: 'remarks', id: 'failures'}, failed.map(run => h('li', {}, h('b', {}, run.variation),
    known(run.seed) ? `, seed ${run.seed}` : '', `: ${run.status.replace(/_/g, ' ')}`, run.error ? h('pre', {tabindex: 0}, run.error) : '')))) : null;
}

/// {name, complete, table, measures, metrics, model_keys, methods, runs}: a run has `count` rows of the table, in order.
export function sweepPage(data) {
  const {columns, rows} = data.table, varied = columns.slice(2, columns.indexOf('seed'));
  let at = 0;
  const runs = data.runs.map(run => {
    const own = rows.slice(at, at += run.count).map(row => ({...row, run: run.variation}));
    return {...run, errors: rowsOf(run.errors), rows: own.filter(row => row.method), settings: {...own[0], run: run.variation}};
  });
  const values = key => unique(runs.map(run => run.settings[key] ?? null)).sort((a, b) => typeof a === 'number' && typeof b === 'number' ? a - b : 0);
  const keys = ['sweep', ...varied].filter(key => values(key).length > 1), all = {...data, runs, columns, values, rows: runs.flatMap(run => run.rows), redraw: [],
    order: unique(runs.flatMap(run => run.rows.map(row => row.method))), seeds: unique(runs.map(run => run.seed ?? null)), of: data};
  all.keys = keys.length ? keys : ['run'];
  // "bending modulus [Pa]", and of a value "bending modulus 8e7 Pa"; the whole path where two keys end alike.
  const last = key => key.split('.').at(-1), plain = key => (keys.filter(each => last(each) === last(key)).length > 1 ? key : last(key)).replace(/[_.]/g, ' '), units = data.table.units ?? {};
  all.keyTitle = key => plain(key) + (units[key] ? ` [${units[key]}]` : '');
  all.keyText = (key, value) => typeof value === 'string' && ['run', 'sweep', 'experiment'].includes(key) ? value : `${plain(key)} ${written(value, units[key])}`;
  all.keyNames = Object.fromEntries(all.keys.map(key => [key, all.keyTitle(key)]));
  const numeric = columns.filter(name => !varied.includes(name) && name !== 'seed' && all.rows.some(row => typeof row[name] === 'number'));
  all.quantity = [all.rows.some(row => row.machine === 'busy') ? 'cpu_seconds' : 'seconds', numeric[0]].find(name => numeric.includes(name));
  all.chooser = choice('value', Object.fromEntries(numeric.map(name => [name, describe(name, all.of).text])), all.quantity, value => {
    all.quantity = value;
    all.redraw.forEach(draw => draw());
  }, 'quantity');
  const matching = h('output', {id: 'matching'}), filter = text => {
    const fits = matcher(text, columns);
    runs.forEach(run => { run.shown = run.rows.filter(fits); });
    all.shown = runs.filter(run => run.shown.length || !run.rows.length && fits({status: run.status, ...run.settings}));
    all.shownRows = runs.flatMap(run => run.shown);
    const kinds = new Set(all.shownRows.map(row => row.variation + '\n' + row.method));
    all.shownSummary = data.table.summary.filter(row => kinds.has(row.variation + '\n' + row.method));
    matching.textContent = all.shown.length < runs.length ? `${all.shown.length} of ${counted(runs.length, 'run')}` : '';
    all.redraw.forEach(draw => draw());
  };
  const statuses = unique(runs.map(run => run.status)), machines = unique(runs.map(about).filter(text => text)), ended = runs.map(run => run.ended).filter(known);
  const summary = (data.complete ? '' : 'Not all runs are done; these are the figures so far. ') + `${counted(runs.length, 'run')} of ${counted(unique(runs.map(run => run.variation)).length, 'variation')}: ` +
    statuses.map(status => `${count(runs.filter(run => run.status === status).length)} ${status.replace(/_/g, ' ') || 'unknown'}`).join(', ') + '.';
  const parts = all.rows.length ? [matrix(all), against(all), table(all), errors(all)] : [h('p', {class: 'absent'}, 'No run has written results yet.')];
  filter('');
  return [h('header', {}, h('h1', {}, data.name || 'Several runs'), data.description ? h('p', {class: 'lead'}, data.description) : null, h('p', {class: 'lead', id: 'counts'}, summary), busyWarning(all.rows)),
    h('p', {class: 'controls filter'}, h('label', {}, 'Filter ', h('input', {type: 'search', id: 'filter', size: 26, placeholder: 'words, or as in seconds<2', input: event => filter(event.target.value)})), matching),
    ...parts, failures(all),
    h('footer', {}, machines.map(text => h('p', {}, text)), ended.length ? h('p', {}, unique([Math.min(...ended), Math.max(...ended)].map(day)).join(' to ')) : null, machines.length > 1 ? h('p', {class: 'poor'}, 'More than one machine or setting: their times do not compare.') : null)];
}
