// The report of a small run, opened from disk in a real browser.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {before} from 'node:test';
import {pathToFileURL} from 'node:url';
import {checkWhole, contactConfig, downloaded, drawnShare, newPage, onFirstScreen, openPage, run, scratch, screens, test, until} from './support.mjs';

const folder = scratch(), report = pathToFileURL(path.join(folder, 'out/report.html')).href;

/// With small pictures, which are drawn sooner.
async function writeReport(of) {
  await run(folder, 'report', of, '--width', '225');
}

before(() => run(folder, 'run', contactConfig, '--out', 'out', '--method', 'all', '--quiet',
  '--threads', '1', '--set', 'snapshots=0'));

test('opens without a complaint or a request, on the preview beside its end', async () => {
  const {page, heard, state} = await openPage(report);
  const shown = await state();
  assert.equal(shown.level, 0);
  assert.deepEqual(shown.panels.map(p => [p.method, p.end, p.level, p.vertices]), [['pcs', false, 0, 81], ['pcs', true, 1, 289]]);
  assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
  assert.match(await page.locator('#viewer-rounding').textContent(), /^Positions are rounded to [0-9.]+ µm here/);
  assert.equal(await page.locator('#distance .absent').textContent(), 'No states were recorded in this run (snapshots: 0).');
  await page.locator('#viewer-beside').uncheck();
  for (const k of [1, 2]) await page.locator('#viewer-methods input').nth(k).check();
  await until('three views', async () => (await state()).panels.map(p => p.method).join() === 'pcs,cascadic,newton');
  await page.locator('#viewer-level').fill('1');
  await until('level 1', async () => (await state()).panels.every(p => p.level === 1));
  assert.equal(new Set((await state()).panels.map(p => p.sum)).size, 3);  // each method has its own state
  assert.deepEqual(heard.requests.filter(url => !url.startsWith('data:')), [report]);
});

test('the first screen has the cloth and the time of the preview, wide and narrow, light and dark', async () => {
  for (const screen of screens) {
    const {page} = await openPage(report, screen);
    const {width} = screen.viewport;
    for (const part of ['#viewer-canvas', '.preview-time']) assert.ok(await onFirstScreen(page, part), `${part} at ${width}`);
    assert.match(await page.locator('.sentences li').first().textContent(), /^pcs: preview after [0-9.]+ s, end after [0-9.]+ s, 289 vertices, 0 intersections, at rest to 0.01\.$/);
    assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
    await checkWhole(page, 1);
  }
});

test('the level slider changes the mesh, the colours and the legend follow the choice', async () => {
  const {page, state} = await openPage(report);
  await page.locator('#viewer-beside').uncheck();
  await page.locator('#viewer-level').fill('0');
  await until('level 0', async () => (await state()).panels.every(p => p.level === 0 && p.vertices === 81));
  assert.match(await page.locator('#viewer-level-text').textContent(), /^0, 81 vertices/);
  const fields = await page.locator('#viewer-field option').evaluateAll(all => all.map(o => o.value));
  assert.deepEqual(fields, ['', 'mean_curvature', 'stretch', 'gap', 'contact_pressure', 'H_difference', 'principal_curvature']);
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
  await page.locator('#viewer-obstacles').uncheck();
  await page.locator('#viewer-xray').check();
  assert.ok(await drawnShare(page, '#viewer-canvas') > .02);
  const picture = await downloaded(page, '#viewer-png');
  assert.equal(picture.name, 'contact.png');
  assert.equal(picture.bytes.subarray(1, 4).toString(), 'PNG');

  // The nearest level is taken for one without a state, and the next one by keys.
  await page.evaluate(() => {
    const {data} = window.drapeViewer, spread = levels => levels.map(entry => ({...entry, level: 2 * entry.level}));
    return window.drapeViewer.update({...data, levels: [data.levels[0], data.levels[0], data.levels[1]], methods: data.methods.map(method => ({...method, levels: spread(method.levels)}))});
  });
  const level = n => until('level ' + n, async () => (await state()).panels.every(p => p.level === n));
  await page.locator('#viewer-level').fill('1');
  await level(2);
  await page.locator('#viewer-canvas').focus();
  await page.keyboard.press('PageDown');
  await level(0);
  await page.keyboard.press('PageUp');
  await level(2);
});

