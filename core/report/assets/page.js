'use strict';
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const charts = [];
  const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Level shows as dash and width: dotted and thin is coarse, solid and thick is the finest.
  const dashes = [[1, 3], [4, 3], [8, 3], [12, 3, 2, 3]];
  function lineStyle(series) {
    const k = data.methods.indexOf(series.method);
    const finest = series.level === data.finest;
    return {
      label: series.method + ', level ' + series.level,
      borderColor: colour('--method-' + (Math.max(k, 0) % 5)),
      borderWidth: finest ? 2.6 : 1.5,
      borderDash: finest ? [] : dashes[series.level % dashes.length],
      pointRadius: series.iteration.length > 1 ? 0 : 3, pointHitRadius: 6, tension: 0, fill: false, spanGaps: true,
    };
  }

  /// Where only one level is shown: methods by name, told apart by dashes too, as lines may coincide.
  function methodStyle(series) {
    const k = data.methods.indexOf(series.method);
    return Object.assign(lineStyle(series), {label: series.method, borderWidth: 2.2,
      borderDash: [[], [9, 5], [2, 3], [12, 4, 2, 4]][Math.max(k, 0) % 4]});
  }

  const short = value => Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3)
    ? value.toExponential(2).replace('e+', 'e') : String(Number(value.toPrecision(3)));
  const superscript = n => String(n).replace(/./g, c => c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]);

  function axis(title, logarithmic) {
    const options = {
      type: logarithmic ? 'logarithmic' : 'linear',
      title: {display: true, text: title, color: colour('--soft')},
      grid: {color: colour('--line'), borderColor: colour('--line')},
      ticks: {color: colour('--soft'), maxRotation: 0},
    };
    if (logarithmic) {
      options.ticks.autoSkip = false;
      options.ticks.callback = value => {
        const power = Math.log10(value);
        if (Math.abs(power - Math.round(power)) > 1e-6) return '';
        return Math.round(power) >= -2 && Math.round(power) <= 3 ? String(Number(value.toPrecision(1)))
          : '10' + superscript(Math.round(power));
      };
      options.grid.color = context => {
        const power = context.tick ? Math.log10(context.tick.value) : 0;
        return Math.abs(power - Math.round(power)) < 1e-6 ? colour('--line') : 'transparent';
      };
    }
    return options;
  }

  /// Chart.js leaves the dashes out of its legend.
  function lineLabels(chart) {
    return Chart.defaults.plugins.legend.labels.generateLabels(chart)
      .filter(item => item.text !== 'tolerance')
      .map(item => Object.assign(item, {lineDash: chart.data.datasets[item.datasetIndex].borderDash}));
  }

  function show(id, config, count) {
    const canvas = document.getElementById(id);
    if (!canvas) return;
    if (!count) {
      const note = document.createElement('p');
      note.className = 'absent';
      note.textContent = 'Nothing was recorded for this plot.';
      canvas.parentElement.style.height = 'auto';
      canvas.replaceWith(note);
      return;
    }
    config.options.animation = false;
    config.options.responsive = true;
    config.options.maintainAspectRatio = false;
    config.options.plugins = Object.assign({
      legend: {position: 'bottom', labels: {color: colour('--ink'), usePointStyle: true, pointStyle: 'line',
        boxWidth: 34, font: {size: 11}, generateLabels: lineLabels}},
    }, config.options.plugins);
    charts.push(new Chart(canvas, config));
  }

  function lines(id, x, y, titles, logarithmicX, withTolerance, chosen = data.series, style = lineStyle) {
    const datasets = chosen.map(series => Object.assign(style(series), {
      data: series[x].map((value, k) => ({x: value, y: series[y][k]}))
        .filter(p => p.x !== null && p.y !== null && p.y > 0 && (!logarithmicX || p.x > 0)),
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
        scales: {x: axis(titles[0], logarithmicX), y: axis(titles[1], true)},
        plugins: {tooltip: {callbacks: {label: item => item.dataset.label + ': ' + short(item.parsed.x) + ', ' +
          short(item.parsed.y)}}},
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

  function draw() {
    while (charts.length) charts.pop().destroy();
    Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
    lines('residual-iteration', 'iteration', 'residual', ['Newton iteration', 'force residual'], false, true);
    lines('residual-seconds', 'seconds', 'residual', ['time [s]', 'force residual'], false, true);
    lines('gap-seconds', 'seconds', 'gap', ['time [s]', 'energy above the lowest [J]'], true, false);
    const coarsest = data.series.filter(series => series.level === data.coarsest);
    lines('coarsest-step', 'iteration', 'step', ['Newton iteration', 'Newton step, RMS [m]'], false, false,
      coarsest, methodStyle);
    lines('coarsest-residual', 'iteration', 'residual', ['Newton iteration', 'force residual'], false, true,
      coarsest, methodStyle);
    bars('phases', data.phases, 's');
    bars('parts', data.parts, 'J');
  }

  const theme = document.documentElement.dataset;
  draw();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
  addEventListener('beforeprint', () => { theme.theme = 'light'; draw(); });
  addEventListener('afterprint', () => { delete theme.theme; draw(); });

  const dialog = document.getElementById('enlarged');
  document.querySelectorAll('figure img').forEach(img => img.addEventListener('click', () => {
    dialog.firstElementChild.src = img.src;
    dialog.firstElementChild.alt = img.alt;
    dialog.showModal();
  }));
  dialog.addEventListener('click', () => dialog.close());
})();
