// The plots, tables and words of the report of a small run, opened from disk in a real browser.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {edited, folder, openReport, report, runContact} from './contact_report.mjs';
import {addressOf, downloaded, jsonIn, newPage, openPage, savedRows, test, textOf, unfold, until} from './support.mjs';

test('a schedule has plots of its own', async () => {
  await runContact('changing', '--no-report', '--set', 'snapshots=0', '--method', 'newton', '--set',
    'schedule={steps: 4, keys: [{parameter: material.bending_modulus, times: [0, 1], values: [8e4, 8e5]}]}');
  const {page} = await openReport('changing');
  await unfold(page);
  for (const plot of ['#increment-energy', '#increment-steps'])
    await until(plot, async () => await page.locator(plot + ' .mark').count() >= 4);
});

test('plots have a line a method, are saved, and follow the choices', async () => {
  await runContact('timed', '--no-report', '--method', 'all', '--set', 'snapshots=4');
  const {page} = await openReport('timed');
  const label = () => page.locator('#distance svg').getAttribute('aria-label');
  // Without a reference the plot opens on the methods' own ends.
  assert.equal(await label(), 'distance, RMS [diagonal] against time [s]: pcs, cascadic, newton');
  assert.equal(await page.locator('#distance-target').inputValue(), 'own');
  const csv = (await downloaded(page, '#distance button:text-is("CSV")')).bytes.toString().split('\n');
  assert.equal(csv[0], 'series,seconds,own_rms,level');
  const levels = method => [...new Set(csv.filter(row => row.startsWith(method)).map(row => row.split(',')[3]))];
  assert.deepEqual(levels('pcs'), ['0', '1']);
  assert.deepEqual(levels('newton'), ['1']);  // the direct method's coarse level leads nowhere

  const svg = await downloaded(page, '#distance button:text-is("SVG")'), drawn = await newPage();
  assert.equal(svg.name, 'distance.svg');
  fs.writeFileSync(path.join(folder, 'distance.svg'), svg.bytes);
  await drawn.goto(addressOf(folder, 'distance.svg'));
  const looks = of => of.evaluate(() => [...document.querySelectorAll('.series')].map(g =>
    ({name: g.querySelector('title').textContent, colour: g.getAttribute('stroke'), marks: g.querySelectorAll('.mark').length})));
  const inFile = await looks(drawn), marks = all => all.map(line => [line.name, line.marks]);
  assert.deepEqual(marks(inFile), marks(await looks(page)));
  assert.deepEqual(inFile.map(line => line.colour), ['#0072b2', '#d55e00', '#009e73']);
  assert.equal(await drawn.evaluate(() => document.documentElement.localName), 'svg');

  await page.locator('#distance-measure').selectOption('hausdorff');
  assert.match(await label(), /^Hausdorff/);
  const legend = page.locator('#distance .legend > g').nth(1);
  await legend.focus();
  await page.keyboard.press('Enter');
  assert.equal(await page.locator('#distance .series').count(), 2);
  assert.equal(await legend.getAttribute('aria-pressed'), 'false');
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'cascadic');

  const absent = of => textOf(of, '#distance .absent'), errors = path.join(folder, 'timed/errors.csv');
  await page.locator('#distance-target').selectOption('reference');
  assert.equal(await absent(page), 'No state was compared with the reference.');
  fs.rmSync(errors);
  assert.equal(await absent((await openReport('timed')).page),
    'errors.csv is missing or empty: a run writes it once all its methods have ended.');
  // A logarithmic axis on which fewer than two of 1, 2, 5 times a power of ten lie has the ticks of a linear one.
  fs.writeFileSync(errors, 'method,level,seconds,own_rms\npcs,0,1.1,1.1\npcs,1,1.9,1.9\n');
  const few = (await openReport('timed')).page;
  assert.equal((await few.locator('#distance .grid text').allTextContents()).filter(text => text === '1.4').length, 2);
  await few.locator('#distance-cost').selectOption('flops');
  assert.equal(await absent(few), 'No state that was compared has its flops of factorisations.');
});

test('a table begins with few columns, sorts by every one and is saved', async () => {
  const {page} = await openPage(report);
  const first = () => page.locator('#methods tbody tr th').first().textContent();
  const column = page.locator('#methods [data-column="method"]'), headers = page.locator('#methods thead th');
  assert.ok(await headers.count() <= 8);
  await column.locator('button').focus();
  for (const method of ['cascadic', 'pcs']) {
    await page.keyboard.press('Enter');
    assert.equal(await first(), method);
  }
  assert.equal(await column.getAttribute('aria-sort'), 'descending');
  await page.locator('#methods summary').click();
  await page.locator('#methods details button').click();
  assert.ok(await headers.count() > 12);
  await page.locator('#methods label:has-text("method")').first().click();
  assert.equal(await column.count(), 0);
  const rows = await savedRows(page, '#methods');
  assert.deepEqual(rows.map(row => row.method), ['pcs', 'newton', 'cascadic']);
  assert.equal(rows[0].energy_released, jsonIn(folder, 'out/results.json').methods.pcs.levels[1].energy_released);
  // Energies that count from the potentials' origin are nowhere.
  await unfold(page);
  await page.locator('#levels details button').click();
  const names = await page.locator('#levels th[data-column]').evaluateAll(all => all.map(th => th.dataset.column));
  assert.ok(names.includes('energy_parts_released.gravity'));
  for (const name of ['energy', 'energy_on_finest', 'energy_parts.gravity']) assert.ok(!names.includes(name), name);
});

