/// The page of a run that goes on: polls for news four times a second, and sends button presses.
import {Chart, methodLook} from './charts.js';
import {h, say, unique} from './text.js';
import {View} from './view.js';

export function livePage({title, methods}) {
  const status = h('p', {class: 'lead', id: 'live-status', role: 'status'}, 'Waiting for the run.');
  const note = h('p', {class: 'note', id: 'live-note', role: 'status'}, '“Refine now” ends the level in its present state and begins the next finer one. “Stop” ends the run, as Ctrl-C does, ' +
    'and keeps all results so far.');
  const button = (action, text, answer) => h('button', {type: 'button', id: 'live-' + action, disabled: true, click: async event => {
    event.target.disabled = true;
    const response = await fetch(action, {method: 'POST'}).catch(() => null);
    if (response) note.textContent = response.ok ? answer : await response.text();
  }}, text);
  const refine = button('refine', 'Refine now', 'The next level begins after this step.'), stop = button('stop', 'Stop', 'The run ends after this step.');
  const chart = new Chart('live-residual', 'Force residual over time since the method’s start. The dashed grey line is the tolerance.', 260);
  const hero = h('section', {class: 'hero'}, h('div', {class: 'facts'}, status, h('p', {class: 'controls'}, refine, stop), note, chart.element));
  const load = async name => {
    const response = await fetch('block/' + name);
    if (!response.ok) throw new Error(await response.text());
    return response.arrayBuffer();
  };
  const lines = new Map();
  let version = 0, rows = 0, last = null, misses = 0;

  async function take(news) {
    version = news.version;
    rows += news.rows.length;
    last = news;
    for (const [method, , x, y] of news.rows) {
      const {name} = news.methods[method];
      if (!lines.has(name)) lines.set(name, []);
      lines.get(name).push({x, y});
      if (lines.get(name).length > 2000) lines.set(name, lines.get(name).filter((_, k) => k % 2));  // more are not visible
    }
    const ends = [...lines.values()].map(points => points.at(-1).x), tolerances = Object.values(methods).map(method => method.tolerance);
    chart.draw({x: {title: 'time [s]', name: 'seconds'}, y: {title: 'force residual', name: 'force_residual', log: true}, series: [
      ...[...lines].map(([label, points]) => ({label, ...methodLook(methods, label), mark: null, points})),
      ...unique(ends.length ? tolerances : []).map(y =>
        ({label: 'tolerance', colour: 'var(--soft)', dash: '5 4', width: 1, points: [0, Math.max(...ends)].map(x => ({x, y}))}))]});
    say(status, news.outcome ? `The run has ended: ${news.outcome}.`
      : news.method ? `Running: ${news.method}, level ${news.level} of ${news.finest}.` : 'Waiting for the run.');
    stop.disabled = !news.method || !!news.outcome;
    refine.disabled = stop.disabled || news.level === news.finest;
    // Before the next request: the server soon drops replaced states.
    if (window.drapeViewer) return window.drapeViewer.update(news);
    const view = window.drapeViewer = new View(news, {load, live: true});
    hero.prepend(view.element);
    hero.append(view.controls);
  }

  async function ask() {
    let pause = 250;
    try {
      const response = await fetch(`news?version=${version}&rows=${rows}`);
      if (!response.ok) throw new Error(response.statusText);  // of another run's server
      misses = 0;
      if (response.status === 200) {
        await take(await response.json());
        pause = last.outcome ? 0 : pause;  // at once: tells the run that its outcome was received
      } else if (last && last.outcome) {
        return;
      }
    } catch (error) {
      if (++misses > 4) {
        if (!last || !last.outcome) status.textContent = 'The run no longer answers: it has finished or was stopped.';
        stop.disabled = refine.disabled = true;
        return;
      }
    }
    setTimeout(ask, pause);
  }
  ask();
  return [h('header', {}, h('h1', {}, title)), hero];
}
