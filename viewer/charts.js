/// Plots as SVG: lines with marks, bands and ranges on linear or logarithmic axes.
import {costs, ranking, targets} from './columns.js';
import {choice, filled, h, known, number, saving, unique} from './text.js';

const space = 'http://www.w3.org/2000/svg';
const s = (tag, attributes = {}, ...children) => filled(document.createElementNS(space, tag), attributes, children);

/// The look of a method, the same on every page and in Python: colour and mark are its solver's, dashes tell methods of one
/// solver apart. `methods` has the `style` of each, an index that is its solver's.
const marks = ['circle', 'square', 'triangle', 'diamond'], dashes = ['', '9 5', '2 3', '12 4 2 4'];
export function methodLook(methods, method) {
  const style = methods[method]?.style ?? 3, alike = Object.keys(methods).filter(name => methods[name].style === style);
  return {colour: `var(--solver-${style})`, mark: marks[style], dash: dashes[Math.max(alike.indexOf(method), 0) % dashes.length]};
}
/// The same for the k-th of `count` variations: paler, with other dashes.
export const variantLook = (methods, method, k, count) => count < 2 ? methodLook(methods, method) : {...methodLook(methods, method), dash: dashes[k % dashes.length], opacity: 1 - .65 * k / count};

function markPath(mark, x, y, r) {
  if (mark === 'square') return `M${x - r} ${y - r}h${2 * r}v${2 * r}h${-2 * r}z`;
  if (mark === 'triangle') return `M${x} ${y - 1.2 * r}l${1.2 * r} ${2.1 * r}h${-2.4 * r}z`;
  if (mark === 'diamond') return `M${x} ${y - 1.4 * r}l${1.4 * r} ${1.4 * r}l${-1.4 * r} ${1.4 * r}l${-1.4 * r} ${-1.4 * r}z`;
  return `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
}

/// Round values from one to the other, at least `least` apart, as [value, text]; a text has the digits that tell neighbours apart.
function roundTicks(from, to, least) {
  const unit = 10 ** Math.floor(Math.log10(least)), step = [1, 2, 5, 10].map(m => m * unit).find(u => u >= least), ticks = [];
  const digits = Math.max(6, 2 + Math.floor(Math.log10(Math.max(Math.abs(from), Math.abs(to)))) - Math.floor(Math.log10(step)));
  for (let k = Math.ceil(from / step); k * step <= to; ++k) {
    const t = Number((k * step).toPrecision(digits)), plain = t === 0 || Math.abs(t) >= 1e-3 && Math.abs(t) < 1e6;
    ticks.push([k * step, plain ? String(t) : t.toExponential().replace('+', '')]);
  }
  return ticks;
}

/// {place: value → 0 … 1, ticks: [value, text]}.
function scale(values, logarithmic, categories, most) {
  if (categories) return {place: v => (categories.indexOf(v) + .5) / categories.length, ticks: categories.map(c => [c, String(c ?? '–')])};
  let low = Math.min(...values), high = Math.max(...values);
  if (logarithmic) {
    [low, high] = [Math.log10(low), Math.log10(high)];
    const margin = Math.max(.04 * (high - low), .02);
    [low, high] = [low - margin, high + margin];
    const every = Math.max(1, Math.ceil((high - low) / most)), ticks = [];
    for (let p = Math.floor(low); p <= high; ++p)
      for (const m of high - low < 2 ? [1, 2, 5] : [1]) {
        const t = p + Math.log10(m);
        if (t >= low && t <= high && p % every === 0) ticks.push([m * 10 ** p, Math.abs(p) < 3 ? String(Number((m * 10 ** p).toPrecision(2))) : m + 'e' + p]);
      }
    const [from, to] = [10 ** low, 10 ** high];
    return {place: v => (Math.log10(v) - low) / (high - low), ticks: ticks.length < 2 && high - low < 2 ? roundTicks(from, to, (to - from) / most) : ticks};
  }
  if (low > 0 && low < .5 * high) low = 0;
  const size = Math.max(Math.abs(low), Math.abs(high));
  if (high - low <= 1e-9 * size) [low, high] = [low - Math.max(.5, 1e-3 * size), high + Math.max(.5, 1e-3 * size)];
  const margin = .03 * (high - low), from = low === 0 ? 0 : low - margin, to = high + margin;
  return {place: v => (v - from) / (to - from), ticks: roundTicks(from, to, (high - low) / most)};
}

/// Choices and a plot of errors over costs, as rows of errors.csv have them; series(cost, error) are the lines of two columns.
/// `absent` says why there are no rows.
export function distancePlot(name, caption, height, {measures, rows, absent}, series) {
  const chosen = {measure: ranking(measures), cost: 'seconds'}, chart = new Chart(name, caption, height);
  chosen.target = Object.keys(targets).find(t => rows.some(row => known(row[`${t}_${chosen.measure}`]))) || 'own';
  const draw = () => {
    const y = `${chosen.target}_${chosen.measure}`, {cost} = chosen;
    const compared = rows.filter(row => known(row[y]));
    const why = !rows.length ? absent : !compared.length ? `No state was compared with ${targets[chosen.target]}.`
      : !compared.some(row => known(row[cost])) ? `No state that was compared has its ${costs[cost]}.` : 'No value is above zero, and the axes are logarithmic.';
    chart.draw({x: {title: costs[cost], name: cost, log: true}, y: {title: measures.find(m => m.name === chosen.measure)?.label, name: y, log: true}, absent: why, series: series(cost, y)});
  };
  const pick = (label, part, options) => choice(label, options, chosen[part], value => { chosen[part] = value; draw(); }, `${name}-${part}`);
  return {draw, elements: [h('p', {class: 'controls'}, pick('of', 'measure', Object.fromEntries(measures.map(m => [m.name, m.label]))), pick('from', 'target', targets),
    pick('over', 'cost', costs)), chart.element]};
}

/// A plot that follows its width: draw({x, y, series}) shows other lines. An axis is {title, name, log, categories}; a series
/// {label, colour, mark, dash, width, opacity, points: [{x, y, low, high, end, …}], band}. Points that an axis cannot show are left out.
export class Chart {
  constructor(name, caption, height = 360) {
    Object.assign(this, {name, caption, height, hidden: new Set(), width: 0});
    this.box = h('div', {class: 'plot'});
    this.element = h('figure', {class: 'chart', id: name}, h('figcaption', {}, caption), this.box,
      saving(name, 'the plot ' + name, () => this.rows(), {SVG: () => new Blob([this.text()], {type: 'image/svg+xml'})}));
    new ResizeObserver(() => { if (this.box.clientWidth !== this.width) this.render(); }).observe(this.box);
  }

  draw(plot) {
    const fits = (axis, v) => axis.categories ? true : known(v) && (!axis.log || v > 0);
    const series = plot.series.map(line => ({...line, points: line.points.filter(p => fits(plot.x, p.x) && fits(plot.y, p.y))}));
    this.plot = {...plot, series: series.filter(line => line.points.length)};
    this.render();
  }

  rows() {
    const {x, y, series} = this.plot;
    return series.flatMap(line => line.points.map(({x: a, y: b, end, ...more}) => ({series: line.label, [x.name]: a, [y.name]: b, ...more})));
  }

  /// The plot as a file: colours are those on paper.
  text() {
    const root = document.documentElement;
    root.dataset.theme = 'light';
    const light = getComputedStyle(root), copy = this.box.firstChild.cloneNode(true);
    copy.querySelectorAll('.hint').forEach(hint => hint.remove());
    const text = new XMLSerializer().serializeToString(copy).replace(/var\((--[\w-]+)\)/g, (_, v) => light.getPropertyValue(v).trim());
    delete root.dataset.theme;
    return text;
  }

  render() {
    this.width = this.box.clientWidth;
    if (!this.plot || !this.width) return;
    const {x, y, series} = this.plot;
    this.element.querySelector('.saving').hidden = !series.length;
    if (!series.length) return this.box.replaceChildren(h('p', {class: 'absent'}, this.plot.absent || 'Nothing was recorded for this plot.'));
    const shown = series.filter(line => !this.hidden.has(line.label)), of = shown.length ? shown : series;
    const points = of.flatMap(line => line.points), ends = p => [p.y, p.low, p.high].filter(v => known(v) && (!y.log || v > 0));
    const sy = scale(points.flatMap(ends), y.log, null, 6);
    const left = Math.max(62, 22 + 6.6 * Math.max(0, ...sy.ticks.map(([, label]) => label.length)));  // room for the longest text
    const W = this.width, right = W - 14, top = 10, legend = this.legend(series, left, right);
    const longest = 6.6 * Math.max(0, ...(x.categories ?? []).map(c => String(c ?? '–').length));  // [px]
    const tilted = longest > (right - left) / (x.categories?.length ?? 1) ? Math.min(.7 * longest, 110) : 0;  // height of names that do not fit beside each other
    const H = Math.max(this.height, legend.height + tilted + 240), bottom = H - 46 - tilted - legend.height;
    const sx = scale(points.map(p => p.x), x.log, x.categories, Math.max(2, Math.floor((right - left) / (x.log ? 45 : 80))));
    const px = v => left + sx.place(v) * (right - left), py = v => bottom - sy.place(v) * (bottom - top), r2 = v => Math.round(100 * v) / 100;
    const svg = s('svg', {xmlns: space, width: W, height: H, viewBox: `0 0 ${W} ${H}`, role: 'group', 'font-family': 'system-ui, "DejaVu Sans", sans-serif',
      'font-size': 12, 'aria-label': `${y.title} against ${x.title}: ${series.map(line => line.label).join(', ')}`});
    const grid = s('g', {class: 'grid', stroke: 'var(--line)', fill: 'var(--soft)'});
    const text = (at, value, anchor = 'middle', more = {}) => grid.append(s('text', {x: at[0], y: at[1], 'text-anchor': anchor, stroke: 'none', ...more}, value));
    for (const [value, label] of sx.ticks) {
      if (!x.categories) grid.append(s('line', {x1: r2(px(value)), x2: r2(px(value)), y1: top, y2: bottom}));
      if (tilted) text([0, 0], label, 'end', {transform: `translate(${r2(px(value))} ${bottom + 14}) rotate(-40)`});
      else text([r2(px(value)), bottom + 16], label);
    }
    for (const [value, label] of sy.ticks) {
      grid.append(s('line', {x1: left, x2: right, y1: r2(py(value)), y2: r2(py(value))}));
      text([left - 6, r2(py(value)) + 4], label, 'end');
    }
    text([(left + right) / 2, bottom + 33 + tilted], x.title);
    text([0, 0], y.title, 'middle', {transform: `translate(13 ${(top + bottom) / 2}) rotate(-90)`});
    svg.append(grid);
    // Marks of a category stand beside each other, and no line joins categories.
    const slot = x.categories ? Math.min(16, .7 * (right - left) / x.categories.length / shown.length) : 0, at = (p, k) => [px(p.x) + slot * (k - (shown.length - 1) / 2), py(p.y)];
    shown.forEach((line, k) => svg.append(this.line({...line, joined: !x.categories}, k, p => at(p, k).map(r2), v => r2(py(v)))));
    svg.append(legend.group(bottom + 55 + tilted));
    const hint = s('g', {class: 'hint', 'pointer-events': 'none'});
    svg.append(hint);
    svg.addEventListener('pointermove', event => this.hint(hint, event, shown, at, W));
    svg.addEventListener('pointerleave', () => hint.replaceChildren());
    const focused = this.box.contains(document.activeElement) ? document.activeElement.textContent : null;  // a line's name in the legend
    this.box.replaceChildren(svg);
    if (focused !== null) [...svg.querySelectorAll('.legend > g')].find(item => item.textContent === focused)?.focus({preventScroll: true});
  }

  line({label, colour, mark, dash = '', width = 2, opacity = 1, points, band, joined}, k, at, py) {
    const several = points.length > 1;
    return s('g', {class: `series series-${k}`, fill: 'none', stroke: colour, 'stroke-width': width, opacity},
      s('title', {}, label),
      band && several ? s('path', {class: 'band', d: `M${points.map(p => `${at(p)[0]} ${py(p.high)}`).join('L')}L${
        [...points].reverse().map(p => `${at(p)[0]} ${py(p.low)}`).join('L')}z`, fill: colour, 'fill-opacity': .15, stroke: 'none'}) : '',
      joined && several ? s('path', {class: 'line', d: 'M' + points.map(p => at(p).join(' ')).join('L'), 'stroke-dasharray': dash}) : '',
      points.flatMap(p => [
        !band && known(p.low) && p.low < p.high ? s('path', {class: 'range', d: `M${at(p)[0]} ${py(p.low)}V${py(p.high)}`, 'stroke-width': 1.2}) : '',
        mark ? s('path', {class: 'mark', d: markPath(mark, ...at(p), p.end === undefined ? 3 : p.end ? 4.5 : 2), fill: colour, stroke: 'none'}) : '']));
  }

  /// Names in rows below the plot; a click, Enter or Space hides or shows a line.
  legend(series, left, right) {
    let x = left, row = 0;
    const items = unique(series.map(line => line.label)).map(label => {
      const line = series.find(one => one.label === label), width = 46 + 7.6 * label.length;
      if (x > left && x + width > right) x = left, ++row;
      const item = {label, line, x, row};
      x += width;
      return item;
    });
    const group = top => s('g', {class: 'legend', fill: 'var(--ink)'}, ...items.map(({label, line, x: at, row: r}) => {
      const y = top + 18 * r, off = this.hidden.has(label), click = () => { this.hidden[off ? 'delete' : 'add'](label); this.render(); };
      const keydown = event => {
        if (event.key !== 'Enter' && event.key !== ' ') return;
        event.preventDefault();
        click();
      };
      return s('g', {role: 'button', tabindex: 0, 'aria-pressed': String(!off), opacity: off ? .4 : 1, click, keydown},
        s('rect', {x: at, y: y - 11, width: 38 + 7.6 * label.length, height: 17, fill: 'transparent'}),
        s('path', {d: `M${at} ${y - 3}h28`, stroke: line.colour, 'stroke-width': line.width ?? 2, 'stroke-opacity': line.opacity ?? 1, 'stroke-dasharray': line.dash || ''}),
        line.mark ? s('path', {d: markPath(line.mark, at + 14, y - 3, 3.5), fill: line.colour}) : '',
        s('text', {x: at + 34, y: y + 1}, label));
    }));
    return {height: 18 * (row + 1), group};
  }

  /// The values of the point that is nearest to the pointer.
  hint(group, event, shown, at, W) {
    const box = group.ownerSVGElement.getBoundingClientRect(), x = event.clientX - box.left, y = event.clientY - box.top;
    let best = null, least = 40;
    for (const [k, line] of shown.entries())
      for (const p of line.points) {
        const [a, b] = at(p, k), distance = Math.hypot(a - x, b - y);
        if (distance < least) [best, least] = [{line, p, a, b}, distance];
      }
    group.replaceChildren();
    if (!best) return;
    const value = v => typeof v === 'number' ? number(v) : v, {p, a, b} = best;
    const range = known(p.low) && p.low < p.high ? ` (${value(p.low)} … ${value(p.high)})` : '';
    const text = `${best.line.label}${p.level === undefined ? '' : ', level ' + p.level}: ${value(p.x)}, ${value(p.y)}${range}`, wide = 7 * text.length + 12;
    const left = Math.min(Math.max(a - wide / 2, 2), Math.max(W - wide - 2, 2)), above = b > 40 ? b - 32 : b + 12;
    group.append(s('circle', {cx: a, cy: b, r: 6, fill: 'none', stroke: 'var(--ink)'}),
      s('rect', {x: left, y: above, width: wide, height: 22, rx: 4, fill: 'var(--panel)', stroke: 'var(--line)'}),
      s('text', {x: left + 6, y: above + 15, fill: 'var(--ink)'}, text));
  }
}
