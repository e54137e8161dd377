// The live view of runs that go on: in a real browser, and against others who would meddle.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import {contactConfig, drawnShare, jsonIn, listenTo, newPage, openPage, run, scratch, start, stateOf, test, textOf, until} from './support.mjs';

const folder = scratch();
// Small steps for ever: at larger ones a level stalls before long, and a busy machine lets no page ask for
// the next one before.
const endless = ['force_tolerance=1e-300', 'max_steps=100000000', 'step_size=2e-4', 'step_growth=1']
  .flatMap(set => ['--set', 'newton.' + set]).concat('--method', 'all');

/// A run with a live view, once its address is known.
async function startViewed(experiment, out, ...more) {
  const command =
    start(folder, 'run', experiment, '--out', out, '--quiet', '--threads', '1', '--no-report', '--view', ...more);
  const url = await until('the address', () => /^view: (\S+)\n/.exec(command.text.out)?.[1]);
  return Object.assign(command, {url});
}

function request(url, method, headers = {}) {
  return new Promise((resolve, reject) => {
    const asked = http.request(url, {method, headers}, response => {
      let body = '';
      response.on('data', data => { body += data; });
      response.on('end', () => resolve({status: response.statusCode, body}));
    });
    asked.on('error', reject);
    asked.end();
  });
}

/// The share that a page has drawn while its run stands still: one that goes on has a slow machine draw and never take a picture.
async function drawnAtRest(running, page, selector) {
  running.kill('SIGSTOP');
  const share = await drawnShare(page, selector);
  running.kill('SIGCONT');
  return share;
}

const statusOf = page => textOf(page, '#live-status');

test('levels appear and move; "refine now" goes on to the next; "stop" ends the run as Ctrl-C does', async () => {
  const running = await startViewed(contactConfig, 'stopped', '--view-keep', ...endless);
  assert.match(running.url, /^http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\/$/);
  const {page, heard, state} = await openPage(running.url);
  assert.equal(await statusOf(page), 'Running: pcs, level 0 of 1.');
  const first = (await state()).panels[0];
  assert.deepEqual([first.method, first.level, first.vertices], ['pcs', 0, 81]);
  await until('a newer state', async () => (await state()).panels[0].sum !== first.sum);
  assert.match(await textOf(page, '#viewer-labels'), /level 0 of 1, running, [0-9]+ iterations/);
  assert.ok(await drawnAtRest(running, page, '#viewer-canvas') > .05);
  assert.ok(await drawnAtRest(running, page, '#live-residual') > .002);
  await page.evaluate(() => {
    document.querySelector('#live-residual svg').drawnBefore = true;
    document.querySelector('#live-residual .legend > g').focus();
    new MutationObserver(() => { window.saidAgain = true; })
      .observe(document.querySelector('#live-status'), {childList: true, characterData: true});
  });
  await until('a newer plot', () => page.evaluate(() => !document.querySelector('#live-residual svg').drawnBefore));
  assert.deepEqual(await page.evaluate(() => [document.activeElement.textContent, !!window.saidAgain]), ['pcs', false]);
  await page.locator('#viewer-field').selectOption('stretch');
  await until('colours', async () => (await state()).panels[0].tints > 0);

  await page.locator('#live-refine').click();
  await until('level 1', async () => (await state()).panels[0].vertices === 289);
  assert.equal(await statusOf(page), 'Running: pcs, level 1 of 1.');
  assert.ok(await page.locator('#live-refine').isDisabled());
  const refused = await request(running.url + 'refine', 'POST');
  assert.deepEqual(refused, {status: 409, body: 'This is the finest level: there is none to refine to.\n'});

  await page.locator('#live-stop').click();
  // A view that is not kept is there for seconds on the clock, which a busy machine may let go by.
  await until('the page says so', async () =>
    (await statusOf(page)) === 'The run has ended: stopped on request; the results are in stopped.');
  assert.deepEqual(heard.errors, []);
  running.kill('SIGINT');
  const ended = await running.ended();
  assert.equal(ended.code, 130);
  assert.match(ended.err, /stopped on request; everything up to then is in stopped\n$/);
  assert.ok(heard.requests.every(url => url.startsWith(running.url) || url.startsWith('data:')), heard.requests.join());
  const {pcs, cascadic} = jsonIn(folder, 'stopped/results.json').methods;
  assert.deepEqual(pcs.levels.map(level => level.status), ['refined_early_on_request', 'cancelled']);
  assert.match(pcs.levels[0].message, /^refined on request; force residual /);
  assert.equal(cascadic, undefined);
});

test('controls do nothing before there is a state', async () => {
  const running = await startViewed(contactConfig, 'begun', ...endless), page = await newPage(), heard = listenTo(page);
  const methods = [{name: 'pcs', levels: []}];
  await page.route('**/news*', route => route.fulfill({json: {version: 1, outcome: '', method: 'pcs', level: 0, finest: 1,
    rows: [], levels: [], obstacles: [], fields: [], methods}}));
  await page.goto(running.url);
  await until('the view', () => page.evaluate(() => !!window.drapeViewer));
  await page.locator('#viewer-obstacles').uncheck();
  await page.locator('#viewer-play').click();
  assert.equal(await textOf(page, '#viewer-play'), 'Play');
  await page.locator('#viewer-canvas').focus();
  await page.keyboard.press('PageUp');
  assert.deepEqual(heard.errors, []);
  running.kill('SIGTERM');
});

