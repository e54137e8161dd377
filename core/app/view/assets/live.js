'use strict';
/// The live page: polls for news four times a second, and sends button presses.
(() => {
  const element = name => document.getElementById('live-' + name);
  const style = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const source = {
    live: true,
    async load(name) {
      const response = await fetch('block/' + name);
      if (!response.ok) throw new Error(await response.text());
      return response.arrayBuffer();
    },
  };
  let chart = null, version = 0, rows = 0, last = null, misses = 0;

  function drawChart(news) {
    if (!chart) {
      const axis = (title, type) => ({type, title: {display: true, text: title, color: style('--soft')},
        grid: {color: style('--line')}, ticks: {color: style('--soft')}});
      chart = new Chart(element('residual'), {type: 'scatter', data: {datasets: []}, options: {animation: false,
        responsive: true, maintainAspectRatio: false,
        scales: {x: axis('time [s]', 'linear'), y: axis('force residual', 'logarithmic')},
        plugins: {legend: {position: 'bottom', labels: {color: style('--ink')}}}}});
      chart.data.datasets = news.methods.map(method => ({label: method.name, data: [], showLine: true, pointRadius: 0,
        borderWidth: 2, borderColor: style('--solver-' + method.style), backgroundColor: style('--solver-' + method.style)}));
      chart.data.datasets.push({label: 'tolerance', data: [], showLine: true, pointRadius: 0, borderWidth: 1,
        borderDash: [5, 4], borderColor: style('--soft'), backgroundColor: style('--soft')});
    }
    const lines = chart.data.datasets;
    news.rows.forEach(([method, , seconds, residual]) => lines[method].data.push({x: seconds, y: residual}));
    const end = Math.max(1e-3, ...lines.flatMap(line => line.data.length ? [line.data[line.data.length - 1].x] : []));
    lines[lines.length - 1].data = [{x: 0, y: news.tolerance}, {x: end, y: news.tolerance}];
    chart.update();
  }

  async function take(news) {
    version = news.version;
    rows = news.first_row + news.rows.length;
    last = news;
    drawChart(news);
    element('status').textContent = news.outcome ? `The run has ended: ${news.outcome}.`
      : news.method ? `Running: ${news.method}, level ${news.level} of ${news.finest}.` : 'Waiting for the run.';
    element('stop').disabled = !news.method || !!news.outcome;
    element('refine').disabled = element('stop').disabled || news.level === news.finest;
    // Before the next request: the server soon drops replaced states.
    if (window.drapeViewer) await window.drapeViewer.update(news);
    else window.drapeViewer = new Viewer(Object.assign(source, {document: news}));
  }

  async function ask() {
    let pause = 250;
    try {
      const response = await fetch(`news?version=${version}&rows=${rows}`);
      misses = 0;
      if (response.status === 200) {
        await take(await response.json());
        pause = last.outcome ? 0 : pause;  // at once: tells the run that its outcome was received
      } else if (last && last.outcome) {
        return;
      }
    } catch (error) {
      if (++misses > 4) {
        if (!last || !last.outcome) element('status').textContent = 'The run no longer answers: it has finished or was stopped.';
        element('stop').disabled = element('refine').disabled = true;
        return;
      }
    }
    setTimeout(ask, pause);
  }

  for (const action of ['stop', 'refine']) {
    element(action).addEventListener('click', async () => {
      element(action).disabled = true;
      const response = await fetch(action, {method: 'POST'}).catch(() => null);
      if (response && !response.ok) element('note').textContent = await response.text();
      else if (response) element('note').textContent = action === 'stop' ? 'The run ends after this step.'
        : 'The next level begins after this step.';
    });
  }
  ask();
})();
