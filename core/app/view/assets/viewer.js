'use strict';
/// The viewer's controls: which state of the progression is shown, in which colours, in which views.
class Viewer {
  /// `source` has the document and load(name), a promise of a block's bytes.
  constructor(source) {
    this.source = source;
    this.blocks = new Map();   // promises of decoded blocks, by kind and name
    this.element = Object.fromEntries(['level', 'level-text', 'field', 'methods', 'stage', 'canvas', 'labels', 'play', 'stop',
      'reset', 'legend', 'note', 'rounding'].map(name => [name, document.getElementById('viewer-' + name)]));
    this.hidden = new Set();   // methods not shown
    this.stops = [];
    this.stop = -1;
    this.panels = [];
    try {
      this.scene = new ViewerScene(this.element.canvas, this.element.labels);
    } catch (error) {
      this.element.stage.hidden = true;
      document.querySelectorAll('.viewer-bar, #viewer-keys').forEach(bar => { bar.hidden = true; });
      this.say('This browser has no WebGL: there is no 3D view. The pictures show the same states.');
      return;
    }
    this.listen();
    this.update(source.document);
  }

  say(text) { this.element.note.textContent = text; }

  /// Takes a document, also while it grows; a viewer of the newest state follows. Resolves once it is shown.
  update(data) {
    const following = this.stop === this.stops.length - 1;
    this.data = data;
    const reached = data.methods.flatMap(method => method.levels.map(level => level.level));
    this.stops = [];
    for (let level = 0; level <= Math.max(-1, ...reached); ++level) {
      const counts = data.methods.flatMap(m => m.levels).filter(l => l.level === level).map(l => l.states.length);
      const count = Math.max(0, ...counts);
      for (let k = 0; k < count; ++k) this.stops.push({level, share: count > 1 ? k / (count - 1) : 1, last: k === count - 1});
    }
    if (this.source.live) this.forget();
    this.listFields();
    this.listMethods();
    this.element.rounding.textContent = data.rounding > 0
      ? `Positions are rounded to ${Number((data.rounding * 1e6).toPrecision(2))} µm here; the files in levels/ are exact.` : '';
    return this.stops.length ? this.show(following ? this.stops.length - 1 : this.stop) : null;
  }

  /// Drops the blocks of states that newer ones have replaced.
  forget() {
    const states = this.data.methods.flatMap(m => m.levels).flatMap(l => l.states);
    const named = new Set(states.flatMap(s => [s.x, ...Object.values(s.fields), ...Object.values(s.obstacles || {})]));
    for (const key of this.blocks.keys()) {
      const [kind, name] = key.split(' ');
      if ((kind === 'x' && name[0] === 'm' || kind === 'scalars') && !named.has(name)) this.blocks.delete(key);
    }
  }

  listFields() {
    const select = this.element.field, chosen = select.value;
    if (select.options.length !== this.data.fields.length + 1) {
      select.replaceChildren(new Option('cloth', ''), ...this.data.fields.map(f => new Option(f.label, f.name)));
      select.value = this.data.fields.some(f => f.name === chosen) ? chosen : '';
    }
    const field = this.field(), [low, bar, high, note] = this.element.legend.children;
    this.element.legend.hidden = !field;
    if (!field) return;
    const text = v => String(Number(v.toPrecision(3))).replace('-', '−');
    low.textContent = text(field.low);
    bar.style.background = ViewerColours.gradient(field.map);
    high.textContent = text(field.high) + (field.unit === '1' ? '' : ' ' + field.unit);
    note.textContent = field.note;
  }

  listMethods() {
    const box = this.element.methods, names = this.data.methods.map(method => method.name);
    if (box.dataset.names === JSON.stringify(names)) return;
    box.dataset.names = JSON.stringify(names);
    box.replaceChildren(...(names.length < 2 ? [] : names).map(name => {
      const label = document.createElement('label'), tick = document.createElement('input');
      tick.type = 'checkbox';
      tick.checked = !this.hidden.has(name);
      tick.addEventListener('change', () => {
        this.hidden[tick.checked ? 'delete' : 'add'](name);
        this.listViews();
        this.show(this.stop);
      });
      label.append(tick, ' ' + name);
      return label;
    }));
    this.listViews();
  }

