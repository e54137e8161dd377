'use strict';
(() => {
  const {data, colour, axis, show} = drape;
  const palette = ['#4c78a8', '#f58518', '#54a24b', '#b279a2', '#e45756', '#72b7b2', '#eeca3b', '#9d755d',
    '#bab0ac', '#ff9da6'];

  /// A method's look; several variations have colours that no solver has.
  function style(row) {
    const look = Object.assign(drape.methodStyle(row.method), {borderWidth: 2});
    const v = data.variations.indexOf(row.variation);
    if (data.variations.length > 1)
      look.borderColor = look.backgroundColor = palette[v % palette.length];
    return look;
  }

  const chosen = drape.choices('error', drawErrors, target =>
    Object.values(((data.errors || {}).seconds || {})[target] || {}).some(plot => plot.curves.some(c => c.length)));
  const ranges = document.getElementById('error-ranges');
  ranges.addEventListener('change', drawErrors);

  function drawErrors() {
    const {measure, target, cost} = chosen();
    const plot = (((data.errors || {})[cost] || {})[target] || {})[measure] || {curves: data.rows.map(() => []), front: []};
    const datasets = [];
    let count = 0;
    data.rows.forEach((row, r) => {
      const curve = plot.curves[r], line = style(row);
      count += curve.length;
      if (!curve.length) return;
      datasets.push(Object.assign({label: row.title, pointRadius: curve.map((_, k) => k + 1 < curve.length ? 0 : 5), pointHitRadius: 6,
        fill: false, tension: 0, stepped: true,
        data: curve.map(([x, y, low, high, runs]) => ({x, y, low, high, runs}))}, line));
      if (!ranges.checked || curve.every(([, , low, high]) => low === high)) return;
      const edge = {borderWidth: 0, pointRadius: 0, pointHitRadius: 0, stepped: true, label: ''};
      datasets.push(Object.assign({data: curve.map(([x, , low]) => ({x, y: low})), fill: false}, edge));
      datasets.push(Object.assign({data: curve.map(([x, , , high]) => ({x, y: high})), fill: '-1',
        backgroundColor: line.borderColor + '26'}, edge));
    });
    if (plot.front.length)
      datasets.push({label: 'Pareto front', data: plot.front.map(([x, y, r]) => ({x, y, of: data.rows[r].title})),
        borderColor: colour('--ink'), backgroundColor: 'transparent', borderWidth: 1.5, borderDash: [1, 3],
        pointRadius: 4, pointBorderWidth: 1.5, showLine: false});
    show('errors', {
      type: 'scatter',
      data: {datasets: datasets.map(set => Object.assign({showLine: true}, set))},
      options: {
        scales: {x: axis(drape.costKinds[cost], true, cost), y: axis(drape.measures[measure], true, target + '_' + measure)},
        plugins: {tooltip: drape.tooltip},
      },
    }, count);
  }

  /// Thin lines from the lowest to the highest, over the bars.
  const whiskers = {
    id: 'whiskers',
    afterDatasetsDraw(chart) {
      const set = chart.data.datasets[0], {ctx, scales: {x}} = chart;
      ctx.save();
      ctx.strokeStyle = colour('--ink');
      chart.getDatasetMeta(0).data.forEach((bar, k) => {
        if (!set.ranges[k]) return;
        const [low, high] = set.ranges[k].map(value => x.getPixelForValue(value));
        ctx.beginPath();
        ctx.moveTo(low, bar.y);
        ctx.lineTo(high, bar.y);
        for (const end of [low, high]) ctx.moveTo(end, bar.y - 4), ctx.lineTo(end, bar.y + 4);
        ctx.stroke();
      });
      ctx.restore();
    },
  };

  const kind = document.getElementById('cost-kind');
  for (const [value, text] of Object.entries(drape.costKinds)) kind.add(new Option(text, value));
  kind.addEventListener('change', drawCosts);

  function drawCosts() {
    const costs = (data.costs || {})[kind.value] || [];
    document.getElementById('costs').parentElement.style.height = (110 + 30 * data.rows.length) + 'px';
    show('costs', {
      type: 'bar',
      data: {
        labels: data.rows.map(row => row.title),
        datasets: [{label: drape.costKinds[kind.value], data: costs.map(c => c && c[0]),
          ranges: costs.map(c => c && [c[1], c[2]]),
          backgroundColor: data.rows.map(row => style(row).borderColor + 'b0'), barPercentage: .8}],
      },
      options: {
        indexAxis: 'y',
        scales: {x: Object.assign(axis(drape.costKinds[kind.value], false, kind.value), {beginAtZero: true,
          suggestedMax: Math.max(...costs.filter(c => c).map(c => 1.02 * c[2]))}),
          y: {grid: {display: false}, ticks: {color: colour('--ink'), autoSkip: false}}},
        plugins: {legend: {display: false}},
      },
      plugins: [whiskers],
    }, costs.filter(c => c).length);
  }

  addEventListener('beforeprint', () => document.querySelectorAll('details').forEach(d => { d.open = true; }));

  drape.follow(() => {
    drawErrors();
    drawCosts();
  });
})();