test('a schedule has plots of its own', async () => {
  const schedule = '{steps: 4, keys: [{parameter: material.bending_modulus, times: [0, 1], values: [8e4, 8e5]}]}';
  await run(folder, 'run', contactConfig, '--out', 'changing', '--quiet', '--no-report', '--threads', '1', '--set', 'snapshots=0',
    '--method', 'newton', '--set', 'schedule=' + schedule);
  await writeReport('changing');
  const {page} = await openPage(pathToFileURL(path.join(folder, 'changing/report.html')).href);
  await page.evaluate(() => document.querySelectorAll('details').forEach(part => { part.open = true; }));
  for (const plot of ['#increment-energy', '#increment-steps'])
    await until(plot, () => page.evaluate(id => document.querySelectorAll(id + ' .mark').length >= 4, plot));
});

test('the progression plays, snapshots between the levels included', async () => {
  addFrames();
  await writeReport('out');
  const {page, state} = await openPage(report);
  assert.equal((await state()).stops, 5);  // four of level 0, one of level 1
  await page.evaluate(() => {  // in the page, as looking from here could miss one
    const scene = window.drapeViewer.scene, setCloth = scene.setCloth;
    window.shown = [];
    scene.setCloth = (k, shape) => {
      if (k === 0) window.shown.push(window.drapeViewer.stop + ' ' + shape.x[2]);
      setCloth.call(scene, k, shape);
    };
  });
  await page.locator('#viewer-stop').fill('4');
  await until('the last', async () => (await state()).panels[0].level === 1);
  await page.evaluate(() => { window.shown = []; });
  await page.locator('#viewer-play').click();  // from the end it plays from the start
  await until('the end', async () => !(await state()).playing && (await state()).stop === 4);
  const shown = await page.evaluate(() => window.shown);
  assert.deepEqual(shown.map(text => text.split(' ')[0]), ['0', '1', '2', '3', '4']);
  assert.equal(new Set(shown.map(text => text.split(' ')[1])).size, 5);
  await page.locator('#viewer-stop').fill('1');
  await until('a snapshot', async () => (await state()).stop === 1 && (await state()).panels[0].level === 0);
  assert.match(await page.locator('#viewer-labels').textContent(), /7 iterations, 0.700 s/);
});

test('keys and pointer turn all views together', async () => {
  const {page, state} = await openPage(report, {hasTouch: true});
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
  await page.keyboard.press('PageUp');
  await until('the level above', async () => (await state()).panels.every(p => p.level === 1));
  await page.keyboard.press('PageDown');
  await until('the level below', async () => (await state()).panels[0].level === 0);
  await page.keyboard.press('PageUp');
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
  const finer = () => page.evaluate(() => { const {width, clientWidth} = document.getElementById('viewer-canvas'); return width / clientWidth > 1.9; });
  await until('smooth edges at rest', finer);
  assert.equal(await page.evaluate(async () => {
    window.drapeViewer.scene.turn(.1, 0);
    await new Promise(requestAnimationFrame);
    return document.getElementById('viewer-canvas').width / document.getElementById('viewer-canvas').clientWidth > 1.9;
  }), false);
});

