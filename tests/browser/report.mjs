// The report of a small run, opened from disk in a real browser.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {before} from 'node:test';
import {pathToFileURL} from 'node:url';
import {contactConfig, drawnShare, guarded, newPage, openPage, run, scratch, test, until} from './support.mjs';

const folder = scratch(), report = pathToFileURL(path.join(folder, 'out/report.html')).href;

/// With small pictures, which are drawn sooner.
async function writeReport(of) {
  await run(folder, 'report', of, '--width', '225');
}

before(() => guarded('the run that is reported', () => run(folder, 'run', contactConfig, '--out', 'out', '--method', 'all', '--quiet',
  '--threads', '1', '--set', 'snapshots=0')));

test('opens without a complaint or a request, and draws', async () => {
  const {page, heard, state} = await openPage(report);
  const shown = await state();
  assert.equal(shown.level, 1);
  assert.deepEqual(shown.panels.map(p => p.method), ['pcs', 'cascadic', 'newton']);
  assert.deepEqual(shown.panels.map(p => p.vertices), [289, 289, 289]);
  assert.equal(new Set(shown.panels.map(p => p.sum)).size, 3);  // each method has its own state
  assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
  assert.match(await page.locator('#viewer-rounding').textContent(), /^Positions are rounded to [0-9.]+ µm here/);
  assert.deepEqual(heard.errors, []);
  assert.deepEqual(heard.requests.filter(url => !url.startsWith('data:')), [report]);
  assert.ok(fs.statSync(path.join(folder, 'out/report.html')).size < 8e6);
});

test('the level slider changes the mesh, the colours and the legend follow the choice', async () => {
  const {page, heard, state} = await openPage(report);
  await page.locator('#viewer-level').fill('0');
  await until('level 0', async () => (await state()).panels.every(p => p.level === 0 && p.vertices === 81));
  assert.match(await page.locator('#viewer-level-text').textContent(), /^0, 81 vertices/);
  const fields = await page.locator('#viewer-field option').evaluateAll(all => all.map(o => o.value));
  assert.deepEqual(fields, ['', 'mean_curvature', 'stretch', 'gap', 'H_difference']);
  const seen = new Set();
  for (const field of fields.slice(1)) {
    await page.locator('#viewer-field').selectOption(field);
    await until(field, async () => (await state()).panels.every(p => p.tints > 0 && !seen.has(p.tints)));
    seen.add((await state()).panels[0].tints);
    assert.ok(await page.locator('#viewer-legend').isVisible());
  }
  await page.locator('#viewer-field').selectOption('gap');
  assert.match(await page.locator('#viewer-legend').textContent(), /^0.* m.*distance to an obstacle/s);
  await page.locator('#viewer-field').selectOption('');
  await until('no tint', async () => (await state()).panels.every(p => p.tints === null));
  assert.ok(!(await page.locator('#viewer-legend').isVisible()));
  await page.locator('#viewer-methods input').nth(1).uncheck();
  await until('two views', async () => (await state()).panels.map(p => p.method).join() === 'pcs,newton');
  assert.deepEqual(heard.errors, []);
});

test('a schedule has plots of its own', async () => {
  const schedule = '{steps: 4, keys: [{parameter: material.bending_modulus, times: [0, 1], values: [8e4, 8e5]}]}';
  await run(folder, 'run', contactConfig, '--out', 'changing', '--quiet', '--no-report', '--threads', '1', '--set', 'snapshots=0',
    '--method', 'newton', '--set', 'schedule=' + schedule);
  await writeReport('changing');
  const {page, heard} = await openPage(pathToFileURL(path.join(folder, 'changing/report.html')).href);
  for (const plot of ['#increment-energy', '#increment-steps']) assert.ok(await drawnShare(page, plot) > .01, plot);
  assert.deepEqual(heard.errors, []);
});