  listViews() {
    this.shown = this.data.methods.map(m => m.name).filter(name => !this.hidden.has(name));
    this.element.labels.replaceChildren(...this.shown.map(() => document.createElement('div')));
    this.scene.setViews(this.shown.length);
    this.panels = [];
  }

  field() { return this.data.fields.find(field => field.name === this.element.field.value); }

  /// A block, decoded once.
  block(kind, name, decode) {
    const key = kind + ' ' + name;
    if (!this.blocks.has(key)) {
      const promise = this.source.load(name).then(decode);
      promise.catch(() => this.blocks.delete(key));
      this.blocks.set(key, promise);
    }
    return this.blocks.get(key);
  }
  index(entry) {
    return this.block('index', entry.block, bytes =>
      new THREE.BufferAttribute(ViewerData.triangles(bytes, entry.triangles), 1));
  }

  /// The state of a method at a stop: of that level, or of the last one that it reached.
  stateAt(method, stop) {
    const level = method.levels.filter(l => l.level <= stop.level && l.states.length).pop();
    if (!level) return null;
    const share = level.level === stop.level ? stop.share : 1;
    return {level, state: level.states[Math.round(share * (level.states.length - 1))]};
  }

  async panel(method, stop, field) {
    const found = this.stateAt(method, stop);
    if (!found) return {method, shape: null, obstacles: await this.obstaclesOf({})};
    const entry = this.data.levels[found.level.level], block = field && found.state.fields[field.name];
    const [obstacles, index, x, tints] = await Promise.all([this.obstaclesOf(found.state), this.index(entry),
      this.block('x', found.state.x, bytes => ViewerData.positions(bytes, entry.vertices)),
      block ? this.block('scalars', block, ViewerData.scalars).then(s => ViewerColours.paint(s, field)) : null]);
    return {method, found, shape: {index, x, tints}, obstacles};
  }

  /// Shows a stop once its data are loaded; a later call supersedes it.
  async show(number) {
    this.stop = Math.min(Math.max(number, 0), this.stops.length - 1);
    const stop = this.stops[this.stop], {level, stop: scrubber} = this.element;
    level.max = Math.max(...this.stops.map(s => s.level));
    level.value = stop.level;
    scrubber.max = this.stops.length - 1;
    scrubber.value = this.stop;
    this.element['level-text'].textContent = `${stop.level}, ${this.data.levels[stop.level].vertices.toLocaleString('en')} vertices`;
    const ticket = this.ticket = {};
    const methods = this.shown.map(name => this.data.methods.find(m => m.name === name));
    let panels;
    try {
      panels = await Promise.all(methods.map(method => this.panel(method, stop, this.field())));
    } catch (error) {
      if (this.ticket === ticket && !this.source.live) this.say('A state could not be read: ' + error.message);
      return;
    }
    if (this.ticket !== ticket) return;
    if (!this.aimed) this.aim(panels);
    panels.forEach((panel, k) => {
      this.scene.setCloth(k, panel.shape);
      this.scene.setObstacles(k, panel.obstacles);
      this.label(this.element.labels.children[k], panel);
    });
    scrubber.setAttribute('aria-valuetext', `level ${stop.level}, ${Math.round(100 * stop.share)} % of it`);
    this.panels = panels;
    this.scene.draw();
  }

  /// The obstacles where a state has them; a state names those that have moved.
  obstaclesOf(state) {
    return Promise.all(this.data.obstacles.map(async (o, k) => {
      const name = state.obstacles && state.obstacles[k] || o.x;
      const [index, x] = await Promise.all([this.index(o), this.block('x', name, b => ViewerData.positions(b, o.vertices))]);
      return {index, x};
    }));
  }