test('plots have a line a method, are saved, and follow the choices', async () => {
  await run(folder, 'run', contactConfig, '--out', 'timed', '--quiet', '--no-report', '--threads', '1', '--method', 'all', '--set', 'snapshots=4');
  await writeReport('timed');
  const {page} = await openPage(pathToFileURL(path.join(folder, 'timed/report.html')).href);
  const label = () => page.locator('#distance svg').getAttribute('aria-label');
  // Without a reference the plot opens on the methods' own ends.
  assert.equal(await label(), 'distance, RMS [diagonal] against time [s]: pcs, cascadic, newton');
  assert.equal(await page.locator('#distance-target').inputValue(), 'own');
  const csv = (await downloaded(page, '#distance button:text-is("CSV")')).bytes.toString().split('\n');
  assert.equal(csv[0], 'series,seconds,own_rms,level');
  const levels = method => new Set(csv.filter(row => row.startsWith(method)).map(row => row.split(',')[3]));
  assert.deepEqual([...levels('pcs')], ['0', '1']);
  assert.deepEqual([...levels('newton')], ['1']);  // the direct method's coarse level leads nowhere

  const svg = await downloaded(page, '#distance button:text-is("SVG")');
  assert.equal(svg.name, 'distance.svg');
  const file = path.join(folder, 'distance.svg'), drawn = await newPage();
  fs.writeFileSync(file, svg.bytes);
  await drawn.goto(pathToFileURL(file).href);
  const looks = () => [...document.querySelectorAll('.series')].map(g => [g.querySelector('title').textContent, g.getAttribute('stroke'), g.querySelectorAll('.mark').length]);
  const onPage = await page.evaluate(looks), inFile = await drawn.evaluate(looks);
  assert.deepEqual(inFile.map(([name, , marks]) => [name, marks]), onPage.map(([name, , marks]) => [name, marks]));
  assert.deepEqual(inFile.map(([, colour]) => colour), ['#0072b2', '#d55e00', '#009e73']);
  assert.equal(await drawn.evaluate(() => document.documentElement.localName), 'svg');

  await page.locator('#distance-measure').selectOption('hausdorff');
  assert.match(await label(), /^Hausdorff/);
  await page.locator('#distance .legend > g').nth(1).focus();
  await page.keyboard.press('Enter');
  assert.equal(await page.locator('#distance .series').count(), 2);
  assert.equal(await page.locator('#distance .legend > g').nth(1).getAttribute('aria-pressed'), 'false');
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'cascadic');

  const absent = () => page.locator('#distance .absent').textContent();
  await page.locator('#distance-target').selectOption('reference');
  assert.equal(await absent(), 'No state was compared with the reference.');
  fs.rmSync(path.join(folder, 'timed/errors.csv'));
  await writeReport('timed');
  await page.reload();
  assert.equal(await absent(), 'errors.csv is missing or empty: a run writes it once all its methods have ended.');

  // A logarithmic axis on which fewer than two of 1, 2, 5 times a power of ten lie has the ticks of a linear one.
  fs.writeFileSync(path.join(folder, 'timed/errors.csv'), 'method,level,seconds,iterations,flops,own_rms\npcs,0,1.1,1,1,1.1\npcs,1,1.9,2,2,1.9\n');
  await writeReport('timed');
  await page.reload();
  assert.ok((await page.locator('#distance .grid text').allTextContents()).filter(text => text === '1.4').length === 2);

  fs.writeFileSync(path.join(folder, 'timed/errors.csv'), 'method,level,seconds,own_rms\npcs,0,1.1,1.1\npcs,1,1.9,1.9\n');
  await writeReport('timed');
  await page.reload();
  await page.locator('#distance-cost').selectOption('flops');
  assert.equal(await absent(), 'No state that was compared has its flops of factorisations.');
});

