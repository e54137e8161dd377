/// Shows what the page's data are of: a run, several runs, a run that goes on, or states alone.
import {livePage} from './live.js';
import {runPage} from './run.js';
import {sweepPage} from './sweep.js';
import {h} from './text.js';
import {View} from './view.js';

function statesPage({view, notes = []}) {
  const shown = window.drapeViewer = new View(view);
  return [h('header', {}, h('h1', {}, view.title || 'States')), h('section', {}, shown.element, shown.controls),
    notes.length ? h('ul', {class: 'remarks', id: 'remarks'}, notes.map(note => h('li', {}, note))) : null];
}

const data = JSON.parse(document.getElementById('data').textContent);
document.getElementById('page').replaceChildren(...{run: runPage, runs: sweepPage, live: livePage, states: statesPage}[data.kind](data).filter(part => part));

// Paper is light and has no clicks.
addEventListener('beforeprint', () => {
  document.documentElement.dataset.theme = 'light';
  document.querySelectorAll('details').forEach(part => { part.open = true; });
  window.drapeViewer?.copyForPaper();
});
addEventListener('afterprint', () => {
  delete document.documentElement.dataset.theme;
  window.drapeViewer?.scene?.draw();
});