test('a garment is told by piece first, as it is at the end', async () => {
  const pieces = level => ['front', 'back'].map((piece, k) => ({piece, stretch_warp: level + k, ease: 5}));
  const {page} = await edited('garment', ({pcs}) => pcs.levels.forEach(level => { level.pieces = pieces(level.level); }));
  assert.equal(await page.locator('#page > section').nth(1).getAttribute('id'), 'garment');
  assert.ok(await page.locator('#pieces tbody').isVisible());
  assert.deepEqual((await savedRows(page, '#pieces')).map(row => [row.level, row.piece, row.stretch_warp]), [[1, 'front', 1], [1, 'back', 2]]);
  await page.locator('#garment > details > summary').click();
  assert.deepEqual((await savedRows(page, '#pieces-of-levels')).map(row => row.level), [0, 0, 1, 1]);
  assert.equal(await (await openReport('out')).page.locator('#garment').count(), 0);
});

test('names from the results are texts, never parts of the page', async () => {
  const evil = '</script><img src=x onerror="window.broken = 1">';
  const {page} = await edited('evil', (methods, results) => {
    Object.assign(results, {experiment: evil, description: evil, remarks: [evil]});
    methods.pcs.levels[0].message = evil;
    methods[evil] = methods.newton;
  });
  assert.equal(await textOf(page, 'h1'), evil);
  assert.match(await textOf(page, '#remarks'), /onerror/);
  assert.equal(await page.evaluate(() => window.broken), undefined);
});

test('a method that did not finish is described by its last state', async () => {
  const {page} = await edited('aborted', ({pcs, cascadic, newton}) => {
    Object.assign(pcs, {status: 'aborted', levels: [pcs.levels[0]], consistency: []});
    cascadic.status = 'failed';
    cascadic.levels[1] = {level: 1, vertices: 289, triangles: 512, status: 'failed', message: 'no memory'};
    delete newton.levels[1].status;
  });
  const said = await page.locator('.sentences li').allTextContents();
  const soFar = 'level 0 so far, after [0-9.]+ s, 81 vertices, 0 intersections, at rest: unbalanced force below 1 % of the load, stable, then';
  assert.match(said[0], new RegExp(`^pcs: ${soFar} aborted\\.$`));
  assert.match(said[1], new RegExp(`^cascadic: preview after [0-9.]+ s, ${soFar} failed\\.$`));
  assert.match(said[2], /^newton: .* 289 vertices, 0 intersections, not at rest: unknown status, force residual /);
});

test('a method has its own tolerance, and one that asks for no balance is not called at rest', async () => {
  await runContact('own', '--no-report', '--method', 'all', '--set', 'snapshots=0',
    '--set', 'methods.newton.newton.force_tolerance=5e-2', '--set', 'methods.cascadic.newton.force_tolerance=1e9');
  const said = await textOf((await openReport('own')).page, '.sentences');
  assert.match(said, /newton: .* at rest: unbalanced force below 5 % of the load, stable\./);
  assert.match(said, /cascadic: [^:]* ended at force residual [0-9.e-]+\./);
});

test('a method with a level that did not converge is neither good nor the best', async () => {
  const {page} = await edited('early', ({newton}) => {
    newton.status = newton.levels[1].status = 'max_steps_reached';
    newton.levels[1].seconds = 1e-3;
    newton.consistency[0].distance_rms = 1e-9;
  });
  assert.deepEqual(await page.locator('#methods .status.poor').allTextContents(), ['converged, max steps reached']);
  for (const best of ['#methods tr:has(.poor) strong', '#consistency tbody tr:has-text("newton") strong'])
    assert.equal(await page.locator(best).count(), 0);
});

test('ticks of large values are short, and those of a narrow range differ', async () => {
  for (const [energyAt, ticks] of [[time => 3e7 * time, ['1e7', '2e7']], [time => 5 + 1e-6 * time, ['5.0000002', '5.0000004']]]) {
    const {page} = await edited('ticks', ({newton}) => {
      newton.increments = [0, 1].map(time => ({level: 1, time, energy_released: energyAt(time), steps: 1}));
    });
    await unfold(page);
    const labels = page.locator('#increment-energy .grid text');
    await until('the plot', () => labels.count());
    const texts = await labels.allTextContents();
    assert.ok(ticks.every(tick => texts.includes(tick)), texts.join());
  }
});

test('dashes tell methods of one solver apart, the width of a line its level', async () => {
  const {page} = await edited('alike', ({cascadic, newton}) => { cascadic.solver = newton.solver; });
  await unfold(page);
  const looks = () => page.locator('#convergence .series').evaluateAll(all => Object.fromEntries(all.map(g =>
    [g.querySelector('title').textContent, {colour: g.getAttribute('stroke'),
      dash: g.querySelector('.line')?.getAttribute('stroke-dasharray'), width: Number(g.getAttribute('stroke-width'))}])));
  const [coarse, fine, other] = await until('the lines', async () => {
    const all = await looks(), lines = ['newton, level 0', 'newton, level 1', 'cascadic, level 1'].map(name => all[name]);
    return lines.every(Boolean) && lines;
  });
  assert.deepEqual([coarse.colour, coarse.dash], [fine.colour, fine.dash]);
  assert.ok(coarse.width < fine.width);
  assert.deepEqual([other.colour, other.width], [fine.colour, fine.width]);
  assert.notEqual(other.dash, fine.dash);
});
