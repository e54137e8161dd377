// The 3D view of the report of a small run, opened from disk in a real browser.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {changeResults, edited, folder, openReport, report} from './contact_report.mjs';
import {addressOf, checkWhole, downloaded, drawnShare, newPage, onFirstScreen, openPage, run, screens, source, test, textOf, until} from './support.mjs';

test('opens without a complaint or a request, on the preview beside its end', async () => {
  const {page, heard, state} = await openPage(report);
  const shown = await state();
  assert.equal(shown.level, 0);
  assert.deepEqual(shown.panels.map(p => [p.method, p.end, p.level, p.vertices]), [['pcs', false, 0, 81], ['pcs', true, 1, 289]]);
  assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
  assert.match(await textOf(page, '#viewer-rounding'), /^Positions are rounded to [0-9.]+ µm here/);
  assert.equal(await textOf(page, '#distance .absent'), 'No states were recorded in this run (snapshots: 0).');
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
    for (const part of ['#viewer-canvas', '.preview-time'])
      assert.ok(await onFirstScreen(page, part), `${part} at ${screen.viewport.width}`);
    assert.match(await page.locator('.sentences li').first().textContent(),
      /^pcs: preview after [0-9.]+ s, end after [0-9.]+ s, 289 vertices, 0 intersections, at rest: unbalanced force below 1 % of the load, stable\.$/);
    assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
    await checkWhole(page, 1);
  }
});

