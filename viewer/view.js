/// The 3D view and its controls: which states are shown, in which colours, in which panels.
import {embedded, gradient, paint, positions, scalars, triangles} from './blocks.js';
import {Scene} from './scene.js';
import {surface} from './smooth.js';
import {choice, count, fold, h, save, say, tick} from './text.js';

/// So many digits, or a whole number where these do not suffice: no exponent.
const digits = (value, n) => value < 10 ** n - .5 ? value.toPrecision(n) : count(value);

const boxOf = arrays => arrays.reduce((box, x) => box.union(new THREE.Box3().setFromArray(x)), new THREE.Box3());
/// A small sphere around points.
function ballAround(arrays) {
  const centre = boxOf(arrays).getCenter(new THREE.Vector3());
  let square = 0;
  for (const x of arrays)
    for (let i = 0; i < x.length; i += 3) square = Math.max(square, (x[i] - centre.x) ** 2 + (x[i + 1] - centre.y) ** 2 + (x[i + 2] - centre.z) ** 2);
  return {center: centre, radius: Math.sqrt(square)};
}
/// Whether an obstacle is to be seen as a whole, as in pictures (core/app/report/pictures.cpp): it is taller than the cloth, as no floor
/// is, and at most three times as large.
function isBody(x, cloth) {
  const [own, its] = [boxOf([x]), boxOf(cloth)].map(box => box.getSize(new THREE.Vector3()));
  return own.z > its.z && own.length() <= 3 * its.length();
}

export class View {
  /// `load(name)` is a promise of a block's bytes. Of the methods `first` is shown, or all; with `beside` the panel of a state
  /// has that of the method's end beside it.
  constructor(view, {load = embedded, live = false, first = null, beside = false, picture = null} = {}) {
    Object.assign(this, {load, live, beside, picture, blocks: new Map(), stops: [], stop: -1, panels: [], obstacles: true,
      hidden: new Set(first === null ? [] : view.methods.map(m => m.name).filter(name => name !== first)), fieldName: ''});
    const button = (id, text, click) => h('button', {type: 'button', id, click}, text);
    const range = (id, label, input) => h('input', {type: 'range', id, 'aria-label': label, min: 0, max: 0, step: 1, value: 0, input: event => input(Number(event.target.value))});
    this.canvas = h('canvas', {id: 'viewer-canvas', tabindex: 0, role: 'application', 'aria-describedby': 'viewer-keys',
      'aria-label': 'The cloth in 3D, panels side by side, turned together'});
    this.labels = h('div', {class: 'viewer-labels', id: 'viewer-labels'});
    this.stage = h('div', {class: 'viewer-stage', id: 'viewer-stage'}, this.canvas, this.labels);
    this.note = h('p', {class: 'note', id: 'viewer-note', role: 'status'});
    this.level = range('viewer-level', 'Level', level => { this.play(false); this.showLevel(level); });
    this.levelText = h('output', {id: 'viewer-level-text', for: 'viewer-level'});
    this.scrubber = range('viewer-stop', 'Position in the progression', stop => { this.play(false); this.show(stop); });
    this.playing = h('button', {type: 'button', id: 'viewer-play', 'aria-pressed': 'false', click: () => this.play(!this.plays)}, 'Play');
    this.fields = h('span');
    this.squareSize = h('output', {id: 'viewer-square-size', for: 'viewer-squares'});
    this.ticks = h('span', {class: 'controls', id: 'viewer-methods', role: 'group', 'aria-label': 'Methods shown'});
    this.legend = h('p', {class: 'legend', id: 'viewer-legend', hidden: true});
    this.rounding = h('span', {id: 'viewer-rounding'});
    this.controls = h('div', {class: 'viewer-controls'},
      h('p', {class: 'controls'}, this.playing, this.scrubber, h('label', {}, 'Level ', this.level, this.levelText)),
      h('p', {class: 'controls'}, this.fields, this.ticks,
        tick('beside its end', beside, on => { this.beside = on; this.listPanels(); this.show(this.stop); }, 'viewer-beside'),
        tick('obstacles', true, on => { this.obstacles = on; this.show(this.stop); }, 'viewer-obstacles'),
        tick('smooth surface', false, on => { this.smooth = on; this.scene.setBack(on); this.show(this.stop); }, 'viewer-smooth'),
        tick('x-ray', false, on => this.scene.setXray(on), 'viewer-xray'),
        view.levels.some(level => level.warp) ? tick('warp (red arrows)', false, on => this.scene.setLines('warp', on), 'viewer-warp') : '',
        view.levels.some(level => level.rest || level.flat) ? tick('squares at rest', false, on => { this.squares = on; this.show(this.stop); }, 'viewer-squares') : '', this.squareSize,
        view.levels.some(level => level.seams) ? [tick('seams', true, on => this.scene.setLines('seams', on), 'viewer-seams'),
          tick('flat pieces', false, on => { this.flat = on; this.listPanels(); this.show(this.stop); }, 'viewer-flat')] : '',
        button('viewer-reset', 'Reset', () => this.scene.resetView()), button('viewer-png', 'PNG', () => this.savePicture())),
      this.legend,
      fold('Keys and precision', h('p', {class: 'note', id: 'viewer-keys'}, 'All panels share a camera. Drag to turn, with Shift or two fingers to pan; the wheel zooms ' +
        'once the view is clicked. Keys, with the view focused: arrows turn, Shift and arrows pan, + and − zoom, 0 resets, Page Up and Page Down change the level, ' +
        'Space plays. '), h('p', {class: 'note'}, this.rounding)));
    this.element = h('div', {class: 'viewer', id: 'viewer'}, this.stage, this.note, picture);
    try {
      this.scene = new Scene(this.canvas, this.labels);
    } catch (error) {
      this.stage.hidden = this.controls.hidden = true;
      this.element.classList.add('flat');
      this.note.textContent = 'This browser has no WebGL: there is no 3D view.';
      return;
    }
    this.listen();
    this.update(view);
  }