test('a table begins with few columns, sorts by every one and is saved', async () => {
  const {page} = await openPage(report);
  const first = () => page.locator('#methods tbody tr th').first().textContent();
  assert.ok(await page.locator('#methods thead th').count() <= 8);
  const button = page.locator('#methods [data-column="method"] button');
  await button.focus();
  await page.keyboard.press('Enter');
  assert.equal(await first(), 'cascadic');
  await page.keyboard.press('Enter');
  assert.equal(await first(), 'pcs');
  assert.equal(await page.locator('#methods [data-column="method"]').getAttribute('aria-sort'), 'descending');
  await page.locator('#methods summary').click();
  await page.locator('#methods details button').click();
  assert.ok(await page.locator('#methods thead th').count() > 12);
  await page.locator('#methods label:has-text("method")').first().click();
  assert.equal(await page.locator('#methods [data-column="method"]').count(), 0);
  const rows = JSON.parse((await downloaded(page, '#methods button:text-is("JSON")')).bytes);
  assert.deepEqual(rows.map(row => row.method), ['pcs', 'newton', 'cascadic']);
  const results = JSON.parse(fs.readFileSync(path.join(folder, 'out/results.json'))).methods.pcs.levels;
  assert.equal(rows[0].energy_released, results[1].energy_released);
  // Energies that count from the potentials' origin are nowhere.
  await page.evaluate(() => document.querySelectorAll('details').forEach(part => { part.open = true; }));
  await page.locator('#levels details button').click();
  const names = await page.locator('#levels th[data-column]').evaluateAll(all => all.map(th => th.dataset.column));
  assert.ok(names.includes('energy_parts_released.gravity'));
  for (const name of ['energy', 'energy_on_finest', 'energy_parts.gravity']) assert.ok(!names.includes(name), name);
});

test('along the outline of sharp folds nothing is seen of the side that faces away', async () => {
  const {page} = await openPage(report);
  await page.locator('#viewer-obstacles').uncheck();
  const counts = await page.evaluate(async () => {
    const {scene} = window.drapeViewer, n = 100, r = .004, x = new Float32Array(3 * n * n), index = [];
    // A bent ridge across the mesh's lines, with walls that lead down from it.
    for (let i = 0; i < n * n; ++i) {
      const u = (i % n) / n - .5, v = Math.floor(i / n) / n - .5, along = .8 * u + .6 * v, across = .8 * v - .6 * u;
      const turn = Math.max(-1.4, Math.min(1.4, across / r)), wall = across - r * turn;
      x.set([along, r * Math.sin(turn) + wall * Math.cos(turn) + .2 * along * along,
        r * Math.cos(turn) - Math.abs(wall) * Math.sin(1.4) - .5 * along - .3 * along * along], 3 * i);
      if (i % n < n - 1 && i < n * n - n) index.push(i, i + 1, i + n, i + 1, i + n + 1, i + n);
    }
    scene.setViews(1);
    scene.setCloth(0, {x, index: new THREE.BufferAttribute(new Uint32Array(index), 1)});
    scene.cloth.uniforms.front.value.set(0, 1, 0);
    scene.cloth.uniforms.back.value.set(1, 0, 0);
    const canvas = document.createElement('canvas'), pen = canvas.getContext('2d', {willReadFrequently: true}), red = [];
    for (const elevation of [0, .3, .6]) {
      Object.assign(scene.view, {azimuth: 1.3, elevation, distance: 1.5, target: [0, 0, 0]});
      const bitmap = await createImageBitmap(await scene.picture());
      Object.assign(canvas, {width: bitmap.width, height: bitmap.height});
      pen.drawImage(bitmap, 0, 0);
      const pixels = pen.getImageData(canvas.width / 4, 0, canvas.width / 2, canvas.height).data;
      red.push(pixels.filter((value, i) => i % 4 === 0 && value > pixels[i + 1] + 20).length);
    }
    return red;
  });
  assert.ok(counts.every(count => count < 3), counts.join());
});

