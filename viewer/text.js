/// What every part of the page uses: elements, numbers as words, statistics, tables of values as files.

/// The element with attributes and children. Children are nodes or texts, which are never read as HTML; attributes that are
/// functions listen.
export function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(name, value);
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat().filter(child => child !== null && child !== undefined && child !== ''));
  return element;
}
export const h = (tag, attributes = {}, ...children) => filled(document.createElement(tag), attributes, children);

/// Writes a text that is read aloud when it changes: only then.
export const say = (element, text) => { if (element.textContent !== text) element.textContent = text; };

/// Nodes of a text with subscripts and superscripts: of "d_H^fit", H stands below and fit above the line.
export function formula(text) {
  return text.split(/(?<=[A-Za-z0-9])([_^][A-Za-z0-9]+)/).map((part, k) =>
    k % 2 ? h(part[0] === '_' ? 'sub' : 'sup', {}, part.slice(1)) : part);
}

/// Three significant digits ("403", "0.0213", "7.21e4"), or a dash.
export function number(value) {
  if (value === null || value === undefined || !isFinite(value)) return '–';
  if (value === 0) return '0';
  const [digits, power] = value.toExponential(2).split('e').map(Number), places = Math.max(0, 2 - power);
  return power < -3 || power > 3 ? digits.toFixed(2) + 'e' + power : Number(value.toPrecision(3)).toFixed(places);
}
export const count = value => value === null || value === undefined ? '–' : Math.round(value).toLocaleString('en').replace(/,/g, '\u202f');
/// "3.8 s", for reading.
export const seconds = value => value === null || value === undefined ? '–'
  : (value < 1 ? Number(value.toPrecision(1)) : value < 10 ? value.toFixed(1) : count(value)) + ' s';
/// A number, whole or not, or a word.
export const words = value => value === null || value === undefined || value === '' ? '–' : typeof value === 'string' ? value
  : typeof value === 'boolean' ? (value ? 'yes' : 'no') : Number.isInteger(value) && Math.abs(value) < 1e7 ? count(value) : number(value);

/// A method whose levels ended differently has the word of each: "converged, max_steps_reached".
export const converged = status => status.split(', ').every(word => word.startsWith('converged'));
/// A status with a dot in the colour of its kind.
export const badge = status => h('span', {class: 'status ' + (converged(status) ? 'good' : 'poor')}, status.replace(/_/g, ' '));
/// "1 run" or "3 runs".
export const counted = (n, thing) => `${count(n)} ${thing}${n === 1 ? '' : 's'}`;

export const known = value => typeof value === 'number' && isFinite(value);
export const unique = values => [...new Set(values)];
/// Lists of the values with the same key, in order of appearance.
export const grouped = (values, key) => values.reduce((all, value) => all.set(key(value), [...(all.get(key(value)) || []), value]), new Map());
export const fold = (title, ...content) => h('details', {}, h('summary', {}, title), ...content);
/// The prose of a section, behind a click.
export const explained = (...text) => fold('What is this?', h('p', {}, ...text));

/// Median and extremes of the known values; null without any.
export function spread(values) {
  const v = values.filter(known).sort((a, b) => a - b), n = v.length;
  return n ? {median: (v[(n - 1) >> 1] + v[n >> 1]) / 2, low: v[0], high: v[n - 1], count: n} : null;
}

/// A number with as many digits as it was written with, and its unit: "8e7 Pa".
export const written = (value, unit) => (typeof value !== 'number' ? String(value ?? '–') : value === 0 || Math.abs(value) >= 1e-3 && Math.abs(value) < 1e5 ? String(value)
  : value.toExponential().replace('+', '')) + (unit ? ' ' + unit : '');

/// A warning where the system had other work while methods were timed.
export function busyWarning(rows) {
  const busy = rows.filter(row => row.machine === 'busy').length;
  return busy ? h('p', {class: 'poor', id: 'busy'}, `The machine was busy during ${busy} of ${counted(rows.length, 'timing')}: compare CPU time, or iterations of one method, not wall time.`) : null;
}

/// "2026-03-01" of seconds since 1970.
export const day = seconds => new Date(1000 * seconds).toISOString().slice(0, 10);
/// The program and the machine of a run, as results.json has them.
export const about = ({version, commit, machine}) =>
  [version, commit?.slice(0, 10), machine?.cpu, machine?.cores && counted(machine.cores, 'core'), machine?.threads && counted(machine.threads, 'thread')].filter(part => part).join(' · ');

/// The rows of a file of the run as objects.
export const rowsOf = ({names, rows}) => rows.map(row => Object.fromEntries(names.map((name, k) => [name, row[k]])));

const quoted = cell => cell === null || cell === undefined ? '' : /[",\n]/.test(cell) ? '"' + String(cell).replace(/"/g, '""') + '"' : String(cell);
function toCsv(rows) {  // the names of all rows: where a spread is missing, so are two of its three values
  const names = unique(rows.flatMap(row => Object.keys(row)));
  return [names, ...rows.map(row => names.map(name => row[name]))].map(row => row.map(quoted).join(',') + '\n').join('');
}

export function save(name, content) {
  const link = h('a', {href: URL.createObjectURL(content), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/// Buttons that save a plot or a table; `rows` are objects of its values, `more` further kinds of files.
export function saving(name, what, rows, more = {}) {
  const kinds = {...more, CSV: () => new Blob([toCsv(rows())], {type: 'text/csv'}),
    JSON: () => new Blob([JSON.stringify(rows(), null, 1)], {type: 'application/json'})};
  return h('p', {class: 'saving'}, Object.entries(kinds).map(([kind, content]) => h('button', {type: 'button',
    'aria-label': `${kind} of ${what}`, click: () => save(`${name}.${kind.toLowerCase()}`, content())}, kind)));
}

/// A labelled list of choices, {value: text}; `change` is called with the chosen value.
export function choice(label, options, value, change, id) {
  const select = h('select', {id, change: () => change(select.value)}, Object.entries(options).map(([v, text]) => h('option', {value: v}, text)));
  select.value = value;
  return h('label', {}, label + ' ', select);
}

/// A box to tick with its label; `change` is called with whether it is ticked.
export function tick(label, on, change, id = null) {
  return h('label', {}, h('input', {type: 'checkbox', id, checked: on, change: event => change(event.target.checked)}), ' ' + label);
}