  /// Takes a document, also while it grows; a view of the newest state follows. Resolves once it is shown.
  update(view) {
    if (!this.scene) return null;  // without WebGL
    const following = this.stop === this.stops.length - 1 && this.live;
    this.data = view;
    const levels = view.methods.flatMap(method => method.levels);
    this.stops = [];
    for (let level = 0; level <= Math.max(-1, ...levels.map(l => l.level)); ++level) {
      const most = Math.max(0, ...levels.filter(l => l.level === level).map(l => l.states.length));
      for (let k = 0; k < most; ++k) this.stops.push({level, share: most > 1 ? k / (most - 1) : 1, last: k === most - 1});
    }
    if (this.live) [this.former, this.blocks] = [this.blocks, new Map()];  // what nothing shows any more goes at the next update
    this.listFields();
    this.listMethods();
    // The preview at first, beside the end; without that the end.
    const begin = this.beside && this.stops.some(s => s.level > this.stops[0].level) ? this.stops.findIndex(s => s.last) : this.stops.length - 1;
    return this.show(this.stop < 0 || following ? begin : this.stop);
  }

  field() { return this.data.fields.find(field => field.name === this.fieldName); }
  listFields() {
    const names = JSON.stringify(this.data.fields.map(f => f.name));
    if (this.fields.dataset.names !== names) {
      this.fields.dataset.names = names;
      this.fieldName = this.field() ? this.fieldName : '';
      this.fields.replaceChildren(choice('Colour', {'': 'cloth', ...Object.fromEntries(this.data.fields.map(f => [f.name, f.label]))}, this.fieldName,
        name => { this.fieldName = name; this.listFields(); this.show(this.stop); }, 'viewer-field'));
    }
    // Strain and pressure in units that people know.
    const field = this.field(), pressure = field?.unit === 'Pa';
    const [shown, unit] = !field ? [] : field.name === 'stretch' ? [v => 100 * (v - 1), '% strain'] : pressure ? [v => v / 1e3, 'kPa'] : [v => v, field.unit];
    const text = v => String(Number(shown(v).toPrecision(3))).replace('-', '−');
    this.legend.hidden = !field;
    if (!field) return;
    const bar = h('i');
    bar.style.background = gradient(field.map);
    this.legend.replaceChildren(text(field.low), bar, text(field.high) + (unit === '1' ? '' : ' ' + unit) + (pressure ? ` (${digits(field.high / 133.322, 3)} mmHg)` : ''), h('span', {}, field.note));
  }

