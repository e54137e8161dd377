/// Tables that sort, with few columns at first, and filters.
import {badge, fold, grouped, h, number, saving, tick, words} from './text.js';

/// The value of a cell: a number, a word, or a spread over repeats.
const value = cell => cell !== null && typeof cell === 'object' ? cell.median : cell;

function content(column, cell) {
  if (column.show) return column.show(cell);
  if (column.name === 'status' && cell) return badge(cell);
  if (cell !== null && typeof cell === 'object')
    return [number(cell.median), number(cell.low) !== number(cell.high) ? h('span', {class: 'range'}, `${number(cell.low)} … ${number(cell.high)}`) : ''];
  return words(cell);
}

/// Whether a row satisfies every word of a filter: "seconds<2" and the like of a column, by its name or the last part of it; other
/// words are regular expressions, one of which some cell matches.
export function matcher(filter, names) {
  const operators = {'<': (a, b) => a < b, '<=': (a, b) => a <= b, '>': (a, b) => a > b, '>=': (a, b) => a >= b, '=': (a, b) => a === b, '!=': (a, b) => a !== b};
  const tests = filter.split(/\s+/).filter(word => word).map(word => {
    const [, key, operator, text] = /^([\w.]+)(<=|>=|!=|<|>|=)(.+)$/.exec(word) || [], name = names.find(each => each === key) ?? names.find(each => each.split('.').at(-1) === key);
    if (name) return row => {
      const cell = row[name] ?? null;
      if (cell === null) return operator === '!=';
      return typeof cell === 'number' ? operators[operator](cell, Number(text)) : operators[operator](String(cell), text);
    };
    let pattern;
    try { pattern = new RegExp(word, 'i'); } catch { pattern = {test: cell => cell.includes(word)}; }  // not finished yet
    return row => names.some(each => pattern.test(String(row[each] ?? '')));
  });
  return row => tests.every(test => test(row));
}

/// A row's values for a file; a spread has three.
const plain = (row, columns) => Object.fromEntries(columns.flatMap(({name}) => {
  const cell = row[name];
  return cell !== null && typeof cell === 'object'
    ? [[name, cell.median], [name + '_lowest', cell.low], [name + '_highest', cell.high]] : [[name, cell ?? null]];
}));

/// A column is {name, title (text or nodes), few: whether it is among the first ones, better: 'lower' or 'higher', show};
/// `rivals` gives the key of the rows among which the best value is bold; a row that only equals one with `yardstick`, such as
/// the flat start, is not. The name is the column's in files; `state` keeps order and columns for another table of these columns.
export function dataTable(name, what, columns, rows, rivals = () => '', state = {}) {
  const filled = columns.filter(column => rows.some(row => row[column.name] !== null && row[column.name] !== undefined && row[column.name] !== ''));
  const best = new Map();
  for (const column of filled) {
    if (!column.better) continue;
    for (const group of grouped(rows, rivals).values()) {
      const known = group.filter(row => typeof value(row[column.name]) === 'number' && row.comparable !== false);
      const text = row => words(value(row[column.name]));
      if (new Set(known.map(text)).size < 2) continue;  // equal as shown
      // Where lower is better, what is nearer to zero is: a difference of energies may be negative.
      const rank = row => column.better === 'higher' ? -value(row[column.name]) : Math.abs(value(row[column.name])), first = known.reduce((a, b) => rank(b) < rank(a) ? b : a);
      const tied = known.filter(row => text(row) === text(first)), yardsticks = tied.filter(row => row.yardstick);
      (yardsticks.length ? yardsticks : tied).forEach(row => best.set(row, (best.get(row) || new Set()).add(column.name)));
    }
  }
  const chosen = state.chosen ??= new Set(filled.filter(column => column.few).map(column => column.name));
  const table = h('table'), frame = h('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'table: ' + what}, table);
  const shownRows = () => {
    if (!state.sort) return rows;
    const key = row => value(row[state.sort]) ?? '', order = (a, b) => typeof a === 'number' && typeof b === 'number' ? a - b
      : typeof a === 'number' ? -1 : typeof b === 'number' ? 1 : String(a).localeCompare(String(b), 'en', {numeric: true});
    return [...rows].sort((a, b) => (state.down ? -1 : 1) * order(key(a), key(b)));
  };
  const draw = () => {
    const shown = filled.filter(column => chosen.has(column.name)), number = column => rows.some(row => typeof value(row[column.name]) === 'number');
    table.replaceChildren(h('thead', {}, h('tr', {}, shown.map(column => h('th', {scope: 'col', class: number(column) ? '' : 'text', 'data-column': column.name,
      'aria-sort': state.sort !== column.name ? 'none' : state.down ? 'descending' : 'ascending'},
    h('button', {type: 'button', click: () => {
      state.down = state.sort === column.name && !state.down;
      state.sort = column.name;
      draw();
      table.querySelector(`[data-column="${CSS.escape(column.name)}"] button`).focus();
    }}, column.title ?? column.name))))),
    h('tbody', {}, shownRows().map(row => h('tr', {}, shown.map((column, k) => h(k ? 'td' : 'th', {scope: k ? null : 'row', class: number(column) ? '' : 'text',
      'data-name': column.text ?? column.name}, best.get(row)?.has(column.name) ? h('strong', {}, content(column, row[column.name])) : content(column, row[column.name])))))));
  };
  draw();
  const ticks = filled.map(column => tick(column.text ?? column.name, chosen.has(column.name), on => {
    chosen[on ? 'add' : 'delete'](column.name);
    draw();
  }));
  const all = h('button', {type: 'button', click: () => ticks.forEach(({firstChild: box}) => { if (!box.checked) box.click(); })}, 'All');
  return h('div', {class: 'table', id: name}, filled.some(column => !column.few) ? fold('Columns', h('p', {class: 'controls'}, all, ticks)) : '', frame,
    saving(name, 'the table ' + what, () => shownRows().map(row => plain(row, filled))));
}
