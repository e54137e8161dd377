/// The page of a sweep, or of several runs.
import {Chart, distancePlot, methodLook, otherLook} from './charts.js';
import {columnsOf, describe, ranking} from './columns.js';
import {dataTable, matcher} from './tables.js';
import {about, choice, converged, count, counted, explained, fold, grouped, h, known, rowsOf, spread, tick, unique, words} from './text.js';

/// Median and extremes over repeats of a curve of error over cost, a step function, at costs in geometric progression from that
/// at which all have a state to the largest.
function medianCurve(repeats, points = 40) {
  const curves = repeats.map(curve => curve.filter(p => p.x > 0 && p.y > 0)).filter(curve => curve.length);
  if (!curves.length) return [];
  const from = Math.max(...curves.map(curve => curve[0].x)), to = Math.max(...curves.map(curve => curve.at(-1).x));
  const costsOf = from < to ? Array.from({length: points}, (_, k) => k === points - 1 ? to : from * (to / from) ** (k / (points - 1))) : [to];
  return costsOf.map(x => {
    const {median, low, high, count: runs} = spread(curves.map(curve => curve.filter(p => p.x <= x).at(-1).y));
    return {x, y: median, low, high, runs};
  });
}

const keyText = (key, value) => `${key.split('.').at(-1)} ${value ?? '–'}`;

function matrix(all) {
  const chosen = {across: all.keys.reduce((a, b) => all.values(b).length > all.values(a).length && all.values(b).length <= 8 ? b : a), method: all.methods[0]};
  const frame = h('div', {id: 'matrix'}), others = () => all.keys.filter(key => key !== chosen.across);
  const tile = (run, row) => {
    const picture = run.pictures.find(each => each.method === chosen.method), good = row && converged(row.status);
    const text = all.keys.map(key => keyText(key, run.settings[key])).join(', ') + (known(run.seed) ? `, seed ${run.seed}` : '');
    const content = [picture ? h('img', {src: 'data:image/png;base64,' + picture.png, alt: text}) : h('span', {class: 'blank'}, run.status.replace(/_/g, ' ')),
      h('span', {class: 'value' + (good ? '' : ' poor')}, row ? `${good ? '' : '✕ '}${words(row[all.quantity])}` : '–')];
    return h(run.report ? 'a' : 'span', {class: 'tile', href: run.report || null, title: `${text}: ${row ? row.status : run.status}`}, content);
  };
  const draw = () => {
    const columns = all.values(chosen.across).flatMap(value => all.seeds.map(seed => ({value, seed}))).filter(({value, seed}) =>
      all.shown.some(run => run.settings[chosen.across] === value && (run.seed ?? null) === seed));
    const lines = [...new Map(all.shown.map(run => [JSON.stringify(others().map(key => run.settings[key])), run])).values()];
    const line = first => [others().length ? h('p', {class: 'line'}, others().map(key => keyText(key, first.settings[key])).join(', ')) : null,
      ...columns.map(({value, seed}) => {
        const runs = all.shown.filter(run => run.settings[chosen.across] === value && (run.seed ?? null) === seed && others().every(key => run.settings[key] === first.settings[key]));
        return h('div', {class: 'cell'}, runs.map(run => tile(run, run.rows.find(row => row.method === chosen.method))));
      })];
    const grid = h('div', {class: 'matrix'}, columns.map(({value, seed}) => h('p', {class: 'head'}, keyText(chosen.across, value), all.seeds.length > 1 ? h('span', {}, ` · ${seed ?? '–'}`) : '')), lines.map(line).flat());
    grid.style.gridTemplateColumns = `repeat(${columns.length}, minmax(0, 1fr))`;
    grid.style.maxWidth = Math.max(360, columns.length * Math.min(260, Math.max(70, (560 / lines.length - 40) * 9 / 7))) + 'px';  // 24 runs fit a screen
    frame.replaceChildren(grid);
  };
  all.redraw.push(draw);
  const pick = (label, name, options) => Object.keys(options).length > 1 ? choice(label, options, chosen[name], value => { chosen[name] = value; draw(); }, 'matrix-' + name) : '';
  return h('section', {id: 'runs'}, h('p', {class: 'controls'}, all.chooser,
    pick('across', 'across', Object.fromEntries(all.keys.map(key => [key, key]))), pick('method', 'method', Object.fromEntries(all.methods.map(name => [name, name])))), frame);
}