test('the progression plays, snapshots between the levels included', async () => {
  addFrames();
  await writeReport('out');
  const {page, heard, state} = await openPage(report);
  assert.equal((await state()).stops, 5);  // four of level 0, one of level 1
  await page.evaluate(() => {  // in the page, as looking from here could miss one
    const scene = window.drapeViewer.scene, setCloth = scene.setCloth;
    window.shown = [];
    scene.setCloth = (k, shape) => {
      if (k === 0) window.shown.push(window.drapeViewer.stop + ' ' + shape.x[2]);
      setCloth.call(scene, k, shape);
    };
  });
  await page.locator('#viewer-play').click();
  await until('the end', async () => !(await state()).playing && (await state()).stop === 4);
  const shown = await page.evaluate(() => window.shown);
  assert.deepEqual(shown.map(text => text.split(' ')[0]), ['0', '1', '2', '3', '4']);
  assert.equal(new Set(shown.map(text => text.split(' ')[1])).size, 5);
  await page.locator('#viewer-stop').fill('1');
  await until('a snapshot', async () => (await state()).stop === 1 && (await state()).panels[0].level === 0);
  assert.match(await page.locator('#viewer-labels').textContent(), /7 iterations, 0.700 s/);
  assert.deepEqual(heard.errors, []);
});

test('keys and pointer turn all views together', async () => {
  const {page, heard, state} = await openPage(report, {hasTouch: true});
  const home = (await state()).camera;
  await page.locator('#viewer-canvas').focus();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('+');
  await page.keyboard.press('Shift+ArrowRight');
  const turned = (await state()).camera;
  for (const name of ['azimuth', 'elevation', 'distance']) assert.notEqual(turned[name], home[name]);
  assert.notDeepEqual(turned.target, home.target);
  await page.keyboard.press('0');
  assert.deepEqual((await state()).camera, home);
  await page.keyboard.press('PageDown');
  await until('the level below', async () => (await state()).panels.every(p => p.level === 0));
  await page.keyboard.press('PageUp');  // from the end it plays from the start
  // Noted in the page: it may have played to the end before it is asked.
  await page.evaluate(() => window.addEventListener('keydown', () => { window.plays = window.drapeViewer.state().playing; }));
  const playsAfterSpace = async () => {
    await page.keyboard.press(' ');
    return page.evaluate(() => window.plays);
  };
  assert.equal(await playsAfterSpace(), true);
  await until('it stands still', async () => !await playsAfterSpace());
  const box = await page.locator('#viewer-canvas').boundingBox();
  await page.mouse.move(box.x + 200, box.y + 150);
  await page.mouse.down();
  await page.mouse.move(box.x + 300, box.y + 150);
  await page.mouse.up();
  assert.notEqual((await state()).camera.azimuth, home.azimuth);
  await page.mouse.wheel(0, 100);
  assert.ok((await state()).camera.distance > home.distance);
  assert.deepEqual(heard.errors, []);
});

/// Entries of a plot's legend.
const legendOf = (page, id) => page.evaluate(name => Chart.getChart(name).legend.legendItems.map(item => item.text), id);

/// Heads of the tables that are shown and wider than the page.
const wideTables = page => page.evaluate(() => [...document.querySelectorAll('.scroll')]
  .filter(frame => frame.scrollWidth > frame.clientWidth).map(frame => frame.querySelector('thead').textContent));

