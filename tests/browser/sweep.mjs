// The page of a sweep of 24 runs, and of several runs, in a real browser.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {before} from 'node:test';
import {addressOf, checkWhole, contactConfig, downloaded, drawnShare, jsonIn, listenTo, newPage, onFirstScreen, run, savedRows,
  scratch, screens, source, test, textOf, unfold, until} from './support.mjs';

const folder = scratch();

before(async () => {
  await run(folder, 'sweep', path.join(source, 'tests/sweep/small_sweep.yaml'), '-o', 'sweep');
  await run(folder, 'report', 'sweep');
});

async function open(name, options = {}) {
  const page = await newPage({viewport: {width: 1200, height: 800}, ...options});
  listenTo(page);
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable', {timeDomain: 'threadTicks'});
  await page.goto(addressOf(folder, name));
  /// What the page's thread has worked since it was opened [s].
  const work = async () =>
    (await session.send('Performance.getMetrics')).metrics.find(metric => metric.name === 'TaskDuration').value;
  return {page, work};
}

test('24 runs fit one screen of thumbnails, a cell has all starts, and nothing scrolls sideways', async () => {
  assert.ok(fs.statSync(path.join(folder, 'sweep/report.html')).size < 8e6);
  for (const screen of screens) {
    const {page, work} = await open('sweep/report.html', screen);
    assert.equal(await page.locator('.tile img').count(), 8);
    assert.match(await page.locator('.tile').first().getAttribute('title'), /: 3 of 3 starts converged, [-0-9.e]+ … [-0-9.e]+ over 3 starts$/);
    assert.ok(await work() < 2, `${await work()} s`);
    assert.ok(await onFirstScreen(page, '#matrix'), `at ${screen.viewport.width}`);
    assert.ok(await drawnShare(page, '#matrix') > .1);
    assert.equal(await textOf(page, '#counts'), '24 runs of 8 variations: 24 converged.');
    await checkWhole(page, 2);
  }
});

test('the table of a sweep of three keys fits a screen of 1440 pixels with its last column', async () => {
  const {page} = await open('sweep/report.html', {viewport: {width: 1440, height: 900}});
  const widths = await page.locator('#table .scroll').evaluate(frame => [frame.scrollWidth, frame.clientWidth]);
  assert.ok(widths[0] <= widths[1], widths.join(' of '));
  assert.equal(await page.locator('#table thead th').last().getAttribute('data-column'), 'force_residual');
});

test('a thumbnail opens the run in 3D', async () => {
  const {page} = await open('sweep/report.html');
  await page.locator('.tile[title*="levels 2"]').first().click();  // one level has no preview
  await until('its 3D view', () => page.evaluate(() => window.drapeViewer?.panels.length === 2));
  assert.match(await textOf(page, '#viewer-labels'), /pcs, preview.*pcs, end/s);
});

test('a page alone says what is better beyond starts, what the reference was and whether the machine was busy', async () => {
  for (const seed of [1, 2, 3]) {
    const file = path.join(folder, `sweep/runs/refiner=loop,levels=2,step_growth=3/seed_${seed}/results.json`), results = JSON.parse(fs.readFileSync(file));
    for (const [name, seconds] of [['pcs', 1e-5 * seed], ['newton', seed]])
      for (const level of results.methods[name].levels) Object.assign(level, {seconds, cpu_seconds: seconds / 2, load_before: 99, load_after: 99});
    fs.writeFileSync(file, JSON.stringify(results));
  }
  await run(folder, 'report', 'sweep', '-o', 'busy.html');
  const {page} = await open('busy.html');
  assert.match(await textOf(page, '#busy'), /^The machine was busy during [0-9]+ of 48 timings/);
  assert.match(await textOf(page, '#bold'), /^Bold: /);
  assert.match(await textOf(page, '#references'), /newton in 24 of 24 runs/);
  await page.locator('#filter').fill('refiner=loop levels=2 step_growth=3');
  const cell = method => page.locator(`#table tr:has(td:text-is("${method}"))`);
  assert.equal(await cell('newton').locator('[data-name^="end from the reference"]').textContent(), 'reference');
  const fast = await cell('pcs').locator('[data-name="time [s]"]').textContent();
  assert.match(fast, /^4\.00e-52\.00e-5\s… 6\.00e-5$/);
  assert.equal(await page.locator('#table [data-name="time [s]"] strong').count(), 1);
});

test('a value is shown against a parameter: medians, with ranges over starts', async () => {
  const {page} = await open('sweep/report.html');
  await page.locator('#quantity').selectOption('iterations');
  await page.locator('#parameter-key').selectOption('levels');
  assert.match(await page.locator('#parameter svg').getAttribute('aria-label'), /^Newton iterations against levels: pcs, refiner loop/);
  const rows = await savedRows(page, '#parameter');
  assert.equal(rows.length, 16);  // two methods, eight variations
  const runs = path.join(folder, 'sweep/runs/refiner=loop,levels=1,step_growth=1.5');
  const iterations = [1, 2, 3].map(seed => jsonIn(runs, `seed_${seed}/results.json`).methods.pcs.levels[0].iterations)
    .sort((a, b) => a - b);
  const row = rows.find(each => each.series === 'pcs, refiner loop, step growth 1.5' && each.levels === 1);
  assert.deepEqual([row.low, row.iterations, row.high, row.runs], [...iterations, 3]);
  assert.match(await page.locator('.tile .value').first().textContent(), new RegExp(`^(${iterations.join('|')})$`));
});