/// A value against a varied key: medians, with ranges over seeds.
function against(all) {
  const chosen = {key: all.keys.reduce((a, b) => all.values(b).length > all.values(a).length ? b : a), log: false};
  const chart = new Chart('parameter', 'Medians over the starts that converged, with the range as a line.');
  const draw = () => {
    const values = all.values(chosen.key), numeric = values.every(known), rest = all.keys.filter(key => key !== chosen.key);
    const lines = grouped(all.shownRows, row => [row.method, ...rest.map(key => keyText(key, row[key]))].join(', '));
    const plain = unique([...lines.values()].map(rows => rows[0].method)).length === lines.size, wide = numeric && Math.min(...values) > 0 && Math.max(...values) > 20 * Math.min(...values);
    chart.draw({x: {title: chosen.key, name: chosen.key, log: wide, categories: numeric ? null : values}, y: {title: describe(all.quantity, all.of).text, name: all.quantity},
      absent: 'No run has this value.', series: [...lines].map(([label, rows], k) => ({label, ...(plain ? methodLook(all.styles, rows[0].method) : otherLook(k)),
        points: values.flatMap(x => {
          const s = spread(rows.filter(row => row[chosen.key] === x && converged(row.status)).map(row => row[all.quantity]));
          return s ? [{x, y: s.median, low: s.low, high: s.high, runs: s.count}] : [];
        })}))});
  };
  all.redraw.push(draw);
  return h('section', {id: 'against'}, h('h2', {}, 'A value against a parameter'), h('p', {class: 'controls'}, choice('against', Object.fromEntries(all.keys.map(key => [key, key])), chosen.key,
    value => { chosen.key = value; draw(); }, 'parameter-key')), chart.element);
}

function errors(all) {
  const recorded = all.runs.filter(run => run.errors.length), variations = unique(recorded.map(run => run.variation));
  if (!recorded.length) return null;
  const line = (variation, method, cost, y) => medianCurve(recorded.filter(run => run.variation === variation && run.shown.some(row => row.method === method)).map(run =>
    run.errors.filter(row => row.method === method && row.level >= (run.first_levels[method] ?? 0)).map(row => ({x: row[cost], y: row[y]}))));
  const plot = distancePlot('errors', 'Medians over the starts, with a band from the lowest to the highest. Lower and further left is better.', 420,
    {measures: all.measures, rows: recorded.flatMap(run => run.errors)}, (cost, y) => variations.flatMap((variation, v) => all.methods.map((method, m) => ({
      ...(variations.length > 1 ? {label: `${variation}, ${method}`, ...otherLook(v * all.methods.length + m)} : {label: method, ...methodLook(all.styles, method)}),
      mark: null, band: true, points: line(variation, method, cost, y)}))));
  all.redraw.push(plot.draw);
  return fold('Distance against time', ...plot.elements);
}

function table(all) {
  const measure = ranking(all.measures), keys = all.keys.filter(key => key !== 'run'), state = {medians: all.seeds.length > 1, table: {}};
  const names = all.columns.filter(name => name !== 'pass' && (name !== 'sweep' || keys.includes(name))), frame = h('div');
  const few = ['run', ...keys, 'seed', 'method', 'status', 'converged', 'preview_seconds', 'seconds', 'preview_' + measure, 'error_' + measure, 'energy_released', 'intersections'];
  if (keys.length) few.shift();  // the keys tell the runs apart
  const medians = () => [...grouped(all.shownRows, row => JSON.stringify([row.variation, row.method])).values()].map(rows => {
    const good = rows.filter(row => converged(row.status)), common = name => keys.includes(name) || ['run', 'method'].includes(name);
    return {physics: rows[0].physics, comparable: good.length > 0, converged: `${good.length} of ${rows.length}`, ...Object.fromEntries(names.filter(name => name !== 'seed' && name !== 'status').map(name =>
      [name, common(name) ? rows[0][name] : rows.some(row => typeof row[name] === 'number') ? spread(good.map(row => row[name])) : null]))};
  });
  const draw = () => {
    const rows = state.medians ? medians() : all.shownRows.map(row => ({...row, comparable: converged(row.status)}));
    const columns = columnsOf(state.medians ? [...names.slice(0, names.indexOf('method') + 1), 'converged', ...names.slice(names.indexOf('method') + 1)] : names, few, all.of);
    columns.filter(column => keys.includes(column.name)).forEach(column => Object.assign(column, {title: column.name.split('.').at(-1), text: column.name.split('.').at(-1), show: cell => String(cell ?? '–')}));
    frame.replaceChildren(dataTable('table', 'of runs', columns, rows, row => row.physics, state.table));
  };
  all.redraw.push(draw);
  const own = unique(all.runs.filter(run => run.rows.length).map(run => run.reference).filter(name => name)).map(name =>
    `${name} in ${all.runs.filter(run => run.reference === name).length} of ${all.runs.filter(run => run.rows.some(row => row.method === name)).length}`);
  return h('section', {id: 'summary'}, h('h2', {}, 'All runs'), explained('A row per method and variation: the median over the starts that converged, with the range; or a row per method and run. ' +
    'Time counts the levels that the end builds on. The best value is bold among rows of the same physics: times and energies of different physics do not compare. Its keys in the ' +
    `experiment are ${all.model_keys.join(', ')}; the start’s noise is not part of it.`, own.length ? ` Ends that were the reference themselves are not compared with it: ${own.join(', ')}.` : ''),
  all.seeds.length > 1 ? h('p', {class: 'controls'}, tick('medians over starts', true, on => { Object.assign(state, {medians: on, table: {}}); draw(); }, 'medians')) : null, frame);
}