test('opens on fine energy and distance over time, a line a method, and no table is wider than the page', async () => {
  await run(folder, 'run', contactConfig, '--out', 'timed', '--quiet', '--no-report', '--threads', '1', '--method', 'all', '--set', 'snapshots=4');
  await writeReport('timed');
  const timed = pathToFileURL(path.join(folder, 'timed/report.html')).href;
  const {page, heard} = await openPage(timed);
  const methods = ['pcs', 'cascadic', 'newton'];
  for (const id of ['fine-energy', 'errors']) {
    assert.deepEqual(await legendOf(page, id), methods);
    assert.ok(await drawnShare(page, '#' + id) > .01, id);
    const titles = await page.evaluate(name => ['x', 'y'].map(k => Chart.getChart(name).options.scales[k].title.text), id);
    assert.deepEqual(titles, ['time [s]', id === 'errors' ? 'distance, RMS [diagonal]' : 'energy gap, over the energy released']);
    const levels = await page.evaluate(name => Chart.getChart(name).data.datasets.map(set =>
      [...new Set(set.data.map(point => point.level))].join()), id);
    assert.ok(levels[0].startsWith('0') && levels[1].startsWith('0'), levels.join('; '));
    assert.equal(levels[2], '1');  // the direct method's coarse level leads nowhere
  }
  // Without a reference the plots open on the methods' own ends.
  assert.equal(await page.locator('#error-target').inputValue(), 'own');
  await page.locator('#error-measure').selectOption('hausdorff');
  assert.match(await page.evaluate(() => Chart.getChart('errors').options.scales.y.title.text), /^Hausdorff/);
  for (const width of [1200, 700, 360]) {
    await page.setViewportSize({width, height: 900});
    await page.evaluate(() => document.querySelectorAll('details').forEach(part => { part.open = true; }));
    await until('tables fit ' + width, async () => (await wideTables(page)).length === 0);
    if (width === 1200) assert.equal(await page.locator('.stacked').count(), 0);
  }
  assert.ok(await page.locator('.stacked').count() > 0);  // the last width is too narrow for rows
  assert.deepEqual(heard.errors, []);
  await page.context().close();

  // More methods than a legend has entries.
  const file = path.join(folder, 'timed/results.json'), results = JSON.parse(fs.readFileSync(file));
  const errors = path.join(folder, 'timed/errors.csv'), rows = fs.readFileSync(errors, 'utf8');
  let more = rows;
  for (let k = 0; k < 5; ++k) {
    results.methods['cascadic' + k] = results.methods.cascadic;
    more += rows.split('\n').filter(row => row.startsWith('cascadic,')).map(row => row.replace('cascadic', 'cascadic' + k) + '\n').join('');
  }
  fs.writeFileSync(file, JSON.stringify(results));
  fs.writeFileSync(errors, more);
  await writeReport('timed');
  const crowded = await openPage(timed);
  assert.deepEqual(await legendOf(crowded.page, 'errors'), [...methods, 'cascadic0', 'cascadic1', '3 more']);
  assert.deepEqual(crowded.heard.errors, []);
  await crowded.page.context().close();
});

test('dark, narrow, printed, and without WebGL', async () => {
  const {page, heard} = await openPage(report, {colorScheme: 'dark', viewport: {width: 400, height: 800}});
  assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await page.emulateMedia({media: 'print'});
  assert.ok(!(await page.locator('#in-3d').isVisible()));
  assert.ok(await page.locator('#states img').first().isVisible());
  assert.deepEqual(heard.errors, []);
  await page.context().close();

  const bare = await newPage();
  await bare.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
  await bare.goto(report);
  await bare.locator('#viewer').scrollIntoViewIfNeeded();
  await until('the sentence', async () => (await bare.locator('#viewer-note').textContent()).includes('no WebGL'));
  assert.ok(!(await bare.locator('#viewer-stage').isVisible()));
});

/// Writes four snapshots of pcs's level 0 into the run, as a recorded run has them: the sheet sinking to its last state.
function addFrames() {
  const ply = fs.readFileSync(path.join(folder, 'out/levels/pcs_l0.ply')), marker = 'end_header\n';
  const begin = ply.indexOf(marker) + marker.length, count = 81, snapshots = Buffer.alloc(4 * count * 12);
  for (let k = 0; k < 4; ++k) {
    for (let i = 0; i < 3 * count; ++i) {
      const lift = i % 3 === 2 ? .03 * (3 - k) : 0;
      snapshots.writeFloatLE(ply.readDoubleLE(begin + 8 * i) + lift, 4 * (3 * count * k + i));
    }
  }
  fs.mkdirSync(path.join(folder, 'out/snapshots'), {recursive: true});
  fs.writeFileSync(path.join(folder, 'out/snapshots/pcs_l0.bin'), snapshots);
  const file = path.join(folder, 'out/results.json'), results = JSON.parse(fs.readFileSync(file));
  results.methods.pcs.levels[0].snapshots = {file: 'snapshots/pcs_l0.bin', iterations: [1, 7, 15, 22], seconds: [.1, .7, 1.5, 2.2]};
  fs.writeFileSync(file, JSON.stringify(results));
}