test('names from the results are texts, never parts of the page', async () => {
  fs.cpSync(path.join(folder, 'out'), path.join(folder, 'evil'), {recursive: true});
  const file = path.join(folder, 'evil/results.json'), evil = '</script><img src=x onerror="window.broken = 1">';
  const results = JSON.parse(fs.readFileSync(file));
  Object.assign(results, {experiment: evil, description: evil, remarks: [evil]});
  results.methods.pcs.levels[0].message = evil;
  results.methods[evil] = results.methods.newton;
  fs.writeFileSync(file, JSON.stringify(results));
  await writeReport('evil');
  const {page} = await openPage(pathToFileURL(path.join(folder, 'evil/report.html')).href);
  assert.equal(await page.locator('h1').textContent(), evil);
  assert.match(await page.locator('#remarks').textContent(), /onerror/);
  assert.equal(await page.evaluate(() => window.broken), undefined);
});

test('printed, and without WebGL', async () => {
  const {page} = await openPage(report, {colorScheme: 'dark', viewport: {width: 400, height: 800}});
  assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await page.emulateMedia({media: 'print'});
  assert.ok(!(await page.locator('#viewer-canvas').isVisible()));
  assert.ok(await page.locator('img.fallback').isVisible());
  // A page without a picture prints a copy of the view.
  await page.emulateMedia({media: 'screen'});
  await page.evaluate(() => {
    window.drapeViewer.picture.remove();
    window.drapeViewer.picture = null;
    dispatchEvent(new Event('beforeprint'));
  });
  await page.emulateMedia({media: 'print'});
  assert.ok(await drawnShare(page, '.fallback canvas') > .05);
  assert.deepEqual(await page.locator('.fallback b').allTextContents(), await page.locator('#viewer-labels b').allTextContents());
  assert.ok(await page.locator('.fallback b').first().isVisible());
  // The screen may be dark again.
  assert.equal(await page.evaluate(() => {
    let drawn = 0;
    window.drapeViewer.scene.draw = () => ++drawn;
    dispatchEvent(new Event('afterprint'));
    return drawn;
  }), 1);
  await page.context().close();

  const bare = await newPage();
  await bare.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
  await bare.goto(report);
  await until('the sentence', async () => (await bare.locator('#viewer-note').textContent()).includes('no WebGL'));
  assert.ok(!(await bare.locator('#viewer-stage').isVisible()));
  assert.ok(await bare.locator('img.fallback').isVisible());
});

/// The report of a copy of the run with other results.
async function edited(name, edit) {
  fs.cpSync(path.join(folder, 'out'), path.join(folder, name), {recursive: true});
  const file = path.join(folder, name, 'results.json'), results = JSON.parse(fs.readFileSync(file));
  edit(results.methods);
  fs.writeFileSync(file, JSON.stringify(results));
  await writeReport(name);
  return openPage(pathToFileURL(path.join(folder, name, 'report.html')).href);
}

test('minutes are written in seconds, without exponents', async () => {
  const {page} = await edited('long', methods => { methods.pcs.levels[0].seconds = 123.4; });
  await until('the label', async () => (await page.locator('#viewer-labels').textContent()).includes('after 123 s'));
});

test('the view begins with the first method that has a state', async () => {
  const {page, state} = await edited('failed', methods =>
    Object.assign(methods.pcs, {status: 'failed', levels: [{level: 0, status: 'failed', message: 'no memory'}], consistency: []}));
  assert.deepEqual((await state()).panels.map(p => [p.method, p.vertices]), [['cascadic', 81], ['cascadic', 289]]);
  assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
});

test('a method that did not finish is described by its last state', async () => {
  const {page} = await edited('aborted', methods => {
    Object.assign(methods.pcs, {status: 'aborted', levels: [methods.pcs.levels[0]], consistency: []});
    methods.cascadic.status = 'failed';
    methods.cascadic.levels[1] = {level: 1, vertices: 289, triangles: 512, status: 'failed', message: 'no memory'};
    delete methods.newton.levels[1].status;
  });
  const said = await page.locator('.sentences li').allTextContents();
  assert.match(said[0], /^pcs: level 0 so far, after [0-9.]+ s, 81 vertices, 0 intersections, at rest to 0.01, then aborted\.$/);
  assert.match(said[1], /^cascadic: preview after [0-9.]+ s, level 0 so far, after [0-9.]+ s, 81 vertices, 0 intersections, at rest to 0.01, then failed\.$/);
  assert.match(said[2], /^newton: .* 289 vertices, 0 intersections, not at rest: unknown status, force residual /);
});