function failures(all) {
  const failed = all.runs.filter(run => run.error || !['converged', 'not_converged'].includes(run.status));
  return failed.length ? fold(`${counted(failed.length, 'run')} without results`, h('ul', {class: 'remarks', id: 'failures'}, failed.map(run => h('li', {}, h('b', {}, run.variation),
    known(run.seed) ? `, seed ${run.seed}` : '', `: ${run.status.replace(/_/g, ' ')}`, run.error ? h('pre', {tabindex: 0}, run.error) : '')))) : null;
}

/// {name, complete, table, measures, metrics, model_keys, styles, runs}: a run has `count` rows of the table, in order.
export function sweepPage(data) {
  const {columns, rows} = data.table, varied = columns.slice(2, columns.indexOf('seed'));
  let at = 0;
  const runs = data.runs.map(run => {
    const own = rows.slice(at, at += run.count).map(row => ({...row, run: run.variation, variation: run.variation, physics: run.physics}));
    return {...run, errors: rowsOf(run.errors), rows: own.filter(row => row.method), settings: {...own[0], run: run.variation}};
  });
  const values = key => unique(runs.map(run => run.settings[key] ?? null)).sort((a, b) => typeof a === 'number' && typeof b === 'number' ? a - b : 0);
  const keys = ['sweep', ...varied].filter(key => values(key).length > 1), all = {...data, runs, columns, values, rows: runs.flatMap(run => run.rows), redraw: [],
    methods: unique(runs.flatMap(run => run.rows.map(row => row.method))), seeds: unique(runs.map(run => run.seed ?? null)), of: data};
  all.keys = keys.length ? keys : ['run'];
  const numeric = columns.filter(name => !varied.includes(name) && name !== 'seed' && all.rows.some(row => typeof row[name] === 'number'));
  all.quantity = numeric.includes('seconds') ? 'seconds' : numeric[0];
  all.chooser = choice('value', Object.fromEntries(numeric.map(name => [name, describe(name, all.of).text])), all.quantity, value => {
    all.quantity = value;
    all.redraw.forEach(draw => draw());
  }, 'quantity');
  const matching = h('output', {id: 'matching'}), filter = text => {
    const fits = matcher(text, columns);
    runs.forEach(run => { run.shown = run.rows.filter(fits); });
    all.shown = runs.filter(run => run.shown.length || !run.rows.length && fits({status: run.status, ...run.settings}));
    all.shownRows = runs.flatMap(run => run.shown);
    matching.textContent = all.shown.length < runs.length ? `${all.shown.length} of ${counted(runs.length, 'run')}` : '';
    all.redraw.forEach(draw => draw());
  };
  const statuses = unique(runs.map(run => run.status)), machines = unique(runs.map(about).filter(text => text));
  const summary = (data.complete ? '' : 'Not all runs are done; these are the figures so far. ') + `${counted(runs.length, 'run')} of ${counted(unique(runs.map(run => run.variation)).length, 'variation')}: ` +
    statuses.map(status => `${count(runs.filter(run => run.status === status).length)} ${status.replace(/_/g, ' ') || 'unknown'}`).join(', ') + '.';
  const parts = all.rows.length ? [matrix(all), against(all), table(all), errors(all)] : [h('p', {class: 'absent'}, 'No run has written results yet.')];
  filter('');
  return [h('header', {}, h('h1', {}, data.name || 'Several runs'), h('p', {class: 'lead', id: 'counts'}, summary)),
    h('p', {class: 'controls filter'}, h('label', {}, 'Filter ', h('input', {type: 'search', id: 'filter', size: 22, placeholder: 'words, or as in seconds<2', input: event => filter(event.target.value)})), matching),
    ...parts, failures(all),
    h('footer', {}, machines.map(text => h('p', {}, text)), machines.length > 1 ? h('p', {class: 'poor'}, 'More than one machine or setting: their times do not compare.') : null)];
}