test('the level slider changes the mesh, the colours and the legend follow the choice', async () => {
  const {page, state} = await openPage(report);
  const choose = field => page.locator('#viewer-field').selectOption(field);
  await page.locator('#viewer-beside').uncheck();
  await page.locator('#viewer-level').fill('0');
  await until('level 0', async () => (await state()).panels.every(p => p.level === 0 && p.vertices === 81));
  assert.match(await textOf(page, '#viewer-level-text'), /^0 of 1, 81 vertices/);
  const fields = await page.locator('#viewer-field option').evaluateAll(all => all.map(o => o.value)), seen = new Set();
  assert.deepEqual(fields, ['', 'mean_curvature', 'stretch', 'gap', 'contact_pressure', 'H_difference', 'principal_curvature']);
  for (const field of fields.slice(1)) {
    await choose(field);
    await until(field, async () => (await state()).panels.every(p => p.tints > 0 && !seen.has(p.tints)));
    seen.add((await state()).panels[0].tints);
    assert.ok(await page.locator('#viewer-legend').isVisible());
  }
  await choose('gap');
  assert.match(await textOf(page, '#viewer-legend'), /^0.* m.*distance to an obstacle/s);
  await choose('');
  await until('no tint', async () => (await state()).panels.every(p => p.tints === null));
  assert.ok(!(await page.locator('#viewer-legend').isVisible()));
  await page.locator('#viewer-smooth').check();
  await until('a smooth surface', async () => (await state()).panels.every(p => p.vertices === 33 * 33));
  await page.locator('#viewer-smooth').uncheck();
  await until('the mesh', async () => (await state()).panels.every(p => p.vertices === 81));
  const plain = (await downloaded(page, '#viewer-png')).bytes;
  await page.locator('#viewer-squares').check();
  await until('squares', async () => (await textOf(page, '#viewer-square-size')).startsWith('of '));
  assert.notDeepEqual((await downloaded(page, '#viewer-png')).bytes, plain);
  await page.locator('#viewer-squares').uncheck();
  await page.locator('#viewer-obstacles').uncheck();
  await page.locator('#viewer-xray').check();
  assert.ok(await drawnShare(page, '#viewer-canvas') > .02);
  const picture = await downloaded(page, '#viewer-png');
  assert.equal(picture.name, 'contact.png');
  assert.equal(picture.bytes.subarray(1, 4).toString(), 'PNG');

  // The nearest level is taken for one without a state, and the next one by keys.
  await page.evaluate(() => {
    const {data} = window.drapeViewer, spread = levels => levels.map(entry => ({...entry, level: 2 * entry.level}));
    return window.drapeViewer.update({...data, levels: [data.levels[0], data.levels[0], data.levels[1]],
      methods: data.methods.map(method => ({...method, levels: spread(method.levels)}))});
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

test('the progression plays, snapshots between the levels included', async () => {
  addFrames();
  const {page, state} = await openReport('out');
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
  const shown = await page.evaluate(() => window.shown.map(text => text.split(' ')));
  assert.deepEqual(shown.map(([stop]) => stop), ['0', '1', '2', '3', '4']);
  assert.equal(new Set(shown.map(([, x]) => x)).size, 5);
  await page.locator('#viewer-stop').fill('1');
  await until('a snapshot', async () => (await state()).stop === 1 && (await state()).panels[0].level === 0);
  assert.match(await textOf(page, '#viewer-labels'), /7 iterations, 0.700 s/);
});

test('labels can be read over whatever is behind them, and a body is in the frame from head to foot', async () => {
  // A cape on a post, which is taller than the cape.
  fs.writeFileSync(path.join(folder, 'post.yaml'), `name: post
cloth: {shape: square, side: 0.3, columns: 9, rows: 9}
levels: 1
start: {translate: [-0.15, -0.15, 0.41]}
energies: [neo_hookean, hinge, gravity]
contact: ipc
obstacles: [{meshed_shape: box, size: [0.1, 0.1, 0.8]}]
newton: {force_tolerance: 1e9, decrement_tolerance: 1e9}
methods: {newton: {}}
`);
  await run(folder, 'run', 'post.yaml', '--out', 'post', '--quiet', '--threads', '1', '--set', 'snapshots=0');
  for (const colorScheme of ['light', 'dark']) {
    const {page} = await openPage(addressOf(folder, 'post/report.html'), {colorScheme});
    const farthest = await page.evaluate(() => {
      const {scene, panels} = window.drapeViewer, points = [...panels[0].shape.x, ...panels[0].obstacles[0].x];
      scene.render(1);
      scene.camera.updateMatrixWorld();
      let most = 0;
      for (let i = 0; i < points.length; i += 3) {
        const place = new THREE.Vector3(...points.slice(i, i + 3)).project(scene.camera);
        most = Math.max(most, Math.abs(place.x), Math.abs(place.y));
      }
      return most;
    });
    assert.ok(farthest > .5 && farthest < 1, `${farthest}`);
    const contrasts = await page.evaluate(() => {
      const pen = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
      const luminance = (...colours) => {
        for (const colour of colours) {
          pen.fillStyle = colour;
          pen.fillRect(0, 0, 1, 1);
        }
        const [r, g, b] = [...pen.getImageData(0, 0, 1, 1).data].map(v => v / 255).map(v => v <= .04045 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4);
        return .2126 * r + .7152 * g + .0722 * b;
      };
      return [...document.querySelectorAll('#viewer-labels :is(b, span)')].flatMap(text => ['black', 'white'].map(behind => {
        const {color, backgroundColor} = getComputedStyle(text), pair = [luminance(color), luminance(behind, backgroundColor)];
        return (Math.max(...pair) + .05) / (Math.min(...pair) + .05);
      }));
    });
    assert.ok(contrasts.length >= 4 && contrasts.every(contrast => contrast >= 4.5), contrasts.join());
  }
});

test('sewn cloth has its seams as lines, and its flat pieces beside it in the same colours', async () => {
  await run(folder, 'run', path.join(source, 'configs/cushion.yaml'), '--levels', '1', '--method', 'pcs', '--out', 'cushion', '--quiet', '--threads', '1');
  const {page, state} = await openReport('cushion');
  const [draped] = (await state()).panels, picture = async () => (await downloaded(page, '#viewer-png')).bytes;
  const sewn = await picture();
  await page.locator('#viewer-seams').uncheck();
  assert.notDeepEqual(await picture(), sewn);
  await page.locator('#viewer-seams').check();
  await page.locator('#viewer-squares').check();
  await until('cut along its seams', async () => (await state()).panels[0].vertices > draped.vertices);
  assert.notDeepEqual(await picture(), sewn);
  assert.match(await textOf(page, '#viewer-square-size'), /^of (10|20|50) mm$/);
  await page.locator('#viewer-squares').uncheck();
  await until('whole again', async () => (await state()).panels[0].vertices === draped.vertices);
  await page.locator('#viewer-flat').check();
  await until('two panels', async () => (await state()).panels.length === 2);
  assert.deepEqual((await state()).panels.map(p => p.flat), [false, true]);
  assert.ok((await state()).panels[1].vertices > draped.vertices);  // those of seams stand twice
  await page.locator('#viewer-field').selectOption('stretch_warp');
  await until('colours', async () => (await state()).panels.every(p => p.tints > 0));
});

test('keys and pointer turn all views together', async () => {
  const {page, state} = await openPage(report, {hasTouch: true});
  const home = (await state()).camera;
  await page.locator('#viewer-canvas').focus();
  for (const key of ['ArrowLeft', 'ArrowUp', '+', 'Shift+ArrowRight']) await page.keyboard.press(key);
  const turned = (await state()).camera;
  for (const name of ['azimuth', 'elevation', 'distance']) assert.notEqual(turned[name], home[name]);
  assert.notDeepEqual(turned.target, home.target);
  await page.keyboard.press('0');
  assert.deepEqual((await state()).camera, home);
  for (const [key, level] of [['PageUp', 1], ['PageDown', 0]]) {
    await page.keyboard.press(key);
    await until('level ' + level, async () => (await state()).panels[0].level === level);
  }
  await page.keyboard.press('PageUp');
  // Noted in the page: it may have played to the end before it is asked.
  await page.evaluate(() => window.addEventListener('keydown', () => { window.plays = !!window.drapeViewer.plays; }));
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
  await page.evaluate(() => {
    const canvas = document.getElementById('viewer-canvas');
    window.isFine = () => canvas.width / canvas.clientWidth > 1.9;
  });
  await until('smooth edges at rest', () => page.evaluate(() => window.isFine()));
  assert.equal(await page.evaluate(async () => {
    window.drapeViewer.scene.turn(.1, 0);
    await new Promise(requestAnimationFrame);
    return window.isFine();
  }), false);
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

test('printed, and without WebGL', async () => {
  const {page} = await openPage(report, {colorScheme: 'dark', viewport: {width: 400, height: 800}});
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
  const names = page.locator('.fallback b');
  assert.deepEqual(await names.allTextContents(), await page.locator('#viewer-labels b').allTextContents());
  assert.ok(await names.first().isVisible());
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
  await until('the sentence', async () => (await textOf(bare, '#viewer-note')).includes('no WebGL'));
  assert.ok(!(await bare.locator('#viewer-stage').isVisible()));
  assert.ok(await bare.locator('img.fallback').isVisible());
});

test('the view begins with the first method that has a state, whose minutes are in seconds', async () => {
  const {page, state} = await edited('failed', ({pcs, cascadic}) => {
    const levels = [{level: 0, status: 'failed', message: 'no memory'}];
    Object.assign(pcs, {status: 'failed', levels, consistency: []});
    cascadic.levels[0].seconds = 123.4;
  });
  assert.deepEqual((await state()).panels.map(p => [p.method, p.vertices]), [['cascadic', 81], ['cascadic', 289]]);
  assert.ok(await drawnShare(page, '#viewer-canvas') > .05);
  await until('the label', async () => (await textOf(page, '#viewer-labels')).includes('after 123 s'));
});

/// Writes four snapshots of pcs's level 0 into the run, as a recorded run has them: the sheet sinking to its last state.
function addFrames() {
  const ply = fs.readFileSync(path.join(folder, 'out/levels/pcs_l0.ply')), marker = 'end_header\n';
  const begin = ply.indexOf(marker) + marker.length, count = 81, snapshots = Buffer.alloc(4 * count * 12);
  for (let k = 0; k < 4; ++k)
    for (let i = 0; i < 3 * count; ++i)
      snapshots.writeFloatLE(ply.readDoubleLE(begin + 8 * i) + (i % 3 === 2 ? .03 * (3 - k) : 0), 4 * (3 * count * k + i));
  fs.mkdirSync(path.join(folder, 'out/snapshots'), {recursive: true});
  fs.writeFileSync(path.join(folder, 'out/snapshots/pcs_l0.bin'), snapshots);
  changeResults('out', ({pcs}) => {
    pcs.levels[0].snapshots = {file: 'snapshots/pcs_l0.bin', iterations: [1, 7, 15, 22], seconds: [.1, .7, 1.5, 2.2]};
  });
}
