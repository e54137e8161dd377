// What the browser tests share: tests that end what they start, the drape command, Chromium, and pixels.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';
import nodeTest, {after} from 'node:test';
import {pathToFileURL} from 'node:url';

const drape = path.join(process.env.DRAPE_BIN, 'drape');
export const source = path.resolve(path.dirname(new URL(import.meta.url).pathname), '../..');

export const contactConfig = path.join(source, 'tests/configs/data/contact.yaml');

const load = createRequire(path.join(process.env.DRAPE_NODE_MODULES, '/'));
const deadline = 600e3;  // [ms], many times what anything that a test waits for takes
const commands = new Set(), complaints = [];  // of pages from the disk in the test under way
let chrome, closes = false;

/// node:test's `test`. What it has started ends with it. It fails where a page complains.
export function test(name, body) {
  if (!closes) after(async () => { if (chrome) await (await chrome).close(); });
  closes = true;
  nodeTest(name, async () => {
    complaints.length = 0;
    try {
      await body();
      if (complaints.length) throw new Error('a page complains: ' + complaints.join('; '));
    } finally {
      endCommands();
      if (chrome) await Promise.all((await chrome).contexts().map(context => context.close()));
    }
  });
}

function endCommands() {
  for (const command of commands) command.kill('SIGKILL');
  commands.clear();
}

process.on('exit', endCommands);
for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP']) process.on(signal, () => process.exit(1));

/// Waits until the condition holds, which it looks up again and again, ever less often. Fails after the deadline, and at once where a
/// command has ended.
export async function until(what, condition) {
  const end = Date.now() + deadline;
  for (let pause = 20; ; pause = Math.min(1.5 * pause, 500)) {
    const value = await condition();
    if (value) return value;
    for (const {line, result, awaited} of commands)
      if (result && !awaited) throw new Error(`${line} has ended with ${result.code} before: ${what}\n${result.err}`);
    if (Date.now() > end) throw new Error(`in vain for ten minutes: ${what}`);
    await new Promise(resolve => setTimeout(resolve, pause));
  }
}

export const addressOf = (...parts) => pathToFileURL(path.join(...parts)).href;
export const jsonIn = (...parts) => JSON.parse(fs.readFileSync(path.join(...parts)));

export function scratch() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'drape_browser_'));
  process.on('exit', () => fs.rmSync(folder, {recursive: true, force: true}));
  return folder;
}

/// Starts the command, in a process group of its own. `ended()` resolves to its {code, out, err}.
export function start(folder, ...args) {
  const child = spawn(drape, args, {cwd: folder, stdio: ['ignore', 'pipe', 'pipe'], detached: true});
  const command = {line: ['drape', ...args].join(' '), text: {out: '', err: ''}, result: null, awaited: false};
  command.kill = signal => {
    try { process.kill(-child.pid, signal); } catch { /* it has ended */ }
  };
  command.ended = () => {
    command.awaited = true;
    return until('the end of: ' + command.line, () => command.result);
  };
  child.stdout.on('data', data => { command.text.out += data; });
  child.stderr.on('data', data => { command.text.err += data; });
  child.on('close', code => { command.result = {code, ...command.text}; });
  commands.add(command);
  return command;
}

/// Runs the command to its end; throws if it does not end well.
export async function run(folder, ...args) {
  const command = start(folder, ...args);
  const {code, err} = await command.ended();
  commands.delete(command);
  if (code !== 0) throw new Error(`${command.line} has ended with ${code}:\n${err}`);
}

/// Chromium, one for all tests of a file.
export function browser() {
  chrome ??= load('playwright-core').chromium.launch({
    executablePath: process.env.DRAPE_CHROMIUM || '/usr/bin/chromium', timeout: deadline,
    args: ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
      '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'],
  });
  return chrome;
}

export async function newPage(options = {}) {
  const context = await (await browser()).newContext(options);
  context.setDefaultTimeout(deadline);
  return context.newPage();
}

/// Takes down everything that a page complains about and every address that it asks for. A page from the disk that complains fails
/// the test.
export function listenTo(page) {
  const heard = {errors: [], requests: []};
  const complain = text => {
    heard.errors.push(text);
    if (page.url().startsWith('file:')) complaints.push(text);
  };
  page.on('console', message => { if (['error', 'warning'].includes(message.type())) complain(message.text()); });
  page.on('pageerror', error => complain(String(error)));
  page.on('request', request => heard.requests.push(request.url()));
  return heard;
}

