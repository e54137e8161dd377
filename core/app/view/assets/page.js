'use strict';
(() => {
  const {data, colour, short, axis, show} = drape;

  // Level shows as dash and width: dotted and thin is coarse, solid and thick is the finest.
  const dashes = [[1, 3], [4, 3], [8, 3], [12, 3, 2, 3]];
  function lineStyle(series) {
    const finest = series.level === data.finest;
    return {
      label: series.method + ', level ' + series.level,
      borderColor: drape.methodStyle(series.method).borderColor,
      borderWidth: finest ? 2.6 : 1.5,
      borderDash: finest ? [] : dashes[series.level % dashes.length],
      pointRadius: series.iteration.length > 1 ? 0 : 3, pointHitRadius: 6, tension: 0, fill: false, spanGaps: true,
    };
  }

  /// Plots of one level: methods by name.
  function methodStyle(series) {
    return Object.assign(lineStyle(series), {label: series.method, borderWidth: 2.2}, drape.methodStyle(series.method));
  }

  function lines(id, x, y, titles, logarithmicX, withTolerance, chosen = data.series, style = lineStyle,
    logarithmicY = true) {
    const datasets = chosen.map(series => Object.assign(style(series), {
      data: series[x].map((value, k) => ({x: value, y: series[y][k]}))
        .filter(p => p.x !== null && p.y !== null && (!logarithmicY || p.y > 0) && (!logarithmicX || p.x > 0)),
    })).filter(set => set.data.length > 0);
    const all = datasets.flatMap(set => set.data.map(p => p.x));
    if (withTolerance && data.tolerance && all.length) {
      datasets.push({label: 'tolerance', borderColor: colour('--soft'), borderWidth: 1, borderDash: [5, 4],
        pointRadius: 0, pointHitRadius: 0,
        data: [{x: Math.min(...all), y: data.tolerance}, {x: Math.max(...all), y: data.tolerance}]});
    }
    show(id, {
      type: 'scatter',
      data: {datasets: datasets.map(set => Object.assign(set, {showLine: true}))},
      options: {
        scales: {x: axis(titles[0], logarithmicX, x), y: axis(titles[1], logarithmicY, y)},
        plugins: {tooltip: drape.tooltip},
      },
    }, all.length);
  }

  const palette = ['#4c78a8', '#f58518', '#54a24b', '#b279a2', '#e45756', '#72b7b2', '#eeca3b', '#9d755d',
    '#bab0ac', '#ff9da6'];
  function bars(id, bar, unit) {
    const count = bar.labels.length, canvas = document.getElementById(id);
    if (canvas) canvas.parentElement.style.height = (110 + 30 * count) + 'px';
    show(id, {
      type: 'bar',
      data: {labels: bar.labels, datasets: bar.names.map((name, k) => ({label: name, data: bar.values[k],
        backgroundColor: palette[k % palette.length], barPercentage: .8, categoryPercentage: .9}))},
      options: {
        indexAxis: 'y',
        scales: {
          x: Object.assign(axis(unit, false), {stacked: true}),
          y: {stacked: true, grid: {display: false}, ticks: {color: colour('--ink'), autoSkip: false}},
        },
        plugins: {
          legend: {position: 'bottom', labels: {color: colour('--ink'), boxWidth: 12, font: {size: 11}}},
          tooltip: {callbacks: {label: item => item.dataset.label + ': ' + short(item.parsed.x) + ' ' + unit}},
        },
      },
    }, count);
  }

  /// Over pseudo-time, one point per increment.
  function increments(id, y, title) {
    lines(id, 'time', y, ['pseudo-time', title], false, false, data.increments,
      s => Object.assign(lineStyle(Object.assign({iteration: s.time}, s)), {pointRadius: 2.5}), false);
  }

  /// One line per method, through the levels that its last state builds on; levels end in larger points.
  function errorLines(id, measure, target, cost) {
    const datasets = data.methods.map(({name: method}) => {
      const points = data.errors.filter(series => series.method === method).flatMap(series => {
        const errors = (series[target] || {})[measure] || [];
        const last = series[cost].length - 1;
        return series[cost].map((x, k) => ({x, y: errors[k], level: series.level, radius: k === last ? 4.5 : 1.5}));
      }).filter(p => p.x > 0 && p.y > 0);
      const style = methodStyle({method, level: data.finest, iteration: points});
      return Object.assign(style, {data: points, showLine: true, borderWidth: method === data.methods[0].name ? 3 : 1.8,
        pointRadius: points.map(p => p.radius)});
    }).filter(set => set.data.length > 0);
    const label = item => item.dataset.label + ', level ' + item.raw.level + ': ' + short(item.parsed.x) + ', ' +
      short(item.parsed.y);
    show(id, {
      type: 'scatter',
      data: {datasets},
      options: {
        scales: {x: axis(drape.costKinds[cost], true, cost), y: axis(drape.measures[measure], true, target + '_' + measure)},
        plugins: {tooltip: {callbacks: {label}}},
      },
    }, datasets.flatMap(set => set.data).length, 6);
  }

  function drawErrors() {
    const {measure, target, cost} = chosenError();
    errorLines('fine-energy', 'energy_gap', target, cost);
    errorLines('errors', measure, target, cost);
  }
  const chosenError = drape.choices('error', drawErrors, target => data.errors.some(series =>
    Object.values(series[target] || {}).some(errors => errors.some(error => error !== null))));

  function draw() {
    drawErrors();
    lines('residual-iteration', 'iteration', 'force_residual', ['Newton iteration', 'force residual'], false, true);
    lines('residual-seconds', 'seconds', 'force_residual', ['time [s]', 'force residual'], false, true);
    lines('gap-seconds', 'seconds', 'gap', ['time [s]', 'energy above the lowest [J]'], true, false);
    const coarsest = data.series.filter(series => series.level === data.coarsest);
    lines('coarsest-step', 'iteration', 'step', ['Newton iteration', 'Newton step, RMS [m]'], false, false,
      coarsest, methodStyle);
    lines('coarsest-residual', 'iteration', 'force_residual', ['Newton iteration', 'force residual'], false, true,
      coarsest, methodStyle);
    increments('increment-energy', 'energy_released', 'energy released [J]');
    increments('increment-steps', 'steps', 'steps');
    bars('phases', data.phases, 's');
    bars('parts', data.parts, 'J');
  }

  drape.follow(draw);

  const dialog = document.getElementById('enlarged');
  document.querySelectorAll('figure img').forEach(img => {
    const enlarge = () => {
      dialog.firstElementChild.src = img.src;
      dialog.firstElementChild.alt = img.alt;
      dialog.showModal();
    };
    img.tabIndex = 0;
    img.setAttribute('role', 'button');
    img.addEventListener('click', enlarge);
    img.addEventListener('keydown', event => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      enlarge();
    });
  });
  dialog.addEventListener('click', () => dialog.close());
})();