  /// Points the camera at the cloth's bounding box.
  aim(panels) {
    const lower = [Infinity, Infinity, Infinity], upper = [-Infinity, -Infinity, -Infinity];
    panels.forEach(({shape}) => shape && shape.x.forEach((v, i) => {
      lower[i % 3] = Math.min(lower[i % 3], v);
      upper[i % 3] = Math.max(upper[i % 3], v);
    }));
    if (!(upper[0] >= lower[0])) return;
    const centre = lower.map((v, k) => (v + upper[k]) / 2);
    let radius = 0;
    panels.forEach(({shape}) => {
      for (let i = 0; shape && i < shape.x.length; i += 3)
        radius = Math.max(radius, Math.hypot(shape.x[i] - centre[0], shape.x[i + 1] - centre[1], shape.x[i + 2] - centre[2]));
    });
    this.scene.lookAt(centre, radius || 1);
    this.aimed = true;
  }

  label(box, {method, found}) {
    const name = document.createElement('b'), text = document.createElement('span');
    name.textContent = method.name;
    if (found) {
      const {iteration, seconds} = found.state, running = found.level.status === 'running';
      text.textContent = `level ${found.level.level}` + (running ? ', running' : '') +
        (iteration == null ? '' : `, ${iteration} iterations`) + (seconds == null ? '' : `, ${seconds.toPrecision(3)} s`);
    } else {
      text.textContent = 'not reached yet';
    }
    box.replaceChildren(name, text);
  }

  play(on) {
    clearTimeout(this.timer);
    this.playing = on;
    this.element.play.textContent = on ? 'Pause' : 'Play';
    this.element.play.setAttribute('aria-pressed', String(on));
    if (!on) return;
    const next = this.stop + 1 < this.stops.length ? this.stop + 1 : 0;
    const step = async stop => {
      await this.show(stop);
      if (!this.playing) return;
      if (stop + 1 >= this.stops.length) return this.play(false);
      this.timer = setTimeout(() => step(stop + 1), this.stops[stop].last ? 900 : 140);
    };
    step(next);
  }

  changeLevel(by) {
    const level = (this.stops.length ? this.stops[this.stop].level : 0) + by;
    if (this.stops.some(s => s.level === level)) this.showLevel(level);
  }
  showLevel(level) { this.show(this.stops.findIndex(s => s.level === level && s.last)); }

  listen() {
    const {level, stop, field, play, reset, canvas} = this.element;
    level.addEventListener('input', () => { this.play(false); this.showLevel(Number(level.value)); });
    stop.addEventListener('input', () => { this.play(false); this.show(Number(stop.value)); });
    field.addEventListener('change', () => { this.listFields(); this.show(this.stop); });
    play.addEventListener('click', () => this.play(!this.playing));
    reset.addEventListener('click', () => this.scene.resetView());
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.scene.draw());
    listenToView(this, canvas);
  }

  /// What is shown, for tests and scripts.
  state() {
    const stop = this.stops[this.stop];
    return {
      level: stop ? stop.level : -1, stop: this.stop, stops: this.stops.length, playing: !!this.playing,
      field: this.element.field.value, renders: this.scene ? this.scene.renders : 0, webgl: !!this.scene,
      camera: this.scene && Object.assign({}, this.scene.view),
      panels: this.panels.map(({method, found, shape, obstacles}) => ({method: method.name, level: found ? found.level.level : -1,
        vertices: shape ? shape.x.length / 3 : 0, triangles: shape ? shape.index.count / 3 : 0,
        sum: shape ? shape.x.reduce((a, b) => a + Math.abs(b), 0) : 0,
        tints: shape && shape.tints ? shape.tints.reduce((a, b) => a + b, 0) : null,
        obstacles: obstacles.map(({x}) => x.reduce((a, b) => a + b, 0))})),
    };
  }
}

// In a report the viewer waits until it is about to be seen.
addEventListener('DOMContentLoaded', () => {
  const data = document.getElementById('viewer-data'), root = document.getElementById('viewer');
  if (!data || !root) return;
  const start = () => { window.drapeViewer = window.drapeViewer || new Viewer(ViewerData.embedded()); };
  new IntersectionObserver((entries, observer) => {
    if (!entries.some(entry => entry.isIntersecting)) return;
    observer.disconnect();
    start();
  }, {rootMargin: '300px'}).observe(root);
});