  levelName(level) { return level + (this.data.levels.length > 1 ? ` of ${this.data.levels.length - 1}` : ''); }

  listMethods() {
    const names = this.data.methods.map(method => method.name);
    // While a run goes on, methods that it has not reached have no panel.
    const known = JSON.stringify([names, this.live && this.data.methods.map(method => method.levels.length > 0)]);
    if (this.ticks.dataset.names === known) return;
    this.ticks.dataset.names = known;
    this.ticks.replaceChildren(...(names.length < 2 ? [] : names).map(name => tick(name, !this.hidden.has(name), on => {
      this.hidden[on ? 'delete' : 'add'](name);
      this.listPanels();
      this.show(this.stop);
    })));
    this.listPanels();
  }

  listPanels() {
    this.shown = this.data.methods.filter(m => !this.hidden.has(m.name) && !(this.live && !m.levels.length)).flatMap(m =>
      this.beside && m.levels.length > 1 ? [{name: m.name}, {name: m.name, end: true}] : [{name: m.name}]).flatMap(panel => this.flat ? [panel, {...panel, flat: true}] : panel);
    this.labels.replaceChildren(...this.shown.map(() => h('div')));
    this.scene.setViews(this.shown.length);
    this.panels = [];
  }

  /// A block, decoded once.
  block(kind, name, decode) {
    const key = kind + ' ' + name;
    if (!this.blocks.has(key)) {
      const promise = this.former?.get(key) ?? this.load(name).then(decode);
      promise.catch(() => this.blocks.delete(key));
      this.blocks.set(key, promise);
    }
    return this.blocks.get(key);
  }
  index(entry) {
    return this.block('index', entry.block, bytes => new THREE.BufferAttribute(triangles(bytes, entry.triangles), 1));
  }

  /// The state of a method at a stop: of that level, or of the last one that it reached.
  stateAt(method, stop) {
    const level = method.levels.filter(l => l.level <= stop.level && l.states.length).pop();
    if (!level) return null;
    const share = level.level === stop.level ? stop.share : 1;
    return {level, state: level.states[Math.round(share * (level.states.length - 1))]};
  }

  async panel({name, end, flat}, stop, field) {
    const method = this.data.methods.find(m => m.name === name);
    const found = this.stateAt(method, end ? this.stops[this.stops.length - 1] : stop);
    if (!found) return {method, end, shape: null, obstacles: await this.obstaclesOf({})};
    const entry = this.data.levels[found.level.level], block = field && found.state.fields[field.name];
    const tinted = block ? this.block('scalars', block, scalars).then(values => paint(values, field)) : null;
    if (flat) return {method, end, found, flat, shape: {...await this.flatPieces(entry.flat, await tinted), flat}, obstacles: []};
    const [obstacles, index, x, tints] = await Promise.all([this.obstaclesOf(found.state), this.index(entry),
      this.block('x', found.state.x, bytes => positions(bytes, entry.vertices)),
      tinted]);
    let shape = {index, x, tints};
    if (this.smooth) shape = surface(shape, block ?? '') ?? shape;
    else if (this.squares) shape = entry.flat ? await this.flatPieces(entry.flat, tints, x)
      : {...shape, rest: entry.rest && await this.block('rest', entry.rest, b => positions(b, entry.vertices))};
    return {method, end, found, shape: {...shape, warp: entry.warp, seams: !this.smooth && entry.seams}, obstacles};
  }
  /// The pieces of a level as they are cut, or where x has its vertices, with the colours of its vertices.
  async flatPieces(flat, tints, x = null) {
    const [index, rest] = await Promise.all([this.index(flat), this.block('flat', flat.x, b => positions(b, flat.vertices))]);
    const all = values => {
      if (!values) return values;
      const copied = Object.assign(new values.constructor(3 * flat.vertices), {rounding: values.rounding});
      copied.set(values);
      flat.copies.forEach((v, k) => copied.set(values.subarray(3 * v, 3 * v + 3), values.length + 3 * k));
      return copied;
    };
    return {index, x: all(x) ?? rest, rest, tints: all(tints)};
  }