test('a method has its own tolerance, and one that asks for no balance is not called at rest', async () => {
  await run(folder, 'run', contactConfig, '--out', 'own', '--quiet', '--no-report', '--threads', '1', '--method', 'all', '--set', 'snapshots=0',
    '--set', 'methods.newton.newton.force_tolerance=5e-2', '--set', 'methods.cascadic.newton.force_tolerance=1e9');
  await writeReport('own');
  const {page} = await openPage(pathToFileURL(path.join(folder, 'own/report.html')).href);
  const said = await page.locator('.sentences').textContent();
  assert.match(said, /newton: .* at rest to 0\.05\./);
  assert.match(said, /cascadic: [^:]* ended at force residual [0-9.e-]+\./);
});

test('a method with a level that did not converge is neither good nor the best', async () => {
  const {page} = await edited('early', methods => {
    methods.newton.status = methods.newton.levels[1].status = 'max_steps_reached';
    methods.newton.levels[1].seconds = 1e-3;
    methods.newton.consistency[0].distance_rms = 1e-9;
  });
  assert.deepEqual(await page.locator('#methods .status.poor').allTextContents(), ['converged, max steps reached']);
  assert.equal(await page.locator('#methods tr:has(.poor) strong').count(), 0);
  assert.equal(await page.locator('#consistency tbody tr:has-text("newton") strong').count(), 0);
});

test('large values have short ticks', async () => {
  const {page} = await edited('large', methods => { methods.newton.increments = [0, 1].map(time => ({level: 1, time, energy_released: 3e7 * time, steps: 1})); });
  await page.evaluate(() => document.querySelectorAll('details').forEach(part => { part.open = true; }));
  const texts = await until('the plot', async () => { const all = await page.locator('#increment-energy .grid text').allTextContents(); return all.length && all; });
  assert.ok(texts.includes('1e7') && texts.includes('2e7'), texts.join());
});

test('ticks of a narrow range differ', async () => {
  const {page} = await edited('narrow', methods => { methods.newton.increments = [0, 1].map(time => ({level: 1, time, energy_released: 5 + 1e-6 * time, steps: 1})); });
  await page.evaluate(() => document.querySelectorAll('details').forEach(part => { part.open = true; }));
  const texts = await until('the plot', async () => { const all = await page.locator('#increment-energy .grid text').allTextContents(); return all.length && all; });
  assert.ok(texts.includes('5.0000002') && texts.includes('5.0000004'), texts.join());
});

test('dashes tell methods of one solver apart, the width of a line its level', async () => {
  const {page} = await edited('alike', methods => { methods.cascadic.solver = methods.newton.solver; });
  await page.evaluate(() => document.querySelectorAll('details').forEach(part => { part.open = true; }));
  const looks = () => page.locator('#convergence .series').evaluateAll(all => Object.fromEntries(all.map(g =>
    [g.querySelector('title').textContent, [g.getAttribute('stroke'), g.querySelector('.line')?.getAttribute('stroke-dasharray'), g.getAttribute('stroke-width')]])));
  const of = await until('the lines', async () => { const all = await looks(); return all['newton, level 1'] && all['cascadic, level 1'] && all; });
  const [colour, dash, width] = of['newton, level 1'];
  assert.deepEqual([of['newton, level 0'][0], of['newton, level 0'][1]], [colour, dash]);
  assert.ok(Number(of['newton, level 0'][2]) < Number(width));
  assert.deepEqual([of['cascadic, level 1'][0], of['cascadic, level 1'][2]], [colour, width]);
  assert.notEqual(of['cascadic, level 1'][1], dash);
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