/// What the page's 3D view shows.
export function stateOf(page) {
  return page.evaluate(() => {
    const {stops, stop, plays, scene, panels} = window.drapeViewer, sum = values => values.reduce((a, b) => a + b, 0);
    return {
      level: stops[stop]?.level, stop, stops: stops.length, playing: !!plays, camera: scene && {...scene.view},
      panels: panels.map(({method, end, found, shape, obstacles, flat}) => ({method: method.name, end: !!end, flat: !!flat, level: found ? found.level.level : -1,
        vertices: shape ? shape.x.length / 3 : 0, sum: shape ? shape.x.reduce((a, b) => a + Math.abs(b), 0) : 0,
        tints: shape?.tints ? sum(shape.tints) : null, obstacles: obstacles.map(({x}) => sum(x))})),
    };
  });
}

/// A page with a 3D view that shows a state, and what is heard of it.
export async function openPage(url, options = {}) {
  const page = await newPage({viewport: {width: 1200, height: 900}, ...options}), heard = listenTo(page);
  await page.goto(url);
  await page.locator('#viewer').scrollIntoViewIfNeeded();
  await until('a state is shown', async () => {
    if (heard.errors.length) throw new Error(heard.errors.join('; '));
    return page.evaluate(() => window.drapeViewer?.panels.length > 0);
  });
  return {page, heard, state: () => stateOf(page)};
}

export const textOf = (page, selector) => page.locator(selector).textContent();

export function unfold(page) {
  return page.evaluate(() => document.querySelectorAll('details').forEach(part => { part.open = true; }));
}

/// Checks that a page, with all of it unfolded and so many plots drawn, fits its width and has no serious fault of
/// accessibility; closes it.
export async function checkWhole(page, plots) {
  await unfold(page);
  await until('the plots are drawn', async () => await page.evaluate(() => document.querySelectorAll('.plot svg').length) >= plots);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
  await page.evaluate(load('axe-core').source);
  const {violations} = await page.evaluate(() => window.axe.run());
  const faults = violations.filter(fault => ['serious', 'critical'].includes(fault.impact))
    .map(fault => `${fault.id}: ${fault.nodes.map(node => node.html).join(' ').slice(0, 300)}`);
  assert.deepEqual(faults, []);
  await page.context().close();
}

/// Whether all of an element is on the first screen, and the page is no wider than the screen.
export function onFirstScreen(page, selector) {
  return page.evaluate(of => {
    const box = document.querySelector(of).getBoundingClientRect();
    return box.width > 0 && box.top >= 0 && box.bottom <= innerHeight && document.documentElement.scrollWidth <= innerWidth;
  }, selector);
}

/// What a press of a button downloads.
export async function downloaded(page, button) {
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator(button).click()]);
  return {name: download.suggestedFilename(), bytes: fs.readFileSync(await download.path())};
}

/// What the JSON button of a plot or a table saves.
export async function savedRows(page, part) {
  return JSON.parse((await downloaded(page, part + ' button:text-is("JSON")')).bytes);
}

export const screens = ['light', 'dark'].flatMap(colorScheme => [1200, 400].map(width => ({colorScheme, viewport: {width, height: 800}})));

/// The share of a screenshot of the element whose colour differs from its most frequent one.
export async function drawnShare(page, selector) {
  const png = (await page.locator(selector).screenshot()).toString('base64');
  return page.evaluate(async data => {
    const image = new Image();
    image.src = 'data:image/png;base64,' + data;
    await image.decode();
    const canvas = Object.assign(document.createElement('canvas'), {width: image.width, height: image.height});
    const pen = canvas.getContext('2d');
    pen.drawImage(image, 0, 0);
    const counts = new Map(), pixels = new Uint32Array(pen.getImageData(0, 0, image.width, image.height).data.buffer);
    for (const p of pixels) counts.set(p, (counts.get(p) || 0) + 1);
    return 1 - Math.max(...counts.values()) / pixels.length;
  }, png);
}