  /// Shows a stop once its data are loaded; a later call supersedes it.
  async show(to) {
    if (!this.stops.length) return;  // of a run that has just begun
    this.stop = Math.min(Math.max(to, 0), this.stops.length - 1);
    const stop = this.stops[this.stop], ticket = this.ticket = {};
    this.level.max = Math.max(...this.stops.map(each => each.level));
    this.level.value = stop.level;
    this.scrubber.max = this.stops.length - 1;
    this.scrubber.value = this.stop;
    say(this.levelText, `${this.levelName(stop.level)}, ${count(this.data.levels[stop.level].vertices)} vertices`);
    let panels;
    try {
      panels = await Promise.all(this.shown.map(panel => this.panel(panel, stop, this.field())));
    } catch (error) {
      if (this.ticket === ticket && !this.live) this.note.textContent = 'A state could not be read: ' + error.message;
      return;
    }
    if (this.ticket !== ticket) return;
    if (!this.aimed) this.aim(panels);
    this.showSquares(panels);
    panels.forEach((panel, k) => {
      this.scene.setCloth(k, panel.shape);
      this.scene.setObstacles(k, this.obstacles ? panel.obstacles : []);
      this.label(this.labels.children[k], panel);
    });
    this.scrubber.setAttribute('aria-valuetext', `level ${stop.level}, ${Math.round(100 * stop.share)} % of it`);
    const rounding = Math.max(0, ...panels.map(({shape}) => shape ? shape.x.rounding : 0));
    this.rounding.textContent = !rounding ? '' : `Positions are rounded to ${Number((rounding * 1e6).toPrecision(2))} µm here; the files in levels/ are exact.`;
    this.panels = panels;
    this.scene.draw();
  }

  /// Squares of a round size, some thirty along the cloth.
  showSquares(panels) {
    const box = new THREE.Box3(), rest = this.squares && panels.find(({shape}) => shape?.rest)?.shape.rest;
    const side = rest ? box.setFromArray(rest).getSize(new THREE.Vector3()).length() / 30 : 0, power = 10 ** Math.floor(Math.log10(side || 1));
    this.square = side && [1, 2, 5, 10].map(digit => digit * power).find(size => size >= .8 * side);
    this.scene.setSquares(this.square);
    say(this.squareSize, side ? `of ${Number((1e3 * this.square).toPrecision(2))} mm` : '');
  }

  /// The obstacles where a state has them; a state names those that have moved.
  obstaclesOf(state) {
    return Promise.all(this.data.obstacles.map(async (o, k) => {
      const name = state.obstacles && state.obstacles[k] || o.x;
      const [index, x] = await Promise.all([this.index(o), this.block('x', name, b => positions(b, o.vertices))]);
      return {index, x};
    }));
  }

  /// Points the camera at the cloth, and at all of a body in it.
  aim(panels) {
    const drawn = panels.filter(panel => panel.shape && !panel.flat), cloth = drawn.map(({shape}) => shape.x);
    if (!cloth.some(x => x.length)) return;
    const bodies = drawn.flatMap(({obstacles}) => obstacles.map(({x}) => x)).filter(x => isBody(x, cloth));
    const {center, radius} = ballAround([...cloth, ...bodies]);
    this.scene.lookAt(center.toArray(), radius || 1, ballAround(cloth).radius || 1);
    this.aimed = true;
  }