test('distance against time is the median over starts at equal cost, between the lowest and the highest', async () => {
  const {page} = await open('sweep/report.html');
  await unfold(page);
  await page.locator('#errors-cost').selectOption('iterations');
  const rows = await savedRows(page, '#errors');
  const name = 'refiner=loop,levels=2,step_growth=1.5', curve = rows.filter(row => row.series === name + ', pcs');
  assert.equal(curve.length, 40);
  curve.forEach((point, k) => {
    assert.equal(point.runs, 3);
    assert.ok(point.low <= point.reference_rms && point.reference_rms <= point.high);
    assert.ok(k === 0 || point.iterations > curve[k - 1].iterations);
  });
  // It ends where the last of the three starts does.
  const errors = seed => fs.readFileSync(path.join(folder, `sweep/runs/${name}/seed_${seed}/errors.csv`), 'utf8').split('\n');
  const ends = [1, 2, 3].map(seed => Number(errors(seed).findLast(line => line.startsWith('pcs,')).split(',')[4]));
  assert.equal(curve.at(-1).iterations, Math.max(...ends));
});

test('two sweeps stay apart, and what has no results is found by its status', async () => {
  fs.cpSync(path.join(folder, 'sweep'), path.join(folder, 'again'), {recursive: true});
  const sweep = jsonIn(folder, 'again/sweep.json');
  Object.assign(sweep.runs[0], {status: 'failed', exit_code: 124});
  fs.writeFileSync(path.join(folder, 'again/sweep.json'), JSON.stringify({...sweep, sweep: 'again'}));
  await run(folder, 'report', 'sweep', 'again', '-o', 'both.html');
  const {page} = await open('both.html');
  const rows = await savedRows(page, '#parameter');
  assert.ok(rows.length > 0 && rows.every(row => row.runs <= 3));
  await page.locator('#filter').fill('status=timeout');
  assert.equal(await textOf(page, '#matching'), '1 of 48 runs');
});

test('plots keep their height above a long legend, and tables their chooser of columns', async () => {
  const {page} = await open('sweep/report.html', screens[1]);
  await unfold(page);
  const grid = page.locator('#errors .grid line');
  await until('the plot', () => grid.count());
  assert.ok(await grid.evaluateAll(all => Math.max(...all.map(l => l.y2.baseVal.value - l.y1.baseVal.value))) > 150);
  await page.locator('#table details button').click();
  await page.locator('#filter').fill('pcs');
  assert.equal(await page.locator('#table summary').count(), 1);
});

test('the table sorts and filters, by medians or by run, and compares within one physics only', async () => {
  const {page} = await open('sweep/report.html');
  const rows = page.locator('#table tbody tr'), parameter = page.locator('#parameter .series');
  assert.equal(await rows.count(), 16);
  const lines = (await downloaded(page, '#table button:text-is("CSV")')).bytes.toString().trim().split('\n');
  assert.equal(new Set(lines.map(line => line.replace(/"[^"]*"/g, '').split(',').length)).size, 1);
  await page.locator('#medians').uncheck();
  assert.equal(await rows.count(), 48);
  const shows = async (filter, runs, tiles, count) => {
    await page.locator('#filter').fill(filter);
    assert.deepEqual([await page.locator('.tile').count(), await rows.count()], [tiles, count]);
    assert.equal(await textOf(page, '#matching'), `${runs} of 24 runs`);
  };
  await shows('levels>=2 seed!=3 method=pcs', 8, 4, 8);
  assert.match(await page.locator('#parameter svg').getAttribute('aria-label'),
    /: pcs, levels 2, step growth 1.5, pcs, levels 2, step growth 3$/);
  // A colour is a solver's; variations are paler. No line joins what is no number.
  for (const [attribute, kinds] of [['stroke', 1], ['opacity', 2]])
    assert.equal(new Set(await parameter.evaluateAll((all, name) => all.map(line => line.getAttribute(name)), attribute)).size, kinds);
  assert.equal(await parameter.locator('.line').count(), 0);
  await shows('^lo+p$ step_growth=3 levels=1', 3, 1, 6);
  await shows('preview_seconds<100 levels=1', 0, 0, 0);  // which have no preview
  await shows('(unfinished', 0, 0, 0);
  await shows('midpoint newton', 12, 4, 12);
  const seconds = async () => (await page.locator('#table td[data-name="time [s]"]').allTextContents()).map(Number);
  await page.locator('#table [data-column="seconds"] button').click();
  const sorted = await seconds();
  assert.deepEqual(sorted, [...sorted].sort((a, b) => a - b));
  await page.locator('#table [data-column="seconds"] button').click();
  assert.deepEqual(await seconds(), [...sorted].reverse());
  const saved = await savedRows(page, '#table');
  assert.deepEqual(saved.map(row => row.method), Array(12).fill('newton'));
  assert.ok(saved.every(row => row.refiner === 'midpoint' && Number.isInteger(row.seed) && Number.isInteger(row.levels)));

  // Of two runs with other energies neither is the best.
  for (const [name, modulus] of [['soft', '1e4'], ['stiff', '1e6']])
    await run(folder, 'run', contactConfig, '--quiet', '--no-report', '--threads', '1', '--set', 'snapshots=0', '-o', name,
      '--set', 'newton.force_tolerance=0.1', '--set', 'material.bending_modulus=' + modulus);
  await run(folder, 'report', 'soft', 'stiff', '-o', 'two.html');
  const two = await open('two.html');
  assert.equal(await two.page.locator('#table tbody tr').count(), 2);
  assert.equal(await two.page.locator('#table strong').count(), 0);
});