test('without WebGL the page goes on, and asks for no state', async () => {
  const running = await startViewed(contactConfig, 'flat', ...endless), page = await newPage(), heard = listenTo(page);
  await page.addInitScript(() => { HTMLCanvasElement.prototype.getContext = () => null; });
  await page.goto(running.url);
  await until('news', () => heard.requests.filter(url => url.includes('/news')).length > 8);
  assert.equal(await statusOf(page), 'Running: pcs, level 0 of 1.');
  assert.ok(!heard.requests.some(url => url.includes('/block/')));
  assert.deepEqual(heard.errors, []);
  running.kill('SIGTERM');
});

test('an obstacle that the schedule moves is shown where it is', async () => {
  // It rises to the cloth in the first thousand increments. The others take minutes, so the run still goes on when it is stopped.
  fs.writeFileSync(path.join(folder, 'risen.yaml'), `name: risen
cloth: {shape: square, side: 0.4, columns: 33, rows: 33}
levels: 1
start: {translate: [-0.2, -0.2, 0]}
pins: [{region: ball, point: [0, 0, 0], radius: 0.01}]
energies: [neo_hookean, hinge, gravity]
contact: shapes
obstacles: [{shape: sphere, radius: 0.05, translate: [0, 0, -0.1]}, {shape: sphere, radius: 0.05, translate: [1, 0, 0]}]
schedule: {steps: 100000, equilibrate: true, keys: [
  {parameter: obstacles.0.translate, times: [0, 0.01, 1], values: [[0, 0, -0.1], [0, 0, 0], [0, 0, 0.1]]}]}
methods: {newton: {}}
`);
  const running = await startViewed('risen.yaml', 'risen');
  const {page, heard, state} = await openPage(running.url);
  const first = (await state()).panels[0].obstacles;
  await until('it has risen', async () => (await state()).panels[0].obstacles[0] > first[0] + .01);
  assert.equal((await state()).panels[0].obstacles[1], first[1]);
  await page.locator('#live-stop').click();
  assert.equal((await running.ended()).code, 130);
  assert.deepEqual(heard.errors, []);
});

test('a page whose run is gone says so, even if another server answers', async () => {
  const running = await startViewed(contactConfig, 'left', ...endless), {page} = await openPage(running.url);
  await page.route('**/news*', route => route.fulfill({status: 404}));
  await until('the page says so', async () => /no longer answers/.test(await statusOf(page)));
  running.kill('SIGTERM');
});

test('others can neither look nor stop the run', async () => {
  const running = await startViewed(contactConfig, 'guarded', ...endless);
  const {origin, host, port} = new URL(running.url);
  const refuses = async (status, url, method, headers) => {
    const answer = await request(url, method, headers);
    assert.equal(answer.status, status);
    return answer.body;
  };
  for (const action of ['stop', 'refine']) {
    assert.match(await refuses(403, running.url + action, 'POST', {Origin: 'http://elsewhere.example'}),
      /^Refused: the request comes from elsewhere/);
    await refuses(403, running.url + action, 'POST', {Origin: 'null'});
    await refuses(404, `${origin}/${action}`, 'POST', {Origin: origin});
    await refuses(404, running.url + action, 'GET');
  }
  await refuses(403, running.url, 'GET', {Host: `elsewhere.example:${port}`});
  await refuses(404, origin + '/', 'GET');
  await refuses(404, running.url + 'block/nothing', 'GET');
  assert.equal((await request(running.url, 'GET', {Host: host})).status, 200);

  // A page of another site, in a browser, with the right address.
  const page = await newPage();
  await page.goto('data:text/html,<title>elsewhere</title>');
  await page.evaluate(url => fetch(url + 'stop', {method: 'POST', mode: 'no-cors'}).catch(() => {}), running.url);
  await page.context().close();
  const lines = () => fs.readFileSync(path.join(folder, 'guarded/iterations.csv'), 'utf8').split('\n').length;
  const before = lines();
  await until('the run goes on', () => lines() > before + 5);
  assert.equal((await request(running.url + 'stop', 'POST', {Origin: origin})).status, 204);
  assert.equal((await running.ended()).code, 130);
});

test('a run has the same bits with a view, looked at, and without', async () => {
  const short = ['--method', 'pcs,newton', '--set', 'newton.force_tolerance=0.1'];
  const running = await startViewed(contactConfig, 'viewed', '--view-keep', ...short);
  const {page, heard} = await openPage(running.url);
  await until('the end', () => running.text.out.includes('the view stays at'));
  await until('the page says so', async () => /^The run has ended: /.test(await statusOf(page)));
  assert.equal((await stateOf(page)).panels.filter(p => p.level === 1).length, 2);
  assert.deepEqual(heard.errors, []);
  running.kill('SIGINT');
  assert.equal((await running.ended()).code, 0);
  await page.context().close();

  await run(folder, 'run', contactConfig, '--out', 'plain', '--quiet', '--threads', '1', '--no-report', ...short);
  const read = (out, file) => fs.readFileSync(path.join(folder, out, file));
  for (const method of ['pcs', 'newton'])
    for (const level of [0, 1])
      assert.ok(read('viewed', `levels/${method}_l${level}.ply`).equals(read('plain', `levels/${method}_l${level}.ply`)));
  const untimed = out => read(out, 'iterations.csv').toString().split('\n')
    .map(line => line.split(',').filter((_, column) => column !== 4).join());
  assert.deepEqual(untimed('viewed'), untimed('plain'));
});
