/// Tables that sort, with few columns at first, and filters.
import {badge, fold, h, saving, tick, words} from './text.js';

/// The value of a cell: a number, a word, or a spread over repeats.
const value = cell => cell !== null && typeof cell === 'object' ? cell.median : cell;

function content(column, row) {
  const cell = row[column.name], own = column.ofReference && row.reference;  // in how many starts the row was the reference itself
  if (column.show) return column.show(cell);
  if (column.name === 'status' && cell) return badge(cell);
  if (cell === null || typeof cell !== 'object') return own ? 'reference' : words(cell);
  const notes = [words(cell.low) !== words(cell.high) ? `${words(cell.low)}\u00a0… ${words(cell.high)}` : '', cell.count < row.starts ? `n = ${cell.count}` : '',
    own ? `reference in ${own}` : ''].filter(note => note).join(', ');
  return [words(cell.median), notes ? h('span', {class: 'range'}, notes) : ''];
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

/// A column is {name, title (text or nodes), few: whether it is among the first ones, show}; a row's `best` names the columns in
/// which it is bold. The name is the column's in files; `state` keeps order and columns for another table of these columns.
export function dataTable(name, what, columns, rows, state = {}) {
  const filled = columns.filter(column => rows.some(row => row[column.name] !== null && row[column.name] !== undefined && row[column.name] !== ''));
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
      'data-name': column.text ?? column.name}, row.best?.includes(column.name) ? h('strong', {}, content(column, row)) : content(column, row)))))));
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