  label(box, {method, end, found, flat}) {
    const {iteration = null, seconds = null, total = null} = found ? found.state : {}, running = found && found.level.status === 'running';
    const text = !found ? 'not reached yet' : [`level ${this.levelName(found.level.level)}` + (running ? ', running' : ''),
      ...(total !== null ? [`after ${digits(total, 2)} s`] : [iteration === null ? null : `${iteration} iterations`, seconds === null ? null : `${digits(seconds, 3)} s`])]
      .filter(part => part).join(', ');
    const name = end ? 'end' : found && method.levels.length > 1 && found.level === method.levels[0] && found.state === found.level.states.at(-1) ? 'preview' : '';
    box.replaceChildren(h('b', {}, method.name + (name && ', ' + name)), h('span', {}, flat ? 'flat pieces' : text));
  }

  play(on) {
    clearTimeout(this.timer);
    this.plays = on && this.stops.length > 0;
    this.playing.textContent = this.plays ? 'Pause' : 'Play';
    this.playing.setAttribute('aria-pressed', String(this.plays));
    if (!this.plays) return;
    const step = async stop => {
      await this.show(stop);
      if (!this.plays) return;
      if (stop + 1 >= this.stops.length) return this.play(false);
      this.timer = setTimeout(() => step(stop + 1), this.stops[stop].last ? 900 : 140);
    };
    step(this.stop + 1 < this.stops.length ? this.stop + 1 : 0);
  }

  /// The next level that has a state, up or down.
  changeLevel(up) {
    const levels = this.stops.map(stop => stop.level), at = levels[this.stop], next = up ? levels.find(level => level > at) : levels.findLast(level => level < at);
    if (next !== undefined) this.showLevel(next);
  }
  /// The last state of the nearest level that has one.
  showLevel(level) {
    const nearest = Math.min(...this.stops.map(stop => Math.abs(stop.level - level)));
    this.show(this.stops.findLastIndex(stop => Math.abs(stop.level - level) === nearest));
  }
  /// A canvas of WebGL cannot be printed: a copy of it stands in, with its labels, unless the page has a picture.
  copyForPaper() {
    if (this.picture || !this.scene?.panel) return;
    this.scene.render(2);
    const copy = h('canvas', {role: 'img', 'aria-label': 'The cloth', width: this.canvas.width, height: this.canvas.height}), labels = this.labels.cloneNode(true);
    copy.getContext('2d').drawImage(this.canvas, 0, 0);
    labels.removeAttribute('id');
    labels.style.gridTemplateRows = `repeat(${this.scene.rows}, 1fr)`;
    this.copy?.remove();
    this.element.append(this.copy = h('div', {class: 'fallback'}, copy, labels));
  }
  async savePicture() { save((this.data.title || 'cloth') + '.png', await this.scene.picture()); }

  /// Keys and the wheel on the view; its pointers are the scene's.
  listen() {
    const {canvas, scene} = this;
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => scene.draw());
    const go = (right, up) => shift => shift ? scene.move(.05 * right, .05 * up) : scene.turn(.1 * right, .1 * up);
    const nearer = () => scene.zoom(1 / 1.15), home = () => scene.resetView();
    const keys = {ArrowLeft: go(-1, 0), ArrowRight: go(1, 0), ArrowUp: go(0, 1), ArrowDown: go(0, -1), '+': nearer, '=': nearer, '-': () => scene.zoom(1.15),
      0: home, Home: home, PageUp: () => this.changeLevel(true), PageDown: () => this.changeLevel(false), ' ': () => this.play(!this.plays)};
    canvas.addEventListener('keydown', event => {
      if (event.ctrlKey || event.metaKey || event.altKey || !Object.hasOwn(keys, event.key)) return;
      keys[event.key](event.shiftKey);
      event.preventDefault();
    });
    canvas.addEventListener('wheel', event => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;  // the page scrolls
      event.preventDefault();
      scene.zoom(Math.exp(event.deltaY * (event.deltaMode ? .05 : .0015)));
    }, {passive: false});
  }
}
